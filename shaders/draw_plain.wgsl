// Draws the surface with nothing on it but the material, which is what most pictures are of. Little goes from vertex to
// fragment, since that is what drawing many small triangles costs.

// A uniform, which GPUs read fastest where all invocations read the same. No branch depends on it: see draw_surface_inputs.wgsl.
@group(0) @binding(6) var<uniform> plain_frame: Frame;
@group(1) @binding(0) var<uniform> material: Material;
@group(1) @binding(1) var base_texture: texture_2d<f32>;
@group(1) @binding(2) var base_sampler: sampler;

struct PlainVaryings {
    @builtin(position) clip: vec4<f32>,
    @location(0) normal: vec3<f32>,
}

@vertex
fn plain_vertex(@location(0) position: vec3<f32>, @location(1) normal: u32) -> PlainVaryings {
    return PlainVaryings(plain_frame.clip_from_object * vec4<f32>(position, 1.0), unpack_normal(normal));
}

fn plain_color(base: vec3<f32>, px: vec2<f32>, normal: vec3<f32>, front: bool) -> vec4<f32> {
    let to_eye = toward_eye(plain_frame.clip_from_object, plain_frame.viewport, px);
    let lights = Lights(plain_frame.key_light.xyz, plain_frame.fill_light.xyz, to_eye);
    return vec4<f32>(shade(lights, base, normalize(select(-normal, normal, front))), 1.0);
}

@fragment
fn plain_fragment(in: PlainVaryings, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    return plain_color(material.base_color.rgb, unmoved(in.clip, plain_frame.shift).xy, in.normal, front);
}

struct TexturedVaryings {
    @builtin(position) clip: vec4<f32>,
    @location(0) normal: vec3<f32>,
    @location(1) uv: vec2<f32>,
}

@vertex
fn textured_vertex(vertex: EmittedVertex) -> TexturedVaryings {
    let clip = plain_frame.clip_from_object * vec4<f32>(vertex.position, 1.0);
    return TexturedVaryings(clip, unpack_normal(vertex.normal), vertex.uv);
}

@fragment
fn textured_fragment(in: TexturedVaryings, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    let base = material.base_color.rgb * textureSample(base_texture, base_sampler, in.uv).rgb;
    return plain_color(base, unmoved(in.clip, plain_frame.shift).xy, in.normal, front);
}

// With a texture or without: little is drawn where normals are evaluated at pixels, and all that differs is a texel.
struct PixelVaryings {
    @builtin(position) clip: vec4<f32>,
    // Weights u and v in the patch.
    @location(0) weights: vec2<f32>,
    @location(1) uv: vec2<f32>,
    @location(2) @interpolate(flat) patch_index: u32,
}

@vertex
fn pixel_vertex(vertex: EmittedVertex) -> PixelVaryings {
    let weights = vec2<f32>(key_uv(vertex.key)) * UNIT;
    let clip = plain_frame.clip_from_object * vec4<f32>(vertex.position, 1.0);
    return PixelVaryings(clip, weights, vertex.uv, key_patch(vertex.key));
}

@fragment
fn pixel_fragment(in: PixelVaryings, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    let base = material.base_color.rgb * textureSample(base_texture, base_sampler, in.uv).rgb;
    return plain_color(base, unmoved(in.clip, plain_frame.shift).xy, pixel_normal(in.patch_index, in.weights), front);
}

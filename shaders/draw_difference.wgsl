// Shows how much two pictures of one size differ: black where they are equal, and brighter where a channel differs by more.

@group(0) @binding(0) var left_picture: texture_2d<f32>;
@group(0) @binding(1) var right_picture: texture_2d<f32>;

// How bright the smallest difference is, in steps of 255.
const DIFFERENCE_FLOOR: f32 = 64.0;

@vertex
fn difference_vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    // One triangle that holds the picture.
    let corner = vec2<f32>(f32(index & 1u), f32(index >> 1u));
    return vec4<f32>(4.0 * corner - 1.0, 0.0, 1.0);
}

@fragment
fn difference_fragment(@builtin(position) px: vec4<f32>) -> @location(0) vec4<f32> {
    let at = vec2<u32>(px.xy);
    let apart = abs(textureLoad(left_picture, at, 0) - textureLoad(right_picture, at, 0));
    let most = max(max(apart.r, apart.g), max(apart.b, apart.a));
    return vec4<f32>(vec3<f32>(select(0.0, most + DIFFERENCE_FLOOR / 255.0, most > 0.0)), 1.0);
}

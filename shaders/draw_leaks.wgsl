// Front faces add 1 and back faces subtract 1, so that a closed surface sums to 0 in every pixel.

@group(0) @binding(0) var<uniform> clip_from_object: mat4x4<f32>;

@vertex
fn leak_vertex(@location(0) position: vec3<f32>) -> @builtin(position) vec4<f32> {
    return clip_from_object * vec4<f32>(position, 1.0);
}

@fragment
fn leak_fragment(@builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    return vec4<f32>(select(-1.0, 1.0, front), 0.0, 0.0, 0.0);
}

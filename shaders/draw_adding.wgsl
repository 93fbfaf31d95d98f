// What is added at every sample that a triangle covers: see src/inspect/render/adding.rs.

@group(0) @binding(0) var<uniform> clip_from_object: mat4x4<f32>;

@vertex
fn adding_vertex(@location(0) position: vec3<f32>) -> @builtin(position) vec4<f32> {
    return clip_from_object * vec4<f32>(position, 1.0);
}

// Front faces add 1 and back faces subtract 1, so that a closed surface sums to 0 in every pixel.
@fragment
fn leak_fragment(@builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    return vec4<f32>(select(-1.0, 1.0, front), 0.0, 0.0, 0.0);
}

// Marks what triangles cover. The blend constant chooses the channel.
@fragment
fn silhouette_fragment() -> @location(0) vec4<f32> {
    return vec4<f32>(1.0);
}

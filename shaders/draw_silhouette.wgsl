// Marks what triangles cover. The blend constant chooses the channel.

@group(0) @binding(0) var<uniform> clip_from_object: mat4x4<f32>;

@vertex
fn silhouette_vertex(@location(0) position: vec3<f32>) -> @builtin(position) vec4<f32> {
    return clip_from_object * vec4<f32>(position, 1.0);
}

@fragment
fn silhouette_fragment() -> @location(0) vec4<f32> {
    return vec4<f32>(1.0);
}

// The vertex shader of draws that fill a picture.

// The depth of what is drawn: 0 is the far end.
override WHOLE_DEPTH: f32 = 0.0;

@vertex
fn whole_vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    // One triangle that holds the picture.
    let corner = vec2<f32>(f32(index & 1u), f32(index >> 1u));
    return vec4<f32>(4.0 * corner - 1.0, WHOLE_DEPTH, 1.0);
}

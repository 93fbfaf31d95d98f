// Sets the depths of a part of a picture, as clearing does with all of it.

// The depth that is set.
override CLEAR_DEPTH: f32 = 0.0;

@vertex
fn clear_vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    // One triangle that holds the picture.
    let corner = vec2<f32>(f32(index & 1u), f32(index >> 1u));
    return vec4<f32>(4.0 * corner - 1.0, CLEAR_DEPTH, 1.0);
}

// Colours stay as they are.
@fragment
fn clear_fragment() {}

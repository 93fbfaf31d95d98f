// Sets the depths of a part of a picture, as clearing does with all of it.
// With: draw_whole

// Colours stay as they are.
@fragment
fn clear_fragment() {}

// Layers in pictures with several samples a pixel: the depths that they are compared with. layers_single.wgsl has the same
// functions for the others.
// With: draw_lit_layers, draw_surface_layers

@group(3) @binding(2) var passed_depths: texture_depth_multisampled_2d;
@group(1) @binding(35) var hiding_depths: texture_depth_multisampled_2d;

// The depth of the layer that was found last.
fn passed_depth(px: vec2<f32>, sample: u32) -> f32 {
    return textureLoad(passed_depths, vec2<i32>(px), i32(sample));
}

// The depth of the surface that hides everything behind it.
fn hiding_depth(px: vec2<f32>, sample: u32) -> f32 {
    return textureLoad(hiding_depths, vec2<i32>(px), i32(sample));
}

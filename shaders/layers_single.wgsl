// Layers in pictures with one sample a pixel: the depths that draw_layers.wgsl compares. layers_multisampled.wgsl has the same
// for the others.
// With: draw_lit_layers, draw_surface_layers

@group(3) @binding(2) var passed_depths: texture_depth_2d;
@group(1) @binding(35) var hiding_depths: texture_depth_2d;

// One picture's view and material. Twin of Frame in ../peer.rs; fields mean what they do in shaders/draw_types.wgsl.

layout(push_constant) uniform Frame {
    mat4 clip_from_object;
    vec4 key_light;
    vec4 fill_light;
    // Width and height in px, then nothing.
    vec4 viewport;
    vec4 base_color;
} frame;

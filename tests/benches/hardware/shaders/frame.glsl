// The constants of a picture: its view and material. Twin of PeerFrame in ../peer.rs; its fields are those of shaders/draw_types.wgsl.

layout(push_constant) uniform Frame {
    mat4 clip_from_object;
    vec4 key_light;
    vec4 fill_light;
    // Width and height in px; the rest is unused.
    vec4 viewport;
    vec4 base_color;
} frame;

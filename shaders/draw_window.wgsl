// Paints the largest areas of the window: its background and the viewport's picture.

@group(0) @binding(0) var window_picture: texture_2d<f32>;
@group(0) @binding(1) var window_sampler: sampler;

// Whether the window's texture encodes what is written to it as sRGB. Pictures are then read as linear light.
override window_encodes: bool = false;

struct WindowPicture {
    @builtin(position) position: vec4<f32>,
    // From the picture's top left corner to its bottom right one: 0 to 1.
    @location(0) at: vec2<f32>,
}

struct WindowColor {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) color: vec3<f32>,
}

// A corner of one triangle that holds the area.
fn window_corner(index: u32) -> vec2<f32> {
    return 2.0 * vec2<f32>(f32(index & 1u), f32(index >> 1u));
}

fn window_position(corner: vec2<f32>) -> vec4<f32> {
    return vec4<f32>(2.0 * corner.x - 1.0, 1.0 - 2.0 * corner.y, 0.0, 1.0);
}

@vertex
fn picture_vertex(@builtin(vertex_index) index: u32) -> WindowPicture {
    let corner = window_corner(index);
    return WindowPicture(window_position(corner), corner);
}

@fragment
fn picture_fragment(in: WindowPicture) -> @location(0) vec4<f32> {
    return vec4<f32>(textureSampleLevel(window_picture, window_sampler, in.at, 0.0).rgb, 1.0);
}

// The number of the instance is the colour: red is its lowest byte.
@vertex
fn fill_vertex(@builtin(vertex_index) index: u32, @builtin(instance_index) color: u32) -> WindowColor {
    let encoded = unpack4x8unorm(color).rgb;
    let low = encoded / 12.92;
    let light = select(pow((encoded + 0.055) / 1.055, vec3<f32>(2.4)), low, encoded <= vec3<f32>(0.04045));
    return WindowColor(window_position(window_corner(index)), select(encoded, light, window_encodes));
}

@fragment
fn fill_fragment(in: WindowColor) -> @location(0) vec4<f32> {
    return vec4<f32>(in.color, 1.0);
}

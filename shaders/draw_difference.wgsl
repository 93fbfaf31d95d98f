// Shows how much two pictures of one size differ: black where they are equal, and brighter where a channel differs by more. Over
// that are their wireframes, which they keep as what they lack of alpha 1.
// With: draw_whole

@group(0) @binding(0) var left_picture: texture_2d<f32>;
@group(0) @binding(1) var right_picture: texture_2d<f32>;

// How bright the smallest difference is, in steps of 255.
const DIFFERENCE_FLOOR: f32 = 64.0;

// The wireframes of the left and of the right picture, in sRGB; the mean of both where they agree.
const LEFT_WIRE_COLOR: vec3<f32> = vec3<f32>(0.90, 0.62, 0.0);
const RIGHT_WIRE_COLOR: vec3<f32> = vec3<f32>(0.34, 0.71, 0.91);

@fragment
fn difference_fragment(@builtin(position) px: vec4<f32>) -> @location(0) vec4<f32> {
    let at = vec2<u32>(px.xy);
    let left = textureLoad(left_picture, at, 0);
    let right = textureLoad(right_picture, at, 0);
    let apart = abs(left.rgb - right.rgb);
    let most = max(max(apart.r, apart.g), apart.b);
    let difference = vec3<f32>(select(0.0, most + DIFFERENCE_FLOOR / 255.0, most > 0.0));
    let wires = 1.0 - vec2<f32>(left.a, right.a);
    let color = (wires.x * LEFT_WIRE_COLOR + wires.y * RIGHT_WIRE_COLOR) / max(wires.x + wires.y, 1e-3);
    return vec4<f32>(mix(difference, color, max(wires.x, wires.y)), 1.0);
}

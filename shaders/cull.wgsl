// Which patches emit nothing. Twin: src/tessellate/cull.rs.

const CLIP_OFF: u32 = 0u;
const CLIP_PAPER: u32 = 1u;
const CLIP_FRUSTUM: u32 = 2u;

// IsClipped of the PN-AEN white paper: outside -w <= x, y, z <= w.
fn is_clipped(clip: vec4<f32>) -> bool {
    let inside = all(abs(clip.xyz) <= clip.www);
    return !inside;
}

fn outside_view(view: LodView, position: vec3<f32>) -> bool {
    return is_clipped(view.clip_from_object * vec4<f32>(position, 1.0));
}

fn patch_is_clipped(view: LodView, net: ControlNet) -> bool {
    var clipped = outside_view(view, net.center);
    for (var i = 0u; i < 3u; i++) {
        clipped = clipped && outside_view(view, net.corners[i]);
    }
    for (var i = 0u; i < 6u; i++) {
        clipped = clipped && outside_view(view, net.edges[i]);
    }
    return clipped;
}

// Bits: left, right, below, above, beyond far, nearer than near. Linear also behind the eye.
fn planes_outside(clip: vec4<f32>) -> u32 {
    return far_outside(array<f32, 6>(0.0, 0.0, 0.0, 0.0, 0.0, 0.0), clip);
}

fn far_outside(margins: array<f32, 6>, clip: vec4<f32>) -> u32 {
    return u32(clip.x + margins[0] < -clip.w)
        | u32(clip.x - margins[1] > clip.w) << 1u
        | u32(clip.y + margins[2] < -clip.w) << 2u
        | u32(clip.y - margins[3] > clip.w) << 3u
        | u32(clip.z + margins[4] < 0.0) << 4u
        | u32(clip.z - margins[5] > clip.w) << 5u;
}

// How far towards the inside of each plane displacement may move a point.
fn reach_margins(view: LodView) -> array<f32, 6> {
    let x = clip_row(view, 0u);
    let y = clip_row(view, 1u);
    let z = clip_row(view, 2u);
    let w = clip_row(view, 3u);
    return array<f32, 6>(
        length(x + w) * view.reach,
        length(x - w) * view.reach,
        length(y + w) * view.reach,
        length(y - w) * view.reach,
        length(z) * view.reach,
        length(z - w) * view.reach,
    );
}

fn patch_is_outside(view: LodView, net: ControlNet) -> bool {
    let m = view.clip_from_object;
    let margins = reach_margins(view);
    var shared_planes = far_outside(margins, m * vec4<f32>(net.center, 1.0));
    for (var i = 0u; i < 3u; i++) {
        shared_planes &= far_outside(margins, m * vec4<f32>(net.corners[i], 1.0));
    }
    for (var i = 0u; i < 6u; i++) {
        shared_planes &= far_outside(margins, m * vec4<f32>(net.edges[i], 1.0));
    }
    return shared_planes != 0u;
}

// Of a quadratic triangle, in the order 200, 110, 020, 011, 002, 101.
fn polar_points(net: ControlNet, i: u32) -> array<vec3<f32>, 6> {
    let b = net.edges;
    if i == 0u {
        return array<vec3<f32>, 6>(net.corners[0], b[0], b[1], net.center, b[4], b[5]);
    }
    if i == 1u {
        return array<vec3<f32>, 6>(b[0], b[1], net.corners[1], b[2], b[3], net.center);
    }
    return array<vec3<f32>, 6>(b[5], net.center, b[2], b[3], net.corners[2], b[4]);
}

const FACING_MARGIN: f32 = 1e-3;

const FACING_ROUNDING: f32 = 1e-6;

// Digits to base 5 of second and third index, and how often each counts.
const POLAR_INDICES: array<u32, 6> = array<u32, 6>(0u, 5u, 10u, 6u, 2u, 1u);
const POLAR_WEIGHTS: array<f32, 6> = array<f32, 6>(1.0, 2.0, 1.0, 2.0, 1.0, 2.0);

// Whether each control vector of the tangents' cross product shows its back to all of the net's box.
fn faces_away(view: LodView, net: ControlNet) -> bool {
    // Its columns are the rows of the matrix: x, y and w.
    let rows = mat3x3<f32>(clip_row(view, 0u), clip_row(view, 1u), clip_row(view, 3u));
    var at_u = polar_points(net, 0u);
    var at_v = polar_points(net, 1u);
    var at_w = polar_points(net, 2u);
    var least = vec3<f32>(3.4e38);
    var greatest = vec3<f32>(-3.4e38);
    var toward_u: array<vec3<f32>, 6>;
    var toward_v: array<vec3<f32>, 6>;
    for (var k = 0u; k < 6u; k++) {
        let u = (view.clip_from_object * vec4<f32>(at_u[k], 1.0)).xyw;
        let v = (view.clip_from_object * vec4<f32>(at_v[k], 1.0)).xyw;
        let w = (view.clip_from_object * vec4<f32>(at_w[k], 1.0)).xyw;
        least = min(min(least, u), min(v, w));
        greatest = max(max(greatest, u), max(v, w));
        toward_u[k] = (at_u[k] - at_w[k]) * rows;
        toward_v[k] = (at_v[k] - at_w[k]) * rows;
    }
    let middle = (least + greatest) * 0.5;
    let reach = (greatest - least) * 0.5 + (abs(middle) + greatest - least) * FACING_MARGIN;
    var indices = POLAR_INDICES;
    var weights = POLAR_WEIGHTS;
    var facing: array<vec3<f32>, 25>;
    var terms: array<vec3<f32>, 25>;
    for (var i = 0u; i < 6u; i++) {
        for (var j = 0u; j < 6u; j++) {
            let product = cross(toward_u[i], toward_v[j]) * (weights[i] * weights[j]);
            facing[indices[i] + indices[j]] += product;
            terms[indices[i] + indices[j]] += abs(product);
        }
    }
    for (var i = 0u; i < 5u; i++) {
        for (var j = 0u; j < 5u - i; j++) {
            let own = facing[5u * i + j];
            let rounding = dot(terms[5u * i + j], abs(middle)) * FACING_ROUNDING;
            let away = dot(own, middle) + dot(abs(own), reach) + rounding < 0.0;
            if !away {
                return false;
            }
        }
    }
    return true;
}

// Why a patch emits nothing.
const SEEN: u32 = 0u;
const OUT_OF_VIEW: u32 = 1u;
const FACING_AWAY: u32 = 2u;

fn unseen(clip: u32, culls_back: bool, view: LodView, net: ControlNet) -> u32 {
    let outside = (clip == CLIP_PAPER && patch_is_clipped(view, net))
        || (clip == CLIP_FRUSTUM && patch_is_outside(view, net));
    if outside {
        return OUT_OF_VIEW;
    }
    return select(SEEN, FACING_AWAY, culls_back && faces_away(view, net));
}

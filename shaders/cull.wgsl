// Culling and clipping of whole patches. Twin: src/geometry/tessellate/cull.rs.

// Returns whether a clip-space position lies outside the white paper's view volume, -w <= x, y, z <= w (`IsClipped` of
// McDonald and Kilgard 2010).
fn is_clipped(clip: vec4<f32>) -> bool {
    let inside = all(abs(clip.xyz) <= clip.www);
    return !inside;
}

// Returns whether a position in object units lies outside that view volume.
fn outside_view(view: LodView, position: vec3<f32>) -> bool {
    return is_clipped(view.clip_from_object * vec4<f32>(position, 1.0));
}

// Returns whether all ten control points lie outside the view volume: the white paper's test of a patch.
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

// Returns which planes of the view volume a clip-space position lies outside of, as bits: left (bit 0), right, bottom,
// top, far, near (bit 5). Depth is reversed.
fn planes_outside(clip: vec4<f32>) -> u32 {
    return planes_outside_by(array<f32, 6>(0.0, 0.0, 0.0, 0.0, 0.0, 0.0), clip);
}

// Returns the same bits for the planes that a position lies outside of by more than their margin, in clip-space units.
fn planes_outside_by(margins: array<f32, 6>, clip: vec4<f32>) -> u32 {
    return u32(clip.x + margins[0] < -clip.w)
        | u32(clip.x - margins[1] > clip.w) << 1u
        | u32(clip.y + margins[2] < -clip.w) << 2u
        | u32(clip.y - margins[3] > clip.w) << 3u
        | u32(clip.z + margins[4] < 0.0) << 4u
        | u32(clip.z - margins[5] > clip.w) << 5u;
}

// Returns how far displacement may move a point towards the inside of each plane, in clip-space units and in the order
// of the bits of `planes_outside`.
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

// Returns whether all of a patch lies outside one plane of the view volume, however it is displaced.
fn patch_is_outside(view: LodView, net: ControlNet) -> bool {
    let m = view.clip_from_object;
    let margins = reach_margins(view);
    var shared_planes = planes_outside_by(margins, m * vec4<f32>(net.center, 1.0));
    for (var i = 0u; i < 3u; i++) {
        shared_planes &= planes_outside_by(margins, m * vec4<f32>(net.corners[i], 1.0));
    }
    for (var i = 0u; i < 6u; i++) {
        shared_planes &= planes_outside_by(margins, m * vec4<f32>(net.edges[i], 1.0));
    }
    return shared_planes != 0u;
}

// Returns the six control points whose weights contain the weight of corner `i` as a factor, as the net of a quadratic
// triangle in the order 200, 110, 020, 011, 002, 101.
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

// How far a surface must be from being seen edge-on, about as a sine. The margin is larger than rounding errors, and
// large enough that a rasteriser which snaps vertices to 1/256 px sees a back face too.
const FACING_MARGIN: f32 = 1e-3;

// The rounding error of a sum, relative to the sum of the absolute values of its terms.
const FACING_ROUNDING: f32 = 1e-6;

// The second and third index of each polar point, as two digits to base 5, and its binomial weight.
const POLAR_INDICES: array<u32, 6> = array<u32, 6>(0u, 5u, 10u, 6u, 2u, 1u);
const POLAR_WEIGHTS: array<f32, 6> = array<f32, 6>(1.0, 2.0, 1.0, 2.0, 1.0, 2.0);

// Returns whether a patch shows its back everywhere. The patch must lie beyond the near plane.
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

// The reasons why a patch emits nothing. `NOT_CULLED`: the view leaves it in, though its own factors may cull it.
const NOT_CULLED: u32 = 0u;
const OUT_OF_VIEW: u32 = 1u;
const FACING_AWAY: u32 = 2u;

// Returns whether a patch is left out, and why. Patches that show only their backs are left out if `culls_back` is set.
fn cull_reason(clip: u32, culls_back: bool, view: LodView, net: ControlNet) -> u32 {
    let outside = (clip == CLIP_PAPER && patch_is_clipped(view, net))
        || (clip == CLIP_FRUSTUM && patch_is_outside(view, net));
    if outside {
        return OUT_OF_VIEW;
    }
    return select(NOT_CULLED, FACING_AWAY, culls_back && faces_away(view, net));
}

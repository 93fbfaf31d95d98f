// What exported shaders do with a patch: the part of a hull shader and of a domain shader that doesn't depend on their language.
// A patch has its own three corners and, for each of its sides, the two corners that its neighbour has there: the white
// paper's nine indices (McDonald and Kilgard 2010).

// The choices of an export, which src/inspect/shader_files puts in place of these.
const CHOSEN_SURFACE: u32 = SURFACE_PN_AEN;
const CHOSEN_TEARING: u32 = TEARING_OFF;
const CHOSEN_EDGES: u32 = EDGES_PER_EDGE;
const CHOSEN_LOD: u32 = LOD_UNIFORM;
const CHOSEN_PARTITIONING: u32 = PARTITIONING_FRACTIONAL_ODD;
const CHOSEN_CLIP: u32 = CLIP_OFF;
const CHOSEN_CULLING: u32 = CULLING_OFF;
const CHOSEN_CONVENTION: u32 = CONVENTION_D3D11;
const CHOSEN_NORMALS: u32 = NORMALS_LINEAR;

// Whether the sides of an edge have curves of their own, so that the surface tears where their normals differ.
const TEARING_OFF: u32 = 0u;
const TEARING_ON: u32 = 1u;

// Whether patches that show only their backs are left out.
const CULLING_OFF: u32 = 0u;
const CULLING_ON: u32 = 1u;

// The numbers that a host may change from frame to frame.
struct StageConstants {
    // The matrix that vertices are drawn with.
    clip_from_object: mat4x4<f32>,
    // What LOD and culling are computed for.
    view: LodView,
    // The factor of uniform LOD, and the largest of LOD by distance, 1 to 64.
    factor: f32,
    // The length of a segment on screen in px, of LOD by the length of edges.
    pixels_per_segment: f32,
    // The distances of LOD by distance in bounding radii: up to `near` edges get `factor`, from `far` on 1.
    near: f32,
    far: f32,
    // How strong Phong tessellation is, 0 to 1.
    alpha: f32,
}

// The unit normals of one side of an edge, at the edge's start and at its end.
struct SideNormals {
    at_a: vec3<f32>,
    at_b: vec3<f32>,
}

// What the hull shader computes for a side of a patch: the control points near its start and near its end, and the factor of
// its edge.
struct HullSide {
    near_start: vec3<f32>,
    near_end: vec3<f32>,
    factor: f32,
}

// What the domain shader reads of a patch.
struct StagePatch {
    net: ControlNet,
    normals: array<vec3<f32>, 3>,
    uvs: array<vec2<f32>, 3>,
}

// What the domain shader makes of one domain point.
struct StageVertex {
    position: vec3<f32>,
    normal: vec3<f32>,
    uv: vec2<f32>,
}

// Returns whether a position comes before another one, by x, then y, then z.
fn comes_before(a: vec3<f32>, b: vec3<f32>) -> bool {
    if a.x != b.x {
        return a.x < b.x;
    }
    if a.y != b.y {
        return a.y < b.y;
    }
    return a.z < b.z;
}

// Returns whether a side of a patch, from `start` to `end`, runs against its edge. An edge runs from the end that comes first to
// the other one, which all its sides see alike: they compute it in that direction, and get the same bits. As published, every
// side has a direction of its own.
fn side_is_reversed(start: vec3<f32>, end: vec3<f32>) -> bool {
    if CHOSEN_EDGES == EDGES_AS_PUBLISHED {
        return false;
    }
    return comes_before(end, start);
}

// Returns the normals of a side in the direction of its edge.
fn along_edge(side: SideNormals, reversed: bool) -> SideNormals {
    return SideNormals(select(side.at_a, side.at_b, reversed), select(side.at_b, side.at_a, reversed));
}

// Returns the normals of `one` side, or those of the `other` one.
fn chosen_normals(one: SideNormals, other: SideNormals, takes_other: bool) -> SideNormals {
    return SideNormals(select(one.at_a, other.at_a, takes_other), select(one.at_b, other.at_b, takes_other));
}

// Returns the control points that one side of an edge from `a` to `b` proposes.
fn unshared_curve(alpha: f32, a: vec3<f32>, b: vec3<f32>, side: SideNormals) -> CurveNet {
    let proposed = side_control_points(CHOSEN_SURFACE, alpha, a, b, side.at_a, side.at_b);
    return CurveNet(proposed[0], proposed[1]);
}

// Returns the control points of an edge from `a` to `b` that two sides share: the mean of what both propose, or on a crease
// those along it.
fn shared_curve(alpha: f32, a: vec3<f32>, b: vec3<f32>, one: SideNormals, other: SideNormals) -> CurveNet {
    let of_one = unshared_curve(alpha, a, b, one);
    let of_other = unshared_curve(alpha, a, b, other);
    let ab = (of_one.ab + of_other.ab) * 0.5;
    let ba = (of_one.ba + of_other.ba) * 0.5;
    if CHOSEN_SURFACE == SURFACE_PN_CREASE {
        let none = DistinctNormals(vec3<f32>(0.0), vec3<f32>(0.0), 0u);
        let around_a = add_normal(add_normal(none, one.at_a), other.at_a);
        let around_b = add_normal(add_normal(none, one.at_b), other.at_b);
        return CurveNet(crease_control_point(a, b, around_a, ab), crease_control_point(b, a, around_b, ba));
    }
    return CurveNet(ab, ba);
}

// Returns the curve of a patch's side: shared with the side across the edge if the surface doesn't tear, else the patch's own.
fn side_curve(alpha: f32, a: vec3<f32>, b: vec3<f32>, own: SideNormals, across: SideNormals, reversed: bool) -> CurveNet {
    if CHOSEN_SURFACE == SURFACE_FLAT || CHOSEN_TEARING == TEARING_ON {
        return unshared_curve(alpha, a, b, own);
    }
    // The side that runs along the edge first, so that both sides add up in the same order.
    return shared_curve(alpha, a, b, chosen_normals(own, across, reversed), chosen_normals(across, own, reversed));
}

// Returns LOD's factor of an edge with these control points, in the edge's direction.
fn edge_curve_factor(constants: StageConstants, a: vec3<f32>, curve: CurveNet, b: vec3<f32>) -> f32 {
    if CHOSEN_LOD == LOD_UNIFORM {
        return constants.factor;
    }
    if CHOSEN_LOD == LOD_DISTANCE {
        return distance_factor(constants.view, constants.factor, constants.near, constants.far, a, b);
    }
    if CHOSEN_LOD == LOD_PAPER {
        return paper_edge_factor(constants.view, constants.pixels_per_segment, a, curve.ab, curve.ba, b);
    }
    if CHOSEN_LOD == LOD_EDGE_LENGTH {
        return edge_length_factor(constants.view, constants.pixels_per_segment, a, curve.ab, curve.ba, b);
    }
    // No other LOD can be exported. A factor of 0 leaves patches out, which is seen at once.
    return 0.0;
}

// Returns the factor of a patch's side. Where a surface tears, the sides of an edge have curves of different lengths; both take
// the larger factor, so that only the surface tears and not the pattern.
fn hull_side_factor(
    constants: StageConstants,
    a: vec3<f32>,
    b: vec3<f32>,
    curve: CurveNet,
    across: SideNormals,
) -> f32 {
    let own = edge_curve_factor(constants, a, curve, b);
    if CHOSEN_EDGES == EDGES_AS_PUBLISHED || CHOSEN_LOD == LOD_UNIFORM || CHOSEN_LOD == LOD_DISTANCE {
        return own;
    }
    if CHOSEN_TEARING == TEARING_ON {
        return max(own, edge_curve_factor(constants, a, unshared_curve(constants.alpha, a, b, across), b));
    }
    return own;
}

// Returns a factor as it is handed to the tessellator: under pow2 rounded up to a power of two.
fn written_factor(factor: f32) -> f32 {
    if CHOSEN_PARTITIONING == PARTITIONING_POW2 {
        return round_pow2(factor);
    }
    return factor;
}

// Returns what the hull shader computes for the side of a patch from `start` to `end`, whose corners have the normals `own`;
// `across` are those that the neighbour's corners have there, in the same order, or `own` where there is no neighbour.
fn hull_side(
    constants: StageConstants,
    start: vec3<f32>,
    end: vec3<f32>,
    own: SideNormals,
    across: SideNormals,
) -> HullSide {
    // Both directions run the same code, which a compiler then rounds alike.
    let reversed = side_is_reversed(start, end);
    let a = select(start, end, reversed);
    let b = select(end, start, reversed);
    let side_along = along_edge(own, reversed);
    let across_along = along_edge(across, reversed);
    let curve = side_curve(constants.alpha, a, b, side_along, across_along, reversed);
    let factor = written_factor(hull_side_factor(constants, a, b, curve, across_along));
    return HullSide(select(curve.ab, curve.ba, reversed), select(curve.ba, curve.ab, reversed), factor);
}

// Returns whether a patch is left out, because it is out of view or shows only its back.
fn patch_is_left_out(view: LodView, net: ControlNet) -> bool {
    if CHOSEN_CLIP == CLIP_PAPER {
        if patch_is_clipped(view, net) {
            return true;
        }
    }
    if CHOSEN_CLIP == CLIP_FRUSTUM {
        if patch_is_outside(view, net) {
            return true;
        }
    }
    if CHOSEN_CULLING == CULLING_ON {
        return faces_away(view, net);
    }
    return false;
}

// Returns what the hull shader hands to the tessellator: the factors of the edges in the order of the convention, and the one
// inside. `sides` are the factors of the sides 0-1, 1-2 and 2-0. A patch that is left out gets zeros.
fn tessellation_factors(constants: StageConstants, net: ControlNet, sides: vec3<f32>) -> vec4<f32> {
    if CHOSEN_CLIP != CLIP_OFF || CHOSEN_CULLING != CULLING_OFF {
        if patch_is_left_out(constants.view, net) {
            return vec4<f32>(0.0);
        }
    }
    let edges = vec3<f32>(
        sides[factor_side(CHOSEN_CONVENTION, 0u)],
        sides[factor_side(CHOSEN_CONVENTION, 1u)],
        sides[factor_side(CHOSEN_CONVENTION, 2u)],
    );
    if CHOSEN_PARTITIONING == PARTITIONING_ROWS {
        return vec4<f32>(edges, base_factor(edges));
    }
    return vec4<f32>(edges, max(max(sides.x, sides.y), sides.z));
}

// Returns U and V of a domain point in 16.16 fixed point, in which the tessellator computes them (Direct3D 11.3, section
// 11.7). Then t and 1 - t, which an edge's two sides get for the same point, add up to exactly 1.
fn fixed_location(location: vec3<f32>) -> vec2<u32> {
    let u = min(u32(location.x * 65536.0 + 0.5), FIXED_ONE);
    let v = min(u32(location.y * 65536.0 + 0.5), FIXED_ONE - u);
    return vec2<u32>(u, v);
}

// Returns the vertex at `side_t` (16.16 fixed point) on a side of a patch, computed in the direction of its edge.
fn edge_vertex(hull: StagePatch, side: u32, side_t: u32) -> StageVertex {
    let next = (side + 1u) % 3u;
    let reversed = side_is_reversed(hull.net.corners[side], hull.net.corners[next]);
    let start = select(side, next, reversed);
    let end = select(next, side, reversed);
    let t = select(side_t, FIXED_ONE - side_t, reversed);
    let a = hull.net.corners[start];
    let b = hull.net.corners[end];
    let near_a = hull.net.edges[2u * side + u32(reversed)];
    let near_b = hull.net.edges[2u * side + u32(!reversed)];
    let curved = edge_position(CHOSEN_SURFACE, a, near_a, near_b, b, t);
    // The ends are corners of other patches too, whose bits they must have.
    let position = select(select(curved, a, t == 0u), b, t == FIXED_ONE);
    let normal = edge_vertex_normal(a, b, hull.normals[start], hull.normals[end], t);
    return StageVertex(position, normal, edge_uv(hull.uvs[start], hull.uvs[end], t));
}

// Returns the normal at `t` on an edge from `a` to `b`.
fn edge_vertex_normal(a: vec3<f32>, b: vec3<f32>, at_a: vec3<f32>, at_b: vec3<f32>, t: u32) -> vec3<f32> {
    if CHOSEN_NORMALS == NORMALS_QUADRATIC {
        return quadratic_edge_normal(a, b, at_a, at_b, t);
    }
    return edge_normal(at_a, at_b, t);
}

// Returns the vertex of a patch at weights `u` and `v`.
fn inner_vertex(hull: StagePatch, u: u32, v: u32) -> StageVertex {
    return StageVertex(patch_position(CHOSEN_SURFACE, hull.net, u, v), inner_normal(hull, u, v), linear_uv(hull.uvs, u, v));
}

// Returns the normal of a patch at weights `u` and `v`.
fn inner_normal(hull: StagePatch, u: u32, v: u32) -> vec3<f32> {
    if CHOSEN_NORMALS == NORMALS_QUADRATIC {
        return quadratic_normal(hull.net.corners, hull.normals, u, v);
    }
    return linear_normal(hull.normals, u, v);
}

// Returns the vertex of a patch at weights `u` and `v`, which on a side is computed for the edge.
fn shared_vertex(hull: StagePatch, u: u32, v: u32) -> StageVertex {
    if CHOSEN_EDGES == EDGES_AS_PUBLISHED {
        return inner_vertex(hull, u, v);
    }
    let place = outline_place(u, v);
    if place.side < 3u {
        return edge_vertex(hull, place.side, place.t);
    }
    return inner_vertex(hull, u, v);
}

// Returns the vertex at a domain point that the tessellator gives as U and V, in 16.16 fixed point.
fn stage_vertex(hull: StagePatch, domain: vec2<u32>) -> StageVertex {
    let weights = corner_weights(CHOSEN_CONVENTION, domain);
    let made = shared_vertex(hull, weights.x, weights.y);
    if CHOSEN_NORMALS == NORMALS_SURFACE {
        // Each patch's own normal, also on its sides, where neighbours have other normals.
        let own = surface_normal(CHOSEN_SURFACE, hull.net, weights.x, weights.y, made.normal);
        return StageVertex(made.position, own, made.uv);
    }
    return made;
}

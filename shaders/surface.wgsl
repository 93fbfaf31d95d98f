// Control nets, and the evaluation of the surfaces that they define. Twin: src/geometry/tessellate/surface.rs.
//
// Weights follow the PN-AEN white paper: u belongs to corner 0, v to corner 1, w to corner 2. Domain coordinates are
// 16.16 fixed point, FIXED_ONE = 65536.

const UNIT: f32 = 1.0 / 65536.0;

// Returns the point at `t` (16.16 fixed point) on the edge from `a` to `b` with control points `ab` (near a) and `ba`
// (near b), in object units. The arguments must be in the edge's own direction: then all sides do the same arithmetic
// on the same bits, and get the same point.
fn edge_position(surface: u32, a: vec3<f32>, ab: vec3<f32>, ba: vec3<f32>, b: vec3<f32>, t: u32) -> vec3<f32> {
    let y = f32(t) * UNIT;
    let x = f32(FIXED_ONE - t) * UNIT;
    if surface == SURFACE_FLAT {
        return a * x + b * y;
    }
    return a * (x * x * x) + ab * (3.0 * x * x * y) + ba * (3.0 * x * y * y) + b * (y * y * y);
}

// b300 b030 b003; on sides 0, 1 and 2, near their starts and ends, b210 b120, b021 b012, b102 b201; b111.
struct ControlNet {
    corners: array<vec3<f32>, 3>,
    edges: array<vec3<f32>, 6>,
    center: vec3<f32>,
}

// Returns the point of a patch at weights `u` and `v` (16.16 fixed point; w is the rest of 1), in object units (Vlachos
// et al. 2001, equation 1).
fn patch_position(surface: u32, net: ControlNet, u: u32, v: u32) -> vec3<f32> {
    let x = f32(u) * UNIT;
    let y = f32(v) * UNIT;
    let z = f32(FIXED_ONE - u - v) * UNIT;
    if surface == SURFACE_FLAT {
        return net.corners[0] * x + net.corners[1] * y + net.corners[2] * z;
    }
    return net.corners[0] * (x * x * x)
        + net.corners[1] * (y * y * y)
        + net.corners[2] * (z * z * z)
        + net.edges[0] * (3.0 * x * x * y)
        + net.edges[1] * (3.0 * x * y * y)
        + net.edges[2] * (3.0 * y * y * z)
        + net.edges[3] * (3.0 * y * z * z)
        + net.edges[4] * (3.0 * z * z * x)
        + net.edges[5] * (3.0 * z * x * x)
        + net.center * (6.0 * x * y * z);
}

// Returns the derivatives of a patch's position by u and by v (w = 1 - u - v) at weights `u` and `v`: its tangents, in
// object units.
fn patch_tangents(surface: u32, net: ControlNet, u: u32, v: u32) -> array<vec3<f32>, 2> {
    let x = f32(u) * UNIT;
    let y = f32(v) * UNIT;
    let z = f32(FIXED_ONE - u - v) * UNIT;
    if surface == SURFACE_FLAT {
        return array<vec3<f32>, 2>(net.corners[0] - net.corners[2], net.corners[1] - net.corners[2]);
    }
    let b210 = net.edges[0];
    let b120 = net.edges[1];
    let b021 = net.edges[2];
    let b012 = net.edges[3];
    let b102 = net.edges[4];
    let b201 = net.edges[5];
    let b111 = net.center;
    // The derivatives are quadratic Bézier triangles of differences of control points, times 3.
    let xx = 3.0 * x * x;
    let xy = 6.0 * x * y;
    let yy = 3.0 * y * y;
    let yz = 6.0 * y * z;
    let zz = 3.0 * z * z;
    let zx = 6.0 * z * x;
    let along_u = (net.corners[0] - b201) * xx
        + (b210 - b111) * xy
        + (b120 - b021) * yy
        + (b111 - b012) * yz
        + (b102 - net.corners[2]) * zz
        + (b201 - b102) * zx;
    let along_v = (b210 - b201) * xx
        + (b120 - b111) * xy
        + (net.corners[1] - b021) * yy
        + (b021 - b012) * yz
        + (b012 - net.corners[2]) * zz
        + (b111 - b102) * zx;
    return array<vec3<f32>, 2>(along_u, along_v);
}

// Returns the linearly interpolated texture coordinate at weights `u` and `v` of a patch.
fn linear_uv(uvs: array<vec2<f32>, 3>, u: u32, v: u32) -> vec2<f32> {
    return uvs[0] * (f32(u) * UNIT) + uvs[1] * (f32(v) * UNIT) + uvs[2] * (f32(FIXED_ONE - u - v) * UNIT);
}

// Returns the linearly interpolated texture coordinate at `t` (16.16 fixed point) on an edge whose ends have `a` and
// `b`.
fn edge_uv(a: vec2<f32>, b: vec2<f32>, t: u32) -> vec2<f32> {
    return a * (f32(FIXED_ONE - t) * UNIT) + b * (f32(t) * UNIT);
}

// A point on a patch's outline: the side, and the weight of the side's end. Side 3 means inside the patch.
struct OutlinePlace {
    side: u32,
    t: u32,
}

// Returns where the domain point (u, v, w) lies on the patch's outline.
fn outline_place(u: u32, v: u32) -> OutlinePlace {
    let w = FIXED_ONE - u - v;
    if w == 0u {
        return OutlinePlace(0u, v);
    }
    if u == 0u {
        return OutlinePlace(1u, w);
    }
    if v == 0u {
        return OutlinePlace(2u, u);
    }
    return OutlinePlace(3u, 0u);
}

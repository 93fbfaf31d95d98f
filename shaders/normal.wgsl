// Shading normals of emitted vertices. Weights are 16.16 fixed point. Twin: src/geometry/tessellate/normal.rs.

// Weighted sums of unit normals that are shorter than this are rounding errors: the normals cancel.
const CANCELLED: f32 = 1e-6;

// Returns a weighted sum of normals at unit length, or `nearest` (the normal with the greatest weight) if they cancel.
fn unit_or(sum: vec3<f32>, nearest: vec3<f32>) -> vec3<f32> {
    let length_squared = dot(sum, sum);
    return select(nearest, sum * inverseSqrt(length_squared), length_squared > CANCELLED * CANCELLED);
}

// Returns the linearly interpolated unit normal at weights `u` and `v` of a patch, or the normal of the nearest corner
// if the normals cancel.
fn linear_normal(normals: array<vec3<f32>, 3>, u: u32, v: u32) -> vec3<f32> {
    let w = FIXED_ONE - u - v;
    let nearest = select(select(normals[2], normals[1], v >= w), normals[0], u >= v && u >= w);
    return unit_or(normals[0] * (f32(u) * UNIT) + normals[1] * (f32(v) * UNIT) + normals[2] * (f32(w) * UNIT), nearest);
}

// Returns the linearly interpolated unit normal at `t` on an edge whose ends have normals `a` and `b`. The arguments
// must be in the edge's own direction, as for edge_position.
fn edge_normal(a: vec3<f32>, b: vec3<f32>, t: u32) -> vec3<f32> {
    let nearest = select(b, a, 2u * t <= FIXED_ONE);
    return unit_or(a * (f32(FIXED_ONE - t) * UNIT) + b * (f32(t) * UNIT), nearest);
}

// Returns the control normal in the middle of an edge (h110 of Vlachos et al. 2001, section 3.3): the sum of the
// normals at the ends, mirrored in the plane perpendicular to the edge, at unit length. It is `at_a` if the sum
// cancels.
fn middle_normal(a: vec3<f32>, b: vec3<f32>, at_a: vec3<f32>, at_b: vec3<f32>) -> vec3<f32> {
    let along = b - a;
    let size = max(max(abs(along.x), abs(along.y)), abs(along.z));
    let sum = at_a + at_b;
    if size == 0.0 {
        return unit_or(sum, at_a);
    }
    // Scale the edge, so that its square neither underflows nor overflows: only its direction matters.
    let direction = along * (1.0 / size);
    return unit_or(sum - direction * (2.0 * dot(direction, sum) / dot(direction, direction)), at_a);
}

// Returns the quadratically interpolated unit normal at weights `u` and `v` of a patch with these corners (Vlachos et
// al. 2001, section 3.3), or the linearly interpolated one if the sum cancels.
fn quadratic_normal(corners: array<vec3<f32>, 3>, normals: array<vec3<f32>, 3>, u: u32, v: u32) -> vec3<f32> {
    let x = f32(u) * UNIT;
    let y = f32(v) * UNIT;
    let z = f32(FIXED_ONE - u - v) * UNIT;
    let sum = normals[0] * (x * x)
        + normals[1] * (y * y)
        + normals[2] * (z * z)
        + middle_normal(corners[0], corners[1], normals[0], normals[1]) * (x * y)
        + middle_normal(corners[1], corners[2], normals[1], normals[2]) * (y * z)
        + middle_normal(corners[2], corners[0], normals[2], normals[0]) * (z * x);
    return unit_or(sum, linear_normal(normals, u, v));
}

// Returns the quadratically interpolated unit normal at `t` on the edge from `a` to `b`. The arguments must be in the
// edge's own direction, as for edge_position.
fn quadratic_edge_normal(a: vec3<f32>, b: vec3<f32>, at_a: vec3<f32>, at_b: vec3<f32>, t: u32) -> vec3<f32> {
    let x = f32(FIXED_ONE - t) * UNIT;
    let y = f32(t) * UNIT;
    let sum = at_a * (x * x) + middle_normal(a, b, at_a, at_b) * (x * y) + at_b * (y * y);
    return unit_or(sum, edge_normal(at_a, at_b, t));
}

// Returns the unit normal of a surface with these tangents along u and v, or `otherwise` if they are parallel or one is
// zero.
fn facing_or(tangents: array<vec3<f32>, 2>, otherwise: vec3<f32>) -> vec3<f32> {
    let along_u = tangents[0];
    let along_v = tangents[1];
    let size_u = max(max(abs(along_u.x), abs(along_u.y)), abs(along_u.z));
    let size_v = max(max(abs(along_v.x), abs(along_v.y)), abs(along_v.z));
    if size_u == 0.0 || size_v == 0.0 {
        return otherwise;
    }
    return unit_or(cross(along_u * (1.0 / size_u), along_v * (1.0 / size_v)), otherwise);
}

// Returns the unit normal of the surface itself at weights `u` and `v`, or `otherwise` where it has none.
fn surface_normal(surface: u32, net: ControlNet, u: u32, v: u32, otherwise: vec3<f32>) -> vec3<f32> {
    return facing_or(patch_tangents(surface, net, u, v), otherwise);
}

// Control points of cubic patches, computed from the positions and normals at the ends of their edges. Twin:
// src/geometry/tessellate/control_points.rs, which gives the formulas' derivations.

// Two unit normals count as parallel or opposite if the squared length of their cross product is at most this: the
// squared sine of 0.1 degrees. Below it, rounding would decide in which line their tangent planes intersect.
const PARALLEL: f32 = 3.046e-6;

// Returns the control point near `a` of a PN triangle's edge: the point one third of the way from `a` to `b`, projected
// into the tangent plane at `a` (Vlachos et al. 2001, section 3.1: b210 = (2 P1 + P2 - w12 N1) / 3). `normal` is the
// unit normal at `a`.
fn edge_control_point(a: vec3<f32>, b: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    return (a * 2.0 + b - normal * dot(b - a, normal)) * (1.0 / 3.0);
}

// Returns the control point near `a` of a straight edge: the point one third of the way from `a` to `b`.
fn straight_control_point(a: vec3<f32>, b: vec3<f32>) -> vec3<f32> {
    return (a * 2.0 + b) * (1.0 / 3.0);
}

// Returns the middle control point of a quadratic edge of Phong tessellation (Boubekeur and Alexa 2008, equations 2 to
// 4). `at_a` and `at_b` are the unit normals at the ends.
fn phong_control_point(alpha: f32, a: vec3<f32>, b: vec3<f32>, at_a: vec3<f32>, at_b: vec3<f32>) -> vec3<f32> {
    let along = b - a;
    let back = at_a * dot(along, at_a) - at_b * dot(along, at_b);
    return (a + b - back * alpha) * 0.5;
}

// Returns the middle control point of a quadratic edge of Nagata's patch (Nagata 2005). `at_a` and `at_b` are the unit
// normals at the ends. Where they are parallel or opposite, the edge is straight.
fn nagata_control_point(a: vec3<f32>, b: vec3<f32>, at_a: vec3<f32>, at_b: vec3<f32>) -> vec3<f32> {
    let line = cross(at_a, at_b);
    if dot(line, line) <= PARALLEL {
        return (a + b) * 0.5;
    }
    let along = b - a;
    let sum = (at_a + at_b) * 0.5;
    let difference = (at_a - at_b) * 0.5;
    let long = length(sum);
    let short = length(difference);
    let curvature = sum / long * (dot(along, difference) / long) + difference / short * (dot(along, sum) / short);
    return (a + b - curvature) * 0.5;
}

// Returns the cubic control point near `a` of a quadratic edge whose middle control point is `middle`, by degree
// elevation.
fn elevated_control_point(a: vec3<f32>, middle: vec3<f32>) -> vec3<f32> {
    return (a + middle * 2.0) * (1.0 / 3.0);
}

// Returns the control points near `a` and near `b` that one side of an edge proposes. `at_a` and `at_b` are the side's
// own unit normals at the ends; `alpha` is the strength of Phong tessellation, which other surfaces ignore.
fn side_control_points(
    surface: u32,
    alpha: f32,
    a: vec3<f32>,
    b: vec3<f32>,
    at_a: vec3<f32>,
    at_b: vec3<f32>,
) -> array<vec3<f32>, 2> {
    if surface == SURFACE_FLAT {
        return array<vec3<f32>, 2>(straight_control_point(a, b), straight_control_point(b, a));
    }
    if surface == SURFACE_PHONG || surface == SURFACE_PHONG_AEN {
        let middle = phong_control_point(alpha, a, b, at_a, at_b);
        return array<vec3<f32>, 2>(elevated_control_point(a, middle), elevated_control_point(b, middle));
    }
    if surface == SURFACE_NAGATA || surface == SURFACE_NAGATA_AEN {
        let middle = nagata_control_point(a, b, at_a, at_b);
        return array<vec3<f32>, 2>(elevated_control_point(a, middle), elevated_control_point(b, middle));
    }
    return array<vec3<f32>, 2>(edge_control_point(a, b, at_a), edge_control_point(b, a, at_b));
}

// The distinct normals that the sides of an edge have at one of its ends. Only the first two are stored.
struct DistinctNormals {
    first: vec3<f32>,
    second: vec3<f32>,
    // 0, 1, 2, or 3 for three or more.
    count: u32,
}

// Adds the normal of one more side.
fn add_normal(distinct: DistinctNormals, normal: vec3<f32>) -> DistinctNormals {
    if distinct.count == 0u {
        return DistinctNormals(normal, normal, 1u);
    }
    if all(normal == distinct.first) || all(normal == distinct.second) {
        return distinct;
    }
    if distinct.count == 1u {
        return DistinctNormals(distinct.first, normal, 2u);
    }
    return DistinctNormals(distinct.first, distinct.second, 3u);
}

// Returns the control point near `a` of an edge on which two surfaces meet at a crease: the control point of a straight
// edge, projected onto the line in which the two tangent planes at `a` intersect (Vlachos et al. 2001, section 3.4).
// `mean` is the mean of all sides' proposals; it is returned if the planes are parallel or if there are not two of
// them.
fn crease_control_point(a: vec3<f32>, b: vec3<f32>, distinct: DistinctNormals, mean: vec3<f32>) -> vec3<f32> {
    let line = cross(distinct.first, distinct.second);
    let length_squared = dot(line, line);
    if distinct.count != 2u || length_squared <= PARALLEL {
        return mean;
    }
    // The square of a short line's length is too small to divide by: large edges would overflow.
    let direction = line / sqrt(length_squared);
    return a + direction * (dot(b - a, direction) * (1.0 / 3.0));
}

// Returns the control point b111 of a net with these corners and six edge control points: E + (E - V) / 2, where E is
// the mean of the edge control points and V is the mean of the corners (Vlachos et al. 2001, section 3.1).
fn center_control_point(corners: array<vec3<f32>, 3>, edges: array<vec3<f32>, 6>) -> vec3<f32> {
    let e = (edges[0] + edges[1] + edges[2] + edges[3] + edges[4] + edges[5]) * (1.0 / 6.0);
    let v = (corners[0] + corners[1] + corners[2]) * (1.0 / 3.0);
    return e + (e - v) * 0.5;
}

// Where a surface's control points lie, given what an edge's ends look like. Twin: src/tessellate/control_points.rs.

// The squared sine of 0.1 degrees.
const PARALLEL: f32 = 3.046e-6;

// b210 = (2 P1 + P2 - w12 N1) / 3 (Vlachos et al. 2001, section 3.1).
fn edge_control_point(a: vec3<f32>, b: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    return (a * 2.0 + b - normal * dot(b - a, normal)) * (1.0 / 3.0);
}

fn straight_control_point(a: vec3<f32>, b: vec3<f32>) -> vec3<f32> {
    return (a * 2.0 + b) * (1.0 / 3.0);
}

// Boubekeur and Alexa 2008, equations 2 to 4.
fn phong_control_point(alpha: f32, a: vec3<f32>, b: vec3<f32>, at_a: vec3<f32>, at_b: vec3<f32>) -> vec3<f32> {
    let along = b - a;
    let back = at_a * dot(along, at_a) - at_b * dot(along, at_b);
    return (a + b - back * alpha) * 0.5;
}

// Nagata 2005, by lengths: their squares are too small to divide what is vast by.
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

fn raised_control_point(a: vec3<f32>, middle: vec3<f32>) -> vec3<f32> {
    return (a + middle * 2.0) * (1.0 / 3.0);
}

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
        return array<vec3<f32>, 2>(raised_control_point(a, middle), raised_control_point(b, middle));
    }
    if surface == SURFACE_NAGATA || surface == SURFACE_NAGATA_AEN {
        let middle = nagata_control_point(a, b, at_a, at_b);
        return array<vec3<f32>, 2>(raised_control_point(a, middle), raised_control_point(b, middle));
    }
    return array<vec3<f32>, 2>(edge_control_point(a, b, at_a), edge_control_point(b, a, at_b));
}

// The different normals that an edge's sides have at one of its ends, as far as two.
struct Meeting {
    first: vec3<f32>,
    second: vec3<f32>,
    count: u32,
}

fn meet(meeting: Meeting, normal: vec3<f32>) -> Meeting {
    if meeting.count == 0u {
        return Meeting(normal, normal, 1u);
    }
    if all(normal == meeting.first) || all(normal == meeting.second) {
        return meeting;
    }
    if meeting.count == 1u {
        return Meeting(meeting.first, normal, 2u);
    }
    return Meeting(meeting.first, meeting.second, 3u);
}

// Vlachos et al. 2001, section 3.4.
fn crease_control_point(a: vec3<f32>, b: vec3<f32>, meeting: Meeting, mean: vec3<f32>) -> vec3<f32> {
    let line = cross(meeting.first, meeting.second);
    let length_squared = dot(line, line);
    if meeting.count != 2u || length_squared <= PARALLEL {
        return mean;
    }
    // By the line's own length: its square is too small to divide what is vast by.
    let direction = line / sqrt(length_squared);
    return a + direction * (dot(b - a, direction) * (1.0 / 3.0));
}

// b111 = E + (E - V) / 2 (Vlachos et al. 2001, section 3.1).
fn center_control_point(corners: array<vec3<f32>, 3>, edges: array<vec3<f32>, 6>) -> vec3<f32> {
    let e = (edges[0] + edges[1] + edges[2] + edges[3] + edges[4] + edges[5]) * (1.0 / 6.0);
    let v = (corners[0] + corners[1] + corners[2]) * (1.0 / 3.0);
    return e + (e - v) * 0.5;
}

// Control nets and the surfaces they make. Twin: src/tessellate/surface.rs.
//
// Weights follow the PN-AEN white paper: u belongs to corner 0, v to corner 1, w to corner 2.
// Domain coordinates are 16.16 fixed point, FIXED_ONE = 65536.

const UNIT: f32 = 1.0 / 65536.0;

const SURFACE_FLAT: u32 = 0u;
const SURFACE_PN: u32 = 1u;
const SURFACE_PN_AEN: u32 = 2u;

// b210 = (2 P1 + P2 - w12 N1) / 3 (Vlachos et al. 2001, section 3.1).
fn edge_control_point(a: vec3<f32>, b: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    return (a * 2.0 + b - normal * dot(b - a, normal)) * (1.0 / 3.0);
}

fn straight_control_point(a: vec3<f32>, b: vec3<f32>) -> vec3<f32> {
    return (a * 2.0 + b) * (1.0 / 3.0);
}

// b111 = E + (E - V) / 2 (Vlachos et al. 2001, section 3.1).
fn center_control_point(corners: array<vec3<f32>, 3>, edges: array<vec3<f32>, 6>) -> vec3<f32> {
    let e = (edges[0] + edges[1] + edges[2] + edges[3] + edges[4] + edges[5]) * (1.0 / 6.0);
    let v = (corners[0] + corners[1] + corners[2]) * (1.0 / 3.0);
    return e + (e - v) * 0.5;
}

// Called in the edge's own direction only: the two sides then run one computation on the same bits.
fn edge_position(surface: u32, a: vec3<f32>, ab: vec3<f32>, ba: vec3<f32>, b: vec3<f32>, t: u32) -> vec3<f32> {
    let y = f32(t) * UNIT;
    let x = f32(FIXED_ONE - t) * UNIT;
    if surface == SURFACE_FLAT {
        return a * x + b * y;
    }
    return a * (x * x * x) + ab * (3.0 * x * x * y) + ba * (3.0 * x * y * y) + b * (y * y * y);
}

struct ControlNet {
    corners: array<vec3<f32>, 3>,
    edges: array<vec3<f32>, 6>,
    center: vec3<f32>,
}

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

const CANCELLED: f32 = 1e-6;

// A weighted sum of normals at unit length, or the one with the greatest weight where they cancel.
fn unit_or(sum: vec3<f32>, nearest: vec3<f32>) -> vec3<f32> {
    let length_squared = dot(sum, sum);
    return select(nearest, sum * (1.0 / sqrt(length_squared)), length_squared > CANCELLED * CANCELLED);
}

fn linear_normal(normals: array<vec3<f32>, 3>, u: u32, v: u32) -> vec3<f32> {
    let w = FIXED_ONE - u - v;
    let nearest = select(select(normals[2], normals[1], v >= w), normals[0], u >= v && u >= w);
    return unit_or(normals[0] * (f32(u) * UNIT) + normals[1] * (f32(v) * UNIT) + normals[2] * (f32(w) * UNIT), nearest);
}

// Called in the edge's own direction only.
fn edge_normal(a: vec3<f32>, b: vec3<f32>, t: u32) -> vec3<f32> {
    let nearest = select(b, a, 2u * t <= FIXED_ONE);
    return unit_or(a * (f32(FIXED_ONE - t) * UNIT) + b * (f32(t) * UNIT), nearest);
}

// Octahedral, two signed normalised 16-bit numbers (Cigolle et al. 2014, section 3).
fn pack_normal(normal: vec3<f32>) -> u32 {
    let flat = normal / (abs(normal.x) + abs(normal.y) + abs(normal.z));
    let folded = (1.0 - abs(flat.yx)) * vec2<f32>(toward(flat.x), toward(flat.y));
    return pack2x16snorm(select(flat.xy, folded, flat.z < 0.0));
}

fn unpack_normal(bits: u32) -> vec3<f32> {
    let at = unpack2x16snorm(bits);
    let z = 1.0 - abs(at.x) - abs(at.y);
    let back = max(-z, 0.0);
    return normalize(vec3<f32>(at.x - toward(at.x) * back, at.y - toward(at.y) * back, z));
}

fn toward(x: f32) -> f32 {
    return select(-1.0, 1.0, x >= 0.0);
}

fn linear_uv(uvs: array<vec2<f32>, 3>, u: u32, v: u32) -> vec2<f32> {
    return uvs[0] * (f32(u) * UNIT) + uvs[1] * (f32(v) * UNIT) + uvs[2] * (f32(FIXED_ONE - u - v) * UNIT);
}

fn edge_uv(a: vec2<f32>, b: vec2<f32>, t: u32) -> vec2<f32> {
    return a * (f32(FIXED_ONE - t) * UNIT) + b * (f32(t) * UNIT);
}

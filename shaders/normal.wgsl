// Normals that a surface is shaded with. Twin: src/tessellate/normal.rs.

const NORMALS_LINEAR: u32 = 0u;
const NORMALS_QUADRATIC: u32 = 1u;
const NORMALS_SURFACE: u32 = 2u;

const CANCELLED: f32 = 1e-6;

// A weighted sum of normals at unit length, or the one with the greatest weight where they cancel.
fn unit_or(sum: vec3<f32>, nearest: vec3<f32>) -> vec3<f32> {
    let length_squared = dot(sum, sum);
    return select(nearest, sum * inverseSqrt(length_squared), length_squared > CANCELLED * CANCELLED);
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

// h110 and so on, unit length (Vlachos et al. 2001, section 3.3).
fn middle_normal(a: vec3<f32>, b: vec3<f32>, at_a: vec3<f32>, at_b: vec3<f32>) -> vec3<f32> {
    let along = b - a;
    let size = max(max(abs(along.x), abs(along.y)), abs(along.z));
    let sum = at_a + at_b;
    if size == 0.0 {
        return unit_or(sum, at_a);
    }
    let direction = along * (1.0 / size);
    return unit_or(sum - direction * (2.0 * dot(direction, sum) / dot(direction, direction)), at_a);
}

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

// Called in the edge's own direction only.
fn quadratic_edge_normal(a: vec3<f32>, b: vec3<f32>, at_a: vec3<f32>, at_b: vec3<f32>, t: u32) -> vec3<f32> {
    let x = f32(FIXED_ONE - t) * UNIT;
    let y = f32(t) * UNIT;
    let sum = at_a * (x * x) + middle_normal(a, b, at_a, at_b) * (x * y) + at_b * (y * y);
    return unit_or(sum, edge_normal(at_a, at_b, t));
}

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

fn surface_normal(surface: u32, net: ControlNet, u: u32, v: u32, otherwise: vec3<f32>) -> vec3<f32> {
    return facing_or(patch_tangents(surface, net, u, v), otherwise);
}

// Octahedral, two signed normalised 16-bit numbers (Cigolle et al. 2014, section 3).
fn pack_normal(normal: vec3<f32>) -> u32 {
    let flat = normal * (1.0 / (abs(normal.x) + abs(normal.y) + abs(normal.z)));
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

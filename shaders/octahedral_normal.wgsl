// Unit normals in 32 bits. Twin: src/geometry/tessellate/octahedral_normal.rs.

// Packs a unit normal into 32 bits: octahedral, two signed normalised 16-bit numbers (Cigolle et al. 2014, section 3).
// The error is less than 0.004 degrees.
fn pack_normal(normal: vec3<f32>) -> u32 {
    let flat = normal * (1.0 / (abs(normal.x) + abs(normal.y) + abs(normal.z)));
    let folded = (1.0 - abs(flat.yx)) * vec2<f32>(sign_not_zero(flat.x), sign_not_zero(flat.y));
    return pack2x16snorm(select(flat.xy, folded, flat.z < 0.0));
}

// Returns the unit normal that was packed.
fn unpack_normal(bits: u32) -> vec3<f32> {
    let at = unpack2x16snorm(bits);
    let z = 1.0 - abs(at.x) - abs(at.y);
    let back = max(-z, 0.0);
    return normalize(vec3<f32>(at.x - sign_not_zero(at.x) * back, at.y - sign_not_zero(at.y) * back, z));
}

// Returns 1 for zero and positive numbers, else -1.
fn sign_not_zero(x: f32) -> f32 {
    return select(-1.0, 1.0, x >= 0.0);
}

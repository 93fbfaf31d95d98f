//! Unit normals in 32 bits. Twin: `shaders/octahedral_normal.wgsl`.

use glam::{Vec2, Vec3, vec2, vec3};

/// Packs a unit normal into 32 bits: octahedral, two signed normalised 16-bit numbers (Cigolle et al. 2014, section 3).
/// The error is less than 0.004 degrees.
pub fn pack_normal(normal: Vec3) -> u32 {
    let flat = normal * (1.0 / (normal.x.abs() + normal.y.abs() + normal.z.abs()));
    let folded = (Vec2::ONE - vec2(flat.y.abs(), flat.x.abs())) * vec2(sign_not_zero(flat.x), sign_not_zero(flat.y));
    let [x, y] = if flat.z < 0.0 { folded } else { flat.truncate() }.to_array();
    let bits = |x: f32| u32::from((0.5 + 32767.0 * x.clamp(-1.0, 1.0)).floor() as i16 as u16);
    bits(x) | bits(y) << 16
}

/// Returns the unit normal that was packed.
pub fn unpack_normal(bits: u32) -> Vec3 {
    let number = |bits: u32| (f32::from(bits as u16 as i16) / 32767.0).max(-1.0);
    let at = vec2(number(bits), number(bits >> 16));
    let z = 1.0 - at.x.abs() - at.y.abs();
    let back = (-z).max(0.0);
    vec3(at.x - sign_not_zero(at.x) * back, at.y - sign_not_zero(at.y) * back, z).normalize()
}

/// Returns 1 for zero and positive numbers, else -1.
fn sign_not_zero(x: f32) -> f32 {
    if x >= 0.0 { 1.0 } else { -1.0 }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn a_packed_normal_is_nearly_itself(x in -1f32..1.0, y in -1f32..1.0, z in -1f32..1.0) {
            let Some(normal) = vec3(x, y, z).try_normalize() else { return Ok(()) };
            let sine = normal.cross(unpack_normal(pack_normal(normal))).length();
            prop_assert!(sine.asin().to_degrees() < 0.004, "{}", sine);
        }
    }

    #[test]
    fn axes_are_packed_exactly() {
        for axis in Vec3::AXES {
            assert_eq!(unpack_normal(pack_normal(axis)), axis);
            assert_eq!(unpack_normal(pack_normal(-axis)), -axis);
        }
    }
}

//! Tells coordinates that were rounded to 16-bit floating-point numbers, as vertex buffers of engines often are.

use half::f16;

use super::OurTessellation;
use super::foreign::ForeignMesh;
use geometry::mesh::Bounds;

/// Half a unit in the last place of their largest coordinate as a number of 16 bits, in our object units. `None` if some of their
/// coordinates have more bits, or if all of ours have as few.
pub(super) fn resolution(theirs: &ForeignMesh, ours: &OurTessellation) -> Option<f64> {
    let is_rounded = |position: &glam::Vec3| position.to_array().into_iter().all(has_16_bits);
    let emitted = ours.emitted_positions();
    if !theirs.positions.iter().all(is_rounded) || emitted.iter().all(is_rounded) {
        return None;
    }
    let [own, bounds] = [Bounds::new(emitted.into_iter()), theirs.bounds()];
    let largest = bounds.min.abs().max(bounds.max.abs()).max_element();
    let unit = f64::from(largest.max(f16::MIN_POSITIVE.to_f32())).log2().floor().exp2() / 1024.0;
    // Their units may be others than ours.
    let scale = f64::from(own.diagonal()) / f64::from(bounds.diagonal());
    Some(0.5 * unit * scale).filter(|resolution| resolution.is_finite())
}

/// Whether a number is one of 16 bits (IEEE 754-2019, binary16).
fn has_16_bits(number: f32) -> bool {
    number.is_finite() && f16::from_f32(number).to_f32() == number
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_16_bits_are_told_from_others() {
        for number in [0.0, -0.0, 1.0, 0.333_251_95, -65504.0, 6.1035156e-5, 5.9604645e-8, 1.7881393e-7, 2049.0 - 1.0] {
            assert!(has_16_bits(number), "{number}");
        }
        for number in [0.333_333_34, 65505.0, 1e6, 5.9e-8, 9e-8, 2049.0, f32::INFINITY, f32::NAN] {
            assert!(!has_16_bits(number), "{number}");
        }
    }
}

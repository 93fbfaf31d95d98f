//! Deviation on the device: the distances to a reference surface, and the colour scales for them.

use super::Scale;
use super::scale::hex_colors;
use crate::measure::DeviationField;
use gpu::{Gpu, uniform_buffer};

/// The distances from what is emitted to the reference surface.
pub(super) struct Deviations {
    /// One buffer for each chunk: see `deviations` in `shaders/draw_surface_inputs.wgsl`.
    pub(super) chunks: Vec<wgpu::Buffer>,
    /// The colour scale, in object units.
    pub(super) scale: Scale,
    /// The tessellation that was measured: see [`gpu::Tessellator::generation`].
    pub(super) of: u64,
}

impl Deviations {
    pub(super) fn new(gpu: &Gpu, field: &DeviationField, scale: Scale, of: u64) -> Self {
        // Shaders can't detect NaN on every device, so -1 stands for it.
        let known = |sample: &f32| if sample.is_nan() { -1.0 } else { *sample };
        let buffer = |samples: &Vec<f32>| {
            let contents: Vec<f32> = [field.steps as f32].into_iter().chain(samples.iter().map(known)).collect();
            uniform_buffer(gpu, "deviation", bytemuck::cast_slice(&contents))
        };
        Self { chunks: field.chunks.iter().map(buffer).collect(), scale, of }
    }
}

/// The scale for distances on screen, in px. It is plasma (Smith and van der Walt 2015, CC0) from 2 to 8 ninths: its lightness
/// grows evenly, its hues differ from those for factors and sizes, and the dark end is left out, since dark lines would vanish
/// on it.
pub const DEVIATION_PX_SCALE: Scale = Scale {
    least: 0.1,
    most: 10.0,
    colors: hex_colors([0x7201a8, 0x9c179e, 0xbd3786, 0xd8576b, 0xed7953, 0xfb9f3a, 0xfdca26]),
};

/// The greatest value of a scale divided by the least: two decades. Most of a surface deviates by at least a tenth of the
/// largest deviation, and would have a single colour on a longer scale.
const SPAN: f64 = 100.0;

/// The scale for distances in object units up to `largest`, which is rounded up. It starts at `ulp` (one unit in the last place
/// of the mesh's largest coordinate) or above.
pub fn deviation_scale(largest: f64, ulp: f32) -> Scale {
    const ROUND: [f64; 9] = [1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0];
    let largest = largest.max(f64::from(ulp) * SPAN).max(f64::from(f32::MIN_POSITIVE) * SPAN * 10.0);
    let decade = 10.0_f64.powf(largest.log10().floor());
    let most = ROUND.iter().map(|round| round * decade).find(|most| *most >= largest).unwrap_or(10.0 * decade);
    Scale { least: (most / SPAN) as f32, most: most as f32, ..DEVIATION_PX_SCALE }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_end_at_round_numbers_and_hold_the_largest_distance() {
        let ends = |largest| {
            let Scale { least, most, .. } = deviation_scale(largest, 1e-7);
            (least, most)
        };
        assert_eq!(ends(0.2053), (0.0025, 0.25));
        assert_eq!(ends(0.1), (0.001, 0.1));
        assert_eq!(ends(8.1), (0.1, 10.0));
        assert_eq!(ends(123.0), (1.5, 150.0));
        assert_eq!(ends(0.0), ends(1e-5), "no colour for rounding errors");
        assert!(deviation_scale(0.0, 0.0).least > 0.0);
    }
}

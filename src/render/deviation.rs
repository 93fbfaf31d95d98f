//! Distances to the truth on the device, and the scales that they are read against.

use wgpu::util::DeviceExt;

use super::Scale;
use super::scale::FACTOR_SCALE;
use crate::gpu::Gpu;
use crate::measure::DeviationField;
use crate::settings::{Colors, DeviationUnit, Settings};

/// How far what is emitted is from the truth.
pub(super) struct Deviations {
    /// One a chunk: see `deviations` in `shaders/draw_surface.wgsl`.
    pub(super) chunks: Vec<wgpu::Buffer>,
    /// In object units.
    pub(super) scale: Scale,
    /// Which tessellation it is about: see [`crate::gpu::Tessellator::generation`].
    pub(super) of: u64,
}

impl Deviations {
    pub(super) fn new(gpu: &Gpu, field: &DeviationField, scale: Scale, of: u64) -> Self {
        // What is no number can't be told from others on every device.
        let known = |sample: &f32| if sample.is_nan() { -1.0 } else { *sample };
        let buffer = |samples: &Vec<f32>| {
            let contents: Vec<f32> = [field.steps as f32].into_iter().chain(samples.iter().map(known)).collect();
            buffer(gpu, &contents)
        };
        Self { chunks: field.chunks.iter().map(buffer).collect(), scale, of }
    }

    /// What is bound where nothing is known: no samples.
    pub(super) fn unknown(gpu: &Gpu) -> wgpu::Buffer {
        buffer(gpu, &[0.0])
    }
}

fn buffer(gpu: &Gpu, contents: &[f32]) -> wgpu::Buffer {
    gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: Some("deviation"),
        contents: bytemuck::cast_slice(contents),
        usage: wgpu::BufferUsages::STORAGE,
    })
}

/// Distances on screen in px. Plasma (Smith and van der Walt 2015, CC0) from 2 to 8 ninths: evenly lighter to the eye, in
/// hues that neither factors nor sizes have, and without the end that lines couldn't be told from.
pub(crate) const DEVIATION_PX_SCALE: Scale = Scale {
    least: 0.1,
    most: 10.0,
    colors: [
        [0x72, 0x01, 0xa8],
        [0x9c, 0x17, 0x9e],
        [0xbd, 0x37, 0x86],
        [0xd8, 0x57, 0x6b],
        [0xed, 0x79, 0x53],
        [0xfb, 0x9f, 0x3a],
        [0xfd, 0xca, 0x26],
    ],
};

/// From the least to the most, as a ratio: two decades. Most of a surface is within one of its worst place, and would be of
/// one colour on a longer scale.
const SPAN: f64 = 100.0;

/// The scale for distances in object units up to `largest`, which is rounded up; nothing below `ulp`, one unit in the last
/// place, is worth a colour.
pub(crate) fn deviation_scale(largest: f64, ulp: f32) -> Scale {
    const ROUND: [f64; 9] = [1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0];
    let largest = largest.max(f64::from(ulp) * SPAN).max(f64::from(f32::MIN_POSITIVE) * SPAN * 10.0);
    let decade = 10.0_f64.powf(largest.log10().floor());
    let most = ROUND.iter().map(|round| round * decade).find(|most| *most >= largest).unwrap_or(10.0 * decade);
    Scale { least: (most / SPAN) as f32, most: most as f32, ..DEVIATION_PX_SCALE }
}

/// The scale that a picture's numbers are read against; where its colours are none, any.
pub(super) fn scale_of(settings: &Settings, known: Option<&Deviations>) -> Scale {
    match (settings.overlays.colors, settings.deviation_in) {
        (Colors::Deviation, DeviationUnit::Units) => known.map_or(DEVIATION_PX_SCALE, |known| known.scale),
        (Colors::Deviation, DeviationUnit::Px) => DEVIATION_PX_SCALE,
        (colors, _) => *Scale::of(colors).unwrap_or(&FACTOR_SCALE),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_are_round_and_hold_the_largest() {
        let ends = |largest| {
            let Scale { least, most, .. } = deviation_scale(largest, 1e-7);
            (least, most)
        };
        assert_eq!(ends(0.2053), (0.0025, 0.25));
        assert_eq!(ends(0.1), (0.001, 0.1));
        assert_eq!(ends(8.1), (0.1, 10.0));
        assert_eq!(ends(123.0), (1.5, 150.0));
        assert_eq!(ends(0.0), ends(1e-5), "rounding alone is no deviation");
        assert!(deviation_scale(0.0, 0.0).least > 0.0);
    }
}

//! Scales of colours: what a number over the surface looks like, for shaders and legends alike.

use crate::measure::SMALL_PX;
use crate::settings::Colors;

/// Colours from a least to a most, evenly spaced on a logarithmic scale. What lies beyond looks as the end does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    pub least: f32,
    pub most: f32,
    /// sRGB, from the least to the most.
    pub colors: [[u8; 3]; Scale::STOPS],
}

/// Tessellation factors, a colour each power of two. The upper six eighths of viridis (Smith and van der Walt 2015, CC0):
/// evenly lighter to the eye with any colour vision, and without the end that lines couldn't be told from.
pub(crate) const FACTOR_SCALE: Scale = Scale {
    least: 1.0,
    most: 64.0,
    colors: [
        [0x3b, 0x52, 0x8b],
        [0x2c, 0x72, 0x8e],
        [0x21, 0x91, 0x8c],
        [0x28, 0xae, 0x80],
        [0x5e, 0xc9, 0x62],
        [0xad, 0xdc, 0x30],
        [0xfd, 0xe7, 0x25],
    ],
};

/// Sizes of triangles in px: blue, which nobody confuses with [`super::layout::WASTE_COLOR`], darker the larger.
pub(crate) const SIZE_SCALE: Scale = Scale {
    least: SMALL_PX as f32,
    most: 64.0,
    colors: [
        [0xe4, 0xee, 0xf6],
        [0xcb, 0xde, 0xee],
        [0xae, 0xcb, 0xe3],
        [0x8f, 0xb5, 0xd6],
        [0x70, 0x9d, 0xc6],
        [0x55, 0x84, 0xb2],
        [0x3d, 0x6a, 0x9b],
    ],
};

impl Scale {
    pub const STOPS: usize = 7;

    /// The scale that colours are read against, if they are numbers and it is always the same.
    pub fn of(colors: Colors) -> Option<&'static Self> {
        match colors {
            Colors::Factors => Some(&FACTOR_SCALE),
            Colors::TriangleSize => Some(&SIZE_SCALE),
            Colors::Material | Colors::Barycentric | Colors::LowFactors | Colors::Deviation => None,
        }
    }

    /// Where a number lies between the least (0) and the most (1).
    pub fn place(&self, number: f32) -> f32 {
        ((number / self.least).ln() / (self.most / self.least).ln()).clamp(0.0, 1.0)
    }

    /// The sRGB colour at a place; `scale_color` in `shaders/draw_surface.wgsl` does the same.
    pub fn color(&self, place: f32) -> [u8; 3] {
        let at = place.clamp(0.0, 1.0) * (Self::STOPS - 1) as f32;
        let below = (at as usize).min(Self::STOPS - 2);
        let share = at - below as f32;
        [0, 1, 2].map(|c| {
            let [low, high] = [below, below + 1].map(|stop| f32::from(self.colors[stop][c]));
            (low + (high - low) * share).round() as u8
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::DEVIATION_PX_SCALE;
    use super::super::layout::linear;
    use super::*;

    #[test]
    fn powers_of_two_have_the_colours_of_the_stops() {
        for (stop, factor) in [1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0].into_iter().enumerate() {
            assert_eq!(FACTOR_SCALE.color(FACTOR_SCALE.place(factor)), FACTOR_SCALE.colors[stop], "{factor}");
        }
        assert_eq!(SIZE_SCALE.color(SIZE_SCALE.place(0.5)), SIZE_SCALE.colors[0], "below the least");
        assert_eq!(SIZE_SCALE.color(SIZE_SCALE.place(1000.0)), SIZE_SCALE.colors[6], "beyond the most");
    }

    #[test]
    fn scales_are_ordered_by_lightness() {
        let luminance = |rgb: [u8; 3]| {
            let [r, g, b] = linear(rgb);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        let steps = |scale: &Scale| scale.colors.map(luminance);
        assert!(steps(&FACTOR_SCALE).windows(2).all(|pair| pair[0] * 1.15 < pair[1]), "{:?}", steps(&FACTOR_SCALE));
        let rising = steps(&DEVIATION_PX_SCALE);
        assert!(rising.windows(2).all(|pair| pair[0] * 1.15 < pair[1]), "{rising:?}");
        assert!(steps(&SIZE_SCALE).windows(2).all(|pair| pair[0] > pair[1] * 1.15), "{:?}", steps(&SIZE_SCALE));
    }
}

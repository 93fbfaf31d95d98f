//! Colour scales: the colours of numbers over the surface, for shaders and legends.

use crate::measure::SMALL_PX;

/// A colour scale. Its colours are evenly spaced: on a logarithmic scale, or on an even one if that has numbers below 0. Numbers
/// beyond an end have the colour of that end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    pub least: f32,
    pub most: f32,
    /// sRGB, from the least to the most.
    pub colors: [[u8; 3]; Scale::STOPS],
}

/// Colours from their hexadecimal numbers, whose first two digits are red.
pub(super) const fn hex_colors(numbers: [u32; Scale::STOPS]) -> [[u8; 3]; Scale::STOPS] {
    let mut colors = [[0; 3]; Scale::STOPS];
    let mut stop = 0;
    while stop < Scale::STOPS {
        let [_, red, green, blue] = numbers[stop].to_be_bytes();
        colors[stop] = [red, green, blue];
        stop += 1;
    }
    colors
}

/// The scale for tessellation factors, with a colour for each power of two. It is the upper six eighths of viridis (Smith and
/// van der Walt 2015, CC0): its lightness grows evenly for any colour vision, and the dark end is left out, since dark lines
/// would vanish on it.
pub const FACTOR_SCALE: Scale = Scale {
    least: 1.0,
    most: 64.0,
    colors: hex_colors([0x3b528b, 0x2c728e, 0x21918c, 0x28ae80, 0x5ec962, 0xaddc30, 0xfde725]),
};

/// The scale for sizes of triangles in px. It is blue, darker for larger triangles, and can't be confused with
/// [`super::layout::WASTE_COLOR`].
pub(crate) const SIZE_SCALE: Scale = Scale {
    least: SMALL_PX as f32,
    most: 64.0,
    colors: hex_colors([0xe4eef6, 0xcbdeee, 0xaecbe3, 0x8fb5d6, 0x709dc6, 0x5584b2, 0x3d6a9b]),
};

/// The scale for how many times as many triangles a patch has as it needs. It runs from cream to a dark red (ColorBrewer's
/// OrRd, its dark end lightened, so that lines stay visible on it).
pub const EXCESS_SCALE: Scale = Scale {
    least: 1.0,
    most: 16.0,
    colors: hex_colors([0xfef0d9, 0xfdd49e, 0xfdbb84, 0xfc8d59, 0xef6548, 0xd7301f, 0xb00010]),
};

/// The scale for texels of an image beside one px of the picture: orange where there are fewer than one, purple where there are more,
/// and light grey at one (ColorBrewer's PuOr, which people with any colour vision can tell apart).
pub const DENSITY_SCALE: Scale = Scale {
    least: 0.125,
    most: 8.0,
    colors: hex_colors([0xb35806, 0xf1a340, 0xfee0b6, 0xf7f7f7, 0xd8daeb, 0x998ec3, 0x542788]),
};

/// The colours of the scale of curvature: blue where it is below 0, red where it is above, and light grey at 0 (ColorBrewer's
/// RdBu, which people with any colour vision can tell apart).
const CURVATURE_COLORS: [[u8; 3]; Scale::STOPS] =
    hex_colors([0x2166ac, 0x67a9cf, 0xd1e5f0, 0xf7f7f7, 0xfddbc7, 0xef8a62, 0xb2182b]);

/// The scale of curvatures that ends at about this one and its negative: the result has two digits.
pub(super) fn curvature_scale(ends: f64) -> Scale {
    // Not so large or small that a shader's division of two curvatures leaves f32.
    let most = ends.clamp(1e-30, 1e30);
    let digit = 10.0_f64.powf(most.log10().floor() - 1.0);
    let most = ((most / digit).round() * digit) as f32;
    Scale { least: -most, most, colors: CURVATURE_COLORS }
}

impl Scale {
    pub const STOPS: usize = 7;

    /// The place of a number on the scale, from 0 for the least to 1 for the most.
    pub fn place(&self, number: f32) -> f32 {
        let place = if self.least < 0.0 {
            (number - self.least) / (self.most - self.least)
        } else {
            (number / self.least).ln() / (self.most / self.least).ln()
        };
        place.clamp(0.0, 1.0)
    }

    /// The sRGB colour at a place from 0 to 1; `scale_color` in `shaders/draw_overlays.wgsl` does the same.
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
    fn curvature_has_an_even_scale_around_0_whose_ends_have_two_digits() {
        let scale = curvature_scale(4.0 / 1.7);
        assert_eq!((scale.least, scale.most), (-2.4, 2.4));
        assert_eq!([-9.0, -2.4, 0.0, 1.2, 2.4].map(|number| scale.place(number)), [0.0, 0.0, 0.5, 0.75, 1.0]);
        assert_eq!(scale.color(scale.place(0.0)), [0xf7; 3]);
        assert_eq!(curvature_scale(4.0 / 3e-7).most, 1.3e7);
        for ends in [0.0, f64::MIN_POSITIVE, f64::MAX, f64::INFINITY] {
            let Scale { least, most, .. } = curvature_scale(ends);
            assert!(most > 0.0 && most.is_finite() && least == -most, "{ends}: {most}");
        }
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
        let both_ways = steps(&curvature_scale(1.0));
        assert!(both_ways[..4].windows(2).all(|pair| pair[0] * 1.15 < pair[1]), "{both_ways:?}");
        assert!(both_ways[3..].windows(2).all(|pair| pair[0] > pair[1] * 1.15), "{both_ways:?}");
        for falling in [&SIZE_SCALE, &EXCESS_SCALE] {
            assert!(steps(falling).windows(2).all(|pair| pair[0] > pair[1] * 1.15), "{:?}", steps(falling));
        }
    }
}

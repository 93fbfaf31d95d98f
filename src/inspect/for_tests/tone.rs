//! Linear light to what a screen can show: twin of `shaders/tone.wgsl`.

use glam::Vec3;

use crate::settings::ToneCurve;

/// Below this, colours are shown as they are, and above they are compressed.
pub(crate) const COMPRESSION_START: f32 = 0.76;

/// How fast compressed colours become white.
pub(crate) const DESATURATION: f32 = 0.15;

/// The Khronos PBR Neutral tone mapper (Khronos 2024, specification 1.0). Takes and returns linear RGB, which isn't negative.
pub(crate) fn neutral_tone(color: Vec3) -> Vec3 {
    let least = color.min_element();
    let offset = if least < 0.08 { least - 6.25 * least * least } else { 0.04 };
    let shifted = color - offset;
    let peak = shifted.max_element();
    if peak < COMPRESSION_START {
        return shifted;
    }
    let room = 1.0 - COMPRESSION_START;
    let compressed = 1.0 - room * room / (peak + room - COMPRESSION_START);
    let white = 1.0 - 1.0 / (DESATURATION * (peak - compressed) + 1.0);
    (shifted * (compressed / peak)).lerp(Vec3::splat(compressed), white)
}

/// Linear RGB to show, by a curve; 0 to 1 under the neutral one.
pub fn tone_mapped(color: Vec3, curve: ToneCurve) -> Vec3 {
    let light = color.max(Vec3::ZERO);
    if curve == ToneCurve::Neutral { neutral_tone(light) } else { light }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 0 to 20 in small steps.
    fn ramp() -> impl Iterator<Item = f32> {
        (0..=2000).map(|step| step as f32 / 100.0)
    }

    /// What a white light adds by reflection, 0.04 at most, is taken away again.
    #[test]
    fn colours_below_the_compression_are_base_colours() {
        for base in [Vec3::new(0.8, 0.1, 0.05), Vec3::new(0.3, 0.7, 0.5), Vec3::splat(0.7), Vec3::new(0.04, 0.5, 0.75)]
        {
            let base = base.min(Vec3::splat(0.7599));
            assert!(neutral_tone(base + 0.04).distance(base) < 1e-6, "{base}");
        }
    }

    #[test]
    fn greys_rise_with_the_light_and_stay_below_one() {
        let shown: Vec<f32> = ramp().map(|light| tone_mapped(Vec3::splat(light), ToneCurve::Neutral).x).collect();
        assert_eq!(shown[0], 0.0);
        assert!(shown.windows(2).all(|pair| pair[0] < pair[1]), "monotone");
        assert!(shown.iter().all(|&value| value < 1.0));
        assert!(shown.windows(2).all(|pair| pair[1] - pair[0] < 0.0101), "continuous");
    }

    #[test]
    fn every_colour_stays_in_the_cube_and_keeps_the_order_of_its_channels() {
        for peak in ramp() {
            for part in [0.0, 0.1, 0.5, 0.9] {
                let shown = tone_mapped(Vec3::new(peak, peak * part, peak * part * part), ToneCurve::Neutral);
                assert!(shown.min_element() >= -1e-7 && shown.max_element() <= 1.0, "{peak} {part}: {shown}");
                assert!(shown.x >= shown.y && shown.y >= shown.z, "{peak} {part}: {shown}");
            }
        }
    }

    #[test]
    fn bright_colours_become_white() {
        let [once, more] = [1.0, 100.0].map(|light| neutral_tone(Vec3::new(light, 0.1 * light, 0.1 * light)));
        assert!(once.x - once.y > 0.6 && more.x - more.y < 0.1, "{once} {more}");
    }

    #[test]
    fn no_curve_leaves_light_as_it_is() {
        assert_eq!(tone_mapped(Vec3::new(3.0, 0.5, -1.0), ToneCurve::None), Vec3::new(3.0, 0.5, 0.0));
    }
}

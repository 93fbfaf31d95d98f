//! The outlines of a silhouette as a picture that is laid over the mesh's.

use glam::{Vec2, vec2};
use image::{Pixel, Rgba, RgbaImage, imageops};

use super::halves::half_places;
use super::layout::OUTLINE_COLOR;
use crate::measure::{OutlineDistance, OutlineOf, Silhouette};
use crate::settings::{ColorSource, Settings, SplitSide};

/// sRGB colours of the outlines, in the order of [`OutlineOf::ALL`]. They are about equally far from a dark and from a light
/// background, and people with any colour vision can tell them apart.
pub(crate) const SILHOUETTE_COLORS: [[u8; 3]; 3] = [[224, 96, 128], [160, 160, 0], [32, 128, 224]];

/// The radius of the ring around the place where two outlines are farthest apart, in px.
const RING_RADIUS: f32 = 8.0;

/// Outlines as lines of 1 px on nothing, the triangles' over the others. A ring in an outline's colour stands around the place
/// where it and that of the triangles are farthest apart.
pub fn outlines_picture(silhouette: &Silhouette) -> RgbaImage {
    let [width, height] = silhouette.grid.picture;
    let mut picture = RgbaImage::new(width, height);
    let order = [OutlineOf::Source, OutlineOf::Surface, OutlineOf::Triangles];
    for (pixel, shares) in picture.pixels_mut().zip(&silhouette.lines) {
        for of in order {
            blend(pixel, SILHOUETTE_COLORS[of as usize], shares[of as usize]);
        }
    }
    let distances = &silhouette.distances;
    for (of, distance) in [(OutlineOf::Source, distances.from_source), (OutlineOf::Surface, distances.from_surface)] {
        if let Some(OutlineDistance { at, .. }) = distance.filter(|distance| distance.px > 0.0) {
            ring(&mut picture, at.as_vec2(), SILHOUETTE_COLORS[of as usize]);
        }
    }
    picture
}

/// Lays outlines over the halves of a picture of the same size that show them, if it shows the view from where they are seen.
pub fn lay_over(picture: &mut RgbaImage, outlines: &RgbaImage, settings: &Settings) {
    let places = half_places(picture.dimensions().into(), settings);
    for (half, place) in SplitSide::BOTH.into_iter().zip(places).filter(|_| !settings.moves_halves()) {
        if settings.half(half).is_some_and(|own| own.overlays.colors.source() == ColorSource::Outlines) {
            let [x, y, width, height] = place.area;
            imageops::overlay(picture, &*imageops::crop_imm(outlines, x, y, width, height), x.into(), y.into());
        }
    }
}

fn blend(pixel: &mut Rgba<u8>, [r, g, b]: [u8; 3], share: f32) {
    if share > 0.0 {
        pixel.blend(&Rgba([r, g, b, (255.0 * share.min(1.0)).round() as u8]));
    }
}

/// Draws a ring of 2 px with a dark border around it, in px from the picture's top left.
fn ring(picture: &mut RgbaImage, middle: Vec2, color: [u8; 3]) {
    let reach = RING_RADIUS + 3.0;
    let [least, most] = [middle - reach, middle + reach].map(|corner| corner.max(Vec2::ZERO).as_uvec2());
    for y in least.y..=most.y.min(picture.height().saturating_sub(1)) {
        for x in least.x..=most.x.min(picture.width().saturating_sub(1)) {
            let off = ((vec2(x as f32, y as f32) + 0.5).distance(middle) - RING_RADIUS).abs();
            let pixel = picture.get_pixel_mut(x, y);
            blend(pixel, OUTLINE_COLOR, (2.5 - off).clamp(0.0, 1.0));
            blend(pixel, color, (1.5 - off).clamp(0.0, 1.0));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::layout::{CRACK_COLOR, FOLD_COLOR, linear};
    use super::*;
    use crate::settings::{LIGHT_BACKGROUND, Settings};
    use glam::{Mat3, Vec3, mat3, vec3};

    /// How colours look without one kind of cones, in linear light (Machado et al. 2009, severity 1): protanopia, deuteranopia and
    /// tritanopia; and as they are.
    fn visions() -> [Mat3; 4] {
        let rows = |a, b, c| mat3(a, b, c).transpose();
        [
            Mat3::IDENTITY,
            rows(
                vec3(0.152286, 1.052583, -0.204868),
                vec3(0.114503, 0.786281, 0.099216),
                vec3(-0.003882, -0.048116, 1.051998),
            ),
            rows(
                vec3(0.367322, 0.860646, -0.227968),
                vec3(0.280085, 0.672501, 0.047413),
                vec3(-0.011820, 0.042940, 0.968881),
            ),
            rows(
                vec3(1.255528, -0.076749, -0.178779),
                vec3(-0.078411, 0.930809, 0.147602),
                vec3(0.004733, 0.691367, 0.303900),
            ),
        ]
    }

    /// CIELAB of linear sRGB, with its white as reference.
    fn lab(linear: Vec3) -> Vec3 {
        let [r, g, b] = linear.clamp(Vec3::ZERO, Vec3::ONE).to_array();
        let [x, y, z] = [
            (0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505,
            0.2126 * r + 0.7152 * g + 0.0722 * b,
            (0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089,
        ]
        .map(|part: f32| if part > 0.008856 { part.cbrt() } else { 7.787 * part + 16.0 / 116.0 });
        vec3(116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z))
    }

    #[test]
    fn every_colour_vision_tells_the_outlines_apart_on_any_background() {
        let [a, b, c] = SILHOUETTE_COLORS.map(|color| Vec3::from(linear(color)));
        for vision in visions() {
            for (one, other) in [(a, b), (a, c), (b, c)] {
                let apart = lab(vision * one).distance(lab(vision * other));
                assert!(apart > 40.0, "{one} and {other} are {apart} apart");
            }
        }
        for outline in [a, b, c] {
            for meaning in [CRACK_COLOR, FOLD_COLOR] {
                assert!(
                    lab(outline).distance(lab(Vec3::from(linear(meaning)))) > 35.0,
                    "{meaning:?} means something else"
                );
            }
            for background in [LIGHT_BACKGROUND, Settings::default().background_color()] {
                let [more, less] = {
                    let luminance = |linear: Vec3| linear.dot(vec3(0.2126, 0.7152, 0.0722)) + 0.05;
                    let both = [outline, Vec3::from(linear(background))].map(luminance);
                    [both[0].max(both[1]), both[0].min(both[1])]
                };
                assert!(more / less > 2.0, "{outline} on {background:?}");
            }
        }
    }
}

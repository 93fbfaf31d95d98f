//! The borders of masks: how much of a pixel is covered where alpha crosses the cutoff.

use geometry::mesh::mesh_builder::{InputCorner, MeshBuilder};
use geometry::mesh::{Alpha, Look, Material, Mesh};
use geometry::progress::Progress;
use glam::{Vec3, vec2, vec3};
use image::RgbaImage;
use inspect::render::layout::linear;
use inspect::settings::{Lighting, Settings};

use crate::engine;
use crate::layers::{drawn_by, single_sampled};
use crate::materials::{SIDE, every_way, image, studio};

/// How u changes along x, and along y, from the middle of the view to its border.
const SLOPE: f32 = 0.28;
const TILT: f32 = 0.4;
/// Texels of the ramp: alpha is exact at each, and linear between them.
const TEXELS: u32 = 16;

/// A white, unlit square across the whole view whose alpha is a slanted ramp, with that cutoff.
fn ramp(cutoff: f32) -> Mesh {
    let mut builder = MeshBuilder::new();
    let look = Look { alpha: Alpha::Mask(cutoff), unlit: true, ..Look::default() };
    let texels: Vec<_> = (0..TEXELS).map(|i| [255, 255, 255, (255 * i / (TEXELS - 1)) as u8]).collect();
    let texture = Some(image([TEXELS, 1], &texels));
    let own = builder.material(Material { look, texture, ..Material::plain("ramp", [1.0; 4]) });
    let corner = |x: f32, y: f32| InputCorner {
        position: vec3(x, y, 0.0),
        normal: Some(Vec3::Z),
        uv: vec2(0.5 + SLOPE * (x + TILT * y), 0.5),
    };
    let [a, b, c, d] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    [[a, b, c], [a, c, d]].into_iter().for_each(|triangle| builder.triangle(own, triangle));
    builder.finish("ramp".to_owned(), &Progress::default()).expect("nobody cancels")
}

/// The part of the view where alpha is at least the cutoff. Alpha is 0 in the middle of the first texel, and 1 in that of the last.
fn expected_coverage(cutoff: f32) -> f32 {
    let u = (cutoff * (TEXELS - 1) as f32 + 0.5) / TEXELS as f32;
    let border = (u - 0.5) / SLOPE;
    assert!(border.abs() + TILT < 1.0, "the border meets the upper and the lower side of the view");
    (1.0 - border) / 2.0
}

fn black(settings: Settings) -> Settings {
    Settings { background: Some([0; 3]), ..settings }
}

/// The colours of a picture in linear light.
fn brightness(picture: &RgbaImage) -> impl Iterator<Item = f32> {
    picture.pixels().map(|pixel| linear([pixel.0[0]; 3])[0])
}

#[test]
fn a_mask_covers_a_part_of_the_pixels_on_its_border() {
    let mesh = ramp(0.5);
    for settings in every_way(black(studio())) {
        let between = |engine| {
            let picture = drawn_by(engine, &mesh, &settings, false);
            // The borders of patches have a colour of their own, in one of these ways, along the sides of the picture.
            let inside = |at: u32| (4..SIDE - 4).contains(&at);
            let inner = picture.enumerate_pixels().filter(|(x, y, _)| inside(*x) && inside(*y));
            inner.filter(|(.., pixel)| pixel.0[0] > 20 && pixel.0[0] < 235).count()
        };
        let (several, one) = (between(engine()), between(&single_sampled()));
        if settings.overlays == studio().overlays {
            assert!(several as u32 > SIDE / 2 && one == 0, "{several} and {one} pixels, {settings:?}");
        } else {
            // Lines blend with the surface, too.
            assert!(several > one, "{several} and {one} pixels, {settings:?}");
        }
    }
}

/// The border crosses each row of pixels once. There at most one sample in four is on the wrong side of it, so that the mean is off
/// by at most a quarter of a pixel for each row. Texture units that filter in 8 bits move the border by 0.03 px.
#[test]
fn the_mean_coverage_is_what_the_cutoff_says() {
    for cutoff in [0.35, 0.42, 0.5, 0.65] {
        let picture = drawn_by(engine(), &ramp(cutoff), &black(studio()), false);
        let mean = brightness(&picture).sum::<f32>() / (SIDE * SIDE) as f32;
        let (expected, allowed) = (expected_coverage(cutoff), 0.28 / SIDE as f32);
        assert!((mean - expected).abs() < allowed, "{cutoff}: {mean}, not {expected}");
    }
}

/// Alpha isn't below 0 anywhere, though what is linear in a pixel may be.
#[test]
fn a_cutoff_of_0_leaves_all_of_the_surface() {
    let mut mesh = ramp(0.0);
    let texels: Vec<_> = (0..TEXELS).map(|i| [255, 255, 255, if i % 2 == 0 { 0 } else { 255 }]).collect();
    mesh.materials[0].texture = Some(image([TEXELS, 1], &texels));
    for lighting in [Lighting::Studio, Lighting::Camera] {
        for settings in every_way(Settings { lighting, ..studio() }) {
            let picture = drawn_by(engine(), &mesh, &settings, true);
            let least = picture.pixels().map(|pixel| pixel.0[3]).min();
            assert_eq!(least, Some(255), "{settings:?}");
        }
    }
}

#[test]
fn a_transparent_picture_is_opaque_where_a_mask_is_whole() {
    let picture = drawn_by(engine(), &ramp(0.5), &studio(), true);
    let alphas: Vec<u8> = picture.pixels().map(|pixel| pixel.0[3]).collect();
    let count = |alpha: u8| alphas.iter().filter(|own| **own == alpha).count();
    let mean = alphas.iter().map(|alpha| f32::from(*alpha) / 255.0).sum::<f32>() / (SIDE * SIDE) as f32;
    assert!(count(0) > 1000 && count(255) > 1000, "{} and {}", count(0), count(255));
    assert!((mean - expected_coverage(0.5)).abs() < 0.28 / SIDE as f32, "{mean}");
}

/// The lights at the camera show masks as light from all around does: leaves stay leaves.
#[test]
fn a_mask_cuts_what_the_lights_at_the_camera_shine_on() {
    for settings in every_way(Settings { lighting: Lighting::Camera, ..studio() }) {
        for (engine, several) in [(engine(), true), (&single_sampled(), false)] {
            let picture = drawn_by(engine, &ramp(0.5), &settings, true);
            // The borders of patches have a colour of their own, in one of these ways, along the sides of the picture.
            let inside = |at: u32| (4..SIDE - 4).contains(&at);
            let inner = picture.enumerate_pixels().filter(|(x, y, _)| inside(*x) && inside(*y));
            let alphas: Vec<u8> = inner.map(|(.., pixel)| pixel.0[3]).collect();
            let count = |least, most| alphas.iter().filter(|own| (least..=most).contains(*own)).count();
            let [clear, border, whole] = [count(0, 0), count(1, 254), count(255, 255)];
            assert!(clear > 1000 && whole > 1000, "{clear}, {border} and {whole} pixels, {settings:?}");
            if settings.overlays == studio().overlays {
                assert_eq!(border > SIDE as usize / 2, several, "{border} pixels, {settings:?}");
                let mean = alphas.iter().map(|alpha| f32::from(*alpha) / 255.0).sum::<f32>() / alphas.len() as f32;
                // The view's sides are left out, and with them 4 of its pixels.
                let (half, expected) = (SIDE as f32 / 2.0, expected_coverage(0.5));
                let expected = 0.5 + (expected - 0.5) * half / (half - 4.0);
                assert!((mean - expected).abs() < 1.0 / SIDE as f32, "{mean}, not {expected}");
            }
        }
    }
}

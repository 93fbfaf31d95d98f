//! Drafts of pictures: what they leave out, and what they must not.

use geometry::mesh::{Alpha, CornerDetail, Look, MapUv, Material, Slot};
use geometry::tessellate::Tessellation;
use glam::{Vec2, Vec3};
use image::RgbaImage;
use inspect::render::Target;
use inspect::settings::{Overlays, Settings};

use crate::engine;
use crate::looks::{facing, square_of};
use crate::materials::{
    PLACES, SIDE, assert_near, at, every_way, image, look_with, map, material, studio, with_details,
};
use crate::stability::{scene_of, seen};

/// A draft and the whole picture of a square that fills the view.
fn both(material: Material, settings: &Settings) -> [RgbaImage; 2] {
    // With details, images may have texture coordinates of their own.
    let mesh = with_details(square_of(material, Vec3::Z, Vec2::ONE), |uv| CornerDetail {
        uvs: [uv; 2],
        tangent: Vec3::X,
        ..CornerDetail::default()
    });
    let gpu = &engine().gpu;
    [Target::draft, Target::new].map(|make| {
        let target = make(gpu, [SIDE; 2]).expect("a small picture");
        let mut scene = scene_of(mesh.clone(), 0.0);
        let camera = facing(&scene, &target);
        seen(&mut scene, &target, settings, &camera)
    })
}

fn assert_same(material: &Material, what: &str) {
    for settings in every_way(studio()) {
        let [draft, whole] = both(material.clone(), &settings);
        for place in PLACES {
            assert_near(at(&draft, place), at(&whole, place), 1, &format!("{what} at {place:?} with {settings:?}"));
        }
    }
}

#[test]
fn a_draft_has_the_colours_of_a_material_whose_images_are_even() {
    assert_same(&material([0.7, 0.4, 0.2], Look { metallic: 0.5, roughness: 0.3, ..Look::default() }), "no images");
    let look = Look { metallic: 1.0, roughness: 1.0, emissive: [0.5; 3], ..Look::default() };
    let even = |texel: [u8; 4]| map(image([4, 2], &[texel; 8]), MapUv::Own);
    let look = look_with(Slot::MetallicRoughness, even([0, 100, 30, 255]), look);
    let look = look_with(Slot::Emissive, even([200, 20, 90, 255]), look);
    assert_same(&material([0.7, 0.4, 0.2], look), "even images");
}

#[test]
fn a_draft_has_the_mean_of_an_uneven_image_and_no_normal_map() {
    let look = Look { metallic: 1.0, roughness: 1.0, ..Look::default() };
    let checks = [[0, 40, 0, 255], [0, 200, 255, 255]];
    let uneven = map(image([2, 2], &[checks[0], checks[1], checks[1], checks[0]]), MapUv::Own);
    let mean = map(image([1, 1], &[[0, 120, 128, 255]]), MapUv::Own);
    let leaning = map(image([1, 1], &[[200, 128, 200, 255]]), MapUv::Own);
    let uneven = look_with(Slot::Normal, leaning, look_with(Slot::MetallicRoughness, uneven, look.clone()));
    let even = look_with(Slot::MetallicRoughness, mean, look);
    let [draft, whole] = both(material([0.7, 0.4, 0.2], uneven), &studio());
    let [_, expected] = both(material([0.7, 0.4, 0.2], even), &studio());
    for place in PLACES {
        assert_near(at(&draft, place), at(&expected, place), 2, &format!("the mean at {place:?}"));
    }
    assert!(PLACES.iter().any(|&place| at(&draft, place) != at(&whole, place)), "the whole picture has the images");
}

/// A square of one colour, of which so much is seen.
fn blended(alpha: f32) -> Material {
    let look = Look { alpha: Alpha::Blend, unlit: true, ..Look::default() };
    Material { look, double_sided: true, ..Material::plain("glass", [0.2, 0.6, 0.9, alpha]) }
}

#[test]
fn a_draft_shows_a_surface_wholly_or_not_at_all() {
    let background = [40, 60, 30];
    let settings = Settings { background: Some(background), ..studio() };
    let shown = |material| at(&both(material, &settings)[0], PLACES[0]);
    let opaque = shown(Material { look: Look { unlit: true, ..Look::default() }, ..blended(1.0) });
    assert_eq!(shown(blended(0.45)), background, "more than half of the background is seen");
    assert_eq!(shown(blended(0.55)), opaque, "less than half of the background is seen");
    let clear = |transmission| material([0.7; 3], Look { transmission, ..Look::default() });
    assert_eq!(shown(clear(0.6)), background, "more than half of the light comes through");
    assert_ne!(shown(clear(0.4)), background, "less than half of the light comes through");
}

#[test]
fn lines_of_a_coarse_picture_are_as_wide_as_those_of_the_whole() {
    let gpu = &engine().gpu;
    let mesh = square_of(Material::plain("gray", [0.2, 0.2, 0.2, 1.0]), Vec3::Z, Vec2::ONE);
    // Few lines, since those that are dense fade by px of the coarse picture.
    let tessellation = Tessellation { factor: 1.0, ..Settings::default().tessellation };
    // How much lines change the mean brightness of the picture, as light: bytes are encoded about like this power.
    let change = |target: &Target, overlays: Overlays| {
        let mut scene = scene_of(mesh.clone(), 0.0);
        let camera = facing(&scene, target);
        let mut mean = |overlays| {
            let picture =
                seen(&mut scene, target, &Settings { overlays, tessellation, ..Settings::default() }, &camera);
            let sum: f64 = picture.pixels().map(|pixel| (f64::from(pixel[0]) / 255.0).powf(2.2)).sum();
            sum / f64::from(picture.width() * picture.height())
        };
        (mean(overlays) - mean(Overlays::default())).abs()
    };
    let lines = [
        Overlays { wireframe: true, ..Overlays::default() },
        Overlays { patches: true, ..Overlays::default() },
        Overlays { adjacency: true, ..Overlays::default() },
    ];
    for overlays in lines {
        let whole = change(&Target::new(gpu, [2 * SIDE; 2]).expect("a small picture"), overlays);
        let coarse = change(&Target::new(gpu, [SIDE; 2]).expect("a small picture").coarse(2), overlays);
        // Lines of the same width in px of the coarse picture would be twice as wide. The rest is how px at their borders count.
        assert!((0.7..1.4).contains(&(coarse / whole)), "{overlays:?}: {coarse} and {whole}");
    }
}

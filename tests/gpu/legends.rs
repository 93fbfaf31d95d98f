//! Legends in pictures as commands and the window write them.

use geometry::mesh::Shape;
use geometry::progress::Progress;
use image::RgbaImage;
use inspect::render::Camera;
use inspect::settings::{Choice, Colors, Lighting, Overlays, Settings};
use inspect::shot::{Shot, ShotView, Subject};

use crate::{engine, loaded};

/// A torus in these colours, with its legend or without.
fn drawn(colors: Colors, size: [u32; 2], legend: bool) -> RgbaImage {
    let overlays = Overlays { colors, ..Overlays::default() };
    let settings = Settings { lighting: Lighting::Camera, overlays, ..Settings::default() };
    let subject = Subject::new(loaded(Shape::Torus), settings);
    let mut scene = engine().scene(&subject.loaded, subject.arena_bytes).expect("shapes are small");
    subject.apply_to_scene(engine(), &mut scene).expect("nothing moves");
    let camera = Camera::framing(&scene.bounds, size.map(|side| side as f32).into());
    let view = ShotView { camera, lod_camera: None, size, transparent: false, legend };
    let mut shot = Shot::new(engine().clone(), scene, subject, view).expect("a small picture");
    shot.picture(None, &Progress::new()).expect("a picture")
}

/// The smallest rectangle in which the legend changes the picture: least and greatest coordinates.
fn legend_of(colors: Colors, size: [u32; 2]) -> Option<[[u32; 2]; 2]> {
    let [plain, with] = [false, true].map(|legend| drawn(colors, size, legend));
    let different = plain.enumerate_pixels().zip(with.pixels()).filter(|((.., own), other)| own != other);
    different.map(|((x, y, _), _)| [x, y]).fold(None, |found, [x, y]| {
        let [least, most] = found.unwrap_or([[x, y]; 2]);
        Some([[least[0].min(x), least[1].min(y)], [most[0].max(x), most[1].max(y)]])
    })
}

#[test]
fn the_legend_is_in_the_lower_right_corner_of_colours_that_stand_for_something() {
    let mut with_legend = 0;
    for &colors in Colors::ALL {
        let found = legend_of(colors, [320, 240]);
        if matches!(colors, Colors::Material | Colors::Clay | Colors::Matcap) {
            assert_eq!(found, None, "{colors:?}: one material stands for nothing");
            continue;
        }
        let Some([least, most]) = found else { panic!("{colors:?} has no legend") };
        // The margin is 10 points, and a point 1 px in so small a picture.
        assert_eq!(most, [309, 229], "{colors:?}");
        assert!(least[0] > 30 && least[1] > 130, "{colors:?}: {least:?}");
        with_legend += 1;
    }
    assert!(with_legend >= 13, "{with_legend}");
}

#[test]
fn the_legend_grows_with_the_picture_and_fits_a_small_one() {
    let width = |size| {
        let [least, most] = legend_of(Colors::Factors, size).expect("a legend");
        most[0] - least[0] + 1
    };
    let [small, usual, large] = [[90, 60], [640, 480], [1600, 1200]].map(width);
    assert!(small < 90, "{small}");
    assert_eq!(usual, 216, "196 points and the margins");
    assert_eq!(large, 432, "twice as many");
}

//! Normals that are evaluated at pixels, held against those of as many vertices as there can be.

use std::path::PathBuf;

use geometry::mesh::{Moment, Shape};
use geometry::progress::Progress;
use geometry::tessellate::{Displacement, Edges, Normals, Surface, Tessellation};
use gpu::{Timing, take_times};
use image::RgbaImage;
use inspect::engine::{Preparation, load};
use inspect::render::{Camera, Scene, Target};
use inspect::settings::{ARENA_BYTES, NormalsAt, Overlays, Settings};
use load::Source;

use crate::displacement::wavy;
use crate::pictures::SIZE;
use crate::{deforming, engine, picture, scene};

/// The mean difference, in levels of 255, that counts as none. Vertices have their normals packed in 32 bits, and pictures have
/// 8 bits a channel, so that one px in a hundred is a level off. At outlines, the middle of some px lies outside the triangle
/// that covers a part of them: there vertices' normals are extrapolated. Both together were at most 0.063, on the vase with its
/// small patches. Other normals, or no texture, differ by more than 1.
const ROUNDING: f64 = 0.1;

fn settings(surface: Surface, normals: Normals, factor: f32, normals_at: NormalsAt) -> Settings {
    let tessellation = Tessellation { surface, normals, factor, ..Tessellation::default() };
    Settings { normals_at, ..Settings::from(tessellation) }
}

/// The largest difference of a channel, in levels of 255, at each px that both pictures cover.
fn differences(a: &RgbaImage, b: &RgbaImage) -> Vec<u8> {
    let behind = a.get_pixel(0, 0);
    let covered = a.pixels().zip(b.pixels()).filter(|(a, b)| *a != behind && *b != behind);
    covered.map(|(a, b)| (0..3).map(|i| a[i].abs_diff(b[i])).max().unwrap_or(0)).collect()
}

fn mean_difference(a: &RgbaImage, b: &RgbaImage) -> f64 {
    let all = differences(a, b);
    assert!(all.len() > 2000, "{} px are covered", all.len());
    all.iter().map(|&levels| f64::from(levels)).sum::<f64>() / all.len() as f64
}

/// How far shading with one triangle a patch is from shading with thousands: with normals at vertices, and at pixels. Flat
/// patches have the same shape, and every px has the same weights, however many triangles there are. So only normals differ.
fn from_fine(scene: &mut Scene, normals: Normals) -> [f64; 2] {
    let fine = picture(scene, &settings(Surface::Flat, normals, 64.0, NormalsAt::Vertices), SIZE);
    [NormalsAt::Vertices, NormalsAt::Pixels].map(|normals_at| {
        let coarse = picture(scene, &settings(Surface::Flat, normals, 1.0, normals_at), SIZE);
        mean_difference(&coarse, &fine)
    })
}

/// Interpolated quadratic normals are more than a level off, on average. Those at pixels were 25 times nearer on the torus, and over
/// 100 times on the others.
#[test]
fn one_triangle_with_normals_at_pixels_is_shaded_as_thousands_with_normals_at_vertices() {
    for shape in [Shape::CubeSmooth, Shape::Torus, Shape::Icosahedron] {
        let (_, mut scene) = scene(shape);
        for normals in Normals::ALL {
            let [vertices, pixels] = from_fine(&mut scene, normals);
            assert!(pixels < ROUNDING, "{shape} {normals:?}: {pixels}");
            assert!(normals != Normals::Quadratic || vertices > 10.0 * pixels, "{shape}: {vertices} {pixels}");
        }
    }
}

#[test]
fn normals_at_pixels_follow_poses() {
    let (loaded, mut scene) = deforming::scene();
    let clips = loaded.mesh.rig.as_deref().expect("a document with clips").clips.len();
    for clip in 0..clips {
        scene.set_moment(Some(Moment { clip, time: 0.6 })).expect("a small rig");
        let [vertices, pixels] = from_fine(&mut scene, Normals::Quadratic);
        assert!(pixels < ROUNDING && vertices > 20.0 * pixels, "clip {clip}: {vertices} {pixels}");
    }
}

/// The same triangles, so small that what they interpolate is what the formula gives.
#[test]
fn every_surface_has_the_same_normals_at_pixels_as_at_many_vertices() {
    let (_, mut scene) = scene(Shape::CubeSplit);
    for surface in Surface::ALL {
        for normals in Normals::ALL {
            for edges in Edges::ALL {
                let [vertices, pixels] = [NormalsAt::Vertices, NormalsAt::Pixels].map(|normals_at| {
                    let own = settings(surface, normals, 64.0, normals_at);
                    picture(&mut scene, &own.with(Tessellation { edges, ..own.tessellation }), SIZE)
                });
                let difference = mean_difference(&vertices, &pixels);
                assert!(difference < ROUNDING, "{surface:?} {normals:?} {edges:?}: {difference}");
            }
        }
    }
}

/// With few triangles the shape differs too, which accounts for most of what is left: pixels were 0.54 times as far off.
#[test]
fn a_curved_surface_of_few_triangles_is_shaded_better_with_normals_at_pixels() {
    let (_, mut scene) = scene(Shape::CubeSmooth);
    let mut draw =
        |factor, normals_at| picture(&mut scene, &settings(Surface::PnAen, Normals::Surface, factor, normals_at), SIZE);
    let fine = draw(64.0, NormalsAt::Vertices);
    let [vertices, pixels] =
        [NormalsAt::Vertices, NormalsAt::Pixels].map(|normals_at| mean_difference(&draw(5.0, normals_at), &fine));
    assert!(pixels < 0.7 * vertices, "{vertices} {pixels}");
}

#[test]
fn textures_stay_with_normals_at_pixels() {
    let source = Source::File(PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/vase.glb")));
    let loaded = load(&source, &Preparation::default(), &Progress::new()).expect("an asset of the project");
    let mut scene = engine().scene(&loaded, ARENA_BYTES).expect("a small mesh");
    let [vertices, pixels] = [NormalsAt::Vertices, NormalsAt::Pixels]
        .map(|normals_at| picture(&mut scene, &settings(Surface::PnAen, Normals::Linear, 64.0, normals_at), SIZE));
    let difference = mean_difference(&vertices, &pixels);
    assert!(difference < ROUNDING, "{difference}");
}

#[test]
fn normals_at_pixels_are_the_same_under_overlays() {
    // Neither overlay marks anything here. One is drawn with an index buffer, the other with pulled vertices.
    let (_, mut scene) = scene(Shape::CubeSmooth);
    let own = settings(Surface::PnAen, Normals::Quadratic, 3.0, NormalsAt::Pixels);
    let plain = picture(&mut scene, &own, SIZE);
    let back_faces = Overlays { back_faces: true, ..own.overlays };
    let folds = Overlays { folds: true, ..own.overlays };
    for overlays in [back_faces, folds] {
        let other = picture(&mut scene, &Settings { overlays, ..own }, SIZE);
        // Another shader, which a driver may round otherwise.
        assert!(differences(&plain, &other).iter().all(|&levels| levels <= 1), "{overlays:?}");
    }
}

#[test]
fn each_half_of_a_split_has_normals_of_its_user_surface() {
    let (_, mut scene) = scene(Shape::Icosahedron);
    let target = Target::new(&engine().gpu, SIZE).expect("a small picture");
    let camera = Camera::framing(&scene.bounds, target.viewport());
    let [left, right] =
        [Surface::Flat, Surface::PnAen].map(|surface| settings(surface, Normals::Surface, 3.0, NormalsAt::Pixels));
    let split =
        Settings { split: Some(0.5), left: Tessellation { surface: Surface::Flat, ..right.tessellation }, ..right };
    let [both, left, right] = [split, left, right].map(|settings| {
        engine().draw(&mut scene, &target, &camera, &settings, &mut Timing::Off).expect("a draw");
        target.read(&engine().gpu).expect("a readback")
    });
    assert!(left != right);
    let middle = SIZE[0] / 2;
    // But for the last column on the left: the software driver lets a sample of the right half in there.
    for (x, y, pixel) in both.enumerate_pixels().filter(|(x, ..)| x + 1 != middle) {
        let alone = if x < middle { &left } else { &right };
        assert_eq!(pixel, alone.get_pixel(x, y), "{x}, {y}");
    }
}

#[test]
fn displaced_surfaces_keep_their_normals_at_vertices() {
    let (_, mut scene) = wavy(Shape::CubeSmooth);
    let [vertices, pixels] = [NormalsAt::Vertices, NormalsAt::Pixels].map(|normals_at| {
        let own = settings(Surface::PnAen, Normals::Quadratic, 8.0, normals_at);
        let displaced = Tessellation { displacement: Displacement::On, height_scale: 0.15, ..own.tessellation };
        picture(&mut scene, &own.with(displaced), SIZE)
    });
    assert!(vertices == pixels);
}

#[test]
fn moving_normals_from_vertices_to_pixels_only_draws_again() {
    let (_, mut scene) = scene(Shape::Torus);
    let target = Target::new(&engine().gpu, SIZE).expect("a small picture");
    let camera = Camera::framing(&scene.bounds, target.viewport());
    let mut draw = |normals_at| {
        let mut timing = Timing::on(&engine().gpu);
        let own = settings(Surface::PnAen, Normals::Quadratic, 3.0, normals_at);
        engine().draw(&mut scene, &target, &camera, &own, &mut timing).expect("a draw");
        engine().gpu.wait();
        let passes: Vec<_> = take_times(&engine().gpu, &mut timing).iter().map(|time| time.pass).collect();
        (passes, scene.tessellator.generation())
    };
    let (passes, generation) = draw(NormalsAt::Vertices);
    assert!(passes.contains(&"emit") && passes.contains(&"draw"), "{passes:?}");
    assert_eq!(draw(NormalsAt::Pixels), (vec!["draw"], generation));
}

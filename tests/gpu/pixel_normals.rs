//! Normals that are evaluated at pixels, held against those of as many vertices as there can be.

use image::RgbaImage;
use pnaen::gpu::{Timing, take_times};
use pnaen::mesh::{Moment, Shape};
use pnaen::render::{Camera, Scene, Target};
use pnaen::settings::{ARENA_BYTES, NormalsAt, Overlays, Settings};
use pnaen::tessellate::{Displacement, Normals, Surface, Tessellation};

use crate::gpu_tests::deforming;
use crate::gpu_tests::displacement::wavy;
use crate::gpu_tests::pictures::SIZE;
use crate::gpu_tests::{engine, picture, scene};

fn settings(surface: Surface, normals: Normals, factor: f32, normals_at: NormalsAt) -> Settings {
    let tessellation = Tessellation { surface, normals, factor, ..Tessellation::default() };
    Settings { normals_at, ..Settings::from(tessellation) }
}

/// The largest difference of a channel at each px that both pictures cover, in levels of 255.
fn differences(a: &RgbaImage, b: &RgbaImage) -> Vec<u8> {
    let behind = a.get_pixel(0, 0);
    let covered = a.pixels().zip(b.pixels()).filter(|(a, b)| *a != behind && *b != behind);
    covered.map(|(a, b)| (0..3).map(|i| a[i].abs_diff(b[i])).max().unwrap_or(0)).collect()
}

fn mean(differences: &[u8]) -> f64 {
    differences.iter().map(|&levels| f64::from(levels)).sum::<f64>() / differences.len() as f64
}

/// How far shading with one triangle a patch is from shading with 4096 of them, in levels: with normals at vertices, and at
/// pixels. Flat patches have the same shape and the same weights at every px however many triangles they have, so that only the
/// normals differ.
fn from_fine(scene: &mut Scene, normals: Normals) -> [Vec<u8>; 2] {
    let fine = picture(scene, &settings(Surface::Flat, normals, 64.0, NormalsAt::Vertices), SIZE);
    [NormalsAt::Vertices, NormalsAt::Pixels].map(|places| {
        let coarse = picture(scene, &settings(Surface::Flat, normals, 1.0, places), SIZE);
        differences(&coarse, &fine)
    })
}

#[test]
fn one_triangle_with_normals_at_pixels_is_shaded_as_many_with_normals_at_vertices() {
    for shape in [Shape::CubeSmooth, Shape::Torus, Shape::Icosahedron] {
        let (_, mut scene) = scene(shape);
        for normals in [Normals::Linear, Normals::Quadratic, Normals::Surface] {
            let [v, p] = from_fine(&mut scene, normals);
            let over = |d: &[u8]| d.iter().filter(|l| **l > 1).count();
            println!("{shape:?} {normals:?}: vertices mean {:.3} max {:?} over1 {}; pixels mean {:.3} max {:?} over1 {} of {}", mean(&v), v.iter().max(), over(&v), mean(&p), p.iter().max(), over(&p), p.len());
        }
    }
}

#[test]
fn curved() {
    for shape in [Shape::CubeSmooth, Shape::CubeSplit, Shape::Torus, Shape::Icosahedron] {
        let (_, mut scene) = scene(shape);
        for surface in Surface::ALL {
        for normals in [Normals::Linear, Normals::Quadratic, Normals::Surface] {
            let fine = picture(&mut scene, &settings(surface, normals, 64.0, NormalsAt::Vertices), SIZE);
            let [v, p] = [NormalsAt::Vertices, NormalsAt::Pixels].map(|places| {
                differences(&picture(&mut scene, &settings(surface, normals, 5.0, places), SIZE), &fine)
            });
            println!("{shape:?} {surface:?} {normals:?}: {:.3} {:?}  pixels {:.3} {:?}", mean(&v), v.iter().max(), mean(&p), p.iter().max());
        }
        }
    }
}

#[test]
fn normals_at_pixels_follow_poses() {
    let (loaded, mut scene) = deforming::scene();
    let clips = loaded.mesh.rig.as_deref().expect("a document with clips").clips.len();
    for clip in 0..clips {
        scene.set_moment(Some(Moment { clip, time: 0.6 })).expect("a small rig");
        let [v, p] = from_fine(&mut scene, Normals::Quadratic);
        println!("{clip}: vertices mean {:.3} max {:?}; pixels mean {:.3} max {:?}", mean(&v), v.iter().max(), mean(&p), p.iter().max());
    }
}

#[test]
fn normals_at_pixels_are_the_same_under_overlays() {
    // Neither overlay marks anything here. The first is drawn indexed, the second with pulled vertices.
    let (_, mut scene) = scene(Shape::CubeSmooth);
    let own = settings(Surface::PnAen, Normals::Quadratic, 3.0, NormalsAt::Pixels);
    let plain = picture(&mut scene, &own, SIZE);
    let [back_faces, folds] =
        [Overlays { back_faces: true, ..own.overlays }, Overlays { folds: true, ..own.overlays }]
            .map(|overlays| picture(&mut scene, &Settings { overlays, ..own }, SIZE));
    for other in [back_faces, folds] {
        println!("{:?}", differences(&plain, &other).into_iter().max());
    }
}

#[test]
fn each_half_of_a_split_has_normals_of_its_own_surface() {
    let (_, mut scene) = scene(Shape::Icosahedron);
    engine().split(&mut scene, ARENA_BYTES).expect("shapes are small");
    let target = Target::new(&engine().gpu, SIZE).expect("a small picture");
    let camera = Camera::framing(&scene.bounds, target.viewport());
    let right = settings(Surface::PnAen, Normals::Surface, 3.0, NormalsAt::Pixels);
    let left = settings(Surface::Flat, Normals::Surface, 3.0, NormalsAt::Pixels);
    let split = Settings { split: Some(0.5), split_surface: Some(Surface::Flat), ..right };
    let [both, right, left] = [split, right, left].map(|settings| {
        engine().draw(&mut scene, &target, &camera, &settings, &mut Timing::Off).expect("a draw");
        target.read(&engine().gpu).expect("a readback")
    });
    let middle = SIZE[0] / 2;
    for (x, y, pixel) in both.enumerate_pixels().filter(|(x, ..)| x + 1 != middle) {
        // The software driver lets a sample of the right half into the last column of the left one.
        let alone = if x < middle { &left } else { &right };
        assert_eq!(pixel, alone.get_pixel(x, y), "{x}, {y}");
    }
    assert!(left != right);
}

#[test]
fn displaced_surfaces_keep_their_normals_at_vertices() {
    let (_, mut scene) = wavy(Shape::CubeSmooth);
    let displaced = |normals_at| {
        let own = settings(Surface::PnAen, Normals::Quadratic, 8.0, normals_at);
        own.with(Tessellation { displacement: Displacement::On, height_scale: 0.15, ..own.tessellation })
    };
    let [vertices, pixels] =
        [NormalsAt::Vertices, NormalsAt::Pixels].map(|places| picture(&mut scene, &displaced(places), SIZE));
    assert!(vertices == pixels);
}

#[test]
fn another_place_of_normals_only_draws_again() {
    let (_, mut scene) = scene(Shape::Torus);
    let target = Target::new(&engine().gpu, SIZE).expect("a small picture");
    let camera = Camera::framing(&scene.bounds, target.viewport());
    let mut passes = |normals_at| {
        let mut timing = Timing::on(&engine().gpu);
        let own = settings(Surface::PnAen, Normals::Quadratic, 3.0, normals_at);
        engine().draw(&mut scene, &target, &camera, &own, &mut timing).expect("a draw");
        engine().gpu.wait();
        let ran: Vec<_> = take_times(&engine().gpu, &mut timing).iter().map(|time| time.pass).collect();
        (ran, scene.tessellator.generation())
    };
    let (first, generation) = passes(NormalsAt::Vertices);
    assert!(first.contains(&"emit") && first.contains(&"draw"), "{first:?}");
    assert_eq!(passes(NormalsAt::Pixels), (vec!["draw"], generation));
}

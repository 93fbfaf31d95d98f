//! Pictures of every surface, partitioning and overlay, against references made on the software driver. Run with
//! PNAEN_UPDATE_IMAGES=1 to make them again; look at what changed before keeping it.

use std::path::{Path, PathBuf};

use image::RgbaImage;
use pnaen::measure::compare;
use pnaen::mesh::{EdgeKind, Progress, Shape, t_junctions};
use pnaen::render::layout::{CRACK_COLOR, FOLD_COLOR, T_JUNCTION_COLOR, edge_color};
use pnaen::render::{Camera, Scene, Target, t_junction_lines};
use pnaen::settings::{Overlay, Overlays, Settings};
use pnaen::tessellate::{Lod, Partitioning, Surface};

use crate::stability::{case, seen};
use crate::{engine, picture, scene};

const SIZE: [u32; 2] = [200, 160];
/// The software driver rasterises a little differently on other processors: a few px along edges. A wrong surface, a
/// missing patch or overlay is a hundred times more (see the test below).
const TOLERANCE: f64 = 0.004;

fn reference(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/images").join(format!("{name}.png"))
}

/// Names of pictures that differ from their references, with how much.
fn differing(pictures: Vec<(String, RgbaImage)>) -> Vec<String> {
    let update = std::env::var_os("PNAEN_UPDATE_IMAGES").is_some();
    assert!(engine().gpu.is_software() || !update, "references are made on the software driver");
    let mut differing = Vec::new();
    for (name, picture) in pictures {
        let path = reference(&name);
        if update {
            picture.save(&path).expect("the folder is there");
            continue;
        }
        let expected = image::open(&path).unwrap_or_else(|error| panic!("{name}: {error}")).to_rgba8();
        let comparison = compare(&picture, &expected).expect("one size");
        if comparison.difference > TOLERANCE {
            let folder = std::env::temp_dir();
            picture.save(folder.join(format!("pnaen-{name}.png"))).expect("a writable temporary folder");
            comparison.map.save(folder.join(format!("pnaen-{name}-diff.png"))).expect("a writable temporary folder");
            differing.push(format!("{name} by {:.4} (see {})", comparison.difference, folder.display()));
        }
    }
    differing
}

#[test]
fn surfaces_look_as_they_did() {
    let (_, mut scene) = scene(Shape::CubeSplit);
    let surfaces = [("flat", Surface::Flat), ("pn", Surface::Pn), ("pn-aen", Surface::PnAen)];
    let pictures = surfaces.map(|(name, surface)| {
        let settings = Settings { surface, factor: 12.0, ..Settings::default() };
        (format!("surface-{name}"), picture(&mut scene, &settings, SIZE))
    });
    assert_eq!(differing(pictures.into()), Vec::<String>::new());
}

#[test]
fn partitionings_look_as_they_did() {
    let (_, mut scene) = scene(Shape::Icosahedron);
    let overlays = [Overlay::Wireframe, Overlay::Patches].into_iter().collect();
    let pictures = Partitioning::ALL.map(|partitioning| {
        let settings = Settings { partitioning, factor: 4.6, overlays, ..Settings::default() };
        (format!("partitioning-{partitioning}"), picture(&mut scene, &settings, SIZE))
    });
    assert_eq!(differing(pictures.into()), Vec::<String>::new());
}

#[test]
fn overlays_look_as_they_did() {
    let mut pictures = Vec::new();
    for (name, shape, overlay) in [
        ("wireframe", Shape::Torus, Overlay::Wireframe),
        ("patches", Shape::Torus, Overlay::Patches),
        ("barycentric", Shape::CubeSplit, Overlay::Barycentric),
        ("adjacency-cylinder", Shape::Cylinder, Overlay::Adjacency),
        ("adjacency-moebius", Shape::Moebius, Overlay::Adjacency),
        ("cracks", Shape::CubeSplit, Overlay::Cracks),
    ] {
        let (_, mut scene) = scene(shape);
        let overlays = [overlay].into_iter().collect();
        let settings = Settings { surface: Surface::Pn, overlays, ..Settings::default() };
        pictures.push((format!("overlay-{name}"), picture(&mut scene, &settings, SIZE)));
    }
    assert_eq!(differing(pictures), Vec::<String>::new());
}

#[test]
fn adaptive_lod_and_the_split_look_as_they_did() {
    let (_, mut scene) = scene(Shape::Cone);
    let overlays = Overlays { wireframe: true, ..Overlays::default() };
    let adaptive = Settings { lod: Lod::Paper, pixels: 12.0, overlays, ..Settings::default() };
    let split = Settings { split: Some(0.5), overlays, ..Settings::default() };
    let pictures = [("lod-paper", adaptive), ("split", split)];
    let pictures = pictures.map(|(name, settings)| (name.to_owned(), picture(&mut scene, &settings, SIZE)));
    assert_eq!(differing(pictures.into()), Vec::<String>::new());
}

#[test]
fn the_tolerance_is_far_below_a_change_that_matters() {
    let (_, mut scene) = scene(Shape::CubeSplit);
    let base = Settings { factor: 12.0, ..Settings::default() };
    let wireframe = Overlays { wireframe: true, ..Overlays::default() };
    let expected = picture(&mut scene, &base, SIZE);
    for changed in [
        Settings { surface: Surface::Pn, ..base },
        Settings { overlays: wireframe, ..base },
        Settings { split: Some(0.4), ..base },
    ] {
        let difference = compare(&picture(&mut scene, &changed, SIZE), &expected).expect("one size").difference;
        assert!(difference > 5.0 * TOLERANCE, "{difference}: {changed:?}");
    }
}

#[test]
fn barycentric_colours_are_red_green_and_blue_at_the_corners() {
    // One patch of a cube's front face, seen from the front: (u, v, w) is 1 at corners 0, 1 and 2.
    let (loaded, mut scene) = scene(Shape::CubeSmooth);
    let engine = engine();
    let target = pnaen::render::Target::new(&engine.gpu, [400, 400]).expect("a small picture");
    let camera = pnaen::render::Camera {
        azimuth: 0.0,
        elevation: 0.0,
        ..pnaen::render::Camera::framing(&scene.bounds, target.viewport())
    };
    let overlays = Overlays { barycentric: true, ..Overlays::default() };
    let settings = Settings { surface: Surface::Flat, overlays, ..Settings::default() };
    let mut timing = pnaen::gpu::Timing::Off;
    engine.draw(&mut scene, &target, &camera, &settings, &mut timing).expect("a draw");
    let picture = target.read(&engine.gpu).expect("a readback");
    let clip = camera.clip_from_object(target.viewport(), &scene.bounds);
    for patch in &loaded.topology.patches {
        let corners = patch.corners.map(|corner| loaded.mesh.corners[corner as usize].position);
        if corners.iter().any(|corner| corner.z < 0.0) {
            continue;
        }
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        for (channel, corner) in corners.into_iter().enumerate() {
            let near = corner.lerp(middle, 0.1);
            let at = pnaen::render::project(clip, target.viewport(), near).expect("in front of the eye");
            let colour = picture.get_pixel(at.x as u32, at.y as u32).0;
            let brightest = (0..3).max_by_key(|&c| colour[c]).expect("three channels");
            assert_eq!(brightest, channel, "{colour:?} at {at}");
        }
    }
}

/// How many px have an sRGB colour, within what rounding from it to linear light, in three digits, and back can do.
fn pixels_of(picture: &RgbaImage, color: [u8; 3]) -> usize {
    let near = |pixel: &image::Rgba<u8>| (0..3).all(|c| pixel.0[c].abs_diff(color[c]) <= 2);
    picture.pixels().filter(|pixel| near(pixel)).count()
}

#[test]
fn lines_have_the_colours_of_their_legend() {
    let legend = [
        (Shape::Cylinder, Overlay::Adjacency, edge_color(EdgeKind::Smooth)),
        (Shape::Cylinder, Overlay::Adjacency, edge_color(EdgeKind::Split)),
        (Shape::Cylinder, Overlay::Adjacency, edge_color(EdgeKind::Seam)),
        (Shape::Saddle, Overlay::Adjacency, edge_color(EdgeKind::Boundary)),
        (Shape::CubeSplit, Overlay::Cracks, CRACK_COLOR),
    ];
    for (shape, overlay, color) in legend {
        let (_, mut scene) = scene(shape);
        let settings =
            Settings { surface: Surface::Pn, overlays: [overlay].into_iter().collect(), ..Settings::default() };
        let found = pixels_of(&picture(&mut scene, &settings, [640, 480]), color);
        assert!(found > 50, "{shape:?} {overlay:?}: {found} px of {color:?}");
    }
}

#[test]
fn folds_are_marked_and_nothing_else_is() {
    let target = Target::new(&engine().gpu, [640, 480]).expect("a small picture");
    let (mut star, camera) = case("folds");
    let marked = |scene: &mut Scene, camera: &Camera, surface, folds| {
        let overlays = Overlays { folds, ..Overlays::default() };
        let settings = Settings { surface, overlays, factor: 14.0, ..Settings::default() };
        pixels_of(&seen(scene, &target, &settings, camera), FOLD_COLOR)
    };
    for surface in [Surface::Pn, Surface::PnAen] {
        let pixels = marked(&mut star, &camera, surface, true);
        assert!(pixels > 1000, "{surface:?}: {pixels} px");
        assert_eq!(marked(&mut star, &camera, surface, false), 0, "{surface:?}, not asked for");
    }
    assert_eq!(marked(&mut star, &camera, Surface::Flat, true), 0, "what is flat has no folds");
    let (_, mut torus) = scene(Shape::Torus);
    let inside = Camera { target: glam::vec3(0.7, 0.0, 0.0), distance: 0.1, ..camera };
    for camera in [camera, inside] {
        let pixels = marked(&mut torus, &camera, Surface::PnAen, true);
        assert_eq!(pixels, 0, "a torus has none, though half of it faces away from the eye");
    }
}

#[test]
fn faces_seen_from_behind_are_marked_and_others_are_not() {
    let target = Target::new(&engine().gpu, [320, 240]).expect("a small picture");
    // How many px are three times as red as green: the mesh is grey, the background bluish.
    let red = |scene: &mut Scene, camera: &Camera, back_faces| {
        let overlays = Overlays { back_faces, ..Overlays::default() };
        let picture = seen(scene, &target, &Settings { overlays, ..Settings::default() }, camera);
        picture.pixels().filter(|pixel| pixel.0[0] > 40 && pixel.0[0] / 3 > pixel.0[1]).count()
    };
    let (_, mut saddle) = scene(Shape::Saddle);
    let above = Camera::framing(&saddle.bounds, target.viewport());
    let below = Camera { elevation: -40.0, ..above };
    assert!(red(&mut saddle, &below, true) > 2000, "an open sheet from below");
    assert_eq!(red(&mut saddle, &below, false), 0, "not asked for");
    assert_eq!(red(&mut saddle, &Camera { elevation: 60.0, ..above }, true), 0, "from above");
    let (_, mut torus) = scene(Shape::Torus);
    let around = Camera::framing(&torus.bounds, target.viewport());
    assert_eq!(red(&mut torus, &around, true), 0, "nobody sees a closed mesh from behind");
}

#[test]
fn t_junctions_are_marked_where_there_are_some() {
    let target = Target::new(&engine().gpu, [640, 480]).expect("a small picture");
    let marked = |scene: &mut Scene, camera: &Camera| {
        let topology = scene.tessellator.topology().clone();
        let junctions = t_junctions(&topology, &Progress::default()).expect("nobody cancels");
        scene.set_lines(&engine().gpu, &t_junction_lines(&topology, &junctions));
        let picture = seen(scene, &target, &Settings::default(), camera);
        (junctions.len(), pixels_of(&picture, T_JUNCTION_COLOR))
    };
    let (mut sheet, camera) = case("t-junction");
    let (found, pixels) = marked(&mut sheet, &camera);
    assert!(found == 7 && pixels > 200, "{pixels} px for {found} T-junctions");
    assert_eq!(marked(&mut scene(Shape::Saddle).1, &camera), (0, 0));
}

//! Culling: what is left out is never missed.

use geometry::mesh::Shape;
use geometry::tessellate::{Clip, Edges, Inputs, Lod, Surface, Tessellation, tessellate};
use glam::{Mat4, Vec2, Vec3};
use gpu::Timing;
use inspect::measure::Culled;
use inspect::render::{Camera, Scene, Target};
use inspect::settings::{Overlays, Settings};
use lab::stability::random_camera;

use crate::{engine, scene};

const CAMERAS: u32 = 500;

/// The shapes of which nothing but the outside is ever seen.
const SOLIDS: [Shape; 6] =
    [Shape::CubeSplit, Shape::CubeSmooth, Shape::Icosahedron, Shape::Icosphere, Shape::Torus, Shape::Cylinder];

fn seen(scene: &mut Scene, target: &Target, camera: &Camera, settings: &Settings) -> image::RgbaImage {
    engine().draw(scene, target, camera, settings, &mut Timing::Off).expect("a draw");
    target.read(&engine().gpu).expect("a readback")
}

fn differing(a: &image::RgbaImage, b: &image::RgbaImage) -> usize {
    a.pixels().zip(b.pixels()).filter(|(a, b)| a != b).count()
}

fn culled(scene: &mut Scene) -> Culled {
    engine().measure(scene).expect("a readback").culled
}

#[test]
fn no_pixel_differs_whatever_is_left_out() {
    let target = Target::new(&engine().gpu, [160, 120]).expect("a small picture");
    let mut removed = Culled::default();
    for (k, shape) in SOLIDS.into_iter().enumerate() {
        let (_, mut scene) = scene(shape);
        for index in (k as u32..CAMERAS).step_by(SOLIDS.len()) {
            let camera = random_camera(&scene.bounds, index);
            let lod = [Lod::Error, Lod::Uniform][index as usize / 7 % 2];
            let surface = [Surface::PnAen, Surface::Flat][index as usize / 5 % 2];
            let all = Settings::from(Tessellation { lod, surface, factor: 3.0, ..Tessellation::default() });
            let needed = all.with(Tessellation { clip: Clip::Frustum, cull_back_faces: true, ..all.tessellation });
            if index % 10 == 0 {
                // With backs drawn too: silhouettes alone may differ, where front and back are equally far.
                let backs = |settings: Settings| Settings {
                    overlays: Overlays { back_faces: true, ..Overlays::default() },
                    ..settings
                };
                let pictures = [all, needed].map(|settings| seen(&mut scene, &target, &camera, &backs(settings)));
                let differing = differing(&pictures[0], &pictures[1]);
                assert!(differing < 12, "{differing} px of {shape:?} from {camera:?} under {lod:?} on {surface:?}");
            }
            let expected = seen(&mut scene, &target, &camera, &all);
            let found = seen(&mut scene, &target, &camera, &needed);
            assert_eq!(differing(&expected, &found), 0, "px of {shape:?} from {camera:?} under {lod:?} on {surface:?}");
            let own = culled(&mut scene);
            removed.out_of_view += own.out_of_view;
            removed.facing_away += own.facing_away;
        }
    }
    println!("{CAMERAS} cameras: {removed:?}");
    assert!(removed.out_of_view > 9_000 && removed.facing_away > 9_000, "{removed:?}");
}

/// Patches that face away, from a camera that sees all of the mesh.
fn facing_away(shape: Shape, settings: &Settings) -> u32 {
    let (_, mut scene) = scene(shape);
    let viewport = Vec2::new(320.0, 240.0);
    let camera = Camera::framing(&scene.bounds, viewport);
    let inputs = settings.inputs(camera.lod_view(viewport, &scene.bounds));
    engine().count(&mut scene, &inputs, &mut Timing::Off).expect("counts");
    culled(&mut scene).facing_away
}

#[test]
fn backs_are_kept_where_they_could_be_seen() {
    let culling = Settings::from(Tessellation { cull_back_faces: true, ..Tessellation::default() });
    let flat = culling.with(Tessellation { surface: Surface::Flat, ..culling.tessellation });
    assert_eq!(facing_away(Shape::CubeSplit, &flat), 6, "three of a cube's faces, two triangles each");
    assert!(facing_away(Shape::Torus, &culling) > 90, "of 256, about half of which face away");
    let torn = culling.with(Tessellation { surface: Surface::Pn, ..culling.tessellation });
    assert_eq!(facing_away(Shape::CubeSplit, &torn), 0, "one looks in through the cracks");
    let published = culling.with(Tessellation { edges: Edges::AsPublished, ..culling.tessellation });
    assert_eq!(facing_away(Shape::CubeSplit, &published), 0, "the same");
    assert_eq!(facing_away(Shape::Saddle, &culling), 0, "open");
    assert_eq!(facing_away(Shape::Moebius, &culling), 0, "without an outside");
}

#[test]
fn the_device_leaves_out_what_the_cpu_does() {
    let viewport = Vec2::new(320.0, 240.0);
    let (mut same, mut all) = (0, 0);
    for shape in SOLIDS {
        let (loaded, mut scene) = scene(shape);
        let left_out = |inputs: &Inputs| tessellate(&loaded.mesh, &loaded.topology, inputs, None).patch_factors;
        for index in 0..12 {
            let camera = random_camera(&scene.bounds, index);
            let settings = Settings::from(Tessellation {
                factor: 1.0,
                clip: Clip::Frustum,
                cull_back_faces: true,
                ..Tessellation::default()
            });
            let inputs = settings.inputs(camera.lod_view(viewport, &scene.bounds));
            engine().count(&mut scene, &inputs, &mut Timing::Off).expect("counts");
            let device = engine().patch_factors(&scene).expect("a readback");
            let host = left_out(&inputs);
            let differ: Vec<_> = (0..host.len()).filter(|&patch| device[patch] != host[patch]).collect();
            (same, all) = (same + host.len() - differ.len(), all + host.len());
            if differ.is_empty() {
                continue;
            }
            let nearly = nearly_the_view(&inputs).map(|inputs| left_out(&inputs));
            for patch in differ {
                let known = nearly.iter().any(|host| host[patch] == device[patch]);
                assert!(known, "{shape:?}, camera {index}, patch {patch}: {:?}", device[patch]);
            }
        }
    }
    assert!(all > 5000 && same * 1000 >= all * 998, "{same} of {all} patches agree without any allowance");
}

/// Views that differ by no more than rounding. What lies on a plane of the view, or is seen edge-on, is on one side of it in
/// some of them, and on the other side in others.
fn nearly_the_view(inputs: &Inputs) -> [Inputs; 8] {
    const ROUNDING: f32 = 1e-6;
    let clip_from_object = inputs.view.clip_from_object;
    let scaled =
        [1.0 - ROUNDING, 1.0 + ROUNDING].map(|size| Mat4::from_scale(Vec3::new(size, size, 1.0)) * clip_from_object);
    let moved = [Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_X, Vec3::NEG_Y, Vec3::NEG_Z]
        .map(|axis| clip_from_object * Mat4::from_translation(axis * inputs.view.radius * ROUNDING));
    let [a, b] = scaled;
    let [c, d, e, f, g, h] = moved;
    [a, b, c, d, e, f, g, h].map(|clip_from_object| Inputs {
        view: inputs.view.seen_through(clip_from_object, inputs.view.half_viewport),
        ..*inputs
    })
}

#[test]
fn backs_that_are_not_rasterised_are_not_missed_either() {
    let target = Target::new(&engine().gpu, [160, 120]).expect("a small picture");
    let (mut inside, mut most) = (0, 0);
    for (k, shape) in SOLIDS.into_iter().enumerate() {
        let (_, mut scene) = scene(shape);
        for index in (k as u32..120).step_by(SOLIDS.len()) {
            let camera = random_camera(&scene.bounds, index);
            let usual = Settings::from(Tessellation { factor: 3.0, ..Tessellation::default() });
            // These shapes have no folds: all that this changes is that backs are rasterised.
            let both = Settings { overlays: Overlays { folds: true, ..Overlays::default() }, ..usual };
            let pictures = [usual, both].map(|settings| seen(&mut scene, &target, &camera, &settings));
            let differing = differing(&pictures[0], &pictures[1]);
            assert!(differing < 12, "{differing} px of {shape:?} from {camera:?}");
            most = most.max(differing);
            let center = 0.5 * (scene.bounds.min + scene.bounds.max);
            inside += u32::from(camera.eye().distance(center) < 0.5 * scene.bounds.radius());
        }
    }
    println!("{inside} cameras deep inside; at most {most} px differ, at silhouettes");
    assert!(inside > 5, "{inside}");
}

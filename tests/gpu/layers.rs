//! Surfaces that show what is behind them: pictures against what compositing on the CPU makes of the same surfaces, and against
//! pictures that must be the same.

mod peeled_area;
mod sheets;
mod transmission;

use std::sync::Arc;

use geometry::mesh::mesh_builder::{InputCorner, MeshBuilder};
use geometry::mesh::{Alpha, Look, Material, Mesh, Topology};
use geometry::progress::Progress;
use geometry::tessellate::Tessellation;
use glam::{Vec3, vec2, vec3};
use gpu::Timing;
use image::RgbaImage;
use inspect::engine::Engine;
use inspect::render::layout::linear;
use inspect::render::{Camera, Target};
use inspect::settings::{Overlays, Settings, ToneCurve};

use crate::engine;
use crate::materials::{SIDE, assert_near, balls, material, of_picture, studio};
use crate::pictures::differing;
use crate::stability::{scene_of, seen};

/// Layers are rounded to bytes one after another.
const ROUNDING: u8 = 2;

/// An unlit sheet across the whole view, at the height `z` + `slope` x.
#[derive(Clone, Copy)]
struct Sheet {
    z: f32,
    slope: f32,
    /// Linear RGB, and alpha.
    color: [f32; 4],
    alpha: Alpha,
}

fn blended(z: f32, slope: f32, color: [f32; 4]) -> Sheet {
    Sheet { z, slope, color, alpha: Alpha::Blend }
}

/// The two triangles of a sheet. The whole part of u says which sheet it is.
fn corners(index: usize, sheet: &Sheet) -> [[InputCorner; 3]; 2] {
    let normal = vec3(-sheet.slope, 0.0, 1.0).normalize();
    let corner = |x: f32, y: f32| InputCorner {
        position: vec3(x, y, sheet.z + sheet.slope * x),
        normal: Some(normal),
        uv: vec2(index as f32 + 0.25 + 0.125 * x, 0.5 - 0.5 * y),
    };
    let [a, b, c, d] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    [[a, b, c], [a, c, d]]
}

const BACKGROUND: [u8; 3] = [40, 60, 30];

pub(super) fn camera_of(engine: &Engine, mesh: &Mesh, target: &Target) -> (inspect::render::Scene, Camera) {
    let topology = Topology::build_within(mesh, 0.0, &Progress::default()).expect("nobody cancels");
    let scene = engine.scene_of(Arc::new(mesh.clone()), Arc::new(topology), 8 << 20).expect("a small mesh");
    let framed = Camera::framing(&scene.bounds, target.viewport());
    let distance = framed.distance * 2.0 / (SIDE as f32 * framed.units_per_pixel(SIDE as f32));
    (scene, Camera { azimuth: 0.0, elevation: 0.0, orthographic: true, distance, ..framed })
}

pub(super) fn drawn_by(engine: &Engine, mesh: &Mesh, settings: &Settings, is_transparent: bool) -> RgbaImage {
    let make = if is_transparent { Target::transparent } else { Target::new };
    let target = make(&engine.gpu, [SIDE; 2]).expect("a small picture");
    let (mut scene, camera) = camera_of(engine, mesh, &target);
    engine.draw(&mut scene, &target, &camera, settings, &mut Timing::Off).expect("a draw");
    target.read(&engine.gpu).expect("a readback")
}

fn drawn(mesh: &Mesh, settings: &Settings) -> RgbaImage {
    drawn_by(engine(), mesh, settings, false)
}

/// An engine on the same device that draws one sample a pixel.
pub(super) fn single_sampled() -> Engine {
    let mut gpu = engine().gpu.clone();
    gpu.most_samples = 1;
    Engine::new(gpu)
}

/// A smooth material that lets a part of the light through and mirrors none.
fn glass([r, g, b]: [f32; 3], transmission: f32) -> Material {
    let look = Look { transmission, specular: 0.0, roughness: 0.0, ..Look::default() };
    Material { look, double_sided: true, ..Material::plain("glass", [r, g, b, 1.0]) }
}

fn painted(color: [f32; 3]) -> Material {
    material(color, Look { unlit: true, ..Look::default() })
}

/// Level sheets at these heights.
fn sheets_of<const N: usize>(sheets: [(f32, Material); N]) -> Mesh {
    let mut builder = MeshBuilder::new();
    for (index, (z, own)) in sheets.into_iter().enumerate() {
        let own = builder.material(own);
        let sheet = Sheet { z, slope: 0.0, color: [0.0; 4], alpha: Alpha::Opaque };
        corners(index, &sheet).into_iter().for_each(|triangle| builder.triangle(own, triangle));
    }
    builder.finish("sheets".to_owned(), &Progress::default()).expect("nobody cancels")
}

/// A ball of glass, or of what blends, around a smaller opaque one.
fn ball_in_ball(outer: Material) -> Mesh {
    let inner = Material { double_sided: false, ..painted([0.9, 0.1, 0.1]) };
    let mut mesh = balls(vec![inner, outer], 1);
    // `balls` puts the second below the first.
    let first = mesh.corners.len() / 2;
    for (index, corner) in mesh.corners.iter_mut().enumerate() {
        let offset = if index < first { Vec3::ZERO } else { vec3(0.0, -2.2, 0.0) };
        corner.position = (corner.position - offset) * if index < first { 0.5 } else { 1.0 };
    }
    mesh
}

fn blended_ball() -> Material {
    let look = Look { alpha: Alpha::Blend, roughness: 0.2, ..Look::default() };
    Material { look, ..Material::plain("ball", [0.2, 0.4, 0.9, 0.3]) }
}

fn ball_picture(scene: &mut inspect::render::Scene, settings: &Settings) -> RgbaImage {
    let target = Target::new(&engine().gpu, [160, 120]).expect("a small picture");
    let camera = Camera { azimuth: 20.0, elevation: 15.0, ..Camera::framing(&scene.bounds, target.viewport()) };
    seen(scene, &target, settings, &camera)
}

#[test]
fn backs_are_seen_through_fronts() {
    for outer in [blended_ball(), Material { double_sided: false, ..glass([0.7, 0.8, 0.9], 1.0) }] {
        let mut scene = scene_of(ball_in_ball(outer), 0.0);
        let settings = of_picture(ToneCurve::Neutral);
        let culled = settings.with(Tessellation { cull_back_faces: true, ..settings.tessellation });
        assert!(ball_picture(&mut scene, &culled) == ball_picture(&mut scene, &settings));
    }
}

#[test]
fn layers_of_many_chunks_and_of_both_halves_give_the_same_picture() {
    let mesh = ball_in_ball(blended_ball());
    let settings = of_picture(ToneCurve::Neutral);
    let settings = settings.with(Tessellation { factor: 40.0, ..settings.tessellation });
    let topology = Arc::new(Topology::new(&mesh));
    let mesh = Arc::new(mesh);
    let [whole, pieces] = [256 << 20, 1 << 20].map(|arena| {
        let mut scene = engine().scene_of(mesh.clone(), topology.clone(), arena).expect("a small mesh");
        let drawn = ball_picture(&mut scene, &settings);
        (scene.tessellator.chunk_count(), drawn)
    });
    assert!(whole.0 == 1 && pieces.0 > 2, "{} chunks and {}", whole.0, pieces.0);
    assert!(whole.1 == pieces.1);
    // The same surface in both halves.
    let mut scene = engine().scene_of(mesh, topology, 256 << 20).expect("a small mesh");
    let split = Settings { split: Some(0.5), left: settings.tessellation, ..settings };
    let left = scene.sibling(1 << 20)().expect("a small mesh");
    scene.set_left(Some(left)).expect("no rig");
    assert!(ball_picture(&mut scene, &split) == whole.1);
}

/// By how much the ground changes the green light of each pixel in the middle of a picture of a blended ball with this alpha.
fn ground_in_front_of_ball(alpha: f32, elevation: f32) -> Vec<f32> {
    let mut ball = blended_ball();
    ball.base_color[3] = alpha;
    let mut scene = scene_of(balls(vec![ball], 1), 0.0);
    let target = Target::new(&engine().gpu, [160, 120]).expect("a small picture");
    let camera = Camera { azimuth: 20.0, elevation, ..Camera::framing(&scene.bounds, target.viewport()) };
    let settings = Settings { background: Some(BACKGROUND), ..of_picture(ToneCurve::Neutral) };
    let overlays = Overlays { grid: true, ..Overlays::default() };
    let [without, with] =
        [settings, Settings { overlays, ..settings }].map(|settings| seen(&mut scene, &target, &settings, &camera));
    let green = |picture: &RgbaImage, index: u32| {
        let [r, g, b, _] = picture.get_pixel(60 + index % 40, 40 + index / 40).0;
        linear([r, g, b])[1]
    };
    (0..40 * 40).map(|index| green(&with, index) - green(&without, index)).collect()
}

#[test]
fn the_ground_is_seen_through_what_is_in_front_of_it() {
    // Where alpha is 0 there is no ball.
    let [alone, through] = [0.0, 0.5].map(|alpha| ground_in_front_of_ball(alpha, 40.0));
    let most = alone.iter().copied().fold(0.0, f32::max);
    assert!(most > 0.12, "the ground has lines here: {most}");
    // A half of it comes through the wall that faces the eye.
    for (alone, through) in alone.iter().zip(&through) {
        assert!((through - 0.5 * alone).abs() < 0.015, "{through}, not a half of {alone}");
    }
    // From below, nothing is in front of it.
    let below = ground_in_front_of_ball(0.9, -40.0).into_iter().map(f32::abs).fold(0.0, f32::max);
    assert!(below > 0.1, "{below}");
}

#[test]
fn wires_on_a_layer_are_opaque() {
    let mesh = sheets_of([(0.4, glass([1.0; 3], 1.0)), (-0.4, painted([0.9; 3]))]);
    let borders = Settings { overlays: Overlays { adjacency: true, ..Overlays::default() }, ..studio() };
    let picture = drawn(&mesh, &borders);
    // The boundary of the sheets, in the middle of the left border of the picture.
    let [r, g, b, _] = picture.get_pixel(0, SIDE / 2).0;
    assert_near([r, g, b], [86, 180, 233], 3, "a boundary edge");
}

#[test]
fn layers_look_as_they_did() {
    let gold = material([1.0, 0.77, 0.34], Look { metallic: 1.0, roughness: 0.3, ..Look::default() });
    let glass = |color, roughness| material(color, Look { transmission: 1.0, roughness, ..Look::default() });
    let mut faint = blended_ball();
    faint.base_color = [0.1, 0.6, 0.2, 0.35];
    let mut mesh =
        balls(vec![gold, glass([0.95, 0.98, 1.0], 0.0), glass([0.9, 0.25, 0.2], 0.1), faint, painted([0.2; 3])], 5);
    // Closer together, so that they intersect, and each a little farther away than the one before.
    mesh.corners.iter_mut().for_each(|corner| {
        let ball = (corner.position.x / 2.2).round();
        corner.position += vec3(-1.1 * ball, 0.0, -0.7 * ball);
    });
    let mut scene = scene_of(mesh, 0.0);
    let target = Target::new(&engine().gpu, [320, 200]).expect("a small picture");
    let camera = Camera { azimuth: 10.0, elevation: 15.0, ..Camera::framing(&scene.bounds, target.viewport()) };
    let plain = seen(&mut scene, &target, &of_picture(ToneCurve::Neutral), &camera);
    let overlays = Overlays { patches: true, grid: true, ..Overlays::default() };
    let lines = Settings { overlays, ..of_picture(ToneCurve::Neutral) };
    let lines = seen(&mut scene, &target, &lines, &camera);
    let pictures = vec![("material-layers".to_owned(), plain), ("material-layers-lines".to_owned(), lines)];
    assert_eq!(differing(pictures), Vec::<String>::new());
}

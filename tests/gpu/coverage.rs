//! Triangles that cover no sample: what is left out before it is drawn is never missed.

use std::sync::Arc;

use geometry::mesh::Shape;
use geometry::tessellate::{CoverageView, Lod, Surface, Tessellation, covers_nothing, screen_corner};
use gpu::Timing;
use inspect::engine::Engine;
use inspect::render::{Camera, Renderer, Scene, Target};
use inspect::settings::{Colors, Overlays, Settings};
use lab::stability::random_camera;

use crate::{engine, scene};

/// An engine that leaves out what covers nothing, from so many triangles a px on.
pub(super) fn sifting(from: f32) -> Engine {
    let mut engine = engine().clone();
    let mut renderer = Renderer::new(&engine.gpu);
    renderer.sift_from = from;
    engine.renderer = Arc::new(renderer);
    engine
}

fn seen(engine: &Engine, scene: &mut Scene, target: &Target, camera: &Camera, settings: &Settings) -> image::RgbaImage {
    engine.draw(scene, target, camera, settings, &mut Timing::Off).expect("a draw");
    target.read(&engine.gpu).expect("a readback")
}

#[test]
fn no_pixel_differs_without_the_triangles_that_cover_nothing() {
    let engines = [sifting(f32::INFINITY), sifting(0.0)];
    let target = Target::new(&engine().gpu, [160, 120]).expect("a small picture");
    let shapes = [Shape::Torus, Shape::CubeSplit, Shape::Icosphere, Shape::Cylinder, Shape::Saddle, Shape::Cone];
    let (mut emitted, mut drawn) = (0, 0);
    for (k, shape) in shapes.into_iter().enumerate() {
        let (_, mut scene) = scene(shape);
        for index in (k as u32..240).step_by(shapes.len()) {
            let camera = Camera { orthographic: index % 5 == 0, ..random_camera(&scene.bounds, index) };
            let overlays = match index % 4 {
                0 => Overlays { patches: true, colors: Colors::Barycentric, ..Overlays::default() },
                1 => Overlays { back_faces: true, ..Overlays::default() },
                _ => Overlays::default(),
            };
            let settings = Settings {
                tessellation: Tessellation {
                    lod: [Lod::Uniform, Lod::EdgeLength][index as usize / 7 % 2],
                    factor: [5.0, 17.0, 40.0][index as usize / 3 % 3],
                    pixels: 0.7,
                    surface: [Surface::PnAen, Surface::Pn][index as usize / 2 % 2],
                    ..Tessellation::default()
                },
                split: [None, Some(0.4)][usize::from(index % 11 == 0)],
                overlays,
                ..Settings::default()
            };
            let [all, needed] = engines.each_ref().map(|engine| seen(engine, &mut scene, &target, &camera, &settings));
            let differing = all.pixels().zip(needed.pixels()).filter(|(a, b)| a != b).count();
            assert_eq!(differing, 0, "px of {shape:?} from {camera:?} with {settings:?}");
            if scene.tessellator.chunk_count() == 1 {
                emitted += scene.tessellator.totals().1;
                drawn += scene.covering_triangles().expect("a readback").expect("it was sifted");
            }
        }
    }
    assert!(emitted > 1_000_000 && drawn < emitted / 2, "{drawn} of {emitted}");
}

#[test]
fn as_many_triangles_are_kept_as_the_reference_keeps() {
    let (size, engine) = ([200, 150], sifting(0.0));
    let target = Target::new(&engine.gpu, size).expect("a small picture");
    for (shape, factor) in [(Shape::Torus, 23.0), (Shape::Bicubic, 48.0), (Shape::CubeSplit, 64.0)] {
        let (_, mut scene) = scene(shape);
        let camera = Camera::framing(&scene.bounds, target.viewport());
        let settings = Settings::from(Tessellation { factor, ..Tessellation::default() });
        seen(&engine, &mut scene, &target, &camera, &settings);
        let clip_from_object = camera.clip_from_object(target.viewport(), &scene.bounds);
        let fronts_only = scene.tessellator.shows_fronts_only(clip_from_object);
        let (samples, bits) = (inspect::render::samples(&engine.gpu), engine.gpu.subpixel_bits);
        let view = CoverageView::new(clip_from_object, target.viewport(), samples, fronts_only, bits);
        let output = engine.read_tessellated(&mut scene).expect("a readback");
        let corner = |index: u32| screen_corner(&view, output.vertices[index as usize].position.into());
        let is_kept = |triangle: &&[u32; 3]| {
            let [a, b, c] = triangle.map(corner);
            !covers_nothing(&view, a, b, c)
        };
        let expected = output.triangles.iter().filter(is_kept).count() as u64;
        let found = scene.covering_triangles().expect("a readback").expect("it was sifted");
        // Rounding decides for a triangle now and then.
        assert!(found.abs_diff(expected) <= expected / 1000, "{found} where {expected} of {shape:?}");
        assert!(expected < output.triangles.len() as u64, "{shape:?}");
    }
}

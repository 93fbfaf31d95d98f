//! Small adapters, and devices that are lost.

use std::sync::Arc;

use geometry::mesh::{Alpha, Shape};
use geometry::progress::Progress;
use geometry::tessellate::{Clip, Displacement, Lod, Normals, Surface, Tessellation};
use gpu::{Gpu, GpuError, Timing, best_adapter};
use inspect::engine::Engine;
use inspect::render::{Camera, Scene, Target};
use inspect::settings::{ARENA_BYTES, Colors, NormalsAt, Overlays, Settings};
use load::{Budget, HeightSource};

use crate::{engine, loaded};

/// A device with what WebGPU has by default and nothing else: 128 MiB a binding, 256 MiB a buffer, 8 storage buffers a
/// stage, no features; and one sample a px if `samples` says so.
fn small(samples: Option<u32>) -> Engine {
    let adapter = best_adapter().expect("these tests need a graphics adapter: run ./setup.sh");
    let descriptor = wgpu::DeviceDescriptor {
        label: Some("small"),
        required_features: wgpu::Features::empty(),
        required_limits: wgpu::Limits::default(),
        ..Default::default()
    };
    let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).expect("WebGPU's defaults");
    let mut gpu = Gpu::new(&adapter, device, queue);
    gpu.most_samples = samples.unwrap_or(gpu.most_samples);
    Engine::new(gpu)
}

fn seen(engine: &Engine, scene: &mut Scene, settings: &Settings) -> Result<image::RgbaImage, GpuError> {
    let target = Target::new(&engine.gpu, [200, 150])?;
    let camera = Camera::framing(&scene.bounds, target.viewport());
    engine.draw(scene, &target, &camera, settings, &mut Timing::Off)?;
    target.read(&engine.gpu)
}

#[test]
fn the_defaults_of_webgpu_are_enough_for_everything() {
    let small = small(None);
    assert!(!small.gpu.has_timestamps());
    let limits = small.gpu.device.limits();
    assert_eq!((limits.max_storage_buffer_binding_size, limits.max_storage_buffers_per_shader_stage), (128 << 20, 8));
    let wireframe = Overlays { wireframe: true, folds: true, normals: true, ..Overlays::default() };
    let factors = Overlays { patches: true, adjacency: true, colors: Colors::Factors, ..Overlays::default() };
    let cases = [
        (Shape::Torus, Settings::opening()),
        (
            Shape::Torus,
            Settings {
                tessellation: Tessellation { lod: Lod::Error, clip: Clip::Frustum, ..Tessellation::default() },
                overlays: wireframe,
                ..Settings::default()
            },
        ),
        (
            Shape::CubeSplit,
            Settings {
                tessellation: Tessellation { surface: Surface::Pn, ..Tessellation::default() },
                overlays: factors,
                split: Some(0.5),
                ..Settings::default()
            },
        ),
        (
            Shape::Bicubic,
            Settings::from(Tessellation { factor: 64.0, normals: Normals::Surface, ..Tessellation::default() }),
        ),
    ];
    for (shape, settings) in cases {
        let mesh = loaded(shape);
        let [expected, found] = [engine(), &small].map(|engine| {
            let mut scene = engine.scene(&mesh, ARENA_BYTES).expect("shapes are small");
            let picture = seen(engine, &mut scene, &settings).expect("a picture");
            let measured = engine.measure(&mut scene).expect("a readback");
            (picture, measured.cracks.different_bits)
        });
        assert!(expected == found, "{shape:?} with {settings:?}");
    }
}

#[test]
fn heights_need_no_more_either() {
    let small = small(None);
    let mut mesh = loaded(Shape::Torus);
    let image = image::RgbaImage::from_fn(64, 64, |x, y| image::Rgba([(x * y % 251) as u8; 4]));
    let texture = geometry::mesh::Texture { size: [64, 64], rgba: image.into_raw() };
    let own = Arc::make_mut(&mut mesh.mesh);
    own.materials.iter_mut().for_each(|material| material.texture = Some(Arc::new(texture.clone())));
    let heights = HeightSource::Materials
        .load(own, &[], &mut Vec::new(), &Budget::unlimited(), &Progress::new())
        .expect("images");
    own.heights = Some(Arc::new(heights));
    let settings =
        Settings::from(Tessellation { displacement: Displacement::On, lod: Lod::Error, ..Tessellation::default() });
    let [expected, found] = [engine(), &small].map(|engine| {
        let mut scene = engine.scene(&mesh, ARENA_BYTES).expect("shapes are small");
        seen(engine, &mut scene, &settings).expect("a picture")
    });
    assert!(expected == found);
}

#[test]
fn layers_need_no_more_either() {
    let small = small(None);
    let mut mesh = loaded(Shape::Torus);
    let own = &mut Arc::make_mut(&mut mesh.mesh).materials[0];
    (own.look.alpha, own.look.transmission, own.base_color[3]) = (Alpha::Blend, 0.5, 0.5);
    let overlays = Overlays { wireframe: true, folds: true, normals: true, grid: true, ..Overlays::default() };
    for overlays in [Overlays::default(), overlays] {
        let settings = Settings { overlays, normals_at: NormalsAt::Pixels, split: Some(0.3), ..Settings::opening() };
        let [expected, found] = [engine(), &small].map(|engine| {
            let mut scene = engine.scene(&mesh, ARENA_BYTES).expect("shapes are small");
            seen(engine, &mut scene, &settings).expect("a picture")
        });
        assert!(expected == found, "{overlays:?}");
    }
}

#[test]
fn one_sample_a_px_draws_too() {
    let engine = small(Some(1));
    let mesh = loaded(Shape::Torus);
    let mut scene = engine.scene(&mesh, ARENA_BYTES).expect("shapes are small");
    let picture = seen(&engine, &mut scene, &Settings::opening()).expect("a picture");
    let background = *picture.get_pixel(0, 0);
    let drawn = picture.pixels().filter(|px| **px != background).count();
    assert!(drawn > 5000, "{drawn}");
}

#[test]
fn what_is_refused_of_an_attempt_is_its_own_error() {
    let gpu = small(None).gpu;
    let other = gpu.clone();
    // Nothing can be mapped to be read and to be written.
    let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::MAP_WRITE;
    let descriptor = wgpu::BufferDescriptor { label: None, size: 4, usage, mapped_at_creation: false };
    let refused = gpu.attempt(|| {
        let beside = std::thread::spawn(move || other.attempt(|| 7).ok());
        assert_eq!(beside.join().ok().flatten(), Some(7), "another thread's is another's");
        gpu.device.create_buffer(&descriptor)
    });
    assert!(matches!(refused, Err(GpuError::Refused(_))));
    assert!(gpu.check().is_ok(), "it is reported nowhere else");
    let _ = gpu.device.create_buffer(&descriptor);
    assert!(matches!(gpu.check(), Err(GpuError::Refused(_))));
    assert!(gpu.check().is_ok(), "said once");
}

#[test]
fn a_lost_device_is_an_error_and_another_goes_on() {
    let lost = small(None);
    let mesh = loaded(Shape::Torus);
    let mut scene = lost.scene(&mesh, ARENA_BYTES).expect("shapes are small");
    let expected = seen(&lost, &mut scene, &Settings::default()).expect("a picture");
    lost.gpu.device.destroy();
    let error = seen(&lost, &mut scene, &Settings::from(Tessellation { factor: 7.0, ..Tessellation::default() }))
        .expect_err("it is lost");
    assert!(matches!(error, GpuError::Lost(_)) && lost.gpu.lost().is_some(), "{error}");
    assert!(matches!(lost.gpu.check(), Err(GpuError::Lost(_))), "for good");
    assert!(matches!(lost.gpu.attempt(|| ()), Err(GpuError::Lost(_))));
    drop(scene);
    let again = small(None);
    let mut scene = again.scene(&mesh, ARENA_BYTES).expect("shapes are small");
    assert!(seen(&again, &mut scene, &Settings::default()).is_ok_and(|found| found == expected));
}

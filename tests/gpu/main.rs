//! What runs on the device, held against the CPU's reference, against itself, and against pictures.
//!
//! These tests fail, rather than pass over, where there is no adapter. In CI it must be the software one.

mod conventions;
mod coverage;
mod crease_band;
mod culling;
mod deforming;
mod deviation;
mod displacement;
mod domain;
mod drafts;
mod driver_domain;
mod embed;
mod environment;
mod error;
mod exported;
mod exported_displaced;
mod exported_levels;
mod layers;
mod legends;
mod light;
mod limits;
mod lines;
mod looks;
mod masks;
mod materials;
mod moving_lights;
mod optimum;
mod orientation;
mod part_styles;
mod passes;
mod picking;
mod pictures;
mod pixel_normals;
mod readbacks;
mod reference;
mod round_trips;
mod scenes;
mod silhouette;
mod specification;
mod stability;
mod threemf;
mod user_lod;
mod user_shaders;
mod user_surface;
// The bench on hardware has the rest of it.
#[allow(dead_code, unreachable_pub, unused_imports)]
#[path = "../vulkan/mod.rs"]
mod vulkan;

use std::sync::{Arc, OnceLock};

use geometry::mesh::{Mesh, Shape, Topology};
use geometry::progress::Progress;
use gpu::Timing;
use inspect::engine::{Engine, Loaded, Preparation, load};
use inspect::render::{Camera, Scene, Target, crack_lines};
use inspect::settings::{ARENA_BYTES, Lighting, Settings};
use load::Source;

/// One engine for all tests: compiling its pipelines is what takes long.
pub(crate) fn engine() -> &'static Engine {
    static ENGINE: OnceLock<Engine> = OnceLock::new();
    ENGINE.get_or_init(|| {
        let engine = Engine::headless().expect("these tests need a graphics adapter: run ./setup.sh");
        println!("adapter: {} ({:?})", engine.gpu.info.name, engine.gpu.info.device_type);
        let in_ci = std::env::var_os("CI").is_some();
        assert!(!in_ci || engine.gpu.is_software(), "in CI, pictures come from the software adapter");
        engine
    })
}

/// Without a desktop session Mesa complains, unless there is a folder to look for a display in: see `.cargo/config.toml`.
#[cfg(target_os = "linux")]
#[test]
fn tests_have_a_folder_for_a_display() {
    let folder = std::env::var_os("XDG_RUNTIME_DIR").map(std::path::PathBuf::from);
    assert!(folder.is_some_and(|folder| folder.is_absolute()));
}

pub(crate) fn loaded(shape: Shape) -> Loaded {
    load(&Source::Shape(shape), &Preparation::default(), &Progress::default()).expect("shapes always load")
}

/// A mesh that no file was read for.
pub(crate) fn loaded_mesh(source: Source, mesh: Mesh) -> Loaded {
    let topology = Arc::new(Topology::build(&mesh, &Progress::new()).expect("nobody cancels"));
    Loaded { source, ..Loaded::from_mesh(Arc::new(mesh), topology) }
}

pub(crate) fn scene(shape: Shape) -> (Loaded, Scene) {
    let loaded = loaded(shape);
    let scene = engine().scene(&loaded, ARENA_BYTES).expect("shapes are small");
    (loaded, scene)
}

/// Draws what `pnaen render --lighting camera` would.
pub(crate) fn picture(scene: &mut Scene, settings: &Settings, size: [u32; 2]) -> image::RgbaImage {
    let settings = &Settings { lighting: Lighting::Camera, ..*settings };
    let engine = engine();
    let target = Target::new(&engine.gpu, size).expect("a small picture");
    let camera = Camera::framing(&scene.bounds, target.viewport());
    let inputs = settings.inputs(camera.lod_view(target.viewport(), &scene.bounds));
    engine.count(scene, &inputs, &mut Timing::Off).expect("counts");
    if settings.overlays.cracks {
        let measured = engine.measure(scene).expect("a readback");
        let lines = crack_lines(&measured, scene.tessellator.topology());
        scene.set_lines(&engine.gpu, &lines);
    }
    engine.draw(scene, &target, &camera, settings, &mut Timing::Off).expect("a draw");
    target.read(&engine.gpu).expect("a readback")
}

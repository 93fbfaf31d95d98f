//! Documents about one part of materials each, read from files as a user's are, and drawn in studio light. With PNAEN_SCENES the
//! test leaves them in that folder, for other viewers: see `docs/manual/compared.md`.

#[path = "../documents/scenes.rs"]
mod documents;

use std::path::PathBuf;

use pnaen::engine::{Preparation, load};
use pnaen::load::Source;
use pnaen::progress::Progress;
use pnaen::render::{Camera, Target};
use pnaen::settings::{ARENA_BYTES, Lighting, Settings, ToneCurve};
use pnaen::tessellate::{Surface, Tessellation};

use crate::gpu_tests::engine;
use crate::gpu_tests::pictures::differing;
use crate::gpu_tests::stability::seen;
use documents::material_scenes;

#[test]
fn scenes_of_materials_look_as_they_did() {
    let temporary = tempfile::tempdir().expect("a writable temporary folder");
    let folder = std::env::var_os("PNAEN_SCENES").map_or_else(|| temporary.path().to_owned(), PathBuf::from);
    let tessellation = Tessellation { surface: Surface::Flat, factor: 1.0, ..Tessellation::default() };
    let settings = Settings { lighting: Lighting::Studio, tone_curve: ToneCurve::None, ..Settings::from(tessellation) };
    let pictures = material_scenes().into_iter().map(|scene| {
        let path = folder.join(format!("{}.glb", scene.name));
        std::fs::write(&path, scene.glb).expect("a writable folder");
        let loaded = load(&Source::File(path), &Preparation::default(), &Progress::default())
            .unwrap_or_else(|error| panic!("{}: {error}", scene.name));
        assert_eq!(loaded.warnings, Vec::<String>::new(), "{}", scene.name);
        let mut uploaded = engine().scene(&loaded, ARENA_BYTES).expect("a small mesh");
        let target = Target::new(&engine().gpu, [160, 120]).expect("a small picture");
        let camera = Camera { azimuth: 10.0, elevation: 8.0, ..Camera::framing(&uploaded.bounds, target.viewport()) };
        (format!("scene-{}", scene.name), seen(&mut uploaded, &target, &settings, &camera))
    });
    assert_eq!(differing(pictures.collect()), Vec::<String>::new());
}

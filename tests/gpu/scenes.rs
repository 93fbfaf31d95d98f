//! Documents about one part of materials each, read from files as a user's are, and drawn in studio light. With PNAEN_SCENES the
//! test leaves them in that folder.

use std::path::{Path, PathBuf};

use geometry::progress::Progress;
use geometry::tessellate::{LodView, Surface, Tessellation, tessellate};
use image::RgbaImage;
use inspect::engine::{Loaded, Preparation, load};
use inspect::export::Exported;
use inspect::render::{Camera, Target};
use inspect::settings::{ARENA_BYTES, Lighting, Settings, ToneCurve};
use load::Source;

use crate::engine;
use crate::pictures::differing;
use crate::stability::seen;
use documents::scenes::{material_scenes, three_lamps};

/// The greatest difference of a channel, in steps of 255: coordinates of an exported texture transform are rounded once more, and
/// exported triangles begin with another corner, from which interpolation rounds otherwise.
pub(super) const EXPORT_STEPS: u8 = 1;

pub(super) fn settings() -> Settings {
    let tessellation = Tessellation { surface: Surface::Flat, factor: 1.0, ..Tessellation::default() };
    Settings { lighting: Lighting::Studio, tone_curve: ToneCurve::None, ..Settings::from(tessellation) }
}

/// Reads a document without a fault.
pub(super) fn read(path: &Path) -> Loaded {
    let loaded = load(&Source::File(path.to_owned()), &Preparation::default(), &Progress::default())
        .unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    assert_eq!(loaded.warnings, Vec::<String>::new(), "{}", path.display());
    loaded
}

pub(super) fn picture_of(loaded: &Loaded) -> RgbaImage {
    let mut uploaded = engine().scene(loaded, ARENA_BYTES).expect("a small mesh");
    let target = Target::new(&engine().gpu, [160, 120]).expect("a small picture");
    let camera = Camera { azimuth: 10.0, elevation: 8.0, ..Camera::framing(&uploaded.bounds, target.viewport()) };
    seen(&mut uploaded, &target, &settings(), &camera)
}

#[test]
fn scenes_of_materials_look_as_they_did() {
    let temporary = tempfile::tempdir().expect("a writable temporary folder");
    let folder = std::env::var_os("PNAEN_SCENES").map_or_else(|| temporary.path().to_owned(), PathBuf::from);
    std::fs::write(folder.join("light.hdr"), three_lamps()).expect("a writable folder");
    let pictures = material_scenes().into_iter().map(|scene| {
        let path = folder.join(format!("{}.glb", scene.name));
        std::fs::write(&path, scene.glb).expect("a writable folder");
        (format!("scene-{}", scene.name), picture_of(&read(&path)))
    });
    assert_eq!(differing(pictures.collect()), Vec::<String>::new());
}

#[test]
fn exported_scenes_look_as_their_sources() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    for scene in material_scenes() {
        let [source, exported] = ["source", "exported"].map(|name| folder.path().join(format!("{name}.glb")));
        std::fs::write(&source, scene.glb).expect("a writable folder");
        let loaded = read(&source);
        let inputs = settings().inputs(LodView::default());
        let tessellated = tessellate(&loaded.mesh, &loaded.topology, &inputs, None);
        let warnings = Exported::new(&loaded.mesh, &loaded.topology, &tessellated).write(&exported);
        assert_eq!(warnings.expect("a writable folder"), Vec::<String>::new(), "{}", scene.name);
        let [expected, got] = [picture_of(&loaded), picture_of(&read(&exported))];
        let most = expected.iter().zip(got.iter()).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(most <= Some(EXPORT_STEPS), "{}: {most:?} steps", scene.name);
    }
}

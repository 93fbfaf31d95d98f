//! Saved states read back as they were written, and damaged files do no harm.

use std::path::{Path, PathBuf};

use glam::Vec3;
use proptest::prelude::*;
use serde_json::{Value, json};
use tempfile::TempDir;

use super::saved_state::{MAX_FILES, Placement, SavedCamera, SavedFile, SavedState, WindowGeometry};
use super::{Persistence, state_file};
use geometry::tessellate::{Surface, Tessellation};
use inspect::for_tests::random::settings;
use inspect::render::Camera;
use inspect::settings::{Overlays, Settings};
use load::{Import, Source};

/// The file that the state is saved in.
fn file(folder: &TempDir) -> PathBuf {
    folder.path().join("window.json")
}

fn names(folder: &TempDir) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

prop_compose! {
    fn seen()(
        target in proptest::array::uniform3(-1e9f32..1e9),
        azimuth in 0.0f32..360.0,
        elevation in -90.0f32..=90.0,
        distance in 1e-20f32..1e20,
        orthographic in proptest::bool::ANY,
        field_of_view in 0.1f32..=170.0,
        roll in -180.0f32..=180.0,
        diagonal in 0.0f32..1e20,
    ) -> SavedCamera {
        let target = Vec3::from(target);
        let camera = Camera { target, azimuth, elevation, distance, orthographic, field_of_view, roll, rows: None };
        SavedCamera { camera, diagonal }
    }
}

prop_compose! {
    fn kept()(
        settings in settings(),
        width in 760.0f32..4000.0,
        height in 480.0f32..4000.0,
        is_maximized in proptest::bool::ANY,
        theme in proptest::sample::select(vec![
            egui::ThemePreference::System, egui::ThemePreference::Light, egui::ThemePreference::Dark,
        ]),
        zoom in 0.2f32..=5.0,
        files in proptest::collection::btree_map(
            "[ -~äßłβ]{1,20}", (proptest::option::of(seen()), proptest::bool::ANY), 0..MAX_FILES,
        ),
    ) -> SavedState {
        let absolute = |name: String| std::env::temp_dir().join(name).to_str().unwrap().to_owned();
        let Import { up, unit, .. } = settings.import;
        let file = |(name, (seen, is_gone))| {
            let (placement, bookmarks) = (Placement { up, unit }, Option::into_iter(seen).collect());
            SavedFile { path: absolute(name), placement, seen, bookmarks, is_gone }
        };
        let files = files.into_iter().map(file).collect();
        let frame = WindowGeometry { size: [width, height], is_maximized, theme, zoom };
        let mut saved = SavedState { frame, files, ..SavedState::default() };
        saved.take_settings(&settings);
        saved
    }
}

/// Values that a damaged or edited file may have in place of any value.
fn odd() -> impl Strategy<Value = Value> {
    proptest::sample::select(vec![
        json!(null),
        json!(true),
        json!("nurbs"),
        json!(-1e300),
        json!(1e300),
        json!(-1),
        json!(65),
        json!([1, 2]),
        json!({ "a": [] }),
        json!(""),
    ])
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_saved_state_reads_back_equal(kept in kept()) {
        let read = SavedState::read(kept.written().as_bytes());
        prop_assert!(read.as_ref() == Some(&kept), "{:?} {:?}", read.map(|read| read.settings), kept.settings);
    }

    #[test]
    fn an_invalid_field_leaves_all_others_unchanged(kept in kept(), odd in odd(), field in 0usize..100) {
        let mut value: Value = serde_json::from_str(&kept.written()).unwrap();
        let fields = value["settings"].as_object_mut().unwrap();
        let name = fields.keys().nth(field % fields.len()).unwrap().clone();
        fields.insert(name.clone(), odd);
        let read = SavedState::read(value.to_string().as_bytes()).unwrap();
        // The result is valid, so it reads back equal.
        let again = SavedState::read(read.written().as_bytes());
        prop_assert_eq!(again.as_ref(), Some(&read));
        prop_assert_eq!((&read.files, &read.frame), (&kept.files, &kept.frame));
        let written = |kept: &SavedState| serde_json::from_str::<Value>(&kept.written()).unwrap()["settings"].take();
        let (before, after) = (written(&kept), written(&read));
        for (other, value) in before.as_object().unwrap() {
            // Near and far are one option: an invalid one resets both.
            let is_same = *other != name && !(["near", "far"].contains(&other.as_str()) && ["near", "far"].contains(&&*name));
            prop_assert!(!is_same || after[other] == *value, "{} by {}", other, name);
        }
    }

    #[test]
    fn a_truncated_file_is_refused(kept in kept(), part in 0.0f64..1.0) {
        let text = kept.written();
        let end = (part * (text.trim_end().len() - 1) as f64) as usize;
        prop_assert_eq!(SavedState::read(&text.as_bytes()[..end]), None);
    }

    #[test]
    fn random_bytes_are_refused(bytes in proptest::collection::vec(0u8.., 0..200)) {
        prop_assert_eq!(SavedState::read(&bytes), None);
    }
}

#[test]
fn unknown_and_missing_fields_are_allowed() {
    let text = r#"{"version": 7, "settings": {"surface": "phong", "shadows": true}, "window": [], "files": "none"}"#;
    let read = SavedState::read(text.as_bytes()).unwrap();
    let settings =
        Settings::opening().with(Tessellation { surface: Surface::Phong, ..Settings::opening().tessellation });
    assert_eq!(read, SavedState { settings, ..SavedState::default() });
    assert_eq!(SavedState::read(b"{}"), Some(SavedState::default()));
    for text in ["", "[]", "null", "7", "{\"settings\": {\"alpha\": NaN}}"] {
        assert_eq!(SavedState::read(text.as_bytes()), None, "{text:?}");
    }
}

#[test]
fn numbers_out_of_range_get_their_defaults() {
    let read = |settings: Value, window: Value| {
        SavedState::read(json!({ "settings": settings, "window": window }).to_string().as_bytes()).unwrap()
    };
    for name in ["alpha", "factor", "pixels", "tolerance", "near", "far", "height_scale", "midlevel", "split"] {
        for number in [-2.0, 1e5, 1e39] {
            assert_eq!(read(json!({ name: number }), json!({})), SavedState::default(), "{name} {number}");
        }
    }
    assert_eq!(read(json!({ "near": 8.0, "far": 3.0 }), json!({})), SavedState::default());
    for (name, number) in [("width", 10.0), ("height", 1e9), ("zoom", 0.0), ("zoom", -1.0)] {
        assert_eq!(read(json!({}), json!({ name: number })), SavedState::default(), "{name}");
    }
    assert_eq!(read(json!({ "overlays": ["factors", "barycentric"] }), json!({})), SavedState::default());
    let overlays = read(json!({ "overlays": ["cracks", "shadows"] }), json!({})).settings.overlays;
    assert_eq!(overlays, Overlays { cracks: true, ..Overlays::default() });
}

#[test]
fn invalid_cameras_are_refused() {
    let camera = json!({"target": [0, 1, 2], "azimuth": 30, "elevation": 20, "distance": 5, "orthographic": false});
    let read = |camera: &Value| {
        let path = std::env::temp_dir().join("a.glb");
        let file = json!({ "path": path, "camera": camera, "diagonal": 2.0 });
        SavedState::read(json!({ "files": [file] }).to_string().as_bytes()).unwrap().files.remove(0).seen
    };
    let seen = read(&camera).unwrap();
    assert_eq!((seen.camera.target, seen.camera.distance), (Vec3::new(0.0, 1.0, 2.0), 5.0));
    for (name, odd) in [
        ("target", json!([0, 1e39, 0])),
        ("target", json!([0, 1])),
        ("azimuth", json!(1e39)),
        ("elevation", json!(90.1)),
        ("field_of_view", json!(171)),
        ("field_of_view", json!(null)),
        ("roll", json!(1e39)),
        ("distance", json!(0)),
        ("distance", json!(-1)),
        ("orthographic", json!(null)),
    ] {
        let mut camera = camera.clone();
        camera[name] = odd;
        assert_eq!(read(&camera), None, "{camera}");
    }
    assert_eq!(seen.camera_for(2.1), Some(seen.camera), "the mesh's size changed a little");
    for diagonal in [0.0, 0.02, 200.0, f32::NAN] {
        assert_eq!(seen.camera_for(diagonal), None, "{diagonal}");
    }
}

#[test]
fn the_number_of_files_is_limited_and_the_last_one_comes_first() {
    let mut lasting = Persistence::default();
    let file = |i: usize| Source::File(std::env::temp_dir().join(format!("{i}.glb")));
    for i in 0..MAX_FILES + 10 {
        assert_eq!(lasting.opened(&file(i), 1.0).0, None);
    }
    assert_eq!(lasting.opened(&file(30), 1.0).0, None);
    assert_eq!(lasting.opened(&Source::default(), 1.0).0, None);
    let names: Vec<_> = lasting.recent().map(|path| Path::new(path).file_stem().unwrap().to_owned()).collect();
    assert_eq!(names, ["30", "59", "58", "57", "56", "55", "54", "53", "52", "51"]);
    let many = lasting.kept.written();
    assert_eq!(
        (lasting.kept.files.len(), SavedState::read(many.as_bytes()).unwrap().files.len()),
        (MAX_FILES, MAX_FILES)
    );
    assert!(lasting.gone(&file(30)) && !lasting.gone(&file(30)) && !lasting.gone(&Source::default()));
    let path = std::env::temp_dir().join("a.glb");
    let named = |paths: Value| json!({ "files": paths }).to_string();
    let files = (0..200).map(|i| json!({ "path": path.with_file_name(i.to_string()) })).collect();
    assert_eq!(SavedState::read(named(files).as_bytes()).unwrap().files.len(), MAX_FILES);
    let odd = named(json!([{ "path": path }, { "path": "a.glb" }, { "path": path }, { "path": 7 }, null]));
    assert_eq!(SavedState::read(odd.as_bytes()).unwrap().files.len(), 1, "no duplicates and no relative paths");
}

#[test]
fn a_damaged_file_is_renamed_and_reported() {
    let folder = tempfile::tempdir().unwrap();
    assert!(state_file::read(folder.path()).said.is_none(), "a missing file is not reported");
    assert!(names(&folder).is_empty());
    for damage in [&b"{\"settings\":"[..], b"\xff\xfe", b""] {
        std::fs::write(file(&folder), damage).unwrap();
        let found = state_file::read(folder.path());
        let said = found.said.unwrap();
        assert!(["window.json is damaged", "window.damaged.json"].iter().all(|part| said.contains(part)), "{said}");
        assert_eq!((found.kept, found.place), (SavedState::default(), Some(file(&folder))));
        assert_eq!(names(&folder), ["window.damaged.json"]);
        assert_eq!(std::fs::read(folder.path().join("window.damaged.json")).unwrap(), damage);
    }
    let file = std::fs::File::create(file(&folder)).unwrap();
    file.set_len(1 << 30).unwrap();
    assert!(state_file::read(folder.path()).said.is_some_and(|said| said.contains("is damaged")), "it is too large");
}

#[test]
fn a_folder_in_place_of_the_file_is_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(file(&folder)).unwrap();
    let found = state_file::read(folder.path());
    assert!(found.place.is_none());
    let said = found.said.unwrap();
    assert!(["window.json", "(it is not a file)"].iter().all(|part| said.contains(part)), "{said}");
    // A file in place of the folder: nothing can be written below it.
    let below = folder.path().join("file");
    std::fs::write(&below, "").unwrap();
    let failed = state_file::write(&below.join("window.json"), &SavedState::default()).unwrap_err();
    assert!(failed.contains("window.json: settings could not be saved ("), "{failed}");
}

#[test]
fn writing_makes_the_folder() {
    let folder = tempfile::tempdir().unwrap();
    let below = folder.path().join("config/pnaen");
    let settings =
        Settings::opening().with(Tessellation { surface: Surface::Nagata, ..Settings::opening().tessellation });
    let kept = SavedState { settings, ..SavedState::default() };
    state_file::write(&below.join("window.json"), &kept).unwrap();
    let found = state_file::read(&below);
    assert_eq!((found.kept, found.said), (kept, None));
}

//! Light of files in the window: opening, dropping, choosing, closing, what the next window has, and files that fail.

use std::path::{Path, PathBuf};

use documents::panoramas::{open_exr_file, radiance_file};
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use geometry::mesh::Shape;
use image::RgbaImage;
use inspect::settings::Lighting;
use load::Source;
use pnaen::app::App;
use pnaen::commands::{Action, CompanionFile, FileAction, Purpose, all};
use tempfile::TempDir;

use crate::editing::{assert_draws, copied};
use crate::loading::drop_files;
use crate::{choose, click, copy_vase, press, resumed, settle, switch, uniform};

/// A panorama with red light above and blue light below.
pub(super) fn panorama(folder: &TempDir, name: &str) -> PathBuf {
    let size = [64, 32];
    let pixels: Vec<[f32; 3]> =
        (0..64 * 32).map(|index| if index < 64 * 16 { [1.5, 0.1, 0.1] } else { [0.1, 0.1, 1.5] }).collect();
    let bytes = if name.ends_with("exr") { open_exr_file(size, &pixels) } else { radiance_file(size, &pixels) };
    write(folder, name, &bytes)
}

fn write(folder: &TempDir, name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).expect("a writable temporary folder");
    path
}

fn folder() -> TempDir {
    tempfile::tempdir().expect("a writable temporary folder")
}

fn torus() -> Harness<'static, App> {
    uniform(Some(Source::Shape(Shape::Torus)))
}

fn open(harness: &mut Harness<App>, path: &Path) {
    let context = harness.ctx.clone();
    harness.state_mut().open_environment(&context, path.to_owned());
    settle(harness);
}

fn give(harness: &mut Harness<App>, action: FileAction) {
    let context = harness.ctx.clone();
    let all = all(&harness.state().availability());
    let command = all.iter().find(|command| command.action == Action::File(action.clone())).expect("a command");
    harness.state_mut().give(&context, command);
    settle(harness);
}

fn shown(harness: &Harness<App>) -> RgbaImage {
    harness.state().read_picture().expect("a device").expect("a picture")
}

fn lighting(harness: &Harness<App>) -> Lighting {
    harness.state().settings().lighting
}

#[test]
fn a_file_lights_the_mesh_until_it_is_closed() {
    let folder = folder();
    let path = panorama(&folder, "dusk sky.hdr");
    let mut harness = torus();
    let studio = shown(&harness);
    assert!(harness.query_by_label("Panorama").is_none());
    open(&mut harness, &path);
    assert_eq!((harness.state().environment_file(), lighting(&harness)), (Some(&*path), Lighting::Environment));
    let sky = shown(&harness);
    assert_ne!(sky, studio);
    harness.get_by_label("dusk sky.hdr");
    let command = copied(&mut harness);
    assert!(command.contains("--lighting environment") && command.contains("dusk sky.hdr"), "{command}");
    assert_draws(&harness, &command, "torus-view");
    press(&mut harness, egui::Key::Escape);
    press(&mut harness, egui::Key::Escape);
    // The file stays open while another light shines.
    choose(&mut harness, "Lighting", "Studio");
    assert_eq!((shown(&harness) == studio, harness.state().environment_file()), (true, Some(&*path)));
    assert!(!copied(&mut harness).contains("--environment"));
    press(&mut harness, egui::Key::Escape);
    choose(&mut harness, "Lighting", "Environment file");
    assert_eq!(shown(&harness), sky);
    harness.get_by_role_and_label(Role::Button, "Close environment").scroll_to_me();
    settle(&mut harness);
    harness.get_by_role_and_label(Role::Button, "Close environment").click();
    settle(&mut harness);
    assert_eq!((harness.state().environment_file(), lighting(&harness)), (None, Lighting::Studio));
    assert_eq!(shown(&harness), studio);
    // Undo goes back to the file with its light.
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::Z);
    settle(&mut harness);
    assert_eq!((harness.state().environment_file(), lighting(&harness)), (Some(&*path), Lighting::Environment));
    assert_eq!(shown(&harness), sky);
    for _ in 0..6 {
        harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::Z);
        settle(&mut harness);
        assert!(lighting(&harness) != Lighting::Environment || harness.state().environment_file().is_some());
    }
    assert_eq!((harness.state().environment_file(), lighting(&harness)), (None, Lighting::Studio));
}

#[test]
fn a_file_that_fails_leaves_the_light_as_it_was() {
    let folder = folder();
    let good = panorama(&folder, "good.exr");
    let bad = write(&folder, "bad.hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16 +X 32\n\x02\x02");
    let mut harness = torus();
    let studio = shown(&harness);
    open(&mut harness, &bad);
    harness.get_by_label_contains("bad.hdr: it ends too early: the file is cut short");
    assert_eq!((harness.state().environment_file(), lighting(&harness)), (None, Lighting::Studio));
    click(&mut harness, "Close");
    open(&mut harness, &good);
    let sky = shown(&harness);
    assert_ne!(sky, studio);
    for missing in [bad, folder.path().join("nowhere.exr")] {
        open(&mut harness, &missing);
        harness.get_by_label_contains(&missing.file_name().expect("a name").to_string_lossy());
        assert_eq!((harness.state().environment_file(), lighting(&harness)), (Some(&*good), Lighting::Environment));
        assert_eq!(shown(&harness), sky);
        click(&mut harness, "Close");
    }
}

#[test]
fn a_panorama_that_is_dropped_lights_the_mesh_that_is_open() {
    let folder = folder();
    let path = panorama(&folder, "Dropped.EXR");
    let mut harness = torus();
    drop_files(&mut harness, std::slice::from_ref(&path));
    settle(&mut harness);
    assert_eq!((harness.state().environment_file(), lighting(&harness)), (Some(&*path), Lighting::Environment));
    assert_eq!(harness.state().source(), Some(&Source::Shape(Shape::Torus)), "the mesh stays");
    let (mesh, other) = (copy_vase(&folder, "vase.glb"), panorama(&folder, "other.hdr"));
    drop_files(&mut harness, &[other.clone(), mesh.clone()]);
    settle(&mut harness);
    assert_eq!(harness.state().source(), Some(&Source::File(mesh)), "a mesh and a panorama go together");
    assert_eq!((harness.state().environment_file(), lighting(&harness)), (Some(&*other), Lighting::Environment));
    assert!(harness.query_by_label_contains("files were dropped").is_none());
}

#[test]
fn a_typed_path_opens_an_environment_and_repairs_are_listed() {
    let folder = folder();
    let path = write(&folder, "square.hdr", &radiance_file([16, 16], &[[0.5; 3]; 256]));
    let mut harness = torus();
    harness.get_by_label("No warnings");
    give(&mut harness, FileAction::Ask(Purpose::CompanionFile(CompanionFile::Environment)));
    while harness.state().path_asked_for().is_none() {
        harness.step();
    }
    assert!(matches!(harness.state().path_asked_for(), Some(("Environment path", Some(_)))));
    harness.run_steps(2);
    harness.get_by_label("A .hdr or .exr panorama").type_text(&path.display().to_string());
    settle(&mut harness);
    click(&mut harness, "Open");
    assert_eq!(harness.state().environment_file(), Some(&*path));
    click(&mut harness, "1 warning");
    harness
        .get_by_label_contains("square.hdr: it has 16 x 16 px; a panorama of all directions is twice as wide as high");
    press(&mut harness, egui::Key::Escape);
    give(&mut harness, FileAction::Close(CompanionFile::Environment));
    assert_eq!(harness.state().environment_file(), None);
    harness.get_by_label("No warnings");
}

#[test]
fn the_background_shows_the_environment() {
    let folder = folder();
    let path = panorama(&folder, "sky.hdr");
    let mut harness = torus();
    open(&mut harness, &path);
    let plain = *shown(&harness).get_pixel(3, 3);
    switch(&mut harness, "Show environment");
    let picture = shown(&harness);
    assert_ne!(*picture.get_pixel(3, 3), plain);
    assert!(picture.get_pixel(3, 3).0[0] > 200 || picture.get_pixel(3, 3).0[2] > 200, "{:?}", picture.get_pixel(3, 3));
    let command = copied(&mut harness);
    assert!(command.contains("--environment-background"), "{command}");
    assert_draws(&harness, &command, "torus-view");
    press(&mut harness, egui::Key::Escape);
    harness.get_by_role_and_label(Role::Slider, "Environment").set_value_accesskit(-4.0);
    settle(&mut harness);
    assert_eq!(harness.state().settings().environment_brightness, -4.0);
    let dark = shown(&harness).get_pixel(3, 3).0;
    assert!(dark[0].max(dark[2]) < 120, "{dark:?}");
    let pictures = harness.state().pictures();
    harness.run_steps(20);
    assert_eq!(harness.state().pictures(), pictures, "nothing is drawn when nothing changed");
}

/// A window that saves its state in a folder.
fn kept(folder: &TempDir) -> Harness<'static, App> {
    resumed(&folder.path().join("kept"), [1200.0, 960.0], Some(Source::Shape(Shape::Torus)))
}

#[test]
fn the_next_window_has_the_same_light() {
    let folder = folder();
    let path = panorama(&folder, "sky.hdr");
    let mut harness = kept(&folder);
    open(&mut harness, &path);
    let sky = shown(&harness);
    eframe::App::on_exit(harness.state_mut());
    let mut harness = kept(&folder);
    assert_eq!((harness.state().environment_file(), lighting(&harness)), (Some(&*path), Lighting::Environment));
    assert_eq!(shown(&harness), sky);
    eframe::App::on_exit(harness.state_mut());
    std::fs::remove_file(&path).expect("a file");
    let mut harness = kept(&folder);
    harness.get_by_label_contains("sky.hdr can't be read: there is no such file");
    assert_eq!((harness.state().environment_file(), lighting(&harness)), (None, Lighting::Studio));
    click(&mut harness, "Close");
    eframe::App::on_exit(harness.state_mut());
    let harness = kept(&folder);
    assert!(harness.query_by_label_contains("sky.hdr").is_none(), "it is said once");
}

/// The switch for the lights of a file is there only if the file has some.
#[test]
fn lights_of_a_file_can_be_switched_off() {
    let folder = folder();
    let mut document: serde_json::Value = serde_json::from_str(
        r#"{ "asset": { "version": "2.0" }, "scenes": [{ "nodes": [0, 1] }], "nodes": [{ "mesh": 0 }, { "translation": [0, 0, 2],
        "extensions": { "KHR_lights_punctual": { "light": 0 } } }],
        "extensions": { "KHR_lights_punctual": { "lights": [{ "type": "point", "intensity": 30, "color": [0, 1, 0] }] } },
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }],
        "accessors": [{ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0] }],
        "bufferViews": [{ "buffer": 0, "byteLength": 36 }] }"#,
    )
    .expect("JSON");
    let bytes: Vec<u8> =
        [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].into_iter().flat_map(f32::to_le_bytes).collect();
    write(&folder, "triangle.bin", &bytes);
    document["buffers"] = serde_json::json!([{ "byteLength": 36, "uri": "triangle.bin" }]);
    let path = write(&folder, "lit.gltf", document.to_string().as_bytes());
    let mut harness = uniform(Some(Source::File(path)));
    let lit = shown(&harness);
    choose(&mut harness, "File's lights", "Off");
    assert_ne!(shown(&harness), lit);
    choose(&mut harness, "File's lights", "On");
    assert_eq!(shown(&harness), lit);
    let command = copied(&mut harness);
    assert_draws(&harness, &command, "lit-view");
    press(&mut harness, egui::Key::Escape);
    let context = harness.ctx.clone();
    harness.state_mut().open(&context, Source::Shape(Shape::Torus));
    settle(&mut harness);
    let has_row = harness
        .get_all_by_role(Role::ComboBox)
        .any(|node| node.accesskit_node().label().as_deref() == Some("File's lights"));
    assert!(!has_row);
}

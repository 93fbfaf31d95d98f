//! What is saved for the next window: settings, recent files and their cameras.

use std::path::{Path, PathBuf};

use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use geometry::mesh::Shape;
use geometry::tessellate::{Displacement, Surface};
use inspect::settings::Settings;
use load::Source;
use pnaen::app::{App, Persistence};
use tempfile::TempDir;

use crate::{choose, click, copy_vase, press, resumed, settle, vase};

/// The file that settings are saved in.
fn settings_file(folder: &TempDir) -> PathBuf {
    folder.path().join("kept/window.json")
}

/// A copy of the vase under another name.
fn mesh(folder: &TempDir, name: &str) -> Source {
    Source::File(copy_vase(folder, name))
}

/// A window that saves its state in a folder.
fn window(folder: &TempDir, source: Option<Source>) -> Harness<'static, App> {
    resumed(&folder.path().join("kept"), [1200.0, 960.0], source)
}

/// Closes a window.
fn close(mut harness: Harness<App>) {
    eframe::App::on_exit(harness.state_mut());
}

fn open(harness: &mut Harness<App>, source: &Source) {
    let context = harness.ctx.clone();
    harness.state_mut().open(&context, source.clone());
    settle(harness);
    assert_eq!(harness.state().source(), Some(source));
}

fn recent_menu(harness: &mut Harness<App>) {
    click(harness, "File");
    harness.get_by_label_contains("Open recent").click();
    settle(harness);
}

#[test]
fn settings_cameras_and_recent_files_survive_a_restart() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let (first, second) = (mesh(&folder, "first.glb"), mesh(&folder, "second.glb"));
    let mut harness = window(&folder, None);
    assert_eq!(harness.state().settings(), &Settings::greeting(), "the settings of a first start");
    choose(&mut harness, "Surface", "Phong AEN");
    harness.get_by_role_and_label(Role::CheckBox, "Cracks").click();
    open(&mut harness, &first);
    let framed = *harness.state().camera();
    press(&mut harness, egui::Key::Num3);
    press(&mut harness, egui::Key::PageUp);
    let looked = *harness.state().camera();
    open(&mut harness, &second);
    assert_ne!(*harness.state().camera(), looked, "another file is framed");
    let settings = *harness.state().settings();
    assert_eq!((settings.tessellation.surface, settings.overlays.cracks), (Surface::PhongAen, true));
    close(harness);

    let mut harness = window(&folder, None);
    assert_eq!(harness.state().source(), Some(&Source::Vase), "the last file isn't opened by itself");
    assert_eq!(harness.state().settings(), &settings);
    recent_menu(&mut harness);
    harness.get_by_label_contains("second.glb");
    harness.get_by_label_contains("first.glb").click();
    settle(&mut harness);
    assert_eq!((harness.state().source(), *harness.state().camera()), (Some(&first), looked));
    press(&mut harness, egui::Key::F);
    assert_ne!(*harness.state().camera(), looked, "F frames the mesh");
    assert_eq!(harness.state().camera().distance, framed.distance);
    close(harness);

    let harness = window(&folder, Some(first.clone()));
    assert_eq!((harness.state().source(), harness.state().settings()), (Some(&first), &settings));
    assert_eq!(
        harness.state().camera().azimuth,
        looked.azimuth,
        "a file that is given as an argument has its camera as well"
    );
}

#[test]
fn changes_are_written_after_a_while_without_drawing_again() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let mut harness = window(&folder, Some(Source::Shape(Shape::Torus)));
    choose(&mut harness, "Surface", "Nagata");
    let (pictures, start) = (harness.state().pictures(), std::time::Instant::now());
    let written = || Persistence::read(settings_file(&folder).parent()).settings().tessellation.surface;
    while written() != Surface::Nagata {
        assert!(start.elapsed() < crate::PATIENCE, "it isn't written");
        harness.step();
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    assert_eq!(harness.state().pictures(), pictures);
    let is_file = |name: &std::ffi::OsString| name == "window.json";
    let names: Vec<_> = std::fs::read_dir(folder.path().join("kept")).expect("a folder").flatten().collect();
    assert!(
        names.iter().map(|entry| entry.file_name()).all(|name| is_file(&name)),
        "no other file is left in the folder"
    );
}

#[test]
fn a_missing_recent_file_is_reported_and_leaves_the_list() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let (first, second) = (mesh(&folder, "first.glb"), mesh(&folder, "second.glb"));
    let mut harness = window(&folder, Some(first));
    open(&mut harness, &second);
    std::fs::remove_file(folder.path().join("first.glb")).expect("it is there");
    recent_menu(&mut harness);
    harness.get_by_label_contains("first.glb").click();
    settle(&mut harness);
    assert_eq!(harness.state().source(), Some(&second), "the open mesh stays");
    harness.get_by_label_contains("first.glb can't be read");
    harness.get_by_label_contains("removed from the recent files");
    click(&mut harness, "Close");
    recent_menu(&mut harness);
    assert!(harness.query_by_label_contains("first.glb").is_none());
    assert_eq!(harness.get_all_by_label_contains("second.glb").count(), 2, "the title and the list's entry");
}

/// The files and cameras that are saved in a folder.
fn kept_files(folder: &TempDir) -> serde_json::Value {
    let text = std::fs::read(settings_file(folder)).expect("the saved state");
    serde_json::from_slice::<serde_json::Value>(&text).expect("JSON")["files"].take()
}

#[test]
fn a_file_that_was_missing_for_a_while_is_listed_again_with_its_camera() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let (first, away) = (mesh(&folder, "first.glb"), folder.path().join("away.glb"));
    let mut harness = window(&folder, Some(first.clone()));
    std::fs::rename(folder.path().join("first.glb"), &away).expect("it is there");
    press(&mut harness, egui::Key::R);
    harness.get_by_label_contains("removed from the recent files");
    std::fs::rename(&away, folder.path().join("first.glb")).expect("it is there");
    press(&mut harness, egui::Key::R);
    press(&mut harness, egui::Key::Num3);
    let looked = *harness.state().camera();
    recent_menu(&mut harness);
    assert_eq!(harness.get_all_by_label_contains("first.glb").count(), 2, "the title and the list's entry");
    close(harness);
    assert_eq!(kept_files(&folder).as_array().map(Vec::len), Some(1));
    assert_eq!(*window(&folder, Some(first)).state().camera(), looked);
}

#[test]
fn a_file_that_was_missing_when_the_window_closed_keeps_its_camera() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let (first, away) = (mesh(&folder, "first.glb"), folder.path().join("away.glb"));
    let mut harness = window(&folder, Some(first.clone()));
    press(&mut harness, egui::Key::Num3);
    let looked = *harness.state().camera();
    std::fs::rename(folder.path().join("first.glb"), &away).expect("it is there");
    press(&mut harness, egui::Key::R);
    close(harness);
    let mut harness = window(&folder, None);
    click(&mut harness, "File");
    assert!(
        harness.get_by_label_contains("Open recent").accesskit_node().is_disabled(),
        "the missing file isn't listed"
    );
    close(harness);
    std::fs::rename(&away, folder.path().join("first.glb")).expect("it is there");
    let mut harness = window(&folder, Some(first));
    assert_eq!(*harness.state().camera(), looked);
    recent_menu(&mut harness);
    assert_eq!(harness.get_all_by_label_contains("first.glb").count(), 2, "the title and the list's entry");
}

#[test]
fn a_recent_file_can_be_opened_with_keys() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let first = mesh(&folder, "first.glb");
    let mut harness = window(&folder, Some(first.clone()));
    open(&mut harness, &Source::Shape(Shape::Torus));
    harness.get_by_role_and_label(Role::Button, "File").focus();
    press(&mut harness, egui::Key::Enter);
    harness.get_by_label_contains("Open recent").focus();
    press(&mut harness, egui::Key::Enter);
    harness.get_by_label_contains("first.glb").focus();
    press(&mut harness, egui::Key::Enter);
    assert_eq!(harness.state().source(), Some(&first));
}

#[test]
fn forgetting_goes_back_to_the_state_of_a_first_start() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let mut harness = window(&folder, None);
    click(&mut harness, "File");
    assert!(
        harness.get_by_label_contains("Open recent").accesskit_node().is_disabled(),
        "there are no recent files yet"
    );
    press(&mut harness, egui::Key::Escape);
    let mesh = mesh(&folder, "first.glb");
    open(&mut harness, &mesh);
    choose(&mut harness, "Surface", "PN");
    press(&mut harness, egui::Key::Num1);
    press(&mut harness, egui::Key::PageUp);
    press(&mut harness, egui::Key::S);
    harness.ctx.set_theme(egui::Theme::Light);
    settle(&mut harness);
    let before = *harness.state().settings();
    click(&mut harness, "File");
    harness.get_by_label_contains("Forget all settings").click();
    settle(&mut harness);
    assert_eq!(harness.state().settings(), &before, "the window asks first");
    click(&mut harness, "Forget them");
    assert_eq!((harness.state().settings(), harness.state().source()), (&Settings::opening(), Some(&mesh)));
    let framed = *harness.state().camera();
    assert_eq!((framed.azimuth, framed.elevation), (30.0, 20.0), "the camera of a first start");
    press(&mut harness, egui::Key::F);
    assert_eq!(*harness.state().camera(), framed, "which shows all of the mesh");
    assert_eq!(harness.ctx.options(|options| options.theme_preference), egui::ThemePreference::System);
    close(harness);
    let text = std::fs::read_to_string(settings_file(&folder)).expect("the saved state");
    assert!(!text.contains("first.glb"), "{text}");
    let mut harness = window(&folder, None);
    assert_eq!(harness.state().settings(), &Settings::greeting());
    click(&mut harness, "File");
    assert!(harness.get_by_label_contains("Open recent").accesskit_node().is_disabled());
}

#[test]
fn forgetting_can_be_confirmed_or_cancelled_with_keys() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let mut harness = window(&folder, None);
    choose(&mut harness, "Surface", "PN");
    for forgets in [false, true] {
        harness.get_by_role_and_label(Role::Button, "File").focus();
        press(&mut harness, egui::Key::Enter);
        harness.get_by_label_contains("Forget all settings").focus();
        press(&mut harness, egui::Key::Enter);
        assert_eq!(harness.state().settings().tessellation.surface, Surface::Pn, "the window asks first");
        harness.get_by_label("Forget them").focus();
        press(&mut harness, if forgets { egui::Key::Enter } else { egui::Key::Escape });
        assert_eq!(harness.state().settings().tessellation.surface == Surface::Pn, !forgets);
    }
}

#[test]
fn damaged_settings_are_renamed_and_the_window_opens() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    std::fs::create_dir(folder.path().join("kept")).expect("a writable folder");
    std::fs::write(settings_file(&folder), "{\"settings\": {\"surf").expect("a writable folder");
    let mut harness = window(&folder, None);
    assert_eq!(harness.state().settings(), &Settings::greeting());
    harness.get_by_label_contains("window.json is damaged");
    assert!(settings_file(&folder).with_file_name("window.damaged.json").exists());
    click(&mut harness, "Close");
    choose(&mut harness, "Surface", "Flat");
    close(harness);
    assert_eq!(
        window(&folder, None).state().settings().tessellation.surface,
        Surface::Flat,
        "settings are saved again"
    );
}

#[test]
fn heights_and_selection_are_not_saved() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let mut harness = window(&folder, Some(vase()));
    let waves = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/waves.png");
    let context = harness.ctx.clone();
    harness.state_mut().open_path(&context, waves);
    settle(&mut harness);
    assert_eq!(harness.state().settings().tessellation.displacement, Displacement::On);
    harness.state_mut().select_edge(3);
    press(&mut harness, egui::Key::Z);
    close(harness);
    let harness = window(&folder, Some(vase()));
    let app = harness.state();
    assert_eq!((app.settings().tessellation.displacement, app.selected_edge()), (Displacement::Off, None));
    assert_eq!(app.loaded().and_then(|loaded| loaded.preparation.heights.clone()), None);
}

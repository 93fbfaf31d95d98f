//! Tests of the window, driven by the names that its controls have for screen readers.

mod animation;
mod chart;
mod commands;
mod deviation;
mod driver;
mod editing;
mod environment;
mod file_cameras;
mod findings;
mod foreign_factors;
mod halves;
mod import;
mod lasting;
mod layout;
mod lists;
mod loading;
mod lod_shader;
mod lost;
mod morphs;
mod opening;
mod parts;
mod picking;
mod saving;
mod scenes;
mod silhouette;
mod spending;
mod surface_shader;
mod tasks;
mod techniques;
mod typing;
mod undoing;
mod variants;
mod viewing;
mod warm_up;

use std::path::{Path, PathBuf};

use clap::Parser;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use geometry::mesh::Shape;
use geometry::tessellate::{Clip, Edges, Lod, Partitioning, Surface, Tessellation};
use inspect::settings::Colors;
use load::Source;
use pnaen::app::{App, Persistence};
use pnaen::cli::Cli;
use pnaen::commands::{Action, all};
use tempfile::TempDir;

use driver::{PATIENCE, settle};
use opening::{open, open_alone};

fn window(source: Option<Source>) -> Harness<'static, App> {
    let source = source.or(Some(Source::Shape(Shape::CubeSplit)));
    unfolded(open(Harness::builder().with_size([1200.0, 960.0]), source, |_, _| ()))
}

/// A window with all sections open and everything drawn.
fn unfolded(mut harness: Harness<'static, App>) -> Harness<'static, App> {
    open_all_sections(&mut harness);
    settle(&mut harness);
    harness
}

/// A window that goes on where the last one with this folder ended, and keeps its own state there.
fn resumed(kept: &Path, size: [f32; 2], source: Option<Source>) -> Harness<'static, App> {
    let mut harness = open(Harness::builder().with_size(size), source, |app, context| {
        app.resume(context, Persistence::read(Some(kept)));
    });
    settle(&mut harness);
    harness
}

/// Opens all sections of both panels, so that every control is there.
fn open_all_sections(harness: &mut Harness<App>) {
    let context = harness.ctx.clone();
    let all = all(&harness.state().availability());
    let open = all.iter().find(|command| command.action == Action::OpenAllSections).expect("a command");
    harness.state_mut().give(&context, open);
}

/// A window that draws every patch with one factor and fractional partitioning, so that counts don't depend on the view.
fn uniform(source: Option<Source>) -> Harness<'static, App> {
    made_uniform(window(source))
}

fn made_uniform(mut harness: Harness<'static, App>) -> Harness<'static, App> {
    choose(&mut harness, "Partitioning", "Fractional odd");
    choose(&mut harness, "LOD", "Uniform");
    choose(&mut harness, "Clipping", "Off");
    if harness.state().settings().tessellation.cull_back_faces {
        switch(&mut harness, "Cull back faces");
    }
    settle(&mut harness);
    harness
}

/// The same, which opens a file of this name and content; and the folder of the file, which must be kept for as long as the window.
fn uniform_of(name: &str, content: impl AsRef<[u8]>) -> (TempDir, Harness<'static, App>) {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = folder.path().join(name);
    std::fs::write(&path, content).expect("a writable temporary folder");
    (folder, uniform(Some(Source::File(path))))
}

/// The button that stops what is under way, which names its key.
const STOP: &str = "Stop (Escape)";

fn press(harness: &mut Harness<App>, key: egui::Key) {
    harness.key_press(key);
    settle(harness);
}

fn click(harness: &mut Harness<App>, label: &str) {
    harness.get_by_label(label).click();
    settle(harness);
}

/// Scrolls a panel to what has this label.
fn scroll_to(harness: &mut Harness<App>, label: &str) {
    harness.get_by_label(label).scroll_to_me();
    settle(harness);
}

/// Clicks on a switch. The panel is scrolled to it first, since not all rows fit the window.
fn switch(harness: &mut Harness<App>, label: &str) {
    harness.get_by_role_and_label(Role::CheckBox, label).scroll_to_me();
    settle(harness);
    harness.get_by_role_and_label(Role::CheckBox, label).click();
    settle(harness);
}

/// Opens a list. The panel is scrolled to it first, since not all rows fit the window.
fn open_list(harness: &mut Harness<App>, list: &str) {
    harness.get_by_role_and_label(Role::ComboBox, list).scroll_to_me();
    settle(harness);
    harness.get_by_role_and_label(Role::ComboBox, list).click();
    settle(harness);
}

/// Picks an entry of a list.
fn choose(harness: &mut Harness<App>, list: &str, entry: &str) {
    open_list(harness, list);
    click(harness, entry);
}

/// Runs one of the program's commands in this process, which writes `output`.
fn run_command<'a>(words: impl IntoIterator<Item = &'a str>, output: &'a Path) {
    let output = output.to_str().expect("a path in UTF-8");
    let words = ["pnaen"].into_iter().chain(words).chain(["-o", output]);
    let command = Cli::try_parse_from(words).expect("a command").command.expect("a command");
    // Errors are on standard error; whoever reads the output sees that there is none.
    let _ = pnaen::cli::run(command);
}

/// Copies the vase into a folder under another name.
fn copy_vase(folder: &TempDir, name: &str) -> PathBuf {
    let (Source::File(vase), path) = (vase(), folder.path().join(name)) else { unreachable!("it is a file") };
    std::fs::copy(vase, &path).expect("a writable folder");
    path
}

fn vase() -> Source {
    Source::File(PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/vase.glb")))
}

#[test]
fn the_window_opens_a_cube_without_cracks() {
    let mut harness = window(None);
    let app = harness.state();
    assert_eq!(app.source(), Some(&Source::Shape(Shape::CubeSplit)));
    assert_eq!((app.settings().tessellation.surface, app.settings().tessellation.lod), (Surface::PnAen, Lod::Error));
    assert_eq!(app.cracks().map(|cracks| cracks.edges.len()), Some(0));
    harness.get_by_label("cracks 0");
    harness.get_by_label("6 of 12 patches");
    switch(&mut harness, "Cull back faces");
    settle(&mut harness);
    harness.get_by_label("12 of 12 patches");
}

#[test]
fn the_factor_can_be_slid_typed_and_stepped() {
    let mut harness = uniform(None);
    let before = harness.state().totals();
    harness.get_by_role_and_label(Role::Slider, "Factor").set_value_accesskit(12.0);
    settle(&mut harness);
    let slid = harness.state().settings().tessellation.factor;
    press(&mut harness, egui::Key::Plus);
    assert_eq!(harness.state().settings().tessellation.factor, slid + 1.0);
    assert_ne!(harness.state().totals(), before);
    press(&mut harness, egui::Key::Minus);
    assert_eq!(harness.state().settings().tessellation.factor, slid);
}

#[test]
fn every_switch_does_what_it_says() {
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    for (label, is_on) in [
        ("Patch borders", (|app: &App| app.settings().overlays.patches) as fn(&App) -> bool),
        ("Adjacency edges", |app| app.settings().overlays.adjacency),
        ("Cracks", |app| app.settings().overlays.cracks),
        ("Folds", |app| app.settings().overlays.folds),
        ("Split view", |app| app.settings().split.is_some()),
    ] {
        assert!(!is_on(harness.state()), "{label} is on before it is clicked");
        let pictures = harness.state().pictures();
        let is_listed = harness.query_by_role_and_label(Role::CheckBox, label).is_none();
        if is_listed {
            click(&mut harness, "Overlays");
        }
        switch(&mut harness, label);
        if is_listed {
            click(&mut harness, "Overlays");
        }
        assert!(is_on(harness.state()), "{label}");
        assert!(harness.state().pictures() > pictures, "{label} isn't drawn");
    }
    assert!(!harness.state().settings().overlays.wireframe, "wires are off until they are asked for");
    press(&mut harness, egui::Key::W);
    assert!(harness.state().settings().overlays.wireframe);
    choose(&mut harness, "Partitioning", "Power of two");
    assert_eq!(harness.state().settings().tessellation.partitioning, Partitioning::Pow2);
    choose(&mut harness, "LOD", "Edge length");
    assert_eq!(harness.state().settings().tessellation.lod, Lod::EdgeLength);
    choose(&mut harness, "LOD", "Distance");
    assert_eq!(harness.state().settings().tessellation.lod, Lod::Distance);
    harness.get_by_role_and_label(Role::SpinButton, "Near");
    harness.get_by_role_and_label(Role::SpinButton, "far");
    choose(&mut harness, "LOD", "Screen error");
    assert_eq!(harness.state().settings().tessellation.lod, Lod::Error);
    harness.get_by_role_and_label(Role::Slider, "Tolerance");
    choose(&mut harness, "LOD", "Edge length");
    choose(&mut harness, "Clipping", "Frustum");
    assert_eq!(harness.state().settings().tessellation.clip, Clip::Frustum);
    let before = *harness.state().settings();
    choose(&mut harness, "Shared edges", "By each patch");
    let published = Tessellation { edges: Edges::AsPublished, ..before.tessellation };
    assert_eq!(*harness.state().settings(), before.with(published), "nothing else changes");
    press(&mut harness, egui::Key::E);
    assert_eq!(*harness.state().settings(), before);
}

#[test]
fn subtriangulation_uses_uniform_lod_and_the_chosen_lod_comes_back() {
    let mut harness = window(None);
    let opening = *harness.state().settings();
    assert_eq!(opening.tessellation.used_lod(), Lod::Error);
    choose(&mut harness, "Partitioning", "Subtriangulation");
    let settings = *harness.state().settings();
    assert_eq!(
        (settings.tessellation.partitioning, settings.tessellation.used_lod()),
        (Partitioning::Subtriangulation, Lod::Uniform)
    );
    // Half of the cube's patches face away and are culled; the factor is 8.
    assert_eq!(harness.state().totals(), Some((6 * 45, 6 * 64)));
    let lod = harness.get_by_role_and_label(Role::ComboBox, "LOD");
    assert!(lod.accesskit_node().is_disabled(), "LOD can't be chosen");
    assert_eq!(lod.value().as_deref(), Some("Uniform"));
    press(&mut harness, egui::Key::L);
    assert_eq!(*harness.state().settings(), settings, "the key L changes nothing");
    harness.get_by_role_and_label(Role::Slider, "Factor").set_value_accesskit(4.5);
    settle(&mut harness);
    assert_eq!(harness.state().totals(), Some((6 * 21, 6 * 25)));
    assert_eq!(harness.state().cracks().map(|cracks| cracks.different_bits), Some(0));
    choose(&mut harness, "Partitioning", "Integer");
    assert_eq!(
        (harness.state().settings().tessellation.used_lod(), harness.state().settings().tessellation.factor),
        (opening.tessellation.lod, 4.5)
    );
    assert!(!harness.get_by_role_and_label(Role::ComboBox, "LOD").accesskit_node().is_disabled());
}

#[test]
fn nothing_is_drawn_when_nothing_changed() {
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    let pictures = harness.state().pictures();
    harness.hover_at(egui::pos2(600.0, 400.0));
    harness.run_steps(20);
    assert_eq!(harness.state().pictures(), pictures);
    press(&mut harness, egui::Key::Num1);
    assert_eq!(harness.state().pictures(), pictures + 1);
}

#[test]
fn the_pointer_orbits_and_zooms() {
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    let pictures = harness.state().pictures();
    let before = *harness.state().camera();
    harness.drag_at(egui::pos2(600.0, 400.0));
    harness.run_steps(1);
    harness.hover_at(egui::pos2(650.0, 420.0));
    harness.run_steps(1);
    harness.drop_at(egui::pos2(650.0, 420.0));
    settle(&mut harness);
    let orbited = *harness.state().camera();
    assert_ne!(orbited.azimuth, before.azimuth);
    assert_eq!(orbited.target, before.target);
    harness.hover_at(egui::pos2(650.0, 420.0));
    harness.event(egui::Event::MouseWheel {
        unit: egui::MouseWheelUnit::Line,
        delta: egui::vec2(0.0, 2.0),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Wheel,
        modifiers: egui::Modifiers::NONE,
    });
    settle(&mut harness);
    harness.run_steps(10);
    settle(&mut harness);
    assert!(harness.state().camera().distance < orbited.distance);
    assert!(harness.state().pictures() > pictures);
}

#[test]
fn a_file_is_opened_by_its_path_and_reloading_keeps_settings_and_camera() {
    let mut harness = uniform(None);
    press(&mut harness, egui::Key::B);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::L);
    settle(&mut harness);
    let Source::File(path) = vase() else { unreachable!("it is a file") };
    harness
        .get_by_label("A .gltf, .glb, .vrm, .fbx, .obj, .stl, .ply, .off or .3mf file, shape:NAME, a height image (.png, .jpg, .webp, .tif), or an environment (.hdr, .exr)")
        .type_text(&path.display().to_string());
    settle(&mut harness);
    click(&mut harness, "Open");
    assert_eq!(harness.state().source(), Some(&vase()));
    assert_eq!(harness.state().cracks().map(|cracks| cracks.different_bits), Some(0));
    harness.get_by_label("308 of 308 patches");
    press(&mut harness, egui::Key::Num3);
    let camera = *harness.state().camera();
    press(&mut harness, egui::Key::R);
    assert_eq!(*harness.state().camera(), camera);
    assert_eq!(harness.state().settings().overlays.colors, Colors::Barycentric);
}

#[test]
fn a_file_that_cannot_be_loaded_changes_nothing() {
    let mut harness = uniform(Some(vase()));
    press(&mut harness, egui::Key::A);
    let (settings, camera) = (*harness.state().settings(), *harness.state().camera());
    let context = harness.ctx.clone();
    harness.state_mut().open(&context, Source::File(PathBuf::from("nowhere.glb")));
    settle(&mut harness);
    assert_eq!(harness.state().source(), Some(&vase()), "the old mesh stays");
    assert_eq!((*harness.state().settings(), *harness.state().camera()), (settings, camera));
    harness.get_by_label_contains("nowhere.glb can't be read");
    click(&mut harness, "Close");
    assert!(harness.query_by_label_contains("nowhere.glb").is_none());
}

#[test]
fn a_dropped_file_is_opened() {
    let mut harness = uniform(None);
    let Source::File(path) = vase() else { unreachable!("it is a file") };
    loading::drop_files(&mut harness, &[path]);
    settle(&mut harness);
    assert_eq!(harness.state().source(), Some(&vase()));
}

#[test]
fn every_shape_is_in_the_menu() {
    let mut harness = uniform(None);
    for shape in Shape::ALL {
        click(&mut harness, "File");
        harness.get_by_label_contains("Shapes").click();
        settle(&mut harness);
        harness.get_by_role_and_label(Role::Button, shape.title()).click();
        settle(&mut harness);
        assert_eq!(harness.state().source(), Some(&Source::Shape(shape)));
        assert_eq!(harness.state().cracks().map(|cracks| cracks.different_bits), Some(0), "{shape:?}");
    }
}

#[test]
fn both_themes_show_the_picture_and_legible_controls() {
    for theme in [egui::Theme::Dark, egui::Theme::Light] {
        let builder = Harness::builder().with_size([1200.0, 800.0]).with_theme(theme);
        let mut harness = open(builder, Some(vase()), |_, _| ());
        settle(&mut harness);
        let picture = harness.render().expect("a picture of the window");
        let panel = picture.get_pixel(8, 700).0;
        assert_eq!(panel[0] > 128, theme == egui::Theme::Light, "{theme:?}: {panel:?}");
        // The vase's blue belt, in the middle of the viewport.
        let middle = picture.get_pixel(610, 425).0;
        assert!(middle[2] > middle[0], "{theme:?}: {middle:?}");
    }
}

//! A function of the user's own in place of the surface in the window, its changes on disk, and undo of both kinds of shader.

use std::path::Path;

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use geometry::mesh::Shape;
use geometry::tessellate::{Lod, Surface};
use load::Source;
use pnaen::app::App;

use crate::editing::{assert_draws, copied, press_with};
use crate::lod_shader::{until, write as write_lod};
use crate::{choose, press, resumed, settle, uniform};

const PN: &str = include_str!("../../assets/surface/pn.wgsl");
const PN_AEN: &str = include_str!("../../assets/surface/pn-aen.wgsl");

fn write(path: &Path, text: &str) {
    std::fs::write(path, text).expect("a writable temporary folder");
}

fn open(harness: &mut Harness<App>, path: &Path) {
    let context = harness.ctx.clone();
    harness.state_mut().open_surface_shader(&context, path.to_owned());
    settle(harness);
}

fn surface(harness: &Harness<App>) -> Surface {
    harness.state().settings().tessellation.surface
}

/// The number of edges that crack, once that is measured.
fn cracked(app: &App) -> Option<usize> {
    app.cracks().map(|cracks| cracks.cracked().len())
}

#[test]
fn a_change_on_disk_is_shown_and_where_it_tears() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = folder.path().join("own.wgsl");
    write(&path, PN_AEN);
    let mut harness = uniform(Some(Source::Shape(Shape::CubeSplit)));
    choose(&mut harness, "Surface", "Nagata AEN");
    open(&mut harness, &path);
    assert_eq!(harness.state().surface_shader_file(), Some(&*path));
    harness.get_by_label("own.wgsl");
    assert!(harness.query_by_role_and_label(Role::ComboBox, "Surface").is_none(), "the function has its place");
    let list = harness.get_by_role_and_label(Role::ComboBox, "Shading").rect();
    let button = harness.get_by_role_and_label(Role::Button, "Close the surface").rect();
    assert!(button.right() <= list.right(), "the panel shows all of the button: {button:?} and {list:?}");
    assert_eq!(cracked(harness.state()), Some(0));
    write(&path, PN);
    until(&mut harness, "the change isn't seen", |app| cracked(app) == Some(12));
    // A version that can't be used leaves the last one.
    write(&path, &PN.replace("edge.normal_b)", "\n edge.normal_c)"));
    until(&mut harness, "the change isn't seen", |app| app.surface_shader_error().is_some());
    harness.get_by_label_contains("own.wgsl, line ");
    harness.get_by_label_contains("The version before it stays.");
    assert_eq!(cracked(harness.state()), Some(12));
    // So does one without end.
    let spin = "fn edge_points(edge: SurfaceEdge, triangle: SurfaceTriangle) -> EdgePoints {\n\
                var p = edge.a; loop { p += edge.b; } return EdgePoints(p, p); }";
    write(&path, spin);
    until(&mut harness, "the loop isn't stopped", |app| {
        app.surface_shader_error().is_some_and(|error| error.contains("the surface shader took too long"))
    });
    until(&mut harness, "the version before isn't back", |app| cracked(app) == Some(12));
    write(&path, PN);
    until(&mut harness, "the change isn't seen", |app| app.surface_shader_error().is_none());
    let command = copied(&mut harness);
    assert!(command.contains("--surface-shader ") && !command.contains("--surface "), "{command}");
    assert_draws(&harness, &command, "cube-split-view");
    // Without a reference surface there is no deviation.
    press(&mut harness, Key::V);
    harness.get_by_label_contains("Nothing is measured: the CPU doesn't know the surface of a shader.");
    press(&mut harness, Key::V);
    harness.get_by_role_and_label(Role::Button, "Close the surface").click();
    settle(&mut harness);
    assert_eq!((harness.state().surface_shader_file(), surface(&harness)), (None, Surface::NagataAen));
    assert_eq!(cracked(harness.state()), Some(0));
}

#[test]
fn left_of_a_split_is_a_surface_of_ours() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = folder.path().join("own.wgsl");
    write(&path, PN);
    let mut harness = uniform(Some(Source::Shape(Shape::CubeSplit)));
    press(&mut harness, Key::S);
    choose(&mut harness, "Left", "PN-AEN");
    open(&mut harness, &path);
    assert!(harness.get_by_label("Edit left (A)").accesskit_node().is_disabled(), "the shader is of the right half");
    press(&mut harness, Key::C);
    assert_eq!(cracked(harness.state()), Some(12));
    let command = copied(&mut harness);
    assert!(command.contains("--split-left surface=pn-aen"), "{command}");
    assert_draws(&harness, &command, "cube-split-view");
    // A left half that is made while the function is there has none either.
    choose(&mut harness, "Left", "Untessellated");
    choose(&mut harness, "Left", "PN-AEN");
    let command = copied(&mut harness);
    assert_draws(&harness, &command, "cube-split-view");
}

#[test]
fn opening_and_closing_a_shader_is_one_step_of_undo() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let (path, of_lod) = (folder.path().join("own.wgsl"), folder.path().join("lod.wgsl"));
    write(&path, PN);
    write_lod(&of_lod, "5.0");
    let mut harness = uniform(Some(Source::Shape(Shape::CubeSplit)));
    choose(&mut harness, "Surface", "PN-AEN");
    press(&mut harness, Key::L);
    let lod = harness.state().settings().tessellation.lod;
    assert_ne!(lod, Lod::Uniform);
    open(&mut harness, &path);
    let context = harness.ctx.clone();
    harness.state_mut().open_lod_shader(&context, of_lod.clone());
    settle(&mut harness);
    let files = |app: &App| [app.lod_shader_file(), app.surface_shader_file()].map(|file| file.is_some());
    assert_eq!((files(harness.state()), cracked(harness.state())), ([true, true], Some(12)));
    // The settings that both have replaced aren't steps of their own.
    let undo = |harness: &mut Harness<App>| {
        press_with(harness, Modifiers::COMMAND, Key::Z);
        settle(harness);
    };
    let redo = |harness: &mut Harness<App>| {
        press_with(harness, Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
        settle(harness);
    };
    undo(&mut harness);
    assert_eq!((files(harness.state()), harness.state().settings().tessellation.lod), ([false, true], lod));
    undo(&mut harness);
    assert_eq!((files(harness.state()), surface(&harness)), ([false, false], Surface::PnAen));
    assert_eq!(cracked(harness.state()), Some(0));
    redo(&mut harness);
    assert_eq!((files(harness.state()), cracked(harness.state())), ([false, true], Some(12)));
    redo(&mut harness);
    assert_eq!(files(harness.state()), [true, true]);
    // Another setting is undone while both stay, and closing one is a step too.
    choose(&mut harness, "Shading", "Quadratic normals");
    undo(&mut harness);
    assert_eq!((files(harness.state()), cracked(harness.state())), ([true, true], Some(12)));
    harness.get_by_role_and_label(Role::Button, "Close the surface").click();
    settle(&mut harness);
    assert_eq!((files(harness.state()), surface(&harness)), ([true, false], Surface::PnAen));
    undo(&mut harness);
    assert_eq!((files(harness.state()), cracked(harness.state())), ([true, true], Some(12)));
}

#[test]
fn the_next_session_opens_it_again_and_has_the_surface_before() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let kept = tempfile::tempdir().expect("a writable temporary folder");
    let path = folder.path().join("own.wgsl");
    write(&path, PN);
    let size = [1200.0, 960.0];
    let mut first = resumed(kept.path(), size, Some(Source::Shape(Shape::CubeSplit)));
    choose(&mut first, "Surface", "PN crease");
    open(&mut first, &path);
    eframe::App::on_exit(first.state_mut());
    drop(first);
    let mut second = resumed(kept.path(), size, Some(Source::Shape(Shape::CubeSplit)));
    assert_eq!((second.state().surface_shader_file(), cracked(second.state())), (Some(&*path), Some(12)));
    second.get_by_role_and_label(Role::Button, "Close the surface").click();
    settle(&mut second);
    assert_eq!(surface(&second), Surface::PnCrease);
}

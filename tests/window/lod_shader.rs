//! Functions of the user's own in place of LOD in the window, and their changes on disk.

use std::path::Path;
use std::time::{Duration, Instant};

use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use geometry::mesh::Shape;
use geometry::tessellate::Lod;
use load::Source;
use pnaen::app::App;

use crate::driver::PATIENCE;
use crate::editing::{assert_draws, copied};
use crate::{choose, press, resumed, settle, switch, uniform};

/// Writes a file whose function for edges returns this.
pub(super) fn write(path: &Path, returns: &str) {
    let text = format!("fn edge_factor(edge: Edge, triangle: Triangle, view: View) -> f32 {{ return {returns}; }}");
    std::fs::write(path, text).expect("a writable temporary folder");
}

fn open(harness: &mut Harness<App>, path: &Path) {
    let context = harness.ctx.clone();
    harness.state_mut().open_lod_shader(&context, path.to_owned());
    settle(harness);
}

/// Runs frames until the window has seen a change on disk, and then until nothing is under way.
pub(super) fn until(harness: &mut Harness<App>, what: &str, holds: impl Fn(&App) -> bool) {
    let start = Instant::now();
    while !holds(harness.state()) {
        assert!(start.elapsed() < PATIENCE, "{what}");
        std::thread::sleep(Duration::from_millis(10));
        harness.step();
    }
    settle(harness);
}

fn totals(app: &App) -> (u64, u64) {
    app.totals().expect("a mesh")
}

#[test]
fn a_change_on_disk_is_shown_and_an_asymmetry_is_caught() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = folder.path().join("own.wgsl");
    write(&path, "3.0");
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    let before = totals(harness.state());
    open(&mut harness, &path);
    assert_eq!(harness.state().lod_shader_file(), Some(&*path));
    harness.get_by_label("own.wgsl");
    let list = harness.get_by_role_and_label(Role::ComboBox, "Surface").rect();
    let close = harness.get_by_role_and_label(Role::Button, "Close the shader").rect();
    assert!(close.right() <= list.right(), "the panel shows all of {close:?}, as it does of {list:?}");
    let threes = totals(harness.state());
    // Fractional odd at 3: as many triangles for each of the torus' 256 patches.
    assert!(threes != before && threes.1.is_multiple_of(256), "{threes:?}");
    assert_eq!(harness.state().cracks().expect("measured").different_factors, 0);
    assert!(harness.query_by_label_contains(" edges with different factors").is_none());
    // Factors follow the start of the side, of which an edge has two.
    write(&path, "4.0 + 2.0 * edge.a.y / view.radius");
    until(&mut harness, "the change isn't seen", |app| totals(app) != threes);
    assert!(harness.state().cracks().expect("measured").different_factors > 200);
    harness.get_by_label_contains(" edges with different factors").click();
    settle(&mut harness);
    let edge = harness.state().selected_edge().expect("the edge with the largest difference");
    // Going there froze LOD, so that what was counted stays.
    switch(&mut harness, "Freeze LOD camera");
    assert!(harness.get_all_by_label_contains(&format!("{edge:<9}")).next().is_some(), "it is in the list");
    // Factors that follow the view do so without a readback of their own.
    press(&mut harness, egui::Key::Escape);
    press(&mut harness, egui::Key::F);
    write(&path, "clamp(60.0 - 8.0 * distance(edge.a + edge.b, 2.0 * view.eye) / view.radius, 1.0, 64.0)");
    until(&mut harness, "the change isn't seen", |app| {
        app.cracks().is_some_and(|cracks| cracks.different_factors == 0)
    });
    let from_afar = totals(harness.state());
    (0..3).for_each(|_| press(&mut harness, egui::Key::PageUp));
    assert!(totals(harness.state()).1 > from_afar.1, "nearer by, factors are larger");
    let command = copied(&mut harness);
    assert!(command.contains("--lod-shader ") && !command.contains("--lod "), "{command}");
    assert_draws(&harness, &command, "torus-view");
    press(&mut harness, egui::Key::Escape);
    harness.get_by_role_and_label(Role::Button, "Close the shader").click();
    settle(&mut harness);
    assert_eq!((harness.state().lod_shader_file(), totals(harness.state())), (None, before));
}

#[test]
fn a_version_that_cannot_be_used_is_named_with_its_line_and_leaves_the_last_one() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = folder.path().join("own.wgsl");
    write(&path, "\n\nunknown");
    let mut harness = uniform(Some(Source::Shape(Shape::Icosahedron)));
    press(&mut harness, egui::Key::L);
    let (lod, before) = (harness.state().settings().tessellation.lod, totals(harness.state()));
    assert_ne!(lod, Lod::Uniform);
    open(&mut harness, &path);
    // Nothing can be used yet, so LOD stays, and can be set.
    harness.get_by_label_contains("own.wgsl, line 3: ");
    harness.get_by_label_contains("The LOD is still used.");
    assert_eq!((harness.state().lod_shader_file(), totals(harness.state())), (None, before));
    write(&path, "5.0");
    until(&mut harness, "the change isn't seen", |app| app.lod_shader_file().is_some());
    let fives = totals(harness.state());
    assert!(fives != before && harness.state().lod_shader_error().is_none());
    write(&path, "5.0 +\n oops(3.0)");
    until(&mut harness, "the change isn't seen", |app| app.lod_shader_error().is_some());
    harness.get_by_label_contains("own.wgsl, line 2: ");
    harness.get_by_label_contains("The version before it stays.");
    assert_eq!(totals(harness.state()), fives);
    // Loops without end bring the last good version back as well.
    let spin = "fn spin() -> f32 { var n = 1.0; while n > 0.0 { n += 1.0; if n > 9.0 { n = 1.0; } } return n; }\n";
    std::fs::write(
        &path,
        spin.to_owned() + &std::fs::read_to_string(&path).expect("a text").replace("oops(3.0)", "spin()"),
    )
    .expect("a writable temporary folder");
    until(&mut harness, "the loop isn't stopped", |app| {
        app.lod_shader_error().is_some_and(|error| error.contains("took too long"))
    });
    assert_eq!(totals(harness.state()), fives);
    // A file that is gone for a moment is no new version.
    std::fs::remove_file(&path).expect("it is there");
    std::thread::sleep(std::time::Duration::from_millis(600));
    harness.run_steps(3);
    assert!(harness.state().lod_shader_error().is_some_and(|error| error.contains("took too long")));
    write(&path, "7.0");
    until(&mut harness, "the change isn't seen", |app| app.lod_shader_error().is_none());
    assert!(totals(harness.state()).1 > fives.1);
    // Another mesh keeps it, and the LOD before comes back when it is closed.
    let context = harness.ctx.clone();
    harness.state_mut().open(&context, Source::Shape(Shape::Torus));
    settle(&mut harness);
    assert_eq!(totals(harness.state()).1 % 256, 0, "every patch of the torus has the same factors");
    // Subtriangulation has the same number of segments everywhere.
    choose(&mut harness, "Partitioning", "Subtriangulation");
    settle(&mut harness);
    harness.get_by_role_and_label(Role::Button, "Close the shader").click();
    settle(&mut harness);
    assert_eq!(harness.state().settings().tessellation.lod, lod);
}

#[test]
fn the_next_session_opens_it_again_and_has_the_lod_before() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let kept = tempfile::tempdir().expect("a writable temporary folder");
    let path = folder.path().join("own.wgsl");
    write(&path, "5.0");
    let size = [1200.0, 960.0];
    let mut first = resumed(kept.path(), size, Some(Source::Shape(Shape::Icosahedron)));
    choose(&mut first, "Partitioning", "Integer");
    let lod = first.state().settings().tessellation.lod;
    assert_ne!(lod, Lod::Uniform);
    open(&mut first, &path);
    let fives = totals(first.state());
    eframe::App::on_exit(first.state_mut());
    drop(first);
    let mut second = resumed(kept.path(), size, Some(Source::Shape(Shape::Icosahedron)));
    assert_eq!((second.state().lod_shader_file(), totals(second.state())), (Some(&*path), fives));
    second.get_by_role_and_label(Role::Button, "Close the shader").click();
    settle(&mut second);
    assert_eq!(second.state().settings().tessellation.lod, lod);
}

#[test]
fn the_left_half_and_an_export_have_the_factors_of_the_functions() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let (path, written) = (folder.path().join("own.wgsl"), folder.path().join("five.obj"));
    write(&path, "5.0");
    let mut harness = uniform(Some(Source::Shape(Shape::Icosahedron)));
    open(&mut harness, &path);
    press(&mut harness, egui::Key::S);
    choose(&mut harness, "Left", "Flat");
    let context = harness.ctx.clone();
    harness.state_mut().export_mesh(&context, written.clone()).expect("an .obj file");
    while harness.state().is_writing() {
        std::thread::sleep(Duration::from_millis(2));
        harness.step();
    }
    let text = std::fs::read_to_string(&written).expect("an exported mesh");
    assert_eq!(text.lines().filter(|line| line.starts_with("f ")).count() as u64, totals(harness.state()).1);
    let command = copied(&mut harness);
    assert_draws(&harness, &command, "icosahedron-view");
}

//! Factors of another engine in the window.

use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use geometry::mesh::Shape;
use geometry::tessellate::{Convention, Lod};
use load::Source;
use pnaen::app::App;

use crate::editing::{assert_draws, copied, press_with};
use crate::{choose, click, press, run_command, settle, uniform};

fn open(harness: &mut Harness<App>, path: &std::path::Path) {
    let context = harness.ctx.clone();
    harness.state_mut().open_factors(&context, path.to_owned());
    settle(harness);
}

#[test]
fn factors_of_a_file_are_shown_with_their_disagreements_and_the_convention_that_fits() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = folder.path().join("amd.csv");
    run_command(["factors", "shape:torus", "--convention", "amd-pn", "--lod", "paper", "--pixels", "12"], &path);
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    let before = harness.state().totals();
    open(&mut harness, &path);
    let app = harness.state();
    assert_eq!(app.factors_file(), Some(&*path));
    assert_ne!(app.totals(), before, "the mesh has the file's factors");
    assert!(app.cracks().expect("measured").different_factors > 300, "the convention is wrong");
    harness.get_by_label_contains(" edges with different factors").click();
    settle(&mut harness);
    let edge = harness.state().selected_edge().expect("the edge with the largest difference");
    assert!(harness.get_all_by_label_contains(&format!("{edge:<9}")).next().is_some(), "it is in the list");
    let app = harness.state();
    let crack = app.cracks().expect("measured").edges.iter().find(|crack| crack.edge == edge).expect("it is cracked");
    let [a, b] = crack.widest;
    assert!(app.camera().target.distance((a + b) / 2.0) < 0.1, "the edge is in the middle");
    harness.get_by_label_contains(", all sides agree.");
    // The picked edge has no option.
    press(&mut harness, egui::Key::Escape);
    let command = copied(&mut harness);
    assert!(command.contains("--factors ") && !command.contains("--lod"), "{command}");
    assert_draws(&harness, &command, "torus-view");
    press(&mut harness, egui::Key::Escape);
    // Under the convention of the file nothing disagrees.
    harness.get_by_label_contains("Use AMD").click();
    settle(&mut harness);
    assert_eq!(harness.state().settings().tessellation.convention, Convention::AmdPn);
    assert_eq!(harness.state().cracks().expect("measured").different_factors, 0);
    assert!(harness.query_by_label_contains(" edges with different factors").is_none());
    harness.get_by_role_and_label(Role::Button, "Close the file").click();
    settle(&mut harness);
    assert_eq!((harness.state().factors_file(), harness.state().totals()), (None, before));
}

#[test]
fn a_triangle_that_a_file_leaves_out_is_cracked_all_around() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = folder.path().join("hole.csv");
    run_command(["factors", "shape:icosahedron", "--factor", "3"], &path);
    let whole = std::fs::read_to_string(&path).expect("a file");
    std::fs::write(&path, whole.replace("\n7,3,", "\n7,nan,")).expect("a writable temporary folder");
    let mut harness = uniform(Some(Source::Shape(Shape::Icosahedron)));
    open(&mut harness, &path);
    harness.get_by_label_contains("3 cracked edges").click();
    settle(&mut harness);
    assert!(harness.state().selected_edge().is_some());
    harness.get_by_label_contains("triangle 7");
}

#[test]
fn the_lod_that_comes_back_is_copied_to_the_left_and_swapped() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = folder.path().join("sevens.csv");
    run_command(["factors", "shape:icosahedron", "--factor", "7"], &path);
    let mut harness = uniform(Some(Source::Shape(Shape::Icosahedron)));
    choose(&mut harness, "LOD", "Edge length");
    open(&mut harness, &path);
    let lods = |harness: &Harness<App>| {
        let settings = harness.state().settings();
        [settings.left, settings.tessellation].map(|own| own.lod)
    };
    assert_eq!(lods(&harness)[1], Lod::Uniform, "the file's factors take its place");
    press_with(&mut harness, egui::Modifiers::SHIFT, egui::Key::J);
    assert_eq!(lods(&harness), [Lod::EdgeLength, Lod::Uniform]);
    let button = harness.get_by_role_and_label(Role::Button, "Keep the right half on the left");
    assert!(!button.accesskit_node().is_disabled(), "it does what the key does");
    click(&mut harness, "Swap");
    assert_eq!(lods(&harness), [Lod::EdgeLength, Lod::Uniform]);
    harness.get_by_role_and_label(Role::Button, "Close the file").click();
    settle(&mut harness);
    assert_eq!(lods(&harness), [Lod::EdgeLength; 2]);
}

#[test]
fn the_lod_before_comes_back_and_a_bad_file_changes_nothing() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let (good, bad) = (folder.path().join("good.csv"), folder.path().join("bad.csv"));
    run_command(["factors", "shape:icosahedron", "--factor", "7"], &good);
    std::fs::write(&bad, "patch,e0,e1,e2,inside\n0,1,1,1,1\n").expect("a writable temporary folder");
    let mut harness = uniform(Some(Source::Shape(Shape::Icosahedron)));
    press(&mut harness, egui::Key::L);
    let lod = harness.state().settings().tessellation.lod;
    assert_ne!(lod, Lod::Uniform);
    open(&mut harness, &good);
    let sevens = harness.state().totals();
    open(&mut harness, &bad);
    harness.get_by_label_contains("bad.csv, line 2: the file ends without a line for patch 1 and 18 more");
    assert_eq!((harness.state().factors_file(), harness.state().totals()), (Some(&*good), sevens));
    click(&mut harness, "Close");
    // Loaded again, the mesh keeps the file; another mesh doesn't.
    press(&mut harness, egui::Key::R);
    assert_eq!((harness.state().factors_file(), harness.state().totals()), (Some(&*good), sevens));
    harness.get_by_role_and_label(Role::Button, "Close the file").click();
    settle(&mut harness);
    assert_eq!(harness.state().settings().tessellation.lod, lod);
    open(&mut harness, &good);
    let context = harness.ctx.clone();
    harness.state_mut().open(&context, Source::Shape(Shape::Torus));
    settle(&mut harness);
    assert_eq!((harness.state().factors_file(), harness.state().settings().tessellation.lod), (None, lod));
}

#[test]
fn the_left_half_and_an_export_have_the_factors_of_the_file() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let (path, written) = (folder.path().join("five.csv"), folder.path().join("five.obj"));
    run_command(["factors", "shape:icosahedron", "--factor", "5"], &path);
    let mut harness = uniform(Some(Source::Shape(Shape::Icosahedron)));
    open(&mut harness, &path);
    press(&mut harness, egui::Key::S);
    choose(&mut harness, "Left", "Flat");
    let context = harness.ctx.clone();
    harness.state_mut().export_mesh(&context, written.clone()).expect("an .obj file");
    while harness.state().is_writing() {
        std::thread::sleep(std::time::Duration::from_millis(2));
        harness.step();
    }
    let triangles = harness.state().totals().expect("a mesh").1;
    let text = std::fs::read_to_string(&written).expect("an exported mesh");
    assert_eq!(text.lines().filter(|line| line.starts_with("f ")).count() as u64, triangles);
    let command = copied(&mut harness);
    assert_draws(&harness, &command, "icosahedron-view");
}

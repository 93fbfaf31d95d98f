//! Both halves of a split view beside each other: their figures, and the left half as what was shown before a change.

use std::time::{Duration, Instant};

use egui::accesskit::{Role, Toggled};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use geometry::mesh::Shape;
use geometry::tessellate::Surface;
use inspect::settings::SplitSide;
use load::{HeightSource, Source};
use pnaen::app::App;

use crate::driver::PATIENCE;
use crate::editing::{copied, press_with};
use crate::{choose, click, open_list, press, scroll_to, settle, uniform, uniform_of, window};

const QUAD: &str = "v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nf 1 2 3 4\n";

#[test]
fn the_figures_of_both_halves_stand_beside_each_other() {
    let mut harness = uniform(Some(Source::Shape(Shape::CubeSplit)));
    assert!(harness.query_by_label("Left and right").is_none(), "the view isn't split");
    press(&mut harness, egui::Key::S);
    choose(&mut harness, "Left", "PN");
    click(&mut harness, "Edit left (A)");
    choose(&mut harness, "Partitioning", "Integer");
    harness.get_by_role_and_label(Role::Slider, "Factor").set_value_accesskit(3.0);
    settle(&mut harness);
    // Patches of 13 triangles on the left, and of 121 on the right, which has 9 segments an edge.
    for label in [
        "Triangles, Left: 156",
        "Triangles, Right: 1,452",
        "Triangles, Change: +1,296",
        "Culled patches, Left: 0",
        "At max factor, Change: 0",
        "Cracked edges, Left: 12",
        "Cracked edges, Right: 0",
        "Cracked edges, Change: -12",
        "Widest gap, px, Right: 0",
    ] {
        harness.get_by_label(label);
    }
    harness.get_by_label_contains("Widest gap, px, Change: -");
    for header in ["Half", "Change"] {
        harness.get_by_role_and_label(Role::Label, header);
    }
    assert!(harness.query_by_label_contains("Half, ").is_none(), "headers aren't figures");
    assert!(harness.query_by_label_contains("Deviation, Left: ").is_none(), "the overlay is off");
    scroll_to(&mut harness, "Left and right");
    click(&mut harness, "Left and right");
    assert!(harness.query_by_label("Triangles, Left: 156").is_none(), "the section is folded");
    click(&mut harness, "Left and right");
    harness.get_by_label("Triangles, Left: 156");
    press(&mut harness, egui::Key::S);
    assert!(harness.query_by_label("Left and right").is_none());
}

#[test]
fn the_deviations_of_both_halves_are_compared_if_both_show_it() {
    let mut harness = uniform(Some(Source::Shape(Shape::Icosahedron)));
    press(&mut harness, egui::Key::S);
    choose(&mut harness, "Left", "Flat");
    press(&mut harness, egui::Key::V);
    // The distance between the inscribed and the circumscribed sphere, and a third of it or less.
    harness.get_by_label("Deviation, Left: 0.205");
    harness.get_by_label_contains("Deviation, Right: 0.06");
    harness.get_by_label_contains("Deviation, Change: -0.1");
    choose(&mut harness, "Left looks", "Its own");
    press(&mut harness, egui::Key::V);
    assert!(harness.state().deviation(SplitSide::Left).is_some());
    assert!(harness.query_by_label_contains("Deviation, Left: ").is_none(), "the right half has no deviation");
}

#[test]
fn what_is_shown_is_kept_on_the_left_and_compared_with_what_is_changed_then() {
    let mut harness = uniform(Some(Source::Shape(Shape::CubeSplit)));
    let before = *harness.state().settings();
    press_with(&mut harness, egui::Modifiers::SHIFT, egui::Key::J);
    let kept = *harness.state().settings();
    assert!(kept.split.is_some(), "the split opens");
    assert_eq!((kept.left, kept.left_looks), (before.tessellation, None));
    harness.get_by_label("Triangles, Change: 0");
    choose(&mut harness, "Surface", "PN");
    harness.get_by_label("Cracked edges, Left: 0");
    harness.get_by_label("Cracked edges, Change: +12");
    // Looks of its own are those of the right half, too.
    choose(&mut harness, "Left looks", "Its own");
    press(&mut harness, egui::Key::W);
    let left = |harness: &Harness<App>| {
        let left = harness.state().settings().half(SplitSide::Left).expect("it is split");
        (left.tessellation.surface, left.overlays.wireframe)
    };
    assert_eq!(left(&harness), (Surface::PnAen, false));
    scroll_to(&mut harness, "Keep the right half on the left");
    click(&mut harness, "Keep the right half on the left");
    assert_eq!(left(&harness), (Surface::Pn, true));
    harness.get_by_label("Cracked edges, Left: 12");
    press(&mut harness, egui::Key::W);
    assert_eq!(left(&harness), (Surface::Pn, true), "the right half alone changes");
    let context = harness.ctx.clone();
    harness.state_mut().undo(&context);
    harness.state_mut().undo(&context);
    settle(&mut harness);
    assert_eq!(left(&harness), (Surface::PnAen, false));
    harness.get_by_label("Cracked edges, Left: 0");
}

#[test]
fn the_reference_surface_is_shown_on_the_left_until_the_right_half_is_kept_there() {
    let (folder, mut harness) = uniform_of("quad.obj", QUAD);
    let path = folder.path().join("high.obj");
    std::fs::write(&path, QUAD.replace("f 1 2 3 4", "f 1 2 3")).expect("a writable folder");
    press(&mut harness, egui::Key::S);
    let context = harness.ctx.clone();
    harness.state_mut().open_reference_shape(&context, Source::File(path));
    settle(&mut harness);
    choose(&mut harness, "Left mesh", "Reference surface: high.obj");
    harness.get_by_label_contains("Left: high.obj");
    open_list(&mut harness, "Left mesh");
    let entry = harness.get_by_label("Reference surface: high.obj").accesskit_node().toggled();
    assert_eq!(entry, Some(Toggled::True), "the list says what is shown");
    press(&mut harness, egui::Key::Escape);
    scroll_to(&mut harness, "Keep the right half on the left");
    click(&mut harness, "Keep the right half on the left");
    harness.get_by_label_contains("Left: PN-AEN");
    harness.state_mut().undo(&context);
    settle(&mut harness);
    harness.get_by_label_contains("Left: high.obj");
}

fn left_mesh(harness: &Harness<App>) -> Option<String> {
    harness.get_by_role_and_label(Role::ComboBox, "Left mesh").accesskit_node().value()
}

#[test]
fn the_mesh_that_is_kept_stays_when_the_right_one_is_prepared_otherwise() {
    let mut harness = uniform(Some(Source::Shape(Shape::CubeSplit)));
    press_with(&mut harness, egui::Modifiers::SHIFT, egui::Key::J);
    let same = "Left: PN-AEN\n1,452 triangles, 0 cracked edges";
    harness.get_by_label(same);
    assert_eq!(left_mesh(&harness).as_deref(), Some("The same"));
    let context = harness.ctx.clone();
    harness.state_mut().prepare(&context, |own| own.crease_band = 0.1);
    settle(&mut harness);
    let earlier = "Left: as kept, PN-AEN\n1,452 triangles, 0 cracked edges";
    harness.get_by_label(earlier);
    assert!(harness.query_by_label("Triangles, Change: 0").is_none(), "the right half alone has the band");
    assert_eq!(left_mesh(&harness).as_deref(), Some("As kept"));
    let command = copied(&mut harness);
    assert!(!command.contains("--split"), "{command}");
    harness.get_by_label_contains("no command can name the earlier version of a mesh");
    press(&mut harness, egui::Key::Escape);
    // Prepared as it was kept, it is the same mesh again.
    harness.state_mut().undo(&context);
    settle(&mut harness);
    harness.get_by_label(same);
    let command = copied(&mut harness);
    assert!(command.contains("--split"), "{command}");
    press(&mut harness, egui::Key::Escape);
    harness.state_mut().redo(&context);
    settle(&mut harness);
    harness.get_by_label(earlier);
    choose(&mut harness, "Left mesh", "The same");
    harness.get_by_label("Triangles, Change: 0");
    harness.state_mut().undo(&context);
    settle(&mut harness);
    harness.get_by_label(earlier);
}

#[test]
fn figures_of_different_moments_are_not_subtracted() {
    let mut harness = window(Some(Source::Shape(Shape::Torus)));
    press_with(&mut harness, egui::Modifiers::SHIFT, egui::Key::J);
    let differences = ["Triangles, Change: 0", "Triangles, Change: …"];
    for _ in 0..4 {
        let start = Instant::now();
        harness.key_press(egui::Key::PageUp);
        harness.run_steps(2);
        while harness.state().is_busy() {
            assert!(start.elapsed() < PATIENCE, "the window is still busy");
            let is_right = differences.iter().any(|label| harness.query_by_label(label).is_some());
            assert!(is_right, "both halves are alike at any moment");
            std::thread::sleep(Duration::from_millis(1));
            harness.step();
        }
        settle(&mut harness);
        harness.get_by_label(differences[0]);
    }
}

#[test]
fn swap_exchanges_the_meshes_of_two_files_as_they_are() {
    let quad = QUAD.replace("f 1", "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1").replace("2 3 4", "2/2 3/3 4/4");
    let (folder, mut harness) = uniform_of("quad.obj", &quad);
    let (path, heights) = (folder.path().join("half.obj"), folder.path().join("heights.png"));
    std::fs::write(&path, QUAD.replace("f 1 2 3 4", "f 1 2 3")).expect("a writable folder");
    image::GrayImage::from_pixel(2, 2, image::Luma([255])).save(&heights).expect("a writable folder");
    press(&mut harness, egui::Key::S);
    choose(&mut harness, "Left", "PN");
    let context = harness.ctx.clone();
    harness.state_mut().displace(&context, Some(HeightSource::File(heights)));
    harness.state_mut().open_reference_shape(&context, Source::File(path.clone()));
    settle(&mut harness);
    choose(&mut harness, "Left mesh", "Reference surface: half.obj");
    let camera = *harness.state().camera();
    let shown = |harness: &Harness<App>, [left, right, change]: [&str; 3]| {
        harness.get_by_label_contains(&format!("Left: {left}"));
        harness.get_by_label_contains(&format!("Right: {right}"));
        harness.get_by_label(&format!("Triangles, Change: {change}"));
        assert_eq!(*harness.state().camera(), camera, "the view stays");
        assert_eq!(harness.state().reference_shape(), Some(&Source::File(path.clone())), "it stays, too");
    };
    let before = ["half.obj, PN", "quad.obj, PN-AEN", "+121"];
    shown(&harness, before);
    let drawn = harness.state_mut().read_picture().expect("a picture");
    scroll_to(&mut harness, "Swap");
    click(&mut harness, "Swap");
    shown(&harness, ["quad.obj, PN-AEN", "half.obj, PN", "-121"]);
    assert_eq!(harness.state().loaded().map(|loaded| loaded.preparation.heights.is_some()), Some(false));
    // No step goes back to meshes that were there.
    harness.state_mut().undo(&context);
    settle(&mut harness);
    shown(&harness, ["quad.obj, PN-AEN", "half.obj, PN", "-121"]);
    scroll_to(&mut harness, "Swap");
    click(&mut harness, "Swap");
    shown(&harness, before);
    assert!(harness.state_mut().read_picture().expect("a picture") == drawn, "as before, with heights");
}

#[test]
fn the_selected_patch_has_the_factors_of_the_half_that_is_edited() {
    let mut harness = uniform(Some(Source::Shape(Shape::CubeSplit)));
    harness.state_mut().select_triangle(Some(0));
    settle(&mut harness);
    assert!(harness.query_by_label("Of the right half").is_none(), "the view isn't split");
    press(&mut harness, egui::Key::S);
    choose(&mut harness, "Left", "PN");
    let has = |harness: &Harness<App>, factor: &str| harness.query_all_by_label_contains(factor).next().is_some();
    harness.get_by_label("Of the right half");
    assert!(has(&harness, "8.000") && !has(&harness, "3.000"));
    click(&mut harness, "Edit left (A)");
    choose(&mut harness, "Partitioning", "Integer");
    harness.get_by_role_and_label(Role::Slider, "Factor").set_value_accesskit(3.0);
    settle(&mut harness);
    harness.get_by_label("Of the left half");
    assert!(has(&harness, "3.000") && !has(&harness, "8.000"));
    scroll_to(&mut harness, "Edit right (B)");
    click(&mut harness, "Edit right (B)");
    harness.get_by_label("Of the right half");
    assert!(has(&harness, "8.000") && !has(&harness, "3.000"));
}

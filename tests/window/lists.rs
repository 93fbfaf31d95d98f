//! The lists about a mesh: cracks, worst edges, and what a weld would join.

use std::path::PathBuf;
use std::time::Instant;

use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use geometry::mesh::Shape;
use geometry::numbers::grouped;
use geometry::tessellate::Surface;
use inspect::render::Leak;
use load::Source;
use pnaen::app::App;
use tempfile::TempDir;

use crate::findings::button;
use crate::{PATIENCE, choose, click, open_list, press, scroll_to, settle, uniform, uniform_of, window};

#[test]
fn pn_triangles_crack_and_the_status_line_counts_it() {
    let mut harness = uniform(None);
    choose(&mut harness, "Surface", "PN");
    harness.get_by_role_and_label(Role::CheckBox, "Cracks").click();
    settle(&mut harness);
    let app = harness.state();
    assert_eq!(app.settings().tessellation.surface, Surface::Pn);
    assert!(app.settings().overlays.cracks);
    assert_eq!(app.cracks().map(|cracks| cracks.edges.len()), Some(12));
    harness.get_by_label_contains("cracks 12, ");
}

#[test]
fn a_list_of_other_rows_begins_with_the_first() {
    let mut harness = uniform(Some(Source::Shape(Shape::CubeSplit)));
    choose(&mut harness, "Surface", "PN");
    let row = |harness: &Harness<App>, place: usize| {
        let edge = harness.state().cracks().expect("measured").edges[place].edge;
        format!("{edge:<7}split normal")
    };
    let (first, last) = (row(&harness, 0), row(&harness, 11));
    assert!(harness.query_by_label_contains(&last).is_none(), "the list has fewer rows than there are");
    harness.get_by_label_contains(&first).focus();
    settle(&mut harness);
    press(&mut harness, egui::Key::End);
    harness.get_by_label_contains(&last);
    assert!(harness.query_by_label_contains(&first).is_none());
    choose(&mut harness, "Surface", "Phong");
    harness.get_by_label_contains(&row(&harness, 0));
}

#[test]
fn the_worst_edges_are_listed_and_a_click_frames_one() {
    let mut harness = uniform(Some(Source::Shape(Shape::CubeSplit)));
    choose(&mut harness, "Surface", "PN");
    let app = harness.state();
    let cracks = app.cracks().expect("measured").clone();
    let before = *app.camera();
    // Click the list's third row.
    let edge = cracks.edges[2].edge;
    let row = format!("{edge:<7}split normal");
    harness.get_by_label_contains(&row).click();
    settle(&mut harness);
    let app = harness.state();
    assert_eq!(app.selected_edge(), Some(edge));
    let topology = &app.loaded().expect("a mesh").topology;
    let [a, b] = cracks.edges[2].widest;
    assert_ne!(*app.camera(), before);
    assert!(app.camera().target.distance((a + b) / 2.0) < 1e-5, "its widest gap is in the middle");
    // The details have the edge's number, kind and triangles, and both sides' factors and points.
    harness.get_by_label(&format!("Edge {edge}"));
    assert!(harness.get_all_by_label("split normal").next().is_some());
    for side in topology.edge_sides(&topology.edges[edge as usize]) {
        let triangle = topology.patches[side.patch() as usize].triangle;
        harness.get_by_label(&format!("Triangle {triangle}"));
    }
    assert_eq!(harness.get_all_by_label("8.00000").count(), 2, "both sides' factors");
    assert_eq!(harness.get_all_by_label("9").count(), 2, "both sides' segments");
    assert_eq!(harness.get_all_by_label_contains("gap, units").count(), 2, "of the worst edges, and of their points");
    // The panel was scrolled to the list.
    scroll_to(&mut harness, "Deselect");
    click(&mut harness, "Deselect");
    assert_eq!(harness.state().selected_edge(), None);
}

#[test]
fn rows_stay_where_they_are_while_clicks_move_the_camera() {
    let mut harness = window(Some(Source::Shape(Shape::CubeSplit)));
    choose(&mut harness, "Surface", "PN");
    let edges = |harness: &Harness<App>| -> Vec<u32> {
        harness.state().cracks().expect("measured").edges.iter().map(|crack| crack.edge).collect()
    };
    let rows = |harness: &Harness<App>| -> Vec<String> {
        let buttons = harness.query_all_by_role(Role::Button).filter_map(|node| node.accesskit_node().label());
        buttons.filter(|text| text.contains("split normal")).map(|text| text[..7].to_owned()).collect()
    };
    scroll_to(&mut harness, "Worst edges");
    let (shown, before) = (rows(&harness), edges(&harness));
    // The last row is seen in part.
    for row in &shown[..5] {
        let label = button(&harness, |label| label.starts_with(row));
        click(&mut harness, &label);
        assert_eq!(rows(&harness), shown, "after a click on {row}");
        assert_eq!(harness.state().selected_edge(), row.trim().parse().ok());
        assert_eq!(edges(&harness), before, "LOD is frozen, and with it the gaps");
    }
    harness.get_by_label("LOD camera frozen");
}

#[test]
fn a_turn_of_the_wheel_that_began_beside_a_list_goes_past_it() {
    let mut harness = uniform(Some(Source::Shape(Shape::CubeSplit)));
    choose(&mut harness, "Surface", "PN");
    scroll_to(&mut harness, "Largest gap");
    let edge = harness.state().cracks().expect("measured").edges[0].edge;
    let first = format!("{edge:<7}split normal");
    let top = |harness: &Harness<App>| harness.get_by_label("Worst edges").rect().top();
    // Less than the pause between two turns.
    let turn = |harness: &mut Harness<App>, points: f32| {
        harness.event(egui::Event::MouseWheel {
            unit: egui::MouseWheelUnit::Point,
            delta: egui::vec2(0.0, -points),
            phase: egui::TouchPhase::Move,
            source: egui::MouseWheelSource::Wheel,
            modifiers: egui::Modifiers::NONE,
        });
        harness.step();
    };
    let (place, before) = (harness.get_by_label("Largest gap").rect().center(), top(&harness));
    harness.hover_at(place);
    (0..12).for_each(|_| turn(&mut harness, 20.0));
    assert!(before - top(&harness) > 200.0, "the panel scrolls on: from {before} to {}", top(&harness));
    settle(&mut harness);
    harness.run_steps(10);
    scroll_to(&mut harness, "Worst edges");
    let place = harness.get_by_label_contains(&first).rect().center();
    harness.hover_at(place);
    harness.run_steps(3);
    let before = top(&harness);
    (0..4).for_each(|_| turn(&mut harness, 20.0));
    assert_eq!(top(&harness), before, "a turn that begins on the list scrolls it");
    assert!(harness.query_by_label_contains(&first).is_none());
}

#[test]
fn keys_go_through_a_list_beyond_the_visible_rows() {
    let mut harness = uniform(Some(Source::Shape(Shape::CubeSplit)));
    choose(&mut harness, "Surface", "PN");
    let edges: Vec<_> = harness.state().cracks().expect("measured").edges.iter().map(|crack| crack.edge).collect();
    harness.get_by_label_contains(&format!("{:<7}split normal", edges[0])).focus();
    settle(&mut harness);
    let steps = [egui::Key::ArrowDown; 9].into_iter().chain([egui::Key::ArrowUp, egui::Key::Enter]);
    for key in steps {
        press(&mut harness, key);
    }
    assert_eq!(harness.state().selected_edge(), Some(edges[8]));
    for key in [egui::Key::End, egui::Key::Enter] {
        press(&mut harness, key);
    }
    assert_eq!(harness.state().selected_edge(), Some(edges[11]));
    press(&mut harness, egui::Key::Home);
    press(&mut harness, egui::Key::Enter);
    assert_eq!(harness.state().selected_edge(), Some(edges[0]));
}

/// Clicks the row of a list that begins like this. The panel is scrolled to the list first.
fn click_row(harness: &mut Harness<App>, list: &str, text: &str) {
    scroll_to(harness, list);
    let row = button(harness, |label| label.starts_with(text));
    click(harness, &row);
}

#[test]
fn folds_are_listed_and_the_verdict_goes_to_the_largest() {
    // Two triangles apart, whose normals are like those at a notch and a point of a star; the second is twice as large.
    let triangle = |x: f32, size: f32| {
        let corners = [[0.0, 0.0], [0.28, 0.2], [1.0, 0.0]];
        let lines = corners.map(|[a, c]| format!("v {} 0 {}\n", x + size * a, size * c));
        lines.concat() + "vn 0 1 0\nvn -0.77 0.32 -0.56\nvn 0.84 0.28 0.45\n"
    };
    let faces = "f 1//1 2//2 3//3\nf 4//4 5//5 6//6\n";
    let (_folder, mut harness) = uniform_of("leaning.obj", triangle(0.0, 1.0) + &triangle(5.0, 2.0) + faces);
    let before = *harness.state().camera();
    let line = button(&harness, |text| text.ends_with(" folds"));
    click(&mut harness, &line);
    settle(&mut harness);
    let app = harness.state();
    assert!(app.settings().overlays.folds);
    assert_eq!(app.selected_triangle(), Some(1), "the larger one");
    assert_ne!(*app.camera(), before);
    assert!((5.0..7.0).contains(&app.camera().target.x), "{:?}", app.camera());
    click_row(&mut harness, "Folded patches", &format!("{:<10}", 0));
    let app = harness.state();
    assert_eq!(app.selected_triangle(), Some(0), "the one of the row");
    assert!((0.0..2.0).contains(&app.camera().target.x), "{:?}", app.camera());
}

#[test]
fn leaks_are_listed_and_lead_to_the_edge_that_leaks() {
    let mut harness = uniform(Some(Source::Shape(Shape::CubeSplit)));
    harness.get_by_label("No leaks in this view");
    choose(&mut harness, "Surface", "PN");
    let app = harness.state();
    let leaks = app.leaks().expect("counted");
    assert!(leaks.is_sorted_by_key(|leak| std::cmp::Reverse(leak.pixels)), "{leaks:?}");
    let pixels: u32 = leaks.iter().map(|leak| leak.pixels).sum();
    let row = |leak: &Leak| {
        format!("{:>6.0}{:>8.0}{:>15}", leak.px.x.floor(), leak.px.y.floor(), grouped(leak.pixels.into()))
    };
    let (leak, second, before) = (leaks[1], row(&leaks[1]), *app.camera());
    click_row(&mut harness, "Leaks", &second);
    let app = harness.state();
    assert!(app.settings().overlays.cracks);
    let edge = app.selected_edge().expect("the edge beside the leak");
    assert!(app.cracks().expect("measured").edges.iter().any(|crack| crack.edge == edge && crack.gap > 0.0));
    assert_ne!(*app.camera(), before);
    // They stay those of the view that they were counted in.
    let line = format!("{} px leak in the frozen view", grouped(pixels.into()));
    assert_eq!(app.leaks().expect("they stay")[1], leak);
    // The panel was scrolled to the list.
    harness.get_by_label(&line).scroll_to_me();
    settle(&mut harness);
    click(&mut harness, &line);
    assert_ne!(*harness.state().camera(), before, "at the largest leak");
    // An edge that is computed once can't leak. An open mesh has no inside, but where no edge is cracked, none leaks.
    choose(&mut harness, "Surface", "PN-AEN");
    harness.get_by_label("No leaks in the frozen view");
    let context = harness.ctx.clone();
    harness.state_mut().open(&context, Source::Shape(Shape::Bicubic));
    settle(&mut harness);
    assert!(harness.state().leaks().is_none(), "not counted");
    harness.get_by_label_contains("No leaks in ");
}

#[test]
fn escape_closes_a_list_before_it_deselects() {
    let mut harness = uniform(Some(Source::Shape(Shape::CubeSplit)));
    harness.state_mut().select_edge(3);
    settle(&mut harness);
    open_list(&mut harness, "Surface");
    press(&mut harness, egui::Key::Escape);
    assert_eq!(harness.state().selected_edge(), Some(3));
    press(&mut harness, egui::Key::Escape);
    assert_eq!(harness.state().selected_edge(), None);
}

#[test]
fn edges_crack_as_published_and_not_if_computed_once() {
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    press(&mut harness, egui::Key::E);
    let cracked = harness.state().cracks().expect("measured").different_bits;
    assert!(cracked > 1000, "{cracked}");
    press(&mut harness, egui::Key::E);
    assert_eq!(harness.state().cracks().expect("measured").different_bits, 0);
}

/// Writes two triangles with a slit between them, whose width is less than 1e-4 of the bounding diagonal.
fn slit(folder: &TempDir) -> PathBuf {
    let path = folder.path().join("slit.obj");
    let corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1.0001 0 0\nv 1 1 0\nv 0.0001 1 0\n";
    std::fs::write(&path, format!("{corners}f 1 2 3\nf 4 5 6\n")).expect("a writable temporary folder");
    path
}

#[test]
fn the_list_of_weld_tolerances_says_what_each_joins() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let mut harness = uniform(Some(Source::File(slit(&folder))));
    let start = Instant::now();
    while harness.state().is_checking() {
        assert!(start.elapsed() < PATIENCE, "the mesh is still being checked");
        harness.step();
    }
    let edges = |harness: &Harness<App>| {
        let topology = &harness.state().loaded().expect("a mesh").topology;
        (topology.edges.len(), topology.edge_counts().boundary)
    };
    assert_eq!(edges(&harness), (6, 6), "two triangles with a slit between them");
    press(&mut harness, egui::Key::Num3);
    let camera = *harness.state().camera();
    for (entry, weld, expected) in
        [("1e-5: joins nothing", 1e-5, (6, 6)), ("1e-4: joins 2 edges", 1e-4, (5, 4)), ("Exact", 0.0, (6, 6))]
    {
        choose(&mut harness, "Weld", entry);
        assert_eq!(harness.state().loaded().map(|loaded| loaded.preparation.weld), Some(weld));
        assert_eq!(edges(&harness), expected, "{entry}");
        assert_eq!(*harness.state().camera(), camera, "the view stays");
    }
}

#[test]
fn a_crease_band_closes_the_cracks_of_pn_and_the_view_stays() {
    let mut harness = uniform(None);
    choose(&mut harness, "Surface", "PN");
    press(&mut harness, egui::Key::Num3);
    let (camera, settings) = (*harness.state().camera(), *harness.state().settings());
    assert_eq!(harness.state().cracks().map(|cracks| cracks.edges.len()), Some(12));
    harness.get_by_role_and_label(Role::SpinButton, "Crease band").set_value_accesskit(2.0);
    settle(&mut harness);
    let app = harness.state();
    let band = app.loaded().map(|loaded| loaded.crease_band).expect("a mesh");
    assert_eq!((band.width, band.creases), (0.02, 12));
    assert_eq!(app.cracks().map(|cracks| cracks.edges.len()), Some(0));
    assert_eq!((*app.camera(), *app.settings()), (camera, settings));
    // The crease band stays when the mesh is loaded again.
    press(&mut harness, egui::Key::R);
    assert_eq!(harness.state().loaded().map(|loaded| loaded.crease_band), Some(band));
    harness.get_by_role_and_label(Role::SpinButton, "Crease band").set_value_accesskit(0.0);
    settle(&mut harness);
    let loaded = harness.state().loaded().expect("a mesh");
    assert_eq!((loaded.crease_band.width, loaded.mesh.triangles.len()), (0.0, 12));
}

//! Picking in the window: clicks in the picture, and the section about the patch.

use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use geometry::mesh::{EdgeKind, Shape};
use geometry::tessellate::Surface;
use inspect::render::layout::{FACTOR_COLORS, SIDE_COLORS};
use load::Source;
use pnaen::app::App;

use crate::{choose, click, press, scroll_to, settle, uniform, window};

fn cube() -> Harness<'static, App> {
    uniform(Some(Source::Shape(Shape::CubeSplit)))
}

/// Clicks in the picture, at this offset from its middle in points.
fn click_beside_the_middle(harness: &mut Harness<App>, offset: egui::Vec2) {
    let place = harness.get_by_role_and_label(Role::Image, "Viewport").rect().center() + offset;
    harness.hover_at(place);
    harness.drag_at(place);
    harness.run_steps(1);
    harness.drop_at(place);
    settle(harness);
}

fn neighbour(harness: &mut Harness<App>, triangle: u32) {
    // The panel is scrolled to it first, since not all rows fit the window.
    let name = format!("Neighbour, triangle {triangle}");
    harness.get_by_role_and_label(Role::Button, &name).scroll_to_me();
    settle(harness);
    harness.get_by_role_and_label(Role::Button, &name).click();
    settle(harness);
}

/// The triangles across the selected one's edges.
fn neighbours(app: &App) -> Vec<u32> {
    let topology = &app.loaded().expect("a mesh").topology;
    let patch = topology.patch_of(app.selected_triangle().expect("one is selected")).expect("no shape is degenerate");
    let edges = topology.patches[patch as usize].sides.map(|side| topology.sides[side as usize].edge);
    let others = edges.into_iter().flat_map(|edge| topology.edge_sides(&topology.edges[edge as usize]).iter());
    let others = others.filter(|side| side.patch() != patch);
    others.map(|side| topology.patches[side.patch() as usize].triangle).collect()
}

#[test]
fn a_click_selects_what_is_under_the_pointer() {
    let mut harness = cube();
    harness.get_by_label("Click a triangle, or type its number.");
    press(&mut harness, egui::Key::Num1);
    let before = *harness.state().camera();
    let picture = harness.get_by_role_and_label(Role::Image, "Viewport").rect();
    // Seen from the front, the middle lies on the front face, a little above its diagonal.
    click_beside_the_middle(&mut harness, egui::vec2(-8.0, -12.0));
    assert_eq!(harness.get_by_role_and_label(Role::Image, "Viewport").rect(), picture, "the panel's width stays");
    let app = harness.state();
    assert_eq!(*app.camera(), before, "a click doesn't orbit");
    let loaded = app.loaded().expect("a mesh");
    let triangle = app.selected_triangle().expect("a triangle");
    let corners = loaded.mesh.triangles[triangle as usize].map(|corner| loaded.mesh.corners[corner as usize]);
    assert!(corners.iter().all(|corner| corner.position.z == 0.6), "it faces the eye: {corners:?}");
    let edge = app.selected_edge().expect("its nearest edge") as usize;
    assert_eq!(loaded.topology.edges[edge].kind, EdgeKind::Smooth, "the diagonal is nearest");
    let hit = app.hit().expect("an emitted triangle").number;
    // The section has the triangle's number, factors, pattern, neighbours and emitted triangle.
    assert_eq!(harness.get_by_role_and_label(Role::SpinButton, "Triangle").value(), Some(triangle.to_string()));
    for row in ["[0] 1-2    8.000   8.000     9", "[1] 2-0    8.000   8.000     9", "[2] 0-1    8.000   8.000     9"] {
        harness.get_by_label(row);
    }
    harness.get_by_label("inside     8.000   8.000     9");
    harness.get_by_role_and_label(Role::Image, "Domain pattern, 75 points, 121 triangles");
    harness.get_by_label(&format!("Emitted triangle {hit}"));
    harness.get_by_label(&format!("Edge {edge}"));
    for triangle in neighbours(harness.state()) {
        harness.get_by_role_and_label(Role::Button, &format!("Neighbour, triangle {triangle}"));
    }
}

#[test]
fn escape_and_a_click_beside_the_mesh_deselect() {
    let mut harness = cube();
    click_beside_the_middle(&mut harness, egui::Vec2::ZERO);
    assert!(harness.state().selected_triangle().is_some());
    press(&mut harness, egui::Key::Escape);
    let nothing = |app: &App| (app.selected_triangle(), app.selected_edge()) == (None, None) && app.hit().is_none();
    assert!(nothing(harness.state()));
    click_beside_the_middle(&mut harness, egui::Vec2::ZERO);
    assert!(!nothing(harness.state()));
    click_beside_the_middle(&mut harness, egui::vec2(-300.0, -330.0));
    assert!(nothing(harness.state()), "there is no cube there");
    click_beside_the_middle(&mut harness, egui::Vec2::ZERO);
    click(&mut harness, "Deselect patch");
    assert!(nothing(harness.state()));
}

#[test]
fn the_ruler_measures_between_two_clicks_and_selects_nothing() {
    let mut harness = cube();
    let front = [egui::Key::Num1, egui::Key::Num5];
    front.into_iter().for_each(|key| press(&mut harness, key));
    harness.key_press_modifiers(egui::Modifiers::SHIFT, egui::Key::D);
    settle(&mut harness);
    harness.get_by_label("Distance: click on two places of the mesh");
    let plain = harness.state().read_picture().expect("a device");
    click_beside_the_middle(&mut harness, egui::vec2(-60.0, 0.0));
    click_beside_the_middle(&mut harness, egui::vec2(60.0, 0.0));
    let app = harness.state();
    let [Some(a), Some(b)] = app.ruler().expect("in use") else { panic!("two places: {:?}", app.ruler()) };
    // 120 points apart, seen without perspective. The face is curved, so that the ends may differ a little in depth.
    let viewport = harness.get_by_label("Viewport").rect();
    let height = 2.0 * app.camera().distance * 20f32.to_radians().tan();
    let units = 120.0 * height / viewport.height();
    assert!(((b.x - a.x) / units - 1.0).abs() < 0.02, "{a} {b} {units}");
    assert!(a.y.abs() < 0.02 && (a.z - b.z).abs() < 0.05 && a.z > 0.5, "{a} {b}");
    harness.get_by_label_contains("Distance: 0.");
    assert_ne!(app.read_picture().expect("a device"), plain, "it is drawn");
    assert_eq!((app.selected_triangle(), app.selected_edge()), (None, None));
    press(&mut harness, egui::Key::Escape);
    assert_eq!(harness.state().ruler(), None);
    assert_eq!(harness.state().read_picture().expect("a device"), plain);
}

#[test]
fn neighbours_lead_from_triangle_to_triangle() {
    let mut harness = cube();
    click_beside_the_middle(&mut harness, egui::Vec2::ZERO);
    for _ in 0..3 {
        let (from, next) = (harness.state().selected_triangle(), neighbours(harness.state())[1]);
        neighbour(&mut harness, next);
        assert_eq!(harness.state().selected_triangle(), Some(next));
        assert!(neighbours(harness.state()).contains(&from.expect("one was selected")), "neighbours are mutual");
        assert!(harness.state().hit().is_none(), "no emitted triangle of this patch was clicked on");
    }
}

#[test]
fn a_change_of_settings_keeps_the_patch_but_not_the_emitted_triangle() {
    let mut harness = cube();
    click_beside_the_middle(&mut harness, egui::Vec2::ZERO);
    let selected = |app: &App| (app.selected_triangle(), app.selected_edge());
    let before = selected(harness.state());
    assert!(before.0.is_some() && before.1.is_some() && harness.state().hit().is_some());
    press(&mut harness, egui::Key::Num3);
    assert!(harness.state().hit().is_some(), "another view emits the same triangles");
    press(&mut harness, egui::Key::Plus);
    assert_eq!(selected(harness.state()), before);
    assert!(harness.state().hit().is_none());
    harness.get_by_label("[0] 1-2    9.000   9.000     9");
    choose(&mut harness, "Surface", "PN");
    assert_eq!((selected(harness.state()), harness.state().settings().tessellation.surface), (before, Surface::Pn));
    press(&mut harness, egui::Key::R);
    assert_eq!(selected(harness.state()), (None, None), "loading the mesh again deselects");
}

#[test]
fn a_triangle_is_selected_by_its_number_and_framed_by_a_key() {
    let mut harness = cube();
    let typed = |harness: &mut Harness<App>, text: &str| {
        harness.get_by_role_and_label(Role::SpinButton, "Triangle").focus();
        settle(harness);
        harness.event(egui::Event::Text(text.into()));
        settle(harness);
        press(harness, egui::Key::Enter);
    };
    typed(&mut harness, "0");
    assert_eq!(harness.state().selected_triangle(), Some(0));
    typed(&mut harness, "99");
    assert_eq!(harness.state().selected_triangle(), Some(11), "the number is clamped to the last triangle");
    // Leave the field, where keys are text.
    press(&mut harness, egui::Key::Escape);
    typed(&mut harness, "5");
    // What is emitted is the triangle itself.
    choose(&mut harness, "Surface", "Flat");
    let app = harness.state();
    let topology = &app.loaded().expect("a mesh").topology;
    let [a, b, c] = topology.patch_positions(topology.patch_of(5).expect("no shape is degenerate"));
    click(&mut harness, "Frame");
    let camera = *harness.state().camera();
    assert!(camera.target.distance((a + b + c) / 3.0) < 1e-6, "it is in the middle");
    assert!(camera.axes()[2].dot((b - a).cross(c - a).normalize()) > 0.999, "it faces the eye");
    press(&mut harness, egui::Key::F);
    assert_ne!(*harness.state().camera(), camera);
    harness.key_press_modifiers(egui::Modifiers::SHIFT, egui::Key::F);
    settle(&mut harness);
    assert_eq!(*harness.state().camera(), camera);
}

#[test]
fn selecting_an_edge_keeps_the_triangle_only_if_it_has_that_edge() {
    let mut harness = cube();
    click_beside_the_middle(&mut harness, egui::Vec2::ZERO);
    let triangle = harness.state().selected_triangle();
    for edge in ["0-1", "1-2", "2-0"] {
        click(&mut harness, &format!("Edge {edge} of the patch"));
        let edge = harness.state().selected_edge().expect("an edge");
        harness.state_mut().select_edge(edge);
        settle(&mut harness);
        assert_eq!(harness.state().selected_triangle(), triangle, "edge {edge} is one of its edges");
    }
    let app = harness.state();
    let topology = &app.loaded().expect("a mesh").topology;
    let own = topology.patches[topology.patch_of(triangle.expect("one is selected")).expect("a patch") as usize].sides;
    let own = own.map(|side| topology.sides[side as usize].edge);
    let other = (0..).find(|edge| !own.contains(edge)).expect("a cube has more edges");
    harness.state_mut().select_edge(other);
    settle(&mut harness);
    assert_eq!((harness.state().selected_triangle(), harness.state().selected_edge()), (None, Some(other)));
}

#[test]
fn a_selected_edge_shows_the_colour_of_its_factor_and_a_halo() {
    let mut harness = cube();
    let count = |harness: &Harness<App>, color: [u8; 3]| {
        let picture = harness.state().read_picture().expect("a device").expect("a picture");
        picture.pixels().filter(|pixel| pixel.0[..3] == color).count()
    };
    harness.state_mut().select_triangle(Some(0));
    click(&mut harness, "Frame");
    let halo = SIDE_COLORS[0];
    let (alone, white) = (FACTOR_COLORS.map(|color| count(&harness, color)), count(&harness, halo));
    for (k, edge) in ["0-1", "1-2", "2-0"].into_iter().enumerate() {
        scroll_to(&mut harness, &format!("Edge {edge} of the patch"));
        click(&mut harness, &format!("Edge {edge} of the patch"));
        assert!(harness.state().selected_edge().is_some());
        for (color, alone) in FACTOR_COLORS.into_iter().zip(alone) {
            // Where edges meet, the order of their lines decides.
            let shown = count(&harness, color);
            assert!(alone > 200 && shown + 20 > alone, "edge {k}: {shown} of {alone} px of {color:?} are seen");
        }
        let seen = count(&harness, halo);
        assert!(seen > white + 100, "edge {k} has a halo: {seen} px, and {white} before");
    }
}

#[test]
fn left_of_the_split_no_emitted_triangle_is_picked() {
    let mut harness = cube();
    press(&mut harness, egui::Key::S);
    for (offset, emitted) in [(-60.0, false), (60.0, true)] {
        click_beside_the_middle(&mut harness, egui::vec2(offset, 0.0));
        let app = harness.state();
        assert!(app.selected_triangle().is_some() && app.selected_edge().is_some());
        assert_eq!(app.hit().is_some(), emitted, "{offset} points from the divider");
    }
}

#[test]
fn the_pattern_says_why_a_patch_is_left_out() {
    let mut harness = cube();
    press(&mut harness, egui::Key::Num1);
    // A triangle of the cube's back, seen from the front: it is selected while it is drawn, then culled.
    let loaded = harness.state().loaded().expect("a mesh");
    let behind =
        |corners: &[u32; 3]| corners.iter().all(|&corner| loaded.mesh.corners[corner as usize].position.z < 0.0);
    let triangle = loaded.mesh.triangles.iter().position(behind).expect("a cube has a back") as u32;
    harness.state_mut().select_triangle(Some(triangle));
    settle(&mut harness);
    harness.get_by_role_and_label(Role::Image, "Domain pattern, 75 points, 121 triangles");
    harness.get_by_role_and_label(Role::CheckBox, "Cull back faces").click();
    settle(&mut harness);
    harness.get_by_role_and_label(Role::Image, "Domain pattern, facing away, so nothing is emitted");
    assert_eq!(harness.state().selected_triangle(), Some(triangle));
}

/// The text of the one label that starts like this.
fn row(harness: &Harness<App>, start: &str) -> String {
    let labels = harness.query_all_by_label_contains(start).filter_map(|node| node.accesskit_node().value());
    let found: Vec<_> = labels.filter(|label| label.starts_with(start)).collect();
    assert_eq!(found.len(), 1, "{start}: {found:?}");
    found[0].clone()
}

/// The numbers in a row.
fn numbers(text: &str) -> Vec<f64> {
    text.split_whitespace().filter_map(|word| word.trim_end_matches('x').parse().ok()).collect()
}

#[test]
fn under_rows_a_patch_is_explained_as_a_whole() {
    let mut harness = window(Some(Source::Shape(Shape::Torus)));
    harness.state_mut().select_triangle(Some(33));
    settle(&mut harness);
    let tolerance = numbers(&row(&harness, "tolerance  "))[0];
    let whole = numbers(&row(&harness, "whole          "));
    assert!(whole[0] >= 1.0 && whole[1] <= tolerance, "{whole:?}");
    for edge in ["0-1 ", "1-2 ", "2-0 "] {
        let text = row(&harness, edge);
        let asked: Vec<f64> = text.split_whitespace().skip(1).take(3).filter_map(|word| word.parse().ok()).collect();
        let [own, others, got] = asked[..] else { panic!("{text}") };
        assert!(got >= own.max(others), "{text}");
    }
}

#[test]
fn a_patch_says_why_it_has_its_factors() {
    let mut harness = window(Some(Source::Shape(Shape::Torus)));
    choose(&mut harness, "Partitioning", "Integer");
    let mut decided = Vec::new();
    for triangle in [0, 33, 90, 150] {
        harness.state_mut().select_triangle(Some(triangle));
        settle(&mut harness);
        if harness.query_by_label_contains("culled").is_some() {
            continue;
        }
        harness.get_by_label("Why these factors");
        let tolerance = numbers(&row(&harness, "tolerance  "))[0];
        assert!((tolerance - f64::from(harness.state().settings().tessellation.tolerance)).abs() < 1e-3);
        for edge in ["0-1 ", "1-2 ", "2-0 "] {
            let text = row(&harness, edge);
            let words: Vec<_> = text.split_whitespace().collect();
            let [_, own, others, got, by, px] = words[..] else { panic!("{text}") };
            let [own, others, got, px] = [own, others, got, px].map(|word| word.parse::<f64>().expect("a number"));
            assert_eq!(got, own.max(others), "{text}");
            assert!(px <= tolerance, "{text}");
            decided.push(by.to_owned());
        }
        assert!(numbers(&row(&harness, "inside         "))[1] <= tolerance);
        let (least, has) = (row(&harness, "minimum"), row(&harness, "drawn  "));
        let (least, has) = (numbers(&least)[0], numbers(&has));
        assert!(has[0] >= least && (has[1] - has[0] / least).abs() < 0.01, "{least} {has:?}");
        assert!(row(&harness, "Pattern: ").ends_with(&format!(" {} triangles", has[0])));
    }
    assert!(decided.iter().any(|by| by == "curve") || decided.iter().any(|by| by == "this"), "{decided:?}");
    assert!(decided.len() >= 6, "{decided:?}");
    // Under another LOD the same patch is compared with the same tolerance.
    let least = row(&harness, "minimum");
    choose(&mut harness, "LOD", "Uniform");
    harness.get_by_label("Against LOD by error");
    assert_eq!(row(&harness, "minimum"), least);
    assert!(numbers(&row(&harness, "drawn  "))[1] > 1.0);
}

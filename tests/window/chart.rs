//! The chart beside the picture: measured beside the window, and a click applies.

use std::time::{Duration, Instant};

use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use pnaen::app::App;
use pnaen::chart::{Effort, LodKind, Plan, Row, Setting};
use pnaen::engine::Runs;
use pnaen::load::Source;
use pnaen::measure::AccuracyOptions;
use pnaen::mesh::Shape;
use pnaen::tessellate::{Clip, Surface};

use crate::window_tests::{PATIENCE, choose, click, press, settle, window};

/// Ten settings of few triangles; the window's own is none of them.
fn plan() -> Plan {
    Plan {
        surfaces: vec![Surface::Flat, Surface::PnAen],
        lods: vec![LodKind::Uniform, LodKind::Error],
        factors: vec![1.0, 2.0, 4.0],
        tolerances: vec![8.0, 1.0],
        ..Plan::default()
    }
}

/// No more than it takes to have a number.
fn effort() -> Effort {
    let runs = Runs { least: 1, most: 1, within: Duration::ZERO };
    let accuracy = AccuracyOptions { samples: 500, threads: 2 };
    Effort { runs, accuracy, ..Effort::default() }
}

/// A window with its chart open, on an icosahedron; what is tried there is up to the test.
fn charting(plan: Plan, effort: Effort) -> Harness<'static, App> {
    let mut harness = window(Some(Source::Shape(Shape::Icosahedron)));
    harness.state_mut().chart_with(plan, effort);
    press(&mut harness, egui::Key::G);
    harness
}

/// Steps until this is so.
fn wait(harness: &mut Harness<App>, until: impl Fn(&App) -> bool) {
    let start = Instant::now();
    while !until(harness.state()) {
        assert!(start.elapsed() < PATIENCE, "the chart is still not there");
        std::thread::sleep(Duration::from_millis(2));
        harness.step();
    }
    harness.run_steps(2);
}

/// Steps until nothing more is measured, however long one leaves it alone.
fn rest(harness: &mut Harness<App>) {
    loop {
        wait(harness, |app| app.charting().is_none());
        harness.run_steps(20);
        if harness.state().charting().is_none() {
            return;
        }
    }
}

fn measure(harness: &mut Harness<App>, button: &str) {
    click(harness, button);
    wait(harness, |app| app.charting().is_none());
}

fn error(row: &Row) -> f64 {
    row.errors.map_or(f64::INFINITY, |errors| errors.largest)
}

#[test]
fn the_chart_fills_in_beside_the_window_and_a_setting_of_its_front_is_applied() {
    let mut harness = charting(plan(), effort());
    assert!(harness.state().chart_rows().is_empty(), "nothing starts by itself");
    click(&mut harness, "Measure");
    assert_eq!(harness.state().charting().map(|(_, all)| all), Some(11), "and the window's own");
    wait(&mut harness, |app| !app.chart_rows().is_empty());
    wait(&mut harness, |app| app.charting().is_none());
    let rows = harness.state().chart_rows().to_vec();
    assert_eq!(rows.len(), 10);
    assert!(rows.iter().all(|row| row.time.total() > 0.0 && error(row) > 0.0 && row.mesh == "shape:icosahedron"));
    assert!(harness.query_by_label_contains("Icosahedron against exact icosahedron").is_some());
    let own = harness.state().chart_current().expect("measured first");
    assert!(own.triangles > rows[0].triangles);
    // Whatever comes closest is beaten by nothing.
    let best = rows.iter().min_by(|a, b| error(a).total_cmp(&error(b))).expect("ten rows").setting;
    let before = *harness.state().settings();
    assert_ne!(Setting::of(&before), Some(best));
    harness.get_by_role_and_label(Role::Button, "Triangles").click();
    settle(&mut harness);
    harness.get_by_label_contains(&format!("Apply {} ({})", best.method, best.label())).click();
    settle(&mut harness);
    assert_eq!(*harness.state().settings(), best.applied(&before), "and nothing else");
    let path = std::env::temp_dir().join(format!("pnaen-window-{}.csv", std::process::id()));
    harness.state().save_chart(&path).expect("it is written");
    let table = std::fs::read_to_string(&path).expect("it is there");
    std::fs::remove_file(&path).expect("removed");
    assert_eq!(table.lines().count(), 11);
}

#[test]
fn a_click_on_a_point_applies_its_setting() {
    let one = Plan { surfaces: vec![Surface::Flat], lods: vec![LodKind::Uniform], factors: vec![1.0], ..plan() };
    // The window's own has more, so that the one point is in the middle.
    let mut harness = charting(one, Effort { most_triangles: 30, ..effort() });
    measure(&mut harness, "Measure");
    assert_eq!((harness.state().chart_rows().len(), harness.state().chart_current()), (1, None));
    assert!(harness.query_by_label_contains("current left out as too fine").is_some());
    let middle = harness.get_by_role_and_label(Role::Image, "Chart").rect().center();
    harness.hover_at(middle);
    harness.run_steps(3);
    assert!(harness.query_by_label_contains("20 triangles").is_some(), "it says what it is");
    harness.drag_at(middle);
    harness.run_steps(1);
    harness.drop_at(middle);
    settle(&mut harness);
    let settings = harness.state().settings();
    assert_eq!(Setting::of(settings), Some(harness.state().chart_rows()[0].setting));
    assert_eq!(settings.tessellation.clip, Clip::Frustum, "it stays what it was");
    assert!(harness.query_by_label("Measure again").is_some(), "it is still of what is shown");
}

#[test]
fn what_is_measured_stays_when_cancelled_and_goes_grey_when_the_camera_turns() {
    let mut harness = charting(plan(), effort());
    click(&mut harness, "Measure");
    wait(&mut harness, |app| app.chart_rows().len() >= 2);
    click(&mut harness, "Cancel");
    let kept = harness.state().chart_rows().to_vec();
    assert!(kept.len() >= 2 && harness.state().charting().is_none());
    // What isn't measured doesn't matter to it.
    choose(&mut harness, "Clipping", "Off");
    assert!(harness.query_by_label_contains("measure again").is_none());
    measure(&mut harness, "Measure on");
    assert_eq!(harness.state().chart_rows().len(), 10);
    assert!(kept.iter().all(|row| harness.state().chart_rows().contains(row)), "those weren't measured again");
    press(&mut harness, egui::Key::Num1);
    assert!(harness.query_by_label("of another view: measure again").is_some());
    assert_eq!(harness.state().chart_rows().len(), 10, "and stay until then");
    assert!(harness.state().charting().is_none(), "nothing starts by itself");
    measure(&mut harness, "Measure again");
    assert!(harness.query_by_label("of another view: measure again").is_none());
    let rows = harness.state().chart_rows();
    assert!(rows.len() == 10 && !rows.contains(&kept[0]), "measured anew");
    press(&mut harness, egui::Key::G);
    assert!(harness.query_by_label("Measure again").is_none());
    assert_eq!(harness.state().chart_rows().len(), 10, "they are there when it is opened again");
}

#[test]
fn what_the_window_has_is_measured_once_it_is_left_alone() {
    let mut harness = charting(Plan { lods: vec![LodKind::Uniform], ..plan() }, effort());
    measure(&mut harness, "Measure");
    let before = harness.state().chart_current().expect("measured first");
    choose(&mut harness, "LOD", "Distance");
    wait(&mut harness, |app| app.chart_current().is_some_and(|own| own.triangles != before.triangles));
    wait(&mut harness, |app| app.charting().is_none());
    choose(&mut harness, "Partitioning", "Fractional odd");
    harness.get_by_role_and_label(Role::Slider, "Factor").set_value_accesskit(4.0);
    settle(&mut harness);
    rest(&mut harness);
    let once = harness.state().chart_current();
    choose(&mut harness, "LOD", "Uniform");
    harness.run_steps(20);
    assert_eq!((harness.state().charting(), harness.state().chart_current()), (None, once), "the list has that one");
    choose(&mut harness, "LOD", "Distance");
    harness.run_steps(20);
    assert_eq!((harness.state().charting(), harness.state().chart_current()), (None, once), "and this is known");
}

#[test]
fn methods_are_chosen_and_a_mesh_without_a_truth_is_held_against_limits() {
    let mut harness = window(Some(Source::Shape(Shape::CubeSplit)));
    harness.state_mut().chart_with(Plan { factors: vec![1.0, 4.0], ..plan() }, effort());
    for (role, name) in [(Role::Button, "View"), (Role::CheckBox, "Chart")] {
        harness.get_by_role_and_label(role, name).click();
        settle(&mut harness);
    }
    press(&mut harness, egui::Key::Escape);
    click(&mut harness, "Methods");
    for name in ["flat", "LOD by error", "pn"] {
        harness.get_by_role_and_label(Role::CheckBox, name).click();
        settle(&mut harness);
    }
    press(&mut harness, egui::Key::Escape);
    measure(&mut harness, "Measure");
    let rows = harness.state().chart_rows();
    let mut surfaces: Vec<_> = rows.iter().map(|row| row.setting.method.surface).collect();
    surfaces.dedup();
    assert!(rows.len() == 4 && !surfaces.contains(&Surface::Flat) && surfaces.contains(&Surface::Pn), "{surfaces:?}");
    assert!(rows.iter().all(|row| row.errors.is_none() && row.max_error_px.is_some()));
    assert!(harness.query_by_label_contains("against each surface's own limit").is_some());
}

//! The chart: measuring, cancelling, and applying a setting with a click.

use std::time::{Duration, Instant};

use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use geometry::mesh::Shape;
use geometry::tessellate::{Clip, Surface};
use inspect::engine::Runs;
use inspect::measure::{AccuracyOptions, Narrow};
use inspect::settings::Choice;
use lab::chart::{Effort, LodKind, Plan, Row, Setting};
use load::Source;
use pnaen::app::App;

use crate::{PATIENCE, choose, click, press, settle, window};

/// Ten settings with few triangles. The window's own setting isn't among them.
fn plan() -> Plan {
    Plan {
        surfaces: vec![Surface::Flat, Surface::PnAen],
        lods: vec![LodKind::Uniform, LodKind::Error],
        factors: vec![1.0, 2.0, 4.0],
        tolerances: vec![8.0, 1.0],
        ..Plan::default()
    }
}

/// The smallest effort that gives a number.
fn effort() -> Effort {
    let runs = Runs { least: 1, most: 1, within: Duration::ZERO };
    let accuracy = AccuracyOptions { samples: 500, threads: 2, narrow: Narrow { searches: 1 << 12, ..Narrow::QUICK } };
    Effort { runs, accuracy, ..Effort::default() }
}

/// A window with an icosahedron and an open chart.
fn charting(plan: Plan, effort: Effort) -> Harness<'static, App> {
    let mut harness = window(Some(Source::Shape(Shape::Icosahedron)));
    harness.state_mut().chart_with(plan, effort);
    press(&mut harness, egui::Key::G);
    harness
}

/// Runs frames until this is true.
fn wait(harness: &mut Harness<App>, until: impl Fn(&App) -> bool) {
    let start = Instant::now();
    while !until(harness.state()) {
        assert!(start.elapsed() < PATIENCE, "the chart takes too long");
        std::thread::sleep(Duration::from_millis(2));
        harness.step();
    }
    harness.run_steps(2);
}

/// Runs frames until no measurement is under way and none starts by itself.
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

/// Checks that no name of the legend is broken, and no setting in the list is cut off.
fn legend_and_list_are_whole(harness: &Harness<App>) {
    for name in ["Flat", "PN-AEN", "Uniform factor", "LOD by error", "Front"] {
        let height = harness.get_by_role_and_label(Role::Label, name).rect().height();
        assert!(height < 20.0, "{name} is {height} points high");
    }
    let edge = harness.get_by_label("Viewport").rect().right();
    let rows: Vec<_> = harness.query_all_by_label_contains("Apply ").map(|row| row.rect()).collect();
    assert!(!rows.is_empty() && rows.iter().all(|row| row.right() < edge - 12.0), "{rows:?} {edge}");
}

fn error(row: &Row) -> f64 {
    row.probe.errors.map_or(f64::INFINITY, |errors| errors.largest.at_least)
}

#[test]
fn the_chart_is_measured_and_a_setting_of_its_front_is_applied() {
    let mut harness = charting(plan(), effort());
    assert!(harness.state().chart_rows().is_empty(), "measuring doesn't start by itself");
    click(&mut harness, "Measure");
    assert_eq!(harness.state().charting().map(|(_, all)| all), Some(11), "ten settings and the window's own");
    wait(&mut harness, |app| !app.chart_rows().is_empty());
    wait(&mut harness, |app| app.charting().is_none());
    legend_and_list_are_whole(&harness);
    let rows = harness.state().chart_rows().to_vec();
    assert_eq!(rows.len(), 10);
    assert!(rows.iter().all(|row| row.probe.time.total() > 0.0 && error(row) > 0.0 && row.mesh == "shape:icosahedron"));
    assert!(harness.query_by_label_contains("Icosahedron against exact icosahedron").is_some());
    let own = harness.state().chart_current().expect("measured first");
    assert!(own.triangles > rows[0].probe.triangles);
    // The setting with the least error is always on the front.
    let best = rows.iter().min_by(|a, b| error(a).total_cmp(&error(b))).expect("ten rows").setting;
    let before = *harness.state().settings();
    assert_ne!(Setting::new(&before), Some(best));
    harness.get_by_role_and_label(Role::Button, "Triangles").click();
    settle(&mut harness);
    harness.get_by_label_contains(&format!("Apply {} {best}:", best.method.surface.label())).click();
    settle(&mut harness);
    assert_eq!(*harness.state().settings(), best.applied(&before), "nothing else changes");
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = folder.path().join("chart.csv");
    harness.state().save_chart(&path).expect("it is written");
    let table = std::fs::read_to_string(&path).expect("it is there");
    assert_eq!(table.lines().count(), 11);
}

#[test]
fn a_click_on_a_point_applies_its_setting() {
    let one = Plan { surfaces: vec![Surface::Flat], lods: vec![LodKind::Uniform], factors: vec![1.0], ..plan() };
    // The window's own setting has more triangles, so the chart has one point, which is in its middle.
    let mut harness = charting(one, Effort { most_triangles: 30, ..effort() });
    measure(&mut harness, "Measure");
    assert_eq!((harness.state().chart_rows().len(), harness.state().chart_current()), (1, None));
    assert!(harness.query_by_label_contains("current settings left out").is_some());
    let middle = harness.get_by_role_and_label(Role::Image, "Chart").rect().center();
    harness.hover_at(middle);
    harness.run_steps(3);
    assert!(harness.query_by_label_contains("20 triangles").is_some(), "the tooltip has the number of triangles");
    harness.drag_at(middle);
    harness.run_steps(1);
    harness.drop_at(middle);
    settle(&mut harness);
    let settings = harness.state().settings();
    assert_eq!(Setting::new(settings), Some(harness.state().chart_rows()[0].setting));
    assert_eq!(settings.tessellation.clip, Clip::Frustum, "clipping stays");
    assert!(harness.query_by_label("Measure again").is_some(), "the chart isn't out of date");
}

#[test]
fn rows_stay_after_cancelling_and_are_out_of_date_after_the_camera_turned() {
    let mut harness = charting(plan(), effort());
    click(&mut harness, "Measure");
    wait(&mut harness, |app| app.chart_rows().len() >= 2);
    click(&mut harness, "Cancel");
    let kept = harness.state().chart_rows().to_vec();
    assert!(kept.len() >= 2 && harness.state().charting().is_none());
    // Clipping isn't part of the measurement, so the chart isn't out of date.
    choose(&mut harness, "Clipping", "Off");
    assert!(harness.query_by_label_contains("out of date").is_none());
    measure(&mut harness, "Measure rest");
    assert_eq!(harness.state().chart_rows().len(), 10);
    assert!(
        kept.iter().all(|row| harness.state().chart_rows().contains(row)),
        "the rows so far weren't measured again"
    );
    press(&mut harness, egui::Key::Num1);
    assert!(harness.query_by_label("out of date: the view has changed").is_some());
    assert_eq!(harness.state().chart_rows().len(), 10, "the rows stay");
    assert!(harness.state().charting().is_none(), "measuring doesn't start by itself");
    measure(&mut harness, "Measure again");
    assert!(harness.query_by_label_contains("out of date").is_none());
    let rows = harness.state().chart_rows();
    assert!(rows.len() == 10 && !rows.contains(&kept[0]), "all rows are new");
    press(&mut harness, egui::Key::G);
    assert!(harness.query_by_label("Measure again").is_none());
    assert_eq!(harness.state().chart_rows().len(), 10, "the rows stay while the chart is closed");
}

#[test]
fn the_windows_own_settings_are_measured_once_they_stay_unchanged() {
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
    assert_eq!(
        (harness.state().charting(), harness.state().chart_current()),
        (None, once),
        "the chart's list has this setting"
    );
    choose(&mut harness, "LOD", "Distance");
    harness.run_steps(20);
    assert_eq!(
        (harness.state().charting(), harness.state().chart_current()),
        (None, once),
        "this setting was measured before"
    );
}

#[test]
fn methods_can_be_chosen_and_without_a_reference_surface_errors_are_in_px() {
    let mut harness = window(Some(Source::Shape(Shape::CubeSplit)));
    harness.state_mut().chart_with(Plan { factors: vec![1.0, 4.0], ..plan() }, effort());
    for (role, name) in [(Role::Button, "View"), (Role::CheckBox, "Chart")] {
        harness.get_by_role_and_label(role, name).click();
        settle(&mut harness);
    }
    press(&mut harness, egui::Key::Escape);
    click(&mut harness, "Methods");
    for name in ["Flat", "LOD by error", "PN"] {
        harness.get_by_role_and_label(Role::CheckBox, name).click();
        settle(&mut harness);
    }
    press(&mut harness, egui::Key::Escape);
    measure(&mut harness, "Measure");
    let rows = harness.state().chart_rows();
    let mut surfaces: Vec<_> = rows.iter().map(|row| row.setting.method.surface).collect();
    surfaces.dedup();
    assert!(rows.len() == 4 && !surfaces.contains(&Surface::Flat) && surfaces.contains(&Surface::Pn), "{surfaces:?}");
    assert!(rows.iter().all(|row| row.probe.errors.is_none() && row.probe.max_error_px.is_some()));
    assert!(harness.query_all_by_label_contains("each surface's own limit").count() > 0);
}

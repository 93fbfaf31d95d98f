//! The deviation overlay, its section, and truths.

use egui_kittest::kittest::Queryable;
use glam::Vec3;
use pnaen::mesh::{Shape, Source};
use pnaen::settings::{Colors, DeviationUnit};

use crate::{choose, click, press, settle, uniform, window};

#[test]
fn deviation_is_measured_and_has_a_legend_and_a_worst_point_that_a_click_frames() {
    let mut harness = uniform(Some(Source::Shape(Shape::Icosahedron)));
    choose(&mut harness, "Surface", "Flat");
    assert!(harness.query_by_label("Legend: Deviation, units").is_none());
    choose(&mut harness, "Colours", "Deviation");
    assert_eq!(harness.state().settings().overlays.colors, Colors::Deviation);
    assert!(harness.query_by_label("Legend: Deviation, units").is_some());
    // What the inscribed sphere leaves of the circumscribed one.
    let largest = harness.state().deviation().expect("measured");
    assert!((largest - 0.205_345_5).abs() < 1e-6, "{largest}");
    for text in ["exact icosahedron", "0.205 units"] {
        assert!(harness.query_by_label(text).is_some(), "{text}");
    }
    let before = *harness.state().camera();
    harness.get_by_label_contains("Worst point in patch").click();
    settle(&mut harness);
    let after = *harness.state().camera();
    assert_ne!(after, before);
    // The middle of a face, seen from above it.
    assert!((after.target.length() - 0.794_654_5).abs() < 1e-5, "{}", after.target);
    assert!(after.axes()[2].distance(after.target.normalize()) < 1e-3);
    assert_eq!(harness.state().deviation(), Some(largest), "the same tessellation");
    choose(&mut harness, "Distances in", "Px");
    assert_eq!(harness.state().settings().deviation_in, DeviationUnit::Px);
    assert!(harness.query_by_label("Legend: Deviation, px").is_some());
    press(&mut harness, egui::Key::V);
    assert_eq!(harness.state().settings().overlays.colors, Colors::Material);
    assert!(harness.query_by_label("Legend: Deviation, px").is_none());
}

#[test]
fn another_tessellation_is_measured_anew_and_the_worst_point_stays_the_worst_when_framed() {
    let mut harness = window(Some(Source::Shape(Shape::Icosahedron)));
    press(&mut harness, egui::Key::V);
    let adaptive = harness.state().deviation().expect("measured");
    harness.get_by_label_contains("Worst point in patch").click();
    settle(&mut harness);
    assert_eq!(harness.state().deviation(), Some(adaptive), "LOD and clipping stay as they are");
    choose(&mut harness, "Surface", "Flat");
    let flat = harness.state().deviation().expect("measured anew");
    assert!(flat > 1.2 * adaptive, "{flat} and {adaptive}");
}

#[test]
fn a_truth_is_loaded_beside_the_window_and_the_old_one_stays_where_it_fails() {
    let mut harness = uniform(Some(Source::Shape(Shape::CubeSmooth)));
    press(&mut harness, egui::Key::V);
    assert!(harness.query_by_label("its own limit").is_some());
    let limit = harness.state().deviation().expect("measured");
    let context = harness.ctx.clone();
    harness.state_mut().open_truth(&context, Source::Shape(Shape::CubeSplit));
    settle(&mut harness);
    // The cube that it is made from: rounded, its corners stay and its faces bulge.
    assert_eq!(harness.state().truth(), Some(&Source::Shape(Shape::CubeSplit)));
    let bulge = harness.state().deviation().expect("measured");
    assert!(bulge > 10.0 * limit && bulge < Vec3::ONE.length().into(), "{bulge} and {limit}");
    harness.state_mut().open_truth(&context, Source::File("nowhere.glb".into()));
    settle(&mut harness);
    assert!(harness.query_by_label_contains("nowhere.glb").is_some(), "a problem");
    assert_eq!(harness.state().deviation(), Some(bulge), "the old one stays");
    click(&mut harness, "Close");
    click(&mut harness, "File");
    click(&mut harness, "No truth");
    assert_eq!((harness.state().truth(), harness.state().deviation()), (None, Some(limit)));
}

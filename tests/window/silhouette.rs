//! The silhouette: its outlines over the picture, its legend, and the command that draws the same.

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use geometry::mesh::Shape;
use inspect::settings::Colors;
use load::Source;
use pnaen::app::App;

use crate::driver::settle;
use crate::editing::{assert_draws, copied, press_with};
use crate::{press, uniform};

/// What the legend says of the outlines' distances, in px: from the source mesh and from the surface.
fn distances(harness: &Harness<App>) -> [f64; 2] {
    let legend = harness.get_by_label_contains("Legend: Outlines: triangles, source: ");
    let said = legend.accesskit_node().label().expect("a name");
    let numbers: Vec<f64> = said.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    numbers.try_into().unwrap_or_else(|_| panic!("two numbers in {said}"))
}

fn set_factor(harness: &mut Harness<App>, factor: f64) {
    harness.get_by_role_and_label(Role::Slider, "Factor").set_value_accesskit(factor);
    settle(harness);
}

#[test]
fn the_silhouette_shows_how_far_the_outline_is_from_the_sources_and_the_surfaces() {
    let mut harness = uniform(Some(Source::Shape(Shape::Icosahedron)));
    set_factor(&mut harness, 1.0);
    press_with(&mut harness, Modifiers::SHIFT, Key::O);
    assert_eq!(harness.state().settings().overlays.colors, Colors::Silhouette);
    let coarse = distances(&harness);
    assert!(coarse[0] == 0.0 && coarse[1] > 10.0, "factor 1 is the source: {coarse:?}");
    let command = copied(&mut harness);
    assert!(command.contains("--overlay silhouette"), "{command}");
    assert_draws(&harness, &command, "icosahedron-view");
    press(&mut harness, Key::Escape);
    set_factor(&mut harness, 32.0);
    let fine = distances(&harness);
    assert!((fine[0] - coarse[1]).abs() <= 1.0 && fine[1] <= 0.6, "{fine:?} after {coarse:?}");
    let before = harness.state().read_picture().expect("a device");
    for _ in 0..3 {
        press(&mut harness, Key::PageDown);
    }
    let far = distances(&harness);
    assert!(far[0] < 0.8 * fine[0] && far[0] > 5.0, "farther away, it is fewer px: {far:?} after {fine:?}");
    assert_ne!(harness.state().read_picture().expect("a device"), before);
    press_with(&mut harness, Modifiers::SHIFT, Key::O);
    assert!(harness.query_by_label_contains("Legend: ").is_none());
}

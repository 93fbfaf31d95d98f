//! The weights of the file's morph targets: slid, reset, undone, and in the command that draws the same.

use std::time::{Duration, Instant};

use documents::moving::moving;
use egui::Key;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use load::Source;
use pnaen::app::App;
use tempfile::TempDir;

use crate::driver::PATIENCE;
use crate::editing::{assert_draws, copied};
use crate::lod_shader::until;
use crate::{click, press, scroll_to, settle, uniform, uniform_of, vase};

/// The least x of the mesh: the beam's upper end, which is 1 wide, swells by 0.8 of that at a weight of 1.
fn least(harness: &Harness<App>) -> f32 {
    harness.state().loaded().expect("a mesh").mesh.bounds().min.x
}

fn chosen(harness: &Harness<App>) -> Vec<(String, f32)> {
    harness.state().loaded().expect("a mesh").preparation.parts.morphs.clone().into_iter().collect()
}

fn weight(harness: &Harness<App>) -> Option<f64> {
    harness.get_by_role_and_label(Role::Slider, "Swell").accesskit_node().numeric_value()
}

#[test]
fn morph_targets_are_weighed_undone_and_reset() {
    let (_folder, mut harness) = uniform_of("moving.glb", moving());
    scroll_to(&mut harness, "Reset morph targets");
    let near = |own: f32, expected: f32| (own - expected).abs() < 1e-5;
    assert!(near(least(&harness), -0.6) && weight(&harness) == Some(0.25), "as the file says");
    let camera = *harness.state().camera();
    harness.get_by_role_and_label(Role::Slider, "Swell").set_value_accesskit(1.0);
    settle(&mut harness);
    assert!(near(least(&harness), -0.9), "{}", least(&harness));
    assert_eq!((chosen(&harness), *harness.state().camera()), (vec![("Swell".to_owned(), 1.0)], camera));
    let context = harness.ctx.clone();
    harness.state_mut().undo(&context);
    settle(&mut harness);
    assert!(near(least(&harness), -0.6) && chosen(&harness).is_empty());
    harness.state_mut().redo(&context);
    settle(&mut harness);
    assert!(near(least(&harness), -0.9));
    click(&mut harness, "Reset morph targets");
    assert!(near(least(&harness), -0.6) && chosen(&harness).is_empty() && weight(&harness) == Some(0.25));
}

#[test]
fn the_left_half_has_weights_of_its_own_which_are_undone_and_copied() {
    let (_folder, mut harness) = uniform_of("moving.glb", moving());
    press(&mut harness, Key::S);
    scroll_to(&mut harness, "Edit left (A)");
    click(&mut harness, "Edit left (A)");
    scroll_to(&mut harness, "Reset morph targets");
    assert_eq!(weight(&harness), Some(0.25), "as on the right");
    let unweighed = "Left: untessellated\n";
    harness.get_by_label_contains(unweighed);
    harness.get_by_role_and_label(Role::Slider, "Swell").set_value_accesskit(1.0);
    settle(&mut harness);
    assert!(
        (least(&harness) + 0.6).abs() < 1e-5 && chosen(&harness).is_empty(),
        "the right half stays: {}, {:?}",
        least(&harness),
        chosen(&harness)
    );
    assert_eq!(weight(&harness), Some(1.0));
    let weighed = "Left: Swell 1, untessellated\n";
    harness.get_by_label_contains(weighed);
    harness.get_by_label_contains("Right: PN-AEN\n");
    let command = copied(&mut harness);
    assert!(command.contains(" --split-morph Swell=1"), "{command}");
    assert_draws(&harness, &command, "moving-view");
    let context = harness.ctx.clone();
    harness.state_mut().undo(&context);
    settle(&mut harness);
    harness.get_by_label_contains(unweighed);
    harness.state_mut().redo(&context);
    settle(&mut harness);
    harness.get_by_label_contains(weighed);
    // What it doesn't have of its own it has from the right half.
    scroll_to(&mut harness, "Edit right (B)");
    click(&mut harness, "Edit right (B)");
    let left_mesh = harness.get_by_role_and_label(Role::ComboBox, "Left mesh").accesskit_node().value();
    assert_eq!(left_mesh.as_deref(), Some("The same, own weights"));
    scroll_to(&mut harness, "Reset morph targets");
    assert_eq!(weight(&harness), Some(0.25));
    harness.get_by_role_and_label(Role::Slider, "Lean").set_value_accesskit(0.5);
    settle(&mut harness);
    harness.get_by_label_contains(weighed);
    assert_eq!(chosen(&harness), [("Lean".to_owned(), 0.5)]);
    let command = copied(&mut harness);
    assert!(command.contains(" --morph Lean=0.5") && command.contains(" --split-morph Swell=1"), "{command}");
    assert_draws(&harness, &command, "moving-view");
    scroll_to(&mut harness, "Edit left (A)");
    click(&mut harness, "Edit left (A)");
    scroll_to(&mut harness, "Reset morph targets");
    click(&mut harness, "Reset morph targets");
    harness.get_by_label_contains(unweighed);
    let lean = harness.get_by_role_and_label(Role::Slider, "Lean").accesskit_node().numeric_value();
    assert_eq!((weight(&harness), lean), (Some(0.25), Some(0.5)));
    assert!(!copied(&mut harness).contains("--split-morph"));
}

/// A window whose left half alone has a weight of 1, while that half is edited, and the folder of its file.
fn swollen_on_the_left() -> (TempDir, Harness<'static, App>) {
    let (folder, mut harness) = uniform_of("moving.glb", moving());
    press(&mut harness, Key::S);
    scroll_to(&mut harness, "Edit left (A)");
    click(&mut harness, "Edit left (A)");
    scroll_to(&mut harness, "Reset morph targets");
    harness.get_by_role_and_label(Role::Slider, "Swell").set_value_accesskit(1.0);
    settle(&mut harness);
    (folder, harness)
}

#[test]
fn swap_exchanges_the_weights_of_both_halves() {
    let (_folder, mut harness) = swollen_on_the_left();
    for (swell, of_left) in [(-0.6, "Swell 1"), (-0.9, "Swell 0.25"), (-0.6, "Swell 1")] {
        assert!((least(&harness) - swell).abs() < 1e-5, "{}", least(&harness));
        harness.get_by_label_contains(&format!("Left: {of_left}, "));
        scroll_to(&mut harness, "Swap");
        click(&mut harness, "Swap");
    }
    let context = harness.ctx.clone();
    harness.state_mut().undo(&context);
    settle(&mut harness);
    assert!((least(&harness) + 0.6).abs() < 1e-5, "it is one step: {}", least(&harness));
    harness.get_by_label_contains("Left: Swell 1, ");
}

#[test]
fn weights_of_the_left_half_that_the_file_no_longer_has_are_dropped_with_a_sentence() {
    let (folder, mut harness) = swollen_on_the_left();
    harness.get_by_label_contains("Left: Swell 1, untessellated\n");
    let mut changed = moving();
    // A clip is called Swell, too.
    let targets = br#""Swell","Lean""#;
    let name = 1 + changed.windows(targets.len()).position(|word| word == targets).expect("morph targets");
    changed[name..name + 5].copy_from_slice(b"Puffs");
    std::fs::write(folder.path().join("moving.glb"), changed).expect("a writable folder");
    until(&mut harness, "the file isn't read again", |app| {
        app.loaded().is_some_and(|loaded| loaded.contents.morph_targets.contains_key("Puffs"))
    });
    harness.get_by_label_contains("Left: untessellated\n");
    harness.get_by_label_contains("; the left half has no weights of its own any more");
}

#[test]
fn a_drag_loads_the_mesh_anew_while_a_reference_surface_is_being_read() {
    // Reading it takes longer than loading the beam.
    const SIDE: usize = 450;
    let points = (0..=SIDE).flat_map(|y| (0..=SIDE).map(move |x| format!("v {x} {y} 0\n")));
    let faces = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| 1 + y * (SIDE + 1) + x));
    let faces = faces.map(|first| format!("f {first} {} {} {}\n", first + 1, first + SIDE + 2, first + SIDE + 1));
    let (folder, mut harness) = uniform_of("moving.glb", moving());
    let sheet = folder.path().join("sheet.obj");
    std::fs::write(&sheet, points.chain(faces).collect::<String>()).expect("a writable folder");
    scroll_to(&mut harness, "Reset morph targets");
    let slider = harness.get_by_role_and_label(Role::Slider, "Swell").rect();
    let place = slider.left_center() + egui::vec2(0.4 * slider.width(), 0.0);
    harness.hover_at(place);
    harness.run_steps(1);
    let context = harness.ctx.clone();
    harness.state_mut().open_reference_shape(&context, Source::File(sheet));
    harness.drag_at(place);
    let start = Instant::now();
    while (least(&harness) + 0.6).abs() < 1e-5 {
        assert!(start.elapsed() < PATIENCE, "the mesh isn't loaded anew");
        std::thread::sleep(Duration::from_millis(2));
        harness.step();
    }
    assert!(harness.state().reference_shape().is_none(), "it isn't read yet");
}

#[test]
fn a_file_without_morph_targets_has_no_list_of_them() {
    let harness = uniform(Some(vase()));
    assert!(harness.query_by_label("Morph targets").is_none());
}

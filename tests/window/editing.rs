//! Undo and redo, the command that draws what is shown, and the search for commands.

use std::process::Command;

use egui::accesskit::Role;
use egui::{Key, Modifiers, OutputCommand};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use geometry::mesh::Shape;
use geometry::tessellate::{Displacement, Lod, Surface, Tessellation};
use inspect::shot::{BETWEEN_DRIVERS, compare};
use load::{HeightSource, Source};
use pnaen::app::App;

use crate::{choose, click, press, run_command, settle, uniform, vase, window};

pub(super) fn press_with(harness: &mut Harness<App>, modifiers: Modifiers, key: Key) {
    harness.key_press_modifiers(modifiers, key);
    settle(harness);
}

#[test]
fn settings_are_undone_and_redone() {
    let mut harness = window(None);
    let first = *harness.state().settings();
    choose(&mut harness, "Surface", "PN");
    press(&mut harness, Key::W);
    choose(&mut harness, "LOD", "Uniform");
    let last = *harness.state().settings();
    assert_eq!(
        (last.tessellation.surface, last.tessellation.lod, last.overlays.wireframe),
        (Surface::Pn, Lod::Uniform, true)
    );
    press_with(&mut harness, Modifiers::COMMAND, Key::Z);
    press_with(&mut harness, Modifiers::COMMAND, Key::Z);
    let between = *harness.state().settings();
    assert_eq!(
        (between.tessellation.surface, between.tessellation.lod, between.overlays.wireframe),
        (Surface::Pn, first.tessellation.lod, false)
    );
    click(&mut harness, "Edit");
    harness.get_by_label_contains("Undo").click();
    settle(&mut harness);
    assert_eq!(*harness.state().settings(), first);
    assert_eq!(
        harness.state().cracks().map(|cracks| cracks.edges.len()),
        Some(0),
        "the picture is drawn and measured again"
    );
    press_with(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(*harness.state().settings(), first, "there is nothing to undo");
    for _ in 0..3 {
        press_with(&mut harness, Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z);
    }
    assert_eq!(*harness.state().settings(), last);
    // Opening a mesh isn't a step.
    press_with(&mut harness, Modifiers::COMMAND, Key::Z);
    let before = *harness.state().settings();
    let context = harness.ctx.clone();
    harness.state_mut().open(&context, Source::Shape(Shape::Torus));
    settle(&mut harness);
    assert_eq!((*harness.state().settings(), harness.state().source()), (before, Some(&Source::Shape(Shape::Torus))));
    press(&mut harness, Key::C);
    press_with(&mut harness, Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z);
    assert!(harness.state().settings().overlays.cracks, "a change clears what could be redone");
}

#[test]
fn a_drag_is_one_step() {
    let mut harness = uniform(None);
    let before = harness.state().settings().tessellation.factor;
    let slider = harness.get_by_role_and_label(Role::Slider, "Factor").rect();
    harness.drag_at(slider.center());
    for x in [10.0, 20.0, 25.0] {
        harness.run_steps(2);
        harness.hover_at(slider.center() + egui::vec2(x, 0.0));
    }
    harness.run_steps(2);
    harness.drop_at(slider.center() + egui::vec2(25.0, 0.0));
    settle(&mut harness);
    assert_ne!(harness.state().settings().tessellation.factor, before);
    press_with(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(harness.state().settings().tessellation.factor, before);
}

/// Copies the command with the menu and returns it. Checks that the window shows it.
pub(super) fn copied(harness: &mut Harness<App>) -> String {
    click(harness, "Edit");
    harness.get_by_label_contains("Copy as command").click();
    harness.step();
    let commands = &harness.output().platform_output.commands;
    let copied = commands.iter().find_map(|command| match command {
        OutputCommand::CopyText(text) => Some(text.clone()),
        _ => None,
    });
    settle(harness);
    let command = copied.expect("a command");
    assert!(harness.query_by_label(&command).is_some(), "the command is shown");
    press(harness, Key::Escape);
    assert!(harness.query_by_label(&command).is_none());
    press_with(harness, Modifiers::COMMAND, Key::K);
    assert!(harness.query_by_label(&command).is_some(), "the key does the same");
    command
}

/// Runs a command in a folder of its own, and compares its picture with the window's.
pub(super) fn assert_draws(harness: &Harness<App>, command: &str, name: &str) {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    // The shell splits the line into words.
    let output = Command::new("sh").args(["-c", &format!("printf '%s\\n' {command}")]).output().expect("a shell");
    let line = String::from_utf8(output.stdout).expect("UTF-8");
    let mut words: Vec<&str> = line.lines().collect();
    assert_eq!(words.remove(0), "pnaen");
    let at = words.iter().position(|word| *word == "-o").expect("a command that writes a picture");
    let file: Vec<_> = words.drain(at..at + 2).collect();
    assert_eq!(file[1], format!("{name}.png"));
    let picture = folder.path().join(file[1]);
    run_command(words, &picture);
    let drawn = image::open(&picture).expect("a picture").to_rgba8();
    let shown = harness.state().read_picture().expect("a device").expect("a picture");
    let comparison = compare(&drawn, &shown).expect("one size");
    // The command has the camera's distance in bounding radii, which rounds its last bit.
    assert!(comparison.worst_square <= f64::from(BETWEEN_DRIVERS), "{command}: {comparison:?}");
}

#[test]
fn the_copied_command_draws_what_is_shown() {
    let mut harness = window(Some(vase()));
    choose(&mut harness, "Surface", "Phong");
    choose(&mut harness, "Colours", "Barycentric");
    press(&mut harness, Key::A);
    press(&mut harness, Key::S);
    for key in [Key::ArrowLeft, Key::ArrowUp, Key::Num5] {
        press(&mut harness, key);
    }
    press_with(&mut harness, Modifiers::SHIFT, Key::ArrowRight);
    let command = copied(&mut harness);
    assert!(command.contains("--surface phong ") && command.contains("--split 0.5 "), "{command}");
    assert!(command.contains("--overlay barycentric,adjacency "), "{command}");
    assert_draws(&harness, &command, "vase-view");
}

#[test]
fn commands_are_found_by_a_part_of_their_name() {
    let mut harness = window(None);
    press_with(&mut harness, Modifiers::COMMAND, Key::P);
    harness.get_by_role_and_label(Role::TextInput, "Search commands").type_text("surf aen");
    settle(&mut harness);
    harness.get_by_label("Surface: PN-AEN");
    assert!(harness.query_by_label("Surface: Flat").is_none());
    for key in [Key::ArrowDown, Key::ArrowDown, Key::ArrowUp, Key::Enter] {
        press(&mut harness, key);
    }
    assert_eq!(harness.state().settings().tessellation.surface, Surface::PhongAen);
    assert!(harness.query_by_label("Search commands").is_none(), "the search closes");
    // The search also opens from the menu, and letters that are shortcuts elsewhere are typed into it.
    click(&mut harness, "Help");
    harness.get_by_label_contains("Search commands").click();
    settle(&mut harness);
    let before = *harness.state().settings();
    harness.get_by_role_and_label(Role::TextInput, "Search commands").type_text("wire");
    settle(&mut harness);
    assert_eq!(*harness.state().settings(), before);
    harness.get_by_label_contains("Overlay: Wireframe").click();
    settle(&mut harness);
    assert!(harness.state().settings().overlays.wireframe);
    press_with(&mut harness, Modifiers::COMMAND, Key::P);
    press(&mut harness, Key::Escape);
    assert!(harness.query_by_label("Search commands").is_none());
    press_with(&mut harness, Modifiers::COMMAND, Key::P);
    harness.get_by_role_and_label(Role::TextInput, "Search commands").type_text("torus");
    settle(&mut harness);
    press(&mut harness, Key::Enter);
    assert_eq!(harness.state().source(), Some(&Source::Shape(Shape::Torus)));
}

#[test]
fn displacement_follows_the_height_map_and_is_undone_with_it() {
    let mut harness = window(None);
    let drawn = |harness: &Harness<App>| harness.state().totals();
    let (settings, before) = (*harness.state().settings(), drawn(&harness));
    press(&mut harness, Key::D);
    assert_eq!((*harness.state().settings(), drawn(&harness)), (settings, before), "there are no heights");
    press(&mut harness, Key::W);
    let with_wires = *harness.state().settings();
    let context = harness.ctx.clone();
    let waves = HeightSource::File(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/waves.png").into());
    harness.state_mut().displace(&context, Some(waves));
    settle(&mut harness);
    assert_eq!(harness.state().settings().tessellation.displacement, Displacement::On);
    let displaced = drawn(&harness);
    // Displacement came with the heights, and both are one step.
    press_with(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!((*harness.state().settings(), drawn(&harness)), (with_wires, before));
    press_with(&mut harness, Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z);
    let with_heights = Tessellation { displacement: Displacement::On, ..with_wires.tessellation };
    assert_eq!((*harness.state().settings(), drawn(&harness)), (with_wires.with(with_heights), displaced));
    harness.state_mut().displace(&context, None);
    settle(&mut harness);
    assert_eq!((*harness.state().settings(), drawn(&harness)), (with_wires, before));
    for _ in 0..3 {
        press_with(&mut harness, Modifiers::COMMAND, Key::Z);
    }
    assert_eq!(*harness.state().settings(), settings);
}

#[test]
fn the_picture_is_copied_as_it_is_shown() {
    let mut harness = window(None);
    let shown = harness.state().read_picture().expect("a device").expect("a picture");
    click(&mut harness, "Edit");
    harness.get_by_label_contains("Copy picture").click();
    harness.step();
    let copied = harness.output().platform_output.commands.iter().find_map(|command| match command {
        OutputCommand::CopyImage(image) => Some(image.clone()),
        _ => None,
    });
    let copied = copied.expect("a picture");
    assert_eq!(copied.size, [shown.width() as usize, shown.height() as usize]);
    assert!(copied.pixels.iter().zip(shown.pixels()).all(|(copied, shown)| copied.to_srgba_unmultiplied() == shown.0));
}

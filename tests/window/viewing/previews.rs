//! Previews while the camera moves.

use egui::Key;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use geometry::mesh::{PartStyle, Shape};
use geometry::tessellate::Surface;
use load::Source;
use pnaen::app::App;

use crate::editing::{assert_draws, copied};
use crate::{PATIENCE, press, settle, uniform, uniform_of};

/// Presses a key and runs frames until a preview is shown.
fn move_until_previewed(harness: &mut Harness<App>, key: Key) {
    let (start, before) = (std::time::Instant::now(), harness.state().previews());
    while harness.state().previews() == before || !harness.state().shows_preview() {
        assert!(start.elapsed() < PATIENCE, "no preview is shown");
        harness.key_press(key);
        harness.step();
    }
}

#[test]
fn a_preview_is_shown_while_the_camera_moves_and_the_full_picture_follows() {
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    // A million triangles are late on any driver for software.
    harness.get_by_role_and_label(Role::Slider, "Factor").set_value_accesskit(64.0);
    settle(&mut harness);
    let (totals, pictures) = (harness.state().totals(), harness.state().pictures());
    assert!(!harness.state().shows_preview());
    move_until_previewed(&mut harness, Key::ArrowRight);
    harness.get_by_label_contains("Preview: factor ");
    assert_eq!(harness.state().totals(), totals, "nothing is counted in a preview");
    assert_eq!(harness.state().pictures(), pictures, "the full picture waits until the camera rests");
    settle(&mut harness);
    assert!(!harness.state().shows_preview() && harness.state().pictures() > pictures);
    assert!(harness.query_by_label_contains("Preview: ").is_none());
    assert_eq!(harness.state().totals(), totals);
    let command = copied(&mut harness);
    assert_draws(&harness, &command, "torus-view");
    press(&mut harness, Key::Escape);
    // Somebody who judges LOD in motion switches previews off.
    harness.get_by_role_and_label(Role::Button, "View").click();
    settle(&mut harness);
    harness.get_by_label_contains("Preview while the camera moves").click();
    settle(&mut harness);
    let previews = harness.state().previews();
    press(&mut harness, Key::ArrowRight);
    assert_eq!(harness.state().previews(), previews);
}

#[test]
fn a_part_keeps_its_own_surface_in_previews() {
    // More triangles than previews on a driver for software draw as they are.
    const SIDE: usize = 60;
    let points = (0..=SIDE).flat_map(|y| (0..=SIDE).map(move |x| format!("v {x} {y} 0\n")));
    let faces = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| 1 + y * (SIDE + 1) + x));
    let faces = faces.map(|first| format!("f {first} {} {} {}\n", first + 1, first + SIDE + 2, first + SIDE + 1));
    let sheet: String = points.chain(faces).collect();
    let (_folder, mut harness) = uniform_of("sheet.obj", format!("o sheet\n{sheet}"));
    harness.get_by_role_and_label(Role::Slider, "Factor").set_value_accesskit(16.0);
    let (context, style) = (harness.ctx.clone(), PartStyle { surface: Some(Surface::Flat), ..PartStyle::default() });
    harness.state_mut().prepare(&context, |own| own.parts.set_style("sheet", style));
    settle(&mut harness);
    // A simplified mesh would be made in the meantime.
    for _ in 0..2 {
        move_until_previewed(&mut harness, Key::ArrowRight);
        assert!(harness.query_by_label_contains("Preview: a simplified mesh").is_none());
        settle(&mut harness);
        std::thread::sleep(std::time::Duration::from_millis(500));
    }
}

//! The file's parts: filtered, hidden, shown alone and framed, from the list and from the picture.

use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use load::ShownParts;
use pnaen::app::App;

use crate::{click, scroll_to, settle, uniform_of};

/// A file of eleven parts, each a square of its own.
fn eleven_parts() -> String {
    let mut text = String::new();
    for part in 0..11 {
        let x = 2 * part;
        text += &format!("o Part{part}\nv {x} 0 0\nv {} 0 0\nv {} 1 0\nv {x} 1 0\nf -4 -3 -2 -1\n", x + 1, x + 1);
    }
    text
}

#[test]
fn parts_are_filtered_shown_alone_and_framed() {
    let (_folder, mut harness) = uniform_of("parts.obj", eleven_parts());
    let triangles = |harness: &Harness<App>| harness.state().loaded().map(|loaded| loaded.mesh.triangles.len());
    let before = harness.state().camera().distance;
    scroll_to(&mut harness, "Filter parts by name");
    harness.get_by_label("11 of 11 shown");
    click(&mut harness, "Filter parts by name");
    harness.get_by_label("Filter parts by name").type_text("PART7");
    settle(&mut harness);
    assert!(harness.query_by_label("Part6").is_none(), "it isn't listed");
    click(&mut harness, "Show only Part7");
    assert_eq!(triangles(&harness), Some(2));
    assert_eq!(harness.state().camera().distance, before, "the camera stays");
    harness.get_by_label("1 of 11 shown");
    let only_part_7 = ShownParts { only: vec!["Part7".to_owned()], ..ShownParts::default() };
    assert_eq!(harness.state().loaded().expect("a mesh").preparation.parts, only_part_7);
    harness.get_by_label("Part7").click_secondary();
    settle(&mut harness);
    click(&mut harness, "Frame this part");
    assert!(harness.state().camera().distance < 0.5 * before, "it fills the view");
    click(&mut harness, "Show only Part7");
    assert_eq!(triangles(&harness), Some(22), "a second click shows all");
    harness.state_mut().select_triangle(Some(6));
    settle(&mut harness);
    harness.get_by_role_and_label(Role::Label, "Part3");
}

#[test]
fn a_right_click_in_the_picture_leads_to_its_part() {
    let (_folder, mut harness) = uniform_of("parts.obj", eleven_parts());
    harness.get_by_label("Viewport").click_secondary();
    settle(&mut harness);
    click(&mut harness, "Hide this part");
    let parts = harness.state().loaded().expect("a mesh").contents.parts.clone();
    let hidden: Vec<_> = parts.iter().filter(|part| part.is_hidden).map(|part| part.name.as_str()).collect();
    assert_eq!(hidden, ["Part5"]);
}

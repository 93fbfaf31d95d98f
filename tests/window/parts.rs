//! The file's parts: filtered, hidden, shown alone and framed, from the list and from the picture.

use egui::OutputCommand;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use geometry::mesh::PartStyle;
use geometry::tessellate::Surface;
use load::{NormalSource, ShownParts, Source};
use pnaen::app::App;

use crate::editing::{copied, press_with};
use crate::{choose, click, press, scroll_to, settle, switch, uniform_of};

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
fn a_part_gets_a_surface_and_a_detail_of_its_own() {
    let (_folder, mut harness) = uniform_of("parts.obj", eleven_parts());
    assert!(harness.query_by_label("Phong strength").is_none());
    scroll_to(&mut harness, "Filter parts by name");
    click(&mut harness, "Filter parts by name");
    harness.get_by_label("Filter parts by name").type_text("Part7");
    settle(&mut harness);
    for (menu, entry) in [("Its surface", "Phong AEN"), ("Its detail", "1/2")] {
        harness.get_by_label("Part7").click_secondary();
        settle(&mut harness);
        click(&mut harness, menu);
        click(&mut harness, entry);
    }
    let style = PartStyle { surface: Some(Surface::PhongAen), detail: Some(0.5), ..PartStyle::default() };
    let styles = |harness: &Harness<App>| harness.state().loaded().expect("a mesh").preparation.parts.styles.clone();
    assert!(matches!(&styles(&harness)[..], [(name, own)] if name.ends_with("Part7") && *own == style));
    assert_eq!(harness.state().loaded().expect("a mesh").mesh.part_styles[7], style);
    harness.get_by_label("surface=phong-aen,detail=0.5");
    harness.get_by_role_and_label(Role::Slider, "Phong strength").set_value_accesskit(0.5);
    settle(&mut harness);
    assert_eq!(harness.state().settings().tessellation.alpha, 0.5);
    let command = copied(&mut harness);
    assert!(command.contains("--alpha 0.5"), "{command}");
    press(&mut harness, egui::Key::Escape);
    click(&mut harness, "Show only Part7");
    assert_eq!(styles(&harness).len(), 1, "what is shown doesn't change it");
}

#[test]
fn a_part_gets_normals_and_a_crease_angle_of_its_own_while_the_view_stays() {
    let bent = "v 0 0 0\nv 2 0 0\nv 2 0 3\nv 0 0 3\nv 0 1 0\nv 2 1 0\no floor\nf 1 4 3 2\no wall\nf 1 2 6 5\n";
    let (_folder, mut harness) = uniform_of("bent.obj", bent);
    harness.get_by_label("Missing normals: smoothed below 60\u{b0}");
    press(&mut harness, egui::Key::ArrowLeft);
    let before = *harness.state().camera();
    for (menu, entry) in [("Its normals", "Made anew"), ("Its crease angle", "180\u{b0}")] {
        harness.get_by_role_and_label(Role::CheckBox, "wall").scroll_to_me();
        settle(&mut harness);
        harness.get_by_role_and_label(Role::CheckBox, "wall").click_secondary();
        settle(&mut harness);
        click(&mut harness, menu);
        click(&mut harness, entry);
    }
    assert_eq!(*harness.state().camera(), before);
    assert!(harness.query_by_label_contains("Missing normals").is_none(), "somebody asked for them");
    let loaded = harness.state().loaded().expect("a mesh");
    let style = PartStyle { normals: Some(NormalSource::Made), crease_angle: Some(180.0), ..PartStyle::default() };
    assert_eq!(loaded.preparation.parts.style("wall"), style);
    let bent = loaded.mesh.corners.iter().filter(|corner| corner.normal.y > 0.1 && corner.normal.z > 0.1).count();
    assert_eq!((loaded.mesh.corners.len(), bent), (8, 2), "the floor stays flat");
    harness.get_by_label("normals=made,crease=180");
    scroll_to(&mut harness, "Styles of parts");
    let command = copied(&mut harness);
    assert!(command.contains("--part wall:normals=made,crease=180"), "{command}");
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

/// Groups of parts, each a square of its own.
fn grouped(groups: &[(&str, &[&str])]) -> String {
    let (mut text, mut x) = (String::new(), 0);
    for (group, parts) in groups {
        for part in *parts {
            text += &format!(
                "o {group}\ng {part}\nv {x} 0 0\nv {} 0 0\nv {} 1 0\nv {x} 1 0\nf -4 -3 -2 -1\n",
                x + 1,
                x + 1
            );
            x += 2;
        }
    }
    text
}

fn triangles(harness: &Harness<App>) -> usize {
    harness.state().loaded().expect("a mesh").mesh.triangles.len()
}

#[test]
fn a_group_is_hidden_shown_alone_folded_and_framed_as_one() {
    let (_folder, mut harness) = uniform_of("groups.obj", grouped(&[("Body", &["Arm", "Leg"]), ("Hat", &["Brim"])]));
    let hidden = |harness: &Harness<App>| harness.state().loaded().expect("a mesh").preparation.parts.hidden.clone();
    switch(&mut harness, "Body");
    assert_eq!((triangles(&harness), hidden(&harness)), (2, vec!["Body".to_owned()]));
    switch(&mut harness, "Arm");
    assert_eq!((triangles(&harness), hidden(&harness)), (4, vec!["Body/Leg".to_owned()]), "the rest stays hidden");
    switch(&mut harness, "Body");
    switch(&mut harness, "Body");
    assert_eq!((triangles(&harness), hidden(&harness).len()), (6, 0));
    click(&mut harness, "Show only Body");
    assert_eq!(triangles(&harness), 4);
    click(&mut harness, "Show only Body");
    assert_eq!(triangles(&harness), 6, "a second click shows all");
    let before = harness.state().camera().distance;
    harness.get_by_role_and_label(Role::CheckBox, "Hat").click_secondary();
    settle(&mut harness);
    click(&mut harness, "Frame this group");
    assert!(harness.state().camera().distance < 0.8 * before, "it fills the view");
    click(&mut harness, "Unfold Body");
    assert!(harness.query_by_role_and_label(Role::CheckBox, "Arm").is_none(), "it isn't listed");
    harness.get_by_role_and_label(Role::CheckBox, "Brim");
    click(&mut harness, "Unfold Body");
    harness.get_by_role_and_label(Role::CheckBox, "Arm").click_secondary();
    settle(&mut harness);
    harness.get_by_label("Copy its name").click();
    harness.step();
    let commands = &harness.output().platform_output.commands;
    assert!(commands.iter().any(|command| matches!(command, OutputCommand::CopyText(text) if text == "Body/Arm")));
}

#[test]
fn of_thousands_of_parts_only_those_in_sight_are_laid_out() {
    let names: Vec<(String, Vec<String>)> = (0..200)
        .map(|group| (format!("Group{group}"), (0..10).map(|part| format!("Part{group}x{part}")).collect()))
        .collect();
    let parts: Vec<Vec<&str>> = names.iter().map(|(_, parts)| parts.iter().map(String::as_str).collect()).collect();
    let groups: Vec<(&str, &[&str])> =
        names.iter().zip(&parts).map(|((group, _), parts)| (&**group, &parts[..])).collect();
    let (_folder, mut harness) = uniform_of("many.obj", grouped(&groups));
    scroll_to(&mut harness, "Filter parts by name");
    assert!(harness.query_all_by_label_contains("Show only ").count() <= 8, "the list shows six rows at once");
    click(&mut harness, "Filter parts by name");
    harness.get_by_label("Filter parts by name").type_text("group77/");
    settle(&mut harness);
    harness.get_by_label("Show only Group77/Part77x0");
    assert!(harness.query_by_label("Show only Group78").is_none(), "it isn't listed");
    click(&mut harness, "Show only Group77/Part77x0");
    assert_eq!(triangles(&harness), 2);
}

#[test]
fn materials_are_listed_after_the_parts_and_found_by_their_prefix() {
    let red_and_blue =
        eleven_parts().replace("o Part4\n", "o Part4\nusemtl red\n").replace("o Part9\n", "o Part9\nusemtl blue\n");
    let (_folder, mut harness) = uniform_of("materials.obj", red_and_blue);
    scroll_to(&mut harness, "Filter parts by name");
    harness.get_by_label("14 of 14 shown");
    click(&mut harness, "Filter parts by name");
    harness.get_by_label("Filter parts by name").type_text("material:");
    settle(&mut harness);
    assert!(harness.query_by_label("Part4").is_none(), "it isn't listed");
    switch(&mut harness, "material:red");
    assert_eq!(triangles(&harness), 12, "those before Part4 and from Part9 on");
    assert_eq!(harness.state().loaded().expect("a mesh").preparation.parts.hidden, ["material:red"]);
    click(&mut harness, "Show only material:blue");
    assert_eq!(triangles(&harness), 4);
}

#[test]
fn parts_are_listed_while_the_left_half_is_edited_unless_it_has_another_file() {
    let (folder, mut harness) = uniform_of("parts.obj", eleven_parts());
    let other = folder.path().join("other.obj");
    std::fs::write(&other, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("a writable folder");
    press_with(&mut harness, egui::Modifiers::SHIFT, egui::Key::J);
    click(&mut harness, "Edit left (A)");
    let is_listed = |harness: &Harness<App>| harness.query_by_label("Parts").is_some();
    assert!(is_listed(&harness), "both halves have the same mesh");
    let context = harness.ctx.clone();
    harness.state_mut().prepare(&context, |own| own.crease_band = 0.1);
    settle(&mut harness);
    harness.get_by_label_contains("Left: as kept");
    assert!(is_listed(&harness), "the same file, prepared otherwise");
    harness.state_mut().open_reference_shape(&context, Source::File(other));
    settle(&mut harness);
    scroll_to(&mut harness, "Edit right (B)");
    click(&mut harness, "Edit right (B)");
    choose(&mut harness, "Left mesh", "Reference surface: other.obj");
    assert!(is_listed(&harness));
    scroll_to(&mut harness, "Edit left (A)");
    click(&mut harness, "Edit left (A)");
    assert!(!is_listed(&harness), "they are those of the right half's file");
}

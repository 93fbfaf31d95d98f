//! The choice of material variants.

use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use geometry::mesh::Shape;
use load::Source;
use pnaen::app::App;

use crate::{choose, press, uniform_of, window};
use documents::lamp::LAMP;

fn material(harness: &Harness<App>) -> String {
    harness.state().loaded().expect("a mesh").mesh.materials[0].name.clone()
}

#[test]
fn a_variant_is_chosen_and_the_view_stays() {
    let (_folder, mut harness) = uniform_of("lamp.gltf", LAMP);
    assert_eq!(material(&harness), "red");
    press(&mut harness, egui::Key::Num3);
    let camera = *harness.state().camera();
    choose(&mut harness, "Variant", "Night");
    assert_eq!((material(&harness).as_str(), *harness.state().camera()), ("blue", camera));
    // The variant stays when the file is loaded again.
    press(&mut harness, egui::Key::R);
    assert_eq!(material(&harness), "blue");
    choose(&mut harness, "Variant", "File's own");
    assert_eq!(material(&harness), "red");
}

#[test]
fn a_mesh_without_variants_has_no_choice() {
    let harness = window(Some(Source::Shape(Shape::Torus)));
    assert_eq!(harness.query_all_by_role_and_label(Role::ComboBox, "Variant").count(), 0);
}

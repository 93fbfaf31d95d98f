//! Choosing surfaces, normals and displacement.

use egui::Key;
use egui::accesskit::Role;
use egui_kittest::kittest::{NodeT, Queryable};
use geometry::mesh::Shape;
use geometry::tessellate::{Displacement, Normals, Surface};
use load::{HeightSource, Source};

use crate::editing::copied;
use crate::{choose, press, settle, uniform};

#[test]
fn every_surface_can_be_chosen_and_only_those_that_tear_have_cracks() {
    let mut harness = uniform(Some(Source::Shape(Shape::CubeSplit)));
    let names = ["Flat", "PN", "PN crease", "Phong", "Phong AEN", "Nagata", "Nagata AEN", "PN-AEN"];
    for name in names {
        choose(&mut harness, "Surface", name);
        let app = harness.state();
        let surface = app.settings().tessellation.surface;
        assert_eq!(app.cracks().map(|cracks| cracks.edges.len()), Some(if surface.tears() { 12 } else { 0 }), "{name}");
    }
    assert_eq!(harness.state().settings().tessellation.surface, Surface::PnAen);
}

#[test]
fn phong_strength_has_a_row_under_phong_alone() {
    let mut harness = uniform(Some(Source::Shape(Shape::CubeSplit)));
    assert!(harness.query_by_role_and_label(Role::Slider, "Phong strength").is_none());
    choose(&mut harness, "Surface", "Phong AEN");
    let pictures = harness.state().pictures();
    harness.get_by_role_and_label(Role::Slider, "Phong strength").set_value_accesskit(0.25);
    settle(&mut harness);
    assert_eq!(harness.state().settings().tessellation.alpha, 0.25);
    assert!(harness.state().pictures() > pictures, "the surface is drawn anew");
}

#[test]
fn normals_of_the_surface_differ_across_edges_and_are_counted() {
    let mut harness = uniform(Some(Source::Shape(Shape::CubeSmooth)));
    for (name, normals) in [("Quadratic normals", Normals::Quadratic), ("Surface normals", Normals::Surface)] {
        choose(&mut harness, "Shading", name);
        let app = harness.state();
        assert_eq!(app.settings().tessellation.normals, normals);
        let differing = app.cracks().expect("measured").different_normals;
        assert_eq!(differing > 0, normals == Normals::Surface, "{name}");
    }
}

#[test]
fn an_image_displaces_the_mesh_and_other_settings_stay() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = folder.path().join("heights.png");
    let image = image::GrayImage::from_fn(16, 16, |x, y| image::Luma([(x * 13 + y * 7) as u8]));
    image.save(&path).expect("a writable temporary folder");
    let mut harness = uniform(Some(Source::Shape(Shape::CubeSplit)));
    assert_eq!(
        harness.query_all_by_role_and_label(Role::ComboBox, "Displace").count(),
        0,
        "without heights there is no such row"
    );
    let (camera, factor) = (*harness.state().camera(), harness.state().settings().tessellation.factor);
    let context = harness.ctx.clone();
    harness.state_mut().open_path(&context, path.clone());
    settle(&mut harness);
    let app = harness.state();
    assert_eq!(app.settings().tessellation.displacement, Displacement::On);
    assert_eq!((*app.camera(), app.settings().tessellation.factor), (camera, factor));
    let loaded = app.loaded().expect("a mesh");
    assert_eq!(loaded.preparation.heights, Some(HeightSource::File(path.clone())));
    assert_eq!(app.cracks().map(|cracks| cracks.different_bits), Some(0));
    choose(&mut harness, "Displace", "Paper (seams closed)");
    assert!(
        harness.state().cracks().expect("measured").different_bits > 0,
        "displacement as published cracks at split normals"
    );
    let pictures = harness.state().pictures();
    harness.get_by_role_and_label(Role::Slider, "Scale").set_value_accesskit(0.2);
    settle(&mut harness);
    assert!(harness.state().pictures() > pictures);
    press(&mut harness, Key::D);
    assert_eq!(harness.state().settings().tessellation.displacement, Displacement::Off);
    press(&mut harness, Key::D);
    assert_eq!(
        harness.state().settings().tessellation.displacement,
        Displacement::AsPublished,
        "the displacement before it was switched off"
    );
    choose(&mut harness, "Height map", "None");
    assert_eq!(harness.query_all_by_role_and_label(Role::ComboBox, "Displace").count(), 0);
}

#[test]
fn a_file_is_displaced_by_the_height_images_of_its_materials() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = |name: &str| folder.path().join(name);
    let white = image::GrayImage::from_pixel(2, 2, image::Luma([255]));
    white.save(path("white.png")).expect("a writable temporary folder");
    let mesh = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl wall\nf 1/1 2/2 3/3\n";
    for (name, text) in [("a.mtl", "newmtl wall\ndisp -mm 0 0.25 white.png\n"), ("a.obj", mesh)] {
        std::fs::write(path(name), text).expect("a writable temporary folder");
    }
    let mut harness = uniform(Some(Source::File(path("a.obj"))));
    assert_eq!(harness.state().settings().tessellation.displacement, Displacement::On);
    assert_eq!(harness.state().loaded().expect("a mesh").preparation.heights, None, "nothing was chosen");
    assert!(harness.query_by_role_and_label(Role::Slider, "Midlevel").is_none(), "the file says how far");
    assert!(copied(&mut harness).contains("--height file"));
    press(&mut harness, Key::D);
    press(&mut harness, Key::R);
    let app = harness.state();
    assert_eq!(app.settings().tessellation.displacement, Displacement::Off, "loading it again changes nothing");
}

#[test]
fn missing_heights_are_reported_and_change_nothing() {
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    let pictures = harness.state().pictures();
    choose(&mut harness, "Height map", "Base colour brightness");
    harness.get_by_label_contains("no material has a base colour image");
    assert_eq!(harness.state().source(), Some(&Source::Shape(Shape::Torus)));
    assert_eq!(harness.state().settings().tessellation.displacement, Displacement::Off, "settings stay");
    assert_eq!(harness.state().pictures(), pictures, "nothing is drawn anew");
}

#[test]
fn a_height_image_can_be_chosen_from_the_file_menu() {
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    harness.get_by_label("File").click();
    settle(&mut harness);
    let entry = harness.get_by_label("Height image…");
    assert_eq!((entry.accesskit_node().role(), entry.accesskit_node().is_disabled()), (Role::Button, false));
    let (open, own, reload) = ("Open path… Ctrl+L", entry.rect(), harness.get_by_label("Reload R").rect());
    let above = harness.get_by_label(open).rect();
    assert!(above.bottom() <= own.top() && own.bottom() <= reload.top(), "{above} {own} {reload}");
    entry.hover();
    // Hover texts appear after a delay.
    harness.run_steps(60);
    harness.get_by_label_contains("PNG, JPEG, WebP, TGA, KTX2, TIFF or EXR image");
}

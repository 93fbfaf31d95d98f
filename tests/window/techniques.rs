//! Choosing surfaces, normals and displacement.

use std::path::Path;

use egui::Key;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use geometry::mesh::{HeightAmount, Shape};
use geometry::tessellate::{Displacement, Normals, Surface};
use load::{HeightSource, NamedImage, Source};
use pnaen::app::App;

use crate::editing::copied;
use crate::{choose, click, press, scroll_to, settle, uniform, uniform_of};

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
fn a_part_gets_a_height_image_and_an_amount_of_its_own() {
    let mesh = "v 0 0 0\nv 2 0 0\nv 2 0 3\nv 0 0 3\nv 0 1 0\nv 2 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
                o floor\nf 1/1 4/4 3/3 2/2\no wall\nf 1/1 2/2 6/3 5/4\n";
    let (folder, mut harness) = uniform_of("room.obj", mesh);
    let path = |name: &str, level: u8| {
        let path = folder.path().join(name);
        image::GrayImage::from_pixel(2, 2, image::Luma([level])).save(&path).expect("a writable temporary folder");
        path
    };
    let (white, grey) = (path("white.png", 255), path("grey.png", 128));
    let open = |harness: &mut Harness<App>, path: &Path| {
        while harness.state().path_asked_for().is_none() {
            harness.step();
        }
        assert!(matches!(harness.state().path_asked_for(), Some(("Height image path", Some(_)))));
        harness.run_steps(2);
        let field = harness.get_by_label("A .png, .jpg, .webp, .tga, .ktx2, .tif or .exr image");
        field.type_text(&path.display().to_string());
        settle(harness);
        click(harness, "Open");
    };
    let images = |harness: &Harness<App>| match &harness.state().loaded().expect("a mesh").preparation.heights {
        Some(HeightSource::Each(images)) => images.clone(),
        _ => Vec::new(),
    };
    scroll_to(&mut harness, "wall");
    harness.get_by_role_and_label(Role::CheckBox, "wall").click_secondary();
    settle(&mut harness);
    click(&mut harness, "Its height image…");
    open(&mut harness, &white);
    let image = NamedImage { part: "wall".to_owned(), path: white, amount: None };
    assert_eq!(images(&harness), std::slice::from_ref(&image));
    harness.get_by_role_and_label(Role::Slider, "Midlevel");
    for (label, number) in [("Height scale of wall", 0.5), ("Midlevel of wall", 0.25)] {
        scroll_to(&mut harness, label);
        harness.get_by_role_and_label(Role::SpinButton, label).set_value_accesskit(number);
        settle(&mut harness);
    }
    let amount = HeightAmount::new(0.5, 0.25);
    assert_eq!(images(&harness), [NamedImage { amount, ..image.clone() }]);
    assert!(harness.query_by_role_and_label(Role::Slider, "Midlevel").is_none(), "the image has its own");
    let command = copied(&mut harness);
    assert!(command.contains("white.png,scale=0.5,midlevel=0.25"), "{command}");
    press(&mut harness, Key::Escape);
    click(&mut harness, "Another image of wall");
    open(&mut harness, &grey);
    assert_eq!(images(&harness), [NamedImage { amount, path: grey, ..image }]);
    click(&mut harness, "No image of wall");
    assert_eq!(harness.state().loaded().expect("a mesh").preparation.heights, None);
    let context = harness.ctx.clone();
    harness.state_mut().undo(&context);
    settle(&mut harness);
    assert_eq!(images(&harness).len(), 1);
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

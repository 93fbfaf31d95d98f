//! Whose normals the mesh has, which of its axes points up, and what its unit is.

use clap::Parser;
use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use geometry::mesh::{Shape, UpAxis};
use inspect::render::Camera;
use load::{FileUnit, Import, LengthUnit, NormalSource, Source};
use pnaen::app::{App, Persistence};
use pnaen::cli::Cli;
use tempfile::TempDir;

use crate::editing::{assert_draws, copied, press_with};
use crate::{choose, click, open, press, resumed, settle, uniform, vase, window};

/// Two squares that meet in an edge at a right angle, 1 high, 2 wide and 3 deep, without normals.
const BENT: &str = "v 0 0 0\nv 2 0 0\nv 2 0 3\nv 0 0 3\nv 0 1 0\nv 2 1 0\nf 1 4 3 2\nf 1 2 6 5\n";

fn bent(folder: &TempDir) -> Source {
    let path = folder.path().join("bent.obj");
    std::fs::write(&path, BENT).expect("a writable temporary folder");
    Source::File(path)
}

fn import(harness: &Harness<App>) -> Import {
    harness.state().loaded().expect("a mesh").preparation.import
}

fn corners(harness: &Harness<App>) -> usize {
    harness.state().loaded().expect("a mesh").mesh.corners.len()
}

fn size(harness: &Harness<App>) -> [f32; 3] {
    let bounds = harness.state().loaded().expect("a mesh").mesh.bounds();
    (bounds.max - bounds.min).to_array()
}

#[test]
fn missing_normals_are_told_and_a_click_makes_them_flat() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let mut harness = uniform(Some(bent(&folder)));
    harness.get_by_label("Missing normals: smoothed below 60\u{b0}").click();
    settle(&mut harness);
    assert_eq!((import(&harness).normals, import(&harness).crease_angle), (NormalSource::File, 0.0));
    click(&mut harness, "Missing normals: flat");
    assert_eq!(import(&harness).crease_angle, 60.0, "there is a way back");
    press_with(&mut harness, Modifiers::COMMAND, Key::Z);
    harness.get_by_label("Missing normals: flat");
    press_with(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(import(&harness).crease_angle, 60.0);
    harness.get_by_label("No other warnings");
    harness.get_by_label("Missing normals: smoothed below 60\u{b0}");
    choose(&mut harness, "Normals", "Made anew");
    assert!(harness.query_by_label_contains("Missing normals").is_none(), "none is missed where all are made");
}

#[test]
fn normals_are_made_anew_with_a_crease_angle_and_undone_while_the_camera_stays() {
    let mut harness = uniform(Some(vase()));
    press(&mut harness, Key::Num3);
    let (camera, before): (Camera, usize) = (*harness.state().camera(), corners(&harness));
    assert!(harness.query_by_role_and_label(Role::Slider, "Crease angle").is_none(), "all normals are the file's");
    choose(&mut harness, "Normals", "Made anew");
    assert_eq!(import(&harness).normals, NormalSource::Made);
    let made = corners(&harness);
    harness.get_by_role_and_label(Role::Slider, "Crease angle").set_value_accesskit(0.0);
    settle(&mut harness);
    assert_eq!(import(&harness).crease_angle, 0.0);
    assert!(corners(&harness) > made, "flat triangles share no corners");
    assert_eq!(*harness.state().camera(), camera);
    let line = copied(&mut harness);
    assert!(line.contains("--mesh-normals made --crease-angle 0"), "{line}");
    press(&mut harness, Key::Escape);
    assert_draws(&harness, &line, "vase-view");
    press_with(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!((import(&harness).crease_angle, corners(&harness)), (60.0, made), "the mesh follows undo");
    press_with(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!((import(&harness), corners(&harness)), (Import::default(), before));
    press_with(&mut harness, Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z);
    assert_eq!(import(&harness).normals, NormalSource::Made);
}

#[test]
fn the_command_line_says_how_the_first_mesh_is_taken() {
    let (folder, state) = (TempDir::new().expect("a folder"), TempDir::new().expect("a folder"));
    let path = folder.path().join("parts.obj");
    std::fs::write(&path, BENT.replace("f 1 4", "o lid\nf 1 4").replace("f 1 2", "o side\nf 1 2"))
        .expect("a writable folder");
    let options =
        ["--up", "z", "--unit", "cm", "--mesh-normals", "made", "--crease-angle", "20", "--hide-part", "side"];
    let arguments = ["pnaen".as_ref(), path.as_os_str()].into_iter().chain(options.map(AsRef::as_ref));
    let opening = Cli::try_parse_from(arguments).expect("options of the window").opening;
    let (source, kept) = (Source::File(path), state.path().to_owned());
    let first = source.clone();
    let mut harness = open(Harness::builder().with_size([1200.0, 960.0]), Some(first), |app, context| {
        app.resume(context, Persistence::read(Some(&kept)));
        app.open_as(context, |preparation| opening.change(preparation));
    });
    settle(&mut harness);
    let made = Import {
        normals: NormalSource::Made,
        crease_angle: 20.0,
        up: Some(UpAxis::Z),
        unit: Some(FileUnit::Named(LengthUnit::Centimetre)),
        show_hidden: false,
        ..Import::default()
    };
    assert_eq!((import(&harness), harness.state().settings().import), (made, made));
    assert_eq!(harness.state().loaded().expect("a mesh").preparation.parts.hidden, ["side"]);
    // Without the side, the square of 2 times 3 stands upright.
    assert_eq!(size(&harness), [0.02, 0.03, 0.0]);
    eframe::App::on_exit(harness.state_mut());
    drop(harness);
    let again = resumed(state.path(), [1200.0, 960.0], Some(source));
    let loaded = again.state().loaded().expect("a mesh");
    assert_eq!((loaded.preparation.import, loaded.mesh.triangles.len()), (made, 4), "parts are shown again");
}

#[test]
fn an_axis_and_a_unit_turn_and_scale_the_mesh_and_belong_to_its_file() {
    let (folder, state) = (TempDir::new().expect("a folder"), TempDir::new().expect("a folder"));
    let source = bent(&folder);
    let mut harness = resumed(state.path(), [1200.0, 960.0], Some(source.clone()));
    assert_eq!(size(&harness), [2.0, 1.0, 3.0]);
    harness.get_by_role_and_label(Role::Slider, "Crease angle");
    super::open_all_sections(&mut harness);
    settle(&mut harness);
    let distance = harness.state().camera().distance;
    choose(&mut harness, "Up axis", "Z");
    assert_eq!(size(&harness), [2.0, 3.0, 1.0]);
    let turned = *harness.state().camera();
    assert!((turned.target - harness.state().loaded().expect("a mesh").mesh.bounds().center()).length() < 1e-6);
    press(&mut harness, Key::F);
    assert_eq!(*harness.state().camera(), turned, "the turned mesh is framed already");
    choose(&mut harness, "Unit", "Centimetre");
    let [x, y, z] = size(&harness);
    assert!((x - 0.02).abs() < 1e-6 && (y - 0.03).abs() < 1e-6 && (z - 0.01).abs() < 1e-6);
    assert!(harness.state().camera().distance < 0.1 * distance, "the camera shows all of it again");
    let line = copied(&mut harness);
    assert!(line.contains("--up z --unit cm"), "{line}");
    press(&mut harness, Key::Escape);
    // A unit without a name has a row for its length, which begins as a metre.
    choose(&mut harness, "Unit", "Another length");
    assert_eq!(size(&harness), [2.0, 3.0, 1.0]);
    // A long number moves nothing.
    let viewport = harness.get_by_label("Viewport").rect();
    harness.get_by_role_and_label(Role::Slider, "Unit length").set_value_accesskit(1e9);
    settle(&mut harness);
    assert_eq!(size(&harness), [2e9, 3e9, 1e9]);
    assert_eq!(harness.get_by_label("Viewport").rect(), viewport);
    let edge = harness.get_by_role_and_label(Role::ComboBox, "Unit").rect().right();
    let rows = harness.query_all_by_role(Role::SpinButton).map(|number| number.rect());
    let numbers: Vec<_> = rows.map(|row| row.right()).filter(|right| *right < viewport.center().x).collect();
    assert!(numbers.len() > 4 && numbers.iter().all(|right| *right <= edge + 0.5), "{numbers:?} beyond {edge}");
    harness.get_by_role_and_label(Role::Slider, "Unit length").set_value_accesskit(0.25);
    settle(&mut harness);
    assert_eq!(size(&harness), [0.5, 0.75, 0.25]);
    let line = copied(&mut harness);
    assert!(line.contains("--up z --unit 0.25"), "{line}");
    press(&mut harness, Key::Escape);
    // Another file has an axis and a unit of its own; this isn't a step that can be undone.
    let context = harness.ctx.clone();
    harness.state_mut().open(&context, vase());
    settle(&mut harness);
    assert_eq!(import(&harness), Import::default());
    harness.state_mut().open(&context, source.clone());
    settle(&mut harness);
    let chosen = Import { up: Some(UpAxis::Z), unit: Some(FileUnit::Metres(0.25)), ..Import::default() };
    assert_eq!((import(&harness), harness.state().settings().import), (chosen, chosen));
    eframe::App::on_exit(harness.state_mut());
    drop(harness);
    let harness = resumed(state.path(), [1200.0, 960.0], Some(source));
    assert_eq!(import(&harness), chosen, "the next window knows the file");
}

#[test]
fn parts_are_hidden_and_shown_again_while_the_camera_stays() {
    let folder = TempDir::new().expect("a folder");
    let path = folder.path().join("parts.obj");
    let text = BENT.replace("f 1 4", "o floor\nf 1 4").replace("f 1 2", "o wall\nf 1 2");
    std::fs::write(&path, text).expect("a writable temporary folder");
    let mut harness = uniform(Some(Source::File(path)));
    let camera = *harness.state().camera();
    let triangles = |harness: &Harness<App>| harness.state().loaded().expect("a mesh").mesh.triangles.len();
    assert_eq!(triangles(&harness), 4);
    super::switch(&mut harness, "wall");
    assert_eq!((triangles(&harness), *harness.state().camera()), (2, camera));
    let line = copied(&mut harness);
    assert!(line.contains("--hide-part wall"), "{line}");
    press(&mut harness, Key::Escape);
    super::switch(&mut harness, "floor");
    harness.get_by_label_contains("its parts are hidden");
    assert_eq!(triangles(&harness), 2, "what is shown stays");
    harness.get_by_role_and_label(Role::Button, "Show all parts").scroll_to_me();
    settle(&mut harness);
    super::click(&mut harness, "Show all parts");
    assert_eq!(triangles(&harness), 4);
}

#[test]
fn hiding_a_part_is_a_step_of_undo_beside_those_of_settings() {
    let folder = TempDir::new().expect("a folder");
    let path = folder.path().join("parts.obj");
    let text = BENT.replace("f 1 4", "o floor\nf 1 4").replace("f 1 2", "o wall\nf 1 2");
    std::fs::write(&path, text).expect("a writable temporary folder");
    let mut harness = uniform(Some(Source::File(path.clone())));
    let state = |harness: &Harness<App>| {
        let loaded = harness.state().loaded().expect("a mesh");
        (loaded.mesh.triangles.len(), harness.state().settings().overlays.wireframe)
    };
    super::switch(&mut harness, "wall");
    press(&mut harness, Key::W);
    assert_eq!(state(&harness), (2, true));
    let undo = |harness: &mut Harness<App>| press_with(harness, Modifiers::COMMAND, Key::Z);
    let redo = |harness: &mut Harness<App>| press_with(harness, Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    undo(&mut harness);
    assert_eq!(state(&harness), (2, false));
    undo(&mut harness);
    assert_eq!(state(&harness), (4, false), "the part is there again");
    redo(&mut harness);
    assert_eq!(state(&harness), (2, false));
    redo(&mut harness);
    assert_eq!(state(&harness), (2, true));
    // Another mesh has all its parts, and no step hides any.
    let context = harness.ctx.clone();
    harness.state_mut().open(&context, Source::Shape(Shape::Torus));
    settle(&mut harness);
    undo(&mut harness);
    harness.state_mut().open(&context, Source::File(path));
    settle(&mut harness);
    assert_eq!(state(&harness), (4, false));
    undo(&mut harness);
    assert_eq!(state(&harness).0, 4);
}

#[test]
fn a_file_that_is_gone_leaves_the_mesh_and_its_settings_as_they_are() {
    let folder = TempDir::new().expect("a folder");
    let source = bent(&folder);
    let mut harness = uniform(Some(source.clone()));
    let Source::File(path) = source else { unreachable!("it is a file") };
    std::fs::remove_file(path).expect("a file");
    choose(&mut harness, "Normals", "Made anew");
    assert_eq!((import(&harness), harness.state().settings().import), (Import::default(), Import::default()));
    harness.get_by_label_contains("bent.obj can't be read");
}

#[test]
fn a_shape_has_no_other_axis() {
    let harness = window(Some(Source::Shape(Shape::Torus)));
    for name in ["Up axis", "Unit"] {
        let list = harness.get_by_role_and_label(Role::ComboBox, name);
        assert!(list.accesskit_node().is_disabled());
        assert_eq!(list.value().as_deref(), Some("As the file says"));
    }
}

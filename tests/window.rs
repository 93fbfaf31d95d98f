//! The real window, driven by the names that its controls have for a screen reader.

#[path = "window/picking.rs"]
mod picking;

use std::path::PathBuf;
use std::time::{Duration, Instant};

use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use pnaen::app::App;
use pnaen::mesh::{Shape, Source};
use pnaen::settings::Colors;
use pnaen::tessellate::{Clip, Convention, Edges, Lod, Partitioning, Surface};

/// Longer than anything here takes on two slow cores.
const PATIENCE: Duration = Duration::from_secs(60);

fn window(source: Option<Source>) -> Harness<'static, App> {
    let mut harness = Harness::builder()
        .with_size([1200.0, 800.0])
        .wgpu()
        .build_eframe(move |context| App::new(context, source).expect("these tests need a graphics adapter"));
    settle(&mut harness);
    harness
}

/// A window that draws every patch, in fractional segments by one factor: pictures and counts of these tests are of such.
fn uniform(source: Option<Source>) -> Harness<'static, App> {
    let mut harness = window(source);
    choose(&mut harness, "Partitioning", "Fractional odd");
    choose(&mut harness, "LOD", "Uniform");
    choose(&mut harness, "Clipping", "Off");
    if harness.state().settings().cull_back_faces {
        harness.get_by_role_and_label(Role::CheckBox, "Cull back faces").click();
    }
    settle(&mut harness);
    harness
}

/// Steps until everything is loaded, drawn and measured.
fn settle(harness: &mut Harness<App>) {
    let start = Instant::now();
    // What was just pressed takes effect in the next two steps.
    harness.run_steps(3);
    while harness.state().is_busy() {
        assert!(start.elapsed() < PATIENCE, "the window is still busy");
        std::thread::sleep(Duration::from_millis(2));
        harness.step();
    }
    harness.run_steps(2);
}

fn press(harness: &mut Harness<App>, key: egui::Key) {
    harness.key_press(key);
    settle(harness);
}

fn click(harness: &mut Harness<App>, label: &str) {
    harness.get_by_label(label).click();
    settle(harness);
}

/// Picks an entry of a list.
fn choose(harness: &mut Harness<App>, list: &str, entry: &str) {
    harness.get_by_role_and_label(Role::ComboBox, list).click();
    settle(harness);
    click(harness, entry);
}

fn vase() -> Source {
    Source::File(PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/vase.glb")))
}

#[test]
fn it_opens_on_a_cube_without_cracks() {
    let mut harness = window(None);
    let app = harness.state();
    assert_eq!(app.source(), Some(&Source::Shape(Shape::CubeSplit)));
    assert_eq!((app.settings().surface, app.settings().lod), (Surface::PnAen, Lod::Error));
    assert_eq!(app.cracks().map(|cracks| cracks.edges.len()), Some(0));
    harness.get_by_label("cracks 0");
    harness.get_by_label("6 of 12 patches");
    harness.get_by_role_and_label(Role::CheckBox, "Cull back faces").click();
    settle(&mut harness);
    harness.get_by_label("12 of 12 patches");
}

#[test]
fn choosing_pn_lights_up_the_cracks() {
    let mut harness = uniform(None);
    choose(&mut harness, "Surface", "PN");
    harness.get_by_role_and_label(Role::CheckBox, "Cracks").click();
    settle(&mut harness);
    let app = harness.state();
    assert_eq!(app.settings().surface, Surface::Pn);
    assert!(app.settings().overlays.cracks);
    assert_eq!(app.cracks().map(|cracks| cracks.edges.len()), Some(12));
    harness.get_by_label_contains("cracks 12, ");
}

#[test]
fn the_factor_can_be_slid_typed_and_stepped() {
    let mut harness = uniform(None);
    let before = harness.state().totals();
    harness.get_by_role_and_label(Role::Slider, "Factor").set_value_accesskit(12.0);
    settle(&mut harness);
    let slid = harness.state().settings().factor;
    press(&mut harness, egui::Key::Plus);
    assert_eq!(harness.state().settings().factor, slid + 1.0);
    assert_ne!(harness.state().totals(), before);
    press(&mut harness, egui::Key::Minus);
    assert_eq!(harness.state().settings().factor, slid);
}

#[test]
fn every_switch_does_what_it_says() {
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    for (label, is_on) in [
        ("Patch borders", (|app: &App| app.settings().overlays.patches) as fn(&App) -> bool),
        ("Adjacency edges", |app| app.settings().overlays.adjacency),
        ("Cracks", |app| app.settings().overlays.cracks),
        ("Folds", |app| app.settings().overlays.folds),
        ("Split view", |app| app.settings().split.is_some()),
    ] {
        assert!(!is_on(harness.state()), "{label} is on already");
        let pictures = harness.state().pictures();
        harness.get_by_role_and_label(Role::CheckBox, label).click();
        settle(&mut harness);
        assert!(is_on(harness.state()), "{label}");
        assert!(harness.state().pictures() > pictures, "{label}: a new picture");
    }
    assert!(harness.state().settings().overlays.wireframe);
    press(&mut harness, egui::Key::W);
    assert!(!harness.state().settings().overlays.wireframe);
    choose(&mut harness, "Partitioning", "Power of two");
    assert_eq!(harness.state().settings().partitioning, Partitioning::Pow2);
    choose(&mut harness, "LOD", "Edge length");
    assert_eq!(harness.state().settings().lod, Lod::EdgeLength);
    choose(&mut harness, "LOD", "Distance");
    assert_eq!(harness.state().settings().lod, Lod::Distance);
    harness.get_by_role_and_label(Role::SpinButton, "Near");
    harness.get_by_role_and_label(Role::SpinButton, "far");
    choose(&mut harness, "LOD", "Error");
    assert_eq!(harness.state().settings().lod, Lod::Error);
    harness.get_by_role_and_label(Role::Slider, "Tolerance");
    choose(&mut harness, "LOD", "Edge length");
    choose(&mut harness, "Clipping", "Frustum");
    assert_eq!(harness.state().settings().clip, Clip::Frustum);
    choose(&mut harness, "Edges", "As published");
    let settings = *harness.state().settings();
    assert_eq!((settings.edges, settings.lod, settings.clip), (Edges::AsPublished, Lod::Paper, Clip::Paper));
}

#[test]
fn colours_exclude_each_other_and_numbers_have_a_legend() {
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    let legends = ["Legend: Factor", "Legend: Triangle size, px", "Legend: Factors below 2"];
    let shown = |harness: &Harness<App>| legends.map(|legend| harness.query_by_label(legend).is_some());
    assert_eq!(shown(&harness), [false; 3]);
    for (entry, colors, expected) in [
        ("Factors", Colors::Factors, [true, false, false]),
        ("Triangle size", Colors::TriangleSize, [false, true, false]),
        ("Factors below 2", Colors::LowFactors, [false, false, true]),
        ("Barycentric", Colors::Barycentric, [false; 3]),
        ("Material", Colors::Material, [false; 3]),
    ] {
        let pictures = harness.state().pictures();
        choose(&mut harness, "Colours", entry);
        assert_eq!(harness.state().settings().overlays.colors, colors);
        assert_eq!(shown(&harness), expected, "{entry}");
        assert!(harness.state().pictures() > pictures, "{entry}: a new picture");
    }
    for (key, colors) in [
        (egui::Key::H, Colors::Factors),
        (egui::Key::X, Colors::TriangleSize),
        (egui::Key::U, Colors::LowFactors),
        (egui::Key::B, Colors::Barycentric),
        (egui::Key::B, Colors::Material),
    ] {
        press(&mut harness, key);
        assert_eq!(harness.state().settings().overlays.colors, colors);
    }
    press(&mut harness, egui::Key::N);
    assert!(harness.state().settings().overlays.normals);
}

#[test]
fn small_triangles_are_counted_for_the_view_that_is_shown_and_for_no_other() {
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    let count = |harness: &Harness<App>| harness.state().sizes_shown().map(|sizes| (sizes.in_view, sizes.small));
    let (_, triangles) = harness.state().totals().expect("counted");
    let (in_view, small) = count(&harness).expect("measured");
    assert_eq!(in_view, triangles, "all of it is framed");
    assert!(small > 0);
    // From farther away nothing is tessellated anew, so nothing is measured.
    press(&mut harness, egui::Key::PageDown);
    assert_eq!(count(&harness), None);
    // Unless one looks at the sizes.
    press(&mut harness, egui::Key::X);
    let (_, smaller) = count(&harness).expect("measured");
    assert!(smaller > small, "{smaller}, and {small} from nearer");
    press(&mut harness, egui::Key::PageDown);
    let (_, smallest) = count(&harness).expect("measured");
    assert!(smallest > smaller, "{smallest}, and {smaller} from nearer");
    assert!(harness.state().cracks().is_some(), "which the view doesn't change");
}

#[test]
fn a_mistaken_convention_cracks_and_shows_both_factors() {
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    choose(&mut harness, "LOD", "Edge length");
    let cracked = |harness: &Harness<App>| harness.state().cracks().map(|cracks| cracks.different_factors);
    for (entry, convention) in [("AMD PN sample", Convention::AmdPn), ("Edge order", Convention::EdgeOrder)] {
        choose(&mut harness, "Convention", entry);
        assert_eq!((harness.state().settings().convention, cracked(&harness)), (convention, Some(0)));
    }
    choose(&mut harness, "Convention", "Mirrored, a mistake");
    assert!(cracked(&harness) > Some(100), "{:?}", cracked(&harness));
    choose(&mut harness, "Convention", "Rotated, a mistake");
    assert!(cracked(&harness) > Some(100), "{:?}", cracked(&harness));
    choose(&mut harness, "LOD", "Uniform");
    assert_eq!(cracked(&harness), Some(0));
    choose(&mut harness, "Convention", "Direct3D 11");
    assert_eq!(harness.state().settings().convention, Convention::D3d11);
}

#[test]
fn the_worst_edges_are_listed_and_one_click_frames_one() {
    let mut harness = uniform(Some(Source::Shape(Shape::CubeSplit)));
    choose(&mut harness, "Surface", "PN");
    let app = harness.state();
    let cracks = app.cracks().expect("measured").clone();
    let before = *app.camera();
    // The list shows the widest gap first; its third row is as good as any.
    let edge = cracks.edges[2].edge;
    let row = format!("{edge:<6}split normal");
    harness.get_by_label_contains(&row).click();
    settle(&mut harness);
    let app = harness.state();
    assert_eq!(app.selected_edge(), Some(edge));
    let topology = &app.loaded().expect("a mesh").topology;
    let [a, b] = topology.edges[edge as usize].points.map(|point| topology.points[point as usize]);
    assert_ne!(*app.camera(), before);
    assert!(app.camera().target.distance((a + b) / 2.0) < 1e-6, "the edge is in the middle");
    // Named, with its two triangles, both sides' factors and points.
    harness.get_by_label(&format!("Edge {edge}"));
    assert!(harness.get_all_by_label("split normal").next().is_some());
    for side in topology.edge_sides(&topology.edges[edge as usize]) {
        let triangle = topology.patches[side.patch as usize].triangle;
        harness.get_by_label(&format!("Triangle {triangle}"));
    }
    assert_eq!(harness.get_all_by_label("8.00000").count(), 2, "both sides' factors");
    assert_eq!(harness.get_all_by_label("9").count(), 2, "both sides' segments");
    assert_eq!(harness.get_all_by_label_contains("apart, units").count(), 1, "their points");
    harness.get_by_label("Deselect").click();
    settle(&mut harness);
    assert_eq!(harness.state().selected_edge(), None);
}

#[test]
fn keys_go_through_a_list_beyond_the_rows_in_sight() {
    let mut harness = uniform(Some(Source::Shape(Shape::CubeSplit)));
    choose(&mut harness, "Surface", "PN");
    let edges: Vec<_> = harness.state().cracks().expect("measured").edges.iter().map(|crack| crack.edge).collect();
    harness.get_by_label_contains(&format!("{:<6}split normal", edges[0])).focus();
    settle(&mut harness);
    let steps = [egui::Key::ArrowDown; 9].into_iter().chain([egui::Key::ArrowUp, egui::Key::Enter]);
    for key in steps {
        press(&mut harness, key);
    }
    assert_eq!(harness.state().selected_edge(), Some(edges[8]));
    for key in [egui::Key::End, egui::Key::Enter] {
        press(&mut harness, key);
    }
    assert_eq!(harness.state().selected_edge(), Some(edges[11]));
    press(&mut harness, egui::Key::Home);
    press(&mut harness, egui::Key::Enter);
    assert_eq!(harness.state().selected_edge(), Some(edges[0]));
}

#[test]
fn escape_closes_a_list_before_it_deselects() {
    let mut harness = uniform(Some(Source::Shape(Shape::CubeSplit)));
    harness.state_mut().select_edge(3);
    settle(&mut harness);
    harness.get_by_role_and_label(Role::ComboBox, "Surface").click();
    settle(&mut harness);
    press(&mut harness, egui::Key::Escape);
    assert_eq!(harness.state().selected_edge(), Some(3));
    press(&mut harness, egui::Key::Escape);
    assert_eq!(harness.state().selected_edge(), None);
}

#[test]
fn as_published_edges_crack_and_once_an_edge_they_close() {
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    press(&mut harness, egui::Key::E);
    let cracked = harness.state().cracks().expect("measured").different_bits;
    assert!(cracked > 1000, "{cracked}");
    press(&mut harness, egui::Key::E);
    assert_eq!(harness.state().cracks().expect("measured").different_bits, 0);
}

#[test]
fn a_weld_tolerance_says_what_it_joins_and_then_joins_it() {
    let mut harness = uniform(Some(Source::Shape(Shape::Saddle)));
    let start = Instant::now();
    while harness.state().is_checking() {
        assert!(start.elapsed() < PATIENCE, "the mesh is still being checked");
        harness.step();
    }
    press(&mut harness, egui::Key::Num3);
    let camera = *harness.state().camera();
    choose(&mut harness, "Weld", "1e-5: joins nothing");
    let app = harness.state();
    assert_eq!(app.loaded().map(|loaded| loaded.weld), Some(1e-5));
    assert_eq!(*app.camera(), camera, "the view stays");
}

#[test]
fn nothing_is_drawn_when_nothing_changed() {
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    let pictures = harness.state().pictures();
    harness.hover_at(egui::pos2(600.0, 400.0));
    harness.run_steps(20);
    assert_eq!(harness.state().pictures(), pictures);
    press(&mut harness, egui::Key::Num1);
    assert_eq!(harness.state().pictures(), pictures + 1);
}

#[test]
fn frozen_lod_stays_while_the_camera_moves() {
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    press(&mut harness, egui::Key::L);
    let before = harness.state().totals();
    press(&mut harness, egui::Key::Z);
    press(&mut harness, egui::Key::PageUp);
    press(&mut harness, egui::Key::PageUp);
    assert_eq!(harness.state().totals(), before, "frozen");
    press(&mut harness, egui::Key::Z);
    assert!(harness.state().totals() > before, "nearer, so more triangles");
}

#[test]
fn the_pointer_orbits_and_zooms() {
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    let pictures = harness.state().pictures();
    let before = *harness.state().camera();
    harness.drag_at(egui::pos2(600.0, 400.0));
    harness.run_steps(1);
    harness.hover_at(egui::pos2(650.0, 420.0));
    harness.run_steps(1);
    harness.drop_at(egui::pos2(650.0, 420.0));
    settle(&mut harness);
    let orbited = *harness.state().camera();
    assert_ne!(orbited.azimuth, before.azimuth);
    assert_eq!(orbited.target, before.target);
    harness.hover_at(egui::pos2(650.0, 420.0));
    harness.event(egui::Event::MouseWheel {
        unit: egui::MouseWheelUnit::Line,
        delta: egui::vec2(0.0, 2.0),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Wheel,
        modifiers: egui::Modifiers::NONE,
    });
    settle(&mut harness);
    harness.run_steps(10);
    settle(&mut harness);
    assert!(harness.state().camera().distance < orbited.distance);
    assert!(harness.state().pictures() > pictures);
}

#[test]
fn a_file_is_opened_by_its_path_and_reloaded_with_every_setting() {
    let mut harness = uniform(None);
    press(&mut harness, egui::Key::B);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::L);
    settle(&mut harness);
    let Source::File(path) = vase() else { unreachable!("it is a file") };
    harness.get_by_label("A .gltf or .glb file, or shape:NAME").type_text(&path.display().to_string());
    settle(&mut harness);
    click(&mut harness, "Open");
    assert_eq!(harness.state().source(), Some(&vase()));
    assert_eq!(harness.state().cracks().map(|cracks| cracks.different_bits), Some(0));
    harness.get_by_label("308 of 308 patches");
    press(&mut harness, egui::Key::Num3);
    let camera = *harness.state().camera();
    press(&mut harness, egui::Key::R);
    assert_eq!(*harness.state().camera(), camera);
    assert_eq!(harness.state().settings().overlays.colors, Colors::Barycentric);
}

#[test]
fn a_file_that_cannot_be_loaded_changes_nothing() {
    let mut harness = uniform(Some(vase()));
    press(&mut harness, egui::Key::A);
    let (settings, camera) = (*harness.state().settings(), *harness.state().camera());
    let context = harness.ctx.clone();
    harness.state_mut().open(&context, Source::File(PathBuf::from("nowhere.glb")));
    settle(&mut harness);
    assert_eq!(harness.state().source(), Some(&vase()), "the old mesh stays");
    assert_eq!((*harness.state().settings(), *harness.state().camera()), (settings, camera));
    harness.get_by_label_contains("nowhere.glb can't be read");
    click(&mut harness, "Close");
    assert!(harness.query_by_label_contains("nowhere.glb").is_none());
}

#[test]
fn a_dropped_file_is_opened() {
    #[derive(Debug)]
    struct Dropped(PathBuf);
    impl egui::DroppedFile for Dropped {
        fn path(&self) -> &std::path::Path {
            &self.0
        }
        fn bytes(&self) -> Result<Vec<u8>, String> {
            std::fs::read(&self.0).map_err(|error| error.to_string())
        }
    }
    let mut harness = uniform(None);
    let Source::File(path) = vase() else { unreachable!("it is a file") };
    harness.input_mut().dropped_files.push(std::sync::Arc::new(Dropped(path)));
    settle(&mut harness);
    assert_eq!(harness.state().source(), Some(&vase()));
}

#[test]
fn every_shape_is_in_the_menu() {
    let mut harness = uniform(None);
    for shape in Shape::ALL {
        click(&mut harness, "File");
        harness.get_by_label_contains("Shapes").click();
        settle(&mut harness);
        harness.get_by_role_and_label(Role::Button, shape.title()).click();
        settle(&mut harness);
        assert_eq!(harness.state().source(), Some(&Source::Shape(shape)));
        assert_eq!(harness.state().cracks().map(|cracks| cracks.different_bits), Some(0), "{shape:?}");
    }
}

#[test]
fn both_themes_show_the_picture_and_legible_controls() {
    for theme in [egui::Theme::Dark, egui::Theme::Light] {
        let mut harness = Harness::builder()
            .with_size([1200.0, 800.0])
            .with_theme(theme)
            .wgpu()
            .build_eframe(|context| App::new(context, Some(vase())).expect("these tests need a graphics adapter"));
        settle(&mut harness);
        let picture = harness.render().expect("a picture of the window");
        let panel = picture.get_pixel(8, 700).0;
        assert_eq!(panel[0] > 128, theme == egui::Theme::Light, "{theme:?}: {panel:?}");
        // The vase's blue belt, in the middle of the viewport.
        let middle = picture.get_pixel(610, 400).0;
        assert!(middle[2] > middle[0], "{theme:?}: {middle:?}");
    }
}

#[test]
fn a_picture_of_many_steps_can_be_cancelled_and_drawn_after_all() {
    let path = std::env::temp_dir().join(format!("pnaen-window-{}.glb", std::process::id()));
    let made = std::process::Command::new(env!("CARGO_BIN_EXE_pnaen"))
        .args(["tessellate", "shape:torus", "--factor", "3", "-o"])
        .arg(&path)
        .status();
    assert!(made.is_ok_and(|status| status.success()));
    let mut harness = uniform(Some(Source::File(path.clone())));
    let (pictures, before) = (harness.state().pictures(), harness.state().totals());
    // Some 20 million triangles: more than anyone would wait for here.
    harness.get_by_role_and_label(Role::Slider, "Factor").set_value_accesskit(64.0);
    let start = Instant::now();
    while harness.query_by_label_contains("Drawing ").is_none() {
        assert!(start.elapsed() < PATIENCE, "nothing is being drawn");
        harness.step();
    }
    click(&mut harness, "Cancel");
    assert_eq!((harness.state().pictures(), harness.state().settings().factor), (pictures, 64.0));
    assert!(!harness.state().is_busy());
    harness.get_by_label_contains("Not drawn: ");
    harness.get_by_label("Draw").click();
    harness.run_steps(3);
    harness.get_by_label_contains("Drawing ");
    harness.get_by_role_and_label(Role::Slider, "Factor").set_value_accesskit(8.0);
    settle(&mut harness);
    // The last picture is of that: it only has to be counted again.
    assert_eq!((harness.state().pictures(), harness.state().totals()), (pictures, before));
    let _ = std::fs::remove_file(path);
}

//! A lost graphics device: the window goes on with another one, once, and keeps its state.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use geometry::mesh::Shape;
use geometry::progress::Progress;
use inspect::engine::Loaded;
use inspect::settings::SplitSide;
use load::files::Limits;
use load::{Source, load};
use pnaen::app::App;

use crate::opening::setup;
use crate::{choose, click, made_uniform, open_alone, press, settle, unfolded};

/// The start of the message if the window goes on, and of no other.
const SENTENCE: &str = "The graphics device was lost (it was destroyed). The window goes on with a new one";

const SIZE: [f32; 2] = [1200.0, 960.0];

/// A window whose device nothing else uses.
fn alone(source: Source) -> Harness<'static, App> {
    unfolded(open_alone(Harness::builder().with_size(SIZE), Some(source)))
}

/// Destroys the device, as a driver's reset does, and waits until the window has noticed.
fn lose(harness: &mut Harness<App>) {
    harness.state().gpu().device.destroy();
    let start = std::time::Instant::now();
    while !harness.state().is_lost() {
        assert!(start.elapsed() < crate::PATIENCE, "the window hasn't noticed the loss");
        let _ = harness.state().gpu().device.poll(wgpu::PollType::wait_indefinitely());
        harness.step();
    }
    harness.run_steps(2);
    assert!(harness.query_by_role(Role::Button).is_none(), "nothing is shown, since nothing could be painted");
}

/// Opens the window that follows one whose device was lost.
fn anew(harness: Harness<'static, App>) -> Harness<'static, App> {
    let before = harness.ctx.clone();
    let app = harness.into_state();
    Harness::builder()
        .with_size(SIZE)
        .wgpu_setup(setup())
        .build_eframe(move |context| app.anew(context, &before).expect("these tests need a graphics adapter"))
}

/// The viewport's picture without the panels around it, which show times.
fn viewport(harness: &mut Harness<App>) -> image::RgbaImage {
    harness.remove_cursor();
    harness.set_render_cursor(false);
    harness.run_steps(2);
    let window = harness.render().expect("a picture of the window");
    image::imageops::crop_imm(&window, 320, 60, 520, 800).to_image()
}

fn is_the_same(before: &Loaded, now: Option<&Loaded>) -> bool {
    now.is_some_and(|now| Arc::ptr_eq(&before.mesh, &now.mesh) && Arc::ptr_eq(&before.topology, &now.topology))
}

#[test]
fn everything_stays_and_the_picture_is_the_same_to_the_bit() {
    let mut harness = made_uniform(alone(Source::Shape(Shape::Torus)));
    choose(&mut harness, "Surface", "PN");
    harness.get_by_role_and_label(Role::CheckBox, "Split view").click();
    settle(&mut harness);
    choose(&mut harness, "Left", "Nagata");
    press(&mut harness, egui::Key::C);
    press(&mut harness, egui::Key::ArrowUp);
    press(&mut harness, egui::Key::PageUp);
    press(&mut harness, egui::Key::Z);
    press(&mut harness, egui::Key::ArrowLeft);
    harness.state_mut().select_triangle(Some(7));
    // A value in egui's memory, which also has scroll positions and folded sections.
    harness.ctx.data_mut(|data| data.insert_temp(egui::Id::unique("kept"), 7_i32));
    settle(&mut harness);
    harness.run_steps(20);
    let picture = viewport(&mut harness);
    let app = harness.state();
    let (settings, camera, loaded) = (*app.settings(), *app.camera(), app.loaded().cloned().expect("a torus"));
    let (totals, cracks) = (app.totals(), app.cracks().cloned());
    assert!(settings.half(SplitSide::Left).is_some() && cracks.is_some());

    lose(&mut harness);
    let mut harness = anew(harness);
    settle(&mut harness);
    harness.get_by_label_contains(SENTENCE);
    click(&mut harness, "Close");
    harness.run_steps(20);
    let app = harness.state();
    assert_eq!((app.settings(), app.camera(), app.selected_triangle()), (&settings, &camera, Some(7)));
    assert!(is_the_same(&loaded, app.loaded()), "the mesh isn't loaded again");
    assert_eq!(harness.ctx.data(|data| data.get_temp(egui::Id::unique("kept"))), Some(7_i32));
    assert_eq!((app.totals(), app.cracks().map(|cracks| cracks.edges.len())), (totals, cracks.map(|c| c.edges.len())));
    assert!(viewport(&mut harness) == picture, "the pictures differ");
}

#[test]
fn jobs_that_were_under_way_go_on_without_further_messages() {
    let mut harness = alone(Source::Shape(Shape::Torus));
    choose(&mut harness, "Colours", "Deviation");
    let wanted: Source = "shape:icosphere@4".parse().expect("a shape");
    let (context, reference_shape) = (harness.ctx.clone(), Source::Shape(Shape::Icosphere));
    // Measuring, copying, making the left half and loading are all under way.
    press(&mut harness, egui::Key::S);
    choose(&mut harness, "Left", "Flat");
    harness.key_press(egui::Key::Num7);
    harness.run_steps(2);
    harness.state_mut().open(&context, wanted.clone());
    harness.state_mut().open_reference_shape(&context, reference_shape);
    lose(&mut harness);
    let mut harness = anew(harness);
    settle(&mut harness);
    let app = harness.state();
    assert_eq!(app.source(), Some(&wanted));
    assert!(app.deviation(SplitSide::Right).is_some() && app.deviation(SplitSide::Left).is_some());
    assert!(
        harness.query_by_label_contains("stopped").is_none() && harness.query_by_label_contains("failed").is_none()
    );
}

#[test]
fn the_pose_stays() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = folder.path().join("moving.glb");
    std::fs::write(&path, documents::moving::moving()).expect("a writable folder");
    let mut harness = alone(Source::File(path));
    harness.state_mut().choose_clip(Some(0));
    settle(&mut harness);
    harness.key_press(egui::Key::Space);
    harness.run_steps(5);
    press(&mut harness, egui::Key::Space);
    let (moment, totals) = (harness.state().moment(), harness.state().totals());
    let picture = viewport(&mut harness);
    assert!(moment.is_some());
    lose(&mut harness);
    let mut harness = anew(harness);
    settle(&mut harness);
    click(&mut harness, "Close");
    assert_eq!((harness.state().moment(), harness.state().totals()), (moment, totals));
    assert!(viewport(&mut harness) == picture);
}

#[test]
fn after_a_second_loss_the_window_offers_to_save_and_to_try_again() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = folder.path().join("saved.obj");
    let mut harness = made_uniform(alone(Source::Shape(Shape::Torus)));
    let (totals, loaded) = (harness.state().totals(), harness.state().loaded().cloned().expect("a torus"));
    lose(&mut harness);
    let mut harness = anew(harness);
    settle(&mut harness);
    lose(&mut harness);
    let mut harness = anew(harness);
    harness.run_steps(3);
    assert!(harness.state().fatal_message().is_some_and(|said| said.contains("lost again (it was destroyed)")));
    harness.get_by_label("Quit");
    save_as(&mut harness, &path);
    harness.get_by_label_contains("is written.");
    let saved = load(&path, &Limits::default(), &Progress::new()).expect("an OBJ file").mesh;
    assert_eq!(Some(saved.triangles.len() as u64), totals.map(|(_, triangles)| triangles), "the CPU emits as many");
    click(&mut harness, "Save mesh");
    said(&mut harness, "saved.obj exists already");

    click(&mut harness, "Try again");
    let mut harness = anew(harness);
    settle(&mut harness);
    harness.get_by_label_contains(SENTENCE);
    assert!(is_the_same(&loaded, harness.state().loaded()) && harness.state().pictures() > 0);
}

fn save_as(harness: &mut Harness<App>, path: &Path) {
    harness.get_by_label("Tessellated mesh, a .glb or .obj file").focus();
    harness.run_steps(2);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::A);
    harness.get_by_label("Tessellated mesh, a .glb or .obj file").type_text(&path.display().to_string());
    harness.run_steps(2);
    click(harness, "Save mesh");
    said(harness, "is written.");
}

/// Runs frames until this text is shown.
fn said(harness: &mut Harness<App>, text: &str) {
    let start = std::time::Instant::now();
    while harness.query_by_label_contains(text).is_none() {
        assert!(start.elapsed() < crate::PATIENCE, "{text}");
        std::thread::sleep(std::time::Duration::from_millis(2));
        harness.step();
    }
}

#[test]
fn a_refused_command_is_reported_and_the_window_goes_on() {
    let mut harness = made_uniform(alone(Source::Shape(Shape::Torus)));
    let (settings, pictures) = (*harness.state().settings(), harness.state().pictures());
    // A buffer can't be mapped both for reading and for writing, so the device refuses it.
    let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::MAP_WRITE;
    let descriptor = wgpu::BufferDescriptor { label: None, size: 4, usage, mapped_at_creation: false };
    let _ = harness.state().gpu().device.create_buffer(&descriptor);
    settle(&mut harness);
    harness.get_by_label_contains("the graphics device refused a command");
    assert_eq!((harness.state().settings(), harness.state().pictures()), (&settings, pictures));
    click(&mut harness, "Close");
    press(&mut harness, egui::Key::Num1);
    assert!(harness.state().pictures() > pictures && !harness.state().is_lost());
    assert!(harness.query_by_label_contains("refused").is_none(), "the error is shown only once");
}

#[test]
fn a_second_loss_before_the_first_picture_shows_the_message() {
    let nowhere = Source::File(PathBuf::from("nowhere.glb"));
    let mut harness = open_alone(Harness::builder().with_size(SIZE), Some(nowhere));
    lose(&mut harness);
    let mut harness = anew(harness);
    lose(&mut harness);
    let mut harness = anew(harness);
    harness.run_steps(2);
    assert!(harness.state().fatal_message().is_some());
    harness.get_by_label("Try again");
}

//! Loading: the latest load wins, the open mesh stays until the new one is loaded, and nothing hangs.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use geometry::mesh::Shape;
use load::Source;
use pnaen::app::App;

use crate::editing::{assert_draws, copied};
use crate::lod_shader::until;
use crate::{PATIENCE, STOP, choose, click, copy_vase, press, settle, uniform, uniform_of, vase};

#[derive(Debug)]
struct Dropped(PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }
    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

/// Drops files on the window, all at once.
pub(super) fn drop_files(harness: &mut Harness<App>, paths: &[PathBuf]) {
    for path in paths {
        harness.input_mut().dropped_files.push(Arc::new(Dropped(path.clone())));
    }
    harness.run_steps(2);
}

/// A shape that takes a second or more to make.
fn slow() -> Source {
    "shape:icosphere@6".parse().expect("a shape")
}

fn open(harness: &mut Harness<App>, source: Source) {
    let context = harness.ctx.clone();
    harness.state_mut().open(&context, source);
    harness.run_steps(2);
}

fn says_nothing(harness: &Harness<App>) {
    assert!(harness.query_by_label("Problem").is_none() && harness.query_by_label("Close").is_none());
}

#[test]
fn before_the_first_picture_the_view_has_its_background_and_everything_its_place() {
    let builder = Harness::builder().with_size([1280.0, 720.0]).with_theme(egui::Theme::Dark);
    // The pipelines of another device are made already.
    let mut harness = crate::open_alone(builder, None);
    harness.step();
    assert_eq!(harness.state().source(), None, "it is still being loaded");
    let below = harness.get_by_label("Waste").rect();
    assert!(
        harness.query_by_label_contains("triangles, 0 cracked").is_none(),
        "there is nothing yet that is untessellated"
    );
    assert!(harness.query_by_label_contains("Drag to turn").is_none(), "the progress is there");
    let picture = harness.render().expect("a picture of the window");
    let corner = harness.get_by_label("Viewport").rect().left_top();
    let [r, g, b] = harness.state().settings().background_color();
    assert_eq!(picture.get_pixel(corner.x as u32 + 20, corner.y as u32 + 60).0, [r, g, b, 255]);
    // Compiling shaders takes the longest, and has a name.
    let start = Instant::now();
    while harness.query_by_label("Preparing to draw Vase").is_none() {
        assert!(harness.state().source().is_none() && start.elapsed() < PATIENCE, "it wasn't said");
        std::thread::sleep(Duration::from_millis(1));
        harness.step();
    }
    settle(&mut harness);
    assert_eq!(harness.get_by_label("Waste").rect(), below);
    harness.get_by_label("Left: untessellated\n308 triangles, 0 cracked edges");
    harness.get_by_label_contains("Drag to turn");
}

#[test]
fn a_mesh_opened_while_another_loads_wins() {
    let mut harness = uniform(Some(vase()));
    open(&mut harness, slow());
    harness.get_by_label(STOP);
    open(&mut harness, Source::Shape(Shape::Torus));
    settle(&mut harness);
    assert_eq!(harness.state().source(), Some(&Source::Shape(Shape::Torus)));
    // The cancelled load would have ended by now.
    std::thread::sleep(Duration::from_millis(500));
    harness.run_steps(5);
    assert_eq!(harness.state().source(), Some(&Source::Shape(Shape::Torus)));
    says_nothing(&harness);
}

#[test]
fn reloading_while_another_mesh_loads_keeps_the_open_mesh() {
    let mut harness = uniform(Some(vase()));
    let loaded = harness.state().loaded().cloned().expect("the vase");
    open(&mut harness, slow());
    press(&mut harness, egui::Key::R);
    let app = harness.state();
    assert_eq!(app.source(), Some(&vase()), "the latest wins");
    assert!(!Arc::ptr_eq(&app.loaded().expect("the vase").mesh, &loaded.mesh), "the mesh is read again");
    says_nothing(&harness);
}

#[test]
fn repeated_reloading_ends_with_the_last_version_of_the_file() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = copy_vase(&folder, "mesh.obj");
    std::fs::write(&path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("a writable folder");
    let mut harness = uniform(Some(Source::File(path.clone())));
    let camera = *harness.state().camera();
    for k in 1..8 {
        harness.key_press(egui::Key::R);
        harness.run_steps(1);
        let text = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n{}", "f 1 2 3\n".repeat(k));
        std::fs::write(&path, text).expect("a writable folder");
    }
    press(&mut harness, egui::Key::R);
    assert_eq!(harness.state().loaded().map(|loaded| loaded.read.triangles.len()), Some(7));
    assert_eq!(*harness.state().camera(), camera);
}

#[test]
fn closing_the_window_while_a_mesh_loads_ends_at_once() {
    let mut harness = uniform(None);
    open(&mut harness, slow());
    harness.get_by_label(STOP);
    let start = Instant::now();
    eframe::App::on_exit(harness.state_mut());
    drop(harness);
    assert!(start.elapsed() < Duration::from_secs(1), "{:?}", start.elapsed());
}

const QUAD: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";

#[test]
fn several_dropped_meshes_are_a_list_to_step_through() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let elsewhere = tempfile::tempdir().expect("a writable temporary folder");
    let image = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/waves.png"));
    let [first, second] = [copy_vase(&folder, "z.glb"), copy_vase(&elsewhere, "b.glb")];
    let mut harness = uniform(None);
    drop_files(&mut harness, &[image, first.clone(), second.clone()]);
    settle(&mut harness);
    let source = |harness: &Harness<App>| harness.state().source().cloned();
    assert_eq!(source(&harness), Some(Source::File(first.clone())), "the first mesh, not the image before it");
    says_nothing(&harness);
    wait_for_label(&mut harness, "1/2");
    click(&mut harness, "Next mesh");
    assert_eq!(source(&harness), Some(Source::File(second)));
    wait_for_label(&mut harness, "2/2");
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::PageDown);
    settle(&mut harness);
    assert_eq!(source(&harness), Some(Source::File(first)), "after the last one comes the first");
}

#[test]
fn the_meshes_of_a_folder_are_stepped_through() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let [first, second, last] = ["a.glb", "B.glb", "c.glb"].map(|name| copy_vase(&folder, name));
    std::fs::write(folder.path().join("b.txt"), "").expect("a writable folder");
    let mut harness = uniform(Some(Source::File(second)));
    wait_for_label(&mut harness, "2/3");
    click(&mut harness, "Previous mesh");
    assert_eq!(harness.state().source(), Some(&Source::File(first)));
    wait_for_label(&mut harness, "1/3");
    click(&mut harness, "Previous mesh");
    assert_eq!(harness.state().source(), Some(&Source::File(last)));
}

#[test]
fn the_number_of_a_mesh_stays_while_it_is_loaded_again_by_a_relative_path() {
    // Tests run in the package's folder; beside the vase there is glass.
    let mut harness = uniform(Some(Source::File("assets/vase.glb".into())));
    wait_for_label(&mut harness, "2/2");
    let context = harness.ctx.clone();
    let before = harness.state().pictures();
    harness.state_mut().reload(&context);
    until_always(&mut harness, "2/2", |app| app.pictures() > before);
}

/// Goes on until something holds, while a label must be there in every frame.
fn until_always(harness: &mut Harness<App>, label: &str, holds: impl Fn(&App) -> bool) {
    let start = Instant::now();
    while !holds(harness.state()) {
        assert!(start.elapsed() < PATIENCE, "the window is still busy");
        harness.step();
        harness.get_by_label(label);
    }
}

#[test]
fn steps_through_a_folder_go_past_meshes_that_cannot_be_loaded_and_none_is_lost() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).expect("a writable temporary folder");
        path
    };
    let paths = ["a.obj", "b.obj", "c.obj", "d.obj"].map(|name| write(name, if name == "b.obj" { "" } else { QUAD }));
    let mut harness = uniform(Some(Source::File(paths[0].clone())));
    wait_for_label(&mut harness, "1/4");
    let source = |harness: &Harness<App>| harness.state().source().cloned();
    click(&mut harness, "Next mesh");
    harness.get_by_label_contains("b.obj is empty");
    assert_eq!(source(&harness), Some(Source::File(paths[0].clone())), "the last good one stays");
    click(&mut harness, "Next mesh");
    assert_eq!(source(&harness), Some(Source::File(paths[2].clone())));
    std::fs::remove_file(&paths[3]).expect("it is there");
    click(&mut harness, "Next mesh");
    harness.get_by_label_contains("d.obj can't be read");
    // Two at once.
    write("b.obj", QUAD);
    for _ in 0..2 {
        harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::PageDown);
        harness.step();
    }
    settle(&mut harness);
    assert_eq!(source(&harness), Some(Source::File(paths[1].clone())));
    wait_for_label(&mut harness, "2/3");
}

#[test]
fn parts_that_vanish_on_disk_are_forgotten_and_the_rest_is_shown() {
    let part = |name: &str| format!("o {name}\n{}", QUAD.replace("f 1 2 3 4", "f -4 -3 -2 -1"));
    let parts = |names: &[&str]| names.iter().map(|name| part(name)).collect::<String>();
    let (folder, mut harness) = uniform_of("parts.obj", parts(&["A", "B", "C"]));
    let path = folder.path().join("parts.obj");
    let context = harness.ctx.clone();
    let triangles = |harness: &Harness<App>| harness.state().loaded().map(|loaded| loaded.mesh.triangles.len());
    harness.state_mut().prepare(&context, |own| own.parts.hidden = vec!["A".to_owned(), "B".to_owned()]);
    settle(&mut harness);
    assert_eq!(triangles(&harness), Some(2));
    std::fs::write(&path, parts(&["B", "C", "D"])).expect("a writable folder");
    wait_for_label(&mut harness, "changed on disk, loaded anew");
    settle(&mut harness);
    assert_eq!(triangles(&harness), Some(4), "B is hidden still");
    let loaded = harness.state().loaded().expect("a mesh");
    assert_eq!(loaded.preparation.parts.hidden, ["B"]);
    assert_eq!(loaded.warnings[0], "it no longer has the part A; what was set for it is forgotten.");
    harness.state_mut().prepare(&context, |own| own.parts.show_only(vec!["D".to_owned()]));
    settle(&mut harness);
    assert_eq!(triangles(&harness), Some(2));
    std::fs::write(&path, part("C")).expect("a writable folder");
    until(&mut harness, "all parts are shown", |app| {
        app.loaded().is_some_and(|own| own.preparation.parts.only.is_empty() && own.mesh.triangles.len() == 2)
    });
}

#[test]
fn a_mesh_that_changes_on_disk_is_loaded_anew_and_a_broken_one_leaves_the_last_good_one() {
    let (folder, mut harness) = uniform_of("quad.obj", QUAD);
    let path = folder.path().join("quad.obj");
    press(&mut harness, egui::Key::Num3);
    let (settings, camera) = (*harness.state().settings(), *harness.state().camera());
    let triangles = |harness: &Harness<App>| harness.state().loaded().map(|loaded| loaded.mesh.triangles.len());
    assert_eq!(triangles(&harness), Some(2));
    // The times of file systems are rough, but another length is always seen.
    std::fs::write(&path, QUAD.replace("f 1 2 3 4", "f 1 2 3 # one")).expect("a writable folder");
    wait_for_label(&mut harness, "changed on disk, loaded anew");
    settle(&mut harness);
    assert_eq!(triangles(&harness), Some(1));
    assert_eq!((*harness.state().settings(), *harness.state().camera()), (settings, camera));
    std::fs::write(&path, "f 1 2 3").expect("a writable folder");
    wait_for_label(&mut harness, "Close");
    assert_eq!(triangles(&harness), Some(1), "the last good one stays");
    harness.get_by_label_contains("quad.obj has no triangles");
    std::fs::write(&path, QUAD).expect("a writable folder");
    let start = Instant::now();
    while triangles(&harness) != Some(2) {
        assert!(start.elapsed() < PATIENCE, "a good version is taken again");
        std::thread::sleep(Duration::from_millis(20));
        settle(&mut harness);
    }
    says_nothing(&harness);
}

#[test]
fn a_mesh_that_changed_is_compared_with_what_it_was_and_with_another_file() {
    let (folder, mut harness) = uniform_of("quad.obj", QUAD);
    let path = folder.path().join("quad.obj");
    std::fs::write(&path, QUAD.replace("f 1 2 3 4", "f 1 2 3 # one")).expect("a writable folder");
    wait_for_label(&mut harness, "changed on disk, loaded anew");
    settle(&mut harness);
    click(&mut harness, "changed on disk, loaded anew");
    let tessellation = harness.state().settings().tessellation;
    assert_eq!(harness.state().settings().left, tessellation);
    harness.get_by_label("Left: before the change, PN-AEN\n242 triangles, 0 cracked edges");
    harness.get_by_label("Right: quad.obj, PN-AEN\n121 triangles, 0 cracked edges");
    // Another version of the mesh leaves the one that is compared.
    std::fs::write(&path, QUAD).expect("a writable folder");
    wait_for_label(&mut harness, "Right: quad.obj, PN-AEN\n242 triangles, 0 cracked edges");
    harness.get_by_label_contains("Left: before the change");
    choose(&mut harness, "Left mesh", "Another file…");
    let start = Instant::now();
    while harness.state().path_asked_for().is_none() {
        assert!(start.elapsed() < PATIENCE, "no path is asked for");
        std::thread::sleep(Duration::from_millis(2));
        harness.step();
    }
    harness.event(egui::Event::Text("shape:cube-smooth".into()));
    settle(&mut harness);
    press(&mut harness, egui::Key::Enter);
    harness.get_by_label_contains("Left: Cube, smooth normals, PN-AEN");
    let command = copied(&mut harness);
    assert!(command.contains("--split-with shape:cube-smooth"), "{command}");
    assert_draws(&harness, &command, "quad-view");
    // Patches there are those of the other mesh, which has more of them.
    choose(&mut harness, "Colours", "Deviation");
    harness.get_by_label_contains("Left Worst point in patch").click();
    settle(&mut harness);
    assert!(harness.state().camera().target.is_finite());
    choose(&mut harness, "Colours", "Material");
    choose(&mut harness, "Left mesh", "The same");
    harness.get_by_label("Left: PN-AEN\n242 triangles, 0 cracked edges");
    says_nothing(&harness);
}

#[test]
fn the_mesh_before_a_change_is_undone_and_left_out_of_copied_commands() {
    let (folder, mut harness) = uniform_of("quad.obj", QUAD);
    let path = folder.path().join("quad.obj");
    std::fs::write(&path, QUAD.replace("f 1 2 3 4", "f 1 2 3 # one")).expect("a writable folder");
    wait_for_label(&mut harness, "changed on disk, loaded anew");
    settle(&mut harness);
    let (context, settings) = (harness.ctx.clone(), *harness.state().settings());
    click(&mut harness, "changed on disk, loaded anew");
    harness.get_by_label("Left: before the change, PN-AEN\n242 triangles, 0 cracked edges");
    let compared = *harness.state().settings();
    harness.state_mut().undo(&context);
    settle(&mut harness);
    assert_eq!(*harness.state().settings(), settings);
    assert!(harness.query_by_label_contains("Left: before the change").is_none());
    harness.state_mut().redo(&context);
    settle(&mut harness);
    assert_eq!(*harness.state().settings(), compared);
    harness.get_by_label("Left: before the change, PN-AEN\n242 triangles, 0 cracked edges");
    let command = copied(&mut harness);
    assert!(!command.contains("--split"), "{command}");
    harness.get_by_label_contains("no command can name the earlier version of a mesh");
    press(&mut harness, egui::Key::Escape);
    choose(&mut harness, "Left mesh", "The same");
    harness.get_by_label("Left: PN-AEN\n121 triangles, 0 cracked edges");
    assert!(copied(&mut harness).contains("--split"), "a command can name this mesh");
    assert!(harness.query_by_label_contains("the earlier version of a mesh").is_none());
    press(&mut harness, egui::Key::Escape);
    harness.state_mut().undo(&context);
    settle(&mut harness);
    harness.get_by_label("Left: before the change, PN-AEN\n242 triangles, 0 cracked edges");
    harness.state_mut().redo(&context);
    settle(&mut harness);
    harness.get_by_label("Left: PN-AEN\n121 triangles, 0 cracked edges");
    says_nothing(&harness);
}

/// Waits for something that isn't waited for by `settle`.
fn wait_for_label(harness: &mut Harness<App>, label: &str) {
    let start = Instant::now();
    while harness.query_by_label(label).is_none() {
        assert!(start.elapsed() < PATIENCE, "there is no {label}");
        std::thread::sleep(Duration::from_millis(20));
        settle(harness);
    }
}

#[test]
fn a_file_dropped_while_another_loads_wins() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = copy_vase(&folder, "a.glb");
    let mut harness = uniform(None);
    open(&mut harness, slow());
    drop_files(&mut harness, std::slice::from_ref(&path));
    settle(&mut harness);
    assert_eq!(harness.state().source(), Some(&Source::File(path)));
    says_nothing(&harness);
}

#[test]
fn folders_pipes_and_devices_are_refused_by_name() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let mut harness = uniform(Some(vase()));
    let mut refuses = |path: PathBuf, expected: &str| {
        drop_files(&mut harness, std::slice::from_ref(&path));
        settle(&mut harness);
        harness.get_by_label_contains(expected);
        assert_eq!(harness.state().source(), Some(&vase()), "the old mesh stays");
        click(&mut harness, "Close");
    };
    let inside = folder.path().join("models.glb");
    std::fs::create_dir(&inside).expect("a writable folder");
    refuses(inside, "models.glb is not a file");
    if cfg!(unix) {
        for name in ["pipe.glb", "pipe.png"] {
            let pipe = folder.path().join(name);
            let made = std::process::Command::new("mkfifo").arg(&pipe).status();
            assert!(made.is_ok_and(|made| made.success()));
            let is_mesh = name.ends_with("glb");
            refuses(pipe, if is_mesh { "pipe.glb is not a file" } else { "pipe.png" });
        }
        let device = folder.path().join("zero.stl");
        std::os::unix::fs::symlink("/dev/zero", &device).expect("a writable folder");
        refuses(device, "zero.stl is not a file");
    }
}

#[test]
fn reloading_a_missing_file_keeps_the_mesh() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = copy_vase(&folder, "a.glb");
    let mut harness = uniform(Some(Source::File(path.clone())));
    let (camera, totals) = (*harness.state().camera(), harness.state().totals());
    std::fs::remove_file(&path).expect("it is there");
    press(&mut harness, egui::Key::R);
    harness.get_by_label_contains("a.glb can't be read");
    assert_eq!((*harness.state().camera(), harness.state().totals()), (camera, totals));
    assert_eq!(harness.state().source(), Some(&Source::File(path.clone())));
    copy_vase(&folder, "a.glb");
    click(&mut harness, "Close");
    press(&mut harness, egui::Key::R);
    says_nothing(&harness);
}

#[test]
fn a_file_that_changes_while_it_is_loaded_is_refused_or_read_whole() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = folder.path().join("a.glb");
    let Source::File(vase) = vase() else { unreachable!("it is a file") };
    let whole = std::fs::read(vase).expect("the vase");
    std::fs::write(&path, &whole).expect("a writable folder");
    let mut harness = uniform(Some(Source::File(path.clone())));
    let patches = harness.state().loaded().map(|loaded| loaded.topology.patches.len());
    for k in 0..40 {
        harness.key_press(egui::Key::R);
        harness.run_steps(1);
        let part = if k % 2 == 0 { &whole[..whole.len() * k / 40] } else { &whole[..] };
        std::fs::write(&path, part).expect("a writable folder");
        settle(&mut harness);
        assert_eq!(
            harness.state().loaded().map(|loaded| loaded.topology.patches.len()),
            patches,
            "never a mix of two versions"
        );
        assert!(harness.query_by_label_contains("stopped unexpectedly").is_none());
    }
    press(&mut harness, egui::Key::R);
    says_nothing(&harness);
}

#[test]
fn after_cancelling_the_first_load_another_file_can_be_opened() {
    let mut harness = crate::open(Harness::builder().with_size([1200.0, 960.0]), Some(slow()), |_, _| ());
    harness.run_steps(2);
    click(&mut harness, STOP);
    assert_eq!(harness.state().source(), None);
    open(&mut harness, vase());
    settle(&mut harness);
    assert_eq!(harness.state().source(), Some(&vase()));
}

//! The table of commands: its keys, menus and search, and what the commands do.

use documents::moving;
use std::path::Path;
use std::time::Instant;

use egui::accesskit::Role;
use egui::{Key, KeyboardShortcut, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use geometry::mesh::Shape;
use geometry::progress::Progress;
use geometry::tessellate::{Edges, Lod, Surface};
use inspect::engine::Preparation;
use inspect::settings::Settings;
use load::{HeightSource, Source};
use pnaen::app::App;
use pnaen::commands::{Action, Change, Command, FileAction, GESTURES, Menu, Place, all};
use tempfile::TempDir;

use crate::driver::PATIENCE;
use crate::{choose, click, open, press, run_command, settle, switch, uniform, window};

fn commands(harness: &Harness<App>) -> Vec<Command> {
    all(&harness.state().availability())
}

/// Performs the command of this name.
fn give(harness: &mut Harness<App>, name: &str) {
    let commands = commands(harness);
    let command = commands.iter().find(|command| command.name == name).unwrap_or_else(|| panic!("no command {name}"));
    let context = harness.ctx.clone();
    harness.state_mut().give(&context, command);
    settle(harness);
}

fn press_shortcut(harness: &mut Harness<App>, key: &KeyboardShortcut) {
    harness.key_press_modifiers(key.modifiers, key.logical_key);
    harness.run_steps(3);
}

/// A window in which every command with a key is possible once a triangle is selected: an animated mesh with heights,
/// uniform LOD and a change that can be undone.
fn full_window(folder: &TempDir) -> Harness<'static, App> {
    let path = folder.path().join("moving.glb");
    std::fs::write(&path, moving::moving()).expect("a writable temporary folder");
    let mut harness = uniform(Some(Source::File(path)));
    let context = harness.ctx.clone();
    let waves = HeightSource::File(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/waves.png").into());
    harness.state_mut().displace(&context, Some(waves));
    settle(&mut harness);
    harness
}

/// Waits for the window in which a path is typed if the desktop has no dialog, so that the test can close it.
fn wait_for_dialog(harness: &mut Harness<App>) {
    let start = Instant::now();
    while harness.state().path_asked_for().is_none() && start.elapsed().as_secs() < 5 {
        std::thread::sleep(std::time::Duration::from_millis(20));
        harness.step();
    }
}

#[test]
fn every_key_of_the_table_gives_its_command() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let mut harness = full_window(&folder);
    let mut pressed = 0;
    // These open another mesh, without what belongs to this one.
    let neighbours = [FileAction::NextMesh, FileAction::PreviousMesh].map(Action::File);
    let is_tried = |command: &&Command| !command.keys.is_empty() && !neighbours.contains(&command.action);
    for command in commands(&harness).iter().filter(is_tried) {
        for key in &command.keys {
            // Another command first, so that the last action changes.
            let other = if command.action == Action::Cancel { Key::W } else { Key::Escape };
            press_shortcut(&mut harness, &KeyboardShortcut::new(Modifiers::NONE, other));
            harness.state_mut().select_triangle(Some(0));
            assert_ne!(harness.state().last_action(), Some(&command.action), "{}", command.name);
            // Some commands need a picture, and what the key before did may still be drawn.
            if command.why_not(&harness.state().availability()).is_some() {
                settle(&mut harness);
            }
            let why_not = command.why_not(&harness.state().availability());
            assert_eq!(why_not, None, "{}", command.name);
            press_shortcut(&mut harness, key);
            assert_eq!(harness.state().last_action(), Some(&command.action), "{}: {key:?}", command.name);
            pressed += 1;
            if matches!(&command.action, Action::File(FileAction::Ask(_))) {
                wait_for_dialog(&mut harness);
            }
            if command.action == Action::PlayOrPause {
                assert!(harness.state().is_playing());
                harness.state_mut().choose_clip(None);
            }
            // Without the panels the picture has another size, and is drawn anew. Undo loads the mesh anew, which Escape would stop.
            let loads = [Action::File(FileAction::Reload), Action::HidePanels, Action::Undo, Action::Redo];
            if loads.contains(&command.action) {
                settle(&mut harness);
            }
        }
    }
    assert!(pressed > 45, "{pressed}");
}

#[test]
fn a_key_does_nothing_if_its_command_is_not_possible() {
    let mut harness = window(None);
    assert_eq!(harness.state().settings().tessellation.lod, Lod::Error);
    let before = *harness.state().settings();
    for key in [Key::Plus, Key::Minus, Key::D, Key::Space] {
        press(&mut harness, key);
        let (settings, last) = (harness.state().settings(), harness.state().last_action());
        assert_eq!((settings, last), (&before, Some(&Action::OpenAllSections)), "{key:?}");
    }
    choose(&mut harness, "LOD", "Uniform");
    press(&mut harness, Key::Plus);
    assert_eq!(harness.state().last_action(), Some(&Action::Setting(Change::FactorUp)));
    assert_eq!(harness.state().settings().tessellation.factor, before.tessellation.factor + 1.0);
}

/// The names of all buttons and boxes.
fn clickable(harness: &Harness<App>) -> Vec<String> {
    let roles = [Role::Button, Role::CheckBox, Role::RadioButton];
    let nodes = roles.iter().flat_map(|&role| harness.query_all_by_role(role));
    nodes.filter_map(|node| node.accesskit_node().label()).collect()
}

#[test]
fn menus_have_exactly_the_commands_of_the_table() {
    let mut harness = window(None);
    let before = clickable(&harness).len();
    for menu in Menu::ALL {
        harness.get_by_role_and_label(Role::Button, menu.name()).click();
        settle(&mut harness);
        let shown = clickable(&harness);
        let in_menu = |command: &Command| matches!(command.place, Some(Place::Menu(of, _)) if of == menu);
        let mut names: Vec<String> = commands(&harness)
            .iter()
            .filter(|command| in_menu(command))
            .map(|command| command.name.to_string())
            .collect();
        names.extend(menu.submenus().iter().map(|(_, submenu)| submenu.name().to_owned()));
        for name in &names {
            // A button's name is followed by its key.
            let is_it = |label: &String| {
                label.strip_prefix(name.as_str()).is_some_and(|rest| !rest.starts_with(char::is_alphanumeric))
            };
            assert!(shown.iter().any(is_it), "{name} is not in {}: {shown:?}", menu.name());
        }
        assert_eq!(shown.len() - before, names.len(), "{}: {shown:?}", menu.name());
        press(&mut harness, Key::Escape);
        assert_eq!(clickable(&harness).len(), before);
    }
}

#[test]
fn the_search_shows_why_a_command_is_not_possible() {
    let mut harness = window(None);
    give(&mut harness, "Search commands…");
    harness.get_by_role_and_label(Role::TextInput, "Search commands").type_text("factor up");
    settle(&mut harness);
    let row = harness.get_by_label_contains("Factor up");
    assert!(row.accesskit_node().is_disabled());
    let place = row.rect().center();
    harness.hover_at(place);
    harness.run_steps(60);
    assert!(harness.query_by_label_contains("Not now: Adaptive LOD").is_some());
    let factor = harness.state().settings().tessellation.factor;
    press(&mut harness, Key::Enter);
    assert_eq!(harness.state().settings().tessellation.factor, factor);
    assert!(harness.query_by_label("Search commands").is_some(), "the search stays open");
}

#[test]
fn values_tolerances_and_resets_are_commands() {
    let mut harness = window(Some(Source::Shape(Shape::CubeSplit)));
    let opening = *harness.state().settings();
    for name in
        ["Surface: Nagata AEN", "LOD: Distance", "Shared edges: By each patch", "Colours: Factors", "Cull back faces"]
    {
        give(&mut harness, name);
    }
    let settings = *harness.state().settings();
    assert_eq!(
        (settings.tessellation.surface, settings.tessellation.lod, settings.tessellation.edges),
        (Surface::NagataAen, Lod::Distance, Edges::AsPublished)
    );
    assert_eq!(settings.tessellation.cull_back_faces, !opening.tessellation.cull_back_faces);
    give(&mut harness, "Reset settings");
    assert_eq!(*harness.state().settings(), Settings::opening());
    give(&mut harness, "Undo");
    assert_eq!(*harness.state().settings(), settings);
    let preparation = |harness: &Harness<App>| harness.state().loaded().expect("a cube").preparation.clone();
    give(&mut harness, "Weld: 1e-4");
    give(&mut harness, "Crease band: On");
    assert_eq!((preparation(&harness).weld, preparation(&harness).crease_band), (1e-4, 0.02));
    give(&mut harness, "Weld: Exact");
    give(&mut harness, "Crease band: Off");
    assert_eq!((preparation(&harness).weld, preparation(&harness).crease_band), (0.0, 0.0));
}

#[test]
fn every_clip_is_a_command() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let mut harness = full_window(&folder);
    for (i, clip) in moving::CLIPS.iter().enumerate() {
        give(&mut harness, &format!("Animation: {clip}"));
        assert_eq!(harness.state().moment().map(|moment| moment.clip), Some(i));
    }
    give(&mut harness, "Animation: Rest pose");
    assert_eq!(harness.state().moment(), None);
}

#[test]
fn the_background_window_changes_the_colour() {
    let mut harness = window(None);
    give(&mut harness, "Background colour…");
    assert!(harness.query_by_role_and_label(Role::Window, "Background colour").is_some());
    assert_eq!(harness.state().settings().background, None, "the theme chooses");
    let [red, _, blue] = harness.state().settings().background_color();
    harness.get_by_role_and_label(Role::Slider, "Green").set_value_accesskit(200.0);
    settle(&mut harness);
    assert_eq!(harness.state().settings().background, Some([red, 200, blue]));
    harness.get_by_role_and_label(Role::Window, "Background colour").get_by_label("As the theme").click();
    settle(&mut harness);
    assert_eq!(harness.state().settings().background, None);
    press(&mut harness, Key::Escape);
    assert!(harness.query_by_role_and_label(Role::Window, "Background colour").is_none());
}

#[test]
fn the_keys_fit_a_small_screen_and_are_scrolled() {
    let mut harness = open(Harness::builder().with_size([1280.0, 720.0]), None, |_, _| ());
    settle(&mut harness);
    give(&mut harness, "Keys…");
    let list = harness.get_by_role_and_label(Role::Window, "Keys").rect();
    assert!(list.top() >= 0.0 && list.bottom() <= 720.0, "{list:?}");
    let (gesture, _) = GESTURES[0];
    assert!(list.contains(harness.get_by_label(gesture).rect().center()));
    let last = commands(&harness).into_iter().rfind(|command| !command.keys.is_empty()).expect("a command with a key");
    let row = |harness: &Harness<App>| {
        let rows: Vec<_> = harness.query_all_by_label(&last.name).map(|node| node.rect()).collect();
        rows.into_iter().find(|row| list.contains(row.center()))
    };
    assert!(row(&harness).is_none(), "the last row isn't visible before scrolling");
    harness.hover_at(list.center());
    harness.event(egui::Event::MouseWheel {
        unit: egui::MouseWheelUnit::Point,
        delta: egui::vec2(0.0, -5000.0),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Wheel,
        modifiers: Modifiers::NONE,
    });
    harness.run_steps(60);
    assert!(row(&harness).is_some(), "{}", last.name);
}

/// The command that opens the window that chooses how a picture is saved.
const SAVE_PICTURE: &str = "Save picture…";

/// Performs a command that asks for a path where there is no file dialog, and types the path.
fn write_as(harness: &mut Harness<App>, command: &str, path: &Path) {
    give(harness, command);
    if command == SAVE_PICTURE {
        click(harness, "Save…");
    }
    wait(harness, |app| app.path_asked_for().is_some());
    harness.run_steps(2);
    // Typing replaces the proposed path.
    harness.get_by_role(Role::TextInput).type_text(&path.display().to_string());
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    harness.run_steps(3);
    wait(harness, |app| !app.is_writing());
    settle(harness);
}

fn wait(harness: &mut Harness<App>, until: impl Fn(&App) -> bool) {
    let start = Instant::now();
    while !until(harness.state()) {
        assert!(start.elapsed() < PATIENCE, "it takes too long");
        std::thread::sleep(std::time::Duration::from_millis(2));
        harness.step();
    }
}

#[test]
fn the_picture_is_saved_as_it_is_shown() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let mut harness = window(Some(Source::Shape(Shape::Torus)));
    let path = folder.path().join("torus.png");
    write_as(&mut harness, SAVE_PICTURE, &path);
    let saved = image::open(&path).expect("a picture").to_rgba8();
    assert_eq!(saved, harness.state().read_picture().expect("a device").expect("a picture"));
    assert!(harness.query_by_label_contains("torus.png is written.").is_some());
    press(&mut harness, Key::Escape);
    assert!(harness.query_by_label_contains("is written.").is_none());
    // A typed path never replaces a file.
    press(&mut harness, Key::W);
    write_as(&mut harness, SAVE_PICTURE, &path);
    assert!(harness.query_by_label_contains("torus.png exists already").is_some());
    assert_eq!(image::open(&path).expect("a picture").to_rgba8(), saved);
    press(&mut harness, Key::Escape);
    write_as(&mut harness, SAVE_PICTURE, &folder.path().join("torus.jpg"));
    assert!(harness.query_by_label_contains("torus.jpg: the name must end in .png").is_some());
    assert!(!folder.path().join("torus.jpg").exists());
}

#[test]
fn an_exported_mesh_is_the_one_that_the_command_writes() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    let (_, triangles) = harness.state().totals().expect("a torus");
    for name in ["torus.glb", "torus.obj"] {
        let path = folder.path().join(name);
        write_as(&mut harness, "Export mesh…", &path);
        assert!(harness.query_by_label_contains(&format!("{name} is written.")).is_some());
        assert!(harness.query_by_label_contains("aren't in the file").is_none(), "all patches are written");
        press(&mut harness, Key::Escape);
        let written = inspect::engine::load(&Source::File(path.clone()), &Preparation::default(), &Progress::default())
            .expect("what was written");
        assert_eq!(written.mesh.triangles.len() as u64, triangles, "{name}");
        let command = folder.path().join(format!("command-{name}"));
        let settings = ["--factor", "8", "--partitioning", "fractional-odd"];
        run_command(["tessellate", "shape:torus"].into_iter().chain(settings), &command);
        assert!(
            std::fs::read(&command).expect("a file") == std::fs::read(&path).expect("a file"),
            "{name} differs from the command's file"
        );
    }
    write_as(&mut harness, "Export mesh…", &folder.path().join("torus.ply"));
    assert!(harness.query_by_label_contains("torus.ply: the name must end in").is_some());
}

#[test]
fn an_export_says_how_many_patches_are_left_out() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    switch(&mut harness, "Cull back faces");
    settle(&mut harness);
    write_as(&mut harness, "Export mesh…", &folder.path().join("torus.glb"));
    harness.get_by_label_contains("of 256 patches aren't drawn in this view, and aren't in the file.");
}

#[test]
fn an_export_that_is_cancelled_writes_nothing() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    // So many triangles take longer to write than a frame takes, however busy the machine is.
    harness.get_by_role_and_label(Role::Slider, "Factor").set_value_accesskit(32.0);
    settle(&mut harness);
    let (context, path) = (harness.ctx.clone(), folder.path().join("torus.obj"));
    harness.state_mut().export_mesh(&context, path.clone()).expect("an .obj file");
    harness.step();
    assert!(harness.query_by_label_contains("Exporting torus.obj").is_some());
    press(&mut harness, Key::Escape);
    assert!(!harness.state().is_writing());
    // A second export takes as long as the first one would have taken.
    harness.state_mut().export_mesh(&context, folder.path().join("second.obj")).expect("an .obj file");
    wait(&mut harness, |app| !app.is_writing());
    assert!(folder.path().join("second.obj").exists() && !path.exists());
}

//! Saving what the window shows: pictures and turntables, and that commands draw the same; factors, adjacency and stats.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;
use std::time::Instant;

use egui::Key;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use geometry::mesh::Shape;
use image::RgbaImage;
use inspect::settings::Colors;
use load::Source;
use pnaen::app::App;
use tempfile::TempDir;

use super::{PATIENCE, STOP, choose, click, press, run_command, settle, uniform, window};

fn folder() -> TempDir {
    tempfile::tempdir().expect("a writable temporary folder")
}

pub(super) fn wait(harness: &mut Harness<App>, until: impl Fn(&App) -> bool) {
    let start = Instant::now();
    while !until(harness.state()) {
        assert!(start.elapsed() < PATIENCE, "it takes too long");
        std::thread::sleep(std::time::Duration::from_millis(2));
        harness.step();
    }
}

/// Gives a command by its name.
fn give(harness: &mut Harness<App>, name: &str) {
    let all = pnaen::commands::all(&harness.state().availability());
    let command = all.iter().find(|command| command.name == name).unwrap_or_else(|| panic!("no command {name}"));
    let context = harness.ctx.clone();
    harness.state_mut().give(&context, command);
    harness.run_steps(3);
}

/// Types the path that a command asks for where there is no file dialog, and waits until the file is written.
fn write_to(harness: &mut Harness<App>, path: &Path) {
    wait(harness, |app| app.path_asked_for().is_some());
    harness.run_steps(2);
    harness.get_by_role(Role::TextInput).type_text(&path.display().to_string());
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    harness.run_steps(3);
    wait(harness, |app| !app.is_writing());
    harness.run_steps(2);
    let name = path.file_name().expect("a name").to_string_lossy().into_owned();
    assert!(harness.query_by_label_contains(&format!("{name} is written.")).is_some(), "{name}");
    press(harness, Key::Escape);
}

fn ctrl_s(harness: &mut Harness<App>) {
    harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::S);
    harness.run_steps(3);
}

/// Types a number of px into a field.
fn type_px(harness: &mut Harness<App>, field: &str, px: u32) {
    harness.get_by_role_and_label(Role::SpinButton, field).set_value_accesskit(f64::from(px));
    harness.run_steps(3);
}

fn value(harness: &Harness<App>, field: &str) -> Option<f64> {
    harness.get_by_role_and_label(Role::SpinButton, field).accesskit_node().numeric_value()
}

/// Saves the picture with the choices that were made.
fn save(harness: &mut Harness<App>, path: &Path) -> RgbaImage {
    let context = harness.ctx.clone();
    harness.state_mut().save_picture(&context, path.to_owned()).expect("a PNG file");
    assert!(harness.state().is_writing());
    wait(harness, |app| !app.is_writing());
    harness.run_steps(2);
    image::open(path).expect("a picture").to_rgba8()
}

/// The words of the command that a PNG file holds.
fn command_in(path: &Path) -> Vec<String> {
    let mut reader =
        png::Decoder::new(BufReader::new(File::open(path).expect("a file"))).read_info().expect("a PNG file");
    reader.finish().expect("a whole file");
    let texts = &reader.info().uncompressed_latin1_text;
    let command = texts.iter().find(|chunk| chunk.keyword == "pnaen command").expect("a command");
    command.text.split(' ').map(str::to_owned).collect()
}

/// Draws the picture of the command that a PNG file holds.
fn drawn_again(path: &Path) -> RgbaImage {
    let mut words = command_in(path);
    let output = words.iter().position(|word| word == "-o").expect("an output");
    assert_eq!(words[output + 1], path.file_name().expect("a name").to_string_lossy());
    words.drain(output..output + 2);
    let again = path.with_file_name("again.png");
    run_command(words[1..].iter().map(String::as_str), &again);
    image::open(&again).expect("the command's picture").to_rgba8()
}

#[test]
fn the_window_of_pictures_proposes_the_size_of_the_view_and_remembers_choices() {
    let mut harness = window(Some(Source::Shape(Shape::Torus)));
    click(&mut harness, "Save picture");
    let shown = harness.state().read_picture().expect("a device").expect("a picture").dimensions();
    assert_eq!((value(&harness, "Width"), value(&harness, "Height")), (Some(shown.0.into()), Some(shown.1.into())));
    let legend = harness.get_by_role_and_label(Role::CheckBox, "With legend");
    assert!(legend.accesskit_node().is_disabled(), "the mesh's own colours have no legend");
    type_px(&mut harness, "Width", 321);
    click(&mut harness, "Transparent");
    press(&mut harness, Key::Escape);
    assert!(harness.query_by_label("With legend").is_none(), "Esc closes it");
    ctrl_s(&mut harness);
    assert_eq!((value(&harness, "Width"), value(&harness, "Height")), (Some(321.0), Some(shown.1.into())));
    let is_on = |harness: &Harness<App>, name| {
        let toggled = harness.get_by_role_and_label(Role::RadioButton, name).accesskit_node().toggled();
        toggled == Some(egui::accesskit::Toggled::True)
    };
    assert!(is_on(&harness, "Transparent") && !is_on(&harness, "As shown"));
    click(&mut harness, "Size of the view");
    assert_eq!(value(&harness, "Width"), Some(shown.0.into()));
    // A side of 0 px, or of more than commands take, can't be typed.
    type_px(&mut harness, "Width", 1_000_000);
    assert_eq!(value(&harness, "Width"), Some(16384.0));
}

#[test]
fn the_button_asks_for_a_path_and_closes_the_window() {
    let mut harness = window(None);
    ctrl_s(&mut harness);
    click(&mut harness, "Save…");
    assert!(harness.query_by_label("With overlays").is_none());
    wait(&mut harness, |app| app.path_asked_for().is_some());
    assert_eq!(harness.state().path_asked_for().map(|(title, _)| title), Some("Save picture"));
}

#[test]
fn a_saved_picture_is_the_one_that_is_shown_and_that_its_command_draws() {
    let folder = folder();
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    let shown = |harness: &Harness<App>| harness.state().read_picture().expect("a device").expect("a picture");
    let path = folder.path().join("plain.png");
    assert!(save(&mut harness, &path) == shown(&harness), "the plain picture");
    assert!(drawn_again(&path) == shown(&harness), "the plain command");
    press(&mut harness, Key::W);
    press(&mut harness, Key::Num3);
    harness.state_mut().select_triangle(Some(3));
    settle(&mut harness);
    let path = folder.path().join("wires.png");
    let saved = save(&mut harness, &path);
    assert!(saved == shown(&harness), "wires and a selected triangle");
    assert!(drawn_again(&path) == saved, "their command");
}

#[test]
fn a_picture_of_another_size_without_background_is_the_one_that_its_command_draws() {
    let folder = folder();
    let mut harness = window(Some(Source::Shape(Shape::Torus)));
    choose(&mut harness, "Colours", "Factors");
    press(&mut harness, Key::W);
    ctrl_s(&mut harness);
    type_px(&mut harness, "Width", 360);
    type_px(&mut harness, "Height", 240);
    for choice in ["Transparent", "With legend"] {
        click(&mut harness, choice);
    }
    let path = folder.path().join("small.png");
    let saved = save(&mut harness, &path);
    assert_eq!(saved.dimensions(), (360, 240));
    assert_eq!((saved.get_pixel(1, 1).0, saved.get_pixel(349, 229).0[3]), ([0; 4], 255), "nothing, and the legend");
    let words = command_in(&path);
    for word in ["--transparent", "--legend", "360x240", "wireframe,factors"] {
        assert!(words.iter().any(|own| own == word), "{word} is not in {words:?}");
    }
    assert!(drawn_again(&path) == saved);
    press(&mut harness, Key::Escape);
    ctrl_s(&mut harness);
    click(&mut harness, "With overlays");
    let path = folder.path().join("bare.png");
    let bare = save(&mut harness, &path);
    assert!(!command_in(&path).iter().any(|word| word == "--overlay"), "{:?}", command_in(&path));
    assert!(bare != saved && drawn_again(&path) == bare);
    assert_eq!(harness.state().settings().overlays.colors, Colors::Factors, "the window's overlays stay");
}

#[test]
fn saving_a_picture_shows_its_progress_and_can_be_cancelled() {
    let folder = folder();
    let mut harness = window(Some(Source::Shape(Shape::Torus)));
    let (context, path) = (harness.ctx.clone(), folder.path().join("large.png"));
    save_large(&mut harness, &path);
    let command = pnaen::commands::all(&harness.state().availability())
        .into_iter()
        .find(|command| command.name == "Save picture…")
        .expect("a command");
    assert_eq!(command.why_not(&harness.state().availability()), Some("Another file is being written."));
    click(&mut harness, STOP);
    assert!(!harness.state().is_writing());
    // The second takes as long as the first would have taken.
    harness.state_mut().save_picture(&context, folder.path().join("second.png")).expect("a PNG file");
    wait(&mut harness, |app| !app.is_writing());
    assert!(folder.path().join("second.png").exists() && !path.exists());
    assert_eq!(std::fs::read_dir(folder.path()).expect("a folder").count(), 1, "nothing else is left");
}

/// Starts to save a picture that takes a while.
fn save_large(harness: &mut Harness<App>, path: &Path) {
    ctrl_s(harness);
    type_px(harness, "Width", 3000);
    type_px(harness, "Height", 3000);
    press(harness, Key::Escape);
    let context = harness.ctx.clone();
    harness.state_mut().save_picture(&context, path.to_owned()).expect("a PNG file");
    harness.step();
    harness.get_by_label("Saving large.png");
}

#[test]
fn escape_stops_what_is_saved_and_says_so_for_a_while() {
    let folder = folder();
    let path = folder.path().join("large.png");
    let mut harness = window(Some(Source::Shape(Shape::Torus)));
    harness.state_mut().select_triangle(Some(3));
    save_large(&mut harness, &path);
    harness.key_press(Key::Escape);
    harness.run_steps(3);
    assert!(!harness.state().is_writing());
    harness.get_by_label("Stopped: Saving large.png.");
    assert!(harness.query_by_label(STOP).is_none());
    assert_eq!(harness.state().selected_triangle(), Some(3), "the key does one thing at a time");
    // By itself it goes, and the status line has its numbers again.
    pass(&mut harness, 11.0);
    assert!(harness.query_by_label_contains("Stopped:").is_none());
    harness.get_by_label_contains("256 to ");
    assert!(!path.exists());
}

/// Lets some seconds pass by the window's clock. The window asks for the frame that comes then.
fn pass(harness: &mut Harness<App>, seconds: f64) {
    let until = harness.ctx.input(|input| input.time) + seconds;
    while harness.ctx.input(|input| input.time) < until {
        harness.step();
    }
}

#[test]
fn what_was_written_is_said_for_a_while_and_not_over_the_next_file() {
    let folder = folder();
    let mut harness = window(Some(Source::Shape(Shape::Torus)));
    // The preview that is drawn out of sight when the window has rested for a while would draw the window, too.
    crate::warm_up::wait(&mut harness, std::time::Duration::from_millis(500));
    save(&mut harness, &folder.path().join("torus.png"));
    assert!(harness.query_by_role_and_label(Role::Window, "Written").is_none(), "nothing lies over the picture");
    harness.get_by_label_contains("torus.png is written.");
    pass(&mut harness, 3.0);
    let next = harness.output().viewport_output[&egui::ViewportId::ROOT].repaint_delay;
    assert!(!next.is_zero() && next.as_secs() < 10, "nothing is drawn until it is to go: {next:?}");
    harness.get_by_label_contains("torus.png is written.");
    pass(&mut harness, 8.0);
    assert!(harness.query_by_label_contains("is written").is_none());
    save(&mut harness, &folder.path().join("again.png"));
    harness.get_by_label_contains("again.png is written.");
    let context = harness.ctx.clone();
    harness.state_mut().open(&context, Source::Shape(Shape::Icosphere));
    harness.run_steps(2);
    assert!(harness.query_by_label_contains("is written").is_none());
}

#[test]
fn a_turntable_is_saved_as_the_pictures_that_the_command_draws() {
    let folder = folder();
    let mut harness = window(Some(Source::Shape(Shape::CubeSplit)));
    give(&mut harness, "Save turntable…");
    for (field, number) in [("Pictures", 3), ("Width", 96), ("Height", 72)] {
        type_px(&mut harness, field, number);
    }
    let turn = folder.path().join("turn");
    click(&mut harness, "Save…");
    write_to(&mut harness, &turn);
    let names = |folder: &Path| {
        let all = std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").file_name());
        let mut names: Vec<_> = all.map(|name| name.into_string().expect("UTF-8")).collect();
        names.sort();
        names
    };
    assert_eq!(names(&turn), ["frame-0000.png", "frame-0001.png", "frame-0002.png"]);
    assert_eq!(names(folder.path()), ["turn"], "nothing half written stays");
    let second = turn.join("frame-0001.png");
    let picture = image::open(&second).expect("a picture").to_rgba8();
    assert_eq!(picture.dimensions(), (96, 72));
    assert!(drawn_again(&second) == picture, "the command in the file draws the same");
    // The choices are remembered, and a GIF asks for another ending.
    give(&mut harness, "Save turntable…");
    assert_eq!(value(&harness, "Pictures"), Some(3.0));
    click(&mut harness, "Animated GIF");
    type_px(&mut harness, "Pictures a second", 10);
    click(&mut harness, "Copy as command");
    harness.get_by_label_contains("pnaen turntable shape:cube-split -o cube-split-turntable.gif --frames 3 --fps 10");
    click(&mut harness, "Save…");
    write_to(&mut harness, &folder.path().join("turn.gif"));
    let gif = std::fs::read(folder.path().join("turn.gif")).expect("a file");
    assert!(gif.starts_with(b"GIF89a") && gif.ends_with(&[0x3b]), "a whole GIF file");
    let context = harness.ctx.clone();
    let said = harness.state_mut().save_turntable(&context, folder.path().join("turn.png"));
    assert!(said.is_err_and(|why| why.contains("must end in .gif")));
}

#[test]
fn a_turntable_that_is_cancelled_leaves_nothing() {
    let folder = folder();
    let mut harness = window(Some(Source::Shape(Shape::Torus)));
    give(&mut harness, "Save turntable…");
    type_px(&mut harness, "Pictures", 500);
    press(&mut harness, Key::Escape);
    let context = harness.ctx.clone();
    harness.state_mut().save_turntable(&context, folder.path().join("turn")).expect("a folder");
    let begun = || std::fs::read_dir(folder.path()).expect("a folder").count();
    wait(&mut harness, |_| begun() > 0);
    assert!(harness.query_by_label_contains("Saving turn").is_some());
    click(&mut harness, STOP);
    let start = Instant::now();
    while begun() > 0 {
        assert!(start.elapsed() < PATIENCE, "its folder stays");
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
}

#[test]
fn a_free_name_beside_the_last_file_is_proposed() {
    let folder = folder();
    let mut harness = window(Some(Source::Shape(Shape::CubeSplit)));
    let path = |name: &str| folder.path().join(name);
    give(&mut harness, "Save adjacency…");
    write_to(&mut harness, &path("own.json"));
    for name in ["Cube,-split-normals-adjacency.json", "Cube,-split-normals-adjacency-2.json"] {
        give(&mut harness, "Save adjacency…");
        wait(&mut harness, |app| app.path_asked_for().is_some());
        harness.run_steps(2);
        let proposed = harness.get_by_role(Role::TextInput).accesskit_node().value();
        assert_eq!(proposed, Some(path(name).display().to_string()));
        std::fs::write(path(name), "").expect("a writable temporary folder");
        click(&mut harness, "Cancel");
    }
}

#[test]
fn saved_factors_adjacency_and_stats_are_those_of_the_commands() {
    let folder = folder();
    let mut harness = window(Some(Source::Shape(Shape::Torus)));
    let command = folder.path().join("view.png");
    save(&mut harness, &command);
    // The options of the view, without those of the picture.
    let words: Vec<String> = command_in(&command)[5..].to_vec();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let bytes = |path: &Path| std::fs::read(path).expect("a file");
    for (name, file, arguments) in [
        ("Save factors…", "own.csv", [&["factors", "shape:torus"], &words[..]].concat()),
        ("Save adjacency…", "own.json", vec!["adjacency", "shape:torus"]),
        ("Save adjacency…", "own.bin", vec!["adjacency", "shape:torus"]),
    ] {
        let own = folder.path().join(file);
        press(&mut harness, Key::Escape);
        give(&mut harness, name);
        write_to(&mut harness, &own);
        let expected = folder.path().join(file.replace("own", "command"));
        run_command(arguments, &expected);
        assert!(bytes(&own) == bytes(&expected) && bytes(&own).len() > 100, "{file} differs from the command's");
    }
    let own = folder.path().join("stats.json");
    give(&mut harness, "Save stats…");
    write_to(&mut harness, &own);
    let expected = folder.path().join("expected.json");
    let stats = ["--stats", expected.to_str().expect("a path in UTF-8")];
    run_command([&["render", "shape:torus"], &words[..], &stats].concat(), &folder.path().join("again.png"));
    let read = |path: &Path| {
        let mut stats: serde_json::Value = serde_json::from_slice(&bytes(path)).expect("JSON");
        // Times differ from run to run.
        let ms = stats.as_object_mut().and_then(|stats| stats.remove("ms"));
        assert!(ms.is_some_and(|ms| ms["draw"].as_f64() > Some(0.0)));
        stats
    };
    assert_eq!(read(&own), read(&expected));
}

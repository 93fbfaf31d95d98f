//! Typing paths: every letter arrives in the text field, and none acts as a shortcut.

use egui::accesskit::Role;
use egui::{Event, Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use pnaen::app::App;

use crate::{click, copy_vase, open_list, press, settle, window};

fn key(key: Key, modifiers: Modifiers) -> Event {
    Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers }
}

/// Letters as a keyboard gives them: a key, and its text.
fn typed(word: &str) -> Vec<Event> {
    let letter = |letter: char| {
        let text = letter.to_string();
        [key(Key::from_name(&text.to_uppercase()).expect("a letter"), Modifiers::NONE), Event::Text(text)]
    };
    word.chars().flat_map(letter).collect()
}

fn field(harness: &Harness<App>) -> Option<String> {
    harness.get_by_role(Role::TextInput).accesskit_node().value()
}

#[test]
fn letters_typed_right_after_the_shortcut_go_into_the_field() {
    let open_path = key(Key::L, Modifiers::COMMAND);
    // All events in one frame, as after a slow frame, and one event per frame.
    for at_once in [true, false] {
        let mut harness = window(None);
        let settings = *harness.state().settings();
        let events = [vec![open_path.clone()], typed("elephant")].concat();
        if at_once {
            harness.input_mut().events.extend(events);
        } else {
            events.into_iter().for_each(|event| harness.event(event));
        }
        settle(&mut harness);
        assert_eq!(harness.state().settings(), &settings, "no letter acts as a shortcut");
        assert_eq!(field(&harness).as_deref(), Some("elephant"));
    }
}

#[test]
fn the_shortcut_pressed_again_among_the_letters_does_no_harm() {
    let open_path = key(Key::L, Modifiers::COMMAND);
    let mut harness = window(None);
    let events = [vec![open_path.clone()], typed("elephant"), vec![open_path], typed("s")].concat();
    // All in one frame, as after a slow one.
    harness.input_mut().events.extend(events);
    settle(&mut harness);
    assert_eq!(field(&harness).as_deref(), Some("elephants"));
}

#[test]
fn keys_and_clicks_in_the_picture_only_close_an_open_list() {
    let mut harness = window(None);
    let (settings, camera) = (*harness.state().settings(), *harness.state().camera());
    let place = harness.get_by_role_and_label(Role::Image, "Viewport").rect().center();
    for press in [Some(Key::W), Some(Key::Num7), None] {
        open_list(&mut harness, "LOD");
        match press {
            Some(key) => harness.key_press(key),
            None => {
                harness.hover_at(place);
                harness.drag_at(place);
                harness.run_steps(1);
                harness.drop_at(place);
            }
        }
        settle(&mut harness);
        assert_eq!((harness.state().settings(), harness.state().camera()), (&settings, &camera), "{press:?}");
        assert_eq!(harness.state().selected_triangle(), None, "{press:?}");
        harness.key_press(Key::Escape);
        settle(&mut harness);
    }
    harness.drag_at(place);
    harness.run_steps(1);
    harness.drop_at(place);
    settle(&mut harness);
    assert!(harness.state().selected_triangle().is_some(), "without a list, a click selects");
}

#[test]
fn a_path_can_be_entered_before_its_window_is_shown() {
    let mut harness = window(None);
    let text = Event::Text("shape:torus".into());
    harness.input_mut().events.extend([key(Key::L, Modifiers::COMMAND), text, key(Key::Enter, Modifiers::NONE)]);
    settle(&mut harness);
    assert_eq!(harness.state().source().map(ToString::to_string).as_deref(), Some("shape:torus"));
    assert!(harness.query_by_role(Role::TextInput).is_none());
}

#[test]
fn the_reference_surfaces_path_can_be_typed_and_tab_reaches_the_buttons() {
    let mut harness = window(None);
    let settings = *harness.state().settings();
    click(&mut harness, "File");
    harness.get_by_label("Reference surface…").click();
    let start = std::time::Instant::now();
    while harness.state().path_asked_for().is_none() {
        assert!(start.elapsed() < crate::driver::PATIENCE, "no path is asked for");
        std::thread::sleep(std::time::Duration::from_millis(2));
        harness.step();
    }
    typed("elephant").into_iter().for_each(|event| harness.event(event));
    settle(&mut harness);
    assert_eq!((field(&harness).as_deref(), harness.state().settings()), (Some("elephant"), &settings));
    // The first says that no name begins like this.
    (0..3).for_each(|_| press(&mut harness, Key::Tab));
    assert!(harness.get_by_role_and_label(Role::Button, "Cancel").accesskit_node().is_focused());
    press(&mut harness, Key::W);
    assert_eq!(harness.state().settings(), &settings, "keys go to the window with the path");
    press(&mut harness, Key::Enter);
    assert!(harness.query_by_role(Role::TextInput).is_none());
}

/// Opens the window for a path, types this in place of what is proposed, and presses a key.
fn type_path(harness: &mut Harness<App>, text: &str, last: Key) {
    harness.input_mut().events.extend([key(Key::L, Modifiers::COMMAND), Event::Text(text.into())]);
    settle(harness);
    press(harness, last);
}

#[test]
fn tab_completes_a_path_and_quotes_and_uris_are_understood() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = copy_vase(&folder, "my vase.glb").display().to_string();
    let mut harness = window(None);
    type_path(&mut harness, &folder.path().join("my").display().to_string(), Key::Tab);
    assert_eq!(field(&harness), Some(path.clone()));
    press(&mut harness, Key::Escape);
    type_path(&mut harness, &format!("\"{}", folder.path().join("my").display()), Key::Tab);
    assert_eq!(field(&harness), Some(format!("\"{path}\"")), "the quote is closed");
    press(&mut harness, Key::Escape);
    for typed in [format!("\"{path}\""), format!("file://{}", path.replace(' ', "%20"))] {
        type_path(&mut harness, "shape:torus", Key::Enter);
        type_path(&mut harness, &typed, Key::Enter);
        assert_eq!(harness.state().source().map(ToString::to_string), Some(path.clone()), "{typed}");
    }
}

#[test]
fn tab_that_cannot_choose_a_name_stays_in_the_field_and_says_so() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let _ = [copy_vase(&folder, "vase-a.glb"), copy_vase(&folder, "vase-b.glb")];
    let begun = folder.path().join("vase-").display().to_string();
    let mut harness = window(None);
    type_path(&mut harness, &begun, Key::Tab);
    harness.get_by_label("These begin like this: vase-a.glb, vase-b.glb.");
    harness.event(Event::Text("b".into()));
    settle(&mut harness);
    assert_eq!(field(&harness), Some(format!("{begun}b")), "the field still has the focus");
    harness.event(Event::Text("x".into()));
    settle(&mut harness);
    assert!(harness.query_by_label_contains("begin like this").is_none());
    press(&mut harness, Key::Tab);
    harness.get_by_label("No file or folder there has a name that begins like this.");
    harness.event(Event::Text("y".into()));
    settle(&mut harness);
    assert_eq!(field(&harness), Some(format!("{begun}bxy")));
}

#[test]
fn what_was_typed_stays_until_it_can_be_opened() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let mut harness = window(None);
    let missing = folder.path().join("vsae.glb").display().to_string();
    type_path(&mut harness, &missing, Key::Enter);
    harness.get_by_label_contains("vsae.glb can't be read: there is no such file");
    assert_eq!(field(&harness), Some(missing.clone()), "it can be mended");
    press(&mut harness, Key::Escape);
    // A file that is there, but no mesh.
    std::fs::write(&missing, "no mesh").expect("a writable temporary folder");
    type_path(&mut harness, &missing, Key::Enter);
    assert!(harness.query_by_role(Role::TextInput).is_none());
    harness.event(key(Key::L, Modifiers::COMMAND));
    settle(&mut harness);
    assert_eq!(field(&harness), Some(missing));
}

#[test]
fn keys_do_not_act_behind_a_window_that_asks() {
    let mut harness = window(None);
    let before = *harness.state().settings();
    click(&mut harness, "File");
    harness.get_by_label_contains("Save picture…").click();
    settle(&mut harness);
    for letter in [Key::W, Key::C, Key::D] {
        harness.key_press(letter);
    }
    settle(&mut harness);
    assert_eq!(*harness.state().settings(), before);
    press(&mut harness, Key::Escape);
    press(&mut harness, Key::W);
    assert!(harness.state().settings().overlays.wireframe, "without the window it acts");
}

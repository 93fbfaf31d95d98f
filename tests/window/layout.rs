//! Where things are in the window: the toolbar, the sections, the verdict, and that nothing moves by itself.

use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use geometry::mesh::Shape;
use geometry::view::project;
use glam::{Vec2, vec2};
use inspect::measure::CrackedEdge;
use inspect::settings::{Colors, Settings};
use load::Source;
use pnaen::app::App;
use tempfile::TempDir;

use crate::editing::press_with;
use crate::{choose, click, open, press, resumed, scroll_to, settle, switch, uniform_of, window};
use documents::moving::{CLIPS, moving};

/// A window of this size that was never open before, with all sections as they are then.
pub(super) fn first_start(size: [f32; 2], source: Option<Source>) -> Harness<'static, App> {
    let mut harness = open(Harness::builder().with_size(size), source, |_, _| ());
    settle(&mut harness);
    harness
}

fn viewport(harness: &Harness<App>) -> egui::Rect {
    harness.get_by_label("Viewport").rect()
}

/// Each cracked edge with the middle of its widest gap in the picture and that gap, in px; and the picture's size.
fn gaps(harness: &Harness<App>) -> (Vec<(u32, Vec2, f64)>, Vec2) {
    let app = harness.state();
    let picture = app.read_picture().expect("a device").expect("a picture");
    let size = vec2(picture.width() as f32, picture.height() as f32);
    let clip_from_object = app.camera().clip_from_object(size, &app.loaded().expect("a mesh").mesh.bounds());
    let gap = |crack: &CrackedEdge| {
        let middle = project(clip_from_object, size, 0.5 * (crack.widest[0] + crack.widest[1]));
        (crack.edge, middle.expect("in front of the eye"), crack.gap_px(clip_from_object, size))
    };
    (app.cracks().expect("measured").cracked().iter().map(gap).collect(), size)
}

/// Does something, and checks that it selects the edge whose gap was the widest in px.
fn selects_the_widest(harness: &mut Harness<App>, act: impl FnOnce(&mut Harness<App>)) {
    let (gaps, _) = gaps(harness);
    act(harness);
    let selected = harness.state().selected_edge();
    let px = gaps.iter().find(|(edge, ..)| Some(*edge) == selected).expect("a cracked edge").2;
    let widest = gaps.iter().map(|gap| gap.2).fold(0.0, f64::max);
    assert!((px - widest).abs() < 1e-3, "{px} px, and the widest has {widest}");
}

#[test]
fn a_first_start_shows_the_vase_split_with_a_line_of_help_until_something_is_done() {
    let mut harness = first_start([1280.0, 720.0], None);
    assert_eq!(harness.state().source(), Some(&Source::Vase));
    assert_eq!(*harness.state().settings(), Settings::greeting());
    assert!(harness.state().greets());
    harness.get_by_label("No cracks");
    press(&mut harness, egui::Key::ArrowLeft);
    assert!(!harness.state().greets(), "the camera was moved");
    press(&mut harness, egui::Key::ArrowRight);
    assert!(!harness.state().greets(), "it doesn't come back");
    assert!(!first_start([1280.0, 720.0], Some(Source::Shape(Shape::Torus))).state().greets());
}

#[test]
fn the_first_file_is_opened_without_the_split_of_a_first_start_and_from_the_usual_side() {
    let mut harness = first_start([1280.0, 720.0], None);
    press(&mut harness, egui::Key::Num7);
    let context = harness.ctx.clone();
    harness.state_mut().open(&context, Source::Shape(Shape::Torus));
    settle(&mut harness);
    assert_eq!(*harness.state().settings(), Settings::opening());
    let fresh = *first_start([1280.0, 720.0], Some(Source::Shape(Shape::Torus))).state().camera();
    let camera = harness.state().camera();
    assert_eq!((camera.azimuth, camera.elevation), (fresh.azimuth, fresh.elevation));
    // What a person has set stays.
    choose(&mut harness, "LOD", "Uniform");
    let settings = *harness.state().settings();
    harness.state_mut().open(&context, Source::Shape(Shape::CubeSplit));
    settle(&mut harness);
    assert_eq!(*harness.state().settings(), settings);
}

#[test]
fn a_number_that_grows_moves_nothing() {
    let mut harness = first_start([1200.0, 600.0], Some(Source::Shape(Shape::Torus)));
    choose(&mut harness, "LOD", "Uniform");
    click(&mut harness, "Waste");
    let before = viewport(&harness);
    let status = |harness: &Harness<App>| {
        // The findings above say how many patches are drawn, too.
        let lowest = |text| {
            let places = harness.get_all_by_label_contains(text).map(|node| node.rect());
            places.max_by(|a, b| a.top().total_cmp(&b.top())).expect("one").left()
        };
        ["of 256 patches", "vertices", "MiB"].map(lowest)
    };
    let fields = status(&harness);
    // A million triangles, all of them below 3 px, whose count and share are a long text.
    harness.get_by_role_and_label(Role::Slider, "Factor").set_value_accesskit(64.0);
    settle(&mut harness);
    let triangles = harness.state().totals().expect("a torus").1;
    assert!(triangles > 500_000, "{triangles}");
    harness.get_by_label_contains("% of triangles below 3 px");
    assert_eq!(viewport(&harness), before);
    assert_eq!(status(&harness), fields);
    let pictures = harness.state().pictures();
    harness.run_steps(10);
    assert_eq!(harness.state().pictures(), pictures, "nothing is drawn when nothing changed");
}

#[test]
fn a_window_of_another_size_shows_the_last_picture_until_the_next_one_and_frames_the_mesh_again() {
    let mut harness = first_start([620.0, 600.0], Some(Source::Vase));
    let distance = harness.state().camera().distance;
    harness.set_size(egui::vec2(1600.0, 1000.0));
    harness.step();
    let middle = harness.render().expect("a picture of the window").get_pixel(790, 540).0;
    assert!(middle[..3].iter().any(|&channel| channel > 60), "{middle:?} is neither vase nor background");
    settle(&mut harness);
    assert!(harness.state().camera().distance < distance, "the mesh takes the room that there is now");
    press(&mut harness, egui::Key::PageUp);
    let near = harness.state().camera().distance;
    harness.set_size(egui::vec2(1000.0, 700.0));
    settle(&mut harness);
    assert_eq!(harness.state().camera().distance, near, "a camera that shows a detail stays");
}

#[test]
fn the_toolbar_switches_what_is_used_every_day() {
    let mut harness = first_start([1280.0, 720.0], Some(Source::Shape(Shape::Torus)));
    let toolbar = ["Split view", "Wireframe", "Cracks", "Freeze LOD camera"];
    let frame = viewport(&harness);
    let picture = harness.render().expect("a picture of the window");
    let beside = picture.get_pixel(frame.left() as u32 + 3, frame.top() as u32 - 6);
    for name in toolbar {
        let button = harness.get_by_role_and_label(Role::CheckBox, name).rect();
        let within = picture.get_pixel(button.left() as u32 + 3, button.center().y as u32);
        assert_ne!(within, beside, "{name} is off, and looks like a button all the same");
    }
    for name in toolbar {
        let button = harness.get_by_role_and_label(Role::CheckBox, name).rect();
        assert!(button.bottom() <= frame.top() && button.left() >= frame.left(), "{name}: {button:?} is not over it");
        switch(&mut harness, name);
    }
    let settings = *harness.state().settings();
    assert!(settings.split.is_some() && settings.overlays.wireframe && settings.overlays.cracks);
    choose(&mut harness, "Colours", "Factors");
    assert_eq!(harness.state().settings().overlays.colors, Colors::Factors);
    assert!(harness.query_by_label("Play or pause").is_none(), "a torus doesn't move");
    harness.get_by_role_and_label(Role::Slider, "Split divider").set_value_accesskit(25.0);
    settle(&mut harness);
    assert_eq!(harness.state().settings().split, Some(0.25));
    let turned = harness.state().camera().distance;
    press(&mut harness, egui::Key::PageUp);
    click(&mut harness, "Frame all");
    assert_eq!(harness.state().camera().distance, turned);
}

#[test]
fn the_play_buttons_start_the_first_clip_from_rest() {
    let (_folder, mut harness) = uniform_of("moving.glb", moving());
    for name in ["Play", "Play or pause"] {
        harness.get_by_role_and_label(Role::Button, name).click();
        harness.run_steps(3);
        assert!(harness.state().is_playing(), "{name}");
        assert_eq!(harness.state().moment().map(|moment| moment.clip), Some(0), "{name}: {}", CLIPS[0]);
        harness.state_mut().choose_clip(None);
        settle(&mut harness);
    }
}

#[test]
fn the_verdict_counts_what_is_wrong_and_leads_there() {
    let mut harness = first_start([1280.0, 720.0], Some(Source::Shape(Shape::CubeSplit)));
    harness.get_by_label("No cracks");
    harness.get_by_label("No folds");
    choose(&mut harness, "Surface", "PN");
    selects_the_widest(&mut harness, |harness| {
        harness.get_by_label_contains("12 cracked edges, widest ").click();
        settle(harness);
    });
    assert!(harness.state().settings().overlays.cracks);
    harness.get_by_label("Worst edges");
    harness.get_by_label("No warnings");
}

#[test]
fn a_crack_that_is_gone_to_is_in_the_middle_of_the_half_that_has_it() {
    let mut harness = first_start([1280.0, 720.0], Some(Source::Shape(Shape::CubeSplit)));
    switch(&mut harness, "Split view");
    choose(&mut harness, "Surface", "PN");
    assert_eq!(harness.state().settings().split, Some(0.5));
    harness.get_by_label_contains("12 cracked edges, widest ").click();
    settle(&mut harness);
    assert_eq!(harness.state().settings().split, Some(0.5), "the divider stays");
    let (gaps, size) = gaps(&harness);
    let selected = harness.state().selected_edge();
    let place = gaps.into_iter().find(|(edge, ..)| Some(*edge) == selected).expect("a cracked edge").1;
    assert!(place.distance(size * vec2(0.75, 0.5)) < 0.1 * size.y, "{place} of {size}");
}

#[test]
fn a_section_that_opens_moves_nothing_sideways() {
    let mut harness = first_start([1280.0, 500.0], Some(Source::Shape(Shape::CubeSplit)));
    let sides = |harness: &Harness<App>| {
        let titles = ["Surface", "Patch"].map(|title| {
            let title = harness.get_by_role_and_label(Role::DisclosureTriangle, title).rect();
            (title.left(), title.right())
        });
        (titles, harness.get_by_role_and_label(Role::ComboBox, "Surface").rect().right())
    };
    let before = sides(&harness);
    assert!((before.1 - before.0[0].1).abs() < 1.0, "lists end where the titles' lines do: {before:?}");
    crate::open_all_sections(&mut harness);
    settle(&mut harness);
    assert_eq!(sides(&harness), before);
}

#[test]
fn the_verdicts_lines_stay_where_they_are() {
    let mut harness = first_start([1280.0, 720.0], Some(Source::Shape(Shape::CubeSplit)));
    let places = |harness: &Harness<App>| harness.get_by_label("Waste").rect().top();
    let before = places(&harness);
    for dim in ["No cracks", "No folds", "No T-junctions", "No patch at the maximum factor", "No warnings"] {
        harness.get_by_label(dim);
    }
    choose(&mut harness, "Surface", "PN");
    harness.get_by_label_contains("12 cracked edges, widest ");
    assert_eq!(places(&harness), before);
}

#[test]
fn the_widest_crack_is_found_by_words() {
    let mut harness = first_start([1280.0, 720.0], Some(Source::Shape(Shape::CubeSplit)));
    choose(&mut harness, "Surface", "PN");
    selects_the_widest(&mut harness, |harness| {
        press_with(harness, egui::Modifiers::COMMAND, egui::Key::P);
        harness.get_by_role(Role::TextInput).type_text("worst");
        settle(harness);
        press(harness, egui::Key::Enter);
    });
}

#[test]
fn menus_fit_a_low_window_and_one_click_goes_from_one_to_another() {
    let mut harness = first_start([640.0, 400.0], Some(Source::Shape(Shape::CubeSplit)));
    let screen = egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(640.0, 400.0));
    harness.get_by_role_and_label(Role::Button, "View").click();
    settle(&mut harness);
    harness.get_by_label("Dark theme").scroll_to_me();
    harness.run_steps(30);
    harness.get_by_label("G");
    let last = harness.get_by_label("Dark theme").rect();
    assert!(screen.contains_rect(last), "{last:?}");
    harness.get_by_role_and_label(Role::Button, "Help").click();
    settle(&mut harness);
    harness.get_by_label_contains("Keys");
    assert!(harness.query_by_label("Dark theme").is_none());
}

#[test]
fn warnings_are_listed() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = folder.path().join("warns.obj");
    // The material's file isn't there.
    let text = "mtllib nowhere.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n";
    std::fs::write(&path, text).expect("a writable temporary folder");
    let mut harness = first_start([1280.0, 720.0], Some(Source::File(path)));
    let warnings = harness.state().loaded().expect("a mesh").warnings.clone();
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    click(&mut harness, "1 warning");
    let list = harness.get_by_role_and_label(Role::Window, "Warnings").rect();
    assert!(list.contains(harness.get_by_label(&warnings[0]).rect().center()));
    click(&mut harness, "Copy");
    press(&mut harness, egui::Key::Escape);
    assert!(harness.query_by_role_and_label(Role::Window, "Warnings").is_none());
}

#[test]
fn sections_fold_and_the_next_window_remembers_it() {
    let folder: TempDir = tempfile::tempdir().expect("a writable temporary folder");
    let opened = || resumed(folder.path(), [1280.0, 720.0], Some(Source::Shape(Shape::Torus)));
    let mut harness = opened();
    assert!(harness.query_by_role_and_label(Role::ComboBox, "Convention").is_none(), "specialists open it");
    scroll_to(&mut harness, "Advanced");
    click(&mut harness, "Advanced");
    harness.get_by_role_and_label(Role::ComboBox, "Convention");
    harness.get_by_role_and_label(Role::DisclosureTriangle, "Surface").scroll_to_me();
    settle(&mut harness);
    harness.get_by_role_and_label(Role::DisclosureTriangle, "Surface").click();
    settle(&mut harness);
    assert!(harness.query_by_role_and_label(Role::ComboBox, "Partitioning").is_none());
    eframe::App::on_exit(harness.state_mut());
    drop(harness);
    let harness = opened();
    harness.get_by_role_and_label(Role::ComboBox, "Convention");
    assert!(harness.query_by_role_and_label(Role::ComboBox, "Partitioning").is_none());
}

#[test]
fn hidden_panels_leave_the_picture_all_the_room() {
    let mut harness = window(Some(Source::Shape(Shape::Torus)));
    let before = viewport(&harness);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::B);
    settle(&mut harness);
    let whole = viewport(&harness);
    assert!(whole.width() > before.width() + 500.0, "{whole:?}");
    harness.get_by_role_and_label(Role::CheckBox, "Wireframe");
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::B);
    settle(&mut harness);
    assert_eq!(viewport(&harness), before);
}

/// The titles of sections that are shown of both panels: of settings, and of measurements.
fn panels(harness: &Harness<App>) -> [bool; 2] {
    ["Surface", "Patch"].map(|title| harness.query_by_role_and_label(Role::DisclosureTriangle, title).is_some())
}

#[test]
fn the_picture_keeps_half_of_a_narrow_window_and_nothing_is_covered() {
    for (size, zoom, shown) in [
        ([1600.0, 1000.0], 1.0, [true, true]),
        ([1024.0, 640.0], 1.0, [true, false]),
        ([1280.0, 720.0], 1.5, [true, false]),
        ([1024.0, 640.0], 2.0, [true, false]),
        ([640.0, 400.0], 1.5, [false, false]),
    ] {
        let mut harness = first_start(size, Some(Source::Shape(Shape::Torus)));
        harness.ctx.set_zoom_factor(zoom);
        harness.set_size(egui::Vec2::from(size) / zoom);
        settle(&mut harness);
        let screen = harness.ctx.content_rect();
        let picture = viewport(&harness);
        assert!(screen.contains_rect(picture), "{size:?} x {zoom}: {picture:?}");
        assert!(picture.width() >= 0.5 * screen.width(), "{size:?} x {zoom}: {picture:?}");
        switch(&mut harness, "Split view");
        for title in ["Left: untessellated", "Right: PN-AEN"] {
            let title = harness.get_by_label_contains(title).rect();
            assert!(picture.contains_rect(title), "{size:?} x {zoom}: {title:?} {picture:?}");
            let end = harness.query_by_label("Look from the top").map(|end| end.rect());
            assert!(!end.is_some_and(|end| end.intersects(title)), "{size:?} x {zoom}: {title:?} {end:?}");
        }
        assert_eq!(panels(&harness), shown, "{size:?} x {zoom}");
        let left = harness.query_by_role_and_label(Role::DisclosureTriangle, "Surface");
        let right = harness.query_by_role_and_label(Role::DisclosureTriangle, "Patch");
        let titles: Vec<_> = [left, right].into_iter().flatten().map(|node| node.rect()).collect();
        assert!(titles.iter().all(|title| !title.intersects(picture)), "{titles:?} {picture:?}");
        for name in ["Split view", "Wireframe", "Cracks", "Freeze LOD camera"] {
            let button = harness.get_by_role_and_label(Role::CheckBox, name).rect();
            assert!(screen.contains_rect(button) && !button.intersects(picture), "{name}: {button:?}, {picture:?}");
        }
    }
}

#[test]
fn in_a_narrow_window_tabs_show_settings_or_measurements() {
    let mut harness = first_start([1024.0, 640.0], Some(Source::Shape(Shape::CubeSplit)));
    let before = (viewport(&harness), harness.state().pictures());
    assert_eq!(panels(&harness), [true, false]);
    harness.get_by_role_and_label(Role::Tab, "Measurements").click();
    settle(&mut harness);
    assert_eq!(panels(&harness), [false, true]);
    harness.get_by_label("No cracks");
    assert_eq!((viewport(&harness), harness.state().pictures()), before, "the picture stays as it is");
    harness.get_by_role_and_label(Role::Tab, "Settings").click();
    settle(&mut harness);
    choose(&mut harness, "Surface", "PN");
    harness.get_by_role_and_label(Role::Tab, "Measurements").click();
    settle(&mut harness);
    harness.get_by_label_contains("12 cracked edges, widest ");
    // A wider window has both beside the picture.
    harness.set_size(egui::vec2(1280.0, 720.0));
    settle(&mut harness);
    assert_eq!(panels(&harness), [true, true]);
    assert!(harness.query_by_role_and_label(Role::Tab, "Measurements").is_none());
}

/// What can be read or used in the panels: a text, and where it is. Rows that are scrolled out of view count too.
fn rows(harness: &Harness<App>) -> Vec<(String, egui::Rect)> {
    let roles = [
        Role::Label,
        Role::Button,
        Role::CheckBox,
        Role::ComboBox,
        Role::Slider,
        Role::SpinButton,
        Role::DisclosureTriangle,
    ];
    let nodes = roles.iter().flat_map(|&role| harness.query_all_by_role(role));
    let text = |node: &egui_kittest::Node<'_>| {
        let own = node.accesskit_node();
        format!("{:?} {}", own.role(), own.label().or(own.value()).unwrap_or_default())
    };
    nodes.map(|node| (text(&node), node.rect())).collect()
}

/// Pairs of rows that lie over each other by more than a rounding.
fn overlapping(rows: &[(String, egui::Rect)]) -> Vec<String> {
    let mut found = Vec::new();
    for (index, (name, rect)) in rows.iter().enumerate() {
        for (other, beside) in &rows[index + 1..] {
            let common = rect.intersect(*beside);
            // A slider's number is a control within its row.
            let is_part = rect.contains_rect(*beside) || beside.contains_rect(*rect);
            if common.width() > 1.5 && common.height() > 1.5 && !is_part {
                found.push(format!("{name} {rect:?} and {other} {beside:?}"));
            }
        }
    }
    found
}

#[test]
fn no_row_of_the_panels_is_cut_or_covered_at_any_size_of_the_text() {
    let size = [1024.0, 640.0];
    for zoom in [0.75, 1.0, 1.25, 1.5, 2.0] {
        let mut harness = first_start(size, Some(Source::Shape(Shape::CubeSplit)));
        crate::open_all_sections(&mut harness);
        harness.ctx.set_zoom_factor(zoom);
        harness.set_size(egui::Vec2::from(size) / zoom);
        choose(&mut harness, "Surface", "PN");
        harness.state_mut().select_triangle(Some(3));
        settle(&mut harness);
        for (role, last) in [(Role::ComboBox, "Surface"), (Role::CheckBox, "Cull back faces")] {
            harness.get_by_role_and_label(role, last).scroll_to_me();
            settle(&mut harness);
            no_row_is_cut_or_covered(&harness, zoom);
        }
        // Below this width, measurements scroll sideways.
        if let Some(tab) = harness.query_by_role_and_label(Role::Tab, "Measurements").filter(|_| zoom < 1.6) {
            tab.click();
            settle(&mut harness);
            for title in ["Patch", "Mesh"] {
                harness.get_by_role_and_label(Role::DisclosureTriangle, title).scroll_to_me();
                settle(&mut harness);
                no_row_is_cut_or_covered(&harness, zoom);
            }
        }
    }
}

/// Checks the rows that are in view.
fn no_row_is_cut_or_covered(harness: &Harness<App>, zoom: f32) {
    let (picture, screen) = (viewport(harness), harness.ctx.content_rect());
    let in_view = |rect: &egui::Rect| rect.top() > picture.top() - 40.0 && rect.bottom() < picture.bottom();
    let all: Vec<_> = rows(harness).into_iter().filter(|(_, rect)| in_view(rect)).collect();
    let left: Vec<_> = all.iter().filter(|(_, rect)| rect.right() < picture.left() + 1.0).cloned().collect();
    let right: Vec<_> = all.iter().filter(|(_, rect)| rect.left() > picture.right() - 1.0).cloned().collect();
    assert!(left.len() > 12, "{zoom}: {left:?}");
    assert_eq!(right.is_empty(), zoom > 0.9, "the right panel is there if it has room");
    for panel in [left, right] {
        assert_eq!(overlapping(&panel), Vec::<String>::new(), "{zoom}");
    }
    // Nothing reaches from a panel into the picture, or beyond the window.
    for (name, rect) in &all {
        let beside = rect.right() < picture.left() + 1.0 || rect.left() > picture.right() - 1.0;
        assert!(beside || rect.left() > picture.left() - 1.0, "{zoom}: {name} {rect:?} {picture:?}");
        assert!(rect.left() >= screen.left() - 0.5 && rect.right() <= screen.right() + 0.5, "{zoom}: {name} {rect:?}");
    }
}

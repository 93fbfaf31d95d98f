//! Animations: choosing a clip, scrubbing, playing and pausing.

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use geometry::mesh::{Moment, Shape};
use geometry::view::project;
use glam::Vec3;
use load::Source;
use pnaen::app::App;
use tempfile::TempDir;

use crate::editing::{assert_draws, copied, press_with};
use crate::{choose, click, open_list, press, scroll_to, settle, switch, uniform, window};
use documents::moving::{CLIPS, moving};

/// A window with an animated mesh, and the folder of its file, which must be kept for as long as the window.
fn moving_window() -> (Harness<'static, App>, TempDir) {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = folder.path().join("moving.glb");
    std::fs::write(&path, moving()).expect("a writable temporary folder");
    (uniform(Some(Source::File(path))), folder)
}

fn time(harness: &Harness<App>) -> f64 {
    harness.state().moment().expect("a clip").time
}

#[test]
fn a_mesh_without_clips_has_no_timeline() {
    let harness = window(Some(Source::Shape(Shape::Torus)));
    assert_eq!(harness.query_all_by_role_and_label(Role::ComboBox, "Clip").count(), 0);
}

#[test]
fn a_clip_is_chosen_and_scrubbed() {
    let (mut harness, _folder) = moving_window();
    harness.get_by_role_and_label(Role::ComboBox, "Clip");
    assert_eq!(harness.state().moment(), None, "it opens at rest");
    // Frame again, because the viewport had another size when the mesh was loaded.
    press(&mut harness, Key::F);
    let (rest, pictures) = (*harness.state().camera(), harness.state().pictures());
    choose(&mut harness, "Clip", CLIPS[2]);
    assert!(harness.state().camera().distance > 1.2 * rest.distance, "the camera frames the whole clip");
    choose(&mut harness, "Clip", CLIPS[3]);
    assert_eq!(harness.state().moment(), Some(Moment { clip: 3, time: 0.0 }));
    assert!(!harness.state().is_playing());
    assert!(harness.state().pictures() > pictures);
    let pictures = harness.state().pictures();
    harness.get_by_role_and_label(Role::Slider, "Time").set_value_accesskit(1.25);
    settle(&mut harness);
    assert_eq!(time(&harness), 1.25);
    assert!(harness.state().pictures() > pictures, "the new pose is drawn");
    for (button, expected) in
        [("Next frame", 1.25 + 1.0 / 30.0), ("Previous frame", 1.25), ("Previous frame", 1.25 - 1.0 / 30.0)]
    {
        click(&mut harness, button);
        assert!((time(&harness) - expected).abs() < 1e-3, "{button}: {}", time(&harness));
    }
    // Cracks are measured in the pose.
    let cracks = harness.state().cracks().expect("measured");
    assert!(cracks.edge_points > 100 && cracks.different_bits == 0);
    // Nothing is drawn when nothing has changed.
    let pictures = harness.state().pictures();
    harness.run_steps(5);
    assert_eq!(harness.state().pictures(), pictures);
    choose(&mut harness, "Clip", "Rest pose");
    assert_eq!(harness.state().moment(), None);
    assert_eq!(*harness.state().camera(), rest);
    // A camera that shows a detail isn't moved.
    harness.key_press(egui::Key::PageUp);
    settle(&mut harness);
    let near = *harness.state().camera();
    assert!(near.distance < rest.distance);
    choose(&mut harness, "Clip", CLIPS[2]);
    assert_eq!(*harness.state().camera(), near);
}

#[test]
fn the_left_half_keeps_a_pose_that_is_copied_exchanged_and_undone() {
    let (mut harness, _folder) = moving_window();
    let show = |harness: &mut Harness<App>, time: f64| {
        harness.get_by_role_and_label(Role::Slider, "Time").set_value_accesskit(time);
        settle(harness);
    };
    assert_eq!(harness.query_all_by_role_and_label(Role::ComboBox, "Left pose").count(), 0, "nothing is left");
    press(&mut harness, Key::S);
    choose(&mut harness, "Clip", CLIPS[3]);
    show(&mut harness, 0.5);
    choose(&mut harness, "Left pose", "This moment");
    harness.get_by_label_contains("Left: All at 0.5 s, untessellated");
    let kept = harness.state().read_picture().expect("a device").expect("a picture");
    show(&mut harness, 0.25);
    harness.get_by_label_contains("Left: All at 0.5 s, untessellated");
    harness.get_by_label_contains("Right: All at 0.25 s, PN-AEN");
    let shown = harness.state().read_picture().expect("a device").expect("a picture");
    let left = |picture: &image::RgbaImage| {
        image::imageops::crop_imm(picture, 0, 0, picture.width() / 2 - 2, picture.height()).to_image()
    };
    assert!(shown != kept && left(&shown) == left(&kept), "only the right half moves");
    let command = copied(&mut harness);
    assert!(command.contains(" --split-animation All --split-time 0.5"), "{command}");
    assert_draws(&harness, &command, "moving-view");
    scroll_to(&mut harness, "Swap");
    click(&mut harness, "Swap");
    harness.get_by_label_contains("Left: All at 0.25 s, PN-AEN");
    harness.get_by_label_contains("Right: All at 0.5 s, Flat");
    assert_eq!(time(&harness), 0.5);
    let context = harness.ctx.clone();
    harness.state_mut().undo(&context);
    settle(&mut harness);
    harness.get_by_label_contains("Left: All at 0.5 s, untessellated");
    harness.get_by_label_contains("Right: All at 0.25 s, PN-AEN");
    assert_eq!(time(&harness), 0.25);
    harness.state_mut().redo(&context);
    settle(&mut harness);
    harness.get_by_label_contains("Left: All at 0.25 s, PN-AEN");
    harness.get_by_label_contains("Right: All at 0.5 s, Flat");
    scroll_to(&mut harness, "Swap");
    click(&mut harness, "Swap");
    assert_eq!(time(&harness), 0.25);
    choose(&mut harness, "Clip", "Rest pose");
    choose(&mut harness, "Left pose", "This moment");
    harness.get_by_label_contains("Left: at rest, untessellated");
    harness.state_mut().undo(&context);
    settle(&mut harness);
    harness.get_by_label_contains("Left: All at 0.5 s, untessellated");
    harness.state_mut().open(&context, Source::Shape(Shape::Torus));
    settle(&mut harness);
    assert_eq!(harness.query_all_by_label_contains("All at").count(), 0, "another mesh has no such pose");
}

#[test]
fn a_moment_that_is_kept_on_the_left_stays_while_the_right_half_moves() {
    let (mut harness, _folder) = moving_window();
    let show = |harness: &mut Harness<App>, time: f64| {
        harness.get_by_role_and_label(Role::Slider, "Time").set_value_accesskit(time);
        settle(harness);
    };
    choose(&mut harness, "Clip", CLIPS[3]);
    show(&mut harness, 0.5);
    press_with(&mut harness, Modifiers::SHIFT, Key::J);
    harness.get_by_label_contains("Left: All at 0.5 s, PN-AEN");
    show(&mut harness, 0.25);
    harness.get_by_label_contains("Left: All at 0.5 s, PN-AEN");
    harness.get_by_label_contains("Right: All at 0.25 s, PN-AEN");
    harness.get_by_label("Triangles, Change: 0");
    let context = harness.ctx.clone();
    harness.state_mut().undo(&context);
    settle(&mut harness);
    assert!(harness.state().settings().split.is_none());
    assert_eq!(time(&harness), 0.25, "the right half stays");
    harness.state_mut().redo(&context);
    settle(&mut harness);
    harness.get_by_label_contains("Left: All at 0.5 s, PN-AEN");
    choose(&mut harness, "Clip", "Rest pose");
    press_with(&mut harness, Modifiers::SHIFT, Key::J);
    harness.get_by_label_contains("Left: PN-AEN");
    click_without_rest(&mut harness, "Play or pause");
    assert!(harness.state().is_playing());
    harness.get_by_label("Triangles, Left: …");
}

/// Clicks on what starts to play, which never rests.
fn click_without_rest(harness: &mut Harness<App>, label: &str) {
    harness.get_by_label(label).click();
    harness.run_steps(3);
}

#[test]
fn space_plays_and_pauses_and_cracks_are_measured_only_when_paused() {
    let (mut harness, _folder) = moving_window();
    harness.key_press(Key::Space);
    harness.run_steps(2);
    assert!(harness.state().is_playing(), "the first clip plays if none is chosen");
    let pictures = harness.state().pictures();
    let mut times = Vec::new();
    let start = std::time::Instant::now();
    while harness.state().pictures() < pictures + 4 {
        assert!(start.elapsed() < crate::PATIENCE, "no pictures while playing");
        harness.step();
        times.push(time(&harness));
    }
    assert!(times.windows(2).all(|pair| pair[0] != pair[1]), "time goes on");
    assert!(times.iter().all(|time| (0.0..1.0).contains(time)), "the clip loops: {times:?}");
    assert!(harness.state().cracks().is_none(), "nothing is measured while playing");
    harness.get_by_label("cracks: pause to measure");
    harness.get_by_label_contains("… of ");
    harness.get_by_role_and_label(Role::Button, "Pause").click();
    settle(&mut harness);
    assert!(!harness.state().is_playing());
    let (paused, pictures) = (time(&harness), harness.state().pictures());
    assert_eq!(harness.state().cracks().map(|cracks| cracks.different_bits), Some(0));
    harness.get_by_label("cracks 0");
    harness.run_steps(5);
    assert_eq!((time(&harness), harness.state().pictures()), (paused, pictures), "nothing changes while paused");
    harness.get_by_role_and_label(Role::Button, "Play");
}

#[test]
fn another_clip_plays_if_one_does() {
    let (mut harness, _folder) = moving_window();
    harness.key_press(Key::Space);
    harness.run_steps(2);
    harness.state_mut().choose_clip(Some(2));
    harness.run_steps(2);
    assert!(harness.state().is_playing());
    assert_eq!(harness.state().moment().map(|moment| moment.clip), Some(2));
    harness.state_mut().choose_clip(None);
    assert!(!harness.state().is_playing(), "at rest there is nothing to play");
}

#[test]
fn speed_multiplies_time() {
    let (mut harness, _folder) = moving_window();
    choose(&mut harness, "Clip", CLIPS[2]);
    let passed = |harness: &mut Harness<App>| {
        harness.get_by_role_and_label(Role::Slider, "Time").set_value_accesskit(0.0);
        settle(harness);
        harness.key_press(Key::Space);
        harness.run_steps(2);
        let before = time(harness);
        harness.step();
        let passed = time(harness) - before;
        harness.key_press(Key::Space);
        settle(harness);
        passed
    };
    let normal = passed(&mut harness);
    assert!(normal > 0.0, "{normal}");
    harness.get_by_role_and_label(Role::Slider, "Speed").set_value_accesskit(4.0);
    let fast = passed(&mut harness);
    assert!((fast / normal - 4.0).abs() < 1e-3, "{normal} {fast}");
}

#[test]
fn framing_a_selected_patch_uses_its_pose() {
    let (mut harness, _folder) = moving_window();
    // What is emitted is the triangle itself, whose middle the camera looks at.
    choose(&mut harness, "Surface", "Flat");
    harness.state_mut().select_triangle(Some(20));
    settle(&mut harness);
    choose(&mut harness, "Clip", CLIPS[0]);
    harness.get_by_role_and_label(Role::Slider, "Time").set_value_accesskit(0.5);
    settle(&mut harness);
    press(&mut harness, Key::F);
    harness.key_press_modifiers(egui::Modifiers::SHIFT, Key::F);
    settle(&mut harness);
    let loaded = harness.state().loaded().expect("a mesh");
    let posed = loaded.posed(harness.state().moment());
    let patch = posed.topology.patch_of(20).expect("a patch");
    let middle = |corners: [glam::Vec3; 3]| (corners[0] + corners[1] + corners[2]) / 3.0;
    let target = harness.state().camera().target;
    assert!(target.distance(middle(posed.topology.patch_positions(patch))) < 1e-4);
    assert!(target.distance(middle(loaded.topology.patch_positions(patch))) > 0.1);
}

#[test]
fn a_mesh_loaded_again_keeps_its_pose_and_another_is_at_rest() {
    let (mut harness, _folder) = moving_window();
    // A morph target has the same name.
    open_list(&mut harness, "Clip");
    harness.get_by_role_and_label(Role::Button, CLIPS[1]).click();
    settle(&mut harness);
    harness.get_by_role_and_label(Role::Slider, "Time").set_value_accesskit(0.5);
    settle(&mut harness);
    press(&mut harness, Key::R);
    assert_eq!(harness.state().moment(), Some(Moment { clip: 1, time: 0.5 }));
    // A mesh with a crease band is at rest. Without the band it has its pose again.
    harness.get_by_role_and_label(Role::SpinButton, "Crease band").set_value_accesskit(1.0);
    settle(&mut harness);
    assert_eq!(harness.state().moment(), None);
    harness.get_by_role_and_label(Role::SpinButton, "Crease band").set_value_accesskit(0.0);
    settle(&mut harness);
    assert_eq!(harness.state().moment(), Some(Moment { clip: 1, time: 0.5 }));
    let context = harness.ctx.clone();
    harness.state_mut().open(&context, Source::Shape(Shape::Torus));
    settle(&mut harness);
    assert_eq!(harness.state().moment(), None);
    click(&mut harness, "Wireframe");
}

#[test]
fn the_worst_moments_of_a_clip_are_one_click_away() {
    let (mut harness, _folder) = moving_window();
    choose(&mut harness, "LOD", "Edge length");
    choose(&mut harness, "Clip", CLIPS[2]);
    harness.get_by_label("Find the worst moments").click();
    let start = std::time::Instant::now();
    while harness.query_by_label_contains("Most triangles: ").is_none() {
        assert!(start.elapsed() < crate::PATIENCE, "the clip is measured");
        settle(&mut harness);
    }
    let text = crate::findings::button(&harness, |text| text.starts_with("Most triangles: "));
    let [count, at] = [2, 4].map(|word| text.split(' ').nth(word).expect("a number").to_owned());
    click(&mut harness, &text);
    assert_eq!(format!("{:.3}", time(&harness)), at);
    assert_eq!(harness.state().totals().map(|totals| totals.1.to_string()), Some(count.replace(',', "")));
    // Another tessellation has other moments.
    choose(&mut harness, "Surface", "Flat");
    harness.get_by_label("Find the worst moments");
}

#[test]
fn bones_follow_the_clip_and_a_mesh_without_a_skin_has_none() {
    let picture = |harness: &Harness<App>| harness.state().read_picture().expect("a device").expect("a picture");
    let (mut harness, _folder) = moving_window();
    let before = picture(&harness);
    click(&mut harness, "Overlays");
    switch(&mut harness, "Bones");
    click(&mut harness, "Overlays");
    assert!(harness.state().settings().overlays.bones);
    let with = picture(&harness);
    assert_ne!(before, with);
    choose(&mut harness, "Clip", CLIPS[0]);
    harness.get_by_role_and_label(Role::Slider, "Time").set_value_accesskit(0.5);
    settle(&mut harness);
    let bent = picture(&harness);
    press_with(&mut harness, Modifiers::SHIFT, Key::B);
    assert!(!harness.state().settings().overlays.bones);
    assert_ne!(picture(&harness), bent);
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    click(&mut harness, "Overlays");
    assert!(harness.get_by_role_and_label(Role::CheckBox, "Bones").accesskit_node().is_disabled());
    assert!(!harness.get_by_role_and_label(Role::CheckBox, "Folds").accesskit_node().is_disabled());
    click(&mut harness, "Overlays");
    press_with(&mut harness, Modifiers::SHIFT, Key::B);
    assert!(!harness.state().settings().overlays.bones, "there is nothing to show");
}

#[test]
fn the_joint_under_the_resting_pointer_is_named() {
    let (mut harness, _folder) = moving_window();
    let place = |harness: &Harness<App>, joint: Vec3| {
        let rect = harness.get_by_role_and_label(Role::Image, "Viewport").rect();
        let (app, viewport) = (harness.state(), glam::vec2(rect.width(), rect.height()));
        let bounds = app.loaded().expect("a mesh").mesh.bounds();
        let seen = project(app.camera().clip_from_object(viewport, &bounds), viewport, joint);
        let seen = seen.expect("in front of the eye");
        rect.min + egui::vec2(seen.x, seen.y)
    };
    let rest_at = |harness: &mut Harness<App>, place: egui::Pos2| {
        harness.hover_at(place);
        settle(harness);
    };
    let [root, tip] = [Vec3::ZERO, 2.0 * Vec3::Y].map(|joint| place(&harness, joint));
    rest_at(&mut harness, tip);
    assert!(harness.query_by_label("Joint Tip").is_none(), "bones aren't shown");
    press_with(&mut harness, Modifiers::SHIFT, Key::B);
    rest_at(&mut harness, tip + egui::vec2(2.0, -2.0));
    harness.get_by_label("Joint Tip");
    rest_at(&mut harness, root);
    harness.get_by_label("Joint node 1");
    rest_at(&mut harness, tip + egui::vec2(40.0, 0.0));
    assert!(harness.query_by_label_contains("Joint ").is_none(), "there is none");
    // The number of the colours is below it.
    choose(&mut harness, "Colours", "Factors");
    rest_at(&mut harness, tip);
    let [joint, number] = ["Joint Tip", "Factors 8.00, 8.00, 8.00"].map(|line| harness.get_by_label(line).rect());
    assert!(joint.bottom() <= number.top(), "{joint} {number}");
}

#[test]
fn a_moment_goes_with_its_mesh_when_the_meshes_of_two_files_are_exchanged() {
    let (mut harness, folder) = moving_window();
    let other = folder.path().join("other.obj");
    std::fs::write(&other, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("a writable folder");
    choose(&mut harness, "Clip", CLIPS[3]);
    harness.get_by_role_and_label(Role::Slider, "Time").set_value_accesskit(0.5);
    press(&mut harness, Key::S);
    let context = harness.ctx.clone();
    harness.state_mut().open_reference_shape(&context, Source::File(other));
    settle(&mut harness);
    choose(&mut harness, "Left mesh", "Reference surface: other.obj");
    let before = harness.state_mut().read_picture().expect("a device");
    scroll_to(&mut harness, "Swap");
    click(&mut harness, "Swap");
    harness.get_by_label_contains("Left: moving.glb, All at 0.5 s");
    assert_eq!(harness.state().moment(), None, "the other mesh has no clips");
    scroll_to(&mut harness, "Swap");
    click(&mut harness, "Swap");
    assert_eq!(time(&harness), 0.5);
    assert!(harness.state_mut().read_picture().expect("a device") == before, "as it was");
}

//! The part of its curves that a clip shows, and how closely a pose follows them.

use glam::{EulerRot, Quat, Vec3};

use super::documents::{Link, add, curves, document, geometry, model, span};
use super::loaded;
use super::moving::{assert_near, at};
use super::tree::{Entry, list, one};
use crate::loaded_mesh::LoadedMesh;

/// Key frames: times in s, and values.
type Keys<'a> = &'a [(f64, f64)];

/// A triangle on a node whose property has these curves, in a clip between two times. `goes_on` is how curves go on before their
/// first key frame and after their last one, by the format's letters.
fn moving(times: [f64; 2], property: &'static str, keys: [Keys; 3], goes_on: Option<[char; 2]>) -> Vec<Entry> {
    let mut objects = vec![
        geometry(10, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0], &[&[0, 1, 2]], Vec::new()),
        model(20, "moves", "Mesh", &[]),
    ];
    let mut links = vec![Link(20, 0, ""), Link(10, 20, "")];
    let components = [("d|X", keys[0]), ("d|Y", keys[1]), ("d|Z", keys[2])];
    add((&mut objects, &mut links), [span("clip", times), curves(50, (20, property), &components, 4)]);
    for curve in objects.iter_mut().filter(|object| object.name == "AnimationCurve") {
        let sides = goes_on
            .into_iter()
            .flat_map(|letters| ["Pre-Extrapolation", "Post-Extrapolation"].into_iter().zip(letters));
        curve.children.extend(
            sides.map(|(name, letter)| list(name, vec![one("Type", letter as i64), one("Repetition", -1_i64)])),
        );
    }
    document(false, 100.0, objects, &links)
}

fn duration(loaded: &LoadedMesh) -> f64 {
    loaded.rig.as_ref().expect("a rig").clips[0].duration
}

/// Checks where the first corner is along X at times of the clip.
fn assert_path(loaded: &LoadedMesh, path: &[(f64, f32)]) {
    for &(time, x) in path {
        let (rest, posed) = at(loaded, time)[0];
        assert_near(posed, rest + x * Vec3::X, &format!("{time} s"));
    }
}

const STILL: Keys = &[(0.0, 0.0)];

#[test]
fn a_clip_begins_between_key_frames() {
    let rises: Keys = &[(-1.0, 0.0), (1.0, 2.0), (2.0, 3.0)];
    let keys = [rises, STILL, STILL];
    let from_zero = loaded(&moving([0.0, 2.0], "Lcl Translation", keys, None));
    assert_path(&from_zero, &[(0.0, 1.0), (0.5, 1.5), (1.0, 2.0), (2.0, 3.0)]);
    let later = loaded(&moving([0.5, 2.0], "Lcl Translation", keys, None));
    assert_path(&later, &[(0.0, 1.5), (0.5, 2.0), (1.5, 3.0)]);
    assert_eq!(duration(&later), 1.5);
    let earlier = loaded(&moving([-1.0, 2.0], "Lcl Translation", keys, None));
    assert_path(&earlier, &[(0.0, 0.0), (1.0, 1.0), (2.0, 2.0), (3.0, 3.0)]);
    assert_eq!(duration(&earlier), 3.0);
}

#[test]
fn a_clip_lasts_as_long_as_the_file_says() {
    let keys: Keys = &[(0.0, 0.0), (1.0, 2.0)];
    let longer = loaded(&moving([0.0, 1.5], "Lcl Translation", [keys, STILL, STILL], None));
    assert_eq!(duration(&longer), 1.5);
    assert_path(&longer, &[(0.5, 1.0), (1.0, 2.0), (1.25, 2.0), (1.5, 2.0)]);
    let shorter = loaded(&moving([0.0, 0.5], "Lcl Translation", [keys, STILL, STILL], None));
    assert_eq!(duration(&shorter), 1.0, "key frames after the end are kept");
    let without = loaded(&moving([0.0, 0.0], "Lcl Translation", [keys, STILL, STILL], None));
    assert_eq!(duration(&without), 1.0);
}

#[test]
fn curves_go_on_beyond_their_key_frames() {
    let keys: Keys = &[(1.0, 0.0), (2.0, 4.0)];
    let clip = |letter| loaded(&moving([0.0, 5.0], "Lcl Translation", [keys, STILL, STILL], Some([letter; 2])));
    assert_path(&clip('C'), &[(0.25, 0.0), (1.5, 2.0), (2.5, 4.0), (5.0, 4.0)]);
    assert_path(&clip('R'), &[(0.25, 1.0), (0.5, 2.0), (1.5, 2.0), (2.5, 2.0), (4.75, 3.0)]);
    assert_path(&clip('M'), &[(0.25, 3.0), (0.5, 2.0), (1.5, 2.0), (2.25, 3.0), (3.25, 1.0), (4.5, 2.0)]);
    assert_path(&clip('A'), &[(0.5, -2.0), (1.5, 2.0), (2.5, 6.0), (4.75, 15.0)]);
    assert_path(&clip('K'), &[(0.5, -2.0), (1.5, 2.0), (2.5, 6.0), (4.75, 15.0)]);
}

#[test]
fn a_wheel_keeps_turning() {
    let turn: Keys = &[(0.0, 0.0), (1.0, 360.0)];
    let loaded = loaded(&moving([0.0, 10.0], "Lcl Rotation", [STILL, STILL, turn], Some(['A'; 2])));
    for time in [0.25, 1.25, 3.5, 9.875_f32] {
        for (rest, posed) in at(&loaded, time.into()) {
            let expected = Quat::from_rotation_z(time * std::f32::consts::TAU) * rest;
            assert!((posed - expected).length() < 1e-4, "{rest} at {time} s: {posed} instead of {expected}");
        }
    }
}

/// Angles of FBX are of turns about X, then Y, then Z.
fn turned(degrees: [f64; 3], at: Vec3) -> Vec3 {
    let [x, y, z] = degrees.map(|angle| angle.to_radians() as f32);
    Quat::from_euler(EulerRot::ZYX, z, y, x) * at
}

#[test]
fn a_turn_about_three_axes_follows_its_angles() {
    // 100 degrees a second about each axis, between key frames of a tenth of a second.
    let keys: Vec<(f64, f64)> = (0..=10).map(|i| (f64::from(i) / 10.0, 10.0 * f64::from(i))).collect();
    let loaded = loaded(&moving([0.0, 1.0], "Lcl Rotation", [&keys, &keys, &keys], None));
    for i in 0..=1000 {
        let time = f64::from(i) / 1000.0;
        for (rest, posed) in at(&loaded, time) {
            let expected = turned([100.0 * time; 3], rest);
            assert!((posed - expected).length() < 1e-4, "{rest} at {time} s: {posed} instead of {expected}");
        }
    }
}

#[test]
fn key_frames_of_every_frame_may_jump_by_whole_turns() {
    // The angle passes 180 degrees, and the exporter wrote it between -180 and 180.
    let keys: Vec<(f64, f64)> =
        (0..=24).map(|i| (f64::from(i) / 24.0, (15.0 * f64::from(i) + 180.0) % 360.0 - 180.0)).collect();
    let loaded = loaded(&moving([0.0, 1.0], "Lcl Rotation", [STILL, STILL, &keys], None));
    for i in 0..=240 {
        let time = f64::from(i) / 240.0;
        for (rest, posed) in at(&loaded, time) {
            let expected = turned([0.0, 0.0, 360.0 * time], rest);
            assert!((posed - expected).length() < 1e-4, "{rest} at {time} s: {posed} instead of {expected}");
        }
    }
}

#[test]
fn a_clip_that_goes_on_for_a_day_costs_no_more_than_its_samples() {
    let turn: Keys = &[(0.0, 0.0), (1.0, 360.0)];
    let loaded = loaded(&moving([0.0, 86_400.0], "Lcl Rotation", [STILL, STILL, turn], Some(['R'; 2])));
    assert_eq!(duration(&loaded), 86_400.0);
    let channels = &loaded.rig.as_ref().expect("a rig").clips[0].channels;
    assert!(channels.iter().all(|channel| channel.keys.times.len() < 70_000));
}

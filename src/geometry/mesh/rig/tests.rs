use std::sync::Arc;

use glam::{DQuat, DVec3, dvec3};

use super::*;
use crate::mesh::Shape;

fn keys(times: &[f32], values: &[f32], width: usize, interpolation: Interpolation) -> Keys {
    Keys { times: times.to_vec(), values: values.to_vec(), width, interpolation }
}

fn sampled(keys: &Keys, time: f64) -> Vec<f64> {
    let mut values = vec![f64::NAN; keys.width];
    keys.sample(time, |i, x| values[i] = x);
    values
}

#[test]
fn keys_are_joined_as_their_interpolation_says() {
    let (times, values) = ([1.0, 2.0, 4.0], [0.0, 10.0, 1.0, 20.0, 5.0, 0.0]);
    let linear = keys(&times, &values, 2, Interpolation::Linear);
    assert_eq!(sampled(&linear, 1.5), [0.5, 15.0]);
    assert_eq!(sampled(&linear, 3.0), [3.0, 10.0]);
    let step = keys(&times, &values, 2, Interpolation::Step);
    assert_eq!(sampled(&step, 1.999), [0.0, 10.0]);
    assert_eq!(sampled(&step, 2.0), [1.0, 20.0]);
    for keys in [linear, step] {
        assert_eq!(sampled(&keys, 0.0), [0.0, 10.0], "before the first");
        assert_eq!(sampled(&keys, 9.0), [5.0, 0.0], "after the last");
    }
}

#[test]
fn cubic_splines_have_their_values_and_slopes() {
    // The in-tangent, value and out-tangent of two key frames, two seconds apart.
    let spline = keys(&[1.0, 3.0], &[9.0, 1.0, 3.0, -2.0, 5.0, 9.0], 1, Interpolation::CubicSpline);
    let at = |time| sampled(&spline, time)[0];
    assert_eq!((at(1.0), at(3.0), at(0.0), at(7.0)), (1.0, 5.0, 1.0, 5.0));
    let step = 1e-6;
    assert!(((at(1.0 + step) - at(1.0)) / step - 3.0).abs() < 1e-4);
    assert!(((at(3.0) - at(3.0 - step)) / step + 2.0).abs() < 1e-4);
    // The middle of a Hermite curve: the mean of the values, plus an eighth of the difference of the slopes times the
    // duration.
    assert!((at(2.0) - (3.0 + 2.0 * (3.0 + 2.0) / 8.0)).abs() < 1e-12);
}

#[test]
fn a_rig_takes_memory_of_its_mesh() {
    let rig = Rig { alike: vec![0; 1000], ..Rig::default() };
    let mut mesh = Shape::Torus.build();
    let still = mesh.bytes();
    mesh.rig = Some(Arc::new(rig));
    assert_eq!(mesh.bytes(), still + 4000);
}

#[test]
fn rotations_go_the_shorter_way() {
    let turn = |degrees: f64| DQuat::from_rotation_z(degrees.to_radians());
    // The same rotation by 90 degrees with the opposite signs: its components are far away.
    let far = -turn(90.0);
    let values = [turn(0.0), far].map(|q| q.to_array().map(|x| x as f32));
    let found = keys(&[0.0, 1.0], values.as_flattened(), 4, Interpolation::Linear).rotation(0.5);
    assert!(found.angle_between(turn(45.0)) < 1e-6, "{found}");
    // The rotation's speed is constant, which it would not be for the mean of the components.
    let third = keys(&[0.0, 1.0], values.as_flattened(), 4, Interpolation::Linear).rotation(1.0 / 3.0);
    assert!(third.angle_between(turn(30.0)) < 1e-6, "{third}");
    let zero = keys(&[0.0, 1.0], &[0.0; 8], 4, Interpolation::Linear).rotation(0.5);
    assert_eq!(zero.angle_between(DQuat::IDENTITY), 0.0, "what is no rotation turns nothing");
}

#[test]
fn a_loop_comes_back_to_its_start() {
    let clip = Clip { name: String::new(), duration: 2.0, channels: Vec::new() };
    assert_eq!([0.0, 1.5, 2.0, 5.0].map(|time| clip.looped(time)), [0.0, 1.5, 0.0, 1.0]);
    assert_eq!(Clip { duration: 0.0, ..clip }.looped(5.0), 0.0);
}

fn node(parent: Option<u32>, x: f64) -> AnimatedNode {
    let rest = Placement { translation: dvec3(x, 0.0, 0.0), ..Placement::default() };
    AnimatedNode { parent, between: DMat4::from_translation(DVec3::Y), rest, is_joint: false }
}

fn channel(target: u32, property: Property, keys: Keys) -> Channel {
    Channel { target, property, keys }
}

/// Two nodes, the second below the first, and two morph targets.
fn rig() -> Rig {
    let grow = keys(&[0.0, 1.0], &[1.0, 1.0, 1.0, 1e30, 1.0, 1.0], 3, Interpolation::Linear);
    let walk = keys(&[0.0, 1.0], &[0.0, 0.0, 0.0, 8.0, 0.0, 0.0], 3, Interpolation::Linear);
    let weigh = keys(&[0.0, 1.0], &[0.0, 1.0, 1.0, 0.0], 2, Interpolation::Linear);
    let clip = |channels| Clip { name: "clip".to_owned(), duration: 1.0, channels };
    let bindings = vec![Binding { position: [1e10, 0.0, 0.0], ..Binding::default() }];
    Rig {
        nodes: vec![node(None, 1.0), node(Some(0), 2.0)],
        joints: vec![
            Joint { node: Some(1), offset: DMat4::from_translation(DVec3::Z), ..Joint::default() },
            Joint::default(),
        ],
        morphs: vec![Morph { first_weight: 0, rest: vec![0.25, 0.75] }],
        clips: vec![
            clip(vec![channel(0, Property::Translation, walk), channel(0, Property::Weights, weigh)]),
            clip(vec![channel(1, Property::Scale, grow)]),
        ],
        reach: Reach::new(&bindings, &[], &[]),
        bindings,
        ..Rig::default()
    }
}

fn place(matrix: &JointMatrix) -> [f32; 3] {
    matrix.rows().map(|row| row[3])
}

#[test]
fn a_pose_moves_nodes_and_their_children() {
    let rig = rig();
    let rest = rig.rest();
    assert_eq!((place(&rest.palette[0]), place(&rest.palette[1])), ([3.0, 2.0, 1.0], [0.0; 3]));
    assert_eq!(rest.weights, [0.25, 0.75]);
    let pose = rig.pose(Moment { clip: 0, time: 0.5 });
    assert_eq!((place(&pose.palette[0]), place(&pose.palette[1])), ([6.0, 2.0, 1.0], [0.0; 3]));
    assert_eq!(pose.weights, [0.5, 0.5]);
    assert_eq!(rig.pose(Moment { clip: 7, time: 0.5 }), rest, "no such clip");
    assert_eq!(rig.animated_counts(&rig.clips[0]), AnimatedCounts { joints: 0, nodes: 1, targets: 2 });
}

#[test]
fn poses_beyond_f32_become_the_rest_pose() {
    let rig = rig();
    assert_ne!(rig.pose(Moment { clip: 1, time: 1e-9 }), rig.rest());
    assert_eq!(rig.pose(Moment { clip: 1, time: 1.0 }), rig.rest());
}

#[test]
fn clips_of_one_name_are_told_apart_by_number() {
    let clips = ["run", "walk", "run", "run#2", "Walk", "run"];
    let clip = |name: &str| Clip { name: name.to_owned(), duration: 1.0, channels: Vec::new() };
    let rig = Rig { clips: clips.map(clip).to_vec(), ..Rig::default() };
    let found = ["run", "run#1", "run#3", "run#4", "run#", "walk", "WALK", "walk#1"].map(|name| rig.clip(name));
    assert_eq!(found, [Some(0), Some(0), Some(5), None, None, Some(1), None, Some(1)]);
    // A clip whose name is exactly this comes first.
    assert_eq!(rig.clip("run#2"), Some(3));
    let found: Vec<_> = (0..clips.len()).map(|index| rig.clip(&rig.clip_name(index))).collect();
    assert_eq!(found, [0, 1, 3, 3, 4, 5].map(Some), "all but one that another clip is called");
}

#[test]
fn rotations_stay_or_bend_where_their_interpolation_says_so() {
    let [from, to] = [0.0_f64, 90.0].map(|degrees| DQuat::from_rotation_z(degrees.to_radians()).as_quat().to_array());
    let step = keys(&[0.0, 1.0], [from, to].as_flattened(), 4, Interpolation::Step);
    assert_eq!(step.rotation(0.75).to_array(), from.map(f64::from));
    // With tangents of 0, the weights of a Hermite curve at a quarter are 27/32 and 5/32.
    let spline = [[0.0; 4], from, [0.0; 4], [0.0; 4], to, [0.0; 4]];
    let found = keys(&[0.0, 1.0], spline.as_flattened(), 4, Interpolation::CubicSpline).rotation(0.25).to_array();
    for (i, own) in found.into_iter().enumerate() {
        let expected = (27.0 * f64::from(from[i]) + 5.0 * f64::from(to[i])) / 32.0;
        assert!((own - expected).abs() < 1e-9, "{found:?}");
    }
}

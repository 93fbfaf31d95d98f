//! Skins, moving nodes and blend shapes, against closed forms.

use glam::Vec3;

use super::documents::{Link, curves, document, geometry, model, morphed_square, skinned_strip, stack};
use super::loaded;
use crate::load::loaded_mesh::LoadedMesh;
use crate::mesh::{Moment, Topology};
use crate::progress::Progress;
use crate::tessellate::deform;

/// The corners' positions at rest, and at a time of the first clip.
pub(super) fn at(loaded: &LoadedMesh, time: f64) -> Vec<(Vec3, Vec3)> {
    let pose = loaded.rig.as_ref().expect("a rig").pose(Moment { clip: 0, time });
    let topology = Topology::build(&loaded.mesh, &Progress::new()).expect("nobody cancels");
    let (posed, _) = deform(&loaded.mesh, &topology, &pose);
    loaded.corners.iter().zip(&posed.corners).map(|(rest, posed)| (rest.position, posed.position)).collect()
}

pub(super) fn assert_near(posed: Vec3, expected: Vec3, what: &str) {
    assert!((posed - expected).length() < 1e-5, "{what}: {posed} instead of {expected}");
}

#[test]
fn a_skin_bends_with_its_joints() {
    let loaded = loaded(&skinned_strip());
    let rig = loaded.rig.as_ref().expect("a rig");
    assert_eq!((rig.clips.len(), rig.clips[0].name.as_str(), rig.clips[0].duration), (1, "wave", 1.0));
    assert_eq!(rig.animated_counts(&rig.clips[0]).joints, 1);
    for time in [0.0, 0.3, 0.5, 1.0, 2.0_f64] {
        let (sin, cos) = (time.min(1.0) * std::f64::consts::FRAC_PI_2).sin_cos();
        for (rest, posed) in at(&loaded, time) {
            // Turned about (2, 0, 0).
            let [x, y] = [f64::from(rest.x) - 2.0, f64::from(rest.y)];
            let turned = Vec3::new((2.0 + cos * x - sin * y) as f32, (sin * x + cos * y) as f32, 0.0);
            let expected = match rest.x {
                x if x < 2.0 => rest,
                x if x > 2.0 => turned,
                _ => (rest + turned) / 2.0,
            };
            assert_near(posed, expected, &format!("{rest} at {time} s"));
        }
    }
}

#[test]
fn shapes_in_between_bend_the_path_of_a_vertex() {
    let loaded = loaded(&morphed_square());
    let rig = loaded.rig.as_ref().expect("a rig");
    assert_eq!(rig.animated_counts(&rig.clips[0]).targets, 2);
    for (time, height) in [(0.0, 0.0), (0.5, 0.5), (1.0, 1.0), (1.5, 2.5), (2.0, 4.0)] {
        for (rest, posed) in at(&loaded, time) {
            let risen = if rest.x * rest.y == 1.0 { height } else { 0.0 };
            assert_near(posed, rest + risen * Vec3::Z, &format!("{rest} at {time} s"));
        }
    }
}

#[test]
fn a_node_moves_what_hangs_below_it_within_the_units_of_the_file() {
    // In centimetres with Z up: the parent rises by 300, and the child, 100 beside it, turns about its own pivot.
    let square = [0.0, 0.0, 0.0, 10.0, 0.0, 0.0, 10.0, 10.0, 0.0, 0.0, 10.0, 0.0];
    let mut objects = vec![
        geometry(10, &square, &[&[0, 1, 2, 3]], Vec::new()),
        model(20, "parent", "Null", &[]),
        model(
            21,
            "child",
            "Mesh",
            &[
                ("RotationPivot", "Vector3D", &[10.0, 0.0, 0.0]),
                ("Lcl Translation", "Lcl Translation", &[100.0, 0.0, 0.0]),
            ],
        ),
    ];
    let mut links = vec![Link(20, 0, ""), Link(21, 20, ""), Link(10, 21, "")];
    let still: &[(f64, f64)] = &[(0.0, 0.0), (4.0, 0.0)];
    let rise: &[(f64, f64)] = &[(0.0, 0.0), (4.0, 300.0)];
    let turn: &[(f64, f64)] = &[(0.0, 0.0), (4.0, 360.0)];
    for (more, joined) in [
        stack("lift", 4.0),
        curves(50, (20, "Lcl Translation"), &[("d|X", still), ("d|Y", still), ("d|Z", rise)], 4),
        curves(60, (21, "Lcl Rotation"), &[("d|X", still), ("d|Y", still), ("d|Z", turn)], 4),
    ] {
        objects.extend(more);
        links.extend(joined);
    }
    let loaded = loaded(&document(true, 1.0, objects, &links));
    for time in [0.0, 1.0, 2.5, 4.0_f64] {
        let (sin, cos) = (time / 4.0 * std::f64::consts::TAU).sin_cos();
        for (rest, posed) in at(&loaded, time) {
            // Back to the file's axes, from the pivot.
            let [x, y] = [f64::from(rest.x) - 1.1, -f64::from(rest.z)];
            let [x, y] = [1.1 + cos * x - sin * y, sin * x + cos * y];
            let expected = Vec3::new(x as f32, (time / 4.0 * 3.0) as f32, -y as f32);
            // A turn is sampled, and its pieces are arcs; what moves with them is a chord.
            assert!((posed - expected).length() < 1e-4, "{rest} at {time} s: {posed} instead of {expected}");
        }
    }
}

#[test]
fn steps_stay_steps() {
    let mut objects = vec![
        geometry(10, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0], &[&[0, 1, 2]], Vec::new()),
        model(20, "flag", "Mesh", &[]),
    ];
    let mut links = vec![Link(20, 0, ""), Link(10, 20, "")];
    let keys: &[(f64, f64)] = &[(0.0, 0.0), (1.0, 5.0), (2.0, 7.0)];
    let still: &[(f64, f64)] = &[(0.0, 0.0)];
    for (more, joined) in
        [stack("steps", 2.0), curves(50, (20, "Lcl Translation"), &[("d|X", keys), ("d|Y", still), ("d|Z", still)], 2)]
    {
        objects.extend(more);
        links.extend(joined);
    }
    let loaded = loaded(&document(false, 100.0, objects, &links));
    for (time, x) in [(0.0, 0.0), (0.9, 0.0), (1.01, 5.0), (1.9, 5.0), (2.1, 7.0)] {
        for (rest, posed) in at(&loaded, time) {
            assert_near(posed, rest + x * Vec3::X, &format!("{time} s"));
        }
    }
}

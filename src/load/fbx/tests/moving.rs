//! Skins, moving nodes and blend shapes, against closed forms.

use glam::Vec3;

use super::super::read_here;
use super::documents::{LAYER, Link, add, curves, document, geometry, model, morphed_square, skinned_strip, stack};
use super::loaded;
use super::tree::{Entry, object, one, properties, text};
use crate::loaded_mesh::LoadedMesh;
use crate::model_file::ModelFile;
use crate::selection::{MorphWeights, Selection, ShownParts};
use geometry::mesh::{Moment, Topology};
use geometry::progress::Progress;
use geometry::tessellate::deform;

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
fn bones_are_the_joints_of_the_skin() {
    let loaded = loaded(&skinned_strip());
    let bones = |time: Option<f64>| {
        let pose = time.zip(loaded.rig.as_ref()).map(|(time, rig)| rig.pose(Moment { clip: 0, time }));
        loaded.bones_in(pose.as_ref())
    };
    for time in [None, Some(0.0), Some(0.7)] {
        let [root, tip] = &bones(time)[..] else { panic!("{:?}", bones(time)) };
        assert_eq!((root.parent, tip.parent), (None, Some(0)));
        assert_eq!([&*root.name, &*tip.name], ["root", "tip"]);
        // The tip turns about itself.
        assert_near(root.place, Vec3::ZERO, "the root");
        assert_near(tip.place, 2.0 * Vec3::X, "the tip");
    }
    assert!(self::loaded(&morphed_square()).bones.is_empty());
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

/// The mesh of a document.
fn mesh_of(entries: &mut [Entry]) -> &mut Entry {
    let objects = entries.iter_mut().find(|entry| entry.name == "Objects").expect("objects");
    objects.children.iter_mut().find(|entry| entry.name == "Geometry").expect("a mesh")
}

/// What marks a mesh as a subdivision surface that is refined twice.
fn marks() -> [Entry; 2] {
    [one("Smoothness", 2), one("PreviewDivisionLevels", 2)]
}

#[test]
fn a_skin_bends_a_cage_that_is_refined() {
    let mut entries = skinned_strip();
    mesh_of(&mut entries).children.extend(marks());
    let loaded = loaded(&entries);
    assert_eq!((loaded.triangles.len(), loaded.is_refined), (4 * 16 * 2, true), "{:?}", loaded.warnings);
    for (rest, posed) in at(&loaded, 0.0) {
        assert_near(posed, rest, "at rest");
    }
    // Turned by 90 degrees about (2, 0, 0), as much as `tip` weighs there.
    let mut weights: Vec<(f32, f32)> = Vec::new();
    for (rest, posed) in at(&loaded, 1.0) {
        let turned = Vec3::new(2.0 - rest.y, rest.x - 2.0, 0.0);
        let way = turned - rest;
        if way.length() > 0.5 {
            let weight = (posed - rest).dot(way) / way.length_squared();
            assert_near(posed, rest + weight * way, &format!("{rest} lies on the way"));
            weights.push((rest.x, weight));
        }
    }
    weights.sort_by(|a, b| a.0.total_cmp(&b.0));
    assert!(weights.array_windows().all(|[a, b]| a.1 < b.1 + 1e-5), "{weights:?}");
    // The weights of the cage, 0, 0, 1/2, 1 and 1, are smoothed as its points are, by (1, 4, 1) / 6 between its ends.
    for (x, expected) in [(0.0, 0.0), (1.0, 1.0 / 12.0), (2.0, 0.5), (3.0, 11.0 / 12.0), (4.0, 1.0)] {
        let found: Vec<f32> = weights.iter().filter(|own| (own.0 - x).abs() < 1e-5).map(|own| own.1).collect();
        assert!(!found.is_empty() && found.iter().all(|own| (own - expected).abs() < 1e-5), "{x}: {found:?}");
    }
}

#[test]
fn shapes_move_a_cage_that_is_refined_and_what_only_touches_at_rest_comes_apart() {
    // Between the corners of one quadrilateral that stay, all is bilinear.
    let mut entries = morphed_square();
    mesh_of(&mut entries).children.extend(marks());
    let mesh = loaded(&entries);
    assert_eq!((mesh.triangles.len(), mesh.is_refined), (16 * 2, true), "{:?}", mesh.warnings);
    for (time, height) in [(0.0, 0.0), (0.5, 0.5), (1.0, 1.0), (1.5, 2.5), (2.0, 4.0)] {
        for (rest, posed) in at(&mesh, time) {
            assert_near(posed, rest + height * rest.x * rest.y * Vec3::Z, &format!("{rest} at {time} s"));
        }
    }
    // A second square beside it has vertices of its own.
    let both = [[0, 0], [1, 0], [1, 1], [0, 1], [1, 0], [2, 0], [2, 1], [1, 1]];
    let both: Vec<f64> = both.into_iter().flat_map(|[x, y]| [x, y, 0]).map(f64::from).collect();
    *mesh_of(&mut entries) = geometry(10, &both, &[&[0, 1, 2, 3], &[4, 5, 6, 7]], marks().into());
    let mesh = loaded(&entries);
    assert_eq!(mesh.triangles.len(), 2 * 16 * 2);
    let risen: Vec<(Vec3, f32)> = at(&mesh, 2.0).into_iter().map(|(rest, posed)| (rest, posed.z)).collect();
    assert!(risen.iter().all(|(rest, z)| *z < 1e-5 || rest.x < 1.0 + 1e-5), "{risen:?}");
    let at_corner =
        |is_risen: bool| risen.iter().any(|(rest, z)| *rest == Vec3::new(1.0, 1.0, 0.0) && (*z > 3.0) == is_risen);
    assert!(at_corner(true) && at_corner(false), "{risen:?}");
}

#[test]
fn a_cage_that_joints_move_in_part_stays_and_this_is_said() {
    let mut entries = skinned_strip();
    let vertices: Vec<f64> = (0..=5).flat_map(|x| [[x, 0, 0], [x, 1, 0]]).flatten().map(f64::from).collect();
    let polygons: Vec<Vec<i32>> = (0..5).map(|i| vec![2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1]).collect();
    let polygons: Vec<&[i32]> = polygons.iter().map(|polygon| &polygon[..]).collect();
    *mesh_of(&mut entries) = geometry(10, &vertices, &polygons, marks().into());
    let loaded = loaded(&entries);
    assert_eq!((loaded.triangles.len(), loaded.is_refined), (5 * 2, false));
    let said = loaded.warnings.iter().any(|warning| warning.contains("shown as their control cage: 1."));
    assert!(said, "{:?}", loaded.warnings);
}

#[test]
fn chosen_weights_of_shapes_are_those_at_rest() {
    let progress = Progress::new();
    let shown = ShownParts { morphs: [("rise".to_owned(), 0.75)].into(), ..ShownParts::default() };
    let selected = Selection { parts: Some(&shown), ..Selection::default() };
    let file = ModelFile { selected, ..ModelFile::from_test("test", &progress) };
    let loaded = read_here(text(&morphed_square()), &file).expect("a file without a fault");
    assert_eq!(loaded.contents.morph_targets, MorphWeights::from([("rise".to_owned(), 0.0)]), "those of the file");
    for (rest, posed) in at(&loaded, 2.0) {
        // Half of each of both shapes, and at the clip's end the second.
        let [height, end] = if rest.x * rest.y == 1.0 { [2.5, 4.0] } else { [0.0; 2] };
        assert_near(rest, Vec3::new(rest.x, rest.y, height), "at rest");
        assert_near(posed, Vec3::new(rest.x, rest.y, end), "at the end");
    }
}

#[test]
fn a_chosen_weight_stays_in_a_clip_that_moves_another_shape() {
    // Beside the shape that the clip moves, a second one moves the second corner.
    let channel = vec![one("Version", 100), one("DeformPercent", 0.0), one("FullWeights", vec![100.0])];
    let shape = vec![
        one("Version", 100),
        one("Indexes", vec![1]),
        one("Vertices", vec![0.0, 0.0, 2.0]),
        one("Normals", vec![0.0, 0.0, 0.0]),
    ];
    let objects = [
        object("Deformer", 44, "SubDeformer::smile", "BlendShapeChannel", channel),
        object("Geometry", 45, "Geometry::smile", "Shape", shape),
    ];
    let mut entries = morphed_square();
    let into = |entries: &mut [Entry], name: &str, more: Vec<Entry>| {
        let list = entries.iter_mut().find(|entry| entry.name == name).expect("a list");
        list.children.extend(more);
    };
    into(&mut entries, "Objects", objects.into());
    into(&mut entries, "Connections", [Link(44, 40, ""), Link(45, 44, "")].map(|link| link.entry()).into());
    let shown = ShownParts { morphs: [("smile".to_owned(), 0.5)].into(), ..ShownParts::default() };
    let selected = Selection { parts: Some(&shown), ..Selection::default() };
    let progress = Progress::new();
    let file = ModelFile { selected, ..ModelFile::from_test("test", &progress) };
    let loaded = read_here(text(&entries), &file).expect("a file without a fault");
    for (time, risen) in [(0.0, 0.0), (2.0, 4.0)] {
        for (rest, posed) in at(&loaded, time) {
            let height = if rest.x * (1.0 - rest.y) == 1.0 { 1.0 } else { risen * rest.x * rest.y };
            assert_near(posed, Vec3::new(rest.x, rest.y, height), &format!("{rest} at {time} s"));
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
    add(
        (&mut objects, &mut links),
        [
            stack("lift", 4.0),
            curves(50, (20, "Lcl Translation"), &[("d|X", still), ("d|Y", still), ("d|Z", rise)], 4),
            curves(60, (21, "Lcl Rotation"), &[("d|X", still), ("d|Y", still), ("d|Z", turn)], 4),
        ],
    );
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
    add(
        (&mut objects, &mut links),
        [stack("steps", 2.0), curves(50, (20, "Lcl Translation"), &[("d|X", keys), ("d|Y", still), ("d|Z", still)], 2)],
    );
    let loaded = loaded(&document(false, 100.0, objects, &links));
    for (time, x) in [(0.0, 0.0), (0.9, 0.0), (1.01, 5.0), (1.9, 5.0), (2.1, 7.0)] {
        for (rest, posed) in at(&loaded, time) {
            assert_near(posed, rest + x * Vec3::X, &format!("{time} s"));
        }
    }
}

#[test]
fn a_part_that_is_scaled_to_nothing_at_rest_grows_in_its_clip() {
    let square = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0];
    let scaling: &[(&str, &str, &[f64])] = &[("Lcl Scaling", "Lcl Scaling", &[0.0; 3])];
    let mut objects = vec![geometry(10, &square, &[&[0, 1, 2, 3]], Vec::new()), model(20, "part", "Mesh", scaling)];
    let mut links = vec![Link(20, 0, ""), Link(10, 20, "")];
    let keys: &[(f64, f64)] = &[(0.0, 0.0), (2.0, 6.0)];
    add(
        (&mut objects, &mut links),
        [stack("grow", 2.0), curves(50, (20, "Lcl Scaling"), &[("d|X", keys), ("d|Y", keys), ("d|Z", keys)], 4)],
    );
    let loaded = loaded(&document(false, 100.0, objects, &links));
    let topology = Topology::build(&loaded.mesh, &Progress::new()).expect("nobody cancels");
    assert_eq!((topology.patches.len(), topology.edge_counts().smooth), (2, 1));
    for (time, size) in [(0.0, 0.0), (1.0, 3.0), (2.0, 6.0)] {
        let mut found: Vec<_> = at(&loaded, time).into_iter().map(|(_, posed)| posed).collect();
        found.sort_by(|a, b| a.to_array().partial_cmp(&b.to_array()).expect("numbers"));
        for (own, [x, y]) in found.into_iter().zip([[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0]]) {
            assert_near(own, size * Vec3::new(x, y, 0.0), &format!("{time} s"));
        }
    }
    assert!(loaded.corners.iter().all(|corner| corner.position == Vec3::ZERO && corner.normal == Vec3::Z));
}

#[test]
fn each_node_of_a_skinned_mesh_has_a_copy_at_its_own_place() {
    let mut entries = skinned_strip();
    let placed: &[(&str, &str, &[f64])] = &[
        ("Lcl Translation", "Lcl Translation", &[0.0, 0.0, 5.0]),
        ("Lcl Rotation", "Lcl Rotation", &[0.0, 90.0, 0.0]),
    ];
    let child = |entries: &mut Vec<Entry>, name: &str, own: Vec<Entry>| {
        let list = entries.iter_mut().find(|entry| entry.name == name).expect("every file has it");
        list.children.extend(own);
    };
    child(&mut entries, "Objects", vec![model(21, "copy", "Mesh", placed)]);
    child(&mut entries, "Connections", [Link(21, 0, ""), Link(10, 21, "")].iter().map(Link::entry).collect());
    let loaded = loaded(&entries);
    for time in [0.0, 0.5, 1.0] {
        let all = at(&loaded, time);
        let (first, copy) = all.split_at(all.len() / 2);
        assert_eq!((first.len(), copy.len()), (10, 10));
        for (first, copy) in first.iter().zip(copy) {
            for (first, copy) in [(first.0, copy.0), (first.1, copy.1)] {
                let expected = Vec3::new(first.z, first.y, 5.0 - first.x);
                assert_near(copy, expected, &format!("the copy of {first} at {time} s"));
            }
        }
    }
}

#[test]
fn shapes_of_blender_are_limited_by_the_weights_of_their_vertex_group() {
    let shape = vec![
        one("Version", 100),
        one("Indexes", vec![1, 2, 3]),
        one("Vertices", [[0.0, 0.0, 1.0]; 3].concat()),
        one("Normals", vec![0.0; 9]),
    ];
    // One weight for each of the shape's vertices, where other programs write one for each shape.
    let channel = vec![one("Version", 100), one("DeformPercent", 50.0), one("FullWeights", vec![100.0, 25.0, 0.0])];
    let square = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0];
    let mut objects = vec![
        geometry(10, &square, &[&[0, 1, 2, 3]], Vec::new()),
        model(20, "square", "Mesh", &[]),
        object("Deformer", 40, "Deformer::shapes", "BlendShape", vec![one("Version", 100)]),
        object("Deformer", 41, "SubDeformer::rise", "BlendShapeChannel", channel),
        object("Geometry", 42, "Geometry::shape", "Shape", shape),
    ];
    let mut links = vec![Link(20, 0, ""), Link(10, 20, ""), Link(40, 10, ""), Link(41, 40, ""), Link(42, 41, "")];
    let keys: &[(f64, f64)] = &[(0.0, 0.0), (1.0, 100.0)];
    add(
        (&mut objects, &mut links),
        [stack("rise", 1.0), curves(50, (41, "DeformPercent"), &[("d|DeformPercent", keys)], 4)],
    );
    let mut entries = document(false, 100.0, objects, &links);
    entries[0].children.push(one("Creator", "Blender (stable FBX IO) - 2.90.0 - 4.21.3"));
    let loaded = loaded(&entries);
    let weight = |place: Vec3| match (place.x, place.y) {
        (1.0, 0.0) => 1.0,
        (1.0, 1.0) => 0.25,
        _ => 0.0,
    };
    for (rest, posed) in at(&loaded, 1.0) {
        assert_near(Vec3::Z * rest.z, Vec3::Z * 0.5 * weight(rest), &format!("{rest} at rest"));
        assert_near(posed, Vec3::new(rest.x, rest.y, weight(rest)), &format!("{rest} in the clip"));
    }
}

#[test]
fn layers_that_are_muted_or_beside_one_that_plays_alone_move_nothing() {
    let moved = |switches: [(&str, &str); 2]| {
        let mut objects = vec![
            geometry(10, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0], &[&[0, 1, 2]], Vec::new()),
            model(20, "flag", "Mesh", &[]),
            model(21, "other", "Mesh", &[]),
        ];
        let mut links = vec![Link(20, 0, ""), Link(21, 0, ""), Link(10, 20, ""), Link(10, 21, "")];
        let keys: &[(f64, f64)] = &[(0.0, 0.0), (1.0, 5.0)];
        add(
            (&mut objects, &mut links),
            [
                stack("two layers", 1.0),
                curves(50, (20, "Lcl Translation"), &[("d|X", keys)], 4),
                curves(60, (21, "Lcl Translation"), &[("d|Y", keys)], 4),
            ],
        );
        // The second curve is in another layer.
        objects.push(object("AnimationLayer", LAYER + 1, "AnimLayer::second", "", vec![one("Version", 100)]));
        links.push(Link(LAYER + 1, 900, ""));
        links.iter_mut().filter(|link| (link.0, link.1) == (60, LAYER)).for_each(|link| link.1 = LAYER + 1);
        for (name, value) in switches.into_iter().filter(|(name, _)| !name.is_empty()) {
            let layer =
                objects.iter_mut().find(|own| own.values.get(1).is_some_and(|own| format!("{own:?}").contains(value)));
            layer.expect("a layer").children.push(properties(&[(name, "bool", &[1.0])]));
        }
        let loaded = loaded(&document(false, 100.0, objects, &links));
        let clip = loaded.rig.as_ref().map(|_| at(&loaded, 1.0));
        clip.map_or([0.0; 2], |all| {
            let [first, other] = [all[0], all[all.len() / 2]];
            [first.1.x - first.0.x, other.1.y - other.0.y]
        })
    };
    let none = ("", "");
    assert_eq!(moved([none, none]), [5.0, 5.0]);
    assert_eq!(moved([("Mute", "second"), none]), [5.0, 0.0]);
    assert_eq!(moved([("Mute", "base"), none]), [0.0, 5.0]);
    assert_eq!(moved([("Solo", "second"), none]), [0.0, 5.0]);
    assert_eq!(moved([("Mute", "base"), ("Mute", "second")]), [0.0, 0.0]);
}

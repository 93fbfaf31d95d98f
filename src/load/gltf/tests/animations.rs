//! Animated documents: what moves nodes, and any of them with random changes.

mod growing;
mod left_out;
mod morph_targets;
mod skins;
mod tangents;

use proptest::prelude::*;

use super::*;
use geometry::mesh::rig::AnimatedCounts;
use geometry::mesh::{Moment, Rig};
use geometry::tessellate::deform;

impl Draft {
    /// Adds an animation with one channel, linear between key frames.
    fn animate(&mut self, node: usize, path: &str, kind: &str, times: &[f32], values: &[f32]) {
        let (input, output) = (self.floats("SCALAR", times), self.floats(kind, values));
        let animation = json!({
            "samplers": [{ "input": input, "output": output }],
            "channels": [{ "sampler": 0, "target": { "node": node, "path": path } }],
        });
        if self.root.get("animations").is_none() {
            self.root["animations"] = json!([]);
        }
        self.push("animations", animation);
    }

    /// Moves a node to (0, 0, 8) in two seconds.
    fn move_node(&mut self, node: usize) {
        self.animate(node, "translation", "VEC3", &[0.0, 2.0], &[0.0, 0.0, 0.0, 0.0, 0.0, 8.0]);
    }
}

fn rig(mesh: &Mesh) -> &Rig {
    mesh.rig.as_deref().unwrap()
}

fn topology(mesh: &Mesh) -> Topology {
    Topology::build(mesh, &Progress::new()).unwrap()
}

fn posed(mesh: &Mesh, time: f64) -> Mesh {
    deform(mesh, &topology(mesh), &rig(mesh).pose(Moment { clip: 0, time })).0
}

/// Checks that the pose at rest is the mesh that was read.
fn assert_rests(mesh: &Mesh) {
    let deformed = deform(mesh, &topology(mesh), &rig(mesh).rest()).0;
    for (own, read) in deformed.corners.iter().zip(&mesh.corners) {
        let slack = 1e-6 * (1.0 + read.position.length());
        assert!(own.position.distance(read.position) < slack, "{} {}", own.position, read.position);
        assert!(own.normal.distance(read.normal) < 1e-6, "{} {}", own.normal, read.normal);
    }
}

fn skinned() -> Draft {
    let mut draft = triangle();
    let joints = draft.accessor(&[0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0], 5121, "VEC4", 3);
    let weights = draft.floats("VEC4", &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.5, 0.5, 0.0, 0.0]);
    let bind = |x| glam::Mat4::from_translation(Vec3::X * x).to_cols_array();
    let binds = draft.floats("MAT4", &[bind(0.0), bind(-1.0)].concat());
    let attributes = &mut draft.root["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = json!(joints);
    attributes["WEIGHTS_0"] = json!(weights);
    draft.root["skins"] = json!([{ "joints": [1, 2], "inverseBindMatrices": binds }]);
    draft.root["nodes"] =
        json!([{ "mesh": 0, "skin": 0, "translation": [9, 9, 9] }, { "children": [2] }, { "translation": [1, 0, 0] }]);
    // A quarter turn around Y of the joint that moves vertex 1.
    let half = 0.5_f32.sqrt();
    draft.animate(2, "rotation", "VEC4", &[0.0, 1.0], &[0.0, 0.0, 0.0, 1.0, 0.0, half, 0.0, half]);
    draft
}

/// Gives a triangle a normal map, and the tangents that it says.
pub(super) fn normal_mapped(mut draft: Draft, tangent: [f32; 4]) -> Draft {
    let uvs = draft.floats("VEC2", &[0.0, 1.0, 1.0, 1.0, 0.0, 0.0]);
    let tangents = draft.floats("VEC4", &[tangent; 3].concat());
    let primitive = &mut draft.root["meshes"][0]["primitives"][0];
    (primitive["attributes"]["TEXCOORD_0"], primitive["attributes"]["TANGENT"]) = (json!(uvs), json!(tangents));
    primitive["material"] = json!(0);
    draft.root["materials"] = json!([{ "normalTexture": { "index": 0 } }]);
    draft.root["textures"] = json!([{ "source": 0 }]);
    draft.root["images"] = json!([{ "uri": files::png_uri() }]);
    draft
}

#[test]
fn nodes_move_their_children() {
    let mut draft = triangle();
    draft.root["scenes"] = json!([{ "nodes": [1] }]);
    draft.root["nodes"] = json!([
        { "mesh": 0, "scale": [-2.0, 1.0, 3.0], "rotation": [0.6, 0.0, 0.0, 0.8] },
        { "children": [2], "translation": [0.0, 0.0, 5.0], "scale": [1.0, 7.0, 1.0] },
        { "children": [0], "rotation": [0.0, 0.6, 0.0, 0.8] },
    ]);
    draft.move_node(1);
    let mesh = draft.read().unwrap();
    assert_rests(&mesh);
    let (start, end) = (posed(&mesh, 0.0), posed(&mesh, 2.0));
    for ((start, end), rest) in start.corners.iter().zip(&end.corners).zip(&mesh.corners) {
        assert!(start.position.distance(rest.position - 5.0 * Vec3::Z) < 1e-5);
        assert!(end.position.distance(start.position + 8.0 * Vec3::Z) < 1e-5);
        assert!(end.normal.distance(rest.normal) < 1e-6);
    }
    assert_eq!(rig(&mesh).animated_counts(&rig(&mesh).clips[0]), AnimatedCounts { joints: 0, nodes: 1, targets: 0 });
}

/// Two triangles with a common edge, on a node each.
fn touching() -> Draft {
    let mut draft = triangle();
    let (at, n) =
        (draft.vectors(&[[1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]), draft.vectors(&[[0.0, 0.0, 1.0]; 3]));
    draft.push("meshes", json!({ "primitives": [{ "attributes": { "POSITION": at, "NORMAL": n } }] }));
    draft.root["scenes"] = json!([{ "nodes": [2] }]);
    draft.root["nodes"] = json!([{ "mesh": 0 }, { "mesh": 1 }, { "children": [0, 1] }]);
    draft
}

#[test]
fn corners_that_move_apart_are_not_welded() {
    let points = |moved: Option<usize>, tolerance: f32| {
        let mut draft = touching();
        if let Some(node) = moved {
            draft.move_node(node);
        }
        let mesh = draft.read().unwrap();
        assert_eq!(mesh.rig.is_some(), moved.is_some());
        Topology::build_within(&mesh, tolerance, &Progress::new()).unwrap().points.len()
    };
    for tolerance in [0.0, 1e-3] {
        assert_eq!(points(None, tolerance), 4, "nothing moves");
        assert_eq!(points(Some(2), tolerance), 4, "both move together");
        assert_eq!(points(Some(1), tolerance), 6, "one moves");
    }
}

proptest! {
    #[test]
    fn random_animated_documents_never_panic(
        number in 0_usize..200,
        value in prop_oneof![any::<i64>().prop_map(|x| json!(x)), any::<f64>().prop_map(|x| json!(x)), Just(json!([])), Just(json!("x"))],
        byte in any::<(prop::sample::Index, u8)>(),
    ) {
        let mut draft = normal_mapped(skinned(), [1.0, 0.0, 0.0, 1.0]);
        let target = draft.vectors(&TRIANGLE);
        let displacements = json!({ "POSITION": target, "NORMAL": target, "TANGENT": target });
        draft.root["meshes"][0]["primitives"][0]["targets"] = json!([displacements]);
        draft.animate(0, "weights", "SCALAR", &[0.0, 1.0], &[0.0, 1.0]);
        draft.move_node(1);
        let at = byte.0.index(draft.bytes.len());
        draft.bytes[at] = byte.1;
        let mut open = vec![&mut draft.root];
        let mut numbers = Vec::new();
        while let Some(next) = open.pop() {
            match next {
                Value::Array(values) => open.extend(values),
                Value::Object(values) => open.extend(values.values_mut()),
                Value::Number(_) => numbers.push(next),
                _ => {}
            }
        }
        let count = numbers.len();
        *numbers[number % count] = value;
        if let Ok(mesh) = draft.read() && let Some(rig) = &mesh.rig {
            let topology = topology(&mesh);
            for clip in 0..rig.clips.len() {
                for time in [0.0, 0.3, 1e9] {
                    let deformed = deform(&mesh, &topology, &rig.pose(Moment { clip, time })).0;
                    prop_assert!(deformed.corners.iter().all(|corner| corner.position.is_finite() && corner.normal.is_finite()));
                    prop_assert!(deformed.details.iter().flat_map(|details| details.iter()).all(|detail| detail.tangent.is_finite()));
                }
            }
        }
    }
}

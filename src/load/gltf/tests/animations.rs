//! Animated documents, and animations that are left out.

use proptest::prelude::*;

use super::*;
use crate::selection::{MorphWeights, ShownParts};
use geometry::mesh::rig::AnimatedCounts;
use geometry::mesh::{Moment, Pose, Rig};
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

#[test]
fn skins_follow_their_joints() {
    let mesh = skinned().read().unwrap();
    assert_rests(&mesh);
    assert_eq!(positions(&mesh), TRIANGLE);
    let bent = posed(&mesh, 1.0);
    // Vertex 2 is half at its own position, and half at this one turned around (1, 0, 0), which is (1, 1, 1).
    let expected = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 1.0, 0.5]];
    for (own, expected) in positions(&bent).into_iter().zip(expected) {
        assert!(Vec3::from(own).distance(expected.into()) < 1e-6, "{own:?} {expected:?}");
    }
    let normals: Vec<Vec3> = bent.corners.iter().map(|corner| corner.normal).collect();
    assert!(normals[0].distance(Vec3::Z) < 1e-6 && normals[1].distance(Vec3::X) < 1e-6, "{normals:?}");
    assert!(normals[2].distance(Vec3::new(1.0, 0.0, 1.0).normalize()) < 1e-6, "{normals:?}");
    let clip = &rig(&mesh).clips[0];
    assert_eq!((clip.name.as_str(), clip.duration), ("animation 0", 1.0));
    assert_eq!(rig(&mesh).animated_counts(clip), AnimatedCounts { joints: 1, nodes: 0, targets: 0 });
}

/// The places of a mesh's bones, and the bones above them.
fn bones(mesh: &Mesh, pose: Option<&Pose>) -> Vec<([f32; 3], Option<u32>)> {
    mesh.bones_in(pose).iter().map(|bone| (bone.place.to_array(), bone.parent)).collect()
}

#[test]
fn bones_are_the_joints_of_skins_in_any_pose_and_without_clips() {
    let mut draft = skinned();
    draft.move_node(1);
    let mesh = draft.read().unwrap();
    let rest = [([0.0; 3], None), ([1.0, 0.0, 0.0], Some(0))];
    assert_eq!(bones(&mesh, None), rest);
    let pose = rig(&mesh).pose(Moment { clip: 1, time: 1.0 });
    let moved = [([0.0, 0.0, 4.0], None), ([1.0, 0.0, 4.0], Some(0))];
    assert_eq!(bones(&mesh, Some(&pose)), moved);
    // A deformed mesh has no rig, and its bones are where it is.
    assert_eq!(bones(&deform(&mesh, &topology(&mesh), &pose).0, None), moved);
    draft.root.as_object_mut().expect("a document").remove("animations");
    let still = draft.read().unwrap();
    assert!(still.rig.is_none());
    assert_eq!(bones(&still, None), rest);
    // A node between two joints is none itself.
    let nodes = draft.root["nodes"].as_array_mut().expect("nodes");
    nodes[1] = json!({ "children": [3] });
    nodes.push(json!({ "translation": [0, 0, 5], "children": [2] }));
    assert_eq!(bones(&draft.read().unwrap(), None), [([0.0; 3], None), ([1.0, 0.0, 5.0], Some(0))]);
    let (long, mut named) = ("Hip\n".repeat(100), skinned());
    named.root["nodes"][1]["name"] = json!(long);
    let names: Vec<_> = named.read().unwrap().bones.iter().map(|bone| bone.name.to_string()).collect();
    assert_eq!(names, [geometry::names::shown(&long), "node 2".to_owned()]);
    let mut moving = triangle();
    moving.move_node(0);
    assert_eq!(bones(&moving.read().unwrap(), None), [], "a node that a clip moves is no joint");
}

#[test]
fn skins_with_joints_that_are_missing_or_above_themselves_are_refused() {
    let mut missing = skinned();
    missing.root["skins"][0]["joints"] = json!([1, 9]);
    assert!(message(&missing).contains("/skins/0/joints/1"), "{}", message(&missing));
    let mut circle = skinned();
    circle.root["nodes"][2]["children"] = json!([1]);
    assert!(message(&circle).contains("its own ancestor"), "{}", message(&circle));
}

#[test]
fn nodes_that_share_a_mesh_are_each_posed_by_their_own_skin() {
    let mut draft = skinned();
    let other = draft.floats("MAT4", &[glam::Mat4::IDENTITY.to_cols_array(); 2].concat());
    let skins = draft.root["skins"].as_array_mut().expect("skins");
    skins.push(json!({ "joints": [4, 4], "inverseBindMatrices": other }));
    let nodes = draft.root["nodes"].as_array_mut().expect("nodes");
    nodes.extend([json!({ "mesh": 0, "skin": 1 }), json!({ "translation": [0, 0, 7] })]);
    draft.root["scenes"][0]["nodes"] = json!([0, 1, 3, 4]);
    let mesh = draft.read().expect("a document without a fault").mesh;
    let own = positions(&mesh);
    let expected: Vec<_> = TRIANGLE.into_iter().chain(TRIANGLE.map(|[x, y, z]| [x, y, z + 7.0])).collect();
    assert_eq!(own, expected);
    // Only the first one's joint turns.
    assert_eq!(positions(&posed(&mesh, 1.0))[3..], expected[3..]);
}

/// A square of two triangles on node 0, which is scaled to nothing at (1, 2, 3), and below a node that isn't moved. A clip scales it
/// to 4.
fn growing(normals: Option<[f32; 3]>) -> Draft {
    let mut draft = Draft::new();
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let (positions, indices) = (draft.vectors(&square), draft.indices(&[0, 1, 2, 0, 2, 3]));
    let mut attributes = json!({ "POSITION": positions });
    if let Some(normal) = normals {
        attributes["NORMAL"] = json!(draft.vectors(&[normal; 4]));
    }
    draft.primitive(json!({ "attributes": attributes, "indices": indices }));
    draft.root["nodes"] = json!([{ "mesh": 0, "translation": [1, 2, 3], "scale": [0, 0, 0] }, { "children": [0] }]);
    draft.root["scenes"][0]["nodes"] = json!([1]);
    draft.animate(0, "scale", "VEC3", &[0.0, 1.0], &[[0.0; 3], [4.0; 3]].concat());
    draft
}

/// Checks that a growing square is at (1, 2, 3) at rest, and whole and as large as its clip says later.
fn assert_grows(draft: &Draft, normal: Vec3) {
    let mesh = draft.read().expect("a document without a fault").mesh;
    let own = topology(&mesh);
    assert_eq!((own.patches.len(), own.degenerate, own.edge_counts().smooth), (2, 0, 1));
    let place = Vec3::new(1.0, 2.0, 3.0);
    assert!(positions(&mesh).into_iter().all(|at| Vec3::from(at) == place), "{:?}", positions(&mesh));
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    for time in [0.0, 0.5, 1.0] {
        let grown = posed(&mesh, time);
        for (at, [x, y]) in positions(&grown).into_iter().zip(square) {
            assert!(
                Vec3::from(at).distance(place + 4.0 * time as f32 * Vec3::new(x, y, 0.0)) < 1e-6,
                "{at:?} at {time} s"
            );
        }
        if time > 0.0 {
            assert!(grown.corners.iter().all(|corner| corner.normal.distance(normal) < 1e-6), "{:?}", grown.corners);
        }
    }
}

#[test]
fn a_part_that_is_scaled_to_nothing_at_rest_grows_in_its_clip() {
    assert_grows(&growing(None), Vec3::Z);
    let tilted = Vec3::new(0.0, 0.6, 0.8);
    assert_grows(&growing(Some(tilted.to_array())), tilted);
    // It hangs below the node that grows.
    let mut below = growing(None);
    below.root["nodes"] = json!([{ "translation": [1, 2, 3], "scale": [0, 0, 0], "children": [1] }, { "mesh": 0, "scale": [0.5, 0.5, 0.5] }]);
    below.root["scenes"][0]["nodes"] = json!([0]);
    below.root["animations"] = json!([]);
    below.animate(0, "scale", "VEC3", &[0.0, 1.0], &[[0.0; 3], [8.0; 3]].concat());
    assert_grows(&below, Vec3::Z);
    // A joint of its skin grows.
    let mut skinned = growing(None);
    let joints = skinned.accessor(&[0; 16], 5121, "VEC4", 4);
    let weights = skinned.floats("VEC4", &[[1.0, 0.0, 0.0, 0.0]; 4].concat());
    let attributes = &mut skinned.root["meshes"][0]["primitives"][0]["attributes"];
    (attributes["JOINTS_0"], attributes["WEIGHTS_0"]) = (json!(joints), json!(weights));
    skinned.root["skins"] = json!([{ "joints": [0] }]);
    skinned.root["nodes"] =
        json!([{ "translation": [1, 2, 3], "scale": [0, 0, 0] }, { "mesh": 0, "skin": 0, "children": [0] }]);
    assert_grows(&skinned, Vec3::Z);
}

#[test]
fn a_part_that_no_clip_grows_stays_where_it_is() {
    let mut still = growing(None);
    still.root["animations"] = json!([]);
    still.move_node(0);
    let mesh = still.read().expect("a document without a fault").mesh;
    assert_eq!(topology(&mesh).degenerate, 2);
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

fn tangents(mesh: &Mesh) -> Vec<(Vec3, f32)> {
    let details = mesh.details.as_ref().expect("details");
    details.iter().map(|detail| (detail.tangent, detail.bitangent_sign)).collect()
}

#[test]
fn tangents_follow_their_joints() {
    let mesh = normal_mapped(skinned(), [1.0, 0.0, 0.0, -1.0]).read().unwrap();
    assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
    assert_eq!(tangents(&mesh), [(Vec3::X, -1.0); 3]);
    let bent = tangents(&posed(&mesh, 1.0));
    let half = Vec3::new(1.0, 0.0, -1.0).normalize();
    for ((tangent, sign), expected) in bent.into_iter().zip([Vec3::X, Vec3::NEG_Z, half]) {
        assert!(tangent.distance(expected) < 1e-6 && sign == -1.0, "{tangent} {sign}");
    }
}

#[test]
fn morph_targets_turn_tangents_along_with_normals() {
    let mut draft = normal_mapped(triangle(), [1.0, 0.0, 0.0, -1.0]);
    let still = draft.vectors(&[[0.0; 3]; 3]);
    // From +Z to +X.
    let turn = draft.vectors(&[[1.0, 0.0, -1.0]; 3]);
    draft.root["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": still, "NORMAL": turn }]);
    draft.animate(0, "weights", "SCALAR", &[0.0, 1.0], &[0.0, 1.0]);
    let assert_turned = |mesh: &Mesh, tangent: Vec3| {
        for (own, sign) in tangents(mesh) {
            assert!(own.distance(tangent) < 1e-6 && sign == -1.0, "{own} {sign}, not {tangent}");
        }
    };
    let mesh = draft.read().unwrap();
    assert_turned(&mesh, Vec3::X);
    assert_turned(&posed(&mesh, 0.0), Vec3::X);
    assert_turned(&posed(&mesh, 1.0), Vec3::NEG_Z);
    draft.root["meshes"][0]["weights"] = json!([1.0]);
    let mesh = draft.read().unwrap();
    assert_turned(&mesh, Vec3::NEG_Z);
    assert_turned(&posed(&mesh, 0.0), Vec3::X);
    assert_turned(&posed(&mesh, 1.0), Vec3::NEG_Z);
}

/// A triangle with a normal map and one animated morph target, which moves each point up by its x, so that the normals stay and
/// the tangents, along x at rest, should become (1, weight, 0).
fn sheared() -> Draft {
    let mut draft = normal_mapped(triangle(), [1.0, 0.0, 0.0, 1.0]);
    let moves = draft.vectors(&TRIANGLE.map(|[x, ..]| [0.0, x, 0.0]));
    draft.root["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": moves }]);
    draft.animate(0, "weights", "SCALAR", &[0.0, 1.0], &[0.0, 1.0]);
    draft
}

/// Gives a morph target displacements of tangents.
fn displace_tangents(draft: &mut Draft, target: usize, displacements: &[[f32; 3]]) {
    let list = draft.vectors(displacements);
    draft.root["meshes"][0]["primitives"][0]["targets"][target]["TANGENT"] = json!(list);
}

fn assert_tangents(mesh: &Mesh, expected: [Vec3; 3]) {
    let found = tangents(mesh);
    let are_near = found.iter().zip(expected).all(|((own, _), expected)| own.distance(expected.normalize()) < 1e-6);
    assert!(are_near && found.len() == 3, "{found:?}, not {expected:?}");
}

#[test]
fn morph_targets_displace_tangents_as_they_would_be_made() {
    // What MikkTSpace makes of the sheared triangle itself.
    let mut made = normal_mapped(triangle(), [0.0; 4]);
    let positions = made.vectors(&TRIANGLE.map(|[x, y, z]| [x, y + x, z]));
    let primitive = &mut made.root["meshes"][0]["primitives"][0];
    primitive["attributes"]["POSITION"] = json!(positions);
    primitive["attributes"].as_object_mut().expect("attributes").remove("TANGENT");
    let half = Vec3::new(1.0, 1.0, 0.0);
    assert_tangents(&made.read().unwrap(), [half; 3]);
    for node in [json!({ "mesh": 0 }), json!({ "mesh": 0, "scale": [3.0, 3.0, 3.0] })] {
        let mut draft = sheared();
        displace_tangents(&mut draft, 0, &[[0.0, 1.0, 0.0]; 3]);
        draft.root["nodes"][0] = node;
        for rest in [0.0, 1.0] {
            draft.root["meshes"][0]["weights"] = json!([rest]);
            let mesh = draft.read().unwrap();
            assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
            assert_tangents(&mesh, [Vec3::new(1.0, rest, 0.0); 3]);
            for time in [0.0, 0.5, 1.0] {
                assert_tangents(&posed(&mesh, time), [Vec3::new(1.0, time as f32, 0.0); 3]);
            }
        }
        draft.root.as_object_mut().expect("a document").remove("animations");
        assert_tangents(&draft.read().unwrap(), [half; 3]);
    }
}

/// Displacements are added before joints turn the sum, and the bitangent's sign stays.
#[test]
fn displaced_tangents_follow_their_joints() {
    let mut draft = normal_mapped(skinned(), [2.0, 0.0, 0.0, -1.0]);
    draft.root["meshes"][0]["primitives"][0]["targets"] = json!([{}]);
    displace_tangents(&mut draft, 0, &[[0.0, 2.0, 0.0]; 3]);
    let (clip, one) = (draft.root["animations"][0].clone(), draft.floats("SCALAR", &[0.0, 1.0]));
    draft.root["animations"] = json!([{
        "samplers": [clip["samplers"][0], { "input": one, "output": one }],
        "channels": [clip["channels"][0], { "sampler": 1, "target": { "node": 0, "path": "weights" } }],
    }]);
    let mesh = draft.read().unwrap();
    assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
    assert_tangents(&mesh, [Vec3::X; 3]);
    let bent = posed(&mesh, 1.0);
    // Half of a quarter turn, which is a mean of matrices, makes (1, 1, 0) this.
    let half_turned = Vec3::new(0.5, 1.0, -0.5);
    assert_tangents(&bent, [Vec3::new(1.0, 1.0, 0.0), Vec3::new(0.0, 1.0, -1.0), half_turned]);
    assert!(tangents(&bent).iter().all(|(_, sign)| *sign == -1.0));
}

/// Two primitives that differ in nothing but which of two targets displaces the tangent of vertex 1, as a sparse list says.
#[test]
fn each_target_displaces_its_own_tangents() {
    let mut draft = sheared();
    let (place, values) = (draft.view(&[1]), draft.view(bytemuck::bytes_of(&[0.0_f32, 2.0, 0.0])));
    let sparse = json!({
        "componentType": 5126, "type": "VEC3", "count": 3,
        "sparse": {
            "count": 1,
            "indices": { "bufferView": place, "componentType": 5121 },
            "values": { "bufferView": values },
        },
    });
    let sparse = json!({ "TANGENT": draft.push("accessors", sparse) });
    let mut other = draft.root["meshes"][0]["primitives"][0].clone();
    other["targets"] = json!([{}, sparse]);
    draft.root["meshes"][0]["primitives"][0]["targets"] = json!([sparse, {}]);
    draft.primitive(other);
    draft.root["animations"] = json!([]);
    draft.animate(0, "weights", "SCALAR", &[0.0, 1.0], &[0.0, 0.0, 1.0, 0.0]);
    draft.animate(0, "weights", "SCALAR", &[0.0, 1.0], &[0.0, 0.0, 0.0, 1.0]);
    let mesh = draft.read().unwrap();
    assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
    let displaced = Vec3::new(1.0, 2.0, 0.0).normalize();
    for clip in 0..2 {
        let posed = deform(&mesh, &topology(&mesh), &rig(&mesh).pose(Moment { clip, time: 1.0 })).0;
        for (primitive, triangle) in mesh.triangles.iter().enumerate() {
            let found = triangle.map(|corner| tangents(&posed)[corner as usize].0);
            let expected = [Vec3::X, if primitive == clip { displaced } else { Vec3::X }, Vec3::X];
            let are_near = found.iter().zip(expected).all(|(own, expected)| own.distance(expected) < 1e-6);
            assert!(are_near, "clip {clip}, primitive {primitive}: {found:?}, not {expected:?}");
        }
    }
}

#[test]
fn displacements_of_tangents_that_are_broken_cost_a_warning() {
    let mut draft = sheared();
    displace_tangents(&mut draft, 0, &[[0.0, 1.0, 0.0]; 2]);
    let mesh = draft.read().unwrap();
    let [warning] = &mesh.warnings[..] else { panic!("{:?}", mesh.warnings) };
    assert!(warning.contains("TANGENT of a morph target of") && warning.ends_with("it is left out."), "{warning}");
    assert_tangents(&posed(&mesh, 1.0), [Vec3::X; 3]);
    // Numbers that aren't finite are 0, as those of positions and normals are.
    displace_tangents(&mut draft, 0, &[[f32::NAN, 1.0, 0.0], [f32::INFINITY; 3], [0.0, 1.0, f32::NEG_INFINITY]]);
    let mesh = draft.read().unwrap();
    let half = Vec3::new(1.0, 1.0, 0.0);
    assert_tangents(&posed(&mesh, 1.0), [half, Vec3::X, half]);
    // A pose whose numbers leave f32 is the pose at rest.
    displace_tangents(&mut draft, 0, &[[0.0, f32::MAX, 0.0]; 3]);
    assert_tangents(&posed(&draft.read().unwrap(), 1.0), [Vec3::X; 3]);
}

#[test]
fn tangents_of_nodes_turn_and_mirror_with_them() {
    let mut draft = normal_mapped(triangle(), [1.0, 0.0, 0.0, 1.0]);
    draft.root["nodes"][0] = json!({ "mesh": 0, "scale": [-2.0, 1.0, 1.0] });
    draft.animate(0, "scale", "VEC3", &[0.0, 1.0], &[-2.0, 1.0, 1.0, 3.0, 1.0, 1.0]);
    let mesh = draft.read().unwrap();
    assert_eq!(tangents(&mesh), [(Vec3::NEG_X, -1.0); 3]);
    assert_eq!(tangents(&posed(&mesh, 0.0)), [(Vec3::NEG_X, -1.0); 3]);
    assert_eq!(tangents(&posed(&mesh, 1.0)), [(Vec3::X, 1.0); 3], "no longer mirrored");
}

#[test]
fn morph_targets_follow_their_weights() {
    let mut draft = triangle();
    let (move_up, turn) = (draft.vectors(&[[0.0, 0.0, 2.0]; 3]), draft.vectors(&[[3.0, 0.0, 0.0]; 3]));
    draft.root["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": move_up }, { "NORMAL": turn }]);
    draft.root["meshes"][0]["weights"] = json!([0.5, 0.0]);
    draft.root["nodes"][0]["scale"] = json!([1.0, 1.0, 2.0]);
    draft.animate(0, "weights", "SCALAR", &[0.0, 1.0], &[0.0, 0.0, 1.0, 1.0]);
    let mesh = draft.read().unwrap();
    assert_rests(&mesh);
    assert!(positions(&mesh).iter().all(|[_, _, z]| *z == 2.0), "half of the target, and the node");
    let bent = posed(&mesh, 1.0);
    assert!(positions(&bent).iter().all(|[_, _, z]| *z == 4.0));
    // (3, 0, 1) transformed by the inverse of the scale.
    let expected = Vec3::new(3.0, 0.0, 0.5).normalize();
    assert!(bent.corners.iter().all(|corner| corner.normal.distance(expected) < 1e-6));
    assert_eq!(rig(&mesh).animated_counts(&rig(&mesh).clips[0]), AnimatedCounts { joints: 0, nodes: 0, targets: 2 });
}

#[test]
fn chosen_weights_take_the_place_of_those_at_rest() {
    let mut draft = triangle();
    let (move_up, turn) = (draft.vectors(&[[0.0, 0.0, 2.0]; 3]), draft.vectors(&[[3.0, 0.0, 0.0]; 3]));
    let primitive = &mut draft.root["meshes"][0]["primitives"][0];
    primitive["targets"] = json!([{ "POSITION": move_up }, { "NORMAL": turn }]);
    primitive["extras"] = json!({ "targetNames": ["Up"] });
    draft.root["meshes"][0]["weights"] = json!([0.5]);
    let chosen = MorphWeights::from([("Up".to_owned(), 0.25)]);
    fn read_as(draft: &Draft, morphs: &MorphWeights) -> LoadedMesh {
        let (bytes, progress) = (draft.document().to_string().into_bytes(), Progress::new());
        let shown = ShownParts { morphs: morphs.clone(), ..ShownParts::default() };
        let selected = Selection { parts: Some(&shown), ..Selection::default() };
        read(bytes, &ModelFile { selected, ..ModelFile::from_test("draft", &progress) }).expect("no fault")
    }
    let all_at = |mesh: &Mesh, height: f32| positions(mesh).iter().all(|[_, _, z]| *z == height);
    let (own, still) = (read_as(&draft, &MorphWeights::new()), read_as(&draft, &chosen));
    assert!(all_at(&own, 1.0) && all_at(&still, 0.5) && still.rig.is_none());
    let listed = MorphWeights::from([("Up".to_owned(), 0.5), ("mesh 0 target 1".to_owned(), 0.0)]);
    assert_eq!((&own.contents.morph_targets, &still.contents.morph_targets), (&listed, &listed));
    draft.animate(0, "weights", "SCALAR", &[0.0, 1.0], &[0.0, 0.0, 1.0, 1.0]);
    let moving = read_as(&draft, &chosen);
    assert_rests(&moving);
    assert!(all_at(&moving, 0.5));
    assert!(all_at(&posed(&moving, 1.0), 2.0), "the clip moves the target");
    // A node's own weights come before those of its mesh, which are two nodes' then.
    draft.root["nodes"] = json!([{ "mesh": 0, "weights": [1.0, 0.0] }, { "mesh": 0 }]);
    draft.root["scenes"] = json!([{ "nodes": [0, 1] }]);
    draft.root["meshes"][0]["weights"] = json!([2.0]);
    let heights: Vec<f32> = positions(&read_as(&draft, &MorphWeights::new())).iter().map(|[_, _, z]| *z).collect();
    assert_eq!(heights, [2.0, 2.0, 2.0, 4.0, 4.0, 4.0]);
    let node_first = read_as(&draft, &chosen);
    assert_eq!(node_first.contents.morph_targets["Up"], 1.0);
    assert!(all_at(&node_first, 0.5), "both nodes");
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

#[test]
fn computed_normals_turn_too() {
    let mut draft = skinned();
    draft.root["meshes"][0]["primitives"][0]["attributes"].as_object_mut().unwrap().remove("NORMAL");
    draft.root["nodes"][1]["rotation"] = json!([0.5, 0.5, 0.5, 0.5]);
    draft.root["nodes"][1]["scale"] = json!([1.0, -2.0, 3.0]);
    let mesh = draft.read().unwrap();
    assert!(mesh.repairs.normals_made == 3);
    assert_rests(&mesh);
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

#[test]
fn morph_targets_that_part_an_edge_part_its_points() {
    let mut draft = touching();
    let second = draft.root["meshes"][1]["primitives"][0].clone();
    draft.primitive(second);
    draft.root["scenes"] = json!([{ "nodes": [0] }]);
    let (still, apart) = (draft.vectors(&[[0.0; 3]; 3]), draft.vectors(&[[0.0, 0.0, 1.0], [0.0; 3], [0.0; 3]]));
    draft.animate(0, "weights", "SCALAR", &[0.0, 1.0], &[0.0, 1.0]);
    for (target, points) in [(still, 4), (apart, 5)] {
        draft.root["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": still }]);
        draft.root["meshes"][0]["primitives"][1]["targets"] = json!([{ "POSITION": target }]);
        assert_eq!(topology(&draft.read().unwrap()).points.len(), points);
    }
}

#[test]
fn bad_animations_are_left_out_with_a_warning() {
    let changes: [(&str, Value, &str); 14] = [
        ("/samplers/0/input", json!(77), "channel 0 names accessor 77, but /accessors has 4"),
        ("/samplers/0/input", json!("no"), "it can't be read (invalid type: string \"no\", expected usize)"),
        ("/samplers/0/interpolation", json!("CUBIC"), "channel 0 has the unknown interpolation \"CUBIC\""),
        ("/samplers/0/interpolation", json!("CUBICSPLINE"), "channel 0 has 6 numbers for 2 key frames of 9"),
        ("/channels/0/sampler", json!(3), "channel 0 uses sampler 3, but the animation has 1"),
        ("/channels/0/target/node", json!(9), "channel 0 moves node 9, but /nodes has 1"),
        (
            "/channels/0/target/path",
            json!("rotation"),
            "channel 0 has values in /accessors/3, which has Vec3 elements, but 4 numbers an element are needed",
        ),
        (
            "/channels/0/target/path",
            json!("weights"),
            "channel 0 changes weights of morph targets of node 0, which has none",
        ),
        ("/accessors/2/count", json!(1), "channel 0 has 6 numbers for 1 key frames of 3"),
        ("/accessors/2/count", json!(4), "which needs 16 bytes of /bufferViews/2, which has 8"),
        ("/accessors/3/count", json!(1u64 << 60), "above the limit of 67108864 animated numbers"),
        ("/nodes/0/matrix", json!(glam::Mat4::IDENTITY.to_cols_array()), "moves node 0, whose transform is a matrix"),
        ("/times", json!([2.0, 2.0]), "channel 0 has times that are negative or don't increase"),
        ("/times", json!([-1.0, 2.0]), "channel 0 has times that are negative or don't increase"),
    ];
    for (pointer, value, expected) in changes {
        let mut draft = triangle();
        draft.move_node(0);
        if pointer == "/times" {
            let times: Vec<f32> = serde_json::from_value(value).unwrap();
            let input = draft.floats("SCALAR", &times);
            draft.root["animations"][0]["samplers"][0]["input"] = json!(input);
        } else {
            let is_own = pointer.starts_with("/samplers") || pointer.starts_with("/channels");
            let (parent, key) = pointer.rsplit_once('/').unwrap();
            let parent = if is_own { format!("/animations/0{parent}") } else { parent.to_owned() };
            draft.root.pointer_mut(&parent).unwrap()[key] = value;
        }
        let mesh = draft.read().unwrap();
        assert!(mesh.rig.is_none(), "{pointer}");
        let [warning] = &mesh.warnings[..] else { panic!("{pointer}: {:?}", mesh.warnings) };
        assert!(warning.starts_with("animation 0 is left out: "), "{warning}");
        assert!(warning.contains(expected), "{pointer}: {warning}");
    }
}

#[test]
fn of_many_faults_a_hundred_are_named_and_the_others_counted_before_the_repairs() {
    let mut draft = triangle();
    let normals = draft.vectors(&[[0.0, 0.0, 9.0], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]]);
    draft.root["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = json!(normals);
    (0..130).for_each(|_| draft.animate(0, "translation", "VEC3", &[0.0], &[0.0, f32::NAN, 0.0]));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("faults.gltf");
    std::fs::write(&path, draft.document().to_string()).unwrap();
    let warnings = crate::mesh_file::load(&path, &Limits::default(), &Progress::new()).unwrap().warnings;
    assert!(warnings[..100].iter().zip(0..).all(|(said, i)| said.starts_with(&format!("animation {i} is left out: "))));
    let rest = ["30 more such sentences are left out.", "normals whose length wasn't 1, scaled to it: 1."];
    assert_eq!(warnings[100..], rest);
}

#[test]
fn values_that_are_no_numbers_are_left_out() {
    let mut draft = triangle();
    draft.animate(0, "translation", "VEC3", &[0.0], &[0.0, f32::NAN, 0.0]);
    draft.root["animations"][0]["name"] = json!("Walk\n\u{1b}on");
    let expected = ["animation 0 \"Walk  on\" is left out: channel 0 has values that aren't finite."];
    assert_eq!(draft.read().unwrap().warnings, expected);
}

#[test]
fn animations_of_hidden_nodes_are_left_out() {
    let mut draft = triangle();
    draft.push("nodes", json!({ "name": "camera" }));
    draft.move_node(1);
    let mesh = draft.read().unwrap();
    assert_eq!(mesh.warnings, ["animation \"animation 0\" moves nothing that is shown; it is left out."]);
    assert!(mesh.rig.is_none());
    draft.move_node(0);
    let mesh = draft.read().unwrap();
    let names: Vec<_> = rig(&mesh).clips.iter().map(|clip| clip.name.as_str()).collect();
    assert_eq!(names, ["animation 1"], "it keeps its number");
}

#[test]
fn channels_of_extensions_are_passed_over() {
    let mut draft = triangle();
    draft.move_node(0);
    let channels = draft.root["animations"][0]["channels"].as_array_mut().unwrap();
    channels
        .push(json!({ "sampler": 0, "target": { "path": "pointer", "extensions": { "KHR_animation_pointer": {} } } }));
    channels.push(json!({ "sampler": 0, "target": { "node": 0, "path": "shine" } }));
    let mesh = draft.read().unwrap();
    let said = "animation 0 has 1 channels of KHR_animation_pointer, which aren't read; the others are played.";
    assert_eq!((rig(&mesh).clips[0].channels.len(), &mesh.warnings[..]), (1, &[said.to_owned()][..]));
}

#[test]
fn bad_morph_targets_leave_the_mesh_at_rest() {
    let mut draft = triangle();
    let short = draft.vectors(&[[0.0; 3]; 2]);
    draft.root["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": short }]);
    draft.animate(0, "weights", "SCALAR", &[0.0, 1.0], &[0.0, 1.0]);
    let mesh = draft.read().unwrap();
    let [warning] = &mesh.warnings[..] else { panic!("{:?}", mesh.warnings) };
    assert!(warning.starts_with("animations are left out: /accessors/2 (POSITION of a morph target of"), "{warning}");
    assert!(mesh.rig.is_none());
}

#[test]
fn a_part_that_is_scaled_to_nothing_stays_so_without_its_animations() {
    let mut draft = growing(None);
    let short = draft.vectors(&[[0.0; 3]; 2]);
    // A second part, whose targets are broken, stands before it and beside it.
    draft.push("meshes", draft.root["meshes"][0].clone());
    draft.root["meshes"][1]["primitives"][0]["targets"] = json!([{ "POSITION": short }]);
    draft.animate(2, "weights", "SCALAR", &[0.0, 1.0], &[0.0, 1.0]);
    draft.push("nodes", json!({ "mesh": 1, "translation": [9, 0, 0] }));
    for roots in [[1, 2], [2, 1]] {
        draft.root["scenes"][0]["nodes"] = json!(roots);
        let mesh = draft.read().unwrap();
        let is_said = mesh.warnings.iter().any(|warning| warning.starts_with("animations are left out: "));
        assert!(is_said && mesh.mesh.rig.is_none(), "{:?}", mesh.warnings);
        let (there, beside): (Vec<_>, Vec<_>) = positions(&mesh.mesh).into_iter().partition(|[x, ..]| *x < 5.0);
        assert_eq!((there, beside.len()), (vec![[1.0, 2.0, 3.0]; 6], 6));
    }
}

#[test]
fn targets_without_end_take_no_memory() {
    let mut draft = triangle();
    // Many targets with one long list of zeros, which takes no bytes in the file except for one value.
    let (places, values) = (draft.view(&[0]), draft.view(&[0; 12]));
    let zeros = json!({
        "componentType": 5126, "type": "VEC3", "count": 1 << 18,
        "sparse": {
            "count": 1,
            "indices": { "bufferView": places, "componentType": 5121 },
            "values": { "bufferView": values },
        },
    });
    let zeros = draft.push("accessors", zeros);
    let targets: Vec<Value> = (0..1025).map(|_| json!({ "POSITION": zeros })).collect();
    draft.root["meshes"][0]["primitives"][0] = json!({ "attributes": { "POSITION": zeros }, "targets": targets });
    let indices = draft.indices(&[0, 1, 2]);
    draft.root["meshes"][0]["primitives"][0]["indices"] = json!(indices);
    draft.animate(0, "weights", "SCALAR", &[0.0], &[0.0; 1025]);
    let mesh = draft.read().unwrap();
    assert!(mesh.rig.is_none());
    assert!(
        mesh.warnings.iter().any(|warning| warning.contains("morph targets have more than")),
        "{:?}",
        mesh.warnings
    );
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

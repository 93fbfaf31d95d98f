//! What the scene doesn't use, and what changes nothing of the shape: it may be broken.

use super::*;
use crate::gltf::tests::animations::normal_mapped;
use crate::gltf::tests::files::png_uri;

fn changed(change: impl FnOnce(&mut Value)) -> Draft {
    let mut draft = triangle();
    change(&mut draft.root);
    draft
}

fn read(name: &'static str, change: impl FnOnce(&mut Value)) -> Case {
    Case::draft(name, &changed(change), Gets::Read)
}

fn repaired(name: &'static str, parts: &'static str, change: impl FnOnce(&mut Value)) -> Case {
    Case::draft(name, &changed(change), Gets::Repaired(parts))
}

fn refused(name: &'static str, parts: &str, change: impl FnOnce(&mut Value)) -> Case {
    Case::draft(name, &changed(change), Gets::Refused(parts.to_owned()))
}

fn add(root: &mut Value, list: &str, value: Value) -> usize {
    let list = root[list].as_array_mut().expect("a list");
    list.push(value);
    list.len() - 1
}

/// A triangle with a second mesh on a node that the scene doesn't show.
fn with_unshown(root: &mut Value, mesh: Value) {
    let mesh = add(root, "meshes", mesh);
    add(root, "nodes", json!({ "mesh": mesh, "skin": 7, "rotation": "none", "children": [1, 2] }));
}

/// A broken accessor as an attribute of the triangle.
fn with_attribute(root: &mut Value, name: &str, accessor: Value) {
    let accessor = add(root, "accessors", accessor);
    root["meshes"][0]["primitives"][0]["attributes"][name] = json!(accessor);
}

fn textured(root: &mut Value) {
    root["materials"] = json!([{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }]);
    root["textures"] = json!([{ "source": 0 }]);
    root["images"] = json!([{ "uri": png_uri() }]);
    root["meshes"][0]["primitives"][0]["material"] = json!(0);
}

fn animated(root: &mut Value, input: usize) {
    let sampler = json!({ "input": input, "output": 0 });
    let channel = json!({ "sampler": 0, "target": { "node": 0, "path": "translation" } });
    root["animations"] = json!([{ "samplers": [sampler], "channels": [channel] }]);
}

fn instanced(root: &mut Value, attributes: Value) {
    root["nodes"][0]["extensions"] = json!({ "EXT_mesh_gpu_instancing": { "attributes": attributes } });
}

/// A normal-mapped triangle with a morph target of weight 1/2, which displaces tangents by an accessor.
fn displaced_tangents(accessor: impl FnOnce(&mut Draft) -> usize) -> Draft {
    let mut draft = normal_mapped(triangle(), [1.0, 0.0, 0.0, 1.0]);
    let accessor = accessor(&mut draft);
    draft.root["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": 0, "TANGENT": accessor }]);
    draft.root["meshes"][0]["weights"] = json!([0.5]);
    draft
}

/// A triangle each of whose vertices eight joints move.
fn eight_joints() -> Draft {
    let mut draft = triangle();
    for set in [0, 1] {
        let joints: Vec<u8> = (0..12).map(|i| i % 4 + 4 * set).collect();
        let joints = draft.accessor(&joints, 5121, "VEC4", 3);
        let weights = draft.floats("VEC4", &[[0.1, 0.2, 0.1, 0.1]; 3].concat());
        let attributes = &mut draft.root["meshes"][0]["primitives"][0]["attributes"];
        attributes[format!("JOINTS_{set}")] = json!(joints);
        attributes[format!("WEIGHTS_{set}")] = json!(weights);
    }
    draft.root["nodes"] = std::iter::once(json!({ "mesh": 0, "skin": 0 })).chain((0..8).map(|_| json!({}))).collect();
    draft.root["skins"] = json!([{ "joints": [1, 2, 3, 4, 5, 6, 7, 8] }]);
    draft
}

pub(super) fn cases() -> Vec<Case> {
    let mut cases = unused();
    cases.extend(details());
    cases.extend(scenes_and_versions());
    cases.extend(instances_and_joints());
    cases
}

/// Nothing that is shown uses these.
fn unused() -> Vec<Case> {
    vec![
        read("unused accessors, views and buffers of any kind", |root| {
            add(root, "accessors", json!({ "componentType": "FLOAT", "count": -1, "bufferView": 99 }));
            add(root, "accessors", json!(7));
            add(
                root,
                "bufferViews",
                json!({ "buffer": "none", "byteStride": 1, "extensions": { "EXT_meshopt_compression": 1 } }),
            );
            add(root, "bufferViews", json!(null));
        }),
        Case::draft(
            "an unused buffer that isn't there",
            &{
                let mut draft = triangle();
                draft.fallback = Some(json!({ "byteLength": 1_u64 << 60, "uri": "/dev/zero" }));
                draft
            },
            Gets::Read,
        ),
        read("a broken mesh on a node that isn't shown", |root| {
            with_unshown(root, json!({ "primitives": [{ "mode": "STARS", "attributes": 3, "indices": -1 }] }));
        }),
        read("a mesh that isn't there on a node that isn't shown", |root| {
            add(root, "nodes", json!({ "mesh": 99 }));
        }),
        read("a skin that moves nothing", |root| {
            root["skins"] = json!([{ "joints": "all", "inverseBindMatrices": 99 }]);
            root["nodes"][0]["skin"] = json!(0);
        }),
        read("attributes that nothing reads", |root| {
            with_attribute(root, "_HEAT", json!({ "componentType": 1, "count": 0.5, "type": "COLOUR" }));
            root["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = json!(99);
        }),
        read("weights of no morph targets", |root| {
            root["nodes"][0]["weights"] = json!(["a\nb"]);
            root["meshes"][0]["weights"] = json!({});
        }),
        read("whole numbers with a point", |root| {
            root["nodes"][0]["mesh"] = json!(0.0);
            root["accessors"][0]["count"] = json!(3.0);
            root["accessors"][0]["componentType"] = json!(5126.0);
        }),
        repaired("a primitive without positions, beside another", "without positions | 1", |root| {
            add(&mut root["meshes"][0], "primitives", json!({ "attributes": { "NORMAL": 1 }, "indices": 99 }));
        }),
        repaired("broken points", "primitives of points | 1", |root| {
            let points = json!({ "mode": 0, "attributes": { "POSITION": 99 } });
            add(&mut root["meshes"][0], "primitives", points);
        }),
        refused("a document without a buffer", "Empty | no node of its scene has a mesh", |root| {
            *root =
                json!({ "asset": root["asset"], "nodes": [{}], "accessors": [{}], "meshes": [{ "primitives": 1 }] });
        }),
    ]
}

/// The shape is the same without these.
fn details() -> Vec<Case> {
    vec![
        repaired("texture coordinates that aren't there", "attributes/TEXCOORD_0 | 2 accessors | left out", |root| {
            root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(9);
        }),
        repaired(
            "texture coordinates of an unknown type",
            "TEXCOORD_0 | /accessors/2/type | \"VEC9\" | left out",
            |root| {
                with_attribute(root, "TEXCOORD_0", json!({ "componentType": 5126, "count": 3, "type": "VEC9" }));
            },
        ),
        repaired("texture coordinates beyond their view", "TEXCOORD_0 | 7200 | /bufferViews/0 | left out", |root| {
            with_attribute(
                root,
                "TEXCOORD_0",
                json!({ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC2", "byteOffset": 7176 }),
            );
        }),
        repaired("an image in a view of no buffer", "/images/0 | /bufferViews/2/buffer | missing", |root| {
            textured(root);
            let view = add(root, "bufferViews", json!({ "byteLength": 4 }));
            root["images"] = json!([{ "bufferView": view }]);
        }),
        repaired("times of an animation that are broken", "animation 0 is left out | /accessors/2/count", |root| {
            add(root, "accessors", json!({ "componentType": 5126, "type": "SCALAR" }));
            animated(root, 2);
        }),
        repaired("a morph target without weight that isn't there", "targets/0/POSITION | 2 accessors", |root| {
            root["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": 9 }]);
        }),
        refused(
            "a morph target with a weight that isn't there",
            "Document | /meshes/0/primitives/0/targets/0/POSITION | 9 | /accessors",
            |root| {
                root["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": 9 }]);
                root["meshes"][0]["weights"] = json!([0.5]);
            },
        ),
        repaired("a displacement of tangents that isn't there", "targets/0/TANGENT | 2 accessors | left out", |root| {
            root["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": 0, "TANGENT": 9 }]);
            root["meshes"][0]["weights"] = json!([0.5]);
        }),
        Case::draft(
            "displacements of two of three tangents",
            &displaced_tangents(|draft| draft.vectors(&[[0.0, 1.0, 0.0]; 2])),
            Gets::Repaired(
                "TANGENT of a morph target of /meshes/0/primitives/0 | 2 elements for 3 vertices | left out",
            ),
        ),
        Case::draft(
            "displacements of tangents without a type",
            &displaced_tangents(|draft| draft.push("accessors", json!({ "componentType": 5126, "count": 3 }))),
            Gets::Repaired("TANGENT of a morph target of /meshes/0/primitives/0 | type | left out"),
        ),
        Case::draft(
            "displacements of tangents that are no numbers",
            &displaced_tangents(|draft| draft.vectors(&[[f32::NAN, f32::INFINITY, 0.0]; 3])),
            Gets::Read,
        ),
        read("a rotation of length 1.0000001", |root| root["nodes"][0]["rotation"] = json!([0, 0, 0, 1.000_000_1])),
        repaired("a rotation of zeros", "/nodes/0/rotation | zeros", |root| {
            root["nodes"][0]["rotation"] = json!([0, 0, 0, 0]);
        }),
        repaired("a rotation of 1e308", "/nodes/0/rotation | length", |root| {
            root["nodes"][0]["rotation"] = json!([1e308, 1e308, 0, 0]);
        }),
        refused("a rotation of three numbers", "Document | /nodes/0/rotation | 4 numbers | 3", |root| {
            root["nodes"][0]["rotation"] = json!([0, 0, 1]);
        }),
        repaired("an extension of looks and one of the shape, used", "MPEG_mesh_linking isn't read", |root| {
            root["extensionsUsed"] = json!(["KHR_materials_fuzz", "MPEG_mesh_linking"]);
            root["extensionsRequired"] = json!(["KHR_materials_fuzz", "KHR_xmp_json_ld", "VRMC_vrm"]);
        }),
        refused(
            "an extension of the shape, required",
            "Extension | /extensionsRequired/0 | AGI_articulations | isn't read | export",
            |root| root["extensionsRequired"] = json!(["AGI_articulations"]),
        ),
    ]
}

fn scenes_and_versions() -> Vec<Case> {
    vec![
        repaired("scenes without the default one", "/scene | 5 | /scenes | 1 | first scene", |root| {
            root["scene"] = json!(5)
        }),
        read("another scene with nodes that aren't there", |root| {
            root["scenes"] = json!([{ "nodes": [0] }, { "nodes": [99, "x"], "name": 3 }]);
        }),
        refused("a scene of hidden nodes", "Empty | KHR_node_visibility | 1 nodes", |root| {
            root["nodes"] = json!([{ "children": [1], "extensions": { "KHR_node_visibility": { "visible": false } } }, { "mesh": 0 }]);
        }),
        repaired("a hidden node with a broken mesh", "KHR_node_visibility | 1", |root| {
            let hidden = json!({ "mesh": 9, "extensions": { "KHR_node_visibility": { "visible": false } } });
            root["nodes"] = json!([{ "mesh": 0, "children": [1] }, hidden]);
        }),
        refused("a later minimum version", "NotGltf | /asset/minVersion | \"2.1\" | 2.0", |root| {
            root["asset"] = json!({ "version": "2.1", "minVersion": "2.1" });
        }),
        read("a later version that needs no more", |root| {
            root["asset"] = json!({ "version": "2.9", "minVersion": "2.0" });
        }),
        repaired("a version that is a number, and a triangle", "/asset/version | 2", |root| {
            root["asset"] = json!({ "version": 2.0 });
        }),
    ]
}

fn instances_and_joints() -> Vec<Case> {
    vec![
        refused(
            "instances that aren't there",
            "Document | EXT_mesh_gpu_instancing/attributes/SCALE | 9 | /accessors",
            |root| {
                instanced(root, json!({ "TRANSLATION": 0, "SCALE": 9 }));
            },
        ),
        refused(
            "rotations of other instances",
            "Accessor | /accessors/2 | ROTATION of the instances of node 0 | 2 | 3",
            |root| {
                add(root, "accessors", json!({ "componentType": 5126, "count": 2, "type": "VEC4" }));
                instanced(root, json!({ "TRANSLATION": 0, "ROTATION": 2 }));
            },
        ),
        refused("2^24 instances without data", "TooLarge | 16777216 | 512", |root| {
            add(root, "accessors", json!({ "componentType": 5126, "count": 1 << 24, "type": "VEC3" }));
            instanced(root, json!({ "TRANSLATION": 2 }));
        }),
        refused("2^62 instances", "TooLarge | 4611686018427387904 | 134217728", |root| {
            add(root, "accessors", json!({ "componentType": 5126, "count": 1_u64 << 62, "type": "VEC3" }));
            instanced(root, json!({ "TRANSLATION": 2 }));
        }),
        read("instances of a node without a mesh", |root| {
            let own = json!({ "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": 9 } } });
            root["nodes"] = json!([{ "mesh": 0, "children": [1] }, { "extensions": own }]);
        }),
        Case::draft("eight joints a vertex", &eight_joints(), Gets::Repaired("more than four joints | 3 | 40.00 %")),
    ]
}

//! Accessors, their views, and the values in them.

use super::*;

/// 2 to the power of 62.
const HUGE: u64 = 1 << 62;

fn sparse(count: u64, place: u8) -> Draft {
    let mut draft = triangle();
    let places = draft.view(&[place]);
    draft.root["accessors"][0]["sparse"] = json!({
        "count": count,
        "indices": { "bufferView": places, "componentType": 5121 },
        "values": { "bufferView": 1 },
    });
    draft
}

fn changed(change: impl FnOnce(&mut Draft)) -> Draft {
    let mut draft = triangle();
    change(&mut draft);
    draft
}

/// A triangle with another position.
fn position(x: f32) -> Draft {
    let mut draft = Draft::new();
    let at = draft.vectors(&[[0.0; 3], [1.0, x, 0.0], [0.0, 1.0, 0.0]]);
    draft.primitive(json!({ "attributes": { "POSITION": at } }));
    draft
}

/// Adds a whole triangle to a document.
fn beside(mut draft: Draft) -> Draft {
    let at = draft.vectors(&TRIANGLE);
    draft.primitive(json!({ "attributes": { "POSITION": at } }));
    draft
}

fn attribute(name: &str, kind: &str, values: &[f32]) -> Draft {
    let mut draft = triangle();
    let accessor = draft.floats(kind, values);
    draft.root["meshes"][0]["primitives"][0]["attributes"][name] = json!(accessor);
    draft
}

fn indexed(indices: &[u16]) -> Draft {
    let mut draft = triangle();
    let indices = draft.indices(indices);
    draft.root["meshes"][0]["primitives"][0]["indices"] = json!(indices);
    draft
}

/// A triangle that one joint moves, with this weight and joint in all its vertices.
fn skinned(joint: u8, weight: f32) -> Draft {
    let mut draft = attribute("WEIGHTS_0", "VEC4", &[weight; 12]);
    let joints = draft.accessor(&[joint; 12], 5121, "VEC4", 3);
    draft.root["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = json!(joints);
    draft.root["nodes"] = json!([{ "mesh": 0, "skin": 0 }, {}]);
    draft.root["skins"] = json!([{ "joints": [1] }]);
    draft
}

fn refused(name: &'static str, draft: &Draft, expected: &str) -> Case {
    Case::draft(name, draft, Gets::Refused(expected.to_owned()))
}

/// Normals for two of the three vertices.
fn fewer_normals() -> Case {
    let mut draft = triangle();
    draft.root["accessors"][1]["count"] = json!(2);
    let said = "/accessors/1 | NORMAL | /meshes/0/primitives/0 | \"thing\" | 2 | 3 | left out";
    Case::draft("normals for fewer vertices", &draft, Gets::Repaired(said))
}

pub(super) fn cases() -> Vec<Case> {
    let mode = |mode: u32| changed(|draft| draft.root["meshes"][0]["primitives"][0]["mode"] = json!(mode));
    let mut short_skin = skinned(0, 1.0);
    let binds = short_skin.floats("MAT4", &glam::Mat4::IDENTITY.to_cols_array());
    short_skin.root["skins"] = json!([{ "joints": [1, 1], "inverseBindMatrices": binds }]);
    let mut jointless = skinned(0, 1.0);
    jointless.root["skins"] = json!([{ "joints": [1, 9] }]);
    let mut skinless = skinned(0, 1.0);
    skinless.root["nodes"][0]["skin"] = json!(5);
    vec![
        Case::with(
            "a count of 2^62",
            "/accessors/0/count",
            json!(HUGE),
            "Accessor | /accessors/0 | POSITION | /meshes/0/primitives/0 | \"thing\" | 2^64 | /bufferViews/0 | 36",
        ),
        Case::with(
            "a count of 2^64 - 1",
            "/accessors/0/count",
            json!(u64::MAX),
            "Accessor | /accessors/0 | POSITION | /meshes/0/primitives/0 | \"thing\" | 2^64 | /bufferViews/0 | 36",
        ),
        Case::with(
            "one element more than there is",
            "/accessors/0/count",
            json!(4),
            "Accessor | /accessors/0 | POSITION | /meshes/0/primitives/0 | \"thing\" | 48 | /bufferViews/0 | 36",
        ),
        Case::with(
            "an offset of 2^62",
            "/accessors/0/byteOffset",
            json!(HUGE),
            "Accessor | /accessors/0 | POSITION | /meshes/0/primitives/0 | \"thing\" | 4611686018427387940 | /bufferViews/0 | 36",
        ),
        Case::with(
            "an offset of 4",
            "/accessors/0/byteOffset",
            json!(4),
            "Accessor | /accessors/0 | POSITION | /meshes/0/primitives/0 | \"thing\" | 40 | /bufferViews/0 | 36",
        ),
        Case::with(
            "a view from 2^64 - 1",
            "/bufferViews/0/byteOffset",
            json!(u64::MAX),
            "Accessor | /accessors/0 | POSITION | /meshes/0/primitives/0 | \"thing\" | /bufferViews/0 | 36 | 18446744073709551615 | /buffers/0 | 72",
        ),
        Case::with(
            "a view longer than its buffer",
            "/bufferViews/0/byteLength",
            json!(73),
            "Accessor | /accessors/0 | POSITION | /meshes/0/primitives/0 | \"thing\" | /bufferViews/0 | 73 | 0 | /buffers/0 | 72",
        ),
        Case::with(
            "a stride within an element",
            "/bufferViews/0/byteStride",
            json!(4),
            "Accessor | /accessors/0 | POSITION | /meshes/0/primitives/0 | \"thing\" | 12 | /bufferViews/0 | 4",
        ),
        Case::with(
            "a stride past the end",
            "/bufferViews/0/byteStride",
            json!(252),
            "Accessor | /accessors/0 | POSITION | /meshes/0/primitives/0 | \"thing\" | 516 | /bufferViews/0 | 36",
        ),
        Case::with(
            "positions of two numbers",
            "/accessors/0/type",
            json!("VEC2"),
            "Accessor | /accessors/0 | POSITION | /meshes/0/primitives/0 | \"thing\" | Vec2 | 3",
        ),
        fewer_normals(),
        Case::with("no positions", "/meshes/0/primitives/0/attributes", json!({}), "Empty | 1 primitives | empty"),
        refused(
            "sparse values beyond the list",
            &sparse(1, 9),
            "Accessor | /accessors/0 | POSITION | /meshes/0/primitives/0 | \"thing\" | 9 | 3 | /sparse/indices",
        ),
        refused(
            "more sparse values than there are",
            &sparse(HUGE, 0),
            "Accessor | /accessors/0 | POSITION | /meshes/0/primitives/0 | \"thing\" | 4611686018427387904 | /bufferViews/2 | 1",
        ),
        refused(
            "positions that are no numbers",
            &position(f32::NAN),
            "Empty | 1 faces | 1e37 | /meshes/0/primitives/0 | \"thing\"",
        ),
        Case::draft(
            "positions without end, beside others",
            &beside(position(f32::NEG_INFINITY)),
            Gets::Repaired("1 faces | 1e37 | /meshes/0/primitives/0 | \"thing\" | left out"),
        ),
        Case::draft(
            "positions that sums can't hold, beside others",
            &beside(position(1.1e37)),
            Gets::Repaired("1 faces | 1e37 | /meshes/0/primitives/0 | \"thing\" | left out"),
        ),
        refused(
            "an index beyond the vertices",
            &indexed(&[0, 1, 3]),
            "Primitive | /meshes/0/primitives/0 | \"thing\" | vertex 3 | index 2",
        ),
        refused(
            "an index that starts anew",
            &indexed(&[0, 1, 65535]),
            "Primitive | /meshes/0/primitives/0 | \"thing\" | vertex 65535 | 3 | index 2",
        ),
        Case::with(
            "indices that are vectors",
            "/meshes/0/primitives/0/indices",
            json!(0),
            "Accessor | /accessors/0 | /meshes/0/primitives/0 | \"thing\" | Vec3 | F32",
        ),
        refused("fewer matrices than joints", &short_skin, "Accessor | /accessors/4 | skin 0 | 1 | 2"),
        refused("a joint that isn't there", &jointless, "Document | /skins/0/joints/1 | 9 | /nodes | 2"),
        refused("a skin that isn't there", &skinless, "Document | /nodes/0/skin | 5 | /skins | 1"),
        refused("points only", &mode(0), "Empty | 1 | points | 0 | lines"),
        refused("lines only", &mode(1), "Empty | 0 | points | 1 | lines"),
        refused(
            "no vertices",
            &changed(|draft| {
                draft.root["accessors"][0]["count"] = json!(0);
                draft.root["accessors"][1]["count"] = json!(0);
            }),
            "Empty | 1 | empty",
        ),
        refused("no indices", &indexed(&[]), "Empty | 1 | empty"),
        Case::draft("indices left over", &indexed(&[0, 1, 2, 0]), Gets::Repaired("indices | 1")),
        Case::draft(
            "normals of nothing",
            &attribute("NORMAL", "VEC3", &[0.0; 9]),
            Gets::Repaired("normals without a direction | 3"),
        ),
        Case::draft(
            "normals that are no numbers",
            &attribute("NORMAL", "VEC3", &[f32::NAN; 9]),
            Gets::Repaired("normals without a direction | 3"),
        ),
        Case::draft(
            "uvs without end",
            &attribute("TEXCOORD_0", "VEC2", &[f32::INFINITY; 6]),
            Gets::Repaired("uvs that aren't finite | 3"),
        ),
        Case::draft("joints that aren't there", &skinned(7, 1.0), Gets::Repaired("unusable joints or weights | 3")),
        Case::draft("weights of nothing", &skinned(0, 0.0), Gets::Repaired("unusable joints or weights | 3")),
        Case::draft(
            "weights that are no numbers",
            &skinned(0, f32::NAN),
            Gets::Repaired("unusable joints or weights | 3"),
        ),
    ]
}

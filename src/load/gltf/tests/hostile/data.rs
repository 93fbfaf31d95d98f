//! Accessors, their views and what they hold.

use super::*;

/// Two to the power of 62.
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

/// A triangle with one other position.
fn position(x: f32) -> Draft {
    let mut draft = Draft::new();
    let at = draft.vectors(&[[0.0; 3], [1.0, x, 0.0], [0.0, 1.0, 0.0]]);
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

/// A triangle that hangs on one joint with these weights and joints.
fn skinned(joint: u8, weight: f32) -> Draft {
    let mut draft = attribute("WEIGHTS_0", "VEC4", &[weight; 12]);
    let joints = draft.accessor(&[joint; 12], 5121, "VEC4", 3);
    draft.root["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = json!(joints);
    draft.root["nodes"] = json!([{ "mesh": 0, "skin": 0 }, {}]);
    draft.root["skins"] = json!([{ "joints": [1] }]);
    draft
}

fn refused(name: &'static str, draft: &Draft, sentence: &str) -> Case {
    Case::draft(name, draft, Gets::Refused(sentence.to_owned()))
}

pub fn cases() -> Vec<Case> {
    let mode = |mode: u32| changed(|draft| draft.root["meshes"][0]["primitives"][0]["mode"] = json!(mode));
    let short_skin = changed(|draft| {
        let binds = draft.floats("MAT4", &glam::Mat4::IDENTITY.to_cols_array());
        draft.root["nodes"] = json!([{ "mesh": 0, "skin": 0 }, {}]);
        draft.root["skins"] = json!([{ "joints": [1, 1], "inverseBindMatrices": binds }]);
    });
    vec![
        Case::with(
            "a count of 2^62",
            "/accessors/0/count",
            json!(HUGE),
            "/accessors/0 (POSITION of /meshes/0/primitives/0 (\"thing\")) needs more than 2^64 bytes of /bufferViews/0, which has 36; export the model again",
        ),
        Case::with(
            "a count of 2^64 - 1",
            "/accessors/0/count",
            json!(u64::MAX),
            "/accessors/0 (POSITION of /meshes/0/primitives/0 (\"thing\")) needs more than 2^64 bytes of /bufferViews/0, which has 36; export the model again",
        ),
        Case::with(
            "one element more than there is",
            "/accessors/0/count",
            json!(4),
            "/accessors/0 (POSITION of /meshes/0/primitives/0 (\"thing\")) needs 48 bytes of /bufferViews/0, which has 36; export the model again",
        ),
        Case::with(
            "an offset of 2^62",
            "/accessors/0/byteOffset",
            json!(HUGE),
            "/accessors/0 (POSITION of /meshes/0/primitives/0 (\"thing\")) needs 4611686018427387940 bytes of /bufferViews/0, which has 36; export the model again",
        ),
        Case::with(
            "an offset of 4",
            "/accessors/0/byteOffset",
            json!(4),
            "/accessors/0 (POSITION of /meshes/0/primitives/0 (\"thing\")) needs 40 bytes of /bufferViews/0, which has 36; export the model again",
        ),
        Case::with(
            "a view from 2^64 - 1",
            "/bufferViews/0/byteOffset",
            json!(u64::MAX),
            "/accessors/0 (POSITION of /meshes/0/primitives/0 (\"thing\")) uses /bufferViews/0, which takes 36 bytes from byte 18446744073709551615 of /buffers/0, which has 72; export the model again",
        ),
        Case::with(
            "a view longer than its buffer",
            "/bufferViews/0/byteLength",
            json!(73),
            "/accessors/0 (POSITION of /meshes/0/primitives/0 (\"thing\")) uses /bufferViews/0, which takes 73 bytes from byte 0 of /buffers/0, which has 72; export the model again",
        ),
        Case::with(
            "a stride within an element",
            "/bufferViews/0/byteStride",
            json!(4),
            "/accessors/0 (POSITION of /meshes/0/primitives/0 (\"thing\")) has elements of 12 bytes, and /bufferViews/0 has them 4 bytes apart; export the model again",
        ),
        Case::with(
            "a stride past the end",
            "/bufferViews/0/byteStride",
            json!(252),
            "/accessors/0 (POSITION of /meshes/0/primitives/0 (\"thing\")) needs 516 bytes of /bufferViews/0, which has 36; export the model again",
        ),
        Case::with(
            "positions of two numbers",
            "/accessors/0/type",
            json!("VEC2"),
            "/accessors/0 (POSITION of /meshes/0/primitives/0 (\"thing\")) has Vec2 elements where 3 numbers are needed; export the model again",
        ),
        Case::with(
            "normals for fewer vertices",
            "/accessors/1/count",
            json!(2),
            "/accessors/1 (NORMAL of /meshes/0/primitives/0 (\"thing\")) has 2 elements for 3 vertices; export the model again",
        ),
        Case::with(
            "no positions",
            "/meshes/0/primitives/0/attributes",
            json!({}),
            "/meshes/0/primitives/0/attributes/POSITION is missing; export the model again",
        ),
        refused(
            "sparse values beyond the list",
            &sparse(1, 9),
            "/accessors/0 (POSITION of /meshes/0/primitives/0 (\"thing\")) replaces element 9 of 3, in /sparse/indices; export the model again",
        ),
        refused(
            "more sparse values than there are",
            &sparse(HUGE, 0),
            "/accessors/0 (POSITION of /meshes/0/primitives/0 (\"thing\")) needs 4611686018427387904 bytes of /bufferViews/2, which has 1; export the model again",
        ),
        refused(
            "positions that are no numbers",
            &position(f32::NAN),
            "/meshes/0/primitives/0 (\"thing\") has a position that isn't finite, at vertex 1; export the model again",
        ),
        refused(
            "positions without end",
            &position(f32::NEG_INFINITY),
            "/meshes/0/primitives/0 (\"thing\") has a position that isn't finite, at vertex 1; export the model again",
        ),
        refused(
            "positions that sums can't hold",
            &position(1.1e37),
            "/meshes/0/primitives/0 (\"thing\") has a coordinate beyond 1e37, at vertex 1; export the model again",
        ),
        refused(
            "an index beyond the vertices",
            &indexed(&[0, 1, 3]),
            "/meshes/0/primitives/0 (\"thing\") uses vertex 3 of 3, at index 2; export the model again",
        ),
        refused(
            "an index that starts anew",
            &indexed(&[0, 1, 65535]),
            "/meshes/0/primitives/0 (\"thing\") uses vertex 65535 of 3, at index 2; export the model again",
        ),
        Case::with(
            "indices that are vectors",
            "/meshes/0/primitives/0/indices",
            json!(0),
            "/accessors/0 (indices of /meshes/0/primitives/0 (\"thing\")) holds (Vec3, F32) where unsigned integers are needed; export the model again",
        ),
        refused(
            "fewer matrices than joints",
            &short_skin,
            "/accessors/2 (inverse bind matrices of skin 0) has 1 matrices for 2 joints; export the model again",
        ),
        refused("points only", &mode(0), "no triangles: its scene holds 1 primitives of points and 0 of lines"),
        refused("lines only", &mode(1), "no triangles: its scene holds 0 primitives of points and 1 of lines"),
        refused(
            "no vertices",
            &changed(|draft| {
                draft.root["accessors"][0]["count"] = json!(0);
                draft.root["accessors"][1]["count"] = json!(0);
            }),
            "no triangles: the 1 primitives of its scene are empty",
        ),
        refused("no indices", &indexed(&[]), "no triangles: the 1 primitives of its scene are empty"),
        Case::draft(
            "indices left over",
            &indexed(&[0, 1, 2, 0]),
            Gets::Repaired("indices at the end of triangle lists that make no whole triangle, left out: 1."),
        ),
        Case::draft(
            "normals of nothing",
            &attribute("NORMAL", "VEC3", &[0.0; 9]),
            Gets::Repaired("normals of no direction, replaced by ones that are smooth within 60 degrees: 3."),
        ),
        Case::draft(
            "normals that are no numbers",
            &attribute("NORMAL", "VEC3", &[f32::NAN; 9]),
            Gets::Repaired("normals of no direction, replaced by ones that are smooth within 60 degrees: 3."),
        ),
        Case::draft(
            "uvs without end",
            &attribute("TEXCOORD_0", "VEC2", &[f32::INFINITY; 6]),
            Gets::Repaired("uvs that aren't finite, replaced by (0, 0): 3."),
        ),
        Case::draft(
            "joints that aren't there",
            &skinned(7, 1.0),
            Gets::Repaired("vertices with unusable joints or weights, left unskinned: 3."),
        ),
        Case::draft(
            "weights of nothing",
            &skinned(0, 0.0),
            Gets::Repaired("vertices with unusable joints or weights, left unskinned: 3."),
        ),
        Case::draft(
            "weights that are no numbers",
            &skinned(0, f32::NAN),
            Gets::Repaired("vertices with unusable joints or weights, left unskinned: 3."),
        ),
    ]
}

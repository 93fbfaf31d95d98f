//! Small files that need much memory, which is refused before it is allocated.

use super::*;

/// A triangle whose positions are zeros without data, except for one sparse value.
fn zeros(count: u64) -> Draft {
    let mut draft = triangle();
    let places = draft.view(&[0]);
    let accessor = json!({
        "componentType": 5126, "type": "VEC3", "count": count,
        "sparse": {
            "count": 1,
            "indices": { "bufferView": places, "componentType": 5121 },
            "values": { "bufferView": 1 },
        },
    });
    let accessor = draft.push("accessors", accessor);
    draft.root["meshes"][0]["primitives"] = json!([{ "attributes": { "POSITION": accessor } }]);
    draft
}

/// A mesh with `count` times the same triangle, on this number of nodes.
fn instances(count: usize, nodes: usize) -> Draft {
    let mut draft = triangle();
    let indices = draft.accessor(&vec![0; count * 3], 5121, "SCALAR", count * 3);
    draft.root["meshes"][0]["primitives"][0]["indices"] = json!(indices);
    draft.root["nodes"] = json!(vec![json!({ "mesh": 0 }); nodes]);
    draft.root["scenes"] = json!([{ "nodes": (0..nodes).collect::<Vec<usize>>() }]);
    draft
}

pub(super) fn cases() -> Vec<Case> {
    let mut twins = triangle();
    let primitive = twins.root["meshes"][0]["primitives"][0].clone();
    twins.root["meshes"][0]["primitives"] = json!(vec![primitive; 2000]);
    twins.root["nodes"] = json!(vec![json!({ "mesh": 0 }); 2000]);
    twins.root["scenes"] = json!([{ "nodes": (0..2000).collect::<Vec<usize>>() }]);
    let mut targets = zeros(1 << 22);
    targets.root["meshes"][0]["primitives"][0]["targets"] = json!(vec![json!({ "POSITION": 2 }); 1000]);
    targets.root["meshes"][0]["weights"] = json!(vec![1.0; 1000]);
    let refused = |name, draft: &Draft, expected: &str| Case::draft(name, draft, Gets::Refused(expected.to_owned()));
    vec![
        refused(
            "2^62 zeros",
            &zeros(1 << 62),
            "Accessor | /accessors/2 | POSITION | /meshes/0/primitives/0 | \"thing\" | 4611686018427387904 | 16777216",
        ),
        refused(
            "more zeros than are read",
            &zeros((1 << 24) + 1),
            "Accessor | /accessors/2 | POSITION | /meshes/0/primitives/0 | \"thing\" | 16777217 | 16777216",
        ),
        refused("as many zeros as are read", &zeros(1 << 24), "TooLarge | 5592405 | 1770 | 512"),
        refused("6000 triangles on 5000 nodes", &instances(6000, 5000), "TooLarge | 30000000 | 512"),
        refused(
            "60,000 triangles on 3000 nodes",
            &instances(60_000, 3000),
            "TooLarge | 180000000 | 134217728 | triangles | most",
        ),
        refused("2000 primitives on 2000 nodes", &twins, "TooLarge | 4000000 | 766 | 512"),
        refused(
            "1000 morph targets of zeros",
            &targets,
            "TooLarge | 4202692608 | 536870912 | vertices | indices | most",
        ),
        Case::refused(
            "objects beyond memory",
            format!(r#"{{"asset":{{"version":"2.0"}},"extras":[{}{{}}]}}"#, "{\"\":0},".repeat(1_000_000)),
            "Document | JSON | 755 | 538",
        ),
    ]
}

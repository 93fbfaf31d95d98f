//! Small files that ask for much: memory is refused before it is taken.

use super::*;

/// A triangle of zeros without data behind them, but for one sparse value.
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

/// One list of indices, `count` times the same triangle, in a mesh on so many nodes.
fn instances(count: usize, nodes: usize) -> Draft {
    let mut draft = triangle();
    let indices = draft.accessor(&vec![0; count * 3], 5121, "SCALAR", count * 3);
    draft.root["meshes"][0]["primitives"][0]["indices"] = json!(indices);
    draft.root["nodes"] = json!(vec![json!({ "mesh": 0 }); nodes]);
    draft.root["scenes"] = json!([{ "nodes": (0..nodes).collect::<Vec<usize>>() }]);
    draft
}

pub fn cases() -> Vec<Case> {
    let mut twins = triangle();
    let primitive = twins.root["meshes"][0]["primitives"][0].clone();
    twins.root["meshes"][0]["primitives"] = json!(vec![primitive; 2000]);
    twins.root["nodes"] = json!(vec![json!({ "mesh": 0 }); 2000]);
    twins.root["scenes"] = json!([{ "nodes": (0..2000).collect::<Vec<usize>>() }]);
    let mut targets = zeros(1 << 22);
    targets.root["meshes"][0]["primitives"][0]["targets"] = json!(vec![json!({ "POSITION": 2 }); 1000]);
    targets.root["meshes"][0]["weights"] = json!(vec![1.0; 1000]);
    let refused = |name, draft: &Draft, sentence: &str| Case::draft(name, draft, Gets::Refused(sentence.to_owned()));
    vec![
        refused(
            "2^62 zeros",
            &zeros(1 << 62),
            "/accessors/2 (POSITION of /meshes/0/primitives/0 (\"thing\")) has 4611686018427387904 elements but no data, and 16777216 such are read at most; export the model again",
        ),
        refused(
            "more zeros than are read",
            &zeros((1 << 24) + 1),
            "/accessors/2 (POSITION of /meshes/0/primitives/0 (\"thing\")) has 16777217 elements but no data, and 16777216 such are read at most; export the model again",
        ),
        refused(
            "as many zeros as are read",
            &zeros(1 << 24),
            "the scene of 5592405 triangles would take at least 1770 MiB of memory, and files of this size may take 256 MiB (--max-memory allows more); split the model into several files",
        ),
        refused(
            "6000 triangles on 3000 nodes",
            &instances(6000, 3000),
            "the scene of 18000000 triangles would take at least 415 MiB of memory, and files of this size may take 256 MiB (--max-memory allows more); split the model into several files",
        ),
        refused(
            "60,000 triangles on 3000 nodes",
            &instances(60_000, 3000),
            "the scene has 180000000 triangles, and 134217728 are read at most; split the model into several files",
        ),
        refused(
            "2000 primitives on 2000 nodes",
            &twins,
            "the scene of 4000000 triangles would take at least 766 MiB of memory, and files of this size may take 256 MiB (--max-memory allows more); split the model into several files",
        ),
        refused(
            "1000 morph targets of zeros",
            &targets,
            "the scene has 4202692608 vertices, displacements of them and indices, and 536870912 are read at most; split the model into several files",
        ),
        Case::refused(
            "objects beyond memory",
            format!(r#"{{"asset":{{"version":"2.0"}},"extras":[{}{{}}]}}"#, "{\"\":0},".repeat(500_000)),
            "its JSON would take at least 378 MiB of memory, and files of this size may take 269 MiB (--max-memory allows more); export the model again",
        ),
    ]
}

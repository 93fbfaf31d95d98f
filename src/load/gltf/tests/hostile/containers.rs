//! Headers, chunks and JSON.

use super::*;

const MINIMAL: &str = r#"{"asset":{"version":"2.0"}}"#;

/// A `.glb` with another number in one place.
fn changed(at: usize, number: u32) -> Vec<u8> {
    let mut glb = triangle().glb();
    glb[at..at + 4].copy_from_slice(&number.to_le_bytes());
    glb
}

/// A file that isn't a glTF document; `parts` are those of its message.
fn no_gltf(name: &'static str, bytes: impl Into<Vec<u8>>, parts: &str) -> Case {
    Case::refused(name, bytes, &format!("NotGltf | {parts}"))
}

pub(super) fn cases() -> Vec<Case> {
    let glb = triangle().glb();
    let json_end = 20 + u32::from_le_bytes([glb[12], glb[13], glb[14], glb[15]]) as usize;
    let cut = |length: usize| {
        let mut glb = glb[..length].to_vec();
        glb[8..12].copy_from_slice(&(length as u32).to_le_bytes());
        glb
    };
    let deep = |open: &str, close: &str| {
        format!(r#"{{"asset":{{"version":"2.0"}},"extras":{}0{}}}"#, open.repeat(1_000_000), close.repeat(1_000_000))
    };
    vec![
        no_gltf("nothing at all", "", "JSON | 1 | 0"),
        no_gltf("four bytes", "glTF", "header | 12 | 4"),
        no_gltf("the first version's header", changed(4, 1), "1 | 2 | header"),
        no_gltf("a length beyond the file", changed(8, u32::MAX), "4294967295 | 540 | header"),
        no_gltf("a length within the header", changed(8, 3), "3 | 540 | header"),
        no_gltf("a chunk beyond the file", changed(12, u32::MAX), "0 | 4294967295 | 520"),
        no_gltf("no JSON first", changed(16, 0x004e_4942), "JSON | chunk"),
        no_gltf("an end within a chunk's header", cut(json_end + 5), "1 | 8 | 5"),
        no_gltf("an end within the binary chunk", cut(json_end + 20), "1 | 72 | 12"),
        no_gltf("JSON without end", r#"{"asset":{"#, "JSON | 1 | 10"),
        no_gltf("JSON that is a list", "[]", "JSON | object"),
        no_gltf("JSON not in UTF-8", &b"{\"asset\":{\"version\":\"2.0\"},\"extras\":\"\xff\"}"[..], "JSON | 1 | 38"),
        no_gltf("half a surrogate pair", r#"{"asset":{"version":"\ud800"}}"#, "JSON | 1 | 28"),
        no_gltf("a number beyond f64", r#"{"asset":{"version":"2.0"},"extras":1e999}"#, "JSON | 1 | 41"),
        no_gltf("lists nested 1,000,000 deep", deep("[", "]"), "JSON | 1000001 | 100"),
        no_gltf("objects nested 1,000,000 deep", deep("{\"a\":", "}"), "JSON | 1000001 | 100"),
        no_gltf("brackets without end", "[".repeat(1_000_000), "JSON | 1000000 | 100"),
        no_gltf("another format", "solid cube", "JSON | 1"),
        no_gltf("no version", "{}", "/asset/version"),
        no_gltf("a version that is true", r#"{"asset":{"version":true}}"#, "/asset/version"),
        no_gltf("the first version", r#"{"asset":{"version":"1.0"}}"#, r#"/asset/version | "1.0""#),
        Case::refused("nothing but a version", MINIMAL, "Empty | triangles | meshes"),
    ]
}

#[test]
fn a_truncated_glb_is_refused_wherever_it_ends() {
    let glb = triangle().glb();
    for length in 0..glb.len() {
        let problem = read_bytes(&glb[..length]).unwrap_err();
        assert!(matches!(problem, GltfError::NotGltf { .. }), "{length}: {problem}");
    }
}

//! Headers, chunks and JSON.

use super::*;

const MINIMAL: &str = r#"{"asset":{"version":"2.0"}}"#;

/// A `.glb` with one place of 4 bytes changed.
fn changed(at: usize, number: u32) -> Vec<u8> {
    let mut glb = triangle().glb();
    glb[at..at + 4].copy_from_slice(&number.to_le_bytes());
    glb
}

fn no_gltf(name: &'static str, bytes: impl Into<Vec<u8>>, reason: &str) -> Case {
    let sentence = format!("not a glTF 2.0 document: {reason}; export the model again as glTF 2.0");
    Case::refused(name, bytes, &sentence)
}

pub fn cases() -> Vec<Case> {
    let glb = triangle().glb();
    let json_end = 20 + u32::from_le_bytes([glb[12], glb[13], glb[14], glb[15]]) as usize;
    let cut = |length: usize| {
        let mut glb = glb[..length].to_vec();
        glb[8..12].copy_from_slice(&(length as u32).to_le_bytes());
        glb
    };
    let deep = |open: &str, close: &str| {
        format!(r#"{{"asset":{{"version":"2.0"}},"extras":{}0{}}}"#, open.repeat(100_000), close.repeat(100_000))
    };
    vec![
        no_gltf("nothing at all", "", "its JSON ends too early, at line 1, column 0"),
        no_gltf("four bytes", "glTF", "the file ends within its header, which takes 12 bytes of its 4"),
        no_gltf("the first version's header", changed(4, 1), "its header says version 1, and 2 is read"),
        no_gltf("a length beyond the file", changed(8, u32::MAX), "its header says 4294967295 bytes, the file has 540"),
        no_gltf("a length within the header", changed(8, 3), "its header says 3 bytes, the file has 540"),
        no_gltf("a chunk beyond the file", changed(12, u32::MAX), "chunk 0 says 4294967295 bytes, and 520 are left"),
        no_gltf("no JSON first", changed(16, 0x004e_4942), "its first chunk holds no JSON"),
        no_gltf(
            "an end within a chunk's header",
            cut(json_end + 5),
            "chunk 1 ends within its header, which takes 8 bytes of 5",
        ),
        no_gltf("an end within the binary chunk", cut(json_end + 20), "chunk 1 says 72 bytes, and 12 are left"),
        no_gltf("JSON without end", r#"{"asset":{"#, "its JSON ends too early, at line 1, column 10"),
        no_gltf("JSON that is a list", "[]", "it is no JSON object"),
        no_gltf(
            "JSON not in UTF-8",
            &b"{\"asset\":{\"version\":\"2.0\"},\"extras\":\"\xff\"}"[..],
            "its JSON is broken: invalid unicode code point at line 1 column 38",
        ),
        no_gltf(
            "half a surrogate pair",
            r#"{"asset":{"version":"\ud800"}}"#,
            "its JSON is broken: unexpected end of hex escape at line 1 column 28",
        ),
        no_gltf(
            "a number beyond f64",
            r#"{"asset":{"version":"2.0"},"extras":1e999}"#,
            "its JSON is broken: number out of range at line 1 column 41",
        ),
        no_gltf("lists nested 100,000 deep", deep("[", "]"), "its JSON is nested 100001 deep, and 100 are read"),
        no_gltf(
            "objects nested 100,000 deep",
            deep("{\"a\":", "}"),
            "its JSON is nested 100001 deep, and 100 are read",
        ),
        no_gltf("brackets without end", "[".repeat(100_000), "its JSON is nested 100000 deep, and 100 are read"),
        no_gltf("another format", "solid cube", "its JSON is broken: expected value at line 1 column 1"),
        no_gltf("no version", "{}", "it has no /asset/version"),
        no_gltf("a version that is a number", r#"{"asset":{"version":2}}"#, "it has no /asset/version"),
        no_gltf("the first version", r#"{"asset":{"version":"1.0"}}"#, r#"its /asset/version is "1.0""#),
        Case::refused("nothing but a version", MINIMAL, "no triangles: the document has no meshes"),
    ]
}

#[test]
fn a_truncated_glb_is_refused_wherever_it_ends() {
    let glb = triangle().glb();
    for length in 0..glb.len() {
        let problem = read_bytes(&glb[..length]).unwrap_err();
        assert!(matches!(problem, Problem::NotGltf { .. }), "{length}: {problem}");
    }
}

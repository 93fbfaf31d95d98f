//! A small glTF document with a material variant, which tests write and then read.

/// A triangle that is red, and blue in the variant `Night`.
pub const LAMP: &str = r#"{
    "asset": { "version": "2.0" },
    "extensions": { "KHR_materials_variants": { "variants": [{ "name": "Night" }] } },
    "nodes": [{ "mesh": 0 }],
    "scenes": [{ "nodes": [0] }],
    "scene": 0,
    "buffers": [{ "byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA" }],
    "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
    "accessors": [{ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3" }],
    "materials": [{ "name": "red" }, { "name": "blue" }],
    "meshes": [{ "primitives": [{
        "attributes": { "POSITION": 0 },
        "material": 0,
        "extensions": { "KHR_materials_variants": { "mappings": [{ "material": 1, "variants": [0] }] } }
    }] }]
}"#;

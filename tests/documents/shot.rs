//! A small glTF document with cameras, which tests write and then read.

/// A triangle, and two cameras in front of it: `Close`, which sees it in perspective and turned by a quarter, and one without a
/// name, which is orthographic.
pub const SHOT: &str = r#"{
    "asset": { "version": "2.0" },
    "nodes": [
        { "mesh": 0 },
        { "name": "Close", "camera": 0, "translation": [0.25, 0.25, 2], "rotation": [0, 0, 0.70710678, 0.70710678] },
        { "camera": 1, "translation": [0, 0, 3] }
    ],
    "scenes": [{ "nodes": [0, 1, 2] }],
    "scene": 0,
    "cameras": [
        { "type": "perspective", "perspective": { "yfov": 0.5, "znear": 0.1 } },
        { "type": "orthographic", "orthographic": { "xmag": 1, "ymag": 1.5, "znear": 0, "zfar": 9 } }
    ],
    "buffers": [{ "byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA" }],
    "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
    "accessors": [{ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3" }],
    "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }]
}"#;

//! Draco data that lie, and documents that lie about them.

use super::draco::{Order, grid, skinned};
use super::*;

const PRIMITIVE: &str = "/meshes/0/primitives/0";
const UNPACK: &str = "decompress the model first (gltf-transform, for one, can)";
const EXTENSION: &str = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression";

/// A packed grid in which one place of the document says something else.
fn with(name: &'static str, pointer: &str, value: Value, sentence: &str) -> Case {
    let mut draft = grid(Order::Walked);
    set(&mut draft.root, pointer, value);
    Case::refused(name, draft.document().to_string(), &format!("{sentence}; export the model again"))
}

/// One whose data are changed, and lie first in the buffer.
fn bytes(name: &'static str, order: Order, change: impl Fn(&mut Vec<u8>), sentence: &str) -> Case {
    let mut draft = grid(order);
    change(&mut draft.bytes);
    draft.root["bufferViews"][0]["byteLength"] = json!(draft.bytes.len());
    Case::refused(name, draft.document().to_string(), &format!("{EXTENSION} {sentence}"))
}

/// A varint of the specification: seven bits a byte, the least first.
fn varint(mut value: u64) -> Vec<u8> {
    let mut bytes = Vec::new();
    while value > 127 {
        bytes.push(value as u8 | 128);
        value >>= 7;
    }
    bytes.push(value as u8);
    bytes
}

/// Indices of a triangle in order, as symbols of which a table says that there are as many as its bytes may name: a megabyte
/// that would take half a gigabyte, of a mesh of three vertices.
fn table() -> Draft {
    let mut draft = skinned();
    let length = 1 << 20;
    let mut bytes = b"DRACO\x02\x02\x01\0\0\0\x01\x03\0\x01\x01".to_vec();
    bytes.extend(varint((length - 32) * 64));
    bytes.resize(length as usize, 0);
    let view = draft.view(&bytes);
    set(&mut draft.root, &format!("{EXTENSION}/bufferView"), json!(view));
    draft
}

/// A header of 2^31 triangles; accessors of so many indices.
fn huge(indices: u64) -> Draft {
    let mut draft = grid(Order::Kept);
    let counts = [varint(1 << 31), varint(81)].concat();
    draft.bytes = [&draft.bytes[..11], &counts, &[0; 64]].concat();
    draft.root["bufferViews"][0]["byteLength"] = json!(draft.bytes.len());
    draft.root["accessors"][3]["count"] = json!(indices);
    draft
}

fn documents() -> Vec<Case> {
    let at = |place: &str| format!("{EXTENSION}{place}");
    let member = |place: &str| format!("{PRIMITIVE}{place}");
    let mut unindexed = grid(Order::Walked);
    set(&mut unindexed.root, &member("/indices"), json!(null));
    unindexed.root["accessors"][3]["bufferView"] = json!(0);
    vec![
        with(
            "a view of Draco data that isn't there",
            &at("/bufferView"),
            json!(9),
            &at("/bufferView is 9, and /bufferViews has 1"),
        ),
        with("no view", &at("/bufferView"), json!(null), &at("/bufferView is missing")),
        with("no ids", &at("/attributes"), json!(null), &at("/attributes is missing")),
        with(
            "ids in a list",
            &at("/attributes"),
            json!([0]),
            &at("/attributes should be an object and is a list of 1"),
        ),
        with(
            "an id below 0",
            &at("/attributes/NORMAL"),
            json!(-1),
            &at("/attributes/NORMAL should be a whole number and is -1"),
        ),
        with(
            "an id beyond 32 bits",
            &at("/attributes/_HEAT"),
            json!(1_u64 << 32),
            &at("/attributes/_HEAT is 4294967296, and 4294967295 is the most"),
        ),
        with(
            "an id of nothing",
            &at("/attributes/NORMAL"),
            json!(7),
            &at(" says that NORMAL is attribute 7, which its data doesn't have"),
        ),
        with(
            "no id for positions",
            &at("/attributes"),
            json!({ "NORMAL": 1 }),
            &at(" names no POSITION among its attributes"),
        ),
        with(
            "another attribute's id",
            &at("/attributes/TEXCOORD_0"),
            json!(0),
            &at(" holds 3 numbers a vertex for TEXCOORD_0, and its accessor says 2"),
        ),
        with(
            "Draco data beyond the buffer",
            "/bufferViews/0/byteLength",
            json!(1 << 20),
            &at(" uses /bufferViews/0, which takes 1048576 bytes from byte 0 of /buffers/0, which has 307"),
        ),
        with(
            "a strip",
            &member("/mode"),
            json!(5),
            &at(" is of a strip or a fan, and only lists of triangles are read from there"),
        ),
        Case::refused(
            "Draco data without indices",
            unindexed.document().to_string(),
            &format!("{EXTENSION} is of a primitive without indices, which it always has; export the model again"),
        ),
        with(
            "indices that are more",
            "/accessors/3/count",
            json!(387),
            &at(" holds 128 triangles, and its indices' accessor says 387 indices"),
        ),
        with(
            "indices of no triangle",
            "/accessors/3/count",
            json!(385),
            &at(" holds 128 triangles, and its indices' accessor says 385 indices"),
        ),
        with(
            "vertices that are more",
            "/accessors/0/count",
            json!(82),
            &at(" holds 81 vertices and 128 triangles, and its accessors say 82 and 128"),
        ),
        with(
            "vertices that are fewer",
            "/accessors/0/count",
            json!(5),
            &at(" becomes more than 5 vertices with the attributes it names"),
        ),
        with(
            "normals that are fewer",
            "/accessors/1/count",
            json!(80),
            "/accessors/1 (NORMAL of /meshes/0/primitives/0 (\"thing\")) has 80 elements for 81 vertices",
        ),
        with(
            "floats that are called whole",
            "/accessors/1/componentType",
            json!(5120),
            &at(" holds NORMAL as F32, and its accessor says I8"),
        ),
        with(
            "a width that is normalised",
            "/accessors/0",
            json!({ "componentType": 5121, "type": "VEC3", "count": 81, "normalized": true }),
            &at(" holds POSITION as U16, and its accessor says U8"),
        ),
        with(
            "packed and sparse",
            "/accessors/1/sparse",
            json!({ "count": 1, "indices": { "bufferView": 0, "componentType": 5121 }, "values": { "bufferView": 0 } }),
            &at(" holds NORMAL, whose accessor is sparse"),
        ),
    ]
}

pub fn cases() -> Vec<Case> {
    let wrong = |reason: &str| format!("{reason}; export the model again");
    let cut = |length: usize| wrong(&format!("can't be decompressed: its {length} bytes aren't whole Draco data"));
    let mut cases = documents();
    cases.extend([
        bytes("no Draco data", Order::Kept, |bytes| bytes[0] = b'd', &wrong("is of data that don't begin with DRACO")),
        bytes("no byte of Draco data", Order::Kept, Vec::clear, &wrong("ends within its header: it has 0 bytes")),
        bytes(
            "a Draco header cut off",
            Order::Walked,
            |b| b.truncate(12),
            &wrong("ends within its header: it has 12 bytes"),
        ),
        bytes("an older Draco", Order::Walked, |b| b[6] = 1, &wrong("is of Draco's version 2.1, and 2.2 is read")),
        bytes(
            "points alone",
            Order::Walked,
            |bytes| bytes[7] = 0,
            &wrong("is of kind 0 and method 1, and a mesh is of kind 1 and method 0 or 1"),
        ),
        bytes("metadata that aren't there", Order::Kept, |b| b[10] = 0x80, &wrong("has metadata that can't be read")),
        bytes(
            "metadata without end in one another",
            Order::Kept,
            |bytes| {
                bytes[10] = 0x80;
                bytes.truncate(11);
                bytes.push(0);
                bytes.extend([0, 1, 0].repeat(100_000));
            },
            &wrong("has metadata that can't be read"),
        ),
        bytes("connectivity cut off", Order::Walked, |b| b.truncate(20), &cut(20)),
        bytes("attributes cut off", Order::Kept, |b| b.truncate(500), &cut(500)),
        bytes(
            "2^40 vertices",
            Order::Kept,
            |bytes| _ = bytes.splice(13..14, varint(1 << 40)),
            &wrong("holds 1099511627776 vertices, and its accessors say 81"),
        ),
        Case::refused(
            "2^31 triangles of 384 indices",
            huge(384).document().to_string(),
            &wrong(&format!("{EXTENSION} holds 2147483648 triangles, and its indices' accessor says 384 indices")),
        ),
        Case::refused(
            "2^31 triangles",
            huge(3 << 31).document().to_string(),
            &format!("{EXTENSION} would take at least 24577 MiB of memory, and files of this size may take 256 MiB (--max-memory allows more); {UNPACK}"),
        ),
        Case::refused(
            "a table of 2^26 symbols",
            table().document().to_string(),
            &format!("{EXTENSION} would take at least 523 MiB of memory, and files of this size may take 261 MiB (--max-memory allows more); {UNPACK}"),
        ),
    ]);
    cases
}

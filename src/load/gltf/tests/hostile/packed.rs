//! Wrong Draco data, and documents that don't fit their Draco data.

use super::draco::{Order, grid, skinned};
use super::*;

const PRIMITIVE: &str = "/meshes/0/primitives/0";
const EXTENSION: &str = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression";

/// A compressed grid with another value in one place of the document.
fn with(name: &'static str, pointer: &str, value: Value, parts: &str) -> Case {
    let kind = if parts.starts_with("/accessors") { "Accessor" } else { "Document" };
    let mut draft = grid(Order::Walked);
    set(&mut draft.root, pointer, value);
    Case::refused(name, draft.document().to_string(), &format!("{kind} | {parts}"))
}

/// A compressed grid whose data is changed; it lies at the start of the buffer.
fn bytes(name: &'static str, order: Order, change: impl Fn(&mut Vec<u8>), parts: &str) -> Case {
    let mut draft = grid(order);
    change(&mut draft.bytes);
    draft.root["bufferViews"][0]["byteLength"] = json!(draft.bytes.len());
    Case::refused(name, draft.document().to_string(), &format!("Document | {EXTENSION} | {parts}"))
}

/// Encodes a varint of the specification: seven bits a byte, the lowest first.
fn varint(mut value: u64) -> Vec<u8> {
    let mut bytes = Vec::new();
    while value > 127 {
        bytes.push(value as u8 | 128);
        value >>= 7;
    }
    bytes.push(value as u8);
    bytes
}

/// The indices of a mesh with three vertices, encoded with a table of as many symbols as its bytes can name: a megabyte
/// that would take half a gigabyte.
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

/// A header of 2^31 triangles, with accessors of `indices` indices.
fn huge(indices: u64) -> Draft {
    let mut draft = grid(Order::Kept);
    let counts = [varint(1 << 31), varint(81)].concat();
    draft.bytes = [&draft.bytes[..11], &counts, &[0; 64]].concat();
    draft.root["bufferViews"][0]["byteLength"] = json!(draft.bytes.len());
    draft.root["accessors"][3]["count"] = json!(indices);
    draft
}

/// Normals for all vertices but one.
fn fewer_normals() -> Case {
    let mut draft = grid(Order::Kept);
    draft.root["accessors"][1]["count"] = json!(80);
    let said = "/accessors/1 | NORMAL | /meshes/0/primitives/0 | \"thing\" | 80 | 81 | left out";
    Case::draft("normals that are fewer", &draft, Gets::Repaired(said))
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
            &at("/bufferView | 9 | /bufferViews | 1"),
        ),
        with("no view", &at("/bufferView"), json!(null), &at("/bufferView | missing")),
        with("no ids", &at("/attributes"), json!(null), &at("/attributes | missing")),
        with("ids in a list", &at("/attributes"), json!([0]), &at("/attributes | 1 | object | list")),
        with("an id below 0", &at("/attributes/NORMAL"), json!(-1), &at("/attributes/NORMAL | -1 | whole number")),
        with(
            "an id beyond 32 bits",
            &at("/attributes/NORMAL"),
            json!(1_u64 << 32),
            &at("/attributes/NORMAL | 4294967296 | 4294967295"),
        ),
        Case { gets: Gets::Read, ..with("an id that nothing reads", &at("/attributes/_HEAT"), json!(-1), "") },
        with("an id of nothing", &at("/attributes/NORMAL"), json!(7), &at(" | NORMAL | 7")),
        with("no id for positions", &at("/attributes"), json!({ "NORMAL": 1 }), &at(" | POSITION")),
        Case {
            gets: Gets::Repaired("TEXCOORD_0 | can't be decompressed | holds 3 numbers a vertex"),
            ..with("another attribute's id", &at("/attributes/TEXCOORD_0"), json!(0), "")
        },
        with(
            "Draco data beyond the buffer",
            "/bufferViews/0/byteLength",
            json!(1 << 20),
            &at(" | /bufferViews/0 | 1048576 | 0 | /buffers/0 | 307"),
        ),
        with("a strip", &member("/mode"), json!(5), &at(" | strip | fan | triangles")),
        Case::refused(
            "Draco data without indices",
            unindexed.document().to_string(),
            &format!("Document | {EXTENSION} | indices"),
        ),
        with("indices that are more", "/accessors/3/count", json!(387), &at(" | 128 | 387 | triangles | indices")),
        with("indices of no triangle", "/accessors/3/count", json!(385), &at(" | 128 | 385 | triangles | indices")),
        with("vertices that are more", "/accessors/0/count", json!(82), &at(" | 81 | 128 | 82")),
        with("vertices that are fewer", "/accessors/0/count", json!(5), &at(" | 5 | vertices")),
        fewer_normals(),
        with("floats that are called whole", "/accessors/1/componentType", json!(5120), &at(" | NORMAL | F32 | I8")),
        with(
            "a width that is normalised",
            "/accessors/0",
            json!({ "componentType": 5121, "type": "VEC3", "count": 81, "normalized": true }),
            &at(" | POSITION | U16 | U8"),
        ),
        with(
            "packed and sparse",
            "/accessors/1/sparse",
            json!({ "count": 1, "indices": { "bufferView": 0, "componentType": 5121 }, "values": { "bufferView": 0 } }),
            &at(" | NORMAL | sparse"),
        ),
    ]
}

pub(super) fn cases() -> Vec<Case> {
    let cut = |length: usize| length.to_string();
    let mut cases = documents();
    cases.extend([
        bytes("no Draco data", Order::Kept, |bytes| bytes[0] = b'd', "DRACO"),
        bytes("no byte of Draco data", Order::Kept, Vec::clear, "header | 0"),
        bytes("a Draco header cut off", Order::Walked, |b| b.truncate(12), "12 | header"),
        bytes("an older Draco", Order::Walked, |b| b[6] = 1, "2.1 | 2.2"),
        bytes("points alone", Order::Walked, |bytes| bytes[7] = 0, "kind 0 | method 1"),
        bytes("metadata that aren't there", Order::Kept, |b| b[10] = 0x80, "metadata"),
        bytes(
            "metadata without end in one another",
            Order::Kept,
            |bytes| {
                bytes[10] = 0x80;
                bytes.truncate(11);
                bytes.push(0);
                bytes.extend([0, 1, 0].repeat(100_000));
            },
            "metadata",
        ),
        bytes("connectivity cut off", Order::Walked, |b| b.truncate(20), &cut(20)),
        bytes("attributes cut off", Order::Kept, |b| b.truncate(500), &cut(500)),
        bytes(
            "2^40 vertices",
            Order::Kept,
            |bytes| _ = bytes.splice(13..14, varint(1 << 40)),
            "1099511627776 | 81 | vertices",
        ),
        Case::refused(
            "2^31 triangles of 384 indices",
            huge(384).document().to_string(),
            &format!("Document | {EXTENSION} | 2147483648 | 384"),
        ),
        Case::refused(
            "2^31 triangles",
            huge(3 << 31).document().to_string(),
            &format!("Draco | {EXTENSION} | 512 MiB | --max-memory"),
        ),
        Case::refused(
            "a table of 2^26 symbols",
            table().document().to_string(),
            &format!("Draco | {EXTENSION} | 517 MiB | --max-memory"),
        ),
    ]);
    cases
}

//! Odd documents that open (see `load/hostile_files/odd.rs`).

use super::*;
use crate::Format;
use crate::hostile_files::odd::Odd;

fn of(name: &'static str, bytes: impl Into<Vec<u8>>, triangles: usize, warning: &'static str) -> Odd {
    Odd { name, format: Format::Gltf, bytes: bytes.into(), triangles, warning }
}

/// The document of a triangle after a change.
fn with(name: &'static str, warning: &'static str, change: impl FnOnce(&mut Value)) -> Odd {
    let mut root = triangle().document();
    change(&mut root);
    of(name, root.to_string(), 1, warning)
}

/// A `.glb` whose JSON and chunks are these.
fn glb(json: &[u8], chunks: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
    let mut all = vec![(b"JSON", json)];
    all.extend(chunks);
    let body: Vec<u8> = all
        .iter()
        .flat_map(|(kind, bytes)| [&(bytes.len() as u32).to_le_bytes()[..], &kind[..], bytes].concat())
        .collect();
    [&b"glTF"[..], &2_u32.to_le_bytes(), &(12 + body.len() as u32).to_le_bytes(), &body].concat()
}

pub(crate) fn odd() -> Vec<Odd> {
    [texts(), addresses(), containers(), accessors(), primitives()].into_iter().flatten().collect()
}

/// Oddities of the JSON.
fn texts() -> Vec<Odd> {
    let text = triangle().document().to_string();
    let pretty = serde_json::to_string_pretty(&triangle().document()).expect("JSON");
    vec![
        of("a byte order mark", format!("\u{feff}{text}"), 1, ""),
        of("white space around the document", format!("\r\n\t {text}\r\n\n"), 1, ""),
        of("line ends of Windows", pretty.replace('\n', "\r\n"), 1, ""),
        of("whole numbers written as fractions", text.replace("\"count\":3", "\"count\":3.0"), 1, ""),
        of("whole numbers with exponents", text.replace("\"count\":3", "\"count\":3e0"), 1, ""),
        with("a version that is a number", "is the number 2 | read as 2.0", |root| {
            root["asset"]["version"] = json!(2.0)
        }),
        with("no default scene", "", |root| _ = root.as_object_mut().map(|root| root.remove("scene"))),
        with("no scenes", "", |root| {
            root.as_object_mut().map(|root| (root.remove("scene"), root.remove("scenes")));
        }),
        with("members that aren't known", "", |root| {
            root["author"] = json!({ "name": null });
            root["meshes"][0]["primitives"][0]["visible"] = json!(true);
        }),
        with("empty lists", "", |root| {
            root["materials"] = json!([]);
            root["images"] = json!([]);
            root["extensionsUsed"] = json!([]);
        }),
        with("members that are null", "", |root| {
            root["nodes"][0]["name"] = Value::Null;
            root["meshes"][0]["primitives"][0]["material"] = Value::Null;
        }),
        with("an extension of another program", "ACME_sparkles", |root| {
            root["extensionsUsed"] = json!(["ACME_sparkles"]);
            root["extensions"] = json!({ "ACME_sparkles": { "many": true } });
        }),
        with("names in every script", "", |root| root["nodes"][0]["name"] = json!("三角 \u{1f98a}\u{0}")),
        with("a rotation whose length isn't 1", "", |root| root["nodes"][0]["rotation"] = json!([0, 0, 0, 1.00001])),
    ]
}

/// Oddities of addresses.
fn addresses() -> Vec<Odd> {
    let own = |change: fn(&str) -> String| {
        move |root: &mut Value| {
            let uri = root["buffers"][0]["uri"].as_str().map(change);
            root["buffers"][0]["uri"] = json!(uri);
        }
    };
    let file = |uri: &'static str| {
        move |root: &mut Value| {
            root["buffers"] = json!([{ "byteLength": 36, "uri": uri }]);
            root["accessors"][1] = json!({ "componentType": 5126, "type": "VEC3", "count": 3 });
            root["bufferViews"] = json!([{ "buffer": 0, "byteLength": 36 }]);
            root["meshes"][0]["primitives"][0]["attributes"] = json!({ "POSITION": 0 });
        }
    };
    vec![
        with("data of type application/gltf-buffer", "", own(|uri| uri.replace("octet-stream", "gltf-buffer"))),
        with(
            "data of type text/plain with a charset",
            "",
            own(|uri| uri.replace("application/octet-stream", "text/plain;charset=utf-8")),
        ),
        with("data without a type", "", own(|uri| uri.replace("application/octet-stream", ""))),
        with(
            "data in capitals",
            "",
            own(|uri| uri.replace("data:application/octet-stream;base64", "DATA:application/octet-stream;BASE64")),
        ),
        with("base64 without padding", "", own(|uri| uri.trim_end_matches('=').to_owned())),
        with("base64 with line ends", "", own(|uri| uri.replace("AAAA", "AAAA\r\n"))),
        with("a name with %20", "", file("three%20positions.bin")),
        with("a name with a space", "", file("three positions.bin")),
        with("a name after ./", "", file("./three%20positions.bin")),
        with("a name with %2e", "", file("three%20positions%2Ebin")),
    ]
}

/// Oddities of `.glb` files.
fn containers() -> Vec<Odd> {
    let draft = triangle();
    let whole = draft.glb();
    let mut root = draft.root.clone();
    root["buffers"] = json!([{ "byteLength": draft.bytes.len() }]);
    let padded = |by: u8| {
        let mut json = root.to_string().into_bytes();
        json.resize(json.len().next_multiple_of(4), by);
        json
    };
    let json = padded(b' ');
    let bin = (b"BIN\0", &draft.bytes[..]);
    let mut longer = whole.clone();
    longer.extend([0; 7]);
    vec![
        of("a .glb with bytes after its end", longer, 1, ""),
        of(
            "a .glb whose header leaves out its last four bytes",
            {
                let mut short = triangle().glb();
                let length = (short.len() as u32 - 4).to_le_bytes();
                short[8..12].copy_from_slice(&length);
                short
            },
            1,
            "header says that it has 536 bytes | until 540",
        ),
        of("a .glb whose JSON ends with zero bytes", glb(&[padded(0), vec![0; 4]].concat(), &[bin]), 1, ""),
        of("a .glb whose JSON isn't padded", glb(root.to_string().as_bytes(), &[bin]), 1, ""),
        of(
            "a .glb whose JSON begins with a byte order mark",
            glb(&[&b"\xef\xbb\xbf"[..], &json, b" "].concat(), &[bin]),
            1,
            "",
        ),
        of("a .glb with a chunk of another kind at its end", glb(&json, &[bin, (b"META", b"{}  ")]), 1, ""),
        of("a .glb with an empty chunk of another kind", glb(&json, &[bin, (b"NONE", b"")]), 1, ""),
        of(
            "a .glb with more binary data than its buffer",
            glb(&json, &[(b"BIN\0", &[&draft.bytes[..], &[0; 9]].concat())]),
            1,
            "",
        ),
        of(
            "a .glb without binary data, whose buffer is a data URI",
            glb(triangle().document().to_string().as_bytes(), &[]),
            1,
            "",
        ),
    ]
}

/// Oddities of buffers and accessors.
fn accessors() -> Vec<Odd> {
    let mut strided = Draft::new();
    let rows: Vec<u8> = TRIANGLE.iter().flat_map(|row| [bytemuck::cast_slice(row), &[9_u8; 8][..]].concat()).collect();
    let at = strided.accessor(&rows, 5126, "VEC3", 3);
    strided.root["bufferViews"][0]["byteStride"] = json!(20);
    strided.primitive(json!({ "attributes": { "POSITION": at } }));
    let mut sparse = Draft::new();
    let (indices, values) = (sparse.view(&[1, 2]), sparse.view(bytemuck::cast_slice(&TRIANGLE[1..])));
    let zeros = json!({ "componentType": 5126, "type": "VEC3", "count": 3, "sparse": {
        "count": 2, "indices": { "bufferView": indices, "componentType": 5121 }, "values": { "bufferView": values } } });
    let at = sparse.push("accessors", zeros);
    sparse.primitive(json!({ "attributes": { "POSITION": at } }));
    let mut zeros = triangle();
    let at = zeros.push("accessors", json!({ "componentType": 5126, "type": "VEC2", "count": 3 }));
    zeros.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(at);
    let mut shifted = Draft::new();
    shifted.view(&[0]);
    let bytes = [&[0][..], bytemuck::cast_slice(&TRIANGLE)].concat();
    shifted.bytes = bytes;
    shifted.root["bufferViews"] = json!([{ "buffer": 0, "byteOffset": 1, "byteLength": 36 }]);
    shifted.root["accessors"] = json!([{ "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3 }]);
    shifted.primitive(json!({ "attributes": { "POSITION": 0 } }));
    vec![
        of("positions between other bytes", strided.document().to_string(), 1, ""),
        of("positions that are sparse, without a buffer view", sparse.document().to_string(), 1, ""),
        of("texture coordinates without a buffer view", zeros.document().to_string(), 1, ""),
        of("positions at an odd byte", shifted.document().to_string(), 1, ""),
        with("no bounds of positions", "", |root| {
            _ = root["accessors"][0].as_object_mut().map(|own| own.remove("min"))
        }),
        with("bounds of positions that are wrong", "", |root| root["accessors"][0]["max"] = json!([9, 9, 9])),
        with("a buffer longer than it says", "", |root| root["buffers"][0]["byteLength"] = json!(72)),
        with("a target that isn't known", "", |root| root["bufferViews"][0]["target"] = json!(1)),
    ]
}

/// Oddities of primitives.
fn primitives() -> Vec<Odd> {
    let of_mode = |name, mode: u32, indices: Option<&[u16]>, triangles, warning| {
        let mut draft = Draft::new();
        let positions = draft.vectors(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]]);
        let mut primitive = json!({ "attributes": { "POSITION": positions }, "mode": mode });
        if let Some(indices) = indices {
            primitive["indices"] = json!(draft.indices(indices));
        }
        draft.primitive(primitive);
        of(name, draft.document().to_string(), triangles, warning)
    };
    let mut bytes = triangle();
    let at = bytes.accessor(&[0, 1, 2], 5121, "SCALAR", 3);
    bytes.root["meshes"][0]["primitives"][0]["indices"] = json!(at);
    vec![
        of("indices of bytes", bytes.document().to_string(), 1, ""),
        of_mode("a strip of triangles", 5, None, 2, ""),
        of_mode("a fan of triangles", 6, None, 2, ""),
        of_mode("four indices of a list of triangles", 4, Some(&[0, 1, 2, 3]), 1, "no whole triangle"),
        of_mode("a triangle with the same vertex twice", 4, Some(&[0, 1, 2, 0, 0, 1]), 2, ""),
        with("a mode that isn't said", "", |root| {
            _ = root["meshes"][0]["primitives"][0].as_object_mut().map(|own| own.remove("mode"))
        }),
        with("an attribute of another program", "", |root| {
            root["meshes"][0]["primitives"][0]["attributes"]["_HEAT"] = json!(1)
        }),
        with("two nodes with the same mesh, one scaled by -1", "", |root| {
            root["nodes"] = json!([{ "mesh": 0, "scale": [-1, 1, 1] }]);
        }),
        with("a node that is its parent's copy", "", |root| {
            root["nodes"] = json!([{ "children": [1] }, { "mesh": 0, "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 5,0,0,1] }])
        }),
        with("a material that isn't in the file", "material", |root| {
            root["meshes"][0]["primitives"][0]["material"] = json!(7)
        }),
    ]
}

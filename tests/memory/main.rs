//! Measures how much memory a load takes, with an allocator that counts: at most four times the file's size, plus 512
//! MiB; and less than twice as much for data that was made to make a decoder take more. These tests are a program of their own, so that nothing else is counted.
//!
//! `PNAEN_TRIANGLES=3000000 cargo test --release --test memory -- --nocapture` measures larger meshes than the tests
//! have time for.

mod bounded;
#[path = "../counting/mod.rs"]
mod counting;
mod fbx;
mod glb;
mod grid;
mod heights;
mod honest;
mod packed;
mod textures;

use documents::package;
use std::io::Write;
use std::sync::{Mutex, PoisonError};

use geometry::progress::Progress;
use load::{Limits, LoadError, LoadedMesh, load};
use serde_json::{Value, json};
use tempfile::TempPath;

use counting::peak_of;

/// Writes a temporary file whose name has this end. It is removed when its path is dropped.
fn temporary(name: &str, bytes: &[u8]) -> TempPath {
    let mut file = tempfile::Builder::new().suffix(name).tempfile().expect("a writable temporary folder");
    file.write_all(bytes).expect("a writable temporary folder");
    file.into_temp_path()
}

/// Lets one test run at a time, since the memory of all tests is counted together.
static ALONE: Mutex<()> = Mutex::new(());

/// Loads a `.glb`, checks the memory against what its size allows, and returns how much it took, in MiB.
fn measured(name: &str, bytes: Vec<u8>) -> (Result<LoadedMesh, LoadError>, usize) {
    let (result, took) = taken(&format!("{name}.glb"), bytes);
    (result, took >> 20)
}

/// Loads any file in the same way, after its bytes have been freed. Returns how much memory it took, in bytes.
fn taken(name: &str, bytes: Vec<u8>) -> (Result<LoadedMesh, LoadError>, usize) {
    taken_within(name, bytes, 1)
}

/// Loads a file that was made to make a decoder take more than is counted: it takes less than twice as much as its size allows.
fn bomb(name: &str, bytes: Vec<u8>) -> (Result<LoadedMesh, LoadError>, usize) {
    taken_within(name, bytes, 2)
}

fn taken_within(name: &str, bytes: Vec<u8>, times: usize) -> (Result<LoadedMesh, LoadError>, usize) {
    let (file, size) = (temporary(name, &bytes), bytes.len());
    drop(bytes);
    let (result, took) = peak_of(|| load(&file, &Limits::default(), &Progress::new()));
    let allowed = 4 * size + Limits::default().memory as usize;
    println!("{name}: {} of {} MiB, loaded: {}", took >> 20, allowed >> 20, result.is_ok());
    assert!(took <= times * allowed, "{name}: {took} of {allowed} bytes");
    (result, took)
}

/// A `.glb` of a square with this number of vertices a side, or of a smaller one on many nodes.
fn grid(side: u32, nodes: usize) -> Vec<u8> {
    let at = (0..side * side).flat_map(|i| [(i % side) as f32, (i / side) as f32, 0.0]);
    let normals = (0..side * side).flat_map(|_| [0.0, 0.0, 1.0_f32]);
    let positions: Vec<u8> = at.flat_map(f32::to_le_bytes).collect();
    let normals: Vec<u8> = normals.flat_map(f32::to_le_bytes).collect();
    let corners = (0..(side - 1) * (side - 1)).map(|i| i / (side - 1) * side + i % (side - 1));
    let indices = corners.flat_map(|a| [a, a + 1, a + side, a + 1, a + side + 1, a + side]);
    let indices: Vec<u8> = indices.flat_map(u32::to_le_bytes).collect();
    let (vertices, count) = (side * side, indices.len() / 4);
    let view = |offset: usize, bytes: &[u8]| json!({ "buffer": 0, "byteOffset": offset, "byteLength": bytes.len() });
    let root = json!({
        "asset": { "version": "2.0" },
        "scenes": [{ "nodes": (0..nodes).collect::<Vec<_>>() }],
        "nodes": (0..nodes).map(|i| json!({ "mesh": 0, "translation": [0, 0, i] })).collect::<Vec<_>>(),
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0, "NORMAL": 1 }, "indices": 2 }] }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": vertices },
            { "bufferView": 1, "componentType": 5126, "type": "VEC3", "count": vertices },
            { "bufferView": 2, "componentType": 5125, "type": "SCALAR", "count": count },
        ],
        "bufferViews": [
            view(0, &positions), view(positions.len(), &normals), view(positions.len() + normals.len(), &indices),
        ],
        "buffers": [{ "byteLength": positions.len() + normals.len() + indices.len() }],
    });
    glb(&root, &[positions, normals, indices].concat())
}

fn glb(root: &Value, bin: &[u8]) -> Vec<u8> {
    let mut json = root.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let total = (28 + json.len() + bin.len()) as u32;
    let number = |number: usize| (number as u32).to_le_bytes();
    let header = [&b"glTF"[..], &2_u32.to_le_bytes(), &total.to_le_bytes()].concat();
    [&header, &number(json.len())[..], b"JSON", &json, &number(bin.len()), b"BIN\0", bin].concat()
}

/// A triangle with a texture of one colour and this size in px a side.
fn textured(side: u32) -> Vec<u8> {
    let mut png = std::io::Cursor::new(Vec::new());
    image::RgbImage::new(side, side).write_to(&mut png, image::ImageFormat::Png).expect("an image in memory");
    with_image(&png.into_inner())
}

/// A triangle with this image as its texture.
fn with_image(image: &[u8]) -> Vec<u8> {
    let at: Vec<u8> =
        [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0_f32].into_iter().flat_map(f32::to_le_bytes).collect();
    let bin = [&at, image].concat();
    let root = json!({
        "asset": { "version": "2.0" },
        "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "material": 0 }] }],
        "materials": [{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }],
        "textures": [{ "source": 0 }],
        "images": [{ "bufferView": 1 }],
        "accessors": [{ "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3 }],
        "bufferViews": [
            { "buffer": 0, "byteLength": 36 },
            { "buffer": 0, "byteOffset": 36, "byteLength": bin.len() - 36 },
        ],
        "buffers": [{ "byteLength": bin.len() }],
    });
    glb(&root, &bin)
}

/// Triangles with a gray texture each, of this size in px a side.
fn textures(count: usize, side: u32) -> Vec<u8> {
    let mut png = std::io::Cursor::new(Vec::new());
    let gray = image::GrayImage::from_pixel(side, side, image::Luma([128]));
    gray.write_to(&mut png, image::ImageFormat::Png).expect("an image in memory");
    let at = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0_f32].into_iter().flat_map(f32::to_le_bytes);
    let mut bin: Vec<u8> = at.collect();
    let mut views = vec![json!({ "buffer": 0, "byteLength": 36 })];
    for _ in 0..count {
        views.push(json!({ "buffer": 0, "byteOffset": bin.len(), "byteLength": png.get_ref().len() }));
        bin.extend(png.get_ref());
    }
    let each = |value: &dyn Fn(usize) -> Value| (0..count).map(value).collect::<Vec<_>>();
    let root = json!({
        "asset": { "version": "2.0" },
        "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": each(&|i| json!({ "attributes": { "POSITION": 0 }, "material": i })) }],
        "materials": each(&|i| json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": i } } })),
        "textures": each(&|i| json!({ "source": i })),
        "images": each(&|i| json!({ "bufferView": i + 1, "mimeType": "image/png" })),
        "accessors": [{ "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3 }],
        "bufferViews": views,
        "buffers": [{ "byteLength": bin.len() }],
    });
    glb(&root, &bin)
}

/// A chain of nodes, each the child of the one before.
fn chain(count: usize) -> Vec<u8> {
    let nodes: Vec<String> = (1..count).map(|i| format!(r#"{{"children":[{i}]}}"#)).collect();
    let start = r#"{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":["#;
    format!("{start}{},{{}}]}}", nodes.join(",")).into_bytes()
}

#[test]
fn loads_take_no_more_than_their_size_allows() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let vase = std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/vase.glb")).expect("the vase");
    assert!(measured("vase", vase).0.is_ok());
    // The data in a file fits without the additional memory.
    let large = grid(600, 1);
    let size = large.len() >> 20;
    let (result, took) = measured("large", large);
    assert!(result.is_ok() && took <= 4 * size + 8, "{took} MiB for {size}");
    // 720,000 triangles with the data of 2,000 vertices.
    let (result, took) = measured("repeated", grid(31, 400));
    assert!(result.is_ok_and(|loaded| loaded.mesh.triangles.len() == 720_000) && took > 20);
    // Thirty times as many are refused before anything is read.
    let (result, took) = measured("repeated-more", grid(61, 3000));
    assert!(result.is_err_and(|error| error.to_string().contains("of 21600000 triangles would take")) && took < 20);
    let (result, took) = measured("image", textured(5000));
    assert!(result.is_ok_and(|loaded| loaded.mesh.materials[0].texture.is_some()) && took > 150);
    // With its mip levels each would take 325 MiB on the graphics card. The first one is decoded row by row.
    let (result, took) = measured("larger-images", textures(2, 8000));
    let sizes = |loaded: LoadedMesh| -> Vec<_> {
        loaded.mesh.materials.iter().map(|material| material.texture.as_ref().map(|texture| texture.size)).collect()
    };
    assert!(result.is_ok_and(|loaded| sizes(loaded) == [Some([4000; 2]), Some([8000; 2])]) && took < 460, "{took} MiB");
    // A progressive image keeps twice as much for each pixel until its last scan, whatever the file's size.
    let (result, took) = measured("progressive-image", with_image(&heights::jpeg(9000, 0xc2)));
    assert!(result.is_ok_and(|loaded| loaded.mesh.materials[0].texture.is_none()) && took < 20);
    // What would unpack to a thousand times its size is refused before it does.
    let spaces = format!("{}{}", package::model("", ""), " ".repeat(200_000_000));
    let bomb = package::zip(&[package::Entry::deflated("bomb.model", spaces.as_bytes())]);
    drop(spaces);
    let (result, took) = taken("bomb.3mf", bomb);
    assert!(result.is_err_and(|error| error.to_string().contains("unpack to 200000")) && took < 4 << 20, "{took}");
    assert!(measured("nodes", chain(200_000)).0.is_err_and(|error| error.to_string().contains("no meshes")));
    let many = format!(r#"{{"asset":{{"version":"2.0"}},"extras":[{}0]}}"#, "0,".repeat(4_000_000));
    assert!(measured("numbers", many.into_bytes()).0.is_err());
    let many = format!(r#"{{"asset":{{"version":"2.0"}},"extras":[{}0]}}"#, r#"{"a":"b"},"#.repeat(250_000));
    assert!(measured("objects", many.into_bytes()).0.is_err());
}

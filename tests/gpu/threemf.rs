//! Textures of 3MF files look as those of glTF files, also after they were exported.

use std::io::Cursor;

use geometry::tessellate::{LodView, tessellate};
use image::{ImageFormat, RgbaImage};
use inspect::export::Exported;
use serde_json::json;

use crate::scenes::{EXPORT_STEPS, picture_of, read, settings};
use documents::package::{Entry, MODEL, model, relationships, zip};

/// A square that faces the camera, in the coordinates of glTF.
const CORNERS: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
const TRIANGLES: [[u16; 3]; 2] = [[0, 1, 2], [0, 2, 3]];
/// The image is shown one and a half times, and mirrored the other way. In glTF v counts from the top.
const UVS: [[f32; 2]; 4] = [[0.0, 1.25], [1.5, 1.25], [1.5, 0.0], [0.0, 0.0]];

/// An image without any symmetry.
fn png() -> Vec<u8> {
    let image = RgbaImage::from_fn(4, 2, |x, y| image::Rgba([60 * x as u8, 200 * y as u8, 90 + 40 * x as u8, 255]));
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, ImageFormat::Png).expect("an image in memory");
    bytes.into_inner()
}

fn threemf() -> Vec<u8> {
    // Z points up in 3MF files.
    let vertices = CORNERS.map(|[x, y, z]| format!("<vertex x=\"{x}\" y=\"{}\" z=\"{y}\"/>", -z)).concat();
    let triangle = |[a, b, c]: [u16; 3]| {
        format!("<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\" pid=\"3\" p1=\"{a}\" p2=\"{b}\" p3=\"{c}\"/>")
    };
    let uvs = UVS.map(|[u, v]| format!("<m:tex2coord u=\"{u}\" v=\"{}\"/>", 1.0 - v)).concat();
    let resources = format!(
        "<m:texture2d id=\"2\" path=\"/3D/Textures/a.png\" contenttype=\"image/png\" tilestyleu=\"wrap\" tilestylev=\"mirror\"/>\
         <m:texture2dgroup id=\"3\" texid=\"2\">{uvs}</m:texture2dgroup><object id=\"1\"><mesh><vertices>{vertices}</vertices>\
         <triangles>{}</triangles></mesh></object>",
        TRIANGLES.map(triangle).concat()
    );
    zip(&[
        Entry::stored("_rels/.rels", relationships().as_bytes()),
        Entry::deflated(MODEL, model(&resources, "<item objectid=\"1\"/>").as_bytes()),
        Entry::stored("3D/Textures/a.png", &png()),
    ])
}

/// The same as glTF, with its data in the file `data.bin`.
fn gltf() -> (String, Vec<u8>) {
    let normals = [[0.0, 0.0, 1.0_f32]; 4];
    let floats = CORNERS.as_flattened().iter().chain(UVS.as_flattened()).chain(normals.as_flattened());
    let floats = floats.flat_map(|x| x.to_le_bytes());
    let bytes: Vec<u8> = floats.chain(TRIANGLES.as_flattened().iter().flat_map(|i| i.to_le_bytes())).collect();
    let view = |start: usize, length: usize| json!({ "buffer": 0, "byteOffset": start, "byteLength": length });
    let root = json!({
        "asset": { "version": "2.0" },
        "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{
            "attributes": { "POSITION": 0, "TEXCOORD_0": 1, "NORMAL": 2 }, "indices": 3, "material": 0,
        }] }],
        "materials": [{ "pbrMetallicRoughness": {
            "baseColorTexture": { "index": 0 }, "metallicFactor": 0, "roughnessFactor": 0.5,
        } }],
        "textures": [{ "source": 0, "sampler": 0 }],
        "samplers": [{ "wrapS": 10497, "wrapT": 33648 }],
        "images": [{ "uri": "a.png" }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 4 },
            { "bufferView": 1, "componentType": 5126, "type": "VEC2", "count": 4 },
            { "bufferView": 2, "componentType": 5126, "type": "VEC3", "count": 4 },
            { "bufferView": 3, "componentType": 5123, "type": "SCALAR", "count": 6 },
        ],
        "bufferViews": [view(0, 48), view(48, 32), view(80, 48), view(128, 12)],
        "buffers": [{ "byteLength": bytes.len(), "uri": "data.bin" }],
    });
    (root.to_string(), bytes)
}

#[test]
fn a_textured_3mf_file_looks_as_the_same_gltf_file_and_stays_so_when_exported() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = |name: &str| folder.path().join(name);
    let (document, data) = gltf();
    let files = [("a.3mf", threemf()), ("a.gltf", document.into_bytes()), ("data.bin", data), ("a.png", png())];
    for (name, bytes) in files {
        std::fs::write(path(name), bytes).expect("a writable folder");
    }
    let [own, other] = ["a.3mf", "a.gltf"].map(|name| read(&path(name)));
    assert_eq!(own.mesh.materials[0].sampling.wrap, other.mesh.materials[0].sampling.wrap);
    let picture = picture_of(&own);
    let colors: std::collections::BTreeSet<_> = picture.pixels().map(|px| px.0).collect();
    assert!(colors.len() > 100, "the image is seen");
    assert!(picture == picture_of(&other), "a picture of the same mesh");
    let tessellated = tessellate(&own.mesh, &own.topology, &settings().inputs(LodView::default()), None);
    let warnings = Exported::new(&own.mesh, &own.topology, &tessellated).write(&path("b.glb"));
    assert_eq!(warnings.expect("a writable folder"), Vec::<String>::new());
    let exported = read(&path("b.glb"));
    assert!(exported.mesh.materials[0].texture.is_some(), "the texture is kept");
    let exported = picture_of(&exported);
    let most = picture.iter().zip(exported.iter()).map(|(a, b)| a.abs_diff(*b)).max();
    assert!(most <= Some(EXPORT_STEPS), "{most:?} steps");
}

//! Textures, and files next to the document.

use base64::prelude::{BASE64_STANDARD, Engine};

use super::*;
use crate::{LoadError, load};
use geometry::progress::Cancelled;

/// A triangle whose material has an image.
pub(super) fn textured(image: Value) -> Draft {
    let mut draft = triangle();
    let uvs = draft.floats("VEC2", &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
    let primitive = &mut draft.root["meshes"][0]["primitives"][0];
    primitive["attributes"]["TEXCOORD_1"] = json!(uvs);
    primitive["material"] = json!(0);
    let texture = json!({ "index": 0, "texCoord": 1 });
    draft.root["materials"] = json!([{ "name": "skin", "pbrMetallicRoughness": { "baseColorTexture": texture } }]);
    draft.root["textures"] = json!([{ "source": 0 }]);
    draft.root["images"] = json!([image]);
    draft
}

/// An image of two px, within a document.
pub(super) fn png_uri() -> String {
    format!("data:image/png;base64,{}", BASE64_STANDARD.encode(png()))
}

fn png() -> Vec<u8> {
    let pixels = image::RgbaImage::from_raw(2, 1, vec![255, 0, 0, 255, 0, 0, 255, 128]).unwrap();
    let mut bytes = std::io::Cursor::new(Vec::new());
    pixels.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

#[test]
fn textures_are_decoded_wherever_they_are() {
    let data = json!({ "uri": png_uri() });
    let mut in_view = textured(json!({ "mimeType": "image/png", "bufferView": 0 }));
    let view = in_view.view(&png());
    in_view.root["images"][0]["bufferView"] = json!(view);
    for draft in [textured(data), in_view] {
        let mesh = draft.read().unwrap();
        let texture = mesh.materials[0].texture.as_ref().unwrap();
        assert_eq!((texture.size, texture.rgba.as_slice()), ([2, 1], &[255, 0, 0, 255, 0, 0, 255, 128][..]));
        assert_eq!(mesh.corners[2].uv, Vec2::Y, "the set that the texture names");
        assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
    }
}

#[test]
fn missing_and_broken_textures_are_warnings() {
    let images = [
        (json!({ "uri": "missing%20one.png" }), "\"missing%20one.png\" can't be read: there is no such file; put it"),
        (json!({ "uri": "/elsewhere.png" }), "an absolute path"),
        (json!({ "uri": "data:image/png;base64,AAAA" }), "can't be decoded"),
        (json!({ "bufferView": 0 }), "can't be decoded"),
        (json!({}), "neither"),
    ];
    for (image, reason) in images {
        let mesh = textured(image).read().unwrap();
        assert!(mesh.materials[0].texture.is_none());
        assert_eq!(mesh.warnings.len(), 1);
        assert!(mesh.warnings[0].contains("\"skin\"") && mesh.warnings[0].contains(reason), "{}", mesh.warnings[0]);
    }
    let mut elsewhere = textured(json!({}));
    elsewhere.root["textures"] = json!([{ "extensions": { "MSFT_texture_dds": { "source": 0 } } }]);
    assert!(elsewhere.read().unwrap().warnings[0].contains("texture 0 has no PNG, JPEG, WebP or KTX2"));
}

#[test]
fn files_next_to_the_document_are_found() {
    let folder = tempfile::tempdir().unwrap();
    let draft = textured(json!({ "uri": "my%20skin.png" }));
    let mut document = draft.document();
    document["buffers"][0]["uri"] = json!("data.bin");
    let path = folder.path().join("model.GLTF");
    std::fs::write(&path, document.to_string()).unwrap();
    let progress = Progress::new();
    let error = load(&path, &Limits::default(), &progress).unwrap_err().to_string();
    assert!(error.contains("model.GLTF: /buffers/0 (data.bin) can't be read"), "{error}");
    std::fs::write(folder.path().join("data.bin"), &draft.bytes).unwrap();
    std::fs::write(folder.path().join("my skin.png"), png()).unwrap();
    let mesh = load(&path, &Limits::default(), &progress).unwrap();
    assert!(mesh.materials[0].texture.is_some());
    assert_eq!((mesh.name.as_str(), progress.fraction()), ("model", 1.0));
    std::fs::write(folder.path().join("data.bin"), &draft.bytes[1..]).unwrap();
    let error = load(&path, &Limits::default(), &progress).unwrap_err().to_string();
    assert!(error.contains("it should have 96 bytes but has 95"), "{error}");
    progress.cancel();
    assert!(matches!(load(&path, &Limits::default(), &progress), Err(LoadError::Cancelled(Cancelled))));
}

#[test]
fn files_that_are_named_have_the_same_limit() {
    let folder = tempfile::tempdir().unwrap();
    let draft = textured(json!({ "uri": "large.png" }));
    let mut document = draft.document();
    document["buffers"][0]["uri"] = json!("data.bin");
    let path = folder.path().join("model.gltf");
    let text = document.to_string();
    let [own, data] = [text.len() as u64, draft.bytes.len() as u64];
    std::fs::write(&path, text).unwrap();
    std::fs::write(folder.path().join("large.png"), [&png()[..], &vec![0; 100_000]].concat()).unwrap();
    std::fs::write(folder.path().join("data.bin"), [&draft.bytes[..], &vec![0; own as usize]].concat()).unwrap();
    let load = |file| load(&path, &Limits { file, ..Limits::default() }, &Progress::new());
    let said = load(own).unwrap_err().to_string();
    let expected = format!("data.bin has {} bytes, but at most {own} are read", own + data);
    assert!(said.contains("/buffers/0 (data.bin) can't be read") && said.contains(&expected), "{said}");
    let mesh = load(own + data).unwrap();
    let said = mesh.warnings.first().unwrap();
    assert!(mesh.materials[0].texture.is_none() && said.contains("large.png has 1000"), "{said}");
    assert!(load(200_000).unwrap().materials[0].texture.is_some());
}

#[cfg(unix)]
#[test]
fn links_within_the_folder_are_followed() {
    let folder = tempfile::tempdir().unwrap();
    let draft = triangle();
    let mut document = draft.document();
    document["buffers"][0]["uri"] = json!("link/data.bin");
    let path = folder.path().join("model.gltf");
    std::fs::write(&path, document.to_string()).unwrap();
    std::fs::create_dir_all(folder.path().join("there")).unwrap();
    std::fs::write(folder.path().join("there/data.bin"), &draft.bytes).unwrap();
    std::os::unix::fs::symlink("there", folder.path().join("link")).unwrap();
    assert_eq!(load(&path, &Limits::default(), &Progress::new()).unwrap().triangles.len(), 1);
}

/// A folder, links and a socket, which a corpus of files can't hold. Nothing outside the document's folder is read.
#[cfg(unix)]
#[test]
fn what_is_no_file_of_the_folder_is_no_buffer() {
    use std::os::unix::{fs::symlink, net::UnixListener};
    let around = tempfile::tempdir().unwrap();
    let folder = around.path().join("own");
    std::fs::create_dir_all(folder.join("folder.bin")).unwrap();
    std::fs::write(around.path().join("secret.bin"), [0; 72]).unwrap();
    for (to, name) in [("../secret.bin", "link.bin"), ("/dev/zero", "device.bin"), ("loop.bin", "loop.bin")] {
        symlink(to, folder.join(name)).unwrap();
    }
    let _socket = UnixListener::bind(folder.join("socket.bin"));
    let endless = std::fs::metadata(folder.join("loop.bin")).unwrap_err().to_string();
    let endless = format!("{endless}; put it where the document names it, or export as .glb");
    let no_file = "it is not a file; name one, or export as .glb";
    let outside = "it is a link to a file outside the document's folder, but only files in that folder and below are read; \
                   put the file itself there";
    for (uri, said) in [
        ("folder.bin", no_file),
        ("link.bin", outside),
        ("device.bin", outside),
        ("loop.bin", &endless),
        ("socket.bin", no_file),
    ] {
        let mut document = triangle().document();
        document["buffers"][0]["uri"] = json!(uri);
        let path = folder.join("model.gltf");
        std::fs::write(&path, document.to_string()).unwrap();
        let error = load(&path, &Limits::default(), &Progress::new()).unwrap_err();
        let LoadError::Gltf { problem, .. } = error else { panic!("{error:?}") };
        assert!(matches!(*problem, GltfError::Buffer { .. }), "{problem:?}");
        assert_eq!(problem.to_string(), format!("/buffers/0 ({uri}) can't be read: {said}"));
    }
}

#[test]
fn a_truncated_glb_is_refused_wherever_it_ends() {
    let glb = triangle().glb();
    for length in 0..glb.len() {
        let problem = read_bytes(&glb[..length]).unwrap_err();
        assert!(matches!(problem, GltfError::NotGltf { .. }), "{length}: {problem}");
    }
}

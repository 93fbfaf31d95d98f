//! Files that a document names, and data in its URIs.

use super::*;
use crate::load::gltf::schema::MESHOPT;
use crate::load::uri;
use base64::prelude::{BASE64_STANDARD, Engine};

/// A folder with a document's folder in it, and things around it that are none of a document's business.
pub struct Folder(PathBuf);

impl Folder {
    pub fn new() -> Self {
        let root = std::env::temp_dir().join(format!("pnaen-hostile-{}", std::process::id()));
        let folder = Self(root);
        std::fs::create_dir_all(folder.own().join("folder.bin")).expect("a writable temporary folder");
        std::fs::write(folder.0.join("secret.bin"), [0; 72]).expect("a writable temporary folder");
        #[cfg(unix)]
        for (to, name) in [("../secret.bin", "link.bin"), ("/dev/zero", "device.bin"), ("loop.bin", "loop.bin")] {
            let _ = std::os::unix::fs::symlink(to, folder.own().join(name));
        }
        #[cfg(unix)]
        let _ = std::os::unix::net::UnixListener::bind(folder.own().join("socket.bin"));
        folder
    }

    fn own(&self) -> PathBuf {
        self.0.join("own")
    }

    /// A buffer that can't be read, for a reason with places for the folder and for what the system says.
    fn refused(&self, name: &'static str, uri: &str, reason: &str) -> Case {
        let said = std::fs::metadata(self.own().join(uri)).err().map_or(String::new(), |error| error.to_string());
        let reason = reason.replace("{folder}", &self.own().display().to_string()).replace("{os}", &said);
        let sentence = format!("/buffers/0 ({}) can't be read: {reason}", uri::shown(uri));
        Case::refused(name, elsewhere(uri), &sentence)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// A triangle whose buffer is elsewhere.
fn elsewhere(uri: &str) -> Vec<u8> {
    let mut document = triangle().document();
    document["buffers"][0]["uri"] = json!(uri);
    document.to_string().into_bytes()
}

/// The start of a PNG file that says so of its size.
fn png(width: u32, height: u32) -> Vec<u8> {
    let chunk = |kind: &[u8], data: &[u8]| {
        let checked = [kind, data].concat();
        let crc = checked.iter().fold(u32::MAX, |crc, &byte| {
            (0..8).fold(crc ^ u32::from(byte), |crc, _| (crc >> 1) ^ (0xedb8_8320 * (crc & 1)))
        });
        [&(data.len() as u32).to_be_bytes()[..], &checked, &(!crc).to_be_bytes()].concat()
    };
    let header = [&width.to_be_bytes()[..], &height.to_be_bytes(), &[8, 6, 0, 0, 0]].concat();
    [&b"\x89PNG\r\n\x1a\n"[..], &chunk(b"IHDR", &header), &chunk(b"IDAT", &[0x78, 1])].concat()
}

/// A triangle with a texture from these bytes.
fn textured(image: &[u8]) -> String {
    let mut draft = triangle();
    draft.root["meshes"][0]["primitives"][0]["material"] = json!(0);
    draft.root["materials"] = json!([{ "name": "m", "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }]);
    draft.root["textures"] = json!([{ "source": 0 }]);
    draft.root["images"] = json!([{ "uri": format!("data:image/png;base64,{}", BASE64_STANDARD.encode(image)) }]);
    draft.document().to_string()
}

/// A triangle whose positions are said to be compressed.
fn compressed(name: &'static str, change: impl FnOnce(&mut Value), sentence: &str) -> Case {
    let mut draft = triangle();
    let mut extension = json!({
        "buffer": 0, "byteOffset": 36, "byteLength": 36, "byteStride": 12, "count": 3, "mode": "ATTRIBUTES",
    });
    change(&mut extension);
    draft.root["bufferViews"][0]["extensions"] = json!({ MESHOPT: extension });
    Case::draft(name, &draft, Gets::Refused(sentence.to_owned()))
}

pub fn cases(folder: &Folder) -> Vec<Case> {
    let mut cases = vec![
        compressed(
            "compressed data that isn't",
            |_| {},
            "/bufferViews/0/extensions/EXT_meshopt_compression can't be decompressed: 36 bytes aren't 3 elements in mode Attributes; export the model again",
        ),
        compressed(
            "compressed data past the end",
            |view| view["byteLength"] = json!(37),
            "/bufferViews/0/extensions/EXT_meshopt_compression takes 37 bytes from byte 36 of /buffers/0, which has 72; export the model again",
        ),
        compressed(
            "a count of 2^62, compressed",
            |view| view["count"] = json!(1_u64 << 62),
            "/bufferViews/0/extensions/EXT_meshopt_compression would take at least 17592186044416 MiB of memory, and files of this size may take 256 MiB (--max-memory allows more); export the model again",
        ),
        compressed(
            "as much as fits a byte count, compressed",
            |view| view["count"] = json!(1_u64 << 30),
            "/bufferViews/0/extensions/EXT_meshopt_compression would take at least 12289 MiB of memory, and files of this size may take 256 MiB (--max-memory allows more); export the model again",
        ),
        compressed(
            "a stride of 6, compressed",
            |view| view["byteStride"] = json!(6),
            "/bufferViews/0/extensions/EXT_meshopt_compression has a byteStride of 6, which mode Attributes doesn't have; export the model again",
        ),
        compressed(
            "a compression that there isn't",
            |view| view["mode"] = json!("POINTS"),
            "/bufferViews/0/extensions/EXT_meshopt_compression/mode should be ATTRIBUTES, TRIANGLES or INDICES and is \"POINTS\"; export the model again",
        ),
        compressed(
            "four corners a triangle",
            |view| {
                (view["mode"], view["byteStride"], view["count"]) = (json!("TRIANGLES"), json!(4), json!(4));
            },
            "/bufferViews/0/extensions/EXT_meshopt_compression has a count of 4, which is no multiple of 3; export the model again",
        ),
        compressed(
            "quaternions of 12 bytes",
            |view| view["filter"] = json!("QUATERNION"),
            "/bufferViews/0/extensions/EXT_meshopt_compression has the filter Quaternion, which mode Attributes with a byteStride of 12 doesn't have; export the model again",
        ),
        Case::new(
            "an image of 20,000 px",
            textured(&png(20_000, 20_000)),
            Gets::Repaired(
                "the texture of material \"m\" is left out: its image is 20000 x 20000 px large, and 16384 px a side are read; scale it to 4096 px a side or less.",
            ),
        ),
        Case::new(
            "an image of 1 GiB in 60 bytes",
            textured(&png(16_384, 16_384)),
            Gets::Repaired(
                "the texture of material \"m\" is left out: its image of 16384 x 16384 px would take at least 1041 MiB of memory, and files of this size may take 256 MiB (--max-memory allows more); scale it down.",
            ),
        ),
        Case::new(
            "an image of no px",
            textured(&png(0, 1)),
            Gets::Repaired(
                "the texture of material \"m\" is left out: its image can't be decoded: Format error decoding Png: Invalid image dimensions.",
            ),
        ),
        Case::new(
            "an image that is cut off",
            textured(&png(1, 1)),
            Gets::Repaired(
                "the texture of material \"m\" is left out: its image can't be decoded: unexpected end of file.",
            ),
        ),
    ];
    let uris = [
        (
            "a buffer that isn't there",
            "missing.bin",
            "{folder}/missing.bin: it is not there; put the file where the document says, or export as .glb",
        ),
        (
            "a buffer above",
            "../secret.bin",
            "it leads out of a folder, with ..; only files in the document's folder and below are read",
        ),
        (
            "a buffer above, in code",
            "%2e%2E%2fsecret.bin",
            "it leads out of a folder, with ..; only files in the document's folder and below are read",
        ),
        (
            "a buffer anywhere",
            "/dev/zero",
            "it is an absolute path; only files in the document's folder and below are read",
        ),
        (
            "a buffer by scheme",
            "file:///dev/zero",
            "it names another place, with file:; only files in the document's folder and below are read",
        ),
        (
            "a buffer elsewhere",
            "http://example.org/a.bin",
            "it names another place, with http:; only files in the document's folder and below are read",
        ),
        (
            "a buffer on a drive",
            "C:%5Ca.bin",
            "it names another place, with C:; only files in the document's folder and below are read",
        ),
        (
            "a buffer behind a backslash",
            "..%5Csecret.bin",
            "it has a backslash, where a URI has /; only files in the document's folder and below are read",
        ),
        ("a buffer not in UTF-8", "a%ff.bin", "its name is not UTF-8 once its % signs are decoded; rename the file"),
        (
            "a buffer with no end to its name",
            "a%00.bin",
            "it has a control character; only files in the document's folder and below are read",
        ),
        ("a buffer that is a folder", "folder.bin", "{folder}/folder.bin is not a file; name one, or export as .glb"),
        (
            "data that isn't base64",
            "data:application/octet-stream;base64,AA*A",
            "the data URI has a character that isn't base64, '*'; export the model again",
        ),
        (
            "data without a comma",
            "data:application/octet-stream;base64",
            "the data URI has no comma; export the model again",
        ),
        (
            "data that is too short",
            "data:application/octet-stream;base64,AAAA",
            "it should have 72 bytes and has 3; export the model again",
        ),
        ("no name", "", "its name is empty; export the model again"),
    ];
    cases.extend(uris.map(|(name, uri, reason)| folder.refused(name, uri, reason)));
    #[cfg(unix)]
    cases.extend(
        [
            ("a link out of the folder", "link.bin", "{folder}/link.bin is a link out of the document's folder, and only files below that are read; put the file itself there"),
            ("a link to a device", "device.bin", "{folder}/device.bin is a link out of the document's folder, and only files below that are read; put the file itself there"),
            ("a link to itself", "loop.bin", "{folder}/loop.bin: {os}; put the file where the document says, or export as .glb"),
            ("a socket", "socket.bin", "{folder}/socket.bin is not a file; name one, or export as .glb"),
        ]
        .map(|(name, uri, reason)| folder.refused(name, uri, reason)),
    );
    cases.into_iter().map(|case| Case { folder: folder.own(), ..case }).collect()
}

//! Files that a document names, and data in its URIs.

use super::*;
use crate::gltf::schema::MESHOPT;
use crate::ktx2::tests::{ETC1S, plain, with};
use crate::uri;
use base64::prelude::{BASE64_STANDARD, Engine};
use tempfile::TempDir;

use documents::webp::of_groups;

/// A folder that contains a document's folder, and files around it that the document mustn't read.
pub(crate) struct Folder(TempDir);

impl Folder {
    pub(super) fn new() -> Self {
        let folder = Self(tempfile::tempdir().expect("a writable temporary folder"));
        std::fs::create_dir_all(folder.own().join("folder.bin")).expect("a writable temporary folder");
        std::fs::write(folder.0.path().join("secret.bin"), [0; 72]).expect("a writable temporary folder");
        #[cfg(unix)]
        for (to, name) in [("../secret.bin", "link.bin"), ("/dev/zero", "device.bin"), ("loop.bin", "loop.bin")] {
            let _ = std::os::unix::fs::symlink(to, folder.own().join(name));
        }
        #[cfg(unix)]
        let _ = std::os::unix::net::UnixListener::bind(folder.own().join("socket.bin"));
        folder
    }

    fn own(&self) -> PathBuf {
        self.0.path().join("own")
    }

    /// A buffer that can't be read. The parts of its message may contain `{os}` for the system's own message.
    fn refused(&self, name: &'static str, uri: &str, parts: &str) -> Case {
        let said = std::fs::metadata(self.own().join(uri)).err().map_or(String::new(), |error| error.to_string());
        let parts = parts.replace("{os}", &said);
        let expected = format!("Buffer | /buffers/0 | {} | {parts}", uri::shown(uri));
        Case::refused(name, elsewhere(uri), &expected)
    }
}

/// A triangle with its buffer at a URI.
fn elsewhere(uri: &str) -> Vec<u8> {
    let mut document = triangle().document();
    document["buffers"][0]["uri"] = json!(uri);
    document.to_string().into_bytes()
}

/// The start of a PNG file with this size in its header.
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

/// A triangle whose positions are marked as compressed.
fn compressed(name: &'static str, change: impl FnOnce(&mut Value), gets: Gets) -> Case {
    let mut draft = triangle();
    let mut extension = json!({
        "buffer": 0, "byteOffset": 36, "byteLength": 36, "byteStride": 12, "count": 3, "mode": "ATTRIBUTES",
    });
    change(&mut extension);
    draft.root["bufferViews"][0]["extensions"] = json!({ MESHOPT: extension });
    Case::draft(name, &draft, gets)
}

/// Compressed data that overlaps the view's own, so that there is no copy.
fn compressed_alone(name: &'static str, change: impl FnOnce(&mut Value), expected: &str) -> Case {
    let moved = |view: &mut Value| {
        view["byteOffset"] = json!(35);
        change(view);
    };
    compressed(name, moved, Gets::Refused(expected.to_owned()))
}

/// WebP and KTX2 images, and parts of the warning that each gets.
fn images() -> [(&'static str, Vec<u8>, &'static str); 17] {
    let webp = textures::webp();
    let lossy = |width: u16, height: u16| {
        let size = [width, height].map(u16::to_le_bytes);
        [&b"VP8 \x0a\0\0\0\0\0\0\x9d\x01\x2a"[..], size.as_flattened()].concat()
    };
    let riff = |chunks: &[u8]| [&b"RIFF\xff\0\0\0WEBP"[..], chunks].concat();
    let canvas = |flags: u8| [b"VP8X\x0a\0\0\0", &[flags, 0, 0, 0, 0, 0, 0, 0, 0, 0][..]].concat();
    let mut bomb = plain(37, [16_384, 16_384], &[0; 40]);
    bomb[44] = 2;
    bomb[96..104].copy_from_slice(&(1_u64 << 30).to_le_bytes());
    let mut lie = plain(37, [1, 1], &[0; 40]);
    lie[44] = 2;
    lie[96] = 4;
    [
        ("a WebP image that is cut off", webp[..webp.len() / 2].to_vec(), "texture | \"m\" | decoded"),
        ("a WebP image of no px", riff(&lossy(0, 0)), "texture | \"m\" | decoded"),
        ("a WebP image of 16,383 px without data", riff(&lossy(16_383, 16_383)), "texture | \"m\" | 16383 | 512"),
        ("a WebP image within a smaller one", riff(&[canvas(0), lossy(9_999, 9_999)].concat()), "1 x 1 | 9999 x 9999"),
        ("a WebP image with 586 MiB of prefix codes in 1.6", of_groups(28_000), "texture | \"m\" | prefix codes | 520"),
        ("a WebP image of prefix codes that are cut off", of_groups(99)[..4000].to_vec(), "texture | \"m\" | decoded"),
        ("a WebP animation", riff(&canvas(2)), "texture | \"m\" | animation"),
        ("a KTX2 header that is cut off", plain(37, [1, 1], &[0; 4])[..60].to_vec(), "KTX2 header | 68 | 60"),
        ("a KTX2 image of no px", plain(37, [0, 9], &[]), "0 x 9 px"),
        ("a KTX2 image of 20,000 px", with(&bomb, 20, 20_000), "level 0 | 1310720000"),
        ("a KTX2 image of 1 GiB in 144 bytes", bomb, "16384 x 16384 | 512"),
        ("a KTX2 level past the end", with(&plain(37, [1, 1], &[0; 4]), 80, 4_000_000), "4000004 | 108"),
        ("a KTX2 level that is too short", plain(37, [2, 2], &[0; 4]), "4 bytes | 16"),
        ("a KTX2 file of 2^32 - 1 levels", with(ETC1S, 40, u32::MAX), "4294967295 levels"),
        ("a supercompression that there isn't", with(ETC1S, 44, 9), "supercompression 9"),
        ("Zstandard data that isn't", lie, "Zstandard"),
        ("codebooks of zeros", [&ETC1S[..184], &[0; 144]].concat(), "ETC1S data is broken"),
    ]
}

pub(super) fn cases(folder: &Folder) -> Vec<Case> {
    let mut cases = vec![
        compressed(
            "compressed data that isn't",
            |_| {},
            Gets::Repaired("/bufferViews/0/extensions/EXT_meshopt_compression | 36 | 3 | copy"),
        ),
        compressed(
            "compressed data past the end",
            |view| view["byteLength"] = json!(37),
            Gets::Repaired("/bufferViews/0/extensions/EXT_meshopt_compression | 37 | 36 | /buffers/0 | 72 | copy"),
        ),
        compressed(
            "a count of 2^62, compressed",
            |view| view["count"] = json!(1_u64 << 62),
            Gets::Repaired("/bufferViews/0/extensions/EXT_meshopt_compression | 17592186044416 | 512 | copy"),
        ),
        compressed(
            "as much as fits a byte count, compressed",
            |view| view["count"] = json!(1_u64 << 30),
            Gets::Repaired("/bufferViews/0/extensions/EXT_meshopt_compression | 12289 | 512 | copy"),
        ),
        compressed(
            "a stride of 6, compressed",
            |view| view["byteStride"] = json!(6),
            Gets::Repaired("/bufferViews/0/extensions/EXT_meshopt_compression | byteStride | 6 | Attributes | copy"),
        ),
        compressed(
            "a compression that there isn't",
            |view| view["mode"] = json!("POINTS"),
            Gets::Refused("Document | /bufferViews/0/extensions/EXT_meshopt_compression/mode | ATTRIBUTES | TRIANGLES | INDICES | \"POINTS\"".to_owned()),
        ),
        compressed(
            "four corners a triangle",
            |view| {
                (view["mode"], view["byteStride"], view["count"]) = (json!("TRIANGLES"), json!(4), json!(4));
            },
            Gets::Repaired("/bufferViews/0/extensions/EXT_meshopt_compression | count | 4 | 3 | copy"),
        ),
        compressed(
            "quaternions of 12 bytes",
            |view| view["filter"] = json!("QUATERNION"),
            Gets::Repaired("/bufferViews/0/extensions/EXT_meshopt_compression | Quaternion | 12 | copy"),
        ),
        compressed_alone(
            "compressed data that isn't, without a copy",
            |_| {},
            "Document | /bufferViews/0/extensions/EXT_meshopt_compression | 36 | 3",
        ),
        compressed_alone(
            "a count of 2^62, compressed without a copy",
            |view| view["count"] = json!(1_u64 << 62),
            "Document | /bufferViews/0/extensions/EXT_meshopt_compression | 17592186044416 | 512",
        ),
        Case::new(
            "an image of 20,000 px",
            textured(&png(20_000, 20_000)),
            Gets::Repaired("texture | \"m\" | 20000 | 16384"),
        ),
        Case::new(
            "an image of 1 GiB in 60 bytes",
            textured(&png(16_384, 16_384)),
            Gets::Repaired("texture | \"m\" | unexpected end"),
        ),
        Case::new("an image of no px", textured(&png(0, 1)), Gets::Repaired("texture | \"m\" | dimensions")),
        Case::new("an image that is cut off", textured(&png(1, 1)), Gets::Repaired("texture | \"m\" | unexpected end")),
    ];
    cases.extend(images().map(|(name, image, expected)| Case::new(name, textured(&image), Gets::Repaired(expected))));
    let uris = [
        ("a buffer that isn't there", "missing.bin", "missing.bin | no such file"),
        ("a buffer above", "../secret.bin", "leads out | .."),
        ("a buffer above, in code", "%2e%2E%2fsecret.bin", "leads out | .."),
        ("a buffer anywhere", "/dev/zero", "absolute path"),
        ("a buffer by scheme", "file:///dev/zero", "another place | file:"),
        ("a buffer elsewhere", "http://example.org/a.bin", "another place | http:"),
        ("a buffer on a drive", "C:%5Ca.bin", "another place | C:"),
        ("a buffer behind a backslash", "..%5Csecret.bin", "backslash"),
        ("a buffer not in UTF-8", "a%ff.bin", "UTF-8"),
        ("a buffer with no end to its name", "a%00.bin", "control character"),
        ("a buffer that is a folder", "folder.bin", "folder.bin | not a file"),
        ("data that isn't base64", "data:application/octet-stream;base64,AA*A", "isn't base64 | '*'"),
        ("data without a comma", "data:application/octet-stream;base64", "comma"),
        ("data that is too short", "data:application/octet-stream;base64,AAAA", "72 | 3"),
        ("no name", "", "empty"),
    ];
    cases.extend(uris.map(|(name, uri, reason)| folder.refused(name, uri, reason)));
    #[cfg(unix)]
    cases.extend(
        [
            ("a link out of the folder", "link.bin", "link.bin | link | outside"),
            ("a link to a device", "device.bin", "device.bin | link | outside"),
            ("a link to itself", "loop.bin", "loop.bin | {os}"),
            ("a socket", "socket.bin", "socket.bin | not a file"),
        ]
        .map(|(name, uri, reason)| folder.refused(name, uri, reason)),
    );
    cases.into_iter().map(|case| Case { folder: folder.own(), ..case }).collect()
}

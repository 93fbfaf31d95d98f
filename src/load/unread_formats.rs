//! Formats of 3D models that aren't read: how their files are told, and what makes a file from one that is.

use memchr::memmem::find;

/// A format that isn't read.
pub(super) struct UnreadFormat {
    /// What a file of this format is, with its article.
    pub is: &'static str,
    /// The extensions of its files, in lower case.
    extensions: &'static [&'static str],
    /// Whether a file of this format begins with these bytes. The second number is the size of the whole file, in bytes.
    begins: fn(&[u8], u64) -> bool,
    /// What can be done, as the end of a sentence.
    pub advice: &'static str,
}

/// Returns the format whose files begin so. `length` is the size of the whole file, in bytes.
pub(super) fn of_content(start: &[u8], length: u64) -> Option<&'static UnreadFormat> {
    UNREAD.iter().find(|format| (format.begins)(start, length))
}

/// Returns the format whose files have this extension, in lower case.
pub(super) fn of_extension(extension: &str) -> Option<&'static UnreadFormat> {
    UNREAD.iter().find(|format| format.extensions.contains(&extension))
}

/// Returns the format of a compressed file by the extension, since what is compressed can't be seen.
pub(super) fn of_compressed(start: &[u8], extension: &str) -> Option<&'static UnreadFormat> {
    of_extension(extension).filter(|_| PACKED.iter().any(|magic| start.starts_with(magic)))
}

/// How files begin that are compressed with gzip and Zstandard, and archives of 7-Zip and RAR.
const PACKED: [&[u8]; 4] = [b"\x1f\x8b", b"\x28\xb5\x2f\xfd", b"7z\xbc\xaf\x27\x1c", b"Rar!\x1a\x07"];

/// The commands are those of the converters' own documentation.
const UNREAD: [UnreadFormat; 8] = [
    UnreadFormat {
        is: "a USD file",
        extensions: &["usd", "usda", "usdc", "usdz"],
        begins: |start, _| start.starts_with(b"#usda ") || start.starts_with(b"PXR-USDC") || is_usdz(start),
        advice: "convert it with `usd2gltf -i FILE.usd -o FILE.glb`, or export glTF",
    },
    UnreadFormat {
        is: "a Blender file",
        extensions: &["blend"],
        begins: |start, _| start.starts_with(b"BLENDER"),
        advice: "export it with `blender --background FILE.blend --python-expr \"import bpy; \
                 bpy.ops.export_scene.gltf(filepath='FILE.glb')\"`",
    },
    UnreadFormat {
        is: "a Collada file",
        extensions: &["dae"],
        begins: |start, _| start.trim_ascii_start().starts_with(b"<") && find(start, b"<COLLADA").is_some(),
        advice: "convert it with `assimp export FILE.dae FILE.glb -fglb2`",
    },
    UnreadFormat {
        is: "an Alembic file",
        extensions: &["abc"],
        begins: |start, _| start.starts_with(b"Ogawa"),
        advice: "convert it with `blender --background --python-expr \"import bpy; \
                 bpy.ops.wm.read_factory_settings(use_empty=True); bpy.ops.wm.alembic_import(filepath='FILE.abc'); \
                 bpy.ops.export_scene.gltf(filepath='FILE.glb')\"`",
    },
    UnreadFormat {
        is: "a file of 3D Studio",
        extensions: &["3ds"],
        // The first chunk is the whole file.
        begins: |start, length| {
            let chunk = start.get(2..6).and_then(|chunk| chunk.try_into().ok()).map(u32::from_le_bytes);
            start.starts_with(b"\x4d\x4d") && chunk.is_some_and(|chunk| u64::from(chunk) == length)
        },
        advice: "convert it with `assimp export FILE.3ds FILE.glb -fglb2`",
    },
    UnreadFormat {
        is: "a scene of Maya",
        extensions: &["ma", "mb"],
        begins: |start, _| {
            let is_binary = start.starts_with(b"FOR4") || start.starts_with(b"FOR8");
            start.starts_with(b"//Maya ASCII") || is_binary && find(&start[..start.len().min(32)], b"Maya").is_some()
        },
        advice: "export it as FBX from Maya",
    },
    UnreadFormat {
        is: "a STEP file, which holds curved surfaces instead of a mesh",
        extensions: &["step", "stp", "p21"],
        begins: |start, _| start.starts_with(b"ISO-10303-21;"),
        advice: "make triangles of it with `gmsh FILE.step -2 -o FILE.stl`",
    },
    UnreadFormat {
        is: "a packed file (gzip, Zstandard, 7-Zip or RAR)",
        extensions: &["7z", "gz", "rar", "zst"],
        begins: |start, _| PACKED.iter().any(|magic| start.starts_with(magic)),
        advice: "unpack it and open the model that it held",
    },
];

/// Whether a zip archive's first file is one of USD, as the format asks for.
fn is_usdz(start: &[u8]) -> bool {
    let length = start.get(26..28).and_then(|length| length.try_into().ok()).map_or(0, u16::from_le_bytes);
    let name = start.get(30..30 + usize::from(length)).unwrap_or_default().to_ascii_lowercase();
    start.starts_with(b"PK\x03\x04") && [&b".usd"[..], b".usda", b".usdc"].iter().any(|end| name.ends_with(end))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extensions_are_in_lower_case_and_belong_to_one_format() {
        let mut all: Vec<_> = UNREAD.iter().flat_map(|format| format.extensions).collect();
        let count = all.len();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), count);
        assert!(all.iter().all(|extension| extension.to_lowercase() == **extension));
        assert!(crate::format::extensions().into_iter().all(|extension| of_extension(extension).is_none()));
    }

    #[test]
    fn advice_names_a_command_or_a_program() {
        for format in &UNREAD {
            assert_eq!(format.advice.matches('`').count() % 2, 0, "{}", format.is);
            assert!(["convert", "export", "make", "unpack"].iter().any(|verb| format.advice.starts_with(verb)));
        }
    }

    #[test]
    fn files_are_told_by_how_they_begin() {
        let is = |start: &[u8], length: u64| of_content(start, length).map(|format| format.is);
        let mut zip = b"PK\x03\x04".to_vec();
        zip.resize(26, 0);
        zip.extend([7, 0, 0, 0]);
        zip.extend(b"a.usdc!");
        assert_eq!(is(&zip, 100), None);
        zip[26] = 6;
        assert_eq!(is(&zip, 100), Some("a USD file"));
        let studio = [&b"\x4d\x4d"[..], &1000_u32.to_le_bytes(), &[2, 0]].concat();
        assert_eq!([is(&studio, 1000), is(&studio, 999)], [Some("a file of 3D Studio"), None]);
        let xml = b"<?xml version=\"1.0\"?>\n<COLLADA version=\"1.4.1\">";
        assert_eq!(is(xml, 40), Some("a Collada file"));
        assert_eq!(is(b"FOR4\0\0\0\x10Maya", 40), Some("a scene of Maya"));
        assert_eq!(is(b"FORM\0\0\0\x10AIFF", 40), None);
    }

    #[test]
    fn a_compressed_file_has_the_format_of_its_name() {
        let is = |start: &[u8], extension: &str| of_compressed(start, extension).map(|format| format.is);
        assert_eq!(is(b"\x28\xb5\x2f\xfd\0", "blend"), Some("a Blender file"));
        assert_eq!(is(b"\x1f\x8b\x08\0", "blend"), Some("a Blender file"));
        assert_eq!(is(b"\x1f\x8b\x08\0", "gz"), Some("a packed file (gzip, Zstandard, 7-Zip or RAR)"));
        assert_eq!([is(b"\x1f\x8b\x08\0", "bin"), is(b"BLENDER", "blend")], [None, None]);
    }
}

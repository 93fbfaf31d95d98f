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
    let is_compressed = start.starts_with(GZIP) || start.starts_with(ZSTANDARD);
    of_extension(extension).filter(|_| is_compressed)
}

const GZIP: &[u8] = b"\x1f\x8b";
const ZSTANDARD: &[u8] = b"\x28\xb5\x2f\xfd";

/// The commands are those of the converters' own documentation.
const UNREAD: [UnreadFormat; 22] = [
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
        begins: |start, _| is_xml(start) && find(start, b"<COLLADA").is_some(),
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
        is: "a scene of 3ds Max",
        extensions: &["max"],
        // A compound file, as old documents of offices are too.
        begins: |_, _| false,
        advice: "export it as FBX or glTF from 3ds Max",
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
        is: "a scene of Cinema 4D",
        extensions: &["c4d"],
        begins: |start, _| start.starts_with(b"QC4DC4D6"),
        advice: "export it as FBX or glTF from Cinema 4D",
    },
    UnreadFormat {
        is: "a LightWave file",
        extensions: &["lwo"],
        begins: |start, _| start.starts_with(b"FORM") && matches!(start.get(8..12), Some(b"LWO2" | b"LWO3" | b"LWOB")),
        advice: "convert it with `assimp export FILE.lwo FILE.glb -fglb2`",
    },
    UnreadFormat {
        is: "a STEP file, which holds curved surfaces instead of a mesh",
        extensions: &["step", "stp", "p21"],
        begins: |start, _| start.starts_with(b"ISO-10303-21;"),
        advice: "make triangles of it with `gmsh FILE.step -2 -o FILE.stl`",
    },
    UnreadFormat {
        is: "an IGES file, which holds curved surfaces instead of a mesh",
        extensions: &["iges", "igs"],
        // Lines have 80 columns; the last 8 hold the section, which is S at the start, and the line's number.
        begins: |start, _| matches!(start.get(72..80), Some(b"S      1" | b"S0000001")),
        advice: "make triangles of it with `gmsh FILE.iges -2 -o FILE.stl`",
    },
    UnreadFormat {
        is: "a Rhino file, which holds curved surfaces instead of a mesh",
        extensions: &["3dm"],
        begins: |start, _| start.starts_with(b"3D Geometry File Format"),
        advice: "export its mesh as OBJ or glTF from Rhino",
    },
    UnreadFormat {
        is: "a SketchUp file",
        extensions: &["skp"],
        begins: |start, _| start.starts_with(b"\xff\xfe\xff\x0eS\0k\0e\0t\0c\0h\0U\0p\0"),
        advice: "export it as glTF, OBJ or STL from SketchUp",
    },
    UnreadFormat {
        is: "a VRML file",
        extensions: &["wrl", "vrml"],
        begins: |start, _| start.starts_with(b"#VRML V"),
        advice: "convert it with `assimp export FILE.wrl FILE.glb -fglb2`",
    },
    UnreadFormat {
        is: "an X3D file",
        extensions: &["x3d", "x3db", "x3dv"],
        begins: |start, _| start.starts_with(b"#X3D V") || is_xml(start) && find(start, b"<X3D").is_some(),
        advice: "convert it with `assimp export FILE.x3d FILE.glb -fglb2`",
    },
    UnreadFormat {
        is: "an HDF5 file, as older Alembic files are",
        extensions: &["h5", "hdf5"],
        begins: |start, _| start.starts_with(b"\x89HDF\r\n\x1a\n"),
        advice: "export the model as glTF from the program that wrote it",
    },
    UnreadFormat {
        is: "a library of materials for OBJ files",
        extensions: &["mtl"],
        begins: |_, _| false,
        advice: "open the .obj file that names it",
    },
    UnreadFormat {
        is: "compressed with gzip",
        extensions: &["gz"],
        begins: |start, _| start.starts_with(GZIP),
        advice: "unpack it with `gunzip FILE.gz` and open what it held",
    },
    UnreadFormat {
        is: "compressed with Zstandard",
        extensions: &["zst"],
        begins: |start, _| start.starts_with(ZSTANDARD),
        advice: "unpack it with `unzstd FILE.zst` and open what it held",
    },
    UnreadFormat {
        is: "an archive",
        extensions: &["7z", "rar"],
        begins: |start, _| start.starts_with(b"7z\xbc\xaf\x27\x1c") || start.starts_with(b"Rar!\x1a\x07"),
        advice: "unpack it and open the model that it held",
    },
    UnreadFormat {
        is: "a pointer of Git LFS in place of the model",
        extensions: &[],
        begins: |start, _| start.starts_with(b"version https://git-lfs.github.com/spec/"),
        advice: "fetch the model with `git lfs pull`, or check out with LFS",
    },
    UnreadFormat {
        is: "a page in HTML, as a failed download leaves it",
        extensions: &["html", "htm"],
        begins: |start, _| {
            let start = start.trim_ascii_start();
            let begins = |with: &[u8]| start.get(..with.len()).is_some_and(|own| own.eq_ignore_ascii_case(with));
            begins(b"<!doctype html") || begins(b"<html")
        },
        advice: "fetch the model itself",
    },
];

fn is_xml(start: &[u8]) -> bool {
    start.trim_ascii_start().starts_with(b"<")
}

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
        let read = crate::format::EXTENSIONS;
        assert!(read.iter().all(|(extension, _)| of_extension(extension).is_none()));
    }

    #[test]
    fn advice_names_a_command_or_a_program() {
        for format in &UNREAD {
            assert_eq!(format.advice.matches('`').count() % 2, 0, "{}", format.is);
            assert!(
                ["convert", "export", "make", "unpack", "open", "fetch"]
                    .iter()
                    .any(|verb| format.advice.starts_with(verb))
            );
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
        let iges = format!("{:<72}S      1\n", "a part");
        assert!(is(iges.as_bytes(), 81).is_some_and(|is| is.starts_with("an IGES file")));
        let xml = b"<?xml version=\"1.0\"?>\n<COLLADA version=\"1.4.1\">";
        assert_eq!(is(xml, 40), Some("a Collada file"));
        assert_eq!(is(b"FOR4\0\0\0\x10Maya", 40), Some("a scene of Maya"));
        assert_eq!(is(b"FORM\0\0\0\x10LWO2", 40), Some("a LightWave file"));
        assert_eq!(is(b"FORM\0\0\0\x10AIFF", 40), None);
        let pointer = b"version https://git-lfs.github.com/spec/v1\noid sha256:4d7a2146\nsize 12345\n";
        assert_eq!(is(pointer, 130), Some("a pointer of Git LFS in place of the model"));
        let page = "a page in HTML, as a failed download leaves it";
        assert_eq!([is(b"\n<!DOCTYPE html><html>", 40), is(b"<HTML><body>", 40)], [Some(page); 2]);
    }

    #[test]
    fn a_compressed_file_has_the_format_of_its_name() {
        let is = |start: &[u8], extension: &str| of_compressed(start, extension).map(|format| format.is);
        assert_eq!(is(b"\x28\xb5\x2f\xfd\0", "blend"), Some("a Blender file"));
        assert_eq!(is(b"\x1f\x8b\x08\0", "blend"), Some("a Blender file"));
        assert_eq!(is(b"\x1f\x8b\x08\0", "gz"), Some("compressed with gzip"));
        assert_eq!([is(b"\x1f\x8b\x08\0", "bin"), is(b"BLENDER", "blend")], [None, None]);
    }
}

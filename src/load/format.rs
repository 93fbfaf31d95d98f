//! The formats of mesh files that are read, and the endings of their names.

use std::path::Path;

use geometry::choice::choices;

/// The extensions of files that can be read, in lower case, each with its format.
pub const EXTENSIONS: [(&str, Format); 9] = [
    ("gltf", Format::Gltf),
    ("glb", Format::Gltf),
    ("vrm", Format::Gltf),
    ("fbx", Format::Fbx),
    ("obj", Format::Obj),
    ("stl", Format::Stl),
    ("ply", Format::Ply),
    ("off", Format::Off),
    ("3mf", Format::ThreeMf),
];

/// The extensions of files that can be read, for messages: ".gltf, .glb, .vrm, .fbx, .obj, .stl, .ply, .off or .3mf".
pub fn known_extensions() -> String {
    let [others @ .., last] = EXTENSIONS.map(|(extension, _)| format!(".{extension}"));
    format!("{} or {last}", others.join(", "))
}

/// The extension of a file's name, in lower case.
pub(super) fn extension_of(path: &Path) -> Option<String> {
    path.extension().map(|extension| extension.to_string_lossy().to_lowercase())
}

choices! {
    /// The format that a file is read as.
    pub enum Format {
        Gltf => "gltf", "glTF", "`.gltf`, `.glb` or `.vrm`; the first bytes tell whether it is text or binary.";
        Fbx => "fbx", "FBX", "Text or binary; the first bytes tell which.";
        Obj => "obj", "OBJ", "Wavefront's format.";
        Stl => "stl", "STL", "Text or binary; the size tells which.";
        Ply => "ply", "PLY", "The Polygon File Format.";
        Off => "off", "OFF", "Geomview's Object File Format.";
        ThreeMf => "3mf", "3MF", "The 3D Manufacturing Format.";
    }
}

impl Format {
    /// Returns the format that a file's name says, by its extension.
    pub fn from_name(path: &Path) -> Option<Self> {
        let extension = extension_of(path)?;
        EXTENSIONS.into_iter().find(|(known, _)| extension == *known).map(|(_, format)| format)
    }
}

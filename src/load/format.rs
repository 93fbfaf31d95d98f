//! The formats of mesh files that are read, and the endings of their names.

use std::path::Path;

use geometry::choice::choices;
use geometry::names::joined;

/// The extensions of files that can be read, in lower case.
pub fn extensions() -> Vec<&'static str> {
    Format::ALL.iter().flat_map(|format| format.extensions()).copied().collect()
}

/// The extensions of files that can be read, for messages: ".gltf, .glb, .vrm, .fbx, .obj, .stl, .ply, .off or .3mf".
pub fn known_extensions() -> String {
    let all: Vec<_> = extensions().iter().map(|extension| format!(".{extension}")).collect();
    joined(&all, "or")
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
    /// The extensions of its files, in lower case.
    pub const fn extensions(self) -> &'static [&'static str] {
        match self {
            Self::Gltf => &["gltf", "glb", "vrm"],
            Self::Fbx => &["fbx"],
            Self::Obj => &["obj"],
            Self::Stl => &["stl"],
            Self::Ply => &["ply"],
            Self::Off => &["off"],
            Self::ThreeMf => &["3mf"],
        }
    }

    /// Returns the format that a file's name says, by its extension.
    pub fn from_name(path: &Path) -> Option<Self> {
        let extension = extension_of(path)?;
        Self::ALL.into_iter().find(|format| format.extensions().contains(&&*extension))
    }
}

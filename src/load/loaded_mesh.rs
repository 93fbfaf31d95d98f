//! The result of loading a mesh file.

use std::path::PathBuf;

use serde::Serialize;

use super::parts::Part;
use super::selection::MorphWeights;
use geometry::mesh::Mesh;

/// A mesh as its file describes it.
#[derive(Clone, Debug, Default)]
pub struct LoadedMesh {
    /// What the file holds.
    pub mesh: Mesh,
    /// What was left out or repaired, one sentence each.
    pub warnings: Vec<String>,
    pub contents: Contents,
    /// Whether all of it is a refined subdivision surface.
    pub is_refined: bool,
    /// The files that the mesh's own file names and that were read, with links resolved.
    pub files: Vec<PathBuf>,
    /// The size of all files together in bytes, the mesh's own included; 0 for a mesh that was made in code.
    pub file_bytes: u64,
}

impl LoadedMesh {
    /// Says why not all of it is a refined subdivision surface, where that was wanted.
    pub fn why_not_refined(&self) -> String {
        let said = self.cage_warnings().cloned().collect::<Vec<_>>().join(" ");
        if said.is_empty() { NOT_REFINED.to_owned() } else { said }
    }

    /// Those of the warnings that are about what isn't refined.
    pub(super) fn cage_warnings(&self) -> impl Iterator<Item = &String> {
        self.warnings.iter().filter(|warning| warning.contains("control cage"))
    }
}

/// The warning about what was to be refined, and has no polygons that can be.
pub(super) const NOT_REFINED: &str =
    "It isn't refined as a subdivision surface: only polygons of FBX, OBJ, PLY, OFF, STL and 3MF files can be.";

/// What a file offers to choose from.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Contents {
    /// The names of its material variants (KHR_materials_variants).
    pub variants: Vec<String>,
    /// The names of its scenes. A scene without a name is called `scene 0`, by its number in the file.
    pub scenes: Vec<String>,
    /// Which of them was read; none if the file has no scenes.
    pub scene: Option<usize>,
    /// The parts of the file that have triangles, also those that were left out. Only some formats have any.
    pub parts: Vec<Part>,
    /// The weights that the file gives its morph targets at rest, whichever were chosen.
    pub morph_targets: MorphWeights,
}

/// Most tests of the readers look only at the mesh.
#[cfg(test)]
impl std::ops::Deref for LoadedMesh {
    type Target = Mesh;

    fn deref(&self) -> &Mesh {
        &self.mesh
    }
}

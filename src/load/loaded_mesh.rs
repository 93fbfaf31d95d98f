//! What reading a mesh file gives.

use std::path::PathBuf;

use crate::mesh::Mesh;

/// A mesh as its file gave it.
#[derive(Clone, Debug, Default)]
pub struct LoadedMesh {
    pub mesh: Mesh,
    /// What was left out or repaired, one sentence each.
    pub warnings: Vec<String>,
    /// Files that the mesh's own file names and that were read, with links resolved.
    pub files: Vec<PathBuf>,
    /// Bytes of all files together, the mesh's own among them; 0 for a mesh that was made in code.
    pub file_bytes: u64,
}

/// Tests of the readers mostly look at the mesh.
#[cfg(test)]
impl std::ops::Deref for LoadedMesh {
    type Target = Mesh;

    fn deref(&self) -> &Mesh {
        &self.mesh
    }
}

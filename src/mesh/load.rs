//! From a path to a mesh.

use std::path::Path;

use thiserror::Error;

use super::{Cancelled, Mesh, Progress, gltf};

/// Why there is no mesh. Each says what, where, and what to do.
#[derive(Debug, Error)]
pub enum LoadError {
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    #[error("{path}: could not be read ({reason})")]
    Io { path: String, reason: std::io::Error },
    #[error("{path}: this is no .gltf or .glb file: convert it to glTF 2.0 first")]
    Extension { path: String },
    #[error("{path}: not valid glTF 2.0 ({reason}): export the file again")]
    Invalid { path: String, reason: String },
    #[error("{path}: buffer {buffer} could not be loaded ({reason}): put it beside the file, or export a .glb")]
    Buffer { path: String, buffer: usize, reason: String },
    #[error("{path}: {place} {reason}: export the file again")]
    Damaged { path: String, place: String, reason: String },
    #[error("{path}: there are no triangles in it{instead}: choose a file with a triangle mesh")]
    Empty { path: String, instead: String },
}

/// Loads a .gltf or .glb file. `progress` is checked between buffers and primitives.
///
/// # Errors
/// See [`LoadError`]; what can be done without is a warning of the mesh instead.
pub fn load(path: &Path, progress: &Progress) -> Result<Mesh, LoadError> {
    let shown = path.display().to_string();
    let ending = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    if !["gltf", "glb"].contains(&ending.as_str()) {
        // A path that isn't there says so first.
        std::fs::metadata(path).map_err(|reason| LoadError::Io { path: shown.clone(), reason })?;
        return Err(LoadError::Extension { path: shown });
    }
    let bytes = std::fs::read(path).map_err(|reason| LoadError::Io { path: shown.clone(), reason })?;
    progress.check()?;
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    gltf::load(&bytes, path.parent(), &shown, name, progress)
}

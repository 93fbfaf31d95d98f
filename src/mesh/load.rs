//! From a path to a mesh: picks the reader by the file's extension.

use std::io;
use std::path::{Path, PathBuf};

use super::fault::Fault;
use super::gltf::{self, Problem};
use super::heights::HeightError;
use super::progress::{Cancelled, Progress};
use super::{Mesh, obj, ply, stl};

/// Ends of names of files that can be read, for messages.
const KNOWN: &str = ".gltf, .glb, .obj, .stl or .ply";

/// Why a file became no mesh.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    #[error("{} can't be read because its name ends in {extension}; choose a {KNOWN} file", path.display())]
    UnknownFormat { path: PathBuf, extension: String },
    #[error("{} is not a file; choose a {KNOWN} file", path.display())]
    NoFile { path: PathBuf },
    #[error("{} can't be read: {source}", path.display())]
    Io { path: PathBuf, source: io::Error },
    #[error("{}: {problem}", path.display())]
    Gltf { path: PathBuf, problem: Box<Problem> },
    #[error("{}: {fault}", path.display())]
    Broken { path: PathBuf, fault: Box<Fault> },
    #[error(transparent)]
    Heights(HeightError),
    #[error("{} has no triangles to show: {holds}", path.display())]
    Empty { path: PathBuf, holds: String },
}

impl From<HeightError> for LoadError {
    fn from(error: HeightError) -> Self {
        match error {
            HeightError::Cancelled(cancelled) => cancelled.into(),
            error => Self::Heights(error),
        }
    }
}

/// Reads a file: glTF 2.0, as `.gltf` or `.glb`; `.obj`, `.stl` or `.ply` (all in either case).
///
/// `progress` goes from 0 to 1 meanwhile. Buffers and textures in files of their own are looked for in the model's
/// folder and below it.
///
/// # Errors
/// [`LoadError`], whose message says what is wrong, where, and what to do. A missing or broken texture is none: it
/// becomes one of the mesh's warnings.
pub fn load(path: &Path, progress: &Progress) -> Result<Mesh, LoadError> {
    progress.set(0.0);
    // Reading a folder, a device or a pipe would fail later, or never end.
    let file = std::fs::metadata(path).map_err(|source| LoadError::Io { path: path.to_owned(), source })?;
    if !file.is_file() {
        return Err(LoadError::NoFile { path: path.to_owned() });
    }
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
    let mesh = match extension.as_deref() {
        Some("gltf" | "glb") => load_gltf(path, progress)?,
        Some(format @ ("obj" | "stl" | "ply")) => load_plain(format, path, progress)?,
        other => {
            let extension = other.map_or("no extension".to_owned(), |extension| format!(".{extension}"));
            return Err(LoadError::UnknownFormat { path: path.to_owned(), extension });
        }
    };
    progress.set(1.0);
    Ok(mesh)
}

fn load_gltf(path: &Path, progress: &Progress) -> Result<Mesh, LoadError> {
    let bytes = std::fs::read(path).map_err(|source| LoadError::Io { path: path.to_owned(), source })?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let folder = path.parent().unwrap_or(Path::new(""));
    gltf::read(&bytes, folder, &name, progress).map_err(|problem| match problem {
        Problem::Cancelled(cancelled) => cancelled.into(),
        Problem::Empty { holds } => LoadError::Empty { path: path.to_owned(), holds },
        problem => LoadError::Gltf { path: path.to_owned(), problem: Box::new(problem) },
    })
}

/// What has no document: a format by the end of its name.
fn load_plain(format: &str, path: &Path, progress: &Progress) -> Result<Mesh, LoadError> {
    let bytes = std::fs::read(path).map_err(|source| LoadError::Io { path: path.to_owned(), source })?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let mesh = match format {
        "obj" => obj::read(&bytes, path.parent().unwrap_or(Path::new("")), &name, progress),
        "stl" => stl::read(&bytes, &name, progress),
        _ => ply::read(&bytes, &name, progress),
    };
    mesh.map_err(|fault| match fault {
        Fault::Cancelled(cancelled) => cancelled.into(),
        Fault::Empty { holds } => LoadError::Empty { path: path.to_owned(), holds },
        fault => LoadError::Broken { path: path.to_owned(), fault: Box::new(fault) },
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(path: &str) -> String {
        load(Path::new(path), &Progress::new()).unwrap_err().to_string()
    }

    #[test]
    fn unknown_formats_name_the_known_ones() {
        let manifest = concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml");
        let expected = "can't be read because its name ends in .toml; choose a .gltf, .glb, .obj, .stl or .ply file";
        assert_eq!(message(manifest), format!("{manifest} {expected}"));
        assert!(message(concat!(env!("CARGO_MANIFEST_DIR"), "/LICENSE")).contains("no extension"));
    }

    #[test]
    fn a_folder_is_no_file() {
        assert!(message(env!("CARGO_MANIFEST_DIR")).contains("is not a file"));
    }

    #[test]
    fn a_missing_file_is_named() {
        assert!(message("nowhere/a.glb").starts_with("nowhere/a.glb can't be read: "));
        assert!(message("nowhere/A.GLTF").starts_with("nowhere/A.GLTF can't be read: "));
    }
}

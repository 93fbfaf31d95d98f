//! From a path to a mesh: picks the reader by the file's extension.

use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use super::fault::Fault;
use super::gltf::{self, Problem};
use super::heights::HeightError;
use super::progress::{Cancelled, Progress};
use super::{Mesh, obj, ply, stl};

/// Ends of names of files that can be read, for messages.
const KNOWN: &str = ".gltf, .glb, .obj, .stl or .ply";

/// What a load may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Bytes of the model's file, and of each file that it names.
    pub file: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self { file: 2 << 30 }
    }
}

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
    #[error(
        "{} has {bytes} bytes, and {limit} are read at most; if you trust it, allow more with --max-size",
        path.display()
    )]
    TooLarge { path: PathBuf, bytes: u64, limit: u64 },
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
/// folder and below it. Neither it nor they may be larger than `limits` says.
///
/// # Errors
/// [`LoadError`], whose message says what is wrong, where, and what to do. A missing or broken texture is none: it
/// becomes one of the mesh's warnings.
pub fn load(path: &Path, limits: &Limits, progress: &Progress) -> Result<Mesh, LoadError> {
    progress.set(0.0);
    // Reading a folder, a device or a pipe would fail later, or never end.
    let file = std::fs::metadata(path).map_err(|source| LoadError::Io { path: path.to_owned(), source })?;
    if !file.is_file() {
        return Err(LoadError::NoFile { path: path.to_owned() });
    }
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
    let mesh = match extension.as_deref() {
        Some("gltf" | "glb") => load_gltf(path, limits, progress)?,
        Some(format @ ("obj" | "stl" | "ply")) => load_plain(format, path, limits, progress)?,
        other => {
            let extension = other.map_or("no extension".to_owned(), |extension| format!(".{extension}"));
            return Err(LoadError::UnknownFormat { path: path.to_owned(), extension });
        }
    };
    progress.set(1.0);
    Ok(mesh)
}

/// The whole of a file, if it isn't too large: neither by what is said of it, nor by what there turns out to be.
///
/// # Errors
/// [`LoadError::TooLarge`] and [`LoadError::Io`].
pub fn read_file(path: &Path, limits: &Limits) -> Result<Vec<u8>, LoadError> {
    let io = |source| LoadError::Io { path: path.to_owned(), source };
    let too_large = |bytes| LoadError::TooLarge { path: path.to_owned(), bytes, limit: limits.file };
    let file = File::open(path).map_err(io)?;
    let said = file.metadata().map_err(io)?.len();
    if said > limits.file {
        return Err(too_large(said));
    }
    let mut bytes = Vec::new();
    // At once: growing bit by bit would take up to twice as much.
    let room = usize::try_from(said).unwrap_or(usize::MAX).saturating_add(1);
    bytes.try_reserve_exact(room).map_err(|error| io(error.into()))?;
    file.take(limits.file.saturating_add(1)).read_to_end(&mut bytes).map_err(io)?;
    match bytes.len() as u64 {
        read if read > limits.file => Err(too_large(read)),
        _ => Ok(bytes),
    }
}

fn load_gltf(path: &Path, limits: &Limits, progress: &Progress) -> Result<Mesh, LoadError> {
    let bytes = read_file(path, limits)?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let folder = path.parent().unwrap_or(Path::new(""));
    gltf::read(bytes, folder, &name, limits, progress).map_err(|problem| match problem {
        Problem::Cancelled(cancelled) => cancelled.into(),
        Problem::Empty { holds } => LoadError::Empty { path: path.to_owned(), holds },
        problem => LoadError::Gltf { path: path.to_owned(), problem: Box::new(problem) },
    })
}

/// What has no document: a format by the end of its name.
fn load_plain(format: &str, path: &Path, limits: &Limits, progress: &Progress) -> Result<Mesh, LoadError> {
    let bytes = read_file(path, limits)?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let mesh = match format {
        "obj" => obj::read(&bytes, path.parent().unwrap_or(Path::new("")), &name, limits, progress),
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
        load(Path::new(path), &Limits::default(), &Progress::new()).unwrap_err().to_string()
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
    fn large_files_are_refused_with_both_numbers() {
        let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/vase.glb"));
        let bytes = std::fs::metadata(path).unwrap().len();
        let load = |file| load(path, &Limits { file }, &Progress::new());
        assert!(load(bytes).is_ok());
        let message = load(bytes - 1).unwrap_err().to_string();
        let expected = format!("has {bytes} bytes, and {} are read at most", bytes - 1);
        assert!(message.contains(&expected) && message.contains("--max-size"), "{message}");
    }

    /// What the system writes as it is read has no length before.
    #[cfg(target_os = "linux")]
    #[test]
    fn files_that_turn_out_larger_are_refused_too() {
        let path = Path::new("/proc/self/status");
        assert_eq!(std::fs::metadata(path).unwrap().len(), 0);
        let message = read_file(path, &Limits { file: 100 }).unwrap_err().to_string();
        assert!(message.contains("has 101 bytes, and 100 are read at most"), "{message}");
        assert!(read_file(path, &Limits::default()).is_ok_and(|bytes| bytes.len() > 100));
    }

    #[test]
    fn a_missing_file_is_named() {
        assert!(message("nowhere/a.glb").starts_with("nowhere/a.glb can't be read: "));
        assert!(message("nowhere/A.GLTF").starts_with("nowhere/A.GLTF can't be read: "));
    }
}

//! From a path to a mesh: picks the reader by the file's extension.

use std::fs::{File, Metadata};
use std::io::{self, Read, Seek};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use super::fault::Fault;
use super::gltf::{self, Problem};
use super::heights::HeightError;
use super::progress::{Cancelled, Progress};
use super::{Mesh, obj, ply, stl};
use crate::names::{file_reason, shown_path};

/// Ends of names of files that can be read, for messages.
const KNOWN: &str = ".gltf, .glb, .obj, .stl or .ply";

/// What a load may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Bytes of the model's file, and of each file that it names.
    pub file: u64,
    /// Bytes of memory, beyond four times the size of all files.
    pub memory: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self { file: 2 << 30, memory: 256 << 20 }
    }
}

/// Why a file became no mesh.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    #[error("{} can't be read because its name ends in {extension}; choose a {KNOWN} file", shown_path(path))]
    UnknownFormat { path: PathBuf, extension: String },
    #[error("{} is not a file; choose a {KNOWN} file", shown_path(path))]
    NoFile { path: PathBuf },
    #[error("{} changed while it was read; open it again once it is whole", shown_path(path))]
    Changed { path: PathBuf },
    #[error("{} can't be read: {}", shown_path(path), file_reason(source))]
    Io { path: PathBuf, source: io::Error },
    #[error("{} is empty: export the model again", shown_path(path))]
    NoBytes { path: PathBuf },
    #[error(
        "{} begins as {is} does, which isn't what its name says: rename it, or export the model again",
        shown_path(path)
    )]
    Misnamed { path: PathBuf, is: &'static str },
    #[error("{} is no glTF: it begins neither with \"glTF\" nor with a {{; export the model again", shown_path(path))]
    NoGltf { path: PathBuf },
    #[error(
        "{} has {bytes} bytes, and {limit} are read at most; if you trust it, allow more with --max-size",
        shown_path(path)
    )]
    TooLarge { path: PathBuf, bytes: u64, limit: u64 },
    #[error("{}: {problem}", shown_path(path))]
    Gltf { path: PathBuf, problem: Box<Problem> },
    #[error("{}: {fault}", shown_path(path))]
    Broken { path: PathBuf, fault: Box<Fault> },
    #[error(transparent)]
    Heights(HeightError),
    #[error("{}: {what} {reason}; split the model into several files", shown_path(path))]
    TooMuch { path: PathBuf, what: &'static str, reason: String },
    #[error("{} has no triangles to show: {holds}", shown_path(path))]
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
    let format = Format::of(path)?;
    let before = Stamp::of(&file);
    let mesh =
        read(format, read_file(path, limits, |start| format.fits(start, path), progress)?, path, limits, progress)?;
    before.holds(path)?;
    progress.set(1.0);
    Ok(mesh)
}

/// What a file is read as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// `.gltf` and `.glb`: the first bytes tell them apart.
    Gltf,
    Obj,
    Stl,
    Ply,
}

impl Format {
    /// By the end of a file's name.
    ///
    /// # Errors
    /// [`LoadError::UnknownFormat`].
    pub fn of(path: &Path) -> Result<Self, LoadError> {
        let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
        match extension.as_deref() {
            Some("gltf" | "glb") => Ok(Self::Gltf),
            Some("obj") => Ok(Self::Obj),
            Some("stl") => Ok(Self::Stl),
            Some("ply") => Ok(Self::Ply),
            other => {
                let extension = other.map_or("no extension".to_owned(), |extension| format!(".{extension}"));
                Err(LoadError::UnknownFormat { path: path.to_owned(), extension })
            }
        }
    }
}

impl Format {
    /// Whether a file may be of this format, by how it starts: what is something else needn't be read whole.
    ///
    /// # Errors
    /// [`LoadError::NoBytes`], [`LoadError::Misnamed`] and [`LoadError::NoGltf`].
    fn fits(self, start: &[u8], path: &Path) -> Result<(), LoadError> {
        let path = || path.to_owned();
        let is_glb = start.starts_with(b"glTF");
        if start.is_empty() {
            return Err(LoadError::NoBytes { path: path() });
        }
        if self != Self::Gltf && is_glb {
            return Err(LoadError::Misnamed { path: path(), is: "a .glb file" });
        }
        if self != Self::Ply && (start.starts_with(b"ply\n") || start.starts_with(b"ply\r")) {
            return Err(LoadError::Misnamed { path: path(), is: "a .ply file" });
        }
        let text = start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start).trim_ascii_start();
        // A list isn't either, which the parser says with its depth.
        if self == Self::Gltf && !is_glb && !matches!(text.first(), None | Some(b'{' | b'[')) {
            return Err(LoadError::NoGltf { path: path() });
        }
        Ok(())
    }
}

/// Makes a mesh of a file's bytes, as [`load`] does. `path` says where they came from: what they name is looked for there.
///
/// # Errors
/// As [`load`].
pub fn read(
    format: Format,
    bytes: Vec<u8>,
    path: &Path,
    limits: &Limits,
    progress: &Progress,
) -> Result<Mesh, LoadError> {
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let folder = path.parent().unwrap_or(Path::new(""));
    match format {
        Format::Gltf => gltf::read(bytes, folder, &name, limits, progress).map_err(|problem| of_problem(problem, path)),
        Format::Obj => obj::read(bytes, folder, &name, limits, progress).map_err(|fault| of_fault(fault, path)),
        Format::Stl => stl::read(bytes, &name, limits, progress).map_err(|fault| of_fault(fault, path)),
        Format::Ply => ply::read(bytes, &name, limits, progress).map_err(|fault| of_fault(fault, path)),
    }
}

/// A file to read: what is there by its name, and is no folder, device or pipe, to open which could never end.
///
/// # Errors
/// The file system's; none of its own if it is no file, but [`None`].
pub fn open_file(path: &Path) -> io::Result<Option<(File, Metadata)>> {
    if !std::fs::metadata(path)?.is_file() {
        return Ok(None);
    }
    let file = File::open(path)?;
    let about = file.metadata()?;
    // Something else may be there by now.
    Ok(about.is_file().then_some((file, about)))
}

/// What tells that a file has changed since.
#[derive(Debug, PartialEq)]
struct Stamp {
    bytes: u64,
    /// None where the file system keeps no times.
    modified: Option<SystemTime>,
}

impl Stamp {
    fn of(about: &Metadata) -> Self {
        Self { bytes: about.len(), modified: about.modified().ok() }
    }

    /// Whether a document is still what it was before the files were read that it names: those may be another one's by now.
    fn holds(&self, path: &Path) -> Result<(), LoadError> {
        match std::fs::metadata(path) {
            Ok(about) if Self::of(&about) != *self => Err(LoadError::Changed { path: path.to_owned() }),
            // What is gone was read before.
            _ => Ok(()),
        }
    }
}

/// The whole of a file, if it isn't too large: neither by what is said of it, nor by what there turns out to be; and all of
/// one time.
///
/// What `fits` says of its first bytes, it says before the others are read.
///
/// # Errors
/// [`LoadError::TooLarge`], [`LoadError::NoFile`], [`LoadError::Changed`], [`LoadError::Io`], [`LoadError::Cancelled`], and
/// what `fits` has against it.
pub fn read_file(
    path: &Path,
    limits: &Limits,
    fits: impl FnOnce(&[u8]) -> Result<(), LoadError>,
    progress: &Progress,
) -> Result<Vec<u8>, LoadError> {
    let io = |source| LoadError::Io { path: path.to_owned(), source };
    let opened = open_file(path).map_err(io)?;
    let (mut file, about) = opened.ok_or_else(|| LoadError::NoFile { path: path.to_owned() })?;
    if about.len() <= limits.file {
        let mut start = Vec::new();
        file.by_ref().take(START).read_to_end(&mut start).map_err(io)?;
        fits(&start)?;
        file.rewind().map_err(io)?;
    }
    read_whole(file, &about, path, limits, progress)
}

/// Bytes by which a file is known.
const START: u64 = 4096;
/// Bytes that are read without a look at whether anybody still wants them.
const PIECE: u64 = 1 << 24;

fn read_whole(
    file: File,
    about: &Metadata,
    path: &Path,
    limits: &Limits,
    progress: &Progress,
) -> Result<Vec<u8>, LoadError> {
    let io = |source| LoadError::Io { path: path.to_owned(), source };
    let too_large = |bytes| LoadError::TooLarge { path: path.to_owned(), bytes, limit: limits.file };
    let said = about.len();
    if said > limits.file {
        return Err(too_large(said));
    }
    let mut bytes = Vec::new();
    // At once: growing bit by bit would take up to twice as much.
    let room = usize::try_from(said).unwrap_or(usize::MAX).saturating_add(1);
    bytes.try_reserve_exact(room).map_err(|error| io(error.into()))?;
    let mut rest = file.take(limits.file.saturating_add(1));
    while rest.by_ref().take(PIECE).read_to_end(&mut bytes).map_err(io)? > 0 {
        progress.check()?;
    }
    let now = rest.into_inner().metadata().map_err(io)?;
    match bytes.len() as u64 {
        read if read > limits.file => Err(too_large(read)),
        _ if Stamp::of(&now) != Stamp::of(about) => Err(LoadError::Changed { path: path.to_owned() }),
        _ => Ok(bytes),
    }
}

fn of_problem(problem: Problem, path: &Path) -> LoadError {
    match problem {
        Problem::Cancelled(cancelled) => cancelled.into(),
        Problem::Empty { holds } => LoadError::Empty { path: path.to_owned(), holds },
        problem => LoadError::Gltf { path: path.to_owned(), problem: Box::new(problem) },
    }
}

fn of_fault(fault: Fault, path: &Path) -> LoadError {
    match fault {
        Fault::Cancelled(cancelled) => cancelled.into(),
        Fault::Empty { holds } => LoadError::Empty { path: path.to_owned(), holds },
        fault => LoadError::Broken { path: path.to_owned(), fault: Box::new(fault) },
    }
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
        let load = |file| load(path, &Limits { file, ..Limits::default() }, &Progress::new());
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
        let read = |file| read_file(path, &Limits { file, ..Limits::default() }, |_| Ok(()), &Progress::new());
        let message = read(100).unwrap_err().to_string();
        assert!(message.contains("has 101 bytes, and 100 are read at most"), "{message}");
        assert!(read(1 << 20).is_ok_and(|bytes| bytes.len() > 100));
    }

    #[test]
    fn a_file_that_changes_while_it_is_read_is_refused() {
        let path = std::env::temp_dir().join(format!("pnaen-changes-{}.stl", std::process::id()));
        let write = |bytes: usize| std::fs::write(&path, vec![b' '; bytes]).unwrap();
        let opened = || open_file(&path).unwrap().expect("a file");
        let read = |(file, about): (File, Metadata)| {
            read_whole(file, &about, &path, &Limits { file: 1000, ..Limits::default() }, &Progress::new())
                .map_err(|error| error.to_string())
        };
        write(100);
        assert_eq!(read(opened()).map(|bytes| bytes.len()), Ok(100));
        for (bytes, expected) in
            [(90, "changed while it was read"), (110, "changed while it was read"), (2000, "has 1001 bytes")]
        {
            write(100);
            let before = opened();
            write(bytes);
            assert!(read(before).is_err_and(|error| error.contains(expected)), "{bytes}");
        }
        write(100);
        let before = opened();
        let later = SystemTime::now() + std::time::Duration::from_secs(2);
        File::options().write(true).open(&path).and_then(|file| file.set_modified(later)).unwrap();
        assert!(read(before).is_err_and(|error| error.contains("open it again")), "the same length, another time");
        let before = Stamp::of(&std::fs::metadata(&path).unwrap());
        assert!(before.holds(&path).is_ok());
        write(100);
        assert!(before.holds(&path).is_err_and(|error| error.to_string().contains("changed while it was read")));
        // What takes its place under its name is another file.
        let before = opened();
        std::fs::remove_file(&path).unwrap();
        write(7);
        assert_eq!(read(before).map(|bytes| bytes.len()), Ok(100));
        std::fs::remove_file(&path).unwrap();
    }

    #[test]
    fn what_is_something_else_is_known_by_its_start() {
        let said = |name: &str, bytes: &[u8]| {
            let path = std::env::temp_dir().join(format!("pnaen-start-{}-{name}", std::process::id()));
            std::fs::write(&path, bytes).unwrap();
            // So large that nobody waits for the whole of it.
            File::options()
                .write(true)
                .open(&path)
                .and_then(|file| file.set_len(bytes.len() as u64 + (1 << 30)))
                .unwrap();
            let said = message(path.to_str().expect("it is of letters"));
            std::fs::remove_file(&path).unwrap();
            said
        };
        for name in ["a.obj", "a.stl", "a.ply"] {
            assert!(said(name, b"glTF\x02\0\0\0").contains("begins as a .glb file does"), "{name}");
        }
        for name in ["a.obj", "a.stl", "a.gltf", "a.glb"] {
            assert!(said(name, b"ply\nformat").contains("begins as a .ply file does"), "{name}");
        }
        assert!(said("a.glb", b"\0\0\0\0").contains("is no glTF: it begins neither with \"glTF\" nor with a {;"));
        assert!(said("a.gltf", b"\xff\xfe{\0").contains("is no glTF"));
        let empty = std::env::temp_dir().join(format!("pnaen-start-{}.gltf", std::process::id()));
        std::fs::write(&empty, b"").unwrap();
        assert!(message(empty.to_str().expect("it is of letters")).ends_with("is empty: export the model again"));
        std::fs::remove_file(&empty).unwrap();
    }

    #[test]
    fn reading_stops_when_nobody_waits_for_it() {
        let path = std::env::temp_dir().join(format!("pnaen-cancelled-{}.stl", std::process::id()));
        File::create(&path).and_then(|file| file.set_len(1 << 30)).unwrap();
        let progress = Progress::new();
        progress.cancel();
        let result = read_file(&path, &Limits::default(), |_| Ok(()), &progress);
        std::fs::remove_file(&path).unwrap();
        assert!(matches!(result, Err(LoadError::Cancelled(_))));
    }

    #[test]
    fn a_missing_file_is_named() {
        assert!(message("nowhere/a.glb").starts_with("nowhere/a.glb can't be read: "));
        assert!(message("nowhere/A.GLTF").starts_with("nowhere/A.GLTF can't be read: "));
    }
}

//! Loads a mesh from a file, with the reader for its extension.

use std::path::{Path, PathBuf};

use super::gltf::{self, GltfError, scenes};
use super::heights::HeightError;
use super::loaded_mesh::LoadedMesh;
use super::read_error::ReadError;
use super::selection::Selection;
use super::{fbx, obj, ply, stl};
use crate::files::{FileError, Limits, Stamp, read_file};
use crate::names::{shown, shown_path};
use crate::progress::{Cancelled, Progress};

/// The extensions of files that can be read, in lower case, each with its format.
pub(crate) const EXTENSIONS: [(&str, Format); 7] = [
    ("gltf", Format::Gltf),
    ("glb", Format::Gltf),
    ("vrm", Format::Gltf),
    ("fbx", Format::Fbx),
    ("obj", Format::Obj),
    ("stl", Format::Stl),
    ("ply", Format::Ply),
];

/// The extensions of files that can be read, for messages: ".gltf, .glb, .vrm, .fbx, .obj, .stl or .ply".
pub(crate) fn known_extensions() -> String {
    let [others @ .., last] = EXTENSIONS.map(|(extension, _)| format!(".{extension}"));
    format!("{} or {last}", others.join(", "))
}

/// Why a file could not be loaded as a mesh.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the messages say what the fields are")]
pub enum LoadError {
    /// The load was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The extension is none of those that are read.
    #[error("{} can't be read, since it has {extension}; choose a {} file", shown_path(path), known_extensions())]
    UnknownFormat { path: PathBuf, extension: String },
    /// The path leads to a folder, a device or a pipe.
    #[error("{} is not a file; choose a {} file", shown_path(path), known_extensions())]
    NotAFile { path: PathBuf },
    /// The file could not be read.
    #[error(transparent)]
    File(FileError),
    /// The file is empty.
    #[error("{} is empty; export the model again", shown_path(path))]
    NoBytes { path: PathBuf },
    /// The content belongs to another format than the extension.
    #[error(
        "{} begins like {is}, which doesn't fit its extension; rename it, or export the model again",
        shown_path(path)
    )]
    Misnamed { path: PathBuf, is: &'static str },
    /// The file is neither glTF JSON nor a binary glTF.
    #[error(
        "{} isn't a glTF file: it begins neither with \"glTF\" nor with a {{; export the model again",
        shown_path(path)
    )]
    NoGltf { path: PathBuf },
    /// The glTF document can't be read.
    #[error("{}: {problem}", shown_path(path))]
    Gltf { path: PathBuf, problem: Box<GltfError> },
    /// The FBX, OBJ, STL or PLY file can't be read.
    #[error("{}: {fault}", shown_path(path))]
    Broken { path: PathBuf, fault: Box<ReadError> },
    /// A height image can't be read.
    #[error(transparent)]
    Heights(HeightError),
    /// The mesh, or something that is made of it, would take too much memory.
    #[error("{}: {what} {reason}; split the model into several files", shown_path(path))]
    TooMuch { path: PathBuf, what: &'static str, reason: String },
    /// The file has no triangles.
    #[error("{} has no triangles to show: {holds}", shown_path(path))]
    Empty { path: PathBuf, holds: String },
    /// The file doesn't have the material variant.
    #[error("{} has no material variant {}; {}", shown_path(path), shown(variant), said_of(known))]
    NoVariant { path: PathBuf, variant: String, known: Vec<String> },
    /// The file doesn't have a part that should be left out.
    #[error("{} has no part {}; {}", shown_path(path), shown(part), said_of_parts(known))]
    NoPart { path: PathBuf, part: String, known: Vec<String> },
    /// The shape is made in code, where Y is up.
    #[error("{shape} is made in code with Y up, in metres: leave --up and --unit away")]
    Shape { shape: String },
    /// The file doesn't have the scene.
    #[error("{} has no scene {}; {}", shown_path(path), shown(scene), said_of_scenes(known))]
    NoScene { path: PathBuf, scene: String, known: Vec<String> },
}

/// Returns which variants there are, as the end of a message.
fn said_of(known: &[String]) -> String {
    if known.is_empty() { "it has no variants, so leave --variant away".to_owned() } else { choice(known) }
}

/// Returns which scenes there are, as the end of a message.
fn said_of_scenes(known: &[String]) -> String {
    if known.is_empty() { "it has no scenes, so leave --scene away".to_owned() } else { choice(known) }
}

/// Returns which parts there are, as the end of a message.
fn said_of_parts(known: &[String]) -> String {
    if known.is_empty() { "it has no named parts, so leave --hide-part away".to_owned() } else { choice(known) }
}

fn choice(known: &[String]) -> String {
    const NAMED: usize = 20;
    let names: Vec<_> = known.iter().take(NAMED).map(|name| shown(name)).collect();
    match known.len().checked_sub(NAMED) {
        None | Some(0) => format!("choose one of {}", names.join(", ")),
        Some(more) => format!("choose one of {} and {more} more, which `pnaen info` lists", names.join(", ")),
    }
}

impl From<FileError> for LoadError {
    fn from(error: FileError) -> Self {
        match error {
            FileError::Cancelled(cancelled) => cancelled.into(),
            FileError::NotAFile { path } => Self::NotAFile { path },
            error => Self::File(error),
        }
    }
}

impl From<HeightError> for LoadError {
    fn from(error: HeightError) -> Self {
        match error {
            HeightError::Cancelled(cancelled) => cancelled.into(),
            error => Self::Heights(error),
        }
    }
}

/// Loads a mesh from a file: `.gltf`, `.glb`, `.vrm`, `.fbx`, `.obj`, `.stl` or `.ply`, in upper or lower case.
///
/// Sets `progress` from 0 to 1. Files that the model names are only read from its folder and folders below it. No file
/// may be larger than `limits` allows.
///
/// # Errors
/// [`LoadError`], whose message says what is wrong, where, and what to do. A missing or broken texture isn't an error
/// but a warning.
pub fn load(path: &Path, limits: &Limits, progress: &Progress) -> Result<LoadedMesh, LoadError> {
    load_selected(path, Selection::default(), limits, progress)
}

/// Loads a mesh as [`load`] does, with the materials of a variant, or another scene than the default one.
///
/// # Errors
/// The same, [`LoadError::NoVariant`] and [`LoadError::NoScene`].
pub(crate) fn load_selected(
    path: &Path,
    selected: Selection,
    limits: &Limits,
    progress: &Progress,
) -> Result<LoadedMesh, LoadError> {
    progress.set(0.0);
    // Reading a folder, a device or a pipe would fail later, or never end.
    let file = std::fs::metadata(path).map_err(|source| FileError::Io { path: path.to_owned(), source })?;
    if !file.is_file() {
        return Err(LoadError::NotAFile { path: path.to_owned() });
    }
    let format = Format::of(path)?;
    let before = Stamp::of(&file);
    let bytes = read_file(path, limits, |start| format.fits(start, path), progress)?;
    let mesh = read(format, bytes, path, selected, limits, progress)?;
    before.check(path)?;
    check_selected(path, selected, &mesh)?;
    progress.set(1.0);
    Ok(mesh)
}

/// Checks that a mesh has the variant, the scene and the parts that were named.
///
/// # Errors
/// [`LoadError::NoVariant`], [`LoadError::NoScene`] and [`LoadError::NoPart`].
pub(super) fn check_selected(path: &Path, selected: Selection, loaded: &LoadedMesh) -> Result<(), LoadError> {
    if let Some(scene) = selected.scene.filter(|scene| scenes::number(&loaded.scenes, scene).is_none()) {
        let known = loaded.scenes.clone();
        return Err(LoadError::NoScene { path: path.to_owned(), scene: scene.to_owned(), known });
    }
    let is_unknown = |name: &&String| loaded.parts.iter().all(|part| part.name != **name);
    if let Some(part) = selected.hidden.iter().find(is_unknown) {
        let known = loaded.parts.iter().map(|part| part.name.clone()).collect();
        return Err(LoadError::NoPart { path: path.to_owned(), part: part.clone(), known });
    }
    match selected.variant.filter(|variant| loaded.variants.iter().all(|known| known != variant)) {
        None => Ok(()),
        Some(variant) => {
            let known = loaded.variants.clone();
            Err(LoadError::NoVariant { path: path.to_owned(), variant: variant.to_owned(), known })
        }
    }
}

/// The format that a file is read as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// `.gltf`, `.glb` or `.vrm`; the first bytes tell whether it is text or binary.
    Gltf,
    /// Text or binary; the first bytes tell which.
    Fbx,
    Obj,
    Stl,
    Ply,
}

impl Format {
    /// Returns the format of a file by its extension.
    ///
    /// # Errors
    /// [`LoadError::UnknownFormat`].
    pub fn of(path: &Path) -> Result<Self, LoadError> {
        let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
        let known = EXTENSIONS.into_iter().find(|(known, _)| extension.as_deref() == Some(*known));
        known.map(|(_, format)| format).ok_or_else(|| {
            let extension =
                extension.map_or("no extension".to_owned(), |extension| format!("the extension .{extension}"));
            LoadError::UnknownFormat { path: path.to_owned(), extension }
        })
    }
}

impl Format {
    /// Checks whether a file's first bytes fit this format, so that another file isn't read whole.
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
        if self != Self::Fbx && start.starts_with(b"Kaydara FBX Binary") {
            return Err(LoadError::Misnamed { path: path(), is: "a .fbx file" });
        }
        let text = start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start).trim_ascii_start();
        // A list isn't a document either, but the parser also reports how deep it is nested.
        if self == Self::Gltf && !is_glb && !matches!(text.first(), None | Some(b'{' | b'[')) {
            return Err(LoadError::NoGltf { path: path() });
        }
        Ok(())
    }
}

/// Builds a mesh from a file's bytes, as [`load`] does. `path` is the path of the file; the files that it names are
/// looked for in its folder. A variant or a scene that the file doesn't have is left aside.
///
/// # Errors
/// The same as [`load`]'s.
pub fn read(
    format: Format,
    bytes: Vec<u8>,
    path: &Path,
    selected: Selection,
    limits: &Limits,
    progress: &Progress,
) -> Result<LoadedMesh, LoadError> {
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let folder = path.parent().unwrap_or(Path::new(""));
    let import = selected.import;
    let mut loaded = match format {
        Format::Gltf => {
            gltf::read(bytes, folder, &name, selected, limits, progress).map_err(|problem| of_problem(problem, path))
        }
        Format::Fbx => fbx::read(bytes, folder, &name, import, limits, progress).map_err(|fault| of_fault(fault, path)),
        Format::Obj => {
            obj::read(bytes, folder, &name, selected, limits, progress).map_err(|fault| of_fault(fault, path))
        }
        Format::Stl => stl::read(bytes, &name, selected, limits, progress).map_err(|fault| of_fault(fault, path)),
        Format::Ply => ply::read(bytes, &name, import, limits, progress).map_err(|fault| of_fault(fault, path)),
    }?;
    import.place(&mut loaded.mesh);
    Ok(loaded)
}

fn of_problem(problem: GltfError, path: &Path) -> LoadError {
    match problem {
        GltfError::Cancelled(cancelled) => cancelled.into(),
        GltfError::Empty { holds } => LoadError::Empty { path: path.to_owned(), holds },
        problem => LoadError::Gltf { path: path.to_owned(), problem: Box::new(problem) },
    }
}

fn of_fault(fault: ReadError, path: &Path) -> LoadError {
    match fault {
        ReadError::Cancelled(cancelled) => cancelled.into(),
        ReadError::Empty { holds } => LoadError::Empty { path: path.to_owned(), holds },
        fault => LoadError::Broken { path: path.to_owned(), fault: Box::new(fault) },
    }
}

#[cfg(test)]
mod tests {
    use std::fs::File;

    use super::*;

    fn message(path: &str) -> String {
        load(Path::new(path), &Limits::default(), &Progress::new()).unwrap_err().to_string()
    }

    #[test]
    fn unknown_formats_name_the_known_ones() {
        let manifest = concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml");
        let expected = "can't be read, since it has the extension .toml; choose a .gltf, .glb, .vrm, .fbx, .obj, .stl or .ply file";
        assert_eq!(message(manifest), format!("{manifest} {expected}"));
        assert!(message(concat!(env!("CARGO_MANIFEST_DIR"), "/LICENSE")).contains("no extension"));
    }

    #[test]
    fn folders_are_refused() {
        assert!(message(env!("CARGO_MANIFEST_DIR")).contains("is not a file"));
    }

    #[test]
    fn large_files_are_refused_with_both_numbers() {
        let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/vase.glb"));
        let bytes = std::fs::metadata(path).unwrap().len();
        let load = |file| load(path, &Limits { file, ..Limits::default() }, &Progress::new());
        assert!(load(bytes).is_ok());
        let message = load(bytes - 1).unwrap_err().to_string();
        let expected = format!("has {bytes} bytes, but at most {} are read", bytes - 1);
        assert!(message.contains(&expected) && message.contains("--max-size"), "{message}");
    }

    #[test]
    fn files_of_another_format_are_recognised_by_their_start() {
        let folder = tempfile::tempdir().unwrap();
        let said = |name: &str, bytes: &[u8]| {
            let path = folder.path().join(name);
            std::fs::write(&path, bytes).unwrap();
            // Too large to read in the time that a test may take.
            File::options()
                .write(true)
                .open(&path)
                .and_then(|file| file.set_len(bytes.len() as u64 + (1 << 30)))
                .unwrap();
            message(path.to_str().expect("it is of letters"))
        };
        for name in ["a.fbx", "a.obj", "a.stl", "a.ply"] {
            assert!(said(name, b"glTF\x02\0\0\0").contains("begins like a .glb file"), "{name}");
        }
        for name in ["a.fbx", "a.obj", "a.stl", "a.gltf", "a.glb"] {
            assert!(said(name, b"ply\nformat").contains("begins like a .ply file"), "{name}");
        }
        for name in ["a.obj", "a.stl", "a.ply", "a.gltf"] {
            assert!(said(name, b"Kaydara FBX Binary  \0").contains("begins like a .fbx file"), "{name}");
        }
        assert!(
            said("a.glb", b"\0\0\0\0").contains("isn't a glTF file: it begins neither with \"glTF\" nor with a {;")
        );
        assert!(said("a.gltf", b"\xff\xfe{\0").contains("isn't a glTF file"));
        let empty = folder.path().join("empty.gltf");
        std::fs::write(&empty, b"").unwrap();
        assert!(message(empty.to_str().expect("it is of letters")).ends_with("is empty; export the model again"));
    }

    #[test]
    fn a_missing_file_is_named() {
        assert!(message("nowhere/a.glb").starts_with("nowhere/a.glb can't be read: "));
        assert!(message("nowhere/A.GLTF").starts_with("nowhere/A.GLTF can't be read: "));
    }
}

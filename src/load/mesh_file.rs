//! Loads a mesh from a file, with the reader for its content, or for its extension if its content shows no format.

use geometry::choice::Choice;
use std::collections::HashSet;
use std::path::{Path, PathBuf};

use super::content::{self, Content};
use super::format::{Format, extension_of, known_extensions};
use super::gltf::{self, GltfError, scenes};
use super::heights::HeightError;
use super::loaded_mesh::{Contents, LoadedMesh, NOT_REFINED};
use super::model_file::ModelFile;
use super::read_error::ReadError;
use super::selection::{Names, Selection, ShownParts, choice, is_material};
use super::text_lines::in_utf8;
use super::unread_formats::{self, UnreadFormat};
use super::{fbx, obj, off, ply, stl, threemf};
use crate::files::{FileError, Limits, Stamp, read_file};
use geometry::mesh::rig::LARGEST_COORDINATE;
use geometry::names::{shown, shown_path};
use geometry::progress::{Cancelled, Progress};
use glam::Vec3;

/// Why a file could not be loaded as a mesh.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the messages say what the fields are")]
pub enum LoadError {
    /// The load was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The file is empty, has a format that isn't read or none that is known, or isn't of the format that its extension says; what is said
    /// after its path.
    #[error("{} {reason}", shown_path(path))]
    NotRead { path: PathBuf, reason: String },
    /// The path leads to a folder, a device or a pipe.
    #[error("{} is not a file; choose a {} file", shown_path(path), known_extensions())]
    NotAFile { path: PathBuf },
    /// The file could not be read.
    #[error(transparent)]
    File(FileError),
    /// The glTF document can't be read.
    #[error("{}: {problem}", shown_path(path))]
    Gltf { path: PathBuf, problem: Box<GltfError> },
    /// The FBX, OBJ, STL, PLY, OFF or 3MF file can't be read.
    #[error("{}: {fault}", shown_path(path))]
    Broken { path: PathBuf, fault: Box<ReadError> },
    /// A height image can't be read.
    #[error(transparent)]
    Heights(HeightError),
    /// The mesh, or something that is made of it, would take too much memory.
    #[error("{}: {what} {reason}; split the model into several files", shown_path(path))]
    TooMuch { path: PathBuf, what: &'static str, reason: String },
    /// A mesh has no triangles, or its cage can't be refined, but must be.
    #[error("{file} can't be a reference surface: {reason}")]
    NoReference { file: String, reason: String },
    /// The file has no triangles.
    #[error("{} has no triangles to show: {holds}", shown_path(path))]
    Empty { path: PathBuf, holds: String },
    /// The shape is made in code, where Y is up.
    #[error("{shape} is made in code with Y up, in metres: omit --up and --unit")]
    Shape { shape: String },
    /// The file doesn't have the "material variant", "scene", "part" or "morph target" of this name, but others. `none` is said
    /// if there are no others.
    #[error("{} has no {what} {}; {}", shown_path(path), shown(name), choice(known, none))]
    Absent { path: PathBuf, what: &'static str, name: String, known: Vec<String>, none: &'static str },
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

/// Loads a mesh from a file of glTF, FBX, OBJ, STL, PLY, OFF or 3MF. Its first bytes tell the format, whatever its name; where they
/// could belong to any, its extension does, in upper or lower case.
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
/// The same, and [`LoadError::Absent`].
pub fn load_selected(
    path: &Path,
    selected: Selection,
    limits: &Limits,
    progress: &Progress,
) -> Result<LoadedMesh, LoadError> {
    progress.set(0.0);
    let file = std::fs::metadata(path).map_err(|source| FileError::Io { path: path.to_owned(), source })?;
    let before = Stamp::new(&file);
    let mut judged = None;
    let judge = |start: &[u8]| Judged::new(path, start, file.len()).map(|found| judged = Some(found));
    let bytes = read_file(path, limits, judge, progress)?;
    let Some(Judged { format, is_utf16, warning }) = judged else {
        return Err(not_read(path, NO_BYTES));
    };
    let mut mesh = read(format, if is_utf16 { in_utf8(bytes) } else { bytes }, path, selected, limits, progress)?;
    mesh.warnings.splice(0..0, warning);
    if selected.import.refines_all() && !mesh.is_refined {
        let is_said = mesh.cage_warnings().next().is_some();
        mesh.warnings.extend((!is_said).then(|| NOT_REFINED.to_owned()));
    }
    before.check(path)?;
    check_selected(path, selected, &mesh.contents)?;
    progress.set(1.0);
    Ok(mesh)
}

/// Checks that a mesh has the variant, scene, parts and morph targets that were named.
///
/// # Errors
/// [`LoadError::Absent`].
pub(super) fn check_selected(path: &Path, selected: Selection, known: &Contents) -> Result<(), LoadError> {
    let absent = |what, name: &str, known, none| {
        Err(LoadError::Absent { path: path.to_owned(), what, name: name.to_owned(), known, none })
    };
    if let Some(scene) = selected.scene.filter(|scene| scenes::number(&known.scenes, scene).is_none()) {
        return absent("scene", scene, known.scenes.clone(), "it has no scenes, so omit --scene");
    }
    if let Some(ShownParts { hidden, only, styles, morphs }) = selected.parts {
        // The materials of parts that are left out aren't known.
        let is_cut = known.parts.iter().any(|part| part.is_hidden && !is_material(&part.name));
        let may_be = |name: &str| is_cut && is_material(name);
        let named = || hidden.iter().chain(only).chain(styles.iter().map(|(name, _)| name));
        let names = Names::new(named());
        let meant: HashSet<&String> = known.parts.iter().flat_map(|part| names.meaning(&part.name)).collect();
        if let Some(part) = named().find(|name| !may_be(name) && !meant.contains(name)) {
            let known = known.parts.iter().map(|part| part.name.clone()).collect();
            return absent("part", part, known, "it has no named parts, so omit --hide-part, --show-part and --part");
        }
        if let Some(name) = morphs.keys().find(|name| !known.morph_targets.contains_key(*name)) {
            let known = known.morph_targets.keys().cloned().collect();
            return absent("morph target", name, known, "it has no morph targets, so give no weights");
        }
    }
    if let Some(variant) = selected.variant.filter(|variant| known.variants.iter().all(|known| known != variant)) {
        let none = "it has no variants, so omit --variant";
        return absent("material variant", variant, known.variants.clone(), none);
    }
    Ok(())
}

/// What a file is read as.
#[derive(Debug)]
struct Judged {
    format: Format,
    /// Whether it is a text in UTF-16.
    is_utf16: bool,
    /// That the name says something else than the content.
    warning: Option<String>,
}

impl Judged {
    /// Judges a file by its first bytes, and by its name if they show no format. `length` is the file's size in bytes.
    ///
    /// # Errors
    /// [`LoadError::NotRead`].
    fn new(path: &Path, start: &[u8], length: u64) -> Result<Self, LoadError> {
        if start.is_empty() {
            return Err(not_read(path, NO_BYTES));
        }
        let (named, extension) = (Format::from_name(path), extension_of(path).unwrap_or_default());
        let by_name = |format| Self { format, is_utf16: false, warning: None };
        // Whatever an OBJ file begins with, lines that OBJ doesn't have are left out.
        let is_binary = start.contains(&0);
        if named == Some(Format::Obj) && !is_binary && content::has_vertex(start) {
            return Ok(by_name(Format::Obj));
        }
        match (content::recognised(start, length), named) {
            (Some(Content::Read { format, is_utf16 }), _) => {
                let warning = (named != Some(format)).then(|| taken_for(format, &extension));
                // The reader of OBJ does this itself.
                Ok(Self { format, is_utf16: is_utf16 && format != Format::Obj, warning })
            }
            (Some(Content::Unread(format)), _) => {
                Err(not_read(path, unread(unread_formats::of_compressed(start, &extension).unwrap_or(format))))
            }
            (None, Some(Format::Gltf)) if !begins_as_json(start) => Err(not_read(path, NO_GLTF)),
            (None, Some(format)) => Ok(by_name(format)),
            (None, None) => {
                let known = unread_formats::of_extension(&extension);
                Err(not_read(path, known.map_or_else(|| unknown(&extension), unread)))
            }
        }
    }
}

const NO_BYTES: &str = "is empty; export the model again";
const NO_GLTF: &str = "isn't a glTF file: it begins neither with \"glTF\" nor with a {; export the model again";

fn not_read(path: &Path, reason: impl Into<String>) -> LoadError {
    LoadError::NotRead { path: path.to_owned(), reason: reason.into() }
}

fn unread(UnreadFormat { is, advice, .. }: &UnreadFormat) -> String {
    format!("is {is}, which isn't read; {advice}")
}

fn unknown(extension: &str) -> String {
    let extension = match extension {
        "" => "no extension".to_owned(),
        extension => format!("the extension .{}", shown(extension)),
    };
    let advice = format!("choose a {} file", known_extensions());
    format!("can't be read: its content shows no format, and it has {extension}; {advice}")
}

/// A warning about a file whose content isn't what its name says.
fn taken_for(format: Format, extension: &str) -> String {
    let title = format.label();
    match extension {
        "" => format!("The file's name has no extension. Its content is {title}, so it was read as {title}."),
        extension => {
            let extension = shown(extension);
            format!("The file's name ends in .{extension}, but its content is {title}, so it was read as {title}.")
        }
    }
}

/// A list isn't a document either, but the parser also reports how deep it is nested.
fn begins_as_json(start: &[u8]) -> bool {
    let text = start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start).trim_ascii_start();
    matches!(text.first(), None | Some(b'{' | b'['))
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
    let name = &path.file_stem().unwrap_or_default().to_string_lossy();
    let folder = path.parent().unwrap_or(Path::new(""));
    let file = &ModelFile { folder, name, selected, limits: *limits, progress };
    let broken = |fault| match fault {
        ReadError::Cancelled(cancelled) => cancelled.into(),
        ReadError::Empty { holds } => LoadError::Empty { path: path.to_owned(), holds },
        fault => LoadError::Broken { path: path.to_owned(), fault: Box::new(fault) },
    };
    let mut loaded = match format {
        Format::Gltf => gltf::read(bytes, file).map_err(|problem| match problem {
            GltfError::Cancelled(cancelled) => cancelled.into(),
            GltfError::Empty { holds } => LoadError::Empty { path: path.to_owned(), holds },
            problem => LoadError::Gltf { path: path.to_owned(), problem: Box::new(problem) },
        }),
        Format::Fbx => fbx::read(bytes, file).map_err(broken),
        Format::Obj => obj::read(bytes, file).map_err(broken),
        Format::Stl => stl::read(bytes, file).map_err(broken),
        Format::Ply => ply::read(bytes, file).map_err(broken),
        Format::Off => off::read(bytes, file).map_err(broken),
        Format::ThreeMf => threemf::read(bytes, file).map_err(broken),
    }?;
    selected.import.place(&mut loaded.mesh);
    let bounds = loaded.mesh.bounds();
    let is_within = |corner: Vec3| corner.abs().cmple(Vec3::splat(LARGEST_COORDINATE)).all();
    if !(is_within(bounds.min) && is_within(bounds.max)) {
        let reason =
            format!("has coordinates beyond {LARGEST_COORDINATE:e} in this unit; choose a smaller one with --unit");
        return Err(not_read(path, reason));
    }
    Ok(loaded)
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
        let expected = "can't be read: its content shows no format, and it has the extension .toml; choose a .gltf, .glb, .vrm, \
                        .fbx, .obj, .stl, .ply, .off or .3mf file";
        assert_eq!(message(manifest), format!("{manifest} {expected}"));
        assert!(message(documents::in_repository("LICENSE").to_str().unwrap()).contains("it has no extension;"));
    }

    #[test]
    fn folders_are_refused() {
        assert!(message(env!("CARGO_MANIFEST_DIR")).contains("is not a file"));
    }

    #[test]
    fn large_files_are_refused_with_both_numbers() {
        let path = &assets::path("vase.glb");
        let bytes = std::fs::metadata(path).unwrap().len();
        let load = |file| load(path, &Limits { file, ..Limits::default() }, &Progress::new());
        assert!(load(bytes).is_ok());
        let message = load(bytes - 1).unwrap_err().to_string();
        let expected = format!("has {bytes} bytes, but at most {} are read", bytes - 1);
        assert!(message.contains(&expected) && message.contains("--max-size"), "{message}");
    }

    /// Writes a file and loads it.
    fn loaded(name: &str, bytes: &[u8]) -> Result<LoadedMesh, LoadError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        load(&path, &Limits::default(), &Progress::new())
    }

    #[test]
    fn the_content_decides_whatever_the_name_says() {
        let vase = assets::VASE.to_vec();
        let originals = [
            (Format::Gltf, vase),
            (Format::Obj, obj::tests::cube().into_bytes()),
            (Format::Stl, stl::tests::text().into_bytes()),
            (Format::Stl, stl::tests::binary(b"solid cube")),
            (Format::Ply, ply::tests::cube(0, 6, 4)),
            (Format::Ply, ply::tests::cube(1, 6, 4)),
            (Format::Fbx, fbx::tests::files().swap_remove(0)),
            (Format::Off, off::tests::cube().into_bytes()),
            (Format::ThreeMf, threemf::tests::cube()),
        ];
        let names = ["a.gltf", "a.fbx", "a.obj", "a.stl", "a.ply", "a.off", "a.3mf", "a.txt", "a.dae", "a"];
        for (format, bytes) in originals {
            for name in names {
                let title = format.label();
                let mesh = loaded(name, &bytes).unwrap_or_else(|error| panic!("{title} as {name}: {error}"));
                let said = format!("content is {title}, so it was read as {title}.");
                let is_said = mesh.warnings.first().is_some_and(|warning| warning.ends_with(&said));
                assert_eq!(is_said, Format::from_name(Path::new(name)) != Some(format), "{title} as {name}");
            }
        }
    }

    #[test]
    fn texts_in_utf_16_are_read() {
        let document = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/corpus/gltf/good/triangle.gltf"));
        let texts = [
            ("a.gltf", document.unwrap()),
            ("a.obj", obj::tests::cube()),
            ("a.stl", stl::tests::text()),
            ("a.off", off::tests::cube()),
        ];
        for (name, text) in texts {
            let utf16 = [vec![0xff, 0xfe], text.encode_utf16().flat_map(u16::to_le_bytes).collect()].concat();
            let mesh = loaded(name, &utf16).unwrap_or_else(|error| panic!("{name}: {error}"));
            assert_eq!(mesh.warnings, loaded(name, text.as_bytes()).unwrap().warnings, "{name}");
        }
    }

    /// Such files have always been read as their names say.
    #[test]
    fn the_name_decides_where_the_content_could_be_anything() {
        let obj = format!("OFF\n8 6 12\n{}", obj::tests::cube());
        let text = stl::tests::text();
        let stl_without_solid = text.lines().filter(|line| !line.contains("solid")).collect::<Vec<_>>().join("\n");
        let comments = format!("{}\n{}", "# a comment\n".repeat(10_000), obj::tests::cube());
        let cut = stl::tests::binary(b"OFF the shelf")[..400].to_vec();
        let cases = [
            ("a.obj", obj.into_bytes()),
            ("a.stl", stl_without_solid.into_bytes()),
            ("a.obj", comments.into_bytes()),
            ("a.stl", cut),
        ];
        for (name, bytes) in cases {
            let mesh = loaded(name, &bytes).unwrap_or_else(|error| panic!("{name}: {error}"));
            assert!(mesh.warnings.iter().all(|warning| !warning.contains("so it was read as")), "{:?}", mesh.warnings);
        }
    }

    #[test]
    fn formats_that_are_not_read_get_advice() {
        let said = |name: &str, bytes: &[u8]| loaded(name, bytes).unwrap_err().to_string();
        for name in ["a.blend", "a.obj", "a.glb", "a"] {
            let message = said(name, b"BLENDER-v300");
            assert!(
                message.contains(&format!("{name} is a Blender file, which isn't read; export it with `blender ")),
                "{message}"
            );
        }
        let by_name = [
            ("a.usd", "usd2gltf -i"),
            ("a.DAE", "assimp export FILE.dae"),
            ("a.abc", "alembic_import"),
            ("a.mb", "from Maya"),
            ("a.stp", "gmsh"),
            ("a.rar", "unpack it"),
        ];
        for (name, advice) in by_name {
            assert!(said(name, b"could be anything").contains(advice), "{name}");
        }
        assert!(said("a.ply.gz", b"\x1f\x8b\x08").contains("is a packed file"));
        assert!(said("a.ply", b"\x1f\x8b\x08").contains("is a packed file"));
        assert!(said("a.blend", b"\x1f\x8b\x08").contains("is a Blender file"));
    }

    #[test]
    fn a_file_that_is_refused_is_not_read_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.glb");
        std::fs::write(&path, b"\0\0\0\0").unwrap();
        // Too large to read in the time that a test may take.
        File::options().write(true).open(&path).and_then(|file| file.set_len(1 << 30)).unwrap();
        let said = message(path.to_str().expect("it is of letters"));
        assert!(said.contains("isn't a glTF file: it begins neither with \"glTF\" nor with a {;"), "{said}");
        assert!(loaded("empty.gltf", b"").unwrap_err().to_string().ends_with("is empty; export the model again"));
    }

    #[test]
    fn a_missing_file_is_named() {
        assert!(message("nowhere/a.glb").starts_with("nowhere/a.glb can't be read: "));
        assert!(message("nowhere/A.GLTF").starts_with("nowhere/A.GLTF can't be read: "));
    }
}

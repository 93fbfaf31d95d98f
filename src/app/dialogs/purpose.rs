//! What the desktop's file dialog, and the window in which a path is typed, say about the file that they ask for.

use std::path::Path;

use crate::app::jobs::companion_files::absolute_path;
use crate::commands::{CompanionFile, Purpose, Written};
use load::Source;
use load::environment_file::ENVIRONMENT_EXTENSIONS;
use load::format::{extensions, known_extensions};

/// A kind of file: its name, and how names of such files end.
type Kind = (&'static str, Vec<&'static str>);

/// What is said about a file that is asked for.
pub(in crate::app) struct AskedFile {
    /// The title of the window in which a path is typed.
    pub title: &'static str,
    /// The files that can be typed, in a sentence.
    pub takes: String,
    /// The kinds of file that a dialog offers.
    pub kinds: Vec<Kind>,
    /// What the name of a file to write ends with, after the mesh's.
    ending: &'static str,
}

impl AskedFile {
    pub(in crate::app) fn new(purpose: Purpose) -> Self {
        let of = |title, takes: &str, kinds: Vec<Kind>, ending| Self { title, takes: takes.to_owned(), kinds, ending };
        let only = |(name, ending)| (name, vec![ending]);
        let beside =
            |title, takes: &str, kind, endings: &[&'static str]| of(title, takes, vec![(kind, endings.to_vec())], "");
        let mesh = |title, more: &str| {
            // A mesh is told by its content, so it may have any name.
            let kinds = vec![("Meshes", extensions()), ("All files", vec!["*"])];
            of(title, &format!("A {} file, {more}", known_extensions()), kinds, "")
        };
        let images: &[_] = &["png", "jpg", "jpeg", "webp"];
        match purpose {
            Purpose::Open => mesh(
                "Open path",
                "shape:NAME, a height image (.png, .jpg, .webp, .tif), or an environment (.hdr, .exr)",
            ),
            Purpose::CompanionFile(CompanionFile::ReferenceShape) => mesh("Reference surface path", "or shape:NAME"),
            Purpose::CompanionFile(CompanionFile::LeftMesh) => mesh("Left mesh path", "or shape:NAME"),
            Purpose::Heights | Purpose::PartHeights => {
                let images = [images, &["tga", "bmp", "ktx2", "tif", "tiff", "exr"]].concat();
                beside("Height image path", "A .png, .jpg, .webp, .tga, .ktx2, .tif or .exr image", "Images", &images)
            }
            Purpose::CompanionFile(CompanionFile::Matcap) => {
                beside("Matcap path", "A .png, .jpg or .webp image", "Images", images)
            }
            Purpose::CompanionFile(CompanionFile::Factors) => {
                beside("Factors path", "A .csv file with the factors of every triangle", "CSV table", &["csv"])
            }
            Purpose::CompanionFile(CompanionFile::LodShader) => {
                beside("LOD shader path", "A .wgsl file with the function edge_factor", "WGSL", &["wgsl"])
            }
            Purpose::CompanionFile(CompanionFile::SurfaceShader) => {
                beside("Surface shader path", "A .wgsl file with the function edge_points", "WGSL", &["wgsl"])
            }
            Purpose::CompanionFile(CompanionFile::Environment) => {
                beside("Environment path", "A .hdr or .exr panorama", "Panoramas of light", &ENVIRONMENT_EXTENSIONS)
            }
            Purpose::Write(Written::Chart) => {
                let kinds = [("SVG picture", "svg"), ("PNG picture", "png"), ("CSV table", "csv")].map(only).to_vec();
                of("Save chart", "A new .svg, .png or .csv file", kinds, "")
            }
            Purpose::Write(Written::Picture) => {
                let kinds = [("PNG picture", "png"), ("Report as a page", "html")].map(only).to_vec();
                of("Save picture", "A new .png file, or .html for a report on the picture", kinds, "-view.png")
            }
            Purpose::Write(Written::Folder) => of("Save turntable", "A new folder", Vec::new(), "-turntable"),
            Purpose::Write(Written::Gif) => {
                of("Save turntable", "A new .gif file", vec![("Animated GIF", vec!["gif"])], "-turntable.gif")
            }
            Purpose::Write(Written::Factors) => {
                of("Save factors", "A new .csv file", vec![("CSV table", vec!["csv"])], "-factors.csv")
            }
            Purpose::Write(Written::Adjacency) => {
                let kinds = [("JSON", "json"), ("Bare indices", "bin")].map(only).to_vec();
                of("Save adjacency", "A new .json or .bin file", kinds, "-adjacency.json")
            }
            Purpose::Write(Written::Stats) => {
                of("Save stats", "A new .json file", vec![("JSON", vec!["json"])], "-stats.json")
            }
            Purpose::Write(Written::Mesh) => {
                let kinds = [("glTF binary", "glb"), ("Wavefront OBJ", "obj")].map(only).to_vec();
                of("Export mesh", "A new .glb or .obj file", kinds, "-tessellated.glb")
            }
        }
    }
}

pub(super) fn button(purpose: Purpose) -> &'static str {
    match purpose {
        Purpose::Write(Written::Mesh) => "Export",
        Purpose::Write(_) => "Save",
        _ => "Open",
    }
}

/// The proposed name of a file to write, after that of the mesh; none of a file to read.
pub(super) fn proposed_name(purpose: Purpose, open: Option<&Source>) -> Option<String> {
    let title = open.map_or_else(|| "mesh".to_owned(), Source::title);
    match purpose {
        Purpose::Write(Written::Chart) => Some("chart.svg".to_owned()),
        Purpose::Write(_) => Some(name_beside(&title, AskedFile::new(purpose).ending)),
        _ => None,
    }
}

/// The path that the text field starts with. `folder` is where a file was written last.
pub(super) fn proposed(purpose: Purpose, open: Option<&Source>, folder: Option<&Path>) -> String {
    if let Some(name) = proposed_name(purpose, open) {
        let path = folder.map_or_else(|| absolute_path(name.clone().into()), |folder| folder.join(&name));
        return unused(path.display().to_string());
    }
    match (purpose, open) {
        (
            Purpose::Open | Purpose::CompanionFile(CompanionFile::ReferenceShape | CompanionFile::LeftMesh),
            Some(Source::File(path)),
        ) => path.display().to_string(),
        _ => String::new(),
    }
}

/// The path itself, or if there is such a file, one whose name ends with the first number from 2 on that is free.
fn unused(path: String) -> String {
    let (stem, ending) = match path.rsplit_once('.') {
        Some((stem, ending)) if !ending.contains(['/', '\\']) => (stem, format!(".{ending}")),
        _ => (path.as_str(), String::new()),
    };
    let numbered = (2..).map(|number| format!("{stem}-{number}{ending}"));
    std::iter::once(path.clone()).chain(numbered).find(|path| !Path::new(path).exists()).unwrap_or(path.clone())
}

/// The name of a file that is made from a mesh with this title: the title's ending is replaced by `ending`.
pub(crate) fn name_beside(title: &str, ending: &str) -> String {
    let stem = Path::new(title).file_stem().unwrap_or_default().to_string_lossy();
    // A shape's title has a colon, which some systems forbid in file names.
    stem.replace([':', '@', ' '], "-") + ending
}

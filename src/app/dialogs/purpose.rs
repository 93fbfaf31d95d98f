//! What the desktop's file dialog, and the window in which a path is typed, say about the file that they ask for.

use std::path::Path;

use crate::commands::{CompanionFile, Purpose, Written};
use load::Source;
use load::environment_file::ENVIRONMENT_EXTENSIONS;
use load::format::{extensions, known_extensions};

/// A kind of file: its name, and how names of such files end.
type Kind = (&'static str, Vec<&'static str>);

pub(super) fn title(purpose: Purpose) -> &'static str {
    match purpose {
        Purpose::Open => "Open path",
        Purpose::Heights => "Height image path",
        Purpose::CompanionFile(CompanionFile::ReferenceShape) => "Reference surface path",
        Purpose::CompanionFile(CompanionFile::LeftMesh) => "Left mesh path",
        Purpose::CompanionFile(CompanionFile::Factors) => "Factors path",
        Purpose::CompanionFile(CompanionFile::LodShader) => "LOD shader path",
        Purpose::CompanionFile(CompanionFile::SurfaceShader) => "Surface shader path",
        Purpose::CompanionFile(CompanionFile::Matcap) => "Matcap path",
        Purpose::CompanionFile(CompanionFile::Environment) => "Environment path",
        Purpose::Write(Written::Chart) => "Save chart",
        Purpose::Write(Written::Picture) => "Save picture",
        Purpose::Write(Written::Folder | Written::Gif) => "Save turntable",
        Purpose::Write(Written::Factors) => "Save factors",
        Purpose::Write(Written::Adjacency) => "Save adjacency",
        Purpose::Write(Written::Stats) => "Save stats",
        Purpose::Write(Written::Mesh) => "Export mesh",
    }
}

pub(super) fn button(purpose: Purpose) -> &'static str {
    match purpose {
        Purpose::Write(Written::Mesh) => "Export",
        Purpose::Write(_) => "Save",
        _ => "Open",
    }
}

pub(super) fn is_written(purpose: Purpose) -> bool {
    matches!(purpose, Purpose::Write(_))
}

/// The files that can be typed, in a sentence.
pub(super) fn takes(purpose: Purpose) -> String {
    let text = match purpose {
        Purpose::Open => {
            let kinds = known_extensions();
            return format!(
                "A {kinds} file, shape:NAME, a height image (.png, .jpg, .webp), or an environment (.hdr, .exr)"
            );
        }
        Purpose::CompanionFile(CompanionFile::ReferenceShape | CompanionFile::LeftMesh) => {
            return format!("A {} file, or shape:NAME", known_extensions());
        }
        Purpose::Heights | Purpose::CompanionFile(CompanionFile::Matcap) => "A .png, .jpg or .webp image",
        Purpose::CompanionFile(CompanionFile::Factors) => "A .csv file with the factors of every triangle",
        Purpose::CompanionFile(CompanionFile::LodShader) => "A .wgsl file with the function edge_factor",
        Purpose::CompanionFile(CompanionFile::SurfaceShader) => "A .wgsl file with the function edge_points",
        Purpose::CompanionFile(CompanionFile::Environment) => "A .hdr or .exr panorama",
        Purpose::Write(Written::Chart) => "A new .svg, .png or .csv file",
        Purpose::Write(Written::Picture) => "A new .png file, or .html for a report on the picture",
        Purpose::Write(Written::Folder) => "A new folder",
        Purpose::Write(Written::Gif) => "A new .gif file",
        Purpose::Write(Written::Factors) => "A new .csv file",
        Purpose::Write(Written::Adjacency) => "A new .json or .bin file",
        Purpose::Write(Written::Stats) => "A new .json file",
        Purpose::Write(Written::Mesh) => "A new .glb or .obj file",
    };
    text.to_owned()
}

/// The kinds of file that a dialog offers.
pub(super) fn kinds(purpose: Purpose) -> Vec<Kind> {
    match purpose {
        // A mesh is told by its content, so it may have any name.
        Purpose::Open | Purpose::CompanionFile(CompanionFile::ReferenceShape | CompanionFile::LeftMesh) => {
            vec![("Meshes", extensions()), ("All files", vec!["*"])]
        }
        Purpose::Heights | Purpose::CompanionFile(CompanionFile::Matcap) => {
            vec![("Images", vec!["png", "jpg", "jpeg", "webp"])]
        }
        Purpose::CompanionFile(CompanionFile::LodShader | CompanionFile::SurfaceShader) => vec![("WGSL", vec!["wgsl"])],
        Purpose::CompanionFile(CompanionFile::Environment) => {
            vec![("Panoramas of light", ENVIRONMENT_EXTENSIONS.to_vec())]
        }
        Purpose::Write(Written::Chart) => {
            vec![("SVG picture", vec!["svg"]), ("PNG picture", vec!["png"]), ("CSV table", vec!["csv"])]
        }
        Purpose::Write(Written::Picture) => vec![("PNG picture", vec!["png"]), ("Report as a page", vec!["html"])],
        Purpose::Write(Written::Folder) => Vec::new(),
        Purpose::Write(Written::Gif) => vec![("Animated GIF", vec!["gif"])],
        Purpose::CompanionFile(CompanionFile::Factors) | Purpose::Write(Written::Factors) => {
            vec![("CSV table", vec!["csv"])]
        }
        Purpose::Write(Written::Adjacency) => vec![("JSON", vec!["json"]), ("Bare indices", vec!["bin"])],
        Purpose::Write(Written::Stats) => vec![("JSON", vec!["json"])],
        Purpose::Write(Written::Mesh) => vec![("glTF binary", vec!["glb"]), ("Wavefront OBJ", vec!["obj"])],
    }
}

/// The proposed name of a file to write, after that of the mesh; none of a file to read.
pub(super) fn proposed_name(purpose: Purpose, open: Option<&Source>) -> Option<String> {
    let Purpose::Write(written) = purpose else { return None };
    let title = open.map_or_else(|| "mesh".to_owned(), Source::title);
    let ending = match written {
        Written::Chart => return Some("chart.svg".to_owned()),
        Written::Picture => "-view.png",
        Written::Folder => "-turntable",
        Written::Gif => "-turntable.gif",
        Written::Factors => "-factors.csv",
        Written::Adjacency => "-adjacency.json",
        Written::Stats => "-stats.json",
        Written::Mesh => "-tessellated.glb",
    };
    Some(name_beside(&title, ending))
}

/// The path that the text field starts with. `folder` is where a file was written last.
pub(super) fn proposed(purpose: Purpose, open: Option<&Source>, folder: Option<&Path>) -> String {
    if let Some(name) = proposed_name(purpose, open) {
        return unused(folder.map_or_else(|| absolute(&name), |folder| folder.join(&name).display().to_string()));
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

/// The path of a name in the working folder.
pub(crate) fn absolute(name: &str) -> String {
    std::path::absolute(name).map_or_else(|_| name.to_owned(), |path| path.display().to_string())
}

/// The name of a file that is made from a mesh with this title: the title's ending is replaced by `ending`.
pub(crate) fn name_beside(title: &str, ending: &str) -> String {
    let stem = Path::new(title).file_stem().unwrap_or_default().to_string_lossy();
    // A shape's title has a colon, which some systems forbid in file names.
    stem.replace([':', '@', ' '], "-") + ending
}

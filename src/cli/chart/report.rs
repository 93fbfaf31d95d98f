//! `--report`: the folder that `pnaen chart` writes its page to, and what is charted if no mesh was named.

use std::path::Path;
use std::time::SystemTime;

use super::super::{CliError, write_text};
use geometry::mesh::Shape;
use geometry::numbers::utc;
use gpu::Gpu;
use inspect::shot::given;
use lab::chart::report::{Occasion, PAGE, Part, page};
use lab::chart::svg;
use load::Source;

/// Shapes with an exact surface each, round ones first.
const SHAPES: [Shape; 7] =
    [Shape::Icosphere, Shape::Ellipsoid, Shape::Torus, Shape::Cylinder, Shape::Cone, Shape::Saddle, Shape::Bicubic];

/// The project's own mesh, which is there if the command runs in the project's folder.
const VASE: &str = "assets/vase.glb";

/// What is charted if no mesh was named.
pub(super) fn usual() -> Vec<Source> {
    let vase = Path::new(VASE).is_file().then(|| Source::File(VASE.into()));
    SHAPES.into_iter().map(Source::Shape).chain(vase).collect()
}

/// Returns a file name for each mesh's picture, of letters, digits and hyphens; no name occurs twice.
pub(super) fn pictures(meshes: &[Source]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for mesh in meshes {
        let stem = match mesh {
            Source::File(path) => path.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
            shape => shape.to_string().trim_start_matches("shape:").to_owned(),
        };
        let sign = |letter: char| if letter.is_ascii_alphanumeric() { letter.to_ascii_lowercase() } else { '-' };
        let stem: String = stem.chars().map(sign).collect();
        let name = |k: usize| if k == 1 { format!("{stem}.svg") } else { format!("{stem}-{k}.svg") };
        let free = (1..).map(name).find(|name| !names.contains(name));
        names.extend(free);
    }
    names
}

/// Describes this run: adapter, driver, date and command line.
pub(super) fn occasion(gpu: &Gpu) -> Occasion {
    let info = &gpu.info;
    let driver = [info.driver.as_str(), info.driver_info.as_str()].into_iter().filter(|words| !words.is_empty());
    let driver: Vec<String> = driver.map(str::to_owned).chain([format!("{:?}", info.backend)]).collect();
    Occasion {
        adapter: info.name.clone(),
        driver: driver.join(", "),
        is_software: gpu.is_software(),
        date: utc(SystemTime::now()),
        command: given(std::env::args_os()),
    }
}

/// Writes the page and its pictures.
pub(super) fn write(folder: &Path, occasion: &Occasion, parts: &[Part]) -> Result<(), CliError> {
    for part in parts {
        write_text(&folder.join(&part.picture), &svg(std::slice::from_ref(&part.subject))?)?;
    }
    Ok(write_text(&folder.join(PAGE), &page(occasion, parts))?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_mesh_has_a_picture_of_its_own() {
        let source = |text: &str| text.parse::<Source>().expect("a source");
        let meshes = ["shape:torus", "shape:torus@2", "a/Low poly.glb", "b/low poly.gltf", "torus.glb"].map(source);
        assert_eq!(pictures(&meshes), ["torus.svg", "torus-2.svg", "low-poly.svg", "low-poly-2.svg", "torus-3.svg"]);
    }
}

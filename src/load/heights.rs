//! Height maps for displacement, from an image file or from the materials' base colour images.

mod reading;

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use image::ColorType;

use super::memory_budget::Budget;
use geometry::casts::to_u32;
use geometry::mesh::build_limits::MemoryRefused;
use geometry::mesh::heights::{HeightMap, Heights, MAX_KEPT, MAX_MAPS, bytes_beside_maps};
use geometry::mesh::{Mesh, Texture};
use geometry::names::shown_path;
use geometry::progress::{Cancelled, Progress};

use reading::{map_of_px, read_map};

/// The greatest width and height of an image that is read, in px.
const MAX_SIZE: u32 = 16384;

/// Why heights could not be loaded.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the messages say what the fields are")]
pub enum HeightError {
    /// The load was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The image can't be read.
    #[error("{} can't be read as a height image: {reason}", shown_path(path))]
    Image { path: PathBuf, reason: String },
    /// The image is wider or higher than is read.
    #[error(
        "{} has {} x {} px, but at most {MAX_SIZE} px a side are read; scale it to {MAX_KEPT} px a side or less",
        shown_path(path), size[0], size[1]
    )]
    TooLarge { path: PathBuf, size: [u32; 2] },
    /// The image would take too much memory.
    #[error(
        "{} has {} x {} px and {reason}; scale it to {MAX_KEPT} px a side or less, or save it as a PNG that isn't \
         interlaced",
        shown_path(path), size[0], size[1]
    )]
    TooMuch { path: PathBuf, size: [u32; 2], reason: String },
    /// No material has an image that can be read.
    #[error(
        "{name} has no image to displace by: no material has a base colour image that can be read{why}; name a height image"
    )]
    NoImage { name: String, why: String },
    /// The materials have more different images than can be used.
    #[error("{name} has {count} images to displace by, but at most {MAX_MAPS} can be used; name one height image")]
    TooMany { name: String, count: usize },
    /// The materials' images would take too much memory together.
    #[error("the heights of {name}'s {count} images {reason}; scale them down, or name one height image")]
    TooMuchOfMaterials { name: String, count: usize, reason: String },
}

/// The source of height maps. Its text form is `material`, or a path.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum HeightSource {
    /// The brightness of each material's base colour image.
    Materials,
    /// One image for all materials.
    File(PathBuf),
}

impl HeightSource {
    /// Loads heights for a mesh, within the memory that a load may take. Sets `progress` from 0 to 1. `warnings` are
    /// those of loading the mesh: if it has no image because a texture was left out, the error says why.
    ///
    /// # Errors
    /// [`HeightError`].
    pub fn load(
        &self,
        mesh: &Mesh,
        warnings: &[String],
        budget: &Budget,
        progress: &Progress,
    ) -> Result<Heights, HeightError> {
        progress.set(0.0);
        let heights = match self {
            Self::Materials => from_materials(mesh, warnings, budget, progress)?,
            Self::File(path) => from_file(path, mesh, budget, progress)?,
        };
        progress.set(1.0);
        Ok(heights)
    }

    /// Returns a name for the window: the file's name without its folder.
    pub fn title(&self) -> String {
        match self {
            Self::Materials => "Base colour brightness".to_owned(),
            Self::File(path) => path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned(),
        }
    }
}

impl From<OsString> for HeightSource {
    fn from(text: OsString) -> Self {
        if text == "material" { Self::Materials } else { Self::File(text.into()) }
    }
}

/// Loads a PNG, JPEG or WebP image as the height map of all materials.
fn from_file(path: &Path, mesh: &Mesh, budget: &Budget, progress: &Progress) -> Result<Heights, HeightError> {
    let map = read_map(path, bytes_beside_maps(mesh), budget, &progress.part(0.0, 0.8))?;
    Ok(Heights::all_over(mesh, map, &progress.part(0.8, 1.0))?)
}

/// Computes the brightness of every material's base colour image. Materials that share an image share its map.
///
/// # Errors
/// [`HeightError::NoImage`], [`HeightError::TooMany`] and [`HeightError::TooMuchOfMaterials`].
fn from_materials(
    mesh: &Mesh,
    warnings: &[String],
    budget: &Budget,
    progress: &Progress,
) -> Result<Heights, HeightError> {
    let mut known: Vec<&Texture> = Vec::new();
    let of_material = mesh.materials.iter().map(|material| {
        let texture = material.texture.as_deref()?;
        let index = known.iter().position(|&known| std::ptr::eq(known, texture)).unwrap_or_else(|| {
            known.push(texture);
            known.len() - 1
        });
        Some(to_u32(index))
    });
    let of_material = of_material.collect();
    let count = known.len();
    if count == 0 {
        let left_out = warnings.iter().find(|warning| warning.starts_with("the texture of "));
        let why = left_out.map_or(String::new(), |why| format!(" ({})", why.trim_end_matches('.')));
        return Err(HeightError::NoImage { name: mesh.name.clone(), why });
    }
    if count > MAX_MAPS {
        return Err(HeightError::TooMany { name: mesh.name.clone(), count });
    }
    let kept = known.iter().map(|texture| HeightMap::bytes_to_build(texture.size)).sum();
    let too_much = |refused: MemoryRefused| {
        let reason = refused.to_string();
        HeightError::TooMuchOfMaterials { name: mesh.name.clone(), count, reason }
    };
    budget.hold(bytes_beside_maps(mesh)).and_then(|()| budget.hold(kept)).map_err(too_much)?;
    let part = |index: usize| 0.7 * index as f32 / count as f32;
    let of = |(index, texture): (usize, &&Texture)| {
        let progress = progress.part(part(index), part(index + 1));
        map_of_px(texture.size, ColorType::Rgba8, &texture.rgba, &progress)
    };
    let maps = known.iter().enumerate().map(of).collect::<Result<_, _>>()?;
    let heights = Heights::new(mesh, maps, of_material, &progress.part(0.7, 1.0))?;
    Ok(Heights { are_of_colors: true, ..heights })
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::mesh::Shape;

    #[test]
    fn materials_that_share_an_image_share_a_map() {
        let mut mesh = Shape::Torus.build();
        assert!(matches!(
            from_materials(&mesh, &[], &Budget::unlimited(), &Progress::new()),
            Err(HeightError::NoImage { .. })
        ));
        let texture = std::sync::Arc::new(Texture { size: [1, 1], rgba: vec![255; 4] });
        let textured = geometry::mesh::Material { texture: Some(texture), ..mesh.materials[0].clone() };
        mesh.materials = vec![textured.clone(), mesh.materials[0].clone(), textured];
        let heights = from_materials(&mesh, &[], &Budget::unlimited(), &Progress::new()).expect("an image");
        assert_eq!((heights.maps.len(), heights.of_material), (1, vec![Some(0), None, Some(0)]));
    }

    #[test]
    fn a_file_that_is_not_an_image_is_refused() {
        let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml"));
        let error = from_file(path, &Mesh::default(), &Budget::unlimited(), &Progress::new())
            .expect_err("no image")
            .to_string();
        assert!(error.contains("Cargo.toml can't be read as a height image"), "{error}");
    }
}

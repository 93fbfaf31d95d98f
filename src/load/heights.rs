//! Height maps for displacement: those that a model's file gives its materials, image files, or the materials' base colour images.

mod reading;
mod texts;

use std::borrow::Cow;
use std::collections::HashMap;
use std::hash::Hash;
use std::path::{Path, PathBuf};

use image::ColorType;

use super::memory_budget::Budget;
use geometry::casts::to_u32;
use geometry::mesh::build_limits::{MemoryRefused, borrowing};
use geometry::mesh::heights::{HeightMap, Heights, MAX_KEPT, MAX_MAPS, bytes_beside_maps};
use geometry::mesh::{HeightAmount, Mesh, Texture};
use geometry::names::{shown, shown_path};
use geometry::progress::{Cancelled, Progress};

use reading::{map_of_bytes, map_of_px, read_map};

/// The greatest width and height of an image that is read, in px.
const MAX_SIZE: u32 = 16384;

/// How far an image may move the surface at most, in bounding radii.
const MOST_RADII: f32 = 100.0;

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
    /// An image is named for a material that isn't there.
    #[error("{name} has no material \"{material}\" to displace; it has {known}")]
    NoMaterial { name: String, material: String, known: String },
    /// An image would move the surface beyond reason.
    #[error(
        "the height image of material \"{material}\" moves it by up to {reach} object units, more than {MOST_RADII} bounding \
         radii; give it a smaller scale"
    )]
    TooFar { material: String, reach: f32 },
}

/// An image for the materials of one name, in place of what the model's file gives them.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedImage {
    /// The name of the materials.
    pub material: String,
    /// The image file.
    pub path: PathBuf,
    /// How far it moves the surface; none if the settings say so.
    pub amount: Option<HeightAmount>,
}

/// The source of height maps.
#[derive(Clone, Debug, PartialEq)]
pub enum HeightSource {
    /// The images that the model's file gives its materials, or the base colour images if it gives none.
    Model,
    /// The brightness of each material's base colour image.
    Materials,
    /// One image for all materials.
    File(PathBuf),
    /// An image for each of these materials. Others have what the model's file gives them.
    Each(Vec<NamedImage>),
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
            Self::Model | Self::Each(_) => match from_model(self.images(), mesh, budget, progress)? {
                Some(heights) => heights,
                None => from_materials(mesh, warnings, budget, progress)?,
            },
        };
        progress.set(1.0);
        Ok(heights)
    }

    fn images(&self) -> &[NamedImage] {
        if let Self::Each(images) = self { images } else { &[] }
    }

    /// Returns the image files.
    pub fn files(&self) -> Vec<&Path> {
        let own = if let Self::File(path) = self { Some(&**path) } else { None };
        own.into_iter().chain(self.images().iter().map(|image| &*image.path)).collect()
    }

    /// Makes the paths of its files absolute, so that they are valid in every folder.
    pub fn make_absolute(&mut self) {
        let paths: Vec<&mut PathBuf> = match self {
            Self::Model | Self::Materials => Vec::new(),
            Self::File(path) => vec![path],
            Self::Each(images) => images.iter_mut().map(|image| &mut image.path).collect(),
        };
        paths.into_iter().for_each(|path| *path = std::path::absolute(&*path).unwrap_or_else(|_| path.clone()));
    }

    /// Returns a name for the window: the file's name without its folder.
    pub fn title(&self) -> String {
        match self {
            Self::Model => "As the file says".to_owned(),
            Self::Each(images) => {
                images.iter().map(|image| format!("Of {}", image.material)).collect::<Vec<_>>().join(", ")
            }
            Self::Materials => "Base colour brightness".to_owned(),
            Self::File(path) => path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned(),
        }
    }
}

/// Loads the images that a model's file gives its materials, and these in place of some. None if there are none.
///
/// # Errors
/// [`HeightError`].
pub fn from_model(
    images: &[NamedImage],
    mesh: &Mesh,
    budget: &Budget,
    progress: &Progress,
) -> Result<Option<Heights>, HeightError> {
    let name = || mesh.name.clone();
    let mut own: Vec<_> = mesh.materials.iter().map(|material| material.height.clone()).collect();
    let part = |index: usize| 0.7 * index as f32 / images.len() as f32;
    for (index, NamedImage { material, path, amount }) in images.iter().enumerate() {
        if mesh.materials.iter().all(|known| known.name != *material) {
            let known = mesh.materials.iter().map(|known| format!("\"{}\"", shown(&known.name)));
            let known = known.collect::<Vec<_>>().join(", ");
            return Err(HeightError::NoMaterial { name: name(), material: shown(material), known });
        }
        let map = read_map(path, 0, budget, &progress.part(part(index), part(index + 1)))?.with_amount(*amount);
        let users = mesh.materials.iter().zip(&mut own).filter(|(known, _)| known.name == *material);
        users.for_each(|(_, own)| *own = Some(map.clone()));
    }
    let count = own.iter().flatten().count();
    if count == 0 {
        return Ok(None);
    }
    let most = MOST_RADII * mesh.bounds().radius();
    for (material, map) in mesh.materials.iter().zip(&own).filter_map(|(material, map)| Some((material, map.as_ref()?)))
    {
        // What the settings say is bounded by themselves.
        let reach = map.reach(HeightAmount { scale: 0.0, midlevel: 0.0 });
        if reach > most {
            return Err(HeightError::TooFar { material: shown(&material.name), reach });
        }
    }
    let too_much =
        |refused: MemoryRefused| HeightError::TooMuchOfMaterials { name: name(), count, reason: refused.to_string() };
    budget.hold(bytes_beside_maps(mesh)).map_err(too_much)?;
    match Heights::of_materials(mesh, &own, &progress.part(0.7, 1.0))? {
        Some(heights) if heights.maps.len() > MAX_MAPS => {
            Err(HeightError::TooMany { name: name(), count: heights.maps.len() })
        }
        heights => Ok(heights),
    }
}

/// The height images that a model's file names, each read once; `K` tells them apart.
pub(super) struct ModelImages<K>(HashMap<K, Option<HeightMap>>);

impl<K: Eq + Hash> ModelImages<K> {
    pub(super) fn new() -> Self {
        Self(HashMap::new())
    }

    /// Returns an image of a material. One that can't be read causes a warning once, which names the material. `reserved` is the memory
    /// that the rest of the load takes, in bytes.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub(super) fn read<'b>(
        &mut self,
        key: K,
        (image, material): (&str, &str),
        bytes: impl FnOnce() -> Result<Cow<'b, [u8]>, String>,
        (reserved, budget, progress): (u64, &Budget, &Progress),
        warn: impl FnOnce(String),
    ) -> Result<Option<HeightMap>, Cancelled> {
        if let Some(known) = self.0.get(&key) {
            return Ok(known.clone());
        }
        let decode = |bytes: Cow<[u8]>| map_of_bytes(Path::new(image), &bytes, reserved, budget, progress);
        let read = borrowing(budget, || bytes().map(decode));
        let reason = match read {
            Ok(Err(HeightError::Cancelled(cancelled))) => return Err(cancelled),
            Ok(Ok(map)) => {
                budget.release(reserved);
                self.0.insert(key, Some(map.clone()));
                return Ok(Some(map));
            }
            Ok(Err(error)) => error.to_string(),
            Err(reason) => reason,
        };
        warn(format!("the height image {image} of material \"{material}\" is left out: {reason}."));
        self.0.insert(key, None);
        Ok(None)
    }
}

/// Loads an image as the height map of all materials.
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
    fn materials_have_the_files_images_or_those_that_are_named() {
        let mut mesh = Shape::Torus.build();
        let map = HeightMap::new([2, 2], vec![0.5; 4]).with_amount(HeightAmount::from_factor(0.1, 0.0));
        let named = |name: &str, height| geometry::mesh::Material {
            name: name.to_owned(),
            height,
            ..mesh.materials[0].clone()
        };
        mesh.materials = vec![named("wall", Some(map.clone())), named("roof", None), named("door", None)];
        let of = |images: &[NamedImage], mesh: &Mesh| {
            from_model(images, mesh, &Budget::unlimited(), &Progress::new()).map_err(|error| error.to_string())
        };
        let heights = of(&[], &mesh).expect("an image").expect("an image");
        assert_eq!((heights.maps[0].amount, &heights.of_material[..]), (map.amount, &[Some(0), None, None][..]));
        let path = assets::path("waves.png");
        let image = |material: &str| NamedImage { material: material.to_owned(), path: path.clone(), amount: None };
        let heights = of(&[image("roof")], &mesh).expect("two images").expect("two images");
        assert_eq!(heights.of_material, [Some(0), Some(1), None]);
        assert!(heights.follow_settings() && heights.maps[0].size == [2, 2]);
        let heights = of(&[image("wall")], &mesh).expect("an image").expect("an image");
        assert_eq!((heights.of_material, heights.maps[0].amount), (vec![Some(0), None, None], None));
        let said = of(&[image("floor")], &mesh).expect_err("no such material");
        assert!(said.ends_with("has no material \"floor\" to displace; it has \"wall\", \"roof\", \"door\""), "{said}");
        mesh.materials[0].height = Some(map.with_amount(HeightAmount::from_factor(1e9, 0.0)));
        let said = of(&[], &mesh).expect_err("too far");
        assert!(
            said.contains("material \"wall\" moves it by up to 500000000 object units, more than 100 bounding"),
            "{said}"
        );
        mesh.materials[0].height = None;
        assert_eq!(of(&[], &mesh), Ok(None));
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

//! Height images, for displacement: each a pyramid of ever smaller ones, so that what is sampled fits what is drawn.

mod pyramid;
mod reading;

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use glam::Vec2;
use image::ColorType;

use super::budget::Budget;
use super::progress::{Cancelled, Progress};
use super::{Mesh, Texture};
use crate::names::shown_path;

/// The largest width and height of an image that is read, in px.
const MAX_SIZE: u32 = 16384;

/// The largest width and height that is kept, in px: larger images are made smaller first.
pub const MAX_KEPT: u32 = 4096;

/// Levels that a map has at most: 4096 px halved down to 1.
pub const MAX_LEVELS: usize = 13;

/// Maps that a mesh has at most: as many as the shaders have room for.
pub const MAX_MAPS: usize = 256;

/// Why an image is no height map.
#[derive(Debug, thiserror::Error)]
pub enum HeightError {
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    #[error("{} can't be read as a height image: {reason}", shown_path(path))]
    Image { path: PathBuf, reason: String },
    #[error(
        "{} is {} x {} px large, and at most {MAX_SIZE} px a side are read; scale it to {MAX_KEPT} px a side or less",
        shown_path(path), size[0], size[1]
    )]
    TooLarge { path: PathBuf, size: [u32; 2] },
    #[error(
        "{} is {} x {} px large and {reason}; scale it to {MAX_KEPT} px a side or less, or save it as a PNG that isn't \
         interlaced",
        shown_path(path), size[0], size[1]
    )]
    TooMuch { path: PathBuf, size: [u32; 2], reason: String },
    #[error(
        "{name} has no image to displace by: no material has a base colour image that can be read{why}; name a height image"
    )]
    NoImage { name: String, why: String },
    #[error("{name} has {count} images to displace by, and at most {MAX_MAPS} are taken; name one height image")]
    TooMany { name: String, count: usize },
    #[error("heights of {name}'s {count} images {reason}; scale them down, or name one height image")]
    TooMuchOfMaterials { name: String, count: usize, reason: String },
}

/// Where height images come from. As text: `material`, or a path.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum HeightSource {
    /// The brightness of each material's base colour image.
    Materials,
    /// One image over all materials.
    File(PathBuf),
}

impl HeightSource {
    /// Reads heights for a mesh, within what a load may take; `progress` goes from 0 to 1 meanwhile.
    ///
    /// # Errors
    /// [`HeightError`].
    pub fn load(&self, mesh: &Mesh, budget: &Budget, progress: &Progress) -> Result<Heights, HeightError> {
        progress.set(0.0);
        let heights = match self {
            Self::Materials => Heights::of_materials(mesh, budget, progress)?,
            Self::File(path) => Heights::read(path, mesh, budget, progress)?,
        };
        progress.set(1.0);
        Ok(heights)
    }

    /// A name for the window: the file's without its folder.
    pub fn title(&self) -> String {
        match self {
            Self::Materials => "Material".to_owned(),
            Self::File(path) => path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned(),
        }
    }
}

impl From<OsString> for HeightSource {
    fn from(text: OsString) -> Self {
        if text == "material" { Self::Materials } else { Self::File(text.into()) }
    }
}

/// One image's heights, 0 (black) to 1 (white), level after level; each level half as wide and high as the one before, down
/// to a single px.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightMap {
    /// Width and height of level 0, in px.
    pub size: [u32; 2],
    pub levels: u32,
    /// Whether it starts again where it ends: some texture coordinate goes beyond 0 to 1. Else its border goes on.
    pub repeats: bool,
    /// Rows from the top, level after level.
    pub heights: Vec<f32>,
}

/// What a mesh is displaced by.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Heights {
    pub maps: Vec<HeightMap>,
    /// The map of each of the mesh's materials; none for what stays where it is.
    pub of_material: Vec<Option<u32>>,
    /// The least and the greatest height in any map.
    pub range: [f32; 2],
    /// The mesh's bounding radius before anything moves it, in object units: heights are measured in it.
    pub radius: f32,
    /// The sum of the angles, in radians, that triangles have at each of the mesh's corners, before anything moves them.
    pub angles: Vec<f32>,
    /// How far level l of each map, linearly interpolated, is from its level 0 at most; no less for a coarser level.
    pub detail: Vec<[f32; MAX_LEVELS]>,
}

impl HeightMap {
    /// Width and height of a level, in px.
    pub fn level_size(&self, level: u32) -> [u32; 2] {
        self.size.map(|side| (side >> level).max(1))
    }
}

impl Heights {
    /// One map for all of a mesh's materials.
    pub fn everywhere(mesh: &Mesh, map: HeightMap) -> Self {
        // It fails only when it is cancelled, and this progress is nobody else's.
        Self::all_over(mesh, map, &Progress::new()).expect("nobody cancels")
    }

    fn all_over(mesh: &Mesh, map: HeightMap, progress: &Progress) -> Result<Self, Cancelled> {
        Self::new(mesh, vec![map], vec![Some(0); mesh.materials.len()], progress)
    }

    /// Reads a PNG or JPEG image and lays it over all materials.
    fn read(path: &Path, mesh: &Mesh, budget: &Budget, progress: &Progress) -> Result<Self, HeightError> {
        let map = HeightMap::read(path, mesh.corners.len(), budget, &progress.part(0.0, 0.8))?;
        Ok(Self::all_over(mesh, map, &progress.part(0.8, 1.0))?)
    }

    /// The brightness of every material's base colour image, each image once.
    ///
    /// # Errors
    /// [`HeightError::NoImage`], [`HeightError::TooMany`] and [`HeightError::TooMuchOfMaterials`].
    pub fn of_materials(mesh: &Mesh, budget: &Budget, progress: &Progress) -> Result<Self, HeightError> {
        let mut known: Vec<&Texture> = Vec::new();
        let of_material = mesh.materials.iter().map(|material| {
            let texture = material.texture.as_deref()?;
            let index = known.iter().position(|&known| std::ptr::eq(known, texture)).unwrap_or_else(|| {
                known.push(texture);
                known.len() - 1
            });
            Some(index as u32)
        });
        let of_material = of_material.collect();
        let count = known.len();
        if count == 0 {
            let left_out = mesh.warnings.iter().find(|warning| warning.starts_with("the texture of "));
            let why = left_out.map_or(String::new(), |why| format!(" ({})", why.trim_end_matches('.')));
            return Err(HeightError::NoImage { name: mesh.name.clone(), why });
        }
        if count > MAX_MAPS {
            return Err(HeightError::TooMany { name: mesh.name.clone(), count });
        }
        let kept = known.iter().map(|texture| HeightMap::bytes_to_build(texture.size)).sum();
        let too_much = |reason| HeightError::TooMuchOfMaterials { name: mesh.name.clone(), count, reason };
        budget.hold(angle_bytes(mesh.corners.len())).and_then(|()| budget.hold(kept)).map_err(too_much)?;
        let part = |index: usize| 0.7 * index as f32 / count as f32;
        let of = |(index, texture): (usize, &&Texture)| {
            let progress = progress.part(part(index), part(index + 1));
            HeightMap::of_px(texture.size, ColorType::Rgba8, &texture.rgba, &progress)
        };
        let maps = known.iter().enumerate().map(of).collect::<Result<_, _>>()?;
        Ok(Self::new(mesh, maps, of_material, &progress.part(0.7, 1.0))?)
    }

    fn new(
        mesh: &Mesh,
        mut maps: Vec<HeightMap>,
        of_material: Vec<Option<u32>>,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        for (material, map) in mesh.materials.iter().zip(&of_material) {
            let triangles = &mesh.triangles[material.triangles.start as usize..material.triangles.end as usize];
            let uvs = triangles.iter().flatten().map(|&corner| mesh.corners[corner as usize].uv);
            let beyond = |uv: Vec2| uv.cmplt(Vec2::ZERO).any() || uv.cmpgt(Vec2::ONE).any();
            if let Some(map) = map.and_then(|map| maps.get_mut(map as usize)) {
                map.repeats |= uvs.clone().any(beyond);
            }
        }
        let mut range = [f32::INFINITY, f32::NEG_INFINITY];
        for map in &maps {
            let [width, height] = map.size;
            for &own in &map.heights[..(width * height) as usize] {
                range = [range[0].min(own), range[1].max(own)];
            }
        }
        let part = |index: usize| index as f32 / maps.len() as f32;
        let lost = |(index, map): (usize, &HeightMap)| map.detail(&progress.part(part(index), part(index + 1)));
        let detail = maps.iter().enumerate().map(lost).collect::<Result<_, _>>()?;
        Ok(Self { maps, of_material, range, radius: mesh.bounds().radius(), angles: angles(mesh), detail })
    }

    /// What of a mesh these heights tell nothing of, in a sentence: triangles whose corners all have one texture coordinate.
    pub fn warning(&self, mesh: &Mesh) -> Option<String> {
        let mut count = 0;
        for (material, _) in mesh.materials.iter().zip(&self.of_material).filter(|(_, map)| map.is_some()) {
            let triangles = &mesh.triangles[material.triangles.start as usize..material.triangles.end as usize];
            let is_point = |triangle: &&[u32; 3]| {
                let [a, b, c] = triangle.map(|corner| mesh.corners[corner as usize].uv);
                a == b && b == c
            };
            count += triangles.iter().filter(is_point).count();
        }
        (count > 0).then(|| format!("triangles without texture coordinates, which heights move as a whole: {count}."))
    }

    /// How far anything is moved at most, in units of the scale.
    pub fn reach(&self, midlevel: f32) -> f32 {
        (self.range[0] - midlevel).abs().max((self.range[1] - midlevel).abs())
    }

    /// Bytes of all maps.
    pub fn bytes(&self) -> u64 {
        self.maps.iter().map(|map| size_of_val(&map.heights[..]) as u64).sum()
    }
}

/// What [`Heights::angles`] takes, in bytes.
fn angle_bytes(corners: usize) -> u64 {
    4 * corners as u64
}

fn angles(mesh: &Mesh) -> Vec<f32> {
    let mut angles = vec![0.0; mesh.corners.len()];
    for triangle in mesh.triangles.iter() {
        let at = triangle.map(|corner| mesh.corners[corner as usize].position.as_dvec3());
        for k in 0..3 {
            let [a, b] = [1, 2].map(|step| (at[(k + step) % 3] - at[k]).normalize_or_zero());
            angles[triangle[k] as usize] += a.cross(b).length().atan2(a.dot(b)) as f32;
        }
    }
    angles
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Shape;

    #[test]
    fn detail_is_lost_level_by_level() {
        // A checkerboard is gone at once, a slope not at all inside.
        let board = HeightMap::new([8, 8], (0..64).map(|i| ((i + i / 8) % 2) as f32).collect());
        let heights = Heights::everywhere(&Shape::Torus.build(), board);
        let detail = heights.detail[0];
        assert_eq!((detail[0], heights.range), (0.0, [0.0, 1.0]));
        assert!(detail[1] > 0.4 && detail[12] >= detail[3]);
        assert_eq!(heights.reach(0.25), 0.75);
        let flat = Heights::everywhere(&Shape::Torus.build(), HeightMap::new([8, 8], vec![0.5; 64]));
        assert!(flat.detail[0].iter().all(|&lost| lost < 1e-6), "{:?}", flat.detail);
    }

    #[test]
    fn materials_that_share_an_image_share_a_map() {
        let mut mesh = Shape::Torus.build();
        assert!(matches!(
            Heights::of_materials(&mesh, &Budget::endless(), &Progress::new()),
            Err(HeightError::NoImage { .. })
        ));
        let texture = std::sync::Arc::new(Texture { size: [1, 1], rgba: vec![255; 4] });
        let textured = crate::mesh::Material { texture: Some(texture), ..mesh.materials[0].clone() };
        mesh.materials = vec![textured.clone(), mesh.materials[0].clone(), textured];
        let heights = Heights::of_materials(&mesh, &Budget::endless(), &Progress::new()).expect("an image");
        assert_eq!((heights.maps.len(), heights.of_material), (1, vec![Some(0), None, Some(0)]));
    }

    #[test]
    fn triangles_without_texture_coordinates_are_counted() {
        let map = || HeightMap::new([1, 1], vec![0.5]);
        let [with, without] = [Shape::Torus, Shape::Icosphere].map(Shape::build);
        assert_eq!(Heights::everywhere(&with, map()).warning(&with), None);
        let warning = Heights::everywhere(&without, map()).warning(&without).expect("80 triangles");
        assert!(warning.ends_with("as a whole: 80."), "{warning}");
    }

    #[test]
    fn a_file_that_is_no_image_is_a_sentence() {
        let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml"));
        let error = Heights::read(path, &Mesh::default(), &Budget::endless(), &Progress::new())
            .expect_err("no image")
            .to_string();
        assert!(error.contains("Cargo.toml can't be read as a height image"), "{error}");
    }
}

//! Height images, for displacement: each a pyramid of ever smaller ones, so that what is sampled fits what is drawn.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use glam::Vec2;
use image::imageops::{self, FilterType};
use image::{DynamicImage, ImageBuffer, ImageError, ImageReader, Limits, Luma};

use super::{Mesh, Texture};

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
    #[error("{} can't be read as a height image: {reason}", path.display())]
    Image { path: PathBuf, reason: String },
    #[error(
        "{name} has no image to displace by: no material has a base colour image that can be read; name a height image"
    )]
    NoImage { name: String },
    #[error("{name} has {count} images to displace by, and at most {MAX_MAPS} are taken; name one height image")]
    TooMany { name: String, count: usize },
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
    /// Reads heights for a mesh.
    ///
    /// # Errors
    /// [`HeightError`].
    pub fn load(&self, mesh: &Mesh) -> Result<Heights, HeightError> {
        match self {
            Self::Materials => Heights::of_materials(mesh),
            Self::File(path) => Heights::read(path, mesh),
        }
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
    /// Of rows from the top. Sides of more than 4,096 px are made smaller first.
    pub fn new(size: [u32; 2], heights: Vec<f32>) -> Self {
        let [width, height] = size;
        let base: Level = ImageBuffer::from_raw(width, height, heights)
            .filter(|base| base.width() > 0 && base.height() > 0)
            .unwrap_or_else(|| ImageBuffer::from_pixel(1, 1, Luma([0.0])));
        let fitted = [base.width(), base.height()].map(|side| side.min(MAX_KEPT));
        let mut level = if fitted == [base.width(), base.height()] { base } else { resized(&base, fitted) };
        let mut all = level.as_raw().clone();
        let mut levels = 1;
        while level.width() > 1 || level.height() > 1 {
            level = resized(&level, [level.width(), level.height()].map(|side| (side / 2).max(1)));
            all.extend_from_slice(level.as_raw());
            levels += 1;
        }
        Self { size: fitted, levels, repeats: false, heights: all }
    }

    /// The brightness of an image's px as they are stored: the weights of Rec. 709, and no transfer function, since heights
    /// are no light. Gray images give their gray, in all its bits.
    pub fn from_image(image: &DynamicImage) -> Self {
        let size = [image.width(), image.height()];
        let gray = match image {
            DynamicImage::ImageLuma8(_) | DynamicImage::ImageLuma16(_) => image.to_luma32f().into_raw(),
            _ => image.to_rgb32f().pixels().map(|px| brightness(px.0)).collect(),
        };
        Self::new(size, gray)
    }

    fn from_texture(texture: &Texture) -> Self {
        let gray = |px: &[u8]| brightness([px[0], px[1], px[2]].map(|x| f32::from(x) / 255.0));
        Self::new(texture.size, texture.rgba.chunks_exact(4).map(gray).collect())
    }

    /// Width and height of a level, in px.
    pub fn level_size(&self, level: u32) -> [u32; 2] {
        self.size.map(|side| (side >> level).max(1))
    }
}

type Level = ImageBuffer<Luma<f32>, Vec<f32>>;

fn resized(level: &Level, [width, height]: [u32; 2]) -> Level {
    imageops::resize(level, width, height, FilterType::Triangle)
}

fn brightness([r, g, b]: [f32; 3]) -> f32 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

impl Heights {
    /// One map for all of a mesh's materials.
    pub fn everywhere(mesh: &Mesh, map: HeightMap) -> Self {
        Self::new(mesh, vec![map], vec![Some(0); mesh.materials.len()])
    }

    /// Reads a PNG or JPEG image and lays it over all materials.
    ///
    /// # Errors
    /// [`HeightError::Image`].
    pub fn read(path: &Path, mesh: &Mesh) -> Result<Self, HeightError> {
        let fail = |reason: String| HeightError::Image { path: path.to_owned(), reason };
        let reader = ImageReader::open(path).and_then(ImageReader::with_guessed_format);
        let mut reader = reader.map_err(|error| fail(error.to_string()))?;
        let mut limits = Limits::default();
        (limits.max_image_width, limits.max_image_height) = (Some(MAX_SIZE), Some(MAX_SIZE));
        reader.limits(limits);
        let image = reader.decode().map_err(|error| match error {
            ImageError::Unsupported(_) => fail("choose a PNG or JPEG image".to_owned()),
            error => fail(error.to_string()),
        })?;
        Ok(Self::everywhere(mesh, HeightMap::from_image(&image)))
    }

    /// The brightness of every material's base colour image, each image once.
    ///
    /// # Errors
    /// [`HeightError::NoImage`].
    pub fn of_materials(mesh: &Mesh) -> Result<Self, HeightError> {
        let mut known: Vec<*const Texture> = Vec::new();
        let mut maps = Vec::new();
        let of_material = mesh.materials.iter().map(|material| {
            let texture = material.texture.as_ref()?;
            let key = std::sync::Arc::as_ptr(texture);
            let index = known.iter().position(|&known| known == key).unwrap_or_else(|| {
                known.push(key);
                maps.push(HeightMap::from_texture(texture));
                maps.len() - 1
            });
            Some(index as u32)
        });
        let of_material = of_material.collect();
        if maps.is_empty() {
            return Err(HeightError::NoImage { name: mesh.name.clone() });
        }
        if maps.len() > MAX_MAPS {
            return Err(HeightError::TooMany { name: mesh.name.clone(), count: maps.len() });
        }
        Ok(Self::new(mesh, maps, of_material))
    }

    fn new(mesh: &Mesh, mut maps: Vec<HeightMap>, of_material: Vec<Option<u32>>) -> Self {
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
        let detail = maps.iter().map(map_detail).collect();
        Self { maps, of_material, range, radius: mesh.bounds().radius(), angles: angles(mesh), detail }
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

fn angles(mesh: &Mesh) -> Vec<f32> {
    let mut angles = vec![0.0; mesh.corners.len()];
    for triangle in &mesh.triangles {
        let at = triangle.map(|corner| mesh.corners[corner as usize].position.as_dvec3());
        for k in 0..3 {
            let [a, b] = [1, 2].map(|step| (at[(k + step) % 3] - at[k]).normalize_or_zero());
            angles[triangle[k] as usize] += a.cross(b).length().atan2(a.dot(b)) as f32;
        }
    }
    angles
}

/// What each level of a map loses.
fn map_detail(map: &HeightMap) -> [f32; MAX_LEVELS] {
    // Beyond the last level nothing more is lost than there.
    let lost = |level: usize| lost_detail(map, (level as u32).min(map.levels - 1));
    let mut detail = [0.0_f32; MAX_LEVELS];
    std::thread::scope(|scope| {
        let run = |level| scope.spawn(move || lost(level));
        let levels: Vec<_> = (0..MAX_LEVELS).map(run).collect();
        for (detail, lost) in detail.iter_mut().zip(levels) {
            *detail = lost.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        }
    });
    for level in 1..MAX_LEVELS {
        detail[level] = detail[level].max(detail[level - 1]);
    }
    detail
}

/// The largest difference between px of level 0 and level `level` interpolated there. Where interpolation goes over a
/// repeating image's border it says nothing: many don't quite meet there.
fn lost_detail(map: &HeightMap, level: u32) -> f32 {
    let [width, height] = map.size.map(|side| side as usize);
    let [across, down] = map.level_size(level).map(|side| side as usize);
    let start = (0..level).map(|l| map.level_size(l)).map(|[x, y]| (x * y) as usize).sum::<usize>();
    let (columns, rows) = (places(width, across, map.repeats), places(height, down, map.repeats));
    let own = &map.heights[start..start + across * down];
    let mut lost = 0.0_f32;
    for (y, row) in rows.iter().enumerate() {
        let Some((upper, lower, below)) = *row else { continue };
        for (x, column) in columns.iter().enumerate() {
            let Some((left, right, beside)) = *column else { continue };
            let line = |row: usize| {
                let (a, b) = (own[row * across + left], own[row * across + right]);
                a + (b - a) * beside
            };
            let (above, under) = (line(upper), line(lower));
            lost = lost.max((map.heights[y * width + x] - (above + (under - above) * below)).abs());
        }
    }
    lost
}

/// For each of `count` px of level 0 along one side, between which two of a level's `own` it lies, and how far from the
/// first; none beyond the last of a repeating one.
fn places(count: usize, own: usize, repeats: bool) -> Vec<Option<(usize, usize, f32)>> {
    let place = |i: usize| {
        let at = (i as f32 + 0.5) / count as f32 * own as f32 - 0.5;
        let inside = at.clamp(0.0, (own - 1) as f32);
        let first = inside as usize;
        (!repeats || at == inside).then(|| (first, (first + 1).min(own - 1), inside - first as f32))
    };
    (0..count).map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Shape;

    #[test]
    fn levels_halve_down_to_one_pixel() {
        let map = HeightMap::new([5, 2], (0..10).map(|i| i as f32 / 9.0).collect());
        assert_eq!((map.size, map.levels), ([5, 2], 3));
        assert_eq!([0, 1, 2].map(|level| map.level_size(level)), [[5, 2], [2, 1], [1, 1]]);
        assert_eq!(map.heights.len(), 10 + 2 + 1);
        // The last is about the mean.
        assert!((map.heights[12] - 0.5).abs() < 0.1, "{}", map.heights[12]);
    }

    #[test]
    fn what_is_no_image_is_one_black_pixel() {
        for bad in [HeightMap::new([0, 0], Vec::new()), HeightMap::new([3, 3], vec![1.0; 4])] {
            assert_eq!((bad.size, bad.heights.as_slice()), ([1, 1], &[0.0][..]));
        }
    }

    #[test]
    fn gray_images_keep_sixteen_bits_and_colours_become_brightness() {
        let gray: ImageBuffer<Luma<u16>, _> = ImageBuffer::from_raw(2, 1, vec![1_u16, 65535]).expect("two px");
        let map = HeightMap::from_image(&gray.into());
        assert_eq!(map.heights[..2], [1.0 / 65535.0, 1.0]);
        let green = image::RgbImage::from_pixel(1, 1, image::Rgb([0, 255, 0]));
        assert_eq!(HeightMap::from_image(&green.into()).heights, [0.7152]);
    }

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
        assert!(matches!(Heights::of_materials(&mesh), Err(HeightError::NoImage { .. })));
        let texture = std::sync::Arc::new(Texture { size: [1, 1], rgba: vec![255; 4] });
        let textured = crate::mesh::Material { texture: Some(texture), ..mesh.materials[0].clone() };
        mesh.materials = vec![textured.clone(), mesh.materials[0].clone(), textured];
        let heights = Heights::of_materials(&mesh).expect("an image");
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
        let error = Heights::read(path, &Mesh::default()).expect_err("no image").to_string();
        assert!(error.contains("Cargo.toml can't be read as a height image"), "{error}");
    }
}

//! Height maps for displacement: those that a model's file gives its materials, image files for all or for parts of it, or the
//! base colour images.

mod reading;
mod texts;

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::hash::Hash;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::memory_budget::Budget;
use super::notes::Notes;
use super::parts::{Part, closeness};
use super::selection::{MATERIAL, choice, is_material, is_part_of};
use super::uri::Files;
use super::warnings::untextured_warning;
use geometry::mesh::build_limits::{MemoryRefused, borrowing};
use geometry::mesh::heights::{HeightMap, Heights, MAX_MAPS, MOST_BYTES, bytes_beside_maps, bytes_of_maps};
use geometry::mesh::{HeightAmount, Material, Mesh, Wrap};
use geometry::names::{shown, shown_path};
use geometry::progress::{Cancelled, Progress};

use reading::{ImageFile, map_of_px, read_map};

/// Why heights could not be loaded.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the messages say what the fields are")]
pub enum HeightError {
    /// The load was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The image can't be read, or is too large.
    #[error("{} can't be read as a height image: {reason}", shown_path(path))]
    Image { path: PathBuf, reason: String },
    /// No material has an image that can be read.
    #[error("{name} has no image to displace by: {why}; name a height image")]
    NoImage { name: String, why: String },
    /// The materials have more different images than can be used.
    #[error("{name} has more than {MAX_MAPS} images to displace by, the most that are used; name one height image")]
    TooMany { name: String },
    /// The materials' images would take too much memory together.
    #[error("the heights of {name}'s {count} images {reason}; scale them down, or name one height image")]
    TooMuchOfMaterials { name: String, count: usize, reason: String },
    /// An image is named for a material or a part that isn't there.
    #[error("{name} has no material \"{part}\" to displace, and no such part; {known}")]
    NoPart { name: String, part: String, known: String },
}

/// An image for the materials or the parts of one name, in place of what the model's file gives them.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedImage {
    /// The name of materials; if none has it, that of parts and groups as [`is_part_of`] takes it, or of materials after
    /// [`MATERIAL`].
    pub part: String,
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
    /// An image for each of these materials and parts. Others have what the model's file gives them.
    Each(Vec<NamedImage>),
}

impl HeightSource {
    /// Loads heights for a mesh, whose file has these parts, within the memory that a load may take. Sets `progress` from 0 to 1.
    /// `warnings` are those of loading the mesh: if it has no image because a texture was left out, the error says why. What is
    /// scaled down is added.
    ///
    /// # Errors
    /// [`HeightError`].
    pub fn load(
        &self,
        mesh: &Mesh,
        parts: &[Part],
        warnings: &mut Vec<String>,
        budget: &Budget,
        progress: &Progress,
    ) -> Result<Heights, HeightError> {
        progress.set(0.0);
        let images = progress.part(0.0, 0.7);
        let own = match self {
            Self::Materials => Vec::new(),
            Self::File(path) => vec![Some(read_map(path, budget, &images)?); mesh.materials.len()],
            Self::Model | Self::Each(_) => of_model(self.images(), mesh, parts, warnings, budget, &images)?,
        };
        // Images of hidden things alone displace nothing.
        let are_of_colors = self.images().is_empty() && own.iter().all(Option::is_none);
        let mut own = if are_of_colors { of_colors(mesh, warnings, budget, &images)? } else { own };
        warnings.extend(fit(mesh, parts, &mut own, budget, progress)?.into_warnings());
        let held = budget.hold(bytes_beside_maps(mesh));
        held.map_err(|refused| too_much(mesh, own.iter().flatten().count(), refused))?;
        let heights = Heights::of_materials(mesh, &own, &progress.part(0.7, 1.0))?;
        let heights = heights.ok_or_else(|| HeightError::TooMany { name: mesh.name.clone() })?;
        progress.set(1.0);
        Ok(Heights { are_of_colors, ..heights })
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
            Self::Each(_) => "Images of parts".to_owned(),
            Self::Materials => "Base colour brightness".to_owned(),
            Self::File(path) => path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned(),
        }
    }
}

/// Loads the heights of a source; without one those that the model's file gives its materials, in which a flaw costs a warning.
///
/// # Errors
/// [`HeightError`].
pub fn load_heights(
    source: Option<&HeightSource>,
    mesh: &Mesh,
    parts: &[Part],
    warnings: &mut Vec<String>,
    budget: &Budget,
    progress: &Progress,
) -> Result<Option<Heights>, HeightError> {
    if source.is_none() && mesh.materials.iter().all(|material| material.height.is_none()) {
        return Ok(None);
    }
    match source.unwrap_or(&HeightSource::Model).load(mesh, parts, warnings, budget, progress) {
        Err(error) if source.is_none() && !matches!(error, HeightError::Cancelled(_)) => {
            warnings.push(format!("its height images are left out: {error}."));
            Ok(None)
        }
        heights => {
            let heights = heights?;
            warnings.extend(untextured_warning(&heights, mesh));
            Ok(Some(heights))
        }
    }
}

/// The maps of materials, then those of parts: those that the model's file gives them, or these in place of some. Images that
/// mean only hidden things are left out.
fn of_model(
    images: &[NamedImage],
    mesh: &Mesh,
    parts: &[Part],
    warnings: &mut Vec<String>,
    budget: &Budget,
    progress: &Progress,
) -> Result<Vec<Option<HeightMap>>, HeightError> {
    let of_materials = mesh.materials.iter().map(|material| ([MATERIAL, &material.name].concat(), false));
    // Parts that are materials come last, also hidden ones, which the mesh lacks. Those of hidden parts aren't known.
    let all: Vec<_> = of_materials.chain(parts.iter().map(|part| (part.name.clone(), part.is_hidden))).collect();
    let parts = &parts[..parts.partition_point(|part| !is_material(&part.name))];
    let is_meant = |name: &str| all.iter().any(|(path, _)| is_part_of(path, name));
    let fraction = |index: usize| index as f32 / images.len() as f32;
    let mut known: HashMap<&Path, HeightMap> = HashMap::new();
    let mut maps = Vec::new();
    for (index, NamedImage { part, path, amount }) in images.iter().enumerate() {
        let of_materials = format!("{MATERIAL}{part}/.");
        let name = if is_meant(&of_materials) { of_materials } else { part.clone() };
        if !is_meant(&name) && !parts.iter().any(|part| part.is_hidden) {
            let named = |(path, _): &(String, bool)| format!("\"{}\"", path.strip_prefix(MATERIAL).unwrap_or(path));
            let known: Vec<_> = all.iter().take(mesh.materials.len() + parts.len()).map(named).collect();
            let (name, known) = (mesh.name.clone(), choice(&known, "it has none"));
            return Err(HeightError::NoPart { name, part: shown(part), known });
        }
        if !all.iter().any(|(path, is_hidden)| !is_hidden && is_part_of(path, &name)) {
            let said = format!("no material or part \"{}\" is shown; its height image is left out.", shown(part));
            warnings.extend((!is_meant(&name)).then_some(said));
            continue;
        }
        let map = match known.get(&**path) {
            Some(map) => map.clone(),
            None => read_map(path, budget, &progress.part(fraction(index), fraction(index + 1)))?,
        };
        maps.push((name, map.with_amount(*amount)));
        known.insert(path, map);
    }
    let of_file = mesh.materials.iter().map(|material| material.height.clone()).chain(parts.iter().map(|_| None));
    let own = all.iter().zip(of_file).map(|((path, _), of_file)| {
        let meant = maps.iter().filter(|(name, _)| is_part_of(path, name));
        meant.max_by_key(|(name, _)| closeness(path, name)).map(|(_, map)| map.clone()).or(of_file)
    });
    Ok(own.collect())
}

/// The height images that a model's file gives its materials, each read once; `K` tells them apart.
pub(super) struct ModelImages<'a, K> {
    files: &'a Files<'a>,
    known: HashMap<K, Option<HeightMap>>,
    /// The memory that the rest of the load takes, in bytes.
    pub reserved: u64,
    /// What was left out.
    pub warnings: Vec<String>,
}

impl<'a, K: Eq + Hash> ModelImages<'a, K> {
    pub(super) fn new(files: &'a Files<'a>) -> Self {
        Self { files, known: HashMap::new(), reserved: 0, warnings: Vec::new() }
    }

    /// Returns an image of a material, with its amount and wrap. One that can't be read causes a warning, which names the first
    /// material that has it, and so does one that is elsewhere than the texture coordinates that corners have themselves.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub(super) fn read<'b>(
        &mut self,
        key: K,
        [image, material]: [&str; 2],
        (amount, wrap): (Option<HeightAmount>, [Wrap; 2]),
        is_elsewhere: bool,
        bytes: impl FnOnce() -> Result<Cow<'b, [u8]>, String>,
    ) -> Result<Option<HeightMap>, Cancelled> {
        let Files { budget, progress, .. } = self.files;
        let decode = || {
            let bytes = bytes().map_err(|reason| HeightError::Image { path: image.into(), reason })?;
            let (path, progress) = (Path::new(image), &progress.quiet());
            ImageFile { path, reserved: self.reserved, budget, progress }.decode(&bytes)
        };
        let map = match self.known.get(&key) {
            Some(known) => known.clone(),
            None => match borrowing(budget, decode) {
                Err(HeightError::Cancelled(cancelled)) => return Err(cancelled),
                Err(error) => {
                    self.warnings.push(format!("the height image of material \"{material}\" is left out: {error}."));
                    None
                }
                Ok(map) => Some(map),
            },
        };
        let said = "lies elsewhere than its base colour, whose texture coordinates are used";
        let said = format!("the height image of material \"{material}\" {said}.");
        if is_elsewhere && !self.warnings.contains(&said) {
            self.warnings.push(said);
        }
        self.known.insert(key, map.clone());
        Ok(map.map(|map| map.with_wrap(wrap).with_amount(amount)))
    }
}

fn too_much(mesh: &Mesh, count: usize, refused: MemoryRefused) -> HeightError {
    HeightError::TooMuchOfMaterials { name: mesh.name.clone(), count, reason: refused.to_string() }
}

/// Halves the largest images of the materials, and then the parts, until all fit one texture. Returns a sentence about those of each
/// size that they then have.
fn fit(
    mesh: &Mesh,
    parts: &[Part],
    own: &mut [Option<HeightMap>],
    budget: &Budget,
    progress: &Progress,
) -> Result<Notes, HeightError> {
    let distinct: HashSet<_> = own.iter().flatten().map(|map| Arc::as_ptr(&map.heights)).collect();
    if distinct.len() > MAX_MAPS {
        return Err(HeightError::TooMany { name: mesh.name.clone() });
    }
    let mut said = vec![None; own.len()];
    while bytes_of_maps(own.iter().flatten()) > MOST_BYTES {
        progress.check()?;
        let largest = own.iter().flatten().max_by_key(|map| map.heights.len());
        let Some((heights, half)) = largest.and_then(|map| Some((map.heights.clone(), map.halved()?))) else { break };
        let held = budget.hold(bytes_of_maps(std::iter::once(&half)));
        held.map_err(|refused| too_much(mesh, distinct.len(), refused))?;
        let materials = mesh.materials.iter().map(|material| ("material", &material.name));
        let names = materials.chain(parts.iter().map(|part| ("part", &part.name)));
        for (((what, name), map), said) in names.zip(&mut *own).zip(&mut said) {
            let Some(map) = map.as_mut().filter(|map| Arc::ptr_eq(&map.heights, &heights)) else { continue };
            *map = half.with_amount(map.amount).with_wrap(map.wrap);
            let ([width, height], name) = (half.size, shown(name));
            let scaled = format!("is scaled down to {width} x {height} px: all together don't fit one texture");
            *said = Some(format!("the height image of {what} \"{name}\" {scaled}."));
        }
    }
    let mut notes = Notes::default();
    notes.extend(said.into_iter().flatten());
    Ok(notes)
}

/// The brightness of every material's base colour image. Materials that share an image share its pixels.
fn of_colors(
    mesh: &Mesh,
    warnings: &[String],
    budget: &Budget,
    progress: &Progress,
) -> Result<Vec<Option<HeightMap>>, HeightError> {
    let of = |material: &Material| material.texture.as_ref().map(|texture| (Arc::as_ptr(texture), texture.clone()));
    let textures: HashMap<_, _> = mesh.materials.iter().filter_map(of).collect();
    let count = textures.len();
    if count == 0 {
        let left_out = |start: &str| warnings.iter().find(|own| own.starts_with(start) && own.contains(" is left out"));
        let said = |start: &str| left_out(start).map(|own| own.trim_end_matches('.'));
        let own = said("the height image of ").map_or(String::new(), |own| format!("{own}, and "));
        let of_texture = said("the texture of ").map_or(String::new(), |own| format!(" ({own})"));
        let why = format!("{own}no material has a base colour image that can be read{of_texture}");
        return Err(HeightError::NoImage { name: mesh.name.clone(), why });
    }
    if count > MAX_MAPS {
        return Err(HeightError::TooMany { name: mesh.name.clone() });
    }
    let kept = textures.values().map(|texture| HeightMap::bytes_to_build(texture.size)).sum();
    budget.hold(kept).map_err(|refused| too_much(mesh, count, refused))?;
    let mut maps = HashMap::new();
    for (index, (key, texture)) in textures.iter().enumerate() {
        let progress = progress.part(index as f32 / count as f32, (index + 1) as f32 / count as f32);
        maps.insert(key, map_of_px(texture.size, [4, 1], &texture.rgba, &progress)?);
    }
    let own = |material: &Material| Some(maps.get(&of(material)?.0)?.with_wrap(material.sampling.wrap));
    Ok(mesh.materials.iter().map(own).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::mesh::{PartRange, Shape, Texture};

    /// Gives each material one of the first triangles.
    fn one_triangle_each(mesh: &mut Mesh) {
        (0..).zip(&mut mesh.materials).for_each(|(first, material)| material.triangles = first..first + 1);
    }

    /// The numbers of the maps of the first triangles.
    fn maps_of<const N: usize>(heights: &Heights) -> [Option<u32>; N] {
        std::array::from_fn(|triangle| heights.map_of(triangle as u32))
    }

    #[test]
    fn materials_that_share_an_image_share_a_map() {
        let mut mesh = Shape::Torus.build();
        let of_colors = |mesh: &Mesh| {
            HeightSource::Materials.load(mesh, &[], &mut Vec::new(), &Budget::unlimited(), &Progress::new())
        };
        assert!(matches!(of_colors(&mesh), Err(HeightError::NoImage { .. })));
        let texture = std::sync::Arc::new(Texture { size: [1, 1], rgba: vec![255; 4] });
        let textured = geometry::mesh::Material { texture: Some(texture), ..mesh.materials[0].clone() };
        mesh.materials = vec![textured.clone(), mesh.materials[0].clone(), textured];
        one_triangle_each(&mut mesh);
        let heights = of_colors(&mesh).expect("an image");
        assert_eq!((heights.maps.len(), heights.ranges), (1, vec![(0..1, 0), (2..3, 0)]));
        assert!(heights.are_of_colors);
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
        one_triangle_each(&mut mesh);
        let of = |images: &[NamedImage], mesh: &Mesh| {
            let source = HeightSource::Each(images.to_vec());
            source
                .load(mesh, &[], &mut Vec::new(), &Budget::unlimited(), &Progress::new())
                .map_err(|error| error.to_string())
        };
        let heights = of(&[], &mesh).expect("an image");
        assert_eq!((heights.maps[0].amount, maps_of(&heights)), (map.amount, [Some(0), None, None]));
        let path = assets::path("waves.png");
        let image = |name: &str| NamedImage { part: name.to_owned(), path: path.clone(), amount: None };
        let heights = of(&[image("roof")], &mesh).expect("two images");
        assert_eq!(maps_of(&heights), [Some(0), Some(1), None]);
        assert!(heights.follow_settings() && heights.maps[0].size == [2, 2] && !heights.are_of_colors);
        let heights = of(&[image("roof"), image("door")], &mesh).expect("two images");
        assert_eq!(maps_of(&heights), [Some(0), Some(1), Some(1)], "a file is read once");
        let heights = of(&[image("wall")], &mesh).expect("an image");
        assert_eq!((maps_of(&heights), heights.maps[0].amount), ([Some(0), None, None], None));
        let said = of(&[image("floor")], &mesh).expect_err("no such material");
        let expected =
            "has no material \"floor\" to displace, and no such part; choose one of \"wall\", \"roof\", \"door\"";
        assert!(said.ends_with(expected), "{said}");
        mesh.materials[0].height = None;
        assert!(of(&[], &mesh).expect_err("no image").contains("no material has a base colour image"));
    }

    #[test]
    fn parts_and_groups_have_the_images_that_are_named() {
        let mut mesh = Shape::Torus.build();
        mesh.materials[0].name = "wall".to_owned();
        mesh.materials[0].height = Some(HeightMap::new([2, 2], vec![0.5; 4]));
        mesh.part_ranges = (0..3).map(|part| PartRange { triangles: part + 1..part + 2, part }).collect();
        let part = |name: &str| Part { name: name.to_owned(), triangles: 1, is_hidden: false, level: 0 };
        let parts = ["Car", "Car/Wheel", "Hat/wall", "material:wall"].map(part);
        let path = assets::path("waves.png");
        // The scales of the images over the first triangles; 0 for that of the file, which has none.
        let of = |names: &[&str]| {
            let image = |(name, scale): (&&str, f32)| NamedImage {
                part: (*name).to_owned(),
                path: path.clone(),
                amount: HeightAmount::new(scale, 0.5),
            };
            let source = HeightSource::Each(names.iter().zip([1.0, 2.0]).map(image).collect());
            let heights = source.load(&mesh, &parts, &mut Vec::new(), &Budget::unlimited(), &Progress::new());
            let heights = heights.map_err(|error| error.to_string())?;
            let scale = |triangle| heights.map(triangle).expect("an image").amount.map_or(0.0, |own| own.scale);
            Ok::<_, String>([0, 1, 2, 3, 4].map(scale))
        };
        assert_eq!(of(&["Car"]), Ok([0.0, 1.0, 1.0, 0.0, 0.0]));
        assert_eq!(of(&["Hat/wall"]), Ok([0.0, 0.0, 0.0, 1.0, 0.0]));
        assert_eq!(of(&["Wheel", "Car"]), Ok([0.0, 2.0, 1.0, 0.0, 0.0]), "what lies in a group wins over the group");
        assert_eq!(of(&["Car/.", "Car"]), Ok([0.0, 1.0, 2.0, 0.0, 0.0]));
        assert_eq!(of(&["Hat", "Hat"]), Ok([0.0, 0.0, 0.0, 2.0, 0.0]), "the last");
        assert_eq!(of(&["wall"]), Ok([1.0; 5]), "a material wins over a part of the same name");
        assert_eq!(of(&["Car", "material:wall"]), Ok([2.0, 1.0, 1.0, 2.0, 2.0]), "a part wins over its material");
        let said = of(&["Wheels"]).expect_err("no such part");
        assert!(said.contains("has no material \"Wheels\" to displace, and no such part; "), "{said}");
        assert!(said.ends_with("; choose one of \"wall\", \"Car\", \"Car/Wheel\", \"Hat/wall\""), "{said}");
    }

    #[test]
    fn images_of_hidden_things_are_ignored() {
        let mut mesh = Shape::Torus.build();
        mesh.materials[0].name = "roof".to_owned();
        mesh.part_ranges = vec![PartRange { triangles: 1..2, part: 0 }];
        let part = |name: &str, is_hidden| Part { name: name.to_owned(), triangles: 1, is_hidden, level: 0 };
        // The numbers of the maps of the first triangles, and what is said. Only the roof's image can be read.
        let of = |names: &[&str], parts: &[Part]| {
            let path = |name: &str| if name == "roof" { assets::path("waves.png") } else { "gone.png".into() };
            let image = |name: &&str| NamedImage { part: (*name).to_owned(), path: path(name), amount: None };
            let (source, mut said) = (HeightSource::Each(names.iter().map(image).collect()), Vec::new());
            let heights = source.load(&mesh, parts, &mut said, &Budget::unlimited(), &Progress::new());
            heights.map(|heights| (maps_of(&heights), said)).map_err(|error| error.to_string())
        };
        let none = || Ok(([None; 3], Vec::new()));
        let hidden_material = [part("wall", false), part("material:roof", false), part("material:wall", true)];
        assert_eq!(of(&["wall"], &hidden_material), none(), "not the part of the same name");
        assert_eq!(of(&["material:wall"], &hidden_material), none());
        assert_eq!(of(&["wall", "roof"], &hidden_material), Ok(([Some(0); 3], Vec::new())));
        let said = of(&["floor"], &hidden_material).expect_err("no such part");
        assert!(said.contains("no material \"floor\"") && said.ends_with("choose one of \"roof\", \"wall\""), "{said}");
        let hidden_part = [part("house", false), part("shed", true)];
        assert_eq!(of(&["shed"], &hidden_part), none());
        let said = "no material or part \"wall\" is shown; its height image is left out.".to_owned();
        assert_eq!(of(&["wall"], &hidden_part), Ok(([None; 3], vec![said])), "it may be a material of the hidden part");
    }

    #[test]
    fn without_any_image_the_error_says_why_the_files_own_one_is_left_out() {
        let mesh = Shape::Torus.build();
        let said = |warning: &str| {
            let warnings = &mut vec![warning.to_owned()];
            let heights = HeightSource::Model.load(&mesh, &[], warnings, &Budget::unlimited(), &Progress::new());
            heights.expect_err("no image").to_string()
        };
        let colors = "no material has a base colour image that can be read";
        let left_out = "the height image of material \"m\" is left out: \"gone.png\" can't be read";
        assert!(said(&format!("{left_out}.")).contains(&format!(" to displace by: {left_out}, and {colors}; name a")));
        let left_out = "the texture of material \"m\" is left out: it isn't there";
        assert!(said(&format!("{left_out}.")).contains(&format!(" to displace by: {colors} ({left_out}); name a")));
        let elsewhere = "the height image of material \"m\" lies elsewhere than its base colour.";
        assert!(said(elsewhere).contains(&format!(" to displace by: {colors}; name a")));
    }

    #[test]
    fn images_that_exceed_one_texture_are_halved_and_named() {
        let mut mesh = Shape::Torus.build();
        let named = |name: &str| Material { name: name.to_owned(), ..mesh.materials[0].clone() };
        mesh.materials = ["a", "b", "c", "d", "e"].map(named).to_vec();
        let image = || {
            let mut map = HeightMap::new([1, 1], vec![0.0]);
            (map.size, map.levels) = ([4096; 2], 13);
            map.heights = Arc::new(vec![0.0; (0..13).map(|level| (4096_usize >> level).pow(2)).sum()]);
            map
        };
        let [a, b, c, d] = [image(), image(), image(), image()];
        let amount = HeightAmount::from_factor(2.0, 0.0);
        let e = a.with_amount(amount);
        let mut own = [a, b, c, d, e].map(Some);
        // Three fit.
        let fit = |own: &mut [Option<HeightMap>], progress: &Progress| {
            fit(&mesh, &[], own, &Budget::unlimited(), progress).map(Notes::into_warnings)
        };
        assert_eq!(fit(&mut own[..3], &Progress::new()).expect("memory"), [""; 0]);
        let cancelled = Progress::new();
        cancelled.cancel();
        assert!(matches!(fit(&mut own, &cancelled), Err(HeightError::Cancelled(_))));
        let said = fit(&mut own, &Progress::new()).expect("memory");
        let [a, b, c, d, e] = own.map(|map| map.expect("an image"));
        let halved = [&a, &b, &c, &d, &e].map(|map| map.size == [2048; 2] && map.levels == 12);
        assert_eq!(halved, [true, false, false, true, true], "the first image, which two materials have, and another");
        assert!(Arc::ptr_eq(&a.heights, &e.heights) && e.amount == amount);
        let scaled = "is scaled down to 2048 x 2048 px: all together don't fit one texture (and 2 more like it).";
        assert_eq!(said, [format!("the height image of material \"a\" {scaled}")]);
        assert!(bytes_of_maps([a, b, c, d].iter()) <= MOST_BYTES);
        // Of twenty each is halved, and some of them twice: the last size is said.
        mesh.materials = vec![mesh.materials[0].clone(); 20];
        let mut own: Vec<_> = (0..20).map(|_| Some(image())).collect();
        let said =
            super::fit(&mesh, &[], &mut own, &Budget::unlimited(), &Progress::new()).expect("memory").into_warnings();
        assert!(bytes_of_maps(own.iter().flatten()) <= MOST_BYTES && said.len() <= 2, "{said:?}");
    }

    #[test]
    fn more_images_than_are_used_are_refused_before_anything_is_made_of_them() {
        let mut mesh = Shape::Torus.build_at(1);
        let textured = |_| {
            let texture = Arc::new(Texture { size: [1, 1], rgba: vec![255; 4] });
            Material { texture: Some(texture), ..Material::plain("plain", [1.0; 4]) }
        };
        mesh.materials = (0..=MAX_MAPS).map(textured).collect();
        one_triangle_each(&mut mesh);
        let budget = Budget::unlimited();
        let load =
            |source: HeightSource, mesh: &Mesh| source.load(mesh, &[], &mut Vec::new(), &budget, &Progress::new());
        assert!(matches!(load(HeightSource::Materials, &mesh), Err(HeightError::TooMany { .. })));
        assert_eq!(budget.held(), 0);
        for material in &mut mesh.materials {
            material.height = Some(HeightMap::new([1, 1], vec![0.5]));
        }
        assert!(matches!(load(HeightSource::Model, &mesh), Err(HeightError::TooMany { .. })));
        mesh.materials.pop();
        assert_eq!(load(HeightSource::Model, &mesh).map(|heights| heights.maps.len()).ok(), Some(MAX_MAPS));
    }

    #[test]
    fn base_colours_go_on_beyond_their_border_as_their_samplers_say() {
        let mut mesh = Shape::Torus.build();
        mesh.corners.iter_mut().for_each(|corner| corner.uv *= 2.0);
        mesh.materials[0].texture = Some(Arc::new(Texture { size: [1, 1], rgba: vec![255; 4] }));
        for wrap in [[Wrap::Clamp, Wrap::Mirror], [Wrap::Repeat; 2]] {
            mesh.materials[0].sampling.wrap = wrap;
            let heights =
                HeightSource::Materials.load(&mesh, &[], &mut Vec::new(), &Budget::unlimited(), &Progress::new());
            assert_eq!(heights.expect("an image").maps[0].wrap, wrap);
        }
    }

    #[test]
    fn flaws_in_the_files_own_images_cost_a_warning_unless_they_are_asked_for() {
        let mut mesh = Shape::Torus.build();
        let map = HeightMap::new([2, 2], vec![0.5; 4]);
        let small = Budget::new(0, 1);
        let mut warnings = Vec::new();
        let mut load = |source: Option<&HeightSource>, mesh: &Mesh| {
            load_heights(source, mesh, &[], &mut warnings, &small, &Progress::new())
        };
        assert!(load(None, &mesh).is_ok_and(|heights| heights.is_none()), "it has none");
        mesh.materials[0].height = Some(map);
        assert!(load(Some(&HeightSource::Model), &mesh).is_err());
        assert!(load(None, &mesh).is_ok_and(|heights| heights.is_none()));
        assert!(warnings.len() == 1 && warnings[0].starts_with("its height images are left out: "), "{warnings:?}");
    }

    #[test]
    fn a_file_that_is_not_an_image_is_refused() {
        let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml"));
        let source = HeightSource::File(path.to_owned());
        let error = source.load(&Mesh::default(), &[], &mut Vec::new(), &Budget::unlimited(), &Progress::new());
        let error = error.expect_err("no image").to_string();
        assert!(error.contains("Cargo.toml can't be read as a height image"), "{error}");
    }
}

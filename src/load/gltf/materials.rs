//! Makes materials of what a document says about them. Each is made when a primitive first uses it.

use std::borrow::Cow;
use std::cell::RefCell;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::sync::Arc;

use ::gltf::Document;

use super::lenient::Members;
use super::material_source::{MapSource, MaterialSource};
use super::nodes::Placed;
use super::notes::Notes;
use super::texture_source::{MaterialLists, TextureSource};
use super::{Accessors, GltfError};
use crate::heights::ModelImages;
use crate::images::texture_size;
use crate::map_uvs::MapUvs;
use crate::packing::roughness;
use crate::texture_room::{LEFT_OUT, ReadImage, read_images};
use crate::uri::Files;
use geometry::choice::Choice;
use geometry::mesh::mesh_builder::MeshBuilder;
use geometry::mesh::mipmap::MipFilter;
use geometry::mesh::{HeightMap, Look, Map, Material, Sampling, Slot, Texture, borrowing};
use geometry::progress::Cancelled;

/// How many materials a sentence names.
const NAMED: usize = 3;

/// A material's index in the builder, and what its corners need.
#[derive(Clone, Copy, Default)]
pub(super) struct Resolved {
    pub index: usize,
    /// The scale of the node that it was made for; NaN once a warning said that other nodes have another.
    scale: f32,
    pub uvs: MapUvs,
    pub needs: DetailNeeds,
}

/// What the corners of a material need beside position, normal and texture coordinates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct DetailNeeds {
    /// Texture coordinates TEXCOORD_0 and TEXCOORD_1, untransformed.
    pub sets: [bool; 2],
    pub tangents: bool,
}

/// The materials that have been used so far.
pub(super) struct Materials<'a> {
    lists: &'a MaterialLists,
    accessors: &'a Accessors<'a>,
    files: &'a Files<'a>,
    /// Those that are used, by the index in the document; none for the default material.
    sources: HashMap<Option<usize>, MaterialSource>,
    resolved: HashMap<Option<usize>, Resolved>,
    /// By the texture's index.
    textures: HashMap<usize, Option<TextureSource>>,
    /// By the image's index.
    images: HashMap<usize, ReadImage>,
    /// Maps of roughness that were made of glossiness, by the image and the bits of its factor.
    rough: HashMap<(*const Texture, u32), Arc<Texture>>,
    /// By the image's index.
    heights: ModelImages<'a, usize>,
    /// For what isn't drawn, the names of the first few materials that have it, and how many have it.
    undrawn: BTreeMap<String, (Vec<String>, usize)>,
    notes: RefCell<Notes>,
}

impl<'a> Materials<'a> {
    /// Reads the materials of everything that is shown, without their images.
    ///
    /// # Errors
    /// [`GltfError::TooLarge`].
    pub(super) fn new(
        lists: &'a MaterialLists,
        document: &Document,
        placed: &Placed,
        accessors: &'a Accessors<'a>,
        files: &'a Files<'a>,
    ) -> Result<Self, GltfError> {
        let mut materials = Self {
            lists,
            accessors,
            files,
            sources: HashMap::new(),
            resolved: HashMap::new(),
            textures: HashMap::new(),
            images: HashMap::new(),
            rough: HashMap::new(),
            heights: ModelImages::new(files),
            undrawn: BTreeMap::new(),
            notes: RefCell::default(),
        };
        for primitive in placed.meshes(document).flat_map(|mesh| mesh.primitives()) {
            materials.look_at(primitive.material().index())?;
        }
        Ok(materials)
    }

    fn look_at(&mut self, index: Option<usize>) -> Result<(), GltfError> {
        if self.sources.contains_key(&index) {
            return Ok(());
        }
        let bytes = size_of::<MaterialSource>() + size_of::<Material>();
        self.files.budget.hold(bytes as u64).map_err(GltfError::too_large("its materials"))?;
        let value = index.and_then(|index| Some((index, self.lists.materials.get(index)?)));
        let members = value.and_then(|(i, value)| Members::new(value, format!("/materials/{i}"), &self.notes));
        let source = MaterialSource::new(members.as_ref(), self.lists.textures.len());
        let name = name(&source, index);
        for undrawn in &source.undrawn {
            let (named, count) = self.undrawn.entry(undrawn.clone()).or_default();
            *count += 1;
            named.extend((*count <= NAMED).then(|| format!("\"{}\"", crate::uri::shown(&name))));
        }
        self.sources.insert(index, source);
        Ok(())
    }

    /// Returns whether corners of this material need more than position, normal and texture coordinates.
    pub(super) fn needs_details(&self, material: &::gltf::Material) -> bool {
        self.sources.get(&material.index()).is_some_and(MaterialSource::needs_details)
    }

    /// Reads the images of all materials that are used, and scales the largest down until all fit. `reserved` is the memory that
    /// the rest of the load takes, in bytes.
    ///
    /// # Errors
    /// [`GltfError::Cancelled`].
    pub(super) fn read_images(&mut self, reserved: u64) -> Result<(), GltfError> {
        self.heights.reserved = reserved;
        let mut keys: Vec<_> = self.sources.keys().copied().collect();
        keys.sort_unstable();
        let mut found: Vec<(usize, MipFilter)> = Vec::new();
        let mut seen = HashSet::new();
        for key in keys {
            let Some(source) = self.sources.get(&key).cloned() else { continue };
            // Textures can be scaled down to the room that heights leave.
            self.height(&source, &name(&source, key));
            let base = source.base_map.map(|map| (map.texture, MipFilter::from_base_color(source.look.alpha)));
            let maps = Slot::ALL.into_iter().zip(source.maps);
            let maps = maps.filter_map(|(slot, map)| Some((map?.texture, MipFilter::from_map(slot))));
            for (texture, filter) in base.into_iter().chain(maps) {
                let Some(TextureSource { images, .. }) = self.texture_source(texture) else { continue };
                self.files.progress.check()?;
                // The first one that looks right; if it turns out not to be, the next one is read when it is needed.
                let looks_right = |own: &usize| {
                    borrowing(self.files.budget, || self.bytes(*own).is_ok_and(|bytes| texture_size(&bytes).is_some()))
                };
                let image = images.into_iter().find(looks_right).filter(|image| seen.insert(*image));
                found.extend(image.map(|image| (image, filter)));
            }
        }
        Ok(self.read(&found)?)
    }

    fn read(&mut self, images: &[(usize, MipFilter)]) -> Result<(), Cancelled> {
        let bytes = |(image, filter)| Ok((self.bytes(image)?, filter));
        let read = read_images(images, bytes, self.heights.reserved, self.files.budget, self.files.progress)?;
        self.images.extend(images.iter().map(|(image, _)| *image).zip(read));
        Ok(())
    }

    fn bytes(&self, image: usize) -> Result<Cow<'a, [u8]>, String> {
        self.lists.image(image, self.accessors, self.files)
    }

    /// Finds a material of what is shown, or adds it to the builder. `scale` is that of the node which shows it. A texture that
    /// is missing or broken causes a warning.
    pub(super) fn resolve(&mut self, material: &::gltf::Material, scale: f32, builder: &mut MeshBuilder) -> Resolved {
        let key = material.index();
        if let Some(resolved) = self.resolved.get_mut(&key) {
            if (scale / resolved.scale - 1.0).abs() > 0.01 && self.sources[&key].look.refracts() {
                resolved.scale = f32::NAN;
                let name = name(&self.sources[&key], key);
                let said = "is that in the first node which shows it, and other nodes have another scale";
                self.notes.get_mut().push(format!("the thickness of material \"{name}\" {said}."));
            }
            return *resolved;
        }
        let Some(source) = self.sources.get(&key).cloned() else { return Resolved::default() };
        let name = name(&source, key);
        let filter = MipFilter::from_base_color(source.look.alpha);
        let base = source.base_map.and_then(|map| self.texture(map.texture, filter, "texture", &name));
        let mut look = source.look.clone();
        // A thickness is in the mesh's space, the distance of its attenuation in the scene's (KHR_materials_volume).
        look.thickness *= scale;
        for slot in Slot::ALL {
            let map = source.maps[slot as usize];
            look.maps[slot as usize] = map.and_then(|map| self.map(map, slot, source.own_uvs(), &name));
        }
        if let Some(factor) = source.glossiness {
            self.set_roughness(&mut look, factor, &name);
        }
        let height = self.height(&source, &name);
        let (texture, sampling) =
            base.map_or((None, Sampling::default()), |(texture, sampling)| (Some(texture), sampling));
        let (uvs, tangents) = (source.own_uvs(), look.tangent_uv().is_some());
        let needs = DetailNeeds { sets: look.uv_sets(), tangents };
        let MaterialSource { base_color, double_sided, .. } = source;
        let plain = Material::plain(&name, base_color);
        let made = Material { texture, sampling, double_sided, look, height, ..plain };
        let resolved = Resolved { index: builder.material(made), scale, uvs, needs };
        self.resolved.insert(key, resolved);
        resolved
    }

    fn map(&mut self, map: MapSource, slot: Slot, own: MapUvs, material: &str) -> Option<Map> {
        let what = slot.label();
        let (texture, sampling) = self.texture(map.texture, MipFilter::from_map(slot), what, material)?;
        let uv = map.uvs.on_corners(own, || {
            let said = "only TEXCOORD_0 and TEXCOORD_1 are read for it; TEXCOORD_0 is used";
            let set = map.uvs.set;
            self.notes.get_mut().push(format!("the {what} of material \"{material}\" has TEXCOORD_{set}, but {said}."));
        });
        Some(Map { texture, uv, sampling })
    }

    fn height(&mut self, source: &MaterialSource, material: &str) -> Option<HeightMap> {
        let (map, amount) = source.height?;
        let TextureSource { images, sampling } = self.texture_source(map.texture)?;
        let image = *images.last()?;
        let bytes = || self.lists.image(image, self.accessors, self.files);
        let names = [&*format!("/images/{image}"), material];
        // If it was cancelled, what follows ends too.
        self.heights.read(image, names, (amount, sampling.wrap), map.uvs != source.own_uvs(), bytes).ok()?
    }

    /// Gives a material a map of roughness, made of the glossiness in the image of its specular colour, times this factor.
    fn set_roughness(&mut self, look: &mut Look, factor: f32, material: &str) {
        let Some(specular) = &look.maps[Slot::SpecularColor as usize] else { return };
        let key = (Arc::as_ptr(&specular.texture), factor.to_bits());
        let made = match self.rough.get(&key) {
            Some(known) => Ok(known.clone()),
            None => roughness(&specular.texture, factor, self.files.budget).map(Arc::new),
        };
        match made {
            Ok(texture) => {
                self.rough.insert(key, texture.clone());
                look.roughness = 1.0;
                look.maps[Slot::MetallicRoughness as usize] = Some(Map { texture, ..specular.clone() });
            }
            Err(reason) => {
                let said = format!("the glossiness map of material \"{material}\" is left out: {reason}.");
                self.notes.get_mut().push(said);
            }
        }
    }

    fn texture_source(&mut self, texture: usize) -> Option<TextureSource> {
        let read = || self.lists.texture(texture, &self.notes);
        self.textures.entry(texture).or_insert_with(read).clone()
    }

    fn texture(
        &mut self,
        texture: usize,
        filter: MipFilter,
        what: &str,
        material: &str,
    ) -> Option<(Arc<Texture>, Sampling)> {
        let TextureSource { images, sampling } = self.texture_source(texture)?;
        let (last, others) = images.split_last()?;
        let name = format!("the {what} of material \"{material}\"");
        let used = "can't be used, and the texture's other image takes its place";
        let other = others.iter().find_map(|&image| self.image(image, filter, &name, used));
        Some((other.or_else(|| self.image(*last, filter, &name, LEFT_OUT))?, sampling))
    }

    /// An image, which is read unless it was already. If it can't be read, the sentence about it has `otherwise` in it; `name` says
    /// where it is used.
    fn image(&mut self, image: usize, filter: MipFilter, name: &str, otherwise: &str) -> Option<Arc<Texture>> {
        if !self.images.contains_key(&image) {
            // If it was cancelled, what follows ends too.
            self.read(&[(image, filter)]).ok()?;
        }
        let ReadImage { texture, said } = self.images.get_mut(&image)?;
        // Said once.
        let said = said.take().map(|said| format!("{name} {}", said.replacen(LEFT_OUT, otherwise, 1)));
        self.notes.get_mut().extend(said);
        texture.clone()
    }

    /// Returns what was repaired or left out.
    pub(super) fn into_notes(self) -> Notes {
        let mut notes = self.notes.into_inner();
        notes.extend(self.heights.warnings);
        for (what, (named, count)) in self.undrawn {
            let names = named.join(", ");
            notes.push(match count - named.len() {
                0 if count == 1 => format!("{what} isn't drawn; material {names} has it."),
                0 => format!("{what} isn't drawn; materials {names} have it."),
                more => format!("{what} isn't drawn; materials {names} and {more} more have it."),
            });
        }
        notes
    }
}

/// Returns a material's name, or one made of its index.
fn name(source: &MaterialSource, index: Option<usize>) -> String {
    match (&source.name, index) {
        (Some(name), _) => name.clone(),
        (None, Some(index)) => format!("material {index}"),
        (None, None) => "default".to_owned(),
    }
}

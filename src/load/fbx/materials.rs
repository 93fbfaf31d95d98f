//! Makes the mesh's materials: each when a polygon first uses it.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use ufbx::{Mesh, Node, RefList};

use super::looks::{LookSource, MapSource};
use super::textures::{bytes, of_file, sampling};
use crate::face_builder::FaceBuilder;
use crate::heights::ModelImages;
use crate::map_uvs::MapUvs;
use crate::notes::Notes;
use crate::packing;
use crate::read_error::ReadError;
use crate::texture_room::{ReadImage, read_images};
use crate::uri::{Files, shown};
use geometry::mesh::{Alpha, HeightAmount, HeightMap, Map, Material, Sampling, Slot, Texture};

/// The materials of all polygons.
pub(super) struct Materials<'a> {
    files: &'a Files<'a>,
    /// By the number of the file.
    images: HashMap<u32, ReadImage>,
    /// By material (none for polygons without one) and the sets of its maps, which depend on the mesh.
    resolved: HashMap<(Option<u32>, Vec<usize>), Resolved>,
    heights: ModelImages<'a, u32>,
    /// How many object units one unit of the file is.
    unit: f32,
    notes: Notes,
}

/// A material on a mesh.
#[derive(Clone, Copy)]
pub(super) struct Resolved {
    /// Its index in the builder.
    pub index: usize,
    /// The texture coordinates that corners have themselves.
    pub own: MapUvs,
    /// Which of the sets 0 and 1 some map uses in another way.
    pub sets: [bool; 2],
}

impl<'a> Materials<'a> {
    /// `unit` is how many object units one unit of the file is.
    pub(super) fn new(files: &'a Files<'a>, unit: f32) -> Self {
        Self {
            files,
            images: HashMap::new(),
            resolved: HashMap::new(),
            heights: ModelImages::new(files),
            unit,
            notes: Notes::default(),
        }
    }

    /// Reads the images of all materials of these meshes, and the heights of those that polygons have; `reserved` is the memory
    /// that the rest of the load takes, in bytes.
    ///
    /// # Errors
    /// [`ReadError::Cancelled`].
    pub(super) fn read_images<'m>(
        &mut self,
        meshes: impl Iterator<Item = (&'m Node, &'m Mesh)>,
        reserved: u64,
    ) -> Result<(), ReadError> {
        self.heights.reserved = reserved;
        let mut seen = HashSet::new();
        let sources = meshes.flat_map(|(node, mesh)| {
            let is_new = seen.insert(std::ptr::from_ref(mesh));
            let own = mesh.materials.iter().enumerate().filter(move |_| is_new);
            let is_used = |slot: usize| mesh.material_parts.get(slot).is_none_or(|part| part.num_faces > 0);
            let materials = node.materials.iter().enumerate().chain(own);
            materials.map(move |(slot, material)| (is_used(slot), LookSource::new(material, mesh)))
        });
        let mut images = Vec::new();
        for (is_used, source) in sources {
            // Textures can be scaled down to the room that heights leave.
            is_used.then(|| self.height(&source)).transpose()?;
            images.extend(source.images());
        }
        let mut seen = HashSet::new();
        let used = images.into_iter().filter_map(|(texture, filter)| Some((of_file(texture)?, filter)));
        let used: Vec<_> = used.filter(|(file, _)| seen.insert(file.file_index)).collect();
        let bytes = |(file, filter)| Ok((bytes(file, self.files)?, filter));
        let read = read_images(&used, bytes, reserved, self.files.budget, self.files.progress)?;
        self.images = used.iter().map(|(file, _)| file.file_index).zip(read).collect();
        Ok(())
    }

    /// Finds a material of a node's mesh by its index there, or adds it to the builder.
    ///
    /// # Errors
    /// [`ReadError::TooMany`] and [`ReadError::TooLarge`].
    pub(super) fn resolve(
        &mut self,
        index: u32,
        node: &Node,
        mesh: &Mesh,
        faces: &mut FaceBuilder,
    ) -> Result<Resolved, ReadError> {
        // Nodes may have others than their mesh.
        let own = node.materials.get(index as usize).or_else(|| mesh.materials.get(index as usize));
        let source = own.map(|own| LookSource::new(own, mesh));
        let sets = source.iter().flat_map(LookSource::sets).collect();
        let key = (own.map(|own| own.element.typed_id), sets);
        if let Some(&resolved) = self.resolved.get(&key) {
            return Ok(resolved);
        }
        self.files.budget.hold(size_of::<Material>() as u64)?;
        let (material, own) = match &source {
            Some(source) => {
                let undrawn = source.undrawn.iter();
                let said = |what| format!("material \"{}\" has {what}, which isn't drawn.", source.name);
                self.notes.extend(undrawn.map(said));
                let height = self.height(source)?;
                (Material { height, ..self.make(source) }, source.own_uvs())
            }
            None => (Material::plain("default", [1.0; 4]), MapUvs::default()),
        };
        let sets = material.look.uv_sets();
        let resolved = Resolved { index: faces.material(material)?, own, sets };
        self.resolved.insert(key, resolved);
        Ok(resolved)
    }

    fn make(&mut self, source: &LookSource) -> Material {
        let mut look = source.look.clone();
        look.maps[Slot::MetallicRoughness as usize] = self.metallic_roughness(source);
        for (slot, map, what) in [
            (Slot::Normal, source.normal, "normal map"),
            (Slot::Emissive, source.emission, "emissive map"),
            (Slot::Occlusion, source.occlusion, "occlusion map"),
        ] {
            look.maps[slot as usize] = map.and_then(|map| {
                let texture = self.image(map, what, source)?;
                Some(self.map(map, texture, what, source))
            });
        }
        let (texture, sampling) = self.base(source);
        if texture.is_none() && source.look.alpha == Alpha::Blend && source.base_color[3] >= 1.0 {
            // Its opacity was to come from an image.
            look.alpha = Alpha::Opaque;
        }
        if look.maps[Slot::Emissive as usize].is_none() && source.emission.is_some() {
            look.emissive = [0.0; 3];
        }
        let LookSource { name, base_color, double_sided, .. } = source;
        Material { texture, sampling, double_sided: *double_sided, look, ..Material::plain(name, *base_color) }
    }

    fn height(&mut self, source: &LookSource) -> Result<Option<HeightMap>, ReadError> {
        let Some((map, file)) = source.height.and_then(|map| Some((map, of_file(map.texture)?))) else {
            return Ok(None);
        };
        let names = [&*format!("\"{}\"", shown(file.element.name.as_ref())), &*source.name];
        let is_elsewhere = map.uvs != source.own_uvs();
        let used = (HeightAmount::from_factor(source.height_factor * self.unit, 0.0), sampling(map.texture).wrap);
        Ok(self.heights.read(file.file_index, names, used, is_elsewhere, || bytes(file, self.files))?)
    }

    /// Returns the image of the base colour, with the opacity as its alpha.
    fn base(&mut self, source: &LookSource) -> (Option<Arc<Texture>>, Sampling) {
        let color = source.base.and_then(|base| self.image(base, "texture", source));
        let opacity = source.opacity.and_then(|opacity| self.image(opacity, "opacity map", source));
        let map = source.base.or(source.opacity);
        let sampling = map.map_or_else(Sampling::default, |map| sampling(map.texture));
        let Some(opacity) = opacity else { return (color, sampling) };
        match packing::with_opacity(color.as_deref(), &opacity, self.files.budget) {
            Ok(joined) => (Some(Arc::new(joined)), sampling),
            Err(reason) => {
                self.notes.push(format!("the opacity map of material \"{}\" is left out: it {reason}.", source.name));
                (color, sampling)
            }
        }
    }

    fn metallic_roughness(&mut self, source: &LookSource) -> Option<Map> {
        let what = "metallic-roughness map";
        let roughness = source.roughness.and_then(|map| self.image(map, what, source));
        let metalness = source.metalness.and_then(|map| self.image(map, what, source));
        let map = source.roughness.filter(|_| roughness.is_some()).or(source.metalness)?;
        let texture = match (&roughness, &metalness) {
            (None, None) => return None,
            (Some(roughness), Some(metalness)) if Arc::ptr_eq(roughness, metalness) && !source.is_glossiness => {
                roughness.clone()
            }
            (roughness, metalness) => {
                let packed = packing::metallic_roughness(
                    roughness.as_deref(),
                    source.is_glossiness,
                    metalness.as_deref(),
                    self.files.budget,
                );
                let left_out = |reason| format!("the {what} of material \"{}\" is left out: it {reason}.", source.name);
                Arc::new(packed.map_err(|reason: String| self.notes.push(left_out(reason))).ok()?)
            }
        };
        Some(self.map(map, texture, what, source))
    }

    /// Returns the image of a map. One that is missing or broken causes a warning.
    fn image(&mut self, map: MapSource, what: &str, source: &LookSource) -> Option<Arc<Texture>> {
        let what = format!("the {what} of material \"{}\"", source.name);
        let Some(file) = of_file(map.texture) else {
            self.notes.push(format!("{what} is left out: it is computed by another program."));
            return None;
        };
        let image = self.images.get_mut(&file.file_index)?;
        self.notes.extend(image.said.take().map(|said| format!("{what} {said}")));
        image.texture.clone()
    }

    fn map(&mut self, map: MapSource, texture: Arc<Texture>, what: &str, source: &LookSource) -> Map {
        let uv = map.uvs.on_corners(source.own_uvs(), || {
            let has = format!("the {what} of material \"{}\" has a third set of texture coordinates", source.name);
            self.notes.push(format!("{has}, but only the first two sets are read for it; the first is used."));
        });
        let sampling = of_file(map.texture).map_or_else(Sampling::default, sampling);
        Map { texture, uv, sampling }
    }

    /// Returns what was repaired or left out.
    pub(super) fn into_notes(self) -> Notes {
        let mut notes = self.notes;
        notes.extend(self.heights.warnings);
        notes
    }
}

/// Whether corners of the meshes of these nodes need more than position, normal and the base colour's texture coordinates.
pub(super) fn need_details<'a>(mut meshes: impl Iterator<Item = (&'a Node, &'a Mesh)>) -> bool {
    let needed = |materials: &RefList<ufbx::Material>, mesh: &Mesh| {
        materials.into_iter().any(|material| LookSource::new(material, mesh).needs_details())
    };
    let mut seen = HashSet::new();
    meshes.any(|(node, mesh)| {
        let is_new = seen.insert(std::ptr::from_ref(mesh));
        needed(&node.materials, mesh) || is_new && (mesh.vertex_color.exists || needed(&mesh.materials, mesh))
    })
}

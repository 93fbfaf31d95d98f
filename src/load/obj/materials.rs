//! The materials of an OBJ file. Files in its folder describe them; each is made when a face first uses it.

use std::collections::HashMap;
use std::sync::Arc;

use glam::Vec2;

use super::mtl::{self, MtlMaterial, MtlTexture};
use crate::load::face_builder::{FaceBuilder, counted};
use crate::load::images::decode_texture;
use crate::load::memory_budget::Budget;
use crate::load::read_error::ReadError;
use crate::load::text_lines::{shown, words};
use crate::load::uri::Files;
use crate::mesh::{Alpha, Look, Map, MapUv, Material, MemoryAccount, Sampling, Slot, Texture, Wrap};

/// The greatest number of material files that are read.
const MAX_LIBRARIES: usize = 64;

/// The materials of the faces.
pub(super) struct Materials<'a> {
    files: &'a Files<'a>,
    budget: &'a Budget,
    /// The names of the material files.
    libraries: Vec<String>,
    described: HashMap<Vec<u8>, MtlMaterial>,
    /// The name of the material that the next faces use; empty before the first `usemtl`.
    name: Vec<u8>,
    /// The index of that material, once a face uses it.
    index: Option<usize>,
    indices: HashMap<Vec<u8>, usize>,
    /// How texture coordinates are placed, by the index of a material: what they are multiplied by, and what is added.
    places: HashMap<usize, [Vec2; 2]>,
    /// Textures by file name; none for one that can't be read.
    textures: HashMap<String, Option<Arc<Texture>>>,
    problems: Vec<String>,
    bad_statements: usize,
    libraries_left_out: usize,
    undescribed: usize,
}

impl<'a> Materials<'a> {
    pub(super) fn new(files: &'a Files<'a>, budget: &'a Budget) -> Self {
        Self {
            files,
            budget,
            libraries: Vec::new(),
            described: HashMap::new(),
            name: Vec::new(),
            index: None,
            indices: HashMap::new(),
            places: HashMap::new(),
            textures: HashMap::new(),
            problems: Vec::new(),
            bad_statements: 0,
            libraries_left_out: 0,
            undescribed: 0,
        }
    }

    /// Reads `mtllib`: the names of one or more files, which may contain spaces.
    pub(super) fn add_library(&mut self, names: &[u8]) {
        let mut name = Vec::new();
        for word in words(names) {
            if !name.is_empty() {
                name.push(b' ');
            }
            name.extend(word);
            if word.to_ascii_lowercase().ends_with(b".mtl") {
                self.read_library(&std::mem::take(&mut name));
            }
        }
        if !name.is_empty() {
            self.read_library(&name);
        }
    }

    fn read_library(&mut self, name: &[u8]) {
        let name = String::from_utf8_lossy(name).into_owned();
        if self.libraries.contains(&name) {
            return;
        }
        if self.libraries.len() == MAX_LIBRARIES {
            self.libraries_left_out += 1;
            return;
        }
        let borrowed = self.budget.borrowed();
        match self.beside(&name).and_then(|bytes| mtl::read(&bytes)) {
            Ok((materials, bad)) => {
                self.bad_statements += bad;
                // Of several materials with one name the first counts, as in most programs.
                materials.into_iter().for_each(|material| {
                    self.described.entry(material.name.clone()).or_insert(material);
                });
            }
            Err(reason) => {
                let name = shown(name.as_bytes());
                self.problems.push(format!("the material file {name} is left out: {reason}."));
            }
        }
        self.budget.give_back_to(borrowed);
        self.libraries.push(name);
    }

    /// Reads `usemtl`: the material of the next faces.
    pub(super) fn enter(&mut self, name: &[u8]) {
        if self.name != name {
            self.name = name.to_vec();
            self.index = None;
        }
    }

    /// Returns the index of the next face's material.
    ///
    /// # Errors
    /// [`ReadError::TooMany`].
    pub(super) fn current(&mut self, faces: &mut FaceBuilder) -> Result<usize, ReadError> {
        if let Some(index) = self.index.or_else(|| self.indices.get(&self.name).copied()) {
            self.index = Some(index);
            return Ok(index);
        }
        let (material, place) = self.make();
        let index = faces.material(material)?;
        if let Some(place) = place {
            self.places.insert(index, place);
        }
        self.indices.insert(self.name.clone(), index);
        self.index = Some(index);
        Ok(index)
    }

    /// Returns where on the image of a material a corner with these texture coordinates is. The file's v points upwards, the
    /// mesh's downwards.
    pub(super) fn placed(&self, material: usize, uv: Vec2) -> Vec2 {
        let Some([scale, offset]) = self.places.get(&material) else { return uv };
        let [u, v] = (Vec2::new(uv.x, 1.0 - uv.y) * scale + offset).to_array();
        Vec2::new(u, 1.0 - v)
    }

    /// Makes the material of the next faces. Also returns how its texture coordinates are placed, if not as they are.
    fn make(&mut self) -> (Material, Option<[Vec2; 2]>) {
        if self.name.is_empty() {
            return (Material::plain("default", [1.0; 4]), None);
        }
        let shown = String::from_utf8_lossy(&self.name).into_owned();
        let Some(described) = self.described.get(&self.name).cloned() else {
            self.undescribed += 1;
            return (Material::plain(&shown, [1.0; 4]), None);
        };
        let MtlMaterial { color: [r, g, b], alpha, ref texture, ref emissive_texture, .. } = described;
        // Some programs write 0 for what they show as opaque.
        let is_transparent = alpha > 0.0 && alpha < 1.0;
        let base_color = [r, g, b, if is_transparent { alpha } else { 1.0 }];
        // One place serves both images.
        let placing = texture.as_ref().or(emissive_texture.as_ref());
        let place = placing.map(|texture| [texture.scale, texture.offset].map(Vec2::from));
        let wrap = if placing.is_some_and(|texture| texture.is_clamped) { Wrap::Clamp } else { Wrap::Repeat };
        let sampling = Sampling { wrap: [wrap; 2], ..Sampling::default() };
        let image = texture.as_ref().and_then(|texture| self.texture(texture, &shown));
        let glow = emissive_texture.as_ref().and_then(|texture| self.texture(texture, &shown));
        let mut look = Look::default();
        look.roughness = described.roughness.unwrap_or(look.roughness);
        look.metallic = described.metallic.unwrap_or(look.metallic);
        // A texture alone shines as it is.
        let is_given = described.emissive != [0.0; 3] || glow.is_none();
        look.emissive = if is_given { described.emissive } else { [1.0; 3] };
        look.alpha = if is_transparent { Alpha::Blend } else { Alpha::Opaque };
        look.maps[Slot::Emissive as usize] = glow.map(|texture| Map { texture, uv: MapUv::Own, sampling });
        let material = Material { texture: image, sampling, look, ..Material::plain(&shown, base_color) };
        (material, place.filter(|place| *place != [Vec2::ONE, Vec2::ZERO]))
    }

    fn texture(&mut self, MtlTexture { file: name, .. }: &MtlTexture, material: &str) -> Option<Arc<Texture>> {
        if let Some(texture) = self.textures.get(name) {
            return texture.clone();
        }
        let borrowed = self.budget.borrowed();
        let texture = self.beside(name).and_then(|bytes| decode_texture(&bytes, self.budget)).map(Arc::new);
        self.budget.give_back_to(borrowed);
        let texture = texture.map_err(|reason| {
            let image = shown(name.as_bytes());
            self.problems.push(format!("the texture {image} of material \"{material}\" is left out: {reason}."));
        });
        self.textures.insert(name.to_owned(), texture.clone().ok());
        texture.ok()
    }

    /// Returns what is missing or broken, one sentence each.
    pub(super) fn warnings(&mut self) -> Vec<String> {
        let mut warnings = std::mem::take(&mut self.problems);
        warnings.extend(counted([
            (self.bad_statements, "numbers in material files that can't be read, left out"),
            (self.libraries_left_out, "material files beyond the first 64, left out"),
            (self.undescribed, "materials that no material file describes, shown white"),
        ]));
        warnings
    }

    /// Reads a file in the OBJ file's folder or below it, under the same rules as a glTF document's URIs. Of an absolute path the
    /// last name is looked for in the folder.
    fn beside(&self, name: &str) -> Result<Vec<u8>, String> {
        let name = name.replace('%', "%25").replace('\\', "/");
        let drive =
            name.as_bytes().get(..3).is_some_and(|start| start[0].is_ascii_alphabetic() && &start[1..] == b":/");
        // The path on somebody else's machine doesn't lead anywhere here.
        let shortened = if drive || name.starts_with('/') { name.rsplit('/').next() } else { None };
        self.files.read(shortened.unwrap_or(&name), false)
    }
}

#[cfg(test)]
mod tests;

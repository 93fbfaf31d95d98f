//! The materials of an OBJ file. Files in its folder describe them; each is made when a face first uses it.

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};

use glam::Vec2;

use super::mtl::{self, MtlMap, MtlMaterial, MtlTexture};
use super::textures::{Giving, UsedMap, are_normals};
use crate::face_builder::FaceBuilder;
use crate::heights::ModelImages;
use crate::images::decoded_bytes;
use crate::notes::counts;
use crate::read_error::ReadError;
use crate::text_lines::{shown, words};
use crate::texture_room::{ReadImage, read_images};
use crate::uri::Files;
use geometry::mesh::{Alpha, Look, Material, Sampling, Wrap, borrowing};

/// The greatest number of material files that are read.
const MAX_LIBRARIES: usize = 64;

/// The materials of the faces.
#[derive(Default)]
pub(super) struct Materials {
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
    /// The height images, by the index of a material.
    heights: Vec<(usize, MtlTexture)>,
    /// The other maps of materials, by their indices, in the order of the maps.
    used: Vec<(usize, Vec<UsedMap>)>,
    problems: Vec<String>,
    found: Counts,
}

counts! {
    struct Counts {
        bad_statements => "numbers in material files that can't be read, left out";
        libraries_left_out => "material files beyond the first 64, left out";
        undescribed => "materials that no material file describes, shown white";
        bumped => "materials with a bump map (map_Bump, bump), whose heights aren't drawn; norm names a normal map";
        with_normals_as_bumps =>
            "materials with a bump map (map_Bump, bump) that is an image of normals, drawn as a normal map";
    }
}

impl Materials {
    /// Reads `mtllib`: the names of one or more files, which may contain spaces.
    pub(super) fn add_library(&mut self, names: &[u8], files: &Files) {
        let mut name = Vec::new();
        for word in words(names) {
            if !name.is_empty() {
                name.push(b' ');
            }
            name.extend(word);
            if word.to_ascii_lowercase().ends_with(b".mtl") {
                self.read_library(&std::mem::take(&mut name), files);
            }
        }
        if !name.is_empty() {
            self.read_library(&name, files);
        }
    }

    fn read_library(&mut self, name: &[u8], files: &Files) {
        let name = String::from_utf8_lossy(name).into_owned();
        if self.libraries.contains(&name) {
            return;
        }
        if self.libraries.len() == MAX_LIBRARIES {
            self.found.libraries_left_out += 1;
            return;
        }
        match borrowing(files.budget, || files.read_path(&name).and_then(|bytes| mtl::read(&bytes))) {
            Ok((materials, bad)) => {
                self.found.bad_statements += bad;
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
        self.libraries.push(name);
    }

    /// Whether any material has a normal map, or a bump map that may be one.
    pub(super) fn may_have_normal_maps(&self) -> bool {
        let mut maps = self.described.values().flat_map(|material| material.textures.keys());
        maps.any(|map| matches!(map, MtlMap::Normal | MtlMap::Bump))
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
        let (material, textures) = self.make();
        let index = faces.material(material)?;
        // One place serves all images of a material.
        let place = textures.first().map(|(.., texture)| [texture.scale, texture.offset].map(Vec2::from));
        self.places.extend(place.filter(|place| *place != [Vec2::ONE, Vec2::ZERO]).map(|place| (index, place)));
        let mut used = Vec::new();
        for (map, factor, texture) in textures {
            if map == MtlMap::Displacement {
                self.heights.push((index, texture));
            } else {
                used.push(UsedMap { map, factor, file: texture.file });
            }
        }
        self.used.push((index, used));
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

    /// The material of the next faces, and its textures with their factors, which are read last.
    fn make(&mut self) -> (Material, Vec<(MtlMap, f32, MtlTexture)>) {
        if self.name.is_empty() {
            return (Material::plain("default", [1.0; 4]), Vec::new());
        }
        let shown = String::from_utf8_lossy(&self.name).into_owned();
        let Some(described) = self.described.get(&self.name) else {
            self.found.undescribed += 1;
            return (Material::plain(&shown, [1.0; 4]), Vec::new());
        };
        let &MtlMaterial { color: [r, g, b], emissive, alpha, transparency, roughness, metallic, .. } = described;
        // Programs write both, or one of them.
        let alpha = if alpha == 1.0 { 1.0 - transparency } else { alpha };
        self.found.bumped += usize::from(described.textures.contains_key(&MtlMap::Bump));
        let with_factor = |(map, texture): (_, &MtlTexture)| (map, described.factor(map, texture), texture.clone());
        let textures: Vec<_> = described.maps().map(with_factor).collect();
        let wrap = textures.first().map_or(Wrap::Repeat, |(.., texture)| texture.wrap);
        // Some programs write 0 for what they show as opaque.
        let is_transparent = alpha > 0.0 && alpha < 1.0;
        let own = Look::default();
        let look = Look {
            roughness: roughness.unwrap_or(own.roughness),
            metallic: metallic.unwrap_or(own.metallic),
            emissive,
            alpha: if is_transparent { Alpha::Blend } else { Alpha::Opaque },
            ..own
        };
        let sampling = Sampling { wrap: [wrap; 2], ..Sampling::default() };
        let base_color = [r, g, b, if is_transparent { alpha } else { 1.0 }];
        (Material { sampling, look, ..Material::plain(&shown, base_color) }, textures)
    }

    /// Reads all textures, and scales the largest down until they fit. `freed` is the memory that is freed before the mesh is
    /// finished, in bytes.
    ///
    /// # Errors
    /// [`ReadError::Cancelled`].
    pub(super) fn read_images(&mut self, faces: &mut FaceBuilder, files: &Files, freed: u64) -> Result<(), ReadError> {
        let used = std::mem::take(&mut self.used);
        let uses = || used.iter().flat_map(|(index, maps)| maps.iter().map(move |own| (*index, own)));
        // By file, how many materials have it as a bump map, and how many as another map.
        let mut users: HashMap<&str, [usize; 2]> = HashMap::new();
        uses().for_each(|(_, own)| users.entry(&own.file).or_default()[usize::from(own.map != MtlMap::Bump)] += 1);
        let reserved = faces.bytes_to_finish().saturating_sub(freed);
        // Textures can be scaled down to the room that heights leave.
        self.read_heights(faces, files, reserved)?;
        let mut seen = HashSet::new();
        let first: Vec<_> = uses().filter(|(_, own)| seen.insert(&own.file)).collect();
        let bytes = |(_, own): (usize, &UsedMap)| Ok((Cow::Owned(files.read_path(&own.file)?), own.map.filter()));
        let read = read_images(&first, bytes, reserved, files.budget, files.progress)?;
        let mut images = HashMap::new();
        for ((index, own), ReadImage { texture, said }) in first.into_iter().zip(read) {
            let [bumps, others] = users[&*own.file];
            let is_of_normals = bumps > 0 && texture.as_ref().is_some_and(|texture| are_normals(texture));
            if is_of_normals {
                self.found.bumped -= bumps;
                self.found.with_normals_as_bumps += bumps;
            } else if others == 0 {
                // Heights aren't drawn.
                files.budget.release(texture.map_or(0, |texture| decoded_bytes(texture.size)));
                continue;
            }
            let (image, material) = (shown(own.file.as_bytes()), &faces.builder.material_mut(index).name);
            self.problems.extend(said.map(|said| format!("the texture {image} of material \"{material}\" {said}")));
            images.extend(texture.map(|texture| (&*own.file, (texture, is_of_normals))));
        }
        let mut giving = Giving::default();
        for (index, maps) in &used {
            let given = maps.iter().filter_map(|own| {
                let (texture, is_of_normals) = images.get(&*own.file)?;
                (own.map != MtlMap::Bump || *is_of_normals).then_some((own, texture))
            });
            let given: Vec<_> = given.collect();
            self.problems.extend(giving.give(faces.builder.material_mut(*index), &given, files.budget));
        }
        Ok(())
    }

    fn read_heights(&mut self, faces: &mut FaceBuilder, files: &Files, reserved: u64) -> Result<(), ReadError> {
        let mut images = ModelImages::new(files);
        images.reserved = reserved;
        for (index, MtlTexture { file, amount, .. }) in self.heights.drain(..) {
            let (material, image) = (faces.builder.material_mut(index), shown(file.as_bytes()));
            let bytes = || files.read_path(&file).map(Cow::Owned);
            let (names, used) = ([&*image, &*material.name], (amount, material.sampling.wrap));
            material.height = images.read(file.clone(), names, used, false, bytes)?;
        }
        self.problems.extend(images.warnings);
        Ok(())
    }

    /// Returns what is missing or broken, one sentence each.
    pub(super) fn warnings(&mut self) -> Vec<String> {
        std::mem::take(&mut self.problems).into_iter().chain(self.found.sentences()).collect()
    }
}

#[cfg(test)]
mod tests;

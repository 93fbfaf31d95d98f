//! The materials of an OBJ file. Files in its folder describe them; each is made when a face first uses it.

use std::collections::HashMap;
use std::sync::Arc;

use super::mtl::{self, MtlMaterial};
use crate::load::face_builder::{FaceBuilder, counted};
use crate::load::images::decode_texture;
use crate::load::memory_budget::Budget;
use crate::load::read_error::ReadError;
use crate::load::text_lines::{shown, words};
use crate::load::uri::Files;
use crate::mesh::{Material, MemoryAccount, Texture};

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
        let index = faces.material(self.make())?;
        self.indices.insert(self.name.clone(), index);
        self.index = Some(index);
        Ok(index)
    }

    fn make(&mut self) -> Material {
        if self.name.is_empty() {
            return Material::plain("default", [1.0; 4]);
        }
        let shown = String::from_utf8_lossy(&self.name).into_owned();
        let Some(described) = self.described.get(&self.name).cloned() else {
            self.undescribed += 1;
            return Material::plain(&shown, [1.0; 4]);
        };
        let [r, g, b] = described.color;
        let texture = described.texture.and_then(|name| self.texture(&name, &shown));
        Material { texture, ..Material::plain(&shown, [r, g, b, 1.0]) }
    }

    fn texture(&mut self, name: &str, material: &str) -> Option<Arc<Texture>> {
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
            (self.bad_statements, "colours in material files that can't be read, left out"),
            (self.libraries_left_out, "material files beyond the first 64, left out"),
            (self.undescribed, "materials that no material file describes, shown white"),
        ]));
        warnings
    }

    /// Reads a file in the OBJ file's folder or below it, under the same rules as a glTF document's URIs.
    fn beside(&self, name: &str) -> Result<Vec<u8>, String> {
        self.files.read(&name.replace('%', "%25").replace('\\', "/"), false)
    }
}

#[cfg(test)]
mod tests;

//! The materials of an OBJ file. Files in its folder describe them; each is made when a face first uses it.

use std::collections::HashMap;
use std::sync::Arc;

use super::mtl::{self, MtlMaterial};
use crate::load::face_builder::{FaceBuilder, counted};
use crate::load::images::{decode_halved, texture_size};
use crate::load::memory_budget::Budget;
use crate::load::read_error::ReadError;
use crate::load::text_lines::{shown, words};
use crate::load::texture_room::{Scaling, TextureRoom};
use crate::load::uri::Files;
use crate::mesh::mipmap::MipFilter;
use crate::mesh::{Material, MemoryAccount};
use crate::progress::Progress;

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
    /// The names of texture files, in order, with the materials that use them: index and name.
    textures: Vec<(String, Vec<(usize, String)>)>,
    /// Places in that list by file name.
    places: HashMap<String, usize>,
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
            textures: Vec::new(),
            places: HashMap::new(),
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
        let (material, texture) = self.make();
        let user = material.name.clone();
        let index = faces.material(material)?;
        if let Some(texture) = texture {
            let place = *self.places.entry(texture.clone()).or_insert(self.textures.len());
            if place == self.textures.len() {
                self.textures.push((texture, Vec::new()));
            }
            self.textures[place].1.push((index, user));
        }
        self.indices.insert(self.name.clone(), index);
        self.index = Some(index);
        Ok(index)
    }

    /// The material of the next faces, and the name of its texture's file.
    fn make(&mut self) -> (Material, Option<String>) {
        if self.name.is_empty() {
            return (Material::plain("default", [1.0; 4]), None);
        }
        let shown = String::from_utf8_lossy(&self.name).into_owned();
        let Some(described) = self.described.get(&self.name).cloned() else {
            self.undescribed += 1;
            return (Material::plain(&shown, [1.0; 4]), None);
        };
        let [r, g, b] = described.color;
        (Material::plain(&shown, [r, g, b, 1.0]), described.texture)
    }

    /// Reads all textures, and scales the largest down until they fit. `freed` is the memory that is freed before the mesh is
    /// finished, in bytes.
    ///
    /// # Errors
    /// [`ReadError::Cancelled`].
    pub(super) fn read_textures(
        &mut self,
        faces: &mut FaceBuilder,
        freed: u64,
        progress: &Progress,
    ) -> Result<(), ReadError> {
        let textures = std::mem::take(&mut self.textures);
        let size =
            |(name, _): &(String, _)| self.borrowing(|| self.beside(name).ok().and_then(|bytes| texture_size(&bytes)));
        let sizes: Vec<_> = textures.iter().map(|texture| size(texture).unwrap_or_default()).collect();
        let room = TextureRoom::of(self.budget, faces.bytes_to_finish().saturating_sub(freed));
        for (((name, users), size), Scaling { halvings, reason }) in
            textures.iter().zip(&sizes).zip(room.scalings(&sizes))
        {
            progress.check()?;
            let decode = |bytes: Vec<u8>| decode_halved(&bytes, halvings, MipFilter::Colors, self.budget);
            let texture = self.borrowing(|| self.beside(name).and_then(decode)).map(Arc::new);
            let said = match &texture {
                Err(reason) => Some(format!("is left out: {reason}")),
                Ok(texture) => {
                    let [[a, b], [c, d]] = [*size, texture.size];
                    (halvings > 0).then(|| format!("is scaled down from {a} x {b} px to {c} x {d} px: {reason}"))
                }
            };
            let first = users.first().map_or("", |(_, name)| name);
            let image = shown(name.as_bytes());
            self.problems.extend(said.map(|said| format!("the texture {image} of material \"{first}\" {said}.")));
            if let Ok(texture) = texture {
                users.iter().for_each(|(material, _)| faces.texture(*material, &texture));
            }
        }
        Ok(())
    }

    /// Gives back what `read` borrows.
    fn borrowing<T>(&self, read: impl FnOnce() -> T) -> T {
        let borrowed = self.budget.borrowed();
        let result = read();
        self.budget.give_back_to(borrowed);
        result
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

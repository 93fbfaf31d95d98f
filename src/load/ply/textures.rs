//! The images that comments of a PLY file name (`comment TextureFile wood.png`), as MeshLab and programs for scans write them. A face
//! shows that of its `texnumber`, or the first one.

use std::sync::Arc;

use crate::load::face_builder::FaceBuilder;
use crate::load::images::{decode_halved, texture_size};
use crate::load::memory_budget::Budget;
use crate::load::read_error::ReadError;
use crate::load::text_lines::{first_word, shown};
use crate::load::texture_room::TextureRoom;
use crate::load::uri::Files;
use crate::mesh::mipmap::MipFilter;
use crate::mesh::{Material, borrowing};
use crate::names;
use crate::progress::Progress;

/// How many images are read. Each is a material of its own.
const MAX_IMAGES: usize = 256;

/// Returns the name of an image, if a comment names one.
pub(super) fn named(comment: &[u8]) -> Option<&[u8]> {
    let (word, name) = first_word(comment);
    (word == b"TextureFile" && !name.is_empty()).then_some(name)
}

/// The images of a file.
pub(super) struct Textures<'a> {
    names: &'a [&'a [u8]],
    /// The material of each that is used.
    materials: Vec<Option<usize>>,
}

impl<'a> Textures<'a> {
    pub(super) fn new(names: &'a [&'a [u8]]) -> Self {
        let names = &names[..names.len().min(MAX_IMAGES)];
        Self { names, materials: vec![None; names.len()] }
    }

    pub(super) fn len(&self) -> usize {
        self.names.len()
    }

    /// Returns the index of the material that shows an image; none if there is no such image.
    ///
    /// # Errors
    /// [`ReadError::TooMany`].
    pub(super) fn material(&mut self, faces: &mut FaceBuilder, image: usize) -> Result<Option<usize>, ReadError> {
        let Some(known) = self.materials.get_mut(image) else { return Ok(None) };
        if known.is_none() {
            let name = names::shown(&String::from_utf8_lossy(self.names[image]));
            *known = Some(faces.material(Material::plain(&name, [1.0; 4]))?);
        }
        Ok(*known)
    }

    /// Reads the images of materials, and scales the largest down until all fit. `freed` is the memory that is freed before the mesh is
    /// finished, in bytes. Returns what is wrong with them, one sentence each.
    ///
    /// # Errors
    /// [`ReadError::Cancelled`].
    pub(super) fn give(
        &self,
        faces: &mut FaceBuilder,
        (files, budget): (&Files, &Budget),
        freed: u64,
        progress: &Progress,
    ) -> Result<Vec<String>, ReadError> {
        let used = || self.names.iter().zip(&self.materials).filter_map(|(name, material)| Some((*name, (*material)?)));
        let read = |name: &[u8]| files.read_path(&String::from_utf8_lossy(name));
        let size = |name: &[u8]| {
            borrowing(budget, || read(name).ok().and_then(|bytes| texture_size(&bytes)).unwrap_or_default())
        };
        let sizes: Vec<_> = used().map(|(name, _)| size(name)).collect();
        let room = TextureRoom::of(budget, faces.bytes_to_finish().saturating_sub(freed));
        let mut problems = Vec::new();
        for (((name, material), size), scaling) in used().zip(&sizes).zip(room.scalings(&sizes)) {
            progress.check()?;
            let decode = |bytes: Vec<u8>| decode_halved(&bytes, scaling.halvings, MipFilter::Colors, budget);
            let texture = borrowing(budget, || read(name).and_then(decode));
            let said = scaling.said(*size, texture.as_ref().map(|texture| texture.size));
            problems.extend(said.map(|said| format!("the texture {} {said}", shown(name))));
            if let Ok(texture) = texture {
                faces.material_mut(material).texture = Some(Arc::new(texture));
            }
        }
        Ok(problems)
    }
}

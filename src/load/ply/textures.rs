//! The images that comments of a PLY file name (`comment TextureFile wood.png`), as MeshLab and programs for scans write them. A face
//! shows that of its `texnumber`, or the first one.

use std::borrow::Cow;

use crate::face_builder::FaceBuilder;
use crate::read_error::ReadError;
use crate::text_lines::{first_word, shown};
use crate::texture_room::read_images;
use crate::uri::Files;
use geometry::mesh::Material;
use geometry::mesh::mipmap::MipFilter;
use geometry::names;

/// How many images are read. Each is a material of its own.
const MAX_IMAGES: usize = 256;

/// Returns the name of an image, if a comment names one.
pub(super) fn named(comment: &[u8]) -> Option<&[u8]> {
    let (word, name) = first_word(comment);
    (word == b"TextureFile" && !name.is_empty()).then_some(name)
}

/// The images of a file.
pub(super) struct Textures<'a> {
    pub names: &'a [&'a [u8]],
    /// The material of each that is used.
    materials: Vec<Option<usize>>,
}

impl<'a> Textures<'a> {
    pub(super) fn new(names: &'a [&'a [u8]]) -> Self {
        let names = &names[..names.len().min(MAX_IMAGES)];
        Self { names, materials: vec![None; names.len()] }
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
    pub(super) fn give(&self, faces: &mut FaceBuilder, files: &Files, freed: u64) -> Result<Vec<String>, ReadError> {
        let used: Vec<_> = self.names.iter().zip(&self.materials).filter(|(_, own)| own.is_some()).collect();
        let bytes = |(name, _): (&&[u8], _)| {
            let bytes = files.read_path(&String::from_utf8_lossy(name))?;
            Ok((Cow::Owned(bytes), MipFilter::Colors))
        };
        let reserved = faces.bytes_to_finish().saturating_sub(freed);
        let images = read_images(&used, bytes, reserved, files.budget, files.progress)?;
        let mut problems = Vec::new();
        for ((name, material), image) in used.into_iter().zip(images) {
            problems.extend(image.said.map(|said| format!("the texture {} {said}", shown(name))));
            if let Some(material) = material.filter(|_| image.texture.is_some()) {
                faces.builder.material_mut(material).texture = image.texture;
            }
        }
        Ok(problems)
    }
}

//! Unpacks the images of textures, and gives them to the materials that show them.

use std::borrow::Cow;
use std::collections::{BTreeMap, HashMap};
use std::io::Read;
use std::sync::Arc;

use super::archive::Archive;
use super::document::Document;
use super::properties::Group;
use crate::face_builder::FaceBuilder;
use crate::memory_budget::Budget;
use crate::read_error::ReadError;
use crate::texture_room::{ReadImage, read_images};
use geometry::mesh::mipmap::MipFilter;
use geometry::mesh::{Alpha, Texture};
use geometry::names::shown;
use geometry::progress::{Cancelled, Progress};

/// The images of all textures that a group of coordinates names, packed as PNG or JPEG: the bytes of each by its name in the archive, or
/// why it isn't there, as a clause.
pub(super) struct Images(HashMap<String, Result<Vec<u8>, String>>);

impl Images {
    /// Unpacks the images. The budget holds their bytes.
    pub(super) fn unpack(
        archive: &Archive,
        document: &Document,
        budget: &Budget,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        let mut bytes = HashMap::new();
        for part in &document.parts {
            // The order decides which images still fit.
            let groups: BTreeMap<_, _> = part.groups.iter().collect();
            let of_group =
                |group: &Group| if let Group::Texture { texture, .. } = group { Some(*texture) } else { None };
            let textures = groups.values().filter_map(|group| part.textures.get(&of_group(group)?));
            for texture in textures {
                progress.check()?;
                let path = &texture.path;
                if !bytes.contains_key(path) {
                    bytes.insert(path.clone(), unpacked(archive, path, budget));
                }
            }
        }
        Ok(Self(bytes))
    }

    /// Decodes the images that materials show, each given by a material's index and an image's name, and scales the largest down until all fit. `freed` is the memory that is freed before the
    /// mesh is finished, in bytes. What is wrong with an image costs a note.
    pub(super) fn give(
        self,
        textured: &[(usize, String)],
        faces: &mut FaceBuilder,
        freed: u64,
        budget: &Budget,
        progress: &Progress,
    ) -> Result<(), Cancelled> {
        let mut users: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        textured.iter().for_each(|(material, path)| users.entry(path).or_default().push(*material));
        let packed = self.0.values().flatten().map(|bytes| bytes.len() as u64).sum();
        let reserved = faces.bytes_to_finish().saturating_sub(freed + packed);
        let paths: Vec<_> = users.keys().copied().collect();
        let bytes = |path| {
            let bytes = self.0.get(path).ok_or("it isn't in the file")?;
            Ok((Cow::Borrowed(bytes.as_deref().map_err(Clone::clone)?), MipFilter::Colors))
        };
        let images = read_images(&paths, bytes, reserved, budget, progress)?;
        for ((path, materials), ReadImage { texture, said }) in users.iter().zip(images) {
            faces.notes.extend(said.map(|said| format!("the texture \"{}\" {said}", shown(path))));
            let given = texture.iter().flat_map(|texture| materials.iter().map(move |material| (*material, texture)));
            given.for_each(|(material, texture)| show(faces, material, texture));
        }
        budget.release(packed);
        Ok(())
    }
}

/// Unpacks a part of the archive.
fn unpacked(archive: &Archive, path: &str, budget: &Budget) -> Result<Vec<u8>, String> {
    let part = archive.open(path).map_err(|error| match error {
        ReadError::TooLarge { reason } => format!("it {reason}"),
        other => other.to_string(),
    })?;
    let mut part = part.ok_or("it isn't in the archive")?;
    let size = part.left;
    budget.hold(size).map_err(|refused| format!("unpacking it {refused}"))?;
    // A part that is longer or shorter than it says is an error.
    let mut bytes = Vec::with_capacity(usize::try_from(size).unwrap_or(usize::MAX));
    let read = part.read_to_end(&mut bytes).map_err(|error| error.to_string());
    if read.is_err() {
        budget.release(size);
    }
    read.map(|_| bytes)
}

/// Shows an image on a material, which blends if the image has transparent texels.
fn show(faces: &mut FaceBuilder, material: usize, texture: &Arc<Texture>) {
    let material = faces.builder.material_mut(material);
    if texture.rgba.iter().skip(3).step_by(4).any(|alpha| *alpha < 255) {
        material.look.alpha = Alpha::Blend;
    }
    material.texture = Some(texture.clone());
}

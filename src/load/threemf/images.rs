//! Unpacks the images of textures, and gives them to the materials that show them.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::io::Read;
use std::sync::Arc;

use super::archive::Archive;
use super::document::Document;
use super::mixtures::{Mixture, Shown, Textured};
use super::model::Part;
use super::properties::Group;
use crate::load::face_builder::FaceBuilder;
use crate::load::images::{decode_halved, decode_texture, texture_size};
use crate::load::memory_budget::Budget;
use crate::load::notes::Notes;
use crate::load::read_error::ReadError;
use crate::load::texture_room::{Scaling, TextureRoom, decoded_bytes};
use crate::mesh::mipmap::{MipFilter, level_size};
use crate::mesh::{Alpha, MemoryAccount, Texture};
use crate::names::shown;
use crate::progress::{Cancelled, Progress};

/// The images of all textures that a group of coordinates names, packed as PNG or JPEG.
pub(super) struct Images {
    /// An image's bytes by its name in the archive, or why it isn't there, as a clause.
    bytes: HashMap<String, Result<Vec<u8>, String>>,
    /// Those that have no transparent texel, if the file has layers.
    opaque: HashSet<String>,
}

impl Images {
    /// Unpacks the images. The budget holds their bytes.
    ///
    /// # Errors
    /// [`Cancelled`].
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
        let has_layers = |part: &Part| part.groups.values().any(|group| matches!(group, Group::Layers(_)));
        let mut opaque = HashSet::new();
        if document.parts.iter().any(has_layers) {
            for (path, bytes) in &bytes {
                progress.check()?;
                if bytes.as_deref().is_ok_and(|bytes| is_opaque(bytes, budget)) {
                    opaque.insert(path.clone());
                }
            }
        }
        Ok(Self { bytes, opaque })
    }

    /// Whether all texels of an image are opaque, as far as layers need to know it.
    pub(super) fn is_opaque(&self, path: &str) -> bool {
        self.opaque.contains(path)
    }

    /// Decodes the images that materials show, blends those of layers, and scales the largest down until all fit. `freed` is the memory
    /// that is freed before the mesh is finished, in bytes. What is wrong with an image costs a note.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub(super) fn give(
        self,
        textured: &[Textured],
        faces: &mut FaceBuilder,
        (freed, budget): (u64, &Budget),
        progress: &Progress,
        notes: &mut Notes,
    ) -> Result<(), Cancelled> {
        let mut users: BTreeMap<&Shown, Vec<usize>> = BTreeMap::new();
        textured.iter().for_each(|shows| users.entry(&shows.shown).or_default().push(shows.material));
        let paths = users.keys().flat_map(|shown| match shown {
            Shown::Image { path, .. } => std::slice::from_ref(path),
            Shown::Mixture(mixture) => &mixture.images[..],
        });
        let paths: Vec<&String> = paths.collect::<BTreeSet<_>>().into_iter().collect();
        let mixtures: Vec<&Mixture> = users.keys().filter_map(|shown| shown.mixture()).collect();
        let mut sizes: Vec<[u32; 2]> = paths.iter().map(|path| self.size(path)).collect();
        let larger = |a: [u32; 2], b: [u32; 2]| [a[0].max(b[0]), a[1].max(b[1])];
        let of_mixture =
            |mixture: &Mixture| mixture.seen().map(|image| self.size(&mixture.images[image])).fold([1; 2], larger);
        sizes.extend(mixtures.iter().map(|mixture| of_mixture(mixture)));
        let packed = self.held();
        let room = TextureRoom::of(budget, faces.bytes_to_finish().saturating_sub(freed + packed));
        let scalings = room.scalings(&sizes);
        let (of_paths, of_mixtures) = scalings.split_at(paths.len());
        let mut decoded: BTreeMap<&str, Arc<Texture>> = BTreeMap::new();
        for ((path, size), scaling) in paths.iter().zip(&sizes).zip(of_paths) {
            progress.check()?;
            let (texture, said) = self.decoded(path, *size, scaling, budget);
            notes.extend(said.map(|said| format!("the texture \"{}\" {said}.", shown(path))));
            decoded.extend(texture.map(|texture| (path.as_str(), Arc::new(texture))));
        }
        let mut blended: BTreeMap<&Mixture, Arc<Texture>> = BTreeMap::new();
        for (mixture, scaling) in mixtures.iter().zip(of_mixtures) {
            let images: Vec<_> = mixture.images.iter().map(|path| decoded.get(path.as_str()).cloned()).collect();
            let seen = mixture.seen().filter_map(|image| images[image].as_deref());
            let size = seen.map(|image| image.size).fold([1; 2], larger);
            let size = level_size(size, scaling.halvings.saturating_sub(halvings_of(mixture, &paths, of_paths)));
            match budget.hold(decoded_bytes(size)) {
                Ok(()) => {
                    blended.insert(mixture, Arc::new(mixture.blend(&images, size, progress)?));
                }
                Err(refused) => {
                    notes.push_once(format!("layers of textures are left out: an image of them {refused}."))
                }
            }
        }
        for (shown, materials) in &users {
            let (texture, hides) = match shown {
                Shown::Image { path, hides } => (decoded.get(path.as_str()), *hides),
                Shown::Mixture(mixture) => (blended.get(mixture), false),
            };
            let Some(texture) = texture else { continue };
            materials.iter().for_each(|&material| show(faces, material, texture, hides));
        }
        // Those that only layers needed.
        let is_shown =
            |path: &str| users.keys().any(|shown| matches!(shown, Shown::Image { path: own, .. } if own == path));
        let unneeded = decoded.iter().filter(|(path, _)| !is_shown(path));
        budget.release(packed + unneeded.map(|(_, texture)| decoded_bytes(texture.size)).sum::<u64>());
        Ok(())
    }

    /// An image's size in px; 0 if it isn't one that is read.
    fn size(&self, path: &str) -> [u32; 2] {
        self.of(path).ok().and_then(texture_size).unwrap_or_default()
    }

    fn of(&self, path: &str) -> Result<&[u8], String> {
        let bytes = self.bytes.get(path).ok_or("it isn't in the file")?;
        bytes.as_deref().map_err(Clone::clone)
    }

    /// Decodes an image, and says what is wrong with it or that it was scaled down.
    fn decoded(
        &self,
        path: &str,
        size: [u32; 2],
        Scaling { halvings, reason }: &Scaling,
        budget: &Budget,
    ) -> (Option<Texture>, Option<String>) {
        let borrowed = budget.borrowed();
        let texture = self.of(path).and_then(|bytes| decode_halved(bytes, *halvings, MipFilter::Colors, budget));
        budget.give_back_to(borrowed);
        match texture {
            Err(reason) => (None, Some(format!("is left out: {reason}"))),
            Ok(texture) => {
                let [[a, b], [c, d]] = [size, texture.size];
                let said =
                    (*halvings > 0).then(|| format!("is scaled down from {a} x {b} px to {c} x {d} px: {reason}"));
                (Some(texture), said)
            }
        }
    }

    /// How many bytes the budget holds for the images.
    fn held(&self) -> u64 {
        self.bytes.values().flatten().map(|bytes| bytes.len() as u64).sum()
    }
}

/// Whether all texels of an image are opaque. Those of JPEG images always are. An image that can't be decoded as a whole counts as
/// translucent.
fn is_opaque(bytes: &[u8], budget: &Budget) -> bool {
    if bytes.starts_with(&[0xff, 0xd8]) {
        return true;
    }
    let Ok(texture) = decode_texture(bytes, budget) else { return false };
    budget.release(decoded_bytes(texture.size));
    !is_translucent(&texture)
}

fn is_translucent(texture: &Texture) -> bool {
    texture.rgba.iter().skip(3).step_by(4).any(|alpha| *alpha < 255)
}

/// Unpacks a part of the archive.
fn unpacked(archive: &Archive, path: &str, budget: &Budget) -> Result<Vec<u8>, String> {
    let part = archive.open(path).map_err(|error| match error {
        ReadError::TooLarge { reason } => format!("it {reason}"),
        other => other.to_string(),
    })?;
    let mut part = part.ok_or("it isn't in the archive")?;
    let size = part.left();
    budget.hold(size).map_err(|refused| format!("unpacking it {refused}"))?;
    // A part that is longer or shorter than it says is an error.
    let mut bytes = Vec::with_capacity(usize::try_from(size).unwrap_or(usize::MAX));
    let read = part.read_to_end(&mut bytes).map_err(|error| error.to_string());
    if read.is_err() {
        budget.release(size);
    }
    read.map(|_| bytes)
}

/// How often the images were halved that a mixture shows: the least of them.
fn halvings_of(mixture: &Mixture, paths: &[&String], scalings: &[Scaling]) -> u32 {
    let of = |path: &String| scalings.get(paths.iter().position(|other| *other == path)?);
    let halvings = mixture.seen().filter_map(|image| of(&mixture.images[image])).map(|scaling| scaling.halvings);
    halvings.min().unwrap_or(0)
}

/// Shows an image on a material, which blends if the image has transparent texels and doesn't hide what is behind.
fn show(faces: &mut FaceBuilder, material: usize, texture: &Arc<Texture>, hides: bool) {
    let material = faces.material_mut(material);
    if !hides && is_translucent(texture) {
        material.look.alpha = Alpha::Blend;
    }
    material.texture = Some(texture.clone());
}

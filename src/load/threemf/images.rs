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
        let wanted = Wanted::new(users.keys().copied());
        let packed = self.held();
        let room = TextureRoom::of(budget, faces.bytes_to_finish().saturating_sub(freed + packed));
        let scalings = room.scalings(&wanted.sizes(&self));
        let (of_images, of_mixtures) = scalings.split_at(wanted.images.len());
        let decoded = self.decode(&wanted.images, of_images, (budget, progress), notes)?;
        let least = |mixture: &Mixture| wanted.halvings(mixture, of_images);
        let mut blended: BTreeMap<&Mixture, Arc<Texture>> = BTreeMap::new();
        for (mixture, scaling) in wanted.mixtures.iter().zip(of_mixtures) {
            let more = Scaling { halvings: scaling.halvings.saturating_sub(least(mixture)), ..scaling.clone() };
            match blend(mixture, &decoded, &more, (budget, progress), notes)? {
                Ok(texture) => _ = blended.insert(mixture, Arc::new(texture)),
                Err(reason) => notes.push_once(format!("layers of textures are left out: an image of them {reason}.")),
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
        // Those that only layers needed end here.
        let is_shown =
            |path: &str| users.keys().any(|shown| matches!(shown, Shown::Image { path: own, .. } if own == path));
        let unneeded = decoded.iter().filter(|(path, _)| !is_shown(path));
        budget.release(packed + unneeded.map(|(_, texture)| decoded_bytes(texture.size)).sum::<u64>());
        Ok(())
    }

    /// Decodes images, each halved as its scaling says. Those that can't be decoded are left out.
    fn decode<'p>(
        &self,
        paths: &[&'p str],
        scalings: &[Scaling],
        (budget, progress): (&Budget, &Progress),
        notes: &mut Notes,
    ) -> Result<BTreeMap<&'p str, Arc<Texture>>, Cancelled> {
        let mut decoded = BTreeMap::new();
        for (path, scaling) in paths.iter().zip(scalings) {
            progress.check()?;
            let texture =
                self.of(path).and_then(|bytes| decode_halved(bytes, scaling.halvings, MipFilter::Colors, budget));
            let said = scaling.said(self.size(path), texture.as_ref().map(|texture| texture.size));
            notes.extend(said.map(|said| format!("the texture \"{}\" {said}", shown(path))));
            decoded.extend(texture.ok().map(|texture| (*path, Arc::new(texture))));
        }
        Ok(decoded)
    }

    /// An image's size in px; 0 if it isn't one that is read.
    fn size(&self, path: &str) -> [u32; 2] {
        self.of(path).ok().and_then(texture_size).unwrap_or_default()
    }

    fn of(&self, path: &str) -> Result<&[u8], String> {
        let bytes = self.bytes.get(path).ok_or("it isn't in the file")?;
        bytes.as_deref().map_err(Clone::clone)
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

/// The images that are needed: those of the archive by their names, and those that are blended of layers.
struct Wanted<'s> {
    images: Vec<&'s str>,
    mixtures: Vec<&'s Mixture>,
}

impl<'s> Wanted<'s> {
    fn new(shown: impl Iterator<Item = &'s Shown> + Clone) -> Self {
        let images = shown.clone().flat_map(|shown| match shown {
            Shown::Image { path, .. } => std::slice::from_ref(path),
            Shown::Mixture(mixture) => &mixture.images[..],
        });
        let images: BTreeSet<_> = images.map(String::as_str).collect();
        Self { images: images.into_iter().collect(), mixtures: shown.filter_map(Shown::mixture).collect() }
    }

    /// The sizes of all, in px. A mixture is as large as the largest image that it shows.
    fn sizes(&self, images: &Images) -> Vec<[u32; 2]> {
        let of = |path: &&str| images.size(path);
        let of_mixture =
            |mixture: &&Mixture| mixture.seen().map(|image| images.size(&mixture.images[image])).fold([1; 2], larger);
        self.images.iter().map(of).chain(self.mixtures.iter().map(of_mixture)).collect()
    }

    /// How often the images were halved that a mixture shows: the least of them.
    fn halvings(&self, mixture: &Mixture, scalings: &[Scaling]) -> u32 {
        let of = |path: &String| scalings.get(self.images.iter().position(|other| other == path)?);
        let halvings = mixture.seen().filter_map(|image| of(&mixture.images[image])).map(|scaling| scaling.halvings);
        halvings.min().unwrap_or(0)
    }
}

/// Blends layers into an image, which is halved as often as `more` says beside the images that it shows. The budget holds it. Returns a
/// clause if it takes too much memory.
fn blend(
    mixture: &Mixture,
    decoded: &BTreeMap<&str, Arc<Texture>>,
    more: &Scaling,
    (budget, progress): (&Budget, &Progress),
    notes: &mut Notes,
) -> Result<Result<Texture, String>, Cancelled> {
    let images: Vec<_> = mixture.images.iter().map(|path| decoded.get(path.as_str()).cloned()).collect();
    let whole = mixture.seen().filter_map(|image| images[image].as_deref()).map(|image| image.size);
    let whole = whole.fold([1; 2], larger);
    let size = level_size(whole, more.halvings);
    if let Err(refused) = budget.hold(decoded_bytes(size)) {
        return Ok(Err(refused.into()));
    }
    if let Some(said) = more.said(whole, Ok(size)) {
        let name = mixture.images.last().map_or("", String::as_str);
        notes.push_once(format!("an image of layers with the texture \"{}\" {said}", shown(name)));
    }
    Ok(Ok(mixture.blend(&images, size, progress)?))
}

fn larger(a: [u32; 2], b: [u32; 2]) -> [u32; 2] {
    [a[0].max(b[0]), a[1].max(b[1])]
}

/// Shows an image on a material, which blends if the image has transparent texels and doesn't hide what is behind.
fn show(faces: &mut FaceBuilder, material: usize, texture: &Arc<Texture>, hides: bool) {
    let material = faces.material_mut(material);
    if !hides && is_translucent(texture) {
        material.look.alpha = Alpha::Blend;
    }
    material.texture = Some(texture.clone());
}

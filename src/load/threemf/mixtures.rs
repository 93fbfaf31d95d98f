//! Images that are blended from layers.

use std::sync::Arc;

use glam::{Vec3, Vec4};

use super::layers::{Method, blended};
use crate::face_builder::linear_color;
use geometry::mesh::Texture;
use geometry::mesh::mipmap::encoded;
use geometry::progress::{Cancelled, Progress};

/// A material that shows an image.
pub(super) struct Textured {
    /// Its index in the face builder.
    pub material: usize,
    pub shown: Shown,
}

/// The image that a material shows.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Shown {
    /// An image of the archive, by its name there, and whether it hides what is behind whatever its alpha is.
    Image {
        path: String,
        hides: bool,
    },
    Mixture(Mixture),
}

impl Shown {
    pub(super) fn mixture(&self) -> Option<&Mixture> {
        match self {
            Self::Mixture(mixture) => Some(mixture),
            Self::Image { .. } => None,
        }
    }
}

/// Layers that are blended at each texel of an image, the lowest first.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) struct Mixture {
    /// The names of images in the archive.
    pub images: Vec<String>,
    pub layers: Vec<(Source, Method)>,
    /// Whether the lowest layer is a material (see [`blended`]).
    pub has_material: bool,
}

/// Where the colour of a layer comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) enum Source {
    /// The bits of linear RGBA.
    Color([u32; 4]),
    /// One of the images.
    Image(usize),
    /// The mean of one of the images.
    Mean(usize),
}

impl Source {
    pub(super) fn of_color(color: Vec4) -> Self {
        Self::Color(color.to_array().map(f32::to_bits))
    }
}

/// What a layer is at a texel.
enum Sampled<'t> {
    Color(Vec4),
    Image(&'t Texture),
}

impl Mixture {
    /// The index of an image, which is added if it isn't there.
    pub(super) fn image(&mut self, path: &str) -> usize {
        self.images.iter().position(|image| image == path).unwrap_or_else(|| {
            self.images.push(path.to_owned());
            self.images.len() - 1
        })
    }

    /// The indices of images that are seen themselves.
    pub(super) fn seen(&self) -> impl Iterator<Item = usize> {
        self.layers.iter().filter_map(|(source, _)| match source {
            Source::Image(image) => Some(*image),
            Source::Color(_) | Source::Mean(_) => None,
        })
    }

    /// Blends the layers into an image of this size in px. Layers of images that aren't there are left out.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub(super) fn blend(
        &self,
        images: &[Option<Arc<Texture>>],
        size: [u32; 2],
        progress: &Progress,
    ) -> Result<Texture, Cancelled> {
        let image = |index: usize| images.get(index).and_then(Option::as_deref);
        let sampled = |(source, method): &(Source, Method)| {
            let sampled = match source {
                Source::Color(bits) => Sampled::Color(bits.map(f32::from_bits).into()),
                Source::Image(index) => Sampled::Image(image(*index)?),
                Source::Mean(index) => Sampled::Color(mean(image(*index)?)),
            };
            Some((sampled, *method))
        };
        let layers: Vec<_> = self.layers.iter().filter_map(sampled).collect();
        let mut point = Vec::with_capacity(layers.len());
        let mut rgba = Vec::with_capacity(4 * size[0] as usize * size[1] as usize);
        for y in 0..size[1] {
            progress.check()?;
            for x in 0..size[0] {
                point.clear();
                point.extend(layers.iter().map(|(sampled, method)| match sampled {
                    Sampled::Color(color) => (*color, *method),
                    Sampled::Image(texture) => (texel([x, y], size, texture), *method),
                }));
                let color = blended(&point, self.has_material);
                let bytes = encoded(color.truncate()).extend((255.0 * color.w + 0.5).floor());
                rgba.extend(bytes.to_array().map(|byte| byte as u8));
            }
        }
        Ok(Texture { size, rgba })
    }
}

/// Returns an image's colour at the centre of a texel of another one that covers the same: linear RGBA, interpolated between the
/// centres of four texels if the sizes differ.
fn texel(at: [u32; 2], size: [u32; 2], texture: &Texture) -> Vec4 {
    let load = |x: u32, y: u32| {
        let start = 4 * (y as usize * texture.size[0] as usize + x as usize);
        let bytes = texture.rgba.get(start..).and_then(|rgba| rgba.first_chunk::<4>());
        bytes.map_or(Vec4::ZERO, |bytes| linear_color(*bytes))
    };
    if texture.size == size {
        return load(at[0], at[1]);
    }
    let along = |axis: usize| {
        let [own, other] = [size[axis], texture.size[axis]].map(|side| side as f32);
        let place = ((at[axis] as f32 + 0.5) / own * other - 0.5).clamp(0.0, other - 1.0);
        let first = place.floor();
        ([first as u32, (first as u32 + 1).min(texture.size[axis] - 1)], place - first)
    };
    let ([left, right], across) = along(0);
    let ([top, bottom], down) = along(1);
    let row = |y: u32| load(left, y).lerp(load(right, y), across);
    row(top).lerp(row(bottom), down)
}

/// The mean of an image in linear RGBA. Each texel's colour counts as much as its alpha.
fn mean(texture: &Texture) -> Vec4 {
    let mut sum = [0.0_f64; 4];
    for bytes in texture.rgba.as_chunks::<4>().0 {
        let color = linear_color(*bytes);
        let weighted = (color.truncate() * color.w).extend(color.w);
        sum.iter_mut().zip(weighted.to_array()).for_each(|(sum, channel)| *sum += f64::from(channel));
    }
    let [r, g, b, alpha] = sum;
    let count = (texture.rgba.len() / 4).max(1) as f64;
    match alpha > 0.0 {
        true => Vec3::from([r, g, b].map(|channel| (channel / alpha) as f32)).extend((alpha / count) as f32),
        false => Vec4::ZERO,
    }
}

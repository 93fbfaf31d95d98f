//! Smaller levels of images: twin of `shaders/mipmap.wgsl`.
//!
//! A level has half the width and height of the one before, rounded down. A texel of it is the average of 2 x 2 texels. Where a side
//! of `n = 2 m + 1` texels is odd, texel `i` of the smaller level is made of three, with weights `(m - i) / n`, `m / n` and
//! `(i + 1) / n`: each texel then counts as much as any other (Guthe and Heckbert 2005, "Non-Power-of-Two Mipmapping").

use crate::names::every;
use std::collections::VecDeque;
use std::sync::LazyLock;

use glam::{Vec3, Vec4, vec3};

use super::{Alpha, Slot, Texture};
use crate::casts::to_f32;

/// How the texels of an image are averaged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum MipFilter {
    /// Colours in linear light. Alpha has no part in them.
    Colors,
    /// Colours in linear light, each as much as its alpha says: what isn't seen adds no fringe.
    AlphaWeighted,
    /// Numbers.
    Numbers,
    /// Normals, which are made unit vectors again.
    Normals,
}

impl MipFilter {
    pub const ALL: [Self; 4] = every![MipFilter: Colors, AlphaWeighted, Numbers, Normals];

    /// That of the base colour's image of a material whose alpha does this.
    pub fn from_base_color(alpha: Alpha) -> Self {
        if alpha == Alpha::Opaque { Self::Colors } else { Self::AlphaWeighted }
    }

    /// That of a map.
    pub fn from_map(slot: Slot) -> Self {
        match slot {
            Slot::Emissive | Slot::SheenColor | Slot::SpecularColor => Self::Colors,
            Slot::Normal | Slot::ClearcoatNormal => Self::Normals,
            Slot::MetallicRoughness | Slot::Occlusion | Slot::Transmission | Slot::SheenRoughness => Self::Numbers,
            Slot::Clearcoat | Slot::ClearcoatRoughness | Slot::Specular => Self::Numbers,
            Slot::Anisotropy | Slot::Thickness => Self::Numbers,
        }
    }
}

/// For each byte the linear light that sRGB encodes as it; then for each the least light that is encoded as it.
pub static SRGB_TABLE: LazyLock<[f32; 512]> = LazyLock::new(|| {
    std::array::from_fn(|i| {
        let encoded = if i < 256 { i as f64 } else { ((i - 256) as f64 - 0.5).max(0.0) } / 255.0;
        // IEC 61966-2-1.
        let linear = if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) };
        to_f32(linear)
    })
});

/// The number of levels of an image of a size in px, with the image itself.
pub fn level_count(size: [u32; 2]) -> u32 {
    size[0].max(size[1]).max(1).ilog2() + 1
}

/// Width and height of a level, in px; level 0 is the image itself.
pub fn level_size(size: [u32; 2], level: u32) -> [u32; 2] {
    size.map(|side| side.checked_shr(level).unwrap_or(0).max(1))
}

/// The texels along a side that a texel of the next level is made of: `first` and up to two more.
struct Taps {
    first: u32,
    /// Whole numbers, so that sums are exact.
    weights: [f32; 3],
}

impl Taps {
    /// Of texel `target` of the level after one with `source` texels along this side.
    fn new(target: u32, source: u32) -> Self {
        let half = source / 2;
        let weights = match source {
            1 => [1, 0, 0],
            _ if source.is_multiple_of(2) => [1, 1, 0],
            _ => [half - target, half, target + 1],
        };
        Self { first: 2 * target, weights: weights.map(|weight| weight as f32) }
    }
}

/// A sum of texels.
#[derive(Clone, Copy, Default)]
struct MipSum {
    /// Of channels that are decoded.
    plain: Vec3,
    /// Of channels times alpha, and of alpha, 0 to 255.
    weighted: Vec4,
    /// Of weights.
    total: f32,
}

impl MipSum {
    fn add(&mut self, texel: [u8; 4], weight: f32, filter: MipFilter) {
        let [r, g, b, alpha] = texel;
        let decoded = Vec3::from([r, g, b].map(|byte| decoded(byte, filter)));
        let covered = weight * f32::from(alpha);
        self.plain += decoded * weight;
        self.weighted += (decoded * covered).extend(covered);
        self.total += weight;
    }

    #[expect(clippy::cast_possible_truncation, reason = "at most 255, and at most the texels of a level")]
    fn texel(&self, filter: MipFilter) -> [u8; 4] {
        let color = match filter {
            MipFilter::Numbers => self.plain / self.total,
            MipFilter::Normals => 127.5 * unit(self.plain) + 127.5,
            MipFilter::AlphaWeighted if self.weighted.w > 0.0 => encoded(self.weighted.truncate() / self.weighted.w),
            MipFilter::AlphaWeighted | MipFilter::Colors => encoded(self.plain / self.total),
        };
        color.extend(self.weighted.w / self.total).to_array().map(|channel| (channel + 0.5).floor() as u8)
    }
}

/// What a byte stands for. Normals are 255 times as long, so that their sums are exact.
fn decoded(byte: u8, filter: MipFilter) -> f32 {
    match filter {
        MipFilter::Colors | MipFilter::AlphaWeighted => SRGB_TABLE[usize::from(byte)],
        MipFilter::Numbers => f32::from(byte),
        MipFilter::Normals => 2.0 * f32::from(byte) - 255.0,
    }
}

/// The direction of a sum of normals, or straight up if they cancel out.
fn unit(normal: Vec3) -> Vec3 {
    let length = normal.dot(normal).sqrt();
    if length > 0.0 { normal / length } else { Vec3::Z }
}

/// The bytes that sRGB encodes linear light as. Looked up, so that all devices agree.
pub fn encoded(color: Vec3) -> Vec3 {
    let byte = |light: f32| {
        let above = SRGB_TABLE[256..].partition_point(|least| *least <= light);
        above.saturating_sub(1) as f32
    };
    vec3(byte(color.x), byte(color.y), byte(color.z))
}

/// Makes a row of the next level of the rows that it is made of, and their weights. `width` is theirs, in px.
fn averaged_row(rows: [&[u8]; 3], down: [f32; 3], width: u32, filter: MipFilter) -> Vec<u8> {
    let targets = level_size([width; 2], 1)[0];
    let mut made = Vec::with_capacity(4 * targets as usize);
    for target in 0..targets {
        let across = Taps::new(target, width);
        let mut sum = MipSum::default();
        for (row, down) in rows.iter().zip(down).filter(|(_, weight)| *weight > 0.0) {
            let texels = row.as_chunks::<4>().0.iter().skip(across.first as usize);
            for (texel, across) in texels.zip(across.weights).filter(|(_, weight)| *weight > 0.0) {
                sum.add(*texel, down * across, filter);
            }
        }
        made.extend(sum.texel(filter));
    }
    made
}

/// Halves an image that comes row by row, so that no more than three rows are kept.
pub struct RowHalver {
    /// Of the image that comes, in px.
    size: [u32; 2],
    filter: MipFilter,
    /// Rows that are still needed, and the number of the first of them.
    kept: VecDeque<Vec<u8>>,
    first: u32,
    /// The next row that is made.
    next: u32,
}

impl RowHalver {
    /// For an image of this size in px.
    pub fn new(size: [u32; 2], filter: MipFilter) -> Self {
        Self { size, filter, kept: VecDeque::new(), first: 0, next: 0 }
    }

    /// Takes the next row, of 4 bytes a px. Returns a row of the smaller image if one is complete.
    pub fn push(&mut self, row: Vec<u8>) -> Option<Vec<u8>> {
        self.kept.push_back(row);
        let Taps { first, weights } = Taps::new(self.next, self.size[1]);
        while self.first < first && self.kept.pop_front().is_some() {
            self.first += 1;
        }
        let needed = weights.iter().filter(|weight| **weight > 0.0).count();
        let is_over = self.next >= level_size(self.size, 1)[1];
        if self.kept.len() < needed || is_over {
            return None;
        }
        let row = |index: usize| self.kept.get(index).map_or(&[][..], Vec::as_slice);
        self.next += 1;
        Some(averaged_row([row(0), row(1), row(2)], weights, self.size[0], self.filter))
    }
}

/// The next level of an image.
pub fn halved(texture: &Texture, filter: MipFilter) -> Texture {
    let [width, height] = texture.size;
    let size = level_size(texture.size, 1);
    let row = |y: u32| {
        let Taps { first, weights } = Taps::new(y, height);
        let stride = 4 * width as usize;
        let source = |k: u32| {
            let start = (first + k) as usize * stride;
            texture.rgba.get(start..start + stride).unwrap_or_default()
        };
        averaged_row([source(0), source(1), source(2)], weights, width, filter)
    };
    let mut rgba = Vec::with_capacity(4 * size[0] as usize * size[1] as usize);
    (0..size[1]).for_each(|y| rgba.extend(row(y)));
    Texture { size, rgba }
}

/// How many texels of an image have an alpha of at least `least`.
pub fn covered(texture: &Texture, least: u32) -> u64 {
    texture.rgba.iter().skip(3).step_by(4).filter(|alpha| u32::from(**alpha) >= least).count() as u64
}

/// How many texels of a level must pass the test of alpha, so that as large a part of it does as of the image, of which `covered`
/// texels do.
#[expect(clippy::cast_possible_truncation, reason = "at most 255, and at most the texels of a level")]
pub fn wanted_texels(covered: u64, size: [u32; 2], level: u32) -> u32 {
    let texels = |size: [u32; 2]| u64::from(size[0]) * u64::from(size[1]);
    let all = texels(size).max(1);
    ((2 * covered * texels(level_size(size, level)) + all) / (2 * all)) as u32
}

/// The alpha from which on the number of texels is nearest to `wanted`, and of these the one nearest to `least`. `counts` has the
/// number of texels of each alpha.
fn covering_alpha(counts: &[u32; 256], wanted: u32, least: u32) -> u32 {
    let (mut best, mut best_error, mut count) = (256_u32, wanted, 0_u32);
    for alpha in (1..256_u32).rev() {
        count += counts[alpha as usize];
        let error = count.abs_diff(wanted);
        if error < best_error || (error == best_error && alpha.abs_diff(least) < best.abs_diff(least)) {
            (best, best_error) = (alpha, error);
        }
    }
    best
}

/// An alpha that reaches `least` only if it was at least `from`.
fn scaled_alpha(alpha: u32, from: u32, least: u32) -> u32 {
    (alpha * least / from).min(255)
}

/// All levels of an image but the first. If `least` is the least alpha that passes the test of a mask, alpha is scaled on each
/// level so that as large a part of it passes as of the image (Castaño 2010, "Computing Alpha Mipmaps").
#[expect(clippy::cast_possible_truncation, reason = "at most 255, and at most the texels of a level")]
pub fn mip_levels(texture: &Texture, filter: MipFilter, least: Option<u32>) -> Vec<Texture> {
    let mut levels: Vec<Texture> = Vec::new();
    for _ in 1..level_count(texture.size) {
        let next = halved(levels.last().unwrap_or(texture), filter);
        levels.push(next);
    }
    let Some(least) = least else { return levels };
    let all = covered(texture, least);
    for (level, made) in (1..).zip(&mut levels) {
        let mut counts = [0; 256];
        made.rgba.iter().skip(3).step_by(4).for_each(|alpha| counts[usize::from(*alpha)] += 1);
        let from = covering_alpha(&counts, wanted_texels(all, texture.size, level), least);
        let scale = |alpha: &mut u8| *alpha = scaled_alpha(u32::from(*alpha), from, least) as u8;
        made.rgba.iter_mut().skip(3).step_by(4).for_each(scale);
    }
    levels
}

#[cfg(test)]
mod tests;

//! Builds the levels of a height map.

use std::sync::Arc;

use super::{HeightMap, MAX_KEPT};
use crate::casts::to_u32;
use crate::mesh::Wrap;
use crate::progress::{Cancelled, Progress};

impl HeightMap {
    /// Makes a map from the pixels of an image, row by row from the top. Sides of more than 4,096 px are scaled down.
    /// If `size` doesn't fit the pixels, the map is one black pixel.
    pub fn new(size: [u32; 2], heights: Vec<f32>) -> Self {
        let width = size[0] as usize;
        let is_image = width > 0 && heights.len() == width * size[1] as usize && !heights.is_empty();
        let (size, width, heights) = if is_image { (size, width, heights) } else { ([1, 1], 1, vec![0.0]) };
        // The only possible error is cancellation, and no other code has this handle.
        Self::build::<Cancelled>(size, &Progress::new(), rows_of(&heights, width)).expect("not cancelled")
    }

    /// Makes a map from rows that `row` writes one by one, from the top (at least one). While it is built, the map
    /// takes up to a quarter more memory.
    ///
    /// # Errors
    /// The errors of `row`, and [`Cancelled`] when `progress` says so.
    pub fn build<E: From<Cancelled>>(
        size: [u32; 2],
        progress: &Progress,
        row: impl FnMut(&mut [f32]) -> Result<(), E>,
    ) -> Result<Self, E> {
        let fitted = size.map(|side| side.min(MAX_KEPT));
        let sizes: Vec<[u32; 2]> = std::iter::successors(Some(fitted), |&size| halved(size)).collect();
        // Exactly as much as is needed: a list that grows may take twice as much.
        let mut heights = Vec::with_capacity(sizes.iter().map(|&size| px_of(size)).sum());
        let mut done = 0.9;
        shrink(size, fitted, &progress.part(0.0, done), row, &mut heights)?;
        let [least, greatest] = [f32::min, f32::max].map(|of| heights.iter().copied().reduce(of).unwrap_or(0.0));
        let mut start = 0;
        for pair in sizes.windows(2) {
            // Each level has a quarter of the pixels of the one before.
            let end = done + 0.75 * (1.0 - done);
            let mut next = Vec::with_capacity(px_of(pair[1]));
            let rows = rows_of(&heights[start..], pair[0][0] as usize);
            shrink(pair[0], pair[1], &progress.part(done, end), rows, &mut next)?;
            start = heights.len();
            heights.extend_from_slice(&next);
            done = end;
        }
        let range = [least, greatest];
        let (levels, heights) = (to_u32(sizes.len()), Arc::new(heights));
        Ok(Self { size: fitted, levels, wrap: [Wrap::Repeat; 2], amount: None, range, heights })
    }

    /// Returns the map without its level 0; none if it has no other.
    pub fn halved(&self) -> Option<Self> {
        let (size, heights) = (halved(self.size)?, self.heights[px_of(self.size)..].to_vec());
        Some(Self { size, levels: self.levels - 1, heights: Arc::new(heights), ..self.clone() })
    }

    /// Returns how many bytes it takes to build a map from an image of this size, the map included.
    pub fn bytes_to_build(size: [u32; 2]) -> u64 {
        // All levels together have 4/3 of the pixels of the first, and level 1 is made in a list of its own.
        px_of(size.map(|side| side.min(MAX_KEPT))) as u64 * 4 * 19 / 12 + (64 << 10)
    }
}

/// The pixels of a longer row that one pixel of a shorter row is made from, with their weights, which add up to 1.
struct Taps {
    first: usize,
    weights: Vec<f32>,
}

/// Returns the weights for scaling a row of `from` pixels down to `to` pixels, or leaving it as it is. The filter is a
/// triangle with a width of two pixels of the shorter row.
#[expect(clippy::cast_possible_truncation, reason = "whole numbers within the image")]
fn taps(from: u32, to: u32) -> Vec<Taps> {
    let ratio = from as f32 / to as f32;
    let of = |i: u32| {
        let middle = (i as f32 + 0.5) * ratio;
        let first = (middle - ratio).floor().max(0.0) as u32;
        let end = ((middle + ratio).ceil() as u32).clamp(first + 1, from);
        let weight = |k: u32| (1.0 - (k as f32 + 0.5 - middle).abs() / ratio).max(0.0);
        let zeros = to_u32((first..end).take_while(|&k| weight(k) == 0.0).count());
        let weights: Vec<f32> = (first + zeros..end).map(weight).take_while(|&weight| weight > 0.0).collect();
        let sum: f32 = weights.iter().sum();
        Taps { first: (first + zeros) as usize, weights: weights.into_iter().map(|weight| weight / sum).collect() }
    };
    (0..to).map(of).collect()
}

fn px_of([width, height]: [u32; 2]) -> usize {
    width as usize * height as usize
}

/// Returns the size of the next level, if there is one.
fn halved(size: [u32; 2]) -> Option<[u32; 2]> {
    (size != [1, 1]).then(|| size.map(|side| (side / 2).max(1)))
}

/// Returns a function that writes one row of an image in memory after another.
fn rows_of<E>(px: &[f32], width: usize) -> impl FnMut(&mut [f32]) -> Result<(), E> {
    let mut rows = px.chunks_exact(width);
    move |out| {
        if let Some(row) = rows.next() {
            out.copy_from_slice(row);
        }
        Ok(())
    }
}

/// Scales an image down, or leaves it as it is, and appends it to `out`. `row` writes each row of the image, from the
/// top. Only one row of the image is in memory at a time.
fn shrink<E: From<Cancelled>>(
    from: [u32; 2],
    to: [u32; 2],
    progress: &Progress,
    mut row: impl FnMut(&mut [f32]) -> Result<(), E>,
    out: &mut Vec<f32>,
) -> Result<(), E> {
    let (columns, rows) = (taps(from[0], to[0]), taps(from[1], to[1]));
    let (width, start) = (to[0] as usize, out.len());
    out.resize(start + px_of(to), 0.0);
    let out = &mut out[start..];
    let (mut own, mut narrow) = (vec![0.0; from[0] as usize], vec![0.0; width]);
    let mut first = 0;
    for y in 0..from[1] as usize {
        progress.check()?;
        progress.set(y as f32 / from[1] as f32);
        row(&mut own)?;
        for (narrow, taps) in narrow.iter_mut().zip(&columns) {
            *narrow = taps.weights.iter().zip(&own[taps.first..]).map(|(weight, own)| weight * own).sum();
        }
        // The first and the last source row of a row never decrease from row to row.
        first += rows[first..].iter().take_while(|taps| taps.first + taps.weights.len() <= y).count();
        for (taps, out) in rows[first..].iter().zip(out[first * width..].chunks_mut(width)) {
            let Some(weight) = y.checked_sub(taps.first).and_then(|at| taps.weights.get(at)) else { break };
            out.iter_mut().zip(&narrow).for_each(|(out, narrow)| *out += weight * narrow);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_halve_down_to_one_pixel() {
        let map = HeightMap::new([5, 2], (0..10).map(|i| i as f32 / 9.0).collect());
        assert_eq!((map.size, map.levels), ([5, 2], 3));
        assert_eq!([0, 1, 2].map(|level| map.level_size(level)), [[5, 2], [2, 1], [1, 1]]);
        assert_eq!(map.heights.len(), 10 + 2 + 1);
        // The last level is about the mean.
        assert!((map.heights[12] - 0.5).abs() < 0.1, "{}", map.heights[12]);
    }

    #[test]
    fn a_halved_map_is_the_same_without_its_first_level() {
        let map = HeightMap::new([5, 2], (0..10).map(|i| i as f32 / 9.0).collect());
        let half = map.halved().expect("two more levels");
        assert_eq!((half.size, half.levels, &half.heights[..]), ([2, 1], 2, &map.heights[10..]));
        assert_eq!(half.halved().expect("a level").halved(), None, "it has one px");
    }

    #[test]
    fn invalid_images_become_one_black_pixel() {
        for bad in [HeightMap::new([0, 0], Vec::new()), HeightMap::new([3, 3], vec![1.0; 4])] {
            assert_eq!((bad.size, bad.heights.as_slice()), ([1, 1], &[0.0][..]));
        }
    }

    #[test]
    fn images_shrink_as_the_image_crate_shrinks_them() {
        use image::imageops::{FilterType, resize};
        let size = [37, 23];
        let heights: Vec<f32> =
            (0..37 * 23_u32).map(|i| (i.wrapping_mul(2_654_435_769) >> 24) as f32 / 255.0).collect();
        let image: image::ImageBuffer<image::Luma<f32>, _> =
            image::ImageBuffer::from_raw(37, 23, heights.clone()).expect("all px");
        for to in [[37, 23], [18, 11], [37, 1], [5, 23], [1, 1]] {
            let mut own = Vec::new();
            let rows = rows_of::<Cancelled>(&heights, 37);
            shrink(size, to, &Progress::new(), rows, &mut own).expect("not cancelled");
            let peer = resize(&image, to[0], to[1], FilterType::Triangle).into_raw();
            let farthest = own.iter().zip(&peer).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(own.len() == peer.len() && farthest < 1e-5, "{to:?}: {farthest}");
        }
    }

    #[test]
    fn building_can_be_cancelled() {
        let progress = Progress::new();
        progress.cancel();
        assert_eq!(HeightMap::build::<Cancelled>([64, 64], &progress, |_| Ok(())), Err(Cancelled));
    }
}

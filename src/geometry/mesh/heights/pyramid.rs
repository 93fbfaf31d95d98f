//! Builds the levels of a height map, and measures how much detail each level loses.

use super::{HeightMap, MAX_KEPT, MAX_LEVELS};
use crate::casts::to_u32;
use crate::cores::in_ranges;
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
        Ok(Self { size: fitted, levels: to_u32(sizes.len()), repeats: false, heights })
    }

    /// Returns how many bytes it takes to build a map from an image of this size, the map included.
    pub fn bytes_to_build(size: [u32; 2]) -> u64 {
        // All levels together have 4/3 of the pixels of the first, and level 1 is made in a list of its own.
        px_of(size.map(|side| side.min(MAX_KEPT))) as u64 * 4 * 19 / 12 + (64 << 10)
    }

    /// Returns, for each level, the greatest difference between that level, interpolated linearly, and level 0. The
    /// difference never decreases from level to level.
    ///
    /// # Errors
    /// [`Cancelled`] when `progress` says so.
    pub(super) fn detail(&self, progress: &Progress) -> Result<[f32; MAX_LEVELS], Cancelled> {
        let mut detail = [0.0_f32; MAX_LEVELS];
        let part = |level: usize| (level as f32 - 1.0) / (self.levels.max(2) - 1) as f32;
        for level in 1..MAX_LEVELS {
            detail[level] = detail[level - 1];
            // Beyond the last level, the difference stays what it is there.
            if level < self.levels as usize {
                let lost = lost_detail(self, to_u32(level), &progress.part(part(level), part(level + 1)))?;
                detail[level] = detail[level].max(lost);
            }
        }
        Ok(detail)
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

/// Returns the greatest difference between the pixels of level 0 and level `level`, interpolated there. Pixels of a
/// repeating image beyond the last centre of the level are left out: the opposite borders of many images don't quite
/// match.
fn lost_detail(map: &HeightMap, level: u32, progress: &Progress) -> Result<f32, Cancelled> {
    let [width, height] = map.size.map(|side| side as usize);
    let [across, down] = map.level_size(level).map(|side| side as usize);
    let start = (0..level).map(|l| map.level_size(l)).map(|[x, y]| (x * y) as usize).sum::<usize>();
    let (columns, rows) = (places(width, across, map.repeats), places(height, down, map.repeats));
    let own = &map.heights[start..start + across * down];
    let lost = |y: usize| {
        let Some((upper, lower, below)) = rows[y] else { return 0.0 };
        let line = |row: usize| &own[row * across..(row + 1) * across];
        let between: Vec<f32> = line(upper).iter().zip(line(lower)).map(|(a, b)| a + (b - a) * below).collect();
        let all = map.heights[y * width..(y + 1) * width].iter().zip(&columns);
        let differences = all.filter_map(|(height, column)| {
            let (left, right, beside) = (*column)?;
            Some((height - (between[left] + (between[right] - between[left]) * beside)).abs())
        });
        differences.fold(0.0, f32::max)
    };
    let parts = in_ranges(height, 1, |rows| {
        let (mut most, first, count) = (0.0_f32, rows.start, rows.len());
        for y in rows {
            progress.check()?;
            if first == 0 {
                progress.set(y as f32 / count as f32);
            }
            most = most.max(lost(y));
        }
        Ok(most)
    });
    parts.into_iter().try_fold(0.0, |most: f32, part| Ok(most.max(part?)))
}

/// For each of `count` pixels of level 0 along an axis, returns the two of a level's `own` pixels that it lies between,
/// and how far it lies from the first of them towards the second, 0 to 1. Returns none for pixels of a repeating image
/// that lie outside the level's pixel centres.
#[expect(clippy::cast_possible_truncation, reason = "whole numbers within the image")]
fn places(count: usize, own: usize, repeats: bool) -> Vec<Option<(usize, usize, f32)>> {
    let place = |i: usize| {
        let at = (i as f32 + 0.5) / count as f32 * own as f32 - 0.5;
        let inside = at.clamp(0.0, (own - 1) as f32);
        let first = inside as usize;
        (!repeats || at == inside).then(|| (first, (first + 1).min(own - 1), inside - first as f32))
    };
    (0..count).map(place).collect()
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
    fn detail_is_the_greatest_error_of_a_pixel() {
        let map = HeightMap::new([8, 8], (0..64).map(|i| if i == 27 { 1.0 } else { 0.0 }).collect());
        let detail = map.detail(&Progress::new()).expect("not cancelled");
        // One white pixel among 64: the coarser levels lose all but its share in the mean.
        assert!(detail[1] > 0.5 && detail[3] > 0.9 && detail[12] == detail[3], "{detail:?}");
        assert!(detail.is_sorted());
    }

    #[test]
    fn building_and_measuring_can_be_cancelled() {
        let progress = Progress::new();
        let map = HeightMap::new([64, 64], vec![0.5; 4096]);
        progress.cancel();
        assert_eq!(map.detail(&progress), Err(Cancelled));
        assert_eq!(HeightMap::build::<Cancelled>([64, 64], &progress, |_| Ok(())), Err(Cancelled));
    }

    #[test]
    fn detail_is_what_interpolation_between_pixels_leaves() {
        // Level 1 is 1/7 and 6/7, as its filter reaches one pixel across the middle; the last level is the mean.
        for size in [[4, 1], [1, 4]] {
            let map = HeightMap::new(size, vec![0.0, 0.0, 1.0, 1.0]);
            let detail = map.detail(&Progress::new()).expect("not cancelled");
            let expected = [0.0, 1.0 / 7.0 + 5.0 / 28.0, 0.5, 0.5];
            assert!(detail.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6), "{size:?}: {detail:?}");
        }
    }

    #[test]
    fn progress_moves_on_within_the_last_level() {
        let (map, progress) = (HeightMap::new([1, 2048], vec![0.5; 2048]), Progress::new());
        map.detail(&progress).expect("not cancelled");
        assert!(progress.fraction() > 0.95, "{}: the last of 11 levels begins at 10/11", progress.fraction());
    }
}

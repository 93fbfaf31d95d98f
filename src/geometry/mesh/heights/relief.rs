//! How far heights may be from linear ones between points where they are read: bounds over each triangle of a mesh, made once for
//! its images and texture coordinates.
//!
//! A function differs from its linear interpolation at the corners of a triangle by at most a sixth of its largest second
//! derivative times the square of the longest side (S. Waldron: *The error in linear interpolation at the vertices of a
//! simplex*, 1998; the smallest circle around a triangle has at most a third of that square). A height image is bilinear
//! between the centres of its px: its slopes change at the lines through these, by a second difference each. Along a path that is
//! as if its second derivative were that difference, but for an eighth of it.
//!
//! Steps between neighbouring px make second differences large. Then a level of the pyramid tells more: what the image is farther
//! from that level counts twice, and the second differences are those of the level. Or the heights' range tells most.

use std::ops::Range;

use bytemuck::{Pod, Zeroable};
use glam::Vec2;

use super::{HeightMap, Heights, Mesh};
use crate::cores::in_ranges;
use crate::mesh::{Patch, Topology, Wrap};
use crate::progress::{Cancelled, Progress};

/// For how many lengths of sides there are bounds, each half as long as the one before.
pub const RELIEF_STEPS: usize = 5;

/// Bounds on the heights over one triangle. Heights are from 0 to 1, and lengths in px of the image's level 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Relief {
    /// The triangle's longest side.
    pub longest: f32,
    /// The greatest height less the least one.
    pub range: f32,
    /// The largest slope.
    pub slope: f32,
    /// Of triangles within this one whose sides are no longer than the longest, half of it, a quarter of it and so on: how far
    /// heights are at most from linear ones. That is the first number, and the second one times the square of their longest side.
    pub losses: [[f32; 2]; RELIEF_STEPS],
}

impl Relief {
    /// Takes a bound where it says more than what is known. `loss` is as in [`Self::losses`].
    fn offer(&mut self, loss: [f32; 2]) {
        // In the middle of what each is used for: the last one also for all shorter sides.
        let mut side = 0.7 * self.longest;
        let mut ratios = [0.5; RELIEF_STEPS];
        (ratios[0], ratios[RELIEF_STEPS - 1]) = (1.0, 0.25);
        for (own, ratio) in self.losses.iter_mut().zip(ratios) {
            side *= ratio;
            let at = |[constant, square]: [f32; 2]| constant + square * side * side;
            if at(loss) < at(*own) {
                *own = loss;
            }
        }
    }
}

/// Returns the bounds of each of a mesh's triangles; zeros where no image displaces it.
///
/// # Errors
/// [`Cancelled`] when `progress` says so.
pub(super) fn reliefs(
    mesh: &Mesh,
    maps: &[HeightMap],
    ranges: &[(Range<u32>, u32)],
    progress: &Progress,
) -> Result<Vec<Relief>, Cancelled> {
    let mut all = vec![Relief::default(); mesh.triangles.len()];
    for (index, map) in (0..).zip(maps) {
        let own = ranges.iter().filter(|(_, own)| *own == index);
        let triangles: Vec<u32> = own.flat_map(|(range, _)| range.clone()).collect();
        let uvs = |triangle: &u32| mesh.triangles[*triangle as usize].map(|corner| mesh.corners[corner as usize].uv);
        let part = |index: u32| index as f32 / maps.len() as f32;
        let progress = progress.part(part(index), part(index + 1));
        let over = Triangles { map, uvs: triangles.iter().map(uvs).collect(), progress: &progress };
        for (triangle, relief) in triangles.iter().zip(over.reliefs()?) {
            all[*triangle as usize] = relief;
        }
    }
    Ok(all)
}

/// What passes know of the heights over a patch. Lengths are in px of the image's level 0.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct PatchRelief {
    /// The squared length of a step in the domain is x x `form[0]` + 2 x y `form[1]` + y y `form[2]`; x and y are the weights of
    /// corners 0 and 1.
    pub form: [f32; 3],
    /// As in [`Relief`]; negative where no image displaces the patch.
    pub longest: f32,
    pub range: f32,
    pub slope: f32,
    pub losses: [[f32; 2]; RELIEF_STEPS],
}

impl PatchRelief {
    /// Of a patch that no image displaces.
    pub const NONE: Self =
        Self { form: [0.0; 3], longest: -1.0, range: 0.0, slope: 0.0, losses: [[0.0; 2]; RELIEF_STEPS] };
}

/// Returns what is known of the heights over every patch; nothing without heights.
pub fn patch_reliefs(heights: Option<&Heights>, mesh: &Mesh, topology: &Topology) -> Vec<PatchRelief> {
    let Some(heights) = heights else { return Vec::new() };
    let of_patch = |patch: &Patch| {
        let Some(map) = heights.map(patch.triangle) else { return PatchRelief::NONE };
        let Relief { longest, range, slope, losses } = heights.reliefs[patch.triangle as usize];
        let size = Vec2::from(map.size.map(|side| side as f32));
        let [a, b, c] = topology.corners(patch).map(|corner| mesh.corners[corner as usize].uv * size);
        let (x, y) = (a - c, b - c);
        PatchRelief { form: [x.dot(x), x.dot(y), y.dot(y)], longest, range, slope, losses }
    };
    topology.patches.iter().map(of_patch).collect()
}

/// The texture coordinates of the triangles that an image displaces.
struct Triangles<'a> {
    map: &'a HeightMap,
    uvs: Vec<[Vec2; 3]>,
    progress: &'a Progress,
}

impl Triangles<'_> {
    fn reliefs(&self) -> Result<Vec<Relief>, Cancelled> {
        let heights = LevelPx::new(self.map, 0);
        let greatest = self.largest(0, &|x, y| heights.at(x, y))?;
        let least = self.largest(0, &|x, y| -heights.at(x, y))?;
        let slopes = self.largest(0, &|x, y| heights.slope(x, y))?;
        let size = Vec2::from(self.map.size.map(|side| side as f32));
        let sides = |[a, b, c]: &[Vec2; 3]| [*b - *a, *c - *b, *a - *c].map(|side| (side * size).length());
        let mut beyond = self.largest(0, &|x, y| heights.beyond_border(x, y))?;
        // Half a px beyond a border is all that slopes which go on are near.
        let is_beyond = |uv: &Vec2, k: usize| self.map.wrap[k] != Wrap::Repeat && !(0.0..=1.0).contains(&uv[k]);
        for (beyond, uvs) in beyond.iter_mut().zip(&self.uvs) {
            if uvs.iter().any(|uv| is_beyond(uv, 0) || is_beyond(uv, 1)) {
                *beyond = f32::INFINITY;
            }
        }
        let relief = |(index, uvs): (usize, &[Vec2; 3])| {
            let range = greatest[index] + least[index];
            let longest = sides(uvs).into_iter().fold(0.0, f32::max);
            Relief { longest, range, slope: slopes[index], losses: [[range, 0.0]; RELIEF_STEPS] }
        };
        let mut all: Vec<Relief> = self.uvs.iter().enumerate().map(relief).collect();
        let longest = all.iter().fold(0.0, |longest: f32, relief| longest.max(relief.longest));
        for level in 0..self.map.levels {
            self.progress.set(level as f32 / self.map.levels as f32);
            // Px that are longer than all sides tell nothing.
            if (1 << level) as f32 > 2.0 * longest {
                break;
            }
            // Beyond a border slopes end. That is a bend, or a distance from slopes that go on.
            if level == 0 && self.map.wrap != [Wrap::Repeat; 2] {
                let losses = self.losses(level, &heights, &|x, y| heights.bend(x, y, false))?;
                all.iter_mut().zip(losses).for_each(|(relief, loss)| relief.offer(loss));
            }
            let own = LevelPx::new(self.map, level);
            let losses = self.losses(level, &heights, &|x, y| own.bend(x, y, true))?;
            for ((relief, [constant, square]), beyond) in all.iter_mut().zip(losses).zip(&beyond) {
                relief.offer([constant + 2.0 * beyond, square]);
            }
        }
        Ok(all)
    }

    /// Returns what a level tells of each triangle: see [`Relief::losses`].
    fn losses(
        &self,
        level: u32,
        heights: &LevelPx,
        bend: &(dyn Fn(usize, usize) -> f32 + Sync),
    ) -> Result<Vec<[f32; 2]>, Cancelled> {
        let own = LevelPx::new(self.map, level);
        let bends = self.largest(level, bend)?;
        let twists = self.largest(level, &|x, y| own.twist(x, y))?;
        let lost = match level {
            0 => vec![0.0; self.uvs.len()],
            _ => self.largest(level, &own.loss(heights))?,
        };
        // Width and height of a px, in px of level 0.
        let px = own.ratio.recip();
        let loss = |((bend, twist), lost): ((&f32, &f32), f32)| {
            // Between the centres of level 0's px the level may bend once more.
            let between = if level == 0 { 0.0 } else { 0.25 * bend * (px.x + px.y) };
            let constant = 2.0 * (lost + between) + 0.125 * bend * px.length_squared();
            // What rounding may add.
            [constant * 1.0001 + 1e-6, (bend + twist) * (1.0001 / 6.0)]
        };
        Ok(bends.iter().zip(&twists).zip(lost).map(loss).collect())
    }

    /// Returns the largest of the values over each triangle's px of a level, and over those around it.
    fn largest(&self, level: u32, value: &(dyn Fn(usize, usize) -> f32 + Sync)) -> Result<Vec<f32>, Cancelled> {
        let size = self.map.level_size(level).map(|side| side as usize);
        // Of level 0 blocks of 2 x 2 px take as much memory as level 1.
        let blocks = Blocks::new(size, if level == 0 { 2 } else { 1 }, self.progress, value)?;
        let over = |[a, b, c]: &[Vec2; 3]| {
            let (least, greatest) = (a.min(*b).min(*c), a.max(*b).max(*c));
            let span = |axis: usize| spans(size[axis], self.map.wrap[axis], [least[axis], greatest[axis]]);
            blocks.largest(&span(0), &span(1))
        };
        let ranges = in_ranges(self.uvs.len(), 1024, |range| self.uvs[range].iter().map(over).collect::<Vec<_>>());
        Ok(ranges.concat())
    }
}

/// Returns the px of an axis between two texture coordinates, and two more on each side: two ranges, where the image repeats between
/// them. All px, where it is mirrored.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the image")]
fn spans(size: usize, wrap: Wrap, ends: [f32; 2]) -> [Range<usize>; 2] {
    let [from, to] = ends.map(|end| (f64::from(end) * size as f64 - 0.5).floor());
    let (from, to) = (from - 1.0, to + 3.0);
    let is_mirrored = wrap == Wrap::Mirror && (ends[0] < 0.0 || ends[1] > 1.0);
    if wrap != Wrap::Repeat && !is_mirrored {
        let end = (to.max(1.0) as usize).min(size);
        return [(from.max(0.0) as usize).min(size - 1)..end, 0..0];
    }
    let within = to - from;
    if is_mirrored || within.is_nan() || within >= size as f64 {
        return [0..size, 0..0];
    }
    let start = (from.rem_euclid(size as f64) as usize).min(size - 1);
    let end = start + within as usize;
    [start..end.min(size), 0..end.saturating_sub(size)]
}

/// The px of a level.
struct LevelPx<'a> {
    size: [usize; 2],
    /// Whether the image repeats along each axis.
    repeats: [bool; 2],
    /// Width and height of level 0, as parts of this level's.
    ratio: Vec2,
    px: &'a [f32],
}

impl<'a> LevelPx<'a> {
    fn new(map: &'a HeightMap, level: u32) -> Self {
        let size = map.level_size(level).map(|side| side as usize);
        let start: usize = (0..level).map(|l| map.level_size(l)).map(|[x, y]| (x * y) as usize).sum();
        let [x, y] = [0, 1].map(|axis| size[axis] as f32 / map.size[axis] as f32);
        let repeats = map.wrap.map(|wrap| wrap == Wrap::Repeat);
        Self { size, repeats, ratio: Vec2::new(x, y), px: &map.heights[start..start + size[0] * size[1]] }
    }

    fn at(&self, x: usize, y: usize) -> f32 {
        self.px[y * self.size[0] + x]
    }

    /// The px beside one along an axis: itself at the border of an image that doesn't repeat.
    fn beside(&self, axis: usize, at: usize) -> [usize; 2] {
        let last = self.size[axis] - 1;
        match self.repeats[axis] {
            true => [if at > 0 { at - 1 } else { last }, if at < last { at + 1 } else { 0 }],
            false => [at.saturating_sub(1), (at + 1).min(last)],
        }
    }

    /// Whether a px is at a border, beyond which the image doesn't repeat, on the left or right and above or below.
    fn is_at_border(&self, x: usize, y: usize) -> [bool; 2] {
        [0, 1].map(|axis| !self.repeats[axis] && [0, self.size[axis] - 1].contains(&[x, y][axis]))
    }

    /// The larger second difference along both axes, for px of level 0, as it is or as if slopes went on beyond borders.
    fn bend(&self, x: usize, y: usize, goes_on: bool) -> f32 {
        let ([left, right], [above, below]) = (self.beside(0, x), self.beside(1, y));
        let twice = 2.0 * self.at(x, y);
        let across = (self.at(left, y) - twice + self.at(right, y)).abs() * self.ratio.x * self.ratio.x;
        let down = (self.at(x, above) - twice + self.at(x, below)).abs() * self.ratio.y * self.ratio.y;
        let [beside, over] = self.is_at_border(x, y).map(|is_at_border| goes_on && is_at_border);
        (if beside { 0.0 } else { across }).max(if over { 0.0 } else { down })
    }

    /// How far the half px beyond a border is from slopes that go on.
    fn beyond_border(&self, x: usize, y: usize) -> f32 {
        let ([left, right], [above, below]) = (self.beside(0, x), self.beside(1, y));
        let half = |a: f32, b: f32| 0.5 * (a - b).abs();
        let twist =
            || (self.at(left, above) - self.at(right, above) - self.at(left, below) + self.at(right, below)).abs();
        let (across, down) = (half(self.at(left, y), self.at(right, y)), half(self.at(x, above), self.at(x, below)));
        match self.is_at_border(x, y) {
            [false, false] => 0.0,
            [true, false] => across,
            [false, true] => down,
            [true, true] => across + down + 0.25 * twist(),
        }
    }

    /// The mixed second difference to the right and down, for px of level 0.
    fn twist(&self, x: usize, y: usize) -> f32 {
        let ([_, right], [_, below]) = (self.beside(0, x), self.beside(1, y));
        let mixed = self.at(x, y) - self.at(right, y) - self.at(x, below) + self.at(right, below);
        mixed.abs() * self.ratio.x * self.ratio.y
    }

    /// The largest slope between a px and those to the right and below.
    fn slope(&self, x: usize, y: usize) -> f32 {
        let ([_, right], [_, below]) = (self.beside(0, x), self.beside(1, y));
        let [own, right, below, beyond] = [self.at(x, y), self.at(right, y), self.at(x, below), self.at(right, below)];
        let (across, down) =
            ((right - own).abs().max((beyond - below).abs()), (below - own).abs().max((beyond - right).abs()));
        across.hypot(down)
    }

    /// How far the level is from level 0, `heights`: the largest difference at the centres of level 0's px within one of the level.
    fn loss(&self, heights: &LevelPx) -> impl Fn(usize, usize) -> f32 + Sync {
        let of = |axis: usize| places(heights.size[axis], self.size[axis], self.repeats[axis]);
        let (columns, rows) = (of(0), of(1));
        move |x, y| {
            let within = |axis: usize, at: usize| {
                let (count, own) = (heights.size[axis], self.size[axis]);
                at * count / own..((at + 1) * count).div_ceil(own)
            };
            let mut most = 0.0f32;
            for row in within(1, y) {
                let (upper, lower, below) = rows[row];
                for column in within(0, x) {
                    let (left, right, beside) = columns[column];
                    let between = |line| {
                        let (a, b) = (self.at(left, line), self.at(right, line));
                        a + (b - a) * beside
                    };
                    let (above, under) = (between(upper), between(lower));
                    most = most.max((heights.at(column, row) - (above + (under - above) * below)).abs());
                }
            }
            most
        }
    }
}

/// The two px of a level that the centre of one of level 0 lies between, and how far it is from the first of them towards the second. At
/// a border it lies beyond both, where slopes go on.
type Between = (usize, usize, f32);

/// For each of `count` px of level 0 along an axis, returns where it lies between a level's `own` px.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole numbers within the image")]
fn places(count: usize, own: usize, repeats: bool) -> Vec<Between> {
    let place = |i: usize| {
        let at = (i as f32 + 0.5) / count as f32 * own as f32 - 0.5;
        let first = at.floor();
        if repeats {
            let start = if first < 0.0 { own - 1 } else { first as usize };
            return (start, (start + 1) % own, at - first);
        }
        let start = (first.max(0.0) as usize).min(own.saturating_sub(2));
        (start, (start + 1).min(own - 1), at - start as f32)
    };
    (0..count).map(place).collect()
}

/// The largest values of blocks of an image's px, of blocks of 2 x 2 of these, of 4 x 4 and so on. The first blocks are `side` px wide.
struct Blocks {
    side: usize,
    levels: Vec<([usize; 2], Vec<f32>)>,
}

/// How many rows of blocks are computed before they are put with the others.
const ROWS: usize = 64;

impl Blocks {
    fn new(
        size: [usize; 2],
        side: usize,
        progress: &Progress,
        value: &(dyn Fn(usize, usize) -> f32 + Sync),
    ) -> Result<Self, Cancelled> {
        let first = size.map(|px| px.div_ceil(side));
        let block = |x: usize, y: usize| {
            let px = |axis: usize, at: usize| at * side..((at + 1) * side).min(size[axis]);
            let all = px(1, y).flat_map(|y| px(0, x).map(move |x| (x, y)));
            all.fold(f32::NEG_INFINITY, |largest, (x, y)| largest.max(value(x, y)))
        };
        // As much memory as is needed: an image may have 64 MiB.
        let mut blocks = Vec::with_capacity(first[0] * first[1]);
        for start in (0..first[1]).step_by(ROWS) {
            progress.check()?;
            let rows = ROWS.min(first[1] - start);
            let parts = in_ranges(rows, 1, |rows| {
                let all = rows.flat_map(|y| (0..first[0]).map(move |x| (x, y)));
                all.map(|(x, y)| block(x, start + y)).collect::<Vec<_>>()
            });
            parts.iter().for_each(|part| blocks.extend_from_slice(part));
        }
        let mut all = vec![(first, blocks)];
        while let Some((size, px)) = all.last().filter(|(size, _)| *size != [1, 1]) {
            let halved = size.map(|side| side.div_ceil(2));
            let mut next = vec![f32::NEG_INFINITY; halved[0] * halved[1]];
            for (y, row) in px.chunks_exact(size[0]).enumerate() {
                let next = &mut next[y / 2 * halved[0]..][..halved[0]];
                next.iter_mut()
                    .zip(row.chunks(2))
                    .for_each(|(next, px)| *next = px.iter().fold(*next, |a, b| a.max(*b)));
            }
            all.push((halved, next));
        }
        Ok(Self { side, levels: all })
    }

    /// Returns the largest value over these columns and rows, and over others in the same blocks.
    fn largest(&self, columns: &[Range<usize>; 2], rows: &[Range<usize>; 2]) -> f32 {
        let widest = columns.iter().chain(rows).map(ExactSizeIterator::len).fold(self.side, usize::max) / self.side;
        let level = (widest.ilog2().saturating_sub(2) as usize).min(self.levels.len() - 1);
        let (size, px) = &self.levels[level];
        let side = self.side << level;
        let mut largest = f32::NEG_INFINITY;
        let blocks = |range: &Range<usize>| range.start / side..range.end.div_ceil(side);
        for rows in rows.iter().filter(|rows| !rows.is_empty()).map(blocks) {
            for columns in columns.iter().filter(|columns| !columns.is_empty()).map(blocks) {
                for row in px.chunks_exact(size[0]).skip(rows.start).take(rows.len()) {
                    largest = row[columns.clone()].iter().fold(largest, |a, b| a.max(*b));
                }
            }
        }
        largest
    }
}

//! The largest distance from triangles to the triangles of a tree, as an interval that contains it for certain.
//!
//! It is found by branch and bound. The distance to a convex set is a convex function (Boyd and Vandenberghe, "Convex
//! optimization", section 3.2.5), so that over a piece of a triangle the distance to *one* triangle of the tree is largest
//! in a corner of the piece, and the least of these maxima, over any choice of triangles, bounds the distance to all of
//! them. That is the second of the bounds of Sacht and Jacobson ("Cascading upper bounds for triangle soup
//! Pompeiu-Hausdorff distance", 2024); the other one here is that the distance grows no faster than one moves. A piece
//! whose bound is too large is cut where the triangle of the tree that is nearest to its middle ends, so that each part has
//! one triangle that is near all of it; or else in half.

use std::cmp::Reverse;

use glam::{DVec3, Vec3};
use rayon::prelude::*;
use serde::Serialize;

use super::polygon::Polygon;
use super::triangle_tree::{Near, ROUNDING, TriangleTree};
use crate::casts::to_u32;
use crate::defaults::with_defaults;
use crate::progress::{Cancelled, Progress};

/// Triangles by their corners' positions.
#[derive(Clone, Copy)]
pub struct Soup<'a> {
    pub positions: &'a [Vec3],
    pub triangles: &'a [[u32; 3]],
}

/// When an interval is narrow enough, and how much work it may take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Goal {
    /// The width that suffices, as a part of the distance.
    pub relative: f64,
    /// The width that suffices, in object units.
    pub absolute: f64,
    /// The number of searches for a nearest point after which the interval stays as it is. Those for the corners of the
    /// triangles are always made.
    pub searches: u64,
}

/// A number that is known to lie between two others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Interval {
    pub at_least: f64,
    /// Infinite if nothing is known.
    pub at_most: f64,
}

impl Interval {
    /// The larger of two numbers.
    pub fn or(self, other: Self) -> Self {
        Self { at_least: self.at_least.max(other.at_least), at_most: self.at_most.max(other.at_most) }
    }
}

/// The largest distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Farthest {
    pub distance: Interval,
    /// The triangle that has the farthest point that was found.
    pub triangle: u32,
    /// That point, and the point of the tree that is nearest to it.
    pub point: DVec3,
    pub nearest: DVec3,
}

/// Pieces that were cut so often aren't cut any more. Each cut rounds the corners that it makes.
const DEEPEST: u32 = 120;

/// Every so many cuts a piece is halved, so that pieces shrink whatever the tree is like.
const HALVED_EVERY: u32 = 6;

/// The least overhang of a piece beyond a triangle of the tree that is cut off, as a part of the distance that is near
/// enough.
const LEAST_BEYOND: f64 = 0.05;

/// Every so many corners of triangles are searched for first, so that the distances of most others needn't be exact.
const STRIDE: usize = 61;

/// The least number of pieces that are cut before the largest distance so far is looked at again.
const ROUND: usize = 1 << 13;

/// The number of triangles or pieces that a thread takes at once. Results don't depend on the number of threads.
const BLOCK: usize = 512;

/// Measures the largest distance from a soup, whose positions must be finite, to a tree. `None` if the soup has no
/// triangle.
///
/// # Errors
/// `progress` was cancelled.
pub fn farthest(
    from: Soup,
    to: &TriangleTree,
    goal: &Goal,
    progress: &Progress,
) -> Result<Option<Farthest>, Cancelled> {
    let Some(&[first, ..]) = from.triangles.first() else { return Ok(None) };
    let search = Search { to, goal };
    let mut state = State::default();
    state.best.point = from.positions[first as usize].as_dvec3() * to.scale;
    let corners = search.corners(from);
    let some: Vec<_> = corners.iter().step_by(STRIDE).map(|corner| Corner { reach: 0.0, ..*corner }).collect();
    search.nearest(from, &some, &mut state, progress)?;
    let nearest = search.nearest(from, &corners, &mut state, progress)?;
    drop(corners);
    let all: Vec<usize> = (0..from.triangles.len()).collect();
    for_blocks(&mut state, &all, progress, |&i, best| {
        let corners = from.triangles[i].map(|corner| from.positions[corner as usize].as_dvec3() * to.scale);
        let faces = from.triangles[i].map(|corner| nearest[corner as usize]);
        search.piece(to_u32(i), Polygon::new(corners), &faces, 0, best)
    })?;
    drop((nearest, all));
    while let Some(round) = state.next_round(&search) {
        for_blocks(&mut state, &round, progress, |piece, best| search.cut(piece, best))?;
    }
    Ok(Some(state.result(&search, from)))
}

/// Does `work` with each item, on all cores, and adds what it returns to the state. `work` gets the best place before the
/// round, and raises it.
fn for_blocks<T: Sync>(
    state: &mut State,
    items: &[T],
    progress: &Progress,
    work: impl Fn(&T, &mut Best) -> Found + Sync,
) -> Result<(), Cancelled> {
    let before = state.best;
    let done = items.par_chunks(BLOCK).map(|block| {
        progress.check()?;
        let (mut best, mut found) = (before, Found::default());
        block.iter().for_each(|item| found.add(work(item, &mut best)));
        Ok((best, found))
    });
    for (best, found) in done.collect::<Result<Vec<_>, Cancelled>>()? {
        state.best.raise(best);
        state.found.add(found);
    }
    Ok(())
}

/// A place, and its distance, in scaled units.
#[derive(Clone, Copy, Debug, Default)]
struct Best {
    distance: f64,
    point: DVec3,
    triangle: u32,
}

impl Best {
    fn raise(&mut self, other: Self) {
        if other.distance > self.distance {
            *self = other;
        }
    }
}

/// A corner of triangles, and the length of the longest side that ends there, in scaled units.
#[derive(Clone, Copy, Debug)]
struct Corner {
    index: u32,
    /// One of the triangles.
    triangle: u32,
    reach: f64,
}

/// A part of a triangle.
#[derive(Clone, Copy, Debug)]
struct Piece {
    triangle: u32,
    polygon: Polygon,
    /// The triangle of the tree that is nearest to the middle.
    face: u32,
    /// No point of it is farther from the tree.
    bound: f64,
    depth: u32,
}

/// What became of some pieces.
#[derive(Default)]
struct Found {
    searches: u64,
    /// Those whose bound isn't small enough.
    pieces: Vec<Piece>,
    /// The largest bound of the others.
    closed: f64,
}

impl Found {
    fn is_empty(&self) -> bool {
        self.pieces.is_empty() && self.closed == 0.0 && self.searches == 0
    }

    fn add(&mut self, mut other: Self) {
        self.searches += other.searches;
        self.closed = self.closed.max(other.closed);
        self.pieces.append(&mut other.pieces);
    }
}

#[derive(Default)]
struct State {
    best: Best,
    found: Found,
}

impl State {
    /// The pieces to cut next: those with the largest bounds. `None` once none has to be cut, or the work was enough.
    fn next_round(&mut self, search: &Search) -> Option<Vec<Piece>> {
        let enough = search.enough(self.best.distance);
        let Found { searches, pieces, closed } = &mut self.found;
        pieces.retain(|piece| {
            let is_open = piece.bound > enough && piece.depth < DEEPEST;
            if !is_open {
                *closed = closed.max(piece.bound);
            }
            is_open
        });
        if pieces.is_empty() || *searches >= search.goal.searches {
            return None;
        }
        let count = pieces.len().div_ceil(2).max(ROUND).min(pieces.len());
        if count < pieces.len() {
            let key = |piece: &Piece| Reverse(piece.bound.to_bits());
            pieces.select_nth_unstable_by_key(count, |piece| (key(piece), piece.triangle, piece.depth));
        }
        Some(pieces.drain(..count).collect())
    }

    fn result(&self, search: &Search, from: Soup) -> Farthest {
        let (to, best) = (search.to, self.best);
        let size = from.triangles.iter().flatten().map(|corner| from.positions[*corner as usize].abs().max_element());
        let largest = (f64::from(size.fold(0.0, f32::max)) * to.scale).max(to.largest_coordinate());
        let margin = ROUNDING * largest;
        let bound =
            self.found.pieces.iter().map(|piece| piece.bound).fold(self.found.closed.max(best.distance), f64::max);
        let nearest = to.nearest(best.point, 0, 0.0);
        let at_least = to.proven_distance(best.point, nearest.distance) - margin;
        Farthest {
            distance: Interval {
                at_least: at_least.clamp(0.0, best.distance) / to.scale,
                at_most: (bound + margin) / to.scale,
            },
            triangle: best.triangle,
            point: best.point / to.scale,
            nearest: to.closest_at(nearest.place, best.point) / to.scale,
        }
    }
}

struct Search<'a> {
    to: &'a TriangleTree,
    goal: &'a Goal,
}

impl Search<'_> {
    /// The largest bound that is near enough to a distance, in scaled units.
    fn enough(&self, distance: f64) -> f64 {
        (distance * (1.0 + self.goal.relative)).max(distance + self.goal.absolute * self.to.scale)
    }

    /// The corners that triangles use.
    fn corners(&self, from: Soup) -> Vec<Corner> {
        let mut corners = vec![Corner { index: 0, triangle: u32::MAX, reach: 0.0 }; from.positions.len()];
        for (i, triangle) in from.triangles.iter().enumerate() {
            for (k, &index) in triangle.iter().enumerate() {
                let end = from.positions[triangle[(k + 1) % 3] as usize].as_dvec3();
                let side = ((from.positions[index as usize].as_dvec3() - end) * self.to.scale).length();
                for index in [index, triangle[(k + 1) % 3]] {
                    let corner = &mut corners[index as usize];
                    *corner = Corner { index, triangle: corner.triangle.min(to_u32(i)), reach: corner.reach.max(side) };
                }
            }
        }
        corners.retain(|corner| corner.triangle != u32::MAX);
        corners
    }

    /// For each position, the triangle of the tree that is nearest to it, or one that is so near that it is likely to bound all
    /// triangles of this corner.
    fn nearest(
        &self,
        from: Soup,
        corners: &[Corner],
        state: &mut State,
        progress: &Progress,
    ) -> Result<Vec<u32>, Cancelled> {
        let before = state.best;
        let blocks = corners.par_chunks(BLOCK).map(|block| {
            progress.check()?;
            let (mut best, mut hint) = (before, 0);
            let mut places = Vec::with_capacity(block.len());
            for Corner { index, triangle, reach } in block {
                let point = from.positions[*index as usize].as_dvec3() * self.to.scale;
                // Across the way to the nearest point, the distance to a triangle grows about with the square of what one
                // moves. Where this isn't so, the pieces' own searches find a better triangle.
                let growth = reach * (reach / self.enough(best.distance)).min(1.0);
                hint = self.look(point, growth, *triangle, hint, &mut best).place;
                places.push((*index, hint));
            }
            Ok((best, places))
        });
        let mut nearest = vec![0; from.positions.len()];
        for (best, places) in blocks.collect::<Result<Vec<_>, Cancelled>>()? {
            state.best.raise(best);
            places.into_iter().for_each(|(index, place)| nearest[index as usize] = place);
        }
        Ok(nearest)
    }

    /// The triangle of the tree that is nearest to a point, or one that is so near that all points within `reach` are near
    /// enough to it. `hint` is one that may be near.
    fn look(&self, point: DVec3, reach: f64, triangle: u32, hint: u32, best: &mut Best) -> Near {
        let limit = self.enough(best.distance) - reach;
        let near = self.to.nearest(point, hint, limit);
        if near.distance > limit {
            best.raise(Best { distance: near.distance, point, triangle });
        }
        near
    }

    /// Bounds a piece of a triangle, which is returned if its bound isn't near enough to the best distance. `faces` are
    /// triangles of the tree that are likely to be near.
    fn piece(&self, triangle: u32, polygon: Polygon, faces: &[u32], depth: u32, best: &mut Best) -> Found {
        let enough = self.enough(best.distance);
        let mut found = Found::default();
        let mut bound = Bound::default();
        for &face in faces {
            bound = bound.min(self.farthest(&polygon, face));
        }
        let mut face = bound.face;
        if bound.distance > enough {
            let middle = polygon.middle();
            let radius = polygon.radius(middle);
            let near = self.look(middle, radius, triangle, face, best);
            face = near.place;
            bound = bound.min(self.farthest(&polygon, face));
            // Nor does the distance grow faster than one moves.
            bound.distance = bound.distance.min(near.distance + radius);
            found.searches += 1;
        }
        if bound.distance > enough {
            let near = self.look(bound.corner, 0.0, triangle, face, best);
            bound = bound.min(self.farthest(&polygon, near.place));
            found.searches += 1;
        }
        match bound.distance > enough {
            true => found.pieces.push(Piece { triangle, polygon, face, bound: bound.distance, depth }),
            false => found.closed = bound.distance,
        }
        found
    }

    /// The largest distance from a piece to one triangle of the tree.
    fn farthest(&self, polygon: &Polygon, face: u32) -> Bound {
        let distances = polygon.corners().iter().map(|corner| (self.to.distance_to(face, *corner), *corner));
        let (distance, corner) =
            distances.fold((0.0, DVec3::ZERO), |most, other| if other.0 >= most.0 { other } else { most });
        Bound { distance, face, corner }
    }

    /// How far a piece reaches from the plane of a triangle of the tree, on either side.
    fn height(&self, polygon: &Polygon, face: u32) -> f64 {
        let [at, across] = self.to.plane(face);
        polygon.height(at, across).max(polygon.height(at, -across))
    }

    /// Cuts a piece where the triangle that is nearest to its middle ends, or else in half, and bounds the parts.
    fn cut(&self, piece: &Piece, best: &mut Best) -> Found {
        let Piece { triangle, polygon, face, depth, .. } = *piece;
        // What is a little beyond the triangle's border is near enough, too: above the triangle, the less the higher.
        let enough = self.enough(best.distance);
        let height = self.height(&polygon, face).min(enough);
        let beyond = (enough * enough - height * height).sqrt().max(LEAST_BEYOND * enough) / 2.0;
        let mut found = Found::default();
        let mut inside = polygon;
        for [at, outwards] in self.to.borders(face).filter(|_| !(depth + 1).is_multiple_of(HALVED_EVERY)) {
            // A corner that is there by rounding isn't cut off.
            if inside.height(at, outwards) < 1.25 * beyond {
                continue;
            }
            let [within, outside] = inside.cut(at + beyond * outwards, outwards);
            let (Some(within), Some(outside)) = (within, outside) else { continue };
            found.add(self.piece(triangle, outside, &[face], depth + 1, best));
            inside = within;
        }
        if !found.is_empty() {
            found.add(self.piece(triangle, inside, &[face], depth + 1, best));
            return found;
        }
        let [at, along] = polygon.across();
        for part in polygon.cut(at, along).into_iter().flatten() {
            found.add(self.piece(triangle, part, &[face], depth + 1, best));
        }
        found
    }
}

with_defaults! {
    /// The largest distance from a piece to a triangle of the tree, and the corner that has it.
    #[derive(Clone, Copy)]
    struct Bound {
        distance: f64 = f64::INFINITY,
        face: u32 = 0,
        corner: DVec3 = DVec3::ZERO,
    }
}

impl Bound {
    fn min(self, other: Self) -> Self {
        if other.distance < self.distance { other } else { self }
    }
}

#[cfg(test)]
mod tests;

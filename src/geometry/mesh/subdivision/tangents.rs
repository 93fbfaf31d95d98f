//! Tangents of the limit surface.
//!
//! Around a point, faces form sectors between sharp edges, and each sector has a tangent plane of its own. Sums of the values
//! around a smooth point, weighted by the cosines and sines of one turn, are directions of the limit surface: refinement only
//! scales them, so every level gives the same. Source: Halstead, Kass and DeRose 1993; Loop 1987.
//!
//! In a sector between two sharp edges the sines are those of half a turn, and the point and the two edges have weights too. These
//! follow from the same condition. Published ones belong to other rules along sharp edges (Hoppe et al. 1994; Biermann, Levin
//! and Zorin 2000), and are the same only for up to two faces of Catmull-Clark and up to three of Loop's scheme.
//!
//! Of the butterfly scheme, the sums are exact around a smooth point of other than six faces among points of six. Elsewhere they
//! are differences between neighbours, which approach the tangents from level to level.

use std::f64::consts::{PI, TAU};

use rayon::prelude::*;

use super::values::Values;
use super::{Linear, Scheme};
use crate::casts::to_u32;

/// The faces between two sharp edges at a point, or all around it.
pub(super) struct Sector {
    /// The first side, from which the others follow counter-clockwise.
    first: u32,
    faces: u32,
    is_whole: bool,
}

impl<T: Linear> Values<'_, T> {
    /// Two tangents of the limit surface at a point, if they are the same in all faces around it.
    pub(super) fn tangents_around(&self, point: u32) -> Option<[T; 2]> {
        self.smooth_tangents(&self.sector(self.level.first_side(point)?))
    }

    fn smooth_tangents(&self, sector: &Sector) -> Option<[T; 2]> {
        let point = self.level.origins[sector.first as usize];
        let is_smooth = self.level.point_sharpness(point) == 0.0 && self.level.first_side(point).is_some();
        (is_smooth && sector.is_whole && sector.faces > 2).then(|| self.waves(sector, TAU))
    }

    /// Tangents at a point as if the side's face were the only one there: along both of the face's edges.
    pub(super) fn flat_tangents(&self, side: u32) -> [T; 2] {
        let level = self.level;
        let own = self.start(side) * -1.0;
        [level.polygons.after(side), level.polygons.before(side)].map(|side| self.start(side) + own)
    }

    /// The sectors of two faces or more between sharp edges.
    pub(super) fn sectors(&self) -> impl ParallelIterator<Item = Sector> {
        let sides = (0..to_u32(self.level.origins.len())).into_par_iter().filter(|side| self.is_first(*side));
        sides.map(|first| self.sector_from(first)).filter(|sector| sector.faces > 1 && !sector.is_whole)
    }

    /// The sides at the point of a sector.
    pub(super) fn sides(&self, sector: &Sector) -> impl Iterator<Item = u32> {
        self.level.ring(sector.first).take(sector.faces as usize).filter_map(|spoke| spoke.side)
    }

    /// Whether a sector begins with a side.
    fn is_first(&self, side: u32) -> bool {
        self.level.edge_sharpness(self.level.edges[side as usize]) > 0.0 || self.level.twin(side).is_none()
    }

    /// Finds the sector of a side's face at the point where the side starts.
    fn sector(&self, side: u32) -> Sector {
        let mut first = side;
        while !self.is_first(first) {
            // The side that leaves the same point in the face that follows clockwise.
            first = self.level.twin(first).map_or(side, |twin| self.level.polygons.after(twin));
            if first == side {
                // All sides at the point must find the same sector.
                first = self.level.first_side(self.level.origins[side as usize]).unwrap_or(side);
                break;
            }
        }
        self.sector_from(first)
    }

    fn sector_from(&self, first: u32) -> Sector {
        let mut faces = 0;
        for spoke in self.level.ring(first).skip(1) {
            faces += 1;
            if spoke.side.is_none_or(|side| self.is_first(side)) {
                return Sector { first, faces, is_whole: false };
            }
        }
        Sector { first, faces: faces + 1, is_whole: true }
    }

    /// Tangents in a sector of two faces or more: along the sharp edges, and across them into the sector.
    pub(super) fn sector_tangents(&self, sector: &Sector) -> [T; 2] {
        let level = self.level;
        let own = self.start(sector.first);
        let mut ends = level.ring(sector.first).map(|spoke| self.points[spoke.far as usize]);
        let first = ends.next().unwrap_or_default();
        let last = ends.nth(sector.faces as usize - 1).unwrap_or_default();
        let [point, edge] = sharp_weights(self.scheme, f64::from(sector.faces));
        let [_, sines] = self.waves(sector, PI);
        [first + last * -1.0, sines + own * point + (first + last) * edge]
    }

    /// The sums of the values around a point times the cosines and the sines of angles that divide `turn` among the faces.
    fn waves(&self, sector: &Sector, turn: f64) -> [T; 2] {
        let angle = turn / f64::from(sector.faces);
        let (sin, cos) = angle.sin_cos();
        let center_weight = 1.0 + 4.0 * opposite_weight(angle);
        let mut wave = [1.0, 0.0];
        let mut sums = [T::default(); 2];
        for spoke in self.level.ring(sector.first).take(sector.faces as usize) {
            let next = [wave[0] * cos - wave[1] * sin, wave[0] * sin + wave[1] * cos];
            let end = self.points[spoke.far as usize];
            let center = spoke.side.map_or(T::default(), |side| self.center(side));
            for ((sum, now), next) in sums.iter_mut().zip(wave).zip(next) {
                *sum = *sum + end * now + center * (center_weight * (now + next));
            }
            wave = next;
        }
        sums
    }
}

/// The weight of the point opposite in each quadrilateral, where the far ends of edges have cosines of multiples of an angle: g
/// in λg = 1/16 + g/4 and λ = 3/8 + cos(angle)/8 + g(1 + cos(angle))/2, which say that refinement scales the sum by λ. With
/// the center of a face in place of its opposite point the weight is 1 + 4g, on the next level.
fn opposite_weight(angle: f64) -> f64 {
    let cos = angle.cos();
    let scale = (5.0 + cos + (angle / 2.0).cos() * (2.0 * (9.0 + cos)).sqrt()) / 16.0;
    1.0 / (16.0 * scale - 4.0)
}

/// The weights of a point between so many faces, and of the ends of its two sharp edges, so that the sum over the sector is
/// zero for equal values, and refinement only scales it.
fn sharp_weights(scheme: Scheme, faces: f64) -> [f64; 2] {
    let angle = PI / faces;
    let (sin, cos) = angle.sin_cos();
    // The sum of all sines.
    let sines = (1.0 + cos) / sin;
    match scheme {
        Scheme::CatmullClark => {
            let g = opposite_weight(angle);
            let edge = g * ((4.0 * g + 1.0) * sin - 2.0 * sines * (1.0 + 2.0 * g));
            let point = -sines * (1.0 + 2.0 * g) - 2.0 * edge;
            // Centers of faces stand for opposite points, so these are the weights on the next level.
            [3.0 * point + 4.0 * edge + sines, 0.5 * point + 2.0 * edge]
        }
        Scheme::Loop => [-sines / (1.0 + 2.0 * cos), -sines * cos / (1.0 + 2.0 * cos)],
        Scheme::Butterfly => [-sines, 0.0],
    }
}

/// What tests compare normals with.
#[cfg(test)]
impl<T: Linear> Values<'_, T> {
    /// Two tangents of the limit surface at the point where a side starts, in the side's face.
    pub(super) fn tangents(&self, side: u32) -> [T; 2] {
        let sector = self.sector(side);
        self.smooth_tangents(&sector).unwrap_or_else(|| match sector.faces {
            2.. if !sector.is_whole => self.sector_tangents(&sector),
            _ => self.flat_tangents(side),
        })
    }
}

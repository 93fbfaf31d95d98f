//! The limit surface at the points of the finest level.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::Linear;
use super::values::Values;
use crate::casts::to_u32;

/// What values become in the limit of infinitely many levels, at the points of a refinement.
///
/// The butterfly scheme's points are in the limit already, and its normals approximate the limit's.
///
/// Edges and points that are still sharp on the finest level count as infinitely sharp, and where a single sharp edge ends the
/// limit is that of a smooth point: both as in OpenSubdiv's `PrimvarRefiner::Limit`.
pub struct Limit<'a, T>(pub(super) Values<'a, T>);

impl<T: Linear> Limit<'_, T> {
    /// Returns the value at each point.
    pub fn values(&self) -> Vec<T> {
        self.0.limit()
    }
}

impl Limit<'_, DVec3> {
    /// Returns the unit normal at each corner of all refined faces, which points outward; zero where it has no direction. All faces at a
    /// smooth point share it, as do faces between the same two sharp edges at a point.
    ///
    /// A corner has no tangent plane where several faces lie between two sharp edges; there, normals are those of a crease. Around a sharp
    /// point without sharp edges, where several fans of faces meet, and where two faces close around a point, they are those of the
    /// corner's own face.
    pub fn normals(&self) -> Vec<Vec3> {
        let Self(values) = self;
        let level = values.level;
        let normal = |[a, b]: [DVec3; 2]| {
            let normal = a.cross(b).normalize_or_zero().as_vec3();
            (normal != Vec3::ZERO).then_some(normal)
        };
        let around = |point| values.tangents_around(point).and_then(normal);
        let shared: Vec<Option<Vec3>> = (0..to_u32(level.points)).into_par_iter().map(around).collect();
        let at_corner = |side: u32| {
            let shared = shared[level.origins[side as usize] as usize];
            shared.or_else(|| normal(values.flat_tangents(side))).unwrap_or_default()
        };
        let mut normals: Vec<Vec3> = (0..to_u32(level.origins.len())).into_par_iter().map(at_corner).collect();
        // Each sector once, however many faces it has.
        let of_sector = |sector| Some((normal(values.sector_tangents(&sector))?, sector));
        for (normal, sector) in values.sectors().filter_map(of_sector).collect::<Vec<_>>() {
            values.sides(&sector).for_each(|side| normals[side as usize] = normal);
        }
        normals
    }
}

/// What tests compare normals with.
#[cfg(test)]
impl<T: Linear> Limit<'_, T> {
    /// Returns two tangents at a corner of a refined face, of any lengths.
    pub(super) fn tangents(&self, corner: usize) -> [T; 2] {
        self.0.tangents(to_u32(corner))
    }
}

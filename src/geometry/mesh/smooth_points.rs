//! Computes the normals of points whose faces surely all lie within the crease angle of each other, in one pass over the triangles.
//! Most points of most meshes are such points, and for them nobody needs a list of their faces.

use std::ops::Range;

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::build_limits::{Budget, BuildError};
use super::normals::{FAN_LIMIT, faces_of, limit_of, unit_mean};
use super::unfinished_mesh::{CornerPoints, UnfinishedMesh};
use super::weld::plus_zero3;
use crate::casts::{to_f32, to_u32};
use crate::cores::{in_ranges, ranges, split};
use crate::progress::Progress;

/// How many triangles have their faces computed before these are added to points.
const BLOCK: usize = 1 << 14;

/// The least number of triangles that are worth a thread.
const LEAST: usize = 1 << 10;

/// The memory for each point and for each triangle of a block, in bytes.
const PER_POINT: u64 = size_of::<PointSum>() as u64 + 1;
const PER_TRIANGLE: u64 = size_of::<(DVec3, [f64; 3])>() as u64;

/// The sum over the faces around a point, and how far their normals lie apart.
#[derive(Clone, Copy)]
struct PointSum {
    /// The sum of the faces' normals, each times the face's angle at the point.
    sum: DVec3,
    /// The least box that holds the faces' normals.
    least: Vec3,
    most: Vec3,
    /// The number of faces, or [`APART`](Self::APART).
    faces: u32,
}

impl PointSum {
    /// Instead of the number of faces: one of them has no area, or they are too many.
    const APART: u32 = u32::MAX;

    const NONE: Self = Self { sum: DVec3::ZERO, least: Vec3::INFINITY, most: Vec3::NEG_INFINITY, faces: 0 };

    /// Adds a face with a surface normal and an angle at the point.
    fn add(&mut self, normal: DVec3, angle: f64) {
        let rounded = normal.as_vec3();
        (self.least, self.most) = (self.least.min(rounded), self.most.max(rounded));
        self.sum += angle * normal;
        let fits = normal != DVec3::ZERO && self.faces < to_u32(FAN_LIMIT);
        self.faces = if fits { self.faces + 1 } else { Self::APART };
    }

    /// Returns the point's normal, if no two normals are farther apart than the square root of `chord`.
    fn normal(&self, chord: f32) -> Option<Vec3> {
        let is_smooth = self.faces != Self::APART && (self.most - self.least).length_squared() <= chord;
        unit_mean(self.sum).filter(|_| is_smooth).map(plus_zero3)
    }
}

/// Gives the corners on points with one normal that normal, with a crease angle in degrees. Returns for each point whether nothing is
/// left to be done there; the list is empty if that holds for none: if a corner has a normal,
/// if most triangles share no points, or if memory is short.
///
/// The normals have the same bits as those that [`fan_normals`](super::normals::fan_normals) returns: faces are added in the same order.
///
/// # Errors
/// [`BuildError::Cancelled`].
pub(super) fn give_normals(
    mesh: &mut UnfinishedMesh,
    points: &CornerPoints,
    crease_angle: f32,
    budget: &Budget,
    progress: &Progress,
) -> Result<Vec<bool>, BuildError> {
    let count = points.count(mesh);
    let has_normals = mesh.corners.iter().any(|corner| !corner.normal.x.is_nan());
    let bytes = PER_POINT * count as u64 + PER_TRIANGLE * mesh.triangles.len().min(BLOCK) as u64;
    // Where most triangles share no points, this would take more memory than lists.
    if has_normals || count > mesh.triangles.len() || budget.borrow(bytes).is_err() {
        return Ok(Vec::new());
    }
    // A little less than the square of the distance between unit normals at that angle, for the rounding to f32.
    let chord = to_f32(2.0 - 2.0 * limit_of(crease_angle)) - 2e-6;
    let mut sums = vec![PointSum::NONE; count];
    let parts: Vec<_> = ranges(count, LEAST).collect();
    for block in mesh.triangles.chunks(BLOCK) {
        progress.check()?;
        let faces = in_ranges(block.len(), LEAST, |range| {
            let faces = |corners: &[u32; 3]| {
                let (normal, angle) = faces_of(corners.map(|id| mesh.corners[id as usize].position));
                (normal, [0, 1, 2].map(angle))
            };
            block[range].iter().map(faces).collect::<Vec<_>>()
        });
        split(&mut sums, parts.iter().map(Range::len)).into_par_iter().zip(&parts).for_each(|(sums, part)| {
            // Each core looks at all faces, so that those around a point are added in their order.
            for (corners, (normal, angles)) in block.iter().zip(faces.iter().flatten()) {
                for (&corner, angle) in corners.iter().zip(angles) {
                    if let Some(sum) = sums.get_mut(points.at(corner).wrapping_sub(part.start)) {
                        sum.add(*normal, *angle);
                    }
                }
            }
        });
    }
    mesh.corners.par_iter_mut().enumerate().for_each(|(id, corner)| {
        corner.normal = sums[points.at(to_u32(id))].normal(chord).unwrap_or(Vec3::NAN);
    });
    Ok(sums.par_iter().map(|sum| sum.faces == 0 || sum.normal(chord).is_some()).collect())
}

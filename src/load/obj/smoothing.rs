//! Normals of faces that have none, from the smoothing groups that the file puts them in (the statement `s`).

use std::collections::HashMap;

use foldhash::fast::RandomState;
use glam::Vec3;

use super::faces::{FacePiece, Found};
use super::vertices::Vertices;
use crate::face_builder::NumberedCorner;
use crate::memory_budget::Budget;
use crate::read_error::ReadError;
use crate::recent_corners::VertexNumbers;

/// Memory for an entry of the table while it grows, in bytes: the old and the new table exist at the same time.
const PER_ENTRY: u64 = 3 * (size_of::<((u32, u32), Vec3)>() as u64 + 1);

/// The sums of normals at positions, by smoothing group.
pub(super) struct Smoothing<'v> {
    vertices: &'v Vertices,
    budget: &'v Budget,
    /// The group of the next faces. Faces in group 0 are flat.
    pub group: u32,
    sums: HashMap<(u32, u32), Vec3, RandomState>,
}

impl<'v> Smoothing<'v> {
    pub(super) fn new(vertices: &'v Vertices, budget: &'v Budget) -> Self {
        Self { vertices, budget, group: 0, sums: HashMap::default() }
    }

    /// Adds the faces of a piece of the file to the sums of their groups. What is wrong with a face is said when it is read as
    /// a face.
    ///
    /// # Errors
    /// [`ReadError::TooLarge`].
    pub(super) fn take(&mut self, piece: &FacePiece) -> Result<(), ReadError> {
        let mut start = 0;
        for found in &piece.found {
            match found {
                Found::Smoothing(group) => self.group = *group,
                Found::Face { end, .. } => {
                    let end = *end as usize;
                    if self.group != 0 {
                        self.add(&piece.corners[start..end])?;
                    }
                    start = end;
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn add(&mut self, corners: &[VertexNumbers]) -> Result<(), ReadError> {
        let positions: Vec<Vec3> = corners.iter().map(|[number, ..]| self.position(*number)).collect();
        let face = face_normal(&positions);
        if !face.is_finite() {
            return Ok(());
        }
        for (i, &[number, ..]) in corners.iter().enumerate() {
            let at = |step: usize| positions[(i + step) % positions.len()];
            let angle = (at(1) - at(0)).angle_between(at(positions.len() - 1) - at(0));
            let key = (number, self.group);
            if self.sums.len() == self.sums.capacity() && !self.sums.contains_key(&key) {
                self.budget.hold(self.sums.len().max(64) as u64 * PER_ENTRY)?;
            }
            // An edge without a length has no angle.
            *self.sums.entry(key).or_default() += if angle.is_finite() { angle * face } else { Vec3::ZERO };
        }
        Ok(())
    }

    fn position(&self, number: u32) -> Vec3 {
        self.vertices.positions.get(number as usize).copied().unwrap_or(Vec3::NAN)
    }

    /// Gives a face's corners the normals that they lack. `numbers` begin with those of their positions. Returns false if a group has
    /// none, because its faces have no area.
    pub(super) fn complete(&self, numbers: &[VertexNumbers], corners: &mut [NumberedCorner]) -> bool {
        let positions: Vec<Vec3> = corners.iter().map(|at| at.corner.position).collect();
        let face = face_normal(&positions);
        let mut is_whole = true;
        for ([number, ..], at) in numbers.iter().zip(corners).filter(|(_, at)| at.corner.normal.is_none()) {
            let sum = if self.group == 0 { Some(&face) } else { self.sums.get(&(*number, self.group)) };
            at.corner.normal = sum.and_then(|sum| sum.try_normalize());
            // The group determines it too.
            at.vertex = None;
            is_whole &= at.corner.normal.is_some();
        }
        is_whole
    }
}

/// Returns a polygon's normal, of unit length, by Newell's method; NaN for one without area.
fn face_normal(positions: &[Vec3]) -> Vec3 {
    let first = positions.first().copied().unwrap_or_default();
    let pairs = positions.iter().zip(positions.iter().skip(1));
    pairs.map(|(&a, &b)| (a - first).cross(b - first)).sum::<Vec3>().normalize()
}

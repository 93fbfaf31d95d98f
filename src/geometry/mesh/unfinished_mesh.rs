//! A mesh whose corners may still lack normals, and the points that its corners lie on.

use super::Corner;
use super::build_limits::{Budget, BuildError};
use super::weld::{WELD_BYTES, weld};

/// A mesh that is being built. Missing normals are NaN.
#[derive(Default)]
pub(crate) struct UnfinishedMesh {
    pub corners: Vec<Corner>,
    /// The binding of each corner; empty if all are 0.
    pub bindings: Vec<u32>,
    pub triangles: Vec<[u32; 3]>,
}

impl UnfinishedMesh {
    /// Returns the corner that a triangle has in one of its places (3 * triangle + k).
    pub(super) fn corner(&self, place: u32) -> u32 {
        self.triangles[place as usize / 3][place as usize % 3]
    }
}

/// The point of each corner.
pub(super) enum CornerPoints {
    /// Every corner has a point of its own.
    Corners,
    /// The point of each corner, and the number of points.
    Welded(Vec<u32>, usize),
}

impl CornerPoints {
    pub(super) fn new(mesh: &UnfinishedMesh, budget: &Budget) -> Result<Self, BuildError> {
        // Corners that are nothing but positions differ in their positions.
        let plain = |corner: &Corner| corner.normal.x.is_nan() && corner.uv == glam::Vec2::ZERO;
        if mesh.bindings.is_empty() && mesh.corners.iter().all(plain) {
            return Ok(Self::Corners);
        }
        budget.borrow(mesh.corners.len() as u64 * WELD_BYTES)?;
        let (points, point_of) = weld(mesh.corners.len(), |corner| mesh.corners[corner].position);
        Ok(Self::Welded(point_of, points.len()))
    }

    pub(super) fn at(&self, corner: u32) -> usize {
        match self {
            Self::Corners => corner as usize,
            Self::Welded(point_of, _) => point_of[corner as usize] as usize,
        }
    }

    /// The number of points.
    pub(super) fn count(&self, mesh: &UnfinishedMesh) -> usize {
        match self {
            Self::Corners => mesh.corners.len(),
            Self::Welded(_, count) => *count,
        }
    }
}

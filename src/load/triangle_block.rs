//! Looks up the corners of many triangles together: the processor then waits for memory once for several of them.

use super::recent_corners::{RecentCorners, VertexNumbers};
use geometry::casts::to_u32;
use geometry::mesh::mesh_builder::{CornerRepairs, InputCorner, StoredCorner};

/// How many triangles are looked up together. All that is kept for them fits beside the vertices that are remembered.
pub(super) const BLOCK: usize = 512;

/// A mark beside the repairs: the corner isn't stored yet, and its number is that of a new one in this block.
const NEW: u8 = 1 << CornerRepairs::BITS;

/// Triangles of vertices that have numbers in the file.
#[derive(Default)]
pub(super) struct TriangleBlock {
    triangles: Vec<[StoredCorner; 3]>,
    /// Corners that are to be stored, with the numbers that keep them apart, and the vertex of each.
    pub corners: Vec<(InputCorner, u32)>,
    vertices: Vec<VertexNumbers>,
    /// What the new corners are stored as.
    stored: Vec<StoredCorner>,
}

impl TriangleBlock {
    /// Forgets all triangles.
    pub(super) fn clear(&mut self) {
        self.triangles.clear();
        self.corners.clear();
        self.vertices.clear();
        self.stored.clear();
    }

    /// Adds a triangle. `corner_of` returns the corner of a vertex that isn't remembered, or none if the triangle can't be added.
    /// Returns whether it was.
    ///
    /// # Errors
    /// Those of `corner_of`.
    pub(super) fn push<E>(
        &mut self,
        triangle: [VertexNumbers; 3],
        recent: &mut RecentCorners,
        mut corner_of: impl FnMut(VertexNumbers) -> Result<Option<(InputCorner, u32)>, E>,
    ) -> Result<bool, E> {
        let mut corners = [StoredCorner::default(); 3];
        for (own, vertex) in corners.iter_mut().zip(triangle) {
            if let Some(known) = recent.known(vertex) {
                *own = known;
                continue;
            }
            let Some(corner) = corner_of(vertex)? else { return Ok(false) };
            let new = StoredCorner { id: to_u32(self.corners.len()), repairs: CornerRepairs(NEW) };
            self.corners.push(corner);
            self.vertices.push(vertex);
            *own = recent.get(vertex, || new);
        }
        self.triangles.push(corners);
        Ok(true)
    }

    /// Stores the corners: `store` appends to a list what each is stored as.
    pub(super) fn store(
        &mut self,
        recent: &mut RecentCorners,
        store: impl FnOnce(&[(InputCorner, u32)], &mut Vec<StoredCorner>),
    ) {
        store(&self.corners, &mut self.stored);
        for ((id, &vertex), &stored) in (0..).zip(&self.vertices).zip(&self.stored) {
            recent.replace(vertex, StoredCorner { id, repairs: CornerRepairs(NEW) }, stored);
        }
    }

    /// Returns the triangles, after their corners were [stored](Self::store).
    pub(super) fn triangles(&self) -> impl Iterator<Item = [StoredCorner; 3]> {
        let is_new = |corner: &StoredCorner| corner.repairs.0 & NEW != 0;
        let stored = move |corner: StoredCorner| {
            if is_new(&corner) { self.stored[corner.id as usize] } else { corner }
        };
        self.triangles.iter().map(move |corners| corners.map(stored))
    }
}

//! Remembers the corners of vertices that faces used lately: the next faces mostly use them again.

use geometry::mesh::mesh_builder::{InputCorner, StoredCorner};

/// How many vertices are remembered. A power of two that keeps the table within a core's own cache.
const SLOTS: usize = 1 << 13;

/// What determines a corner: numbers of the file's, such as those of its position, texture coordinates and normal.
pub(super) type VertexNumbers = [u32; 3];

/// The corners of vertices that were used lately. A vertex takes the place of another whose first number has the same lowest
/// bits.
#[derive(Default)]
pub(super) struct RecentCorners {
    /// Empty until the first vertex.
    slots: Vec<Option<(VertexNumbers, StoredCorner)>>,
}

impl RecentCorners {
    /// Returns the corner of a vertex, which `store` stores unless it is remembered.
    pub(super) fn get(&mut self, vertex: VertexNumbers, store: impl FnOnce() -> StoredCorner) -> StoredCorner {
        if self.slots.is_empty() {
            self.slots.resize(SLOTS, None);
        }
        let slot = &mut self.slots[vertex[0] as usize % SLOTS];
        match slot {
            Some((same, corner)) if *same == vertex => *corner,
            _ => slot.insert((vertex, store())).1,
        }
    }
}

/// A corner of a face.
#[derive(Clone, Copy)]
pub(super) struct NumberedCorner {
    pub corner: InputCorner,
    /// A number of the reader's. Corners with different ones aren't merged.
    pub number: u32,
    /// What determines both, if the file has numbers for it. Then corners with the same numbers must be the same.
    pub vertex: Option<VertexNumbers>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::mesh::mesh_builder::CornerRepairs;

    #[test]
    fn a_corner_is_stored_again_only_if_another_took_its_place() {
        let (mut recent, mut stored) = (RecentCorners::default(), Vec::new());
        let far = SLOTS as u32;
        for vertex in [[7, 0, 0], [7, 0, 0], [8, 0, 0], [7, 0, 0], [7, 1, 0], [7, 0, 0], [7 + far, 0, 0], [8, 0, 0]] {
            let id = vertex[0] + vertex[1];
            let corner = recent.get(vertex, || {
                stored.push(vertex);
                StoredCorner { id, repairs: CornerRepairs(vertex[1] as u8) }
            });
            assert_eq!(corner, StoredCorner { id, repairs: CornerRepairs(vertex[1] as u8) });
        }
        assert_eq!(stored, [[7, 0, 0], [8, 0, 0], [7, 1, 0], [7, 0, 0], [7 + far, 0, 0]]);
    }
}

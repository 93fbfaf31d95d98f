//! A list of distinct corners.

use crate::mesh::Corner;
use crate::mesh::build_limits::{Budget, MemoryRefused};
use crate::mesh::interner::Interner;

/// Corners that differ in some bit or in their binding, in the order of their first appearance.
#[derive(Default)]
pub(super) struct DistinctCorners {
    pub corners: Vec<Corner>,
    /// The binding of each corner; empty while all are 0.
    pub bindings: Vec<u32>,
    ids: Interner,
}

impl DistinctCorners {
    /// Returns the number of a corner. A new corner gets the next number.
    pub(super) fn id(&mut self, corner: Corner, binding: u32) -> u32 {
        self.id_of(self.hash(&corner, binding), corner, binding)
    }

    /// Returns the hash of a corner for [`id_of`](Self::id_of).
    pub(super) fn hash(&self, corner: &Corner, binding: u32) -> u64 {
        self.ids.hash(key(corner, binding))
    }

    /// Prepares a call of [`id_of`](Self::id_of) with this hash.
    pub(super) fn approach(&self, hash: u64) {
        self.ids.approach(hash);
    }

    /// Returns the number of a corner with this hash, as [`id`](Self::id) does.
    pub(super) fn id_of(&mut self, hash: u64, corner: Corner, binding: u32) -> u32 {
        let (corners, bindings) = (&self.corners, &self.bindings);
        let (id, is_new) = self.ids.number_of(hash, key(&corner, binding), |id| key_of(corners, bindings, id));
        if is_new {
            if binding != 0 || !self.bindings.is_empty() {
                self.bindings.resize(self.corners.len(), 0);
                self.bindings.push(binding);
            }
            self.corners.push(corner);
        }
        id
    }

    /// Returns how many more corners there is room for.
    pub(super) fn room(&self) -> usize {
        self.ids.room().min(self.corners.capacity() - self.corners.len())
    }

    /// Makes room for exactly `more` further corners.
    ///
    /// # Errors
    /// [`MemoryRefused`].
    pub(super) fn make_room(&mut self, more: usize, budget: &Budget) -> Result<(), MemoryRefused> {
        let (count, capacity) = (self.corners.len(), self.corners.capacity());
        if capacity - count < more {
            budget.exchange(capacity as u64 * 32, (count + more) as u64 * 32)?;
            self.corners.reserve_exact(more);
        }
        if self.ids.room() < more {
            budget.exchange(self.ids.bytes(), Interner::bytes_for(count + more))?;
            let (corners, bindings) = (&self.corners, &self.bindings);
            self.ids.reserve(more, |id| key_of(corners, bindings, id));
        }
        Ok(())
    }

    /// Frees the table that finds equal corners: no more corners will be added.
    pub(super) fn close(&mut self, budget: &Budget) {
        budget.release(self.ids.bytes());
        self.ids = Interner::default();
    }
}

fn key_of(corners: &[Corner], bindings: &[u32], id: u32) -> (u64, u64, u64, u64, u32) {
    key(&corners[id as usize], bindings.get(id as usize).copied().unwrap_or_default())
}

/// Returns all bits of a corner and its binding. A missing normal is NaN, and equals other missing ones.
fn key(corner: &Corner, binding: u32) -> (u64, u64, u64, u64, u32) {
    let pair = |a: f32, b: f32| u64::from(a.to_bits()) << 32 | u64::from(b.to_bits());
    let Corner { position: p, normal: n, uv } = corner;
    (pair(p.x, p.y), pair(p.z, n.x), pair(n.y, n.z), pair(uv.x, uv.y), binding)
}

//! Corners, each once.

use crate::mesh::Corner;
use crate::mesh::build_limits::{MemoryAccount, MemoryRefused};
use crate::mesh::interner::Interner;

/// Corners that differ in some bit, or in what they are bound to, in the order of their first appearance.
#[derive(Default)]
pub struct Distinct {
    pub corners: Vec<Corner>,
    /// None at all while all are 0.
    pub bindings: Vec<u32>,
    ids: Interner,
}

impl Distinct {
    /// The number of a corner, which is the next one if it is new.
    pub fn id(&mut self, corner: Corner, binding: u32) -> u32 {
        let (corners, bindings) = (&self.corners, &self.bindings);
        let (id, is_new) = self.ids.number(key(&corner, binding), |id| key_of(corners, bindings, id));
        if is_new {
            if binding != 0 || !self.bindings.is_empty() {
                self.bindings.resize(self.corners.len(), 0);
                self.bindings.push(binding);
            }
            self.corners.push(corner);
        }
        id
    }

    /// How many more there is room for.
    pub fn room(&self) -> usize {
        self.ids.room().min(self.corners.capacity() - self.corners.len())
    }

    /// Makes room for exactly so many more.
    ///
    /// # Errors
    /// [`MemoryRefused`].
    pub fn make_room(&mut self, more: usize, budget: &dyn MemoryAccount) -> Result<(), MemoryRefused> {
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

    /// No more are told apart: the table goes.
    pub fn close(&mut self, budget: &dyn MemoryAccount) {
        budget.release(self.ids.bytes());
        self.ids = Interner::default();
    }
}

fn key_of(corners: &[Corner], bindings: &[u32], id: u32) -> (u64, u64, u64, u64, u32) {
    key(&corners[id as usize], bindings.get(id as usize).copied().unwrap_or_default())
}

/// All of a corner; no normal is what no number is.
fn key(corner: &Corner, binding: u32) -> (u64, u64, u64, u64, u32) {
    let pair = |a: f32, b: f32| u64::from(a.to_bits()) << 32 | u64::from(b.to_bits());
    let Corner { position: p, normal: n, uv } = corner;
    (pair(p.x, p.y), pair(p.z, n.x), pair(n.y, n.z), pair(uv.x, uv.y), binding)
}

//! Numbers for the details of corners, while a mesh is being built.

use std::hash::BuildHasher;

use foldhash::fast::RandomState;
use hashbrown::HashTable;

use super::CornerDetail;
use super::build_limits::{Budget, MemoryRefused};
use super::corner_details::CornerDetails;
use crate::casts::to_u32;

/// Memory for one entry, in bytes, besides the table that finds equal ones.
const PER_ENTRY: usize = size_of::<CornerDetail>() + size_of::<u32>();

/// Distinct pairs of a corner's details and its binding (a number of the caller's, for animation). Corners with equal
/// numbers of pairs may be merged: [`MeshBuilder`](super::mesh_builder::MeshBuilder) takes that number as a binding.
#[derive(Default)]
pub struct DetailTable {
    details: Vec<CornerDetail>,
    bindings: Vec<u32>,
    /// The numbers of the pairs alone: 5 to 12 bytes a pair.
    ids: HashTable<u32>,
    hasher: RandomState,
}

/// Returns the greatest size of a table with room for `count` numbers, in bytes. It has a power of two of places, of which an eighth
/// stays free.
pub fn id_bytes(count: usize) -> u64 {
    let places = (count as u64 * 8).div_ceil(7).max(16).next_power_of_two();
    places * 5 + 64
}

impl DetailTable {
    /// The greatest memory that a table of `count` entries takes while it grows, in bytes.
    pub fn bytes_for(count: usize) -> u64 {
        3 * (count * PER_ENTRY) as u64 / 2 + id_bytes(count + count / 2)
    }

    /// Returns the number of a pair.
    ///
    /// # Errors
    /// [`MemoryRefused`].
    pub fn number(&mut self, detail: CornerDetail, binding: u32, budget: &Budget) -> Result<u32, MemoryRefused> {
        if self.ids.len() == self.ids.capacity() || self.details.len() == self.details.capacity() {
            self.grow(budget)?;
        }
        let Self { details, bindings, ids, hasher } = self;
        let own = key(&detail, binding);
        let is_own = |id: &u32| key_of(details, bindings, *id) == own;
        let hash = |id: &u32| hasher.hash_one(key_of(details, bindings, *id));
        let id = *ids.entry(hasher.hash_one(own), is_own, hash).or_insert(to_u32(details.len())).get();
        if id as usize == details.len() {
            details.push(detail);
            bindings.push(binding);
        }
        Ok(id)
    }

    /// Returns the details of a number; those of a corner that has none if there is no such number.
    pub fn detail(&self, number: u32) -> CornerDetail {
        self.details.get(number as usize).copied().unwrap_or_default()
    }

    /// Returns the binding of a number; the number itself if there is no such pair.
    pub fn binding(&self, number: u32) -> u32 {
        self.bindings.get(number as usize).copied().unwrap_or(number)
    }

    fn grow(&mut self, budget: &Budget) -> Result<(), MemoryRefused> {
        let (count, capacity) = (self.details.len(), self.details.capacity());
        let more = (count / 2).max(64);
        budget.exchange((capacity * PER_ENTRY) as u64, ((count + more) * PER_ENTRY) as u64)?;
        self.details.reserve_exact(more);
        self.bindings.reserve_exact(more);
        budget.exchange(self.ids.allocation_size() as u64, id_bytes(count + more))?;
        if self.ids.capacity() < count + more {
            // The old table is freed before the new one is allocated.
            self.ids = HashTable::new();
            self.ids = HashTable::with_capacity(count + more);
            let hash = |id: &u32| self.hasher.hash_one(key_of(&self.details, &self.bindings, *id));
            for id in 0..to_u32(count) {
                self.ids.insert_unique(hash(&id), id, hash);
            }
        }
        Ok(())
    }

    /// Returns the details and bindings of corners with these numbers. The budget holds the memory of the details.
    ///
    /// # Errors
    /// [`MemoryRefused`].
    pub fn into_lists(self, numbers: &[u32], budget: &Budget) -> Result<(CornerDetails, Vec<u32>), MemoryRefused> {
        budget.release(self.ids.allocation_size() as u64);
        budget.hold((numbers.len() * PER_ENTRY) as u64)?;
        let details = numbers.iter().map(|&id| self.details.get(id as usize).copied().unwrap_or_default()).collect();
        let bindings = numbers.iter().map(|&id| self.bindings.get(id as usize).copied().unwrap_or_default()).collect();
        budget.release((self.details.capacity() * PER_ENTRY) as u64);
        Ok((details, bindings))
    }
}

type Key = ([u32; 12], u32);

fn key_of(details: &[CornerDetail], bindings: &[u32], id: u32) -> Key {
    key(&details[id as usize], bindings[id as usize])
}

/// Returns all bits of a corner's details, and its binding (-0 counts as 0).
fn key(detail: &CornerDetail, binding: u32) -> Key {
    let numbers: [f32; 12] = bytemuck::cast(*detail);
    (numbers.map(|number| (number + 0.0).to_bits()), binding)
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::mesh::Budget;

    #[test]
    fn equal_pairs_have_equal_numbers() {
        let detail = |i: u32| CornerDetail { uvs: [Vec2::splat(i as f32), Vec2::ZERO], ..CornerDetail::default() };
        let mut table = DetailTable::default();
        let numbers: Vec<u32> = (0..1000)
            .map(|i| table.number(detail(i % 100), i % 7, &Budget::unlimited()).expect("memory is unlimited"))
            .collect();
        assert_eq!(numbers[0], table.number(detail(0), 0, &Budget::unlimited()).expect("memory is unlimited"));
        assert_eq!((table.details.len(), numbers[700], numbers[999]), (700, 0, numbers[299]));
        let (details, bindings) = table.into_lists(&numbers, &Budget::unlimited()).expect("memory is unlimited");
        for i in 0..1000 {
            assert_eq!((details[i as usize], bindings[i as usize]), (detail(i % 100), i % 7));
        }
    }

    #[test]
    fn equal_pairs_have_equal_numbers_however_the_table_grows() {
        let (mut table, mut known) = (DetailTable::default(), Vec::new());
        for i in 0..10_000_u32 {
            let binding = i * i % 4096;
            let id = table.number(CornerDetail::default(), binding, &Budget::unlimited()).expect("memory is unlimited");
            let is_new = id as usize == known.len();
            assert_eq!(is_new, !known.contains(&binding));
            if is_new {
                known.push(binding);
            }
            assert_eq!((known[id as usize], table.binding(id)), (binding, binding));
            assert!(table.ids.allocation_size() as u64 <= id_bytes(table.ids.capacity()));
        }
    }
}

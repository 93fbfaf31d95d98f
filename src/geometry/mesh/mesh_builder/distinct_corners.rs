//! A list of distinct corners.

use std::hash::{BuildHasher, Hash};
use std::hint::black_box;
use std::ops::Range;
use std::sync::atomic::AtomicU32;
use std::sync::atomic::Ordering::Relaxed;

use foldhash::fast::RandomState;
use hashbrown::HashTable;
use rayon::prelude::*;

use crate::casts::to_u32;
use crate::cores::{ranges, split};
use crate::mesh::Corner;
use crate::mesh::build_limits::{Budget, MemoryRefused};

/// How many tables find equal corners: as many cores can work at once.
const TABLES: usize = 32;

/// The most memory that tables take for a corner, in bytes: one and four bytes for each place, of which seven sixteenths are full at
/// least.
pub(super) const TABLE_BYTES: u64 = 12;

/// Corners that differ in some bit or in their binding, in the order of their first appearance.
#[derive(Default)]
pub(super) struct DistinctCorners {
    pub corners: Vec<Corner>,
    /// The binding of each corner; empty while all are 0.
    pub bindings: Vec<u32>,
    hasher: RandomState,
    /// The numbers of the corners, divided by their hashes.
    tables: [HashTable<u32>; TABLES],
}

impl DistinctCorners {
    /// Returns the hash of a corner for [`id_of`](Self::id_of).
    pub(super) fn hash(&self, corner: &Corner, binding: u32) -> u64 {
        self.hasher.hash_one(key(corner, binding))
    }

    /// Reads the place of this hash, so that the processor has it at hand when [`id_of`](Self::id_of) is called soon.
    pub(super) fn approach(&self, hash: u64) {
        black_box(self.tables[table_of(hash)].find(hash, |_| false));
    }

    /// Returns the number of a corner with this hash. A new corner gets the next number.
    pub(super) fn id_of(&mut self, hash: u64, corner: Corner, binding: u32) -> u32 {
        let (corners, bindings) = (&self.corners, &self.bindings);
        let next = to_u32(corners.len());
        let key_of = |id| if id == next { key(&corner, binding) } else { key_of(corners, bindings, id) };
        let id = find_or_add(&mut self.tables[table_of(hash)], hash, next, key_of, &self.hasher);
        if id == next {
            self.push(corner, binding);
        }
        id
    }

    /// Returns the numbers of many corners, as [`id_of`](Self::id_of) does of one after another. Each core looks up those of some tables.
    pub(super) fn ids(&mut self, offered: &[(Corner, u32)]) -> Vec<u32> {
        let Self { corners, bindings, hasher, tables } = &mut *self;
        let hash_of = |(corner, binding): &(Corner, u32)| hasher.hash_one(key(corner, *binding));
        let hashes: Vec<u64> = offered.par_iter().map(hash_of).collect();
        // Until it is known which ones are new, each has the number that it would have if all were.
        let first = to_u32(corners.len());
        let key_of = |id: u32| match id.checked_sub(first) {
            Some(place) => key(&offered[place as usize].0, offered[place as usize].1),
            None => key_of(corners, bindings, id),
        };
        let found: Vec<_> = offered.iter().map(|_| AtomicU32::new(0)).collect();
        with_tables(tables, &hashes, |table, place, hash| {
            let id = find_or_add(table, hash, first + to_u32(place), key_of, hasher);
            found[place].store(id, Relaxed);
        });
        let mut ids: Vec<u32> = found.iter().map(|id| id.load(Relaxed)).collect();
        let is_new = |place: usize| found[place].load(Relaxed) == first + to_u32(place);
        for place in 0..ids.len() {
            if is_new(place) {
                ids[place] = to_u32(self.corners.len());
                self.push(offered[place].0, offered[place].1);
            } else if ids[place] >= first {
                ids[place] = ids[(ids[place] - first) as usize];
            }
        }
        // A new number is never above the one before, so that none of those that follow in the table is taken for it.
        with_tables(&mut self.tables, &hashes, |table, place, hash| {
            let before = first + to_u32(place);
            if is_new(place) && ids[place] != before {
                table.find_mut(hash, |id| *id == before).into_iter().for_each(|id| *id = ids[place]);
            }
        });
        ids
    }

    fn push(&mut self, corner: Corner, binding: u32) {
        if binding != 0 || !self.bindings.is_empty() {
            self.bindings.resize(self.corners.len(), 0);
            self.bindings.push(binding);
        }
        self.corners.push(corner);
    }

    /// Returns how many more corners there is room for.
    pub(super) fn room(&self) -> usize {
        self.corners.capacity() - self.corners.len()
    }

    /// Makes room for exactly `more` further corners.
    ///
    /// # Errors
    /// [`MemoryRefused`].
    pub(super) fn make_room(&mut self, more: usize, budget: &Budget) -> Result<(), MemoryRefused> {
        let (all, before) = (self.corners.len() + more, self.corners.capacity());
        budget.exchange(before as u64 * 32, all as u64 * 32)?;
        self.corners.reserve_exact(more);
        // Tables grow one after another, in place of themselves.
        budget.hold((self.corners.capacity() - before) as u64 * TABLE_BYTES)?;
        let Self { corners, bindings, hasher, tables } = self;
        for table in tables {
            let hash = |&id: &u32| hasher.hash_one(key_of(corners, bindings, id));
            table.reserve((all / TABLES).saturating_sub(table.len()), hash);
        }
        Ok(())
    }

    /// Frees the tables that find equal corners: no more corners will be added.
    pub(super) fn close(&mut self, budget: &Budget) {
        budget.release(self.corners.capacity() as u64 * TABLE_BYTES);
        self.tables = Default::default();
    }
}

/// Returns which table has the corners with this hash. Tables themselves use the lowest bits and the highest ones.
fn table_of(hash: u64) -> usize {
    (hash >> 40) as usize % TABLES
}

/// Calls `work` with the table, the place and the hash of each of some hashes; with those of one table in the order of their places.
fn with_tables(tables: &mut [HashTable<u32>], hashes: &[u64], work: impl Fn(&mut HashTable<u32>, usize, u64) + Sync) {
    let parts: Vec<_> = ranges(TABLES, 1).collect();
    split(tables, parts.iter().map(Range::len)).into_par_iter().zip(&parts).for_each(|(tables, part)| {
        for (place, &hash) in hashes.iter().enumerate() {
            if let Some(table) = tables.get_mut(table_of(hash).wrapping_sub(part.start)) {
                work(table, place, hash);
            }
        }
    });
}

/// Returns the number in a table that has the key of this one, and this hash; or else adds this one.
fn find_or_add<K: Hash + Eq>(
    table: &mut HashTable<u32>,
    hash: u64,
    own: u32,
    key_of: impl Fn(u32) -> K,
    hasher: &RandomState,
) -> u32 {
    let key = key_of(own);
    *table.entry(hash, |&id| key_of(id) == key, |&id| hasher.hash_one(key_of(id))).or_insert(own).get()
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

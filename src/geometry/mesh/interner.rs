//! Gives equal keys equal numbers, while the keyed items lie in a list of the caller's.

use crate::casts::to_u32;
use std::hash::{BuildHasher, Hash};

use foldhash::fast::RandomState;
use hashbrown::HashTable;

/// Numbers items from 0 on. The table holds only the numbers: 5 to 12 bytes an item.
#[derive(Default)]
pub struct Interner {
    table: HashTable<u32>,
    hasher: RandomState,
}

impl Interner {
    /// Returns the number of the item with this key, and whether the item is new, in which case the number is the next
    /// one. `key_of` must return the key of each item that has a number.
    pub fn number<K: Hash + Eq>(&mut self, key: K, key_of: impl Fn(u32) -> K) -> (u32, bool) {
        let hash = self.hasher.hash_one(&key);
        if let Some(&id) = self.table.find(hash, |&id| key_of(id) == key) {
            return (id, false);
        }
        let id = to_u32(self.table.len());
        if self.table.len() == self.table.capacity() {
            self.reserve(self.table.len().max(8), &key_of);
        }
        self.table.insert_unique(hash, id, |&id| self.hasher.hash_one(key_of(id)));
        (id, true)
    }

    /// Makes room for `more` further items. The old table is freed before the new one is allocated.
    pub(crate) fn reserve<K: Hash>(&mut self, more: usize, key_of: impl Fn(u32) -> K) {
        let count = self.table.len();
        if self.table.capacity() - count >= more {
            return;
        }
        self.table = HashTable::new();
        self.table = HashTable::with_capacity(count + more);
        let hash = |&id: &u32| self.hasher.hash_one(key_of(id));
        for id in 0..to_u32(count) {
            self.table.insert_unique(hash(&id), id, hash);
        }
    }

    /// Returns how many more items there is room for.
    pub fn room(&self) -> usize {
        self.table.capacity() - self.table.len()
    }

    /// Returns the size of the table, in bytes.
    pub fn bytes(&self) -> u64 {
        self.table.allocation_size() as u64
    }

    /// Returns the greatest size of a table with room for `count` items, in bytes. A table has a power of two of slots,
    /// of which an eighth stays free.
    pub fn bytes_for(count: usize) -> u64 {
        let places = (count as u64 * 8).div_ceil(7).max(16).next_power_of_two();
        places * 5 + 64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_keys_have_equal_numbers_however_it_grows() {
        let (mut ids, mut things) = (Interner::default(), Vec::new());
        for i in 0..10_000_u64 {
            let key = i * i % 4096;
            let (id, is_new) = ids.number(key, |id| things[id as usize]);
            assert_eq!(is_new, !things.contains(&key));
            if is_new {
                things.push(key);
            }
            assert_eq!(things[id as usize], key);
            assert!(ids.bytes() <= Interner::bytes_for(ids.table.capacity()));
        }
        ids.reserve(100_000, |id| things[id as usize]);
        assert!(ids.room() >= 100_000 && ids.bytes() <= Interner::bytes_for(things.len() + 100_000));
        assert_eq!(ids.number(things[7], |id| things[id as usize]), (7, false));
    }
}

//! Disjoint sets that can be merged (union-find).

use std::sync::atomic::AtomicU32;
use std::sync::atomic::Ordering::Relaxed;

use crate::casts::to_u32;

/// Items 0 to n - 1, each in one set (Tarjan 1975: union by linking, with path halving). Several cores may join items at once.
pub struct UnionFind {
    /// For each item, a lower item of the same set; or itself, if it stands for the set.
    links: Vec<AtomicU32>,
}

impl UnionFind {
    /// Makes a set of its own for each item.
    pub fn new(items: usize) -> Self {
        Self { links: (0..to_u32(items)).map(AtomicU32::new).collect() }
    }

    /// Returns the set of an item, named by its lowest item. All items of a set get the same name until the next join.
    pub fn of(&self, mut item: u32) -> u32 {
        loop {
            let link = &self.links[item as usize];
            let next = link.load(Relaxed);
            if next == item {
                return item;
            }
            // Whatever another core writes here meanwhile is an item of this set too.
            link.store(self.links[next as usize].load(Relaxed), Relaxed);
            item = next;
        }
    }

    /// Merges the sets of two items.
    pub fn join(&self, a: u32, b: u32) {
        loop {
            let (a, b) = (self.of(a), self.of(b));
            let higher = &self.links[a.max(b) as usize];
            // It fails if another core has joined the higher one to something meanwhile.
            if a == b || higher.compare_exchange(a.max(b), a.min(b), Relaxed, Relaxed).is_ok() {
                return;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use rayon::prelude::*;

    use super::*;
    use crate::cores::on_threads;

    #[test]
    fn joined_items_are_in_one_set() {
        let parts = UnionFind::new(6);
        for [a, b] in [[4, 2], [1, 0], [2, 5], [5, 4]] {
            parts.join(a, b);
        }
        assert_eq!([0, 1, 2, 3, 4, 5].map(|item| parts.of(item)), [0, 0, 2, 3, 2, 2]);
    }

    #[test]
    fn several_cores_join_items_as_one_does() {
        let join = |cores| {
            let parts = UnionFind::new(100_000);
            on_threads(cores, || (0..90_000).into_par_iter().for_each(|i| parts.join(i, i * 7919 % 100_000)))
                .expect("threads");
            (0..100_000).map(|item| parts.of(item)).collect::<Vec<_>>()
        };
        assert_eq!(join(8), join(1));
    }
}

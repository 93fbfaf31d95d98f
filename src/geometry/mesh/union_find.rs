//! Disjoint sets that can be merged (union-find).

use crate::casts::to_u32;

/// Items 0 to n - 1, each in one set (Tarjan 1975: union by linking, with path halving).
pub struct UnionFind {
    /// For each item, another item of the same set; or itself, if it stands for the set.
    links: Vec<u32>,
}

impl UnionFind {
    /// Makes a set of its own for each item.
    pub fn new(items: usize) -> Self {
        Self { links: (0..to_u32(items)).collect() }
    }

    /// Returns the set of an item, named by one of its items. All items of a set get the same name until the next join.
    pub fn of(&mut self, mut item: u32) -> u32 {
        while self.links[item as usize] != item {
            let next = self.links[item as usize];
            self.links[item as usize] = self.links[next as usize];
            item = next;
        }
        item
    }

    /// Merges the sets of two items. The lower of their two names is the name of the result.
    pub fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.of(a), self.of(b));
        self.links[a.max(b) as usize] = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joined_items_are_in_one_set() {
        let mut parts = UnionFind::new(6);
        for [a, b] in [[4, 2], [1, 0], [2, 5], [5, 4]] {
            parts.join(a, b);
        }
        assert_eq!([0, 1, 2, 3, 4, 5].map(|item| parts.of(item)), [0, 0, 2, 3, 2, 2]);
    }
}

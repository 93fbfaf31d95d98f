//! What hangs together: sets that are joined two at a time.

/// Items 0 to n - 1, each in one part (Tarjan 1975: union by linking, with path halving).
pub struct UnionFind {
    /// Another item of the same part, or itself.
    links: Vec<u32>,
}

impl UnionFind {
    /// Every item a part of its own.
    pub fn new(items: usize) -> Self {
        Self { links: (0..items as u32).collect() }
    }

    /// The part of an item, named by one of its items: the same for all of them until the next join.
    pub fn of(&mut self, mut item: u32) -> u32 {
        while self.links[item as usize] != item {
            let next = self.links[item as usize];
            self.links[item as usize] = self.links[next as usize];
            item = next;
        }
        item
    }

    /// Makes one part of those of two items. The lower name stays.
    pub fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.of(a), self.of(b));
        self.links[a.max(b) as usize] = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_joined_hangs_together() {
        let mut parts = UnionFind::new(6);
        for [a, b] in [[4, 2], [1, 0], [2, 5], [5, 4]] {
            parts.join(a, b);
        }
        assert_eq!([0, 1, 2, 3, 4, 5].map(|item| parts.of(item)), [0, 0, 2, 3, 2, 2]);
    }
}

//! A list that grows without being copied: its end is elsewhere now and then.

/// The most items that lie in one piece.
const RUN: usize = 1 << 14;

pub struct ChunkedVec<T> {
    /// All but the last are full.
    runs: Vec<Vec<T>>,
    count: usize,
}

impl<T> Default for ChunkedVec<T> {
    fn default() -> Self {
        Self { runs: Vec::new(), count: 0 }
    }
}

impl<T> ChunkedVec<T> {
    pub fn push(&mut self, item: T) {
        if self.count.is_multiple_of(RUN) {
            // Most lists are short.
            self.runs.push(if self.count == 0 { Vec::new() } else { Vec::with_capacity(RUN) });
        }
        if let Some(run) = self.runs.last_mut() {
            run.push(item);
        }
        self.count += 1;
    }

    pub fn get(&self, i: usize) -> Option<&T> {
        self.runs.get(i / RUN)?.get(i % RUN)
    }

    pub fn len(&self) -> usize {
        self.count
    }

    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// What it takes, in bytes.
    pub fn bytes(&self) -> u64 {
        (self.runs.len() * RUN * size_of::<T>()) as u64
    }

    /// The bytes that the next item takes beyond those that are taken.
    pub fn next_bytes(&self) -> u64 {
        if self.count.is_multiple_of(RUN) { (RUN * size_of::<T>()) as u64 } else { 0 }
    }
}

impl<T> IntoIterator for ChunkedVec<T> {
    type Item = T;
    type IntoIter = std::iter::Flatten<std::vec::IntoIter<Vec<T>>>;

    fn into_iter(self) -> Self::IntoIter {
        self.runs.into_iter().flatten()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_stay_in_order_and_in_place() {
        let mut runs = ChunkedVec::default();
        for i in 0..3 * RUN + 5 {
            assert_eq!((runs.len(), runs.next_bytes() > 0), (i, i % RUN == 0));
            runs.push(i);
        }
        assert!([0, RUN - 1, RUN, 3 * RUN + 4].iter().all(|i| runs.get(*i) == Some(i)));
        assert_eq!(runs.get(3 * RUN + 5), None);
        assert!(runs.into_iter().eq(0..3 * RUN + 5));
    }
}

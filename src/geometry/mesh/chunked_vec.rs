//! A list of chunks that grows without copying its items.

/// The greatest number of items in a chunk.
const MAX_CHUNK: usize = 1 << 14;

/// A list that allocates a new chunk when it grows, so that its items stay where they are.
pub struct ChunkedVec<T> {
    /// All chunks but the last are full.
    chunks: Vec<Vec<T>>,
    count: usize,
}

impl<T> Default for ChunkedVec<T> {
    fn default() -> Self {
        Self { chunks: Vec::new(), count: 0 }
    }
}

impl<T> ChunkedVec<T> {
    pub fn push(&mut self, item: T) {
        if self.count.is_multiple_of(MAX_CHUNK) {
            // The first chunk grows from nothing, since most lists are short.
            self.chunks.push(if self.count == 0 { Vec::new() } else { Vec::with_capacity(MAX_CHUNK) });
        }
        if let Some(chunk) = self.chunks.last_mut() {
            chunk.push(item);
        }
        self.count += 1;
    }

    pub fn get(&self, i: usize) -> Option<&T> {
        self.chunks.get(i / MAX_CHUNK)?.get(i % MAX_CHUNK)
    }

    pub fn len(&self) -> usize {
        self.count
    }

    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Returns the size of the chunks, in bytes.
    pub fn bytes(&self) -> u64 {
        (self.chunks.len() * MAX_CHUNK * size_of::<T>()) as u64
    }

    /// Returns how many bytes the next [`push`](Self::push) allocates.
    pub fn next_bytes(&self) -> u64 {
        if self.count.is_multiple_of(MAX_CHUNK) { (MAX_CHUNK * size_of::<T>()) as u64 } else { 0 }
    }
}

impl<T> IntoIterator for ChunkedVec<T> {
    type Item = T;
    type IntoIter = std::iter::Flatten<std::vec::IntoIter<Vec<T>>>;

    fn into_iter(self) -> Self::IntoIter {
        self.chunks.into_iter().flatten()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_stay_in_order_and_in_place() {
        let mut chunks = ChunkedVec::default();
        for i in 0..3 * MAX_CHUNK + 5 {
            assert_eq!((chunks.len(), chunks.next_bytes() > 0), (i, i % MAX_CHUNK == 0));
            chunks.push(i);
        }
        assert!([0, MAX_CHUNK - 1, MAX_CHUNK, 3 * MAX_CHUNK + 4].iter().all(|i| chunks.get(*i) == Some(i)));
        assert_eq!(chunks.get(3 * MAX_CHUNK + 5), None);
        assert!(chunks.into_iter().eq(0..3 * MAX_CHUNK + 5));
    }
}

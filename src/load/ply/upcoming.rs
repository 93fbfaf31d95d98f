//! The next faces of a binary file, as far as they are triangles: decoded together.

use super::values::{FaceRow, Values};
use crate::recent_corners::VertexNumbers;

/// How many triangles are decoded together.
const BLOCK: u64 = 1 << 12;

/// Triangles that were decoded.
pub(super) struct Upcoming {
    row: FaceRow,
    block: Vec<[VertexNumbers; 3]>,
    /// The first that wasn't taken.
    next: usize,
}

impl Upcoming {
    pub(super) fn new(row: FaceRow) -> Self {
        Self { row, block: Vec::new(), next: 0 }
    }

    /// Returns the next faces that are triangles, of the `left` faces that are left. Without any, the next face isn't one.
    pub(super) fn triangles(&mut self, values: &Values, left: u64) -> &[[VertexNumbers; 3]] {
        if self.next == self.block.len() {
            let next = values.triangles(&self.row).take(left.min(BLOCK) as usize);
            self.block.clear();
            self.block.extend(next.map(|triangle| triangle.map(|vertex| [vertex, 0, 0])));
            self.next = 0;
        }
        &self.block[self.next..]
    }

    /// Goes on after so many of the [triangles](Self::triangles) that were returned. Returns false if the next face must be read in
    /// another way, whatever it is.
    pub(super) fn take(&mut self, values: &mut Values, triangles: usize) -> bool {
        values.skip_triangles(&self.row, triangles);
        self.next += triangles;
        if triangles > 0 && self.next == self.block.len() {
            return true;
        }
        self.next = self.block.len().min(self.next + 1);
        false
    }
}

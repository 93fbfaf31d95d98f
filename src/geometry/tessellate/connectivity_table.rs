//! The results of `connectivity` in a table. On a GPU it is faster to read one word than to compute it. The
//! table depends on numbers of segments only, and is the same for all meshes.
//!
//! Twin: `shaders/connectivity_table.wgsl`, in which the table is the storage buffer `connectivity_table`.

use std::sync::LazyLock;

use super::connectivity;
use super::rings::TransitionStep;

/// The numbers of segments that half a side may have: 0 to 32.
pub const PATTERN_HALVES: u32 = 33;
/// The table has room for this many triangles before the middle of a side.
pub const PATTERN_STEPS: u32 = 64;
/// The largest number of segments.
const MOST_SEGMENTS: u32 = 64;

/// Returns the index of triangle `t` before the middle of a side.
fn step_index(inner_half: u32, outer_half: u32, t: u32) -> u32 {
    (inner_half * PATTERN_HALVES + outer_half) * PATTERN_STEPS + t
}

/// Returns the index of the first triangle inside the first ring of a patch with `n` segments inside, 2 or more.
///
/// These triangles follow those of the sides, in the order of `n`. The triangles of smaller `n` are the sum of floor(3
/// k^2 / 2) for k below n - 2.
fn regular_index(n: u32) -> u32 {
    let rows = u64::from(n - 2);
    let squares = if rows == 0 { 0 } else { (rows - 1) * rows * (2 * rows - 1) / 2 };
    PATTERN_HALVES * PATTERN_HALVES * PATTERN_STEPS + ((squares - rows / 2) / 2) as u32
}

/// Looks up [`connectivity::transition_before_middle`].
#[cfg(test)]
fn transition_before_middle(inner_half: u32, outer_half: u32, t: u32) -> TransitionStep {
    let word = CONNECTIVITY_TABLE[step_index(inner_half, outer_half, t) as usize];
    TransitionStep {
        inner: word & 0xff,
        outer: word >> 8 & 0xff,
        along_inner: word & 0x1_0000 != 0,
        inner_first: word & 0x2_0000 != 0,
    }
}

/// Looks up [`connectivity::regular_triangle`].
#[cfg(test)]
fn regular_triangle(outer: u32, n: u32, t: u32) -> [u32; 3] {
    let word = CONNECTIVITY_TABLE[(regular_index(n) + t) as usize];
    let a = outer + (word & 0xfff);
    [a, a + (word >> 12 & 0x3ff) - 512, a + (word >> 22) - 512]
}

/// The table: first the triangles of the sides, then those inside the first ring. Triangles inside are stored as the first
/// point's number and the differences of the other two from it, plus 512; points of neighbouring rings never differ by more.
pub static CONNECTIVITY_TABLE: LazyLock<Vec<u32>> = LazyLock::new(|| {
    let flags = |step: TransitionStep| u32::from(step.along_inner) << 16 | u32::from(step.inner_first) << 17;
    let mut words = vec![0; regular_index(MOST_SEGMENTS + 1) as usize];
    for inner_half in 1..PATTERN_HALVES {
        for outer_half in 0..PATTERN_HALVES {
            for t in 0..inner_half - 1 + outer_half {
                let step = connectivity::transition_before_middle(inner_half, outer_half, t);
                words[step_index(inner_half, outer_half, t) as usize] = step.inner | step.outer << 8 | flags(step);
            }
        }
    }
    for n in 2..=MOST_SEGMENTS {
        let first = regular_index(n);
        for t in 0..regular_index(n + 1) - first {
            let [a, b, c] = connectivity::regular_triangle(0, n, t);
            words[(first + t) as usize] = a | (b + 512 - a) << 12 | (c + 512 - a) << 22;
        }
    }
    words
});

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tessellate::{Partitioning, process, triangle_count};

    #[test]
    fn every_transition_triangle_is_in_the_table() {
        for inner_half in 1..=32 {
            for outer_half in 0..=32 {
                for t in 0..inner_half - 1 + outer_half {
                    let computed = connectivity::transition_before_middle(inner_half, outer_half, t);
                    assert_eq!(transition_before_middle(inner_half, outer_half, t), computed);
                }
            }
        }
    }

    #[test]
    fn every_regular_triangle_is_in_the_table() {
        for n in 2..=64u32 {
            let count = triangle_count(process(Partitioning::Integer, [n as f32; 3], n as f32)) - 3 * n - 3 * (n - 2);
            assert_eq!(regular_index(n + 1) - regular_index(n), count);
            for t in 0..count {
                for outer in [3, 57, 192] {
                    assert_eq!(regular_triangle(outer, n, t), connectivity::regular_triangle(outer, n, t), "{n} {t}");
                }
            }
        }
    }
}

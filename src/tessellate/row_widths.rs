//! The numbers of segments of the rows of `rows.rs`, added up. Twin: `shaders/row_widths.wgsl`.

/// Returns `number / by`, rounded down. `number` is at most 65,535.
///
/// It is the integer part of an f32 quotient, since GPUs divide f32 numbers many times faster than integers. The 0.5 that is
/// added keeps the quotient further from integers than the 2.5 ULP by which WGSL lets it be wrong.
pub(super) fn quotient(number: u32, by: u32) -> u32 {
    ((number as f32 + 0.5) / by as f32) as u32
}

/// Returns a number for [`scaled`]. `by` is 1 to 128.
pub(super) fn reciprocal(by: u32) -> u32 {
    (1 << 24) / by + 1
}

/// Returns `number / by`, rounded down, for the [`reciprocal`] of `by`, with one multiplication. `number * by` is below 2^24,
/// and the quotient at most 255.
///
/// The reciprocal is too large by at most 1, which makes the quotient too large by at most `number / 2^24`: less than `1 / by`,
/// so that it doesn't reach the next whole number (Granlund and Montgomery 1994, *Division by Invariant Integers using
/// Multiplication*, theorem 4.2).
pub(super) fn scaled(number: u32, reciprocal: u32) -> u32 {
    (number * reciprocal) >> 24
}

/// Returns how many segments rows 1 to `row` have together, of `rows` rows that widen evenly to `width` segments: the sum of
/// ceil(width * i / rows) for i from 1 to `row`. `rows` and `width` are 1 to 64, and `row` is at most `rows`.
///
/// A sum of rounded-down fractions counts the points of a lattice below a line. As in Euclid's algorithm, the line's slope
/// is reduced below 1, and then the axes are exchanged (Graham, Knuth and Patashnik, *Concrete Mathematics*, section 3.5).
pub(super) fn widths_through(rows: u32, width: u32, row: u32) -> u32 {
    // The sum of floor((slope * i + shift) / base) for i from 0 to count - 1, of which the first is floor((rows - 1) / rows).
    let (mut count, mut base, mut slope, mut shift) = (row + 1, rows, width, rows - 1);
    let mut sum = 0;
    while count > 0 {
        let (steps, steps_at_start) = (quotient(slope, base), quotient(shift, base));
        sum += count * (count - 1) / 2 * steps + count * steps_at_start;
        (slope, shift) = (slope - steps * base, shift - steps_at_start * base);
        // The line's height at the end. Below it, columns are counted as rows.
        let end = slope * count + shift;
        count = quotient(end, base);
        shift = end - count * base;
        (base, slope) = (slope, base);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotients_are_rounded_down() {
        for by in 1..=256 {
            for number in 0..=65535 {
                assert_eq!(quotient(number, by), number / by, "{number} / {by}");
            }
        }
    }

    #[test]
    fn products_with_reciprocals_are_rounded_down() {
        for by in 1..=128 {
            for number in 0..=((1 << 24) / by).min(255 * by) {
                assert_eq!(scaled(number, reciprocal(by)), number / by, "{number} / {by}");
            }
        }
    }

    #[test]
    fn the_sum_is_that_of_all_rows() {
        for rows in 1..=64 {
            for width in 1..=64 {
                let mut sum = 0;
                for row in 0..=rows {
                    sum += u32::div_ceil(width * row, rows);
                    assert_eq!(widths_through(rows, width, row), sum, "row {row} of {rows}, to {width}");
                }
            }
        }
    }
}

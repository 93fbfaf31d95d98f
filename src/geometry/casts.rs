//! Conversions of numbers that may not fit, each with what keeps it right.

/// Converts a count or an index of a mesh. [`build_limits`](crate::mesh) keeps all of them below 2³².
///
/// # Panics
/// If it doesn't fit, since another index would show another mesh.
#[inline]
pub fn to_u32(count: usize) -> u32 {
    u32::try_from(count).expect("counts of a mesh fit in 32 bits")
}

/// Converts a size or an offset. What doesn't fit in the address space becomes its end, which every limit refuses.
#[inline]
pub fn to_usize(size: u64) -> usize {
    usize::try_from(size).unwrap_or(usize::MAX)
}

/// Rounds to the nearest f32; beyond the largest it is infinite.
#[inline]
#[expect(clippy::cast_possible_truncation, reason = "`as` rounds to the nearest, which is what is asked for")]
pub fn to_f32(number: f64) -> f32 {
    number as f32
}

/// Rounds to the nearest of 0 to 255.
#[inline]
#[expect(clippy::cast_possible_truncation, reason = "`as` takes what is outside to the nearer end")]
pub fn to_byte(number: f32) -> u8 {
    number.round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_and_kept_in_their_range() {
        assert_eq!([-3.0, 0.49, 127.5, 254.6, 1e9, f32::NAN].map(to_byte), [0, 0, 128, 255, 255, 0]);
        assert_eq!([to_f32(0.1), to_f32(1e300)], [0.1, f32::INFINITY]);
        assert_eq!([to_u32(0), to_u32(u32::MAX as usize)], [0, u32::MAX]);
        assert_eq!(to_usize(1 << 40), 1 << 40);
    }

    #[test]
    #[should_panic = "counts of a mesh fit in 32 bits"]
    fn a_count_that_does_not_fit_is_not_cut() {
        to_u32(1 << 32);
    }
}

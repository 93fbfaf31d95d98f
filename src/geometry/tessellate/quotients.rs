//! Whole quotients and common divisors without divisions of integers, which take a GPU many instructions. Twin:
//! `shaders/quotients.wgsl`.

/// Returns `number / by`, rounded down. `number` is at most 65,535.
///
/// It is the integer part of an f32 quotient, since GPUs divide f32 numbers many times faster than integers. The 0.5 that is
/// added keeps the quotient further from integers than the 2.5 ULP by which WGSL lets it be wrong.
pub(super) fn quotient(number: u32, by: u32) -> u32 {
    ((number as f32 + 0.5) / by as f32) as u32
}

/// Returns a number for [`divided`]. `by` is 1 to 2^14.
pub(super) fn inverse(by: u32) -> f32 {
    1.0 / by as f32
}

/// Returns `number / by`, rounded down, for the [`inverse`] of `by`, as [`quotient`] does. `number` is at most 2^20.
pub(super) fn divided(number: u32, inverse: f32) -> u32 {
    ((number as f32 + 0.5) * inverse) as u32
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

/// Returns the greatest common divisor of two numbers of at most 65,535, by Euclid's algorithm.
pub(super) fn common_divisor(one: u32, other: u32) -> u32 {
    let (mut divisor, mut rest) = (one, other);
    while rest > 0 {
        (divisor, rest) = (rest, divisor - quotient(divisor, rest) * rest);
    }
    divisor
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
    fn products_with_inverses_are_rounded_down() {
        for by in 1..=1 << 14u32 {
            // WGSL lets an inverse be wrong by 2.5 ULP.
            for off in [-3, 0, 3] {
                let inverse = f32::from_bits(inverse(by).to_bits().wrapping_add_signed(off));
                for multiple in (0..=1 << 20).map(|times| times * by).take_while(|&multiple| multiple + by <= 1 << 20) {
                    assert_eq!(divided(multiple, inverse), multiple / by, "{multiple} / {by}");
                    assert_eq!(divided(multiple + by - 1, inverse), multiple / by, "{multiple} + {by} - 1");
                }
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
    fn common_divisors_are_the_greatest() {
        for (one, other) in (1..=127).flat_map(|one| (1..=127).map(move |other| (one, other))) {
            let divides = |by: &u32| one % by == 0 && other % by == 0;
            assert_eq!((1..=127).rev().find(divides), Some(common_divisor(one, other)), "{one} and {other}");
        }
    }
}

// Whole quotients and common divisors without divisions of integers, which take a GPU many instructions. Twin:
// src/geometry/tessellate/quotients.rs.

// Returns `number / by`, rounded down, as the integer part of an f32 quotient. `number` is at most 65,535.
fn quotient(number: u32, by: u32) -> u32 {
    return u32((f32(number) + 0.5) / f32(by));
}

// Returns a number for `divided`. `by` is 1 to 2^14.
fn inverse(by: u32) -> f32 {
    return 1.0 / f32(by);
}

// Returns `number / by`, rounded down, for the inverse of `by`. `number` is at most 2^20.
fn divided(number: u32, inverse: f32) -> u32 {
    return u32((f32(number) + 0.5) * inverse);
}

// Returns a number for `scaled`. `by` is 1 to 128.
fn reciprocal(by: u32) -> u32 {
    return 16777216u / by + 1u;
}

// Returns `number / by`, rounded down, for the reciprocal of `by`. `number * by` is below 2^24, and the quotient at most 255.
fn scaled(number: u32, reciprocal: u32) -> u32 {
    return (number * reciprocal) >> 24u;
}

// Returns the greatest common divisor of two numbers of at most 65,535, by Euclid's algorithm.
fn common_divisor(one: u32, other: u32) -> u32 {
    var divisor = one;
    var rest = other;
    while rest > 0u {
        let next = divisor - quotient(divisor, rest) * rest;
        divisor = rest;
        rest = next;
    }
    return divisor;
}

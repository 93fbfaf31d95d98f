// Rows of points: where the points of an edge, or of a side of a ring, lie between its ends. Twin:
// src/geometry/tessellate/domain_row.rs.

// A row of points, prepared for `row_location`.
struct DomainRow {
    half: u32,
    odd: u32,
    fraction: u32,
    split: u32,
    coarse_step: u32,
    fine_step: u32,
}

// Returns the length of one of `segments` equal segments in 16.16 fixed point: 1 / segments, rounded half up. There are
// at most 128 segments.
fn segment_length(segments: u32) -> u32 {
    return u32((f32(2u * FIXED_ONE + segments) + 0.5) / f32(2u * segments));
}

// Clears the highest set bit of a number, which must not be zero.
fn drop_top_bit(value: u32) -> u32 {
    return value ^ (1u << firstLeadingBit(value));
}

// Returns the point of each half after which the next new point grows. New points come in the order of a breadth-first
// bisection.
fn row_split(whole: u32, odd: u32) -> u32 {
    let v = whole - odd;
    return select(2u * drop_top_bit(v) + 1u, 0u, v == 0u);
}

// Prepares the row of a factor's word.
fn domain_row(word: u32) -> DomainRow {
    let factor = half_factor(word);
    let whole = factor >> 16u;
    let odd = odd_parity(word);
    let fraction = factor & 0xffffu;
    let half = half_segments(word);
    return DomainRow(
        half,
        odd,
        fraction,
        select(row_split(whole, odd), 0xffffffffu, fraction == 0u),
        segment_length(2u * whole - odd),
        segment_length(2u * half - odd),
    );
}

// Returns where point `p` of a row lies, from 0 to 1 in 16.16 fixed point. Rows are symmetric to the last bit.
fn row_location(row: DomainRow, p: u32) -> u32 {
    if row.odd == 0u && p == row.half {
        return FIXED_HALF;
    }
    let mirrored = p >= row.half;
    let fine = select(p, 2u * row.half - row.odd - p, mirrored);
    let coarse = select(fine, fine - 1u, fine > row.split);
    let coarse_part = coarse * row.coarse_step * (FIXED_ONE - row.fraction);
    let fine_part = fine * row.fine_step * row.fraction;
    let x = (coarse_part + fine_part + FIXED_HALF) >> 16u;
    return select(x, FIXED_ONE - x, mirrored);
}

// Returns where point `p` of a row of so many equal segments, at most 127, lies: as `row_location` of a whole factor. `step` is
// the segment_length.
fn whole_location(segments: u32, step: u32, p: u32) -> u32 {
    if 2u * p == segments {
        return FIXED_HALF;
    }
    return select(p * step, FIXED_ONE - (segments - p) * step, 2u * p > segments);
}

// The numbers of segments of the rows of rows.wgsl, added up. Twin: src/tessellate/row_widths.rs.

// Returns `number / by`, rounded down, as the integer part of an f32 quotient. `number` is at most 65,535.
fn quotient(number: u32, by: u32) -> u32 {
    return u32((f32(number) + 0.5) / f32(by));
}

// Returns a number for `scaled`. `by` is 1 to 128.
fn reciprocal(by: u32) -> u32 {
    return 16777216u / by + 1u;
}

// Returns `number / by`, rounded down, for the reciprocal of `by`. `number * by` is below 2^24, and the quotient at most 255.
fn scaled(number: u32, reciprocal: u32) -> u32 {
    return (number * reciprocal) >> 24u;
}

// Returns how many segments rows 1 to `row` have together, of `rows` rows that widen evenly to `width` segments: the sum of
// ceil(width * i / rows) for i from 1 to `row`, by Euclid's algorithm.
fn widths_through(rows: u32, width: u32, row: u32) -> u32 {
    var count = row + 1u;
    var base = rows;
    var slope = width;
    var shift = rows - 1u;
    var sum = 0u;
    while count > 0u {
        let steps = quotient(slope, base);
        let steps_at_start = quotient(shift, base);
        sum += count * (count - 1u) / 2u * steps + count * steps_at_start;
        slope -= steps * base;
        shift -= steps_at_start * base;
        // The line's height at the end. Below it, columns are counted as rows.
        let end = slope * count + shift;
        count = quotient(end, base);
        shift = end - count * base;
        let steep = base;
        base = slope;
        slope = steep;
    }
    return sum;
}

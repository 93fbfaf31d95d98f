// The numbers of segments of the rows of rows.wgsl, added up. Twin: src/tessellate/row_widths.rs.

// Returns how many segments rows 1 to `row` have together, of `rows` rows that widen evenly to `width` segments: the sum of
// ceil(width * i / rows) for i from 1 to `row`, by Euclid's algorithm.
fn widths_through(rows: u32, width: u32, row: u32) -> u32 {
    var count = row + 1u;
    var base = rows;
    var slope = width;
    var shift = rows - 1u;
    var sum = 0u;
    while count > 0u {
        sum += count * (count - 1u) / 2u * (slope / base) + count * (shift / base);
        slope = slope % base;
        shift = shift % base;
        // The line's height at the end. Below it, columns are counted as rows.
        let end = slope * count + shift;
        count = end / base;
        shift = end % base;
        let steep = base;
        base = slope;
        slope = steep;
    }
    return sum;
}

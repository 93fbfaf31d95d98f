// Rows: a pattern in which a patch is cut into strips beside one of its edges. Each point and each triangle is computed from
// its number alone. Twin: src/tessellate/rows.rs, which describes the pattern. Needs connectivity.wgsl or
// connectivity_table.wgsl.

// A patch's rows, prepared for `row_point`, `row_triangle` and `row_triangle_places`.
struct RowPlan {
    // The numbers of segments of the first edge, of the second, and of the base.
    a: u32,
    b: u32,
    c: u32,
    // The lengths of one segment of the first edge and of the second.
    a_step: u32,
    b_step: u32,
    // The number of rows, and its reciprocal.
    n: u32,
    per_row: u32,
    width: u32,
    base: u32,
    // 1 if diagonals are flipped, else 0.
    flip: u32,
    apex: u32,
    outer: u32,
}

// Returns the larger of 1 and row * segments / n, rounded half up: where a row after the first starts on an edge with so many
// segments.
fn end_place(plan: RowPlan, segments: u32, row: u32) -> u32 {
    return max(scaled(2u * row * segments + plan.n, plan.per_row) >> 1u, 1u);
}

// Returns one of three numbers, from those that follow each other in a circle.
fn in_circle(numbers: vec3<u32>, i: u32) -> u32 {
    let at = select(i, i - 3u, i >= 3u);
    return select(select(numbers.x, numbers.y, at == 1u), numbers.z, at == 2u);
}

// Prepares the rows of a patch.
fn row_plan(factors: PatchFactors) -> RowPlan {
    let base = row_base(factors);
    let words = factors.outside;
    let counts = vec3<u32>(segments(words.x), segments(words.y), segments(words.z));
    let starts = vec3<u32>(0u, counts.x, counts.x + counts.y);
    let a = in_circle(counts, base + 2u);
    let b = in_circle(counts, base + 1u);
    let n = row_count(factors);
    return RowPlan(
        a,
        b,
        in_circle(counts, base),
        segment_length(a),
        segment_length(b),
        n,
        reciprocal(n),
        row_width(factors),
        base,
        row_flip(factors),
        in_circle(starts, base + 2u),
        counts.x + counts.y + counts.z,
    );
}

// Returns how many points lie inside the patch in rows 1 to `row`, if these have `widths` segments together.
fn points_through(widths: u32, row: u32) -> u32 {
    return widths - row;
}

// Returns the number of triangles before the strip below row `row`, which is 1 or more and less than the number of rows. `widths`
// are its row_widths.
fn triangles_before(plan: RowPlan, row: u32, widths: vec2<u32>) -> u32 {
    return widths.x + widths.y + end_place(plan, plan.a, row) + end_place(plan, plan.b, row) - 2u * row;
}

// Returns between which rows the strip with triangle `t` begins: the first one or later, and before the second one.
fn rows_around(plan: RowPlan, t: u32) -> vec2<u32> {
    let n = f32(plan.n);
    let m = f32(plan.width);
    let sides = f32(plan.a + plan.b);
    let slopes = vec2<f32>(sides, sides - 2.0 * n);
    let heights = max(vec2<f32>(f32(t) - 2.0, f32(t) + 2.0), vec2<f32>(0.0));
    let roots = (sqrt(slopes * slopes + 4.0 * m * n * heights) - slopes) / (2.0 * m);
    // Bounds that are too far apart are no mistake, so roundings go outwards.
    let first = u32(max(roots.x - 0.015625, 0.0));
    // The base may have so many segments that the first bound is beyond the last strip.
    return vec2<u32>(min(first, plan.n - 1u), min(plan.n, u32(roots.y + 1.015625) + 1u));
}

// Returns point `i` of the outline, counted from the apex.
fn outline_point(plan: RowPlan, i: u32) -> u32 {
    let at = plan.apex + i;
    return select(at, at - plan.outer, at >= plan.outer);
}

// Returns the number of segments of a row between the apex and the base: ceil(width * row / rows).
fn row_segments(plan: RowPlan, row: u32) -> u32 {
    return scaled(plan.width * row + plan.n - 1u, plan.per_row);
}

// A row: its number of segments, and at which points of the first and of the second edge it starts and ends, counted from the
// apex.
struct PatternRow {
    segments: u32,
    start: u32,
    end: u32,
}

// Returns a row of a patch.
fn row_at(plan: RowPlan, row: u32) -> PatternRow {
    if row == 0u {
        return PatternRow(0u, 0u, 0u);
    }
    // The last row starts and ends at the last points of the two edges.
    let segments = select(row_segments(plan, row), plan.c, row == plan.n);
    return PatternRow(segments, end_place(plan, plan.a, row), end_place(plan, plan.b, row));
}

// A strip between a row and the next one.
struct Strip {
    // The number of the upper row.
    row: u32,
    upper: PatternRow,
    lower: PatternRow,
}

// Returns the number of triangles of a strip: one for each segment of its two rows, less one for each point that they share.
fn strip_triangles(strip: Strip) -> u32 {
    let joint = u32(strip.upper.start == strip.lower.start) + u32(strip.upper.end == strip.lower.end);
    return strip.upper.segments + strip.lower.segments - joint;
}

// A corner of a triangle: whether it is on the lower row of its strip, and which point of its row it is.
struct StripPoint {
    is_lower: bool,
    at: u32,
}

// Returns the corners of triangle `i` of a strip, in the order of the outline.
fn strip_corners(plan: RowPlan, strip: Strip, i: u32) -> array<StripPoint, 3> {
    let shares_start = u32(strip.upper.start == strip.lower.start);
    let joint = shares_start + u32(strip.upper.end == strip.lower.end);
    let own = strip.upper.segments - joint;
    let others = strip.lower.segments - joint;

    // The triangle at a shared start stands on the upper row, the one at a shared end on the lower row.
    var at = vec2<u32>(0u, 1u);
    var is_upper = true;
    if i >= shares_start {
        // Of the first steps along both rows, those along the upper row are step * own / (own + others), halves rounded up, or down
        // if diagonals are flipped. The next step is one of them if it makes them more.
        let step = i - shares_start;
        let all = max(own + others, 1u);
        let halves = 2u * step * own + all - plan.flip;
        let along_upper = quotient(halves, 2u * all);
        at = shares_start + vec2<u32>(along_upper, step - along_upper);
        is_upper = step < own + others && halves + 2u * own >= 2u * all * (along_upper + 1u);
    }
    let upper = StripPoint(false, at.x);
    let lower = StripPoint(true, at.y);
    if is_upper {
        return array<StripPoint, 3>(StripPoint(false, at.x + 1u), upper, lower);
    }
    return array<StripPoint, 3>(upper, lower, StripPoint(true, at.y + 1u));
}

// Returns the number of point `at` of row `row`. `above` is how many segments rows 1 to `row - 1` have together.
fn number_in_row(plan: RowPlan, row: u32, own: PatternRow, above: u32, at: u32) -> u32 {
    if at == 0u {
        return outline_point(plan, own.start);
    }
    if at == own.segments {
        return outline_point(plan, plan.outer - own.end);
    }
    if row == plan.n {
        // The points of the base follow each other on the outline.
        return outline_point(plan, plan.a) + at;
    }
    return plan.outer + points_through(above, row - 1u) + at - 1u;
}

// Returns the number of a corner of a triangle. `widths` are the row_widths of the strip's upper row.
fn corner_number(plan: RowPlan, strip: Strip, widths: vec2<u32>, corner: StripPoint) -> u32 {
    if corner.is_lower {
        return number_in_row(plan, strip.row + 1u, strip.lower, widths.y, corner.at);
    }
    return number_in_row(plan, strip.row, strip.upper, widths.x, corner.at);
}

// Returns triangle `t` of a patch, as point numbers, in the order of the outline.
fn row_triangle(plan: RowPlan, t: u32) -> vec3<u32> {
    // A bisection over the few strips that it can be. No triangle is before row 0.
    let around = rows_around(plan, t);
    var row = around.x;
    var end = around.y;
    var before = 0u;
    var widths = vec2<u32>(0u);
    if row > 0u {
        widths = row_widths(plan.n, plan.width, row);
        before = triangles_before(plan, row, widths);
    }
    while row + 1u < end {
        let middle = (row + end) / 2u;
        let own = row_widths(plan.n, plan.width, middle);
        let count = triangles_before(plan, middle, own);
        if count <= t {
            row = middle;
            before = count;
            widths = own;
        } else {
            end = middle;
        }
    }
    let strip = Strip(row, row_at(plan, row), row_at(plan, row + 1u));
    let corners = strip_corners(plan, strip, t - before);
    return vec3<u32>(
        corner_number(plan, strip, widths, corners[0]),
        corner_number(plan, strip, widths, corners[1]),
        corner_number(plan, strip, widths, corners[2]),
    );
}

// Returns (U, V) of point `at` of a row, in 16.16 fixed point.
fn place_in_row(plan: RowPlan, row: PatternRow, at: u32) -> vec2<u32> {
    let start = whole_location(plan.a, plan.a_step, row.start);
    let end = whole_location(plan.b, plan.b_step, row.end);
    // The weights of the base's start and end. Neither product exceeds 32 bits, since `along` is neither 0 nor 1.
    let segments = max(row.segments, 1u);
    let along = whole_location(segments, segment_length(segments), at);
    let inner = (vec2<u32>(start, end) * vec2<u32>(FIXED_ONE - along, along) + FIXED_HALF) >> vec2<u32>(16u);
    let at_start = select(select(inner.x, 0u, at == row.segments), start, at == 0u);
    let at_end = select(select(inner.y, end, at == row.segments), 0u, at == 0u);
    let at_apex = FIXED_ONE - at_start - at_end;
    let beside = select(vec2<u32>(at_apex, at_start), vec2<u32>(at_end, at_apex), plan.base == 1u);
    return select(beside, vec2<u32>(at_start, at_end), plan.base == 2u);
}

// Returns (U, V) of a corner of a triangle.
fn corner_place(plan: RowPlan, strip: Strip, corner: StripPoint) -> vec2<u32> {
    if corner.is_lower {
        return place_in_row(plan, strip.lower, corner.at);
    }
    return place_in_row(plan, strip.upper, corner.at);
}

// Returns (U, V) of the corners of triangle `t` of a patch, in 16.16 fixed point. It passes the strips before the triangle one by
// one: for the few rows of most patches that is faster than finding points by their numbers.
fn row_triangle_places(plan: RowPlan, t: u32) -> array<vec2<u32>, 3> {
    var strip = Strip(0u, row_at(plan, 0u), row_at(plan, 1u));
    var rest = t;
    while rest >= strip_triangles(strip) && strip.row + 1u < plan.n {
        rest -= strip_triangles(strip);
        strip = Strip(strip.row + 1u, strip.lower, row_at(plan, strip.row + 2u));
    }
    let corners = strip_corners(plan, strip, rest);
    return array<vec2<u32>, 3>(
        corner_place(plan, strip, corners[0]),
        corner_place(plan, strip, corners[1]),
        corner_place(plan, strip, corners[2]),
    );
}

// Returns the row of point `i` of those inside the patch, and the point's place in it.
fn row_of_point(plan: RowPlan, i: u32) -> vec2<u32> {
    let n = f32(plan.n);
    let width = f32(plan.width);
    let root = sqrt((width - 2.0) * (width - 2.0) + 8.0 * width * n * f32(i));
    // Too few rows are no mistake, so rounding is always downwards.
    var row = u32(max((root + 2.0 - width) / (2.0 * width) - 0.015625, 0.0));
    var rest = i - points_through(widths_through(plan.n, plan.width, row), row);
    var inner = row_segments(plan, row + 1u) - 1u;
    var alike = quotient((inner + 1u) * plan.n, plan.width) - row;
    while rest >= alike * inner {
        rest -= alike * inner;
        row += alike;
        inner = row_segments(plan, row + 1u) - 1u;
        alike = quotient((inner + 1u) * plan.n, plan.width) - row;
    }
    let passed = quotient(rest, inner);
    return vec2<u32>(row + 1u + passed, rest - passed * inner + 1u);
}

// Returns (U, V) of point `i` of those inside the patch, in 16.16 fixed point.
fn row_point(plan: RowPlan, i: u32) -> vec2<u32> {
    let found = row_of_point(plan, i);
    return place_in_row(plan, row_at(plan, found.x), found.y);
}

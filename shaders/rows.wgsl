// Rows: a pattern in which a patch is cut into strips beside one of its edges. Each point and each triangle is computed from
// its number alone. Twin: src/geometry/tessellate/rows.rs, which describes the pattern.

// A patch's rows, prepared for `row_triangle_places`.
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

// A patch's rows, prepared for `row_point` and `row_triangle`.
struct NumberedRows {
    rows: RowPlan,
    // The common_divisor of the number of rows and the width.
    divisor: u32,
    // How many points lie inside the patch.
    inside: u32,
    // The inverse of how many points `n` pairs of rows have, and of half of how many triangles `n` pairs of strips have.
    per_point: f32,
    per_half: f32,
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

// Prepares the rows of a patch, and their numbers.
fn numbered_rows(factors: PatchFactors) -> NumberedRows {
    let rows = row_plan(factors);
    let divisor = common_divisor(rows.n, rows.width);
    return NumberedRows(
        rows,
        divisor,
        points_in_rows(rows.n, rows.width, divisor),
        // Where there is nothing to find, any number will do.
        inverse(max(rows.n * (rows.width - 1u), divisor + 1u) - divisor),
        inverse(max(rows.n * rows.width, divisor + 1u) - divisor),
    );
}

// Returns point `i` of the outline, counted from the apex.
fn outline_point(plan: RowPlan, i: u32) -> u32 {
    let at = plan.apex + i;
    return select(at, at - plan.outer, at >= plan.outer);
}

// Returns ceil(width * row / rows): the number of segments of a row before the base.
fn widened(plan: RowPlan, row: u32) -> u32 {
    return scaled(plan.width * row + plan.n - 1u, plan.per_row);
}

// Returns the number of segments of a row.
fn row_segments(plan: RowPlan, row: u32) -> u32 {
    return select(widened(plan, row), plan.c, row == plan.n);
}

// Returns where a row starts on the first edge and ends on the second: max(1, row * segments / n) of each, rounded half up.
fn end_places(plan: RowPlan, row: u32) -> vec2<u32> {
    let place = max(scaled(2u * row * min(plan.a, plan.b) + plan.n, plan.per_row) >> 1u, min(row, 1u));
    return select(vec2<u32>(row, place), vec2<u32>(place, row), plan.a < plan.b);
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
    let ends = end_places(plan, row);
    return PatternRow(row_segments(plan, row), ends.x, ends.y);
}

// A strip between a row and the next one.
struct Strip {
    // The number of the upper row.
    row: u32,
    upper: PatternRow,
    lower: PatternRow,
}

// Returns the strip below a row.
fn strip_below(plan: RowPlan, row: u32) -> Strip {
    return Strip(row, row_at(plan, row), row_at(plan, row + 1u));
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

// Returns how many points the first `pairs` pairs of rows have inside the patch, of which pair j is rows j and n - j.
fn pair_points(rows: NumberedRows, pairs: u32) -> u32 {
    return pairs * (rows.rows.width - 1u) - scaled(pairs * rows.divisor, rows.rows.per_row);
}

// Returns the row of point `i` of those inside the patch, and the point's place in it. Points are numbered pair by pair, the row
// nearer to the apex first.
fn row_of_point(rows: NumberedRows, i: u32) -> vec2<u32> {
    let pairs = divided(i * rows.rows.n, rows.per_point);
    let rest = i - pair_points(rows, pairs);
    let inner = widened(rows.rows, pairs + 1u) - 1u;
    let farther = vec2<u32>(rows.rows.n - pairs - 1u, rest - inner + 1u);
    return select(farther, vec2<u32>(pairs + 1u, rest + 1u), rest < inner);
}

// Returns the number that is added to a point's place in a row with so many segments, if it's no end of the row.
fn number_before(rows: NumberedRows, row: u32, segments: u32) -> u32 {
    let plan = rows.rows;
    let is_farther = 2u * row > plan.n;
    let pairs = select(max(row, 1u) - 1u, plan.n - row, is_farther);
    let inside = plan.outer + pair_points(rows, pairs) - select(1u, segments, is_farther);
    // The points of the base follow each other on the outline.
    return select(inside, outline_point(plan, plan.a), row == plan.n);
}

// Returns the strip with triangle `k` of the last ones.
fn unshared_strip(plan: RowPlan, k: u32) -> u32 {
    let fewer = 2u * min(plan.a, plan.b);
    return select(quotient((2u * k + 1u) * plan.n + fewer - 1u, fewer) - 1u, 0u, k == 0u);
}

// Returns the strip with triangle `t`, and the triangle's number in it.
fn strip_of_triangle(rows: NumberedRows, t: u32) -> vec2<u32> {
    let plan = rows.rows;
    let last = plan.n - 1u;
    if t < widened(plan, last) + plan.c - 1u {
        return vec2<u32>(last, t);
    }
    let paired = 2u * rows.inside + last + plan.c - 1u;
    if t >= paired {
        let row = unshared_strip(plan, t - paired);
        return vec2<u32>(row, row_segments(plan, row) + row_segments(plan, row + 1u) - 1u);
    }
    let i = t + plan.width - plan.c;
    let pairs = divided(((i + 1u) >> 1u) * plan.n - (i & 1u), rows.per_half);
    let whole = scaled(pairs * rows.divisor, plan.per_row);
    let is_rounded = whole * plan.n != pairs * rows.divisor;
    let rest = i + u32(is_rounded) - 2u * (pairs * plan.width - whole);
    let lower = last - pairs;
    let in_lower = widened(plan, lower) + widened(plan, lower + 1u) - 1u;
    return select(vec2<u32>(pairs, rest - in_lower), vec2<u32>(lower, rest), rest < in_lower);
}

// Returns the number of a corner of a triangle. `before` are the number_before of the strip's upper and lower row.
fn corner_number(plan: RowPlan, strip: Strip, before: vec2<u32>, corner: StripPoint) -> u32 {
    var row = strip.upper;
    if corner.is_lower {
        row = strip.lower;
    }
    let inside = select(before.x, before.y, corner.is_lower) + corner.at;
    let end = outline_point(plan, select(plan.outer - row.end, row.start, corner.at == 0u));
    return select(inside, end, corner.at == 0u || corner.at == row.segments);
}

// Returns triangle `t` of a patch, as point numbers, in the order of the outline.
fn row_triangle(rows: NumberedRows, t: u32) -> vec3<u32> {
    let plan = rows.rows;
    let at = strip_of_triangle(rows, t);
    let strip = strip_below(plan, at.x);
    let before = vec2<u32>(
        number_before(rows, at.x, strip.upper.segments),
        number_before(rows, at.x + 1u, strip.lower.segments),
    );
    let corners = strip_corners(plan, strip, at.y);
    return vec3<u32>(
        corner_number(plan, strip, before, corners[0]),
        corner_number(plan, strip, before, corners[1]),
        corner_number(plan, strip, before, corners[2]),
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

// Returns (U, V) of the corners of triangle `t` of a patch, counted strip by strip from the apex, in 16.16 fixed point. LOD by
// error looks at triangles in this order. For the few rows of most patches it is faster to pass strips one by one than to prepare
// NumberedRows.
fn row_triangle_places(plan: RowPlan, t: u32) -> array<vec2<u32>, 3> {
    var strip = strip_below(plan, 0u);
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

// Returns (U, V) of point `i` of those inside the patch, in 16.16 fixed point.
fn row_point(rows: NumberedRows, i: u32) -> vec2<u32> {
    let at = row_of_point(rows, i);
    return place_in_row(rows.rows, row_at(rows.rows, at.x), at.y);
}

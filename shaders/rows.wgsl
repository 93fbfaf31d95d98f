// Rows: a pattern in which a patch is cut into strips beside one of its edges. Each point and each triangle is computed from
// its number alone. Twin: src/tessellate/rows.rs, which describes the pattern. Needs connectivity.wgsl or
// connectivity_table.wgsl.

// A patch's rows, prepared for `row_point` and `row_triangle`.
struct RowPlan {
    // The words of the first and of the second edge.
    edges: vec2<u32>,
    a: u32,
    b: u32,
    c: u32,
    n: u32,
    width: u32,
    base: u32,
    apex: u32,
    outer: u32,
}

// Returns the larger of 1 and row * segments / rows, rounded half up: where a row after the first starts on an edge.
fn end_place(segments: u32, rows: u32, row: u32) -> u32 {
    let rounded = (f32(2u * row * segments + rows) + 0.5) / f32(2u * rows);
    return max(u32(rounded), 1u);
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
    return RowPlan(
        vec2<u32>(in_circle(words, base + 2u), in_circle(words, base + 1u)),
        in_circle(counts, base + 2u),
        in_circle(counts, base + 1u),
        in_circle(counts, base),
        row_count(factors),
        row_width(factors),
        base,
        in_circle(starts, base + 2u),
        counts.x + counts.y + counts.z,
    );
}

// Returns how many points lie inside the patch in rows 1 to `row`, if these have `widths` segments together.
fn points_through(widths: u32, row: u32) -> u32 {
    return widths - row;
}

// Returns the number of triangles before the strip below row `row`, which is less than the number of rows.
fn triangles_before(plan: RowPlan, row: u32) -> u32 {
    if row == 0u {
        return 0u;
    }
    let widths = row_widths(plan.n, plan.width, row);
    return widths.x + widths.y + end_place(plan.a, plan.n, row) + end_place(plan.b, plan.n, row) - 2u * row;
}

// Returns point `i` of the outline, counted from the apex.
fn outline_point(plan: RowPlan, i: u32) -> u32 {
    let at = plan.apex + i;
    return select(at, at - plan.outer, at >= plan.outer);
}

// A row: its number of segments, where it starts and ends on the outline, counted from the apex, and the number of the point
// after its first one.
struct PatternRow {
    segments: u32,
    start: u32,
    end: u32,
    inner: u32,
}

// Returns a row of a patch.
fn row_at(plan: RowPlan, row: u32) -> PatternRow {
    if row == 0u {
        return PatternRow(0u, 0u, 0u, 0u);
    }
    if row == plan.n {
        return PatternRow(plan.c, plan.a, plan.a + plan.c, outline_point(plan, plan.a) + 1u);
    }
    let widths = row_widths(plan.n, plan.width, row);
    return PatternRow(
        widths.y - widths.x,
        end_place(plan.a, plan.n, row),
        plan.outer - end_place(plan.b, plan.n, row),
        plan.outer + points_through(widths.x, row - 1u),
    );
}

// Returns the number of point `i` of a row.
fn point_of_row(plan: RowPlan, row: PatternRow, i: u32) -> u32 {
    let on_outline = outline_point(plan, select(row.end, row.start, i == 0u));
    return select(row.inner + i - 1u, on_outline, i == 0u || i == row.segments);
}

// Returns how many of the first `t` steps along two rows together are steps of the row with `own` segments, if the other one has
// `others`.
fn own_steps(own: u32, others: u32, t: u32) -> u32 {
    let all = max(own + others, 1u);
    return u32((f32(2u * t * own + all) + 0.5) / f32(2u * all));
}

// Returns triangle `t` of a patch, as point numbers, in the order of the outline.
fn row_triangle(plan: RowPlan, t: u32) -> vec3<u32> {
    // A bisection over the at most 64 strips.
    var strip = 0u;
    for (var skip = 32u; skip > 0u; skip >>= 1u) {
        if strip + skip < plan.n && triangles_before(plan, strip + skip) <= t {
            strip += skip;
        }
    }
    let upper = row_at(plan, strip);
    let lower = row_at(plan, strip + 1u);
    let in_strip = t - triangles_before(plan, strip);
    let shares_start = u32(upper.start == lower.start);
    let joint = shares_start + u32(upper.end == lower.end);
    let own = upper.segments - joint;
    let others = lower.segments - joint;

    // The triangle at a shared start stands on the upper row, the one at a shared end on the lower row.
    var at = vec2<u32>(0u, 1u);
    var is_upper = true;
    if in_strip >= shares_start {
        let step = in_strip - shares_start;
        let along_upper = own_steps(own, others, step);
        at = shares_start + vec2<u32>(along_upper, step - along_upper);
        is_upper = step < own + others && own_steps(own, others, step + 1u) > along_upper;
    }
    let p = point_of_row(plan, upper, at.x);
    let q = point_of_row(plan, lower, at.y);
    if is_upper {
        return vec3<u32>(point_of_row(plan, upper, at.x + 1u), p, q);
    }
    return vec3<u32>(p, q, point_of_row(plan, lower, at.y + 1u));
}

// Returns the number of segments of a row between the apex and the base: ceil(width * row / rows).
fn row_segments(plan: RowPlan, row: u32) -> u32 {
    return (plan.width * row + plan.n - 1u) / plan.n;
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
    var alike = (inner + 1u) * plan.n / plan.width - row;
    while rest >= alike * inner {
        rest -= alike * inner;
        row += alike;
        inner = row_segments(plan, row + 1u) - 1u;
        alike = (inner + 1u) * plan.n / plan.width - row;
    }
    let passed = rest / inner;
    return vec2<u32>(row + 1u + passed, rest - passed * inner + 1u);
}

// Returns (U, V) of point `i` of those inside the patch, in 16.16 fixed point.
fn row_point(plan: RowPlan, i: u32) -> vec2<u32> {
    let found = row_of_point(plan, i);
    let row = found.x;
    let along = row_location(domain_row(whole_word(row_segments(plan, row))), found.y);
    let start = row_location(domain_row(plan.edges.x), end_place(plan.a, plan.n, row));
    let end = row_location(domain_row(plan.edges.y), end_place(plan.b, plan.n, row));
    // The weights of the base's start and end. Neither product exceeds 32 bits, since `along` is neither 0 nor 1.
    let at_start = (start * (FIXED_ONE - along) + FIXED_HALF) >> 16u;
    let at_end = (end * along + FIXED_HALF) >> 16u;
    let at_apex = FIXED_ONE - at_start - at_end;
    let beside = select(vec2<u32>(at_apex, at_start), vec2<u32>(at_end, at_apex), plan.base == 1u);
    return select(beside, vec2<u32>(at_start, at_end), plan.base == 2u);
}

// Returns the word of a whole factor.
fn whole_word(segments: u32) -> u32 {
    return (segments << 16u) | (segments << 31u);
}

// LOD by error under rows: how many rows of which width keep a patch within a tolerance, with the fewest triangles. Twin:
// src/geometry/tessellate/least_rows.rs, which explains the search. Teams search as search_group.wgsl says.

// Whether the searches of a pass are for rows. The compiler leaves out the other one.
override SEARCHES_ROWS: u32 = 0u;

// What second derivatives say of rows beside a base.
struct Expected {
    // How many rows of which width may keep the tolerance. Neither is rounded.
    rows: f32,
    width: f32,
    // A sixth of the largest second derivatives, in px: across the rows, if there is one, and along the base.
    across: f32,
    along: f32,
    // Whether flipped diagonals follow the surface better.
    flips: bool,
}

// Returns what second derivatives say of rows beside base `base`.
fn expected_rows(seen: ptr<function, SeenPatch>, base: u32, tolerance: f32) -> Expected {
    // Domain coordinates of the corners. The base leads from the corner after the apex to the one after that.
    var corners = array<vec2<f32>, 3>(vec2<f32>(1.0, 0.0), vec2<f32>(0.0, 1.0), vec2<f32>(0.0, 0.0));
    let start = corners[(base + 1u) % 3u];
    let end = corners[(base + 2u) % 3u];
    var forms: array<SecondForms, 3>;
    var along = 1e-12;
    var across = 1e-12;
    for (var corner = 0u; corner < 3u; corner++) {
        forms[corner] = second_forms(seen, corner, end - start, (start + end) * 0.5 - corners[base]);
        along = max(along, length(forms[corner].aa));
        across = max(across, length(forms[corner].bb));
    }
    // With this many times as many segments as rows, both parts are alike.
    let ratio = sqrt(along / across);
    var error = 0.0;
    var agreeing = 0.0;
    var whole = 0.0;
    for (var corner = 0u; corner < 3u; corner++) {
        let segment = forms[corner].aa * (1.0 / (ratio * ratio));
        let mixed = forms[corner].ab * (1.0 / ratio);
        let beside = forms[corner].bb + segment * 0.25;
        error = max(error, triangle_error(length(segment), length(beside + mixed), length(beside - mixed)));
        // Second derivatives along the diagonals are the sum of these, plus and minus twice the mixed one.
        let sides = segment + forms[corner].bb;
        agreeing += dot(sides, mixed);
        whole += dot(sides, sides);
    }
    let rows = sqrt(error / tolerance);
    // Where both diagonals are alike, rounding must not choose.
    return Expected(rows, ratio * rows, across, along, agreeing < -0.01 * whole);
}

// Rows that are tried: their base, number and width, and the base's number of segments.
struct Tried {
    base: u32,
    flips: bool,
    rows: f32,
    width: f32,
    segments: f32,
    // How many segments less than rows the first and the second edge have.
    fewer: vec2<f32>,
    // 0 while they grow; then which number has just been lessened (see `with_less`).
    lessened: u32,
}

// As how many triangles a segment of an edge counts where a patch requests it.
const REQUESTED_SEGMENT: f32 = 1.75;

// Returns as how many triangles a segment of an edge counts.
fn segment_cost(sought: Sought) -> f32 {
    return select(1.0, REQUESTED_SEGMENT, sought.wanted == GOAL_REQUESTS);
}

// Returns whether the edges have their factors, so that only base and width are chosen.
fn is_given(sought: Sought) -> bool {
    return sought.wanted == GOAL_GIVEN;
}

// Returns the least number of rows beside a base.
fn least_rows(sought: Sought, base: u32) -> f32 {
    let beside = max(sought.least[(base + 1u) % 3u], sought.least[(base + 2u) % 3u]);
    return select(max(beside, sought.inside), beside, is_given(sought));
}

// Returns the least number of a base's segments with rows of some width.
fn least_segments(sought: Sought, base: u32, width: f32) -> f32 {
    return select(max(sought.least[base], width), sought.least[base], is_given(sought));
}

// Returns an expected number rounded down, or the least one.
fn expected_at_least(number: f32, least: f32) -> f32 {
    return select(least, floor(min(number, f32(MOST_ROWS))), number > least);
}

// Returns the rows with which the search beside a base starts.
fn first_rows(sought: Sought, base: u32, expected: Expected, share: f32) -> Tried {
    let least = least_rows(sought, base);
    let rows = select(expected_at_least(share * expected.rows, least), least, is_given(sought));
    let width = expected_at_least(share * expected.width, sought.inside);
    return Tried(base, expected.flips, rows, width, least_segments(sought, base, width), vec2<f32>(0.0), 0u);
}

// Returns the share of the expected rows with which a search starts: with the first base, and with the others. Second derivatives
// bound the error from above, and say nothing of it where points may slide.
fn first_shares(slides: bool) -> vec2<f32> {
    return select(vec2<f32>(0.8, 0.6), vec2<f32>(0.0), slides);
}

// Returns about how many triangles rows beside a base will have.
fn expected_cost(sought: Sought, base: u32, expected: Expected) -> f32 {
    let rows = max(expected.rows, least_rows(sought, base));
    let width = max(expected.width, sought.inside);
    let cost = rows * width + segment_cost(sought) * (rows + 0.5 * least_segments(sought, base, width));
    // NaN comes last. Where bases cost about the same, rounding must not choose: only 5 bits of the mantissa count.
    return select(3e38, bitcast<f32>(bitcast<u32>(cost) & 0xfffc0000u), cost < 3e38);
}

// Returns the factors of the edges.
fn edges_of_rows(sought: Sought, tried: Tried) -> vec3<f32> {
    var edges = vec3<f32>(tried.segments);
    edges[(tried.base + 2u) % 3u] = tried.rows - tried.fewer.x;
    edges[(tried.base + 1u) % 3u] = tried.rows - tried.fewer.y;
    return select(edges, sought.least, is_given(sought));
}

// Returns the inside factor that says which rows.
fn inside_of_rows(tried: Tried) -> f32 {
    let step = tried.base + select(1u, 4u, tried.flips);
    return f32(ROW_BASE_STEP * step) + tried.width;
}

// Returns the number that is tried after one that isn't enough: at least by one and by this part of it larger, but no number below
// the largest one passes that over.
fn next_number(number: f32, part: f32, estimate: f32) -> f32 {
    let next = max(max(number + 1.0, floor(number * (1.0 + part))), floor(estimate));
    return select(BEYOND_LAST, min(next, f32(MOST_ROWS)), number < f32(MOST_ROWS));
}

// Returns rows that may be enough, after some that have this error; more than MOST_ROWS, if none will be.
fn grown_rows(sought: Sought, tried: Tried, expected: Expected, error: f32, tolerance: f32) -> Tried {
    let root = sqrt(error / tolerance);
    let ratio = select(100.0, root, root < 100.0);
    let across = expected.across / (tried.rows * tried.rows);
    let along = expected.along / (tried.width * tried.width);
    // Beyond what second derivatives request, more segments rarely help.
    let part = select(0.125, select(0.25, 0.0, tried.width < 1.5 * expected.width), is_given(sought));
    let more_rows = next_number(tried.rows, part, 0.8 * ratio * tried.rows);
    let more_width = next_number(tried.width, part, 0.8 * ratio * tried.width);
    var grown = tried;
    if is_given(sought) {
        // There may be too few rows for any width.
        grown.width = select(more_width, BEYOND_LAST, 0.5 * across > tolerance);
    } else if ratio > 1.5 {
        // The part that is much smaller isn't what is missing.
        grown.rows = select(more_rows, tried.rows, along > 4.0 * across);
        grown.width = select(more_width, tried.width, across > 4.0 * along);
    } else if across > along {
        grown.rows = next_number(tried.rows, part, 0.0);
    } else {
        grown.width = next_number(tried.width, part, 0.0);
    }
    grown.segments = least_segments(sought, tried.base, grown.width);
    return grown;
}

// How many kinds of lessening there are.
const LESSENINGS: u32 = 8u;

// Returns rows with less than others: 1 row less; rows narrower by 1 segment (2) or by 2 (4), and the base with them if it has as
// many; the same without the base (3 and 5); or 1 segment less of the base (6), of the first edge (7) or of the second one (8).
fn with_less(sought: Sought, enough: Tried, kind: u32) -> Tried {
    var less = enough;
    less.rows -= f32(kind == 1u);
    less.width -= f32(kind == 2u || kind == 3u) + 2.0 * f32(kind == 4u || kind == 5u);
    let follows = (kind == 2u || kind == 4u) && enough.segments == enough.width;
    less.segments = select(enough.segments - f32(kind == 6u), least_segments(sought, enough.base, less.width), follows);
    less.fewer += vec2<f32>(f32(kind == 7u), f32(kind == 8u));
    less.lessened = kind;
    return less;
}

// Returns whether there are such rows, and whether they differ from others that are tried.
fn is_possible(sought: Sought, enough: Tried, less: Tried) -> bool {
    let kind = less.lessened;
    if is_given(sought) {
        // The edges have their factors.
        return (kind == 2u || kind == 4u) && less.width >= sought.inside;
    }
    // Where the base doesn't follow, kinds 3 and 5 are the same as 2 and 4.
    let follows = enough.segments == enough.width && enough.width > sought.least[less.base];
    return less.rows >= least_rows(sought, less.base)
        && less.width >= sought.inside
        && less.segments >= sought.least[less.base]
        && less.rows - less.fewer.x >= sought.least[(less.base + 2u) % 3u]
        && less.rows - less.fewer.y >= sought.least[(less.base + 1u) % 3u]
        && min(less.fewer.x, less.fewer.y) == 0.0
        && (follows || (kind != 3u && kind != 5u));
}

// Returns rows with less than some that are enough, by the first kind of lessening after `lessened` that there is; with a `lessened`
// above LESSENINGS, if there is none.
fn lesser_rows(sought: Sought, enough: Tried, lessened: u32) -> Tried {
    // Beside given edges there are no others after the fourth.
    let last = select(LESSENINGS, 4u, is_given(sought));
    for (var kind = lessened + 1u; kind <= last; kind++) {
        let less = with_less(sought, enough, kind);
        if is_possible(sought, enough, less) {
            return less;
        }
    }
    var none = enough;
    none.lessened = LESSENINGS + 1u;
    return none;
}

// Returns the kind of lessening after which the next one is looked for, once one has given rows that are enough: the same again, or
// all of them where the numbers of two rows fit otherwise.
fn lessened_before(kind: u32) -> u32 {
    return select(kind - 1u, 0u, kind == 0u || (kind >= 3u && kind < 6u));
}

// Returns the number of triangles of a pattern, if a segment of an edge counts as `segment` triangles.
fn cost_of_rows(factors: PatchFactors, segment: f32) -> f32 {
    let outer = outer_count(factors);
    return 2.0 * f32(point_count(factors) - outer) + segment * f32(outer);
}

// Returns the bases from the least expected cost to the largest.
fn bases_by_cost(costs: vec3<f32>) -> vec3<u32> {
    let after_first = select(2u, 1u, costs.y <= costs.z);
    let first = select(after_first, 0u, costs.x <= costs.y && costs.x <= costs.z);
    let next = (first + 1u) % 3u;
    let after = (first + 2u) % 3u;
    return select(vec3<u32>(first, after, next), vec3<u32>(first, next, after), costs[next] <= costs[after]);
}

// Returns the rows with which a patch is within the tolerance, and has the fewest triangles of those that are tried. If no rows
// are enough, it returns the least factors and BEYOND_LAST. Not for patches of which one triangle suffices.
fn fewest_rows(seen: ptr<function, SeenPatch>, tolerance: f32, sought: Sought) -> Chosen {
    let within = BOUND_SHARE * tolerance;
    let shares = first_shares(may_slide(seen, within));
    var best = Chosen(sought.least, BEYOND_LAST, 0.0);
    var all_expected: array<Expected, 3>;
    var costs: vec3<f32>;
    for (var base = 0u; base < 3u; base++) {
        all_expected[base] = expected_rows(seen, base, within);
        costs[base] = expected_cost(sought, base, all_expected[base]);
    }
    let order = bases_by_cost(costs);
    var fewest = 3.4e38;
    var at = 0u;
    var tried = first_rows(sought, order.x, all_expected[order.x], shares.x);
    var enough = tried;
    var goes_on = max(max(max(sought.least.x, sought.least.y), sought.least.z), sought.inside) <= f32(MOST_ROWS);
    while any_team(goes_on) {
        let edges = edges_of_rows(sought, tried);
        let factors = process(PARTITIONING_ROWS, edges, inside_of_rows(tried));
        let cost = cost_of_rows(factors, segment_cost(sought));
        let is_worth = goes_on && max(tried.rows, tried.width) <= f32(MOST_ROWS) && cost < fewest;
        let errors = part_errors(seen, within, factors, vec4<bool>(is_worth));
        if !goes_on {
            continue;
        }
        let error = max(max(errors.x, errors.y), max(errors.z, errors.w));
        let lessened = tried.lessened;
        if is_worth && error <= within {
            fewest = cost;
            enough = tried;
            best = Chosen(edges, inside_of_rows(tried), 0.0);
            tried = lesser_rows(sought, enough, lessened_before(lessened));
        } else if lessened > 0u {
            tried = lesser_rows(sought, enough, lessened);
        } else {
            tried = grown_rows(sought, tried, all_expected[tried.base], error, within);
        }
        if (!is_worth && lessened == 0u) || tried.lessened > LESSENINGS {
            at += 1u;
            // The other diagonals may be the only ones that are enough.
            goes_on = at < 3u || (at < 6u && best.inside == BEYOND_LAST);
            let base = order[at % 3u];
            tried = first_rows(sought, base, all_expected[base], shares.y);
            tried.flips = tried.flips != (at >= 3u);
        }
    }
    return best;
}

// Returns the number of points inside a patch.
fn points_inside(edges: vec3<f32>, inside: f32) -> f32 {
    let factors = process(PARTITIONING_ROWS, edges, inside);
    return f32(point_count(factors) - outer_count(factors));
}

// Returns whether a patch requests factors for its edges again: beside what other patches requested, it has many more points inside than with
// what it has chosen.
fn rows_request_again(chosen: f32, points: f32) -> bool {
    return points > 1.1 * chosen + 2.0;
}

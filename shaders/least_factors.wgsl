// LOD by error: the factors with the fewest triangles whose pattern stays within a tolerance. Twin:
// src/geometry/tessellate/least_factors.rs.
// With: connectivity

// The part of the tolerance that bounds may use up. The rest is for rounding.
const BOUND_SHARE: f32 = 0.999;

// A factor that is requested if none is enough.
const BEYOND_LAST: f32 = 127.5;

// Returns the least number of segments, `least` or more, that a partitioning has without fractions: any whole number, a
// power of two, or an odd or even number.
fn whole_segments(partitioning: u32, least: f32) -> f32 {
    if partitioning != PARTITIONING_POW2 && partitioning != PARTITIONING_FRACTIONAL_ODD
        && partitioning != PARTITIONING_FRACTIONAL_EVEN {
        return ceil(least);
    }
    if partitioning == PARTITIONING_POW2 {
        return round_pow2(least);
    }
    if partitioning == PARTITIONING_FRACTIONAL_ODD {
        return 2.0 * ceil(0.5 * (least - 1.0)) + 1.0;
    }
    return 2.0 * ceil(0.5 * least);
}

// Returns the least factor of a partitioning, `least` or more; BEYOND_LAST if it has none.
fn factor_from(partitioning: u32, least: f32) -> f32 {
    if least <= last_factor(partitioning) {
        return whole_segments(partitioning, least);
    }
    return BEYOND_LAST;
}

// Returns the least factor above `factor` that may be enough if `factor` segments have this error, which falls with the
// square of their number. Beyond the last factor it returns BEYOND_LAST.
fn next_factor(partitioning: u32, factor: f32, error: f32, tolerance: f32) -> f32 {
    let ratio = sqrt(error / tolerance);
    // The estimate is lowered, so that it passes over no factor that is enough. NaN counts as infinite.
    var estimate = BEYOND_LAST;
    if ratio < 100.0 {
        estimate = floor(0.8 * ratio * factor);
    }
    return factor_from(partitioning, max(estimate, factor + 1.0));
}

// Returns a point of a cubic curve.
fn curve_point(a: vec3<f32>, ab: vec3<f32>, ba: vec3<f32>, b: vec3<f32>, t: f32) -> vec3<f32> {
    let s = 1.0 - t;
    return a * (s * s * s) + ab * (3.0 * s * s * t) + ba * (3.0 * s * t * t) + b * (t * t * t);
}

// Returns the largest distance in px between a curve and its `factor` segments, at three points of each that are in view. The
// control points are in clip space, as `clip_point` returns them.
fn sampled_edge_error(
    half_viewport: vec2<f32>,
    near: f32,
    a: vec3<f32>,
    ab: vec3<f32>,
    ba: vec3<f32>,
    b: vec3<f32>,
    factor: f32,
) -> f32 {
    var worst = 0.0;
    var start = a;
    for (var i = 0u; i < u32(factor); i++) {
        let end = curve_point(a, ab, ba, b, (f32(i) + 1.0) / factor);
        for (var k = 1u; k < 4u; k++) {
            let share = 0.25 * f32(k);
            let flat_point = start + (end - start) * share;
            let point = curve_point(a, ab, ba, b, (f32(i) + share) / factor);
            let nearest = min(flat_point.z, point.z);
            let place = point.xy / point.z;
            let outside = abs(place) - half_viewport;
            if nearest > 0.0 && nearest >= near && max(outside.x, outside.y) <= 0.0 {
                worst = max(worst, distance(place, flat_point.xy / flat_point.z));
            }
        }
        start = end;
    }
    return worst;
}

// Returns the least number of segments that keeps a curve within `tolerance` px, as far as samples tell; BEYOND_LAST if none does.
// Patches start from it when they look for factors, and take care of the bound themselves.
fn least_edge_factor(
    view: LodView,
    tolerance: f32,
    partitioning: u32,
    a: vec3<f32>,
    ab: vec3<f32>,
    ba: vec3<f32>,
    b: vec3<f32>,
) -> f32 {
    let deepest = deeper(view, deeper(view, deeper(view, deeper(view, 0.0, a), ab), ba), b);
    let scale = depth_scale(deepest);
    let start = clip_point(view, scale, a);
    let after_start = clip_point(view, scale, ab);
    let before_end = clip_point(view, scale, ba);
    let end = clip_point(view, scale, b);
    let near = near_depth(view) * scale;
    var factor = whole_segments(partitioning, 1.0);
    while factor <= last_factor(partitioning) {
        let error = sampled_edge_error(view.half_viewport, near, start, after_start, before_end, end, factor);
        if error <= tolerance {
            return factor;
        }
        factor = next_factor(partitioning, factor, error, tolerance);
    }
    return BEYOND_LAST;
}

// Returns the error of triangle `t` of a pattern, in px; a large number in place of NaN.
fn triangle_error_at(seen: ptr<function, SeenPatch>, tolerance: f32, plan: DomainPlan, t: u32) -> f32 {
    // As weights of corners 0 and 1.
    let at = domain_triangle_places(plan, t);
    let scale = 1.0 / f32(FIXED_ONE);
    let error = piece_error(seen, tolerance, vec2<f32>(at[0]) * scale, vec2<f32>(at[1]) * scale, vec2<f32>(at[2]) * scale);
    return select(3.4e38, error, error < 3.4e38);
}

// Returns whether one triangle is within the tolerance in place of the patch, with these least factors of its edges and of its
// inside.
fn single_suffices(
    seen: ptr<function, SeenPatch>,
    tolerance: f32,
    partitioning: u32,
    edges: vec3<f32>,
    inside: f32,
) -> bool {
    let factors = process(partitioning, vec3<f32>(1.0), 1.0);
    let whole = max(max(max(edges.x, edges.y), edges.z), inside) <= 1.0;
    if !(whole && patch_is_minimal(factors)) {
        return false;
    }
    return triangle_error_at(seen, tolerance, domain_plan(factors), 0u) <= tolerance;
}

// Returns the numbers of triangles of a pattern's parts, which follow each other: the rows along its edges U == 0, V == 0 and
// W == 0, and its inner triangles, which lie along no edge. Of rows all are counted as inner ones.
fn part_counts(factors: PatchFactors) -> vec4<u32> {
    if patch_has_rows(factors) {
        return vec4<u32>(0u, 0u, 0u, triangle_count(factors));
    }
    let outside = vec3<u32>(segments(factors.outside.x), segments(factors.outside.y), segments(factors.outside.z));
    let rows = outside + inside_segments(factors.inside) - 2u;
    return vec4<u32>(rows, triangle_count(factors) - rows.x - rows.y - rows.z);
}

// A prime beyond the number of turns in which a pattern's triangles are looked at: its multiples are spread over them.
const SPREAD: u32 = 2027u;

// Returns the largest error, in px, of each wanted part of a pattern, and 0 for the others. TOGETHER triangles are looked at in
// one turn, by one invocation each (see search_group.wgsl). They are spread over all parts. That ends early with the first turn
// after which no part is within the tolerance.
fn part_errors(
    seen: ptr<function, SeenPatch>,
    tolerance: f32,
    factors: PatchFactors,
    wanted: vec4<bool>,
) -> vec4<f32> {
    let plan = domain_plan(factors);
    let all_counts = part_counts(factors);
    let counts = select(vec4<u32>(0u), all_counts, wanted);
    let ends = vec3<u32>(counts.x, counts.x + counts.y, counts.x + counts.y + counts.z);
    let count = ends.z + counts.w;
    // How many triangles before each part aren't wanted.
    let rest = all_counts - counts;
    let before = vec4<u32>(0u, rest.x, rest.x + rest.y, rest.x + rest.y + rest.z);
    let turns = (count + TOGETHER - 1u) / TOGETHER;
    var worst = vec4<f32>(0.0);
    var goes_on = turns > 0u;
    var first = 0u;
    while any_team(goes_on) {
        let turn = first + lane % team_size / TOGETHER;
        let i = lane % TOGETHER * turns + turn * SPREAD % max(turns, 1u);
        let part = select(0u, 1u, i >= ends.x) + select(0u, 1u, i >= ends.y) + select(0u, 1u, i >= ends.z);
        var own = 0.0;
        if goes_on && turn < turns && i < count && worst[part] <= tolerance {
            own = triangle_error_at(seen, tolerance, plan, i + before[part]);
        }
        worst = largest_of_team(part, own, worst, wanted, tolerance);
        first += team_size / TOGETHER;
        goes_on = first < turns && any(wanted & (worst <= vec4<f32>(tolerance)));
    }
    // A software driver may have ended the loop. What hasn't been looked at may be beyond the tolerance.
    return select(worst, vec4<f32>(3e38), goes_on);
}

// How much larger a factor of an edge is tried than the least one and the inside factor: with more, triangles are long where
// the points of edge and ring don't match.
const ROW_REACH: f32 = 6.0;

// Returns the factor of an edge that is tried after `factor`, whose row has this error beside `inside` segments; BEYOND_LAST
// if none is enough up to the larger of `least` and `inside`, and ROW_REACH. Where points may slide, there is no such end.
fn next_row_factor(
    partitioning: u32,
    slides: bool,
    least: f32,
    inside: f32,
    factor: f32,
    error: f32,
    tolerance: f32,
) -> f32 {
    let estimate = next_factor(partitioning, factor, error, tolerance);
    if slides {
        return estimate;
    }
    // Errors of rows don't fall steadily: where the points of edge and ring don't match, triangles are up to twice as long. Where
    // points may slide, that doesn't matter. More segments than the ring has make no triangle shorter.
    let last = factor_from(partitioning, max(least, inside) + ROW_REACH);
    let next = factor_from(partitioning, factor + 1.0);
    return select(BEYOND_LAST, next, next <= last && 0.5 * estimate <= max(inside, factor));
}

// Returns the number of triangles of a pattern, if a segment of an edge counts as `segment` triangles.
fn pattern_cost(edges: vec3<f32>, inside: f32, segment: f32) -> f32 {
    let rings = inside - 2.0;
    return 3.0 * rings + 1.5 * rings * rings + segment * (edges.x + edges.y + edges.z);
}

// The factors that a patch has chosen.
struct Chosen {
    // Of the edges U == 0, V == 0 and W == 0, and inside.
    edges: vec3<f32>,
    inside: f32,
    // The least inside factor above 2 with which the inner triangles are within the tolerance; 0 if it isn't known.
    inner: f32,
}

// Which factors of a patch's edges are looked for: those that the patch requests for its edges, those that it would have if no
// neighbour requested anything, or what its edges have, beside which only the inside is looked for.
const GOAL_REQUESTS: u32 = 0u;
const GOAL_MINIMUM: u32 = 1u;
const GOAL_GIVEN: u32 = 2u;

// What a patch looks for.
struct Sought {
    // The least factors that the edges U == 0, V == 0 and W == 0 may get, or those that they have.
    least: vec3<f32>,
    // The least inside factor; of rows the least number of rows and of segments of a row.
    inside: f32,
    // As in `Chosen`.
    inner: f32,
    wanted: u32,
}

// Returns the inside factor that a patch gets without a search, 0 if there is none: if one triangle is within the tolerance, or if
// more segments are sought than there are.
fn without_search(seen: ptr<function, SeenPatch>, within: f32, partitioning: u32, sought: Sought) -> f32 {
    if single_suffices(seen, within, partitioning, sought.least, sought.inside) {
        return select(1.0, f32(ROW_BASE_STEP + 1u), partitioning == PARTITIONING_ROWS);
    }
    let most = max(max(max(sought.least.x, sought.least.y), sought.least.z), sought.inside);
    return select(0.0, BEYOND_LAST, most > last_factor(partitioning));
}

// A step of a search: an inside factor; whether its inner triangles are looked at, or its rows; and whether the other ones are
// known to be within the tolerance.
struct Step {
    inside: f32,
    is_inner: bool,
    is_last: bool,
}

// Returns the first step. `least_inside` is the least inside factor, and `inner` is as in `Chosen`.
fn first_step(partitioning: u32, least_inside: f32, inner: f32) -> Step {
    let inside = factor_from(partitioning, max(least_inside, 2.0));
    // Two segments leave no inner triangles.
    if inside == 2.0 || inner == 0.0 {
        return Step(inside, inside > 2.0, inside == 2.0);
    }
    return Step(inner, false, true);
}

// Returns the step after an inside factor that isn't enough. `error` is that of its inner triangles, 0 if these are within the
// tolerance.
fn next_step(partitioning: u32, inside: f32, inner: f32, error: f32, tolerance: f32) -> Step {
    if inside == 2.0 && inner > 0.0 {
        return Step(inner, false, true);
    }
    var next = factor_from(partitioning, inside + 1.0);
    if error > tolerance {
        next = next_factor(partitioning, inside, error, tolerance);
    }
    // Beyond the least one, inner triangles are rarely what is missing, and there are more of them.
    return Step(next, inner == 0.0, false);
}

// Returns the factors with which a patch is within the tolerance and has the fewest triangles. If no factors are enough, it
// returns the least ones and BEYOND_LAST. Not for patches of which one triangle suffices, or with a least factor above the last one.
fn fewest_triangles(seen: ptr<function, SeenPatch>, tolerance: f32, partitioning: u32, sought: Sought) -> Chosen {
    let within = BOUND_SHARE * tolerance;
    let slides = may_slide(seen, within);
    let segment = select(1.0, 2.0, sought.wanted == GOAL_REQUESTS);
    var best = Chosen(sought.least, BEYOND_LAST, sought.inner);
    var fewest = 3.4e38;
    // Written so that each function is called in one place only: drivers compile a copy for each call.
    var step = first_step(partitioning, sought.inside, sought.inner);
    var edges = sought.least;
    var rows = vec3<bool>(true);
    var goes_on = step.inside <= last_factor(partitioning);
    while any_team(goes_on) {
        let inside = step.inside;
        let looked_at = vec4<bool>(rows & vec3<bool>(!step.is_inner), step.is_inner) & vec4<bool>(goes_on);
        let errors = part_errors(seen, within, process(partitioning, edges, inside), looked_at);
        if !goes_on {
            continue;
        }
        let fails = errors > vec4<f32>(within);
        if sought.wanted == GOAL_GIVEN {
            edges = select(edges, vec3<f32>(BEYOND_LAST), fails.xyz);
        } else {
            for (var k = 0u; k < 3u; k++) {
                if fails[k] {
                    edges[k] = next_row_factor(partitioning, slides, sought.least[k], inside, edges[k], errors[k], within);
                }
            }
        }
        let cost = pattern_cost(edges, inside, segment);
        var is_over = fails.w || cost >= fewest || max(max(edges.x, edges.y), edges.z) == BEYOND_LAST;
        rows = fails.xyz;
        if !any(fails) {
            best.inner = select(best.inner, inside, step.is_inner && best.inner == 0.0);
            if step.is_last && !is_over {
                fewest = cost;
                best.edges = edges;
                best.inside = inside;
            }
            is_over = is_over || step.is_last;
            rows = vec3<bool>(true);
            step = Step(inside, !step.is_inner, true);
        }
        if is_over {
            step = next_step(partitioning, inside, best.inner, errors.w, within);
            edges = sought.least;
            rows = vec3<bool>(true);
            goes_on = step.inside <= last_factor(partitioning) && pattern_cost(sought.least, step.inside, segment) < fewest;
        }
    }
    return best;
}

// Returns whether a patch requests factors for its edges again: beside what other patches requested, its inside factor is much larger than
// the one that it has chosen.
fn requests_again(chosen: f32, inside: f32) -> bool {
    return inside == BEYOND_LAST || inside > 1.1 * chosen + 1.0;
}

// Returns whether a patch is within `tolerance` px of its surface if its edges and its inside all have one factor, from 2 on.
fn uniform_suffices(
    seen: ptr<function, SeenPatch>,
    tolerance: f32,
    partitioning: u32,
    factor: f32,
) -> bool {
    let within = BOUND_SHARE * tolerance;
    let factors = process(partitioning, vec3<f32>(factor), factor);
    return all(part_errors(seen, within, factors, vec4<bool>(true)) <= vec4<f32>(within));
}

// LOD by error: the factors with the fewest triangles whose pattern stays within a tolerance. Twin:
// src/tessellate/least_factors.rs.

// The part of the tolerance that bounds may use up. The rest is for rounding.
const BOUND_SHARE: f32 = 0.999;

// A factor that is asked for if none is enough.
const BEYOND_LAST: f32 = 64.5;

// Returns the least number of segments, `least` or more, that a partitioning has without fractions: any whole number, a
// power of two, or an odd or even number.
fn whole_segments(partitioning: u32, least: f32) -> f32 {
    if partitioning == PARTITIONING_INTEGER || partitioning == PARTITIONING_SUBTRIANGULATION {
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

// Returns the largest factor of a partitioning.
fn last_factor(partitioning: u32) -> f32 {
    return select(64.0, 63.0, partitioning == PARTITIONING_FRACTIONAL_ODD);
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
    while factor <= 64.0 {
        let error = sampled_edge_error(view.half_viewport, near, start, after_start, before_end, end, factor);
        if error <= tolerance {
            return factor;
        }
        factor = next_factor(partitioning, factor, error, tolerance);
    }
    return BEYOND_LAST;
}

// Returns a place of a pattern's domain as weights of corners 0 and 1.
fn domain_place(plan: DomainPlan, i: u32) -> vec2<f32> {
    return vec2<f32>(domain_point(plan, i)) / f32(FIXED_ONE);
}

// Returns the error of triangle `t` of a pattern, in px; a large number in place of NaN.
fn triangle_error_at(seen: ptr<function, SeenPatch>, tolerance: f32, plan: DomainPlan, t: u32) -> f32 {
    let at = domain_triangle(plan, t);
    let p = domain_place(plan, at.x);
    let error = piece_error(seen, tolerance, p, domain_place(plan, at.y), domain_place(plan, at.z));
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

// Returns the largest error, in px, of the triangles `first` to `end` of a pattern, each computed by one invocation of the
// workgroup (see search_group.wgsl); or of the first TOGETHER with one that isn't within the tolerance. Those are spread over
// all.
fn triangles_error(
    seen: ptr<function, SeenPatch>,
    tolerance: f32,
    factors: PatchFactors,
    first: u32,
    end: u32,
) -> f32 {
    let plan = domain_plan(factors);
    var worst = 0.0;
    let turns = (end - first + TOGETHER - 1u) / TOGETHER;
    for (var turn = 0u; turn < turns && worst <= tolerance; turn++) {
        let t = first + lane * turns + turn;
        var own = 0.0;
        if t < end {
            own = triangle_error_at(seen, tolerance, plan, t);
        }
        worst = max(worst, largest_of_group(own));
    }
    return worst;
}

// How much larger a factor of an edge is tried than the least one and the inside factor: with more, triangles are long where
// the points of edge and ring don't match.
const ROW_REACH: f32 = 6.0;

// Returns the error of the row along edge `k` (0 to 2 for U == 0, V == 0 and W == 0).
fn row_error(seen: ptr<function, SeenPatch>, tolerance: f32, factors: PatchFactors, k: u32) -> f32 {
    let inner = inside_segments(factors.inside) - 2u;
    let u = segments(factors.outside.x);
    let v = segments(factors.outside.y);
    let w = segments(factors.outside.z);
    let before = select(select(0u, u, k == 1u), u + v, k == 2u);
    let first = before + k * inner;
    return triangles_error(seen, tolerance, factors, first, first + select(select(u, v, k == 1u), w, k == 2u) + inner);
}

// Returns the error of the triangles that lie along no edge.
fn inner_error(seen: ptr<function, SeenPatch>, tolerance: f32, factors: PatchFactors) -> f32 {
    let rows = outer_count(factors) + 3u * (inside_segments(factors.inside) - 2u);
    return triangles_error(seen, tolerance, factors, rows, triangle_count(factors));
}

// Returns the least inside factor, `least` or more, with which the triangles along no edge are within the tolerance;
// BEYOND_LAST if none is.
fn least_inner_factor(seen: ptr<function, SeenPatch>, tolerance: f32, partitioning: u32, least: f32) -> f32 {
    var inside = factor_from(partitioning, max(least, 2.0));
    while inside <= last_factor(partitioning) {
        let error = inner_error(seen, tolerance, process(partitioning, vec3<f32>(2.0), inside));
        if error <= tolerance {
            return inside;
        }
        inside = next_factor(partitioning, inside, error, tolerance);
    }
    return BEYOND_LAST;
}

// Returns the least factor of edge `k`, `least` or more, whose row is within the tolerance beside `inside` segments;
// BEYOND_LAST if that needs more than the larger of `least` and `inside`, and ROW_REACH. Where points may slide it tries all.
fn least_row_factor(
    seen: ptr<function, SeenPatch>,
    tolerance: f32,
    partitioning: u32,
    k: u32,
    least: f32,
    inside: f32,
) -> f32 {
    let slides = may_slide(seen, tolerance);
    let last = select(max(least, inside) + ROW_REACH, BEYOND_LAST, slides);
    let most = min(factor_from(partitioning, last), last_factor(partitioning));
    var factor = least;
    while factor <= most {
        var edges = vec3<f32>(2.0);
        edges[k] = factor;
        let error = row_error(seen, tolerance, process(partitioning, edges, inside), k);
        if error <= tolerance {
            return factor;
        }
        // Errors of rows don't fall steadily: triangles are longer where the points of edge and ring don't match. Where points
        // may slide, that doesn't matter.
        if slides {
            factor = next_factor(partitioning, factor, error, tolerance);
        } else {
            factor = factor_from(partitioning, factor + 1.0);
        }
    }
    return BEYOND_LAST;
}

// Returns the factors of the edges U == 0, V == 0 and W == 0 and inside with which a patch is within the tolerance and has the
// fewest triangles, if a segment of an edge counts as `segment` triangles. `least` are the least factors that the edges may
// get, and `least_inside` is the least inside factor. If no factors are enough, it returns `least` and BEYOND_LAST. Not for
// patches of which one triangle suffices, or with a least factor above 64.
fn fewest_triangles(
    seen: ptr<function, SeenPatch>,
    tolerance: f32,
    partitioning: u32,
    least: vec3<f32>,
    least_inside: f32,
    segment: f32,
) -> vec4<f32> {
    let within = BOUND_SHARE * tolerance;
    var best = vec4<f32>(least, BEYOND_LAST);
    var fewest = 3.4e38;
    // Written so that each function is called in one place only: drivers compile a copy for each call.
    var inside = least_inside;
    var goes_on = true;
    while goes_on {
        inside = least_inner_factor(seen, within, partitioning, inside);
        let rings = inside - 2.0;
        var cost = 3.0 * rings + 1.5 * rings * rings + segment * (least.x + least.y + least.z);
        goes_on = inside <= 64.0 && cost < fewest;
        var asked = least;
        for (var k = 0u; k < 3u; k++) {
            if goes_on && cost < fewest {
                asked[k] = least_row_factor(seen, within, partitioning, k, least[k], inside);
                cost += select(segment * (asked[k] - least[k]), 3.4e38, asked[k] > 64.0);
            }
        }
        if goes_on && cost < fewest {
            fewest = cost;
            best = vec4<f32>(asked, inside);
        }
        inside += 1.0;
    }
    return best;
}

// Returns the factors that a patch asks for, of the edges U == 0, V == 0 and W == 0, and the inside factor that it would take
// beside these. `least` are the least that the edges may get, and `least_inside` is the least inside factor. If no factors are
// enough, it returns `least` and BEYOND_LAST. Not for patches of which one triangle suffices, or with a least factor above 64.
fn asked_factors(
    seen: ptr<function, SeenPatch>,
    tolerance: f32,
    partitioning: u32,
    least: vec3<f32>,
    least_inside: f32,
) -> vec4<f32> {
    // Every segment of an edge is a triangle's side in this patch and in its neighbour.
    return fewest_triangles(seen, tolerance, partitioning, least, least_inside, 2.0);
}

// Returns whether a patch asks its edges again: beside what other patches asked for, its inside factor is much larger than
// the one that it has chosen.
fn asks_again(chosen: f32, inside: f32) -> bool {
    return inside > 64.0 || inside > 1.1 * chosen + 1.0;
}

// Returns the factors, of the edges U == 0, V == 0 and W == 0 and inside, with which a patch has the fewest triangles if no
// neighbour asks for anything. See fewest_triangles.
fn own_least_factors(
    seen: ptr<function, SeenPatch>,
    tolerance: f32,
    partitioning: u32,
    least: vec3<f32>,
    least_inside: f32,
) -> vec4<f32> {
    return fewest_triangles(seen, tolerance, partitioning, least, least_inside, 1.0);
}

// Returns the least inside factor, `least` or more, that keeps a patch within `tolerance` px of its surface beside these
// factors of the edges U == 0, V == 0 and W == 0; BEYOND_LAST if none does. Not for patches of which one triangle suffices, or
// with a factor above 64.
fn least_inside_factor(
    seen: ptr<function, SeenPatch>,
    tolerance: f32,
    partitioning: u32,
    edges: vec3<f32>,
    least: f32,
) -> f32 {
    let within = BOUND_SHARE * tolerance;
    var inside = least;
    var result = 0.0;
    while result == 0.0 {
        inside = least_inner_factor(seen, within, partitioning, inside);
        let factors = process(partitioning, edges, inside);
        var k = 0u;
        while k < 3u && inside <= 64.0 && row_error(seen, within, factors, k) <= within {
            k++;
        }
        if k == 3u || inside > 64.0 {
            result = inside;
        }
        inside += 1.0;
    }
    return result;
}

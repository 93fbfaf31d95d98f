// How far flat triangles are from displaced surfaces because of the heights, for LOD by error. Twin:
// src/geometry/tessellate/relief.rs, which explains the bounds.

// For how many lengths of sides there are bounds, each half as long as the one before.
const RELIEF_STEPS: u32 = 5u;

// The heights over a patch, as it is seen.
struct SeenRelief {
    relief: PatchRelief,
    // How far the corners move from black to white, in clip space: x and y in px times depth, and the depth; along the way between them it may be more by
    // 1 / shortest.
    directions: array<vec3<f32>, 3>,
    // The largest distance between two of the unit directions of the corners, and a bound on the length of weighted means of these.
    turning: f32,
    shortest: f32,
    // The distance from black to white as a part of the reach of displacement.
    part: f32,
}

// Returns the largest distance between two of three unit directions, and the least length of their weighted means: 0 or less, if
// there may be any.
fn turning_of(a: vec3<f32>, b: vec3<f32>, c: vec3<f32>) -> vec2<f32> {
    let turning = max(max(distance(a, b), distance(b, c)), distance(c, a));
    return vec2<f32>(turning, sqrt(max(1.0 - turning * turning / 3.0, 0.0)));
}

// What rounding and packing may add to a direction, as a part of its length.
const DIRECTION_ROUNDING: f32 = 1.0002;

// Returns a bound on how far heights let the triangle between three places of the domain be from the displaced surface, in px: seen
// within `spread` px of `middle`, from `depth`. Large if none holds. Displacement moves a point by `anywhere` px times depth at most.
fn heights_error(
    seen: SeenRelief,
    anywhere: f32,
    at: array<vec2<f32>, 3>,
    middle: vec2<f32>,
    spread: f32,
    depth: f32,
) -> f32 {
    let relief = seen.relief;
    if relief.longest < 0.0 {
        return 0.0;
    }
    var square = 0.0;
    var share = 0.0;
    for (var k = 0u; k < 3u; k++) {
        let side = at[(k + 1u) % 3u] - at[k];
        let form = relief.form;
        square = max(square, side.x * side.x * form.x + 2.0 * side.x * side.y * form.y + side.y * side.y * form.z);
        share = max(share, max(max(abs(side.x), abs(side.y)), abs(side.x + side.y)));
    }
    var loss = relief.losses[0];
    var longest = relief.longest;
    for (var step = 1u; step < RELIEF_STEPS; step++) {
        longest *= 0.5;
        if square <= longest * longest {
            loss = relief.losses[step];
        }
    }
    let lost = min(loss.x + loss.y * square, relief.range);
    let rise = min(relief.range, relief.slope * sqrt(square));
    // How far a direction moves a point from black to white, as it is seen.
    var along = 0.0;
    for (var i = 0u; i < 3u; i++) {
        let direction = seen.directions[i];
        along = max(along, length(direction.xy - middle * direction.z) + spread * abs(direction.z));
    }
    let turned = share * seen.turning * DIRECTION_ROUNDING / seen.shortest;
    let turns = 0.19245 * turned * turned + turned * seen.part * rise;
    let error = DIRECTION_ROUNDING * (along * lost / seen.shortest + anywhere * turns) / depth;
    // NaN counts as infinite.
    return select(3.4e38, error, error < 3.4e38);
}

// Returns the longest side, in px of level 0, of triangles over which heights are at most `lost` from linear ones.
fn longest_within(relief: PatchRelief, lost: f32) -> f32 {
    if relief.range <= lost {
        return 3.4e38;
    }
    var found = 0.0;
    var longest = relief.longest;
    for (var step = 0u; step < RELIEF_STEPS; step++) {
        let loss = relief.losses[step];
        var side = 0.0;
        if loss.x <= lost {
            side = sqrt((lost - loss.x) / max(loss.y, 1e-30));
        }
        found = max(found, min(side, longest));
        longest *= 0.5;
    }
    return found;
}

// The part of the segments that heights need by their bounds that is requested before triangles are looked at.
const NEEDED_SHARE: f32 = 0.98;

// Returns into how many segments sides 0, 1 and 2 must be cut at least so that heights are within a tolerance, and the inside; of rows as
// many as the shortest side. Not rounded, and 1 or more. A search starts with these.
//
// The corners are in clip space, as SeenRelief is; displacement moves them by `deep` at most, and `near` is the near plane.
fn least_for_heights(
    seen: SeenRelief,
    corners: array<vec3<f32>, 3>,
    deep: f32,
    near: f32,
    tolerance: f32,
    has_rows: bool,
) -> vec4<f32> {
    let relief = seen.relief;
    // How far heights may be from linear ones at each corner.
    var lost = vec3<f32>(3.4e38);
    for (var i = 0u; i < 3u; i++) {
        let corner = corners[i];
        let direction = seen.directions[i];
        let along = length(direction.xy - corner.xy / corner.z * direction.z);
        if corner.z > near && corner.z > 0.0 && along > 0.0 {
            lost[i] = tolerance * (corner.z + deep) / along;
        }
    }
    let form = relief.form;
    let squares = vec3<f32>(form.x - 2.0 * form.y + form.z, form.z, form.x);
    var least = vec4<f32>(1.0);
    if relief.longest < 0.0 {
        return least;
    }
    for (var k = 0u; k < 3u; k++) {
        let within = longest_within(relief, min(lost[k], lost[(k + 1u) % 3u]));
        least[k] = max(NEEDED_SHARE * sqrt(max(squares[k], 0.0)) / max(within, 1e-30), 1.0);
    }
    let within = longest_within(relief, max(max(lost.x, lost.y), lost.z));
    let shortest = min(min(squares.x, squares.y), squares.z);
    let longest = max(max(squares.x, squares.y), squares.z);
    least.w = max(NEEDED_SHARE * sqrt(max(select(longest, shortest, has_rows), 0.0)) / max(within, 1e-30), 1.0);
    return least;
}

// LOD by error where a surface is displaced: how many segments show the heights along an edge. Twin:
// src/geometry/tessellate/displacement_factor.rs, which explains the bounds.

// Bounds on the depth and the screen position of a set of control points, from which the size of differences on screen
// is bounded.
struct ScreenBounds {
    nearest: f32,
    least: vec2<f32>,
    greatest: vec2<f32>,
}

// Returns the bounds of no points, to be widened.
fn no_bounds() -> ScreenBounds {
    return ScreenBounds(3.4e38, vec2<f32>(3.4e38), vec2<f32>(-3.4e38));
}

// Widens the bounds to include a control point `p` in object units, wherever displacement moves it.
fn widen(view: LodView, bounds: ScreenBounds, p: vec3<f32>) -> ScreenBounds {
    let clip = view.clip_from_object * vec4<f32>(p, 1.0);
    let depth = max(clip.w, clip.z);
    let place = clip.xy / depth;
    // How far displacement may move the point in depth, past the near plane, and across the view.
    let deep = length(clip_row(view, 3u)) * view.reach;
    let past_near = length(clip_row(view, 3u) - clip_row(view, 2u)) * view.reach;
    let across = vec2<f32>(length(clip_row(view, 0u)), length(clip_row(view, 1u))) * view.reach;
    let beyond = clip.z + past_near <= clip.w;
    let nearest = max(clip.w - deep, clip.z);
    let spread = (across + abs(place) * deep) / nearest;
    return ScreenBounds(
        min(bounds.nearest, nearest),
        min(bounds.least, select(vec2<f32>(-1.0), place - spread, beyond)),
        max(bounds.greatest, select(vec2<f32>(1.0), place + spread, beyond)),
    );
}

// Returns the bounds of an edge's four control points.
fn edge_bounds(view: LodView, a: vec3<f32>, ab: vec3<f32>, ba: vec3<f32>, b: vec3<f32>) -> ScreenBounds {
    return widen(view, widen(view, widen(view, widen(view, no_bounds(), a), ab), ba), b);
}

// Returns a bound on the length on screen, in px, of any vector whose length is `radius` object units.
fn screen_radius(view: LodView, bounds: ScreenBounds, radius: f32) -> f32 {
    let across = vec2<f32>(length(clip_row(view, 0u)), length(clip_row(view, 1u)));
    let deep = length(clip_row(view, 3u));
    let most = max(abs(bounds.least), abs(bounds.greatest));
    return length((across + most * deep) * (radius / bounds.nearest) * view.half_viewport);
}

// The shares of the tolerance where a surface is displaced: for the surface without displacement, for the detail of the
// heights that is lost between segments, and for the turning of the direction of displacement.
const SURFACE_SHARE: f32 = 0.5;
const DETAIL_SHARE: f32 = 0.3;
const TURN_SHARE: f32 = 0.2;

// Returns the least factor (not rounded, 1 or more) that shows the heights of one image along an edge, which is
// `texels` px of level 0 long.
fn displacement_factor(
    view: LodView,
    bounds: ScreenBounds,
    tolerance: f32,
    texels: f32,
    turn: f32,
    scale: f32,
    detail: array<vec4<f32>, 4>,
) -> f32 {
    let bend = screen_radius(view, bounds, view.reach * 0.28125 * turn * turn);
    var segments = texels;
    var losses = detail;
    for (var level = 1u; level < MAX_LEVELS; level++) {
        if screen_radius(view, bounds, scale * losses[level / 4u][level % 4u]) > DETAIL_SHARE * tolerance {
            break;
        }
        segments *= 0.5;
    }
    return max_with_one(max(segments, sqrt(bend / (TURN_SHARE * tolerance))));
}

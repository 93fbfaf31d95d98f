//! LOD by error where a surface is displaced: how many segments show the heights along an edge. Twin:
//! `shaders/displacement_factor.wgsl`.
//!
//! Lengths in object units are bounded on screen. In clip space the difference of two points a and b on screen is (a.xy -
//! b.xy / b.w * a.w) / a.w. So it is at most the largest |d.xy - s d.w| / w, where d = a - b, w is the least depth of the
//! control points, and s is any value between their least and greatest x / w and y / w.

use glam::{Vec2, Vec3};

use super::lod::{LodView, clip_row, max_with_one};
use crate::mesh::MAX_LEVELS;

/// Bounds on the depth and the screen position of a set of control points, from which the size of differences on screen
/// is bounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ScreenBounds {
    /// The least depth (w). Depths nearer than the near plane count as the near plane's, since nothing in front of it is
    /// visible.
    pub nearest: f32,
    /// The least and the greatest x / w and y / w, from -1 to 1 over the view: of the control points if all lie beyond
    /// the near plane, otherwise at least those of the whole view.
    pub least: Vec2,
    pub greatest: Vec2,
}

/// Returns the bounds of no points, to be widened.
fn no_bounds() -> ScreenBounds {
    ScreenBounds { nearest: 3.4e38, least: Vec2::splat(3.4e38), greatest: Vec2::splat(-3.4e38) }
}

/// Widens the bounds to include a control point `p` in object units, wherever displacement moves it.
pub(super) fn widen(view: &LodView, bounds: ScreenBounds, p: Vec3) -> ScreenBounds {
    let clip = view.clip_from_object * p.extend(1.0);
    let depth = clip.w.max(clip.z);
    let place = Vec2::new(clip.x, clip.y) / depth;
    // How far displacement may move the point in depth, past the near plane, and across the view.
    let deep = clip_row(view, 3).length() * view.reach;
    let past_near = (clip_row(view, 3) - clip_row(view, 2)).length() * view.reach;
    let across = Vec2::new(clip_row(view, 0).length(), clip_row(view, 1).length()) * view.reach;
    let beyond = clip.z + past_near <= clip.w;
    let nearest = (clip.w - deep).max(clip.z);
    let spread = (across + place.abs() * deep) / nearest;
    ScreenBounds {
        nearest: bounds.nearest.min(nearest),
        least: bounds.least.min(if beyond { place - spread } else { Vec2::NEG_ONE }),
        greatest: bounds.greatest.max(if beyond { place + spread } else { Vec2::ONE }),
    }
}

/// Returns the bounds of an edge's four control points.
pub(super) fn edge_bounds(view: &LodView, [a, ab, ba, b]: [Vec3; 4]) -> ScreenBounds {
    widen(view, widen(view, widen(view, widen(view, no_bounds(), a), ab), ba), b)
}

/// Returns a bound on the length on screen, in px, of any vector whose length is `radius` object units.
pub(super) fn screen_radius(view: &LodView, bounds: ScreenBounds, radius: f32) -> f32 {
    let across = Vec2::new(clip_row(view, 0).length(), clip_row(view, 1).length());
    let deep = clip_row(view, 3).length();
    let most = bounds.least.abs().max(bounds.greatest.abs());
    ((across + most * deep) * (radius / bounds.nearest) * view.half_viewport).length()
}

/// The shares of the tolerance where a surface is displaced: for the surface without displacement, for the detail of
/// the heights that is lost between segments, and for the turning of the direction of displacement.
pub const SURFACE_SHARE: f32 = 0.5;
pub const DETAIL_SHARE: f32 = 0.3;
pub const TURN_SHARE: f32 = 0.2;

/// Returns the least factor (not rounded, 1 or more) that shows the heights of one image along an edge, which is
/// `texels` px of level 0 long.
///
/// Segments are as long as the px of the coarsest mip level whose loss is within its share of the tolerance. `detail`
/// has the loss of each level, which becomes object units when multiplied by `scale`. They are also short enough for
/// the turning of the direction of displacement: `turn` is the distance between the unit directions at the edge's ends.
/// This is an estimate: between two px an image may rise by more than its levels tell.
pub(super) fn displacement_factor(
    view: &LodView,
    bounds: ScreenBounds,
    tolerance: f32,
    texels: f32,
    turn: f32,
    scale: f32,
    detail: [f32; MAX_LEVELS],
) -> f32 {
    // The sagitta of an arc of radius 1 is an eighth of the squared angle, and `turn` is at least 2/3 of the angle:
    // 9/4 * 1/8 = 0.28125.
    let bend = screen_radius(view, bounds, view.reach * 0.28125 * turn * turn);
    let mut segments = texels;
    for lost in &detail[1..] {
        if screen_radius(view, bounds, scale * lost) > DETAIL_SHARE * tolerance {
            break;
        }
        segments *= 0.5;
    }
    max_with_one(segments.max((bend / (TURN_SHARE * tolerance)).sqrt()))
}

#[cfg(test)]
mod tests;

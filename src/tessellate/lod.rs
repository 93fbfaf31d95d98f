//! How many segments an edge gets. Twin: `shaders/lod.wgsl`.

use clap::ValueEnum;
use glam::{Mat4, Vec2, Vec3};
use serde::{Deserialize, Serialize};

/// Where edge factors come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[repr(u32)]
pub enum Lod {
    /// The same factor everywhere.
    Uniform = 0,
    /// Projected length of the control polygon over pixels per segment, at least 1 (McDonald and Kilgard 2010).
    Paper = 1,
}

/// The view that adaptive factors and clipping are computed for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LodView {
    /// Object units to clip space.
    pub clip_from_object: Mat4,
    /// Half the viewport's width and height, in px.
    pub half_viewport: Vec2,
}

/// The position on screen in segments: px from the centre over px per segment. Divides by w as the paper does, so
/// points behind the eye land on the wrong side.
pub fn project_and_scale(view: &LodView, pixels_per_segment: f32, position: Vec3) -> Vec2 {
    let clip = view.clip_from_object * position.extend(1.0);
    glam::vec2(clip.x, clip.y) / clip.w * view.half_viewport / pixels_per_segment
}

/// The factor of the edge with these four control points, in the edge's own direction (`ComputeEdgeLOD` of the paper).
pub fn paper_edge_factor(view: &LodView, pixels_per_segment: f32, control_points: [Vec3; 4]) -> f32 {
    let [a, ab, ba, b] = control_points.map(|p| project_and_scale(view, pixels_per_segment, p));
    (a.distance(ab) + ab.distance(ba) + ba.distance(b)).max(1.0)
}

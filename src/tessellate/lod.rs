//! How many segments an edge gets. Twin: `shaders/lod.wgsl`.

use clap::ValueEnum;
use glam::{Mat4, Vec2, Vec3};

/// Where edge factors come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, ValueEnum)]
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

/// At least 1, and 1 for what is no number: the length of an edge through the eye's plane may be none. By its bits, since
/// a shader's `max` may give either side of such a comparison.
pub fn at_least_one(length: f32) -> f32 {
    let is_nan = length.to_bits() & 0x7fff_ffff > 0x7f80_0000;
    if is_nan || length < 1.0 { 1.0 } else { length }
}

/// The factor of the edge with these four control points, in the edge's own direction (`ComputeEdgeLOD` of the paper).
pub fn paper_edge_factor(view: &LodView, pixels_per_segment: f32, control_points: [Vec3; 4]) -> f32 {
    let [a, ab, ba, b] = control_points.map(|p| project_and_scale(view, pixels_per_segment, p));
    at_least_one(a.distance(ab) + ab.distance(ba) + ba.distance(b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec3;

    #[test]
    fn a_straight_edge_gets_its_length_on_screen_over_the_length_of_a_segment() {
        let view = LodView { clip_from_object: Mat4::IDENTITY, half_viewport: Vec2::new(400.0, 300.0) };
        let points = [0.0, 0.1, 0.2, 0.3].map(|x| vec3(x, 0.0, 0.0));
        assert!((paper_edge_factor(&view, 8.0, points) - 15.0).abs() < 1e-4, "0.3 of 400 px, in segments of 8");
        assert_eq!(paper_edge_factor(&view, 500.0, points), 1.0, "never less than 1");
    }

    #[test]
    fn what_is_no_number_counts_as_one() {
        assert_eq!([f32::NAN, -f32::NAN, 0.3, -2.0].map(at_least_one), [1.0; 4]);
        assert_eq!([1.5, f32::INFINITY].map(at_least_one), [1.5, f32::INFINITY]);
        let view = LodView { clip_from_object: Mat4::ZERO, half_viewport: Vec2::ONE };
        assert_eq!(paper_edge_factor(&view, 1.0, [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z]), 1.0);
    }
}

//! Which patches emit nothing. Twin: `shaders/cull.wgsl`.

use clap::ValueEnum;
use glam::{Vec3, Vec4};

use super::lod::LodView;
use super::surface::ControlNet;

/// Whether patches that cannot be seen are left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, ValueEnum)]
#[repr(u32)]
pub enum Clip {
    /// Every patch is drawn.
    Off = 0,
    /// A patch goes when each of its ten control points lies outside the view volume, whichever plane each is outside
    /// of (McDonald and Kilgard 2010): it can drop patches that cross the view.
    Paper = 1,
    /// A patch goes when its ten control points all lie outside one and the same plane of the view volume; then so does
    /// the whole patch, which lies in their convex hull.
    Frustum = 2,
}

/// Whether a clip-space position lies outside the paper's view volume, -w <= x, y, z <= w (`IsClipped`).
pub fn is_clipped(clip: Vec4) -> bool {
    let inside = clip.x.abs() <= clip.w && clip.y.abs() <= clip.w && clip.z.abs() <= clip.w;
    !inside
}

/// Whether a position in object units lies outside the view volume.
pub fn outside_view(view: &LodView, position: Vec3) -> bool {
    is_clipped(view.clip_from_object * position.extend(1.0))
}

/// The paper's test of a whole patch.
pub fn patch_is_clipped(view: &LodView, net: &ControlNet) -> bool {
    let outside = |p: &Vec3| outside_view(view, *p);
    net.corners.iter().all(outside) && net.edges.iter().all(outside) && outside(&net.center)
}

/// The planes of the view volume that a clip-space position lies outside of, as bits: left, right, below, above, beyond
/// the far plane, nearer than the near plane (depth is reversed). No division: the planes are linear also behind the eye.
pub fn planes_outside(clip: Vec4) -> u32 {
    u32::from(clip.x < -clip.w)
        | u32::from(clip.x > clip.w) << 1
        | u32::from(clip.y < -clip.w) << 2
        | u32::from(clip.y > clip.w) << 3
        | u32::from(clip.z < 0.0) << 4
        | u32::from(clip.z > clip.w) << 5
}

/// Whether a patch lies outside one plane as a whole.
pub fn patch_is_outside(view: &LodView, net: &ControlNet) -> bool {
    let planes = |p: &Vec3| planes_outside(view.clip_from_object * p.extend(1.0));
    let mut shared = planes(&net.center);
    for p in &net.corners {
        shared &= planes(p);
    }
    for p in &net.edges {
        shared &= planes(p);
    }
    shared != 0
}

/// Whether a patch is left out.
pub fn patch_is_unseen(clip: Clip, view: &LodView, net: &ControlNet) -> bool {
    match clip {
        Clip::Off => false,
        Clip::Paper => patch_is_clipped(view, net),
        Clip::Frustum => patch_is_outside(view, net),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Mat4, Vec2, vec3};

    /// A flat patch with these corners.
    fn flat([a, b, c]: [Vec3; 3]) -> ControlNet {
        let third = |from: Vec3, to: Vec3| from.lerp(to, 1.0 / 3.0);
        let edges = [third(a, b), third(b, a), third(b, c), third(c, b), third(c, a), third(a, c)];
        ControlNet { corners: [a, b, c], edges, center: (a + b + c) / 3.0 }
    }

    #[test]
    fn a_patch_around_the_view_is_dropped_by_the_paper_only() {
        let view = LodView::new(Mat4::IDENTITY, Vec2::ONE);
        // Every control point lies outside, but on different sides: the middle of the view is covered.
        let around = flat([vec3(-9.0, -6.0, 0.5), vec3(9.0, -6.0, 0.5), vec3(0.0, 12.0, 0.5)]);
        let around = ControlNet { center: vec3(0.0, 2.0, 0.5), ..around };
        assert!(patch_is_unseen(Clip::Paper, &view, &around));
        assert!(!patch_is_unseen(Clip::Frustum, &view, &around));
        let left = flat([vec3(-9.0, 0.0, 0.5), vec3(-2.0, -5.0, 0.5), vec3(-1.5, 5.0, 0.5)]);
        assert!(patch_is_unseen(Clip::Frustum, &view, &left));
        assert!(!patch_is_unseen(Clip::Off, &view, &left));
    }

    #[test]
    fn every_plane_has_a_bit_of_its_own() {
        let outside =
            [[-2.0, 0.0, 0.5], [2.0, 0.0, 0.5], [0.0, -2.0, 0.5], [0.0, 2.0, 0.5], [0.0, 0.0, -1.0], [0.0, 0.0, 2.0]];
        for (bit, position) in outside.into_iter().enumerate() {
            assert_eq!(planes_outside(Vec3::from(position).extend(1.0)), 1 << bit);
        }
        assert_eq!(planes_outside(vec3(0.0, 0.0, 0.1).extend(-1.0)) & 1, 1, "behind the eye, left of the left plane");
        assert_eq!(planes_outside(vec3(1.0, -1.0, 0.0).extend(1.0)), 0, "on the planes");
    }
}

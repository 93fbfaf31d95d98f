//! Which patches emit nothing. Twin: `shaders/cull.wgsl`.

use clap::ValueEnum;
use glam::{Vec3, Vec4};

use super::lod::{LodView, clip_row};
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

/// The six control points that weigh in where corner `i`'s weight is taken out of a patch once: of a quadratic triangle,
/// in the order 200, 110, 020, 011, 002, 101. Its points and those of the other two corners differ by the patch's
/// tangents.
pub fn polar_points(net: &ControlNet, i: usize) -> [Vec3; 6] {
    let [b300, b030, b003] = net.corners;
    let [b210, b120, b021, b012, b102, b201] = net.edges;
    let b111 = net.center;
    match i {
        0 => [b300, b210, b120, b111, b102, b201],
        1 => [b210, b120, b030, b021, b012, b111],
        _ => [b201, b111, b021, b012, b003, b102],
    }
}

/// How far a surface must be from being seen edge-on, about as a sine: more than rounding, and enough that also a
/// rasteriser that snaps vertices to 1/256 px finds its back.
pub const FACING_MARGIN: f32 = 1e-3;

/// Whether a patch's surface shows its back everywhere: no point and no two tangents of it, each anywhere within what
/// its control net spans, face the eye. The patch must lie beyond the near plane.
///
/// In homogeneous coordinates of the screen (x, y, w), a point p and the tangents s and t there show their front where
/// p . (s x t) > 0, also without perspective. All three are weighted means of control points and of their differences,
/// with weights that are not negative, so it is less than 0 everywhere if it is for every combination of those.
pub fn faces_away(view: &LodView, net: &ControlNet) -> bool {
    let rows = [clip_row(view, 0), clip_row(view, 1), clip_row(view, 3)];
    let turned = |d: Vec3| Vec3::new(rows[0].dot(d), rows[1].dot(d), rows[2].dot(d));
    let [at_u, at_v, at_w] = [polar_points(net, 0), polar_points(net, 1), polar_points(net, 2)];
    let mut least = Vec3::splat(3.4e38);
    let mut greatest = Vec3::splat(-3.4e38);
    let mut toward_u = [Vec3::ZERO; 6];
    let mut toward_v = [Vec3::ZERO; 6];
    for k in 0..6 {
        for p in [at_u[k], at_v[k], at_w[k]] {
            let clip = view.clip_from_object * p.extend(1.0);
            let seen = Vec3::new(clip.x, clip.y, clip.w);
            least = least.min(seen);
            greatest = greatest.max(seen);
        }
        toward_u[k] = turned(at_u[k] - at_w[k]);
        toward_v[k] = turned(at_v[k] - at_w[k]);
    }
    let middle = (least + greatest) * 0.5;
    let reach = (greatest - least) * 0.5 + (middle.abs() + greatest - least) * FACING_MARGIN;
    for u in toward_u {
        for v in toward_v {
            let facing = u.cross(v);
            // No less than 0 also where it is no number.
            let away = facing.dot(middle) + facing.abs().dot(reach) < 0.0;
            if !away {
                return false;
            }
        }
    }
    true
}

/// Why a patch emits nothing: it doesn't, its own factors cull it being no matter of this.
pub const SEEN: u32 = 0;
/// It is out of view.
pub const OUT_OF_VIEW: u32 = 1;
/// It shows its back only.
pub const FACING_AWAY: u32 = 2;

/// Whether a patch is left out, and why; those that face away if `culls_back` is set.
pub fn unseen(clip: Clip, culls_back: bool, view: &LodView, net: &ControlNet) -> u32 {
    let outside = match clip {
        Clip::Off => false,
        Clip::Paper => patch_is_clipped(view, net),
        Clip::Frustum => patch_is_outside(view, net),
    };
    if outside {
        OUT_OF_VIEW
    } else if culls_back && faces_away(view, net) {
        FACING_AWAY
    } else {
        SEEN
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
        assert_eq!(unseen(Clip::Paper, false, &view, &around), OUT_OF_VIEW);
        assert_eq!(unseen(Clip::Frustum, false, &view, &around), SEEN);
        let left = flat([vec3(-9.0, 0.0, 0.5), vec3(-2.0, -5.0, 0.5), vec3(-1.5, 5.0, 0.5)]);
        assert_eq!(unseen(Clip::Frustum, false, &view, &left), OUT_OF_VIEW);
        assert_eq!(unseen(Clip::Off, false, &view, &left), SEEN);
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

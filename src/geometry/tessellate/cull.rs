//! Culling and clipping of whole patches: which patches emit nothing because they show only their backs or lie outside
//! the view. Twin: `shaders/cull.wgsl`.

use glam::{Vec3, Vec4};

use super::lod::{LodView, clip_row};
use super::surface::ControlNet;
use crate::choice::choices;

choices! {
    /// Whether patches that cannot be seen are left out.
    #[derive(Hash)]
    #[repr(u32)]
    pub enum Clip {
        Off => "off", "Off", "Every patch is drawn.";
        Frustum => "frustum", "Frustum",
            "Leaves out a patch if all its ten control points lie outside the same side of the view. No visible patch is \
             lost.";
        Paper => "paper", "White paper",
            "Leaves out a patch if each of its ten control points lies outside the view, on whichever side (McDonald and \
             Kilgard 2010). Patches that cross the view can be lost.";
    }
}

/// Returns whether a clip-space position lies outside the white paper's view volume, -w <= x, y, z <= w (`IsClipped` of
/// McDonald and Kilgard 2010).
pub(crate) fn is_clipped(clip: Vec4) -> bool {
    let inside = clip.x.abs() <= clip.w && clip.y.abs() <= clip.w && clip.z.abs() <= clip.w;
    !inside
}

/// Returns whether a position in object units lies outside that view volume.
pub(super) fn outside_view(view: &LodView, position: Vec3) -> bool {
    is_clipped(view.clip_from_object * position.extend(1.0))
}

/// Returns whether all ten control points lie outside the view volume: the white paper's test of a patch.
pub(super) fn patch_is_clipped(view: &LodView, net: &ControlNet) -> bool {
    let outside = |p: &Vec3| outside_view(view, *p);
    net.corners.iter().all(outside) && net.edges.iter().all(outside) && outside(&net.center)
}

/// Returns which planes of the view volume a clip-space position lies outside of, as bits: left (bit 0), right, bottom,
/// top, far, near (bit 5). Depth is reversed.
///
/// Nothing is divided by w: the planes are linear functions in clip space, so the test holds behind the eye too.
pub fn planes_outside(clip: Vec4) -> u32 {
    planes_outside_by([0.0; 6], clip)
}

/// Returns the same bits for the planes that a position lies outside of by more than their margin, in clip-space units.
pub(super) fn planes_outside_by(margins: [f32; 6], clip: Vec4) -> u32 {
    u32::from(clip.x + margins[0] < -clip.w)
        | u32::from(clip.x - margins[1] > clip.w) << 1
        | u32::from(clip.y + margins[2] < -clip.w) << 2
        | u32::from(clip.y - margins[3] > clip.w) << 3
        | u32::from(clip.z + margins[4] < 0.0) << 4
        | u32::from(clip.z - margins[5] > clip.w) << 5
}

/// Returns how far displacement may move a point towards the inside of each plane, in clip-space units and in the order
/// of the bits of [`planes_outside`].
pub(super) fn reach_margins(view: &LodView) -> [f32; 6] {
    let x = clip_row(view, 0);
    let y = clip_row(view, 1);
    let z = clip_row(view, 2);
    let w = clip_row(view, 3);
    let inward = [x + w, x - w, y + w, y - w, z, z - w];
    inward.map(|inward| inward.length() * view.reach)
}

/// Returns whether all of a patch lies outside one plane of the view volume, however it is displaced.
pub(crate) fn patch_is_outside(view: &LodView, net: &ControlNet) -> bool {
    let margins = reach_margins(view);
    let planes = |p: &Vec3| planes_outside_by(margins, view.clip_from_object * p.extend(1.0));
    let mut shared = planes(&net.center);
    for p in &net.corners {
        shared &= planes(p);
    }
    for p in &net.edges {
        shared &= planes(p);
    }
    shared != 0
}

/// Returns the six control points whose weights contain the weight of corner `i` as a factor, as the net of a quadratic
/// triangle in the order 200, 110, 020, 011, 002, 101.
///
/// The point of that quadratic triangle is the polar form of the patch with corner `i` as one argument. Differences of
/// the three polar forms are the patch's tangents, up to a factor of 3.
pub(super) fn polar_points(net: &ControlNet, i: usize) -> [Vec3; 6] {
    let [b300, b030, b003] = net.corners;
    let [b210, b120, b021, b012, b102, b201] = net.edges;
    let b111 = net.center;
    match i {
        0 => [b300, b210, b120, b111, b102, b201],
        1 => [b210, b120, b030, b021, b012, b111],
        _ => [b201, b111, b021, b012, b003, b102],
    }
}

/// How far a surface must be from being seen edge-on, about as a sine. The margin is larger than rounding errors, and
/// large enough that a rasteriser which snaps vertices to 1/256 px sees a back face too.
pub const FACING_MARGIN: f32 = 1e-3;

/// The rounding error of a sum, relative to the sum of the absolute values of its terms.
pub const FACING_ROUNDING: f32 = 1e-6;

/// The second and third index of each of the `polar_points`, as two digits to base 5, and its binomial weight. In a
/// product of two quadratic polynomials indices add up, so that digits go up to 4.
pub const POLAR_INDICES: [usize; 6] = [0, 5, 10, 6, 2, 1];
pub const POLAR_WEIGHTS: [f32; 6] = [1.0, 2.0, 1.0, 2.0, 1.0, 2.0];

/// Returns whether a patch shows its back everywhere. The patch must lie beyond the near plane.
///
/// Take the homogeneous screen coordinates (x, y, w) of a point p and of its tangents s and t. The surface shows its
/// front where p . (s x t) > 0, with or without perspective. Tangents are quadratic polynomials. Their cross product is
/// a quartic polynomial: a mean of 15 control vectors with weights that aren't negative. The point p lies in the
/// bounding box of the control points. So the product is negative everywhere if it is negative for each of the 15
/// vectors and every point of the box.
pub(crate) fn faces_away(view: &LodView, net: &ControlNet) -> bool {
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
    let mut facing = [Vec3::ZERO; 25];
    let mut terms = [Vec3::ZERO; 25];
    for i in 0..6 {
        for j in 0..6 {
            let product = toward_u[i].cross(toward_v[j]) * (POLAR_WEIGHTS[i] * POLAR_WEIGHTS[j]);
            facing[POLAR_INDICES[i] + POLAR_INDICES[j]] += product;
            terms[POLAR_INDICES[i] + POLAR_INDICES[j]] += product.abs();
        }
    }
    for i in 0..5 {
        for j in 0..5 - i {
            let own = facing[5 * i + j];
            let rounding = terms[5 * i + j].dot(middle.abs()) * FACING_ROUNDING;
            // Written so that NaN counts as not facing away.
            let away = own.dot(middle) + own.abs().dot(reach) + rounding < 0.0;
            if !away {
                return false;
            }
        }
    }
    true
}

/// The reasons why a patch emits nothing. `NOT_CULLED`: the view leaves it in, though its own factors may cull it.
pub const NOT_CULLED: u32 = 0;
/// The patch lies outside the view.
pub const OUT_OF_VIEW: u32 = 1;
/// The patch shows only its back.
pub const FACING_AWAY: u32 = 2;

/// Returns whether a patch is left out, and why. Patches that show only their backs are left out if `culls_back` is
/// set.
pub fn cull_reason(clip: Clip, culls_back: bool, view: &LodView, net: &ControlNet) -> u32 {
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
        NOT_CULLED
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Mat4, Vec2, vec3};

    /// Returns the control net of a flat patch with these corners.
    fn flat([a, b, c]: [Vec3; 3]) -> ControlNet {
        let third = |from: Vec3, to: Vec3| from.lerp(to, 1.0 / 3.0);
        let edges = [third(a, b), third(b, a), third(b, c), third(c, b), third(c, a), third(a, c)];
        ControlNet { corners: [a, b, c], edges, center: (a + b + c) / 3.0 }
    }

    #[test]
    fn a_patch_that_surrounds_the_view_is_left_out_by_the_white_papers_test_only() {
        let view = LodView::new(Mat4::IDENTITY, Vec2::ONE);
        // All control points lie outside, but beyond different planes, and the patch covers the middle of the view.
        let around = flat([vec3(-9.0, -6.0, 0.5), vec3(9.0, -6.0, 0.5), vec3(0.0, 12.0, 0.5)]);
        let around = ControlNet { center: vec3(0.0, 2.0, 0.5), ..around };
        assert_eq!(cull_reason(Clip::Paper, false, &view, &around), OUT_OF_VIEW);
        assert_eq!(cull_reason(Clip::Frustum, false, &view, &around), NOT_CULLED);
        let left = flat([vec3(-9.0, 0.0, 0.5), vec3(-2.0, -5.0, 0.5), vec3(-1.5, 5.0, 0.5)]);
        assert_eq!(cull_reason(Clip::Frustum, false, &view, &left), OUT_OF_VIEW);
        assert_eq!(cull_reason(Clip::Off, false, &view, &left), NOT_CULLED);
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

    /// Returns a patch of a size of about 1 unit whose control points are moved at random by up to `bend` units. The eye is at the
    /// origin and looks along +z.
    fn bent(random: [f32; 30], bend: f32) -> ControlNet {
        let corners = [vec3(-0.4, -0.3, 3.0), vec3(0.5, -0.4, 3.2), vec3(0.0, 0.6, 2.9)];
        let mut net = flat(corners);
        let off = |k: usize| vec3(random[3 * k], random[3 * k + 1], random[3 * k + 2]) * bend;
        (0..3).for_each(|k| net.corners[k] += off(k) * 3.0);
        (0..6).for_each(|k| net.edges[k] += off(3 + k));
        net.center += off(9);
        net
    }

    /// Returns p . (s x t) at weights `u` and `v`: negative where the surface shows its back.
    fn front(net: &ControlNet, u: f64, v: f64) -> f64 {
        let weights =
            [u * u, 2.0 * u * v, v * v, 2.0 * v * (1.0 - u - v), (1.0 - u - v).powi(2), 2.0 * u * (1.0 - u - v)];
        let at = |i: usize| -> glam::DVec3 {
            polar_points(net, i).iter().zip(weights).map(|(p, weight)| p.as_dvec3() * weight).sum()
        };
        let (at_u, at_v, at_w) = (at(0), at(1), at(2));
        let position = at_u * u + at_v * v + at_w * (1.0 - u - v);
        // The eye looks along +z, with x to the right and y up, so clockwise triangles show their backs.
        position.dot((at_u - at_w).cross(at_v - at_w))
    }

    #[test]
    fn a_patch_that_hardly_leaves_a_corner_faces_away_all_the_same() {
        let mut clip_from_object = Mat4::from_diagonal(glam::Vec4::new(1.0, 1.0, 0.0, 0.0));
        clip_from_object.z_axis.w = 1.0;
        clip_from_object.w_axis.z = 0.01;
        let view = LodView::new(clip_from_object, Vec2::ONE);
        let corners = [vec3(0.0, 0.0, 3.0), vec3(0.0, 1.0, 3.0), vec3(1.0, 0.0, 3.0)];
        for part in [0.3, 1e-4, 1e-8] {
            let mut net = flat(corners);
            net.edges[0] = corners[0].lerp(corners[1], part);
            net.edges[5] = corners[0].lerp(corners[2], part);
            assert!(faces_away(&view, &net), "{part}");
        }
    }

    #[test]
    fn margins_are_the_lengths_of_the_planes_normals() {
        // No two rows are perpendicular to w, as they would be before a camera that looks straight ahead.
        let rows = [[3.0, 0.0, 0.0, 0.0], [0.0, 4.0, 0.0, 0.0], [0.0, 0.0, 2.0, 0.0], [1.0, 2.0, 5.0, 1.0]];
        let clip_from_object = Mat4::from_cols_array_2d(&rows).transpose();
        let view = LodView::new(clip_from_object, Vec2::ONE).with_reach(0.5);
        // The squared lengths of x + w, x - w, y + w, y - w, z and z - w.
        let expected = [45.0, 33.0, 62.0, 30.0, 4.0, 14.0].map(|square: f32| 0.5 * square.sqrt());
        for (own, expected) in reach_margins(&view).into_iter().zip(expected) {
            assert!((own - expected).abs() < 1e-6, "{own}, not {expected}");
        }
    }

    proptest::proptest! {
        #[test]
        fn patches_that_face_away_show_their_back_everywhere(
            random in proptest::array::uniform30(-1.0f32..1.0),
            bend in 0.0f32..0.6,
        ) {
            let mut clip_from_object = Mat4::from_diagonal(glam::Vec4::new(1.0, 1.0, 0.0, 0.0));
            clip_from_object.z_axis.w = 1.0;
            clip_from_object.w_axis.z = 0.01;
            let view = LodView::new(clip_from_object, Vec2::ONE);
            let net = bent(random, bend);
            let places = (0..=24).flat_map(|i| (0..=24 - i).map(move |j| (f64::from(i) / 24.0, f64::from(j) / 24.0)));
            let most = places.map(|(u, v)| front(&net, u, v)).fold(f64::NEG_INFINITY, f64::max);
            let turned = ControlNet {
                corners: [0, 2, 1].map(|k| net.corners[k]),
                edges: [5, 4, 3, 2, 1, 0].map(|k| net.edges[k]),
                center: net.center,
            };
            let away = [faces_away(&view, &net), faces_away(&view, &turned)];
            proptest::prop_assert!(!(away[0] && away[1]));
            proptest::prop_assert!(!away[0] || most < 0.0, "{most}");
            // The test is exact for patches that are nearly flat.
            proptest::prop_assert!(bend > 0.02 || away[0] == (most < 0.0), "{bend} {most}");
        }
    }
}

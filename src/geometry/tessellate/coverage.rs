//! A conservative test for triangles that cover no sample of the picture: such triangles needn't be rasterised. The
//! test holds however the rasteriser rounds the corners. Twin: `shaders/coverage.wgsl`.

use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec2, Vec3, vec2, vec3};

/// The picture that triangles are drawn into.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct CoverageView {
    pub clip_from_object: Mat4,
    /// The rounding error of clip coordinates for each unit of a position's distance from the origin along each axis.
    pub slack: Mat4,
    /// Width and height in px.
    pub viewport: Vec2,
    /// Samples per pixel: 1 or 4.
    pub sample_count: u32,
    /// 1 if back faces are not drawn, else 0.
    pub fronts_only: u32,
    /// The largest distance in px by which the rasteriser moves a corner when it rounds it to its subpixel grid.
    pub snap: f32,
    pub _pad: [u32; 3],
}

impl CoverageView {
    /// Builds the view of a picture of `viewport` px. `subpixel_bits` is the adapter's: see
    /// `gpu::Gpu::subpixel_bits`.
    pub fn new(
        clip_from_object: Mat4,
        viewport: Vec2,
        sample_count: u32,
        fronts_only: bool,
        subpixel_bits: u32,
    ) -> Self {
        // This test and the vertex shader each add up four products, in different orders. Each sum is within 4 rounding
        // errors of the exact one. The other 8 are for the operations that follow, among them the division by w.
        const ROUNDING: f32 = 16.0 * f32::EPSILON / 2.0;
        let slack = Mat4::from_cols_array(&clip_from_object.to_cols_array().map(|x| x.abs() * ROUNDING));
        // Vulkan doesn't say whether corners are rounded or truncated, so they may move by a whole step of the grid.
        let snap = (-(subpixel_bits as f32)).exp2();
        let fronts_only = u32::from(fronts_only);
        Self { clip_from_object, slack, viewport, sample_count, fronts_only, snap, _pad: [0; 3] }
    }
}

/// A triangle's corner on screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScreenCorner {
    /// The position in px from the picture's upper left corner.
    pub at: Vec2,
    /// The largest distance in px between `at` and the rasterised corner, along x and along y. Negative if the corner
    /// may be nearer than the near plane.
    pub reach: f32,
}

/// The x coordinates of samples within their pixel, in px. A pixel has as many rows of samples as samples (1 or 4),
/// with one sample in each row, half a row's height below the row's upper edge. These are the standard positions of
/// Vulkan, Metal and Direct3D.
pub const ROW_SAMPLES: [f32; 4] = [0.375, 0.875, 0.125, 0.625];

/// Projects a position in object units to the screen, and bounds the error of the projection.
pub fn screen_corner(view: &CoverageView, position: Vec3) -> ScreenCorner {
    let clip = view.clip_from_object * position.extend(1.0);
    let off = view.slack * position.abs().extend(1.0);
    let least_w = clip.w - off.w;
    let is_beyond_near = least_w > 0.0 && clip.z + off.z <= least_w;
    if !is_beyond_near {
        return ScreenCorner { at: Vec2::ZERO, reach: -1.0 };
    }
    let place = vec2(clip.x, clip.y) / clip.w;
    let half_size = 0.5 * view.viewport;
    let reach = (vec2(off.x, off.y) + (place.abs() + 1.0) * off.w) / least_w * half_size;
    let at = half_size + place * vec2(half_size.x, -half_size.y);
    ScreenCorner { at, reach: view.snap + reach.max_element() }
}

/// Returns the z coordinate of the cross product.
fn cross_2d(a: Vec2, b: Vec2) -> f32 {
    a.x * b.y - a.y * b.x
}

/// Returns the Manhattan length.
fn manhattan_length(a: Vec2) -> f32 {
    a.x.abs() + a.y.abs()
}

/// Returns whether a triangle is a back face wherever its corners are within `reach` px of `a`, `b` and `c`. Y points
/// down.
fn is_back_face(a: Vec2, b: Vec2, c: Vec2, reach: f32) -> bool {
    let ab = b - a;
    let ac = c - a;
    cross_2d(ab, ac) > 2.0 * reach * (manhattan_length(ab) + manhattan_length(ac) + 4.0 * reach)
}

/// Returns whether a triangle whose corners are within `reach` px of `a`, `b` and `c` may cover the place `at`.
///
/// It covers the place if the three triangles that the place makes with its sides are wound the same way: `areas` are
/// twice their signed areas, and `change` bounds how much `reach` can change these.
fn may_cover(at: Vec2, a: Vec2, b: Vec2, c: Vec2, reach: f32) -> bool {
    let to_a = a - at;
    let to_b = b - at;
    let to_c = c - at;
    let areas = vec3(cross_2d(to_a, to_b), cross_2d(to_b, to_c), cross_2d(to_c, to_a));
    let lengths = vec3(manhattan_length(to_a), manhattan_length(to_b), manhattan_length(to_c));
    let change = reach * (lengths + vec3(lengths.y, lengths.z, lengths.x) + 2.0 * reach);
    areas.cmpge(-change).all() || areas.cmple(change).all()
}

/// Returns the x coordinate within their pixel of the samples in row `row`, in px.
fn row_sample(view: &CoverageView, row: f32) -> f32 {
    if view.sample_count == 1 {
        return 0.5;
    }
    ROW_SAMPLES[row as usize & 3]
}

/// Returns whether no part of a triangle can be seen. Of triangles larger than 2 px in x or y it only tests whether
/// they lie outside the picture or are back faces.
pub fn covers_nothing(view: &CoverageView, a: ScreenCorner, b: ScreenCorner, c: ScreenCorner) -> bool {
    if a.reach.min(b.reach).min(c.reach) < 0.0 {
        return false;
    }
    let reach = a.reach.max(b.reach).max(c.reach);
    let low = a.at.min(b.at).min(c.at) - reach;
    let high = a.at.max(b.at).max(c.at) + reach;
    if high.cmplt(Vec2::ZERO).any() || low.cmpgt(view.viewport).any() {
        return true;
    }
    if view.fronts_only != 0 && is_back_face(a.at, b.at, c.at, reach) {
        return true;
    }
    if (high - low).cmpgt(Vec2::splat(2.0)).any() {
        return false;
    }
    // Rows above the picture have no samples.
    let rows = view.sample_count as f32;
    let last = high.y * rows - 0.5;
    let mut row = (low.y.max(0.0) * rows - 0.5).ceil();
    while row <= last {
        let sample = row_sample(view, row);
        let mut x = (low.x - sample).ceil() + sample;
        while x <= high.x {
            if may_cover(vec2(x, (row + 0.5) / rows), a.at, b.at, c.at, reach) {
                return false;
            }
            x += 1.0;
        }
        row += 1.0;
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;
    use glam::camera::rh::proj::directx::perspective_infinite_reverse;
    use proptest::prelude::*;

    const SIZE: f32 = 64.0;

    /// The coarsest subpixel grid that Vulkan allows (Vulkan specification, required limits).
    const BITS: u32 = 4;
    const SNAP: f32 = 1.0 / 16.0;
    /// The standard sample positions of Vulkan, Metal and Direct3D within a pixel, in px.
    const SAMPLES: [Vec2; 4] = [vec2(0.375, 0.125), vec2(0.875, 0.375), vec2(0.125, 0.625), vec2(0.625, 0.875)];

    fn view(sample_count: u32, fronts_only: bool) -> CoverageView {
        CoverageView::new(Mat4::IDENTITY, Vec2::splat(SIZE), sample_count, fronts_only, BITS)
    }

    /// Returns the position that [`view`] shows at a place in px.
    fn at(px: Vec2) -> Vec3 {
        vec3(px.x / SIZE * 2.0 - 1.0, 1.0 - px.y / SIZE * 2.0, 0.5)
    }

    fn is_left_out(view: &CoverageView, corners: [Vec2; 3]) -> bool {
        let [a, b, c] = corners.map(|corner| screen_corner(view, at(corner)));
        covers_nothing(view, a, b, c)
    }

    /// Returns whether a triangle covers a sample or has one on its outline, in f64.
    fn covers_a_sample(corners: [DVec2; 3], samples: &[Vec2]) -> bool {
        let low = corners.iter().copied().fold(DVec2::MAX, DVec2::min).floor().as_ivec2();
        let high = corners.iter().copied().fold(DVec2::MIN, DVec2::max).floor().as_ivec2();
        let pixels = (low.y..=high.y).flat_map(|y| (low.x..=high.x).map(move |x| DVec2::new(x.into(), y.into())));
        let mut places = pixels.flat_map(|pixel| samples.iter().map(move |sample| pixel + sample.as_dvec2()));
        places.any(|place| {
            let [a, b, c] = corners.map(|corner| corner - place);
            let areas = [a.perp_dot(b), b.perp_dot(c), c.perp_dot(a)];
            areas.iter().all(|area| *area >= 0.0) || areas.iter().all(|area| *area <= 0.0)
        })
    }

    #[test]
    fn corners_lie_where_the_picture_shows_them() {
        for px in [vec2(3.0, 5.0), vec2(60.0, 20.0), vec2(10.0, 50.0)] {
            let corner = screen_corner(&view(1, false), at(px));
            assert!(corner.at.distance(px) < 1e-4, "{corner:?}, not at {px}");
        }
    }

    #[test]
    fn what_rounding_may_put_before_the_near_plane_is_not_placed() {
        let reach = |z: f32| screen_corner(&view(1, false), vec3(0.0, 0.0, z)).reach;
        assert!(reach(0.999) > 0.0 && reach(1.001) < 0.0);
        assert_eq!(reach(1.0_f32.next_down()), -1.0, "an ULP beyond the plane");
    }

    #[test]
    fn a_triangle_covers_what_its_corners_can_come_to() {
        // A place at a distance from the side from (0, 0) to (4, 0). The area with it is four times the distance, and
        // corners that move by 1/10 px change it by up to 1/10 (4 + 2 distance + 2/10): equal at 0.42 / 3.8.
        let [a, b, c] = [vec2(0.0, 0.0), vec2(4.0, 0.0), vec2(0.0, 4.0)];
        let covers = |distance: f32| {
            let at = vec2(1.0, -distance);
            [may_cover(at, a, b, c, 0.1), may_cover(at, c, b, a, 0.1)]
        };
        assert_eq!([covers(0.110), covers(0.111)], [[true; 2], [false; 2]]);
    }

    fn place() -> impl Strategy<Value = Vec2> {
        (20.0_f32..21.0, 20.0_f32..21.0).prop_map(|(x, y)| vec2(x, y))
    }

    fn offset(most: f32) -> impl Strategy<Value = Vec2> {
        (-most..most, -most..most).prop_map(|(x, y)| vec2(x, y))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        /// Corners are moved by up to the step of a grid of 1/16 px.
        #[test]
        fn triangles_that_are_left_out_cover_no_sample(
            a in place(), ab in offset(0.9), ac in offset(0.9), moved in [offset(SNAP), offset(SNAP), offset(SNAP)],
            one_sample: bool,
        ) {
            let corners = [a, a + ab, a + ac];
            let count = if one_sample { 1 } else { 4 };
            if is_left_out(&view(count, false), corners) {
                let samples = if one_sample { &[vec2(0.5, 0.5)][..] } else { &SAMPLES };
                let [a, b, c] = [0, 1, 2].map(|i| corners[i].as_dvec2() + moved[i].as_dvec2());
                prop_assert!(!covers_a_sample([a, b, c], samples));
            }
        }

        /// Triangles that are left out only as back faces are back faces.
        #[test]
        fn front_faces_are_not_left_out_as_back_faces(
            a in place(), ab in offset(0.9), ac in offset(0.9), moved in [offset(SNAP), offset(SNAP), offset(SNAP)],
        ) {
            let corners = [a, a + ab, a + ac];
            if is_left_out(&view(4, true), corners) && !is_left_out(&view(4, false), corners) {
                let [a, b, c] = [0, 1, 2].map(|i| corners[i].as_dvec2() + moved[i].as_dvec2());
                // Y points down, so the area of a front face is negative.
                prop_assert!((b - a).perp_dot(c - a) > 0.0);
            }
        }
    }

    #[test]
    fn small_triangles_between_samples_are_left_out() {
        let around = |px: Vec2| [px + vec2(-0.05, -0.04), px + vec2(0.05, -0.04), px + vec2(0.0, 0.05)];
        assert!(
            is_left_out(&view(4, false), around(vec2(20.5, 20.5))),
            "none of the four samples is in the middle of the pixel"
        );
        assert!(!is_left_out(&view(1, false), around(vec2(20.5, 20.5))));
        for sample in SAMPLES {
            assert!(!is_left_out(&view(4, false), around(vec2(20.0, 20.0) + sample)));
            assert!(is_left_out(&view(1, false), around(vec2(20.0, 20.0) + sample)));
        }
    }

    #[test]
    fn triangles_beside_the_picture_are_left_out_and_those_that_cross_its_border_are_not() {
        let large = |x: f32| [vec2(x, 10.0), vec2(x + 30.0, 10.0), vec2(x, 40.0)];
        assert!(is_left_out(&view(4, false), large(-31.0)));
        assert!(!is_left_out(&view(4, false), large(-29.0)));
        assert!(!is_left_out(&view(4, false), large(SIZE - 1.0)));
        assert!(is_left_out(&view(4, false), large(SIZE + 1.0)));
    }

    #[test]
    fn back_faces_are_left_out_where_only_front_faces_are_drawn() {
        let back = [vec2(10.0, 10.0), vec2(30.0, 10.0), vec2(10.0, 30.0)];
        let [a, b, c] = back;
        assert!(is_left_out(&view(4, true), back) && !is_left_out(&view(4, false), back));
        assert!(!is_left_out(&view(4, true), [a, c, b]));
    }

    #[test]
    fn corners_nearer_than_the_near_plane_have_no_screen_position() {
        let view = CoverageView::new(perspective_infinite_reverse(1.0, 1.0, 0.1), Vec2::splat(SIZE), 4, false, BITS);
        for z in [-0.05, 0.0, 1.0, f32::NAN] {
            assert_eq!(screen_corner(&view, vec3(0.0, 0.0, z)).reach, -1.0);
        }
        let seen = screen_corner(&view, vec3(0.0, 0.0, -1.0));
        assert!(seen.reach > SNAP && seen.reach < SNAP + 1e-3, "{seen:?}");
    }

    #[test]
    fn the_error_of_a_corner_grows_with_its_distance_from_the_origin() {
        // f32 has steps of 1/128 at 100,000, which is a seventh of a px at this distance from the eye.
        let far = Vec3::splat(1e5);
        let clip = perspective_infinite_reverse(1.0, 1.0, 0.1) * Mat4::from_translation(-far);
        let view = CoverageView::new(clip, Vec2::splat(SIZE), 4, false, BITS);
        let reach = screen_corner(&view, far - vec3(0.0, 0.0, 3.0)).reach;
        assert!(reach > 0.15, "{reach}");
    }
}

//! Which triangles cover no sample of the picture, wherever rounding puts their corners: they need not be rasterised. Twin:
//! `shaders/coverage.wgsl`.

use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec2, Vec3, vec2, vec3};

/// A picture that triangles are drawn into.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct CoverageView {
    pub clip_from_object: Mat4,
    /// How far clip coordinates may be off for every unit that a position is from the origin along each axis.
    pub slack: Mat4,
    /// Width and height in px.
    pub viewport: Vec2,
    /// 1 or 4.
    pub sample_count: u32,
    /// 1 where what faces away isn't drawn either.
    pub fronts_only: u32,
    /// How far a corner is moved when it is rounded to the rasteriser's grid, in px.
    pub snap: f32,
    pub _pad: [u32; 3],
}

impl CoverageView {
    /// `subpixel_bits` as an adapter has them: see [`crate::gpu::Gpu::subpixel_bits`].
    pub fn new(
        clip_from_object: Mat4,
        viewport: Vec2,
        sample_count: u32,
        fronts_only: bool,
        subpixel_bits: u32,
    ) -> Self {
        // Four products are added up here and by whoever draws, each in an order of its own: either is within 4 roundings of
        // what is right. As much again is for what follows, the division among it.
        const ROUNDING: f32 = 16.0 * f32::EPSILON / 2.0;
        let slack = Mat4::from_cols_array(&clip_from_object.to_cols_array().map(|x| x.abs() * ROUNDING));
        // Vulkan doesn't say whether corners are rounded or cut off.
        let snap = (-(subpixel_bits as f32)).exp2();
        let fronts_only = u32::from(fronts_only);
        Self { clip_from_object, slack, viewport, sample_count, fronts_only, snap, _pad: [0; 3] }
    }
}

/// A corner on screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScreenCorner {
    /// Px from the upper left.
    pub at: Vec2,
    /// How far from there it may be rasterised along x and along y, in px. Below 0 where it may be nearer than the near
    /// plane.
    pub reach: f32,
}

/// Samples lie in rows, one a pixel in each: how many rows a pixel has (1 or 4), and how far a row's samples are from their
/// pixels' left. A row is half a row's height below its upper side. So have it Vulkan, Metal and Direct3D.
pub(crate) const ROW_SAMPLES: [f32; 4] = [0.375, 0.875, 0.125, 0.625];

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

fn cross_2d(a: Vec2, b: Vec2) -> f32 {
    a.x * b.y - a.y * b.x
}

fn taxicab(a: Vec2) -> f32 {
    a.x.abs() + a.y.abs()
}

/// Whether a triangle faces away, wherever its corners are within reach. Y goes down.
fn turns_away(a: Vec2, b: Vec2, c: Vec2, reach: f32) -> bool {
    let ab = b - a;
    let ac = c - a;
    cross_2d(ab, ac) > 2.0 * reach * (taxicab(ab) + taxicab(ac) + 4.0 * reach)
}

/// Whether a triangle may cover a place within its box if its corners are within reach: twice the areas that the place spans
/// with its sides have one sign then.
fn may_cover(at: Vec2, a: Vec2, b: Vec2, c: Vec2, reach: f32) -> bool {
    let to_a = a - at;
    let to_b = b - at;
    let to_c = c - at;
    let areas = vec3(cross_2d(to_a, to_b), cross_2d(to_b, to_c), cross_2d(to_c, to_a));
    let lengths = vec3(taxicab(to_a), taxicab(to_b), taxicab(to_c));
    let change = reach * (lengths + vec3(lengths.y, lengths.z, lengths.x) + 2.0 * reach);
    areas.cmpge(-change).all() || areas.cmple(change).all()
}

/// How far a row's samples are from their pixels' left.
fn row_sample(view: &CoverageView, row: f32) -> f32 {
    if view.sample_count == 1 {
        return 0.5;
    }
    ROW_SAMPLES[row as usize & 3]
}

/// Whether nothing of a triangle can be seen. Triangles of more than two px either way are not looked at closely.
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
    if view.fronts_only != 0 && turns_away(a.at, b.at, c.at, reach) {
        return true;
    }
    if (high - low).cmpgt(Vec2::splat(2.0)).any() {
        return false;
    }
    // Above the picture and left of it are no samples.
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

    /// The coarsest grid that there is (Vulkan specification, required limits).
    const BITS: u32 = 4;
    const SNAP: f32 = 1.0 / 16.0;
    /// Where Vulkan, Metal and Direct3D have a pixel's samples, in px.
    const SAMPLES: [Vec2; 4] = [vec2(0.375, 0.125), vec2(0.875, 0.375), vec2(0.125, 0.625), vec2(0.625, 0.875)];

    fn view(sample_count: u32, fronts_only: bool) -> CoverageView {
        CoverageView::new(Mat4::IDENTITY, Vec2::splat(SIZE), sample_count, fronts_only, BITS)
    }

    /// A position at a place in px, under [`view`].
    fn at(px: Vec2) -> Vec3 {
        vec3(px.x / SIZE * 2.0 - 1.0, 1.0 - px.y / SIZE * 2.0, 0.5)
    }

    fn is_left_out(view: &CoverageView, corners: [Vec2; 3]) -> bool {
        let [a, b, c] = corners.map(|corner| screen_corner(view, at(corner)));
        covers_nothing(view, a, b, c)
    }

    /// Exactly, but for rounding in f64: whether a triangle covers a sample or has one on its rim.
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

    fn place() -> impl Strategy<Value = Vec2> {
        (20.0_f32..21.0, 20.0_f32..21.0).prop_map(|(x, y)| vec2(x, y))
    }

    fn offset(most: f32) -> impl Strategy<Value = Vec2> {
        (-most..most, -most..most).prop_map(|(x, y)| vec2(x, y))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        /// Wherever a grid of 1/16 px puts the corners.
        #[test]
        fn what_is_left_out_covers_nothing(
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

        /// Nor faces the eye where only that is drawn.
        #[test]
        fn fronts_are_not_left_out_for_their_back(
            a in place(), ab in offset(0.9), ac in offset(0.9), moved in [offset(SNAP), offset(SNAP), offset(SNAP)],
        ) {
            let corners = [a, a + ab, a + ac];
            if is_left_out(&view(4, true), corners) && !is_left_out(&view(4, false), corners) {
                let [a, b, c] = [0, 1, 2].map(|i| corners[i].as_dvec2() + moved[i].as_dvec2());
                // Y goes down: what turns to the left on screen has a negative area.
                prop_assert!((b - a).perp_dot(c - a) > 0.0);
            }
        }
    }

    #[test]
    fn small_triangles_between_samples_are_left_out() {
        let around = |px: Vec2| [px + vec2(-0.05, -0.04), px + vec2(0.05, -0.04), px + vec2(0.0, 0.05)];
        assert!(
            is_left_out(&view(4, false), around(vec2(20.5, 20.5))),
            "in the middle of a pixel is no sample of four"
        );
        assert!(!is_left_out(&view(1, false), around(vec2(20.5, 20.5))));
        for sample in SAMPLES {
            assert!(!is_left_out(&view(4, false), around(vec2(20.0, 20.0) + sample)));
            assert!(is_left_out(&view(1, false), around(vec2(20.0, 20.0) + sample)));
        }
    }

    #[test]
    fn what_lies_beside_the_picture_is_left_out_and_what_crosses_its_rim_is_not() {
        let large = |x: f32| [vec2(x, 10.0), vec2(x + 30.0, 10.0), vec2(x, 40.0)];
        assert!(is_left_out(&view(4, false), large(-31.0)));
        assert!(!is_left_out(&view(4, false), large(-29.0)));
        assert!(!is_left_out(&view(4, false), large(SIZE - 1.0)));
        assert!(is_left_out(&view(4, false), large(SIZE + 1.0)));
    }

    #[test]
    fn backs_are_left_out_where_only_fronts_are_drawn() {
        let back = [vec2(10.0, 10.0), vec2(30.0, 10.0), vec2(10.0, 30.0)];
        let [a, b, c] = back;
        assert!(is_left_out(&view(4, true), back) && !is_left_out(&view(4, false), back));
        assert!(!is_left_out(&view(4, true), [a, c, b]));
    }

    #[test]
    fn corners_nearer_than_the_near_plane_are_not_known() {
        let view = CoverageView::new(perspective_infinite_reverse(1.0, 1.0, 0.1), Vec2::splat(SIZE), 4, false, BITS);
        for z in [-0.05, 0.0, 1.0, f32::NAN] {
            assert_eq!(screen_corner(&view, vec3(0.0, 0.0, z)).reach, -1.0);
        }
        let seen = screen_corner(&view, vec3(0.0, 0.0, -1.0));
        assert!(seen.reach > SNAP && seen.reach < SNAP + 1e-3, "{seen:?}");
    }

    #[test]
    fn far_from_the_origin_corners_reach_further() {
        // A coordinate of 100,000 has steps of 1/128 there, a seventh of a px at this distance.
        let far = Vec3::splat(1e5);
        let clip = perspective_infinite_reverse(1.0, 1.0, 0.1) * Mat4::from_translation(-far);
        let view = CoverageView::new(clip, Vec2::splat(SIZE), 4, false, BITS);
        let reach = screen_corner(&view, far - vec3(0.0, 0.0, 3.0)).reach;
        assert!(reach > 0.15, "{reach}");
    }
}

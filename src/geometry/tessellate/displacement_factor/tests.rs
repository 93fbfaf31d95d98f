use super::*;
use glam::{Mat4, Vec4, vec3};

const VIEW: LodView = LodView::new(Mat4::IDENTITY, Vec2::splat(100.0));

#[test]
fn bounds_are_widened_by_what_displacement_may_move() {
    let spread = |view: &LodView, p: Vec3| {
        let bounds = widen(view, no_bounds(), p);
        [bounds.least.x, bounds.least.y, bounds.greatest.x, bounds.greatest.y, bounds.nearest]
    };
    let near = |own: [f32; 5], expected: [f32; 5]| {
        assert!(own.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6), "{own:?}, not {expected:?}");
    };
    let flat = VIEW.with_reach(0.1);
    near(spread(&flat, vec3(0.3, -0.2, 0.5)), [0.2, -0.3, 0.4, -0.1, 1.0]);
    // With perspective, a point at a depth of 2 may come as near as 1.6: it moves by 0.4 across, and by as much of its
    // place as it comes nearer.
    let mut clip_from_object = Mat4::IDENTITY;
    clip_from_object.z_axis = Vec4::new(0.0, 0.0, 0.0, 1.0);
    clip_from_object.w_axis = Vec4::new(0.0, 0.0, 0.01, 0.0);
    let perspective = LodView { clip_from_object, ..VIEW.with_reach(0.4) };
    let (across, up) = ((0.4 + 0.5 * 0.4) / 1.6, 0.4 / 1.6);
    near(spread(&perspective, vec3(1.0, 0.0, 2.0)), [0.5 - across, -up, 0.5 + across, up, 1.6]);
}

#[test]
fn heights_need_segments_for_their_detail_and_for_their_turning() {
    let view = VIEW.with_reach(0.5);
    let bounds = ScreenBounds { nearest: 1.0, least: Vec2::ZERO, greatest: Vec2::ZERO };
    let mut detail = [0.5; MAX_LEVELS];
    (detail[0], detail[1], detail[2]) = (0.0, 0.001, 0.01);
    // A length of 1 is 100 px across and 100 px up. Of a tolerance of 10 px, 3 px are for the detail, which is 2 px at
    // level 2 with the scale 1.4, and 4 px with 2.8.
    let factor = |turn, scale| displacement_factor(&view, bounds, 10.0, 64.0, turn, scale, detail);
    assert_eq!([factor(0.0, 1.4), factor(0.0, 2.8)], [64.0 / 4.0, 64.0 / 2.0]);
    assert_eq!(factor(0.0, 1400.0), 64.0, "each level loses too much");
    // 2 px of it are for the turning.
    let bend = 0.5 * 0.28125 * 20.0_f32.powi(2) * 100.0 * 2.0_f32.sqrt();
    let turning = factor(20.0, 1.4);
    assert!((turning - (bend / 2.0).sqrt()).abs() < 1e-3, "{turning}");
}

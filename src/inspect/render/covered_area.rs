//! The part of a picture that something can cover.

use glam::{DMat4, DVec3, DVec4, Mat4};

use geometry::mesh::Bounds;

/// Pixels of a picture: x, y, width and height. Nothing is in an area without width or height.
pub(super) type Area = [u32; 4];

/// How far the rounding of a vertex shader's four products and their sum may lie from the exact sum, relative to the sum of the
/// products' magnitudes, with some to spare.
const ROUNDING: f64 = 4.0 * f32::EPSILON as f64;
/// How far rasterisers move vertices at most, in px, with some to spare.
const SNAPPING: f64 = 1.0;

/// Returns an area that holds all pixels which anything within `bounds` covers in a picture of this width and height.
pub(super) fn covered_area(bounds: &Bounds, clip_from_object: Mat4, [width, height]: [u32; 2]) -> Area {
    let whole = [0, 0, width, height];
    let matrix = clip_from_object.as_dmat4();
    let magnitudes = DMat4::from_cols_array(&matrix.to_cols_array().map(f64::abs));
    let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
    let places: [DVec3; 8] =
        std::array::from_fn(|k| DVec3::select(glam::BVec3::new(k & 1 == 1, k & 2 == 2, k & 4 == 4), max, min));
    let error = places.map(|place| magnitudes * place.abs().extend(1.0)).into_iter().reduce(DVec4::max);
    let error = error.unwrap_or_default() * ROUNDING;
    let seen = seen_corners(places.map(|place| matrix * place.extend(1.0)), error);
    if seen.is_empty() {
        return [0; 4];
    }
    let Some([(left, right), (bottom, top)]) = extent(&seen, error) else { return whole };
    let range = |from: f64, to: f64, size: u32| {
        let px = |at: f64| (0.5 + 0.5 * at) * f64::from(size);
        let start = (px(from) - SNAPPING).floor().clamp(0.0, f64::from(size)) as u32;
        let end = (px(to) + SNAPPING).ceil().clamp(0.0, f64::from(size)) as u32;
        (start, end.saturating_sub(start))
    };
    let ((x, width), (y, height)) = (range(left, right, width), range(-top, -bottom, height));
    if width == 0 || height == 0 { [0; 4] } else { [x, y, width, height] }
}

/// Returns the least and the greatest x / w, and y / w, of corners in clip space that are off by up to `error`; `None` if w may be 0.
fn extent(corners: &[DVec4], error: DVec4) -> Option<[(f64, f64); 2]> {
    let mut extent = [(f64::INFINITY, f64::NEG_INFINITY); 2];
    for corner in corners {
        let [nearest, farthest] = [corner.w - error.w, corner.w + error.w];
        if nearest.is_nan() || nearest <= 0.0 {
            return None;
        }
        for (axis, (least, most)) in extent.iter_mut().enumerate() {
            let (low, high) = (corner[axis] - error[axis], corner[axis] + error[axis]);
            *least = least.min(low / nearest).min(low / farthest);
            *most = most.max(high / nearest).max(high / farthest);
        }
    }
    Some(extent)
}

/// Returns the corners in clip space of the part of a box that lies beyond the near plane, or all but for rounding. A corner's three
/// bits say which side of the box it is on, along each axis.
fn seen_corners(corners: [DVec4; 8], error: DVec4) -> Vec<DVec4> {
    // Depth is reversed: beyond the near plane, z is at most w.
    let beyond = corners.map(|corner| corner.w - corner.z + error.w + error.z);
    let mut seen: Vec<DVec4> = (0..8).filter(|&k| beyond[k] >= 0.0 || beyond[k].is_nan()).map(|k| corners[k]).collect();
    for (a, b) in (0..8_usize).flat_map(|a| [1, 2, 4].map(|bit| (a, a | bit))).filter(|(a, b)| a != b) {
        if (beyond[a] < 0.0) != (beyond[b] < 0.0) {
            seen.push(corners[a].lerp(corners[b], beyond[a] / (beyond[a] - beyond[b])));
        }
    }
    seen
}

/// Returns the least area that holds two.
pub(super) fn union(a: Area, b: Area) -> Area {
    if is_empty(a) || is_empty(b) {
        return if is_empty(a) { b } else { a };
    }
    let start = [a[0].min(b[0]), a[1].min(b[1])];
    let end = [(a[0] + a[2]).max(b[0] + b[2]), (a[1] + a[3]).max(b[1] + b[3])];
    [start[0], start[1], end[0] - start[0], end[1] - start[1]]
}

/// Returns what is in both of two areas.
pub(super) fn intersection(a: Area, b: Area) -> Area {
    let start = [a[0].max(b[0]), a[1].max(b[1])];
    let end = [(a[0] + a[2]).min(b[0] + b[2]), (a[1] + a[3]).min(b[1] + b[3])];
    if end[0] <= start[0] || end[1] <= start[1] {
        return [0; 4];
    }
    [start[0], start[1], end[0] - start[0], end[1] - start[1]]
}

pub(super) fn is_empty([_, _, width, height]: Area) -> bool {
    width == 0 || height == 0
}

#[cfg(test)]
mod tests {
    use glam::{Vec2, Vec3, vec3};

    use super::*;
    use crate::render::Camera;
    use geometry::view::project;

    const SIZE: [u32; 2] = [640, 400];

    fn holds([x, y, width, height]: Area, px: Vec2) -> bool {
        let inside = |at: f32, start: u32, size: u32| at >= start as f32 && at <= (start + size) as f32;
        inside(px.x, x, width) && inside(px.y, y, height)
    }

    #[test]
    fn an_area_holds_all_that_is_seen_of_a_box_and_little_more() {
        let all = Bounds::new([Vec3::splat(-1.0), Vec3::ONE].into_iter());
        let part = Bounds::new([vec3(0.1, 0.2, -0.3), vec3(0.4, 0.9, 0.2)].into_iter());
        let viewport = Vec2::new(SIZE[0] as f32, SIZE[1] as f32);
        let framed = Camera::framing(&all, viewport);
        // From afar, from so near that the box reaches behind the eye, and from within.
        for (distance, orthographic) in
            [(1.0, false), (0.3, false), (0.1, false), (0.01, false), (1.0, true), (0.05, true)]
        {
            let camera = Camera { distance: framed.distance * distance, target: part.center(), orthographic, ..framed };
            let matrix = camera.clip_from_object(viewport, &all);
            let area = covered_area(&part, matrix, SIZE);
            let mut seen = Vec::new();
            for k in 0..17 * 17 * 17 {
                let at = vec3((k % 17) as f32, (k / 17 % 17) as f32, (k / 289) as f32) / 16.0;
                let place = part.min + (part.max - part.min) * at;
                let clip = matrix * place.extend(1.0);
                let Some(px) = project(matrix, viewport, place).filter(|_| clip.z <= clip.w) else { continue };
                if px.cmpge(Vec2::ZERO).all() && px.cmple(viewport).all() {
                    assert!(holds(area, px), "{px} isn't in {area:?}, from {distance}");
                    seen.push(px);
                }
            }
            let (least, most) = seen.iter().fold((viewport, Vec2::ZERO), |(a, b), &px| (a.min(px), b.max(px)));
            let size = Vec2::new(area[2] as f32, area[3] as f32);
            // Places of the box are up to a sixteenth of it apart.
            assert!(
                ((most - least) * 1.25 + 4.0).cmpge(size).all(),
                "{area:?} around {least} to {most}, from {distance}"
            );
        }
    }

    #[test]
    fn what_is_out_of_view_covers_nothing() {
        let all = Bounds::new([Vec3::splat(-1.0), Vec3::ONE].into_iter());
        let viewport = Vec2::new(SIZE[0] as f32, SIZE[1] as f32);
        let camera = Camera { azimuth: 0.0, elevation: 0.0, ..Camera::framing(&all, viewport) };
        let matrix = camera.clip_from_object(viewport, &all);
        let around = |center: Vec3| Bounds::new([center - 0.5, center + 0.5].into_iter());
        for center in [camera.eye() + vec3(0.0, 0.0, 2.0), vec3(40.0, 0.0, 0.0), vec3(0.0, -40.0, 0.0)] {
            assert_eq!(covered_area(&around(center), matrix, SIZE), [0; 4], "{center}");
        }
        assert_eq!(covered_area(&all.grown(1e9), matrix, SIZE), [0, 0, SIZE[0], SIZE[1]]);
        let unknown = Bounds::new([Vec3::ZERO, Vec3::ONE].into_iter()).grown(f32::NAN);
        assert_eq!(covered_area(&unknown, matrix, SIZE), [0, 0, SIZE[0], SIZE[1]]);
    }

    #[test]
    fn areas_are_joined_and_cut() {
        let (a, b) = ([2, 3, 4, 5], [4, 1, 10, 3]);
        assert_eq!((union(a, b), intersection(a, b)), ([2, 1, 12, 7], [4, 3, 2, 1]));
        assert_eq!((union(a, [0; 4]), union([7, 7, 0, 3], b)), (a, b));
        assert_eq!(intersection(a, [6, 0, 10, 10]), [0; 4]);
    }
}

//! Points: which positions are one and the same place.

use std::collections::HashMap;

use glam::{Vec2, Vec3};

/// Points by exact position: two positions are one point when all three coordinates have the same value (-0 equals 0;
/// no tolerance). Points come in the order of their first appearance, with +0 for every zero.
///
/// Returns the points, and for each position the index of its point. Linear in expectation.
pub fn weld(positions: impl IntoIterator<Item = Vec3>) -> (Vec<Vec3>, Vec<u32>) {
    let mut ids: HashMap<[u32; 3], u32> = HashMap::new();
    let mut points = Vec::new();
    let point_of = positions
        .into_iter()
        .map(|position| {
            let point = plus_zero3(position);
            *ids.entry(point.to_array().map(f32::to_bits)).or_insert_with(|| {
                points.push(point);
                points.len() as u32 - 1
            })
        })
        .collect();
    (points, point_of)
}

/// The same value with +0 for -0, so that equal values have equal bits.
pub(super) fn plus_zero3(v: Vec3) -> Vec3 {
    // IEEE 754: -0 + +0 is +0; all else stays as it is.
    v + Vec3::ZERO
}

/// As [`plus_zero3`], for texture coordinates.
pub(super) fn plus_zero2(v: Vec2) -> Vec2 {
    v + Vec2::ZERO
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn minus_zero_is_zero() {
        let (points, of) = weld([Vec3::new(-0.0, 1.0, 2.0), Vec3::new(0.0, 1.0, 2.0)]);
        assert_eq!(of, [0, 0]);
        assert_eq!(points.len(), 1);
        assert_eq!(points[0].x.to_bits(), 0);
    }

    #[test]
    fn the_smallest_difference_keeps_points_apart() {
        let next = f32::from_bits(1.0_f32.to_bits() + 1);
        let (points, of) = weld([Vec3::ONE, Vec3::new(1.0, 1.0, next), Vec3::ONE]);
        assert_eq!((points.len(), of), (2, vec![0, 1, 0]));
    }

    proptest! {
        #[test]
        fn points_and_positions_agree(grid in prop::collection::vec((-2i8..2, -2i8..2, -2i8..2), 0..60)) {
            let positions: Vec<Vec3> = grid.iter().map(|&(x, y, z)| Vec3::new(x.into(), y.into(), z.into())).collect();
            let (points, of) = weld(positions.iter().copied());
            for (position, &point) in positions.iter().zip(&of) {
                prop_assert_eq!(*position, points[point as usize]);
            }
            for (i, a) in points.iter().enumerate() {
                prop_assert!(points[..i].iter().all(|b| b != a), "two points in one place");
            }
            let mut seen = 0;
            for point in of {
                prop_assert!(point <= seen, "not in order of first appearance");
                seen = seen.max(point + 1);
            }
        }
    }
}

//! Points: positions that are exactly equal are one.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use glam::Vec3;

/// Welded positions.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Welded {
    /// In order of first appearance, without -0.
    pub points: Vec<Vec3>,
    /// The point of each position.
    pub point_of: Vec<u32>,
}

/// The bits of a position, with -0 counted as 0.
pub fn position_bits(position: Vec3) -> [u32; 3] {
    // Adding 0 turns -0 into 0 and leaves every other number as it is.
    position.to_array().map(|x| (x + 0.0).to_bits())
}

/// Gives equal positions one point.
pub fn weld(positions: impl Iterator<Item = Vec3>) -> Welded {
    let mut welded = Welded::default();
    let mut known = HashMap::with_capacity(positions.size_hint().0);
    for position in positions {
        let point = match known.entry(position_bits(position)) {
            Entry::Occupied(entry) => *entry.get(),
            Entry::Vacant(entry) => {
                welded.points.push(position + 0.0);
                *entry.insert(welded.points.len() as u32 - 1)
            }
        };
        welded.point_of.push(point);
    }
    welded
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_positions_are_one_point_and_minus_zero_is_zero() {
        let positions =
            [Vec3::ZERO, Vec3::X, Vec3::new(-0.0, 0.0, -0.0), Vec3::X, Vec3::new(1.0 + f32::EPSILON, 0.0, 0.0)];
        let welded = weld(positions.into_iter());
        assert_eq!(welded.point_of, [0, 1, 0, 1, 2]);
        let first = weld([Vec3::new(-0.0, 1.0, -0.0)].into_iter());
        assert!(first.points[0].to_array().iter().all(|x| x.is_sign_positive()));
    }
}

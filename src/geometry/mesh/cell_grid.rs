//! Cells of a grid over space, and a hash for each.

use std::hash::BuildHasher;

use foldhash::fast::RandomState;
use glam::Vec3;

/// From here on, counted in cells from the origin, different f32 coordinates are at least 2^16 cells apart.
const FAR: f64 = (1_u64 << 40) as f64;

/// Room for rounding, in cells: below `FAR`, coordinates in cells are off by up to 2^-12.
const ROOM: f64 = 1e-3;

/// Cells as wide as a search needs.
///
/// Positions must have f32 coordinates. Then no coordinate overflows, however large positions are compared with the width of a
/// cell. The hash is another one in every run, so that no file can give all its points the same one; what is found must
/// not depend on it.
pub(super) struct CellGrid {
    /// 1 / the width of a cell.
    inverse: f64,
    hasher: RandomState,
}

impl CellGrid {
    /// The least width of a cell, in reaches of a search.
    pub(super) const LEAST_WIDTH: f64 = 2.01;

    /// Makes a grid of cells with a width above 0, in object units.
    pub(super) fn new(width: f64) -> Self {
        Self { inverse: width.recip(), hasher: RandomState::default() }
    }

    /// Returns the hash of a position's cell. Cells of different numbers are different ones.
    pub(super) fn at(&self, position: Vec3, number: u32) -> u32 {
        let [x, y, z] = (position.as_dvec3() * self.inverse).to_array().map(cell);
        self.hash(x, y, z, number)
    }

    /// Returns the cells of a number that may have positions within `reach` of a position, each as its hash after the square of its
    /// distance, in cells. The cell of the position comes first. Cells are at least `LEAST_WIDTH` reaches wide.
    #[inline(always)] // A call costs more than what the array holds.
    pub(super) fn near(&self, position: Vec3, number: u32) -> [(f64, u32); 8] {
        let [x, y, z] = (position.as_dvec3() * self.inverse).to_array().map(beside);
        std::array::from_fn(|i| {
            let [(away_x, x), (away_y, y), (away_z, z)] = [x[i & 1], y[i >> 1 & 1], z[i >> 2]];
            (away_x + away_y + away_z, self.hash(x, y, z, number))
        })
    }

    /// Returns the greatest squared distance, in cells, of a cell that may have positions within reach.
    pub(super) fn most(&self, reach: f64) -> f64 {
        let reach = reach * self.inverse + ROOM;
        reach * reach
    }

    fn hash(&self, x: u64, y: u64, z: u64, number: u32) -> u32 {
        (self.hasher.hash_one((x, y, z, number)) >> 32) as u32
    }
}

/// Makes a hash for tables of 32 bits of one, which tables keep to save memory: they need the highest and the lowest bits of 64.
pub(super) fn spread(hash: u32) -> u64 {
    // 2^64 / the golden ratio.
    u64::from(hash).wrapping_mul(0x9e37_79b9_7f4a_7c15)
}

/// Returns the cell of a coordinate, which is in cells.
fn cell(at: f64) -> u64 {
    let [(_, cell), _] = beside(at);
    cell
}

/// Returns the cell of a coordinate, which is in cells, and the nearer one beside it; the other one is out of reach. Each comes after
/// the square of its distance.
#[inline]
fn beside(at: f64) -> [(f64, u64); 2] {
    if at.abs() >= FAR {
        // Within reach there is no other coordinate.
        return [(0.0, at.to_bits()), (f64::INFINITY, at.to_bits())];
    }
    // The sum has no room for fractions: its lowest bits are those of the boundary between the two cells, a whole number.
    let sum = at + NO_FRACTION;
    let (boundary, above) = (sum - NO_FRACTION, sum.to_bits().wrapping_sub(NO_FRACTION.to_bits()));
    let is_below = u64::from(at < boundary);
    let away = at - boundary;
    [(0.0, above.wrapping_sub(is_below)), (away * away, above.wrapping_sub(1 - is_below))]
}

/// Around this number f64 numbers are 1 apart, for 2^51 to either side.
const NO_FRACTION: f64 = (3_u64 << 51) as f64;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_coordinate_lies_between_two_cells() {
        let mut random = fastrand::Rng::with_seed(1);
        let far = (0..20_000).map(|_| (random.f64() - 0.5) * f64::from(random.i32(-20..42)).exp2());
        let near = [0.0, -0.0, 0.5, -0.5, 1.0, 1.5, 2.5, -1.0, -2.5, 5e-324, -5e-324, 1.0 - f64::EPSILON, FAR - 0.5];
        for at in far.chain(near) {
            let within = at - at.floor();
            let (to, away) = if within < 0.5 { (-1, within) } else { (1, 1.0 - within) };
            let [(none, own), (square, next)] = beside(at);
            assert_eq!((none, own as i64, cell(at)), (0.0, at.floor() as i64, own), "{at}");
            // In the middle of a cell, one beside it is as good as the other.
            assert!(next as i64 == own as i64 + to || within == 0.5, "{at}: {next}");
            assert!((square - away * away).abs() < 1e-15, "{at}: {square}");
        }
        for at in [FAR, -FAR, 1e300] {
            assert_eq!(beside(at), [(0.0, at.to_bits()), (f64::INFINITY, at.to_bits())]);
        }
    }
}

//! Cells of a grid over space, and a hash for each that keeps neighbouring cells together.

use std::hash::BuildHasher;

use foldhash::fast::RandomState;
use glam::Vec3;

/// From here on, counted in cells from the origin, different f32 coordinates are at least 2^16 cells apart.
const FAR: f64 = (1_u64 << 40) as f64;

/// Room for rounding, in cells: below `FAR`, coordinates in cells are off by up to 2^-12.
const ROOM: f64 = 1e-3;

/// An odd number: 2^64 / the golden ratio.
const MIX: u64 = 0x9e37_79b9_7f4a_7c15;

/// Cells as wide as a search needs. The 64 cells of a block of 4 x 4 x 4 have hashes in a row, so that a search reads few places in
/// memory.
///
/// Positions must have f32 coordinates. Then no coordinate overflows, however large positions are compared with the width of a
/// cell. The hash is another one in every run, so that no file can give all its points the same one; what is found must
/// not depend on it.
pub(super) struct CellGrid {
    /// 1 / the width of a cell.
    inverse: f64,
    factors: [u64; 4],
}

/// The hash of a cell, for tables of any size.
#[derive(Clone, Copy)]
pub(super) struct CellHash {
    /// That of the block of cells.
    block: u64,
    /// Which of the block's 64 cells it is.
    within: u64,
}

impl CellHash {
    /// The number of cells in a block, and the least number of places in a table.
    pub(super) const BLOCK: usize = 64;

    /// Returns the cell's place in a table; the number of places is a power of two.
    pub(super) fn place(self, places: usize) -> usize {
        // Sums of products put blocks at equal distances to places at equal distances, which may lie close together.
        let mixed = (self.block ^ self.block >> 32).wrapping_mul(MIX);
        // Blocks that meet in a table have their cells in different orders.
        (mixed >> (u64::BITS - places.trailing_zeros()) ^ self.within) as usize
    }

    /// Returns a number that tells the cell from nearly all others.
    pub(super) fn tag(self) -> u32 {
        (self.block >> 8) as u32 & !63 | self.within as u32
    }

    /// Adds a cell's coordinate, whose two lowest bits have this place within the block.
    fn with(self, coordinate: u64, factor: u64, shift: u32) -> Self {
        let block = self.block.wrapping_add((coordinate >> 2).wrapping_mul(factor));
        Self { block, within: self.within | (coordinate & 3) << shift }
    }
}

impl CellGrid {
    /// The least width of a cell, in reaches of a search.
    pub(super) const LEAST_WIDTH: f64 = 2.01;

    /// Makes a grid of cells with a width above 0, in object units.
    pub(super) fn new(width: f64) -> Self {
        let hasher = RandomState::default();
        Self { inverse: width.recip(), factors: [0_u64, 1, 2, 3].map(|i| hasher.hash_one(i) | 1) }
    }

    /// Returns the cell of a position. Cells of different numbers are different ones.
    pub(super) fn at(&self, position: Vec3, number: u32) -> CellHash {
        let place = position.as_dvec3() * self.inverse;
        let [x, y, z] = [cell(place.x).0, cell(place.y).0, cell(place.z).0];
        self.start(number).with(z, self.factors[2], 4).with(y, self.factors[1], 2).with(x, self.factors[0], 0)
    }

    /// Returns the cells of a number that may have positions within `reach` of a position, each after the square of its distance, in
    /// cells. The cell of the position comes first. Cells are at least `LEAST_WIDTH` reaches wide.
    #[inline]
    pub(super) fn near(&self, position: Vec3, number: u32) -> [(f64, CellHash); 8] {
        let place = position.as_dvec3() * self.inverse;
        let [x, y, z] = [beside(place.x), beside(place.y), beside(place.z)];
        let start = self.start(number);
        let mut near = [(0.0, start); 8];
        for (i, (away_z, z)) in z.into_iter().enumerate() {
            let plane = start.with(z, self.factors[2], 4);
            for (j, (away_y, y)) in y.into_iter().enumerate() {
                let row = plane.with(y, self.factors[1], 2);
                for (k, (away_x, x)) in x.into_iter().enumerate() {
                    near[4 * i + 2 * j + k] = (away_z + away_y + away_x, row.with(x, self.factors[0], 0));
                }
            }
        }
        near
    }

    /// Returns the greatest squared distance, in cells, of a cell that may have positions within reach.
    pub(super) fn most(&self, reach: f64) -> f64 {
        let reach = reach * self.inverse + ROOM;
        reach * reach
    }

    /// Hashes by multiplication (Dietzfelbinger et al. 1997, "A reliable randomized algorithm for the closest-pair problem"):
    /// the highest bits of the sum of products with random odd numbers. This is the product for the number.
    fn start(&self, number: u32) -> CellHash {
        CellHash { block: u64::from(number).wrapping_mul(self.factors[3]), within: 0 }
    }
}

/// Returns the cell of a coordinate, which is in cells; and where in the cell it is, 0 to 1.
fn cell(at: f64) -> (u64, f64) {
    if at.abs() < FAR {
        let cell = floor(at);
        (cell as i64 as u64, at - cell)
    } else {
        (at.to_bits(), 0.5)
    }
}

/// Returns the cell of a coordinate, which is in cells, and the nearer one beside it; the other one is out of reach. Each comes after
/// the square of its distance.
fn beside(at: f64) -> [(f64, u64); 2] {
    let (cell, within) = cell(at);
    if at.abs() >= FAR {
        // Within reach there is no other coordinate.
        return [(0.0, cell), (f64::INFINITY, cell)];
    }
    let is_low = within < 0.5;
    let away = if is_low { within } else { 1.0 - within };
    let next = if is_low { cell.wrapping_sub(1) } else { cell.wrapping_add(1) };
    [(0.0, cell), (away * away, next)]
}

/// From here on all f64 numbers are whole.
const WHOLE: f64 = (1_u64 << 52) as f64;

/// Rounds down, as [`f64::floor`] does, which is a call of a function on processors that may lack the instruction. A zero
/// may have another sign.
pub(super) fn floor(x: f64) -> f64 {
    if x.abs() < WHOLE {
        let cut = x as i64 as f64;
        cut - f64::from(u8::from(cut > x))
    } else {
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_down() {
        let numbers =
            [0.0, 0.5, 1.0, 1.5, 7.999, 4e9, 4_503_599_627_370_495.5, 4_503_599_627_370_496.0, 1e300, f64::MAX];
        for x in numbers.into_iter().flat_map(|x| [x, -x]).chain([5e-324, -5e-324, f64::INFINITY, f64::NEG_INFINITY]) {
            assert_eq!(floor(x), x.floor());
        }
        assert!(floor(f64::NAN).is_nan());
    }

    #[test]
    fn the_cells_of_a_block_have_places_in_a_row() {
        let grid = CellGrid::new(0.5);
        for corner in [Vec3::ZERO, Vec3::splat(-2.0), Vec3::new(1e6, -64.0, 2.0)] {
            let cells = (0..64_u8).map(|i| Vec3::new(f32::from(i % 4), f32::from(i / 4 % 4), f32::from(i / 16)));
            let mut places: Vec<usize> = cells.map(|cell| grid.at(corner + 0.5 * cell, 3).place(1 << 20)).collect();
            places.sort_unstable();
            assert!(places[0].is_multiple_of(64) && places.windows(2).all(|pair| pair[1] == pair[0] + 1), "{places:?}");
        }
    }
}

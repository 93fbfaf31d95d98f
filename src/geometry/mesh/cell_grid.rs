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
        let [x, y, z] = [cell(place.x), cell(place.y), cell(place.z)];
        self.start(number).with(z, self.factors[2], 4).with(y, self.factors[1], 2).with(x, self.factors[0], 0)
    }

    /// Returns the cells of a number that may have positions within `reach` of a position, each after the square of its distance, in
    /// cells. The cell of the position comes first. Cells are at least `LEAST_WIDTH` reaches wide.
    #[inline(always)] // A call costs more than what the array holds.
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

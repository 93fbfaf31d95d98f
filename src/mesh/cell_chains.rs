//! Finds the items near a position without looking at all of them: items in the cells of a grid. Cells with the same hash share a
//! chain of items, so that no cell must be stored, and a search reads few places in memory.

use std::hash::BuildHasher;
use std::ops::ControlFlow;

use foldhash::fast::RandomState;
use glam::DVec3;

/// The number that ends a chain.
const NONE: u32 = u32::MAX;

/// The least number of chains: a power of two. Four cells side by side have chains side by side.
const LEAST: usize = 16;

/// Items are numbered from 0 on, in the order in which they are added. The caller keeps their positions, and a number for each;
/// items with different numbers are seldom in one chain. An item takes 8 to 16 bytes.
///
/// Cell coordinates are whole f64 numbers, and their bits are used where they don't fit an integer. So no coordinate overflows,
/// however large positions are compared with the width of a cell. The hash is another one in every run, so that no file can put
/// all its points into one chain; what is found doesn't depend on it.
pub(super) struct CellChains {
    /// The width of a cell, and 1 / that.
    width: f64,
    inverse: f64,
    /// The last item of each chain.
    last: Vec<u32>,
    /// For each item, the one before it in its chain.
    before: Vec<u32>,
    factors: [u64; 4],
}

impl CellChains {
    /// Makes an empty grid of cells with a width above 0, in object units, and room for so many items.
    pub(super) fn with_capacity(width: f64, items: usize) -> Self {
        let hasher = RandomState::default();
        Self {
            width,
            inverse: width.recip(),
            last: vec![NONE; items.next_power_of_two().max(LEAST)],
            before: Vec::with_capacity(items),
            factors: [0_u64, 1, 2, 3].map(|i| hasher.hash_one(i) | 1),
        }
    }

    /// Adds the next item, with its position and number. `of` must return those of each item before it.
    pub(super) fn push(&mut self, (place, number): (DVec3, u32), of: impl Fn(u32) -> (DVec3, u32)) {
        if self.before.len() == self.last.len() {
            self.grow(of);
        }
        let item = self.before.len() as u32;
        let chain = self.chain_at(place, number);
        self.before.push(std::mem::replace(&mut self.last[chain], item));
    }

    /// Doubles the number of chains.
    fn grow(&mut self, of: impl Fn(u32) -> (DVec3, u32)) {
        let chains = 2 * self.last.len();
        // The old list is freed before the new one is allocated.
        self.last = Vec::new();
        self.last = vec![NONE; chains];
        for item in 0..self.before.len() {
            let (place, number) = of(item as u32);
            let chain = self.chain_at(place, number);
            self.before[item] = std::mem::replace(&mut self.last[chain], item as u32);
        }
    }

    /// Calls `visit` with all items of this number that may lie within `reach` of a position, until it breaks; and with some
    /// others. An item may come several times. `visit` may lessen the reach for the items that follow, which are then in nearby
    /// cells mostly. `reach` is at most half of the width of a cell.
    pub(super) fn near(
        &self,
        (place, number): (DVec3, u32),
        mut reach: f64,
        mut visit: impl FnMut(u32, &mut f64) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let [x, y, z] = place.to_array().map(|at| self.touched(at, reach));
        let [_, of_y, of_z, of_number] = self.factors;
        let number = u64::from(number).wrapping_mul(of_number);
        for &(z, beyond_z) in z.cells() {
            let plane = number.wrapping_add(z.wrapping_mul(of_z));
            for &(y, beyond_y) in y.cells() {
                let (row, beyond) = (plane.wrapping_add(y.wrapping_mul(of_y)), beyond_z + beyond_y);
                for &(x, beyond_x) in x.cells() {
                    // With room for rounding: between f32 numbers within reach of each other, borders of cells are off by 1e-8 of it.
                    if beyond + beyond_x > reach * reach * (1.0 + 1e-6) {
                        continue;
                    }
                    let mut next = self.last[self.chain(row, x)];
                    while next != NONE {
                        visit(next, &mut reach)?;
                        next = self.before[next as usize];
                    }
                }
            }
        }
        ControlFlow::Continue(())
    }

    /// Returns the cells within reach along one axis, that of the position first. There may be three, since rounding can put the
    /// outer two cells two apart.
    fn touched(&self, at: f64, reach: f64) -> Touched {
        let [low, middle, high] = [self.cell(at - reach), self.cell(at), self.cell(at + reach)];
        let mut touched = Touched { cells: [(key(middle), 0.0); 3], count: 1 };
        if low != middle {
            touched.push(low, at - middle * self.width);
        }
        if high != middle {
            touched.push(high, (middle + 1.0) * self.width - at);
        }
        touched
    }

    fn cell(&self, at: f64) -> f64 {
        floor(at * self.inverse)
    }

    fn chain_at(&self, place: DVec3, number: u32) -> usize {
        let [x, y, z] = [place.x, place.y, place.z].map(|at| key(self.cell(at)));
        let [_, of_y, of_z, of_number] = self.factors;
        let products = [u64::from(number).wrapping_mul(of_number), z.wrapping_mul(of_z), y.wrapping_mul(of_y)];
        self.chain(products.into_iter().fold(0, u64::wrapping_add), x)
    }

    /// Hashes by multiplication (Dietzfelbinger et al. 1997, "A reliable randomized algorithm for the closest-pair problem"):
    /// the highest bits of the sum of products with random odd numbers. `row` is the sum for all but the first coordinate.
    fn chain(&self, row: u64, x: u64) -> usize {
        let sum = row.wrapping_add((x >> 2).wrapping_mul(self.factors[0]));
        let blocks = self.last.len() / 4;
        (sum >> (u64::BITS - blocks.trailing_zeros())) as usize * 4 + (x & 3) as usize
    }
}

/// Up to three cells along an axis: the key of each, and the square of how far away it begins.
struct Touched {
    cells: [(u64, f64); 3],
    count: usize,
}

impl Touched {
    fn push(&mut self, cell: f64, away: f64) {
        self.cells[self.count] = (key(cell), away * away);
        self.count += 1;
    }

    fn cells(&self) -> &[(u64, f64)] {
        &self.cells[..self.count]
    }
}

/// Returns the key of a cell's coordinate, a whole number: the same for equal ones, since adding 0 turns -0 into +0.
fn key(cell: f64) -> u64 {
    if cell.abs() < WHOLE { cell as i64 as u64 } else { (cell + 0.0).to_bits() }
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
    use proptest::prelude::*;

    use super::*;

    fn put(places: &[DVec3], width: f64) -> CellChains {
        let mut chains = CellChains::with_capacity(width, 0);
        places.iter().for_each(|&place| chains.push((place, 7), |item| (places[item as usize], 7)));
        chains
    }

    fn found(chains: &CellChains, place: DVec3, reach: f64) -> Vec<usize> {
        let mut found = Vec::new();
        let end = chains.near((place, 7), reach, |item, _| {
            found.push(item as usize);
            ControlFlow::Continue(())
        });
        assert!(end.is_continue());
        found.sort_unstable();
        found.dedup();
        found
    }

    #[test]
    fn no_cell_overflows() {
        for (place, reach) in [(0.0, 1.0), (-0.0, 1e-30), (1e30, 1e-30), (-3e38, 1e-45), (1e-45, 3e38), (5.0, 1.0)] {
            let places = [DVec3::splat(place)];
            assert_eq!(found(&put(&places, 2.0 * reach), places[0], reach), [0], "{place} within {reach}");
        }
        assert_eq!(found(&put(&[DVec3::ONE], f64::INFINITY), DVec3::ZERO, f64::INFINITY), [0]);
    }

    /// Points on a line along each axis, and far apart: where a poor hash would put them into few chains.
    #[test]
    fn chains_stay_short() {
        let step = f64::from(1 << 20);
        let along = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE, DVec3::X * step, DVec3::Y * step, DVec3::Z * step];
        for along in along {
            let places: Vec<DVec3> = (0..20_000).map(|i| along * f64::from(i)).collect();
            let chains = put(&places, 0.5);
            let visited: usize = places
                .iter()
                .map(|&place| {
                    let mut count = 0;
                    let _ = chains.near((place, 7), 0.25, |_, _| {
                        count += 1;
                        ControlFlow::Continue(())
                    });
                    count
                })
                .sum();
            // Eight cells at most, and about one item a chain.
            assert!(visited < 40 * places.len(), "{along}: {visited}");
        }
    }

    #[test]
    fn a_search_ends_where_it_is_told() {
        let places = [DVec3::ONE; 9];
        let mut left = 4;
        let end = put(&places, 1.0).near((DVec3::ONE, 7), 0.5, |_, _| {
            left -= 1;
            if left > 0 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        assert_eq!((end, left), (ControlFlow::Break(()), 0));
    }

    #[test]
    fn numbers_are_rounded_down() {
        let numbers =
            [0.0, 0.5, 1.0, 1.5, 7.999, 4e9, 4_503_599_627_370_495.5, 4_503_599_627_370_496.0, 1e300, f64::MAX];
        for x in numbers.into_iter().flat_map(|x| [x, -x]).chain([5e-324, -5e-324, f64::INFINITY, f64::NEG_INFINITY]) {
            assert_eq!(floor(x), x.floor());
        }
        assert!(floor(f64::NAN).is_nan());
    }

    proptest! {
        #[test]
        fn all_items_within_reach_are_found(
            places in prop::collection::vec(prop::array::uniform3(-40_i32..40), 1..40),
            reach in 1_u32..9,
            wider in 1_u32..4,
            scale in -120_i32..120,
        ) {
            // Whole numbers times a power of two: many positions lie on the boundaries of cells.
            let scale = f64::from(scale).exp2();
            let reach = f64::from(reach) * scale;
            let places = places.iter().map(|p| DVec3::from(p.map(f64::from)) * scale).collect::<Vec<_>>();
            let chains = put(&places, 2.0 * f64::from(wider) * reach);
            for &place in &places {
                // A reach that shrinks to the nearest other item finds that one.
                let (mut nearest, least) = (f64::INFINITY, |least: f64, other: &DVec3| {
                    if *other == place { least } else { least.min(other.distance(place)) }
                });
                let _ = chains.near((place, 7), reach, |item, left| {
                    nearest = least(nearest, &places[item as usize]);
                    *left = left.min(nearest);
                    ControlFlow::Continue(())
                });
                let expected = places.iter().fold(f64::INFINITY, least);
                prop_assert!(nearest == expected || expected > reach, "{nearest} instead of {expected}");
                let found = found(&chains, place, reach);
                for (i, other) in places.iter().enumerate() {
                    let apart = other.distance(place);
                    prop_assert!(apart > reach || found.contains(&i), "missed at {apart}");
                }
            }
        }
    }
}

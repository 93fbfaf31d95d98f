//! Finds the items near a position without looking at all of them: items in the cells of a grid.

use std::hash::BuildHasher;
use std::ops::ControlFlow;

use foldhash::fast::RandomState;
use glam::{DVec3, Vec3};
use hashbrown::HashTable;
use hashbrown::hash_table::Entry;

use crate::casts::to_u32;

/// From here on, counted in cells from the origin, different f32 coordinates are at least 2^16 cells apart.
const FAR: f64 = (1_u64 << 40) as f64;

/// Room for rounding, in cells: below `FAR`, coordinates in cells are off by up to 2^-12.
const ROOM: f64 = 1e-3;

/// The number that ends a chain.
const NONE: u32 = u32::MAX;

/// Items with a position and a number each. Items are numbered from 0 on, in the order in which they are added. An item takes 26 to
/// 41 bytes at most, and less where cells have several.
///
/// Positions must have f32 coordinates. Then no coordinate overflows, however large positions are compared with the width of a
/// cell. The hash of a cell is another one in every run, so that no file can give all its points the same one; what is found must
/// not depend on it.
pub(super) struct CellChains {
    /// 1 / the width of a cell.
    inverse: f64,
    hasher: RandomState,
    /// For each cell that has items, the last one. Cells with the same hash count as one.
    cells: HashTable<Chain>,
    items: Vec<Item>,
    /// The number of each item; empty while all are 0.
    numbers: Vec<u32>,
}

/// The items of a cell.
struct Chain {
    cell: u32,
    last: u32,
}

/// An item of a chain.
struct Item {
    position: Vec3,
    /// The item before it.
    before: u32,
}

impl CellChains {
    /// The least width of a cell, in reaches of a search.
    pub(super) const LEAST_WIDTH: f64 = 2.01;

    /// Makes an empty grid of cells with a width above 0, in object units, and room for so many items.
    pub(super) fn with_capacity(width: f64, items: usize) -> Self {
        Self {
            inverse: width.recip(),
            hasher: RandomState::default(),
            cells: HashTable::with_capacity(items),
            items: Vec::with_capacity(items),
            numbers: Vec::new(),
        }
    }

    /// Adds the next item, and returns which one it is.
    pub(super) fn push(&mut self, position: Vec3, number: u32) -> u32 {
        let item = to_u32(self.items.len());
        if number != 0 || !self.numbers.is_empty() {
            self.numbers.resize(self.items.len(), 0);
            self.numbers.push(number);
        }
        let [x, y, z] = (position.as_dvec3() * self.inverse).to_array().map(cell);
        let cell = self.hash(x, y, z, number);
        let before = match self.cells.entry(spread(cell), |chain| chain.cell == cell, |chain| spread(chain.cell)) {
            Entry::Occupied(mut there) => std::mem::replace(&mut there.get_mut().last, item),
            Entry::Vacant(free) => {
                free.insert(Chain { cell, last: item });
                NONE
            }
        };
        self.items.push(Item { position, before });
        item
    }

    /// Returns the hash of a cell. Cells of different numbers are different ones.
    fn hash(&self, x: u64, y: u64, z: u64, number: u32) -> u32 {
        (self.hasher.hash_one((x, y, z, number)) >> 32) as u32
    }

    /// Returns the cells of a number that may have positions near a position, each as its hash after the square of its distance, in
    /// cells. The cell of the position comes first.
    #[inline(always)] // A call costs more than what the array holds.
    fn cells_near(&self, position: Vec3, number: u32) -> [(f64, u32); 8] {
        let [x, y, z] = (position.as_dvec3() * self.inverse).to_array().map(beside);
        std::array::from_fn(|i| {
            let [(away_x, x), (away_y, y), (away_z, z)] = [x[i & 1], y[i >> 1 & 1], z[i >> 2]];
            (away_x + away_y + away_z, self.hash(x, y, z, number))
        })
    }

    /// Returns the last item of a cell.
    fn last(&self, cell: u32) -> u32 {
        self.cells.find(spread(cell), |chain| chain.cell == cell).map_or(NONE, |chain| chain.last)
    }

    fn number(&self, item: u32) -> u32 {
        self.numbers.get(item as usize).copied().unwrap_or_default()
    }

    /// Returns the square of the distance between an item and a place, in f64; none if there is no such item, or it has another
    /// number.
    pub(super) fn square(&self, item: u32, place: DVec3, number: u32) -> Option<f64> {
        let at = self.items.get(item as usize)?;
        (self.number(item) == number).then(|| at.position.as_dvec3().distance_squared(place))
    }

    /// Calls `visit` with all items of this number that may lie within `reach` of a position, until it breaks; and with some
    /// others. They come with the square of their distance. `visit` may lessen the reach for the items that follow, which are then in
    /// nearby cells mostly. Cells are at least [`Self::LEAST_WIDTH`] reaches wide.
    pub(super) fn near(
        &self,
        position: Vec3,
        number: u32,
        mut reach: f64,
        mut visit: impl FnMut(u32, f64, &mut f64) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        // The greatest squared distance, in cells, of a cell that may have positions within reach.
        let within = |reach: f64| (reach * self.inverse + ROOM).powi(2);
        let (place, mut most) = (position.as_dvec3(), within(reach));
        for (away, cell) in self.cells_near(position, number) {
            let mut next = if away > most { NONE } else { self.last(cell) };
            while next != NONE {
                let item = &self.items[next as usize];
                if self.number(next) == number {
                    visit(next, item.position.as_dvec3().distance_squared(place), &mut reach)?;
                    most = within(reach);
                }
                next = item.before;
            }
        }
        ControlFlow::Continue(())
    }

    /// Returns the positions of all items.
    pub(super) fn into_positions(self) -> Vec<Vec3> {
        self.items.into_iter().map(|item| item.position).collect()
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
    use proptest::prelude::*;

    use super::*;

    fn put(places: &[Vec3], width: f64) -> CellChains {
        let mut chains = CellChains::with_capacity(width, 0);
        for (i, &place) in places.iter().enumerate() {
            assert_eq!(chains.push(place, 7), i as u32);
        }
        chains
    }

    fn found(chains: &CellChains, place: Vec3, reach: f64) -> Vec<usize> {
        let mut found = Vec::new();
        let end = chains.near(place, 7, reach, |item, _, _| {
            found.push(item as usize);
            ControlFlow::Continue(())
        });
        assert!(end.is_continue());
        found.sort_unstable();
        found
    }

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
    fn no_cell_overflows() {
        for (place, reach) in [(0.0, 1.0), (-0.0, 1e-30), (1e30, 1e-30), (-3e38, 1e-45), (1e-45, 3e38), (5.0, 1.0)] {
            let places = [Vec3::splat(place)];
            let chains = put(&places, CellChains::LEAST_WIDTH * reach);
            assert_eq!(found(&chains, places[0], reach), [0], "{place} within {reach}");
        }
        assert_eq!(found(&put(&[Vec3::ONE], f64::INFINITY), Vec3::ZERO, f64::INFINITY), [0]);
    }

    /// Points on a line along each axis, and far apart: where a poor hash would put them into few chains.
    #[test]
    fn chains_stay_short() {
        let step = (1 << 20) as f32;
        let along = [Vec3::X, Vec3::Y, Vec3::Z, Vec3::ONE, Vec3::X * step, Vec3::Y * step, Vec3::Z * step];
        for along in along {
            let places: Vec<Vec3> = (0..20_000_u16).map(|i| along * f32::from(i)).collect();
            let chains = put(&places, 0.51);
            let mut visited = 0;
            for &place in &places {
                assert!(found(&chains, place, 0.25).len() < 9);
                visited += found(&chains, place, 0.25).len();
            }
            // Each cell has one item, and hardly any two have the same hash.
            assert!(visited < places.len() + places.len() / 100, "{along}: {visited}");
        }
    }

    #[test]
    fn a_search_ends_where_it_is_told() {
        let places = [Vec3::ONE; 9];
        let mut left = 4;
        let end = put(&places, 1.01).near(Vec3::ONE, 7, 0.5, |_, _, _| {
            left -= 1;
            if left > 0 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        assert_eq!((end, left), (ControlFlow::Break(()), 0));
    }

    #[test]
    fn items_with_another_number_are_not_visited() {
        let mut chains = CellChains::with_capacity(3.0, 2);
        let items = [0, 5, 0, 7].map(|number| chains.push(Vec3::ONE, number));
        assert_eq!(items, [0, 1, 2, 3]);
        for (number, expected) in [(0, &[2, 0][..]), (5, &[1]), (7, &[3]), (8, &[])] {
            let mut found = Vec::new();
            let _ = chains.near(Vec3::ONE, number, 1.0, |item, square, _| {
                found.push(item);
                assert_eq!(square, 0.0);
                ControlFlow::Continue(())
            });
            assert_eq!(found, expected, "{number}");
        }
        assert_eq!(chains.into_positions(), [Vec3::ONE; 4]);
    }

    proptest! {
        #[test]
        fn all_items_within_reach_are_found(
            places in prop::collection::vec(prop::array::uniform3(-40_i32..40), 1..40),
            reach in 1_u32..9,
            wider in 1_u32..4,
            far in any::<bool>(),
            scale in -100_i32..40,
        ) {
            // Whole numbers times a power of two: many positions lie on the boundaries of cells. Or some are far away.
            let scale = f64::from(scale).exp2();
            let reach = f64::from(reach) * scale;
            let far = |i: usize| if far && i.is_multiple_of(3) { 1e20_f32 } else { 1.0 };
            let place = |(i, p): (usize, &[i32; 3])| (DVec3::from(p.map(f64::from)) * scale).as_vec3() * far(i);
            let places = places.iter().enumerate().map(place).collect::<Vec<_>>();
            let chains = put(&places, CellChains::LEAST_WIDTH * f64::from(wider) * reach);
            for &place in &places {
                // A reach that shrinks to the nearest other item finds that one.
                let away = |other: &Vec3| other.as_dvec3().distance(place.as_dvec3());
                let (mut nearest, least) = (f64::INFINITY, |least: f64, other: &Vec3| {
                    if *other == place { least } else { least.min(away(other)) }
                });
                let _ = chains.near(place, 7, reach, |item, square, left| {
                    nearest = least(nearest, &places[item as usize]);
                    assert_eq!(square.sqrt(), away(&places[item as usize]));
                    *left = left.min(nearest);
                    ControlFlow::Continue(())
                });
                let expected = places.iter().fold(f64::INFINITY, least);
                prop_assert!(nearest == expected || expected > reach, "{nearest} instead of {expected}");
                let found = found(&chains, place, reach);
                for (i, other) in places.iter().enumerate() {
                    prop_assert!(away(other) > reach || found.contains(&i), "missed at {}", away(other));
                }
            }
        }
    }
}

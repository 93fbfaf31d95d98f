//! A spatial hash: finds the items near a position without looking at all of them.

use std::hash::BuildHasher;

use foldhash::fast::RandomState;
use glam::DVec3;
use hashbrown::HashTable;
use hashbrown::hash_table::Entry;

/// For each occupied cell of space, the number of the item that was added last. The caller keeps the items' positions
/// and passes a function that returns them, so that a cell takes only 5 to 12 bytes.
///
/// Cell coordinates are f64 numbers and never become integers. So no coordinate overflows, however large positions are
/// compared with the reach, and different f32 positions never share a cell for lack of digits.
pub(super) struct SpatialHash {
    reach: f64,
    cells: HashTable<u32>,
    hasher: RandomState,
}

impl SpatialHash {
    /// Makes an empty table for queries within `reach` (above 0, in object units). Cells are two reaches wide.
    pub(super) fn new(reach: f64) -> Self {
        Self { reach, cells: HashTable::new(), hasher: RandomState::default() }
    }

    /// Returns the item in the cell of a position.
    pub(super) fn at(&self, place: DVec3, place_of: impl Fn(u32) -> DVec3) -> Option<u32> {
        self.find(self.key(place), &place_of)
    }

    /// Adds an item to the cell of its position. Returns the item that the cell had before.
    pub(super) fn put(&mut self, id: u32, place_of: impl Fn(u32) -> DVec3) -> Option<u32> {
        let Self { reach, cells, hasher } = self;
        let key = |id: u32| key(cell(*reach, place_of(id)));
        let own = key(id);
        match cells.entry(hasher.hash_one(own), |&id| key(id) == own, |&id| hasher.hash_one(key(id))) {
            Entry::Occupied(mut there) => Some(std::mem::replace(there.get_mut(), id)),
            Entry::Vacant(free) => {
                free.insert(id);
                None
            }
        }
    }

    /// Returns the items of all cells that reach within `reach` of a position: up to 27 cells, but usually 8.
    pub(super) fn near(&self, place: DVec3, place_of: impl Fn(u32) -> DVec3) -> impl Iterator<Item = u32> {
        let [x, y, z] = place.to_array().map(|x| self.touched(x));
        let cells = (0..27).filter_map(move |i| Some([x[i / 9]?, y[i / 3 % 3]?, z[i % 3]?]));
        cells.filter_map(move |cell| self.find(key(cell), &place_of))
    }

    fn find(&self, own: CellKey, place_of: &impl Fn(u32) -> DVec3) -> Option<u32> {
        self.cells.find(self.hasher.hash_one(own), |&id| self.key(place_of(id)) == own).copied()
    }

    fn key(&self, place: DVec3) -> CellKey {
        key(cell(self.reach, place))
    }

    /// Returns the cells within reach along one axis, each once. The middle cell is included because rounding can put
    /// the outer two cells two apart.
    fn touched(&self, x: f64) -> [Option<f64>; 3] {
        let [low, middle, high] = [x - self.reach, x, x + self.reach].map(|x| cell_along(self.reach, x));
        [Some(low), (middle != low).then_some(middle), (high != middle).then_some(high)]
    }
}

fn cell(reach: f64, place: DVec3) -> [f64; 3] {
    place.to_array().map(|x| cell_along(reach, x))
}

fn cell_along(reach: f64, x: f64) -> f64 {
    floor(x / (2.0 * reach))
}

/// Rounds down, as [`f64::floor`] does, which is a call of a function on processors that may lack the instruction. A zero
/// may have another sign.
fn floor(x: f64) -> f64 {
    /// From here on all numbers are whole.
    const WHOLE: f64 = (1_u64 << 52) as f64;
    if x.abs() < WHOLE {
        let cut = x as i64 as f64;
        cut - f64::from(u8::from(cut > x))
    } else {
        x
    }
}

/// The bits of a cell's coordinates: three words, which foldhash hashes several times faster than an array.
type CellKey = (u64, u64, u64);

/// Returns the key of a cell, which is the same for equal cells: adding 0 turns -0 into +0.
fn key(cell: [f64; 3]) -> CellKey {
    let [x, y, z] = cell.map(|x| (x + 0.0).to_bits());
    (x, y, z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Positions of items, the table, and for each item the one before it in its cell.
    struct Put<'a>(&'a [DVec3], SpatialHash, Vec<Option<u32>>);

    fn put(places: &[DVec3], reach: f64) -> Put<'_> {
        let mut grid = SpatialHash::new(reach);
        let before = (0..places.len()).map(|id| grid.put(id as u32, |id| places[id as usize])).collect();
        Put(places, grid, before)
    }

    fn found(Put(places, grid, before): &Put, place: DVec3) -> Vec<usize> {
        let cells = grid.near(place, |id| places[id as usize]);
        let all = cells.flat_map(|latest| std::iter::successors(Some(latest), |&id| before[id as usize]));
        let mut found = all.map(|id| id as usize).collect::<Vec<_>>();
        found.sort_unstable();
        found
    }

    #[test]
    fn no_cell_is_visited_twice_and_none_overflows() {
        for (place, reach) in [(0.0, 1.0), (-0.0, 1e-30), (1e30, 1e-30), (-3e38, 1e-45), (1e-45, 3e38), (5.0, 1.0)] {
            let places = [DVec3::splat(place)];
            assert_eq!(found(&put(&places, reach), places[0]), [0], "{place} within {reach}");
        }
    }

    #[test]
    fn distant_positions_are_not_near_however_small_the_reach() {
        let places = [DVec3::splat(1e30)];
        assert_eq!(found(&put(&places, 1e-45), DVec3::splat(f64::from(1e30_f32.next_up()))), [0; 0]);
    }

    #[test]
    fn a_cell_holds_the_latest_item_and_returns_the_one_before() {
        let places = [0.1, 0.2, 7.0, 0.3].map(DVec3::splat);
        let Put(_, grid, before) = put(&places, 1.0);
        assert_eq!(before, [None, Some(0), None, Some(1)]);
        assert_eq!(
            [0.0, 7.5, -3.0].map(|x| grid.at(DVec3::splat(x), |id| places[id as usize])),
            [Some(3), Some(2), None]
        );
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
            scale in -120_i32..120,
        ) {
            // Whole numbers times a power of two: many positions lie on the boundaries of cells.
            let scale = f64::from(scale).exp2();
            let reach = f64::from(reach) * scale;
            let places = places.iter().map(|p| DVec3::from(p.map(f64::from)) * scale).collect::<Vec<_>>();
            let grid = put(&places, reach);
            for &place in &places {
                let found = found(&grid, place);
                prop_assert!(found.windows(2).all(|pair| pair[0] < pair[1]), "found twice");
                for (i, other) in places.iter().enumerate() {
                    let apart = (*other - place).abs().max_element();
                    prop_assert!(apart > reach || found.contains(&i), "missed at {apart}");
                    prop_assert!(apart < 4.0 * reach || !found.contains(&i), "nothing near at {apart}");
                }
            }
        }
    }
}

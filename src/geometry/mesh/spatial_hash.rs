//! A spatial hash: finds the items in the cell of a position.

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

    fn find(&self, own: CellKey, place_of: &impl Fn(u32) -> DVec3) -> Option<u32> {
        self.cells.find(self.hasher.hash_one(own), |&id| self.key(place_of(id)) == own).copied()
    }

    fn key(&self, place: DVec3) -> CellKey {
        key(cell(self.reach, place))
    }
}

fn cell(reach: f64, place: DVec3) -> [f64; 3] {
    place.to_array().map(|x| cell_along(reach, x))
}

fn cell_along(reach: f64, x: f64) -> f64 {
    floor(x / (2.0 * reach))
}

/// From here on all f64 numbers are whole.
const WHOLE: f64 = (1_u64 << 52) as f64;

/// Rounds down, as [`f64::floor`] does, which is a call of a function on processors that may lack the instruction. A zero
/// may have another sign.
fn floor(x: f64) -> f64 {
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
    fn no_cell_overflows_and_distant_positions_have_others() {
        for (place, reach) in [(0.0, 1.0), (-0.0, 1e-30), (1e30, 1e-30), (-3e38, 1e-45), (1e-45, 3e38), (5.0, 1.0)] {
            let places = [DVec3::splat(place)];
            let mut grid = SpatialHash::new(reach);
            assert_eq!(grid.put(0, |id| places[id as usize]), None);
            assert_eq!(grid.at(places[0], |id| places[id as usize]), Some(0), "{place} within {reach}");
        }
        let mut grid = SpatialHash::new(1e-45);
        grid.put(0, |_| DVec3::splat(1e30));
        assert_eq!(grid.at(DVec3::splat(f64::from(1e30_f32.next_up())), |_| DVec3::splat(1e30)), None);
    }

    #[test]
    fn a_cell_holds_the_latest_item_and_returns_the_one_before() {
        let places = [0.1, 0.2, 7.0, 0.3].map(DVec3::splat);
        let mut grid = SpatialHash::new(1.0);
        let before: Vec<_> = (0..4).map(|id| grid.put(id, |id| places[id as usize])).collect();
        assert_eq!(before, [None, Some(0), None, Some(1)]);
        assert_eq!(
            [0.0, 7.5, -3.0].map(|x| grid.at(DVec3::splat(x), |id| places[id as usize])),
            [Some(3), Some(2), None]
        );
    }
}

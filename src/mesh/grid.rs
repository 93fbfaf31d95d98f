//! A grid over space: what lies within reach of a place, without looking at everything.

use std::hash::BuildHasher;

use foldhash::fast::RandomState;
use glam::DVec3;
use hashbrown::HashTable;
use hashbrown::hash_table::Entry;

/// For each cell of space the latest thing that was put there, by its number. Where things lie is asked of whoever has them, so
/// that a cell takes no more than 5 to 12 bytes.
///
/// Cells are counted in f64 and are never turned into integers: however large coordinates are beside the reach, no
/// count overflows, and different f32 positions never end up in one cell for want of digits.
pub(super) struct Grid {
    reach: f64,
    cells: HashTable<u32>,
    hasher: RandomState,
}

impl Grid {
    /// A grid for questions about what lies within `reach` (above 0), in object units. Cells are two reaches wide.
    pub fn new(reach: f64) -> Self {
        Self { reach, cells: HashTable::new(), hasher: RandomState::default() }
    }

    /// What is in the cell around a place.
    pub fn at(&self, place: DVec3, place_of: impl Fn(u32) -> DVec3) -> Option<u32> {
        self.find(self.key(place), &place_of)
    }

    /// Puts a thing where it lies. What was there before.
    pub fn put(&mut self, id: u32, place_of: impl Fn(u32) -> DVec3) -> Option<u32> {
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

    /// What is in the cells that hold all that is within reach of a place: up to 27 but mostly 8.
    pub fn near(&self, place: DVec3, place_of: impl Fn(u32) -> DVec3) -> impl Iterator<Item = u32> {
        let [x, y, z] = place.to_array().map(|x| self.touched(x));
        let cells = (0..27).filter_map(move |i| Some([x[i / 9]?, y[i / 3 % 3]?, z[i % 3]?]));
        cells.filter_map(move |cell| self.find(key(cell), &place_of))
    }

    fn find(&self, own: [u64; 3], place_of: &impl Fn(u32) -> DVec3) -> Option<u32> {
        self.cells.find(self.hasher.hash_one(own), |&id| self.key(place_of(id)) == own).copied()
    }

    fn key(&self, place: DVec3) -> [u64; 3] {
        key(cell(self.reach, place))
    }

    /// The cells within reach along one axis, each once. The middle one is listed too: rounding can put the outer ones
    /// two apart.
    fn touched(&self, x: f64) -> [Option<f64>; 3] {
        let [low, middle, high] = [x - self.reach, x, x + self.reach].map(|x| cell_along(self.reach, x));
        [Some(low), (middle != low).then_some(middle), (high != middle).then_some(high)]
    }
}

fn cell(reach: f64, place: DVec3) -> [f64; 3] {
    place.to_array().map(|x| cell_along(reach, x))
}

fn cell_along(reach: f64, x: f64) -> f64 {
    (x / (2.0 * reach)).floor()
}

/// Equal cells as equal bits: adding 0 makes +0 of -0.
fn key(cell: [f64; 3]) -> [u64; 3] {
    cell.map(|x| (x + 0.0).to_bits())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Things where they lie, and for each the one before it in its cell.
    struct Put<'a>(&'a [DVec3], Grid, Vec<Option<u32>>);

    fn put(places: &[DVec3], reach: f64) -> Put<'_> {
        let mut grid = Grid::new(reach);
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
    fn far_apart_is_not_near_however_small_the_reach() {
        let places = [DVec3::splat(1e30)];
        assert_eq!(found(&put(&places, 1e-45), DVec3::splat(f64::from(1e30_f32.next_up()))), [0; 0]);
    }

    #[test]
    fn the_latest_is_there_and_tells_of_the_one_before() {
        let places = [0.1, 0.2, 7.0, 0.3].map(DVec3::splat);
        let Put(_, grid, before) = put(&places, 1.0);
        assert_eq!(before, [None, Some(0), None, Some(1)]);
        assert_eq!(
            [0.0, 7.5, -3.0].map(|x| grid.at(DVec3::splat(x), |id| places[id as usize])),
            [Some(3), Some(2), None]
        );
    }

    proptest! {
        #[test]
        fn whatever_lies_within_reach_is_found(
            places in prop::collection::vec(prop::array::uniform3(-40_i32..40), 1..40),
            reach in 1_u32..9,
            scale in -120_i32..120,
        ) {
            // Whole numbers times a power of two: many places lie on the borders of cells.
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

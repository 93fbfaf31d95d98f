//! A grid over space: what lies within reach of a place, without looking at everything.

use std::collections::HashMap;

use foldhash::fast::RandomState;
use glam::DVec3;

/// A value for each cell of space. Cells are made as they are needed.
///
/// Cells are counted in f64 and are never turned into integers: however large coordinates are beside the reach, no
/// count overflows, and different f32 positions never end up in one cell for want of digits.
pub(super) struct Grid<T> {
    reach: f64,
    cells: HashMap<[u64; 3], T, RandomState>,
}

impl<T: Default> Grid<T> {
    /// A grid for questions about what lies within `reach` (above 0), in object units. Cells are two reaches wide.
    pub fn new(reach: f64) -> Self {
        Self { reach, cells: HashMap::default() }
    }

    /// The value of the cell around a place.
    pub fn at(&mut self, place: DVec3) -> &mut T {
        self.cells.entry(key(place.to_array().map(|x| self.cell(x)))).or_default()
    }

    /// The values of the cells that hold all that is within reach of a place: up to 27 but mostly 8.
    pub fn near(&self, place: DVec3) -> impl Iterator<Item = &T> {
        let [x, y, z] = place.to_array().map(|x| self.touched(x));
        let cells = (0..27).filter_map(move |i| Some([x[i / 9]?, y[i / 3 % 3]?, z[i % 3]?]));
        cells.filter_map(|cell| self.cells.get(&key(cell)))
    }

    fn cell(&self, x: f64) -> f64 {
        (x / (2.0 * self.reach)).floor()
    }

    /// The cells within reach along one axis, each once. The middle one is listed too: rounding can put the outer ones
    /// two apart.
    fn touched(&self, x: f64) -> [Option<f64>; 3] {
        let [low, middle, high] = [x - self.reach, x, x + self.reach].map(|x| self.cell(x));
        [Some(low), (middle != low).then_some(middle), (high != middle).then_some(high)]
    }
}

/// Equal cells as equal bits: adding 0 makes +0 of -0.
fn key(cell: [f64; 3]) -> [u64; 3] {
    cell.map(|x| (x + 0.0).to_bits())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn found(grid: &Grid<Vec<usize>>, place: DVec3) -> Vec<usize> {
        let mut found = grid.near(place).flatten().copied().collect::<Vec<_>>();
        found.sort_unstable();
        found
    }

    #[test]
    fn no_cell_is_visited_twice_and_none_overflows() {
        for (place, reach) in [(0.0, 1.0), (-0.0, 1e-30), (1e30, 1e-30), (-3e38, 1e-45), (1e-45, 3e38), (5.0, 1.0)] {
            let mut grid: Grid<Vec<usize>> = Grid::new(reach);
            grid.at(DVec3::splat(place)).push(7);
            assert_eq!(found(&grid, DVec3::splat(place)), [7], "{place} within {reach}");
        }
    }

    #[test]
    fn far_apart_is_not_near_however_small_the_reach() {
        let mut grid: Grid<Vec<usize>> = Grid::new(1e-45);
        grid.at(DVec3::splat(1e30)).push(7);
        assert_eq!(found(&grid, DVec3::splat(f64::from(1e30_f32.next_up()))), [0; 0]);
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
            let mut grid: Grid<Vec<usize>> = Grid::new(reach);
            places.iter().enumerate().for_each(|(i, &place)| grid.at(place).push(i));
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

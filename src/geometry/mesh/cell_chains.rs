//! Finds the items near a position without looking at all of them: items in the cells of a grid.

use std::ops::ControlFlow;

use glam::{DVec3, Vec3};
use hashbrown::HashTable;
use hashbrown::hash_table::Entry;

use super::cell_grid::{CellGrid, spread};
use crate::casts::to_u32;

/// The number that ends a chain.
const NONE: u32 = u32::MAX;

/// Items with a position and a number each. Items are numbered from 0 on, in the order in which they are added. An item takes 26 to
/// 41 bytes at most, and less where cells have several.
pub(super) struct CellChains {
    grid: CellGrid,
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
    /// Makes an empty grid of cells with a width above 0, in object units, and room for so many items.
    pub(super) fn with_capacity(width: f64, items: usize) -> Self {
        Self {
            grid: CellGrid::new(width),
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
        let cell = self.grid.at(position, number);
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
    /// nearby cells mostly. Cells are at least [`CellGrid::LEAST_WIDTH`] reaches wide.
    pub(super) fn near(
        &self,
        position: Vec3,
        number: u32,
        mut reach: f64,
        mut visit: impl FnMut(u32, f64, &mut f64) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let (place, mut most) = (position.as_dvec3(), self.grid.most(reach));
        for (away, cell) in self.grid.near(position, number) {
            let mut next = if away > most { NONE } else { self.last(cell) };
            while next != NONE {
                let item = &self.items[next as usize];
                if self.number(next) == number {
                    visit(next, item.position.as_dvec3().distance_squared(place), &mut reach)?;
                    most = self.grid.most(reach);
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
    fn no_cell_overflows() {
        for (place, reach) in [(0.0, 1.0), (-0.0, 1e-30), (1e30, 1e-30), (-3e38, 1e-45), (1e-45, 3e38), (5.0, 1.0)] {
            let places = [Vec3::splat(place)];
            let chains = put(&places, CellGrid::LEAST_WIDTH * reach);
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
            let chains = put(&places, CellGrid::LEAST_WIDTH * f64::from(wider) * reach);
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

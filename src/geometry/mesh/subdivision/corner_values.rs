//! Values at the corners of faces, such as texture coordinates.

use rayon::prelude::*;

use super::level::Level;
use super::{Linear, Refinement, Scheme};
use crate::casts::to_u32;

impl Refinement {
    /// Refines values at the corners of the cage's faces linearly within each face: OpenSubdiv's `FVAR_LINEAR_ALL`. So faces that
    /// share values at both ends of an edge share them all along it. For values that are smoothed as the surface is, refine
    /// another cage, whose points are the distinct values.
    ///
    /// # Panics
    /// If there isn't a value for each corner of the cage.
    pub fn refine_corners<T: Linear>(&self, values: &[T]) -> Vec<T> {
        assert_eq!(values.len(), self.levels[0].origins.len(), "a value for each corner of the cage");
        let coarse = &self.levels[..self.levels.len() - 1];
        coarse.iter().fold(values.to_vec(), |values, level| split(level, self.scheme, &values))
    }
}

/// The values at the corners of the finer level's faces.
fn split<T: Linear>(level: &Level, scheme: Scheme, values: &[T]) -> Vec<T> {
    let value = |side: u32| values[side as usize];
    let middle = |side: u32| (value(side) + value(level.polygons.after(side))) * 0.5;
    match scheme {
        Scheme::CatmullClark => {
            let corner = |side: u32| {
                let all = level.polygons.sides(level.polygons.face_of(side));
                let share = 1.0 / f64::from(all.end - all.start);
                let center = all.fold(T::default(), |sum, side| sum + value(side)) * share;
                [value(side), middle(side), center, middle(level.polygons.before(side))]
            };
            (0..to_u32(values.len())).into_par_iter().map(corner).collect::<Vec<_>>().into_flattened()
        }
        Scheme::Loop => {
            let face = |face: u32| {
                let [a, b, c] = [0, 1, 2].map(|k| value(3 * face + k));
                let [ab, bc, ca] = [0, 1, 2].map(|k| middle(3 * face + k));
                [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
            };
            let split = (0..level.faces()).into_par_iter().map(face);
            split.collect::<Vec<_>>().into_flattened().into_flattened()
        }
    }
}

//! Subdivision surfaces: a cage of polygons is refined level by level towards a smooth limit surface, with creases, corners,
//! boundaries and holes as OpenSubdiv has them.
//!
//! Sources: Catmull and Clark 1978, "Recursively generated B-spline surfaces on arbitrary topological meshes"; Loop 1987,
//! "Smooth subdivision surfaces based on triangles"; Halstead, Kass and DeRose 1993, "Efficient, fair interpolation using
//! Catmull-Clark surfaces", for limits; Hoppe et al. 1994, "Piecewise smooth surface reconstruction", for creases; DeRose, Kass
//! and Truong 1998, "Subdivision surfaces in character animation", for sharpness; Zorin, Schröder and Sweldens 1996,
//! "Interpolating subdivision for meshes with arbitrary topology", for the butterfly scheme.
//!
//! [`Refinement`] holds only connectivity. Positions, blend shapes, weights of joints and anything else that is
//! [`Linear`] are refined with it, each in its own call. A point's value is computed once, in one order, whatever the number of
//! cores; so faces that share a point share its bits, also after they are rounded to f32, once and at the end.

mod butterfly;
mod cage;
mod corner_values;
mod level;
mod limit;
mod masks;
mod size;
mod split;
mod tangents;
#[cfg(test)]
mod tests;
mod values;

use std::collections::BTreeSet;
use std::ops::{Add, Mul, Range};

pub use cage::{Cage, CageError, INFINITELY_SHARP};
pub use corner_values::FaceVarying;
pub use limit::Limit;
pub use size::Size;

use crate::casts::to_u32;
use level::Level;
use values::Values;

/// How faces are divided, and what is averaged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scheme {
    /// Divides polygons into quadrilaterals. Regular parts become bicubic B-splines.
    #[default]
    CatmullClark,
    /// Divides triangles into four. Regular parts become quartic box splines.
    Loop,
    /// Divides triangles into four, and keeps their corners in place. Regular parts that follow a cubic polynomial stay on it.
    Butterfly,
}

/// What becomes of the boundary of an open cage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Boundary {
    /// Smooth curves, also where a point has only one face.
    Edges,
    /// Curves with corners at points of only one face.
    #[default]
    EdgesAndCorners,
}

/// What can be refined: values that can be added and scaled, such as `f64` and `DVec3`. The default value must be zero.
pub trait Linear: Copy + Default + Send + Sync + Add<Output = Self> + Mul<f64, Output = Self> {}

impl<T: Copy + Default + Send + Sync + Add<Output = T> + Mul<f64, Output = T>> Linear for T {}

/// A face of a refinement.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Face {
    /// The face of the cage that it is a part of.
    pub cage_face: u32,
    /// Its corners: indices into [`Refinement::corners`], and into lists of values at corners.
    pub corners: Range<usize>,
}

/// A cage, and the faces that it is refined to. The points of each level begin with those of the level before, in their order.
pub struct Refinement {
    scheme: Scheme,
    /// From the cage to the finest.
    levels: Vec<Level>,
    /// For each face of the cage whether it is a hole; or nothing if none is.
    is_hole: Vec<bool>,
    /// How many creases are between points that no face connects.
    pub lone_creases: usize,
}

impl Refinement {
    /// Refines a cage so many times. 0 levels keep its own faces. No level may have more than `most` points or `most` faces.
    /// What faces there will be is known, and checked, before any memory is taken; what points, before any level is made.
    ///
    /// # Errors
    /// [`CageError`].
    pub fn new(cage: &Cage, levels: u8, most: u64) -> Result<Self, CageError> {
        cage.check()?;
        let limited = |size: Size| match size.after(levels, cage.scheme) {
            size if size.points > most || size.faces > most || !size.is_numbered() => {
                Err(CageError::TooLarge { points: size.points, faces: size.faces, most: most.min(u64::from(u32::MAX)) })
            }
            _ => Ok(()),
        };
        limited(cage.size(cage.corners.len().div_ceil(2)))?;
        let is_hole = cage.is_hole();
        let (level, lone_creases) = cage.level()?;
        limited(cage.size(level.edge_sides.len()))?;
        Ok(Self { is_hole, lone_creases, ..Self::divided(level, cage.scheme, levels.into()) })
    }

    /// Divides a level so many times.
    fn divided(level: Level, scheme: Scheme, levels: usize) -> Self {
        let mut list = vec![level];
        for _ in 0..levels {
            list.extend(list.last().map(|level| level.split(scheme)));
        }
        Self { scheme, levels: list, is_hole: Vec::new(), lone_creases: 0 }
    }

    /// How many points there are after all levels.
    pub fn points(&self) -> usize {
        self.finest().points
    }

    /// The points at the corners of all refined faces, also of those that are holes.
    pub fn corners(&self) -> &[u32] {
        &self.finest().origins
    }

    /// The refined faces that are no holes. Parts of the same face of the cage follow one another.
    pub fn faces(&self) -> impl Iterator<Item = Face> {
        let is_hole = |face: u32| self.is_hole.get(face as usize) == Some(&true);
        let faces = (0..self.finest().faces()).map(|face| (self.cage_face(face), face));
        faces.filter(move |(cage_face, _)| !is_hole(*cage_face)).map(|(cage_face, face)| {
            let sides = self.finest().polygons.sides(face);
            Face { cage_face, corners: sides.start as usize..sides.end as usize }
        })
    }

    /// Refines values at the points of the cage through all levels.
    ///
    /// # Panics
    /// If there isn't one for each point.
    pub fn refine<T: Linear>(&self, values: &[T]) -> Vec<T> {
        assert_eq!(values.len(), self.levels[0].points, "a value for each point of the cage");
        let coarse = &self.levels[..self.levels.len() - 1];
        let once = |values: Vec<T>, level| Values::new(level, self.scheme, &values).refined();
        coarse.iter().fold(values.to_vec(), once)
    }

    /// The limit surface of refined values at the points of the finest level.
    ///
    /// # Panics
    /// If there isn't a value for each refined point.
    pub fn limit<'a, T: Linear>(&'a self, refined: &'a [T]) -> Limit<'a, T> {
        assert_eq!(refined.len(), self.points(), "a value for each refined point");
        Limit(Values::new(self.finest(), self.scheme, refined))
    }

    /// The limit of values that only some points of the cage have, each under a number, such as weights of joints: what isn't zero at
    /// each refined point, by growing numbers. Before what belongs to a number is added to the lists, `ask` gets how much that is.
    ///
    /// # Errors
    /// Those of `ask`.
    ///
    /// # Panics
    /// If there isn't a list for each point of the cage.
    pub fn limit_of_some<T: Linear + PartialEq, E>(
        &self,
        values: &[Vec<(u32, T)>],
        mut ask: impl FnMut(usize) -> Result<(), E>,
    ) -> Result<Vec<Vec<(u32, T)>>, E> {
        let numbers: BTreeSet<u32> = values.iter().flatten().map(|(number, _)| *number).collect();
        let mut refined = vec![Vec::new(); self.points()];
        for number in numbers {
            let own =
                |list: &Vec<(u32, T)>| list.iter().find(|own| own.0 == number).map_or_else(T::default, |own| own.1);
            let points = self.refine(&values.iter().map(own).collect::<Vec<T>>());
            let limit = self.limit(&points).values();
            ask(limit.iter().filter(|value| **value != T::default()).count())?;
            for (list, value) in refined.iter_mut().zip(limit) {
                list.extend((value != T::default()).then_some((number, value)));
            }
        }
        Ok(refined)
    }

    /// The face of the cage that a refined face is a part of.
    fn cage_face(&self, face: u32) -> u32 {
        let levels = to_u32(self.levels.len()) - 1;
        match self.scheme {
            Scheme::Loop | Scheme::Butterfly => face >> (2 * levels),
            Scheme::CatmullClark if levels == 0 => face,
            // Faces of the first level are corners of the cage.
            Scheme::CatmullClark => self.levels[0].polygons.face_of(face >> (2 * (levels - 1))),
        }
    }

    fn finest(&self) -> &Level {
        &self.levels[self.levels.len() - 1]
    }
}

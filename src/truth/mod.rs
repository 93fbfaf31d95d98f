//! Surfaces that a tessellation is held against: exact ones, which shapes are sampled from, and reference meshes.
//!
//! All is in f64 and in object units. [`crate::measure::Accuracy`] does the holding against.

mod bicubic;
mod ellipsoid;
mod exact;
mod reference;
mod revolved;
mod root;
mod saddle;
mod spread;
mod surface;
mod triangles;

use glam::DVec3;

pub use exact::{Exact, of_shape};
pub use reference::Reference;
pub(crate) use spread::radical_inverse;
pub use triangles::{Closest, Triangles};

use crate::files::Limits;
use crate::load::{LoadError, Source};
use crate::mesh::{Mesh, Shape};
use crate::progress::Progress;

/// The point of a surface that is nearest to some place. Where several are equally near it is one of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    pub point: DVec3,
    /// The surface's unit normal there.
    pub normal: DVec3,
    /// From the place to the point.
    pub distance: f64,
}

/// A point of a surface, and its unit normal there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    pub point: DVec3,
    pub normal: DVec3,
}

/// What a tessellation should have been.
pub enum Truth {
    Exact(Exact),
    Mesh(Reference),
}

impl Truth {
    /// The surface that a shape's corners are samples of; none for shapes that have none.
    pub fn of_shape(shape: Shape) -> Option<Self> {
        of_shape(shape).map(Self::Exact)
    }

    /// What a source stands for: the surface that a shape is sampled from; or the mesh. None if that has no triangle.
    ///
    /// # Errors
    /// What the file holds can't be shown, or `progress` was cancelled.
    pub fn load(source: &Source, limits: &Limits, progress: &Progress) -> Result<Option<Self>, LoadError> {
        match source.shape().and_then(Self::of_shape) {
            Some(exact) => Ok(Some(exact)),
            None => Ok(Self::of_mesh(&source.load(limits, progress)?.mesh)),
        }
    }

    /// A mesh with its interpolated normals, which needn't be closed or manifold; none if it has no triangle.
    pub fn of_mesh(mesh: &Mesh) -> Option<Self> {
        Reference::new(mesh).map(Self::Mesh)
    }

    /// The nearest point.
    pub fn closest(&self, p: DVec3) -> Nearest {
        self.closest_facing(p, DVec3::ZERO)
    }

    /// The nearest point. Where it lies on a crease, which has several normals, it comes with the one nearest to `facing`.
    pub fn closest_facing(&self, p: DVec3, facing: DVec3) -> Nearest {
        match self {
            Self::Exact(exact) => exact.closest_facing(p, facing),
            Self::Mesh(mesh) => mesh.closest_facing(p, facing),
        }
    }

    /// So many points, spread evenly by area; the same every time.
    pub fn samples(&self, count: usize) -> Vec<Sample> {
        match self {
            Self::Exact(exact) => exact.samples(count),
            Self::Mesh(mesh) => mesh.samples(count),
        }
    }

    /// In square object units; of exact surfaces to about 1e-3 of it.
    pub fn area(&self) -> f64 {
        match self {
            Self::Exact(exact) => exact.area(),
            Self::Mesh(mesh) => mesh.area(),
        }
    }

    /// The length of the bounding box's diagonal.
    pub fn diagonal(&self) -> f64 {
        let [min, max] = match self {
            Self::Exact(exact) => exact.extent(),
            Self::Mesh(mesh) => mesh.extent(),
        };
        min.distance(max)
    }
}

/// How near to a crease, relative to the surface's size, its normals can't be told apart by position: a few times what
/// f32 rounds off.
const ON_CREASE: f64 = 1e-6;

#[cfg(test)]
mod tests;

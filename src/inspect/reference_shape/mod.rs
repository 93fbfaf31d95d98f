//! Reference surfaces, which a tessellation is compared with: the exact surfaces that shapes are sampled from, and
//! reference meshes. They are the surfaces of the option `--reference-surface`.
//!
//! All numbers are f64, in object units. [`crate::measure::Accuracy`] does the comparison.

mod bicubic;
mod ellipsoid;
mod exact;
mod facets;
mod reference;
mod revolved;
mod root;
mod saddle;
mod spread;
mod surface;

use glam::DVec3;

pub use exact::{Exact, of_shape};
pub(crate) use facets::Facets;
pub use reference::Reference;
pub use spread::radical_inverse;

use geometry::mesh::{Mesh, Shape};
use geometry::near::{Goal, farthest};
use geometry::progress::Progress;
use load::files::Limits;
use load::mesh_file::NOT_REFINED;
use load::selection::Selection;
use load::{Import, LoadError, LoadedMesh, NormalSource, Source};

/// How often the cage of a reference surface is refined. Its points are then those of the limit surface.
const LEVELS: f32 = 4.0;

/// The point of a surface that is nearest to some place. If several are equally near, it is one of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    pub point: DVec3,
    /// The surface's unit normal there.
    pub normal: DVec3,
    /// The distance from the place to the point.
    pub distance: f64,
}

/// A point of a surface, and the unit normal there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    pub point: DVec3,
    pub normal: DVec3,
}

/// A reference surface: the surface that a tessellation should be.
pub enum ReferenceShape {
    Exact(Exact),
    Mesh(Reference),
}

impl ReferenceShape {
    /// Returns the surface that a shape's corners are samples of, or `None` if the shape has none.
    pub fn from_shape(shape: Shape) -> Option<Self> {
        of_shape(shape).map(Self::Exact)
    }

    /// Returns the reference surface of a source: the exact surface of a shape, or the mesh of a file, with its own normals and refined
    /// four times where `selected` says that it is refined. `None` if that has no triangle.
    ///
    /// # Errors
    /// The file can't be read as a mesh, or is the cage of a subdivision surface and can't be refined, or `progress` was cancelled.
    pub fn load(
        source: &Source,
        selected: Selection,
        limits: &Limits,
        progress: &Progress,
    ) -> Result<Option<Self>, LoadError> {
        let (shape, refines_all) = (source.shape(), selected.import.subdivide.refines_all());
        if let Some(exact) = shape.and_then(Self::from_shape).filter(|_| !refines_all) {
            return Ok(Some(exact));
        }
        let read = |levels, progress: &Progress| -> Result<(Option<Reference>, LoadedMesh), LoadError> {
            let import = Import { levels: Some(levels), normals: NormalSource::File, ..selected.import };
            let import = if shape.is_some() { Import::default() } else { import };
            let loaded = source.load_selected(Selection { import, ..selected }, limits, progress)?;
            Ok((Reference::new(&loaded.mesh), loaded))
        };
        let (fine, loaded) = read(LEVELS, &progress.part(0.0, 0.8))?;
        if refines_all && !loaded.is_refined {
            let reason = if loaded.warnings.is_empty() { NOT_REFINED.to_owned() } else { loaded.warnings.join(" ") };
            return Err(LoadError::Unrefined { file: source.to_string(), reason });
        }
        let Some(mut fine) = fine else { return Ok(None) };
        if loaded.is_refined
            && let (Some(coarse), _) = read(LEVELS - 1.0, &progress.part(0.8, 1.0))?
        {
            let goal = Goal { relative: 0.05, absolute: 1e-7 * fine.diagonal, searches: 1 << 18 };
            let step = farthest(fine.facets().soup(), &coarse.facets().tree, &goal, progress)?;
            fine.step = step.map(|step| step.distance.at_most);
        }
        Ok(Some(Self::Mesh(fine)))
    }

    /// Returns a mesh as reference surface, with its interpolated normals, or `None` if it has no triangle. It needn't
    /// be closed or manifold.
    pub fn from_mesh(mesh: &Mesh) -> Option<Self> {
        Reference::new(mesh).map(Self::Mesh)
    }

    /// Returns the nearest point of the surface.
    pub fn closest(&self, p: DVec3) -> Nearest {
        self.closest_facing(p, DVec3::ZERO)
    }

    /// Returns the nearest point of the surface. If it lies on a crease, where the surface has several normals, it has
    /// the one that is nearest to `facing`.
    pub fn closest_facing(&self, p: DVec3, facing: DVec3) -> Nearest {
        match self {
            Self::Exact(exact) => exact.closest_facing(p, facing),
            Self::Mesh(mesh) => mesh.closest_facing(p, facing),
        }
    }

    /// Returns the nearest point of the surface, and its distance. For a mesh this is faster than [`Self::closest`].
    pub(crate) fn closest_point(&self, p: DVec3) -> (DVec3, f64) {
        match self {
            Self::Exact(exact) => {
                let nearest = exact.closest(p);
                (nearest.point, nearest.distance)
            }
            Self::Mesh(mesh) => mesh.closest_point(p),
        }
    }

    /// Returns how far a cage that was refined is at most from the same one refined once less, in object units. Each refinement moves it about
    /// a quarter as far as the one before, so about a third of this is missing to the limit surface. `None` for other surfaces.
    pub fn step(&self) -> Option<f64> {
        match self {
            Self::Exact(_) => None,
            Self::Mesh(mesh) => mesh.step,
        }
    }

    pub(crate) fn is_exact(&self) -> bool {
        matches!(self, Self::Exact(_))
    }

    /// Returns a distance that no point of the surface is nearer to p than for certain.
    pub(crate) fn proven(&self, p: DVec3) -> f64 {
        match self {
            Self::Exact(exact) => (exact.closest(p).distance - EXACT * self.diagonal()).max(0.0),
            Self::Mesh(mesh) => mesh.proven(p),
        }
    }

    /// Returns triangles that are the surface, or at most about `sag` away from it, in object units; or farther if they would
    /// be more than `most`.
    pub(crate) fn facets(&self, sag: f64, most: u64) -> Facets {
        match self {
            Self::Exact(exact) => exact.facets(sag, most),
            Self::Mesh(mesh) => mesh.facets(),
        }
    }

    /// Returns `count` points, spread evenly by area. They are the same every time.
    pub fn samples(&self, count: usize) -> Vec<Sample> {
        match self {
            Self::Exact(exact) => exact.samples(count),
            Self::Mesh(mesh) => mesh.samples(count),
        }
    }

    /// Returns the area in square object units. That of exact surfaces is accurate to about 1e-3.
    pub fn area(&self) -> f64 {
        match self {
            Self::Exact(exact) => exact.area(),
            Self::Mesh(mesh) => mesh.area(),
        }
    }

    /// Returns the length of the bounding box's diagonal in object units.
    pub fn diagonal(&self) -> f64 {
        let [min, max] = match self {
            Self::Exact(exact) => exact.extent(),
            Self::Mesh(mesh) => mesh.extent(),
        };
        min.distance(max)
    }
}

/// The part of an exact surface's diagonal that its nearest points are computed to, and more.
pub(crate) const EXACT: f64 = 1e-11;

/// The distance from a crease, relative to the surface's size, within which all normals of the crease count: a few
/// rounding errors of f32 positions.
const ON_CREASE: f64 = 1e-6;

#[cfg(test)]
mod tests;

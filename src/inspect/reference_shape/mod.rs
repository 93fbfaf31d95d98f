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

use std::ops::Deref;

use glam::DVec3;

pub use exact::{Exact, of_shape};
pub use facets::Facets;
pub use reference::Reference;
pub use spread::radical_inverse;

use geometry::mesh::{Mesh, Shape};
use geometry::near::{Goal, farthest};
use geometry::progress::Progress;
use load::files::Limits;
use load::selection::Selection;
use load::{Import, LoadError, NormalSource, ShownParts, Source};

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

/// What is known about a reference surface.
pub trait Known: Send + Sync {
    /// Returns the nearest point of the surface. If it lies on a crease, where the surface has several normals, it has
    /// the one that is nearest to `facing`.
    fn closest_facing(&self, p: DVec3, facing: DVec3) -> Nearest;

    /// Returns the nearest point of the surface.
    fn closest(&self, p: DVec3) -> Nearest {
        self.closest_facing(p, DVec3::ZERO)
    }

    /// Returns the nearest point of the surface, and its distance. For a mesh this is faster than [`Self::closest`].
    fn closest_point(&self, p: DVec3) -> (DVec3, f64) {
        let nearest = self.closest(p);
        (nearest.point, nearest.distance)
    }

    /// Returns a distance that no point of the surface is nearer to p than for certain.
    fn proven(&self, p: DVec3) -> f64;

    fn is_exact(&self) -> bool {
        false
    }

    /// Returns triangles that are the surface, or at most about `sag` away from it, in object units; or farther if they would
    /// be more than `most`.
    fn facets(&self, sag: f64, most: u64) -> Facets;

    /// Returns `count` points, spread evenly by area. They are the same every time.
    fn samples(&self, count: usize) -> Vec<Sample>;

    /// Returns the area in square object units. That of exact surfaces is accurate to about 1e-3.
    fn area(&self) -> f64;

    /// Returns the least and the greatest coordinates.
    fn extent(&self) -> [DVec3; 2];

    /// Returns the length of the bounding box's diagonal in object units.
    fn diagonal(&self) -> f64 {
        let [min, max] = self.extent();
        min.distance(max)
    }
}

/// A surface that is known exactly: its nearest points, its extent, and a parametrisation by charts over unit squares.
trait Surface: Send + Sync {
    /// Returns the point nearest to `p`: of several, one whose normal faces as `facing` does.
    fn closest(&self, p: DVec3, facing: DVec3) -> Nearest;

    /// Returns the least and the greatest coordinates.
    fn extent(&self) -> [DVec3; 2];

    /// Returns the number of charts.
    fn charts(&self) -> usize {
        1
    }

    /// Returns the point at `s` and `t` (0 to 1) of a chart, and the surface's area there per area of the unit square.
    fn at(&self, chart: usize, s: f64, t: f64) -> (Sample, f64);

    /// Returns lengths that the second derivatives by s twice, by s and t, and by t twice nowhere exceed in a chart.
    fn bends(&self, chart: usize) -> [f64; 3];
}

/// A reference surface: the surface that a tessellation should be.
pub struct ReferenceShape {
    known: Box<dyn Known>,
    /// How far a cage that was refined is at most from the same one refined once less, in object units. Each refinement moves it
    /// about a quarter as far as the one before, so about a third of this is missing to the limit; under the butterfly scheme it is
    /// a third as far, and half of this. These are observed and not proven. `None` for other surfaces.
    pub step: Option<f64>,
}

impl Deref for ReferenceShape {
    type Target = dyn Known;

    fn deref(&self) -> &Self::Target {
        &*self.known
    }
}

impl ReferenceShape {
    /// Returns the surface that a shape's corners are samples of, or `None` if the shape has none.
    pub fn from_shape(shape: Shape) -> Option<Self> {
        of_shape(shape).map(|exact| Self { known: Box::new(exact), step: None })
    }

    /// Returns the reference surface of a source: the exact surface of a shape, or the mesh of a file, with its own normals and
    /// refined four times where `selected` says that it is refined.
    ///
    /// # Errors
    /// The file can't be read as a mesh, is the cage of a subdivision surface and can't be refined, or has no triangle; or
    /// `progress` was cancelled.
    pub fn load(source: &Source, selected: Selection, limits: &Limits, progress: &Progress) -> Result<Self, LoadError> {
        let (shape, refines_all) = (source.shape(), selected.import.refines_all());
        // Parts don't have normals of their own either.
        let parts = selected.parts.map(|parts| ShownParts { styles: Vec::new(), ..parts.clone() });
        let selected = Selection { parts: parts.as_ref(), ..selected };
        if let Some(exact) = shape.and_then(Self::from_shape).filter(|_| !refines_all) {
            return Ok(exact);
        }
        let refused = |reason: &str| LoadError::NoReference { file: source.to_string(), reason: reason.to_owned() };
        let read = |levels, progress: &Progress| -> Result<(Reference, bool), LoadError> {
            let import = Import { levels: Some(levels), normals: NormalSource::File, ..selected.import };
            let import = if shape.is_some() { Import::default() } else { import };
            let loaded = source.load_selected(Selection { import, ..selected }, limits, progress)?;
            if refines_all && !loaded.is_refined {
                return Err(refused(&loaded.why_not_refined()));
            }
            let read = Reference::new(&loaded.mesh).ok_or_else(|| refused("it has no triangles"))?;
            Ok((read, loaded.is_refined))
        };
        let (fine, is_refined) = read(LEVELS, &progress.part(0.0, 0.8))?;
        let mut step = None;
        if is_refined {
            let (coarse, _) = read(LEVELS - 1.0, &progress.part(0.8, 1.0))?;
            let goal = Goal { relative: 0.05, absolute: 1e-7 * fine.diagonal(), searches: 1 << 18 };
            let found = farthest(fine.facets.soup(), &coarse.facets.tree, &goal, progress)?;
            step = found.map(|found| found.distance.at_most);
        }
        Ok(Self { known: Box::new(fine), step })
    }

    /// Returns a mesh as reference surface, with its interpolated normals, or `None` if it has no triangle. It needn't
    /// be closed or manifold.
    pub fn from_mesh(mesh: &Mesh) -> Option<Self> {
        Reference::new(mesh).map(|mesh| Self { known: Box::new(mesh), step: None })
    }
}

/// The part of an exact surface's diagonal that its nearest points are computed to, and more.
pub(crate) const EXACT: f64 = 1e-11;

/// The distance from a crease, relative to the surface's size, within which all normals of the crease count: a few
/// rounding errors of f32 positions.
const ON_CREASE: f64 = 1e-6;

#[cfg(test)]
mod tests;

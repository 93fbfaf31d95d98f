//! The largest distances between what was emitted and a reference surface, as intervals that contain them for certain.

use super::WorstPoint;
use super::emitted::Emitted;
use crate::reference_shape::ReferenceShape;
use geometry::near::{Farthest, Goal, Interval, TriangleTree, farthest};
use geometry::progress::{Cancelled, Progress};

/// When an interval is narrow enough.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Narrow {
    /// The width that suffices, as a part of the distance.
    pub relative: f64,
    /// The width that suffices, as a part of the reference surface's diagonal.
    pub absolute: f64,
}

impl Default for Narrow {
    fn default() -> Self {
        Self { relative: 0.01, absolute: 1e-6 }
    }
}

/// The number of searches for a nearest point after which an interval is left as it is: about a minute on two cores.
const SEARCHES: u64 = 1 << 26;

/// The part of an exact surface's size that its nearest points are computed to.
const EXACT: f64 = 1e-9;

/// The largest distance in one direction, and the place where its lower end was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Largest {
    pub distance: Interval,
    pub place: WorstPoint,
}

impl Largest {
    /// The largest distance of both.
    pub(super) fn or(self, other: Self) -> Self {
        Self { distance: self.distance.or(other.distance), place: super::worse(self.place, other.place) }
    }
}

/// Measures largest distances, for surfaces that are about `rough` apart, in object units.
pub(crate) struct Comparison<'a> {
    pub reference_shape: &'a ReferenceShape,
    pub emitted: &'a Emitted,
    pub narrow: Narrow,
    pub rough: f64,
}

impl Comparison<'_> {
    fn goal(&self) -> Goal {
        let Narrow { relative, absolute } = self.narrow;
        Goal { relative, absolute: absolute * self.reference_shape.diagonal(), searches: SEARCHES }
    }

    /// How far the triangles may be from an exact surface that they stand for.
    fn sag(&self) -> f64 {
        (self.goal().relative * self.rough).max(self.goal().absolute) / 2.0
    }

    /// From what was emitted to the reference surface. `None` if nothing was emitted.
    pub(crate) fn to_reference(&self, progress: &Progress) -> Result<Option<Largest>, Cancelled> {
        let facets = self.reference_shape.facets(self.sag());
        let found = farthest(self.emitted.soup(), &facets.tree, &self.goal(), progress)?;
        Ok(found.map(|Farthest { distance, triangle, point, .. }| {
            let (nearest, value) = self.reference_shape.closest_point(point);
            let distance = self.beyond(distance, facets.sag, value);
            let patch = self.emitted.patch(triangle);
            let place = WorstPoint { value: distance.at_least, patch, emitted: point, reference_shape: nearest };
            Largest { distance, place }
        }))
    }

    /// From the reference surface to what was emitted, whose triangles are in `tree`.
    pub(crate) fn from_reference(
        &self,
        tree: &TriangleTree,
        progress: &Progress,
    ) -> Result<Option<Largest>, Cancelled> {
        let facets = self.reference_shape.facets(self.sag());
        let found = farthest(facets.soup(), tree, &self.goal(), progress)?;
        Ok(found.and_then(|Farthest { distance, point, .. }| {
            let point = if facets.sag > 0.0 { self.reference_shape.closest_point(point).0 } else { point };
            let closest = tree.closest(point, f64::INFINITY)?;
            let distance = self.beyond(distance, facets.sag, tree.proven(point, &closest));
            let patch = self.emitted.patch(closest.triangle);
            let place = WorstPoint { value: distance.at_least, patch, emitted: closest.point, reference_shape: point };
            Some(Largest { distance, place })
        }))
    }

    /// The interval of the distance to the surface that triangles stand for. `value` is the distance at the place that was
    /// found.
    fn beyond(&self, distance: Interval, sag: f64, value: f64) -> Interval {
        if sag == 0.0 {
            return distance;
        }
        let at_most = distance.at_most + sag;
        let found = value - EXACT * self.reference_shape.diagonal();
        Interval { at_least: found.max(distance.at_least - sag).clamp(0.0, at_most), at_most }
    }
}

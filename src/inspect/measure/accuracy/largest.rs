//! The largest distances between what was emitted and a reference surface, as intervals that contain them for certain.

use super::WorstPoint;
use super::emitted::Emitted;
use crate::reference_shape::{EXACT, Facets, ReferenceShape};
use geometry::defaults::with_defaults;
use geometry::near::{Farthest, Goal, Interval, TriangleTree, farthest};
use geometry::progress::{Cancelled, Progress};

with_defaults! {
    /// When an interval is narrow enough: by default after about a minute on two cores at most.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Narrow {
        /// The width that suffices, as a part of the distance.
        pub relative: f64 = 0.01,
        /// The width that suffices, as a part of the reference surface's diagonal.
        pub absolute: f64 = 1e-6,
        /// The number of searches for a nearest point after which an interval is left as it is. A core makes about a million in a
        /// second.
        pub searches: u64 = 1 << 26,
    }
}

impl Narrow {
    /// About a second on two cores at most.
    pub const QUICK: Self = Self { relative: 0.01, absolute: 1e-6, searches: 1 << 20 };
}

/// An exact surface is cut into at most one triangle for so many searches, and into [`MOST`].
const SEARCHES_A_TRIANGLE: u64 = 16;
const MOST: u64 = 1 << 18;

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

/// Measures largest distances.
pub(crate) struct Comparison<'a> {
    pub reference_shape: &'a ReferenceShape,
    pub emitted: &'a Emitted,
    pub narrow: Narrow,
    /// The farthest emitted point of some samples.
    pub farthest: Option<WorstPoint>,
}

impl Comparison<'_> {
    /// What is left of the width for the search. Of an exact surface, the triangles that stand for it take half of it.
    fn goal(&self) -> Goal {
        let Narrow { relative, absolute, searches } = self.narrow;
        let part = if self.reference_shape.is_exact() { 0.5 } else { 1.0 };
        let absolute = part * absolute * self.reference_shape.diagonal();
        Goal { relative: part * relative, absolute, searches }
    }

    /// The reference surface as triangles, which may be as far from an exact one as is of no matter.
    fn facets(&self) -> Facets {
        let rough = self.farthest.map_or(0.0, |farthest| farthest.value);
        let sag = (self.goal().relative * rough).max(self.goal().absolute);
        self.reference_shape.facets(sag, (self.narrow.searches / SEARCHES_A_TRIANGLE).min(MOST))
    }

    /// From what was emitted to the reference surface. `None` if nothing was emitted.
    pub(crate) fn to_reference(&self, progress: &Progress) -> Result<Option<Largest>, Cancelled> {
        let facets = self.facets();
        let found = farthest(self.emitted.soup(), &facets.tree, &self.goal(), progress)?;
        Ok(found.map(|Farthest { distance, triangle, point, .. }| {
            let (nearest, value) = self.reference_shape.closest_point(point);
            let mut distance = self.beyond(distance, facets.sag, value);
            let patch = self.emitted.patch(triangle);
            let mut place = WorstPoint { value: distance.at_least, patch, emitted: point, reference_shape: nearest };
            if let Some(sample) = self.farthest {
                let value = self.reference_shape.proven(sample.emitted).min(distance.at_most);
                if value > distance.at_least {
                    (distance.at_least, place) = (value, WorstPoint { value, ..sample });
                }
            }
            Largest { distance, place }
        }))
    }

    /// From the reference surface to what was emitted, whose triangles are in `tree`.
    pub(crate) fn to_emitted(&self, tree: &TriangleTree, progress: &Progress) -> Result<Option<Largest>, Cancelled> {
        let facets = self.facets();
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

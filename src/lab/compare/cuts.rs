//! How the sides of patches are cut: into how many segments, and how long.

use super::assignment::Part;
use super::matching::Reach;
use geometry::tessellate::Partitioning;

/// Where a side is cut: shares of its length from its start, with 0 and 1, in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Cut(Vec<f64>);

impl Cut {
    /// How a side (0 to 2) is cut by points at these weights of corners 0 and 1. Points within `reach` of each other are one.
    pub(super) fn new(side: usize, weights: impl Iterator<Item = [f64; 2]>, reach: f64) -> Self {
        let on_side = weights.filter_map(|[u, v]| {
            let weights = [u, v, 1.0 - u - v];
            (weights[(side + 2) % 3].abs() <= reach).then_some(weights[(side + 1) % 3])
        });
        let mut places: Vec<f64> = on_side.collect();
        places.sort_by(f64::total_cmp);
        places.dedup_by(|a, b| *a - *b <= reach);
        Self(places)
    }

    pub(super) fn segments(&self) -> usize {
        self.0.len().saturating_sub(1)
    }

    /// Whether both are cut at the same places, to within `reach`.
    pub(super) fn is_like(&self, other: &Self, reach: f64) -> bool {
        self.0.len() == other.0.len() && self.0.iter().zip(&other.0).all(|(a, b)| (a - b).abs() <= reach)
    }

    /// The tessellation factor that gives such a cut. Under fractional partitioning, the points of n - 2 segments move to those of n
    /// as the factor grows from n - 2 to n (D3D11.3 Functional Specification, section 11.7.10), and so do the lengths of the segments
    /// that aren't growing from nothing.
    pub(super) fn factor(&self) -> f64 {
        let longest = self.lengths().fold(0.0, f64::max);
        let segments = self.segments() as f64;
        if segments < 3.0 {
            return segments;
        }
        let [before, after] = [segments - 2.0, segments].map(f64::recip);
        let share = (before - longest) / (before - after);
        segments - 2.0 + 2.0 * share.clamp(0.0, 1.0)
    }

    fn lengths(&self) -> impl Iterator<Item = f64> {
        self.0.windows(2).map(|ends| ends[1] - ends[0])
    }

    /// Whether a side may be cut so under a partitioning. Lengths within `reach` are equal.
    pub(super) fn suits(&self, partitioning: Partitioning, reach: f64) -> bool {
        let longest = self.lengths().fold(0.0, f64::max);
        let shorter: Vec<f64> = self.lengths().filter(|length| longest - length > 2.0 * reach).collect();
        let are_so = match shorter[..] {
            // Also fractional partitioning at whole factors.
            [] => true,
            [a, b] => partitioning.is_fractional() && (a - b).abs() <= 2.0 * reach,
            _ => false,
        };
        are_so && partitioning.has_segments(self.segments() as u32)
    }
}

/// How their triangles cut the three sides of a patch. Vertices off the surface don't count.
pub(super) fn cuts_of(part: &Part, reach: Reach) -> [Cut; 3] {
    let on_surface = || part.places.iter().filter(|place| place.distance <= reach.fit).map(|place| place.weights);
    [0, 1, 2].map(|side| Cut::new(side, on_surface(), reach.domain))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::domain_points::pattern_points;
    use geometry::tessellate::{Convention, HullFactors};

    const REACH: f64 = 1e-4;

    /// The cut of side 0 under a partitioning, whose factor is this one.
    fn cut(partitioning: Partitioning, factor: f32) -> Cut {
        let factors = HullFactors { edges: [5.0, 6.0, factor], inside: 5.0 }.process(partitioning);
        let points = pattern_points(factors, Convention::D3d11);
        Cut::new(0, points.into_iter(), REACH)
    }

    #[test]
    fn a_cut_tells_segments_factor_and_partitioning() {
        for (partitioning, factor, segments, is_even, suited) in [
            (Partitioning::Integer, 6.3, 7, true, 7.0),
            (Partitioning::FractionalOdd, 6.3, 7, false, 6.3),
            (Partitioning::FractionalEven, 6.3, 8, false, 6.3),
            (Partitioning::FractionalEven, 8.0, 8, true, 8.0),
        ] {
            let cut = cut(partitioning, factor);
            let suits_integer = cut.suits(Partitioning::Integer, REACH);
            assert_eq!((cut.segments(), suits_integer), (segments, is_even), "{partitioning:?}");
            assert!((cut.factor() - suited).abs() < 0.01, "{partitioning:?}: {}", cut.factor());
            assert!(cut.suits(partitioning, REACH), "{partitioning:?}");
        }
        assert!(!cut(Partitioning::FractionalOdd, 6.3).suits(Partitioning::Integer, REACH));
        assert!(!cut(Partitioning::FractionalOdd, 6.3).suits(Partitioning::FractionalEven, REACH));
        assert!(!cut(Partitioning::Integer, 6.3).suits(Partitioning::Pow2, REACH));
    }

    #[test]
    fn a_side_runs_from_its_corner_to_the_next() {
        let points = [[1.0, 0.0], [0.0, 1.0], [0.0, 0.0], [0.0, 0.25]];
        let cut = |side| Cut::new(side, points.into_iter(), REACH).0;
        assert_eq!(cut(0), [0.0, 1.0]);
        // From corner 1 to corner 2, where the weight of corner 1 falls.
        assert_eq!(cut(1), [0.0, 0.75, 1.0]);
        assert_eq!(cut(2), [0.0, 1.0]);
    }
}

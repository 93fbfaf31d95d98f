//! Points of a patch's domain, and which of them is nearest to a place.

use geometry::tessellate::{Convention, FIXED_ONE, PatchFactors, corner_weights};

/// Points of one patch, as the weights of its corners 0 and 1.
#[derive(Clone, Debug, Default)]
pub(super) struct DomainPoints {
    /// In the order of the first weight, each with its number.
    sorted: Vec<([f64; 2], u32)>,
}

impl DomainPoints {
    /// Numbers points from 0 on.
    pub(super) fn new(points: impl Iterator<Item = [f64; 2]>) -> Self {
        let mut sorted: Vec<_> = points.zip(0..).collect();
        sorted.sort_by(|a, b| a.0[0].total_cmp(&b.0[0]));
        Self { sorted }
    }

    /// The number of the point that is nearest to a place, if one is within `reach` in both weights.
    pub(super) fn nearest(&self, at: [f64; 2], reach: f64) -> Option<u32> {
        self.within(at, reach).min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, number)| number)
    }

    /// The least number of a point that is within `reach` of a place in both weights.
    pub(super) fn first(&self, at: [f64; 2], reach: f64) -> Option<u32> {
        self.within(at, reach).map(|(_, number)| number).min()
    }

    /// The distances and numbers of the points within `reach` of a place.
    fn within(&self, [u, v]: [f64; 2], reach: f64) -> impl Iterator<Item = (f64, u32)> {
        let first = self.sorted.partition_point(|(point, _)| point[0] < u - reach);
        let near = self.sorted[first..].iter().take_while(move |(point, _)| point[0] <= u + reach);
        let near = near.map(move |(point, number)| ((point[0] - u).abs().max((point[1] - v).abs()), *number));
        near.filter(move |(distance, _)| *distance <= reach)
    }
}

/// The tessellator's points of a patch with these factors, as the weights of the patch's corners 0 and 1.
pub(super) fn pattern_points(factors: PatchFactors, convention: Convention) -> Vec<[f64; 2]> {
    let place = |weight| f64::from(weight) / f64::from(FIXED_ONE);
    factors.points().into_iter().map(|point| corner_weights(convention, point).map(place)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_point_is_found_within_reach_alone() {
        let points = DomainPoints::new([[0.5, 0.25], [0.0, 0.0], [0.5, 0.26]].into_iter());
        assert_eq!(points.nearest([0.502, 0.257], 0.02), Some(2));
        assert_eq!(points.nearest([0.502, 0.252], 0.02), Some(0));
        assert_eq!(points.nearest([0.6, 0.25], 0.02), None);
        assert_eq!(points.nearest([0.0, 0.1], 0.05), None);
    }
}

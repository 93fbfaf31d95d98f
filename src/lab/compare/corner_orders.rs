//! From which corner of a patch another program starts the tessellator's pattern, where only triangles tell.

use std::collections::BTreeSet;

use super::assignment::Part;
use super::domain_points::{DomainPoints, pattern_points};
use super::matching::Match;
use super::our_mesh::{OurPatch, is_thin, sorted};
use geometry::tessellate::{Convention, HullFactors, Partitioning, weight_corner};

/// An order of a patch's corners: where the tessellator's weights u, v and w belong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CornerOrder([usize; 3]);

impl CornerOrder {
    pub(super) const ALL: [Self; 6] =
        [Self([0, 1, 2]), Self([1, 2, 0]), Self([2, 0, 1]), Self([0, 2, 1]), Self([2, 1, 0]), Self([1, 0, 2])];

    /// The valid convention with this order; `None` if patches are wound the other way.
    pub fn convention(self) -> Option<Convention> {
        let is_own = |convention: &Convention| {
            convention.is_consistent() && (0..3).all(|i| weight_corner(*convention, i) as usize == self.0[i as usize])
        };
        Convention::ALL.into_iter().find(is_own)
    }

    /// The side of the patch that side k of the pattern lies on.
    fn side(self, k: usize) -> usize {
        let [from, to] = [self.0[k], self.0[(k + 1) % 3]];
        if (from + 1) % 3 == to { from } else { to }
    }

    /// Whether their triangles on a patch, whose points are ours, are those of the pattern in this order.
    pub(super) fn explains(
        self,
        part: &Part,
        own: &OurPatch,
        found: &Match,
        cut: (Convention, HullFactors, Partitioning),
    ) -> bool {
        let (convention, written, partitioning) = cut;
        let sides = written.cutting(convention);
        let turned = [0, 1, 2].map(|k| sides[self.side(k)]);
        let factors = HullFactors::from_sides(Convention::D3d11, turned, written.inside).rounded(partitioning);
        let factors = factors.process(partitioning);
        let points = DomainPoints::new(own.weights.iter().copied());
        // Patterns that are turned differ by a few units of fixed point inside.
        const REACH: f64 = 4.0 / 65536.0;
        let of_own = |[u, v]: [f64; 2]| {
            let mut weights = [0.0; 3];
            for (corner, weight) in self.0.into_iter().zip([u, v, 1.0 - u - v]) {
                weights[corner] = weight;
            }
            points.nearest([weights[0], weights[1]], REACH).map(|vertex| own.firsts[vertex as usize])
        };
        let vertices: Vec<_> = pattern_points(factors, Convention::D3d11).into_iter().map(of_own).collect();
        let pattern = triples(factors.triangles(), |vertex| vertices[vertex as usize]);
        let theirs = triples(part.triangles.iter().copied(), |vertex| {
            found.our_vertices[vertex as usize].map(|vertex| own.firsts[vertex as usize])
        });
        theirs.is_subset(&pattern)
    }
}

/// Triangles by their vertices, without order.
fn triples(
    triangles: impl IntoIterator<Item = [u32; 3]>,
    vertex: impl Fn(u32) -> Option<u32>,
) -> BTreeSet<[Option<u32>; 3]> {
    let named = triangles.into_iter().map(|triangle| sorted(triangle.map(&vertex)));
    named.filter(|triangle| !is_thin(*triangle)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turned_orders_are_conventions_and_mirrored_ones_are_none() {
        let named = CornerOrder::ALL.map(CornerOrder::convention);
        let [d3d11, amd, edges] = [Convention::D3d11, Convention::AmdPn, Convention::EdgeOrder].map(Some);
        assert_eq!(named, [d3d11, amd, edges, None, None, None]);
        for order in CornerOrder::ALL {
            let mut sides = [0, 1, 2].map(|k| order.side(k));
            sides.sort_unstable();
            assert_eq!(sides, [0, 1, 2], "{order:?}");
        }
        // From corner 0 to corner 2 is side 2.
        assert_eq!(CornerOrder([0, 2, 1]).side(0), 2);
    }
}

//! The outlines of patches, gathered from what was emitted: the points that each side of an edge has.

use std::ops::RangeInclusive;

use glam::{DVec3, Vec3};

use super::requested_factors::RequestedFactors;
use geometry::mesh::{EdgeKind, Side, Topology};
use geometry::tessellate::{
    Convention, FIXED_ONE, MOST_ROWS, PatchFactors, Vertex, domain_plan, domain_point, domain_side, outer_count,
    patch_has_rows, patch_is_culled, patch_is_low, point_count, segments,
};

/// A vertex on a patch's outline.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OutlinePoint {
    /// In object units.
    pub position: [f32; 3],
    /// See [`geometry::tessellate::pack_normal`].
    pub normal: u32,
}

/// The outline of every patch, and the factors with which it was emitted.
#[derive(Clone, Debug, Default)]
pub struct Outlines {
    factors: Vec<PatchFactors>,
    /// The outline of patch p is `points[starts[p]..starts[p + 1]]`, in the tessellator's order.
    starts: Vec<u32>,
    points: Vec<OutlinePoint>,
    requested: RequestedFactors,
}

/// The emitted points along the edges of a patch (an index into [`Topology::patches`]) that factors 0, 1 and 2 cut. Without
/// outlines, or if nothing was emitted, each edge has its two ends.
pub fn patch_edges(
    topology: &Topology,
    patch: u32,
    outlines: Option<&Outlines>,
    convention: Convention,
) -> [Vec<Vec3>; 3] {
    let corners = topology.patch_positions(patch);
    let sides = outlines.and_then(|outlines| outlines.patch(topology, patch));
    [0, 1, 2].map(|i| {
        let k = domain_side(convention, i) as usize;
        match &sides {
            Some(sides) => sides[k].positions().collect(),
            None => vec![corners[k], corners[(k + 1) % 3]],
        }
    })
}

/// The sum of the emitted triangles' areas of a patch (an index into [`Topology::patches`]), each in the direction that it faces, times
/// 2. Its border alone decides it. Without outlines, or if nothing was emitted, it is that of the mesh's triangle.
pub fn patch_facing(topology: &Topology, patch: u32, outlines: Option<&Outlines>) -> DVec3 {
    let corners = topology.patch_positions(patch);
    let emitted = outlines.and_then(|outlines| outlines.patch(topology, patch));
    let along = |k: usize| {
        let Some(emitted) = &emitted else { return vec![corners[k], corners[(k + 1) % 3]] };
        let mut points: Vec<Vec3> = emitted[k].positions().collect();
        if topology.sides[topology.patches[patch as usize].sides[k] as usize].reversed() {
            points.reverse();
        }
        points
    };
    let from_corner = |point: Vec3| (point - corners[0]).as_dvec3();
    let of_side =
        |points: Vec<Vec3>| -> DVec3 { points.windows(2).map(|p| from_corner(p[0]).cross(from_corner(p[1]))).sum() };
    (0..3).map(along).map(of_side).sum()
}

/// How wide a patch is, as a part of its longest side.
pub fn patch_width(topology: &Topology, patch: u32, outlines: Option<&Outlines>) -> f32 {
    let [a, b, c] = topology.patch_positions(patch);
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    patch_facing(topology, patch, outlines).length() as f32 / longest.powi(2)
}

/// The points of one side of an edge.
#[derive(Clone, Debug, PartialEq)]
pub struct EdgeSide {
    /// Index into [`Topology::patches`].
    pub patch: u32,
    /// Index into the mesh's triangles.
    pub triangle: u32,
    /// The factor that LOD or a file gave, before the tessellator clamped and rounded it. Under a wrong convention it is that of
    /// another edge.
    pub factor: f32,
    /// The factor after clamping and rounding: its word in [`PatchFactors`].
    pub word: u32,
    /// The points in the edge's direction, with both ends.
    pub points: Vec<OutlinePoint>,
}

impl EdgeSide {
    /// The number of segments that the side was cut into.
    pub fn segments(&self) -> u32 {
        segments(self.word)
    }

    /// The positions of its points, in object units.
    pub fn positions(&self) -> impl Iterator<Item = Vec3> {
        self.points.iter().map(|point| Vec3::from(point.position))
    }
}

impl Outlines {
    /// Makes room for the outlines of patches with these factors.
    pub fn new(factors: Vec<PatchFactors>, requested: RequestedFactors) -> Self {
        let mut starts = vec![0];
        let mut end = 0;
        for &patch in &factors {
            end += outer_count(patch);
            starts.push(end);
        }
        Self { factors, starts, points: vec![OutlinePoint::default(); end as usize], requested }
    }

    /// Takes the vertices of whole patches in order, from `first_patch` on.
    pub fn take(&mut self, first_patch: u32, vertices: &[Vertex]) {
        let mut rest = vertices;
        for patch in first_patch as usize..self.factors.len() {
            let count = point_count(self.factors[patch]) as usize;
            if rest.len() < count {
                break;
            }
            let (own, later) = rest.split_at(count);
            let outline = &mut self.points[self.starts[patch] as usize..self.starts[patch + 1] as usize];
            outline
                .iter_mut()
                .zip(own)
                .for_each(|(to, v)| *to = OutlinePoint { position: v.position, normal: v.normal });
            rest = later;
        }
    }

    /// The number of emitted patches with a factor of 63 or more (of rows the largest), which may have requested a larger one than
    /// there is.
    pub fn at_limit(&self) -> u32 {
        let any = |factors: &&PatchFactors| {
            let last = if patch_has_rows(**factors) { MOST_ROWS } else { 63 };
            let is_last = |word: u32| segments(word) >= last;
            !patch_is_culled(**factors) && (is_last(factors.inside) || factors.outside.into_iter().any(is_last))
        };
        self.factors.iter().filter(any).count() as u32
    }

    /// The number of emitted patches whose factors are all below 2.
    pub fn low(&self) -> u32 {
        self.factors.iter().filter(|&&factors| patch_is_low(factors)).count() as u32
    }

    /// The sides of an edge (an index into [`Topology::edges`]). Patches that emit nothing are left out.
    pub fn edge(&self, topology: &Topology, edge: u32) -> Vec<EdgeSide> {
        topology.side_range(&topology.edges[edge as usize]).filter_map(|side| self.side(topology, side)).collect()
    }

    /// The sides of an edge whose patches are left out since a factor of theirs isn't greater than zero; they have no points. What is out
    /// of view or faces away isn't among them, since its place shows no hole.
    pub fn discarded(&self, topology: &Topology, edge: u32) -> Vec<EdgeSide> {
        let sides = topology.edge_sides(&topology.edges[edge as usize]).iter();
        let discarded = sides.filter(|side| self.factors[side.patch() as usize] == PatchFactors::default());
        discarded.map(|side| self.side_without_points(topology, *side)).collect()
    }

    /// Sides 0, 1 and 2 of a patch (an index into [`Topology::patches`]); `None` if it emits nothing.
    pub fn patch(&self, topology: &Topology, patch: u32) -> Option<[EdgeSide; 3]> {
        let [a, b, c] = topology.patches[patch as usize].sides.map(|side| self.side(topology, side));
        Some([a?, b?, c?])
    }

    /// The factors with which a patch was emitted.
    pub fn factors(&self, patch: u32) -> PatchFactors {
        self.factors[patch as usize]
    }

    /// The edges with several sides, as indices in [`Topology::edges`], with the sides of each as [`Self::edge`] has them.
    pub fn shared_edges(&self, topology: &Topology) -> impl Iterator<Item = (u32, Vec<EdgeSide>)> {
        let shared = (0..).zip(&topology.edges).filter(|(_, edge)| edge.kind != EdgeKind::Boundary);
        shared.map(|(index, _)| (index, self.edge(topology, index)))
    }

    /// Where the points of a side (an index into [`Topology::sides`]) lie on its edge: the weight of the edge's end at each, in
    /// 16.16 fixed point. Empty if its patch emits nothing.
    pub fn weights(&self, topology: &Topology, index: u32) -> Vec<u32> {
        let side = topology.sides[index as usize];
        let Some((_, range)) = self.side_points(side) else { return Vec::new() };
        let count = self.outline(side.patch()).len() as u32;
        let plan = domain_plan(self.factors[side.patch() as usize]);
        let weights = |point: u32| {
            let [u, v] = domain_point(&plan, point % count);
            [u, v, FIXED_ONE - u - v]
        };
        // Whichever corner of the domain it is, its weight is 1 where the edge ends.
        let end = if side.reversed() { *range.start() } else { *range.end() };
        let corner = weights(end).iter().position(|&weight| weight == FIXED_ONE).unwrap_or(0);
        let mut all: Vec<u32> = range.map(|point| weights(point)[corner]).collect();
        if side.reversed() {
            all.reverse();
        }
        all
    }

    /// Which of its patch's factors cuts a side, and the numbers of its points on the patch's outline, where the last may be the
    /// first of all once more. `None` if the patch emits nothing.
    fn side_points(&self, side: Side) -> Option<(usize, RangeInclusive<u32>)> {
        if self.outline(side.patch()).is_empty() {
            return None;
        }
        // The outline has the edges of factors 0, 1 and 2 one after another.
        let words = self.factors[side.patch() as usize].outside;
        let factor = self.requested.index(side.index());
        let first: u32 = words[..factor].iter().map(|&word| segments(word)).sum();
        Some((factor, first..=first + segments(words[factor])))
    }

    fn side(&self, topology: &Topology, index: u32) -> Option<EdgeSide> {
        let side = topology.sides[index as usize];
        let (_, range) = self.side_points(side)?;
        let outline = self.outline(side.patch());
        let mut points: Vec<_> = range.map(|p| outline[p as usize % outline.len()]).collect();
        if side.reversed() {
            points.reverse();
        }
        Some(EdgeSide { points, ..self.side_without_points(topology, side) })
    }

    fn side_without_points(&self, topology: &Topology, side: Side) -> EdgeSide {
        let (patch, factor) = (side.patch(), self.requested.index(side.index()));
        let triangle = topology.patches[patch as usize].triangle;
        let word = self.factors[patch as usize].outside[factor];
        EdgeSide { patch, triangle, factor: self.requested.of(topology, patch, factor), word, points: Vec::new() }
    }

    /// A patch's outline, in the tessellator's order.
    fn outline(&self, patch: u32) -> &[OutlinePoint] {
        let patch = patch as usize;
        &self.points[self.starts[patch] as usize..self.starts[patch + 1] as usize]
    }
}

#[cfg(test)]
impl Outlines {
    /// A patch's outline, for tests that change it.
    pub(super) fn outline_mut(&mut self, patch: u32) -> &mut [OutlinePoint] {
        let patch = patch as usize;
        &mut self.points[self.starts[patch] as usize..self.starts[patch + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::tessellate::{Edges, Partitioning, process};

    #[test]
    fn patches_at_the_limit_and_below_2_are_counted_without_culled_ones() {
        let of = |edges, inside| process(Partitioning::Integer, edges, inside);
        let factors = vec![
            of([64.0, 1.0, 1.0], 2.0),
            of([3.0; 3], 64.0),
            of([63.5; 3], 9.0),
            of([1.0; 3], 1.0),
            of([0.0; 3], 64.0),
        ];
        let requested = RequestedFactors::new(Edges::PerEdge, Convention::D3d11, Vec::new());
        let outlines = Outlines::new(factors, requested);
        assert_eq!((outlines.at_limit(), outlines.low()), (3, 1));
    }
}

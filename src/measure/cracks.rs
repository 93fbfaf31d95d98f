//! Cracks: for every edge, whether all sides put its points at the same place, to the last bit.

use glam::{Mat4, Vec2, Vec3};

use crate::mesh::Topology;
use crate::render::{LineSegment, project};
use crate::tessellate::{PatchFactors, Vertex, outer_count, point_count, segments};

/// The outer ring of every patch, gathered from the emitted vertices chunk by chunk.
pub struct Rims {
    factors: Vec<PatchFactors>,
    /// Ring of patch p: `positions[starts[p]..starts[p + 1]]`, in the tessellator's order.
    starts: Vec<u32>,
    positions: Vec<[f32; 3]>,
}

/// What was found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cracks {
    /// Points of edges that were compared: on every edge with several sides, each point once for each side after the
    /// first.
    pub edge_points: u64,
    /// Those that differ in at least one bit of one coordinate.
    pub different_bits: u64,
    /// Edges with such a point, the widest gap first.
    pub edges: Vec<CrackedEdge>,
}

/// An edge whose sides disagree.
#[derive(Clone, Debug, PartialEq)]
pub struct CrackedEdge {
    /// Index in [`Topology::edges`].
    pub edge: u32,
    /// Points that differ.
    pub different_bits: u32,
    /// The largest distance between two sides' positions of one point, in object units.
    pub gap: f64,
    /// Those two positions.
    pub widest: [Vec3; 2],
    /// The points of every side that differs from those before it, in the edge's direction.
    pub sides: Vec<Vec<Vec3>>,
}

/// One unit in the last place of the largest coordinate in magnitude, in object units.
pub fn ulp(topology: &Topology) -> f64 {
    let largest = topology.points.iter().map(|p| p.abs().max_element()).fold(0.0, f32::max);
    f64::from(largest.next_up()) - f64::from(largest)
}

impl Rims {
    /// Room for the rims of patches with these factors.
    pub fn new(factors: Vec<PatchFactors>) -> Self {
        let mut starts = vec![0];
        let mut end = 0;
        for &patch in &factors {
            end += outer_count(patch);
            starts.push(end);
        }
        Self { factors, starts, positions: vec![[0.0; 3]; end as usize] }
    }

    /// Takes the vertices of patches from `first_patch` on; whole patches, in order.
    pub fn take(&mut self, first_patch: u32, vertices: &[Vertex]) {
        let mut rest = vertices;
        for patch in first_patch as usize..self.factors.len() {
            let count = point_count(self.factors[patch]) as usize;
            if rest.len() < count {
                break;
            }
            let (own, later) = rest.split_at(count);
            let ring = &mut self.positions[self.starts[patch] as usize..self.starts[patch + 1] as usize];
            ring.iter_mut().zip(own).for_each(|(to, vertex)| *to = vertex.position);
            rest = later;
        }
    }

    /// How many patches emit nothing.
    pub fn culled(&self) -> u32 {
        self.starts.windows(2).filter(|ring| ring[0] == ring[1]).count() as u32
    }

    /// The points of side `side` (from corner `side` to the next) of a patch, in the edge's direction; none if the patch
    /// emits nothing.
    fn side(&self, patch: u32, side: usize, reversed: bool) -> Option<Vec<[f32; 3]>> {
        let patch = patch as usize;
        let ring = &self.positions[self.starts[patch] as usize..self.starts[patch + 1] as usize];
        if ring.is_empty() {
            return None;
        }
        // The ring starts with factor 0's edge, which is side 1.
        let lengths = self.factors[patch].outside.map(segments);
        let factor = (side + 2) % 3;
        let first: u32 = lengths[..factor].iter().sum();
        let mut points: Vec<_> = (first..=first + lengths[factor]).map(|p| ring[p as usize % ring.len()]).collect();
        if reversed {
            points.reverse();
        }
        Some(points)
    }

    /// Compares every edge's sides.
    pub fn cracks(&self, topology: &Topology) -> Cracks {
        let mut cracks = Cracks::default();
        for (index, edge) in topology.edges.iter().enumerate() {
            if edge.sides.len() < 2 {
                continue;
            }
            let sides = edge.sides.clone().filter_map(|side| {
                let side = &topology.sides[side as usize];
                self.side(side.patch, usize::from(side.index), side.reversed)
            });
            let sides: Vec<_> = sides.collect();
            let (points, crack) = compare_sides(index as u32, &sides);
            cracks.edge_points += points;
            if let Some(crack) = crack {
                cracks.different_bits += u64::from(crack.different_bits);
                cracks.edges.push(crack);
            }
        }
        cracks.edges.sort_by(|a, b| b.gap.total_cmp(&a.gap));
        cracks
    }
}

/// Distinct sides of one edge that are compared with one another; more are compared with the first alone.
const PAIRED_SIDES: usize = 64;

/// How many points were compared, and the crack if any differs.
fn compare_sides(edge: u32, sides: &[Vec<[f32; 3]>]) -> (u64, Option<CrackedEdge>) {
    let Some((first, others)) = sides.split_first() else { return (0, None) };
    let compared = others.iter().map(|other| first.len().max(other.len()) as u64).sum();
    let different: u64 = others.iter().map(|other| different_points(first, other)).sum();
    if different == 0 {
        return (compared, None);
    }
    let mut distinct: Vec<&Vec<[f32; 3]>> = vec![first];
    for other in others {
        if distinct.iter().take(PAIRED_SIDES).all(|known| different_points(known, other) > 0) {
            distinct.push(other);
        }
    }
    let (mut gap, mut widest) = (0.0, [Vec3::ZERO; 2]);
    for (index, side) in distinct.iter().enumerate() {
        let earlier = if index < PAIRED_SIDES { index } else { 1 };
        for other in &distinct[..earlier] {
            for (a, b) in side.iter().zip(*other).map(|(a, b)| (Vec3::from(*a), Vec3::from(*b))) {
                let distance = a.as_dvec3().distance(b.as_dvec3());
                // Positions that are not finite are as far apart as can be.
                let distance = if distance.is_nan() { f64::INFINITY } else { distance };
                if distance >= gap {
                    (gap, widest) = (distance, [a, b]);
                }
            }
        }
    }
    let sides = distinct.iter().map(|side| side.iter().copied().map(Vec3::from).collect()).collect();
    (compared, Some(CrackedEdge { edge, different_bits: different as u32, gap, widest, sides }))
}

/// Points that differ in at least one bit; those that one side doesn't have differ from whatever is there.
fn different_points(a: &[[f32; 3]], b: &[[f32; 3]]) -> u64 {
    let differ = |(a, b): &(&[f32; 3], &[f32; 3])| a.map(f32::to_bits) != b.map(f32::to_bits);
    a.iter().zip(b).filter(differ).count() as u64 + a.len().abs_diff(b.len()) as u64
}

impl Cracks {
    /// The widest gap, in object units.
    pub fn max_gap(&self) -> f64 {
        self.edges.first().map_or(0.0, |edge| edge.gap)
    }

    /// The widest gap on screen, in px, of those that are the widest of their edge.
    pub fn max_gap_px(&self, clip_from_object: Mat4, viewport: Vec2) -> f64 {
        let on_screen = |edge: &CrackedEdge| {
            let [a, b] = edge.widest.map(|p| project(clip_from_object, viewport, p));
            a.zip(b).map_or(0.0, |(a, b)| f64::from(a.distance(b)))
        };
        self.edges.iter().map(on_screen).fold(0.0, f64::max)
    }

    /// Every side of every cracked edge, as lines.
    pub fn lines(&self) -> Vec<LineSegment> {
        let sides = self.edges.iter().flat_map(|edge| &edge.sides);
        let segments = sides.flat_map(|side| side.windows(2));
        segments.map(|ends| LineSegment { start: ends[0].to_array(), end: ends[1].to_array() }).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Shape;
    use crate::settings::Settings;
    use crate::tessellate::{Lod, LodView, Partitioning, Surface, tessellate};

    fn rims(shape: Shape, surface: Surface, partitioning: Partitioning) -> (Topology, Rims) {
        let mesh = shape.build();
        let topology = Topology::build(&mesh, &Default::default()).expect("nobody cancels");
        let view = LodView { clip_from_object: Mat4::IDENTITY, half_viewport: Vec2::splat(300.0) };
        let settings = Settings { surface, partitioning, lod: Lod::Paper, ..Settings::default() };
        let out = tessellate(&mesh, &topology, &settings.inputs(view), None);
        let mut rims = Rims::new(out.patch_factors);
        rims.take(0, &out.vertices);
        (topology, rims)
    }

    #[test]
    fn averaging_over_sides_closes_what_split_normals_tear() {
        for partitioning in Partitioning::ALL {
            let (topology, torn) = rims(Shape::CubeSplit, Surface::Pn, partitioning);
            let torn = torn.cracks(&topology);
            assert_eq!(torn.edges.len(), 12, "the cube's own edges, not its faces' diagonals");
            assert!(torn.max_gap() > 0.01);
            for surface in [Surface::Flat, Surface::PnAen] {
                let (topology, closed) = rims(Shape::CubeSplit, surface, partitioning);
                let closed = closed.cracks(&topology);
                assert_eq!((closed.different_bits, closed.edges.len()), (0, 0));
                assert!(closed.edge_points > 18);
            }
        }
    }

    #[test]
    fn one_bit_of_one_point_is_a_crack() {
        let (topology, mut rims) = rims(Shape::Torus, Surface::PnAen, Partitioning::FractionalOdd);
        assert_eq!(rims.cracks(&topology).different_bits, 0);
        // The second point of patch 5's ring lies inside side 1.
        let at = rims.starts[5] as usize + 1;
        rims.positions[at][0] = rims.positions[at][0].next_up();
        let cracks = rims.cracks(&topology);
        let side = topology.patches[5].sides[1];
        assert_eq!((cracks.different_bits, cracks.edges.len()), (1, 1));
        assert_eq!(cracks.edges[0].edge, topology.sides[side as usize].edge);
    }

    #[test]
    fn the_largest_gap_may_lie_between_any_two_sides() {
        let side = |x: f32| vec![[0.0; 3], [x, 0.0, 0.0], [0.0; 3]];
        let (compared, crack) = compare_sides(7, &[side(0.0), side(-0.25), side(0.5), side(0.5)]);
        let crack = crack.expect("they differ");
        assert_eq!((compared, crack.different_bits, crack.edge), (9, 3, 7));
        assert_eq!((crack.gap, crack.sides.len()), (0.75, 3));
        let (_, none) = compare_sides(0, &[side(1.0), side(1.0)]);
        assert_eq!(none, None);
        let (_, nan) = compare_sides(0, &[side(1.0), side(f32::NAN)]);
        assert_eq!(nan.map(|crack| crack.gap), Some(f64::INFINITY));
    }

    #[test]
    fn an_ulp_is_that_of_the_largest_coordinate() {
        let topology = Topology { points: vec![Vec3::new(0.1, -3.0, 0.2), Vec3::ONE], ..Topology::default() };
        assert_eq!(ulp(&topology), 2f64.powi(-22));
    }
}

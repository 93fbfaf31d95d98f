//! Computes where edges are cut, once for all sides of an edge.

use glam::{DVec3, Vec3};

use super::fans::{Fans, blend, corner_at, shared};
use crate::casts::{to_f32, to_u32};
use crate::mesh::{Edge, Side};

/// The greatest part of an edge between an end and the cut near it.
const LARGEST_PART: f64 = 1.0 / 3.0;
/// The least width, in units in the last place (ULP) of the largest coordinate.
const LEAST_ULP: f64 = 8.0;
/// An edge that meets a crease at an acute angle is cut farther from its end, so that the band beside the crease keeps
/// its width. The distance is divided by the angle's sine, but by no less than this: half, which is enough for 30
/// degrees.
const LEAST_SINE: f64 = 0.5;

/// A point on an edge, and the normal that all its sides have there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cut {
    /// The distance from the end near it, as a part of the edge's length.
    pub part: f32,
    pub position: Vec3,
    pub normal: Vec3,
}

/// The cuts of an edge near its ends, in its own direction.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct EdgeCuts {
    pub is_creased: bool,
    pub ends: [Option<Cut>; 2],
}

/// The cuts of all edges.
pub(super) struct Cuts<'a> {
    pub fans: &'a Fans<'a>,
    /// The band's width, in object units.
    pub width: f64,
    /// One for each of the topology's edges.
    pub edges: Vec<EdgeCuts>,
    /// The number of edges that are too short for the width.
    pub narrowed: u32,
}

impl<'a> Cuts<'a> {
    /// Cuts all edges. `width` is relative to the bounding diagonal.
    pub(super) fn new(fans: &'a Fans, width: f32) -> Self {
        let topology = fans.topology;
        let largest = topology.points.iter().map(|p| p.abs().max_element()).fold(0.0, f32::max);
        let least = LEAST_ULP * f64::from(largest) * f64::from(f32::EPSILON);
        let width = fans.mesh.bounds().part(width.into()).max(least);
        let is_creased = |edge: &Edge| {
            let sides = topology.edge_sides(edge);
            (0..2).any(|end| sides.iter().any(|side| fans.own_normal(side, end) != fans.own_normal(&sides[0], end)))
        };
        let edges = topology.edges.iter().map(|edge| EdgeCuts { is_creased: is_creased(edge), ..EdgeCuts::default() });
        let mut cuts = Self { fans, width, edges: edges.collect(), narrowed: 0 };
        for (index, edge) in topology.edges.iter().enumerate() {
            let reach = [0, 1].map(|end| cuts.reach(edge, end).map(|reach| width * reach));
            let [a, b] = topology.edge_points(edge).map(|point| topology.points[point as usize].as_dvec3());
            let most = LARGEST_PART * a.distance(b);
            cuts.narrowed += u32::from(reach.iter().flatten().any(|reach| *reach > most));
            let sides = topology.edge_sides(edge);
            cuts.edges[index].ends = [0, 1].map(|end| {
                let part = reach[end]?.min(most) / a.distance(b);
                let (from, to) = if end == 0 { (a, b) } else { (b, a) };
                let position = from.lerp(to, part).as_vec3();
                let normal = |side: &Side, end: usize| fans.own_normal(side, end);
                let at = |side: &Side| blend([(1.0 - part, normal(side, end)), (part, normal(side, 1 - end))]);
                // In f32, a cut so near the end may be the end point itself.
                let is_apart = position.as_dvec3() != from;
                let normal = fans.normal_at(&sides[0], end).filter(|_| !is_apart);
                let normal = normal.unwrap_or_else(|| shared(sides.iter().map(at)));
                Some(Cut { part: to_f32(part), position, normal })
            });
        }
        cuts
    }

    /// Returns the number of edges with split normals.
    pub(super) fn creases(&self) -> u32 {
        to_u32(self.edges.iter().filter(|edge| edge.is_creased).count())
    }

    /// Returns how far from an end an edge is cut, as a multiple of the width; none if it isn't cut there.
    fn reach(&self, edge: &Edge, end: usize) -> Option<f64> {
        let sides = self.fans.topology.edge_sides(edge);
        let normal_there = self.fans.normal_at(&sides[0], end)?;
        if !self.edges[sides[0].edge as usize].is_creased {
            return Some(sides.iter().map(|side| self.slant(side, end)).fold(1.0, f64::max));
        }
        // Where the point's fan has more normals than this crease's sides, the crease is cut too: so the normal of the
        // whole fan only bends the surface near the point.
        let own = shared(sides.iter().map(|side| self.fans.own_normal(side, end)));
        (own != normal_there).then_some(1.0)
    }

    /// Returns how far from an end an edge must be cut so that the band of the creased edge beside it, on this side,
    /// keeps its width. The result is a multiple of the width: 1 if that other edge has no crease.
    fn slant(&self, side: &Side, end: usize) -> f64 {
        let topology = self.fans.topology;
        let k = corner_at(side, end);
        let other = if k == side.index() { (k + 2) % 3 } else { k };
        let patch = &topology.patches[side.patch() as usize];
        let other = topology.sides[patch.sides[other] as usize].edge;
        if !self.edges[other as usize].is_creased {
            return 1.0;
        }
        let p = topology.patch_positions(side.patch()).map(Vec3::as_dvec3);
        1.0 / sine(p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]).max(LEAST_SINE)
    }
}

/// Returns the sine of the angle between two vectors.
fn sine(a: DVec3, b: DVec3) -> f64 {
    a.normalize().cross(b.normalize()).length()
}

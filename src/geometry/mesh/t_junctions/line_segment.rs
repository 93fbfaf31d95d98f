//! The straight line between an edge's ends.

use glam::DVec3;

use crate::mesh::{Edge, Topology};

/// A straight segment with a length above 0, in object units. In f64, since squares of very small or large lengths
/// leave f32.
#[derive(Clone, Copy, Debug)]
pub(super) struct LineSegment {
    pub ends: [DVec3; 2],
}

impl LineSegment {
    pub(super) fn from_edge(topology: &Topology, edge: &Edge) -> Self {
        Self { ends: topology.edge_points(edge).map(|point| topology.points[point as usize].as_dvec3()) }
    }

    pub(super) fn way(&self) -> DVec3 {
        self.ends[1] - self.ends[0]
    }

    pub(super) fn length(&self) -> f64 {
        self.way().length()
    }

    /// Returns where along the segment a position lies, 0 at its start and 1 at its end, and its distance from the
    /// line.
    pub(super) fn project(&self, place: DVec3) -> (f64, f64) {
        let t = (place - self.ends[0]).dot(self.way()) / self.way().length_squared();
        (t, place.distance(self.ends[0] + t * self.way()))
    }

    /// Returns the vector from the line to a position, at right angles to the line.
    pub(super) fn across(&self, place: DVec3) -> DVec3 {
        let (t, _) = self.project(place);
        place - (self.ends[0] + t * self.way())
    }
}

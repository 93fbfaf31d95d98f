//! The faces, sides and edges of a cage, or of what it is refined to.

use std::ops::Range;

use super::Linear;
use crate::casts::to_u32;

/// Stands for a side that doesn't exist.
pub(super) const NONE: u32 = u32::MAX;

/// Which sides form which face. The sides of a face follow one another, in the order of its corners.
#[derive(Clone)]
pub(super) enum Polygons {
    Triangles,
    Quads,
    /// Polygons of different numbers of corners: the first side of each face, then the number of all sides; and the face of
    /// each side.
    Mixed {
        starts: Vec<u32>,
        face_of: Vec<u32>,
    },
}

impl Polygons {
    /// The face that a side belongs to.
    pub(super) fn face_of(&self, side: u32) -> u32 {
        match self {
            Self::Triangles => side / 3,
            Self::Quads => side / 4,
            Self::Mixed { face_of, .. } => face_of[side as usize],
        }
    }

    /// The sides of a face.
    pub(super) fn sides(&self, face: u32) -> Range<u32> {
        match self {
            Self::Triangles => 3 * face..3 * face + 3,
            Self::Quads => 4 * face..4 * face + 4,
            Self::Mixed { starts, .. } => starts[face as usize]..starts[face as usize + 1],
        }
    }

    /// The mean of what the sides of a face have.
    pub(super) fn mean<T: Linear>(&self, face: u32, value: impl Fn(u32) -> T) -> T {
        let sides = self.sides(face);
        let share = 1.0 / f64::from(sides.end - sides.start);
        sides.fold(T::default(), |sum, side| sum + value(side)) * share
    }

    /// The side that follows in its face.
    pub(super) fn after(&self, side: u32) -> u32 {
        let sides = self.sides(self.face_of(side));
        if side + 1 == sides.end { sides.start } else { side + 1 }
    }

    /// The side that precedes it in its face.
    pub(super) fn before(&self, side: u32) -> u32 {
        let sides = self.sides(self.face_of(side));
        if side == sides.start { sides.end - 1 } else { side - 1 }
    }
}

/// The connectivity of a cage, or of one level of its refinement. Edges that come last and have no sharpness of their own are
/// smooth, and so are such points: only what comes from a sharp edge or point of the cage can be sharp.
pub(super) struct Level {
    pub(super) points: usize,
    pub(super) polygons: Polygons,
    /// The point that each side starts at. A side runs from a corner of its face to the next one, and has the corner's number.
    pub(super) origins: Vec<u32>,
    /// The edge that each side lies on.
    pub(super) edges: Vec<u32>,
    /// The one or two sides on each edge. The edge runs as the first one does; without a second one it is a boundary.
    pub(super) edge_sides: Vec<[u32; 2]>,
    pub(super) edge_sharpness: Vec<f32>,
    pub(super) point_sharpness: Vec<f32>,
    /// For each point, the side from which all faces around it are reached counter-clockwise. None if there isn't one: the
    /// point is in no face, several fans of faces meet there, or faces of opposite directions. Such points stay where they are.
    pub(super) first_sides: Vec<u32>,
}

/// An edge at a point.
pub(super) struct Spoke {
    pub(super) edge: u32,
    /// The point at the edge's other end.
    pub(super) far: u32,
    /// The side that leaves the point there, in the face that follows counter-clockwise. None at the end of an open fan.
    pub(super) side: Option<u32>,
}

impl Level {
    /// How many faces there are.
    pub(super) fn faces(&self) -> u32 {
        match &self.polygons {
            Polygons::Triangles => to_u32(self.origins.len()) / 3,
            Polygons::Quads => to_u32(self.origins.len()) / 4,
            Polygons::Mixed { starts, .. } => to_u32(starts.len() - 1),
        }
    }

    pub(super) fn edge_sharpness(&self, edge: u32) -> f32 {
        self.edge_sharpness.get(edge as usize).copied().unwrap_or(0.0)
    }

    pub(super) fn point_sharpness(&self, point: u32) -> f32 {
        self.point_sharpness.get(point as usize).copied().unwrap_or(0.0)
    }

    /// The point that a side ends at.
    pub(super) fn end(&self, side: u32) -> u32 {
        self.origins[self.polygons.after(side) as usize]
    }

    /// The other side on a side's edge, if it runs the opposite way.
    pub(super) fn twin(&self, side: u32) -> Option<u32> {
        let [a, b] = self.edge_sides[self.edges[side as usize] as usize];
        let other = if a == side { b } else { a };
        (other != NONE && self.origins[other as usize] != self.origins[side as usize]).then_some(other)
    }

    /// Whether two faces run the same way along an edge, as where a mesh is turned inside out.
    pub(super) fn is_inconsistent(&self, [a, b]: [u32; 2]) -> bool {
        b != NONE && self.origins[a as usize] == self.origins[b as usize]
    }

    /// The side from which all faces around a point are reached counter-clockwise.
    pub(super) fn first_side(&self, point: u32) -> Option<u32> {
        Some(self.first_sides[point as usize]).filter(|&side| side != NONE)
    }

    /// The edges around the point where a side starts, counter-clockwise from that side: once around, or up to an edge that
    /// has no other face.
    pub(super) fn ring(&self, first: u32) -> impl Iterator<Item = Spoke> {
        let (mut side, mut last) = (Some(first), None);
        std::iter::from_fn(move || {
            let Some(leaving) = side else {
                let last = Option::take(&mut last)?;
                return Some(Spoke { edge: self.edges[last as usize], far: self.origins[last as usize], side: None });
            };
            let arriving = self.polygons.before(leaving);
            let next = self.twin(arriving);
            side = next.filter(|&next| next != first);
            last = next.is_none().then_some(arriving);
            Some(Spoke { edge: self.edges[leaving as usize], far: self.end(leaving), side: Some(leaving) })
        })
    }
}

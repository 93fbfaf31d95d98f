//! Divides the faces and edges of a level, and numbers what comes of them.
//!
//! The points of the finer level are the points, then a point for each edge, then for Catmull-Clark one for each face. Its
//! edges are two halves of each edge, then an inner one for each side: for Catmull-Clark from the side's edge to the center, for
//! the other schemes the one that cuts off the corner where the side starts. Its faces are one for each corner, which is their
//! first; the other schemes have a fourth one in the middle of each triangle.

use rayon::prelude::*;

use super::Scheme;
use super::cage::INFINITELY_SHARP;
use super::level::{Level, NONE, Polygons};
use crate::casts::to_u32;

/// What is left of a sharpness one level finer. Source: DeRose, Kass and Truong 1998.
pub(super) fn decayed(sharpness: f32) -> f32 {
    if sharpness >= INFINITELY_SHARP { sharpness } else { (sharpness - 1.0).max(0.0) }
}

impl Scheme {
    /// The side of the finer level that leaves the point where a side starts, along that side.
    fn leaving(self, side: u32) -> u32 {
        match self {
            Self::CatmullClark => 4 * side,
            Self::Loop | Self::Butterfly => 3 * (side + side / 3),
        }
    }

    /// The side of the finer level that arrives at the point where a side starts, in the same face.
    fn arriving(self, side: u32) -> u32 {
        self.leaving(side) + if self == Self::CatmullClark { 3 } else { 2 }
    }
}

impl Level {
    /// Divides each face and edge.
    pub(super) fn split(&self, scheme: Scheme) -> Self {
        let (polygons, faces) = match scheme {
            Scheme::CatmullClark => (Polygons::Quads, self.faces()),
            Scheme::Loop | Scheme::Butterfly => (Polygons::Triangles, 0),
        };
        let halves = self.edge_sharpness.iter().flat_map(|&sharpness| [decayed(sharpness); 2]);
        Self {
            points: self.points + self.edge_sides.len() + faces as usize,
            polygons,
            origins: self.finer_origins(scheme),
            edges: self.finer_edges(scheme),
            edge_sides: self.finer_edge_sides(scheme),
            edge_sharpness: halves.collect(),
            point_sharpness: self.point_sharpness.iter().copied().map(decayed).collect(),
            first_sides: self.finer_first_sides(scheme, faces),
        }
    }

    /// The point that each side of the finer level starts at.
    fn finer_origins(&self, scheme: Scheme) -> Vec<u32> {
        let [points, edges] = [self.points, self.edge_sides.len()].map(to_u32);
        let middle = |side: u32| points + self.edges[side as usize];
        let other = |side: u32| match scheme {
            Scheme::CatmullClark => points + edges + self.polygons.face_of(side),
            Scheme::Loop | Scheme::Butterfly => middle(side),
        };
        let corner = |side: u32, before: u32| [self.origins[side as usize], middle(side), middle(before)];
        of_corners(self, scheme, corner, other)
    }

    /// The edge of each side of the finer level.
    fn finer_edges(&self, scheme: Scheme) -> Vec<u32> {
        let first_inner = 2 * to_u32(self.edge_sides.len());
        // The half of a side's edge where the side starts.
        let start = |side: u32| {
            let edge = self.edges[side as usize];
            let first = self.edge_sides[edge as usize][0];
            2 * edge + u32::from(self.origins[first as usize] != self.origins[side as usize])
        };
        let other = |side: u32| match scheme {
            Scheme::CatmullClark => first_inner + self.polygons.before(side),
            Scheme::Loop | Scheme::Butterfly => first_inner + self.polygons.after(side),
        };
        of_corners(self, scheme, |side, before| [start(side), first_inner + side, start(before) ^ 1], other)
    }

    /// The sides on each edge of the finer level.
    fn finer_edge_sides(&self, scheme: Scheme) -> Vec<[u32; 2]> {
        let halves = |&[a, b]: &[u32; 2]| {
            let after = |side| scheme.arriving(self.polygons.after(side));
            match () {
                () if b == NONE => [[scheme.leaving(a), NONE], [after(a), NONE]],
                () if self.is_inconsistent([a, b]) => [[scheme.leaving(a), scheme.leaving(b)], [after(a), after(b)]],
                () => [[scheme.leaving(a), after(b)], [after(a), scheme.leaving(b)]],
            }
        };
        let inner = |side: u32| match scheme {
            Scheme::CatmullClark => [4 * side + 1, 4 * self.polygons.after(side) + 2],
            Scheme::Loop | Scheme::Butterfly => [scheme.leaving(side) + 1, 12 * (side / 3) + 9 + (side + 2) % 3],
        };
        let mut sides = self.edge_sides.par_iter().map(halves).collect::<Vec<_>>().into_flattened();
        sides.par_extend((0..to_u32(self.origins.len())).into_par_iter().map(inner));
        sides
    }

    /// For each point of the finer level the side from which all faces around it are reached.
    fn finer_first_sides(&self, scheme: Scheme, faces: u32) -> Vec<u32> {
        let of_point = |&side: &u32| if side == NONE { NONE } else { scheme.leaving(side) };
        let of_edge = |sides: &[u32; 2]| scheme.arriving(self.polygons.after(sides[0]));
        let of_face = |face: u32| 4 * self.polygons.sides(face).start + 2;
        let points = self.first_sides.par_iter().map(of_point);
        points.chain(self.edge_sides.par_iter().map(of_edge)).chain((0..faces).into_par_iter().map(of_face)).collect()
    }
}

/// What the corners of the finer level's faces get, in their order. Of the face where a side starts, `corner` says it of the
/// first, the second and the last corner, by that side and the one before it. `other` says it of the third corner of a
/// quadrilateral; in place of that, triangles have a fourth one between them, of whose corners it says it by the sides that
/// these halve.
pub(super) fn of_corners<T: Send>(
    level: &Level,
    scheme: Scheme,
    corner: impl Fn(u32, u32) -> [T; 3] + Sync,
    other: impl Fn(u32) -> T + Sync,
) -> Vec<T> {
    match scheme {
        Scheme::CatmullClark => {
            let face = |side: u32| {
                let [first, second, last] = corner(side, level.polygons.before(side));
                [first, second, other(side), last]
            };
            (0..to_u32(level.origins.len())).into_par_iter().map(face).collect::<Vec<_>>().into_flattened()
        }
        Scheme::Loop | Scheme::Butterfly => {
            let faces = (0..level.faces()).into_par_iter().map(|face| [3 * face, 3 * face + 1, 3 * face + 2]);
            let split = faces.map(|[a, b, c]| [corner(a, c), corner(b, a), corner(c, b), [a, b, c].map(&other)]);
            split.collect::<Vec<_>>().into_flattened().into_flattened()
        }
    }
}

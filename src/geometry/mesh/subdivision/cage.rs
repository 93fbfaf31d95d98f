//! Checks a cage and connects its faces.

use rayon::prelude::*;

use super::level::{Level, NONE, Polygons};
use super::{Boundary, Scheme, Size};
use crate::casts::to_u32;

/// The sharpness of an edge or a point that stays sharp at all levels, and the greatest one.
pub const INFINITELY_SHARP: f32 = 10.0;

/// The polygons that a subdivision surface is made from. Faces are counter-clockwise seen from outside.
///
/// At most two faces may meet at an edge. Where both run the same way along it, it is sharp at all levels, and its points stay
/// where they are. So do points where several fans of faces meet. Both are as in OpenSubdiv.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cage<'a> {
    /// How many points there are. Some may be in no face.
    pub points: usize,
    /// Where each face begins in `corners`, and at last the number of all corners.
    pub starts: &'a [u32],
    /// The points at the corners of all faces.
    pub corners: &'a [u32],
    /// How it is refined.
    pub scheme: Scheme,
    /// What becomes of edges of one face.
    pub boundary: Boundary,
    /// Edges by their two points, each with its sharpness: 0 is smooth, [`INFINITELY_SHARP`] and more is sharp at all levels.
    /// Of several for the same edge the largest counts. Those between points that no face connects are ignored.
    pub creases: &'a [([u32; 2], f32)],
    /// Points with their sharpness, which is counted as that of edges.
    pub sharp_points: &'a [(u32, f32)],
    /// Faces that are refined for the sake of their neighbours but aren't part of the surface. Others than there are don't count.
    pub holes: &'a [u32],
}

/// Why a cage can't be refined.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs, reason = "the messages say what the fields are")]
pub enum CageError {
    #[error("where faces begin isn't a list that leads from 0 to the {corners} corners: correct the list")]
    Starts { corners: usize },
    #[error("face {face} has {corners} corners, but a face needs at least 3: leave it out")]
    TooFewCorners { face: u32, corners: u32 },
    #[error(
        "face {face} has {corners} corners, but this scheme refines triangles: triangulate it, or use Catmull-Clark"
    )]
    NoTriangle { face: u32, corners: u32 },
    #[error("face {face} has point {point} twice: leave the face out, or split it there")]
    RepeatedPoint { face: u32, point: u32 },
    #[error("{user} {index} has point {point}, but there are only {points} points")]
    NoSuchPoint { user: &'static str, index: usize, point: u32, points: usize },
    #[error("{user} {index} has the sharpness {sharpness}: give one from 0 to {INFINITELY_SHARP}")]
    Sharpness { user: &'static str, index: usize, sharpness: f32 },
    #[error("{faces} faces meet at the edge from point {} to {}, but at most two can: separate them", points[0], points[1])]
    NonManifold { points: [u32; 2], faces: usize },
    #[error("would have at least {points} points and {faces} faces, but only {most} are allowed: refine fewer times")]
    TooLarge { points: u64, faces: u64, most: u64 },
}

impl Cage<'_> {
    /// The size after so many levels if no two faces share an edge. Faces and corners are exact, points and edges are
    /// fewer if they do.
    pub fn size_at_most(&self, levels: u8) -> Size {
        self.size(self.corners.len()).after(levels, self.scheme)
    }

    /// The size of the cage itself, with so many edges.
    pub(super) fn size(&self, edges: usize) -> Size {
        let [points, edges] = [self.points, edges].map(|count| count as u64);
        let [faces, corners] = [self.starts.len().saturating_sub(1), self.corners.len()].map(|count| count as u64);
        Size { points, edges, faces, corners }
    }

    /// Returns which faces are holes, or nothing if none is.
    pub(super) fn is_hole(&self) -> Vec<bool> {
        let mut is_hole = vec![false; if self.holes.is_empty() { 0 } else { self.starts.len().saturating_sub(1) }];
        for &face in self.holes {
            is_hole.get_mut(face as usize).into_iter().for_each(|own| *own = true);
        }
        is_hole
    }

    /// Checks the lists against each other.
    pub(super) fn check(&self) -> Result<(), CageError> {
        let starts = (self.starts.first(), self.starts.last().map(|&end| end as usize));
        if starts != (Some(&0), Some(self.corners.len())) {
            return Err(CageError::Starts { corners: self.corners.len() });
        }
        for (face, &[start, end]) in (0..).zip(self.starts.array_windows()) {
            let corners = end.saturating_sub(start);
            match self.scheme {
                _ if corners < 3 => return Err(CageError::TooFewCorners { face, corners }),
                Scheme::Loop | Scheme::Butterfly if corners > 3 => return Err(CageError::NoTriangle { face, corners }),
                Scheme::CatmullClark | Scheme::Loop | Scheme::Butterfly => {}
            }
        }
        let of_one = |point: u32, sharpness| ([point; 2], sharpness);
        self.check_uses("corner", self.corners.iter().map(|&point| of_one(point, 0.0)))?;
        self.check_uses("crease", self.creases.iter().copied())?;
        self.check_uses("sharp point", self.sharp_points.iter().map(|&(point, sharpness)| of_one(point, sharpness)))
    }

    fn check_uses(&self, user: &'static str, uses: impl Iterator<Item = ([u32; 2], f32)>) -> Result<(), CageError> {
        let points = self.points;
        for (index, (used, sharpness)) in uses.enumerate() {
            if let Some(point) = used.into_iter().find(|point| *point as usize >= points) {
                return Err(CageError::NoSuchPoint { user, index, point, points });
            }
            // NaN isn't contained either.
            if !(0.0..=f32::INFINITY).contains(&sharpness) {
                return Err(CageError::Sharpness { user, index, sharpness });
            }
        }
        Ok(())
    }

    /// Connects the faces of a cage that was checked. Also returns how many creases aren't edges.
    ///
    /// # Errors
    /// [`CageError::RepeatedPoint`] and [`CageError::NonManifold`].
    pub(super) fn level(&self) -> Result<(Level, usize), CageError> {
        let (mut level, ends) = connected(self.points, self.polygons(), self.corners.to_vec())?;
        let lone_creases = self.sharpen(&mut level, &ends);
        Ok((level, lone_creases))
    }

    fn polygons(&self) -> Polygons {
        let faces = (0..).zip(self.starts.array_windows());
        match () {
            () if faces.clone().all(|(_, [start, end])| end - start == 3) => Polygons::Triangles,
            () if faces.clone().all(|(_, [start, end])| end - start == 4) => Polygons::Quads,
            () => {
                let mut face_of = Vec::with_capacity(self.corners.len());
                faces.for_each(|(face, [_, end])| face_of.resize(*end as usize, face));
                Polygons::Mixed { starts: self.starts.to_vec(), face_of }
            }
        }
    }

    /// Gives edges, by the ends of each, and points their sharpness. Returns how many creases aren't edges.
    fn sharpen(&self, level: &mut Level, ends: &[[u32; 2]]) -> usize {
        let is_sharp = |sides: &[u32; 2]| sides[1] == NONE || level.is_inconsistent(*sides);
        let own = |sides| if is_sharp(sides) { INFINITELY_SHARP } else { 0.0 };
        let mut edges: Vec<f32> = level.edge_sides.iter().map(own).collect();
        let mut lone_creases = 0;
        for (crease, sharpness) in self.creases {
            let [a, b] = *crease;
            let edge = ends.binary_search(&[a.min(b), a.max(b)]);
            lone_creases += usize::from(edge.is_err());
            edge.iter().for_each(|&edge| edges[edge] = edges[edge].max(*sharpness).min(INFINITELY_SHARP));
        }
        let mut points = vec![0.0; self.points];
        for &(point, sharpness) in self.sharp_points {
            points[point as usize] = sharpness.max(points[point as usize]).min(INFINITELY_SHARP);
        }
        if self.boundary == Boundary::EdgesAndCorners {
            let is_corner = |side| level.twin(side).is_none() && level.twin(level.polygons.before(side)).is_none();
            for (point, sharpness) in (0..).zip(&mut points) {
                if level.first_side(point).is_some_and(is_corner) {
                    *sharpness = INFINITELY_SHARP;
                }
            }
        }
        let unless_smooth = |list: Vec<f32>| if list.iter().all(|s| *s == 0.0) { Vec::new() } else { list };
        (level.edge_sharpness, level.point_sharpness) = (unless_smooth(edges), unless_smooth(points));
        lone_creases
    }
}

/// Connects polygons of so many points, which are given for each corner; all is smooth. Also returns the points of each edge.
///
/// # Errors
/// [`CageError::RepeatedPoint`] and [`CageError::NonManifold`].
pub(super) fn connected(
    points: usize,
    polygons: Polygons,
    origins: Vec<u32>,
) -> Result<(Level, Vec<[u32; 2]>), CageError> {
    let (edges, first_sides) = (vec![0; origins.len()], vec![NONE; points]);
    let [edge_sharpness, point_sharpness] = [Vec::new(), Vec::new()];
    let edge_sides = Vec::new();
    let mut level =
        Level { points, polygons, origins, edges, edge_sides, edge_sharpness, point_sharpness, first_sides };
    check_repeated(&level)?;
    let ends = connect(&mut level)?;
    set_first_sides(&mut level);
    Ok((level, ends))
}

fn check_repeated(level: &Level) -> Result<(), CageError> {
    let mut last_faces = vec![NONE; level.points];
    for (side, &point) in (0..).zip(&level.origins) {
        let face = level.polygons.face_of(side);
        if std::mem::replace(&mut last_faces[point as usize], face) == face {
            return Err(CageError::RepeatedPoint { face, point });
        }
    }
    Ok(())
}

/// Numbers the edges in the order of their two points, and returns these, the lower one first.
fn connect(level: &mut Level) -> Result<Vec<[u32; 2]>, CageError> {
    let ends = |side| {
        let [a, b] = [level.origins[side as usize], level.end(side)];
        ([a.min(b), a.max(b)], side)
    };
    let mut sides: Vec<_> = (0..to_u32(level.origins.len())).into_par_iter().map(ends).collect();
    sides.par_sort_unstable();
    let mut edges = Vec::with_capacity(sides.len() / 2);
    for (edge, same) in (0..).zip(sides.chunk_by(|a, b| a.0 == b.0)) {
        let (points, first) = same[0];
        if same.len() > 2 {
            return Err(CageError::NonManifold { points, faces: same.len() });
        }
        edges.push(points);
        level.edge_sides.push([first, same.get(1).map_or(NONE, |second| second.1)]);
        same.iter().for_each(|(_, side)| level.edges[*side as usize] = edge);
    }
    Ok(edges)
}

/// Finds the side of each point from which all faces around it are reached counter-clockwise.
fn set_first_sides(level: &mut Level) {
    let mut faces = vec![0_usize; level.points];
    for side in 0..to_u32(level.origins.len()) {
        let point = level.origins[side as usize] as usize;
        faces[point] += 1;
        if faces[point] == 1 || level.twin(side).is_none() {
            level.first_sides[point] = side;
        }
    }
    let of = |point| {
        let first: u32 = level.first_side(point)?;
        let reached = level.ring(first).filter(|spoke| spoke.side.is_some()).count();
        (reached == faces[point as usize]).then_some(first)
    };
    let mut firsts: Vec<u32> = (0..to_u32(level.points)).into_par_iter().map(|p| of(p).unwrap_or(NONE)).collect();
    for &sides in &level.edge_sides {
        if level.is_inconsistent(sides) {
            firsts[level.origins[sides[0] as usize] as usize] = NONE;
            firsts[level.end(sides[0]) as usize] = NONE;
        }
    }
    level.first_sides = firsts;
}

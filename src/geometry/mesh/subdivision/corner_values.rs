//! Values at the corners of faces, such as texture coordinates.

use std::collections::HashMap;

use glam::DVec4;

use super::cage::{INFINITELY_SHARP, connected};
use super::level::{Level, NONE};
use super::split::of_corners;
use super::{Linear, Refinement, Scheme};
use crate::casts::to_u32;
use crate::choice::choices;

choices! {
    /// How texture coordinates are refined. A seam is where the faces beside an edge have different ones; it stays one. These are
    /// OpenSubdiv's rules `FVarLinearInterpolation`, in their order.
    #[derive(Default, Hash)]
    pub enum FaceVarying {
        Smooth => "smooth", "Smooth", "Smoothed as the surface is, also along boundaries and seams.";
        Corners => "corners", "Keep corners", "Smooth, but corners that belong to a single face stay.";
        Junctions => "junctions", "Keep corners, junctions", "Smooth, but such corners stay, and points where three islands meet.";
        Concave => "concave", "Keep corners, junctions, concave",
            "Smooth, but such corners and junctions stay, and so do ends and concave corners of seams.";
        Boundaries => "boundaries", "Keep boundaries", "Smooth within, and linear along boundaries and seams.";
        #[default]
        Linear => "linear", "Linear", "Linear in each face.";
    }
}

impl Refinement {
    /// Refines values at the corners of the cage's faces by a rule, to what they are in the limit. Equal values at a point are
    /// one. Creases and sharp points of the cage count for them, too.
    ///
    /// # Panics
    /// If there isn't a value for each corner of the cage.
    pub fn refine_face_varying(&self, values: &[DVec4], rule: FaceVarying) -> Vec<DVec4> {
        if rule == FaceVarying::Linear {
            return self.refine_corners(values);
        }
        let cage = &self.levels[0];
        assert_eq!(values.len(), cage.origins.len(), "a value for each corner of the cage");
        let (mut numbers, mut distinct) = (HashMap::new(), Vec::new());
        let number = |(&point, value): (&u32, &DVec4)| {
            let bits = value.to_array().map(|x| (x + 0.0).to_bits());
            *numbers.entry((point, bits)).or_insert_with(|| {
                distinct.push(*value);
                to_u32(distinct.len() - 1)
            })
        };
        let origins = cage.origins.iter().zip(values).map(number).collect();
        // No more faces meet at an edge between values than at that between their points.
        let Ok((mut level, _)) = connected(distinct.len(), cage.polygons.clone(), origins) else {
            return self.refine_corners(values);
        };
        let of_edge = |&[a, b]: &[u32; 2]| match b {
            NONE => INFINITELY_SHARP,
            _ => cage.edge_sharpness(cage.edges[a as usize]),
        };
        level.edge_sharpness = level.edge_sides.iter().map(of_edge).collect();
        level.point_sharpness = sharpness(cage, &level, rule);
        let smooth = Self::divided(level, self.scheme, self.levels.len() - 1);
        let refined = smooth.refine(&distinct);
        let limit = smooth.limit(&refined).values();
        smooth.corners().iter().map(|&value| limit[value as usize]).collect()
    }

    /// Refines values at the corners of the cage's faces linearly within each face: OpenSubdiv's `FVAR_LINEAR_ALL`. So faces that
    /// share values at both ends of an edge share them all along it.
    ///
    /// # Panics
    /// If there isn't a value for each corner of the cage.
    pub fn refine_corners<T: Linear>(&self, values: &[T]) -> Vec<T> {
        assert_eq!(values.len(), self.levels[0].origins.len(), "a value for each corner of the cage");
        let coarse = &self.levels[..self.levels.len() - 1];
        coarse.iter().fold(values.to_vec(), |values, level| split(level, self.scheme, &values))
    }
}

/// The sharpness of each value: infinite where the rule keeps it, or else that of its point.
fn sharpness(cage: &Level, level: &Level, rule: FaceVarying) -> Vec<f32> {
    let (mut faces, mut points) = (vec![0; level.points], vec![0; level.points]);
    for (&value, &point) in level.origins.iter().zip(&cage.origins) {
        faces[value as usize] += 1;
        points[value as usize] = point;
    }
    // How many values each point has, and whether any of them belongs to a single face.
    let mut around = vec![(0, false); cage.points];
    for (&faces, &point) in faces.iter().zip(&points) {
        let (values, has_corner) = &mut around[point as usize];
        (*values, *has_corner) = (*values + 1, *has_corner || faces == 1);
    }
    let is_closed = |level: &Level, point| level.first_side(point).is_some_and(|first| level.twin(first).is_some());
    let of_value = |(value, (&faces, &point)): (u32, (&u32, &u32))| {
        let (values, has_corner) = around[point as usize];
        let is_junction = faces == 1 || values > 2;
        let is_kept = match rule {
            FaceVarying::Smooth => false,
            FaceVarying::Corners => faces == 1,
            FaceVarying::Junctions => is_junction,
            FaceVarying::Concave if values == 1 => is_junction || is_closed(cage, point),
            FaceVarying::Concave => is_junction || has_corner,
            FaceVarying::Boundaries | FaceVarying::Linear => true,
        };
        if is_kept && !is_closed(level, value) { INFINITELY_SHARP } else { cage.point_sharpness(point) }
    };
    (0..).zip(faces.iter().zip(&points)).map(of_value).collect()
}

/// The values at the corners of the finer level's faces.
fn split<T: Linear>(level: &Level, scheme: Scheme, values: &[T]) -> Vec<T> {
    let value = |side: u32| values[side as usize];
    let middle = |side: u32| (value(side) + value(level.polygons.after(side))) * 0.5;
    let other = |side: u32| match scheme {
        Scheme::CatmullClark => level.polygons.mean(level.polygons.face_of(side), value),
        Scheme::Loop | Scheme::Butterfly => middle(side),
    };
    of_corners(level, scheme, |side, before| [value(side), middle(side), middle(before)], other)
}

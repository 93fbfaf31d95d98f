//! A mesh as reference surface, for example the high-poly original.

use std::sync::Arc;

use glam::{DVec3, Vec3};

use super::spread::{find, radical_inverse};
use super::triangles::{Closest, Triangles};
use super::{EdgePoints, Nearest, ON_CREASE, Sample, segments};
use geometry::mesh::{Corner, Mesh};

/// A mesh's flat triangles, with interpolated shading normals.
pub struct Reference {
    triangles: Triangles,
    /// The mesh's corners; `faces` has the three of each triangle.
    corners: Vec<Corner>,
    faces: Arc<Vec<[u32; 3]>>,
    /// The sum of the areas of all triangles up to and including each one.
    areas: Vec<f64>,
    diagonal: f64,
}

impl Reference {
    /// Returns `None` if the mesh has no triangle.
    pub fn new(mesh: &Mesh) -> Option<Self> {
        let (corners, faces) = (mesh.corners.clone(), mesh.triangles.clone());
        let of = |triangle: &[u32; 3]| triangle.map(|corner| corners[corner as usize].position);
        let triangles = Triangles::new(faces.iter().map(of))?;
        let areas = faces.iter().scan(0.0, |sum, triangle| {
            *sum += cross(&of(triangle)).length() / 2.0;
            Some(*sum)
        });
        let (areas, [min, max]) = (areas.collect(), triangles.extent());
        Some(Self { triangles, areas, diagonal: min.distance(max), corners, faces })
    }

    fn triangle(&self, index: usize) -> [Corner; 3] {
        self.faces[index].map(|corner| self.corners[corner as usize])
    }

    pub(super) fn closest_facing(&self, p: DVec3, facing: DVec3) -> Nearest {
        let nearest = |closest: &Closest| Nearest {
            point: closest.point,
            normal: self.normal(closest.triangle as usize, closest.weights),
            distance: closest.distance,
        };
        let all = self.triangles.all_closest(p, ON_CREASE * self.diagonal);
        // There is a nearest triangle, unless the place has a NaN coordinate.
        let nowhere = Nearest { point: p, normal: DVec3::Y, distance: f64::NAN };
        let Some(first) = all.iter().min_by(|a, b| a.distance.total_cmp(&b.distance)) else { return nowhere };
        let found = nearest(first);
        let normals = all.iter().map(|closest| nearest(closest).normal);
        let normal =
            normals.fold(found.normal, |best, other| if other.dot(facing) > best.dot(facing) { other } else { best });
        Nearest { normal, ..found }
    }

    /// Returns the nearest point and its distance.
    pub(super) fn closest_point(&self, p: DVec3) -> (DVec3, f64) {
        let found = self.triangles.closest(p, f64::INFINITY);
        // There is a nearest triangle, unless the place has a NaN coordinate.
        found.map_or((p, f64::NAN), |closest| (closest.point, closest.distance))
    }

    /// Returns the unit shading normal, or the face's normal if that has no direction, or a corner's if the face has
    /// none either.
    fn normal(&self, triangle: usize, weights: [f64; 3]) -> DVec3 {
        let corners = self.triangle(triangle);
        let normals = corners.map(|corner| corner.normal.as_dvec3());
        let sum: DVec3 = (0..3).map(|i| normals[i] * weights[i]).sum();
        sum.try_normalize()
            .or_else(|| cross(&corners.map(|corner| corner.position)).try_normalize())
            .unwrap_or(normals[0])
    }

    /// Returns `count` points, spread evenly by area.
    pub(super) fn samples(&self, count: usize) -> Vec<Sample> {
        let sample = |i: usize| {
            let (triangle, _) = find(&self.areas, (i as f64 + 0.5) / count as f64);
            // Fold the unit square onto the triangle, which keeps proportions of area.
            let (x, y) = (radical_inverse(2, i), radical_inverse(3, i));
            let (b, c) = if x + y > 1.0 { (1.0 - x, 1.0 - y) } else { (x, y) };
            let weights = [1.0 - b - c, b, c];
            let corners = self.triangle(triangle);
            let point = (0..3).map(|k| corners[k].position.as_dvec3() * weights[k]).sum();
            Sample { point, normal: self.normal(triangle, weights) }
        };
        (0..count).map(sample).collect()
    }

    /// Returns the position of every corner that a triangle has, and points along the edges that are longer than
    /// `spacing`. If that would be more than about `most` points on edges, these are farther apart.
    pub(super) fn edge_points(&self, spacing: f64, most: usize) -> EdgePoints {
        let at = |corner: u32| self.corners[corner as usize].position;
        let position = |corner: u32| at(corner).as_dvec3();
        let length = |[a, b]: [u32; 2]| position(a).distance(position(b));
        let mut long = Vec::new();
        for face in self.faces.iter() {
            let [a, b, c] = face.map(at);
            for (i, [from, to]) in [[a, b], [b, c], [c, a]].into_iter().enumerate() {
                if from.as_dvec3().distance_squared(to.as_dvec3()) > spacing * spacing {
                    let [from, to] = [face[i], face[(i + 1) % 3]];
                    long.push([from.min(to), from.max(to)]);
                }
            }
        }
        long.sort_unstable();
        long.dedup();
        let whole: f64 = long.iter().map(|edge| length(*edge)).sum();
        let spacing = spacing.max(whole / most.max(1) as f64);

        let mut used = vec![false; self.corners.len()];
        self.faces.iter().flatten().for_each(|corner| used[*corner as usize] = true);
        let corners = (0..self.corners.len() as u32).filter(|corner| used[*corner as usize]);
        let mut points: Vec<DVec3> = corners.map(position).collect();
        let mut widest = 0.0_f64;
        for edge in long {
            let ([a, b], count) = (edge.map(position), segments(length(edge), spacing));
            points.extend((1..count).map(|i| a.lerp(b, i as f64 / count as f64)));
            widest = widest.max(length(edge) / count as f64);
        }
        EdgePoints { points, spacing: widest }
    }

    pub(super) fn area(&self) -> f64 {
        self.areas.last().copied().unwrap_or(0.0)
    }

    pub(super) fn extent(&self) -> [DVec3; 2] {
        self.triangles.extent()
    }
}

/// Returns the cross product of two sides: the face's normal, twice as long as its area.
fn cross(triangle: &[Vec3; 3]) -> DVec3 {
    let [a, b, c] = triangle.map(Vec3::as_dvec3);
    (b - a).cross(c - a)
}

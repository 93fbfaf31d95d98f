//! A mesh as reference surface, for example the high-poly original.

use glam::{DVec3, Vec3};

use super::spread::{find, radical_inverse};
use super::{Facets, Known, Nearest, ON_CREASE, Sample};
use geometry::mesh::{Corner, Mesh};
use geometry::near::Closest;

/// A mesh's flat triangles, with interpolated shading normals.
pub struct Reference {
    pub(super) facets: Facets,
    /// The mesh's corners, of which each triangle has three.
    corners: Vec<Corner>,
    /// The sum of the areas of all triangles up to and including each one.
    areas: Vec<f64>,
}

impl Reference {
    /// Returns `None` if the mesh has no triangle.
    pub fn new(mesh: &Mesh) -> Option<Self> {
        let corners = mesh.corners.clone();
        let of = |triangle: &[u32; 3]| triangle.map(|corner| corners[corner as usize].position);
        let facets = Facets::from_mesh(corners.iter().map(|corner| corner.position).collect(), mesh.triangles.clone())?;
        let areas = mesh.triangles.iter().scan(0.0, |sum, triangle| {
            *sum += cross(&of(triangle)).length() / 2.0;
            Some(*sum)
        });
        let areas = areas.collect();
        Some(Self { facets, areas, corners })
    }

    fn triangle(&self, index: usize) -> [Corner; 3] {
        self.facets.soup().triangles[index].map(|corner| self.corners[corner as usize])
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
}

impl Known for Reference {
    fn closest_facing(&self, p: DVec3, facing: DVec3) -> Nearest {
        let nearest = |closest: &Closest| Nearest {
            point: closest.point,
            normal: self.normal(closest.triangle as usize, closest.weights),
            distance: closest.distance,
        };
        let all = self.facets.tree.all_closest(p, ON_CREASE * self.diagonal());
        // There is a nearest triangle, unless the place has a NaN coordinate.
        let nowhere = Nearest { point: p, normal: DVec3::Y, distance: f64::NAN };
        let Some(first) = all.iter().min_by(|a, b| a.distance.total_cmp(&b.distance)) else { return nowhere };
        let found = nearest(first);
        let normals = all.iter().map(|closest| nearest(closest).normal);
        let normal =
            normals.fold(found.normal, |best, other| if other.dot(facing) > best.dot(facing) { other } else { best });
        Nearest { normal, ..found }
    }

    fn closest_point(&self, p: DVec3) -> (DVec3, f64) {
        let found = self.facets.tree.closest(p, f64::INFINITY);
        // There is a nearest triangle, unless the place has a NaN coordinate.
        found.map_or((p, f64::NAN), |closest| (closest.point, closest.distance))
    }

    fn samples(&self, count: usize) -> Vec<Sample> {
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

    fn proven(&self, p: DVec3) -> f64 {
        let tree = &self.facets.tree;
        tree.closest(p, f64::INFINITY).map_or(0.0, |closest| tree.proven(p, &closest))
    }

    fn facets(&self, _: f64, _: u64) -> Facets {
        self.facets.clone()
    }

    fn area(&self) -> f64 {
        self.areas.last().copied().unwrap_or(0.0)
    }

    fn extent(&self) -> [DVec3; 2] {
        self.facets.tree.extent()
    }
}

/// Returns the cross product of two sides: the face's normal, twice as long as its area.
fn cross(triangle: &[Vec3; 3]) -> DVec3 {
    let [a, b, c] = triangle.map(Vec3::as_dvec3);
    (b - a).cross(c - a)
}

//! Normals that are valid but suspicious: the curved surface over them may fold, tear or bulge.

use std::collections::HashSet;

use glam::{DVec3, Vec3};
use serde::Serialize;

use super::Mesh;
use super::topology::{Edge, Patch, Side, Topology};
use crate::casts::to_u32;
use crate::cores::in_ranges;

/// Two unit vectors count as parallel if the magnitude of their dot product is greater than this: within 2.6 degrees.
const PARALLEL: f64 = 0.999;

/// The greatest number of an edge's sides that are compared with each other. Comparing more would take quadratic time
/// and tell little.
const TRIES: usize = 256;

/// The least number of patches, or of edges, that are worth a thread.
const LEAST: usize = 1 << 14;

/// Numbers of suspicious normals. All three can be intended, as in a Möbius strip.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct NormalFaults {
    /// Corners of patches whose normal points to the back of their triangle (the dot product with its surface normal is
    /// below 0). Triangles without area don't count.
    pub against_face: u32,
    /// Edges with two sides whose normals are opposite at one end (their dot product is below -0.999): their mean has
    /// no direction.
    pub opposite: u32,
    /// Corners of patches whose normal is parallel to one of the two edges there (the magnitude of their dot product is
    /// above 0.999): the edge's control point can't follow the normal.
    pub along_edge: u32,
}

impl NormalFaults {
    /// Counts the suspicious normals, in f64, after welding. Takes linear time: of an edge with more than 256 sides,
    /// the first 256 are compared.
    pub fn new(mesh: &Mesh, topology: &Topology) -> Self {
        let of_patches = in_ranges(topology.patches.len(), LEAST, |range| {
            let mut faults = Self::default();
            topology.patches[range].iter().for_each(|patch| faults.add(mesh, topology, patch));
            faults
        });
        // The same corners have the same normals.
        let opposed = |edge: &&Edge| !edge.shares_corners && (0..2).any(|end| opposed(mesh, topology, edge, end));
        let of_edges =
            in_ranges(topology.edges.len(), LEAST, |range| topology.edges[range].iter().filter(opposed).count());
        Self {
            against_face: of_patches.iter().map(|faults| faults.against_face).sum(),
            opposite: to_u32(of_edges.into_iter().sum::<usize>()),
            along_edge: of_patches.iter().map(|faults| faults.along_edge).sum(),
        }
    }

    fn add(&mut self, mesh: &Mesh, topology: &Topology, patch: &Patch) {
        let point = |corner: u32| topology.points[topology.corner_points[corner as usize] as usize].as_dvec3();
        let corners @ [a, b, c] = topology.corners(patch);
        // Arrays' `map` isn't inlined here, and takes a third of the time.
        let [a, b, c] = [point(a), point(b), point(c)];
        let face = (b - a).cross(c - a);
        // Each side once, with the normals at both ends.
        let sides = [b - a, c - b, a - c].map(|side| (side, side.length_squared()));
        for (k, corner) in corners.into_iter().enumerate() {
            let normal = mesh.corners[corner as usize].normal.as_dvec3();
            self.against_face += u32::from(face.dot(normal) < 0.0);
            self.along_edge += u32::from(is_parallel(sides[k], normal) || is_parallel(sides[(k + 2) % 3], normal));
        }
    }
}

/// Returns whether a vector of any length, which comes with its square, is parallel to a unit normal.
fn is_parallel((vector, square): (DVec3, f64), normal: DVec3) -> bool {
    let along = vector.dot(normal);
    // For most vectors the squares tell, and no root is needed: here the cosine is below 0.95.
    let is_clear = along * along < 0.9 * square;
    !is_clear && vector.normalize_or_zero().dot(normal).abs() > PARALLEL
}

/// Returns whether two sides of an edge have opposite normals at one of its ends.
fn opposed(mesh: &Mesh, topology: &Topology, edge: &Edge, end: usize) -> bool {
    let normal = |side: &Side| mesh.corners[topology.side_corners(side)[end] as usize].normal;
    let opposite = |a: &Vec3, b: &Vec3| a.as_dvec3().dot(b.as_dvec3()) < -PARALLEL;
    let sides = topology.edge_sides(edge);
    if let [a, b] = sides {
        return opposite(&normal(a), &normal(b));
    }
    let normals = sides.iter().take(TRIES).map(normal);
    let mut seen = HashSet::new();
    let distinct: Vec<Vec3> = normals.filter(|normal| seen.insert(normal.to_array().map(f32::to_bits))).collect();
    distinct.iter().enumerate().any(|(i, a)| distinct[..i].iter().any(|b| opposite(a, b)))
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::Vec2;

    use super::*;
    use crate::mesh::Corner;
    use crate::mesh::shapes::Shape;
    use crate::progress::Progress;

    fn faults(mesh: &Mesh) -> NormalFaults {
        NormalFaults::new(mesh, &Topology::build(mesh, &Progress::new()).unwrap())
    }

    /// Triangles over the edge from 0 to X, one for each pair of normals at its ends. Their third corners have the
    /// surface normal of the triangle.
    fn book(normals: &[[Vec3; 2]]) -> Mesh {
        let corner = |position: Vec3, normal: Vec3| Corner { position, normal, uv: Vec2::ZERO };
        let pages = normals.iter().enumerate().flat_map(|(i, normals)| {
            let tip = Vec3::new(0.5, 1.0, i as f32);
            let face = Vec3::X.cross(tip).normalize();
            [corner(Vec3::ZERO, normals[0]), corner(Vec3::X, normals[1]), corner(tip, face)]
        });
        let triangles = (0..normals.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect::<Vec<_>>().into();
        Mesh { corners: pages.collect(), triangles, ..Mesh::default() }
    }

    #[test]
    fn good_normals_are_not_suspicious() {
        for shape in Shape::ALL.into_iter().filter(|shape| *shape != Shape::Moebius) {
            assert_eq!(faults(&shape.build()), NormalFaults::default(), "{shape}");
        }
        assert_eq!(faults(&Mesh::default()), NormalFaults::default());
    }

    #[test]
    fn a_moebius_strip_opposes_itself_at_its_join() {
        assert_eq!(faults(&Shape::Moebius.build()), NormalFaults { opposite: 2, ..NormalFaults::default() });
    }

    #[test]
    fn a_shape_inside_out_is_against_every_face() {
        let mut mesh = Shape::Torus.build();
        Arc::make_mut(&mut mesh.triangles).iter_mut().for_each(|triangle| triangle.reverse());
        assert_eq!(faults(&mesh), NormalFaults { against_face: 3 * 256, ..NormalFaults::default() });
    }

    #[test]
    fn squares_tell_the_same_as_roots() {
        let mut random = fastrand::Rng::with_seed(1);
        let mut number = || random.f32() - 0.5;
        for i in 0..20_000 {
            let normal = Vec3::new(number(), number(), number()).normalize().as_dvec3();
            let away = Vec3::new(number(), number(), number()).as_dvec3() * f64::from(i % 100) / 100.0;
            // Of all lengths that differences of f32 numbers have.
            let vector = (normal + away) * f64::from(i % 250 - 140).exp2();
            let expected = vector.normalize_or_zero().dot(normal).abs() > PARALLEL;
            assert_eq!(is_parallel((vector, vector.length_squared()), normal), expected, "{vector} and {normal}");
        }
        assert!(!is_parallel((DVec3::ZERO, 0.0), DVec3::X));
    }

    #[test]
    fn a_normal_along_an_edge_counts_its_corner_once() {
        let within = Vec3::new(1.0, 0.0, 0.04).normalize();
        let beyond = Vec3::new(1.0, 0.0, 0.05).normalize();
        for (normal, along_edge) in [(Vec3::X, 1), (Vec3::NEG_X, 1), (within, 1), (beyond, 0), (Vec3::Z, 0)] {
            let found = faults(&book(&[[Vec3::Z, normal]]));
            assert_eq!(found, NormalFaults { along_edge, ..NormalFaults::default() }, "{normal}");
        }
        // The two edges of corner 0 are nearly parallel; the corner still counts once.
        let mut sliver = book(&[[Vec3::X, Vec3::Z]]);
        sliver.corners[2].position = Vec3::new(2.0, 0.01, 0.0);
        assert_eq!(faults(&sliver).along_edge, 1);
    }

    #[test]
    fn opposite_normals_need_not_be_neighbours() {
        let (up, tilted) = (Vec3::Z, Vec3::new(0.0, -1.0, 1.0).normalize());
        let opposite = |normals: &[[Vec3; 2]]| faults(&book(normals)).opposite;
        assert_eq!(opposite(&[[up, up], [up, -up]]), 1);
        assert_eq!(opposite(&[[up, up], [tilted, tilted], [-up, up]]), 1);
        assert_eq!(opposite(&[[up, up], [tilted, up], [-tilted, up]]), 1);
        assert_eq!(opposite(&[[up, -up], [tilted, -up]]), 0, "opposite at different ends");
        let nearly = |y: f32| Vec3::new(0.0, y, -1.0).normalize();
        assert_eq!(opposite(&[[up, up], [nearly(0.044), up]]), 1);
        assert_eq!(opposite(&[[up, up], [nearly(0.046), up]]), 0);
    }

    #[test]
    fn triangles_without_area_oppose_nothing() {
        let mut flat = book(&[[Vec3::Z, Vec3::NEG_Z]]);
        flat.corners[2].position = Vec3::X * 2.0;
        assert_eq!(faults(&flat), NormalFaults::default());
        flat.corners[2].position = Vec3::X;
        assert_eq!(faults(&flat), NormalFaults::default(), "a degenerate one isn't a patch");
    }

    #[test]
    fn the_size_of_a_mesh_makes_no_difference() {
        for scale in [1e-30, 1e-7, 1e7, 1e30] {
            let mut mesh = book(&[[Vec3::NEG_Z, Vec3::X]]);
            mesh.corners.iter_mut().for_each(|corner| corner.position *= scale);
            assert_eq!(faults(&mesh), NormalFaults { against_face: 1, along_edge: 1, opposite: 0 }, "{scale}");
        }
    }

    #[test]
    fn an_edge_of_60_000_sides() {
        let tilts = (0..60_000).map(|i| Vec3::new(0.0, -5e-6 * i as f32, 1.0).normalize());
        let pages: Vec<_> = tilts.map(|normal| [normal, Vec3::Z]).collect();
        assert_eq!(faults(&book(&pages)).opposite, 0);
    }
}

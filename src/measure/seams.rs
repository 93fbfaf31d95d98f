//! How far shading normals turn where triangles meet at a uv seam or at split normals, and how far the mesh's own normals turn
//! at the same places. So one sees whether a tessellation adds to the seams that the mesh has.

use glam::Vec3;

use super::outlines::{EdgeSide, Outlines};
use crate::mesh::{EdgeKind, Mesh, Topology};
use crate::tessellate::{edge_normal, unpack_normal};

/// The angles between the shading normals of both sides of seams: edges of two triangles whose normals or texture coordinates
/// differ. Emitted normals have 32 bits, so that an angle is right to about 0.01 degrees, and exactly 0 for equal normals.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Seams {
    /// Compared edges. Where a patch is left out, or the sides have different numbers of points, there is nothing to compare.
    pub edges: u64,
    /// Compared points: those of every compared edge.
    pub points: u64,
    /// Between the normals of emitted vertices.
    pub emitted: SeamAngles,
    /// Between the mesh's own normals, interpolated linearly along each side to the same points.
    pub source: SeamAngles,
    /// By how much the emitted angle at a point is larger than that of the mesh, in degrees: the most, at least 0.
    pub most_added: f64,
}

/// Angles at seams, in degrees.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SeamAngles {
    pub most: f64,
    /// Their sum over all points.
    sum: f64,
}

impl SeamAngles {
    fn add(&mut self, degrees: f64) {
        self.most = self.most.max(degrees);
        self.sum += degrees;
    }
}

impl Seams {
    /// Compares the sides of an edge, an index in [`Topology::edges`]. Other edges than seams don't count.
    pub(super) fn take(
        &mut self,
        mesh: &Mesh,
        topology: &Topology,
        outlines: &Outlines,
        edge: u32,
        sides: &[EdgeSide],
    ) {
        let [a, b] = sides else { return };
        let own = &topology.edges[edge as usize];
        if !matches!(own.kind, EdgeKind::Split | EdgeKind::Seam) || a.points.len() != b.points.len() {
            return;
        }
        let mut ranges = topology.side_range(own);
        let Some([first, second]) = ranges.next().zip(ranges.next()).map(|(first, second)| [first, second]) else {
            return;
        };
        let normals = [first, second].map(|side| {
            topology.side_corners(&topology.sides[side as usize]).map(|corner| mesh.corners[corner as usize].normal)
        });
        self.edges += 1;
        for ((t, a), b) in outlines.weights(topology, first).into_iter().zip(&a.points).zip(&b.points) {
            let [of_a, of_b] = normals.map(|[start, end]| edge_normal(start, end, t));
            let source = if normals[0] == normals[1] { 0.0 } else { degrees(of_a, of_b) };
            let same = a.normal == b.normal;
            let emitted = if same { 0.0 } else { degrees(unpack_normal(a.normal), unpack_normal(b.normal)) };
            self.points += 1;
            self.source.add(source);
            self.emitted.add(emitted);
            self.most_added = self.most_added.max(emitted - source);
        }
    }

    /// The mean of angles over all points, in degrees; 0 without seams.
    pub fn mean(&self, angles: SeamAngles) -> f64 {
        angles.sum / self.points.max(1) as f64
    }
}

/// The angle between two directions, in degrees.
fn degrees(a: Vec3, b: Vec3) -> f64 {
    let (a, b) = (a.as_dvec3(), b.as_dvec3());
    a.cross(b).length().atan2(a.dot(b)).to_degrees()
}

#[cfg(test)]
mod tests {
    use glam::{Mat4, Vec2, vec2, vec3};

    use super::*;
    use crate::measure::{AskedFactors, Measured};
    use crate::mesh::mesh_builder::{InputCorner, MeshBuilder};
    use crate::mesh::{Material, Shape};
    use crate::progress::Progress;
    use crate::tessellate::{Convention, Inputs, LodView, Normals, Partitioning, Tessellation, tessellate};

    fn seams(mesh: &Mesh, tessellation: Tessellation) -> Seams {
        let topology = Topology::of(mesh);
        let inputs = Inputs::new(&tessellation, LodView::new(Mat4::IDENTITY, Vec2::ONE));
        let out = tessellate(mesh, &topology, &inputs, None);
        let asked = AskedFactors::new(tessellation.edges, tessellation.convention, out.edge_factors.clone());
        Measured::of(mesh, &topology, asked, &out).seams
    }

    /// A roof of two triangles, which meet at the edge from (0, 0, 0) to (0, 2, 0). `lean` says how far the normals of its sides
    /// lean from the vertical, in degrees, at the edge's start and its end; `shift` sets their texture coordinates apart.
    fn roof(lean: [f32; 2], shift: f32) -> Mesh {
        let mut builder = MeshBuilder::new();
        let material = builder.material(Material::plain("roof", [1.0; 4]));
        for side in [1.0, -1.0] {
            let normal = |lean: f32| vec3(side * lean.to_radians().sin(), 0.0, lean.to_radians().cos());
            let corner = |position: Vec3, normal| InputCorner {
                position,
                normal: Some(normal),
                uv: position.truncate() + vec2(if side > 0.0 { shift } else { 0.0 }, 0.0),
            };
            let start = corner(Vec3::ZERO, normal(lean[0]));
            let end = corner(vec3(0.0, 2.0, 0.0), normal(lean[1]));
            let eave = corner(vec3(side, 1.0, -0.5), normal(30.0));
            let triangle = if side > 0.0 { [start, eave, end] } else { [start, end, eave] };
            builder.triangle(material, triangle);
        }
        builder.finish("roof".to_owned(), &Progress::default()).expect("nobody cancels")
    }

    #[test]
    fn a_seam_of_texture_coordinates_alone_turns_no_normal() {
        let found = seams(&roof([0.0; 2], 0.5), Tessellation { factor: 7.0, ..Tessellation::default() });
        assert_eq!((found.edges, found.points), (1, 8));
        assert_eq!((found.emitted.most, found.source.most, found.most_added), (0.0, 0.0, 0.0));
        // Without the seam there is nothing to compare.
        assert_eq!(seams(&roof([0.0; 2], 0.0), Tessellation::default()), Seams::default());
    }

    #[test]
    fn split_normals_turn_as_far_as_those_of_the_mesh() {
        for partitioning in Partitioning::ALL {
            for convention in [Convention::D3d11, Convention::AmdPn, Convention::EdgeOrder] {
                let tessellation = Tessellation { factor: 5.6, partitioning, convention, ..Tessellation::default() };
                let even = seams(&roof([20.0; 2], 0.0), tessellation);
                let near = |found: f64, expected: f64| (found - expected).abs() < 0.02;
                assert!(even.edges == 1 && even.points > 2, "{partitioning:?} {even:?}");
                let [emitted, source] = [even.emitted, even.source].map(|angles| [angles.most, even.mean(angles)]);
                assert!(emitted.into_iter().chain(source).all(|angle| near(angle, 40.0)), "{partitioning:?} {even:?}");
                // Angles change along the edge, and points that don't lie where they are compared would show.
                let uneven = seams(&roof([20.0, 0.0], 0.0), tessellation);
                let (mean, own) = (uneven.mean(uneven.emitted), uneven.mean(uneven.source));
                assert!(near(uneven.emitted.most, 40.0) && near(uneven.source.most, 40.0), "{uneven:?}");
                assert!(near(mean, own) && (15.0..25.0).contains(&mean), "{partitioning:?} {convention:?} {uneven:?}");
                assert!(uneven.most_added < 0.02, "{partitioning:?} {convention:?} {uneven:?}");
            }
        }
    }

    #[test]
    fn normals_of_the_surface_itself_add_to_seams() {
        let tessellation = Tessellation { normals: Normals::Surface, ..Tessellation::default() };
        let torus = Shape::Torus.build();
        let [shaded, own] = [Tessellation::default(), tessellation].map(|tessellation| seams(&torus, tessellation));
        assert_eq!((shaded.emitted.most, shaded.most_added, shaded.source.most), (0.0, 0.0, 0.0));
        assert!(shaded.edges == own.edges && own.edges > 10, "{shaded:?} {own:?}");
        assert!(own.most_added > 0.5 && own.emitted.most == own.most_added && own.source.most == 0.0, "{own:?}");
    }

    #[test]
    fn edges_with_different_numbers_of_points_are_left_out() {
        let mirrored = Tessellation { convention: Convention::Mirrored, ..Tessellation::default() };
        let mesh = Shape::CubeSplit.build();
        let topology = Topology::of(&mesh);
        let inputs = Inputs::new(&mirrored, LodView::new(Mat4::IDENTITY, Vec2::ONE));
        // Each edge has a factor of its own, and a wrong convention gives it to others.
        let factors: Vec<f32> = (0..topology.edges.len()).map(|edge| 1.0 + edge as f32).collect();
        let out = tessellate(&mesh, &topology, &inputs, Some(&factors));
        let asked = AskedFactors::new(mirrored.edges, mirrored.convention, factors);
        let found = Measured::of(&mesh, &topology, asked, &out).seams;
        assert!(found.edges < 12, "{found:?}");
    }
}

//! How far shading normals turn where triangles meet at a uv seam or at split normals, and how far the mesh's own normals turn
//! at the same places. So one sees whether a tessellation adds to the seams that the mesh has.

use glam::Vec3;

use super::mapped_normals::MappedSide;
use super::outlines::{EdgeSide, Outlines};
use geometry::mesh::{EdgeKind, Mesh, Topology};
use geometry::tessellate::{edge_normal, unpack_normal};

/// Seams: edges of two triangles whose normals or texture coordinates differ. Emitted normals have 32 bits, so that an angle is
/// right to about 0.01 degrees, and exactly 0 for equal normals.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Seams {
    /// Between the shading normals of both sides.
    pub shading: SeamTurns,
    /// Between what normal maps make of these, as drawn without mip levels, at seams where at least one side has a normal map. They
    /// are 0 where there are none.
    pub mapped: SeamTurns,
}

/// How far normals turn where the sides of seams meet.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SeamTurns {
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

impl SeamTurns {
    /// Adds the angles at a point of a seam, in degrees.
    fn add(&mut self, emitted: f64, source: f64) {
        self.points += 1;
        self.emitted.add(emitted);
        self.source.add(source);
        self.most_added = self.most_added.max(emitted - source);
    }

    /// The mean of angles over all points, in degrees; 0 without seams.
    pub fn mean(&self, angles: SeamAngles) -> f64 {
        angles.sum / self.points.max(1) as f64
    }
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
        self.shading.edges += 1;
        let mapped = [first, second].map(|side| MappedSide::new(mesh, topology, side));
        let is_mapped = mapped.iter().any(Option::is_some);
        self.mapped.edges += u64::from(is_mapped);
        for ((t, a), b) in outlines.weights(topology, first).into_iter().zip(&a.points).zip(&b.points) {
            let [of_a, of_b] = normals.map(|[start, end]| edge_normal(start, end, t));
            let source = if normals[0] == normals[1] { 0.0 } else { degrees(of_a, of_b) };
            let same = a.normal == b.normal;
            let emitted = if same { 0.0 } else { degrees(unpack_normal(a.normal), unpack_normal(b.normal)) };
            self.shading.add(emitted, source);
            if is_mapped {
                let angle = |normals| mapped_angle(&mapped, t, normals);
                self.mapped.add(angle([a.normal, b.normal].map(unpack_normal)), angle([of_a, of_b]));
            }
        }
    }
}

/// The angle between what the sides' normal maps make of their normals at `t` along the edge, in 16.16 fixed point; in degrees.
fn mapped_angle(sides: &[Option<MappedSide>; 2], t: u32, normals: [Vec3; 2]) -> f64 {
    let mapped = |k: usize| sides[k].as_ref().map_or(normals[k], |side| side.normal(normals[k], t));
    degrees(mapped(0), mapped(1))
}

/// The angle between two directions, in degrees.
fn degrees(a: Vec3, b: Vec3) -> f64 {
    let (a, b) = (a.as_dvec3(), b.as_dvec3());
    a.cross(b).length().atan2(a.dot(b)).to_degrees()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::{Mat4, Vec2, vec2, vec3};

    use super::*;
    use crate::measure::{Measured, RequestedFactors};
    use geometry::mesh::mesh_builder::{InputCorner, MeshBuilder};
    use geometry::mesh::{Corner, CornerDetail, Map, MapUv, Material, Sampling, Shape, Slot, Texture};
    use geometry::progress::Progress;
    use geometry::tessellate::{Convention, Inputs, LodView, Normals, Partitioning, Tessellation, tessellate};

    fn seams(mesh: &Mesh, tessellation: Tessellation) -> Seams {
        let topology = Topology::new(mesh);
        let inputs = Inputs::new(&tessellation, LodView::new(Mat4::IDENTITY, Vec2::ONE));
        let out = tessellate(mesh, &topology, &inputs, None);
        let requested = RequestedFactors::new(tessellation.edges, tessellation.convention, out.edge_factors.clone());
        Measured::new(mesh, &topology, requested, &out).seams
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
        let found = seams(&roof([0.0; 2], 0.5), Tessellation { factor: 7.0, ..Tessellation::default() }).shading;
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
                let even = seams(&roof([20.0; 2], 0.0), tessellation).shading;
                let near = |found: f64, expected: f64| (found - expected).abs() < 0.02;
                assert!(even.edges == 1 && even.points > 2, "{partitioning:?} {even:?}");
                let [emitted, source] = [even.emitted, even.source].map(|angles| [angles.most, even.mean(angles)]);
                assert!(emitted.into_iter().chain(source).all(|angle| near(angle, 40.0)), "{partitioning:?} {even:?}");
                // Angles change along the edge, and points that don't lie where they are compared would show.
                let uneven = seams(&roof([20.0, 0.0], 0.0), tessellation).shading;
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
        let [shaded, own] =
            [Tessellation::default(), tessellation].map(|tessellation| seams(&torus, tessellation).shading);
        assert_eq!((shaded.emitted.most, shaded.most_added, shaded.source.most), (0.0, 0.0, 0.0));
        assert!(shaded.edges == own.edges && own.edges > 10, "{shaded:?} {own:?}");
        assert!(own.most_added > 0.5 && own.emitted.most == own.most_added && own.source.most == 0.0, "{own:?}");
    }

    /// The roof with a normal map that leans every normal by 30 degrees along its tangent, which points to +X on one side of the
    /// ridge, and to `tangent` on the other.
    fn mapped_roof(lean: [f32; 2], tangent: Vec3) -> Mesh {
        let mut mesh = roof(lean, 0.5);
        let byte = |part: f32| (127.5 + 127.5 * part).round() as u8;
        let rgba = vec![byte(0.5), byte(0.0), byte(0.75_f32.sqrt()), 255];
        let texture = Arc::new(Texture { size: [1, 1], rgba });
        let map = Map { texture, uv: MapUv::Own, sampling: Sampling::default() };
        mesh.materials[0].look.maps[Slot::Normal as usize] = Some(map);
        // Corners of the first side have shifted texture coordinates.
        let of = |corner: &Corner| {
            let is_first = corner.uv != corner.position.truncate();
            CornerDetail { tangent: if is_first { Vec3::X } else { tangent }, ..CornerDetail::default() }
        };
        mesh.details = Some(Arc::new(mesh.corners.iter().map(of).collect()));
        mesh
    }

    #[test]
    fn normal_maps_turn_normals_as_far_as_on_the_mesh_itself() {
        let near = |found: f64, expected: f64| (found - expected).abs() < 0.3;
        for factor in [1.0, 7.0, 64.0] {
            let tessellation = Tessellation { factor, ..Tessellation::default() };
            // One direction on both sides, and two that lean apart by 30 degrees each.
            for (tangent, expected) in [(Vec3::X, 0.0), (Vec3::NEG_X, 60.0)] {
                let found = seams(&mapped_roof([0.0; 2], tangent), tessellation);
                let mapped = found.mapped;
                assert!(mapped.edges == 1 && mapped.points == found.shading.points, "{found:?}");
                assert!(near(mapped.emitted.most, expected) && near(mapped.source.most, expected), "{found:?}");
                assert!(near(mapped.mean(mapped.emitted), expected) && mapped.most_added < 0.02, "{found:?}");
                assert_eq!(found.shading.emitted.most, 0.0, "the shading normals alone have no seam");
            }
            // Normals that lean apart by 20 degrees each.
            let found = seams(&mapped_roof([20.0; 2], Vec3::NEG_X), tessellation);
            assert!(near(found.mapped.emitted.most, 100.0) && found.mapped.most_added < 0.02, "{found:?}");
        }
        assert_eq!(seams(&roof([20.0; 2], 0.5), Tessellation::default()).mapped, SeamTurns::default());
        // What adds to the seam without a map does so with one.
        let mut torus = Shape::Torus.build();
        torus.materials[0].look.maps[Slot::Normal as usize] =
            mapped_roof([0.0; 2], Vec3::X).materials[0].look.maps[1].clone();
        let of = |corner: &Corner| {
            let tangent = corner.normal.any_orthonormal_vector();
            CornerDetail { tangent, ..CornerDetail::default() }
        };
        torus.details = Some(Arc::new(torus.corners.iter().map(of).collect()));
        let found = seams(&torus, Tessellation { normals: Normals::Surface, ..Tessellation::default() });
        assert!(found.shading.most_added > 0.5 && found.mapped.most_added > 0.5, "{found:?}");
        assert!(seams(&torus, Tessellation::default()).mapped.most_added < 0.02);
    }

    #[test]
    fn edges_with_different_numbers_of_points_are_left_out() {
        let mirrored = Tessellation { convention: Convention::Mirrored, ..Tessellation::default() };
        let mesh = Shape::CubeSplit.build();
        let topology = Topology::new(&mesh);
        let inputs = Inputs::new(&mirrored, LodView::new(Mat4::IDENTITY, Vec2::ONE));
        // Each edge has a factor of its own, and a wrong convention gives it to others.
        let factors: Vec<f32> = (0..topology.edges.len()).map(|edge| 1.0 + edge as f32).collect();
        let out = tessellate(&mesh, &topology, &inputs, Some(&factors));
        let requested = RequestedFactors::new(mirrored.edges, mirrored.convention, factors);
        let found = Measured::new(&mesh, &topology, requested, &out).seams;
        assert!(found.shading.edges < 12, "{found:?}");
    }
}

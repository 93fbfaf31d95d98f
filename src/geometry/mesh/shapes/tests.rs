use super::*;
use crate::mesh::Repairs;
use crate::mesh::topology::{EdgeCounts, EdgeKind, Topology};

fn topology(shape: Shape) -> (Mesh, Topology) {
    let mesh = shape.build();
    let topology = Topology::build(&mesh, &Progress::new()).unwrap();
    (mesh, topology)
}

fn euler(topology: &Topology) -> i64 {
    topology.points.len() as i64 - topology.edges.len() as i64 + topology.patches.len() as i64
}

const CLOSED: [(Shape, i64); 8] = [
    (Shape::CubeSplit, 2),
    (Shape::CubeSmooth, 2),
    (Shape::Icosahedron, 2),
    (Shape::Icosphere, 2),
    (Shape::Ellipsoid, 2),
    (Shape::Torus, 0),
    (Shape::Cylinder, 2),
    (Shape::Cone, 2),
];

#[test]
fn names_lead_back_to_shapes() {
    for shape in Shape::ALL {
        assert_eq!(shape.name().parse(), Ok(shape));
    }
    let error = "ball".parse::<Shape>().unwrap_err().to_string();
    assert!(error.contains("\"ball\"") && error.contains("icosphere, ellipsoid, torus"), "{error}");
}

#[test]
fn closed_shapes_are_closed_and_face_outwards() {
    for (shape, expected) in CLOSED {
        let (mesh, topology) = topology(shape);
        let name = shape.name();
        assert!(topology.edges.iter().all(|edge| topology.edge_sides(edge).len() == 2), "{name} is open");
        for edge in &topology.edges {
            let [a, b] = topology.edge_sides(edge) else { panic!("{name}") };
            assert_ne!(a.reversed(), b.reversed(), "{name}: two patches disagree about outside");
        }
        assert_eq!(euler(&topology), expected, "{name}");
        let at = |corner: u32| mesh.corners[corner as usize].position;
        let volume: f32 = mesh.triangles.iter().map(|t| at(t[0]).dot(at(t[1]).cross(at(t[2])))).sum();
        assert!(volume > 0.5, "{name} is inside out: {volume}");
    }
}

#[test]
fn normals_agree_with_the_faces() {
    for shape in Shape::ALL {
        let (mesh, topology) = topology(shape);
        assert_eq!((topology.degenerate, mesh.repairs), (0, Repairs::default()));
        for triangle in mesh.triangles.iter() {
            let c = triangle.map(|corner| mesh.corners[corner as usize]);
            let face = (c[1].position - c[0].position).cross(c[2].position - c[0].position).normalize();
            for corner in c {
                assert!(corner.normal.is_normalized());
                assert!(corner.normal.dot(face) > 0.5, "{shape}: {} against {face}", corner.normal);
            }
        }
    }
}

#[test]
fn sizes_are_as_said() {
    let triangles = [12, 12, 20, 80, 80, 256, 48, 24, 72, 120, 96];
    for (shape, triangles) in Shape::ALL.into_iter().zip(triangles) {
        let (mesh, _) = topology(shape);
        let bounds = mesh.bounds();
        assert_eq!(mesh.triangles.len(), triangles, "{shape}");
        assert!((0.8..1.2).contains(&bounds.radius()), "{shape}: radius {}", bounds.radius());
        assert!(bounds.center().length() < 0.15, "{shape}: centre {}", bounds.center());
    }
}

#[test]
fn edges_are_of_the_expected_kinds() {
    let counts = |shape| topology(shape).1.edge_counts();
    let none = EdgeCounts::default();
    assert_eq!(counts(Shape::CubeSplit), EdgeCounts { smooth: 6, split: 12, ..none });
    assert_eq!(counts(Shape::CubeSmooth), EdgeCounts { smooth: 18, ..none });
    assert_eq!(counts(Shape::Icosphere), EdgeCounts { smooth: 120, ..none });
    assert_eq!(counts(Shape::Torus), EdgeCounts { smooth: 384 - 24, seam: 24, ..none });
    // Two circles of 12 creases, and one seam along the side.
    assert_eq!(counts(Shape::Cylinder), EdgeCounts { smooth: 72 - 25, split: 24, seam: 1, ..none });
    // The base circle, and the 12 edges between sides, whose normals differ at the apex.
    assert_eq!(counts(Shape::Cone), EdgeCounts { smooth: 12, split: 24, ..none });
    assert_eq!(counts(Shape::Saddle), EdgeCounts { smooth: 96, boundary: 24, ..none });
    assert_eq!(counts(Shape::Moebius), EdgeCounts { smooth: 118, split: 2, boundary: 48, ..none });
}

#[test]
fn the_moebius_strip_has_one_side_and_one_boundary() {
    let (_, topology) = topology(Shape::Moebius);
    assert_eq!(euler(&topology), 0);
    let joins = topology.edges.iter().filter(|edge| edge.kind == EdgeKind::Split);
    for join in joins {
        let sides = topology.edge_sides(join);
        assert_eq!(sides[0].reversed(), sides[1].reversed(), "the join is where outside and inside meet");
    }
    assert_eq!(boundary_loops(&topology), 1);
}

fn boundary_loops(topology: &Topology) -> usize {
    let mut next = vec![Vec::new(); topology.points.len()];
    for edge in topology.edges.iter().filter(|edge| edge.kind == EdgeKind::Boundary) {
        let [a, b] = topology.edge_points(edge).map(|point| point as usize);
        next[a].push(b);
        next[b].push(a);
    }
    let mut seen = vec![false; next.len()];
    let mut loops = 0;
    for start in 0..next.len() {
        if seen[start] || next[start].is_empty() {
            continue;
        }
        loops += 1;
        let mut stack = vec![start];
        while let Some(point) = stack.pop() {
            assert_eq!(next[point].len(), 2, "boundaries are loops");
            if !std::mem::replace(&mut seen[point], true) {
                stack.extend(&next[point]);
            }
        }
    }
    loops
}

#[test]
fn every_level_of_every_shape_fits_into_what_a_load_may_take() {
    for shape in Shape::ALL.into_iter().filter(|shape| shape.has_levels()) {
        let mesh = shape.build_at(1);
        // Each level has four times as much of everything. With its topology, a mesh whose corners are all shared takes
        // 92 bytes a triangle.
        let (times, corners) =
            (4_usize.pow(MAX_LEVEL - 1), 68 * mesh.corners.len().saturating_sub(mesh.triangles.len() / 2));
        let bytes = times * (92 * mesh.triangles.len() + corners);
        assert!(bytes < 256 << 20, "{shape}: {bytes} bytes");
    }
}

#[test]
fn closed_shapes_are_closed_at_every_level() {
    for (shape, expected) in CLOSED.into_iter().filter(|(shape, _)| shape.has_levels()) {
        let mesh = shape.build_at(1);
        let topology = Topology::build(&mesh, &Progress::new()).unwrap();
        assert!(topology.is_closed_and_oriented(), "{shape}");
        assert_eq!((topology.degenerate, euler(&topology)), (0, expected), "{shape}");
    }
}

use std::collections::HashMap;

use glam::Vec2;
use proptest::prelude::*;

use super::*;
use crate::cores::on_threads;
use crate::mesh::Material;
use crate::mesh::shapes::Shape;

/// A mesh whose point i lies at (i, i * i, 0). `corners` holds the point of each corner.
fn mesh(corners: &[u32], triangles: &[[u32; 3]]) -> Mesh {
    let corner = |&point: &u32| Corner {
        position: Vec3::new(point as f32, (point * point) as f32, 0.0),
        normal: Vec3::Z,
        uv: Vec2::ZERO,
    };
    let mut material = Material::plain("plain", [1.0; 4]);
    material.triangles = 0..triangles.len() as u32;
    Mesh {
        corners: corners.iter().map(corner).collect(),
        triangles: triangles.to_vec().into(),
        materials: vec![material],
        ..Mesh::default()
    }
}

fn build(mesh: &Mesh) -> Topology {
    Topology::build(mesh, &Progress::new()).unwrap()
}

fn points_of_edges(topology: &Topology) -> Vec<[u32; 2]> {
    topology.edges.iter().map(|edge| topology.edge_points(edge)).collect()
}

/// Checks what must hold for every topology.
fn check(mesh: &Mesh, topology: &Topology) {
    assert_eq!(topology.sides.len(), 3 * topology.patches.len());
    assert_eq!(topology.patches.len() + topology.degenerate as usize, mesh.triangles.len());
    let mut next = 0;
    for (i, edge) in topology.edges.iter().enumerate() {
        let points = topology.edge_points(edge);
        assert!(points[0] < points[1]);
        assert_eq!(edge.first_side, next, "sides are grouped by edge, without gaps");
        next = topology.side_range(edge).end;
        for side in topology.edge_sides(edge) {
            assert_eq!(side.edge as usize, i);
            assert_eq!(topology.side_corners(side).map(|c| topology.corner_points[c as usize]), points);
        }
    }
    assert_eq!(next as usize, topology.sides.len());
    assert!(points_of_edges(topology).is_sorted_by(|a, b| a < b), "every pair of points once");
    for (p, patch) in topology.patches.iter().enumerate() {
        let corners = topology.patch_corners(p as u32);
        assert_eq!(corners, mesh.triangles[patch.triangle as usize]);
        for k in 0..3 {
            let side = topology.sides[patch.sides[k] as usize];
            assert_eq!((side.patch() as usize, side.index()), (p, k));
            let mut own = [corners[k], corners[(k + 1) % 3]];
            if side.reversed() {
                own.reverse();
            }
            assert_eq!(topology.side_corners(&side), own);
        }
    }
}

#[test]
fn two_triangles_share_one_smooth_edge() {
    let mesh = mesh(&[0, 1, 2, 3], &[[0, 1, 2], [2, 1, 3]]);
    let topology = build(&mesh);
    check(&mesh, &topology);
    assert_eq!(topology.edge_counts(), EdgeCounts { smooth: 1, boundary: 4, ..Default::default() });
    let shared = &topology.edges[2];
    assert_eq!((topology.edge_points(shared), shared.kind), ([1, 2], EdgeKind::Smooth));
    assert_eq!(topology.edge_sides(shared).iter().map(|s| s.reversed()).collect::<Vec<_>>(), [false, true]);
}

#[test]
fn normals_split_before_uvs_seam() {
    let mut both = mesh(&[0, 1, 2, 3, 1, 2], &[[0, 1, 2], [5, 4, 3]]);
    assert_eq!(build(&both).edge_counts().smooth, 1);
    both.corners[4].uv = Vec2::X;
    assert_eq!(build(&both).edge_counts().seam, 1);
    both.corners[5].normal = Vec3::X;
    assert_eq!(build(&both).edge_counts().split, 1);
    both.corners[5].normal = Vec3::new(-0.0, -0.0, 1.0);
    assert_eq!(build(&both).edge_counts().seam, 1, "normals compare by value");
}

#[test]
fn sides_wound_the_same_way_still_make_one_edge() {
    let mesh = mesh(&[0, 1, 2, 3], &[[0, 1, 2], [1, 2, 3]]);
    let topology = build(&mesh);
    check(&mesh, &topology);
    assert_eq!(topology.edge_counts().smooth, 1);
}

#[test]
fn three_sides_are_non_manifold() {
    let mesh = mesh(&[0, 1, 2, 3, 4], &[[0, 1, 2], [1, 0, 3], [0, 1, 4]]);
    let topology = build(&mesh);
    check(&mesh, &topology);
    assert_eq!(topology.edge_counts(), EdgeCounts { non_manifold: 1, boundary: 6, ..Default::default() });
}

#[test]
fn degenerate_triangles_are_left_out() {
    let mut mesh = mesh(&[0, 1, 2, 0], &[[0, 0, 1], [0, 3, 1], [0, 1, 2], [1, 2, 1]]);
    mesh.materials[0].triangles = 0..2;
    mesh.materials.push(Material { triangles: 2..4, ..mesh.materials[0].clone() });
    let topology = build(&mesh);
    check(&mesh, &topology);
    assert_eq!((topology.degenerate, topology.patches.len()), (3, 1));
    assert_eq!(topology.patches[0].triangle, 2);
    assert_eq!(topology.material_patches, [0..0, 0..1]);
}

#[test]
fn the_number_of_cores_makes_no_difference() {
    let (mut random, points) = (fastrand::Rng::with_seed(1), 30_000);
    // Some points have two corners. Most triangles are near others, some are anywhere, many are degenerate, and 5,000 have one point.
    let corners: Vec<u32> = (0..points).chain((0..points).step_by(3)).collect();
    let mut triangle = |i: u32| {
        let near = random.u32(0..points - 5);
        let mut of = |range: Range<u32>| [0; 3].map(|_| random.u32(range.clone()));
        match i % 20 {
            0 => of(0..corners.len() as u32),
            1 => [7, near, near + 1],
            _ => of(near..near + 5),
        }
    };
    let triangles: Vec<_> = (0..100_000).map(&mut triangle).collect();
    let mesh = mesh(&corners, &triangles);
    let alone = on_threads(1, || build(&mesh)).expect("threads");
    check(&mesh, &alone);
    let counts = alone.edge_counts();
    assert!(alone.degenerate > 1000 && counts.smooth > 1000 && counts.boundary > 1000 && counts.non_manifold > 1000);
    for cores in [2, 3, 7] {
        let shared = on_threads(cores, || build(&mesh)).expect("threads");
        let same = (alone.points == shared.points && alone.corner_points == shared.corner_points)
            && (alone.point_corners == shared.point_corners && alone.material_patches == shared.material_patches);
        assert!(same, "{cores}");
        assert!(alone.patches == shared.patches && alone.degenerate == shared.degenerate, "{cores}");
        assert!(alone.sides == shared.sides && alone.edges == shared.edges, "{cores}");
    }
}

#[test]
fn nothing_gives_nothing() {
    let topology = build(&Mesh::default());
    assert_eq!((topology.points.len(), topology.edges.len(), topology.sides.len()), (0, 0, 0));
}

#[test]
fn a_fan_of_300_000_triangles() {
    let n = 300_000_u32;
    let corner = |i: u32| Corner {
        position: if i == 0 { Vec3::ZERO } else { Vec3::new(1.0, i as f32, 0.0) },
        normal: Vec3::Z,
        uv: Vec2::ZERO,
    };
    // The apex is the lowest point in one mesh, and the highest in the other.
    for apex in [0, n + 1] {
        let mut corners: Vec<_> = (1..=n + 1).map(corner).collect();
        corners.insert(apex as usize, corner(0));
        let base = |i: u32| if apex == 0 { i + 1 } else { i };
        let triangles: Vec<_> = (0..n).map(|i| [apex, base(i), base(i + 1)]).collect();
        let topology = build(&Mesh { corners, triangles: triangles.into(), ..Mesh::default() });
        let counts = topology.edge_counts();
        assert_eq!((counts.smooth, counts.boundary), (n - 1, n + 2));
    }
}

/// Two triangles that would share an edge but for a gap along x.
fn split_square(scale: f32, gap: f32) -> Mesh {
    let mut mesh = mesh(&[0, 1, 2, 3, 4, 5], &[[0, 1, 2], [3, 4, 5]]);
    let at = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.0], [1.0 + gap, 1.0], [0.0, 1.0]];
    for (corner, [x, y]) in mesh.corners.iter_mut().zip(at) {
        corner.position = scale * Vec3::new(x, y, 0.0);
    }
    mesh
}

#[test]
fn a_gap_closes_within_the_tolerance() {
    for scale in [1e-7, 1.0, 1e7] {
        let mesh = split_square(scale, 1e-3);
        let within = |tolerance| Topology::build_within(&mesh, tolerance, &Progress::new()).unwrap();
        // The diagonal is 1.415 long, so the gap is 7.07e-4 of it.
        assert_eq!(within(7e-4).edge_counts(), EdgeCounts { boundary: 6, ..Default::default() }, "{scale}");
        let closed = within(7.2e-4);
        check(&mesh, &closed);
        assert_eq!(closed.edge_counts(), EdgeCounts { smooth: 1, boundary: 4, ..Default::default() }, "{scale}");
        assert_eq!(closed.points[2], mesh.corners[2].position, "the first corner speaks for the point");
        assert_eq!((closed.corner_points[4], closed.point_corners[2]), (2, 2));
    }
}

#[test]
fn triangles_that_the_tolerance_flattens_are_degenerate() {
    let mesh = Shape::Moebius.build();
    let all = Topology::build_within(&mesh, 1.0, &Progress::new()).unwrap();
    assert_eq!((all.points.len(), all.degenerate, all.patches.len(), all.edges.len()), (1, 96, 0, 0));
    let strip = Topology::build_within(&mesh, 1e-3, &Progress::new()).unwrap();
    assert_eq!(strip.edge_counts(), build(&mesh).edge_counts(), "its own twist is wider than that");
    let nothing = Topology::build_within(&Mesh::default(), 0.1, &Progress::new()).unwrap();
    assert_eq!((nothing.points.len(), nothing.edges.len()), (0, 0));
}

#[test]
fn cancelling_stops_the_work() {
    let progress = Progress::new();
    progress.cancel();
    assert!(Topology::build(&Shape::Torus.build(), &progress).is_err());
}

proptest! {
    #[test]
    fn a_tolerance_leaves_a_whole_topology(
        points in prop::collection::vec(0_u32..9, 12),
        triangles in prop::collection::vec(prop::array::uniform3(0_u32..12), 0..80),
        tolerance in 0_f32..0.5,
    ) {
        let mesh = mesh(&points, &triangles);
        let topology = Topology::build_within(&mesh, tolerance, &Progress::new()).unwrap();
        check(&mesh, &topology);
        prop_assert!(topology.degenerate >= build(&mesh).degenerate);
        let within = mesh.bounds().part(tolerance.into());
        for (corner, &point) in mesh.corners.iter().zip(&topology.corner_points) {
            let apart = corner.position.as_dvec3().distance(topology.points[point as usize].as_dvec3());
            prop_assert!(apart <= within, "{apart} beyond {within}");
        }
        for (point, &corner) in topology.points.iter().zip(&topology.point_corners) {
            prop_assert_eq!(*point, mesh.corners[corner as usize].position);
        }
    }

    #[test]
    fn every_side_belongs_to_one_edge(
        points in prop::collection::vec(0_u32..9, 12),
        triangles in prop::collection::vec(prop::array::uniform3(0_u32..12), 0..80),
    ) {
        let mesh = mesh(&points, &triangles);
        let topology = build(&mesh);
        check(&mesh, &topology);
        // Counts the same edges with a simple, slow method.
        let mut uses: HashMap<[u32; 2], u32> = HashMap::new();
        for patch in 0..topology.patches.len() as u32 {
            let p = topology.patch_points(patch);
            for (a, b) in [(p[0], p[1]), (p[1], p[2]), (p[2], p[0])] {
                *uses.entry([a.min(b), a.max(b)]).or_default() += 1;
            }
        }
        prop_assert_eq!(uses.len(), topology.edges.len());
        for edge in &topology.edges {
            let sides = topology.edge_sides(edge);
            prop_assert_eq!(uses[&topology.edge_points(edge)], sides.len() as u32);
            prop_assert!(sides.windows(2).all(|pair| pair[0].code < pair[1].code));
            let shares_corners = match sides {
                [a, b] => topology.side_corners(a) == topology.side_corners(b),
                _ => false,
            };
            prop_assert_eq!(edge.shares_corners, shares_corners);
        }
    }
}

#[test]
fn a_triangle_knows_its_patch_unless_it_is_degenerate() {
    let topology = build(&mesh(&[0, 1, 2, 3, 1], &[[0, 1, 2], [1, 4, 2], [2, 1, 3]]));
    assert_eq!([0, 1, 2, 3].map(|triangle| topology.patch_of(triangle)), [Some(0), None, Some(1), None]);
    let [a, b, c] = topology.patch_positions(1);
    assert_eq!([a.x, b.x, c.x], [2.0, 1.0, 3.0]);
}

#[test]
fn the_account_holds_what_a_topology_takes() {
    let (mesh, budget) = (Shape::Torus.build(), Budget::unlimited());
    let own = Topology::build_afforded(&mesh, 0.0, &budget, &Progress::new()).unwrap();
    let by_point = size_of_val(&own.points[..]) + size_of_val(&own.point_corners[..]);
    let by_corner = size_of_val(&own.corner_points[..]);
    let by_patch = size_of_val(&own.patches[..]) + size_of_val(&own.sides[..]) + size_of_val(&own.edges[..]);
    assert_eq!(budget.held(), (by_point + by_corner + by_patch) as u64);
}

#[test]
fn the_total_counts_edges_of_every_kind() {
    let counts = EdgeCounts { smooth: 1, split: 20, seam: 300, boundary: 4000, non_manifold: 50_000 };
    assert_eq!(counts.total(), 54_321);
}

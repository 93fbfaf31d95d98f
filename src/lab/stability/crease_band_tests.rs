//! What a crease band does to meshes that break tessellators.

use glam::DVec3;
use proptest::prelude::*;

use super::{CASES, soup};
use geometry::mesh::crease_band::{CreaseBand, with_crease_band};
use geometry::mesh::{Corner, EdgeKind, Mesh, Side, Topology, Budget};
use geometry::progress::Progress;

fn topology(mesh: &Mesh) -> Topology {
    Topology::build(mesh, &Progress::new()).unwrap()
}

/// Returns a mesh with a crease band, after welding its points within a tolerance.
fn banded_within(mesh: &Mesh, weld: f32, width: f32) -> (Mesh, Topology, CreaseBand) {
    let progress = Progress::new();
    let before = Topology::build_within(mesh, weld, &progress).unwrap();
    let (made, after, band) = with_crease_band(mesh, &before, width, &Budget::unlimited(), &progress).unwrap();
    assert_eq!(after.edges, topology(&made).edges);
    for edge in &after.edges {
        let normals = |side: &Side| after.side_corners(side).map(|corner| made.corners[corner as usize].normal);
        let sides = after.edge_sides(edge);
        assert!(sides.iter().all(|side| normals(side) == normals(&sides[0])), "{} {width}: {edge:?}", mesh.name);
    }
    (made, after, band)
}

fn banded(mesh: &Mesh, width: f32) -> (Mesh, Topology, CreaseBand) {
    banded_within(mesh, 0.0, width)
}

fn triangles(mesh: &Mesh) -> impl Iterator<Item = [Corner; 3]> {
    mesh.triangles.iter().map(|triangle| triangle.map(|corner| mesh.corners[corner as usize]))
}

fn places(triangle: [Corner; 3]) -> [DVec3; 3] {
    triangle.map(|corner| corner.position.as_dvec3())
}

fn area(triangle: [Corner; 3]) -> DVec3 {
    let [a, b, c] = places(triangle);
    (b - a).cross(c - a) / 2.0
}

fn areas(mesh: &Mesh) -> f64 {
    triangles(mesh).map(|triangle| area(triangle).length()).sum()
}

fn boundary_length(topology: &Topology) -> f64 {
    let open = topology.edges.iter().filter(|edge| edge.kind == EdgeKind::Boundary);
    open.map(|edge| {
        let [a, b] = topology.edge_points(edge).map(|point| topology.points[point as usize].as_dvec3());
        a.distance(b)
    })
    .sum()
}

fn euler(topology: &Topology) -> i64 {
    topology.points.len() as i64 - topology.edges.len() as i64 + topology.patches.len() as i64
}

#[test]
fn what_was_welded_within_a_tolerance_stays_welded() {
    let case = CASES.iter().find(|case| case.name == "near-seam").unwrap();
    let before = (case.mesh)();
    let (_, exact, _) = banded(&before, 0.01);
    let (_, welded, _) = banded_within(&before, case.weld, 0.01);
    assert!(!exact.is_closed_and_oriented() && welded.is_closed_and_oriented());
    let (mesh, narrow, _) = banded_within(&before, 0.01, 1e-3);
    assert!(narrow.edge_counts().split == 0 && !mesh.triangles.is_empty());
}

#[test]
fn no_split_normals_are_left_and_meshes_stay_whole() {
    for case in &CASES {
        let before = (case.mesh)();
        let progress = Progress::new();
        let old = Topology::build_within(&before, case.weld, &progress).unwrap();
        for width in [1e-4, 0.02] {
            let (mesh, new, band) = banded_within(&before, case.weld, width);
            let name = format!("{} {width}", case.name);
            assert_eq!(new.edge_counts().split, 0, "{name}");
            assert_eq!(new.is_closed_and_oriented(), old.is_closed_and_oriented(), "{name}");
            assert!((boundary_length(&new) - boundary_length(&old)).abs() <= 1e-5 * boundary_length(&old), "{name}");
            assert!(
                band.creases > 0 || (old.edge_counts().split == 0 && mesh.triangles.len() == before.triangles.len())
            );
            if old.is_closed_and_oriented() {
                assert_eq!(euler(&new), euler(&old), "{name}");
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn triangle_soups_lose_all_split_normals(seed in 0_u32..100_000, width in 1e-5_f32..0.1) {
        let before = soup(seed);
        let old = topology(&before);
        let (mesh, new, _) = banded(&before, width);
        prop_assert_eq!(new.edge_counts().split, 0);
        let open = |topology: &Topology| topology.edge_counts().boundary;
        prop_assert!(open(&new) <= 3 * open(&old), "{} of {}", open(&new), open(&old));
        prop_assert!((boundary_length(&new) - boundary_length(&old)).abs() <= 1e-5 * boundary_length(&old));
        prop_assert!((areas(&mesh) / areas(&before) - 1.0).abs() < 1e-5);
    }
}

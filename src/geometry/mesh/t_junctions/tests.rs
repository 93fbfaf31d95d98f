use glam::{DVec3, Vec2, Vec3};
use proptest::prelude::*;

use super::*;
use crate::mesh::shapes::Shape;
use crate::mesh::{Corner, Mesh, weld_previews};

/// Makes triangles with corners at these positions.
fn mesh(places: &[Vec3], triangles: &[[u32; 3]]) -> Mesh {
    let corner = |&position: &Vec3| Corner { position, normal: Vec3::Z, uv: Vec2::ZERO };
    Mesh { corners: places.iter().map(corner).collect(), triangles: triangles.to_vec().into(), ..Mesh::default() }
}

fn topology(places: &[Vec3], triangles: &[[u32; 3]]) -> Topology {
    Topology::build(&mesh(places, triangles), &Progress::new()).unwrap()
}

fn found(topology: &Topology) -> Vec<TJunction> {
    t_junctions(topology, &Progress::new()).unwrap()
}

/// Two columns of quads that meet at x = 1: one quad on the left, and `parts` above each other on the right, both
/// `scale` units high.
fn strip(parts: u32, scale: f32) -> Topology {
    let mut places = vec![Vec3::ZERO, Vec3::Y, Vec3::X, Vec3::new(1.0, 1.0, 0.0)];
    let mut triangles = vec![[0, 2, 3], [0, 3, 1]];
    for i in 0..=parts {
        let y = i as f32 / parts as f32;
        places.extend([Vec3::new(1.0, y, 0.0), Vec3::new(2.0, y, 0.0)]);
    }
    for i in 0..parts {
        let first = 4 + 2 * i;
        triangles.extend([[first, first + 1, first + 3], [first, first + 3, first + 2]]);
    }
    let places: Vec<_> = places.iter().map(|place| *place * scale).collect();
    topology(&places, &triangles)
}

#[test]
fn all_points_in_one_place_are_tried() {
    let [x, y] = [Vec3::X, Vec3::Y];
    let middle = [x + 0.5 * y, 2.0 * x + 0.5 * y];
    // The quads on the right have a side in the middle each, of points of their own.
    let moved = middle.map(|place| place + 5.0 * Vec3::Z);
    let places = [Vec3::ZERO, y, x, x + y, middle[0], 2.0 * x, middle[1], moved[0], moved[1], 2.0 * x + y];
    let triangles = [[0, 2, 3], [0, 3, 1], [2, 5, 6], [2, 6, 4], [7, 8, 9], [7, 9, 3]];
    let mut topology = topology(&places, &triangles);
    for (corner, place) in [7, 8].into_iter().zip(middle) {
        let point = topology.corner_points[corner] as usize;
        topology.points[point] = place;
    }
    let found = found(&topology);
    let points: Vec<_> = found.iter().map(|junction| (junction.point, junction.t)).collect();
    let mut expected = [4, 7].map(|corner| (topology.corner_points[corner], 0.5));
    expected.sort_unstable_by_key(|(point, _)| *point);
    assert_eq!(points, expected, "{found:?}");
}

#[test]
fn a_refined_side_has_a_t_junction_at_every_point_between() {
    for scale in [1e-7, 1.0, 1e7] {
        let topology = strip(5, scale);
        let found = found(&topology);
        assert_eq!(found.len(), 4, "{found:?}");
        let edge = &topology.edges[found[0].edge as usize];
        assert_eq!(
            topology.edge_points(edge).map(|point| topology.points[point as usize] / scale),
            [Vec3::X, Vec3::new(1.0, 1.0, 0.0)]
        );
        for (junction, i) in found.iter().zip(1..) {
            let y = i as f32 / 5.0;
            assert_eq!(junction.edge, found[0].edge);
            assert!((junction.t - y).abs() < 1e-6 && junction.distance <= 1e-7 * scale, "{junction:?}");
            assert!((topology.points[junction.point as usize] / scale).distance(Vec3::new(1.0, y, 0.0)) < 1e-6);
        }
    }
    assert_eq!(found(&strip(1, 1.0)), [], "a side that isn't refined");
}

#[test]
fn shapes_have_none() {
    for shape in [Shape::Saddle, Shape::Moebius, Shape::Torus, Shape::Cone] {
        let mesh = shape.build();
        assert_eq!(found(&Topology::build(&mesh, &Progress::new()).unwrap()), [], "{shape}");
    }
    assert_eq!(found(&Topology::default()), []);
    assert_eq!(found(&topology(&[Vec3::ONE; 3], &[[0, 1, 2]])), [], "a triangle on one point");
    let square = [Vec3::ZERO, Vec3::X, Vec3::Y];
    assert_eq!(found(&topology(&square, &[[0, 1, 2], [0, 1, 2]])), [], "duplicates close each other");
}

/// A triangle with an edge from 0 to 1 along x, and one with a corner at `tip`. The bounding diagonal is about 3, so
/// the tolerance is about 3e-5.
fn touched(tip: Vec3) -> Vec<TJunction> {
    let places =
        [Vec3::ZERO, Vec3::X, Vec3::new(0.5, 2.0, 0.0), tip, Vec3::new(0.4, -0.2, 2.0), Vec3::new(0.6, -0.2, 2.0)];
    found(&topology(&places, &[[0, 1, 2], [3, 4, 5]]))
}

#[test]
fn near_misses_are_not_t_junctions() {
    let hit = touched(Vec3::new(0.25, 0.0, 0.0));
    assert_eq!((hit.len(), hit[0].point, hit[0].t, hit[0].distance), (1, 3, 0.25, 0.0));
    let near = touched(Vec3::new(0.25, -2e-5, 0.0));
    assert_eq!((near.len(), near[0].t, near[0].distance), (1, 0.25, 2e-5));
    assert_eq!(touched(Vec3::new(0.25, -4e-5, 0.0)), [], "too far from the edge");
    for x in [2e-5, 4e-5, 4e-3, 0.031, 0.969, 1.0 - 4e-5] {
        assert_eq!(touched(Vec3::X * x), [], "{x}: a weld tolerance on offer reaches from there to an end");
    }
    for x in [0.032, 0.968] {
        assert_eq!(touched(Vec3::X * x).len(), 1, "{x}: none on offer does");
    }
    assert_eq!(touched(Vec3::new(-4e-5, 0.0, 0.0)), [], "beyond the end");
    assert_eq!(touched(Vec3::X), [], "a shared point");
}

/// A part of a cylinder with 6 by 6 quads in two halves. The second half is moved along the seam by a part of the
/// diagonal.
fn cut_cylinder(part: f32) -> Mesh {
    let at = |i: u32, j: u32| {
        let (sin, cos) = (i as f32 / 4.0).sin_cos();
        Vec3::new(sin, j as f32 / 4.0, cos)
    };
    let quads = (0..6).flat_map(|i| (0..6).map(move |j| (i, j)));
    let corners: Vec<_> = quads
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            [a, b, c, a, c, d].map(|place| place + if i < 3 { Vec3::ZERO } else { Vec3::Y * part * 2.0 })
        })
        .collect();
    let triangles: Vec<_> = (0..72).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    mesh(&corners, &triangles)
}

#[test]
fn a_seam_that_a_weld_tolerance_closes_has_none() {
    for part in [1e-6, 1.1e-5, 1e-4, 1e-3, 4e-3] {
        let mesh = cut_cylinder(part);
        let topology = Topology::build(&mesh, &Progress::new()).unwrap();
        assert_eq!(found(&topology), [], "moved by {part}");
        let joins = weld_previews(&mesh, None, &Progress::new()).unwrap();
        assert!(
            joins.iter().any(|join| (join.edges, join.collapsed) == (Some(12), Some(0))),
            "moved by {part}: {joins:?}"
        );
    }
    let halfway = cut_cylinder(0.0625);
    assert_eq!(found(&Topology::build(&halfway, &Progress::new()).unwrap()).len(), 12, "half an edge is no near miss");
}

#[test]
fn the_tolerance_itself_counts() {
    // An edge of length 1 along x, and a point that no edge uses.
    let places = [Vec3::ZERO, Vec3::X, Vec3::new(0.0, 1.0, 0.5), Vec3::ONE / 4.0];
    let topology = topology(&places, &[[0, 1, 2]]);
    let on_edges = PointsOnEdges::new(&topology);
    let (near, weld) = (on_edges.tolerance, on_edges.welds[5]);
    assert!((near - 1.5e-5).abs() < 1e-9 && (weld - 1.5e-2).abs() < 1e-6);
    let edge = &topology.edges[0];
    let inside =
        |x: f64, y: f64| on_edges.is_inside(edge, &LineSegment::from_edge(&topology, edge), 3, DVec3::new(x, y, 0.0));
    assert!(inside(0.5, near) && !inside(0.5, near.next_up()));
    assert!(!inside(weld, 0.0) && inside(weld.next_up(), 0.0));
}

/// A triangle over an edge of length 1, and one below it with a side along that edge from `x`, `length` long.
fn lapped(x: f32, length: f32) -> usize {
    let tips = [Vec3::X * x, Vec3::X * (x + length), Vec3::new(x, -1.0, 0.0)];
    let [a, b, c] = tips;
    found(&topology(&[Vec3::ZERO, Vec3::X, Vec3::Y, a, b, c], &[[0, 1, 2], [3, 4, 5]])).len()
}

#[test]
fn what_a_weld_would_collapse_is_no_near_miss() {
    // The diagonal is about 2.2, so two of the tolerances are 2.2e-3 and 2.2e-2.
    assert_eq!(lapped(0.001, 0.4), 1, "only the far end lies inside");
    assert_eq!(lapped(0.001, 0.005), 1, "as a weld of 2.2e-3 moves ends by less than half the side");
    assert_eq!(lapped(0.001, 0.004), 2, "which would collapse");
    assert_eq!(lapped(0.004, 0.04), 2, "as a weld of 2.2e-2 would do");
}

#[test]
fn a_slivers_own_corner_is_not_a_t_junction() {
    let places = [Vec3::ZERO, Vec3::X, Vec3::new(0.5, 1e-7, 0.0)];
    assert_eq!(found(&topology(&places, &[[0, 1, 2]])), []);
}

#[test]
fn a_long_edge_along_many_short_ones() {
    let found = found(&strip(10_000, 1.0));
    assert_eq!(found.len(), 9_999);
    assert!(found.windows(2).all(|pair| pair[0].t < pair[1].t));
}

/// Many triangles from an apex to `base` that share no corners. Their long edges meet at the apex, and their other
/// points lie in one place or along a line.
fn loose_fan(n: u32, base: impl Fn(u32) -> Vec3) -> Topology {
    let places: Vec<_> = (0..n).flat_map(|i| [Vec3::ZERO, base(2 * i), base(2 * i + 1)]).collect();
    let triangles: Vec<_> = (0..n).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    topology(&places, &triangles)
}

#[test]
fn long_edges_and_crowded_spots_stay_fast() {
    let n = 30_000;
    let crowd = loose_fan(n, |i| Vec3::new(1.0, 1.0, 5e-11 * i as f32));
    assert_eq!((found(&crowd).len(), crowd.points.len()), (0, 60_001), "all on two spots");
    let round = loose_fan(n, |i| Vec2::from((i as f32 * 1e-4).sin_cos()).extend(0.0));
    assert_eq!((found(&round).len(), round.points.len()), (0, 60_001), "all along a line");
}

#[test]
fn a_fan_of_60_000_triangles() {
    let n = 60_000;
    let base = |i: u32| Vec2::from((i as f32 * 1e-4).sin_cos()).extend(0.0);
    let places: Vec<_> = (0..=n).map(|i| if i == n { Vec3::Z } else { base(i) }).collect();
    let triangles: Vec<_> = (0..n - 1).map(|i| [n, i, i + 1]).collect();
    assert_eq!(found(&topology(&places, &triangles)).len(), 0);
}

#[test]
fn edges_on_top_of_each_other_are_cut_off() {
    // Each triangle's edge from 0 to x = i passes all points before it.
    let n = 3_000;
    let triangles: Vec<_> = (0..n).map(|i| [0, i + 1, n + 1 + i]).collect();
    let above = (0..n).map(|i| Vec3::new(0.0, 1.0, i as f32));
    let places: Vec<_> = (0..=n).map(|i| Vec3::X * i as f32).chain(above).collect();
    assert_eq!(found(&topology(&places, &triangles)).len(), MOST);
}

#[test]
fn cancelling_stops_the_work() {
    let progress = Progress::new();
    let topology = strip(3, 1.0);
    progress.cancel();
    assert_eq!(t_junctions(&topology, &progress), Err(Cancelled));
}

/// Tests all boundary edges against all boundary points.
fn slow(topology: &Topology) -> Vec<(u32, u32)> {
    let on_edges = PointsOnEdges::new(topology);
    let open = || open_edges(topology);
    let at = |point: u32| topology.points[point as usize].as_dvec3();
    let mut found = Vec::new();
    for (i, edge) in open() {
        let mut points: Vec<u32> = open().flat_map(|(_, other)| topology.edge_points(other)).collect();
        points.sort_unstable();
        points.dedup();
        let line = LineSegment::from_edge(topology, edge);
        points.retain(|&point| on_edges.is_inside(edge, &line, point, at(point)));
        found.extend(points.into_iter().map(|point| (i, point)));
    }
    found
}

proptest! {
    #[test]
    fn the_tree_finds_the_same_as_a_slow_search(
        places in prop::collection::vec((prop::array::uniform3(-3_i8..4), -3_i8..4), 3..40),
        triangles in prop::collection::vec(prop::array::uniform3(0_usize..40), 1..30),
    ) {
        // Whole coordinates, so that many positions lie on edges, moved by about the tolerance.
        let places: Vec<_> = places
            .iter()
            .map(|&(place, off)| Vec3::from(place.map(f32::from)) + Vec3::Y * (3e-5 * f32::from(off)))
            .collect();
        let triangles: Vec<_> = triangles.iter().map(|t| t.map(|i| (i % places.len()) as u32)).collect();
        let topology = topology(&places, &triangles);
        let on_edges = PointsOnEdges::new(&topology);
        let mut found = Vec::new();
        for (i, edge) in open_edges(&topology) {
            let mut points = Vec::new();
            on_edges.find(edge, &mut points);
            points.sort_unstable();
            found.extend(points.into_iter().map(|point| (i, point)));
        }
        prop_assert_eq!(found, slow(&topology));
    }
}

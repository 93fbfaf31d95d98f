use glam::{Mat3, Vec2, Vec3, vec3};
use proptest::prelude::*;

use crate::mesh::t_junctions::{TJunction, t_junctions};
use crate::mesh::{Corner, EdgeKind, Mesh, Shape, Topology};
use crate::progress::Progress;

type Triangles = Vec<[Vec3; 3]>;

fn topology(triangles: &[[Vec3; 3]]) -> Topology {
    let corner = |&position: &Vec3| Corner { position, normal: Vec3::Z, uv: Vec2::ZERO };
    let corners = triangles.as_flattened().iter().map(corner).collect();
    let triangles = (0..triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect::<Vec<_>>().into();
    Topology::build(&Mesh { corners, triangles, ..Mesh::default() }, &Progress::new()).unwrap()
}

fn found(topology: &Topology) -> Vec<TJunction> {
    t_junctions(topology, &Progress::new()).unwrap()
}

fn count(triangles: &[[Vec3; 3]]) -> usize {
    found(&topology(triangles)).len()
}

/// Rows of quads over z from 0 to 4, `density` of them per unit, from `x` to `to`; `place` moves each corner.
fn column(density: u32, x: f32, to: f32, place: impl Fn(Vec2) -> Vec3) -> Triangles {
    let rows = (0..4 * density).flat_map(|row| {
        let [z, next] = [row, row + 1].map(|row| row as f32 / density as f32);
        let [a, b, c, d] = [[x, z], [to, z], [to, next], [x, next]].map(|at| place(Vec2::from(at)));
        [[a, c, b], [a, d, c]]
    });
    rows.collect()
}

/// A wavy surface: its heights over x and z.
fn wave(at: Vec2) -> Vec3 {
    vec3(at.x, 0.25 * (1.5 * at.y + at.x).sin(), at.y)
}

/// A sheet that is `times` as dense on the right of x = 0 as on the left.
fn seam(times: u32, place: impl Fn(Vec2) -> Vec3) -> Triangles {
    [column(1, -1.0, 0.0, &place), column(times, 0.0, 1.0 / times as f32, &place)].concat()
}

fn mirrored(triangles: &[[Vec3; 3]]) -> Triangles {
    triangles.iter().map(|&[a, b, c]| [a, c, b]).collect()
}

#[test]
fn a_curved_seam_has_one_at_every_extra_point() {
    for times in 2..5 {
        for scale in [1e-7, 1.0, 1e7] {
            let sheet: Triangles = seam(times, wave).iter().map(|t| t.map(|place| place * scale)).collect();
            let topology = topology(&sheet);
            let found = found(&topology);
            assert_eq!(found.len() as u32, 4 * (times - 1), "{times} to 1");
            let at = |point: u32| topology.points[point as usize] / scale;
            for junction in &found {
                let [a, b] = topology.edge_points(&topology.edges[junction.edge as usize]).map(at);
                let point = at(junction.point);
                assert!((a.x, point.x, b.x) == (0.0, 0.0, 0.0) && (a.z - b.z).abs() == 1.0, "{junction:?}");
                assert!((a.lerp(b, junction.t).z - point.z).abs() < 0.05, "{junction:?}");
                assert!(junction.distance > 1e-3 * scale && junction.distance < 0.125 * scale, "{junction:?}");
            }
            for run in found.chunk_by(|a, b| a.edge == b.edge) {
                assert_eq!(run.len() as u32, times - 1);
            }
        }
    }
    assert_eq!(count(&seam(1, wave)), 0, "a seam that isn't refined");
}

#[test]
fn a_straight_seam_has_them_once() {
    for times in 2..5 {
        assert_eq!(count(&seam(times, |at| vec3(at.x, 0.0, at.y))) as u32, 4 * (times - 1));
    }
}

#[test]
fn winding_and_order_make_no_difference() {
    let sheet = seam(3, wave);
    let reversed: Triangles = sheet.iter().rev().copied().collect();
    for other in [mirrored(&sheet), [mirrored(&sheet[..8]), sheet[8..].to_vec()].concat(), reversed] {
        assert_eq!(count(&other), 8);
    }
}

#[test]
fn a_ring_in_a_ring() {
    // A seam that curves within its surface: seen from outside, its points lie inside the triangles of the coarse side.
    let turned = |at: Vec2| Vec2::from_angle(at.y * std::f32::consts::TAU / 4.0 / 3.0) * (2.0 + at.x);
    for inwards in [1.0, -1.0] {
        let ring = seam(2, |at| turned(Vec2::new(inwards * at.x, at.y)).extend(0.0));
        assert_eq!(count(&ring), 4, "{inwards}");
    }
}

#[test]
fn a_seam_at_a_fold_of_sixty_degrees() {
    let tilt = Mat3::from_rotation_z(60_f32.to_radians());
    let place = |at: Vec2| {
        let crest = vec3(0.0, 0.2 * (1.5 * at.y).sin(), at.y);
        crest + if at.x > 0.0 { tilt * Vec3::X * at.x } else { Vec3::X * at.x }
    };
    assert_eq!(count(&seam(2, place)), 4);
}

#[test]
fn an_ordinary_border_has_none() {
    assert_eq!(count(&column(2, 0.0, 1.0, wave)), 0);
    assert_eq!(count(&column(8, 0.0, 0.01, wave)), 0, "a narrow one");
    for shape in [Shape::Saddle, Shape::Moebius] {
        assert_eq!(found(&Topology::build(&shape.build(), &Progress::new()).unwrap()), [], "{shape}");
    }
}

/// A fan or strip of triangles over the edge from 0 to 1 along x and the points above it.
fn ribbon(above: &[Vec3], split: usize) -> Triangles {
    let mut triangles = vec![[Vec3::ZERO, Vec3::X, above[split]]];
    triangles.extend((0..split).map(|k| [Vec3::ZERO, above[k + 1], above[k]]));
    triangles.extend((split..above.len() - 1).map(|k| [Vec3::X, above[k + 1], above[k]]));
    triangles
}

#[test]
fn a_thin_ribbon_has_none() {
    let arch = [0.2, 0.4, 0.6, 0.8].map(|x| vec3(x, 0.3 * x * (1.0 - x), 0.02 * (9.0 * x).sin()));
    for split in 0..arch.len() {
        assert_eq!(count(&ribbon(&arch, split)), 0, "fanned to {split}");
    }
    assert_eq!(count(&column(1, 0.0, 0.05, wave)), 0, "quads");
    // The strip also has points inside, so that no third corner lies on its border.
    let middle = [0.3, 0.7].map(|x| vec3(x, 0.02, 0.0));
    let ([p, q, r, s], [m, n]) = (arch, middle);
    let filled = [
        [Vec3::ZERO, Vec3::X, m],
        [Vec3::X, n, m],
        [Vec3::ZERO, m, p],
        [p, m, q],
        [q, m, n],
        [q, n, r],
        [r, n, s],
        [s, n, Vec3::X],
    ];
    assert_eq!(count(&filled), 0, "with points inside");
}

#[test]
fn a_leaf_has_none() {
    let [p, q] = [vec3(0.3, 0.05, 0.01), vec3(0.7, 0.05, 0.0)];
    assert_eq!(count(&ribbon(&[p, q], 0)), 0);
    assert_eq!(count(&ribbon(&[p, q], 1)), 0);
    assert_eq!(count(&[[Vec3::ZERO, Vec3::X, p]]), 0, "a sliver");
    let below = vec3(0.5, -0.05, 0.0);
    assert_eq!(count(&[[Vec3::ZERO, p, below], [Vec3::X, below, p]]), 0, "a rhombus");
}

#[test]
fn isolated_slivers_have_none() {
    // A chain of triangles that is as long as the edge below it. The triangles go down by more than a thousandth, by
    // less, or go up.
    let [p, q] = [vec3(0.3, -0.03, 0.0), vec3(0.7, -0.03, 0.0)];
    let slivers = |y: f32| [[Vec3::ZERO, p, p.midpoint(Vec3::ZERO) + Vec3::Y * y], [p, q, p.midpoint(q) + Vec3::Y * y]];
    for y in [-0.01, -9e-4, 1e-4, 0.02] {
        let all = [&slivers(y)[..], &[[q, Vec3::X, q.midpoint(Vec3::X) + Vec3::Y * y], [Vec3::ZERO, Vec3::X, Vec3::Y]]];
        let expected = if y < -1e-3 { 2 } else { 0 };
        assert_eq!(count(&all.concat()), expected, "{y}");
    }
}

#[test]
fn an_edge_of_a_sliver_has_none() {
    for (height, expected) in [(9e-4, 0), (1.1e-3, 1)] {
        let mut sliver = hole(0.05);
        sliver[0][2] = vec3(0.4, height, 0.0);
        assert_eq!(count(&sliver), expected, "{height}");
    }
}

/// A triangle over the edge from 0 to 1 along x, and two below it that leave a hole of this depth between.
fn hole(depth: f32) -> Triangles {
    let (low, far) = (vec3(0.5, -depth, 0.0), vec3(0.5, -2.0, 0.0));
    vec![[Vec3::ZERO, Vec3::X, vec3(0.5, 1.0, 0.0)], [Vec3::ZERO, far, low], [Vec3::X, low, far]]
}

#[test]
fn a_hole_counts_when_it_is_thin() {
    for (depth, expected) in [(0.01, 1), (0.125, 1), (0.126, 0), (0.5, 0), (0.9, 0)] {
        assert_eq!(count(&hole(depth)), expected, "{depth}");
    }
}

#[test]
fn points_must_come_in_order_between_the_ends() {
    let far = |x: f32| vec3(x, -1.0, 0.0);
    let over = [Vec3::ZERO, Vec3::X, vec3(0.5, 1.0, 0.0)];
    let chain = |xs: &[f32]| {
        let inner = xs.iter().map(|&x| vec3(x, -0.02, 0.0));
        let places: Vec<_> = [Vec3::ZERO].into_iter().chain(inner).chain([Vec3::X]).collect();
        let below = places.windows(2).zip(0..).map(|(ends, k)| [ends[0], far(k as f32), ends[1]]);
        count(&[over].into_iter().chain(below).collect::<Vec<_>>())
    };
    assert_eq!(chain(&[0.3, 0.6]), 2);
    assert_eq!(chain(&[0.6, 0.3]), 0, "back and forth");
    assert_eq!(chain(&[-0.1, 0.5]), 0, "before the start");
    assert_eq!(chain(&[0.5, 1.0]), 0, "not before the end");
}

#[test]
fn a_path_that_ends_blindly_hides_no_chain() {
    // At the start of the chain another open edge starts too, which leads nowhere.
    let blind = [Vec3::ZERO, vec3(0.4, 0.0, 0.05), vec3(0.1, -1.0, 1.0)];
    for triangles in [[hole(0.05), vec![blind]].concat(), [vec![blind], hole(0.05)].concat()] {
        assert_eq!(count(&triangles), 1);
    }
}

#[test]
fn chains_of_many_points_and_many_paths_stay_fast() {
    let n = 10_000;
    let arc = |i: u32| {
        let x = i as f32 / n as f32;
        vec3(x, -0.2 * x * (1.0 - x), 0.0)
    };
    let below = (0..n).map(|i| [arc(i), arc(i).with_y(-1.0), arc(i + 1)]);
    let over = [Vec3::ZERO, Vec3::X, Vec3::ONE];
    assert_eq!(count(&[over].into_iter().chain(below).collect::<Vec<_>>()), n as usize - 1);
    // A row of open edges under thousands of long ones that never meet it again.
    let lines = (0..3_000).flat_map(|i| {
        let [x, next, far] = [i, i + 1, i + 4_000].map(|i| i as f32);
        let [x, next, end] = [Vec3::X * x, Vec3::X * next, vec3(far, 400.0, 0.0)];
        [[x, next, x - 100.0 * Vec3::Y], [x, end, end + Vec3::Z * 100.0]]
    });
    assert_eq!(count(&lines.collect::<Vec<_>>()), 0);
}

/// Tetrahedra: whatever their corners, every edge has two sides or more.
fn tetrahedra(places: &[[i8; 3]], corners: &[[usize; 4]]) -> Triangles {
    let at = |i: usize| Vec3::from(places[i % places.len()].map(f32::from));
    let faces = |corners: &[usize; 4]| {
        let [a, b, c, d] = corners.map(at);
        [[a, b, c], [a, c, d], [a, d, b], [b, d, c]]
    };
    corners.iter().flat_map(faces).collect()
}

proptest! {
    #[test]
    fn a_mesh_without_open_edges_has_none(
        places in prop::collection::vec(prop::array::uniform3(-3_i8..4), 4..20),
        corners in prop::collection::vec(prop::array::uniform4(0_usize..20), 1..12),
    ) {
        let topology = topology(&tetrahedra(&places, &corners));
        prop_assert_eq!(topology.edge_counts().boundary, 0);
        prop_assert_eq!(found(&topology), []);
    }

    #[test]
    fn each_is_listed_once_in_order_and_lies_beside_its_edge(
        places in prop::collection::vec(prop::array::uniform3(-3_i8..4), 4..20),
        corners in prop::collection::vec(prop::array::uniform3(0_usize..20), 1..40),
    ) {
        let at = |i: usize| Vec3::from(places[i % places.len()].map(f32::from));
        let triangles: Triangles = corners.iter().map(|corners| corners.map(at)).collect();
        let topology = topology(&triangles);
        let found = found(&topology);
        let order = |a: &TJunction, b: &TJunction| a.edge.cmp(&b.edge).then(a.t.total_cmp(&b.t));
        prop_assert!(found.is_sorted_by(|a, b| order(a, b).is_le()));
        let mut pairs: Vec<_> = found.iter().map(|junction| (junction.edge, junction.point)).collect();
        pairs.sort_unstable();
        prop_assert!(pairs.windows(2).all(|pair| pair[0] != pair[1]), "listed twice");
        for junction in found {
            let edge = &topology.edges[junction.edge as usize];
            let [a, b] = topology.edge_points(edge).map(|point| topology.points[point as usize]);
            prop_assert!(edge.kind == EdgeKind::Boundary && !topology.edge_points(edge).contains(&junction.point));
            prop_assert!(junction.t > 0.0 && junction.t < 1.0 && junction.distance <= 0.126 * a.distance(b));
        }
    }
}

//! The modified butterfly scheme.

use super::*;

/// What each point of a shape contributes to the point that one level makes of an edge.
fn weights(shape: &Shape, edge: [u32; 2]) -> Vec<f64> {
    let refinement = Refinement::new(&shape.cage(), 1, MANY).unwrap();
    let points = shape.positions.len();
    let place = points + shape.edges().iter().position(|other| *other == edge).unwrap();
    let of_point = |point: usize| {
        let mut values = vec![0.0; points];
        values[point] = 1.0;
        let refined = refinement.refine(&values);
        assert_eq!(refined[..points], values, "points stay where they are");
        refined[place]
    };
    (0..points).map(of_point).collect()
}

fn assert_weights(found: &[f64], expected: &[(usize, f64)]) {
    for (point, weight) in found.iter().enumerate() {
        let own: f64 = expected.iter().filter(|(other, _)| *other == point).map(|(_, weight)| weight).sum();
        assert!((weight - own).abs() < 1e-14, "point {point}: {weight}, not {own}");
    }
    assert!((found.iter().sum::<f64>() - 1.0).abs() < 1e-14);
}

/// The published weights of the neighbours of a point with so many edges, from the one on the edge that is divided.
fn published(edges: u32) -> Vec<f64> {
    match edges {
        3 => vec![5.0 / 12.0, -1.0 / 12.0, -1.0 / 12.0],
        4 => vec![3.0 / 8.0, 0.0, -1.0 / 8.0, 0.0],
        _ => {
            let angle = |k: u32| TAU * f64::from(k) / f64::from(edges);
            let weight = |k| (0.25 + angle(k).cos() + 0.5 * (2.0 * angle(k)).cos()) / f64::from(edges);
            (0..edges).map(weight).collect()
        }
    }
}

#[test]
fn butterfly_edges_have_the_published_weights() {
    // Both ends of a rib are irregular: one of each number of edges, and one of four.
    for edges in [3, 4, 5, 7, 12] {
        let found = weights(&poles(edges, Scheme::Butterfly), [0, 2]);
        let rim = published(edges).into_iter().enumerate().map(|(k, weight)| (2 + k, weight / 2.0));
        let halves = [(0, 3.0 / 8.0), (2, 3.0 / 8.0), (0, 3.0 / 16.0), (1, -1.0 / 16.0)];
        assert_weights(&found, &rim.chain(halves).collect::<Vec<_>>());
    }
    // With six edges at the pole, the other end alone decides.
    let found = weights(&poles(6, Scheme::Butterfly), [0, 2]);
    assert_weights(&found, &[(2, 0.75), (0, 0.375), (1, -0.125)]);
    // Between two regular points, eight points count. From (2, 2) to (3, 2):
    let found = weights(&triangle_grid(5), [14, 15]);
    let near = [(14, 0.5), (15, 0.5), (8, 0.125), (21, 0.125)];
    let wings = [7, 9, 20, 22].map(|point| (point, -0.0625));
    assert_weights(&found, &[near, wings].concat());
}

#[test]
fn butterfly_boundaries_have_the_weights_of_four_points() {
    let usual = [(0, -0.0625), (1, 0.5625), (2, 0.5625), (3, -0.0625)];
    assert_weights(&weights(&triangle_grid(3), [1, 2]), &usual);
    // A corner has its neighbour mirrored behind it; without corners the boundary goes on around it.
    let at_end = [(1, -0.0625), (2, 0.625), (3, 0.4375)];
    assert_weights(&weights(&triangle_grid(3), [2, 3]), &at_end);
    let smooth = Shape { boundary: Boundary::Edges, ..triangle_grid(3) };
    assert_weights(&weights(&smooth, [2, 3]), &[(1, -0.0625), (2, 0.5625), (3, 0.5625), (7, -0.0625)]);
    // The same along a crease through the inside, which takes nothing from beside it, half of it if it is half as sharp.
    let creased = |sharpness| {
        let creases = vec![([6, 11], 10.0), ([11, 16], sharpness), ([16, 21], 10.0)];
        weights(&Shape { creases, ..triangle_grid(4) }, [11, 16])
    };
    assert_weights(&creased(10.0), &[(6, -0.0625), (11, 0.5625), (16, 0.5625), (21, -0.0625)]);
    assert!(creased(0.5).iter().filter(|weight| **weight != 0.0).count() > 6);
    assert!((creased(0.5).iter().sum::<f64>() - 1.0).abs() < 1e-15);
}

#[test]
fn butterfly_grids_follow_cubics_and_stay_flat_and_even_at_boundaries() {
    let cubic = |p: DVec3| p.with_z((p.x - 4.0).powi(3) - 0.5 * p.x * p.x * p.y + (p.y - 3.0).powi(3) + p.x * p.y);
    let plain = triangle_grid(8);
    let shape = Shape { positions: plain.positions.iter().copied().map(cubic).collect(), ..plain };
    let (refinement, refined) = shape.refined(2);
    let inner = |p: &&DVec3| p.truncate().min_element() >= 3.0 && p.truncate().max_element() <= 5.0;
    assert_eq!(refined.iter().filter(inner).count(), 81);
    refined.iter().filter(inner).for_each(|p| assert!((*p - cubic(*p)).length() < 1e-11, "{p}"));
    assert_eq!(refinement.limit(&refined).values(), refined);
    // Corners of two faces aren't corners unless they are said to be.
    let flat = Shape { sharp_points: vec![(0, 10.0), (15, 10.0)], ..triangle_grid(3) };
    let (refinement, refined) = flat.refined(1);
    for (edge, middle) in flat.edges().iter().zip(&refined[16..]) {
        let [a, b] = edge.map(|point| flat.positions[point as usize]);
        assert_near(*middle, (a + b) / 2.0);
    }
    assert!(refinement.limit(&refined).normals().iter().all(|normal| normal.distance(Vec3::Z) < 1e-7));
}

#[test]
fn a_butterfly_sphere_gets_rounder_from_level_to_level() {
    let sphere = poles(5, Scheme::Butterfly);
    let round = sphere.positions.iter().map(|p| p.with_z(p.z.trunc()).normalize()).collect();
    let sphere = Shape { positions: round, ..sphere };
    // How far a level moves the middles of edges away from both of their faces.
    let step = |levels| {
        let (refinement, refined) = sphere.refined(levels);
        let level = refinement.finest();
        let at = |side: u32| refined[level.origins[side as usize] as usize];
        let normal = |side: u32| {
            let [b, c] = [level.polygons.after(side), level.polygons.before(side)].map(|other| at(other) - at(side));
            b.cross(c).normalize()
        };
        let (_, finer) = sphere.refined(levels + 1);
        let moved = level.edge_sides.iter().zip(&finer[refined.len()..]).map(|(&[a, b], middle)| {
            let from = (at(a) + at(level.polygons.after(a))) / 2.0;
            (*middle - from).dot((normal(a) + normal(b)).normalize()).abs()
        });
        moved.fold(0.0, f64::max)
    };
    let steps = [2, 3, 4].map(step);
    for [before, after] in steps.array_windows() {
        assert!((0.25..0.36).contains(&(after / before)), "{steps:?}");
    }
}

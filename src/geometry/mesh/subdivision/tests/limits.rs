//! Points and normals of the limit surface.

use super::*;

/// The four uniform cubic B-splines over an interval, and their slopes.
fn splines(t: f64) -> [[f64; 4]; 2] {
    let s = 1.0 - t;
    let values = [s.powi(3), 3.0 * t.powi(3) - 6.0 * t * t + 4.0, 3.0 * s.powi(3) - 6.0 * s * s + 4.0, t.powi(3)];
    let slopes = [-3.0 * s * s, 9.0 * t * t - 12.0 * t, 12.0 * s - 9.0 * s * s, 3.0 * t * t];
    [values.map(|value| value / 6.0), slopes.map(|slope| slope / 6.0)]
}

#[test]
fn a_regular_grid_becomes_a_bicubic_spline() {
    let shape = grid(5).shaken(&mut fastrand::Rng::with_seed(3));
    let (refinement, refined) = shape.refined(2);
    let places: Vec<DVec2> = grid(5).refined(2).1.into_iter().map(DVec3::truncate).collect();
    let limit = refinement.limit(&refined);
    let (values, mut inner) = (limit.values(), 0);
    for (point, normal) in refinement.corners().iter().zip(limit.normals()) {
        let at = places[*point as usize];
        // Of a grid over whole numbers, refinement moves only what is near the boundary.
        let cell = at.floor().min(DVec2::splat(3.0));
        if at.min_element() < 1.0 || at.max_element() > 4.0 {
            continue;
        }
        let [x, y] = [splines(at.x - cell.x), splines(at.y - cell.y)];
        let sum = |dx: usize, dy: usize| {
            let term = |k: usize| {
                let point = (cell.y as usize - 1 + k / 4) * 6 + cell.x as usize - 1 + k % 4;
                shape.positions[point] * x[dx][k % 4] * y[dy][k / 4]
            };
            (0..16).map(term).sum::<DVec3>()
        };
        assert_near(values[*point as usize], sum(0, 0));
        assert!(normal.distance(sum(1, 0).cross(sum(0, 1)).normalize().as_vec3()) < 1e-6);
        inner += 1;
    }
    assert!(inner > 4 * 100, "{inner}");
}

/// Asserts that the limits of the first points of a shape, and the normals there, are the same from each level.
fn assert_same_limit(shape: &Shape, points: usize) {
    let [coarse, fine] = [0, 1].map(|levels| {
        let (refinement, refined) = shape.refined(levels);
        let limit = refinement.limit(&refined);
        let mut normals = HashMap::<u32, Vec<Vec3>>::new();
        for (point, normal) in refinement.corners().iter().zip(limit.normals()) {
            normals.entry(*point).or_default().push(normal);
        }
        (limit.values(), normals)
    });
    for point in 0..points {
        assert_near(coarse.0[point], fine.0[point]);
        for normal in &coarse.1[&to_u32(point)] {
            let nearest = fine.1[&to_u32(point)].iter().map(|other| other.distance(*normal)).fold(9.0, f32::min);
            assert!(nearest < 1e-6, "point {point}: {normal}, {:?}", fine.1[&to_u32(point)]);
        }
    }
}

#[test]
fn limits_are_the_same_from_every_level() {
    let mut random = fastrand::Rng::with_seed(1);
    for scheme in [Scheme::CatmullClark, Scheme::Loop] {
        for edges in 3..=20 {
            let shape = poles(edges, scheme).shaken(&mut random);
            assert_same_limit(&shape, 2);
            // A crease over a pole divides it into two sectors.
            let far = if scheme == Scheme::Loop { [2, 2 + edges / 2] } else { [2, 2 + 2 * (edges / 2)] };
            let creases = far.map(|far| ([0, far], 10.0)).to_vec();
            assert_same_limit(&Shape { creases, ..shape }, 1);
        }
        for faces in 1..=9 {
            assert_same_limit(&fan(faces, scheme).shaken(&mut random), 1);
        }
    }
}

#[test]
fn equal_values_stay_equal_and_have_no_tangents() {
    for shape in varied() {
        let (refinement, _) = shape.refined(2);
        let refined = refinement.refine(&vec![1.0; shape.positions.len()]);
        let limit = refinement.limit(&refined);
        assert!(refined.iter().chain(&limit.values()).all(|value: &f64| (value - 1.0).abs() < 1e-14));
        for corner in 0..refinement.corners().len() {
            assert!(limit.tangents(corner).iter().all(|tangent| tangent.abs() < 1e-12));
        }
    }
}

#[test]
fn normals_are_those_of_tangents() {
    for shape in varied() {
        let (refinement, refined) = shape.refined(1);
        let limit = refinement.limit(&refined);
        for (corner, normal) in limit.normals().into_iter().enumerate() {
            let [a, b] = limit.tangents(corner);
            assert_eq!(normal, a.cross(b).normalize_or_zero().as_vec3());
        }
    }
}

#[test]
fn all_faces_at_a_smooth_point_share_its_normal() {
    for shape in [poles(5, Scheme::CatmullClark), poles(7, Scheme::Loop)] {
        let (refinement, refined) = shape.refined(2);
        let mut normals = HashMap::new();
        for (point, normal) in refinement.corners().iter().zip(refinement.limit(&refined).normals()) {
            assert_eq!(*normals.entry(*point).or_insert(normal), normal);
        }
    }
    // Half a cube's edges around one face are sharp: each point there has a normal for either side.
    let lid = Shape { creases: [[4, 5], [5, 7], [6, 7], [4, 6]].map(|edge| (edge, 10.0)).to_vec(), ..cube() };
    let (refinement, refined) = lid.refined(1);
    let normals = refinement.limit(&refined).normals();
    let of_point = |point| refinement.corners().iter().zip(&normals).filter(move |(at, _)| **at == point);
    let mut distinct: Vec<[u32; 3]> = of_point(7).map(|(_, normal)| normal.to_array().map(f32::to_bits)).collect();
    distinct.sort_unstable();
    distinct.dedup();
    assert_eq!(distinct.len(), 2);
}

//! What one level makes of points and edges, by the rules of Catmull and Clark and of Loop: creases, corners and boundaries.

use super::*;

#[test]
fn a_cube_becomes_what_catmull_and_clark_say() {
    let cube = cube();
    let (refinement, refined) = cube.refined(1);
    assert_eq!((refinement.points(), refinement.faces().count()), (8 + 12 + 6, 24));
    // 1/3 of the point, 1/9 of three neighbours and three centers.
    assert_near(refined[7], DVec3::splat(5.0 / 9.0));
    assert_near(middle(&cube, &refined, [3, 7]), DVec3::new(0.75, 0.75, 0.0));
    assert_eq!(refined[8 + 12 + 1], DVec3::Z);
    // A limit of (6v + 2Σe + 4Σf) / 24.
    let (refinement, own) = cube.refined(0);
    let limit = refinement.limit(&own);
    assert_near(limit.values()[7], DVec3::splat(0.5));
    for (point, normal) in refinement.corners().iter().zip(limit.normals()) {
        assert!(normal.distance(cube.positions[*point as usize].normalize().as_vec3()) < 1e-7);
    }
}

#[test]
fn an_octahedron_becomes_what_loop_says() {
    let octahedron = poles(4, Scheme::Loop);
    let octahedron =
        Shape { positions: octahedron.positions.iter().map(|p| p.with_z(p.z.trunc())).collect(), ..octahedron };
    let (_, refined) = octahedron.refined(1);
    assert_near(refined[0], DVec3::Z * 33.0 / 64.0);
    assert_near(middle(&octahedron, &refined, [0, 2]), DVec3::new(0.375, 0.0, 0.375));
    let (refinement, own) = octahedron.refined(0);
    assert_near(refinement.limit(&own).values()[0], DVec3::Z * 24.0 / 55.0);
}

#[test]
fn sharpness_blends_rules_and_falls_by_one_a_level() {
    let at = |sharpness, levels| {
        let cube = cube().creased(sharpness);
        let (_, refined) = cube.refined(levels);
        (refined[7].x, middle(&cube, &refined, [3, 7]).x)
    };
    assert_eq!(at(10.0, 1), (1.0, 1.0));
    assert_eq!(at(1.0, 1), (1.0, 1.0));
    let (corner, edge) = at(0.5, 1);
    assert!((corner - (0.5 + 0.5 * 5.0 / 9.0)).abs() < 1e-15 && (edge - 0.875).abs() < 1e-15);
    // The cube stays one for two levels, and is smoothed from there.
    assert_eq!(at(2.0, 2).0, 1.0);
    assert!(at(2.0, 3).0 < 1.0);
}

#[test]
fn a_crease_that_fades_on_one_side_becomes_a_dart() {
    // Two edges through the middle of a grid: one stays sharp, of the other 0.25 are left.
    let shape = Shape { creases: vec![([11, 12], 10.0), ([12, 13], 0.25)], ..grid(4) };
    let shape = Shape { positions: shape.positions.iter().map(|p| p.with_z((p.x - 2.0).powi(2))).collect(), ..shape };
    let (_, refined) = shape.refined(1);
    let crease = (1.0 + 1.0) / 8.0;
    let smooth = (4.0 * 0.5 + 2.0 * 1.0) / 16.0;
    assert!((refined[12].z - (0.25 * crease + 0.75 * smooth)).abs() < 1e-15);
}

#[test]
fn a_cube_of_sharp_edges_stays_a_cube() {
    let (refinement, refined) = cube().creased(10.0).refined(3);
    let limit = refinement.limit(&refined);
    for position in refined.iter().chain(&limit.values()) {
        assert_eq!(position.abs().max_element(), 1.0);
    }
    for (point, normal) in refinement.corners().iter().zip(limit.normals()) {
        let position = refined[*point as usize].as_vec3();
        assert!(normal.abs().max_element() > 1.0 - 1e-6 && position.dot(normal) > 1.0 - 1e-6, "{normal} at {position}");
    }
}

#[test]
fn boundaries_are_curves_with_or_without_corners() {
    for (boundary, corner, limit) in [(Boundary::Edges, 0.125, 1.0 / 6.0), (Boundary::EdgesAndCorners, 0.0, 0.0)] {
        let square = Shape { boundary, ..grid(1) };
        let (_, refined) = square.refined(1);
        assert_near(refined[0], DVec3::new(corner, corner, 0.0));
        let (refinement, own) = square.refined(0);
        assert_near(refinement.limit(&own).values()[0], DVec3::new(limit, limit, 0.0));
        assert!(refinement.limit(&own).normals().iter().all(|normal| normal.distance(Vec3::Z) < 1e-7));
    }
}

//! Texture coordinates, which differ between the faces at a point, by each rule for their boundaries.

use glam::DVec4;

use super::*;

/// The limits of values at the corners of a shape's faces, without refinement, by all rules in their order.
fn face_varying(shape: &Shape, values: &[DVec2], levels: u8) -> [Vec<DVec2>; 6] {
    let values: Vec<DVec4> = values.iter().map(|value| value.extend(0.0).extend(0.0)).collect();
    let (refinement, _) = shape.refined(levels);
    FaceVarying::ALL.map(|rule| {
        let refined = refinement.refine_face_varying(&values, rule);
        refined.into_iter().map(|value| value.truncate().truncate()).collect()
    })
}

#[test]
fn two_faces_have_the_coordinates_that_each_rule_gives_them() {
    // Side by side, with u = 0, 1, 4 and v = y.
    let faces: [&[u32]; 2] = [&[0, 1, 4, 3], &[1, 2, 5, 4]];
    let at = |k: u32| DVec2::new([0.0, 1.0, 4.0][k as usize % 3], f64::from(k / 3));
    let pair = Shape { boundary: Boundary::Edges, ..Shape::new((0..6).map(|k| at(k).extend(0.0)).collect(), &faces) };
    let joined: Vec<DVec2> = pair.corners.iter().map(|&point| at(point)).collect();
    let near = |a: DVec2, b: [f64; 2]| assert!(a.distance(b.into()) < 1e-14, "{a} is not {b:?}");
    let [smooth, corners, junctions, concave, boundaries, linear] = face_varying(&pair, &joined, 0);
    // (4 times itself, and its neighbours along the boundary) / 6.
    near(smooth[0], [1.0 / 6.0, 1.0 / 6.0]);
    near(smooth[1], [4.0 / 3.0, 0.0]);
    for kept in [corners, junctions, concave] {
        near(kept[0], [0.0, 0.0]);
        near(kept[1], [4.0 / 3.0, 0.0]);
    }
    assert_eq!((&boundaries, &linear), (&joined, &joined));
    // Between them, the boundaries' rule is smooth: its limit in the middle of the first face.
    let [.., boundaries, linear] = face_varying(&pair, &joined, 1);
    near(boundaries[2], [19.0 / 36.0, 0.5]);
    near(linear[2], [0.5, 0.5]);
    // A seam makes four corners of the two points on it.
    let seam: Vec<DVec2> =
        joined.iter().enumerate().map(|(k, &uv)| uv + DVec2::X * if k > 3 { 10.0 } else { 0.0 }).collect();
    let [smooth, corners, ..] = face_varying(&pair, &seam, 0);
    near(smooth[1], [5.0 / 6.0, 1.0 / 6.0]);
    near(smooth[4], [11.5, 1.0 / 6.0]);
    assert_eq!(corners, seam);
    // What is a corner of the surface is one for the coordinates too.
    let [smooth, ..] = face_varying(&Shape { boundary: Boundary::EdgesAndCorners, ..pair }, &seam, 0);
    near(smooth[0], [0.0, 0.0]);
    near(smooth[1], [5.0 / 6.0, 1.0 / 6.0]);
}

#[test]
fn ends_of_seams_junctions_and_concave_corners_are_kept_by_their_rules() {
    let shape = grid(2);
    // The u of one corner of a face, of the middle or beside it; the others are 0.
    let uvs = |of: &dyn Fn(usize, u32) -> f64| -> Vec<DVec2> {
        shape.corners.iter().enumerate().map(|(k, &point)| DVec2::new(of(k / 4, point), 0.0)).collect()
    };
    let middle = |values: &[DVec2], corner: usize| {
        let all = face_varying(&shape, values, 0);
        all.map(|values| (values[corner].x * 6.0).round())
    };
    // A seam from the boundary, point 1, to the middle: its sides have u = 6 and 0.
    let dart = uvs(&|face, point| if face == 1 && point == 1 { 6.0 } else { 0.0 });
    assert_eq!(middle(&dart, 2), [6.0, 6.0, 6.0, 0.0, 0.0, 0.0]);
    // Three islands meet in the middle, one of two faces, whose value there is 6.
    let three = uvs(&|face, point| match face {
        0 => 10.0,
        1 => 11.0,
        _ => {
            if point == 4 {
                6.0
            } else {
                0.0
            }
        }
    });
    assert_eq!(middle(&three, 9), [24.0, 24.0, 36.0, 36.0, 36.0, 36.0]);
    // One face is an island of its own, and the other three turn around it.
    let concave = uvs(&|face, point| {
        if face == 0 {
            10.0
        } else if point == 4 {
            6.0
        } else {
            0.0
        }
    });
    assert_eq!(middle(&concave, 9), [24.0, 24.0, 24.0, 36.0, 36.0, 36.0]);
    assert_eq!(middle(&concave, 2), [60.0; 6]);
}

/// The sums of all values at corners, and of their squares, that OpenSubdiv 3.5.0 gives (Far, in f64), by each rule.
const BY_OPEN_SUBDIV: [[f64; 2]; 6] = [
    [5898.330049652913, 126024.59816370188],
    [5963.182032120572, 129215.6615063689],
    [5963.784669311471, 129239.78963201137],
    [5956.711047484566, 129248.7760659533],
    [5891.128970569931, 128535.49484748353],
    [5763.836873243539, 127863.48050108289],
];

#[test]
fn rules_for_coordinates_are_those_of_open_subdiv() {
    // Islands, of which two touch, a seam that ends, creases and a sharp point.
    let shape = Shape {
        creases: vec![([7, 12], 10.0), ([16, 17], 0.6)],
        sharp_points: vec![(8, 1.5)],
        boundary: Boundary::EdgesAndCorners,
        ..grid(4)
    };
    let value = |(corner, &point): (usize, &u32)| {
        let island = match (corner / 4, corner % 4) {
            (5, _) => 1.0,
            (10 | 11, _) => 2.0,
            (15, _) => 3.0,
            (8, 0) => 4.0,
            _ => 0.0,
        };
        DVec2::new((1.0 + 1.7 * f64::from(point)).sin() + 10.0 * island, 0.0)
    };
    let values: Vec<DVec2> = shape.corners.iter().enumerate().map(value).collect();
    let found = face_varying(&shape, &values, 2).map(|values| {
        let sums = values.iter().fold(DVec2::ZERO, |sums, value| sums + DVec2::new(value.x, value.x * value.x));
        sums.to_array()
    });
    for (rule, (found, expected)) in FaceVarying::ALL.iter().zip(found.iter().zip(BY_OPEN_SUBDIV)) {
        let near = |k: usize| (found[k] - expected[k]).abs() < 1e-6 * expected[k];
        assert!(near(0) && near(1), "{rule:?}: {found:?}, not {expected:?}");
    }
}

#[test]
fn seams_stay_and_shared_coordinates_stay_shared() {
    let mut shape = triangle_grid(4);
    for scheme in [Scheme::Loop, Scheme::Butterfly] {
        shape.scheme = scheme;
        let uvs: Vec<DVec2> = shape
            .corners
            .iter()
            .enumerate()
            .map(|(k, &point)| {
                shape.positions[point as usize].truncate() + DVec2::splat(if k / 3 < 16 { 0.0 } else { 100.0 })
            })
            .collect();
        let (refinement, _) = shape.refined(2);
        for refined in face_varying(&shape, &uvs, 2) {
            let mut at_points = HashMap::<u32, Vec<DVec2>>::new();
            for (point, uv) in refinement.corners().iter().zip(refined) {
                let found = at_points.entry(*point).or_default();
                if !found.contains(&uv) {
                    found.push(uv);
                }
            }
            let torn = at_points.values().filter(|found| found.len() == 2).count();
            assert_eq!((torn, at_points.values().map(Vec::len).max()), (17, Some(2)), "{scheme:?}");
        }
    }
}

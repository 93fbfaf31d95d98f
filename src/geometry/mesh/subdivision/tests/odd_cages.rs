//! Cages that are large, unusual or wrong.

use super::*;

#[test]
fn a_face_of_ten_thousand_corners_is_refined() {
    let count = 10_000;
    let ring = |z: f64| (0..count).map(move |k| DVec2::from_angle(TAU * f64::from(k) / f64::from(count)).extend(z));
    let lid: Vec<u32> = (0..count).collect();
    let shape = Shape::new(ring(0.5).collect(), &[&lid]);
    let (refinement, refined) = shape.refined(2);
    assert_eq!(refinement.faces().count(), 40_000);
    assert_near(*refined[shape.positions.len() * 2..].first().unwrap(), DVec3::Z * 0.5);
    assert!(refinement.limit(&refined).normals().iter().all(|normal| normal.distance(Vec3::Z) < 1e-5));
}

#[test]
fn many_faces_around_a_point_take_no_longer_than_elsewhere() {
    for scheme in [Scheme::CatmullClark, Scheme::Loop, Scheme::Butterfly] {
        for boundary in [Boundary::Edges, Boundary::EdgesAndCorners] {
            let open = Shape { boundary, ..fan(50_000, scheme) };
            let tip = Shape { sharp_points: vec![(0, 10.0)], ..poles(50_000, scheme) };
            for shape in [open, tip] {
                let (refinement, refined) = shape.refined(1);
                assert_eq!(refinement.limit(&refined).normals().len(), refinement.corners().len());
            }
        }
    }
}

#[test]
fn points_of_several_fans_and_turned_faces_stay_where_they_are() {
    let mut shape = grid(3);
    shape.corners[4 * 4..5 * 4].reverse();
    let two = Shape::new(grid(2).positions, &[&[0, 1, 4, 3], &[4, 5, 8, 7]]);
    for (shape, fixed) in [(shape, 5), (two, 4)] {
        let (refinement, refined) = shape.refined(2);
        let limit = refinement.limit(&refined);
        assert_eq!((refined[fixed], limit.values()[fixed]), (shape.positions[fixed], shape.positions[fixed]));
        assert!(limit.normals().iter().all(|normal| (normal.z.abs() - 1.0).abs() < 1e-6));
    }
}

#[test]
fn points_without_faces_and_cages_without_any_are_kept() {
    let lone = Shape { positions: vec![DVec3::X, DVec3::Y], starts: vec![0], ..Shape::default() };
    for scheme in [Scheme::CatmullClark, Scheme::Loop, Scheme::Butterfly] {
        let (refinement, refined) = Shape { scheme, ..lone.clone() }.refined(3);
        assert_eq!((refined, refinement.faces().count()), (vec![DVec3::X, DVec3::Y], 0));
    }
}

#[test]
fn wrong_cages_are_refused_with_their_place() {
    let shape = cube();
    let refused = |cage: Cage| Refinement::new(&cage, 1, MANY).map(|_| ()).unwrap_err();
    let of = |starts: &[u32], corners: &[u32]| refused(Cage { starts, corners, ..shape.cage() });
    assert_eq!(of(&[], &[]), CageError::Starts { corners: 0 });
    assert_eq!(of(&[0, 3], &[0, 1, 2, 3]), CageError::Starts { corners: 4 });
    assert_eq!(of(&[0, 9, 3], &[0, 1, 2]), CageError::TooFewCorners { face: 1, corners: 0 });
    assert_eq!(of(&[0, 3, 5], &[0, 1, 2, 3, 4]), CageError::TooFewCorners { face: 1, corners: 2 });
    assert_eq!(of(&[0, 1], &[0]), CageError::TooFewCorners { face: 0, corners: 1 });
    assert_eq!(of(&[0, 4], &[0, 1, 2, 1]), CageError::RepeatedPoint { face: 0, point: 1 });
    let beyond = |user, index| CageError::NoSuchPoint { user, index, point: 8, points: 8 };
    assert_eq!(of(&[0, 3], &[0, 1, 8]), beyond("corner", 2));
    assert_eq!(refused(Cage { creases: &[([0, 1], 1.0), ([2, 8], 1.0)], ..shape.cage() }), beyond("crease", 1));
    assert_eq!(refused(Cage { sharp_points: &[(8, 1.0)], ..shape.cage() }), beyond("sharp point", 0));
    assert!(
        Refinement::new(&Cage { holes: &[6], ..shape.cage() }, 1, 1000)
            .is_ok_and(|refined| refined.faces().count() == 24)
    );
    for sharpness in [-1.0, f32::NAN] {
        let said = refused(Cage { creases: &[([0, 1], sharpness)], ..shape.cage() }).to_string();
        assert!(said.starts_with("crease 0 has the sharpness "), "{said}");
    }
    let three = of(&[0, 3, 6, 9], &[0, 1, 2, 1, 0, 3, 0, 1, 4]);
    assert_eq!(three, CageError::NonManifold { points: [0, 1], faces: 3 });
    assert!(three.to_string().contains("3 faces meet at the edge from point 0 to 1"));
    for scheme in [Scheme::Loop, Scheme::Butterfly] {
        assert_eq!(refused(Cage { scheme, ..shape.cage() }), CageError::NoTriangle { face: 0, corners: 4 });
    }
    // What isn't an edge can't be sharp, and more than infinite sharpness is as much.
    let creases = [([0, 7], 5.0), ([0, 1], f32::INFINITY)];
    let refined = Refinement::new(&Cage { creases: &creases, ..shape.cage() }, 1, MANY);
    assert!(refined.is_ok_and(|refined| refined.lone_creases == 1));
}

#[test]
fn too_many_levels_are_refused_before_they_are_made() {
    let shape = cube();
    let refused = |levels, most| Refinement::new(&shape.cage(), levels, most).map(|_| ()).unwrap_err();
    assert_eq!(refused(2, 97), CageError::TooLarge { points: 98, faces: 96, most: 97 });
    assert!(Refinement::new(&shape.cage(), 2, 98).is_ok());
    assert!(matches!(refused(14, u64::MAX), CageError::TooLarge { most: 4_294_967_295, .. }));
    assert!(matches!(refused(255, u64::MAX), CageError::TooLarge { points: u64::MAX, .. }));
}

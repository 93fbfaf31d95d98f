//! Refinement of whole cages: their faces and holes, the values at their points and corners, and what moves along.

use glam::DMat3;

use super::*;
use crate::cores::on_threads;

#[test]
fn moving_a_cage_moves_its_surface() {
    let linear = DMat3::from_cols_array(&[1.0, 0.2, 0.0, -0.5, 2.0, 0.3, 0.1, 0.0, -1.5]);
    let moved = |position: &DVec3| linear * *position + DVec3::new(3.0, -2.0, 7.0);
    for shape in varied() {
        let (refinement, refined) = shape.refined(2);
        let other = refinement.refine(&shape.positions.iter().map(moved).collect::<Vec<_>>());
        let limits = [&refined, &other].map(|refined| refinement.limit(refined).values());
        let pairs = refined.iter().zip(&other).chain(limits[0].iter().zip(&limits[1]));
        pairs.for_each(|(before, after)| assert_near(moved(before), *after));
    }
}

#[test]
fn closed_cages_stay_closed_and_faces_keep_their_direction() {
    for shape in [cube(), poles(3, Scheme::CatmullClark), poles(9, Scheme::Loop), poles(5, Scheme::Butterfly)] {
        let (refinement, _) = shape.refined(3);
        let mut sides = HashMap::new();
        for Face { corners, .. } in refinement.faces() {
            let face = &refinement.corners()[corners];
            (0..face.len()).for_each(|k| *sides.entry((face[k], face[(k + 1) % face.len()])).or_insert(0) += 1);
        }
        assert!(sides.iter().all(|(&(a, b), &count)| count == 1 && sides.contains_key(&(b, a))));
        // So a refinement is a cage of its own, and its size is what was said before.
        let starts: Vec<u32> = refinement.faces().map(|face| to_u32(face.corners.start)).collect();
        let starts = [&starts[..], &[to_u32(refinement.corners().len())]].concat();
        let cage = Cage { points: refinement.points(), starts: &starts, corners: refinement.corners(), ..shape.cage() };
        assert_eq!(
            cage.size(refinement.finest().edge_sides.len()),
            shape.cage().size(shape.edges().len()).after(3, shape.scheme)
        );
        let level = refinement.finest();
        let lists = 4 * (level.origins.len() + level.edges.len() + 2 * level.edge_sides.len() + level.points);
        assert!((lists as u64) <= cage.size(level.edge_sides.len()).bytes());
        let again = Refinement::new(&cage, 0, MANY).unwrap();
        assert_eq!(again.finest().edge_sides.len(), refinement.finest().edge_sides.len());
        assert!(shape.cage().size_at_most(3).points > refinement.points() as u64);
    }
}

#[test]
fn any_number_of_cores_gives_the_same_bits() {
    let surface = |cores| {
        let all = || {
            let found = varied().into_iter().map(|shape| {
                let (refinement, refined) = shape.refined(3);
                let limit = refinement.limit(&refined);
                (limit.values(), limit.normals(), refined)
            });
            found.collect::<Vec<_>>()
        };
        on_threads(cores, all).expect("threads")
    };
    assert!(surface(1) == surface(7));
}

#[test]
fn parts_know_their_face_and_holes_are_left_out() {
    let shape = cube();
    for levels in 0..3 {
        let cage = Cage { holes: &[1], ..shape.cage() };
        let refinement = Refinement::new(&cage, levels, MANY).unwrap();
        let faces: Vec<Face> = refinement.faces().collect();
        assert_eq!(faces.len(), 5 << (2 * levels));
        assert!(faces.is_sorted_by_key(|face| face.cage_face) && faces.iter().all(|face| face.cage_face != 1));
        assert_eq!(refinement.points(), shape.refined(levels).0.points());
    }
    let (refinement, _) = poles(3, Scheme::Loop).refined(2);
    assert!(refinement.faces().map(|face| face.cage_face).eq((0..6).flat_map(|face| [face; 16])));
}

#[test]
fn values_of_some_points_are_refined_as_those_of_all_are() {
    for shape in varied() {
        let (refinement, _) = shape.refined(2);
        // Number 7 is at every point, number 3 at every third one, and number 5 counts for nothing.
        let of_third = |point: usize| if point.is_multiple_of(3) { 2.0 } else { 0.0 };
        let list = |point: usize| [(7, 1.0), (5, 0.0), (3, of_third(point))].to_vec();
        let lists: Vec<_> = (0..shape.positions.len()).map(list).collect();
        let mut asked = Vec::new();
        let refined = refinement.limit_of_some(&lists, |count| {
            asked.push(count);
            Ok::<(), usize>(())
        });
        let refined = refined.expect("nothing is refused");
        let counts = [3, 5, 7].map(|number| refined.iter().flatten().filter(|own| own.0 == number).count());
        assert_eq!((asked, counts[2]), (counts.to_vec(), refinement.points()));
        let refused = refinement.limit_of_some(&lists, |count| if count > counts[0] { Err(count) } else { Ok(()) });
        assert_eq!(refused.err(), (counts[2] > counts[0]).then_some(counts[2]));
        let thirds = refinement.refine(&(0..shape.positions.len()).map(of_third).collect::<Vec<f64>>());
        assert_eq!(refined.len(), refinement.points());
        for (list, third) in refined.iter().zip(refinement.limit(&thirds).values()) {
            let value = |number: u32| list.iter().find(|own| own.0 == number).map(|own| own.1);
            assert_eq!((value(3).unwrap_or(0.0), value(5)), (third, None));
            assert!((value(7).unwrap() - 1.0).abs() < 1e-12 && list.is_sorted_by_key(|own| own.0));
        }
    }
}

#[test]
fn values_at_corners_are_refined_within_their_face() {
    let square = grid(1);
    let uvs = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
    let (refinement, _) = square.refined(2);
    let refined = refinement.refine_corners(&uvs);
    assert_eq!(refined.len(), 16 * 4);
    assert!(refined.iter().all(|uv| (*uv * 4.0).fract() == DVec2::ZERO));
    assert_eq!(refined[..4], [DVec2::ZERO, DVec2::X / 4.0, DVec2::ONE / 4.0, DVec2::Y / 4.0]);
    // Those of a triangle's parts are where its points would be without smoothing.
    let triangle = fan(1, Scheme::Loop).creased(10.0);
    let triangle = Shape { boundary: Boundary::EdgesAndCorners, ..triangle };
    let (refinement, positions) = triangle.refined(1);
    let refined = refinement
        .refine_corners(&triangle.corners.iter().map(|&p| triangle.positions[p as usize]).collect::<Vec<_>>());
    for (point, value) in refinement.corners().iter().zip(refined) {
        assert_near(positions[*point as usize], value);
    }
}

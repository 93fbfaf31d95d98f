use std::collections::HashMap;
use std::f64::consts::{PI, TAU};

use glam::{DMat3, DVec2, DVec3, DVec4, Vec3};

use super::*;
use crate::cores::on_threads;

const MANY: u64 = 1 << 24;

/// A cage with its positions.
#[derive(Clone, Default)]
struct Shape {
    positions: Vec<DVec3>,
    starts: Vec<u32>,
    corners: Vec<u32>,
    creases: Vec<([u32; 2], f32)>,
    sharp_points: Vec<(u32, f32)>,
    scheme: Scheme,
    boundary: Boundary,
}

impl Shape {
    fn new(positions: Vec<DVec3>, faces: &[&[u32]]) -> Self {
        let mut starts = vec![0];
        faces.iter().for_each(|face| starts.push(starts[starts.len() - 1] + to_u32(face.len())));
        Self { positions, starts, corners: faces.concat(), ..Self::default() }
    }

    fn cage(&self) -> Cage<'_> {
        Cage {
            points: self.positions.len(),
            starts: &self.starts,
            corners: &self.corners,
            scheme: self.scheme,
            boundary: self.boundary,
            creases: &self.creases,
            sharp_points: &self.sharp_points,
            holes: &[],
        }
    }

    fn refined(&self, levels: u8) -> (Refinement, Vec<DVec3>) {
        let refinement = Refinement::new(&self.cage(), levels, MANY).unwrap();
        let positions = refinement.refine(&self.positions);
        (refinement, positions)
    }

    /// The edges, by their two points.
    fn edges(&self) -> Vec<[u32; 2]> {
        let faces = self.starts.array_windows().map(|&[start, end]| &self.corners[start as usize..end as usize]);
        let sides = faces.flat_map(|face| (0..face.len()).map(|k| [face[k], face[(k + 1) % face.len()]]));
        let mut edges: Vec<_> = sides.map(|[a, b]| [a.min(b), a.max(b)]).collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    fn creased(self, sharpness: f32) -> Self {
        let creases = self.edges().into_iter().map(|edge| (edge, sharpness)).collect();
        Self { creases, ..self }
    }

    fn shaken(mut self, random: &mut fastrand::Rng) -> Self {
        let mut some = || random.f64() - 0.5;
        self.positions.iter_mut().for_each(|position| *position += 0.4 * DVec3::new(some(), some(), some()));
        self
    }
}

fn cube() -> Shape {
    let sign = |k: usize, bit: usize| if k >> bit & 1 == 1 { 1.0 } else { -1.0 };
    let positions = (0..8).map(|k| DVec3::new(sign(k, 0), sign(k, 1), sign(k, 2))).collect();
    let faces: [&[u32]; 6] = [&[0, 2, 3, 1], &[4, 5, 7, 6], &[0, 1, 5, 4], &[2, 6, 7, 3], &[0, 4, 6, 2], &[1, 3, 7, 5]];
    Shape::new(positions, &faces)
}

/// Two poles, 0 and 1, that so many quadrilaterals or triangles meet at.
fn poles(edges: u32, scheme: Scheme) -> Shape {
    let rim = if scheme == Scheme::CatmullClark { 2 * edges } else { edges };
    let at = |k: u32| DVec2::from_angle(TAU * f64::from(k) / f64::from(rim)).extend(0.2 * f64::from(k % 2));
    let positions = [DVec3::Z, -DVec3::Z].into_iter().chain((0..rim).map(at)).collect();
    let faces: Vec<Vec<u32>> = (0..edges)
        .flat_map(|i| match scheme {
            Scheme::Loop | Scheme::Butterfly => [vec![0, 2 + i, 2 + (i + 1) % rim], vec![1, 2 + (i + 1) % rim, 2 + i]],
            Scheme::CatmullClark => {
                let [a, b, c, d] = [0, 1, 2, 3].map(|k| 2 + (2 * i + k) % rim);
                [vec![0, a, b, c], vec![1, d, c, b]]
            }
        })
        .collect();
    let faces: Vec<&[u32]> = faces.iter().map(Vec::as_slice).collect();
    Shape { scheme, ..Shape::new(positions, &faces) }
}

/// So many faces around point 0, which is on the boundary.
fn fan(faces: u32, scheme: Scheme) -> Shape {
    let rim = if scheme == Scheme::CatmullClark { 2 * faces } else { faces };
    let at = |k: u32| DVec2::from_angle(PI * f64::from(k) / f64::from(rim)).extend(0.0);
    let positions = [DVec3::ZERO].into_iter().chain((0..=rim).map(at)).collect();
    let faces: Vec<Vec<u32>> = (0..faces)
        .map(|i| match scheme {
            Scheme::Loop | Scheme::Butterfly => vec![0, 1 + i, 2 + i],
            Scheme::CatmullClark => vec![0, 1 + 2 * i, 2 + 2 * i, 3 + 2 * i],
        })
        .collect();
    let faces: Vec<&[u32]> = faces.iter().map(Vec::as_slice).collect();
    Shape { scheme, ..Shape::new(positions, &faces) }
}

/// A square of so many quadrilaterals along each side, over whole numbers.
fn grid(size: u32) -> Shape {
    let positions = (0..=size).flat_map(|y| (0..=size).map(move |x| DVec3::new(x.into(), y.into(), 0.0))).collect();
    let at = |x: u32, y: u32| y * (size + 1) + x;
    let faces: Vec<[u32; 4]> = (0..size)
        .flat_map(|y| (0..size).map(move |x| [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)]))
        .collect();
    let faces: Vec<&[u32]> = faces.iter().map(<[u32; 4]>::as_slice).collect();
    Shape::new(positions, &faces)
}

/// The same of triangles, which a diagonal cuts all squares into.
fn triangle_grid(size: u32) -> Shape {
    let square = grid(size);
    let halves = |&[a, b, c, d]: &[u32; 4]| [[a, b, c], [a, c, d]];
    let faces: Vec<[u32; 3]> = square.corners.as_chunks().0.iter().flat_map(halves).collect();
    let faces: Vec<&[u32]> = faces.iter().map(<[u32; 3]>::as_slice).collect();
    Shape { scheme: Scheme::Butterfly, ..Shape::new(square.positions, &faces) }
}

/// Shapes with boundaries, creases, darts and corners of every sharpness, in all schemes.
fn varied() -> Vec<Shape> {
    let mut random = fastrand::Rng::with_seed(7);
    let mut shapes = vec![cube(), grid(4), poles(5, Scheme::CatmullClark), poles(7, Scheme::Loop)];
    shapes.extend([fan(3, Scheme::CatmullClark), fan(5, Scheme::Loop)]);
    shapes.extend([poles(7, Scheme::Butterfly), triangle_grid(3)]);
    for k in 0..24 {
        let mut shape = shapes[k % 8].clone().shaken(&mut random);
        let mut sharpness = || random.f32() * 4.0;
        shape.creases = shape.edges().into_iter().step_by(2 + k / 6).map(|edge| (edge, sharpness())).collect();
        shape.sharp_points = (0..to_u32(shape.positions.len())).step_by(5).map(|point| (point, sharpness())).collect();
        shape.boundary = [Boundary::Edges, Boundary::EdgesAndCorners][k % 2];
        shapes.push(shape);
    }
    shapes
}

fn assert_near(a: DVec3, b: DVec3) {
    assert!((a - b).abs().max_element() < 1e-12, "{a} is not {b}");
}

/// The point that a level makes of an edge.
fn middle(shape: &Shape, refined: &[DVec3], edge: [u32; 2]) -> DVec3 {
    refined[shape.positions.len() + shape.edges().iter().position(|other| *other == edge).unwrap()]
}

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

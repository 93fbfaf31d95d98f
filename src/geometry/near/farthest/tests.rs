use fastrand::Rng;

use super::*;
use crate::mesh::Shape;

type Mesh = (Vec<Vec3>, Vec<[u32; 3]>);

fn of_shape(shape: Shape, level: u32) -> Mesh {
    let mesh = shape.build_at(level);
    (mesh.corners.iter().map(|corner| corner.position).collect(), mesh.triangles.to_vec())
}

fn goal(to: &TriangleTree) -> Goal {
    let [min, max] = to.extent();
    Goal { relative: 0.01, absolute: 1e-6 * min.distance(max), searches: 1 << 22 }
}

fn tree(mesh: &Mesh) -> TriangleTree {
    TriangleTree::new(mesh.1.iter().map(|triangle| triangle.map(|i| mesh.0[i as usize]))).unwrap()
}

fn measured(from: &Mesh, to: &Mesh) -> Farthest {
    let (soup, to) = (Soup { positions: &from.0, triangles: &from.1 }, tree(to));
    farthest(soup, &to, &goal(&to), &Progress::new()).unwrap().unwrap()
}

/// Checks that the interval contains a distance that is known but for the rounding of coordinates, and is narrow.
fn check(name: &str, from: &Mesh, to: &Mesh, expected: f64) {
    let Farthest { distance: Interval { at_least, at_most }, triangle, point, nearest } = measured(from, to);
    let [min, max] = tree(to).extent();
    let far = from.0.iter().map(|p| f64::from(p.abs().max_element())).fold(0.0, f64::max);
    let rounding = 1e-6 * far.max(min.abs().max_element()).max(max.abs().max_element());
    assert!(
        at_least <= expected + rounding && expected - rounding <= at_most,
        "{name}: {at_least} to {at_most}, not {expected}"
    );
    let width = (0.0101 * at_most).max(1.01e-6 * min.distance(max));
    assert!(at_most - at_least <= width, "{name}: {at_least} to {at_most} is wide");
    assert!(point.distance(nearest) >= at_least * (1.0 - 1e-12), "{name}");
    let corners = from.1[triangle as usize].map(|i| from.0[i as usize].as_dvec3());
    let off = super::super::closest_on_triangle(corners, point).1.distance(point);
    assert!(off <= 1e-9 * far, "{name}: the point is {off} off its triangle");
}

/// A grid over the unit square with heights, cut along either diagonal.
fn sheet(cells: u32, is_flipped: bool, height: impl Fn(f32, f32) -> f32) -> Mesh {
    let at = |i: u32| i as f32 / cells as f32;
    let corners = (0..=cells).flat_map(|i| (0..=cells).map(move |j| (at(i), at(j))));
    let positions = corners.map(|(x, z)| Vec3::new(x, height(x, z), z)).collect();
    let cell = |i: u32, j: u32| {
        let a = i * (cells + 1) + j;
        let [b, c, d] = [a + 1, a + cells + 1, a + cells + 2];
        if is_flipped { [[a, b, c], [b, d, c]] } else { [[a, d, c], [a, b, d]] }
    };
    let triangles = (0..cells).flat_map(|i| (0..cells).flat_map(move |j| cell(i, j))).collect();
    (positions, triangles)
}

fn transformed(mesh: &Mesh, by: impl Fn(Vec3) -> Vec3) -> Mesh {
    (mesh.0.iter().map(|position| by(*position)).collect(), mesh.1.clone())
}

/// The smallest and the largest distance of triangles from the origin.
fn from_origin(mesh: &Mesh) -> (f64, f64) {
    let nearest = tree(mesh).closest(DVec3::ZERO, f64::INFINITY).unwrap().distance;
    (nearest, mesh.0.iter().map(|position| position.as_dvec3().length()).fold(0.0, f64::max))
}

#[test]
fn equal_meshes_and_other_cuts_of_one_plane_are_no_distance_apart() {
    let mut random = Rng::with_seed(1);
    for case in 0..200 {
        let shape = Shape::ALL[case % Shape::ALL.len()];
        let mesh = of_shape(shape, (case as u32 / 9) % 3);
        let (turn, size) = (glam::Quat::from_rotation_y(random.f32()), 10f32.powi(random.i32(-4..5)));
        let mesh = transformed(&mesh, |position| size * (turn * position) + Vec3::splat(random_of(case)));
        check("equal", &mesh, &mesh, 0.0);
    }
    for case in 0..100 {
        let [a, b] = [random.u32(1..30), random.u32(1..30)];
        let (slope, lift) = (random.f32() - 0.5, random.f32());
        let plane = |cells, is_flipped| sheet(cells, is_flipped, |x, z| slope * x + 0.3 * z + lift);
        check("plane", &plane(a, case % 2 == 0), &plane(b, case % 3 == 0), 0.0);
    }
}

/// A place that is often the origin and sometimes far away.
fn random_of(case: usize) -> f32 {
    [0.0, 0.0, 1.0, 100.0][case % 4]
}

#[test]
fn offset_sheets_are_as_far_apart_as_they_were_moved() {
    let mut random = Rng::with_seed(2);
    for _ in 0..200 {
        let [a, b] = [random.u32(1..25), random.u32(1..25)];
        let offset = 10f32.powf(random.f32() * 6.0 - 6.0);
        let low = sheet(a, random.bool(), |_, _| 0.0);
        let high = sheet(b, random.bool(), |_, _| offset);
        check("offset", &low, &high, offset.into());
        check("offset back", &high, &low, offset.into());
    }
}

#[test]
fn a_spike_of_one_corner_is_as_high_as_it_is() {
    let mut random = Rng::with_seed(3);
    for _ in 0..150 {
        let cells = random.u32(2..40);
        let flat = sheet(cells, random.bool(), |_, _| 0.0);
        let mut spiked = flat.clone();
        let height = 10f32.powf(random.f32() * 5.0 - 5.0);
        let corner = random.u32(1..cells) * (cells + 1) + random.u32(1..cells);
        spiked.0[corner as usize].y = height;
        check("spike", &spiked, &flat, height.into());
    }
}

/// From the inner of two spheres, every corner is as far from the outer one as it is from the nearest point of it; the other
/// way, the farthest corner is.
#[test]
fn spheres_in_each_other_are_as_far_apart_as_their_radii_allow() {
    let mut random = Rng::with_seed(4);
    for case in 0..120 {
        let outer = of_shape([Shape::Icosphere, Shape::Icosahedron][case % 2], random.u32(0..3));
        let radius = 0.05 + 0.7 * random.f32();
        let turn = glam::Quat::from_rotation_x(3.0 * random.f32());
        let inner = transformed(&of_shape(Shape::Icosphere, random.u32(0..3)), |position| radius * (turn * position));
        let ((in_least, in_most), (out_least, out_most)) = (from_origin(&inner), from_origin(&outer));
        let between = |found: Farthest, least: f64, most: f64| {
            let Interval { at_least, at_most } = found.distance;
            assert!(at_most >= least - 1e-6 && at_least <= most + 1e-6, "{at_least} to {at_most}: {least} to {most}");
            assert!(at_most - at_least <= 0.0101 * at_most + 1e-5, "{at_least} to {at_most}");
        };
        // A corner of the outer one is at least so far from all of the inner one, and at most so far from some of it.
        between(measured(&outer, &inner), out_most - in_most, out_most - in_least);
        between(measured(&inner, &outer), out_least - in_most, out_most - in_least);
    }
}

#[test]
fn soups_slivers_and_points_are_measured_as_samples_say() {
    let mut random = Rng::with_seed(5);
    for case in 0..200 {
        let mut soup = |count: u32| -> Mesh {
            let mut positions = Vec::new();
            for i in 0..count {
                let at = Vec3::new(random.f32(), random.f32(), random.f32());
                let thin = [1.0, 1e-3, 1e-7, 0.0][(case + i as usize) % 4];
                let mut away = || 0.3 * Vec3::new(random.f32() - 0.5, random.f32() - 0.5, random.f32() - 0.5);
                let (b, c) = (away(), away());
                positions.extend([at, at + b, at + 0.4 * b + thin * c]);
            }
            let triangles = (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
            (positions, triangles)
        };
        let (from, to) = (soup(1 + case as u32 % 20), soup(1 + case as u32 % 7));
        let found = measured(&from, &to).distance;
        let tree = tree(&to);
        let mut sampled = 0.0_f64;
        for triangle in &from.1 {
            let [a, b, c] = triangle.map(|i| from.0[i as usize].as_dvec3());
            for (i, j) in (0..=16).flat_map(|i| (0..=16 - i).map(move |j| (i, j))) {
                let p = a + (b - a) * f64::from(i) / 16.0 + (c - a) * f64::from(j) / 16.0;
                sampled = sampled.max(tree.closest(p, f64::INFINITY).unwrap().distance);
            }
        }
        // Samples of triangles that have no area to speak of may be rounded beside them.
        assert!(sampled <= found.at_most + 1e-7, "{case}: {sampled} is above {found:?}");
        assert!(found.at_least <= sampled + 0.03, "{case}: {found:?} for {sampled}");
        assert!(found.at_most - found.at_least <= 0.0101 * found.at_most + 4e-6, "{case}: {found:?}");
    }
}

#[test]
fn one_triangle_against_one_of_each_kind() {
    let of = |corners: [[f32; 3]; 3]| -> Mesh { (corners.map(Vec3::from).to_vec(), vec![[0, 1, 2]]) };
    let right = of([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]);
    let point = of([[0.0; 3]; 3]);
    check("to a point", &right, &point, 1.0);
    check("from a point", &point, &right, 0.0);
    check("across", &right, &of([[0.0, -1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0]]), 1.0);
    check("far away", &of([[1e6; 3]; 3]), &right, (1e12 + 2.0 * (1e6 - 0.5_f64).powi(2)).sqrt());
}

#[test]
fn a_budget_that_ends_leaves_a_wide_interval_that_holds() {
    let (from, to) = (of_shape(Shape::Torus, 2), of_shape(Shape::Torus, 1));
    let tree = tree(&to);
    let soup = Soup { positions: &from.0, triangles: &from.1 };
    let within = |searches| {
        let goal = Goal { relative: 1e-6, searches, ..goal(&tree) };
        farthest(soup, &tree, &goal, &Progress::new()).unwrap().unwrap().distance
    };
    let (none, much) = (within(0), within(1 << 22));
    assert!(none.at_least <= much.at_most && much.at_least <= none.at_most, "{none:?} {much:?}");
    assert!(none.at_most - none.at_least > 10.0 * (much.at_most - much.at_least), "{none:?} {much:?}");
}

#[test]
fn results_do_not_depend_on_threads_and_cancelling_stops() {
    let (from, to) = (of_shape(Shape::Torus, 3), of_shape(Shape::Torus, 2));
    let on = |threads| crate::cores::on_threads(threads, || measured(&from, &to)).expect("threads");
    assert_eq!(on(1), on(5));
    let progress = Progress::new();
    progress.cancel();
    let (soup, to) = (Soup { positions: &from.0, triangles: &from.1 }, tree(&to));
    assert!(farthest(soup, &to, &goal(&to), &progress).is_err());
    let empty = Soup { positions: &[], triangles: &[] };
    assert_eq!(farthest(empty, &to, &goal(&to), &Progress::new()), Ok(None));
}

#[test]
fn a_crowd_of_equal_triangles_takes_no_cuts() {
    let one: Mesh = (vec![Vec3::ZERO, Vec3::X, Vec3::Z], vec![[0, 1, 2]; 100_000]);
    check("equal triangles", &one, &one, 0.0);
}

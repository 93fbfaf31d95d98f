use glam::{DVec3, Mat4, Vec2, vec3};

use super::*;
use crate::settings::Settings;
use geometry::mesh::{Mesh, Shape, Topology};
use geometry::progress::Progress;
use geometry::tessellate::{Partitioning, Surface, Tessellated, Tessellation, pack_key, pack_normal, tessellate};

mod limits;

static PROGRESS: std::sync::LazyLock<Progress> = std::sync::LazyLock::new(Progress::new);

fn options(samples: usize) -> AccuracyOptions {
    AccuracyOptions { samples, threads: 2, narrow: Narrow::default() }
}

/// A mesh tessellated on the CPU with a uniform factor.
fn emitted(mesh: &Mesh, surface: Surface, factor: f32) -> Tessellated {
    let topology = Topology::build(mesh, &Progress::new()).unwrap();
    let settings = Settings::from(Tessellation {
        surface,
        factor,
        partitioning: Partitioning::Integer,
        ..Tessellation::default()
    });
    tessellate(mesh, &topology, &settings.inputs(LodView::new(Mat4::IDENTITY, Vec2::ONE)), None)
}

fn measured(reference_shape: &ReferenceShape, out: &Tessellated, samples: usize) -> Accuracy {
    measured_with(reference_shape, out, options(samples))
}

fn measured_with(reference_shape: &ReferenceShape, out: &Tessellated, options: AccuracyOptions) -> Accuracy {
    let mut measurement = AccuracyMeasurement::new(reference_shape, None, options, &PROGRESS);
    measurement.take(&EmittedChunk::whole(&out.vertices, &out.triangles));
    measurement.finish().unwrap().unwrap()
}

/// A mesh without tessellation: each triangle is a patch.
fn as_it_is(mesh: &Mesh) -> Tessellated {
    emitted(mesh, Surface::Flat, 1.0)
}

/// From the reference surface.
fn back(accuracy: &Accuracy) -> Distances {
    accuracy.from_reference.unwrap().0
}

/// Checks that an interval contains a number that is known within a tolerance, and that it is as narrow as was asked for.
fn holds(Interval { at_least, at_most }: Interval, expected: f64, tolerance: f64) {
    assert!(
        at_least <= expected + tolerance && at_most >= expected - tolerance,
        "{at_least} to {at_most} for {expected}"
    );
    assert!(at_most - at_least <= (0.02 * expected).max(1e-5), "{at_least} to {at_most}");
}

fn near(value: f64, expected: f64, tolerance: f64) {
    assert!((value - expected).abs() < tolerance, "{value} for {expected}");
}

/// A square of two triangles at a height, facing up.
fn square(half: f32, y: f32) -> (Vec<Vertex>, Vec<[u32; 3]>) {
    let vertex = |x: f32, z: f32| Vertex {
        position: [x * half, y, z * half],
        key: pack_key(7, [0, 0]),
        normal: pack_normal(Vec3::Y),
        uv: [0.0; 2],
    };
    (vec![vertex(-1.0, -1.0), vertex(-1.0, 1.0), vertex(1.0, 1.0), vertex(1.0, -1.0)], vec![[0, 1, 2], [0, 2, 3]])
}

fn square_reference_shape(half: f32) -> ReferenceShape {
    let (vertices, triangles) = square(half, 0.0);
    let corner = |i: u32| geometry::mesh::Corner {
        position: vertices[i as usize].position.into(),
        normal: Vec3::Y,
        uv: Vec2::ZERO,
    };
    let mesh = Mesh { corners: (0..4).map(corner).collect(), triangles: triangles.into(), ..Mesh::default() };
    ReferenceShape::from_mesh(&mesh).unwrap()
}

#[test]
fn the_icosahedron_is_a_fifth_of_the_radius_off_the_sphere() {
    let reference_shape = ReferenceShape::from_shape(Shape::Icosahedron).unwrap();
    let accuracy = measured(&reference_shape, &as_it_is(&Shape::Icosahedron.build()), 20_000);
    let inradius = ((5.0 + 2.0 * 5.0_f64.sqrt()) / 15.0).sqrt();
    // Corners are f32 numbers, and no sample lies exactly opposite a face's middle.
    holds(accuracy.to_reference.largest, 1.0 - inradius, 1e-7);
    holds(back(&accuracy).largest, 1.0 - inradius, 1e-4);
    holds(accuracy.relative(accuracy.to_reference).largest, (1.0 - inradius) / 12.0_f64.sqrt(), 1e-7);
    // The farthest place is the middle of a face.
    let face = accuracy.worst_to_reference;
    near(face.emitted.length(), inradius, 1e-7);
    near(face.reference_shape.length(), 1.0, 1e-12);
    assert!(face.patch < 20);
    near(accuracy.to_reference.rms.value, rms_of_a_face(inradius), 2e-4);
    assert!(accuracy.normals.rms.value < accuracy.normals.largest && accuracy.normals.largest < 3.0, "{accuracy:?}");
}

/// The root mean square of the distance between a face of a polyhedron of radius 1 and the sphere, by sampling.
fn rms_of_a_face(inradius: f64) -> f64 {
    let circumradius = (1.0 - inradius * inradius).sqrt();
    let corners = [0.0_f64, 120.0, 240.0].map(|turn| DVec3::new(turn.to_radians().cos(), turn.to_radians().sin(), 0.0));
    let n = 600;
    let cells = (0..n).flat_map(|i| (0..n - i).map(move |j| [i, j].map(|x| (f64::from(x) + 1.0 / 3.0) / f64::from(n))));
    let at = |[u, v]: [f64; 2]| corners[0] * (1.0 - u - v) + corners[1] * u + corners[2] * v;
    let short = cells.map(|cell| 1.0 - (at(cell) * circumradius).length().hypot(inradius));
    let (sum, count) = short.fold((0.0, 0), |(sum, count), short| (sum + short * short, count + 1));
    (sum / f64::from(count)).sqrt()
}

#[test]
fn parallel_squares_are_equally_far_in_both_directions() {
    let (reference_shape, (vertices, triangles)) = (square_reference_shape(1.0), square(1.0, 0.25));
    let mut measurement = AccuracyMeasurement::new(&reference_shape, None, options(1000), &PROGRESS);
    measurement.take(&EmittedChunk::whole(&vertices, &triangles));
    let accuracy = measurement.finish().unwrap().unwrap();
    for distances in [accuracy.to_reference, back(&accuracy), accuracy.both_ways()] {
        holds(distances.largest, 0.25, 1e-12);
        near(distances.rms.value, 0.25, 1e-12);
    }
    assert!(accuracy.normals.largest < 0.01 && accuracy.worst_px.is_none(), "{accuracy:?}");
    near(accuracy.relative(accuracy.to_reference).rms.value, 0.25 / 8.0_f64.sqrt(), 1e-9);
    assert_eq!(accuracy.from_reference.unwrap().1.patch, 7);
}

#[test]
fn missing_parts_count_from_the_reference_surface() {
    let (reference_shape, (vertices, triangles)) = (square_reference_shape(1.0), square(0.5, 0.0));
    let mut measurement = AccuracyMeasurement::new(&reference_shape, None, options(50_000), &PROGRESS);
    measurement.take(&EmittedChunk::whole(&vertices, &triangles));
    let accuracy = measurement.finish().unwrap().unwrap();
    assert!(accuracy.to_reference.largest.at_most < 1e-5, "{accuracy:?}");
    holds(back(&accuracy).largest, 0.5_f64.sqrt(), 0.01);
    // The distance is 0 inside, t along the sides, and the hypotenuse of two such distances in the corners.
    let squares = 4.0 * (0.125 / 3.0) + 4.0 * (0.25 * 0.5 / 3.0);
    near(back(&accuracy).rms.value, (squares / 4.0_f64).sqrt(), 2e-3);
    near(accuracy.both_ways().rms.value, back(&accuracy).rms.value / 2.0_f64.sqrt(), 1e-12);
}

#[test]
fn a_shifted_sphere_is_off_by_the_shift() {
    let reference_shape = ReferenceShape::from_shape(Shape::Icosphere).unwrap();
    let mut out = as_it_is(&Shape::Icosphere.build_at(4));
    out.vertices.iter_mut().for_each(|vertex| vertex.position[0] += 0.01);
    let accuracy = measured(&reference_shape, &out, 5000);
    // The distance is the shift times the cosine between it and the normal, whose mean square over the sphere is a third.
    holds(accuracy.to_reference.largest, 0.01, 7e-4);
    holds(back(&accuracy).largest, 0.01, 7e-4);
    near(accuracy.both_ways().rms.value, 0.01 / 3.0_f64.sqrt(), 2e-4);
    near(accuracy.normals.largest, 0.573, 0.01);
}

#[test]
fn normals_that_lean_are_measured_in_degrees() {
    let (reference_shape, (mut vertices, triangles)) = (square_reference_shape(1.0), square(1.0, 0.0));
    let lean = 10.0_f32.to_radians();
    vertices.iter_mut().for_each(|vertex| vertex.normal = pack_normal(vec3(lean.sin(), lean.cos(), 0.0)));
    let mut measurement = AccuracyMeasurement::new(&reference_shape, None, options(100), &PROGRESS);
    measurement.take(&EmittedChunk::whole(&vertices, &triangles));
    let accuracy = measurement.finish().unwrap().unwrap();
    near(accuracy.normals.rms.value, 10.0, 0.01);
    near(accuracy.normals.largest, 10.0, 0.01);
}

#[test]
fn distances_on_screen_are_in_px_of_what_is_in_view() {
    let (reference_shape, (vertices, triangles)) = (square_reference_shape(1.0), square(1.0, 0.25));
    let px = |clip_from_object| {
        let view = LodView::new(clip_from_object, Vec2::new(400.0, 300.0));
        let mut measurement = AccuracyMeasurement::new(&reference_shape, Some(&view), options(100), &PROGRESS);
        measurement.take(&EmittedChunk::whole(&vertices, &triangles));
        measurement.finish().unwrap().unwrap().worst_px.map(|place| place.value)
    };
    // Seen from the side, y upwards: half the viewport's height is one unit.
    near(px(Mat4::from_scale(Vec3::new(1.0, 1.0, 0.1))).unwrap(), 75.0, 1e-9);
    assert_eq!(px(Mat4::from_translation(Vec3::X * 10.0)), None);
}

#[test]
fn nothing_emitted_gives_no_result_and_nan_is_left_out() {
    let (reference_shape, (mut vertices, triangles)) = (square_reference_shape(1.0), square(1.0, 0.25));
    assert_eq!(AccuracyMeasurement::new(&reference_shape, None, options(10), &PROGRESS).finish(), Ok(None));
    let mut flat = AccuracyMeasurement::new(&reference_shape, None, options(10), &PROGRESS);
    flat.take(&EmittedChunk::whole(&vertices, &[[0, 0, 1]]));
    assert_eq!(flat.finish(), Ok(None));
    vertices[3].position[1] = f32::NAN;
    let mut measurement = AccuracyMeasurement::new(&reference_shape, None, options(1000), &PROGRESS);
    measurement.take(&EmittedChunk::whole(&vertices, &triangles));
    let accuracy = measurement.finish().unwrap().unwrap();
    assert_eq!(accuracy.not_finite, 1);
    near(accuracy.to_reference.rms.value, 0.25, 1e-12);
    assert!(back(&accuracy).largest.at_most.is_finite() && back(&accuracy).largest.at_least > 1.0);
}

#[test]
fn results_depend_neither_on_threads_nor_on_chunks() {
    let reference_shape = ReferenceShape::from_shape(Shape::Bicubic).unwrap();
    let out = emitted(&Shape::Bicubic.build(), Surface::PnAen, 4.0);
    let measure = |threads, chunks: usize| {
        let mut measurement =
            AccuracyMeasurement::new(&reference_shape, None, AccuracyOptions { threads, ..options(3000) }, &PROGRESS);
        let size = out.triangles.len().div_ceil(chunks);
        out.triangles
            .chunks(size)
            .for_each(|triangles| measurement.take(&EmittedChunk::whole(&out.vertices, triangles)));
        measurement.finish().unwrap().unwrap()
    };
    let once = measure(1, 1);
    assert_eq!(once, measure(5, 1));
    let chunked = measure(2, 3);
    holds(chunked.to_reference.largest, once.to_reference.largest.at_least, 1e-9);
    assert_eq!(back(&once).rms, back(&chunked).rms);
    near(chunked.to_reference.rms.value, once.to_reference.rms.value, 1e-12);
    near(chunked.normals.rms.value, once.normals.rms.value, 1e-9);
}

/// With half as long segments, the distance is divided by 2 to the power of the order.
#[test]
fn distances_fall_with_the_level() {
    for (surface, orders) in [(Surface::Flat, 1.7..2.3), (Surface::PnAen, 2.7..4.6)] {
        for shape in [Shape::Icosphere, Shape::Ellipsoid, Shape::Torus] {
            let reference_shape = ReferenceShape::from_shape(shape).unwrap();
            let rms = [1, 2].map(|level| {
                let factor = if surface == Surface::Flat { 1.0 } else { 8.0 };
                let out = emitted(&shape.build_at(level), surface, factor);
                let quick = AccuracyOptions { narrow: Narrow { searches: 0, ..Narrow::QUICK }, ..options(4000) };
                let accuracy = measured_with(&reference_shape, &out, quick);
                accuracy.to_reference.rms.value
            });
            let order = (rms[0] / rms[1]).log2();
            assert!(orders.contains(&order), "{shape}, {surface:?}: order {order}, {rms:?}");
        }
    }
}

/// A mesh of these triangles, with normals upwards.
fn mesh_of(triangles: &[[[f32; 3]; 3]]) -> Mesh {
    let corner =
        |position: &[f32; 3]| geometry::mesh::Corner { position: (*position).into(), normal: Vec3::Y, uv: Vec2::ZERO };
    let indices: Vec<[u32; 3]> = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Mesh {
        corners: triangles.as_flattened().iter().map(corner).collect(),
        triangles: indices.into(),
        ..Mesh::default()
    }
}

/// Triangles as they would be emitted, each by a patch of its own.
fn emitted_triangles(triangles: &[[[f32; 3]; 3]]) -> (Vec<Vertex>, Vec<[u32; 3]>) {
    let vertex = |(i, position): (usize, &[f32; 3])| Vertex {
        position: *position,
        key: pack_key(i as u32 / 3, [0, 0]),
        normal: pack_normal(Vec3::Y),
        uv: [0.0; 2],
    };
    let vertices = triangles.as_flattened().iter().enumerate().map(vertex).collect();
    (vertices, (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect())
}

fn compared(reference_shape: &[[[f32; 3]; 3]], emitted: &[[[f32; 3]; 3]], samples: usize) -> Accuracy {
    let reference_shape = ReferenceShape::from_mesh(&mesh_of(reference_shape)).unwrap();
    let (vertices, triangles) = emitted_triangles(emitted);
    // Seen from above, 150 px are a unit.
    let from_above = Mat4::from_rotation_x(std::f32::consts::FRAC_PI_2);
    let view = LodView::new(from_above, Vec2::splat(150.0));
    let narrow = Narrow { relative: 1e-5, absolute: 1e-9, ..Narrow::default() };
    let options = AccuracyOptions { narrow, ..options(samples) };
    let mut measurement = AccuracyMeasurement::new(&reference_shape, Some(&view), options, &PROGRESS);
    measurement.take(&EmittedChunk::whole(&vertices, &triangles));
    measurement.finish().unwrap().unwrap()
}

#[test]
fn the_tip_of_a_spike_counts_though_samples_miss_it() {
    let ground = [
        [[-1.0, 0.0, -1.0], [-1.0, 0.0, 1.0], [1.0, 0.0, 1.0]],
        [[-1.0, 0.0, -1.0], [1.0, 0.0, 1.0], [1.0, 0.0, -1.0]],
    ];
    // A needle of a millionth of the ground's area.
    let spike = [[0.1, 0.0, 0.2], [0.100_01, 0.0, 0.2], [0.1, 0.5, 0.2]];
    let with_spike = [ground[0], ground[1], spike];
    let missing = compared(&with_spike, &ground, 5000);
    holds(back(&missing).largest, 0.5, 1e-9);
    assert_eq!(missing.from_reference.unwrap().1.reference_shape, vec3(0.1, 0.5, 0.2).as_dvec3());
    near(missing.from_reference.unwrap().1.emitted.y, 0.0, 1e-9);
    let surplus = compared(&ground, &with_spike, 5000);
    holds(surplus.to_reference.largest, 0.5, 1e-9);
}

#[test]
fn a_place_on_an_edge_counts_wherever_it_lies() {
    let [a, b, tip] = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]];
    // A gap that is widest on the triangle's longest edge and ends at its tip: around the middle, and somewhere else.
    for [left, right] in [[-0.5, 0.5], [-0.5, 0.3]] {
        let whole = [[a, b, tip]];
        let with_gap = [[a, [left, 0.0, 0.0], tip], [[right, 0.0, 0.0], b, tip]];
        // The farthest point is as far from the line between left and tip as from that between right and tip.
        let slant = |x: f32| f64::from(x).hypot(1.0);
        let expected = (f64::from(right) - f64::from(left)) / (slant(left) + slant(right));
        let at = f64::from(left) + expected * slant(left);
        for samples in [100, 3000] {
            let missing = compared(&whole, &with_gap, samples);
            holds(back(&missing).largest, expected, 1e-4);
            near(missing.from_reference.unwrap().1.reference_shape.distance(DVec3::X * at), 0.0, 1e-3);
            let surplus = compared(&with_gap, &whole, samples);
            holds(surplus.to_reference.largest, expected, 1e-4);
            near(surplus.worst_to_reference.emitted.distance(DVec3::X * at), 0.0, 1e-3);
            near(surplus.worst_px.unwrap().value, 150.0 * expected, 150.0 * 1e-4);
        }
    }
}

#[test]
fn a_low_poly_mesh_is_as_far_from_a_scan_as_the_farthest_vertex_of_the_scan() {
    let scan = Shape::Torus.build_at(3);
    let (reference_shape, out) = (ReferenceShape::from_mesh(&scan).unwrap(), as_it_is(&Shape::Torus.build()));
    let corners = |triangle: &[u32; 3]| triangle.map(|i| Vec3::from(out.vertices[i as usize].position));
    let tree = geometry::near::TriangleTree::new(out.triangles.iter().map(corners)).unwrap();
    let distance = |corner: &geometry::mesh::Corner| {
        tree.closest(corner.position.as_dvec3(), f64::INFINITY).map_or(0.0, |closest| closest.distance)
    };
    let of_vertices = scan.corners.iter().map(distance).fold(0.0, f64::max);
    for samples in [1000, 20_000] {
        holds(back(&measured(&reference_shape, &out, samples)).largest, of_vertices, 1e-12);
    }
}

#[test]
fn more_triangles_than_are_kept_are_measured_one_way() {
    let (reference_shape, out) =
        (ReferenceShape::from_shape(Shape::Torus).unwrap(), emitted(&Shape::Torus.build(), Surface::Flat, 2.0));
    let measure = |most_kept, chunks: usize| {
        let mut measurement = AccuracyMeasurement {
            most_kept,
            ..AccuracyMeasurement::new(&reference_shape, None, options(3000), &PROGRESS)
        };
        let size = out.triangles.len().div_ceil(chunks);
        let take = |part| measurement.take(&EmittedChunk::whole(&out.vertices, part));
        out.triangles.chunks(size).for_each(take);
        measurement.finish().unwrap().unwrap()
    };
    let kept = measure(usize::MAX, 3);
    assert!(kept.from_reference.is_some());
    for (most_kept, chunks) in [(0, 1), (0, 3), (out.triangles.len() / 2, 3)] {
        let some = measure(most_kept, chunks);
        assert_eq!(some.from_reference, None);
        let [a, b] = [some, kept].map(|accuracy| accuracy.to_reference);
        assert!(a.largest.at_least <= b.largest.at_most && b.largest.at_least <= a.largest.at_most, "{a:?} {b:?}");
        near(a.rms.value, b.rms.value, 1e-12);
    }
}

#[test]
fn a_spike_of_one_corner_on_a_scan_is_found_by_few_samples() {
    let scan = Shape::Torus.build_at(5);
    let mut out = as_it_is(&scan);
    let spike = out.vertices.len() / 3;
    out.vertices[spike].position[1] += 0.1;
    let accuracy = measured(&ReferenceShape::from_mesh(&scan).unwrap(), &out, 100);
    let Interval { at_least, at_most } = accuracy.to_reference.largest;
    assert!(at_least > 0.05 && at_most < 0.11, "{at_least} to {at_most}");
    assert_eq!(accuracy.worst_to_reference.patch, out.vertices[spike].patch());
}

#[test]
fn the_border_of_an_exact_surface_counts() {
    // The border of the saddle is farthest from flat triangles that end inside of it.
    let reference_shape = ReferenceShape::from_shape(Shape::Saddle).unwrap();
    let mut out = as_it_is(&Shape::Saddle.build_at(5));
    let half = f64::from(geometry::mesh::shapes::sheets::SADDLE_HALF);
    out.vertices.iter_mut().for_each(|vertex| {
        let [x, _, z] = vertex.position.map(|x| 0.5 * x);
        vertex.position = [x, (x * x - z * z) / 2.0, z];
    });
    let accuracy = measured(&reference_shape, &out, 2000);
    // From a corner of the saddle, where its height is 0, to that of the smaller square.
    holds(back(&accuracy).largest, half / 2.0_f64.sqrt(), 1e-6);
}

use glam::{DVec2, Vec3};
use proptest::prelude::*;

use super::*;

const EXACT: [Shape; 8] = [
    Shape::Icosahedron,
    Shape::Icosphere,
    Shape::Ellipsoid,
    Shape::Torus,
    Shape::Cylinder,
    Shape::Cone,
    Shape::Saddle,
    Shape::Bicubic,
];

fn exact(shape: Shape) -> Exact {
    of_shape(shape).unwrap()
}

/// Returns by how much a point fails its surface's equation, for shapes that have one.
fn off_surface(shape: Shape, p: DVec3) -> f64 {
    let out = p.x.hypot(p.z);
    // The shapes' sizes are f32 numbers.
    let [major, minor, radius, half, third] = [0.7, 0.3, 0.6, 0.75, 0.8].map(|x: f32| f64::from(x));
    match shape {
        Shape::Icosahedron | Shape::Icosphere => p.length() - 1.0,
        Shape::Ellipsoid => (p / DVec3::new(1.0, radius, third)).length() - 1.0,
        Shape::Torus => (out - major).hypot(p.y) - minor,
        Shape::Cylinder => (out - radius).max(p.y.abs() - half),
        Shape::Cone => (out - radius * (half - p.y) / (2.0 * half)).max(-half - p.y),
        Shape::Saddle => (p.y - (p.x * p.x - p.z * p.z) / 2.0).abs().max(p.x.abs() - third).max(p.z.abs() - third),
        _ => 0.0,
    }
}

fn is_closed(shape: Shape) -> bool {
    !matches!(shape, Shape::Saddle | Shape::Bicubic)
}

#[test]
fn shapes_with_levels_have_an_exact_surface() {
    for shape in Shape::ALL {
        assert_eq!(ReferenceShape::from_shape(shape).is_some(), shape.has_levels(), "{shape}");
        assert_eq!(EXACT.contains(&shape), shape.has_levels(), "{shape}");
    }
}

#[test]
fn corners_of_every_level_lie_on_the_surface_with_its_normals() {
    for shape in EXACT {
        let exact = exact(shape);
        for level in 0..4 {
            let mesh = shape.build_at(level);
            let mut worst = [0.0_f64; 2];
            for corner in &mesh.corners {
                let normal = corner.normal.as_dvec3();
                let nearest = exact.closest_facing(corner.position.as_dvec3(), normal);
                let angle = normal.cross(nearest.normal).length().atan2(normal.dot(nearest.normal)).to_degrees();
                worst = [worst[0].max(nearest.distance), worst[1].max(angle)];
            }
            assert!(worst[0] < 3e-7, "{shape}@{level}: {} away", worst[0]);
            assert!(worst[1] < 1e-4, "{shape}@{level}: {} degrees", worst[1]);
        }
    }
}

#[test]
fn every_level_doubles_the_segments() {
    for shape in EXACT {
        let [coarse, fine] = [0, 1].map(|level| shape.build_at(level).triangles.len());
        // In a fan around an apex or the middle of a cap, each triangle becomes six: two at the tip and a row of two quads.
        let expected = match shape {
            Shape::Cylinder => 4 * 24 + 6 * 24,
            Shape::Cone => 6 * 24,
            _ => 4 * coarse,
        };
        assert_eq!(fine, expected, "{shape}");
        assert_eq!(shape.build_at(0).corners, shape.build().corners);
    }
}

#[test]
fn samples_lie_on_the_surface_and_spread_by_area() {
    for shape in EXACT {
        let exact = exact(shape);
        for sample in exact.samples(500) {
            let nearest = exact.closest_facing(sample.point, sample.normal);
            assert!(nearest.distance < 1e-12 && off_surface(shape, sample.point).abs() < 1e-12, "{shape}: {sample:?}");
            assert!(nearest.normal.distance(sample.normal) < 1e-6, "{shape}: {sample:?} {nearest:?}");
        }
    }
    let part = |shape, is_in: &dyn Fn(DVec3) -> bool| {
        exact(shape).samples(10_000).iter().filter(|sample| is_in(sample.point)).count() as f64 / 1e4
    };
    assert!((part(Shape::Icosphere, &|p| p.y > 0.5) - 0.25).abs() < 1e-3);
    assert!((part(Shape::Icosphere, &|p| p.x > 0.5) - 0.25).abs() < 5e-3);
    let outer = 0.5 + 0.3 / (std::f64::consts::PI * 0.7);
    assert!((part(Shape::Torus, &|p| p.x.hypot(p.z) > 0.7) - outer).abs() < 1e-3);
    assert!((part(Shape::Ellipsoid, &|p| p.x > 0.0 && p.z > 0.0) - 0.25).abs() < 5e-3);
}

#[test]
fn areas_and_boxes_are_those_of_closed_forms() {
    let pi = std::f64::consts::PI;
    let slope = 0.6_f64.hypot(1.5);
    let forms = [
        (Shape::Icosphere, 4.0 * pi, DVec3::ONE),
        (Shape::Torus, 4.0 * pi * pi * 0.7 * 0.3, DVec3::new(1.0, 0.3, 1.0)),
        (Shape::Cylinder, 2.0 * pi * 0.6 * (1.5 + 0.6), DVec3::new(0.6, 0.75, 0.6)),
        (Shape::Cone, pi * 0.6 * (0.6 + slope), DVec3::new(0.6, 0.75, 0.6)),
    ];
    for (shape, area, corner) in forms {
        let reference_shape = ReferenceShape::from_shape(shape).unwrap();
        assert!((reference_shape.area() / area - 1.0).abs() < 1e-3, "{shape}: {} for {area}", reference_shape.area());
        assert!((reference_shape.diagonal() - 2.0 * corner.length()).abs() < 1e-6, "{shape}");
    }
    for shape in EXACT {
        let ([min, max], samples) = (exact(shape).extent(), exact(shape).samples(20_000));
        let low = samples.iter().fold(DVec3::INFINITY, |low, sample| low.min(sample.point));
        let high = samples.iter().fold(DVec3::NEG_INFINITY, |high, sample| high.max(sample.point));
        assert!((low - min).min_element() > -1e-9 && (max - high).min_element() > -1e-9, "{shape}: {low} {high}");
        assert!((low - min).max_element() < 0.03 && (max - high).max_element() < 0.03, "{shape}: {low} {high}");
    }
}

/// Tests places where formulas would divide by 0, or where many points are equally near.
#[test]
fn axes_centres_and_borders_have_a_nearest_point() {
    let far = |shape, p: [f64; 3]| exact(shape).closest(DVec3::from(p)).distance;
    let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-7, "{a} for {b}");
    near(far(Shape::Icosphere, [0.0, 0.0, 0.0]), 1.0);
    near(far(Shape::Ellipsoid, [0.0, 0.0, 0.0]), 0.6);
    near(far(Shape::Ellipsoid, [3.0, 0.0, 0.0]), 2.0);
    near(far(Shape::Ellipsoid, [0.0, -2.0, 0.0]), 1.4);
    // From the plane of the larger radii the shortest way leaves that plane. Its end has x = 0.1 / (1 - 0.36).
    let x: f64 = 0.1 / 0.64;
    near(far(Shape::Ellipsoid, [0.1, 0.0, 0.0]), (x - 0.1).hypot(0.6 * (1.0 - x * x).sqrt()));
    near(far(Shape::Ellipsoid, [0.1, 1e-300, 1e-30]), (x - 0.1).hypot(0.6 * (1.0 - x * x).sqrt()));
    near(far(Shape::Torus, [0.0, 0.0, 0.0]), 0.4);
    near(far(Shape::Torus, [0.0, 2.0, 0.0]), 2.0_f64.hypot(0.7) - 0.3);
    near(far(Shape::Torus, [0.0, 0.0, -0.7]), 0.3);
    near(far(Shape::Cylinder, [0.0, 0.0, 0.0]), 0.6);
    near(far(Shape::Cylinder, [0.0, 0.7, 0.0]), 0.05);
    near(far(Shape::Cylinder, [0.9, 1.15, 0.0]), 0.5);
    near(far(Shape::Cone, [0.0, 1.75, 0.0]), 1.0);
    near(far(Shape::Cone, [0.0, -0.7, 0.0]), 0.05);
    near(far(Shape::Saddle, [0.0, 0.0, 0.0]), 0.0);
    near(far(Shape::Saddle, [0.0, 0.5, 0.0]), 0.5);
    // Above the centre of curvature both sides of the valley are nearer than its middle: x^2 = 2 (1.25 - 1).
    near(far(Shape::Saddle, [0.0, 1.25, 0.0]), 0.5_f64.sqrt().hypot(1.0));
    near(far(Shape::Saddle, [0.0, -1.25, 0.0]), 0.5_f64.sqrt().hypot(1.0));
    near(far(Shape::Saddle, [1.8, 0.0, 1.8]), 2.0_f64.sqrt());
    near(far(Shape::Saddle, [0.0, 1e-3, 1e-160]), 1e-3);
}

#[test]
fn on_a_crease_the_normal_is_the_one_nearest_to_facing() {
    let cylinder = exact(Shape::Cylinder);
    let on_edge = DVec3::new(0.6_f32.into(), 0.75, 0.0);
    assert_eq!(cylinder.closest_facing(on_edge, DVec3::new(0.1, 1.0, 0.0)).normal, DVec3::Y);
    assert_eq!(cylinder.closest_facing(on_edge, DVec3::new(1.0, 0.1, 0.0)).normal, DVec3::X);
    let slope = DVec3::new(0.0, 0.6, 1.5).normalize();
    let apex = exact(Shape::Cone).closest_facing(DVec3::Y * 0.75, slope);
    assert!(apex.distance < 1e-12 && apex.normal.distance(slope) < 1e-6);
    let mesh = Reference::new(&Shape::CubeSplit.build()).unwrap();
    let edge = DVec3::new(0.6_f32.into(), 0.6_f32.into(), 0.0);
    let [up, aside] = [DVec3::Y, DVec3::X].map(|facing| mesh.closest_facing(edge, facing).normal);
    assert!(up.y > 1.2 * up.x && aside.x > 1.2 * aside.y, "{up} {aside}");
}

#[test]
fn a_dense_mesh_is_nearly_its_surface() {
    let mesh = ReferenceShape::from_mesh(&Shape::Icosphere.build_at(4)).unwrap();
    let sphere = ReferenceShape::from_shape(Shape::Icosphere).unwrap();
    assert!((mesh.area() / sphere.area() - 1.0).abs() < 2e-3);
    // The bounding box is smaller than the sphere's, since the flat triangles lie inside the sphere.
    assert!((mesh.diagonal() / sphere.diagonal() - 1.0).abs() < 2e-3);
    for sample in ReferenceShape::from_shape(Shape::Torus).unwrap().samples(500) {
        let p = 2.0 * sample.point;
        let [a, b] = [&mesh, &sphere].map(|reference_shape| reference_shape.closest(p));
        assert!((a.distance - b.distance).abs() < 4e-4 && a.normal.dot(b.normal) > 0.999, "{a:?} {b:?}");
    }
}

#[test]
fn samples_of_a_mesh_are_spread_evenly_over_its_triangles() {
    let mesh = Reference::new(&Shape::CubeSplit.build()).unwrap();
    let samples = mesh.samples(12_000);
    assert_eq!(samples, mesh.samples(12_000));
    let top = samples.iter().filter(|sample| sample.point.y > 0.5999).count();
    assert!((top as f64 / 2000.0 - 1.0).abs() < 2e-3, "{top}");
    let quarter = samples.iter().filter(|s| s.point.y > 0.5999 && s.point.x > 0.0 && s.point.z > 0.0).count();
    assert!((quarter as f64 / 500.0 - 1.0).abs() < 0.05, "{quarter}");
    assert!(ReferenceShape::from_mesh(&Mesh::default()).is_none());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_nearest_point_lies_on_the_surface_and_no_sample_is_nearer(
        p in prop::array::uniform3(-1.5_f64..1.5), scale in prop::sample::select(vec![1e-9, 1e-3, 1.0, 3.0]),
    ) {
        let p = DVec3::from(p) * scale;
        for shape in EXACT {
            let exact = exact_of(shape);
            let nearest = exact.surface.closest(p);
            prop_assert!((p.distance(nearest.point) - nearest.distance).abs() < 1e-12, "{}", shape);
            prop_assert!(off_surface(shape, nearest.point).abs() < 1e-12, "{} {:?}", shape, nearest);
            let others = exact.samples.iter().map(|sample| sample.point.distance(p));
            let least = others.fold(f64::INFINITY, f64::min);
            prop_assert!(least >= nearest.distance - 1e-12, "{}: {} for {:?} of {}", shape, least, nearest, p);
            prop_assert!(least <= nearest.distance + 0.15, "{}: {} for {:?} of {}", shape, least, nearest, p);
            let creased = matches!(shape, Shape::Cylinder | Shape::Cone);
            if is_closed(shape) && !creased && nearest.distance > 1e-6 {
                let across = (p - nearest.point).cross(nearest.normal).length() / nearest.distance;
                prop_assert!(across < 1e-7, "{}: {} across for {:?} of {}", shape, across, nearest, p);
            }
        }
    }

    #[test]
    fn the_hierarchy_finds_the_nearest_point_of_all_triangles(
        corners in prop::collection::vec(prop::array::uniform3(prop::array::uniform3(-4_i8..4)), 1..40),
        p in prop::array::uniform3(-6.0_f64..6.0),
        size in prop::sample::select(vec![1e-25_f32, 1.0, 1e25]),
    ) {
        let triangles: Vec<_> = corners.iter().map(|t| t.map(|c| Vec3::from(c.map(f32::from)) * size)).collect();
        let p = DVec3::from(p) * f64::from(size);
        let found = geometry::near::TriangleTree::new(triangles.iter().copied()).unwrap().closest(p, f64::INFINITY).unwrap();
        let on = |triangle: &[Vec3; 3], [a, b]: [f64; 2]| {
            let [x, y, z] = triangle.map(|corner| corner.as_dvec3());
            x * (1.0 - a - b) + y * a + z * b
        };
        let grid = (0..=20).flat_map(|i| (0..=20 - i).map(move |j| [f64::from(i) / 20.0, f64::from(j) / 20.0]));
        let least = grid.flat_map(|weights| triangles.iter().map(move |t| on(t, weights).distance(p)));
        let least = least.fold(f64::INFINITY, f64::min) / f64::from(size);
        let distance = found.distance / f64::from(size);
        prop_assert!(distance <= least + 1e-9 && least <= distance + 0.5, "{} for {}", distance, least);
        let [_, a, b] = found.weights;
        let at = on(&triangles[found.triangle as usize], [a, b]);
        prop_assert!(at.distance(found.point) <= 1e-6 * f64::from(size));
    }
}

struct Sampled {
    surface: Exact,
    samples: Vec<Sample>,
}

/// Returns a shape's surface with samples, which are made only once.
fn exact_of(shape: Shape) -> &'static Sampled {
    static ALL: std::sync::OnceLock<Vec<Sampled>> = std::sync::OnceLock::new();
    let make = || EXACT.map(|shape| Sampled { samples: exact(shape).samples(5000), surface: exact(shape) }).into();
    let index = EXACT.iter().position(|other| *other == shape).unwrap();
    &ALL.get_or_init(make)[index]
}

#[test]
fn the_profile_of_the_cone_has_its_corner_at_the_edge_of_its_base() {
    let cone = exact(Shape::Cone);
    let corner = DVec2::new(0.6, -0.75);
    assert!(
        cone.closest(DVec3::new(corner.x + 1.0, corner.y - 1.0, 0.0))
            .point
            .distance(DVec3::new(corner.x, corner.y, 0.0))
            < 1e-6
    );
}

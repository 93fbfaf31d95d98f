use glam::{DMat4, DVec4, Vec2, Vec3, dvec4, vec2};
use proptest::prelude::*;

use super::*;
use crate::render::view_projection::{ClipY, DepthRange};
use geometry::mesh::{Mesh, Shape, Topology};
use geometry::progress::Progress;
use geometry::tessellate::{Inputs, Lod, LodView, Partitioning, Tessellation, hull_factors};
use geometry::view::project;

const CONVENTIONS: [(DepthRange, ClipY); 6] = [
    (DepthRange::ZeroToOne, ClipY::Up),
    (DepthRange::ZeroToOne, ClipY::Down),
    (DepthRange::Reversed, ClipY::Up),
    (DepthRange::Reversed, ClipY::Down),
    (DepthRange::MinusOneToOne, ClipY::Up),
    (DepthRange::MinusOneToOne, ClipY::Down),
];

/// The matrix that an engine would have for a camera of ours: with depth that ends at a far plane, and rounded to 32 bits.
fn scaled_matrix(
    camera: &Camera,
    viewport: Vec2,
    bounds: &Bounds,
    (depth, y): (DepthRange, ClipY),
    factor: f64,
) -> ViewProjection {
    let [x, up, z, w] = [0, 1, 2, 3].map(|row| camera.clip_from_object(viewport, bounds).as_dmat4().row(row));
    let far = f64::from(camera.eye().distance(bounds.center()) + 10.0 * bounds.radius());
    let z = match (camera.orthographic, depth) {
        // It grows from 0 on the near plane to 1 on the far plane, over w.
        (false, _) => {
            let near = z.w;
            let zero_to_one = w * (far / (far - near)) - DVec4::W * (near * far / (far - near));
            in_range(zero_to_one, w, depth)
        }
        (true, _) => in_range(DVec4::W - z, w, depth),
    };
    let rows = [x, if y == ClipY::Up { up } else { -up }, z, w];
    // A common factor of all rows changes nothing.
    let clip_from_object = DMat4::from_cols_array_2d(&rows.map(|row| (row * factor).to_array())).transpose();
    ViewProjection { clip_from_object: clip_from_object.as_mat4().as_dmat4(), depth, y }
}

fn engine_matrix(camera: &Camera, viewport: Vec2, bounds: &Bounds, depth: DepthRange, y: ClipY) -> ViewProjection {
    scaled_matrix(camera, viewport, bounds, (depth, y), 1.0)
}

/// The row z of a range of depth, from that of 0 to 1.
fn in_range(zero_to_one: DVec4, w: DVec4, depth: DepthRange) -> DVec4 {
    match depth {
        DepthRange::ZeroToOne => zero_to_one,
        DepthRange::Reversed => w - zero_to_one,
        DepthRange::MinusOneToOne => zero_to_one * 2.0 - w,
    }
}

fn mesh() -> (Mesh, Topology, Bounds) {
    let mesh = Shape::Torus.build();
    let topology = Topology::build(&mesh, &Progress::default()).expect("nobody cancels");
    let bounds = Bounds::new(topology.points.iter().copied());
    (mesh, topology, bounds)
}

prop_compose! {
    fn cameras()(
        target in proptest::array::uniform3(-0.5f32..0.5),
        azimuth in 0.0f32..360.0,
        elevation in -89.0f32..89.0,
        distance in 0.5f32..8.0,
        orthographic in proptest::bool::ANY,
        field_of_view in 5.0f32..120.0,
        roll in -180.0f32..180.0,
    ) -> Camera {
        let target = Vec3::from(target);
        Camera { target, azimuth, elevation, distance, orthographic, field_of_view, roll, rows: None }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    #[test]
    fn a_matrix_of_our_camera_is_that_camera_under_every_convention(
        camera in cameras(),
        size in (64.0f32..2000.0, 64.0f32..2000.0),
        factor in 0.1f64..10.0,
    ) {
        let (mesh, topology, bounds) = mesh();
        let viewport = vec2(size.0, size.1);
        let own = camera.lod_view(viewport, &bounds);
        let screen = viewport.max_element();
        for (depth, y) in CONVENTIONS {
            let matrix = scaled_matrix(&camera, viewport, &bounds, (depth, y), factor);
            let seen = Camera::from_matrix(&matrix, &bounds);
            prop_assert!(seen.is_ok(), "{depth:?} {y:?}: {seen:?}");
            let Ok(seen) = seen else { continue };
            let clip = seen.clip_from_object(viewport, &bounds);
            prop_assert!(!seen.rows.is_some_and(|rows| rows.is_mirrored));
            for &point in &topology.points {
                let [a, b] = [own.clip_from_object, clip].map(|clip| project(clip, viewport, point));
                // So near the eye's plane, rounding moves a point by more than that even between two of our own cameras.
                let is_near = clip.mul_vec4(point.extend(1.0)).w < 0.2;
                let is_seen = |at: Vec2| (at - 0.5 * viewport).abs().max_element() < screen;
                let Some((a, b)) = a.zip(b).filter(|(a, _)| is_seen(*a) && !is_near) else { continue };
                prop_assert!(a.distance(b) <= 1e-5 * screen, "{depth:?} {y:?}: {a} and {b}");
            }
            // A px is as large, and the eye is where it was, up to rounding.
            let px = [&camera, &seen].map(|own| own.units_per_pixel(viewport.y) / own.distance);
            prop_assert!(camera.orthographic || (px[0] / px[1] - 1.0).abs() < 1e-4, "{px:?}");
            if !camera.orthographic {
                prop_assert!(camera.eye().distance(seen.eye()) < 1e-5 * (1.0 + camera.eye().length()));
            }
            prop_assert!(camera.axes()[0].distance(seen.axes()[0]) < 1e-4, "{:?} {:?}", camera.axes(), seen.axes());
            let view = seen.lod_view(viewport, &bounds);
            // An orthographic camera has no eye to be at a distance from.
            let has_eye = |lod: &Lod| !camera.orthographic || !lod.reads().distances;
            for lod in Lod::ALL.into_iter().filter(|lod| lod.follows_view() && !lod.is_by_error()).filter(has_eye) {
                same_factors(&mesh, &topology, lod, [own, view])?;
            }
        }
    }

    #[test]
    fn a_mirrored_matrix_is_its_own_mirror_image(camera in cameras()) {
        let (_, topology, bounds) = mesh();
        let viewport = vec2(640.0, 480.0);
        let matrix = engine_matrix(&camera, viewport, &bounds, DepthRange::ZeroToOne, ClipY::Up);
        let mirror = DMat4::from_diagonal(dvec4(-1.0, 1.0, 1.0, 1.0));
        let mirrored = ViewProjection { clip_from_object: mirror * matrix.clip_from_object, ..matrix };
        let [seen, mirrored] = [matrix, mirrored].map(|matrix| Camera::from_matrix(&matrix, &bounds).expect("a view"));
        prop_assert!(mirrored.rows.is_some_and(|rows| rows.is_mirrored));
        for &point in &topology.points {
            let [a, b] = [seen, mirrored].map(|own| project(own.clip_from_object(viewport, &bounds), viewport, point));
            prop_assert_eq!(a, b, "what is drawn is the picture before it is mirrored");
        }
    }
}

/// Checks that factors differ by no more than rounding makes of positions on the screen.
fn same_factors(mesh: &Mesh, topology: &Topology, lod: Lod, views: [LodView; 2]) -> Result<(), TestCaseError> {
    let partitioning = Partitioning::FractionalOdd;
    let tessellation = Tessellation { lod, partitioning, factor: 16.0, ..Tessellation::default() };
    let [own, seen] = views.map(|view| hull_factors(mesh, topology, &Inputs::new(&tessellation, view)));
    for (own, seen) in own.iter().zip(&seen) {
        for (a, b) in own.edges.into_iter().zip(seen.edges) {
            // The published factor of an edge through the plane of the eye divides by nearly nothing.
            let is_far_off = lod == Lod::Paper && a.max(b) > 1e3;
            prop_assert!(is_far_off || (a - b).abs() <= 2e-3 * a.max(1.0), "{lod:?}: {a} and {b}");
        }
    }
    Ok(())
}

#[test]
fn a_view_from_beside_its_middle_is_kept_as_it_is() {
    // What a frame with a shifted lens, or with jitter of less than a px, has.
    let (_, topology, bounds) = mesh();
    let viewport = vec2(320.0, 200.0);
    let camera = Camera::framing(&bounds, viewport);
    let matrix = engine_matrix(&camera, viewport, &bounds, DepthRange::Reversed, ClipY::Up);
    let mut shift = DMat4::IDENTITY;
    shift.w_axis = dvec4(0.25, -0.5, 0.0, 1.0);
    let shifted = ViewProjection { clip_from_object: shift * matrix.clip_from_object, ..matrix };
    let seen = Camera::from_matrix(&shifted, &bounds).expect("a view");
    assert!(seen.eye().distance(camera.eye()) < 1e-5 * camera.distance);
    for &point in &topology.points {
        let [a, b] = [camera, seen].map(|own| project(own.clip_from_object(viewport, &bounds), viewport, point));
        let (a, b) = a.zip(b).expect("in front of the eye");
        assert!((a + vec2(40.0, 50.0)).distance(b) < 2e-3, "{a} and {b}");
    }
    // Its frustum lies on the borders of the picture.
    for place in seen.frustum(viewport, &bounds).concat() {
        let at = project(seen.clip_from_object(viewport, &bounds), viewport, place).expect("in front of the eye");
        let off = (at / viewport - 0.5).abs() - 0.5;
        assert!(off.abs().max_element() < 1e-3, "{at}");
    }
}

#[test]
fn what_is_no_view_is_refused() {
    let (_, _, bounds) = mesh();
    let viewport = vec2(320.0, 200.0);
    let camera = Camera::framing(&bounds, viewport);
    let good = engine_matrix(&camera, viewport, &bounds, DepthRange::ZeroToOne, ClipY::Up);
    let refused = |clip_from_object| ViewProjection { clip_from_object, ..good }.rows().err();
    assert_eq!(refused(good.clip_from_object), None);
    assert_eq!(refused(good.clip_from_object * f64::NAN), Some(ViewProjectionError::Singular));
    assert_eq!(refused(DMat4::ZERO), Some(ViewProjectionError::Behind));
    assert_eq!(refused(-DMat4::IDENTITY), Some(ViewProjectionError::Behind));
    let mut flat = good.clip_from_object;
    (flat.x_axis.y, flat.y_axis.y, flat.z_axis.y) = (flat.x_axis.x, flat.y_axis.x, flat.z_axis.x);
    assert_eq!(refused(flat), Some(ViewProjectionError::Singular), "x and y say the same");
    let mut even = DMat4::IDENTITY;
    even.z_axis.z = 0.0;
    assert_eq!(refused(even), Some(ViewProjectionError::Flat));
    assert!(refused(good.clip_from_object.transpose()).is_some(), "listed the other way");
    let read = |depth| ViewProjection { depth, ..good }.rows().err();
    assert_eq!(read(DepthRange::Reversed), Some(ViewProjectionError::Near));
    let reversed = engine_matrix(&camera, viewport, &bounds, DepthRange::Reversed, ClipY::Up);
    let read = |depth| ViewProjection { depth, ..reversed }.rows().err();
    assert_eq!(read(DepthRange::ZeroToOne), Some(ViewProjectionError::Near));
    assert_eq!(read(DepthRange::Reversed), None);
}

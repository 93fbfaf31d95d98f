//! The deviation overlay: colours against distances that are known in closed form.

use std::sync::Arc;

use geometry::mesh::Shape;
use geometry::tessellate::{Lod, Surface, Tessellation};
use geometry::view::project;
use glam::{Vec2, Vec3};
use gpu::Timing;
use image::RgbaImage;
use inspect::engine::Measurements;
use inspect::measure::{DeviationField, DeviationTarget};
use inspect::reference_shape::ReferenceShape;
use inspect::render::{Camera, DEVIATION_PX_SCALE, Scale, Scene, Target, deviation_scale, worst_lines};
use inspect::settings::{ARENA_BYTES, Colors, Overlays, Settings, SplitSide, SurfaceUnit};

use crate::engine;
use crate::pictures::{SIZE, differing};

fn settings(surface: Surface, factor: f32) -> Settings {
    let overlays = Overlays { colors: Colors::Deviation, ..Overlays::default() };
    Settings {
        tessellation: Tessellation { surface, factor, ..Tessellation::default() },
        overlays,
        ..Settings::default()
    }
}

/// How far what is emitted is from a surface, all over.
fn deviation_from(scene: &mut Scene, target: &DeviationTarget) -> DeviationField {
    let wanted = Measurements { deviation: Some(target), ..Measurements::default() };
    engine().measure_all(scene, &wanted).expect("a readback").deviation.expect("it was asked for")
}

/// Measures against the surface that a shape is sampled from, and draws.
fn drawn(
    scene: &mut Scene,
    shape: Shape,
    camera: &Camera,
    target: &Target,
    settings: &Settings,
) -> (DeviationField, RgbaImage) {
    let engine = engine();
    let inputs = settings.inputs(camera.lod_view(target.viewport(), &scene.bounds));
    engine.count(scene, &inputs, &mut Timing::Off).expect("counts");
    let reference_shape = ReferenceShape::from_shape(shape).expect("a shape that is sampled from a surface");
    let field = deviation_from(scene, &DeviationTarget::ReferenceShape(Arc::new(reference_shape)));
    let scale = deviation_scale(field.worst().expect("something is emitted").value, scene.ulp);
    scene.set_deviation(&engine.gpu, Some((&field, scale)));
    engine.draw(scene, target, camera, settings, &mut Timing::Off).expect("a draw");
    (field, target.read(&engine.gpu).expect("a readback"))
}

/// The place of the scale that has the colour at a place of the surface, and how far off it is there (sRGB, of 255). Shading
/// takes at most 2 of 100 from what faces the eye.
fn place_of(picture: &RgbaImage, camera: &Camera, scene: &Scene, at: Vec3, scale: &Scale) -> (f32, f32) {
    let size = Vec2::new(picture.width() as f32, picture.height() as f32);
    let px = project(camera.clip_from_object(size, &scene.bounds), size, at).expect("in front of the eye");
    let shown = picture.get_pixel(px.x as u32, px.y as u32).0;
    let off = |place: f32| {
        let differences =
            scale.color(place).iter().zip(shown).map(|(a, b)| f32::from(a.abs_diff(b))).collect::<Vec<_>>();
        differences.into_iter().fold(0.0, f32::max)
    };
    let places = (0..=500).map(|i| i as f32 / 500.0);
    let best = places.min_by(|a, b| off(*a).total_cmp(&off(*b))).expect("places");
    (best, off(best))
}

/// A flat icosahedron, seen along the normal of its first face.
fn face(target: &Target) -> (Scene, Camera, [Vec3; 3]) {
    let (loaded, scene) = crate::scene(Shape::Icosahedron);
    let corners = loaded.topology.patch_corners(0).map(|corner| loaded.mesh.corners[corner as usize].position);
    let mut camera = Camera::framing(&scene.bounds, target.viewport());
    let [a, b, c] = corners;
    camera.frame_at((a + b + c) / 3.0, a.distance(b), (b - a).cross(c - a).normalize(), &scene.bounds);
    (scene, camera, corners)
}

/// A regular icosahedron's inscribed sphere leaves this of its circumscribed one.
const GAP: f64 = 0.205_345_527;

#[test]
fn a_flat_face_is_far_in_its_middle_and_exact_in_its_corners() {
    let target = Target::new(&engine().gpu, [400, 400]).expect("a small picture");
    let (mut scene, camera, corners) = face(&target);
    let (field, picture) = drawn(&mut scene, Shape::Icosahedron, &camera, &target, &settings(Surface::Flat, 1.0));
    let worst = field.worst().expect("something is emitted");
    assert!((worst.value - GAP).abs() < 1e-6, "{}", worst.value);
    let scale = deviation_scale(worst.value, scene.ulp);
    let centroid = (corners[0] + corners[1] + corners[2]) / 3.0;
    let (middle, off) = place_of(&picture, &camera, &scene, centroid, &scale);
    assert!((middle - scale.place(GAP as f32)).abs() < 0.03 && middle > 0.9 && off < 8.0, "{middle}, off by {off}");
    for corner in corners {
        // A px or two from the corner, where the wedge is wider than a pixel.
        let (place, off) = place_of(&picture, &camera, &scene, corner.lerp(centroid, 0.004), &scale);
        assert!(place < 0.15 && off < 25.0, "{place}, off by {off}");
    }
    // Between the two, against the closed form.
    for part in [0.05, 0.2, 0.5] {
        let at = corners[1].lerp(centroid, part);
        let (place, off) = place_of(&picture, &camera, &scene, at, &scale);
        let expected = scale.place(1.0 - at.length());
        assert!((place - expected).abs() < 0.05 && off < 14.0, "{part}: {place} for {expected}, off by {off}");
    }
}

#[test]
fn px_are_counted_at_the_depth_of_the_surface() {
    let target = Target::new(&engine().gpu, [400, 400]).expect("a small picture");
    let (mut scene, camera, corners) = face(&target);
    let centroid = (corners[0] + corners[1] + corners[2]) / 3.0;
    for orthographic in [false, true] {
        let mut camera = Camera { orthographic, ..camera };
        // So far off that the gap is a few px.
        camera.distance *= 20.0;
        let px = GAP as f32 / camera.units_per_pixel(400.0);
        let in_px = Settings { deviation_in: SurfaceUnit::Px, ..settings(Surface::Flat, 1.0) };
        let (_, picture) = drawn(&mut scene, Shape::Icosahedron, &camera, &target, &in_px);
        let (place, off) = place_of(&picture, &camera, &scene, centroid, &DEVIATION_PX_SCALE);
        let expected = DEVIATION_PX_SCALE.place(px);
        assert!((0.1..0.97).contains(&expected), "{px} px");
        assert!((place - expected).abs() < 0.04 && off < 8.0, "{place} for {expected}, off by {off}");
    }
}

#[test]
fn chunks_have_their_own_distances() {
    let loaded = crate::loaded(Shape::Torus);
    let target = Target::new(&engine().gpu, SIZE).expect("a small picture");
    let [whole, pieces] = [ARENA_BYTES, 4 << 20].map(|arena| {
        let mut scene = engine().scene(&loaded, arena).expect("shapes are small");
        let camera = Camera::framing(&scene.bounds, target.viewport());
        let (field, picture) = drawn(&mut scene, Shape::Torus, &camera, &target, &settings(Surface::Pn, 31.0));
        assert_eq!(field.chunks.len(), scene.tessellator.chunk_count());
        (field.chunks.len(), field.worst().map(|worst| worst.value), field.chunks.concat(), picture)
    });
    assert!(whole.0 == 1 && pieces.0 > 2, "{} and {} chunks", whole.0, pieces.0);
    assert_eq!(whole.1, pieces.1);
    assert!(whole.2 == pieces.2, "the same samples in the same order");
    assert!(whole.3 == pieces.3, "the same picture");
}

#[test]
fn the_limit_surface_is_what_a_fine_tessellation_comes_to() {
    let (_, mut scene) = crate::scene(Shape::CubeSmooth);
    let target = Target::new(&engine().gpu, SIZE).expect("a small picture");
    let camera = Camera::framing(&scene.bounds, target.viewport());
    let mut worst = |surface, factor| {
        let inputs = settings(surface, factor).inputs(camera.lod_view(target.viewport(), &scene.bounds));
        engine().count(&mut scene, &inputs, &mut Timing::Off).expect("counts");
        let field = deviation_from(&mut scene, &DeviationTarget::Limit(Box::new(inputs)));
        field.worst().expect("something is emitted").value
    };
    let [coarse, fine] = [3.0, 27.0].map(|factor| worst(Surface::PnAen, factor));
    // The error falls with the square of the factor.
    assert!(coarse > 1e-3 && fine < coarse / 40.0, "{coarse} and {fine}");
    assert!(worst(Surface::Flat, 5.0) < 1e-6, "flat triangles are their own limit");
}

#[test]
fn two_surfaces_beside_each_other_look_as_they_do_alone() {
    let (_, mut scene) = crate::scene(Shape::Icosahedron);
    let target = Target::new(&engine().gpu, SIZE).expect("a small picture");
    let camera = Camera::framing(&scene.bounds, target.viewport());
    let right = settings(Surface::PnAen, 4.0);
    let split =
        Settings { split: Some(0.5), left: Tessellation { surface: Surface::Flat, ..right.tessellation }, ..right };
    engine().split(&mut scene, &split, None).expect("shapes are small");
    let reference_shape = Arc::new(ReferenceShape::from_shape(Shape::Icosahedron).expect("a sphere"));
    let view = camera.lod_view(target.viewport(), &scene.bounds);
    let fields = SplitSide::BOTH.map(|half| {
        let (scene, settings) = scene.half_mut(half).zip(split.half(half)).expect("both halves");
        engine().count(scene, &settings.inputs(view), &mut Timing::Off).expect("counts");
        deviation_from(scene, &DeviationTarget::ReferenceShape(reference_shape.clone()))
    });
    let scale = deviation_scale(fields[0].worst().expect("something is emitted").value, scene.ulp);
    let [right_hand, _, to_eye] = camera.axes();
    for ((half, field), aside) in SplitSide::BOTH.into_iter().zip(&fields).zip([-0.5, 0.5]) {
        // Not its worst point: there are twenty of them, and the last bits would choose.
        let marked = (aside * right_hand + to_eye).normalize();
        let half = scene.half_mut(half).expect("both halves");
        half.set_deviation(&engine().gpu, Some((field, scale)));
        half.set_lines(&engine().gpu, &worst_lines(0.9 * marked, marked));
    }
    let mut draw = |settings: &Settings| {
        engine().draw(&mut scene, &target, &camera, settings, &mut Timing::Off).expect("a draw");
        target.read(&engine().gpu).expect("a readback")
    };
    let both = draw(&split);
    // Alone, the right half is what it is beside the other.
    let alone = draw(&right);
    let is_same = |from: u32, other: &RgbaImage| {
        let pixels = both.enumerate_pixels().filter(|(x, ..)| (from..from + SIZE[0] / 2).contains(x));
        pixels.into_iter().all(|(x, y, pixel)| pixel == other.get_pixel(x, y))
    };
    assert!(is_same(SIZE[0] / 2, &alone) && !is_same(0, &alone));
    // With the mesh as it came on its left, whose distances aren't known.
    let source = draw(&Settings { left: Tessellation::untessellated(), ..split });
    assert!(is_same(SIZE[0] / 2, &source) && !is_same(0, &source));
    // The software driver lets half of a px beside the split through on the wrong side, others none: it is nobody's here.
    let mut without = both.clone();
    (0..SIZE[1]).for_each(|y| without.put_pixel(SIZE[0] / 2 - 1, y, image::Rgba([0, 0, 0, 255])));
    assert_eq!(differing(vec![("deviation-split".to_owned(), without)]), Vec::<String>::new());
}

#[test]
fn each_half_of_a_split_has_its_own_factors() {
    let (_, mut scene) = crate::scene(Shape::Icosahedron);
    let target = Target::new(&engine().gpu, SIZE).expect("a small picture");
    let camera = Camera::framing(&scene.bounds, target.viewport());
    let overlays = Overlays { wireframe: true, ..Overlays::default() };
    let right = Settings {
        tessellation: Tessellation { surface: Surface::PnAen, lod: Lod::Error, ..Tessellation::default() },
        overlays,
        ..Settings::default()
    };
    let flat = right.with(Tessellation { surface: Surface::Flat, ..right.tessellation });
    let split =
        Settings { split: Some(0.5), left: Tessellation { surface: Surface::Flat, ..right.tessellation }, ..right };
    let [both, alone, flat] = [split, right, flat].map(|settings| {
        engine().draw(&mut scene, &target, &camera, &settings, &mut Timing::Off).expect("a draw");
        target.read(&engine().gpu).expect("a readback")
    });
    let middle = SIZE[0] / 2;
    let is_right = alone.enumerate_pixels().all(|(x, y, pixel)| x < middle || pixel == both.get_pixel(x, y));
    // But for the last column: the software driver lets a sample of the right half in there.
    let is_left = flat.enumerate_pixels().all(|(x, y, pixel)| x + 1 >= middle || pixel == both.get_pixel(x, y));
    assert!(is_left && is_right && flat != alone);
}

#[test]
fn deviation_looks_as_it_did() {
    let (_, mut scene) = crate::scene(Shape::Icosahedron);
    let target = Target::new(&engine().gpu, SIZE).expect("a small picture");
    let camera = Camera::framing(&scene.bounds, target.viewport());
    let pictures = [("flat", Surface::Flat, 1.0), ("pn", Surface::Pn, 8.0)].map(|(name, surface, factor)| {
        let (_, picture) = drawn(&mut scene, Shape::Icosahedron, &camera, &target, &settings(surface, factor));
        (format!("deviation-{name}"), picture)
    });
    assert_eq!(differing(pictures.into()), Vec::<String>::new());
}

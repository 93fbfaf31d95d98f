//! Outlines: of polygons whose distance from a curve is known, of flat surfaces, and as they look.

use std::f32::consts::TAU;

use geometry::mesh::mesh_builder::{InputCorner, MeshBuilder};
use geometry::mesh::{Material, Mesh, Shape};
use geometry::progress::Progress;
use geometry::tessellate::{Clip, Lod, Partitioning, Surface, Tessellation};
use geometry::view::project;
use glam::{Vec2, Vec3, vec2, vec3};
use gpu::Timing;
use inspect::engine::SilhouetteView;
use inspect::engine::silhouette::sibling;
use inspect::measure::{OutlineDistance, OutlineDistances, Silhouette};
use inspect::render::{Camera, Scene, lay_over, outlines_picture};
use inspect::settings::{Colors, Overlays, Settings};

use crate::looks::square_of;
use crate::pictures::differing;
use crate::stability::scene_of;
use crate::{engine, picture, scene};

/// Width and height of views in px.
const SIZE: [u32; 2] = [400, 300];

/// A sphere of radius 1 around the origin as two pyramids on a regular polygon in the plane z = 0.
fn bipyramid(sides: u16) -> Mesh {
    let mut builder = MeshBuilder::new();
    let material = builder.material(Material::plain("ball", [0.6, 0.6, 0.6, 1.0]));
    let corner = |place: Vec3| InputCorner { position: place, normal: Some(place), uv: Vec2::ZERO };
    let around = |k: u16| {
        let (sin, cos) = (TAU * f32::from(k % sides) / f32::from(sides)).sin_cos();
        corner(vec3(cos, sin, 0.0))
    };
    for k in 0..sides {
        builder.triangle(material, [around(k), around(k + 1), corner(Vec3::Z)]);
        builder.triangle(material, [around(k + 1), around(k), corner(Vec3::NEG_Z)]);
    }
    builder.finish("bipyramid".to_owned(), &Progress::default()).expect("nobody cancels")
}

/// A view along z in which the mesh fits, without perspective.
fn from_the_pole(scene: &Scene) -> Camera {
    let framed = Camera::framing(&scene.bounds, Vec2::from(SIZE.map(|side| side as f32)));
    Camera { azimuth: 0.0, elevation: 0.0, orthographic: true, ..framed }
}

fn compared(scene: &mut Scene, tessellation: &Tessellation, camera: &Camera) -> Silhouette {
    let viewport = Vec2::from(SIZE.map(|side| side as f32));
    let seen = camera.lod_view(viewport, &scene.bounds);
    let view = SilhouetteView { size: SIZE, seen, lod: seen };
    engine().silhouette(scene, tessellation, &view, &Progress::new()).expect("a device").expect("nobody cancels")
}

fn px(distance: Option<OutlineDistance>) -> f64 {
    distance.expect("both outlines are in view").px
}

fn uniform(factor: f32) -> Tessellation {
    Tessellation { factor, partitioning: Partitioning::Integer, ..Tessellation::default() }
}

#[test]
fn a_polygon_is_as_far_from_its_pn_curve_as_the_formula_says() {
    for sides in [4, 6, 8, 16] {
        let mut scene = scene_of(bipyramid(sides), 0.0);
        let camera = from_the_pole(&scene);
        let viewport = Vec2::from(SIZE.map(|side| side as f32));
        let clip_from_object = camera.clip_from_object(viewport, &scene.bounds);
        let at = |place| project(clip_from_object, viewport, place).expect("in front of the eye");
        let radius = f64::from(at(Vec3::X).distance(at(Vec3::ZERO)));
        // Half way along an edge over an angle 2a, the cubic edge of PN triangles (Vlachos et al. 2001, section 3.1) is at
        // cos a (1 + sin^2 a / 2) radii, and the straight one at cos a.
        let half = std::f64::consts::PI / f64::from(sides);
        let sagitta = radius * half.cos() * half.sin().powi(2) / 2.0;
        assert!(sagitta > 2.0, "{sides} sides: {sagitta} px");
        let coarse = compared(&mut scene, &uniform(1.0), &camera).distances;
        assert_eq!(px(coarse.from_source), 0.0, "factor 1 is the source");
        assert!((px(coarse.from_surface) - sagitta).abs() < 1.0, "{sides} sides: {coarse:?}, not {sagitta}");
        let fine = compared(&mut scene, &uniform(32.0), &camera).distances;
        assert!((px(fine.from_source) - sagitta).abs() < 1.0, "{sides} sides: {fine:?}, not {sagitta}");
        assert!(px(fine.from_surface) <= 0.5, "{sides} sides: {fine:?}");
        // Two segments have their middle on the curve.
        let halved = compared(&mut scene, &uniform(2.0), &camera).distances;
        let left = px(halved.from_surface) / sagitta;
        assert!((0.05..0.5).contains(&left), "{sides} sides: {left} of the distance are left");
    }
}

#[test]
fn a_flat_surface_is_its_source() {
    let mesh = square_of(Material::plain("square", [0.6, 0.6, 0.6, 1.0]), Vec3::Z, Vec2::ONE);
    let mut square = scene_of(mesh, 0.0);
    let none = |distances: OutlineDistances| (px(distances.from_source), px(distances.from_surface));
    // Its sides are level and upright, so that no sample lies where rounding decides.
    let framed = from_the_pole(&square);
    for factor in [1.0, 7.0] {
        assert_eq!(none(compared(&mut square, &uniform(factor), &framed).distances), (0.0, 0.0));
    }
    let mut torus = scene(Shape::Torus).1;
    let framed = Camera::framing(&torus.bounds, vec2(400.0, 300.0));
    let flat = Tessellation { surface: Surface::Flat, ..uniform(5.0) };
    let found = none(compared(&mut torus, &flat, &framed).distances);
    assert!(found.0 <= 0.5 && found.1 <= 0.5, "flat triangles cover what their source does: {found:?}");
}

#[test]
fn a_close_view_has_the_same_distance_with_and_without_clipping() {
    let mut scene = scene_of(bipyramid(8), 0.0);
    let framed = from_the_pole(&scene);
    // The middle of an edge is at the picture's border, and its ends are outside.
    let close = Camera { target: vec3(0.87, 0.36, 0.0), distance: 0.12 * framed.distance, ..framed };
    let by_error = Tessellation { lod: Lod::Error, tolerance: 4.0, ..uniform(1.0) };
    let whole = compared(&mut scene, &by_error, &close);
    let clipped = Tessellation { clip: Clip::Frustum, cull_back_faces: true, ..by_error };
    assert_eq!(compared(&mut scene, &clipped, &close).distances, whole.distances);
    let from_surface = px(whole.distances.from_surface);
    assert!((0.5..=4.5).contains(&from_surface), "within the tolerance: {whole:?}", whole = whole.distances);
    assert!(px(whole.distances.from_source) > 8.0, "{whole:?}", whole = whole.distances);
}

#[test]
fn comparing_leaves_the_scene_as_it_is_and_a_kept_tessellator_finds_the_same() {
    let mut scene = scene(Shape::Torus).1;
    let camera = Camera::framing(&scene.bounds, vec2(400.0, 300.0));
    let seen = camera.lod_view(vec2(400.0, 300.0), &scene.bounds);
    let tessellation = uniform(3.0);
    let inputs = geometry::tessellate::Inputs::new(&tessellation, seen);
    engine().count(&mut scene, &inputs, &mut Timing::Off).expect("counts");
    let before = (scene.tessellator.generation(), scene.tessellator.totals());
    let first = compared(&mut scene, &tessellation, &camera);
    assert_eq!((scene.tessellator.generation(), scene.tessellator.totals()), before);
    let view = SilhouetteView { size: SIZE, seen, lod: seen };
    let mut tessellator = sibling(&scene)().expect("a small mesh");
    for _ in 0..2 {
        let mut drawing =
            engine().start_silhouette(&scene, tessellator, &tessellation, &view).expect("a small picture");
        let mut texels = loop {
            match drawing.step(&engine().gpu).expect("a device") {
                Some(texels) => break texels,
                None => engine().gpu.wait(),
            }
        };
        assert_eq!(Silhouette::find(drawing.grid, &texels.wait(&engine().gpu).expect("a device")), first);
        tessellator = drawing.tessellator;
    }
}

#[test]
fn silhouettes_look_as_they_did() {
    let mut pictures = Vec::new();
    for (name, shape, factor) in [("coarse", Shape::Icosahedron, 1.0), ("fine", Shape::Icosahedron, 3.0)] {
        let mut scene = scene(shape).1;
        let overlays = Overlays { colors: Colors::Silhouette, ..Overlays::default() };
        let settings = Settings { overlays, ..Settings::from(uniform(factor)) };
        let mut drawn = picture(&mut scene, &settings, SIZE);
        let camera = Camera::framing(&scene.bounds, vec2(400.0, 300.0));
        lay_over(&mut drawn, &outlines_picture(&compared(&mut scene, &settings.tessellation, &camera)), &settings);
        pictures.push((format!("silhouette-{name}"), drawn));
    }
    assert_eq!(differing(pictures), Vec::<String>::new());
}

//! What is picked at a pixel, held against a ray cast in f64 on the CPU's tessellation.

use geometry::mesh::Shape;
use geometry::tessellate::{Edges, Partitioning, Surface, Tessellated, Tessellation, tessellate};
use geometry::view::project;
use glam::{DMat4, DVec2, DVec4, Vec3, dvec2, vec3};
use gpu::Timing;
use inspect::engine::Loaded;
use inspect::render::{Camera, Picked, Pixel, Scene, half_at};
use inspect::settings::{Settings, SplitSide};

use crate::{engine, loaded, scene};

/// Width and height in px.
const SIZE: [u32; 2] = [640, 480];
const VIEWPORT: glam::Vec2 = glam::vec2(640.0, 480.0);
/// Nearer than this many px to an edge of a triangle in front, either of its sides may be picked: adapters place
/// vertices on a grid, within a 1/256 of the pixel that the target is. What differs between CPU and GPU is far less.
const NEAR_PX: f64 = 0.01;

fn camera(loaded: &Loaded) -> Camera {
    Camera { azimuth: 37.0, elevation: 24.0, ..Camera::framing(&loaded.mesh.bounds(), VIEWPORT) }
}

fn pixel(loaded: &Loaded, at: [u32; 2]) -> Pixel {
    let clip_from_object = camera(loaded).clip_from_object(VIEWPORT, &loaded.mesh.bounds());
    Pixel { clip_from_object, size: SIZE, at, has_input: false }
}

fn count(loaded: &Loaded, scene: &mut Scene, settings: &Settings) {
    let view = camera(loaded).lod_view(VIEWPORT, &loaded.mesh.bounds());
    engine().count(scene, &settings.inputs(view), &mut Timing::Off).expect("counts");
}

fn pick(scene: &mut Scene, pixel: &Pixel) -> Option<Picked> {
    let picking = engine().picker.start(&engine().gpu, scene, pixel);
    picking.and_then(|mut picking| picking.wait(&engine().gpu)).expect("a readback")
}

/// The same pixels on every run, anywhere in the picture.
fn pixels(count: u32) -> impl Iterator<Item = [u32; 2]> {
    let mut random = fastrand::Rng::with_seed(12345);
    (0..count).map(move |_| SIZE.map(|end| random.u32(..end)))
}

/// A triangle as seen from a pixel's middle: how far inside it that is in px, negative outside, and its depth there.
fn seen(corners: [DVec4; 3], middle: DVec2) -> Option<(f64, f64)> {
    if corners.iter().any(|corner| corner.w <= 0.0) {
        return None;
    }
    let px = corners.map(|c| (dvec2(c.x, -c.y) / c.w * 0.5 + 0.5) * dvec2(SIZE[0].into(), SIZE[1].into()));
    let area = (px[1] - px[0]).perp_dot(px[2] - px[0]);
    // Weights of the corners opposite each edge, and how far that edge is.
    let edge = |k: usize| (px[(k + 1) % 3], px[(k + 2) % 3]);
    let weights = [0, 1, 2].map(|k| (edge(k).1 - edge(k).0).perp_dot(middle - edge(k).0) / area);
    let inside = [0, 1, 2].map(|k| weights[k] * area.abs() / edge(k).0.distance(edge(k).1)).into_iter();
    let depth = (0..3).map(|k| weights[k] * corners[k].z / corners[k].w).sum();
    Some((inside.fold(f64::INFINITY, f64::min), depth))
}

/// What a ray through a pixel's middle meets first: an index into the emitted triangles, or nothing. `None` where that
/// is too close to call.
fn cast(out: &Tessellated, pixel: &Pixel) -> Option<Option<usize>> {
    let clip: DMat4 = pixel.clip_from_object.as_dmat4();
    let middle = dvec2(pixel.at[0].into(), pixel.at[1].into()) + 0.5;
    let corner = |index: u32| clip * Vec3::from(out.vertices[index as usize].position).as_dvec3().extend(1.0);
    let near = out.triangles.iter().enumerate().filter_map(|(index, triangle)| {
        let (inside, depth) = seen(triangle.map(corner), middle)?;
        (inside > -NEAR_PX).then_some((index, inside, depth))
    });
    let mut near: Vec<_> = near.collect();
    // Depth is reversed.
    near.sort_by(|a, b| b.2.total_cmp(&a.2));
    match near[..] {
        [] => Some(None),
        [(_, inside, _), ..] if inside < NEAR_PX => None,
        [(_, _, first), (_, _, second), ..] if first - second < 1e-6 * first => None,
        [(index, ..), ..] => Some(Some(index)),
    }
}

/// Holds random pixels against the ray cast; how many met a triangle, and how many nothing.
fn assert_picks(loaded: &Loaded, scene: &mut Scene, settings: &Settings, count: u32) -> [u32; 2] {
    let view = camera(loaded).lod_view(VIEWPORT, &loaded.mesh.bounds());
    let out = tessellate(&loaded.mesh, &loaded.topology, &settings.inputs(view), None);
    let (mut hits, mut misses) = (0, 0);
    for at in pixels(count) {
        let pixel = pixel(loaded, at);
        let Some(expected) = cast(&out, &pixel) else { continue };
        let picked = pick(scene, &pixel);
        let Some(index) = expected else {
            assert_eq!(picked, None, "{at:?}");
            misses += 1;
            continue;
        };
        let picked = picked.unwrap_or_else(|| panic!("{at:?}: triangle {index} is missed"));
        let triangle = picked.triangle.unwrap_or_else(|| panic!("{at:?}: not an emitted triangle"));
        let corners = out.triangles[index].map(|corner| out.vertices[corner as usize]);
        let first = out.triangles.iter().position(|t| out.vertices[t[0] as usize].patch() == corners[0].patch());
        assert_eq!((picked.patch, Some(triangle.number as usize)), (corners[0].patch(), first.map(|f| index - f)));
        assert_eq!(triangle.vertices.map(|v| v.key), corners.map(|v| v.key), "{at:?}");
        hits += 1;
    }
    [hits, misses]
}

#[test]
fn a_pixel_gives_the_triangle_that_a_ray_meets_first() {
    let settings = [
        (Shape::CubeSplit, Settings::from(Tessellation { surface: Surface::Pn, ..Tessellation::default() })),
        (Shape::Torus, Settings::from(Tessellation { factor: 5.3, ..Tessellation::default() })),
        (
            Shape::Moebius,
            Settings::from(Tessellation { edges: Edges::AsPublished, factor: 3.0, ..Tessellation::default() }),
        ),
        (
            Shape::Saddle,
            Settings::from(Tessellation {
                surface: Surface::Flat,
                partitioning: Partitioning::Pow2,
                ..Tessellation::default()
            }),
        ),
        (
            Shape::Cone,
            Settings::from(Tessellation {
                partitioning: Partitioning::FractionalEven,
                factor: 6.5,
                ..Tessellation::default()
            }),
        ),
    ];
    for (shape, settings) in settings {
        let (loaded, mut scene) = scene(shape);
        count(&loaded, &mut scene, &settings);
        let [hits, misses] = assert_picks(&loaded, &mut scene, &settings, 200);
        assert!(hits > 15 && misses > 15 && hits + misses > 180, "{shape:?}: {hits} hits, {misses} misses");
    }
}

#[test]
fn an_arena_of_many_chunks_gives_the_same_triangles() {
    let loaded = loaded(Shape::Torus);
    let settings = Settings::from(Tessellation { factor: 13.0, ..Tessellation::default() });
    let mut scene = engine().scene(&loaded, 1 << 18).expect("a small mesh");
    count(&loaded, &mut scene, &settings);
    assert!(scene.tessellator.chunk_count() > 3, "{} chunks", scene.tessellator.chunk_count());
    let [hits, misses] = assert_picks(&loaded, &mut scene, &settings, 120);
    assert!(hits > 15 && misses > 15, "{hits} hits, {misses} misses");
}

#[test]
fn the_nearest_edge_is_the_one_whose_weight_is_least() {
    let (loaded, mut scene) = scene(Shape::CubeSmooth);
    let settings = Settings::from(Tessellation { surface: Surface::Flat, ..Tessellation::default() });
    count(&loaded, &mut scene, &settings);
    let mut picked_sides = 0;
    for (index, patch) in (0..).zip(&loaded.topology.patches) {
        let corners = loaded.topology.corners(patch).map(|corner| loaded.mesh.corners[corner as usize].position);
        for weight in 0..3_u32 {
            let [a, b] = [1, 2].map(|step| corners[(weight as usize + step) % 3]);
            let inwards = corners[weight as usize];
            let place = (a + b) * 0.45 + inwards * 0.1;
            let clip = pixel(&loaded, [0, 0]).clip_from_object;
            let at = project(clip, VIEWPORT, place).expect("in front of the eye");
            let at = [at.x as u32, at.y as u32];
            // Of input triangles, none is an emitted one.
            for has_input in [false, true] {
                let picked = pick(&mut scene, &Pixel { has_input, ..pixel(&loaded, at) }).expect("the cube is there");
                assert_eq!(picked.triangle.is_none(), has_input);
                // Faces that face away are behind others.
                if picked.patch == index {
                    assert_eq!(picked.weight, weight, "patch {index}, {has_input}");
                    picked_sides += 1;
                }
            }
        }
    }
    assert_eq!(picked_sides, 2 * 3 * 6, "both triangles of the three faces that one sees");
}

#[test]
fn a_pixel_of_a_split_picture_is_in_one_half() {
    let middle = [SIZE[0] / 2, SIZE[1] / 2];
    let halves =
        [None, Some(0.4), Some(0.6)].map(|split| half_at(middle, SIZE, &Settings { split, ..Settings::default() }).0);
    assert_eq!(halves, [SplitSide::Right, SplitSide::Right, SplitSide::Left]);
}

#[test]
fn nothing_behind_the_eye_is_picked() {
    let (loaded, mut scene) = scene(Shape::Torus);
    let bounds = loaded.mesh.bounds();
    // Inside the tube, and outside looking away.
    let inside = Camera { target: vec3(0.7, 0.0, 0.0), distance: 0.1, ..camera(&loaded) };
    let away = Camera { target: bounds.center() - camera(&loaded).axes()[2] * 50.0, ..camera(&loaded) };
    count(&loaded, &mut scene, &Settings::default());
    for (camera, found) in [(inside, true), (away, false)] {
        let clip_from_object = camera.clip_from_object(VIEWPORT, &bounds);
        let pixel = Pixel { clip_from_object, ..pixel(&loaded, [SIZE[0] / 2, SIZE[1] / 2]) };
        assert_eq!(pick(&mut scene, &pixel).is_some(), found);
    }
}

//! Colours of the surface, which show values: each patch has the colour of its own.

use geometry::mesh::Shape;
use geometry::tessellate::{
    Convention, FACTOR_ODD, FIXED_ONE, Lod, Partitioning, PatchFactors, Surface, Tessellation, domain_side,
    triangle_count,
};
use geometry::view::project;
use glam::{Mat4, Vec2, Vec3};
use image::RgbaImage;
use inspect::render::layout::WASTE_COLOR;
use inspect::render::{Camera, EXCESS_SCALE, FACTOR_SCALE, Scene, Target};
use inspect::settings::{ARENA_BYTES, Colors, Overlays, Settings};

use super::pixels_of;
use crate::passes::sheet;
use crate::stability::seen;
use crate::{engine, scene};

#[test]
fn barycentric_colours_are_red_green_and_blue_at_the_corners() {
    // One patch of a cube's front face, seen from the front: (u, v, w) is 1 at corners 0, 1 and 2.
    let (loaded, mut scene) = scene(Shape::CubeSmooth);
    let engine = engine();
    let target = inspect::render::Target::new(&engine.gpu, [400, 400]).expect("a small picture");
    let camera = inspect::render::Camera {
        azimuth: 0.0,
        elevation: 0.0,
        ..inspect::render::Camera::framing(&scene.bounds, target.viewport())
    };
    let overlays = Overlays { colors: Colors::Barycentric, ..Overlays::default() };
    let settings = Settings {
        tessellation: Tessellation { surface: Surface::Flat, ..Tessellation::default() },
        overlays,
        ..Settings::default()
    };
    let mut timing = gpu::Timing::Off;
    engine.draw(&mut scene, &target, &camera, &settings, &mut timing).expect("a draw");
    let picture = target.read(&engine.gpu).expect("a readback");
    let clip = camera.clip_from_object(target.viewport(), &scene.bounds);
    for patch in &loaded.topology.patches {
        let corners = loaded.topology.corners(patch).map(|corner| loaded.mesh.corners[corner as usize].position);
        if corners.iter().any(|corner| corner.z < 0.0) {
            continue;
        }
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        for (channel, corner) in corners.into_iter().enumerate() {
            let near = corner.lerp(middle, 0.1);
            let at = geometry::view::project(clip, target.viewport(), near).expect("in front of the eye");
            let colour = picture.get_pixel(at.x as u32, at.y as u32).0;
            let brightest = (0..3).max_by_key(|&c| colour[c]).expect("three channels");
            assert_eq!(brightest, channel, "{colour:?} at {at}");
        }
    }
}

/// Whether a px is a factor's colour: it may be a little darker where the surface is slanted, but has its hue.
fn shows(picture: &RgbaImage, at: Vec2, factor: f32) -> bool {
    let [r, g, b, _] = picture.get_pixel(at.x as u32, at.y as u32).0;
    let hue = |c: [u8; 3]| c.map(|x| f32::from(x) / f32::from(c[0].max(c[1]).max(c[2])));
    let (found, expected) = (hue([r, g, b]), hue(FACTOR_SCALE.color(FACTOR_SCALE.place(factor))));
    (0..3).all(|c| (found[c] - expected[c]).abs() < 0.06)
}

/// The factor that the tessellator works with.
fn value(word: u32) -> f32 {
    (word & !FACTOR_ODD) as f32 / FIXED_ONE as f32
}

/// A large picture of a scene, with the factors of its patches.
struct Shown {
    picture: RgbaImage,
    factors: Vec<PatchFactors>,
    clip_from_object: Mat4,
    viewport: Vec2,
}

impl Shown {
    /// Draws a scene as the camera that frames it sees it, turned.
    fn new(scene: &mut Scene, settings: &Settings, turned: impl Fn(Camera) -> Camera) -> Self {
        let target = Target::new(&engine().gpu, [800, 800]).expect("a small picture");
        let viewport = target.viewport();
        let camera = turned(Camera::framing(&scene.bounds, viewport));
        let picture = seen(scene, &target, settings, &camera);
        let factors = engine().patch_factors(scene).expect("a readback");
        Self { picture, factors, clip_from_object: camera.clip_from_object(viewport, &scene.bounds), viewport }
    }

    /// The place in px of a point of the scene.
    fn place(&self, point: Vec3) -> Vec2 {
        project(self.clip_from_object, self.viewport, point).expect("in front of the eye")
    }
}

/// Flat patches of one factor, with these colours.
fn flat(factor: f32, colors: Colors) -> Settings {
    let (surface, partitioning) = (Surface::Flat, Partitioning::Integer);
    let tessellation = Tessellation { surface, partitioning, factor, ..Tessellation::default() };
    Settings { overlays: Overlays { colors, ..Overlays::default() }, ..Settings::from(tessellation) }
}

/// A camera that looks straight at a cube's front face.
fn in_front(scene: &Scene, target: &Target) -> Camera {
    Camera { azimuth: 0.0, elevation: 0.0, ..Camera::framing(&scene.bounds, target.viewport()) }
}

#[test]
fn factors_have_the_colours_of_their_scale_on_edges_and_inside() {
    let (_, mut cube) = scene(Shape::CubeSplit);
    let target = Target::new(&engine().gpu, [400, 400]).expect("a small picture");
    let camera = Camera { orthographic: true, ..in_front(&cube, &target) };
    for (stop, factor) in [1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0].into_iter().enumerate() {
        let settings = flat(factor, Colors::Factors);
        let found = pixels_of(&seen(&mut cube, &target, &settings, &camera), FACTOR_SCALE.colors[stop]);
        assert!(found > 10_000, "{factor}: {found} px");
    }
}

#[test]
fn every_edge_has_the_colour_of_its_own_factor() {
    let (loaded, mut saddle) = scene(Shape::Saddle);
    let overlays = Overlays { colors: Colors::Factors, ..Overlays::default() };
    let settings = Settings {
        tessellation: Tessellation { surface: Surface::Flat, lod: Lod::EdgeLength, ..Tessellation::default() },
        overlays,
        ..Settings::default()
    };
    let shown = Shown::new(&mut saddle, &settings, |camera| Camera { elevation: 70.0, ..camera });
    let (mut wrong, mut differ) = (Vec::new(), 0);
    for (patch, factors) in loaded.topology.patches.iter().zip(&shown.factors) {
        let corners = loaded.topology.corners(patch).map(|corner| loaded.mesh.corners[corner as usize].position);
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        let sides = (0..3).map(|i| {
            let k = domain_side(Convention::D3d11, i) as usize;
            (corners[k].midpoint(corners[(k + 1) % 3]).lerp(middle, 0.06), value(factors.outside[i as usize]))
        });
        let words: Vec<_> = sides.chain([(middle, value(factors.inside))]).collect();
        differ += usize::from(words.iter().any(|(_, factor)| *factor != words[0].1));
        for (place, factor) in words {
            let at = shown.place(place);
            if !shows(&shown.picture, at, factor) {
                wrong.push((factor, at));
            }
        }
    }
    assert!(differ > loaded.topology.patches.len() / 2, "factors of {differ} patches differ");
    assert_eq!(wrong, []);
}

#[test]
fn every_patch_has_the_colour_of_its_excess_triangles() {
    let (loaded, mut saddle) = scene(Shape::Saddle);
    let settings = Settings {
        tessellation: Tessellation { lod: Lod::EdgeLength, tolerance: 0.5, ..Tessellation::default() },
        overlays: Overlays { colors: Colors::Excess, ..Overlays::default() },
        ..Settings::default()
    };
    let shown = Shown::new(&mut saddle, &settings, |camera| Camera { elevation: 70.0, ..camera });
    let least = engine().minimum(&mut saddle).expect("a readback");
    let times = |patch: usize| triangle_count(shown.factors[patch]) as f32 / least[patch] as f32;
    let mut largest = 0.0f32;
    for (patch, corners) in loaded.topology.patches.iter().map(|patch| loaded.topology.corners(patch)).enumerate() {
        let [a, b, c] = corners.map(|corner| loaded.mesh.corners[corner as usize].position);
        let at = shown.place((a + b + c) / 3.0);
        let colour = shown.picture.get_pixel(at.x as u32, at.y as u32).0;
        let expected = EXCESS_SCALE.color(EXCESS_SCALE.place(times(patch)));
        // Slopes are a little darker: see `shade_flat`.
        let bright = (0..3).filter(|&k| expected[k] > 40);
        let mut shares = bright.map(|k| f32::from(colour[k]) / f32::from(expected[k]));
        assert!(shares.all(|share| (0.8..1.02).contains(&share)), "patch {patch}: {colour:?}, not {expected:?}");
        largest = largest.max(times(patch));
    }
    let [first, last] = [0, EXCESS_SCALE.colors.len() - 1].map(|stop| EXCESS_SCALE.colors[stop]);
    assert!(largest > 2.0 && first != last, "{largest}");
}

#[test]
fn patches_of_every_slab_have_the_colours_of_their_own_factors() {
    let loaded = sheet(600, 500);
    let mut scene = engine().scene(&loaded, ARENA_BYTES).expect("it fits");
    let overlays = Overlays { colors: Colors::Factors, ..Overlays::default() };
    let by_distance = Settings {
        tessellation: Tessellation { lod: Lod::Distance, factor: 4.0, near: 2.0, far: 3.5, ..Tessellation::default() },
        overlays,
        ..Settings::default()
    };
    let settings = by_distance.with(Tessellation {
        partitioning: Partitioning::Integer,
        surface: Surface::Flat,
        ..by_distance.tessellation
    });
    let shown = Shown::new(&mut scene, &settings, |camera| Camera { elevation: 40.0, azimuth: 90.0, ..camera });
    let sampled: Vec<_> = (0..shown.factors.len()).step_by(1009).collect();
    let wrong = sampled.iter().filter(|&&patch| {
        let corners = loaded.topology.patch_corners(patch as u32).map(|c| loaded.mesh.corners[c as usize].position);
        let at = shown.place((corners[0] + corners[1] + corners[2]) / 3.0);
        !shows(&shown.picture, at, value(shown.factors[patch].inside))
    });
    // Some lie where one factor ends and another starts.
    let (wrong, all) = (wrong.count(), sampled.len());
    assert!(wrong < all / 25, "{wrong} of {all}");
    let different: std::collections::HashSet<_> = sampled.iter().map(|&patch| shown.factors[patch].inside).collect();
    assert!(different.len() > 2, "{different:?}");
}

#[test]
fn small_triangles_and_low_factors_are_marked_and_others_are_not() {
    let (_, mut cube) = scene(Shape::CubeSplit);
    let target = Target::new(&engine().gpu, [400, 400]).expect("a small picture");
    let camera = Camera { orthographic: true, ..in_front(&cube, &target) };
    let mut marked = |colors, factor| pixels_of(&seen(&mut cube, &target, &flat(factor, colors), &camera), WASTE_COLOR);
    // The face is some 230 px wide, and its rings of triangles are smaller than a square grid's.
    assert_eq!(marked(Colors::TriangleSize, 16.0), 0);
    assert!(marked(Colors::TriangleSize, 64.0) > 10_000);
    assert!(marked(Colors::LowFactors, 1.0) > 10_000);
    assert_eq!(marked(Colors::LowFactors, 2.0), 0);
}

//! Pictures of every surface, partitioning and overlay, against references made on the software driver. Run with
//! PNAEN_UPDATE_IMAGES=1 to make them again; look at what changed before keeping it.

use std::path::{Path, PathBuf};

use geometry::mesh::{EdgeKind, Shape, t_junctions};
use geometry::progress::Progress;
use geometry::tessellate::{
    Convention, Displacement, FACTOR_ODD, FIXED_ONE, Lod, Normals, Partitioning, Surface, Tessellation, domain_side,
    triangle_count,
};
use geometry::view::project;
use image::RgbaImage;
use inspect::engine::{Preparation, load};
use inspect::render::layout::{CRACK_COLOR, FOLD_COLOR, NORMAL_COLOR, T_JUNCTION_COLOR, WASTE_COLOR, edge_color};
use inspect::render::{Camera, EXCESS_SCALE, FACTOR_SCALE, Scene, Target, t_junction_lines};
use inspect::settings::{ARENA_BYTES, Choice, Colors, Matcap, NormalsAt, Overlay, Overlays, Settings};
use inspect::shot::{BETWEEN_DRIVERS, Reference, compare, write_drawn};
use load::Source;

use crate::displacement::wavy;
use crate::passes::sheet;
use crate::stability::{case, seen};
use crate::{engine, picture, scene};

pub(super) const SIZE: [u32; 2] = [200, 160];
fn reference(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/images").join(format!("{name}.png"))
}

/// Names of pictures that differ from their references, with how much. It is decided as `render --reference` does.
pub(super) fn differing(pictures: Vec<(String, RgbaImage)>) -> Vec<String> {
    let update = std::env::var_os("PNAEN_UPDATE_IMAGES").is_some();
    assert!(engine().gpu.is_software() || !update, "references are made on the software driver");
    let mut differing = Vec::new();
    for (name, picture) in pictures {
        let path = reference(&name);
        let adapter = &engine().gpu.info;
        if update {
            write_drawn(&path, &picture, adapter, &[]).expect("the folder is there");
            continue;
        }
        let reference = Reference::read(&path, None).unwrap_or_else(|error| panic!("{name}: {error}"));
        let verdict = reference.compare(&picture, adapter).expect("one size");
        if !verdict.is_same() {
            let folder = std::env::temp_dir();
            picture.save(folder.join(format!("pnaen-{name}.png"))).expect("a writable temporary folder");
            differing.push(format!("{name}, {verdict:?}: see {}", folder.display()));
        }
    }
    differing
}

#[test]
fn surfaces_look_as_they_did() {
    let (_, mut scene) = scene(Shape::CubeSplit);
    let pictures = Surface::ALL.map(|surface| {
        let settings = Settings::from(Tessellation { surface, factor: 12.0, ..Tessellation::default() });
        (format!("surface-{}", surface.name()), picture(&mut scene, &settings, SIZE))
    });
    assert_eq!(differing(pictures.into()), Vec::<String>::new());
}

#[test]
fn normals_look_as_they_did() {
    let (_, mut scene) = scene(Shape::CubeSmooth);
    let all = [("linear", Normals::Linear), ("quadratic", Normals::Quadratic), ("surface", Normals::Surface)];
    let pictures = all.map(|(name, normals)| {
        let settings = Settings::from(Tessellation { normals, factor: 16.0, ..Tessellation::default() });
        (format!("normals-{name}"), picture(&mut scene, &settings, SIZE))
    });
    assert_eq!(differing(pictures.into()), Vec::<String>::new());
}

#[test]
fn normals_at_pixels_look_as_they_did() {
    // Beside normals-quadratic: with 4 segments an edge in place of 16, the outline differs and the shading doesn't.
    let (_, mut scene) = scene(Shape::CubeSmooth);
    let tessellation = Tessellation { normals: Normals::Quadratic, factor: 4.0, ..Tessellation::default() };
    let settings = Settings { normals_at: NormalsAt::Pixels, ..Settings::from(tessellation) };
    let picture = picture(&mut scene, &settings, SIZE);
    assert_eq!(differing(vec![("normals-at-pixels".to_owned(), picture)]), Vec::<String>::new());
}

#[test]
fn a_crease_band_looks_as_it_did() {
    // Beside surface-pn and surface-pn-aen: closed as the one is not, round where the other has its crease.
    let loaded = load(
        &Source::Shape(Shape::CubeSplit),
        &Preparation { crease_band: 0.04, ..Preparation::default() },
        &Progress::new(),
    )
    .expect("shapes always load");
    let mut scene = engine().scene(&loaded, ARENA_BYTES).expect("shapes are small");
    let settings = Settings::from(Tessellation { surface: Surface::Pn, factor: 12.0, ..Tessellation::default() });
    let picture = picture(&mut scene, &settings, SIZE);
    assert_eq!(differing(vec![("surface-pn-crease-band".to_owned(), picture)]), Vec::<String>::new());
}

#[test]
fn displaced_surfaces_look_as_they_did() {
    let (_, mut scene) = wavy(Shape::CubeSplit);
    let all = [("on", Displacement::On), ("as-published", Displacement::AsPublished)];
    let pictures = all.map(|(name, displacement)| {
        let settings =
            Settings::from(Tessellation { displacement, height_scale: 0.15, factor: 32.0, ..Tessellation::default() });
        (format!("displacement-{name}"), picture(&mut scene, &settings, SIZE))
    });
    assert_eq!(differing(pictures.into()), Vec::<String>::new());
}

#[test]
fn partitionings_look_as_they_did() {
    let (_, mut scene) = scene(Shape::Icosahedron);
    let overlays = Overlays { wireframe: true, patches: true, ..Overlays::default() };
    let pictures = Partitioning::ALL.map(|partitioning| {
        let settings = Settings {
            tessellation: Tessellation { partitioning, factor: 4.6, ..Tessellation::default() },
            overlays,
            ..Settings::default()
        };
        (format!("partitioning-{}", partitioning.name()), picture(&mut scene, &settings, SIZE))
    });
    assert_eq!(differing(pictures.into()), Vec::<String>::new());
}

#[test]
fn overlays_look_as_they_did() {
    let mut pictures = Vec::new();
    for (name, shape, overlay) in [
        ("wireframe", Shape::Icosahedron, Overlay::Wireframe),
        ("patches", Shape::Torus, Overlay::Patches),
        ("barycentric", Shape::CubeSplit, Overlay::Barycentric),
        ("adjacency-cylinder", Shape::Cylinder, Overlay::Adjacency),
        ("adjacency-moebius", Shape::Moebius, Overlay::Adjacency),
        ("cracks", Shape::CubeSplit, Overlay::Cracks),
        ("normals", Shape::CubeSplit, Overlay::Normals),
    ] {
        let (_, mut scene) = scene(shape);
        let overlays = Overlays::new(&[overlay]).expect("one overlay");
        let settings = Settings {
            tessellation: Tessellation { surface: Surface::Pn, ..Tessellation::default() },
            overlays,
            ..Settings::default()
        };
        pictures.push((format!("overlay-{name}"), picture(&mut scene, &settings, SIZE)));
    }
    assert_eq!(differing(pictures), Vec::<String>::new());
}

#[test]
fn colours_look_as_they_did() {
    let mut pictures = Vec::new();
    for (name, shape, colors, settings) in [
        (
            "factors",
            Shape::Torus,
            Colors::Factors,
            Settings::from(Tessellation { lod: Lod::Error, ..Tessellation::default() }),
        ),
        (
            "triangle-size",
            Shape::Torus,
            Colors::TriangleSize,
            Settings::from(Tessellation { lod: Lod::EdgeLength, ..Tessellation::default() }),
        ),
        (
            "low-factors",
            Shape::Torus,
            Colors::LowFactors,
            Settings::from(Tessellation { lod: Lod::EdgeLength, ..Tessellation::default() }),
        ),
        (
            "excess",
            Shape::Torus,
            Colors::Excess,
            Settings::from(Tessellation { lod: Lod::EdgeLength, tolerance: 1.0, ..Tessellation::default() }),
        ),
        ("clay", Shape::Bicubic, Colors::Clay, Settings::default()),
        ("zebra", Shape::Bicubic, Colors::Zebra, Settings { normals_at: NormalsAt::Pixels, ..Settings::default() }),
        ("shading-normals", Shape::CubeSplit, Colors::ShadingNormals, Settings::default()),
        ("matcap-red-clay", Shape::Bicubic, Colors::Matcap, Settings::default()),
        ("matcap-chrome", Shape::Bicubic, Colors::Matcap, Settings { matcap: Matcap::Chrome, ..Settings::default() }),
        ("matcap-pearl", Shape::Bicubic, Colors::Matcap, Settings { matcap: Matcap::Pearl, ..Settings::default() }),
        (
            "matcap-two-tone",
            Shape::Bicubic,
            Colors::Matcap,
            Settings { matcap: Matcap::TwoTone, ..Settings::default() },
        ),
        ("texel-density", Shape::Torus, Colors::TexelDensity, Settings::default()),
        (
            "surface-normals",
            Shape::Icosphere,
            Colors::SurfaceNormals,
            Settings { split: Some(0.5), ..Settings::default() },
        ),
        ("curvature", Shape::Torus, Colors::Curvature, Settings { split: Some(0.5), ..Settings::default() }),
        ("uv-checker", Shape::Torus, Colors::UvChecker, Settings { split: Some(0.5), ..Settings::default() }),
    ] {
        let (_, mut scene) = scene(shape);
        let settings = Settings {
            tessellation: Tessellation { pixels: 12.0, ..settings.tessellation },
            overlays: Overlays { colors, ..Overlays::default() },
            ..settings
        };
        pictures.push((format!("colours-{name}"), picture(&mut scene, &settings, SIZE)));
    }
    assert_eq!(differing(pictures), Vec::<String>::new());
}

#[test]
fn adaptive_lod_and_the_split_look_as_they_did() {
    let (_, mut scene) = scene(Shape::Cone);
    let overlays = Overlays { wireframe: true, ..Overlays::default() };
    let adaptive = Settings {
        tessellation: Tessellation { lod: Lod::Paper, pixels: 32.0, ..Tessellation::default() },
        overlays,
        ..Settings::default()
    };
    let few = Settings::from(Tessellation { factor: 3.0, ..Tessellation::default() });
    let split = Settings { split: Some(0.5), overlays, ..few };
    let pictures = [("lod-paper", adaptive), ("split", split)];
    let pictures = pictures.map(|(name, settings)| (name.to_owned(), picture(&mut scene, &settings, SIZE)));
    assert_eq!(differing(pictures.into()), Vec::<String>::new());
}

#[test]
fn a_change_that_matters_is_far_beyond_what_drivers_differ_by() {
    let (_, mut scene) = scene(Shape::CubeSplit);
    let base = Settings::from(Tessellation { factor: 12.0, ..Tessellation::default() });
    let wireframe = Overlays { wireframe: true, ..Overlays::default() };
    let expected = picture(&mut scene, &base, SIZE);
    for changed in [
        base.with(Tessellation { surface: Surface::Pn, ..base.tessellation }),
        Settings { overlays: wireframe, ..base },
        Settings { split: Some(0.4), ..base },
    ] {
        let comparison = compare(&picture(&mut scene, &changed, SIZE), &expected).expect("one size");
        assert!(comparison.worst_square > 10.0 * f64::from(BETWEEN_DRIVERS), "{comparison:?}: {changed:?}");
    }
}

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

/// How many px have an sRGB colour, within what rounding from it to linear light, in three digits, and back can do.
fn pixels_of(picture: &RgbaImage, color: [u8; 3]) -> usize {
    let near = |pixel: &image::Rgba<u8>| (0..3).all(|c| pixel.0[c].abs_diff(color[c]) <= 2);
    picture.pixels().filter(|pixel| near(pixel)).count()
}

#[test]
fn lines_have_the_colours_of_their_legend() {
    let legend = [
        (Shape::Cylinder, Overlay::Adjacency, edge_color(EdgeKind::Smooth)),
        (Shape::Cylinder, Overlay::Adjacency, edge_color(EdgeKind::Split)),
        (Shape::Cylinder, Overlay::Adjacency, edge_color(EdgeKind::Seam)),
        (Shape::Saddle, Overlay::Adjacency, edge_color(EdgeKind::Boundary)),
        (Shape::CubeSplit, Overlay::Cracks, CRACK_COLOR),
    ];
    for (shape, overlay, color) in legend {
        let (_, mut scene) = scene(shape);
        let overlays = Overlays::new(&[overlay]).expect("one overlay");
        let settings = Settings {
            tessellation: Tessellation { surface: Surface::Pn, ..Tessellation::default() },
            overlays,
            ..Settings::default()
        };
        let found = pixels_of(&picture(&mut scene, &settings, [640, 480]), color);
        assert!(found > 50, "{shape:?} {overlay:?}: {found} px of {color:?}");
    }
}

/// Whether a px is a factor's colour: it may be a little darker where the surface is slanted, but has its hue.
fn shows(picture: &RgbaImage, at: glam::Vec2, factor: f32) -> bool {
    let [r, g, b, _] = picture.get_pixel(at.x as u32, at.y as u32).0;
    let hue = |c: [u8; 3]| c.map(|x| f32::from(x) / f32::from(c[0].max(c[1]).max(c[2])));
    let (found, expected) = (hue([r, g, b]), hue(FACTOR_SCALE.color(FACTOR_SCALE.place(factor))));
    (0..3).all(|c| (found[c] - expected[c]).abs() < 0.06)
}

/// The factor that the tessellator works with.
fn value(word: u32) -> f32 {
    (word & !FACTOR_ODD) as f32 / FIXED_ONE as f32
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
    let overlays = Overlays { colors: Colors::Factors, ..Overlays::default() };
    for (stop, factor) in [1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0].into_iter().enumerate() {
        let flat = Settings::from(Tessellation {
            surface: Surface::Flat,
            partitioning: Partitioning::Integer,
            ..Tessellation::default()
        });
        let settings = Settings { tessellation: Tessellation { factor, ..flat.tessellation }, overlays, ..flat };
        let found = pixels_of(&seen(&mut cube, &target, &settings, &camera), FACTOR_SCALE.colors[stop]);
        assert!(found > 10_000, "{factor}: {found} px");
    }
}

#[test]
fn every_edge_has_the_colour_of_its_own_factor() {
    let (loaded, mut saddle) = scene(Shape::Saddle);
    let target = Target::new(&engine().gpu, [800, 800]).expect("a small picture");
    let camera = Camera { elevation: 70.0, ..Camera::framing(&saddle.bounds, target.viewport()) };
    let overlays = Overlays { colors: Colors::Factors, ..Overlays::default() };
    let settings = Settings {
        tessellation: Tessellation { surface: Surface::Flat, lod: Lod::EdgeLength, ..Tessellation::default() },
        overlays,
        ..Settings::default()
    };
    let picture = seen(&mut saddle, &target, &settings, &camera);
    let factors = engine().patch_factors(&saddle).expect("a readback");
    let clip = camera.clip_from_object(target.viewport(), &saddle.bounds);
    let (mut wrong, mut differ) = (Vec::new(), 0);
    for (patch, factors) in loaded.topology.patches.iter().zip(&factors) {
        let corners = loaded.topology.corners(patch).map(|corner| loaded.mesh.corners[corner as usize].position);
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        let sides = (0..3).map(|i| {
            let k = domain_side(Convention::D3d11, i) as usize;
            (corners[k].midpoint(corners[(k + 1) % 3]).lerp(middle, 0.06), value(factors.outside[i as usize]))
        });
        let words: Vec<_> = sides.chain([(middle, value(factors.inside))]).collect();
        differ += usize::from(words.iter().any(|(_, factor)| *factor != words[0].1));
        for (place, factor) in words {
            let at = project(clip, target.viewport(), place).expect("in front of the eye");
            if !shows(&picture, at, factor) {
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
    let target = Target::new(&engine().gpu, [800, 800]).expect("a small picture");
    let camera = Camera { elevation: 70.0, ..Camera::framing(&saddle.bounds, target.viewport()) };
    let settings = Settings {
        tessellation: Tessellation { lod: Lod::EdgeLength, tolerance: 0.5, ..Tessellation::default() },
        overlays: Overlays { colors: Colors::Excess, ..Overlays::default() },
        ..Settings::default()
    };
    let picture = seen(&mut saddle, &target, &settings, &camera);
    let factors = engine().patch_factors(&saddle).expect("a readback");
    let least = engine().minimum(&mut saddle).expect("a readback");
    let clip = camera.clip_from_object(target.viewport(), &saddle.bounds);
    let times = |patch: usize| triangle_count(factors[patch]) as f32 / least[patch] as f32;
    let mut largest = 0.0f32;
    for (patch, corners) in loaded.topology.patches.iter().map(|patch| loaded.topology.corners(patch)).enumerate() {
        let [a, b, c] = corners.map(|corner| loaded.mesh.corners[corner as usize].position);
        let at = project(clip, target.viewport(), (a + b + c) / 3.0).expect("in front of the eye");
        let colour = picture.get_pixel(at.x as u32, at.y as u32).0;
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
    let target = Target::new(&engine().gpu, [800, 800]).expect("a small picture");
    let camera = Camera { elevation: 40.0, azimuth: 90.0, ..Camera::framing(&scene.bounds, target.viewport()) };
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
    let picture = seen(&mut scene, &target, &settings, &camera);
    let factors = engine().patch_factors(&scene).expect("a readback");
    let clip = camera.clip_from_object(target.viewport(), &scene.bounds);
    let sampled: Vec<_> = (0..factors.len()).step_by(1009).collect();
    let wrong = sampled.iter().filter(|&&patch| {
        let corners = loaded.topology.patch_corners(patch as u32).map(|c| loaded.mesh.corners[c as usize].position);
        let at = project(clip, target.viewport(), (corners[0] + corners[1] + corners[2]) / 3.0);
        !shows(&picture, at.expect("in front of the eye"), value(factors[patch].inside))
    });
    // Some lie where one factor ends and another starts.
    let (wrong, all) = (wrong.count(), sampled.len());
    assert!(wrong < all / 25, "{wrong} of {all}");
    let different: std::collections::HashSet<_> = sampled.iter().map(|&patch| factors[patch].inside).collect();
    assert!(different.len() > 2, "{different:?}");
}

#[test]
fn small_triangles_and_low_factors_are_marked_and_others_are_not() {
    let (_, mut cube) = scene(Shape::CubeSplit);
    let target = Target::new(&engine().gpu, [400, 400]).expect("a small picture");
    let camera = Camera { orthographic: true, ..in_front(&cube, &target) };
    let mut marked = |colors, factor| {
        let overlays = Overlays { colors, ..Overlays::default() };
        let flat = Settings::from(Tessellation {
            surface: Surface::Flat,
            partitioning: Partitioning::Integer,
            ..Tessellation::default()
        });
        let picture = seen(
            &mut cube,
            &target,
            &Settings { tessellation: Tessellation { factor, ..flat.tessellation }, overlays, ..flat },
            &camera,
        );
        pixels_of(&picture, WASTE_COLOR)
    };
    // The face is some 230 px wide, and its rings of triangles are smaller than a square grid's.
    assert_eq!(marked(Colors::TriangleSize, 16.0), 0);
    assert!(marked(Colors::TriangleSize, 64.0) > 10_000);
    assert!(marked(Colors::LowFactors, 1.0) > 10_000);
    assert_eq!(marked(Colors::LowFactors, 2.0), 0);
}

#[test]
fn normals_are_drawn_chunk_by_chunk_and_not_hidden_by_later_chunks() {
    let loaded = crate::loaded(Shape::Torus);
    let settings = Settings {
        tessellation: Tessellation { factor: 63.0, ..Tessellation::default() },
        overlays: Overlays { normals: true, ..Overlays::default() },
        ..Settings::default()
    };
    let [whole, pieces] = [ARENA_BYTES, 4 << 20].map(|arena| {
        let mut scene = engine().scene(&loaded, arena).expect("shapes are small");
        let drawn = picture(&mut scene, &settings, SIZE);
        (scene.tessellator.chunk_count(), drawn)
    });
    assert!(whole.0 == 1 && pieces.0 > 4, "{} chunks and {}", whole.0, pieces.0);
    assert!(pixels_of(&whole.1, NORMAL_COLOR) > 100);
    // Where lines lie on each other, the order in which they are blended is another.
    let comparison = compare(&whole.1, &pieces.1).expect("one size");
    assert!(comparison.px < 50 && comparison.worst_square < f64::from(BETWEEN_DRIVERS), "{comparison:?}");
}

#[test]
fn the_same_vertices_show_their_normals_when_they_move_a_little() {
    let (_, mut scene) = scene(Shape::CubeSplit);
    let overlays = Overlays { normals: true, ..Overlays::default() };
    let [shown, moved, coarser] = [(0.75, 16.0), (0.7501, 16.0), (0.75, 15.0)].map(|(alpha, factor)| {
        let settings = Settings {
            tessellation: Tessellation { surface: Surface::Phong, alpha, factor, ..Tessellation::default() },
            overlays,
            ..Settings::default()
        };
        picture(&mut scene, &settings, SIZE)
    });
    let worst = |other: &RgbaImage| compare(&shown, other).expect("one size").worst_square;
    let tolerance = f64::from(BETWEEN_DRIVERS);
    assert!(worst(&moved) < tolerance, "{}", worst(&moved));
    assert!(worst(&coarser) > 10.0 * tolerance, "other vertices are other ones: {}", worst(&coarser));
}

#[test]
fn folds_are_marked_and_nothing_else_is() {
    let target = Target::new(&engine().gpu, [640, 480]).expect("a small picture");
    let (mut star, camera) = case("folds");
    let marked = |scene: &mut Scene, camera: &Camera, surface, folds| {
        let overlays = Overlays { folds, ..Overlays::default() };
        let settings = Settings {
            tessellation: Tessellation { surface, factor: 14.0, ..Tessellation::default() },
            overlays,
            ..Settings::default()
        };
        pixels_of(&seen(scene, &target, &settings, camera), FOLD_COLOR)
    };
    for surface in [Surface::Pn, Surface::PnAen] {
        let pixels = marked(&mut star, &camera, surface, true);
        assert!(pixels > 1000, "{surface:?}: {pixels} px");
        assert_eq!(marked(&mut star, &camera, surface, false), 0, "{surface:?}, not asked for");
    }
    assert_eq!(marked(&mut star, &camera, Surface::Flat, true), 0, "what is flat has no folds");
    let (_, mut torus) = scene(Shape::Torus);
    let inside = Camera { target: glam::vec3(0.7, 0.0, 0.0), distance: 0.1, ..camera };
    for camera in [camera, inside] {
        let pixels = marked(&mut torus, &camera, Surface::PnAen, true);
        assert_eq!(pixels, 0, "a torus has none, though half of it faces away from the eye");
    }
}

#[test]
fn faces_seen_from_behind_are_marked_and_others_are_not() {
    let target = Target::new(&engine().gpu, [320, 240]).expect("a small picture");
    // How many px are three times as red as green: the mesh is grey, the background bluish.
    let red = |scene: &mut Scene, camera: &Camera, back_faces| {
        let overlays = Overlays { back_faces, ..Overlays::default() };
        let picture = seen(scene, &target, &Settings { overlays, ..Settings::default() }, camera);
        picture.pixels().filter(|pixel| pixel.0[0] > 40 && pixel.0[0] / 3 > pixel.0[1]).count()
    };
    let (_, mut saddle) = scene(Shape::Saddle);
    let above = Camera::framing(&saddle.bounds, target.viewport());
    let below = Camera { elevation: -40.0, ..above };
    assert!(red(&mut saddle, &below, true) > 2000, "an open sheet from below");
    assert_eq!(red(&mut saddle, &below, false), 0, "not asked for");
    assert_eq!(red(&mut saddle, &Camera { elevation: 60.0, ..above }, true), 0, "from above");
    let (_, mut torus) = scene(Shape::Torus);
    let around = Camera::framing(&torus.bounds, target.viewport());
    assert_eq!(red(&mut torus, &around, true), 0, "nobody sees a closed mesh from behind");
}

#[test]
fn t_junctions_are_marked_where_there_are_some() {
    let target = Target::new(&engine().gpu, [640, 480]).expect("a small picture");
    let marked = |scene: &mut Scene, camera: &Camera| {
        let topology = scene.tessellator.topology().clone();
        let junctions = t_junctions(&topology, &Progress::default()).expect("nobody cancels");
        scene.set_lines(&engine().gpu, &t_junction_lines(&topology, &junctions));
        let picture = seen(scene, &target, &Settings::default(), camera);
        (junctions.len(), pixels_of(&picture, T_JUNCTION_COLOR))
    };
    let (mut sheet, camera) = case("t-junction");
    let (found, pixels) = marked(&mut sheet, &camera);
    assert!(found == 7 && pixels > 200, "{pixels} px for {found} T-junctions");
    assert_eq!(marked(&mut scene(Shape::Saddle).1, &camera), (0, 0));
}

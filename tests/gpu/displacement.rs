//! Displacement on the device: held against the CPU, watertight where it says so, torn where it says so, and in view.

use std::f32::consts::TAU;
use std::ops::Range;
use std::sync::Arc;

use geometry::mesh::{
    Corner, HeightAmount, HeightMap, Heights, Material, Mesh, Moment, PartRange, Shape, Texture, Wrap,
};
use geometry::progress::Progress;
use geometry::tessellate::{
    Clip, Displacement, Edges, HullFactors, Lod, Normals, Partitioning, PatchFactors, Surface, Tessellation, Vertex,
    deform, tessellate, tessellate_given, triangle_count, unpack_normal,
};
use geometry::view::ulp;
use gpu::Timing;
use inspect::engine::{Loaded, Measurements, Runs};
use inspect::measure::Measured;
use inspect::render::{Scene, Target};
use inspect::settings::{ARENA_BYTES, Settings};
use lab::stability::CASES;
use load::{Budget, HeightSource, Source};

use crate::passes::{edge_factors, inputs, on_gpu};
use crate::{engine, loaded_mesh};

/// Waves that repeat with the image; two crests of either length across it.
pub(super) fn waves(size: u32) -> HeightMap {
    let height = |i: u32| {
        let at = [i % size, i / size].map(|x| TAU * (x as f32 + 0.5) / size as f32);
        0.5 + 0.25 * (2.0 * at[0]).sin() * (3.0 * at[1]).cos() + 0.2 * (at[0] + 2.0 * at[1]).cos()
    };
    HeightMap::new([size, size], (0..size * size).map(height).collect())
}

/// A shape under waves, on the device too.
pub(super) fn wavy(shape: Shape) -> (Loaded, Scene) {
    under_waves(shape, shape.build())
}

/// A torus with smooth normals, whose second half has its texture elsewhere: seams with nothing in common.
pub(super) fn shifted_torus() -> Mesh {
    let mut mesh = Shape::Torus.build();
    let (half, count) = (mesh.triangles.len() / 2, mesh.corners.len() as u32);
    let shifted = mesh.corners.clone().into_iter().map(|c| Corner { uv: c.uv + glam::vec2(0.37, 0.21), ..c });
    mesh.corners.extend(shifted);
    Arc::make_mut(&mut mesh.triangles)[half..]
        .iter_mut()
        .for_each(|triangle| *triangle = triangle.map(|corner| corner + count));
    mesh
}

fn under_waves(shape: Shape, mut mesh: Mesh) -> (Loaded, Scene) {
    mesh.heights = Some(Arc::new(Heights::everywhere(&mesh, waves(64))));
    on_device(shape, mesh)
}

fn on_device(shape: Shape, mesh: Mesh) -> (Loaded, Scene) {
    let loaded = loaded_mesh(Source::Shape(shape), mesh);
    let scene = engine().scene(&loaded, ARENA_BYTES).expect("a small mesh");
    (loaded, scene)
}

const MODES: [Displacement; 3] = [Displacement::On, Displacement::AsPublished, Displacement::PerPatch];

fn measured(scene: &mut Scene, loaded: &Loaded, settings: &Settings) -> Measured {
    engine().count(scene, &inputs(loaded, settings), &mut Timing::Off).expect("counts");
    engine().measure(scene).expect("a readback")
}

#[test]
fn the_device_displaces_as_the_cpu_does() {
    for shape in [Shape::CubeSplit, Shape::Torus, Shape::Cone, Shape::Saddle] {
        let (loaded, mut scene) = wavy(shape);
        let size = loaded.mesh.bounds().radius();
        for (index, displacement) in MODES.into_iter().enumerate() {
            for (turn, surface) in Surface::ALL.into_iter().enumerate() {
                let normals = [Normals::Linear, Normals::Quadratic, Normals::Surface][(index + turn) % 3];
                let edges = if turn % 4 == 3 { Edges::AsPublished } else { Edges::PerEdge };
                let partitioning = Partitioning::ALL[turn % 4];
                let own = Settings::from(Tessellation {
                    surface,
                    normals,
                    edges,
                    partitioning,
                    displacement,
                    ..Tessellation::default()
                });
                let inputs =
                    inputs(&loaded, &own.with(Tessellation { factor: 5.3, height_scale: 0.2, ..own.tessellation }));
                let gpu = on_gpu(&mut scene, &inputs);
                let cpu = tessellate(&loaded.mesh, &loaded.topology, &inputs, None);
                let what = format!("{shape:?} {displacement:?} {surface:?} {normals:?} {edges:?} {partitioning:?}");
                assert_eq!(gpu.vertices.len(), cpu.vertices.len(), "{what}");
                for (a, b) in gpu.vertices.iter().zip(&cpu.vertices) {
                    // Levels are logarithms, good to some 1e-6 of one, and a level is at most the whole height.
                    let [p, q] = [a.position, b.position].map(glam::Vec3::from);
                    assert!(p.distance(q) <= 1e-5 * size, "{what}: {p} {q}");
                    let [n, m] = [a.normal, b.normal].map(unpack_normal);
                    assert!(n.distance(m) < 2e-3, "{what}: {n} {m}");
                }
            }
        }
    }
}

#[test]
fn no_edge_cracks_across_seams_or_split_normals() {
    for shape in Shape::ALL {
        let (loaded, mut scene) = wavy(shape);
        for surface in Surface::ALL.into_iter().filter(|surface| !surface.tears()) {
            for partitioning in Partitioning::ALL {
                let own = Settings::from(Tessellation {
                    surface,
                    partitioning,
                    displacement: Displacement::On,
                    ..Tessellation::default()
                });
                let paper = own.with(Tessellation { lod: Lod::EdgeLength, pixels: 6.0, ..own.tessellation });
                // A strict tolerance takes a software driver long, so that surfaces and partitionings have it by turns.
                let tolerance = if (surface as usize + partitioning as usize).is_multiple_of(3) { 2.0 } else { 8.0 };
                let error = own.with(Tessellation { lod: Lod::Error, tolerance, ..own.tessellation });
                for settings in [own.with(Tessellation { factor: 6.4, ..own.tessellation }), paper, error] {
                    let measured = measured(
                        &mut scene,
                        &loaded,
                        &settings.with(Tessellation { height_scale: 0.3, ..settings.tessellation }),
                    );
                    let what = format!("{shape:?} {surface:?} {partitioning:?} {:?}", settings.tessellation.lod);
                    let cracks = &measured.cracks;
                    assert_eq!((cracks.different_bits, cracks.different_normals), (0, 0), "{what}");
                    assert_eq!(measured.not_finite, 0, "{what}");
                }
            }
        }
    }
}

#[test]
fn what_is_published_tears_where_it_is_said_to() {
    let bits = |(loaded, mut scene): (Loaded, Scene), displacement| {
        let settings = Settings::from(Tessellation { displacement, factor: 6.0, ..Tessellation::default() });
        let cracks = measured(&mut scene, &loaded, &settings).cracks;
        (cracks.different_bits, cracks.max_gap() / ulp(&loaded.topology))
    };
    let seams = || under_waves(Shape::Torus, shifted_torus());
    // Dominance closes seams, and leaves what has normals of its own.
    let (points, gap) = bits(wavy(Shape::CubeSplit), Displacement::AsPublished);
    assert!(points > 60 && gap > 1e4, "{points} points, {gap} ULP");
    assert_eq!(bits(seams(), Displacement::AsPublished).0, 0, "seams alone");
    for torn in [wavy(Shape::CubeSplit), seams()] {
        let (points, gap) = bits(torn, Displacement::PerPatch);
        assert!(points > 60 && gap > 1e4, "{points} points, {gap} ULP");
    }
    assert_eq!(bits(seams(), Displacement::On).0, 0);
}

#[test]
fn heights_move_points_along_the_shared_direction_by_scale_and_midlevel() {
    // One height everywhere: the torus grows by it.
    let (mut loaded, _) = wavy(Shape::Torus);
    let mut mesh = (*loaded.mesh).clone();
    mesh.heights = Some(Arc::new(Heights::everywhere(&mesh, HeightMap::new([4, 4], vec![0.75; 16]))));
    loaded.mesh = Arc::new(mesh);
    let mut scene = engine().scene_of(loaded.mesh.clone(), loaded.topology.clone(), ARENA_BYTES).expect("a small mesh");
    let own =
        Settings::from(Tessellation { factor: 3.0, height_scale: 0.1, midlevel: 0.25, ..Tessellation::default() });
    let [flat, moved] = [Displacement::Off, Displacement::On].map(|displacement| {
        on_gpu(&mut scene, &inputs(&loaded, &own.with(Tessellation { displacement, ..own.tessellation })))
    });
    let expected = 0.5 * 0.1 * loaded.mesh.bounds().radius();
    for (a, b) in flat.vertices.iter().zip(&moved.vertices) {
        let along = glam::Vec3::from(b.position) - glam::Vec3::from(a.position);
        assert!((along.length() - expected).abs() < 1e-5, "{along}");
        // What is level stays shaded as it was.
        assert!(unpack_normal(a.normal).distance(unpack_normal(b.normal)) < 1e-3);
    }
}

#[test]
fn an_image_ends_at_its_border_where_coordinates_end_and_repeats_where_they_do_not() {
    // A ramp over a sheet: a slanted plane, up to half a px at either end.
    let ramp = || HeightMap::new([64, 1], (0..64).map(|i| i as f32 / 63.0).collect());
    for (times, rises) in [(1.0, true), (2.0, false)] {
        let mut mesh = Shape::Saddle.build();
        mesh.corners.iter_mut().for_each(|corner| corner.uv *= times);
        mesh.heights = Some(Arc::new(Heights::everywhere(&mesh, ramp())));
        let (loaded, mut scene) = on_device(Shape::Saddle, mesh);
        let own =
            Settings::from(Tessellation { factor: 8.0, midlevel: 0.0, height_scale: 0.5, ..Tessellation::default() });
        let [flat, moved] = [Displacement::Off, Displacement::On].map(|displacement| {
            on_gpu(&mut scene, &inputs(&loaded, &own.with(Tessellation { displacement, ..own.tessellation })))
        });
        let radius = loaded.mesh.bounds().radius();
        let offset = |(a, b): (&Vertex, &Vertex)| {
            let [p, q] = [a.position, b.position].map(glam::Vec3::from);
            (a.uv[0], q.distance(p) / (0.5 * radius))
        };
        let all: Vec<_> = flat.vertices.iter().zip(&moved.vertices).map(offset).collect();
        let fits = all.iter().all(|&(u, height)| (height - (u * 64.0 - 0.5) / 63.0).abs() < 0.02);
        assert_eq!(fits, rises, "{times}");
    }
}

#[test]
fn factors_that_are_no_numbers_leave_no_hole_in_the_neighbours() {
    let (_, mut scene) = wavy(Shape::CubeSplit);
    let given =
        |patch: usize| HullFactors { edges: [if patch.is_multiple_of(2) { f32::NAN } else { 3.0 }; 3], inside: 3.0 };
    let given: Vec<_> = (0..scene.tessellator.topology().patches.len()).map(given).collect();
    scene.tessellator.give(Some(given.clone().into())).expect("few patches");
    let settings = Settings::from(Tessellation { displacement: Displacement::On, ..Tessellation::default() });
    let viewport = glam::vec2(64.0, 64.0);
    let view = inspect::render::Camera::framing(&scene.bounds, viewport).lod_view(viewport, &scene.bounds);
    engine().count(&mut scene, &settings.inputs(view), &mut Timing::Off).expect("counts");
    let measured = engine().measure(&mut scene).expect("a readback");
    assert!(scene.tessellator.totals().1 > 0 && measured.not_finite == 0, "{} not finite", measured.not_finite);
    let (mesh, topology) = (scene.tessellator.mesh().clone(), scene.tessellator.topology().clone());
    let cpu = tessellate_given(&mesh, &topology, &settings.inputs(view), &given);
    assert!(cpu.vertices.iter().all(|vertex| glam::Vec3::from(vertex.position).is_finite()));
}

#[test]
fn shading_is_smooth_over_the_edges_of_smooth_patches() {
    // The torus's own seams are none under waves that repeat.
    let mut mesh = Shape::Torus.build();
    mesh.corners.iter_mut().for_each(|corner| corner.uv *= 2.0);
    let (loaded, mut scene) = under_waves(Shape::Torus, mesh);
    let steepest = |scene: &mut Scene, factor: f32| {
        let settings = Settings::from(Tessellation {
            displacement: Displacement::On,
            height_scale: 0.1,
            factor,
            ..Tessellation::default()
        });
        let out = on_gpu(scene, &inputs(&loaded, &settings));
        let normals: Vec<_> = out.vertices.iter().map(|vertex| unpack_normal(vertex.normal)).collect();
        let angle = |a: u32, b: u32| normals[a as usize].angle_between(normals[b as usize]).to_degrees();
        out.triangles.iter().map(|&[a, b, c]| angle(a, b).max(angle(b, c)).max(angle(c, a))).fold(0.0, f32::max)
    };
    // A third, were it not for heights that have more detail at finer levels. A step at an edge would stay a step, however
    // short the segment beside it.
    let (coarse, fine) = (steepest(&mut scene, 15.0), steepest(&mut scene, 45.0));
    assert!(fine < 0.5 * coarse, "{coarse} and {fine} degrees from vertex to vertex");
}

#[test]
fn culling_takes_the_amplitude_into_account() {
    let size = [160, 120];
    let mut culled = 0;
    for shape in [Shape::Torus, Shape::CubeSplit] {
        let (_, mut scene) = wavy(shape);
        let target = Target::new(&engine().gpu, size).expect("a small picture");
        for index in 0..24 {
            let camera = lab::stability::random_camera(&scene.bounds, index);
            let whole = Settings::from(Tessellation {
                displacement: Displacement::On,
                height_scale: 0.5,
                factor: 8.0,
                cull_back_faces: true,
                ..Tessellation::default()
            });
            let mut picture = |settings: &Settings| {
                engine().draw(&mut scene, &target, &camera, settings, &mut Timing::Off).expect("a picture");
                (target.read(&engine().gpu).expect("a picture"), scene.tessellator.totals().1)
            };
            let (all, triangles) = picture(&whole);
            let (clipped, fewer) = picture(&whole.with(Tessellation { clip: Clip::Frustum, ..whole.tessellation }));
            assert!(all == clipped, "{shape:?}, camera {index}: clipping shows");
            culled += triangles - fewer;
        }
    }
    assert!(culled > 10_000, "{culled} triangles left out");
}

#[test]
fn lod_by_error_holds_with_gentle_heights() {
    for shape in [Shape::Torus, Shape::Saddle] {
        // Beyond 1, so that the waves repeat and the torus's seams are none.
        let mut mesh = shape.build();
        mesh.corners.iter_mut().for_each(|corner| corner.uv *= 2.0);
        let (loaded, mut scene) = under_waves(shape, mesh);
        let settings = Settings::from(Tessellation {
            displacement: Displacement::On,
            height_scale: 0.05,
            lod: Lod::Error,
            tolerance: 1.0,
            partitioning: Partitioning::Integer,
            ..Tessellation::default()
        });
        let inputs = inputs(&loaded, &settings);
        engine().count(&mut scene, &inputs, &mut Timing::Off).expect("counts");
        let wanted = Measurements { screen_error: Some(&inputs), ..Measurements::default() };
        let results = engine().measure_all(&mut scene, &wanted).expect("a readback");
        let worst = results.screen_error.expect("it is in view");
        assert!(worst.value <= 1.0, "{shape:?}: {} px", worst.value);
        let without = settings.with(Tessellation { displacement: Displacement::Off, ..settings.tessellation });
        let plain = on_gpu(&mut scene, &crate::passes::inputs(&loaded, &without)).triangles.len() as u64;
        engine().count(&mut scene, &inputs, &mut Timing::Off).expect("counts");
        assert!(scene.tessellator.totals().1 > plain, "{shape:?}: heights cost triangles");
    }
}

#[test]
fn a_mesh_that_moves_is_displaced_in_every_pose() {
    let case = CASES.iter().find(|case| case.name == "moving").expect("a case of this name");
    let mut mesh = (case.mesh)();
    mesh.heights = Some(Arc::new(Heights::everywhere(&mesh, waves(32))));
    let (loaded, mut scene) = on_device(Shape::Cylinder, mesh);
    let rig = loaded.mesh.rig.clone().expect("a rig");
    let settings = Settings::from(Tessellation {
        displacement: Displacement::On,
        factor: 5.0,
        height_scale: 0.1,
        ..Tessellation::default()
    });
    let inputs = inputs(&loaded, &settings);
    let mut passes = Vec::new();
    for time in [0.3, 0.9, 1.6] {
        let pose = Arc::new(rig.pose(Moment { clip: 0, time }));
        scene.tessellator.set_pose(Some(pose.clone())).expect("a small rig");
        let gpu = on_gpu(&mut scene, &inputs);
        let (mesh, topology) = deform(&loaded.mesh, &loaded.topology, &pose);
        let cpu = tessellate(&mesh, &topology, &inputs, None);
        for (a, b) in gpu.vertices.iter().zip(&cpu.vertices) {
            let [p, q] = [a.position, b.position].map(glam::Vec3::from);
            assert!(p.distance(q) <= 2e-5, "{time} s: {p} {q}");
        }
        let cracks = engine().measure(&mut scene).expect("a readback").cracks;
        assert_eq!((cracks.different_bits, cracks.different_normals), (0, 0), "{time} s");
        let target = Target::new(&engine().gpu, [64, 64]).expect("a small picture");
        let camera = inspect::render::Camera::framing(&scene.bounds, target.viewport());
        let engine = crate::coverage::sifting(0.0);
        let view = camera.lod_view(target.viewport(), &scene.bounds);
        let times = engine.time(&mut scene, &target, &camera, view, &settings, Runs::default()).expect("a draw");
        passes = times.iter().map(|time| time.pass).collect();
    }
    // Least triangles are computed for an overlay alone.
    let wanted: Vec<_> = gpu::PASSES.into_iter().filter(|&pass| pass != "least").collect();
    assert_eq!(passes, wanted, "every other pass has something to do");
}

/// A torus in two halves of a material each, under these images; a row of edges between the halves twice.
fn halves(images: [&Arc<Texture>; 2]) -> (Loaded, Scene) {
    let mut mesh = Shape::Torus.build();
    let count = mesh.triangles.len() as u32;
    let half = |texture: &Arc<Texture>, triangles| Material {
        texture: Some(texture.clone()),
        triangles,
        ..mesh.materials[0].clone()
    };
    mesh.materials = vec![half(images[0], 0..count / 2), half(images[1], count / 2..count)];
    mesh.heights = Some(Arc::new(
        HeightSource::Materials
            .load(&mesh, &[], &mut Vec::new(), &Budget::unlimited(), &Progress::new())
            .expect("images"),
    ));
    on_device(Shape::Torus, mesh)
}

/// A torus in two halves of a material each, with images of their own or none.
fn halves_under(own: &[Option<HeightMap>; 2]) -> (Loaded, Scene) {
    parts_under(2, &[], own)
}

/// A torus in so many pieces of a material each, with parts of these numbers: first the materials and then the parts have images
/// of their own or none.
fn parts_under(materials: u32, parts: &[(Range<u32>, u32)], own: &[Option<HeightMap>]) -> (Loaded, Scene) {
    let mut mesh = Shape::Torus.build();
    let piece = mesh.triangles.len() as u32 / materials;
    let of = |first| Material { triangles: first * piece..(first + 1) * piece, ..mesh.materials[0].clone() };
    mesh.materials = (0..materials).map(of).collect();
    let range = |(triangles, part): &(Range<u32>, u32)| PartRange { triangles: triangles.clone(), part: *part };
    mesh.part_ranges = parts.iter().map(range).collect();
    let heights = Heights::of_materials(&mesh, own, &Progress::new()).expect("not cancelled").expect("few maps");
    mesh.heights = Some(Arc::new(heights));
    on_device(Shape::Torus, mesh)
}

/// Holds the device against the CPU, and checks that nothing cracks, in three ways to tessellate.
fn assert_without_cracks((loaded, scene): &mut (Loaded, Scene), what: &str) {
    let size = loaded.mesh.bounds().radius();
    for (lod, normals) in
        [(Lod::Uniform, Normals::Linear), (Lod::EdgeLength, Normals::Surface), (Lod::Error, Normals::Quadratic)]
    {
        let settings = Settings::from(Tessellation {
            displacement: Displacement::On,
            height_scale: 0.1,
            factor: 5.3,
            lod,
            normals,
            ..Tessellation::default()
        });
        let inputs = inputs(loaded, &settings);
        let gpu = on_gpu(scene, &inputs);
        // The device may compute factors in other last bits.
        let given = (lod != Lod::Uniform).then(|| edge_factors(scene));
        let cpu = tessellate(&loaded.mesh, &loaded.topology, &inputs, given.as_deref());
        let what = format!("{what} {lod:?} {normals:?}");
        assert!(gpu.patch_factors == cpu.patch_factors && gpu.vertices.len() == cpu.vertices.len(), "{what}");
        for (a, b) in gpu.vertices.iter().zip(&cpu.vertices) {
            let [p, q] = [a.position, b.position].map(glam::Vec3::from);
            assert!(p.distance(q) <= 1e-5 * size, "{what}: {p} {q}");
        }
        let measured = measured(scene, loaded, &settings);
        assert_eq!((measured.cracks.different_bits, measured.not_finite), (0, 0), "{what}");
    }
}

#[test]
fn materials_with_images_of_their_own_meet_without_cracks() {
    let amount = HeightAmount::from_factor(0.15, -0.05);
    let [deep, usual] = [waves(16).with_amount(amount), waves(64)];
    let same_pixels = usual.with_amount(amount);
    for own in [
        [Some(deep.clone()), Some(usual.clone())],
        [Some(usual.clone()), Some(same_pixels)],
        [Some(deep.clone()), None],
        [None, Some(usual)],
        [None, Some(deep)],
    ] {
        let amounts = own.each_ref().map(|map| map.as_ref().map(|map| map.amount));
        assert_without_cracks(&mut halves_under(&own), &format!("{amounts:?}"));
    }
}

#[test]
fn parts_with_images_of_their_own_meet_without_cracks_across_materials() {
    let amount = HeightAmount::from_factor(0.15, -0.05);
    let [deep, usual, fine] = [waves(16).with_amount(amount), waves(64), waves(32).with_amount(amount)].map(Some);
    // Both parts cross the materials' border at 128, and lie in several pieces.
    let parts = [(9..40, 0), (40..57, 1), (100..128, 0), (128..150, 0), (150..171, 1), (171..180, 2), (201..255, 1)];
    for own in [
        [usual.clone(), None, deep.clone(), fine.clone()],
        [None, fine, None, usual.clone()],
        [deep.clone(), usual.clone(), usual.clone(), None],
    ] {
        let amounts = own.each_ref().map(|map| map.as_ref().map(|map| map.amount));
        assert_without_cracks(&mut parts_under(2, &parts, &own), &format!("{amounts:?}"));
    }
    // Parts without materials of their own are displaced as materials are.
    let mut of_materials = halves_under(&[deep.clone(), usual.clone()]);
    let mut of_parts = parts_under(1, &[(0..128, 1), (128..256, 0)], &[None, usual, deep]);
    let displacement = Displacement::On;
    for lod in [Lod::Uniform, Lod::Error] {
        let settings = Settings::from(Tessellation { displacement, lod, ..Tessellation::default() });
        let [a, b] =
            [&mut of_materials, &mut of_parts].map(|(loaded, scene)| on_gpu(scene, &inputs(loaded, &settings)));
        let bits = |vertex: &Vertex| vertex.position.map(f32::to_bits);
        assert!(a.vertices.iter().map(bits).eq(b.vertices.iter().map(bits)), "{lod:?}");
        assert!(a.patch_factors == b.patch_factors, "{lod:?}");
    }
}

#[test]
fn an_amount_of_an_image_counts_as_that_of_the_settings_does() {
    let radius = Shape::Torus.build().bounds().radius();
    let own = waves(32).with_amount(Some(HeightAmount { scale: 0.05 * radius, midlevel: 0.25 }));
    let (said, mut of_settings) = halves_under(&[Some(waves(32)), Some(waves(32))]);
    let (_, mut of_image) = halves_under(&[Some(own.clone()), Some(own)]);
    for lod in [Lod::Uniform, Lod::Error] {
        let tessellation = |height_scale, midlevel| {
            let displacement = Displacement::On;
            let own = Tessellation { displacement, height_scale, midlevel, lod, ..Tessellation::default() };
            inputs(&said, &Settings::from(own))
        };
        let expected = on_gpu(&mut of_settings, &tessellation(0.05, 0.25));
        let made = on_gpu(&mut of_image, &tessellation(-0.7, 0.9));
        assert!(expected.patch_factors == made.patch_factors, "{lod:?}");
        let bits = |vertex: &Vertex| vertex.position.map(f32::to_bits);
        assert!(expected.vertices.iter().map(bits).eq(made.vertices.iter().map(bits)), "{lod:?}");
    }
}

#[test]
fn images_go_on_beyond_their_border_on_the_device_as_on_the_cpu() {
    let mut all = Vec::new();
    for wrap in [[Wrap::Clamp; 2], [Wrap::Mirror; 2], [Wrap::Repeat, Wrap::Clamp], [Wrap::Mirror, Wrap::Repeat]] {
        let mut mesh = Shape::Saddle.build();
        mesh.corners.iter_mut().for_each(|corner| corner.uv = corner.uv * 3.0 - 1.0);
        // Opposite borders differ.
        let ramp = HeightMap::new([16; 2], (0..256).map(|i| (i % 16 + 2 * (i / 16)) as f32 / 48.0).collect());
        mesh.heights = Some(Arc::new(Heights::everywhere(&mesh, ramp.with_wrap(wrap))));
        let (loaded, mut scene) = on_device(Shape::Saddle, mesh);
        let own =
            Tessellation { displacement: Displacement::On, height_scale: 0.1, factor: 7.0, ..Tessellation::default() };
        let inputs = inputs(&loaded, &Settings::from(own));
        let gpu = on_gpu(&mut scene, &inputs);
        let cpu = tessellate(&loaded.mesh, &loaded.topology, &inputs, None);
        assert_eq!(gpu.vertices.len(), cpu.vertices.len());
        for (a, b) in gpu.vertices.iter().zip(&cpu.vertices) {
            let [p, q] = [a.position, b.position].map(glam::Vec3::from);
            assert!(p.distance(q) <= 1e-5 * loaded.mesh.bounds().radius(), "{wrap:?}: {p} {q}");
        }
        all.push(gpu.vertices.iter().map(|vertex| vertex.position.map(f32::to_bits)).collect::<Vec<_>>());
    }
    assert!((0..4).all(|i| all[i + 1..].iter().all(|other| *other != all[i])), "each is another surface");
}

#[test]
fn maps_that_share_heights_are_on_the_device_once() {
    let own = waves(128);
    let bytes = |other: HeightMap| halves_under(&[Some(own.clone()), Some(other)]).1.tessellator.work_bytes();
    let one = bytes(own.clone());
    assert_eq!(bytes(own.with_amount(HeightAmount::from_factor(2.0, 0.0))), one);
    assert!(bytes(waves(128)) >= one + 4 * own.heights.len() as u64, "the same heights in two lists");
}

#[test]
fn lod_by_error_takes_the_amount_of_each_image() {
    let [deep, low] = [0.3, 0.02].map(|scale| waves(64).with_amount(HeightAmount::from_factor(scale, 0.0)));
    for own in [[&deep, &low], [&low, &deep]] {
        let (loaded, mut scene) = halves_under(&own.map(|map| Some(map.clone())));
        let settings = Settings::from(Tessellation {
            displacement: Displacement::On,
            lod: Lod::Error,
            tolerance: 2.0,
            ..Tessellation::default()
        });
        let inputs = inputs(&loaded, &settings);
        let device = on_gpu(&mut scene, &inputs);
        let host = tessellate(&loaded.mesh, &loaded.topology, &inputs, None);
        assert!(device.patch_factors == host.patch_factors, "CPU and GPU disagree");
        let halves = host.patch_factors.split_at(host.patch_factors.len() / 2);
        let [first, second] = [halves.0, halves.1]
            .map(|half: &[PatchFactors]| half.iter().map(|&own| u64::from(triangle_count(own))).sum::<u64>());
        assert_eq!(first > second, own[0] == &deep, "{first} and {second} triangles");
    }
}

#[test]
fn a_noisy_image_refines_its_own_patches_alone() {
    let image = |gray: &dyn Fn(u32) -> u32| {
        let rgba = (0..256 * 256).flat_map(|i| [gray(i) as u8, gray(i) as u8, gray(i) as u8, 255]).collect();
        Arc::new(Texture { size: [256, 256], rgba })
    };
    let slope = image(&|i| i % 256);
    let noise = image(&|i| if i < 256 { i } else { i.wrapping_mul(2_654_435_769) >> 24 });
    let own = Settings::from(Tessellation {
        displacement: Displacement::On,
        height_scale: 0.1,
        lod: Lod::Error,
        ..Tessellation::default()
    });
    for (surface, edges) in [(Surface::PnAen, Edges::PerEdge), (Surface::Flat, Edges::AsPublished)] {
        let settings = own.with(Tessellation { surface, edges, tolerance: 2.0, ..own.tessellation });
        let [(loaded, both), (_, smooth), (_, noisy)] =
            [[&noise, &slope], [&slope, &slope], [&noise, &noise]].map(|images| {
                let (loaded, mut scene) = halves(images);
                let inputs = inputs(&loaded, &settings);
                let device = on_gpu(&mut scene, &inputs);
                let host = tessellate(&loaded.mesh, &loaded.topology, &inputs, None);
                assert!(device.patch_factors == host.patch_factors, "{surface:?}: CPU and GPU disagree");
                (loaded, device.patch_factors)
            });
        let (mut alone, mut shared) = (0, 0);
        let (patches, half) = (&loaded.topology.patches, both.len() / 2);
        // Whether a patch has an edge with one of the other image.
        let is_beside_other = |index: usize| {
            let edge = |side: &u32| loaded.topology.sides[*side as usize].edge;
            let others = if index < half { &patches[half..] } else { &patches[..half] };
            let is_shared = |side| others.iter().flat_map(|patch| &patch.sides).any(|other| edge(other) == edge(side));
            patches[index].sides.iter().any(is_shared)
        };
        for index in half..both.len() {
            assert!(both[index].inside == smooth[index].inside, "{surface:?}: inside a patch of the smooth image");
            match is_beside_other(index) {
                true => shared += 1,
                false => alone += u32::from(both[index] == smooth[index]),
            }
        }
        assert_eq!(alone + shared, half as u32, "{surface:?}: as few as under the smooth image alone");
        assert!(
            shared > 0 && alone > 0,
            "{surface:?}: {shared} patches with an edge between materials, {alone} without"
        );
        for index in (0..half).filter(|index| !is_beside_other(*index)) {
            assert!(both[index] == noisy[index], "{surface:?}: as many as under the noisy image alone");
        }
        let triangles = |all: &[PatchFactors]| all.iter().map(|&own| u64::from(triangle_count(own))).sum::<u64>();
        let (noise_requests, slope_requests) = (triangles(&noisy), triangles(&smooth));
        assert!(noise_requests > 2 * slope_requests, "{surface:?}: {noise_requests} and {slope_requests}");
    }
}

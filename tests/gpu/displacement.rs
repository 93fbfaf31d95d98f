//! Displacement on the device: held against the CPU, watertight where it says so, torn where it says so, and in view.

mod cracks;
mod images;

use std::f32::consts::TAU;
use std::sync::Arc;

use geometry::mesh::{Corner, HeightMap, Heights, Mesh, Moment, Shape};
use geometry::tessellate::{
    Clip, Displacement, Edges, Lod, Normals, Partitioning, Surface, Tessellation, Vertex, deform, tessellate,
    unpack_normal,
};
use gpu::Timing;
use inspect::engine::{Loaded, Measurements, Runs};
use inspect::measure::Measured;
use inspect::render::{Scene, Target};
use inspect::settings::{ARENA_BYTES, Settings};
use lab::stability::CASES;
use load::Source;

use crate::passes::{inputs, on_gpu};
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

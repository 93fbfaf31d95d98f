//! LOD by error: what is emitted is within the tolerance of the surface, and not much finer.

use std::sync::Arc;

use geometry::mesh::mesh_builder::{InputCorner, MeshBuilder};
use geometry::mesh::{HeightMap, Heights, Material, Mesh, Shape, Topology};
use geometry::progress::Progress;
use geometry::tessellate::{
    self, Convention, Displacement, Edges, HullFactors, Inputs, Lod, Partitioning, Surface, Tessellated, Tessellation,
    hull_factors, minimum_triangles, tessellate,
};
use glam::{Vec2, Vec3, vec3};
use gpu::{ComputePipelines, Timing, take_times};
use inspect::engine::{Loaded, Preparation, load};
use inspect::measure::{EmittedChunk, ScreenErrorMeasurement, Visitor};
use inspect::render::{Camera, Scene, Target};
use inspect::settings::{ARENA_BYTES, Colors, Overlays, Settings};
use load::Source;
use proptest::prelude::*;

use crate::displacement::{shifted_torus, waves, wavy};
use crate::passes::edge_factors;
use crate::stability::{Trial, any_trial, soups};
use crate::{engine, loaded, scene};

const VIEWPORT: Vec2 = glam::vec2(320.0, 240.0);

/// Whether anything requests more segments than there are, so that no promise is made.
fn is_capped(written: &[HullFactors], partitioning: Partitioning) -> bool {
    written.iter().any(|factors| factors.is_capped(partitioning))
}

fn deviation_px(mesh: &Mesh, topology: &Topology, inputs: &Inputs, out: &Tessellated) -> f64 {
    let mut measurement = ScreenErrorMeasurement::new(mesh, topology, inputs, out.triangles.len() as u64);
    measurement.take(&EmittedChunk::whole(&out.vertices, &out.triangles));
    measurement.worst().map_or(0.0, |worst| worst.value)
}

/// What rounding adds to a distance in px: emitted positions are off by a few units in the last place of coordinates
/// about as large as the distance to the eye.
fn rounding_px(mesh: &Mesh, inputs: &Inputs) -> f64 {
    let bounds = mesh.bounds();
    let largest = bounds.min.abs().max(bounds.max.abs()).max_element();
    few_px(f64::from(largest) * f64::from(f32::EPSILON), inputs)
}

/// What a device adds to that in meshes of 1e-36 object units: it may take numbers below the least normal one for zero (WGSL,
/// "Floating Point Evaluation"), which there is a hundredth of the mesh. The CPU doesn't.
fn flushing_px(inputs: &Inputs) -> f64 {
    few_px(f64::from(f32::MIN_POSITIVE), inputs)
}

/// A few times a distance in object units, in px where these are largest.
fn few_px(distance: f64, inputs: &Inputs) -> f64 {
    let clip = inputs.view.clip_from_object;
    let a_unit = clip.row(0).truncate().as_dvec3().length() * f64::from(inputs.view.half_viewport.x);
    // Nothing is nearer than the near plane; orthographic views have w = 1.
    let perspective = clip.row(3).truncate() != glam::Vec3::ZERO;
    let depth = if perspective { f64::from(clip.w_axis.z.abs().max(f32::MIN_POSITIVE)) } else { 1.0 };
    16.0 * distance * a_unit / depth
}

/// Meshes under images of every kind: gentle waves, these in steps of 8 bits, noise, terraces, an image that repeats, seams over which heights
/// agree, and seams over which they don't. And which modes of displacement have one surface there.
fn displaced(asset: usize) -> (Mesh, &'static [Displacement]) {
    let size = 128;
    let waves = waves(size);
    let height = |i: u32| {
        let wave = waves.heights[i as usize];
        match asset {
            0 | 5..8 => wave,
            1 | 4 => (255.0 * wave).round() / 255.0,
            2 => (i.wrapping_mul(2_654_435_769) >> 24) as f32 / 255.0,
            _ => (6.0 * wave).floor() / 6.0,
        }
    };
    let mut mesh = match asset {
        0..5 => Shape::Saddle.build(),
        5 => Shape::Icosphere.build(),
        6 => Shape::Torus.build(),
        _ => shifted_torus(),
    };
    mesh.corners.iter_mut().for_each(|corner| corner.uv *= if asset == 4 { 3.0 } else { 1.0 });
    let map = HeightMap::new([size, size], (0..size * size).map(height).collect());
    mesh.heights = Some(Arc::new(Heights::everywhere(&mesh, map)));
    let one_triangle = matches!(asset, 5..8);
    (mesh, if one_triangle { &[Displacement::PerPatch] } else { &[Displacement::On, Displacement::AsPublished] })
}

/// The displaced assets, and cameras around and close to them.
fn displaced_trial() -> impl Strategy<Value = (Trial, f32)> {
    let camera = (0.7f32..4.0, -180f32..180.0, -80f32..80.0, any::<bool>());
    let own = (0usize..8, 0usize..8, -0.1f32..0.1, -0.5f32..1.0, 0usize..5);
    (own, camera).prop_map(|((asset, choice, scale, magnitude, partitioning), camera)| {
        let (mesh, modes) = displaced(asset);
        let (distance, azimuth, elevation, orthographic) = camera;
        let far = Camera::framing(&mesh.bounds(), VIEWPORT);
        let camera = Camera { distance: distance * mesh.bounds().radius(), azimuth, elevation, orthographic, ..far };
        let settings = Settings::from(Tessellation {
            surface: Surface::ALL[choice % Surface::ALL.len()],
            displacement: modes[choice % modes.len()],
            height_scale: scale,
            partitioning: [
                Partitioning::Integer,
                Partitioning::Pow2,
                Partitioning::FractionalOdd,
                Partitioning::FractionalEven,
                Partitioning::Rows,
            ][partitioning],
            ..Tessellation::default()
        });
        (Trial { mesh, settings, camera }, 10f32.powf(magnitude))
    })
}

fn by_error(settings: Settings, tolerance: f32) -> Settings {
    settings.with(Tessellation { lod: Lod::Error, tolerance, ..settings.tessellation })
}

/// Tessellates a soup by error, here or on the device, and checks the promise.
fn keeps_its_promise(trial: Trial, tolerance: f32, on_device: bool) -> Result<(), TestCaseError> {
    let Trial { mesh, settings, camera } = trial;
    let topology = Topology::build(&mesh, &Progress::default()).expect("nobody cancels");
    let settings = by_error(settings, tolerance);
    // Subtriangulation keeps no tolerance.
    prop_assume!(settings.tessellation.used_lod() == Lod::Error);
    let inputs = settings.inputs(camera.lod_view(VIEWPORT, &mesh.bounds()));
    // An eye nearer than f32 can tell has no view.
    prop_assume!(inputs.view.clip_from_object.is_finite());
    let (mesh, topology) = (Arc::new(mesh), Arc::new(topology));
    let (out, written) = if on_device {
        let mut scene = engine().scene_of(mesh.clone(), topology.clone(), ARENA_BYTES).expect("a small mesh");
        engine().count(&mut scene, &inputs, &mut Timing::Off).expect("counts");
        let out = engine().read_tessellated(&mut scene).expect("a readback");
        (out, scene.tessellator.hull_factors().expect("a readback"))
    } else {
        (tessellate(&mesh, &topology, &inputs, None), hull_factors(&mesh, &topology, &inputs))
    };
    // Of more triangles all would take too long.
    prop_assume!(out.triangles.len() < 60_000);
    if !is_capped(&written, settings.tessellation.partitioning) {
        let px = deviation_px(&mesh, &topology, &inputs, &out);
        let flushed = if on_device { flushing_px(&inputs) } else { 0.0 };
        let most = f64::from(tolerance) + rounding_px(&mesh, &inputs) + flushed;
        prop_assert!(px <= most, "{px} px of {tolerance} under {settings:?}");
    }
    Ok(())
}

proptest! {
    #![proptest_config(soups(2000))]
    #[test]
    fn any_soup_is_within_the_tolerance(trial in any_trial(), magnitude in -1.0f32..1.5) {
        keeps_its_promise(trial, 10f32.powf(magnitude), false)?;
    }
}

proptest! {
    #![proptest_config(soups(200))]
    #[test]
    fn any_soup_is_within_the_tolerance_on_the_device(trial in any_trial(), magnitude in -1.0f32..1.5) {
        keeps_its_promise(trial, 10f32.powf(magnitude), true)?;
    }
}

proptest! {
    #![proptest_config(soups(30))]
    #[test]
    fn anything_displaced_is_within_the_tolerance((trial, tolerance) in displaced_trial()) {
        keeps_its_promise(trial, tolerance, false)?;
    }
}

/// Tessellates on the device; counts, then what was requested.
fn on_device(scene: &mut Scene, settings: &Settings, camera: &Camera) -> (Inputs, Tessellated) {
    let inputs = settings.inputs(camera.lod_view(VIEWPORT, &scene.bounds));
    engine().count(scene, &inputs, &mut Timing::Off).expect("counts");
    let out = engine().read_tessellated(scene).expect("a readback");
    (inputs, out)
}

/// Around a shape: all of it, close to it, without perspective.
fn cameras(scene: &Scene) -> [Camera; 4] {
    let far = Camera::framing(&scene.bounds, VIEWPORT);
    let close = Camera { distance: 1.4 * scene.bounds.radius(), azimuth: 75.0, ..far };
    [far, close, Camera { orthographic: true, ..far }, Camera { elevation: -60.0, azimuth: 200.0, ..close }]
}

/// The surface that a shape is tried with under the camera of this index, so that all are tried.
fn surface_of(index: usize, shape: Shape) -> Surface {
    Surface::ALL[(2 * index + shape as usize) % Surface::ALL.len()]
}

#[test]
fn shapes_on_the_device_are_within_the_tolerance_and_not_far_below() {
    let (mut closest, mut tried) = (0.0f64, Vec::new());
    for shape in Shape::ALL {
        let (loaded, mut scene) = scene(shape);
        for (index, camera) in cameras(&scene).into_iter().enumerate() {
            // Strict and lax for each.
            let surface = surface_of(index, shape);
            let tolerance = if index % 2 == 0 { 0.5 } else { 2.0 };
            let partitioning = Partitioning::DIRECT3D[(index + shape as usize) % 4];
            let settings =
                by_error(Settings::from(Tessellation { surface, partitioning, ..Tessellation::default() }), tolerance);
            let (inputs, out) = on_device(&mut scene, &settings, &camera);
            if is_capped(&scene.tessellator.hull_factors().expect("a readback"), inputs.tessellation.partitioning) {
                continue;
            }
            let px = deviation_px(&loaded.mesh, &loaded.topology, &inputs, &out);
            let share = px / (f64::from(tolerance) + rounding_px(&loaded.mesh, &inputs));
            assert!(share <= 1.0, "{shape:?} {surface:?} {partitioning:?}, camera {index}: {px} px of {tolerance}");
            closest = closest.max(share);
            tried.push(surface);
        }
    }
    assert!(tried.len() > 25 && closest > 0.6, "{} tried, {closest} of the tolerance used at best", tried.len());
    assert!(Surface::ALL.iter().all(|surface| tried.contains(surface)), "{tried:?}");
}

/// How much of the tolerance, at most, rounding may make of a bound: its differences, divisions and roots are each good to a
/// few units in the last place.
const ROUNDING: f32 = 1e-4;

/// Whether two factors of an edge are the same: levels exactly; beyond the last, where they are requested as they are, but
/// for rounding.
fn agrees(device: f32, here: f32) -> bool {
    device == here || (device > 64.0 && here > 64.0 && (device - here).abs() <= ROUNDING * here)
}

#[test]
fn the_device_takes_the_factors_that_the_cpu_does() {
    let (mut same, mut all) = (0, 0);
    for shape in Shape::ALL {
        let (loaded, mut scene) = scene(shape);
        for (camera, partitioning) in cameras(&scene).into_iter().zip(Partitioning::DIRECT3D) {
            let settings = by_error(Settings::from(Tessellation { partitioning, ..Tessellation::default() }), 0.5);
            let (inputs, out) = on_device(&mut scene, &settings, &camera);
            // Where a bound falls on a level to the last bits, either level may be taken: that is the one of a tolerance
            // that differs by no more than rounding.
            let own = inputs.tessellation;
            let near = [1.0, 1.0 - ROUNDING, 1.0 + ROUNDING]
                .map(|part| Inputs { tessellation: Tessellation { tolerance: own.tolerance * part, ..own }, ..inputs });
            let what = format!("{shape:?} {partitioning:?}");
            let on_edges = edge_factors(&scene);
            let edges = near.each_ref().map(|inputs| tessellate::edge_factors(&loaded.mesh, &loaded.topology, inputs));
            for (edge, &factor) in on_edges.iter().enumerate() {
                let known = edges.each_ref().map(|factors| factors[edge]);
                assert!(
                    known.iter().any(|&known| agrees(factor, known)),
                    "{what}, edge {edge}: {factor}, not {known:?}"
                );
            }
            // Insides depend on the factors of edges, so patches are compared at those of the device, too.
            let tessellated = |inputs: &Inputs, factors: Option<&[f32]>| {
                tessellate::tessellate(&loaded.mesh, &loaded.topology, inputs, factors).patch_factors
            };
            let own = near.each_ref().map(|inputs| tessellated(inputs, None));
            let beside = near.each_ref().map(|inputs| tessellated(inputs, Some(&on_edges)));
            for (patch, factors) in out.patch_factors.iter().enumerate() {
                let known = [&own, &beside].map(|patches| patches.each_ref().map(|patches| patches[patch]));
                assert!(known.as_flattened().contains(factors), "{what}, patch {patch}: {factors:?}, not {known:?}");
                same += usize::from(known[0][0] == *factors);
                all += 1;
            }
        }
    }
    // Another device may round a bound to the other side of a tolerance.
    assert!(all > 1000 && same * 1000 >= all * 995, "{same} of {all} patches agree without any allowance");
}

/// GPUs search in larger groups than the software driver does.
#[test]
fn the_size_of_a_group_changes_no_factor() {
    let engines = [32, 128].map(|size| {
        let mut engine = engine().clone();
        engine.pipelines = Arc::new(ComputePipelines::in_groups([size; 3]));
        (size, engine)
    });
    for shape in [Shape::Torus, Shape::CubeSmooth, Shape::Cone] {
        let (loaded, mut usual) = scene(shape);
        let camera = cameras(&usual)[1];
        let settings = by_error(Settings::default(), 0.25);
        let (_, out) = on_device(&mut usual, &settings, &camera);
        let (minimum, edges) = (engine().minimum(&mut usual).expect("a readback"), edge_factors(&usual));
        for (size, engine) in &engines {
            let mut scene = engine.scene(&loaded, ARENA_BYTES).expect("shapes are small");
            let (_, other) = on_device(&mut scene, &settings, &camera);
            assert_eq!(edge_factors(&scene), edges, "{shape:?}, groups of {size}");
            assert_eq!(other.patch_factors, out.patch_factors, "{shape:?}, groups of {size}");
            assert_eq!(engine.minimum(&mut scene).expect("a readback"), minimum, "{shape:?}, groups of {size}");
        }
    }
}

/// Such a mesh has fewer edges than the search has counters, which start anew for every view.
#[test]
fn one_triangle_is_searched_anew_for_every_view() {
    let whole = loaded(Shape::Icosahedron);
    let mesh = Mesh { triangles: Arc::new(whole.mesh.triangles[..1].to_vec()), ..Mesh::clone(&whole.mesh) };
    let topology = Topology::build(&mesh, &Progress::default()).expect("nobody cancels");
    let loaded = Loaded { mesh: Arc::new(mesh), topology: Arc::new(topology), ..whole };
    let new = || engine().scene(&loaded, ARENA_BYTES).expect("one triangle is small");
    let mut scene = new();
    let settings = by_error(Settings::default(), 0.5);
    let [first, second, ..] = cameras(&scene);
    for camera in [first, second, first] {
        let (_, out) = on_device(&mut scene, &settings, &camera);
        let (_, known) = on_device(&mut new(), &settings, &camera);
        assert!(out.triangles.len() > 1, "it is curved");
        assert_eq!(out.patch_factors, known.patch_factors);
    }
}

/// How far from the surface a shape under this LOD by error is, and whether it requests more segments than there are. It is seen whole
/// in a small picture.
fn reached(shape: Shape, partitioning: Partitioning, tolerance: f32) -> (f64, bool, Tessellated) {
    let (loaded, mut scene) = scene(shape);
    let viewport = glam::vec2(160.0, 120.0);
    let settings = by_error(Settings::from(Tessellation { partitioning, ..Tessellation::default() }), tolerance);
    let inputs = settings.inputs(Camera::framing(&scene.bounds, viewport).lod_view(viewport, &scene.bounds));
    engine().count(&mut scene, &inputs, &mut Timing::Off).expect("counts");
    let out = engine().read_tessellated(&mut scene).expect("a readback");
    let capped = engine().factors_capped(&scene, &inputs.tessellation).expect("a readback");
    (deviation_px(&loaded.mesh, &loaded.topology, &inputs, &out), capped > 0, out)
}

#[test]
fn patches_that_need_very_many_triangles_get_them() {
    for partitioning in [Partitioning::Integer, Partitioning::Rows] {
        for tolerance in [0.025, 0.03, 0.04] {
            let (px, is_capped, _) = reached(Shape::CubeSmooth, partitioning, tolerance as f32);
            assert!(px <= tolerance && !is_capped, "{partitioning:?}: {px} of {tolerance} px");
        }
    }
    // Beside what their neighbours ask for some patches have no rows that are enough, and ask again.
    let (_, is_capped, out) = reached(Shape::Torus, Partitioning::Rows, 0.038);
    assert!(!is_capped && out.triangles.len() < 13_500, "{}", out.triangles.len());
}

/// Some drivers end the loops of an invocation after so many turns, which no workgroup may need.
#[test]
fn a_mesh_of_many_patches_is_searched_to_its_end() {
    let fine = Source::FineShape(Shape::Torus, 3);
    let loaded = load(&fine, &Preparation::default(), &Progress::default()).expect("shapes always load");
    let mut scene = engine().scene(&loaded, ARENA_BYTES).expect("it isn't that large");
    let camera = Camera::framing(&scene.bounds, VIEWPORT);
    let settings =
        by_error(Settings::from(Tessellation { partitioning: Partitioning::Integer, ..Tessellation::default() }), 0.01);
    let inputs = settings.inputs(camera.lod_view(VIEWPORT, &scene.bounds));
    engine().count(&mut scene, &inputs, &mut Timing::Off).expect("counts");
    let here = tessellate::edge_factors(&loaded.mesh, &loaded.topology, &inputs);
    let differing = edge_factors(&scene).iter().zip(&here).filter(|(device, here)| device != here).count();
    assert_eq!(differing, 0, "of {} edges", here.len());
    assert!(here.iter().filter(|&&factor| factor > 1.0).count() > 1000, "many patches are searched");
}

#[test]
fn rows_on_the_device_are_within_the_tolerance_and_fewer_than_rings() {
    let (mut closest, mut rows, mut rings, mut tried) = (0.0f64, 0, 0, Vec::new());
    for shape in Shape::ALL {
        let (loaded, mut scene) = scene(shape);
        for (index, camera) in cameras(&scene).into_iter().enumerate() {
            let surface = surface_of(index, shape);
            let tolerance = if index % 2 == 0 { 0.5 } else { 2.0 };
            let with = |partitioning| {
                by_error(Settings::from(Tessellation { surface, partitioning, ..Tessellation::default() }), tolerance)
            };
            let triangles = on_device(&mut scene, &with(Partitioning::Integer), &camera).1.triangles.len();
            let (inputs, out) = on_device(&mut scene, &with(Partitioning::Rows), &camera);
            let what = format!("{shape:?} {surface:?}, camera {index}");
            if is_capped(&scene.tessellator.hull_factors().expect("a readback"), inputs.tessellation.partitioning) {
                continue;
            }
            let px = deviation_px(&loaded.mesh, &loaded.topology, &inputs, &out);
            let share = px / (f64::from(tolerance) + rounding_px(&loaded.mesh, &inputs));
            assert!(share <= 1.0, "{what}: {px} px of {tolerance}");
            assert!(out.triangles.len() <= triangles, "{what}: {} of {triangles}", out.triangles.len());
            let here = tessellate(&loaded.mesh, &loaded.topology, &inputs, None);
            let differing = here.patch_factors.iter().zip(&out.patch_factors).filter(|(here, there)| here != there);
            assert_eq!(differing.count(), 0, "{what}: patches whose factors differ from the CPU's");
            let cracks = engine().measure(&mut scene).expect("a readback").cracks;
            let torn = if surface.tears() { cracks.different_bits } else { 0 };
            assert_eq!(cracks.different_bits + cracks.different_factors, torn, "{what}");
            closest = closest.max(share);
            rows += out.triangles.len();
            rings += triangles;
            tried.push(surface);
        }
    }
    assert!(Surface::ALL.iter().all(|surface| tried.contains(surface)), "{tried:?}");
    assert!(closest > 0.9, "some tolerance is nearly used up: {closest}");
    assert!(rows as f64 <= 0.6 * rings as f64, "{rows} triangles of rows, {rings} of rings");
}

/// Few similar patches, which together request more triangles than one factor for all edges takes. Without that choice not all edges
/// would have the same factor.
#[test]
fn the_device_takes_one_factor_for_all_edges_where_the_cpu_does() {
    let tried = [
        (Shape::CubeSmooth, Surface::NagataAen, Partitioning::FractionalEven, 0.5, 2),
        (Shape::CubeSplit, Surface::PhongAen, Partitioning::FractionalEven, 0.1, 0),
        (Shape::Icosahedron, Surface::NagataAen, Partitioning::FractionalOdd, 0.1, 0),
    ];
    for (shape, surface, partitioning, tolerance, camera) in tried {
        let (loaded, mut scene) = scene(shape);
        let camera = cameras(&scene)[camera];
        let settings = Settings::from(Tessellation { surface, partitioning, ..Tessellation::default() });
        let (inputs, out) = on_device(&mut scene, &by_error(settings, tolerance), &camera);
        let what = format!("{shape:?} {surface:?} {partitioning:?}");
        let factors = edge_factors(&scene);
        assert!(factors.iter().all(|&factor| factor == factors[0]), "{what}: {factors:?}");
        assert_eq!(factors, tessellate::edge_factors(&loaded.mesh, &loaded.topology, &inputs), "{what}");
        let here = tessellate(&loaded.mesh, &loaded.topology, &inputs, None);
        assert_eq!(out.patch_factors, here.patch_factors, "{what}");
    }
}

#[test]
fn what_is_flat_costs_one_triangle_a_patch() {
    for (shape, surface) in [(Shape::Torus, Surface::Flat), (Shape::Icosahedron, Surface::Flat)] {
        let (loaded, mut scene) = scene(shape);
        for partitioning in [Partitioning::Integer, Partitioning::Pow2, Partitioning::FractionalOdd] {
            let settings =
                by_error(Settings::from(Tessellation { surface, partitioning, ..Tessellation::default() }), 0.01);
            let [camera, ..] = cameras(&scene);
            let (_, out) = on_device(&mut scene, &settings, &camera);
            assert_eq!(out.triangles.len(), loaded.mesh.triangles.len(), "{shape:?} {partitioning:?}");
        }
    }
}

#[test]
fn the_device_finds_the_own_least_that_the_cpu_does() {
    let (torus, mut plain) = scene(Shape::Torus);
    let (waved, mut displaced) = wavy(Shape::Torus);
    let [camera, close, ..] = cameras(&plain);
    let base = Tessellation { tolerance: 0.5, ..Tessellation::default() };
    let on = Displacement::On;
    let tried = [
        Tessellation { lod: Lod::Error, partitioning: Partitioning::Integer, ..base },
        Tessellation { lod: Lod::Uniform, partitioning: Partitioning::Subtriangulation, ..base },
        Tessellation { lod: Lod::Paper, surface: Surface::Pn, ..base },
        Tessellation {
            lod: Lod::EdgeLength,
            partitioning: Partitioning::Pow2,
            convention: Convention::EdgeOrder,
            ..base
        },
        Tessellation { lod: Lod::Uniform, surface: Surface::Flat, partitioning: Partitioning::FractionalEven, ..base },
        Tessellation { lod: Lod::Distance, edges: Edges::AsPublished, partitioning: Partitioning::Integer, ..base },
        Tessellation { lod: Lod::Uniform, displacement: on, partitioning: Partitioning::Integer, ..base },
        Tessellation { lod: Lod::Error, displacement: on, surface: Surface::Flat, ..base },
    ];
    let (mut same, mut all) = (0, 0);
    for tessellation in tried {
        let is_displaced = tessellation.displacement == on;
        let (loaded, scene) = if is_displaced { (&waved, &mut displaced) } else { (&torus, &mut plain) };
        for camera in [camera, close] {
            let settings = Settings::from(tessellation);
            let inputs = settings.inputs(camera.lod_view(VIEWPORT, &scene.bounds));
            engine().count(scene, &inputs, &mut Timing::Off).expect("counts");
            let least = engine().minimum(scene).expect("a readback");
            let near = [1.0, 1.0 - ROUNDING, 1.0 + ROUNDING].map(|part| {
                let own = Tessellation { tolerance: tessellation.tolerance * part, ..inputs.tessellation };
                minimum_triangles(&loaded.mesh, &loaded.topology, &Inputs { tessellation: own, ..inputs })
            });
            assert_eq!(least.len(), loaded.topology.patches.len());
            for (patch, own) in least.iter().enumerate() {
                let known = near.each_ref().map(|near| near[patch]);
                assert!(known.contains(own), "{tessellation:?}, patch {patch}: {own}, not {known:?}");
                same += usize::from(known[0] == *own);
                all += 1;
            }
            assert!(is_displaced || least.iter().any(|own| *own != least[0]) || tessellation.surface == Surface::Flat);
        }
    }
    println!("{same} of {all} patches agree without any allowance");
    assert!(all > 3000, "{all} patches");
}

#[test]
fn the_own_least_is_computed_only_if_it_is_shown_and_something_has_changed() {
    let (_, mut scene) = scene(Shape::Torus);
    let target = Target::new(&engine().gpu, [64, 64]).expect("a small picture");
    let mut timing = Timing::Submissions(Vec::new());
    let mut ran = |settings: &Settings, camera: &Camera| {
        engine().draw(&mut scene, &target, camera, settings, &mut timing).expect("a draw");
        take_times(&engine().gpu, &mut timing).iter().any(|time| time.pass == "least")
    };
    let camera = Camera::framing(&Shape::Torus.build().bounds(), target.viewport());
    let plain = Settings::default();
    let shown = Settings { overlays: Overlays { colors: Colors::Excess, ..Overlays::default() }, ..plain };
    assert!(!ran(&plain, &camera), "it isn't shown");
    assert!(ran(&shown, &camera));
    assert!(!ran(&shown, &camera), "nothing has changed");
    let finer = shown.with(Tessellation { factor: 12.0, ..shown.tessellation });
    assert!(!ran(&finer, &camera), "it doesn't depend on the factors that are used");
    assert!(ran(&shown.with(Tessellation { tolerance: 2.0, ..shown.tessellation }), &camera));
    assert!(ran(&shown, &Camera { azimuth: 80.0, ..camera }), "another view");
    assert!(ran(&shown.with(Tessellation { surface: Surface::Pn, ..shown.tessellation }), &camera));
}

#[test]
fn lod_by_error_needs_fewer_triangles_for_the_error_that_another_lod_has() {
    let (_, mut scene) = scene(Shape::Torus);
    let [camera, ..] = cameras(&scene);
    let uniform = Settings::from(Tessellation { partitioning: Partitioning::Integer, ..Tessellation::default() });
    let inputs = uniform.inputs(camera.lod_view(VIEWPORT, &scene.bounds));
    let count = |scene: &mut Scene, inputs: &Inputs| {
        engine().count(scene, inputs, &mut Timing::Off).expect("counts");
        scene.tessellator.totals().1
    };
    let all = count(&mut scene, &inputs);
    let by_error = by_error(uniform, 0.5).inputs(inputs.view);
    let expected = count(&mut scene, &by_error);
    assert_eq!(count(&mut scene, &inputs), all);
    let compared =
        |scene: &mut Scene, inputs: &Inputs, px| engine().triangles_by_error(scene, inputs, px).expect("counts");
    assert_eq!(compared(&mut scene, &inputs, 0.5), Some(expected));
    assert_eq!(scene.tessellator.totals().1, all, "the scene is counted as before");
    assert_eq!(compared(&mut scene, &by_error, 0.5), Some(expected), "with itself");
    assert_eq!(compared(&mut scene, &inputs, 1e-5), None, "64 segments aren't enough");
    let whole = Tessellation { partitioning: Partitioning::Subtriangulation, ..inputs.tessellation };
    assert_eq!(compared(&mut scene, &Inputs { tessellation: whole, ..inputs }, 0.5), Some(expected));
    let given = vec![HullFactors { edges: [3.0; 3], inside: 3.0 }; scene.tessellator.topology().patches.len()];
    scene.tessellator.give(Some(given.clone().into())).expect("small");
    let of_given = count(&mut scene, &inputs);
    assert_eq!(compared(&mut scene, &inputs, 0.5), Some(expected));
    assert_eq!((scene.tessellator.given(), scene.tessellator.totals().1), (Some(&given.into()), of_given));
}

/// A mesh of pairs of triangles, one of which takes a pattern of thousands; its camera, and the settings for it.
fn long_searches(copies: u8, tolerance: f32) -> (Mesh, Camera, Settings) {
    let [top, tip] = [vec3(0.600_907, 0.657_626, 0.856_523), vec3(-0.520_539, 0.799_133, 0.300_708)];
    let tilted = vec3(-0.818_629, 0.0, 0.574_322);
    let soup = [
        [(top, vec3(-0.816_866, 0.125_852, 0.562_93)), (vec3(-1.0, 0.0, -0.167_072), tip), (vec3(-0.9, 0.0, 0.0), tip)],
        [(Vec3::ZERO, tilted), (vec3(0.0, -0.619506, 0.0), tilted), (top, Vec3::X)],
    ];
    let mut builder = MeshBuilder::new();
    let material = builder.material(Material::plain("pairs", [0.6, 0.6, 0.6, 1.0]));
    for (copy, corners) in (0..copies).flat_map(|copy| soup.map(|corners| (copy, corners))) {
        // Corners with other texture coordinates are others.
        let corner = |(position, normal)| InputCorner { position, normal: Some(normal), uv: Vec2::splat(copy.into()) };
        builder.triangle(material, corners.map(corner));
    }
    let mesh = builder.finish("pairs".to_owned(), &Progress::default()).expect("nobody cancels");
    let (target, distance) = (vec3(0.107_375, 0.031_104, 1.386_106), 0.605_353);
    let far = Camera::framing(&mesh.bounds(), VIEWPORT);
    let camera = Camera { target, azimuth: 309.469, elevation: -49.886, distance, orthographic: true, ..far };
    let (surface, partitioning) = (Surface::Nagata, Partitioning::Integer);
    let settings = Settings::from(Tessellation { surface, partitioning, ..Tessellation::default() });
    (mesh, camera, by_error(settings, tolerance))
}

#[test]
fn long_searches_end_on_a_driver_that_limits_loops() {
    // More patches than are searched by whole workgroups may find nothing in time, and then have the largest factors.
    for (copies, tolerance) in [(1, 0.3), (1, 0.2), (1, 0.1), (70, 0.3), (70, 0.1)] {
        let (mesh, camera, settings) = long_searches(copies, tolerance);
        let topology = Topology::build(&mesh, &Progress::default()).expect("nobody cancels");
        let inputs = settings.inputs(camera.lod_view(VIEWPORT, &mesh.bounds()));
        let (mesh, topology) = (Arc::new(mesh), Arc::new(topology));
        let mut scene = engine().scene_of(mesh.clone(), topology.clone(), ARENA_BYTES).expect("a small mesh");
        engine().count(&mut scene, &inputs, &mut Timing::Off).expect("counts");
        let (own, expected) =
            (scene.tessellator.hull_factors().expect("a readback"), hull_factors(&mesh, &topology, &inputs));
        for (own, expected) in own.iter().zip(&expected) {
            let is_finest = copies > 1 && own.edges == [64.0; 3];
            assert!(own == expected || is_finest, "{copies} of {tolerance} px: {own:?}, not {expected:?}");
        }
    }
}

#[test]
fn what_needs_more_segments_than_there_are_comes_as_close_as_it_can() {
    for partitioning in [Partitioning::Integer, Partitioning::Pow2, Partitioning::FractionalOdd] {
        let (mesh, camera, settings) = long_searches(1, 0.03);
        let settings = settings.with(Tessellation { partitioning, ..settings.tessellation });
        let topology = Topology::build(&mesh, &Progress::default()).expect("nobody cancels");
        let inputs = settings.inputs(camera.lod_view(VIEWPORT, &mesh.bounds()));
        assert!(is_capped(&hull_factors(&mesh, &topology, &inputs), partitioning));
        let (mesh, topology) = (Arc::new(mesh), Arc::new(topology));
        let mut scene = engine().scene_of(mesh.clone(), topology.clone(), ARENA_BYTES).expect("a small mesh");
        engine().count(&mut scene, &inputs, &mut Timing::Off).expect("counts");
        let on_device = engine().read_tessellated(&mut scene).expect("a readback");
        for out in [on_device, tessellate(&mesh, &topology, &inputs, None)] {
            let px = deviation_px(&mesh, &topology, &inputs, &out);
            assert!(px < 0.3, "{px} px under {partitioning:?} {:?}", scene.tessellator.hull_factors());
        }
    }
}

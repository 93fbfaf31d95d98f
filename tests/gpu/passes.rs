//! The passes, held against the CPU's reference and against themselves.

use geometry::mesh::{Corner, EdgeKind, Material, Mesh, Shape};
use geometry::tessellate::{
    Clip, Edges, Inputs, Lod, Normals, Partitioning, Surface, Tessellated, Tessellation, beyond_near, patch_is_culled,
    point_count, process, tessellate, totals, triangle_count, unpack_normal,
};
use geometry::view::{ScreenView, ulp};
use gpu::{Timing, take_times};
use inspect::engine::{Loaded, Measurements, Runs};
use inspect::measure::{EmittedChunk, Measured, Sizes, Visitor};
use inspect::render::{Camera, Scene, Target};
use inspect::settings::Settings;
use load::Source;

use crate::coverage::sifting;
use crate::{engine, loaded, loaded_mesh, picture, scene};
use gpu::chunks_an_arena;

/// Width and height in px.
const VIEWPORT: glam::Vec2 = glam::vec2(640.0, 480.0);

const SURFACES: [Surface; Surface::ALL.len()] = Surface::ALL;

/// The passes of a mesh that is neither deformed nor displaced.
pub(super) const RIGID_PASSES: [&str; 7] = ["nets", "factors", "counts", "scan", "chunks", "emit", "draw"];

const NORMALS: [Normals; 3] = [Normals::Linear, Normals::Quadratic, Normals::Surface];

pub(super) fn inputs(loaded: &Loaded, settings: &Settings) -> Inputs {
    let bounds = loaded.mesh.bounds();
    settings.inputs(Camera::framing(&bounds, VIEWPORT).lod_view(VIEWPORT, &bounds))
}

pub(super) fn on_gpu(scene: &mut Scene, inputs: &Inputs) -> Tessellated {
    engine().count(scene, inputs, &mut Timing::Off).expect("counts");
    engine().read_tessellated(scene).expect("a readback")
}

/// The factors that the GPU gave the edges.
pub(super) fn edge_factors(scene: &Scene) -> Vec<f32> {
    engine().requested_factors(scene).expect("a readback").into_factors()
}

/// Same domain points and triangles in the same order, positions within 4 ULP of the largest coordinate: what is left
/// after sums of up to ten products that one side may fuse and the other not.
pub(super) fn assert_agree(loaded: &Loaded, gpu: &Tessellated, cpu: &Tessellated, what: &str) {
    // Not assert_eq: nobody reads a hundred thousand triangles.
    assert!(gpu.patch_factors == cpu.patch_factors, "{what}: factors");
    assert!(gpu.triangles == cpu.triangles, "{what}: triangles");
    assert_eq!(gpu.vertices.len(), cpu.vertices.len(), "{what}: vertices");
    let bound = 4.0 * ulp(&loaded.topology);
    for (index, (a, b)) in gpu.vertices.iter().zip(&cpu.vertices).enumerate() {
        assert_eq!(a.key, b.key, "{what}: key of vertex {index}");
        let [own, other] = [a.normal, b.normal].map(unpack_normal);
        assert!(own.distance(other) < 2e-4, "{what}: vertex {index}: {own} {other}");
        assert!((a.uv[0] - b.uv[0]).abs() + (a.uv[1] - b.uv[1]).abs() < 1e-6, "{what}: vertex {index}: uv");
        for (x, y) in a.position.into_iter().zip(b.position) {
            assert!((f64::from(x) - f64::from(y)).abs() <= bound, "{what}: vertex {index}: {x} {y}");
        }
    }
}

#[test]
fn uniform_factors_agree_with_the_cpu() {
    for shape in Shape::ALL {
        let (loaded, mut scene) = scene(shape);
        for surface in SURFACES {
            for partitioning in Partitioning::ALL {
                for (edges, factor) in [(Edges::PerEdge, 1.0), (Edges::PerEdge, 5.3), (Edges::AsPublished, 5.3)] {
                    let normals = NORMALS[(surface as usize + partitioning as usize) % 3];
                    let base = Settings::from(Tessellation { surface, normals, alpha: 0.6, ..Tessellation::default() });
                    let inputs =
                        inputs(&loaded, &base.with(Tessellation { edges, partitioning, factor, ..base.tessellation }));
                    let gpu = on_gpu(&mut scene, &inputs);
                    let cpu = tessellate(&loaded.mesh, &loaded.topology, &inputs, None);
                    let what = format!("{shape:?} {surface:?} {normals:?} {edges:?} {partitioning:?} {factor}");
                    assert_agree(&loaded, &gpu, &cpu, &what);
                    let counted = totals(&loaded.mesh, &loaded.topology, &inputs);
                    assert_eq!(scene.tessellator.totals(), counted, "known before anything is emitted");
                }
            }
        }
    }
}

#[test]
fn adaptive_factors_agree_with_the_cpu() {
    let paper = Settings::from(Tessellation { lod: Lod::Paper, clip: Clip::Paper, ..Tessellation::default() });
    let published = paper.with(Tessellation { edges: Edges::AsPublished, ..paper.tessellation });
    let robust = paper.with(Tessellation { lod: Lod::EdgeLength, clip: Clip::Frustum, ..paper.tessellation });
    let tried = [
        (Shape::CubeSplit, paper),
        (Shape::CubeSplit, published),
        (Shape::Torus, paper),
        (Shape::Cone, robust),
        (Shape::Cone, published),
        (Shape::Moebius, paper),
        (Shape::Moebius, published),
    ];
    for (shape, settings) in tried {
        let (loaded, mut scene) = scene(shape);
        for surface in SURFACES {
            for partitioning in Partitioning::DIRECT3D {
                let settings = settings.with(Tessellation { surface, partitioning, ..settings.tessellation });
                let inputs = inputs(&loaded, &settings);
                let gpu = on_gpu(&mut scene, &inputs);
                let factors = edge_factors(&scene);
                let what = format!(
                    "{shape:?} {surface:?} {partitioning:?} {:?} {:?}",
                    settings.tessellation.edges, settings.tessellation.lod
                );
                // Division and square root may differ in the last bits, and a factor's rounding with them: the
                // tessellation is compared at the GPU's factors; those are held against the formula below.
                let cpu = tessellate(&loaded.mesh, &loaded.topology, &inputs, Some(&factors));
                assert_agree(&loaded, &gpu, &cpu, &what);
                assert!(factors.iter().any(|&factor| factor != factors[0]), "{what}: all factors are the same");
            }
        }
    }
}

#[test]
fn adaptive_factors_are_those_of_the_formula() {
    let (loaded, mut scene) = scene(Shape::Torus);
    for lod in Lod::ALL {
        let own = Tessellation { lod, ..Tessellation::default() };
        let settings = Settings::from(match lod {
            Lod::Paper | Lod::EdgeLength => Tessellation { pixels: 6.0, ..own },
            Lod::Distance => Tessellation { near: 3.0, far: 4.5, factor: 20.0, ..own },
            // Its bounds may fall on either of two levels, so `error.rs` compares its factors.
            Lod::Error => continue,
            // All its factors are the same; `uniform_factors_agree_with_the_cpu` compares them.
            Lod::Uniform => continue,
        });
        let inputs = inputs(&loaded, &settings);
        on_gpu(&mut scene, &inputs);
        let own = geometry::tessellate::edge_factors(&loaded.mesh, &loaded.topology, &inputs);
        assert!(
            own.iter().any(|&factor| factor > own[0] + 1.0 || factor < own[0] - 1.0),
            "{:?}",
            settings.tessellation.lod
        );
        for (gpu, cpu) in edge_factors(&scene).into_iter().zip(own) {
            // A few divisions, a matrix and a square root, each to within a few ULP.
            assert!((gpu - cpu).abs() <= 1e-5 * cpu, "{:?}: {gpu} {cpu}", settings.tessellation.lod);
        }
    }
}

#[test]
fn factors_by_edge_length_are_those_of_the_formula_behind_the_eye_too() {
    let (loaded, mut scene) = scene(Shape::Torus);
    let bounds = loaded.mesh.bounds();
    // The eye is inside the tube: some edges lie before it, some behind, some across its plane.
    let camera = Camera { target: glam::vec3(0.7, 0.0, 0.0), distance: 0.3, ..Camera::framing(&bounds, VIEWPORT) };
    let view = camera.lod_view(VIEWPORT, &bounds);
    let beyond = |point: u32| beyond_near(view.clip_from_object * loaded.topology.points[point as usize].extend(1.0));
    let mut kinds = [0; 3];
    for edge in &loaded.topology.edges {
        kinds[loaded.topology.edge_points(edge).into_iter().filter(|&point| beyond(point)).count()] += 1;
    }
    assert!(
        kinds.into_iter().all(|count| count > 5),
        "edges with no, one and two ends beyond the near plane: {kinds:?}"
    );
    for edges in [Edges::PerEdge, Edges::AsPublished] {
        let settings =
            Settings::from(Tessellation { lod: Lod::EdgeLength, edges, pixels: 6.0, ..Tessellation::default() });
        let inputs = settings.inputs(view);
        on_gpu(&mut scene, &inputs);
        let own = geometry::tessellate::edge_factors(&loaded.mesh, &loaded.topology, &inputs);
        let device = edge_factors(&scene);
        assert_eq!(device.len(), own.len(), "{edges:?}");
        for (gpu, cpu) in device.into_iter().zip(own) {
            // As above; and the nearest depth, of an edge about as long as it is far, may lose a digit more.
            assert!((gpu - cpu).abs() <= 1e-4 * cpu, "{edges:?}: {gpu} {cpu}");
        }
    }
}

#[test]
fn low_factors_and_small_triangles_are_counted_as_on_the_cpu() {
    let (loaded, mut scene) = scene(Shape::Torus);
    let camera = Camera::framing(&scene.bounds, VIEWPORT);
    let view = ScreenView { clip_from_object: camera.clip_from_object(VIEWPORT, &scene.bounds), viewport: VIEWPORT };
    for partitioning in Partitioning::ALL {
        for factor in [1.0, 1.9, 12.0] {
            let settings = Settings::from(Tessellation { partitioning, factor, ..Tessellation::default() });
            let inputs = inputs(&loaded, &settings);
            let cpu = tessellate(&loaded.mesh, &loaded.topology, &inputs, None);
            engine().count(&mut scene, &inputs, &mut Timing::Off).expect("counts");
            let requested = engine().requested_factors(&scene).expect("a readback");
            let on_cpu = Measured::new(&loaded.mesh, &loaded.topology, requested, &cpu);
            let on_gpu = engine().measure(&mut scene).expect("a readback");
            let what = format!("{partitioning:?} {factor}");
            assert_eq!(on_gpu.patches_low, on_cpu.patches_low, "{what}");
            // 1.9 is rounded up where it becomes a whole number, and an even number of segments is at least 2.
            let low = match partitioning {
                Partitioning::FractionalOdd => factor < 2.0,
                Partitioning::FractionalEven => false,
                Partitioning::Integer | Partitioning::Pow2 | Partitioning::Subtriangulation | Partitioning::Rows => {
                    factor == 1.0
                }
            };
            assert_eq!(on_gpu.patches_low, if low { 256 } else { 0 }, "{what}");
            let mut sizes = Sizes::new(view);
            sizes.take(&EmittedChunk::whole(&cpu.vertices, &cpu.triangles));
            let wanted = Measurements { sizes: Some(view), ..Measurements::default() };
            let seen = engine().measure_all(&mut scene, &wanted).expect("a readback").sizes.expect("it was asked for");
            assert_eq!(seen.in_view, sizes.in_view, "{what}");
            // Positions differ by a few ULP, which may take a triangle across 3 px.
            assert!(seen.small.abs_diff(sizes.small) <= 2, "{what}: {} and {}", seen.small, sizes.small);
            assert!(factor < 12.0 || seen.small > seen.in_view / 2, "{what}: {} of {}", seen.small, seen.in_view);
        }
    }
}

#[test]
fn every_shared_point_has_the_same_bits_from_all_sides() {
    for shape in Shape::ALL {
        let (loaded, mut scene) = scene(shape);
        for surface in [Surface::Flat, Surface::PnAen] {
            for partitioning in Partitioning::ALL {
                for lod in [Lod::Uniform, Lod::Paper] {
                    let settings = Settings::from(Tessellation {
                        surface,
                        partitioning,
                        lod,
                        factor: 6.7,
                        ..Tessellation::default()
                    });
                    engine().count(&mut scene, &inputs(&loaded, &settings), &mut Timing::Off).expect("counts");
                    let cracks = engine().measure(&mut scene).expect("a readback").cracks;
                    assert_eq!(cracks.different_bits, 0, "{shape:?} {surface:?} {partitioning:?} {lod:?}");
                    let inner = loaded.topology.edges.iter().filter(|edge| edge.kind != EdgeKind::Boundary).count();
                    assert!(cracks.edge_points >= 2 * inner as u64, "both ends of every inner edge");
                }
            }
        }
    }
}

#[test]
fn equal_triangles_are_watertight_at_every_factor() {
    for shape in Shape::ALL {
        let (loaded, mut scene) = scene(shape);
        let partitionings = [Partitioning::Subtriangulation, Partitioning::Rows];
        for (n, partitioning) in (1..=64).flat_map(|n| partitionings.map(|partitioning| (n, partitioning))) {
            let settings = Settings::from(Tessellation { partitioning, factor: n as f32, ..Tessellation::default() });
            engine().count(&mut scene, &inputs(&loaded, &settings), &mut Timing::Off).expect("counts");
            let patches = loaded.topology.patches.len() as u64;
            assert_eq!(
                scene.tessellator.totals(),
                (patches * ((n + 1) * (n + 2) / 2), patches * n * n),
                "{shape:?} {partitioning:?} {n}"
            );
            let cracks = engine().measure(&mut scene).expect("a readback").cracks;
            assert_eq!(cracks.different_bits + cracks.different_factors, 0, "{shape:?} {partitioning:?} {n}");
            let inner = loaded.topology.edges.iter().filter(|edge| edge.kind != EdgeKind::Boundary).count() as u64;
            assert!(
                cracks.edge_points >= inner * (n + 1),
                "{shape:?} {partitioning:?} {n}: every point of every inner edge"
            );
        }
    }
}

#[test]
fn pn_tears_where_normals_are_split_and_nowhere_else() {
    for (shape, torn) in [(Shape::CubeSplit, 12), (Shape::CubeSmooth, 0), (Shape::Torus, 0)] {
        let (loaded, mut scene) = scene(shape);
        let settings = Settings::from(Tessellation { surface: Surface::Pn, ..Tessellation::default() });
        engine().count(&mut scene, &inputs(&loaded, &settings), &mut Timing::Off).expect("counts");
        let cracks = engine().measure(&mut scene).expect("a readback").cracks;
        assert_eq!(cracks.edges.len(), torn, "{shape:?}");
    }
}

#[test]
fn a_small_arena_gives_the_same_mesh_in_chunks() {
    let loaded = loaded(Shape::Torus);
    let mut whole = engine().scene(&loaded, 1 << 28).expect("small");
    // Room for a little more than the largest patch: 8256 vertices of 32 bytes, 16129 triangles of 12.
    let mut cut = engine().scene(&loaded, 2 * 265_000).expect("small");
    for (lod, factor) in [(Lod::Uniform, 21.0), (Lod::Uniform, 64.0), (Lod::Paper, 1.0)] {
        let settings = Settings::from(Tessellation { lod, factor, pixels: 2.0, ..Tessellation::default() });
        let inputs = inputs(&loaded, &settings);
        let (a, b) = (on_gpu(&mut whole, &inputs), on_gpu(&mut cut, &inputs));
        assert_eq!(whole.tessellator.chunk_count(), 1);
        assert!(cut.tessellator.chunk_count() > 10, "{} chunks", cut.tessellator.chunk_count());
        assert!(a == b, "{lod:?} {factor}: the chunks differ from the whole");
        let size = [160, 120];
        assert!(
            picture(&mut whole, &settings, size) == picture(&mut cut, &settings, size),
            "{lod:?} {factor}: pictures"
        );
    }
}

#[test]
fn output_that_does_not_fit_the_arena_is_cut_into_small_chunks() {
    let loaded = loaded(Shape::Torus);
    // Room for 81,920 vertices.
    let mut scene = engine().scene(&loaded, 5 << 20).expect("small");
    let mut chunks = |factor| {
        let settings = Settings::from(Tessellation { factor, ..Tessellation::default() });
        engine().count(&mut scene, &inputs(&loaded, &settings), &mut Timing::Off).expect("counts");
        let of = |index| scene.tessellator.chunk(index).chunk;
        (0..scene.tessellator.chunk_count()).map(of).collect::<Vec<_>>()
    };
    let [whole] = chunks(17.0)[..] else { panic!("what fits is one chunk") };
    let most = 81_920 / chunks_an_arena(&engine().gpu);
    assert!(whole.vertex_count > 50_000, "{} in one chunk", whole.vertex_count);
    let cut = chunks(21.0);
    assert!(cut.iter().all(|chunk| (1..=most).contains(&chunk.vertex_count)), "{cut:?}");
    assert!(cut.windows(2).all(|pair| pair[0].patch_end == pair[1].first_patch));
}

/// A flat sheet of so many quads either way, two triangles each.
pub(super) fn sheet(columns: u32, rows: u32) -> Loaded {
    let corner = |i: u32, j: u32| Corner {
        position: glam::vec3(i as f32, 0.0, j as f32),
        normal: glam::Vec3::Y,
        uv: glam::Vec2::ZERO,
    };
    let at = |i: u32, j: u32| i * (rows + 1) + j;
    let corners = (0..=columns).flat_map(|i| (0..=rows).map(move |j| corner(i, j))).collect();
    let cells = (0..columns).flat_map(|i| (0..rows).map(move |j| (i, j)));
    let quad = |(i, j)| [[at(i, j), at(i, j + 1), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i + 1, j)]];
    let triangles: Vec<_> = cells.flat_map(quad).collect();
    let mut material = Material::plain("plain", [1.0; 4]);
    material.triangles = 0..triangles.len() as u32;
    let mesh = Mesh { corners, triangles: triangles.into(), materials: vec![material], ..Mesh::default() };
    loaded_mesh(Source::default(), mesh)
}

#[test]
fn more_patches_than_one_scan_covers_are_one_mesh() {
    let loaded = sheet(600, 500);
    assert!(loaded.topology.patches.len() > 1 << 18, "more than one slab");
    let mut scene = engine().scene(&loaded, 1 << 28).expect("it fits");
    let settings =
        Settings::from(Tessellation { factor: 1.7, partitioning: Partitioning::Integer, ..Tessellation::default() });
    let inputs = inputs(&loaded, &settings);
    let gpu = on_gpu(&mut scene, &inputs);
    assert_agree(&loaded, &gpu, &tessellate(&loaded.mesh, &loaded.topology, &inputs, None), "two slabs");
    assert_eq!(engine().measure(&mut scene).expect("a readback").cracks.different_bits, 0);
}

#[test]
fn many_triangles_are_emitted_as_few_are() {
    // From 7,340,032 on, a workgroup makes more of them.
    let loaded = sheet(25, 24);
    let mut scene = engine().scene(&loaded, 1 << 28).expect("it fits");
    let settings =
        Settings::from(Tessellation { factor: 64.0, partitioning: Partitioning::Integer, ..Tessellation::default() });
    let gpu = on_gpu(&mut scene, &inputs(&loaded, &settings));
    let factors = process(settings.tessellation.partitioning, [64.0; 3], 64.0);
    let (points, triangles) = (point_count(factors), triangle_count(factors) as usize);
    assert_eq!((scene.tessellator.chunk_count(), gpu.triangles.len()), (1, 1200 * triangles));
    assert!(gpu.triangles.len() >= 7_340_032);
    let (first, others) = gpu.triangles.split_at(triangles);
    for (patch, own) in (1..).zip(others.chunks(triangles)) {
        let is_same = |(a, b): (&[u32; 3], &[u32; 3])| a.map(|corner| corner + patch * points) == *b;
        assert!(first.iter().zip(own).all(is_same), "patch {patch}");
    }
}

#[test]
fn an_eye_inside_the_mesh_gives_factors_and_no_cracks() {
    let (loaded, mut scene) = scene(Shape::Torus);
    let bounds = loaded.mesh.bounds();
    let mut camera = Camera::framing(&bounds, VIEWPORT);
    // Inside the tube, looking along it: control points lie behind the eye, and some nearly in its plane.
    camera.target = glam::vec3(0.7, 0.0, 0.0);
    camera.distance = 1e-3;
    for clip in [Clip::Off, Clip::Paper] {
        let settings = Settings::from(Tessellation { lod: Lod::Paper, clip, ..Tessellation::default() });
        let inputs = settings.inputs(camera.lod_view(VIEWPORT, &bounds));
        engine().count(&mut scene, &inputs, &mut Timing::Off).expect("counts");
        assert!(edge_factors(&scene).iter().all(|&factor| factor >= 1.0), "{clip:?}");
        assert_eq!(engine().measure(&mut scene).expect("a readback").cracks.different_bits, 0, "{clip:?}");
    }
}

#[test]
fn output_is_the_same_on_every_run() {
    let (loaded, mut scene) = scene(Shape::Cylinder);
    let settings = Settings::from(Tessellation { lod: Lod::Paper, pixels: 3.0, ..Tessellation::default() });
    let inputs = inputs(&loaded, &settings);
    let first = on_gpu(&mut scene, &inputs);
    for _ in 0..3 {
        scene.tessellator.forget();
        assert!(on_gpu(&mut scene, &inputs) == first);
    }
}

#[test]
fn only_what_changed_is_recomputed() {
    // All triangles are drawn, however small.
    let engine = sifting(f32::INFINITY);
    let (_, mut scene) = scene(Shape::Torus);
    let target = Target::new(&engine.gpu, [512, 512]).expect("a small picture");
    let mut camera = Camera::framing(&scene.bounds, target.viewport());
    let mut settings = Settings::default();
    let passes = |scene: &mut Scene, camera: &Camera, settings: &Settings| {
        let mut timing = Timing::Submissions(Vec::new());
        engine.draw(scene, &target, camera, settings, &mut timing).expect("a draw");
        take_times(&engine.gpu, &mut timing).iter().map(|time| time.pass).collect::<Vec<_>>()
    };
    let all = ["nets", "factors", "counts", "scan", "chunks", "emit", "draw"];
    let counts = &all[1..];
    assert_eq!(passes(&mut scene, &camera, &settings), all);
    assert_eq!(passes(&mut scene, &camera, &settings), ["draw"], "nothing changed");
    camera.azimuth += 10.0;
    assert_eq!(passes(&mut scene, &camera, &settings), ["draw"], "the camera moved under uniform LOD");
    settings.tessellation.pixels = 3.0;
    assert_eq!(passes(&mut scene, &camera, &settings), ["draw"], "px a segment mean nothing under uniform LOD");
    settings.tessellation.factor = 3.0;
    assert_eq!(passes(&mut scene, &camera, &settings), counts, "the factor changed");
    settings.tessellation.lod = Lod::Paper;
    assert_eq!(passes(&mut scene, &camera, &settings), counts, "LOD changed");
    camera.azimuth += 10.0;
    assert_eq!(passes(&mut scene, &camera, &settings), counts, "the camera moved under adaptive LOD");
    settings.tessellation.surface = Surface::Flat;
    assert_eq!(passes(&mut scene, &camera, &settings), all, "the surface changed");
}

#[test]
fn clipping_leaves_out_what_is_behind_and_changes_no_factor() {
    let (loaded, mut scene) = scene(Shape::Torus);
    let bounds = loaded.mesh.bounds();
    // Close to the outer edge: part of the torus lies behind the eye and beside the view.
    let camera = Camera { distance: bounds.radius() * 0.9, ..Camera::framing(&bounds, VIEWPORT) };
    let view = camera.lod_view(VIEWPORT, &bounds);
    let off = Settings::default();
    let on = off.with(Tessellation { clip: Clip::Paper, ..off.tessellation });
    let whole = on_gpu(&mut scene, &off.inputs(view));
    let clipped = on_gpu(&mut scene, &on.inputs(view));
    let kept: Vec<_> =
        clipped.patch_factors.iter().zip(&whole.patch_factors).filter(|(c, _)| !patch_is_culled(**c)).collect();
    assert!(!kept.is_empty() && kept.len() < whole.patch_factors.len(), "{} patches kept", kept.len());
    assert!(kept.iter().all(|(clipped, whole)| clipped == whole), "a neighbour's factors changed");
    let cpu = tessellate(&loaded.mesh, &loaded.topology, &on.inputs(view), None);
    assert_agree(&loaded, &clipped, &cpu, "clipped");
}

#[test]
fn the_passes_are_timed_one_by_one() {
    let engine = engine();
    let (_, mut scene) = scene(Shape::CubeSplit);
    let target = Target::new(&engine.gpu, [64, 64]).expect("a small picture");
    let camera = Camera::framing(&scene.bounds, target.viewport());
    let view = camera.lod_view(target.viewport(), &scene.bounds);
    let times = engine.time(&mut scene, &target, &camera, view, &Settings::default(), Runs::default()).expect("a draw");
    // Nothing is deformed or displaced here: see `deforming` and `displacement`.
    assert_eq!(times.iter().map(|time| time.pass).collect::<Vec<_>>(), RIGID_PASSES);
    assert!(times.iter().all(|time| time.ms >= 0.0 && time.ms.is_finite()));
}

#[test]
fn an_empty_view_emits_nothing_and_draws_the_background() {
    let engine = engine();
    let (_, mut scene) = scene(Shape::CubeSplit);
    let target = Target::new(&engine.gpu, [32, 32]).expect("a small picture");
    let mut camera = Camera::framing(&scene.bounds, target.viewport());
    camera.target -= camera.axes()[2] * camera.distance * 3.0;
    let settings = Settings {
        tessellation: Tessellation { clip: Clip::Paper, ..Tessellation::default() },
        background: Some([10, 200, 30]),
        ..Settings::default()
    };
    engine.draw(&mut scene, &target, &camera, &settings, &mut Timing::Off).expect("a draw");
    assert_eq!(scene.tessellator.totals(), (0, 0));
    let picture = target.read(&engine.gpu).expect("a readback");
    assert!(picture.pixels().all(|pixel| pixel.0 == [10, 200, 30, 255]));
}

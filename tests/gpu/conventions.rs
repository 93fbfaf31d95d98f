//! Conventions of factors and weights: those that agree with themselves give one mesh, mistakes crack. And factors that are
//! given in place of LOD's.

use geometry::mesh::Shape;
use geometry::tessellate::{
    Clip, Convention, Edges, HullFactors, Inputs, Lod, Partitioning, Surface, Tessellated, Tessellation, hull_factors,
    patch_is_culled, segments, tessellate, tessellate_given,
};
use gpu::Timing;
use inspect::engine::Loaded;
use inspect::measure::{EdgeSide, Measured, RequestedFactors};
use inspect::render::{Camera, Scene};
use inspect::settings::Settings;

use crate::passes::{assert_agree, edge_factors, inputs, on_gpu};
use crate::{engine, loaded, scene};

const CONSISTENT: [Convention; 3] = [Convention::D3d11, Convention::AmdPn, Convention::EdgeOrder];
const MISTAKES: [Convention; 2] = [Convention::Rotated, Convention::Mirrored];

/// Settings with a LOD, under which factors differ from edge to edge unless it is uniform.
fn by(lod: Lod) -> Settings {
    let own = Tessellation { lod, ..Tessellation::default() };
    Settings::from(match lod {
        Lod::Uniform => Tessellation { factor: 5.3, ..own },
        Lod::Error => Tessellation { tolerance: 0.3, ..own },
        Lod::EdgeLength | Lod::Paper => Tessellation { pixels: 14.0, ..own },
        Lod::Distance => Tessellation { near: 3.0, far: 4.5, factor: 12.0, surface: Surface::Pn, ..own },
    })
}

/// The LODs under which factors differ from edge to edge.
fn adaptive_lods() -> impl Iterator<Item = Lod> {
    Lod::ALL.into_iter().filter(|lod| lod.follows_view())
}

/// Adaptive, in every form.
fn adaptive() -> impl Iterator<Item = Settings> {
    let paper = by(Lod::Paper);
    let as_published = paper.with(Tessellation { edges: Edges::AsPublished, ..paper.tessellation });
    adaptive_lods().map(by).chain([as_published])
}

fn on_cpu(loaded: &Loaded, inputs: &Inputs) -> (Tessellated, Measured) {
    let out = tessellate(&loaded.mesh, &loaded.topology, inputs, None);
    let requested =
        RequestedFactors::new(inputs.tessellation.edges, inputs.tessellation.convention, out.edge_factors.clone());
    let measured = Measured::new(&loaded.mesh, &loaded.topology, requested, &out);
    (out, measured)
}

fn on_device(scene: &mut Scene, inputs: &Inputs) -> (Tessellated, Measured) {
    let out = on_gpu(scene, inputs);
    (out, engine().measure(scene).expect("a readback"))
}

/// What every side of every edge has made of it.
fn sides(loaded: &Loaded, measured: &Measured) -> Vec<Vec<EdgeSide>> {
    (0..loaded.topology.edges.len() as u32).map(|edge| measured.outlines.edge(&loaded.topology, edge)).collect()
}

/// Holds every consistent convention against Direct3D 11's.
fn assert_one_mesh(loaded: &Loaded, settings: Settings, mut run: impl FnMut(&Inputs) -> (Tessellated, Measured)) {
    let [first, others @ ..] = CONSISTENT.map(|convention| {
        let settings = settings.with(Tessellation { convention, ..settings.tessellation });
        let (out, measured) = run(&inputs(loaded, &settings));
        (format!("{:?} {settings:?}", loaded.source), out, measured)
    });
    assert!(first.2.outlines.edge(&loaded.topology, 0)[0].points.len() > 1);
    for (what, out, measured) in others {
        assert_eq!(out.triangles.len(), first.1.triangles.len(), "{what}");
        assert_eq!(out.edge_factors, first.1.edge_factors, "{what}");
        assert!(sides(loaded, &measured) == sides(loaded, &first.2), "{what}: outlines");
        assert_eq!(measured.cracks, first.2.cracks, "{what}");
        assert_eq!((measured.folds, measured.not_finite), (first.2.folds, 0), "{what}");
        if settings.tessellation.edges == Edges::PerEdge && settings.tessellation.surface != Surface::Pn {
            assert_eq!(measured.cracks.edges.len(), 0, "{what}");
        }
    }
}

#[test]
fn consistent_conventions_give_the_same_outlines_on_both_devices() {
    for shape in [Shape::Torus, Shape::CubeSplit, Shape::Moebius, Shape::Cone] {
        let (loaded, mut scene) = scene(shape);
        for settings in adaptive().chain([by(Lod::Uniform)]) {
            for partitioning in Partitioning::ALL {
                let settings = settings.with(Tessellation { partitioning, ..settings.tessellation });
                assert_one_mesh(&loaded, settings, |inputs| on_device(&mut scene, inputs));
                assert_one_mesh(&loaded, settings, |inputs| on_cpu(&loaded, inputs));
            }
        }
    }
}

#[test]
fn mistakes_crack_as_soon_as_factors_differ() {
    for shape in [Shape::Torus, Shape::Moebius, Shape::Icosphere] {
        let (loaded, mut scene) = scene(shape);
        for convention in MISTAKES {
            for partitioning in Partitioning::DIRECT3D {
                for settings in adaptive_lods().map(by) {
                    let settings = settings.with(Tessellation {
                        convention,
                        partitioning,
                        pixels: 5.0,
                        tolerance: 0.05,
                        ..settings.tessellation
                    });
                    let inputs = inputs(&loaded, &settings);
                    for cracks in [on_device(&mut scene, &inputs).1.cracks, on_cpu(&loaded, &inputs).1.cracks] {
                        let found = [cracks.different_factors, cracks.different_bits];
                        assert!(found.iter().all(|&n| n > 3), "{shape:?} {settings:?}: {found:?}");
                        assert!(cracks.max_gap() > 1e-4, "{shape:?} {settings:?}");
                    }
                }
            }
            for partitioning in Partitioning::ALL {
                let uniform =
                    Settings::from(Tessellation { convention, partitioning, factor: 6.4, ..Tessellation::default() });
                let inputs = inputs(&loaded, &uniform);
                for measured in [on_device(&mut scene, &inputs).1, on_cpu(&loaded, &inputs).1] {
                    assert_eq!(measured.cracks.edges.len(), 0, "{shape:?} {uniform:?}");
                }
            }
        }
    }
}

#[test]
fn both_devices_agree_under_every_convention() {
    for shape in [Shape::Torus, Shape::CubeSplit, Shape::Moebius] {
        let (loaded, mut scene) = scene(shape);
        for convention in Convention::ALL {
            for partitioning in Partitioning::ALL {
                // The bounds of LOD by error may fall on either of two levels.
                for settings in adaptive_lods().filter(|lod| !lod.is_by_error()).map(by) {
                    for edges in [Edges::PerEdge, Edges::AsPublished] {
                        let settings = settings.with(Tessellation {
                            convention,
                            partitioning,
                            edges,
                            clip: Clip::Frustum,
                            ..settings.tessellation
                        });
                        let inputs = inputs(&loaded, &settings);
                        let gpu = on_gpu(&mut scene, &inputs);
                        let factors = edge_factors(&scene);
                        let cpu = tessellate(&loaded.mesh, &loaded.topology, &inputs, Some(&factors));
                        assert_agree(&loaded, &gpu, &cpu, &format!("{shape:?} {settings:?}"));
                    }
                }
            }
        }
    }
}

/// Close to the torus, so that part of it is out of view.
fn close(loaded: &Loaded, settings: &Settings) -> Inputs {
    let (bounds, viewport) = (loaded.mesh.bounds(), glam::vec2(640.0, 480.0));
    let camera = Camera { distance: 1.2 * bounds.radius(), ..Camera::framing(&bounds, viewport) };
    settings.inputs(camera.lod_view(viewport, &bounds))
}

#[test]
fn what_a_hull_shader_wrote_gives_the_same_mesh_again() {
    let (loaded, mut scene) = scene(Shape::Torus);
    for convention in Convention::ALL {
        for partitioning in Partitioning::ALL {
            for settings in adaptive() {
                let settings = settings.with(Tessellation {
                    convention,
                    partitioning,
                    clip: Clip::Frustum,
                    ..settings.tessellation
                });
                let (inputs, what) = (close(&loaded, &settings), format!("{settings:?}"));
                let direct = on_gpu(&mut scene, &inputs);
                let written = scene.tessellator.hull_factors().expect("a readback");
                let left_out = written.iter().filter(|patch| patch.culls()).count();
                assert!(left_out > 10 && left_out < written.len() - 10, "{what}: {left_out} out of view");
                // Under a uniform LOD nothing of the view's is left but the file's.
                let given = Inputs {
                    tessellation: Tessellation { lod: Lod::Uniform, clip: Clip::Off, ..inputs.tessellation },
                    ..inputs
                };
                scene.tessellator.give(Some(written.into())).expect("small");
                let again = on_gpu(&mut scene, &given);
                scene.tessellator.give(None).expect("small");
                assert!(again.vertices == direct.vertices && again.triangles == direct.triangles, "{what}");

                let direct = tessellate(&loaded.mesh, &loaded.topology, &inputs, None);
                let written = hull_factors(&loaded.mesh, &loaded.topology, &inputs);
                let again = tessellate_given(&loaded.mesh, &loaded.topology, &given, &written);
                assert!(again.vertices == direct.vertices && again.triangles == direct.triangles, "{what}: CPU");
                // A file of zeros doesn't say why.
                let kept = |out: &Tessellated| -> Vec<_> {
                    out.patch_factors.iter().filter(|factors| !patch_is_culled(**factors)).copied().collect()
                };
                assert!(kept(&again) == kept(&direct), "{what}");
                assert!(again.edge_factors.is_empty());
            }
        }
    }
}

#[test]
fn given_factors_reach_the_tessellator_as_they_are() {
    let (loaded, mut scene) = scene(Shape::Icosphere);
    let odd = [1.0, 0.0, 2.5, f32::NAN, 7.0, f32::INFINITY, -3.0, 64.0, 0.3, f32::MIN_POSITIVE / 4.0, 1e-3, 80.0, 3.0];
    let number = |i: usize| odd[i % odd.len()];
    let given: Vec<_> = (0..loaded.topology.patches.len())
        .map(|i| HullFactors { edges: [number(i), number(i / 3), number(i / 5)], inside: number(3 * i) })
        .collect();
    for convention in Convention::ALL {
        for partitioning in Partitioning::ALL {
            let settings = Settings::from(Tessellation { convention, partitioning, ..Tessellation::default() });
            let inputs = inputs(&loaded, &settings);
            scene.tessellator.give(Some(given.clone().into())).expect("small");
            let (gpu, measured) = on_device(&mut scene, &inputs);
            let cpu = tessellate_given(&loaded.mesh, &loaded.topology, &inputs, &given);
            assert_agree(&loaded, &gpu, &cpu, &format!("{settings:?}"));
            for (factors, own) in gpu.patch_factors.iter().zip(&given) {
                assert_eq!(*factors, own.rounded(partitioning).process(partitioning), "{settings:?}");
            }
            let culled = given.iter().filter(|patch| patch.culls()).count();
            assert!(culled > 20 && measured.culled.total() as usize == culled, "{culled}");
        }
    }
}

#[test]
fn a_side_is_cut_by_the_factor_that_the_convention_puts_there() {
    let loaded = loaded(Shape::Saddle);
    let given = vec![HullFactors { edges: [2.0, 3.0, 4.0], inside: 4.0 }; loaded.topology.patches.len()];
    // Segments of the edges (0, 1), (1, 2), (2, 0).
    for (convention, expected) in [
        (Convention::D3d11, [4, 2, 3]),
        (Convention::AmdPn, [3, 4, 2]),
        (Convention::EdgeOrder, [2, 3, 4]),
        (Convention::Rotated, [4, 2, 3]),
        (Convention::Mirrored, [4, 2, 3]),
    ] {
        let settings =
            Settings::from(Tessellation { convention, partitioning: Partitioning::Integer, ..Tessellation::default() });
        let out = tessellate_given(&loaded.mesh, &loaded.topology, &inputs(&loaded, &settings), &given);
        let measured = Measured::new(&loaded.mesh, &loaded.topology, RequestedFactors::given(convention, &given), &out);
        for (index, patch) in (0..).zip(&loaded.topology.patches) {
            let found = patch.sides.map(|side| {
                let edge = measured.outlines.edge(&loaded.topology, loaded.topology.sides[side as usize].edge);
                let own = edge.iter().find(|side| side.patch == index).expect("nothing is culled");
                let ends =
                    [&own.points[0], &own.points[own.points.len() - 1]].map(|point| glam::Vec3::from(point.position));
                let points = loaded
                    .topology
                    .edge_points(&loaded.topology.edges[loaded.topology.sides[side as usize].edge as usize]);
                assert_eq!(ends, points.map(|point| loaded.topology.points[point as usize]), "{convention:?}");
                assert_eq!((own.factor as u32, own.points.len() as u32 - 1), (segments(own.word), segments(own.word)));
                segments(own.word)
            });
            assert_eq!(found, expected, "{convention:?}");
        }
    }
}

#[test]
fn lod_by_error_asks_for_the_same_inside_under_consistent_conventions() {
    let (loaded, mut scene) = scene(Shape::Moebius);
    let by_error = by(Lod::Error);
    let insides = CONSISTENT.map(|convention| {
        let inputs = inputs(&loaded, &by_error.with(Tessellation { convention, ..by_error.tessellation }));
        engine().count(&mut scene, &inputs, &mut Timing::Off).expect("counts");
        let written = scene.tessellator.hull_factors().expect("a readback");
        written.iter().map(|patch| patch.inside).collect::<Vec<_>>()
    });
    assert!(insides[0].iter().any(|&inside| inside != insides[0][0]), "{insides:?}");
    assert!(insides[0] == insides[1] && insides[0] == insides[2], "{insides:?}");
}

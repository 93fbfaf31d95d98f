//! The cases that break tessellators, and meshes at random: what this program promises holds on all of them, and what
//! is published fails where it is said to.

use std::sync::{Arc, OnceLock};

use geometry::mesh::mesh_builder::{InputCorner, MeshBuilder};
use geometry::mesh::{Material, Mesh, Shape, Topology};
use geometry::progress::Progress;
use geometry::tessellate::{Clip, Edges, Lod, Normals, Partitioning, Surface, Tessellation, tessellate};
use glam::{Vec2, Vec3};
use gpu::Timing;
use inspect::measure::{Measured, RequestedFactors};
use inspect::render::{Camera, Scene, Target};
use inspect::settings::Settings;
use lab::stability::{CASES, CaseView, Effort, Method, Quantity, Row, Verdict, lines, run};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;

use crate::{engine, scene};

/// Width and height in px.
const SIZE: [u32; 2] = [160, 120];

const VIEWPORT: Vec2 = glam::vec2(SIZE[0] as f32, SIZE[1] as f32);

/// Room for output: little, so that a large factor takes several chunks.
const ARENA: u64 = 1 << 20;

const SURFACES: [Surface; Surface::ALL.len()] = Surface::ALL;

/// A mesh on the device, its points welded within `weld` of its diagonal.
pub(super) fn scene_of(mesh: Mesh, weld: f32) -> Scene {
    let topology = Topology::build_within(&mesh, weld, &Progress::default()).expect("nobody cancels");
    engine().scene_of(Arc::new(mesh), Arc::new(topology), ARENA).expect("a small mesh")
}

/// A case's mesh on the device, and the camera of its picture.
pub(super) fn case(name: &str) -> (Scene, Camera) {
    let case = CASES.iter().find(|case| case.name == name).expect("a case of this name");
    let scene = scene_of((case.mesh)(), case.weld);
    let CaseView { azimuth, elevation, distance, target, .. } = case.view;
    let mut camera = Camera { azimuth, elevation, ..Camera::framing(&scene.bounds, VIEWPORT) };
    if distance > 0.0 {
        camera.distance = distance * scene.bounds.radius();
        camera.target = scene.bounds.center() + scene.bounds.radius() * Vec3::from(target);
    }
    (scene, camera)
}

pub(super) fn measured(scene: &mut Scene, settings: &Settings, camera: &Camera) -> Measured {
    let inputs = settings.inputs(camera.lod_view(VIEWPORT, &scene.bounds));
    engine().count(scene, &inputs, &mut Timing::Off).expect("counts");
    engine().measure(scene).expect("a readback")
}

/// Every case, the CPU beside the device, run once for all tests. One factor that fractional modes split unevenly, one
/// random view, and a sweep through the first new points of every partitioning: enough for every failure to show.
fn rows() -> &'static [Row] {
    static ROWS: OnceLock<Vec<Row>> = OnceLock::new();
    ROWS.get_or_init(|| {
        let all = |cpu: bool| {
            let effort = Effort { factors: vec![2.4], cameras: 1, cpu, sweep_to: 2.1, ..Effort::default() };
            let engine = (!cpu).then(engine);
            let of = |case: &lab::stability::Case| run(&case.subject(), engine, &effort).expect("small meshes");
            CASES.iter().flat_map(of).collect::<Vec<_>>()
        };
        std::thread::scope(|scope| {
            let on_cpu = scope.spawn(|| all(true));
            let on_device = all(false);
            [on_cpu.join().expect("no panic"), on_device].concat()
        })
    })
}

#[test]
fn no_case_breaks_a_promise() {
    let broken: Vec<_> = lines(rows()).into_iter().filter(|line| line.verdict == Verdict::BreaksPromise).collect();
    assert!(broken.is_empty(), "{broken:#?}");
    for case in CASES {
        let finite = |device: bool| {
            let own = rows().iter().filter(move |row| row.case == case.name && (row.device != "cpu") == device);
            own.filter(|row| row.quantity == Quantity::NotFinite).count()
        };
        let tried = Method::all().len() * Partitioning::ALL.len();
        assert_eq!([finite(false), finite(true)], [tried; 2], "{}: every method, on both devices", case.name);
    }
}

const FLAT: &str = "flat";
const PN: &str = "PN";
const PUBLISHED: &str = "PN-AEN as published";
const PN_AEN: &str = "PN-AEN";
const PHONG: &str = "Phong";
const NAGATA: &str = "Nagata";
const NAGATA_AEN: &str = "Nagata AEN";

/// What fails on each case, and must: a case on which it holds has lost its bite.
const FAILURES: [(&str, &[(&str, Quantity)]); 35] = {
    use Quantity::{Factors, Folds, Leaks, Missing, OpenEdges, Points, Pop, Segment};
    // Where nothing but rounding goes wrong. Some of these meshes are there to hold: what is special about them (signs
    // of zero, borders, denormals, normals that oppose each other) must do no harm, and is tested beside the meshes.
    const ROUNDING: &[(&str, Quantity)] = &[(PUBLISHED, Points), (PUBLISHED, Factors)];
    // And where normals are split, or mended into such.
    const SPLIT: &[(&str, Quantity)] =
        &[(PN, Points), (PHONG, Points), (NAGATA, Points), (PUBLISHED, Points), (PUBLISHED, Factors)];
    const SPLIT_CLOSED: &[(&str, Quantity)] = &[
        (PN, Points),
        (PN, Leaks),
        (PHONG, Points),
        (PHONG, Leaks),
        (NAGATA, Points),
        (NAGATA, Leaks),
        (PUBLISHED, Points),
        (PUBLISHED, Factors),
    ];
    [
        ("split-normals", SPLIT_CLOSED),
        ("smooth-torus", ROUNDING),
        // Its edges lie in both ends' tangent planes: PN differs by rounding alone, and others not even so.
        ("non-manifold", &[(PN, Points), (PUBLISHED, Points), (PUBLISHED, Factors)]),
        ("reversed-neighbours", ROUNDING),
        ("moebius", ROUNDING),
        ("duplicates", ROUNDING),
        ("slivers", SPLIT_CLOSED),
        ("signed-zeros", ROUNDING),
        ("mirrored", ROUNDING),
        ("borders", ROUNDING),
        ("zero-normals", SPLIT),
        ("nan-normals", SPLIT),
        ("long-normals", SPLIT),
        ("opposite-normals", ROUNDING),
        ("edge-normals", SPLIT_CLOSED),
        ("inward-normals", ROUNDING),
        ("huge", ROUNDING),
        ("tiny", ROUNDING),
        ("far-away", &[(PUBLISHED, Points), (PUBLISHED, Factors), (PUBLISHED, Leaks)]),
        ("denormals", ROUNDING),
        ("near-seam", &[("exact weld", OpenEdges), (PUBLISHED, Points)]),
        // That its T-junctions are found is a promise: were there none, it would break.
        ("t-junction", &[(PUBLISHED, Points)]),
        ("folds", &[(PN, Folds), (PN_AEN, Folds), (PUBLISHED, Folds)]),
        ("inflection", &[(NAGATA, Folds), (NAGATA_AEN, Folds), (PUBLISHED, Points), (PUBLISHED, Factors)]),
        ("dart", SPLIT),
        ("height-seams", &[(PUBLISHED, Points), (PUBLISHED, Factors)]),
        ("height-splits", SPLIT_CLOSED),
        ("moving", SPLIT_CLOSED),
        ("sweep", &[(PN, Points), (PN, Pop), (PN_AEN, Pop), (PUBLISHED, Pop)]),
        ("eye-inside", &[(PUBLISHED, Missing), (PUBLISHED, Points)]),
        ("near-plane", &[(PUBLISHED, Missing), (PUBLISHED, Points)]),
        ("behind-eye", &[(PUBLISHED, Segment), (PUBLISHED, Points)]),
        ("soup", SPLIT),
        ("shared-apex", SPLIT_CLOSED),
        ("parts", &[(PUBLISHED, Points), (PUBLISHED, Factors), (PUBLISHED, Leaks)]),
    ]
};

#[test]
fn what_is_published_fails_where_it_is_said_to() {
    assert_eq!(FAILURES.map(|(case, _)| case), CASES.map(|case| case.name), "every case, in order");
    for (case, failures) in FAILURES {
        for &(method, quantity) in failures {
            let own =
                rows().iter().filter(|row| (row.case.as_str(), row.method, row.quantity) == (case, method, quantity));
            let (failing, all) = (own.clone().filter(|row| !row.holds).count(), own.count());
            assert!(failing > 0, "{case}: {method} holds {quantity:?} in all of {all} rows: it has lost its bite");
        }
    }
    let flat = |row: &&Row| row.method == FLAT && !row.holds && row.quantity != Quantity::Pop;
    assert_eq!(rows().iter().find(flat), None, "flat dicing fails nowhere");
}

/// A direction, of a good length or a bad one; or none.
fn any_normal() -> impl Strategy<Value = Vec3> {
    let direction = || prop::array::uniform3(-1f32..1.0).prop_map(Vec3::from);
    let lengths = prop::sample::select(vec![1e-38, 1e-20, 1e-3, 1e3, 1e20, 1e38]);
    let bad = [Vec3::ZERO, -Vec3::ZERO, Vec3::NAN, Vec3::INFINITY, Vec3::NEG_INFINITY, Vec3::MAX, Vec3::X * 1e-45];
    prop_oneof![
        6 => direction().prop_map(Vec3::normalize_or_zero),
        2 => (direction(), lengths).prop_map(|(direction, length)| direction * length),
        1 => prop::sample::select(bad.to_vec()),
        1 => direction().prop_map(|direction| Vec3 { y: f32::NAN, ..direction }),
    ]
}

/// Up to ten triangles over up to seven points, some of which may be one: edges of many sides, wound either way,
/// triangles on top of each other and triangles without area.
fn any_soup() -> impl Strategy<Value = Vec<[InputCorner; 3]>> {
    let coordinate = prop_oneof![4 => -1f32..1.0, 1 => prop::sample::select(vec![-1.0, -0.0, 0.0, 0.5, 1.0])];
    let points = prop::collection::vec(prop::array::uniform3(coordinate), 3..=7);
    let corner = (any::<prop::sample::Index>(), any_normal(), prop::array::uniform2(-2f32..2.0));
    let triangles = prop::collection::vec(prop::array::uniform3(corner), 1..=10);
    (points, triangles).prop_map(|(points, triangles)| {
        let loose = |(index, normal, uv): (prop::sample::Index, Vec3, [f32; 2])| InputCorner {
            position: (*index.get(&points)).into(),
            normal: Some(normal),
            uv: uv.into(),
        };
        triangles.into_iter().map(|corners| corners.map(loose)).collect()
    })
}

/// From half the least factor to beyond the largest, as many whole numbers among them; most of them small, since large
/// ones take long.
fn any_factor() -> impl Strategy<Value = f32> {
    let whole = |last: u32| (1..=last).prop_map(|factor| factor as f32);
    prop_oneof![6 => 0.5f32..8.0, 2 => whole(8), 1 => 0.5f32..70.0, 1 => whole(70)]
}

/// From anywhere in or around what reaches from -1 to 1, near or far: the eye inside it, or past it.
fn any_camera() -> impl Strategy<Value = Camera> {
    let target = prop::array::uniform3(-1.5f32..1.5);
    (target, 0f32..360.0, -89f32..89.0, -3f32..1.0, prop::bool::weighted(0.1)).prop_map(
        |(target, azimuth, elevation, magnitude, orthographic)| {
            let distance = 10f32.powf(magnitude);
            Camera { target: target.into(), azimuth, elevation, distance, orthographic, ..Camera::default() }
        },
    )
}

/// A mesh, and how it is tessellated and seen.
#[derive(Clone, Debug)]
pub(super) struct Trial {
    pub mesh: Mesh,
    pub settings: Settings,
    pub camera: Camera,
}

/// Nagata's curves can be a thousand times as long as their edges: of vast meshes, beyond what f32 has.
fn is_nagata(settings: &Settings) -> bool {
    matches!(settings.tessellation.surface, Surface::Nagata | Surface::NagataAen)
}

pub(super) fn any_trial() -> impl Strategy<Value = Trial> {
    let scale = prop::sample::select(vec![1e-36, 1e-6, 1.0, 1.0, 1e6, 9e36]);
    let lod = prop::sample::select(Lod::ALL.to_vec());
    let clip = prop::sample::select(Clip::ALL.to_vec());
    let normals = prop::sample::select(Normals::ALL.to_vec());
    // Segments of 2 px take hundreds to an edge, more than there are.
    let rest = (clip, normals, 0f32..=1.0);
    let settings =
        (any_factor(), lod, 2f32..64.0, rest).prop_flat_map(|(factor, lod, pixels, (clip, normals, alpha))| {
            let settings =
                Settings::from(Tessellation { factor, lod, pixels, clip, normals, alpha, ..Tessellation::default() });
            prop::sample::select(every_method(settings))
        });
    (any_soup(), scale, settings, any_camera()).prop_map(|(soup, scale, settings, camera)| {
        let scale = if is_nagata(&settings) { f32::min(scale, 1e33) } else { scale };
        let mut builder = MeshBuilder::new();
        let material = builder.material(Material::plain("soup", [0.6, 0.6, 0.6, 1.0]));
        for corners in soup {
            builder.triangle(material, corners.map(|c| InputCorner { position: c.position * scale, ..c }));
        }
        let mesh = builder.finish("soup".to_owned(), &Progress::default()).expect("nobody cancels");
        let camera = Camera { target: camera.target * scale, distance: camera.distance * scale, ..camera };
        Trial { mesh, settings, camera }
    })
}

/// The settings under every surface and partitioning, by edge and as published.
fn every_method(settings: Settings) -> Vec<Settings> {
    let edges = [Edges::PerEdge, Edges::AsPublished];
    let pairs = SURFACES.into_iter().flat_map(|surface| edges.map(|edges| (surface, edges)));
    let all = pairs.flat_map(|(surface, edges)| {
        Partitioning::ALL
            .map(|partitioning| settings.with(Tessellation { surface, edges, partitioning, ..settings.tessellation }))
    });
    all.collect()
}

/// What is promised of any mesh at all.
fn judge(settings: &Settings, measured: &Measured) -> Result<(), TestCaseError> {
    let cracks = &measured.cracks;
    prop_assert_eq!(measured.not_finite, 0, "{:?}", settings);
    if settings.tessellation.edges == Edges::PerEdge {
        prop_assert_eq!(cracks.different_factors, 0, "{:?}", settings);
        // The surface's own normals have a step wherever the surface has a crease.
        prop_assert!(
            cracks.different_normals == 0 || settings.tessellation.normals == Normals::Surface,
            "{:?}",
            settings
        );
        // Surfaces that go by each side's own normals tear where those are split: that is what they are.
        prop_assert!(cracks.different_bits == 0 || settings.tessellation.surface.tears(), "{:?}", settings);
    }
    Ok(())
}

impl Trial {
    fn on_cpu(&self, settings: &Settings) -> Measured {
        let topology = Topology::build(&self.mesh, &Progress::default()).expect("nobody cancels");
        let inputs = settings.inputs(self.camera.lod_view(VIEWPORT, &self.mesh.bounds()));
        let out = tessellate(&self.mesh, &topology, &inputs, None);
        let requested = RequestedFactors::new(
            settings.tessellation.edges,
            settings.tessellation.convention,
            out.edge_factors.clone(),
        );
        Measured::new(&self.mesh, &topology, requested, &out)
    }
}

/// How many meshes at random the CPU takes: PNAEN_SOUPS, for a long look in release, or else `usually`.
pub(super) fn soups(usually: u32) -> ProptestConfig {
    let requested = std::env::var("PNAEN_SOUPS").ok();
    let cases = requested.map_or(usually, |count| count.parse().expect("PNAEN_SOUPS is a number"));
    // Some soups are passed over: settings that a property says nothing of.
    ProptestConfig { max_global_rejects: cases.max(1024), ..ProptestConfig::with_cases(cases) }
}

proptest! {
    #![proptest_config(soups(2000))]
    #[test]
    fn any_soup_holds_together_on_the_cpu(trial in any_trial()) {
        judge(&trial.settings, &trial.on_cpu(&trial.settings))?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]
    #[test]
    fn any_soup_holds_together_on_the_device(trial in any_trial()) {
        let is_vast = trial.mesh.bounds().diagonal() > 1e34;
        let mut scene = scene_of(trial.mesh, 0.0);
        for settings in every_method(trial.settings).into_iter().filter(|settings| !(is_vast && is_nagata(settings))) {
            judge(&settings, &measured(&mut scene, &settings, &trial.camera))?;
        }
    }
}

#[test]
fn soups_tear_where_nothing_holds_them_together() {
    let mut runner = TestRunner::deterministic();
    let (mut pn, mut published, mut factors) = (0, 0, 0);
    for _ in 0..30 {
        let trial = any_trial().new_tree(&mut runner).expect("a strategy that rejects nothing").current();
        let own = trial.settings.with(Tessellation {
            partitioning: Partitioning::Integer,
            factor: 3.0,
            clip: Clip::Off,
            ..trial.settings.tessellation
        });
        let cracks = |surface, edges, lod| {
            trial.on_cpu(&own.with(Tessellation { surface, edges, lod, ..own.tessellation })).cracks
        };
        pn += cracks(Surface::Pn, Edges::PerEdge, Lod::Uniform).different_bits;
        published += cracks(Surface::PnAen, Edges::AsPublished, Lod::Uniform).different_bits;
        factors += cracks(Surface::PnAen, Edges::AsPublished, Lod::Paper).different_factors;
    }
    assert!(pn > 50 && published > 50 && factors > 5, "{pn} {published} points, {factors} factors");
}

/// Cameras around a mesh: all of it, close to it so that it reaches behind the eye and beside the view, with the eye
/// inside, without perspective, and looking away.
fn cameras(scene: &Scene) -> [Camera; 6] {
    let framing = Camera::framing(&scene.bounds, VIEWPORT);
    let radius = scene.bounds.radius();
    let close = Camera { distance: 0.9 * radius, ..framing };
    let aside = framing.target + radius * glam::vec3(0.4, 0.1, 0.3);
    [
        framing,
        close,
        Camera { azimuth: 200.0, distance: 0.1 * radius, target: aside, ..framing },
        Camera { distance: 0.1 * radius, ..framing },
        Camera { orthographic: true, ..close },
        Camera { target: framing.target + framing.axes()[2] * 3.0 * radius, distance: radius, ..framing },
    ]
}

/// The picture from a camera.
pub(super) fn seen(scene: &mut Scene, target: &Target, settings: &Settings, camera: &Camera) -> image::RgbaImage {
    engine().draw(scene, target, camera, settings, &mut Timing::Off).expect("a draw");
    target.read(&engine().gpu).expect("a readback")
}

#[test]
fn clipping_by_each_plane_changes_no_picture_and_the_papers_does() {
    let target = Target::new(&engine().gpu, SIZE).expect("a small picture");
    let (mut left_out, mut changed) = (0, 0);
    for shape in [Shape::Torus, Shape::CubeSplit, Shape::Icosahedron, Shape::Saddle] {
        let (_, mut scene) = scene(shape);
        for (index, camera) in cameras(&scene).into_iter().enumerate() {
            for surface in [Surface::Flat, Surface::PnAen] {
                let off = Settings::from(Tessellation { surface, factor: 5.0, ..Tessellation::default() });
                let whole = seen(&mut scene, &target, &off, &camera);
                let by_plane = off.with(Tessellation { clip: Clip::Frustum, ..off.tessellation });
                assert!(
                    seen(&mut scene, &target, &by_plane, &camera) == whole,
                    "{shape:?} {surface:?}, camera {index}"
                );
                left_out += measured(&mut scene, &by_plane, &camera).culled.total();
                let paper = seen(
                    &mut scene,
                    &target,
                    &off.with(Tessellation { clip: Clip::Paper, ..off.tessellation }),
                    &camera,
                );
                changed += u32::from(paper != whole);
            }
        }
    }
    assert!(left_out > 500, "{left_out} patches left out: there was little to clip");
    assert!(changed > 0, "the paper's test is known to drop patches that are seen");
}

fn leaks(scene: &mut Scene, settings: &Settings, camera: &Camera) -> Option<u64> {
    let measured = measured(scene, settings, camera);
    engine().leaks(scene, &measured, SIZE, camera).expect("a readback")
}

#[test]
fn what_is_closed_leaks_nowhere_by_edge() {
    let base = Settings::from(Tessellation { pixels: 5.0, ..Tessellation::default() });
    let lods = [(Lod::Uniform, 1.0), (Lod::Uniform, 6.7), (Lod::Paper, 1.0), (Lod::EdgeLength, 1.0)];
    let mut closed = 0;
    for shape in Shape::ALL {
        let (loaded, mut scene) = scene(shape);
        let [far, ..] = cameras(&scene);
        // Outside a box around the bounding sphere, so that the near plane cuts nothing off.
        let near = Camera { distance: 2.2 * scene.bounds.radius(), azimuth: 110.0, ..far };
        let is_closed = loaded.topology.is_closed_and_oriented();
        closed += u32::from(is_closed);
        for surface in [Surface::Flat, Surface::PnAen] {
            for partitioning in Partitioning::ALL {
                for (lod, factor) in lods {
                    let settings = base.with(Tessellation { surface, partitioning, lod, factor, ..base.tessellation });
                    for camera in [far, near] {
                        let leaks = leaks(&mut scene, &settings, &camera);
                        assert_eq!(
                            leaks,
                            is_closed.then_some(0),
                            "{shape:?} {surface:?} {partitioning:?} {lod:?} {factor}"
                        );
                    }
                }
            }
        }
    }
    assert!(closed >= 5, "{closed} closed shapes");
}

#[test]
fn torn_edges_leak() {
    let (_, mut scene) = scene(Shape::CubeSplit);
    let [framing, ..] = cameras(&scene);
    for partitioning in Partitioning::ALL {
        let torn = Settings::from(Tessellation { surface: Surface::Pn, partitioning, ..Tessellation::default() });
        let leaks = leaks(&mut scene, &torn, &framing);
        assert!(leaks > Some(100), "{partitioning:?}: {leaks:?} px of {SIZE:?}");
    }
}

#[test]
fn leaks_say_nothing_of_an_open_mesh_or_from_inside() {
    let (_, mut saddle) = scene(Shape::Saddle);
    let [framing, ..] = cameras(&saddle);
    assert_eq!(leaks(&mut saddle, &Settings::default(), &framing), None);
    let (_, mut ball) = scene(Shape::Icosphere);
    let [framing, _, _, inside, ..] = cameras(&ball);
    assert_eq!(leaks(&mut ball, &Settings::default(), &framing), Some(0));
    assert_eq!(leaks(&mut ball, &Settings::default(), &inside), None);
}

#[test]
fn leaks_say_nothing_where_what_is_behind_the_eye_was_left_out() {
    let (_, mut torus) = scene(Shape::Torus);
    // Inside the tube: all that is emitted lies beyond the near plane, the rest of the torus does not.
    let (target, azimuth, elevation) = (Vec3::new(0.424, -0.136, -0.498), 267.0, 62.0);
    let inside = Camera { target, azimuth, elevation, distance: 0.25, ..Camera::default() };
    let clipped = Settings::from(Tessellation {
        surface: Surface::Flat,
        clip: Clip::Frustum,
        factor: 2.0,
        ..Tessellation::default()
    });
    assert_eq!(leaks(&mut torus, &clipped, &inside), None);
}

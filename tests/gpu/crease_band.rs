//! Crease bands, under PN triangles: nothing is left to tear.

use geometry::mesh::{Budget, Mesh, Shape, Topology, with_crease_band};
use geometry::progress::Progress;
use geometry::tessellate::{Edges, Partitioning, Surface, Tessellation};
use inspect::engine::{Preparation, load};
use inspect::measure::Measured;
use inspect::render::{Camera, Scene};
use inspect::settings::{ARENA_BYTES, Settings};
use lab::stability::{CASES, soup};
use load::Source;

use crate::engine;
use crate::stability::{measured, scene_of};

const SIZE: [u32; 2] = [320, 240];

fn banded(shape: Shape, width: f32) -> Scene {
    let loaded = load(
        &Source::Shape(shape),
        &Preparation { crease_band: width, ..Preparation::default() },
        &Progress::default(),
    )
    .expect("shapes always load");
    engine().scene(&loaded, ARENA_BYTES).expect("shapes are small")
}

fn camera(scene: &Scene) -> Camera {
    Camera::framing(&scene.bounds, glam::vec2(SIZE[0] as f32, SIZE[1] as f32))
}

fn leaks(scene: &mut Scene, measured: &Measured, camera: &Camera) -> u64 {
    engine().leaks(scene, measured, SIZE, camera).expect("a readback").expect("a closed mesh before the eye")
}

#[test]
fn pn_tears_without_a_crease_band_and_is_whole_with_one() {
    for shape in [Shape::CubeSplit, Shape::Cylinder, Shape::Cone] {
        for partitioning in Partitioning::ALL {
            let pn = Settings::from(Tessellation {
                surface: Surface::Pn,
                partitioning,
                factor: 5.3,
                ..Tessellation::default()
            });
            for (width, is_whole) in [(0.0, false), (1e-3, true), (0.02, true)] {
                let mut scene = banded(shape, width);
                let camera = camera(&scene);
                let found = measured(&mut scene, &pn, &camera);
                let leaking = leaks(&mut scene, &found, &camera);
                let cracks = &found.cracks;
                assert!(cracks.edge_points > 0);
                assert_eq!(
                    (cracks.different_bits == 0, leaking == 0),
                    (is_whole, is_whole),
                    "{shape} {partitioning:?} {width}"
                );
                assert!(!is_whole || cracks.different_normals == 0, "{shape} {partitioning:?} {width}");
            }
        }
    }
}

#[test]
fn with_a_crease_band_pn_is_whole_on_whatever_breaks_tessellators() {
    let progress = Progress::default();
    let cases = CASES.iter().map(|case| (case.name, (case.mesh)(), case.weld));
    for (name, mesh, weld) in cases.chain((0..8).map(|seed| ("soup", soup(seed), 0.0))) {
        let welded = Topology::build_within(&mesh, weld, &progress).expect("nobody cancels");
        let (mesh, ..) =
            with_crease_band(&mesh, &welded, 0.01, &Budget::unlimited(), &progress).expect("nobody cancels");
        // All parts are PN.
        let mut scene = scene_of(Mesh { part_styles: Vec::new(), ..mesh }, 0.0);
        let camera = camera(&scene);
        for edges in [Edges::PerEdge, Edges::AsPublished] {
            let pn =
                Settings::from(Tessellation { surface: Surface::Pn, factor: 3.0, edges, ..Tessellation::default() });
            let cracks = measured(&mut scene, &pn, &camera).cracks;
            assert!(cracks.edges_compared > 0 || name == "borders", "{name}");
            match edges {
                Edges::PerEdge => assert_eq!(cracks.different_bits, 0, "{name}"),
                // No more than rounding.
                Edges::AsPublished => {
                    let size = f64::from(scene.bounds.max.abs().max(scene.bounds.min.abs()).max_element());
                    assert!(cracks.max_gap() <= 1e-5 * size, "{name}: {}", cracks.max_gap());
                }
            }
        }
    }
}

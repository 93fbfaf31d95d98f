//! Edges of displaced meshes, which crack where that is said and nowhere else.

use geometry::mesh::Shape;
use geometry::tessellate::{Displacement, HullFactors, Lod, Partitioning, Surface, Tessellation, tessellate_given};
use geometry::view::ulp;
use gpu::Timing;
use inspect::engine::Loaded;
use inspect::render::Scene;
use inspect::settings::Settings;

use super::{measured, shifted_torus, under_waves, wavy};
use crate::engine;

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
                let error = own.with(Tessellation { lod: Lod::Error, tolerance: 2.0, ..own.tessellation });
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

use std::sync::Arc;

use glam::camera::rh::proj::directx::perspective_infinite_reverse;
use glam::{Mat4, Vec2, vec3};

use super::*;
use crate::mesh::{HeightMap, Heights, PartRange, PartStyle, Shape};
use crate::progress::Progress;
use crate::tessellate::{Displacement, Lod, LodView, Surface, edge_factors, hull_factors, tessellate};

const TOLERANCE: f32 = 0.5;

/// Returns a shape, and inputs under which LOD by error gives its edges different factors.
fn shape(shape: Shape, tessellation: Tessellation) -> (Mesh, Topology, Inputs) {
    let mesh = shape.build();
    let topology = Topology::build(&mesh, &Progress::new()).expect("nobody cancels");
    let seen = Mat4::from_rotation_x(0.5) * Mat4::from_rotation_y(-0.6);
    let seen = Mat4::from_translation(vec3(0.0, 0.0, -2.6)) * seen;
    let view = LodView::new(perspective_infinite_reverse(0.8, 1.0, 0.05) * seen, Vec2::splat(300.0));
    let own = Tessellation { lod: Lod::Error, tolerance: TOLERANCE, ..tessellation };
    (mesh, topology, Inputs::new(&own, view))
}

/// Returns what is tried: partitionings, surfaces that tear and that don't, sides with factors of their own.
fn tried() -> Vec<(Shape, Tessellation)> {
    let whole = Tessellation { partitioning: Partitioning::Integer, ..Tessellation::default() };
    let mut all: Vec<_> = Partitioning::DIRECT3D
        .map(|partitioning| (Shape::Torus, Tessellation { partitioning, ..whole }))
        .into_iter()
        .collect();
    all.extend([
        (Shape::Moebius, whole),
        (Shape::CubeSplit, Tessellation { surface: Surface::Pn, ..whole }),
        (Shape::Icosahedron, Tessellation { surface: Surface::Flat, ..whole }),
        (Shape::Cone, Tessellation { edges: crate::tessellate::Edges::AsPublished, ..whole }),
        (Shape::Torus, Tessellation { convention: Convention::EdgeOrder, ..whole }),
    ]);
    all
}

#[test]
fn what_edges_were_asked_for_and_got_is_what_lod_by_error_gives_them() {
    let mut decided = [0; 6];
    for (kind, tessellation) in tried() {
        let (mesh, topology, inputs) = shape(kind, tessellation);
        let nets = ControlNets::new(&mesh, &topology, &inputs);
        let given = edge_factors(&mesh, &topology, &inputs);
        let out = tessellate(&mesh, &topology, &inputs, None);
        let explain = |(patch, used)| explain_patch(&mesh, &topology, &inputs, patch, used);
        let all: Vec<ExplainedPatch> = (0..).zip(out.patch_factors.iter().copied()).map(explain).collect();
        for (patch, explained) in (0..).zip(&all) {
            let used = out.patch_factors[patch as usize];
            let what = format!("{kind:?} {tessellation:?}, patch {patch}: {explained:?}");
            let edges = explained.edges.as_ref().expect("LOD is by error");
            for (side, edge) in edges.iter().enumerate() {
                assert_eq!(edge.got, given[nets.patch_factor(patch, side) as usize], "{what}");
                assert!(edge.own >= edge.least || explained.is_flat, "{what}");
                assert!(edge.got >= edge.own || edge.decided_by() == DecidedBy::All, "{what}");
                decided[edge.decided_by() as usize] += 1;
                for &(other, requested) in &edge.others {
                    let of_other = all[other as usize].edges.as_ref().expect("as above");
                    assert!(of_other.iter().any(|back| back.own == requested && back.got == edge.got), "{what}");
                }
            }
            let errors = explained.errors.expect("nothing is culled");
            assert!(errors.largest() <= TOLERANCE, "{what}");
            assert!(errors.rows.is_some() == (triangle_count(used) > 1 && !explained.is_flat), "{what}");
            assert!(explained.minimum.triangles >= 1, "{what}");
            assert!(!is_enough(BEYOND_LAST) && is_enough(explained.minimum.inside), "{what}");
        }
    }
    let expected = [DecidedBy::Curve, DecidedBy::Own, DecidedBy::Other, DecidedBy::Both];
    assert!(expected.iter().all(|&by| decided[by as usize] > 0), "{decided:?}");
}

#[test]
fn an_edge_that_gets_less_than_was_asked_for_has_what_all_edges_have() {
    let edge = |got| ExplainedEdge { least: 2.0, own: 5.0, others: vec![(1, 6.0)], got };
    assert_eq!([4.0, 6.0, 7.0].map(|got| edge(got).decided_by()), [DecidedBy::All, DecidedBy::Other, DecidedBy::Again]);
}

#[test]
fn patches_beside_no_other_have_their_own_least_if_edges_count_once() {
    // A patch whose neighbours request no more than it does, and which wouldn't request anything else by itself.
    let (mesh, topology, inputs) = shape(Shape::Torus, Tessellation::default());
    let out = tessellate(&mesh, &topology, &inputs, None);
    let least = minimum_triangles(&mesh, &topology, &inputs);
    let has: Vec<_> = out.patch_factors.iter().map(|&factors| triangle_count(factors)).collect();
    assert_eq!(least.len(), has.len());
    assert!(least.iter().zip(&has).any(|(least, has)| least == has));
    assert!(least.iter().zip(&has).any(|(least, has)| least < has));
    let fewer = least.iter().zip(&has).filter(|(least, has)| least > has).count();
    assert!(
        fewer * 50 < has.len(),
        "the search leaves out rows whose edge has far more segments than the rings: {fewer}"
    );
    for patch in [0, 7, 100] {
        let explained = explain_patch(&mesh, &topology, &inputs, patch, out.patch_factors[patch as usize]);
        assert_eq!(explained.minimum.triangles, least[patch as usize]);
        let Minimum { sides: [a, b, c], inside, triangles } = explained.minimum;
        let partitioning = inputs.tessellation.partitioning;
        assert_eq!(triangle_count(process(partitioning, [b, c, a], inside)), triangles);
    }
}

#[test]
fn other_lods_have_an_own_least_and_errors_and_no_requests() {
    for (lod, partitioning) in
        [(Lod::Uniform, Partitioning::Subtriangulation), (Lod::EdgeLength, Partitioning::Integer)]
    {
        let (mesh, topology, by_error) = shape(Shape::Torus, Tessellation { partitioning, ..Tessellation::default() });
        let inputs = Inputs::new(&Tessellation { lod, ..by_error.tessellation }, by_error.view);
        let out = tessellate(&mesh, &topology, &inputs, None);
        let explained = explain_patch(&mesh, &topology, &inputs, 3, out.patch_factors[3]);
        assert_eq!(explained.edges, None);
        assert!(explained.errors.is_some_and(|errors| errors.largest() > 0.0));
        assert_eq!(explained.errors.and_then(|errors| errors.rows).is_none(), lod == Lod::Uniform);
        let whole = Tessellation { partitioning: Partitioning::Integer, ..by_error.tessellation };
        let expected = minimum_triangles(&mesh, &topology, &Inputs::new(&whole, by_error.view));
        assert_eq!(explained.minimum.triangles, expected[3], "{lod:?}");
    }
}

#[test]
fn errors_are_bounds_and_near_the_largest_distance() {
    let (mesh, topology, inputs) = shape(Shape::Icosahedron, Tessellation::default());
    let used = process(Partitioning::Integer, [3.0, 2.0, 4.0], 3.0);
    let seen = MeshLod::new(&mesh, &topology, &inputs).seen_patch(0);
    let errors = pattern_errors(&seen, Convention::D3d11, used).expect("it is emitted");
    // At a tolerance below the largest bound the search finds a place that is farther off.
    let beyond = |tolerance: f32| {
        let plan = domain_plan(used);
        let place = |i| {
            let [x, y] = domain_point(&plan, i);
            Vec2::new(x as f32, y as f32) / FIXED_ONE as f32
        };
        (0..triangle_count(used))
            .any(|t| piece_error(&seen, tolerance, domain_triangle(&plan, t).map(place)) > tolerance)
    };
    assert!(errors.largest() > 1.0, "{errors:?}");
    assert!(!beyond(errors.largest() * 1.001));
    assert!(beyond(errors.largest() * 0.97));
}

#[test]
fn nothing_is_said_about_triangles_that_are_not_emitted() {
    let (mesh, topology, inputs) = shape(Shape::Torus, Tessellation::default());
    let explained = explain_patch(&mesh, &topology, &inputs, 0, PatchFactors::default());
    assert_eq!(explained.errors, None);
    assert!(explained.minimum.triangles > 0);
}

#[test]
fn heights_take_part() {
    let (mut mesh, topology, inputs) = shape(
        Shape::Torus,
        Tessellation { displacement: Displacement::On, partitioning: Partitioning::Integer, ..Tessellation::default() },
    );
    let heights = (0..4096).map(|i| ((i % 64) * (i / 64) % 7) as f32 / 6.0).collect();
    mesh.heights = Some(Arc::new(Heights::everywhere(&mesh, HeightMap::new([64, 64], heights))));
    let given = edge_factors(&mesh, &topology, &inputs);
    let written = hull_factors(&mesh, &topology, &inputs);
    for patch in [0, 50, 200] {
        let used = written[patch as usize].process(Partitioning::Integer);
        let explained = explain_patch(&mesh, &topology, &inputs, patch, used);
        assert_eq!(explained.tolerance, TOLERANCE);
        for (edge, side) in explained.edges.expect("by error").iter().zip(topology.patches[patch as usize].sides) {
            assert_eq!(edge.got, given[topology.sides[side as usize].edge as usize]);
        }
    }
}

#[test]
fn what_is_drawn_within_the_tolerance_is_never_fewer_than_the_least() {
    let mut found_more = 0;
    for partitioning in [Partitioning::Integer, Partitioning::FractionalOdd, Partitioning::Rows] {
        for (kind, tolerance) in [(Shape::Torus, 0.2), (Shape::CubeSmooth, 0.2)] {
            let (mesh, topology, inputs) = shape(kind, Tessellation { partitioning, ..Tessellation::default() });
            let inputs = Inputs { tessellation: Tessellation { tolerance, ..inputs.tessellation }, ..inputs };
            let searched = minimum_triangles(&mesh, &topology, &inputs);
            let out = tessellate(&mesh, &topology, &inputs, None);
            for patch in (0..topology.patches.len() as u32).step_by(5) {
                let used = out.patch_factors[patch as usize];
                let explained = explain_patch(&mesh, &topology, &inputs, patch, used);
                if explained.errors.is_none_or(|errors| errors.largest() > explained.tolerance) {
                    continue;
                }
                let (least, drawn) = (explained.minimum.triangles, triangle_count(used));
                assert!(least <= drawn, "{kind:?} {partitioning:?}, patch {patch}: {explained:?}, {drawn} are drawn");
                assert!(least <= searched[patch as usize]);
                found_more += usize::from(searched[patch as usize] > drawn);
            }
        }
    }
    assert!(found_more > 0, "the search alone should find more somewhere");
}

#[test]
fn the_numbers_of_a_formula_give_the_factor_of_the_edge() {
    for lod in [Lod::Paper, Lod::EdgeLength, Lod::Distance, Lod::Uniform] {
        for kind in [Shape::Torus, Shape::CubeSplit] {
            let own = Tessellation { pixels: 30.0, factor: 9.0, near: 1.5, far: 4.0, ..Tessellation::default() };
            let (mut mesh, topology, inputs) = shape(kind, own);
            if kind == Shape::Torus {
                mesh.part_ranges = vec![PartRange { triangles: 0..mesh.triangles.len() as u32 / 2, part: 0 }];
                mesh.part_styles = vec![PartStyle { detail: Some(1.5), ..PartStyle::default() }];
            }
            let inputs = Inputs { tessellation: Tessellation { lod, ..inputs.tessellation }, ..inputs };
            let nets = ControlNets::new(&mesh, &topology, &inputs);
            let given = edge_factors(&mesh, &topology, &inputs);
            let out = tessellate(&mesh, &topology, &inputs, None);
            let mut above = 0;
            for (patch, &used) in (0..).zip(&out.patch_factors) {
                let formulas =
                    explain_patch(&mesh, &topology, &inputs, patch, used).formulas.expect("it has a formula");
                for (side, (formula, detail)) in formulas.into_iter().enumerate() {
                    let factor = match formula {
                        EdgeFormula::Uniform { factor } => factor * detail,
                        EdgeFormula::Length { px, segment } => (px * detail / segment).max(1.0),
                        EdgeFormula::Distance { factors: [a, b], .. } => 0.5 * (a + b),
                    };
                    let expected = given[nets.patch_factor(patch, side) as usize];
                    assert!((factor - expected).abs() < 1e-5 * expected, "{lod:?} {kind:?}: {formula:?}, {expected}");
                    above += usize::from(expected > 1.0);
                }
            }
            assert!(above > out.patch_factors.len(), "{lod:?}: {above} of {} sides", 3 * out.patch_factors.len());
        }
    }
}

//! The page of results, which has every sentence and kind.

use super::*;

/// A finding of each kind, with the numbers that the manual has.
fn examples() -> Vec<Finding> {
    use crate::compare::corner_orders::CornerOrder;
    use crate::compare::explanations::{Explanation, InsideRule, Rule};
    use crate::compare::findings::{Displaced, UnknownFactors};
    let axes = |axes, scale| Finding::Aligned(Alignment { axes, scale, offset: DVec3::ZERO }.into());
    let space = |kind| Finding::Aligned(Space::from_kind(kind));
    let net = |mistake| Finding::OtherNets { mistake, vertices: 120, of: 300 };
    let edges = |share, bend| net(NetMistake::Edges { share, bend });
    let surface = |surface, alpha| Tessellation { surface, alpha, ..Tessellation::default() };
    let [pn_aen, pn] = [Surface::PnAen, Surface::Pn].map(|own| surface(own, 0.75));
    let raised = Tessellation { displacement: Displacement::On, ..pn_aen };
    let other = |ours, theirs| Finding::OtherSurface { ours, theirs, vertices: 120, of: 300 };
    let displaced = |is_along_normals, largest| {
        let (outward, inward, ours) = (0.03, 0.0, Displacement::Off);
        Finding::Displaced(Displaced { vertices: 290, of: 300, largest, outward, inward, is_along_normals, ours })
    };
    let place = DVec3::new(1.0, 2.0, 3.0);
    let (ours, convention) = (Partitioning::FractionalOdd, Convention::D3d11);
    let factors = |partitioning, rule| {
        let explanations = vec![Explanation { partitioning, rule }];
        Finding::Factors { ours, convention, explanations, patches: 64, of: 64 }
    };
    let farthest = Farthest { distance: 5e-6, patch: 0, theirs: place, ours: place };
    let unknown = |is_of_view| {
        let (suits, ours) = (vec![Partitioning::Integer], Partitioning::Integer);
        Finding::UnknownFactors(UnknownFactors { patches: 60, of: 64, sides: 170, inside: 2, suits, ours, is_of_view })
    };
    vec![
        Finding::NotATessellation { far: 1203, vertices: 4000, distance: 0.05 },
        axes([(0, false), (2, true), (1, false)], 100.0),
        axes([(0, false), (1, false), (2, true)], 1.0),
        space(SpaceKind::View),
        space(SpaceKind::Clip),
        space(SpaceKind::DividedClip),
        space(SpaceKind::Turned { axis: DVec3::Y, degrees: 30.0, scale: 1.0, offset: DVec3::X, is_mirrored: false }),
        net(NetMistake::Center(0.0)),
        net(NetMistake::Center(-1.0)),
        net(NetMistake::Center(1.0)),
        edges(0.5, 1.5),
        edges(2.0 * THIRD, 1.0),
        edges(THIRD, -1.0),
        edges(THIRD, 0.0),
        edges(THIRD, 3.0),
        edges(THIRD, 1.44),
        net(NetMistake::Times(1.5)),
        net(NetMistake::Swapped),
        net(NetMistake::Exchanged(1)),
        other(pn_aen, pn),
        other(surface(Surface::Phong, 0.75), surface(Surface::Phong, 1.0)),
        other(raised, pn_aen),
        displaced(true, 0.03),
        displaced(false, 0.04),
        Finding::Moved { vertices: 1, farthest: place, distance: 0.02, triangle: 7 },
        factors(ours, Rule::All(7.0)),
        factors(Partitioning::FractionalEven, Rule::Same),
        factors(ours, Rule::Sides([2, 0, 1])),
        factors(ours, Rule::Down),
        factors(ours, Rule::Inside(InsideRule::Mean)),
        factors(ours, Rule::Times(0.5)),
        factors(ours, Rule::AtMost(16.0)),
        unknown(false),
        unknown(true),
        Finding::Cracked { edges: 90, of: 96 },
        Finding::MissingPatches { patches: 2, of: 64, triangles: vec![17, 40] },
        Finding::AdditionalPatches { patches: 1, triangles: vec![5] },
        Finding::MissingTriangles { count: 1, patches: 1 },
        Finding::Doubled { count: 3, patches: 2 },
        Finding::Flipped { count: 9, of: 9 },
        Finding::OtherTriangles { count: 2, patches: 1, order: None },
        Finding::OtherTriangles { count: 40, patches: 8, order: Some(CornerOrder::ALL[1]) },
        Finding::Convention { ours: convention, theirs: Convention::AmdPn },
        Finding::NotFinite { count: 1 },
        Finding::Rounding { farthest, ulps: 42.0, triangle: 7 },
    ]
}

#[test]
fn the_results_have_every_sentence_and_kind() {
    let page = documents::in_repository("docs/results/compare-meshes.md");
    let page = std::fs::read_to_string(page).expect("a page");
    for finding in examples() {
        assert!(page.contains(&format!("| {} |", finding)), "the page lacks: {}", finding);
        assert!(page.contains(&format!("`{}`", finding.kind())), "the page lacks {}", finding.kind());
    }
}

use super::fronts::standings;
use super::lods::{saving, table_of, wastes};
use super::*;
use crate::chart::tests::{row, subject};
use crate::chart::{Cost, LodKind, Probe, Row, has_converged};
use geometry::tessellate::Surface;

use LodKind::{Error, Paper, Uniform};
use Surface::{Flat, PhongAen, PnAen};

fn occasion() -> Occasion {
    Occasion {
        adapter: "A_card 9".into(),
        driver: "its driver, 1.2".into(),
        is_software: false,
        date: "2026-11-22 06:00 UTC".into(),
        command: "pnaen chart shape:torus --report out".into(),
    }
}

/// A mesh of ten triangles that was compared with a reference surface.
fn part(rows: Vec<Row>) -> Part {
    let subject = subject(Some("the exact surface"), rows);
    Part { subject, patches: 10, split_edges: 0, picture: "torus.svg".into(), left_out: LeftOut::default() }
}

/// PN-AEN with uniform LOD and LOD by error. Each argument is the ms and triangles with which one has an error of 0.09 %.
fn duel(uniform: (f64, u64), error: (f64, u64)) -> Part {
    part(vec![
        row(PnAen, Uniform, 1.0, (1.0, 10, 0.03)),
        row(PnAen, Uniform, 8.0, (uniform.0, uniform.1, 0.0009)),
        row(PnAen, Error, 4.0, (1.0, 10, 0.03)),
        row(PnAen, Error, 1.0, (error.0, error.1, 0.0009)),
    ])
}

fn said(parts: &[Part]) -> String {
    advice::sentences(parts).join("\n")
}

#[test]
fn the_best_methods_follow_from_the_rows() {
    let text = said(&[duel((4.0, 400), (2.0, 100))]);
    let expected = "**Error of at most 0.1 % of the diagonal:** fewest triangles: pn-aen by error LOD (on 1 of 1 \
                    mesh); fastest, or at most 5 % slower: pn-aen by error LOD (on 1 of 1 mesh).";
    assert!(text.contains(expected), "{text}");
    let text = said(&[duel((2.0, 100), (4.0, 400))]);
    assert!(text.contains(&expected.replace("error LOD", "uniform LOD")), "{text}");
    // The method with fewer triangles may be slower, and a difference of 4 % counts as none.
    let text = said(&[duel((2.0, 400), (4.0, 100))]);
    assert!(text.contains("fewest triangles: pn-aen by error LOD (on 1"), "{text}");
    assert!(text.contains("slower: pn-aen by uniform LOD (on 1 of 1 mesh)."), "{text}");
    let text = said(&[duel((2.0, 400), (2.08, 100))]);
    assert!(text.contains("slower: pn-aen by uniform LOD (on 1 of 1 mesh) and pn-aen by error LOD (on 1)."), "{text}");
}

#[test]
fn the_method_of_most_meshes_comes_first() {
    let (by_error, uniform) = (duel((4.0, 400), (2.0, 100)), duel((2.0, 100), (4.0, 400)));
    let text = said(&[uniform.clone(), by_error.clone(), by_error.clone()]);
    assert!(
        text.contains("triangles: pn-aen by error LOD (on 2 of 3 meshes) and pn-aen by uniform LOD (on 1);"),
        "{text}"
    );
    let text = said(&[uniform.clone(), by_error, uniform]);
    assert!(
        text.contains("triangles: pn-aen by uniform LOD (on 2 of 3 meshes) and pn-aen by error LOD (on 1);"),
        "{text}"
    );
}

#[test]
fn meshes_that_need_no_tessellation_or_reach_no_error_are_named() {
    let text = said(&[duel((4.0, 400), (2.0, 100))]);
    assert!(text.contains("at most 0.01 % of the diagonal:** No setting reaches it on any mesh."), "{text}");
    let fine = part(vec![row(Flat, Uniform, 1.0, (1.0, 10, 0.002)), row(PnAen, Uniform, 2.0, (2.0, 40, 0.0001))]);
    let text = said(&[fine]);
    assert!(text.contains("1 % of the diagonal:** No tessellation is needed on Torus \\<7\\>."), "{text}");
}

#[test]
fn what_lod_by_error_saves_is_the_ratio_of_costs() {
    let parts = [duel((8.0, 400), (2.0, 100)), duel((4.0, 100), (4.0, 100))];
    let found = saving(&parts, Uniform, Cost::Triangles).expect("both reach it");
    assert!((found.times.mean - 2.0).abs() < 1e-12, "the geometric mean of 4 and 1: {found:?}");
    assert!((found.times.least, found.times.most) == (1.0, 4.0) && found.alone == [0, 0], "{found:?}");
    assert!(said(&parts).contains("takes 2.00 times fewer triangles than a uniform factor"), "{}", said(&parts));
    assert!(said(&parts).contains("and 2.00 times less time."), "{}", said(&parts));
    let text = said(&[duel((2.0, 100), (2.0, 400))]);
    assert!(text.contains("takes 4.00 times as many triangles as a uniform factor"), "{text}");
    assert!(text.contains("and about as much time."), "{text}");
    // The range has the word of the mean.
    assert!(said(&parts).contains("; 1.00 to 4.00 times fewer), and"), "{}", said(&parts));
    let text = said(&[duel((2.0, 100), (2.0, 400)), duel((4.0, 100), (4.0, 100))]);
    assert!(text.contains("takes 2.00 times as many triangles as a uniform factor (geometric"), "{text}");
    assert!(text.contains("; 1.00 to 4.00 times as many), and"), "{text}");
    assert_eq!(saving(&parts, Paper, Cost::Triangles), None, "the white paper's LOD wasn't tried");
    // Without a coarser setting of LOD by error, its least cost isn't known.
    let mut first = duel((8.0, 400), (2.0, 100));
    first.subject.rows.retain(|row| row.setting.value != 4.0);
    assert_eq!(saving(&[first], Uniform, Cost::Triangles), None);
    // An error that only one of them reaches is counted, and is not part of the mean.
    let mut alone = duel((8.0, 400), (2.0, 100));
    alone.subject.rows.push(row(PnAen, Error, 0.5, (3.0, 200, 0.0004)));
    let found = saving(&[alone], Uniform, Cost::Triangles).expect("one is reached by both");
    assert_eq!((found.times.mean, found.alone), (4.0, [1, 0]));
}

#[test]
fn a_method_has_converged_when_finer_is_no_closer() {
    let flat = vec![row(Flat, Uniform, 1.0, (1.0, 10, 0.03)), row(Flat, Uniform, 2.0, (1.5, 40, 0.03))];
    let method = flat[0].setting.method;
    assert!(!has_converged(&flat[..1], method) && has_converged(&flat, method));
    let mut falling = flat.clone();
    falling[1].probe.errors = row(Flat, Uniform, 2.0, (1.5, 40, 0.028)).probe.errors;
    assert!(!has_converged(&falling, method), "7 % less is closer");
    let mut turning = flat.clone();
    turning[1].probe.errors.as_mut().expect("known").normal_degrees = 2.0;
    assert!(!has_converged(&turning, method), "its normals still turn");
    let near = [flat[0].clone(), row(Flat, Uniform, 1.5, (1.2, 20, 0.03))];
    assert!(!has_converged(&near, method), "twice the triangles are too few to tell");
    assert!(!has_converged(&flat, row(PnAen, Uniform, 1.0, (1.0, 1, 1.0)).setting.method), "another method");
}

/// Flat, and another surface that comes no closer than an error.
fn with_limits(surface: Surface, error: f64) -> Part {
    part(vec![
        row(Flat, Uniform, 1.0, (1.0, 10, 0.04)),
        row(Flat, Uniform, 2.0, (1.5, 40, 0.04)),
        row(surface, Uniform, 1.0, (1.0, 10, 0.04)),
        row(surface, Uniform, 4.0, (2.0, 160, error)),
        row(surface, Uniform, 8.0, (4.0, 640, error)),
    ])
}

#[test]
fn the_limit_of_a_surface_is_named_with_its_reason() {
    let text = said(&[with_limits(PhongAen, 0.02)]);
    assert!(
        text.contains(
            "However fine, `flat` comes no closer than 4.00 % (Torus \\<7\\>), on 1 of 1 mesh: its points lie"
        ),
        "{text}"
    );
    assert!(text.contains("`phong-aen` comes no closer than 2.00 %"), "{text}");
    assert!(text.contains("its error is 0.5 times that of `flat`"), "{text}");
    assert!(text.contains("It is 2.00 times closer than `flat`."), "{text}");
    let text = said(&[with_limits(PhongAen, 0.02), with_limits(PhongAen, 0.08)]);
    assert!(text.contains("no closer than 2.00 % (Torus \\<7\\>) to 4.00 %"), "its coarsest setting is closer: {text}");
    // Without its last setting, no limit is known.
    let mut open = with_limits(PhongAen, 0.02);
    open.subject.rows.truncate(4);
    let text = said(&[open]);
    assert!(!text.contains("`phong-aen` comes no closer"), "{text}");
}

#[test]
fn creases_are_named_as_the_reason_only_where_they_are() {
    let mut creased = with_limits(PnAen, 0.05);
    creased.subject.rows.remove(2);
    assert!(!said(&[creased.clone()]).contains("there are creases"), "it has none");
    creased.split_edges = 8;
    let text = said(&[creased.clone()]);
    assert!(text.contains("On Torus \\<7\\> `flat` comes closer than `pn-aen`: there are creases"), "{text}");
    let mut near = with_limits(PnAen, 0.01);
    near.split_edges = 8;
    assert!(!said(&[near]).contains("there are creases"), "it is closer than flat");
}

#[test]
fn fronts_are_counted_without_the_mesh_as_it_is() {
    let parts = [duel((4.0, 400), (2.0, 100)), duel((1.5, 400), (2.0, 100))];
    let standings = standings(&parts);
    let found = |lod: LodKind| standings.iter().find(|standing| standing.method.lod == lod).expect("it was tried");
    assert_eq!((found(Error).meshes, found(Error).settings), ([2, 1], [2, 1]));
    assert_eq!((found(Uniform).meshes, found(Uniform).tried), ([0, 1], 2));
    let text = said(&parts[..1]);
    assert!(text.contains("Most often on the front by triangles: pn-aen by error LOD, on 1 of 1 mesh."), "{text}");
    assert!(text.contains("On no front at all: pn-aen by uniform LOD."), "{text}");
}

#[test]
fn a_page_has_its_occasion_and_a_section_for_each_mesh() {
    let mut own = with_limits(PnAen, 0.0009);
    own.left_out = LeftOut { too_large: 3, most_triangles: 500_000, converged: 12, interrupted: 0 };
    let text = page(&occasion(), &[own.clone()]);
    let start = "# Speed against accuracy\n\nMeasured on A\\_card 9 (its driver, 1.2), 2026-11-22 06:00 UTC, by\n\n    \
                 pnaen chart shape:torus --report out\n\n";
    assert!(text.starts_with(start), "{text}");
    assert!(!text.contains("This adapter is software") && text.contains("](torus.svg)"), "{text}");
    assert!(text.contains("| 0.1 % | pn-aen by uniform LOD | 4 | 160 | 2.00 | 0.0900 | 0.0450 | "), "{text}");
    assert!(text.contains("\n0.1 %: not reached by flat by any LOD.\n"), "{text}");
    let left_out = "Left out are settings: 3 with more than 500,000 triangles and 12 whose method came as close";
    assert!(text.contains(left_out), "{text}");
    let software = Occasion { is_software: true, ..occasion() };
    assert!(page(&software, &[own]).contains("This adapter is software."));
}

#[test]
fn without_a_reference_surface_surfaces_are_not_compared() {
    let mut own = with_limits(PnAen, 0.2);
    own.subject.reference_shape = None;
    let text = page(&occasion(), &[own.clone()]);
    assert!(text.contains("- Torus \\<7\\>: no reference surface is known"), "{text}");
    assert!(
        text.contains("in triangles or in ms (`flat`, compared with its own limit):")
            && !text.contains("no closer than"),
        "{text}"
    );
    assert!(!text.contains("### Error of at most") && text.contains("| largest error, px |\n"), "{text}");
    assert!(page(&occasion(), &[]).contains("## Which method to use when"), "a page without meshes");
}

#[test]
fn triangles_are_held_against_those_that_lod_by_error_needs() {
    let needing =
        |needed: Option<u64>, row: Row| Row { probe: Probe { triangles_by_error: needed, ..row.probe }, ..row };
    let two = |needed: [Option<u64>; 2]| {
        part(vec![
            needing(Some(10), row(PnAen, Uniform, 1.0, (1.0, 10, 0.03))),
            needing(needed[0], row(PnAen, Uniform, 4.0, (1.0, 160, 0.004))),
            needing(needed[1], row(PnAen, Uniform, 8.0, (1.0, 640, 0.0008))),
            needing(Some(100), row(PnAen, Error, 1.0, (1.0, 100, 0.0008))),
        ])
    };
    let found = wastes(&[two([Some(80), Some(80)])]);
    let uniform = found.last().expect("two methods");
    assert_eq!((found.len(), found[0].times.mean, uniform.method.lod), (2, 1.0, Uniform), "the least first");
    assert_eq!((uniform.count, uniform.times.least, uniform.times.most), (2, 2.0, 8.0), "the plain mesh doesn't count");
    assert!((uniform.times.mean - 4.0).abs() < 1e-12, "the geometric mean of 2 and 8: {found:?}");
    let text = table_of(&[two([Some(80), None])]);
    assert!(text.contains("| 1 | 2.00 | 2.00 | 2.00 |"), "what can't be compared is left out: {text}");
    assert_eq!(table_of(&[]), "");
}

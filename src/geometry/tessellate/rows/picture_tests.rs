//! The manual's picture of rows, `docs/manual/rows.svg`. `PNAEN_UPDATE_PAGES=1` writes it again.

use std::fmt::Write;

use super::*;
use crate::tessellate::factors::{Partitioning, ROW_BASE_STEP, process, triangle_count};
use crate::tessellate::{domain_plan, domain_point, domain_triangle};

/// What is drawn: the segments of the first edge, of the second, of the base, the width, and 1 if diagonals are flipped.
const DRAWN: [[u32; 5]; 8] = [
    [4, 4, 4, 4, 0],
    [2, 2, 6, 6, 0],
    [1, 1, 5, 1, 0],
    [6, 3, 4, 4, 0],
    [5, 5, 1, 1, 0],
    [5, 5, 1, 1, 1],
    [6, 6, 3, 3, 0],
    [6, 6, 3, 3, 1],
];

/// How many patterns stand beside each other.
const BESIDE: usize = 4;

/// The size of one pattern and of the margin around it, in px.
const SIDE: f64 = 150.0;
const MARGIN: f64 = 20.0;

/// Returns a pattern with its apex at the top and its base at the bottom, and what it is.
fn drawn([a, b, c, width, flip]: [u32; 5], [left, top]: [f64; 2]) -> String {
    let factors =
        process(Partitioning::Rows, [c as f32, b as f32, a as f32], (ROW_BASE_STEP * (1 + 3 * flip) + width) as f32);
    let plan = domain_plan(factors);
    // U is the weight of the apex and V that of the base's start.
    let place = |i: u32| {
        let [apex, start] = domain_point(&plan, i).map(|weight| f64::from(weight) / f64::from(FIXED_ONE));
        let across = (1.0 - apex - start) + 0.5 * apex;
        format!("{:.1},{:.1}", left + SIDE * across, top + SIDE * 0.866 * (1.0 - apex))
    };
    let mut text = String::new();
    for t in 0..triangle_count(factors) {
        let points = domain_triangle(&plan, t).map(place).join(" ");
        writeln!(text, "<polygon points=\"{points}\"/>").expect("memory");
    }
    let triangles = triangle_count(factors);
    let lines = [
        format!("{a} and {b} segments beside, {c} below"),
        format!("width {width}{}: {triangles} triangles", if flip == 1 { ", flipped" } else { "" }),
    ];
    for (line, y) in lines.iter().zip([18.0, 34.0]) {
        let (x, y) = (left + 0.5 * SIDE, top + 0.866 * SIDE + y);
        writeln!(text, "<text x=\"{x:.1}\" y=\"{y:.1}\">{line}</text>").expect("memory");
    }
    text
}

#[test]
fn the_manuals_picture_shows_the_patterns() {
    let [across, down] = [SIDE + 2.0 * MARGIN + 30.0, SIDE * 0.866 + 2.0 * MARGIN + 30.0];
    let patterns = DRAWN.iter().enumerate().map(|(i, pattern)| {
        let left = (i % BESIDE) as f64 * across + MARGIN + 15.0;
        drawn(*pattern, [left, (i / BESIDE) as f64 * down + MARGIN])
    });
    let picture = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0} {1:.0}\" width=\"{0:.0}\" height=\"{1:.0}\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n\
         <g fill=\"#e8eef4\" stroke=\"#1f2a35\" stroke-width=\"1\" stroke-linejoin=\"round\">\n\
         <style>text {{ font: 12px sans-serif; fill: #1f2a35; stroke: none; text-anchor: middle }}</style>\n\
         {2}</g>\n</svg>\n",
        BESIDE as f64 * across,
        DRAWN.len().div_ceil(BESIDE) as f64 * down,
        patterns.collect::<String>()
    );
    let path = documents::in_repository("docs/manual/rows.svg");
    if std::env::var_os("PNAEN_UPDATE_PAGES").is_some() {
        std::fs::write(&path, &picture).expect("a writable file");
    }
    assert!(
        std::fs::read_to_string(&path).is_ok_and(|kept| kept == picture),
        "rows.svg is out of date; PNAEN_UPDATE_PAGES=1 writes it"
    );
}

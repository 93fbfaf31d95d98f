//! A vase of bicubic Bézier patches: the one shape that is made as modellers make theirs.

use std::f64::consts::TAU;

use glam::{DVec3, Vec2};

use super::{corner, quad};
use crate::mesh::Corner;

/// 4 by 4 control points: the first index runs around the vase, the second up.
pub(crate) type BezierNet = [[DVec3; 4]; 4];

/// Patches around and up.
const AROUND: usize = 5;
const UP: usize = 3;
/// Quads along a patch's side at level 0.
const CELLS: usize = 2;

/// Rings of a cubic spline's control points: height, radius, and how far the ring is moved to the right.
const RINGS: [[f64; 3]; UP + 3] = [
    [-1.15, 0.62, 0.02],
    [-0.75, 0.55, 0.0],
    [-0.35, 1.1, -0.06],
    [0.2, 0.95, 0.04],
    [0.7, 0.42, 0.1],
    [1.15, 0.8, 0.16],
];
/// What a ring's radius is multiplied by from column to column, so that no two sides are alike.
const LOBES: [f64; AROUND] = [1.0, 0.88, 1.1, 0.94, 1.06];
/// Turn from one ring to the next, in turns.
const TWIST: f64 = 0.02;

/// Control point of the spline; columns repeat.
fn control_point(column: usize, row: usize) -> DVec3 {
    let [height, radius, aside] = RINGS[row];
    let (sin, cos) = (TAU * (column as f64 / AROUND as f64 + TWIST * row as f64)).sin_cos();
    let out = radius * LOBES[column % AROUND];
    DVec3::new(out * sin + aside, height, out * cos)
}

/// The patches, those of a column one after another upwards. Neighbours share position, tangents and curvature, since all
/// are pieces of one uniform cubic spline.
pub(crate) fn patches() -> Vec<BezierNet> {
    let patch = |column: usize, row: usize| {
        let rows = [0, 1, 2, 3].map(|i| piece([0, 1, 2, 3].map(|j| control_point(column + i, row + j))));
        let columns = [0, 1, 2, 3].map(|j| piece(rows.map(|row| row[j])));
        [0, 1, 2, 3].map(|i| [0, 1, 2, 3].map(|j| columns[j][i]))
    };
    (0..AROUND).flat_map(|column| (0..UP).map(move |row| patch(column, row))).collect()
}

/// The Bézier control points of the piece of a uniform cubic spline that four of its control points govern.
fn piece([a, b, c, d]: [DVec3; 4]) -> [DVec3; 4] {
    [(a + 4.0 * b + c) / 6.0, (2.0 * b + c) / 3.0, (b + 2.0 * c) / 3.0, (b + 4.0 * c + d) / 6.0]
}

/// Position and the derivatives by `u` (around) and `v` (up) that its normal is made of.
pub(crate) fn at(net: &BezierNet, u: f64, v: f64) -> [DVec3; 3] {
    let sum = |by_u: [f64; 4], by_v: [f64; 4]| {
        (0..4).map(|i| by_u[i] * (0..4).map(|j| by_v[j] * net[i][j]).sum::<DVec3>()).sum()
    };
    let [(at_u, along_u), (at_v, along_v)] = [u, v].map(|t| (weights(t), slopes(t)));
    [sum(at_u, at_v), sum(along_u, at_v), sum(at_u, along_v)]
}

/// Bernstein's cubics.
pub(crate) fn weights(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
}

/// Their derivatives.
pub(crate) fn slopes(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [-3.0 * s * s, 3.0 * s * (s - 2.0 * t), 3.0 * t * (2.0 * s - t), 3.0 * t * t]
}

/// Quads sampled from the patches.
pub(super) fn vase(level: u32) -> Vec<[Corner; 3]> {
    let patches = patches();
    let cells = CELLS << level;
    let (columns, rows) = (AROUND * cells, UP * cells);
    let node = |i: usize, j: usize| {
        let (column, row) = (i % columns / cells, (j / cells).min(UP - 1));
        let [u, v] = [i % columns - column * cells, j - row * cells].map(|step| step as f64 / cells as f64);
        let [position, around, up] = at(&patches[column * UP + row], u, v);
        let uv = Vec2::new(i as f32 / columns as f32, 1.0 - j as f32 / rows as f32);
        corner(position.as_vec3(), around.cross(up).normalize().as_vec3(), uv)
    };
    let mut triangles = Vec::with_capacity(2 * columns * rows);
    for i in 0..columns {
        for j in 0..rows {
            triangles.extend(quad([node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)]));
        }
    }
    triangles
}

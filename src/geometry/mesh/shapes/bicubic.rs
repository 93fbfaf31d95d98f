//! A vase of bicubic Bézier patches, as modelling programs make them.

use std::f64::consts::TAU;

use glam::{DVec3, Vec2};

use super::{corner, grid, quad};
use crate::mesh::Corner;

/// 4 by 4 control points. The first index runs around the vase, the second one upwards.
pub type BezierNet = [[DVec3; 4]; 4];

/// The number of patches around the vase.
const AROUND: usize = 5;
/// The number of patches from bottom to top.
const UP: usize = 3;
/// The number of quads along a patch's side at level 0.
const CELLS: usize = 2;

/// The rings of control points of the cubic spline: height, radius, and how far the ring is moved along +X.
const RINGS: [[f64; 3]; UP + 3] = [
    [-1.15, 0.62, 0.02],
    [-0.75, 0.55, 0.0],
    [-0.35, 1.1, -0.06],
    [0.2, 0.95, 0.04],
    [0.7, 0.42, 0.1],
    [1.15, 0.8, 0.16],
];
/// The factor of a ring's radius at each column, which makes all sides different.
const LOBES: [f64; AROUND] = [1.0, 0.88, 1.1, 0.94, 1.06];
/// The rotation from one ring to the next, in turns.
const TWIST: f64 = 0.02;

/// Returns a control point of the spline. Columns repeat.
fn control_point(column: usize, row: usize) -> DVec3 {
    let [height, radius, aside] = RINGS[row];
    let (sin, cos) = (TAU * (column as f64 / AROUND as f64 + TWIST * row as f64)).sin_cos();
    let out = radius * LOBES[column % AROUND];
    DVec3::new(out * sin + aside, height, out * cos)
}

/// Returns the patches column by column, each from bottom to top. Neighbours share position, tangents and curvature,
/// since all are pieces of one uniform cubic spline.
pub fn patches() -> Vec<BezierNet> {
    let patch = |column: usize, row: usize| {
        let rows = [0, 1, 2, 3].map(|i| piece([0, 1, 2, 3].map(|j| control_point(column + i, row + j))));
        let columns = [0, 1, 2, 3].map(|j| piece(rows.map(|row| row[j])));
        [0, 1, 2, 3].map(|i| [0, 1, 2, 3].map(|j| columns[j][i]))
    };
    (0..AROUND).flat_map(|column| (0..UP).map(move |row| patch(column, row))).collect()
}

/// Returns the Bézier control points of the piece of a uniform cubic spline that depends on these four control points.
fn piece([a, b, c, d]: [DVec3; 4]) -> [DVec3; 4] {
    [(a + 4.0 * b + c) / 6.0, (2.0 * b + c) / 3.0, (b + 2.0 * c) / 3.0, (b + 4.0 * c + d) / 6.0]
}

/// Returns the position and the derivatives by `u` (around) and `v` (up), whose cross product is the normal.
pub fn at(net: &BezierNet, u: f64, v: f64) -> [DVec3; 3] {
    let sum = |by_u: [f64; 4], by_v: [f64; 4]| {
        (0..4).map(|i| by_u[i] * (0..4).map(|j| by_v[j] * net[i][j]).sum::<DVec3>()).sum()
    };
    let [(at_u, along_u), (at_v, along_v)] = [u, v].map(|t| (weights(t), slopes(t)));
    [sum(at_u, at_v), sum(along_u, at_v), sum(at_u, along_v)]
}

/// Returns the cubic Bernstein polynomials at t.
pub fn weights(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
}

/// Returns the derivatives of the cubic Bernstein polynomials at t.
pub fn slopes(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [-3.0 * s * s, 3.0 * s * (s - 2.0 * t), 3.0 * t * (2.0 * s - t), 3.0 * t * t]
}

/// Samples the patches at quads.
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
    grid(columns, rows, |i, j| quad([node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_points_lie_on_their_rings() {
        for (row, [height, radius, aside]) in RINGS.into_iter().enumerate() {
            for (column, lobe) in LOBES.into_iter().enumerate() {
                let point = control_point(column, row);
                let out = (point.x - aside).hypot(point.z);
                assert!((out - radius * lobe).abs() < 1e-12 && point.y == height, "{column}, {row}: {point}");
            }
        }
    }
}

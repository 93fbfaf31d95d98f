//! Torus, cylinder and cone: shapes that turn around the Y axis.

use std::f32::consts::TAU;

use glam::{Vec2, Vec3};

use super::{corner, grid, quad};
use crate::mesh::Corner;

/// The number of sides of cylinder and cone at level 0, where sides and caps have one row.
const SIDES: usize = 12;
/// The radius of cylinder and cone.
pub const RADIUS: f32 = 0.6;
/// Half of the height of cylinder and cone.
pub const HALF_HEIGHT: f32 = 0.75;
/// The radius of the circle in the middle of the torus's tube.
pub const MAJOR: f32 = 0.7;
/// The radius of the torus's tube.
pub const MINOR: f32 = 0.3;

/// Returns the direction of column i of n around the Y axis, from +Z towards +X. Column n equals column 0 to the last
/// bit.
fn around(i: usize, n: usize) -> Vec3 {
    let (sin, cos) = (TAU * (i % n) as f32 / n as f32).sin_cos();
    Vec3::new(sin, 0.0, cos)
}

fn fraction(i: usize, n: usize) -> f32 {
    i as f32 / n as f32
}

pub(super) fn torus(level: u32) -> Vec<[Corner; 3]> {
    let (columns, rows) = (16 << level, 8 << level);
    let node = |i: usize, j: usize| {
        let out = around(i, columns);
        let (sin, cos) = (TAU * (j % rows) as f32 / rows as f32).sin_cos();
        let normal = out * cos + Vec3::Y * sin;
        let uv = Vec2::new(fraction(i, columns), 1.0 - fraction(j, rows));
        corner(out * MAJOR + normal * MINOR, normal, uv)
    };
    grid(columns, rows, |i, j| quad([node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)])).collect()
}

pub(super) fn cylinder(level: u32) -> Vec<[Corner; 3]> {
    let (sides, rows) = (SIDES << level, 1 << level);
    let wall = |i: usize, j: usize| {
        let v = fraction(j, rows);
        let position = around(i, sides) * RADIUS + Vec3::Y * (HALF_HEIGHT * (1.0 - 2.0 * v));
        corner(position, around(i, sides), Vec2::new(fraction(i, sides), v))
    };
    let walls = grid(sides, rows, |i, j| quad([wall(i, j + 1), wall(i + 1, j + 1), wall(i + 1, j), wall(i, j)]));
    walls.chain(cap(HALF_HEIGHT, level)).chain(cap(-HALF_HEIGHT, level)).collect()
}

pub(super) fn cone(level: u32) -> Vec<[Corner; 3]> {
    let (sides, rows) = (SIDES << level, 1 << level);
    // The normal of a side: at right angles to the line from the apex to the base circle.
    let normal = |out: Vec3| out * (2.0 * HALF_HEIGHT) + Vec3::Y * RADIUS;
    let slope = |i: usize, j: usize| {
        let v = fraction(j, rows);
        let position = around(i, sides) * (RADIUS * v) + Vec3::Y * (HALF_HEIGHT * (1.0 - 2.0 * v));
        corner(position, normal(around(i, sides)), Vec2::new(fraction(i, sides), v))
    };
    let side = |i: usize| {
        // At the apex, a side has the normal of its middle, half a column farther.
        let (middle, halves) = (2 * i + 1, 2 * sides);
        let uv = Vec2::new(fraction(middle, halves), 0.0);
        let apex = corner(Vec3::Y * HALF_HEIGHT, normal(around(middle, halves)), uv);
        let rest =
            (1..rows).flat_map(move |j| quad([slope(i, j + 1), slope(i + 1, j + 1), slope(i + 1, j), slope(i, j)]));
        std::iter::once([slope(i, 1), slope(i + 1, 1), apex]).chain(rest)
    };
    (0..sides).flat_map(side).chain(cap(-HALF_HEIGHT, level)).collect()
}

/// Returns a disc around the Y axis that faces away from the shape's centre.
fn cap(y: f32, level: u32) -> impl Iterator<Item = [Corner; 3]> {
    let (sides, rows) = (SIDES << level, 1 << level);
    let normal = Vec3::Y * y;
    let at = move |position: Vec3| {
        let uv = Vec2::new(position.x, position.z) / (2.0 * RADIUS) + 0.5;
        corner(position, normal, uv)
    };
    (0..sides).flat_map(move |i| {
        let (a, b) = if y > 0.0 { (i, i + 1) } else { (i + 1, i) };
        let node = move |i: usize, j: usize| at(around(i, sides) * (RADIUS * fraction(j, rows)) + Vec3::Y * y);
        let rest = (1..rows).flat_map(move |j| quad([node(a, j), node(a, j + 1), node(b, j + 1), node(b, j)]));
        std::iter::once([at(Vec3::Y * y), node(a, 1), node(b, 1)]).chain(rest)
    })
}

//! Torus, cylinder and cone: shapes that turn around the Y axis.

use std::f32::consts::TAU;

use glam::{Vec2, Vec3};

use super::{corner, quad};
use crate::mesh::Corner;

/// Sides of cylinder and cone.
const SIDES: usize = 12;
/// Radius of cylinder and cone, and half their height.
const RADIUS: f32 = 0.6;
const HALF_HEIGHT: f32 = 0.75;

/// The direction of column i of n around Y, from +Z towards +X; column n is column 0 to the last bit.
fn around(i: usize, n: usize) -> Vec3 {
    let (sin, cos) = (TAU * (i % n) as f32 / n as f32).sin_cos();
    Vec3::new(sin, 0.0, cos)
}

fn fraction(i: usize, n: usize) -> f32 {
    i as f32 / n as f32
}

pub(super) fn torus() -> Vec<[Corner; 3]> {
    const COLUMNS: usize = 16;
    const ROWS: usize = 8;
    let node = |i: usize, j: usize| {
        let out = around(i, COLUMNS);
        let (sin, cos) = (TAU * (j % ROWS) as f32 / ROWS as f32).sin_cos();
        let normal = out * cos + Vec3::Y * sin;
        let uv = Vec2::new(fraction(i, COLUMNS), 1.0 - fraction(j, ROWS));
        corner(out * 0.7 + normal * 0.3, normal, uv)
    };
    let cell = |i, j| quad([node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)]);
    (0..COLUMNS).flat_map(|i| (0..ROWS).flat_map(move |j| cell(i, j))).collect()
}

pub(super) fn cylinder() -> Vec<[Corner; 3]> {
    let wall = |i: usize, v: f32| {
        let out = around(i, SIDES);
        corner(rim(i, HALF_HEIGHT * (1.0 - 2.0 * v)), out, Vec2::new(fraction(i, SIDES), v))
    };
    let walls = (0..SIDES).flat_map(|i| quad([wall(i, 1.0), wall(i + 1, 1.0), wall(i + 1, 0.0), wall(i, 0.0)]));
    walls.chain(cap(HALF_HEIGHT)).chain(cap(-HALF_HEIGHT)).collect()
}

pub(super) fn cone() -> Vec<[Corner; 3]> {
    // The slope's normal: perpendicular to the line from the apex to the rim.
    let normal = |out: Vec3| out * (2.0 * HALF_HEIGHT) + Vec3::Y * RADIUS;
    let base = |i: usize| corner(rim(i, -HALF_HEIGHT), normal(around(i, SIDES)), Vec2::new(fraction(i, SIDES), 1.0));
    let side = |i: usize| {
        // Seen from the apex a side has one direction: that of its middle, half a column on.
        let apex = corner(
            Vec3::Y * HALF_HEIGHT,
            normal(around(2 * i + 1, 2 * SIDES)),
            Vec2::new(fraction(2 * i + 1, 2 * SIDES), 0.0),
        );
        [base(i), base(i + 1), apex]
    };
    (0..SIDES).map(side).chain(cap(-HALF_HEIGHT)).collect()
}

fn rim(i: usize, y: f32) -> Vec3 {
    around(i, SIDES) * RADIUS + Vec3::Y * y
}

/// A disc around a middle point, facing away from the shape's centre.
fn cap(y: f32) -> impl Iterator<Item = [Corner; 3]> {
    let normal = Vec3::Y * y;
    let at = move |position: Vec3| {
        let uv = Vec2::new(position.x, position.z) / (2.0 * RADIUS) + 0.5;
        corner(position, normal, uv)
    };
    (0..SIDES).map(move |i| {
        let (a, b) = if y > 0.0 { (i, i + 1) } else { (i + 1, i) };
        [at(Vec3::Y * y), at(rim(a, y)), at(rim(b, y))]
    })
}

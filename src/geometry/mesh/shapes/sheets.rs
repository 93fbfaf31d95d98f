//! Saddle and Möbius strip: open surfaces.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3};

use super::{corner, grid, quad};
use crate::mesh::Corner;

/// The number of quads along each side of the saddle at level 0.
const CELLS: usize = 6;
/// Half of the side of the saddle's square.
pub const SADDLE_HALF: f32 = 0.8;
/// The number of quads along and across the Möbius strip.
const LENGTH: usize = 24;
const WIDTH: usize = 2;

pub(super) fn saddle(level: u32) -> Vec<[Corner; 3]> {
    let cells = CELLS << level;
    let node = |i: usize, j: usize| {
        let uv = Vec2::new(i as f32, j as f32) / cells as f32;
        let [x, z] = [uv.x, uv.y].map(|t| 2.0 * SADDLE_HALF * t - SADDLE_HALF);
        corner(Vec3::new(x, (x * x - z * z) / 2.0, z), Vec3::new(-x, 1.0, z), uv)
    };
    sheet(cells, cells, node)
}

pub(super) fn moebius() -> Vec<[Corner; 3]> {
    let node = |i: usize, j: usize| {
        // The last column is the first one upside down: the same positions to the last bit, with opposite normals.
        let (column, row, flip) = if i == LENGTH { (0, WIDTH - j, -1.0) } else { (i, j, 1.0) };
        let uv = Vec2::new(i as f32 / LENGTH as f32, j as f32 / WIDTH as f32);
        let turn = TAU * column as f32 / LENGTH as f32;
        let across = 2.0 * row as f32 / WIDTH as f32 - 1.0;
        let (position, normal) = moebius_at(turn, 0.3 * across);
        corner(position, flip * normal, uv)
    };
    sheet(LENGTH, WIDTH, node)
}

/// Returns position and normal at an angle around the Y axis and a distance from the middle line, which has radius 0.7.
fn moebius_at(turn: f32, across: f32) -> (Vec3, Vec3) {
    let out = Vec3::new(turn.sin(), 0.0, turn.cos());
    let along = Vec3::new(turn.cos(), 0.0, -turn.sin());
    // Half a twist in one turn.
    let (sin, cos) = (turn * PI / TAU).sin_cos();
    let rung = out * cos + Vec3::Y * sin;
    let rung_change = (Vec3::Y * cos - out * sin) / 2.0 + along * cos;
    let ahead = along * 0.7 + rung_change * across;
    (out * 0.7 + rung * across, rung.cross(ahead))
}

/// Returns the sheet whose corner at column i and row j is `node(i, j)`; seen from outside, row numbers increase to the left
/// of the direction in which column numbers increase.
fn sheet(columns: usize, rows: usize, node: impl Fn(usize, usize) -> Corner) -> Vec<[Corner; 3]> {
    grid(columns, rows, |i, j| quad([node(i, j), node(i, j + 1), node(i + 1, j + 1), node(i + 1, j)])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_sheet_shows_a_texture_once() {
        for triangles in [saddle(0), moebius()] {
            let uvs = triangles.as_flattened().iter().map(|corner| corner.uv);
            let (least, greatest) = (uvs.clone().fold(Vec2::MAX, Vec2::min), uvs.fold(Vec2::MIN, Vec2::max));
            assert_eq!((least, greatest), (Vec2::ZERO, Vec2::ONE));
        }
    }

    #[test]
    fn normals_of_the_moebius_strip_are_perpendicular_to_it() {
        let at = |turn: f32, across: f32| moebius_at(turn, across).0;
        let step = 1e-2;
        for i in 0..48 {
            for across in [-0.3, 0.0, 0.2] {
                let turn = TAU * i as f32 / 48.0;
                let ahead = at(turn + step, across) - at(turn - step, across);
                let beside = at(turn, across + step) - at(turn, across - step);
                let normal = moebius_at(turn, across).1.normalize();
                let leaning = normal.dot(ahead.normalize()).abs().max(normal.dot(beside.normalize()).abs());
                assert!(leaning < 1e-3, "{turn}, {across}: {leaning}");
            }
        }
    }
}

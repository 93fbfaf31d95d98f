//! Cubes, the icosahedron, the icosphere and the ellipsoid.

use std::collections::HashMap;

use glam::{Vec2, Vec3};

use super::{corner, quad};
use crate::mesh::Corner;

/// Half of a cube's side, which puts its corners about 1 object unit from the centre.
const HALF: f32 = 0.6;
/// The radii of the ellipsoid along x, y and z.
pub const ELLIPSOID: Vec3 = Vec3::new(1.0, 0.6, 0.8);

pub(super) fn cube_smooth() -> Vec<[Corner; 3]> {
    let mut triangles = cube(|position, _| position);
    for corner in triangles.iter_mut().flatten() {
        // A uv square for each face would split the corners again.
        corner.uv = Vec2::ZERO;
    }
    triangles
}

/// Returns a cube. `normal` returns the normal at a position on a side, whose own normal it gets too.
pub(super) fn cube(normal: impl Fn(Vec3, Vec3) -> Vec3) -> Vec<[Corner; 3]> {
    let axes = [Vec3::X, Vec3::Y, Vec3::Z];
    let face = |out: Vec3, right: Vec3| {
        let up = out.cross(right);
        let at = |u: f32, v: f32| {
            let position = HALF * (out + (2.0 * u - 1.0) * right + (1.0 - 2.0 * v) * up);
            corner(position, normal(position, out), Vec2::new(u, v))
        };
        quad([at(0.0, 1.0), at(1.0, 1.0), at(1.0, 0.0), at(0.0, 0.0)])
    };
    (0..3).flat_map(|k| [face(axes[k], axes[(k + 1) % 3]), face(-axes[k], axes[(k + 1) % 3])]).flatten().collect()
}

/// Returns the icosahedron with each triangle cut into four `levels` times, and all points moved to the unit sphere.
pub(super) fn icosphere(levels: u32) -> Vec<[Corner; 3]> {
    let (mut points, mut triangles) = icosahedron();
    for _ in 0..levels {
        let mut middles = HashMap::new();
        triangles = triangles.into_iter().flat_map(|triangle| cut(triangle, &mut points, &mut middles)).collect();
    }
    let at = |i: usize| corner(points[i], points[i], Vec2::ZERO);
    triangles.into_iter().map(|triangle| triangle.map(at)).collect()
}

/// Returns the icosphere, scaled along its axes, with the normals of the ellipsoid.
pub(super) fn ellipsoid(levels: u32) -> Vec<[Corner; 3]> {
    let stretched = |c: Corner| corner(c.position * ELLIPSOID, c.position / ELLIPSOID, c.uv);
    icosphere(levels).into_iter().map(|triangle| triangle.map(stretched)).collect()
}

/// Cuts a triangle into four. `middles` remembers the middle point of each edge, so that neighbours share it.
fn cut([a, b, c]: [usize; 3], points: &mut Vec<Vec3>, middles: &mut HashMap<[usize; 2], usize>) -> [[usize; 3]; 4] {
    let [ab, bc, ca] = [[a, b], [b, c], [c, a]].map(|[i, j]| {
        *middles.entry([i.min(j), i.max(j)]).or_insert_with(|| {
            points.push((points[i] + points[j]).normalize());
            points.len() - 1
        })
    });
    [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
}

/// Returns the icosahedron: two poles on the Y axis, and two rings of five points between them.
fn icosahedron() -> (Vec<Vec3>, Vec<[usize; 3]>) {
    let height = 0.2_f32.sqrt();
    let ring = |k: usize, y: f32, turn: f32| {
        let angle = (k as f32 + turn) * std::f32::consts::TAU / 5.0;
        Vec3::new(2.0 * height * angle.sin(), y, 2.0 * height * angle.cos())
    };
    let mut points = vec![Vec3::Y];
    points.extend((0..5).map(|k| ring(k, height, 0.0)));
    points.extend((0..5).map(|k| ring(k, -height, 0.5)));
    points.push(Vec3::NEG_Y);
    let mut triangles = Vec::new();
    for k in 0..5 {
        let (upper, upper_next) = (1 + k, 1 + (k + 1) % 5);
        let (lower, lower_next) = (6 + k, 6 + (k + 1) % 5);
        triangles.extend([[0, upper, upper_next], [upper, lower, upper_next]]);
        triangles.extend([[upper_next, lower, lower_next], [11, lower_next, lower]]);
    }
    (points, triangles)
}

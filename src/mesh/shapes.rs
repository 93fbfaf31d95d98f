//! Shapes made in code: coarse on purpose, so that tessellation shows. About two object units wide, around the origin.

use std::f32::consts::{PI, TAU};
use std::str::FromStr;

use glam::{Vec2, Vec3, vec2, vec3};
use thiserror::Error;

use super::merge::from_triangles;
use super::{Corner, Mesh};

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Shape {
    /// A cube whose faces have normals of their own, leaning outwards at the corners: PN tears its edges open.
    #[default]
    CubeSplit,
    /// A cube whose faces share their normals.
    CubeSmooth,
    Icosahedron,
    /// An icosahedron with every face cut into four, on the sphere.
    Icosphere,
    /// With a uv seam both ways.
    Torus,
    /// With flat caps: creases all round.
    Cylinder,
    /// With a flat base; every side face has a normal of its own at the tip.
    Cone,
    /// Open.
    Saddle,
    /// Open, and with one side only: normals turn over at the join.
    Moebius,
}

/// A name that is none of [`Shape::ALL`].
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("there is no shape \"{0}\": choose one of {names}", names = Shape::ALL.map(Shape::name).join(", "))]
pub struct UnknownShape(pub String);

impl FromStr for Shape {
    type Err = UnknownShape;

    fn from_str(name: &str) -> Result<Self, UnknownShape> {
        Self::ALL.into_iter().find(|shape| shape.name() == name).ok_or_else(|| UnknownShape(name.to_owned()))
    }
}

impl Shape {
    pub const ALL: [Self; 9] = [
        Self::CubeSplit,
        Self::CubeSmooth,
        Self::Icosahedron,
        Self::Icosphere,
        Self::Torus,
        Self::Cylinder,
        Self::Cone,
        Self::Saddle,
        Self::Moebius,
    ];

    /// The name in commands, after `shape:`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::CubeSplit => "cube-split",
            Self::CubeSmooth => "cube-smooth",
            Self::Icosahedron => "icosahedron",
            Self::Icosphere => "icosphere",
            Self::Torus => "torus",
            Self::Cylinder => "cylinder",
            Self::Cone => "cone",
            Self::Saddle => "saddle",
            Self::Moebius => "moebius",
        }
    }

    /// The name in menus.
    pub const fn title(self) -> &'static str {
        match self {
            Self::CubeSplit => "Cube, split normals",
            Self::CubeSmooth => "Cube, smooth normals",
            Self::Icosahedron => "Icosahedron",
            Self::Icosphere => "Icosphere",
            Self::Torus => "Torus",
            Self::Cylinder => "Cylinder with caps",
            Self::Cone => "Cone",
            Self::Saddle => "Saddle",
            Self::Moebius => "Moebius strip",
        }
    }

    /// Its triangles, counter-clockwise seen from outside.
    pub fn build(self) -> Mesh {
        let triangles = match self {
            Self::CubeSplit => cube(|face, corner| (face + 0.4 * corner).normalize()),
            Self::CubeSmooth => cube(|_, corner| corner.normalize()),
            Self::Icosahedron => sphere(icosahedron()),
            Self::Icosphere => sphere(icosahedron().into_iter().flat_map(quartered).collect()),
            Self::Torus => torus(),
            Self::Cylinder => cylinder(),
            Self::Cone => cone(),
            Self::Saddle => saddle(),
            Self::Moebius => moebius(),
        };
        from_triangles(self.name(), triangles.into_iter())
    }
}

type Triangles = Vec<[Corner; 3]>;

fn corner(position: Vec3, normal: Vec3, uv: Vec2) -> Corner {
    Corner { position, normal, uv }
}

/// Two triangles of a quadrilateral given counter-clockwise.
fn quad([a, b, c, d]: [Corner; 4]) -> [[Corner; 3]; 2] {
    [[a, b, c], [a, c, d]]
}

/// `normal` makes a corner's normal from its face's and the direction of the cube's own corner.
fn cube(normal: impl Fn(Vec3, Vec3) -> Vec3) -> Triangles {
    let face = |axis: usize, sign: f32| {
        let out = Vec3::AXES[axis] * sign;
        let right = Vec3::AXES[(axis + 1) % 3];
        let up = out.cross(right);
        [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(s, t)| {
            let position = (out + right * (2.0 * s - 1.0) + up * (2.0 * t - 1.0)) * 0.8;
            corner(position, normal(out, position), vec2(s, 1.0 - t))
        })
    };
    (0..6).flat_map(|i| quad(face(i / 2, if i % 2 == 0 { 1.0 } else { -1.0 }))).collect()
}

/// Corners of a regular icosahedron on the unit sphere: cyclic permutations of (0, ±1, ±golden ratio).
fn icosahedron() -> Vec<[Vec3; 3]> {
    let golden = 0.5 + 5f32.sqrt() / 2.0;
    let corners: Vec<Vec3> = (0..12)
        .map(|i: usize| {
            let sign = |bit: usize| if i >> bit & 1 == 0 { 1.0 } else { -1.0 };
            let (a, b) = (sign(0), sign(1) * golden);
            [vec3(0.0, a, b), vec3(b, 0.0, a), vec3(a, b, 0.0)][i / 4].normalize()
        })
        .collect();
    // Neighbours are the nearest: 63.4 degrees apart; the next are 116.6.
    let near = |a: Vec3, b: Vec3| a.dot(b) > 0.4 && a != b;
    let mut faces = Vec::new();
    for (i, &a) in corners.iter().enumerate() {
        for (j, &b) in corners.iter().enumerate().skip(i + 1) {
            for &c in corners.iter().skip(j + 1) {
                if near(a, b) && near(b, c) && near(c, a) {
                    let outwards = (b - a).cross(c - a).dot(a) > 0.0;
                    faces.push(if outwards { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    faces
}

/// A face cut into four by the midpoints of its edges, which are the same whichever face they are cut from.
fn quartered([a, b, c]: [Vec3; 3]) -> [[Vec3; 3]; 4] {
    let [ab, bc, ca] = [a + b, b + c, c + a].map(Vec3::normalize);
    [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
}

/// Faces on the unit sphere, with its normals and uvs around the equator.
fn sphere(faces: Vec<[Vec3; 3]>) -> Triangles {
    let with_uv = |p: Vec3| corner(p, p, vec2(0.5 + p.x.atan2(p.z) / TAU, p.y.acos() / PI));
    faces.into_iter().map(|face| face.map(with_uv)).collect()
}

/// Nodes of a grid that closes both ways; the last row and column are the first's positions with other uvs.
fn torus() -> Triangles {
    let (around, across) = (16, 8);
    let node = |i: usize, j: usize| {
        let (s, c) = (TAU * (i % around) as f32 / around as f32).sin_cos();
        let (t, d) = (TAU * (j % across) as f32 / across as f32).sin_cos();
        let normal = vec3(s * d, t, c * d);
        let position = vec3(s, 0.0, c) * 0.7 + normal * 0.3;
        corner(position, normal, vec2(i as f32 / around as f32, 1.0 - j as f32 / across as f32))
    };
    grid(around, across, node)
}

/// Quads of a grid of (columns + 1) x (rows + 1) nodes; columns run to the right and rows up, seen from outside.
fn grid(columns: usize, rows: usize, node: impl Fn(usize, usize) -> Corner) -> Triangles {
    let cells = (0..columns).flat_map(|i| (0..rows).map(move |j| (i, j)));
    cells.flat_map(|(i, j)| quad([node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)])).collect()
}

const SECTORS: usize = 12;

/// The unit circle's direction in sector i.
fn circle(i: usize) -> Vec3 {
    let (s, c) = (TAU * (i % SECTORS) as f32 / SECTORS as f32).sin_cos();
    vec3(s, 0.0, c)
}

/// A disc at `center`, seen from `normal`'s side.
fn cap(center: Vec3, radius: f32, normal: Vec3) -> Triangles {
    let at = |direction: Vec3| corner(center + direction * radius, normal, vec2(direction.x, direction.z) * 0.5 + 0.5);
    (0..SECTORS)
        .map(|i| {
            let (a, b) = (at(circle(i)), at(circle(i + 1)));
            if normal.y > 0.0 { [at(Vec3::ZERO), a, b] } else { [at(Vec3::ZERO), b, a] }
        })
        .collect()
}

fn cylinder() -> Triangles {
    let (radius, half, rows) = (0.6, 0.8, 2);
    let node = |i: usize, j: usize| {
        let height = half * (2.0 * j as f32 / rows as f32 - 1.0);
        let uv = vec2(i as f32 / SECTORS as f32, 1.0 - j as f32 / rows as f32);
        corner(circle(i) * radius + Vec3::Y * height, circle(i), uv)
    };
    let mut triangles = grid(SECTORS, rows, node);
    triangles.extend(cap(Vec3::Y * half, radius, Vec3::Y));
    triangles.extend(cap(Vec3::Y * -half, radius, Vec3::NEG_Y));
    triangles
}

fn cone() -> Triangles {
    let (radius, half) = (0.8, 0.8);
    let slope = |direction: Vec3| (direction * 2.0 * half + Vec3::Y * radius).normalize();
    let rim = |i: usize| {
        let uv = vec2(i as f32 / SECTORS as f32, 1.0);
        corner(circle(i) * radius - Vec3::Y * half, slope(circle(i)), uv)
    };
    let side = |i: usize| {
        let between = (circle(i) + circle(i + 1)).normalize();
        [rim(i), rim(i + 1), corner(Vec3::Y * half, slope(between), vec2((i as f32 + 0.5) / SECTORS as f32, 0.0))]
    };
    let mut triangles: Triangles = (0..SECTORS).map(side).collect();
    triangles.extend(cap(Vec3::Y * -half, radius, Vec3::NEG_Y));
    triangles
}

/// y = (x^2 - z^2) / 2 over a square.
fn saddle() -> Triangles {
    let cells = 6;
    let node = |i: usize, j: usize| {
        let [x, z] = [i, j].map(|k| 2.0 * k as f32 / cells as f32 - 1.0);
        let z = -z;
        let uv = vec2(i as f32, (cells - j) as f32) / cells as f32;
        corner(vec3(x, 0.5 * (x * x - z * z), z), vec3(-x, 1.0, z).normalize(), uv)
    };
    grid(cells, cells, node)
}

/// A strip with half a turn in it: where it meets itself, left is right and up is down.
fn moebius() -> Triangles {
    let (around, across) = (24, 2);
    let node = |i: usize, j: usize| {
        let turned = i == around;
        let (i_at, j_at) = if turned { (0, across - j) } else { (i, j) };
        let angle = TAU * i_at as f32 / around as f32;
        let (s, c) = angle.sin_cos();
        let (half_s, half_c) = (angle * 0.5).sin_cos();
        let out = vec3(s, 0.0, c);
        let along = vec3(c, 0.0, -s);
        let width = out * half_c + Vec3::Y * half_s;
        let normal = along.cross(width) * if turned { -1.0 } else { 1.0 };
        let position = out * 0.75 + width * (0.6 * (j_at as f32 / across as f32 - 0.5));
        corner(position, normal, vec2(i as f32 / around as f32, 1.0 - j as f32 / across as f32))
    };
    grid(around, across, node)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::normals::face_normal;

    fn faces(mesh: &Mesh) -> Vec<[Corner; 3]> {
        mesh.triangles.iter().map(|t| t.map(|i| mesh.corners[i as usize])).collect()
    }

    #[test]
    fn normals_are_unit_and_on_the_side_that_the_winding_says() {
        for shape in Shape::ALL {
            for face in faces(&shape.build()) {
                let outwards = face_normal(&face.map(|corner| corner.position));
                for corner in face {
                    assert!((corner.normal.length() - 1.0).abs() < 1e-5, "{shape:?}");
                    assert!(corner.normal.dot(outwards) > 0.0, "{shape:?}: {face:?}");
                }
            }
        }
    }

    #[test]
    fn closed_shapes_are_wound_outwards() {
        for shape in Shape::ALL.into_iter().filter(|shape| ![Shape::Saddle, Shape::Moebius].contains(shape)) {
            let volume = |[a, b, c]: [Corner; 3]| a.position.dot(b.position.cross(c.position)) / 6.0;
            assert!(faces(&shape.build()).into_iter().map(volume).sum::<f32>() > 0.3, "{shape:?}");
        }
    }

    #[test]
    fn shapes_go_by_their_names() {
        for shape in Shape::ALL {
            assert_eq!(shape.name().parse(), Ok(shape));
        }
        let error = "teapot".parse::<Shape>().expect_err("there is none").to_string();
        assert!(error.contains("teapot") && error.contains("cube-split, cube-smooth"), "{error}");
    }

    #[test]
    fn shapes_are_as_coarse_as_they_should_be() {
        let counts = Shape::ALL.map(|shape| shape.build().triangles.len());
        assert_eq!(counts, [12, 12, 20, 80, 256, 72, 24, 72, 96]);
    }
}

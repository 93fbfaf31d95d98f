//! Meshes of any size, as files of every format.

use documents::package;
use std::fmt::Write;

/// A wavy sheet of squares, each cut into two triangles.
#[derive(Clone, Copy)]
pub(crate) struct Grid {
    /// The number of vertices along x and along y.
    pub side: usize,
    pub rows: usize,
    /// The greatest random height of a vertex: 0 for a smooth sheet, many sides of a square for creases everywhere.
    pub spikes: f32,
}

impl Grid {
    /// Makes a sheet with this number of triangles, or a few less.
    pub(crate) fn new(triangles: usize, spikes: f32) -> Self {
        let side = (triangles / 2).isqrt() + 1;
        Self { side, rows: side, spikes }
    }

    pub(crate) fn triangle_count(self) -> usize {
        2 * (self.side - 1) * (self.rows - 1)
    }

    pub(crate) fn positions(self) -> impl Iterator<Item = [f32; 3]> {
        (0..self.side * self.rows).map(move |i| self.position(i))
    }

    pub(crate) fn position(self, i: usize) -> [f32; 3] {
        let [x, y] = [(i % self.side) as f32, (i / self.side) as f32];
        [x, y, (x * 0.01).sin() * (y * 0.01).cos() + self.spikes * (i * i % 1009) as f32 / 1009.0]
    }

    /// Returns the corners of the squares, counter-clockwise.
    pub(crate) fn quads(self) -> impl Iterator<Item = [usize; 4]> {
        let (side, rows) = (self.side, self.rows);
        (0..(side - 1) * (rows - 1)).map(move |i| {
            let a = i / (side - 1) * side + i % (side - 1);
            [a, a + 1, a + side + 1, a + side]
        })
    }

    pub(crate) fn triangles(self) -> impl Iterator<Item = [usize; 3]> {
        self.quads().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]])
    }

    /// Writes binary STL. `apart` is the distance between neighbouring triangles.
    pub(crate) fn stl(self, apart: f32) -> Vec<u8> {
        let mut bytes = vec![0; 80];
        bytes.reserve_exact(50 * self.triangle_count() + 4);
        bytes.extend((self.triangle_count() as u32).to_le_bytes());
        for (t, triangle) in self.triangles().enumerate() {
            bytes.extend([0; 12]);
            for [x, y, z] in triangle.map(|i| self.position(i)) {
                bytes.extend([x, y, z + apart * t as f32].into_iter().flat_map(f32::to_le_bytes));
            }
            bytes.extend([0; 2]);
        }
        bytes
    }

    /// Writes binary PLY with triangles or squares.
    pub(crate) fn ply(self, squares: bool) -> Vec<u8> {
        let faces = self.triangle_count() / if squares { 2 } else { 1 };
        let mut bytes = format!(
            "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float \
             z\nelement face {faces}\nproperty list uchar uint vertex_indices\nend_header\n",
            self.side * self.rows
        )
        .into_bytes();
        bytes.extend(self.positions().flatten().flat_map(f32::to_le_bytes));
        let mut face = |corners: &[usize]| {
            bytes.push(corners.len() as u8);
            bytes.extend(corners.iter().flat_map(|i| (*i as u32).to_le_bytes()));
        };
        match squares {
            true => self.quads().for_each(|quad| face(&quad)),
            false => self.triangles().for_each(|triangle| face(&triangle)),
        }
        bytes
    }

    /// Writes OFF.
    pub(crate) fn off(self) -> Vec<u8> {
        let mut text = format!("OFF\n{} {} 0\n", self.side * self.rows, self.triangle_count());
        for [x, y, z] in self.positions() {
            let _ = writeln!(text, "{x} {y} {z:.3}");
        }
        for [a, b, c] in self.triangles() {
            let _ = writeln!(text, "3 {a} {b} {c}");
        }
        text.into_bytes()
    }

    /// Writes 3MF, whose model is compressed.
    pub(crate) fn threemf(self) -> Vec<u8> {
        let object = format!("<object id=\"1\">{}</object>", package::mesh(self.positions(), self.triangles()));
        let model = package::model(&object, "<item objectid=\"1\"/>");
        let relationships = package::relationships();
        package::zip(&[
            package::Entry::stored("_rels/.rels", relationships.as_bytes()),
            package::Entry::deflated(package::MODEL, model.as_bytes()),
        ])
    }

    /// Writes OBJ with or without texture coordinates and normals.
    pub(crate) fn obj(self, attributes: bool) -> Vec<u8> {
        let mut text = String::new();
        for [x, y, z] in self.positions() {
            let _ = writeln!(text, "v {x} {y} {z:.3}");
            if attributes {
                let _ = writeln!(text, "vt {:.4} {:.4}\nvn 0 0 1", x / self.side as f32, y / self.side as f32);
            }
        }
        for triangle in self.triangles() {
            text.push('f');
            for i in triangle.map(|i| i + 1) {
                let _ = if attributes { write!(text, " {i}/{i}/{i}") } else { write!(text, " {i}") };
            }
            text.push('\n');
        }
        text.into_bytes()
    }
}

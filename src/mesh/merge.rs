//! Puts triangles together into a mesh: every corner once, triangles grouped by material.

use std::collections::HashMap;

use super::{Corner, Material, Mesh, position_bits};

/// Collects triangles, material by material.
#[derive(Default)]
pub struct Merge {
    corners: Vec<Corner>,
    known: HashMap<[u32; 8], u32>,
    groups: Vec<Vec<[u32; 3]>>,
}

impl Merge {
    /// Adds a triangle of material `group`, counted from 0.
    pub fn push(&mut self, group: usize, triangle: [Corner; 3]) {
        if self.groups.len() <= group {
            self.groups.resize_with(group + 1, Vec::new);
        }
        let indices = triangle.map(|corner| self.corner(corner));
        self.groups[group].push(indices);
    }

    fn corner(&mut self, corner: Corner) -> u32 {
        let ([a, b, c], [d, e, f]) = (position_bits(corner.position), position_bits(corner.normal));
        let [g, h] = corner.uv.to_array().map(|x| (x + 0.0).to_bits());
        let next = self.corners.len() as u32;
        let index = *self.known.entry([a, b, c, d, e, f, g, h]).or_insert(next);
        if index == next {
            self.corners.push(corner);
        }
        index
    }

    /// The mesh, with `materials` for the groups in order; their runs of triangles are filled in.
    pub fn finish(self, name: String, mut materials: Vec<Material>, warnings: Vec<String>) -> Mesh {
        let mut triangles = Vec::new();
        let groups = self.groups.into_iter().chain(std::iter::repeat_with(Vec::new));
        for (material, group) in materials.iter_mut().zip(groups) {
            let first = triangles.len() as u32;
            triangles.extend(group);
            material.triangles = first..triangles.len() as u32;
        }
        Mesh { name, corners: self.corners, triangles, materials, warnings }
    }
}

/// A mesh of one plain material.
pub fn from_triangles(name: &str, triangles: impl Iterator<Item = [Corner; 3]>) -> Mesh {
    let mut merge = Merge::default();
    triangles.for_each(|triangle| merge.push(0, triangle));
    merge.finish(name.to_owned(), vec![plain_material("plain")], Vec::new())
}

/// Light grey, without a texture.
pub fn plain_material(name: &str) -> Material {
    Material { name: name.to_owned(), base_color: [0.6, 0.6, 0.6, 1.0], texture: None, triangles: 0..0 }
}

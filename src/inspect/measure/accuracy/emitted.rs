//! The triangles that were emitted, and the patch of each.

use glam::Vec3;

use geometry::casts::to_u32;
use geometry::near::{Soup, TriangleTree};
use geometry::tessellate::Vertex;

/// The triangles of all chunks.
#[derive(Default)]
pub(crate) struct Emitted {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    /// The patch of each triangle.
    patches: Vec<u32>,
}

impl Emitted {
    /// Adds the triangles of a chunk, whose positions must be finite.
    pub(crate) fn add(&mut self, vertices: &[Vertex], triangles: &[[u32; 3]]) {
        let first = to_u32(self.positions.len());
        self.positions.extend(vertices.iter().map(|vertex| Vec3::from(vertex.position)));
        self.triangles.extend(triangles.iter().map(|triangle| triangle.map(|index| first + index)));
        self.patches.extend(triangles.iter().map(|triangle| vertices[triangle[0] as usize].patch()));
    }

    pub(crate) fn patch(&self, triangle: u32) -> u32 {
        self.patches[triangle as usize]
    }

    pub(crate) fn soup(&self) -> Soup<'_> {
        Soup { positions: &self.positions, triangles: &self.triangles }
    }

    /// A tree of the triangles; `None` if there are none.
    pub(crate) fn tree(&self) -> Option<TriangleTree> {
        TriangleTree::new(self.triangles.iter().map(|triangle| triangle.map(|index| self.positions[index as usize])))
    }
}

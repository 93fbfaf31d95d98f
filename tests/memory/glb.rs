//! Sheets as `.glb` files: with floats or quantised, with indices of 16 or 32 bits, and without indices.

use serde_json::{Value, json};

use super::glb;
use super::grid::Grid;

/// A document that is being built: one buffer, and views into it.
#[derive(Default)]
struct Draft {
    bin: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    primitives: Vec<Value>,
}

impl Draft {
    fn accessor(&mut self, bytes: impl Iterator<Item = u8>, stride: usize, component: u32, kind: &str) -> usize {
        let start = self.bin.len();
        self.bin.extend(bytes);
        let length = self.bin.len() - start;
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let mut view = json!({ "buffer": 0, "byteOffset": start, "byteLength": length });
        if kind != "SCALAR" {
            view["byteStride"] = json!(stride);
        }
        self.views.push(view);
        let view = self.views.len() - 1;
        let (count, normalized) = (length / stride, component == 5120);
        let accessor = json!({
            "bufferView": view, "componentType": component, "type": kind, "count": count, "normalized": normalized,
        });
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// Adds some of a sheet's vertices.
    fn vertices(&mut self, grid: Grid, numbers: impl Iterator<Item = usize> + Clone, quantised: bool) -> Value {
        let at = numbers.clone().map(move |i| grid.position(i));
        let count = numbers.count();
        let (positions, normals) = if quantised {
            let whole = |[x, y, z]: [f32; 3]| [x as u16, y as u16, (z * 1000.0 + 2000.0) as u16, 0];
            let positions = at.flat_map(move |at| whole(at).into_iter().flat_map(u16::to_le_bytes));
            let positions = self.accessor(positions, 8, 5123, "VEC3");
            (positions, self.accessor((0..count).flat_map(|_| [0, 0, 127, 0]), 4, 5120, "VEC3"))
        } else {
            let positions = self.accessor(at.flatten().flat_map(f32::to_le_bytes), 12, 5126, "VEC3");
            let up = (0..count).flat_map(|_| [0.0, 0.0, 1.0_f32]).flat_map(f32::to_le_bytes);
            (positions, self.accessor(up, 12, 5126, "VEC3"))
        };
        json!({ "POSITION": positions, "NORMAL": normals })
    }

    fn glb(self) -> Vec<u8> {
        let root = json!({
            "asset": { "version": "2.0" },
            "extensionsUsed": ["KHR_mesh_quantization"],
            "extensionsRequired": ["KHR_mesh_quantization"],
            "nodes": [{ "mesh": 0 }],
            "meshes": [{ "primitives": self.primitives }],
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{ "byteLength": self.bin.len() }],
        });
        glb(&root, &self.bin)
    }
}

/// A sheet as one primitive, with indices of 32 bits.
pub(crate) fn indexed(grid: Grid, quantised: bool) -> Vec<u8> {
    let mut draft = Draft::default();
    let attributes = draft.vertices(grid, 0..grid.side * grid.side, quantised);
    let indices = grid.triangles().flatten().flat_map(|i| (i as u32).to_le_bytes());
    let indices = draft.accessor(indices, 4, 5125, "SCALAR");
    draft.primitives.push(json!({ "attributes": attributes, "indices": indices }));
    draft.glb()
}

/// A sheet as quantised primitives of rows of squares, with indices of 16 bits.
pub(crate) fn blocks(grid: Grid) -> Vec<u8> {
    let mut draft = Draft::default();
    let rows = 60_000 / grid.side;
    for first in (0..grid.side - 1).step_by(rows) {
        let own = Grid { rows: rows.min(grid.side - 1 - first) + 1, ..grid };
        let start = first * grid.side;
        let attributes = draft.vertices(grid, start..start + own.rows * grid.side, true);
        let indices = own.triangles().flatten().flat_map(|i| (i as u16).to_le_bytes());
        let indices = draft.accessor(indices, 2, 5123, "SCALAR");
        draft.primitives.push(json!({ "attributes": attributes, "indices": indices }));
    }
    draft.glb()
}

/// A sheet as one primitive without indices.
pub(crate) fn loose(grid: Grid, quantised: bool) -> Vec<u8> {
    let mut draft = Draft::default();
    let numbers: Vec<usize> = grid.triangles().flatten().collect();
    let attributes = draft.vertices(grid, numbers.into_iter(), quantised);
    draft.primitives.push(json!({ "attributes": attributes }));
    draft.glb()
}

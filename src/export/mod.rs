//! Writes tessellated meshes to files.

mod glb;
mod obj;

use std::path::Path;

use glam::{Vec2, Vec3};
use thiserror::Error;

use crate::files::{file_reason, write_whole};
use crate::mesh::{Mesh, Topology};
use crate::names::shown_path;
use crate::tessellate::{Tessellated, linear_normal, linear_uv};

/// A tessellated mesh: the attributes of each vertex, and a list of triangles for each material.
pub(crate) struct Exported<'a> {
    /// The mesh that was tessellated: its name and materials are written.
    pub mesh: &'a Mesh,
    /// In object units.
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    pub uvs: Vec<Vec2>,
    /// The triangles of each material, as indices of vertices.
    pub triangles: Vec<Vec<[u32; 3]>>,
}

#[derive(Debug, Error)]
pub(crate) enum ExportError {
    #[error("{path}: the name must end in .glb or .obj")]
    Extension { path: String },
    #[error("{path}: could not be written ({})", file_reason(reason))]
    Io { path: String, reason: std::io::Error },
    #[error(
        "{path}: {triangles} triangles are too many for this format, which holds 4 GiB as .glb and 4 billion vertices as .obj: lower \
         the factor"
    )]
    TooLarge { path: String, triangles: u64 },
    #[error("{path}: a texture could not be encoded ({reason})")]
    Texture { path: String, reason: String },
}

impl<'a> Exported<'a> {
    /// Collects the attributes of every emitted vertex. Positions are those that were emitted. Normals and uvs are interpolated
    /// once more, since emitted normals are packed, which is precise enough only for drawing.
    pub(crate) fn new(mesh: &'a Mesh, topology: &Topology, tessellated: &Tessellated) -> Self {
        let corners = |patch: u32| topology.patch_corners(patch).map(|c| &mesh.corners[c as usize]);
        let vertices = &tessellated.vertices;
        let attributes = vertices.iter().map(|vertex| {
            let ([u, v], corners) = (vertex.domain(), corners(vertex.patch()));
            (linear_normal(corners.map(|c| c.normal), u, v), linear_uv(corners.map(|c| c.uv), u, v))
        });
        let (normals, uvs) = attributes.unzip();
        let mut triangles = vec![Vec::new(); mesh.materials.len()];
        for &triangle in &tessellated.triangles {
            let patch = vertices[triangle[0] as usize].patch();
            let material = topology.material_patches.partition_point(|range| range.end <= patch);
            triangles[material].push(triangle);
        }
        let positions = vertices.iter().map(|vertex| Vec3::from(vertex.position)).collect();
        Self { mesh, positions, normals, uvs, triangles }
    }

    /// Checks that a file with this name can hold so many vertices and triangles, before they are read back.
    ///
    /// # Errors
    /// The ending is neither .glb nor .obj, or the format can't hold that many.
    pub(crate) fn check(path: &Path, vertices: u64, triangles: u64) -> Result<(), ExportError> {
        let shown = shown_path(path);
        match ending(path).as_str() {
            // This program writes 32-bit indices in both formats.
            "obj" if vertices <= u64::from(u32::MAX) => Ok(()),
            "glb" if glb::bytes(vertices, triangles) <= glb::MAX_BYTES => Ok(()),
            "glb" | "obj" => Err(ExportError::TooLarge { path: shown, triangles }),
            _ => Err(ExportError::Extension { path: shown }),
        }
    }

    /// Writes a .glb or .obj file, depending on the path's ending. The file is written under another name first and then renamed,
    /// so that a failure leaves an older file intact.
    ///
    /// # Errors
    /// The ending is another one, the file can't be written, or the format can't hold that many triangles.
    pub(crate) fn write(&self, path: &Path) -> Result<(), ExportError> {
        let shown = shown_path(path);
        let bytes = match ending(path).as_str() {
            "glb" => glb::encode(self, &shown)?,
            "obj" => obj::encode(self),
            _ => return Err(ExportError::Extension { path: shown }),
        };
        write_whole(path, &bytes).map_err(|reason| ExportError::Io { path: shown, reason })
    }
}

/// Returns the ending of a file's name without its dot, in lower case; empty if there is none.
pub(crate) fn ending(path: &Path) -> String {
    path.extension().and_then(|ending| ending.to_str()).unwrap_or_default().to_ascii_lowercase()
}

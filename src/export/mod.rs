//! Tessellated meshes as files.

mod glb;
mod obj;

use std::path::Path;

use glam::{Vec2, Vec3};
use thiserror::Error;

use crate::files::{file_reason, write_whole};
use crate::mesh::{Mesh, Topology};
use crate::names::shown_path;
use crate::tessellate::{Tessellated, linear_normal, linear_uv};

/// A mesh with attributes, one run of triangles a material.
pub(crate) struct Exported<'a> {
    pub mesh: &'a Mesh,
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    pub uvs: Vec<Vec2>,
    /// As many as the mesh has materials.
    pub triangles: Vec<Vec<[u32; 3]>>,
}

#[derive(Debug, Error)]
pub(crate) enum ExportError {
    #[error("{path}: the name must end in .glb or .obj")]
    Extension { path: String },
    #[error("{path}: could not be written ({})", file_reason(reason))]
    Io { path: String, reason: std::io::Error },
    #[error(
        "{path}: {triangles} triangles are more than it can hold (4 GiB as .glb, 4 billion vertices as .obj): lower the factor"
    )]
    TooLarge { path: String, triangles: u64 },
    #[error("{path}: a texture could not be encoded ({reason})")]
    Texture { path: String, reason: String },
}

impl<'a> Exported<'a> {
    /// Attributes of every emitted vertex: positions and uvs as they are; normals in full precision, which what is drawn
    /// doesn't need.
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

    /// Whether a file of that name can hold so many vertices and triangles: asked before they are read back.
    ///
    /// # Errors
    /// Another ending than .glb or .obj, or more than the format holds.
    pub(crate) fn check(path: &Path, vertices: u64, triangles: u64) -> Result<(), ExportError> {
        let shown = shown_path(path);
        match ending(path).as_str() {
            // Indices of either are 32 bits here.
            "obj" if vertices <= u64::from(u32::MAX) => Ok(()),
            "glb" if glb::bytes(vertices, triangles) <= glb::MAX_BYTES => Ok(()),
            "glb" | "obj" => Err(ExportError::TooLarge { path: shown, triangles }),
            _ => Err(ExportError::Extension { path: shown }),
        }
    }

    /// Writes a .glb or .obj file, by the path's ending: beside it first, then renamed, so that a failure leaves what was
    /// there.
    ///
    /// # Errors
    /// Another ending, a file that can't be written, or more than the format holds.
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

/// In lower case; empty without one.
pub(crate) fn ending(path: &Path) -> String {
    path.extension().and_then(|ending| ending.to_str()).unwrap_or_default().to_ascii_lowercase()
}

//! Writes tessellated meshes to files.

mod glb;
mod obj;

use std::path::Path;

use glam::{Vec2, Vec3};
use thiserror::Error;

use geometry::mesh::{CornerDetail, Mesh, Topology};
use geometry::names::shown_path;
use geometry::tessellate::{Tessellated, Vertex, linear_normal, linear_uv, unpack_normal};
use load::files::{file_reason, write_whole};

/// The greatest sine of the angle between a unit normal and the same once it was packed: 0.004 degrees, and a little more.
const PACKING_ERROR: f32 = 1e-4;

/// A tessellated mesh: the attributes of each vertex, and a list of triangles for each material.
pub struct Exported<'a> {
    /// The mesh that was tessellated: its name, materials and lights are written.
    pub mesh: &'a Mesh,
    /// In object units.
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    pub uvs: Vec<Vec2>,
    /// What vertices have beside these; empty if the mesh's corners have no more.
    pub details: Vec<CornerDetail>,
    /// The triangles of each material, as indices of vertices.
    pub triangles: Vec<Vec<[u32; 3]>>,
}

#[derive(Debug, Error)]
pub enum ExportError {
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
    /// Collects the attributes of every emitted vertex. Positions are those that were emitted, and so are normals, but those that
    /// are linear between corners are interpolated once more: emitted normals are packed, which is precise enough only for
    /// drawing.
    pub fn new(mesh: &'a Mesh, topology: &Topology, tessellated: &Tessellated) -> Self {
        let vertices = &tessellated.vertices;
        let corners = |vertex: &Vertex| topology.patch_corners(vertex.patch());
        let attributes = vertices.iter().map(|vertex| {
            let ([u, v], corners) = (vertex.domain(), corners(vertex).map(|c| &mesh.corners[c as usize]));
            (normal(vertex, corners.map(|c| c.normal)), linear_uv(corners.map(|c| c.uv), u, v))
        });
        let (normals, uvs) = attributes.unzip();
        let details = mesh.details.iter().flat_map(|details| {
            let own = |vertex| corners(vertex).map(|corner| &details[corner as usize]);
            vertices.iter().map(move |vertex| CornerDetail::blended(own(vertex), vertex.weights()))
        });
        let mut triangles = vec![Vec::new(); mesh.materials.len()];
        for &triangle in &tessellated.triangles {
            let patch = vertices[triangle[0] as usize].patch();
            let material = topology.material_patches.partition_point(|range| range.end <= patch);
            triangles[material].push(triangle);
        }
        let positions = vertices.iter().map(|vertex| Vec3::from(vertex.position)).collect();
        Self { mesh, positions, normals, uvs, details: details.collect(), triangles }
    }

    /// Checks that a file with this name can hold so many vertices and triangles of a mesh, before they are read back.
    ///
    /// # Errors
    /// The ending is neither .glb nor .obj, or the format can't hold that many.
    pub fn check(path: &Path, mesh: &Mesh, vertices: u64, triangles: u64) -> Result<(), ExportError> {
        // This program writes 32-bit indices in both formats.
        let fits = match ending(path).as_str() {
            "glb" => glb::bytes(mesh, vertices, triangles) <= glb::MAX_BYTES,
            "obj" => vertices <= u64::from(u32::MAX),
            _ => return Err(ExportError::Extension { path: shown_path(path) }),
        };
        if fits { Ok(()) } else { Err(ExportError::TooLarge { path: shown_path(path), triangles }) }
    }

    /// Writes a .glb or .obj file, depending on the path's ending. The file is written under another name first and then renamed,
    /// so that a failure leaves an older file intact. Returns sentences about what is drawn but couldn't be written.
    ///
    /// # Errors
    /// The ending is another one, the file can't be written, or the format can't hold that many triangles.
    pub fn write(&self, path: &Path) -> Result<Vec<String>, ExportError> {
        let shown = shown_path(path);
        let (bytes, warnings) = match ending(path).as_str() {
            "glb" => glb::encode(self, &shown)?,
            "obj" => (obj::encode(self), obj::left_out(self.mesh, &shown).into_iter().collect()),
            _ => return Err(ExportError::Extension { path: shown }),
        };
        write_whole(path, &bytes).map_err(|reason| ExportError::Io { path: shown, reason })?;
        Ok(warnings)
    }
}

/// Returns the normal of an emitted vertex, of a patch whose corners have these normals.
fn normal(vertex: &Vertex, corners: [Vec3; 3]) -> Vec3 {
    let [u, v] = vertex.domain();
    let (linear, emitted) = (linear_normal(corners, u, v), unpack_normal(vertex.normal));
    let is_linear = linear.cross(emitted).length() < PACKING_ERROR && linear.dot(emitted) > 0.0;
    if is_linear { linear } else { emitted }
}

/// Returns the ending of a file's name without its dot, in lower case; empty if there is none.
pub fn ending(path: &Path) -> String {
    path.extension().and_then(|ending| ending.to_str()).unwrap_or_default().to_ascii_lowercase()
}

#[cfg(test)]
mod tests;

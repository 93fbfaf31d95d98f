//! Builds a mesh from the faces of OBJ, STL and PLY files: checks them, cuts polygons into triangles, and counts
//! repairs.

use std::sync::Arc;

use glam::{Vec2, Vec3};

use super::loaded_mesh::LoadedMesh;
use super::memory_budget::{Budget, edge_bytes};
use super::read_error::{FilePosition, ReadError};
use super::warnings::repair_warnings;
use crate::mesh::build_limits::MAX_TRIANGLES;
use crate::mesh::mesh_builder::{InputCorner, MeshBuilder};
use crate::mesh::polygon::{self, CutQuality, triangulate};
use crate::mesh::rig::LARGEST_COORDINATE;
use crate::mesh::{Material, Texture};
use crate::progress::Progress;

/// The greatest number of materials. A file with more is refused, since each takes memory and a draw call.
const MAX_MATERIALS: usize = 1 << 16;

/// The greatest number of corners of a face. A file with a larger face is refused.
pub(super) const MAX_CORNERS: usize = 1 << 19;

/// The mesh that is being built, and counts of what was repaired or left out.
pub(super) struct FaceBuilder<'a> {
    memory: &'a Budget,
    builder: MeshBuilder,
    materials: usize,
    triangles: usize,
    work: polygon::WorkBudget,
    /// Faces with fewer than 3 corners.
    too_small: usize,
    /// Corners at the position of the corner before them.
    repeated: usize,
    /// Polygons whose triangles may overlap.
    somehow: usize,
    /// Corners with texture coordinates that aren't finite.
    bad_uvs: usize,
    /// The triangles of the polygon that is being cut.
    cut: Vec<[usize; 3]>,
}

impl<'a> FaceBuilder<'a> {
    /// Starts a mesh from a file of `bytes` bytes.
    pub(super) fn new(bytes: usize, memory: &'a Budget) -> Self {
        Self {
            memory,
            builder: MeshBuilder::new(),
            materials: 0,
            triangles: 0,
            work: polygon::WorkBudget::new(bytes),
            too_small: 0,
            repeated: 0,
            somehow: 0,
            bad_uvs: 0,
            cut: Vec::new(),
        }
    }

    /// Adds a material and returns its index for [`add`](Self::add).
    ///
    /// # Errors
    /// [`ReadError::TooMany`].
    pub(super) fn material(&mut self, material: Material) -> Result<usize, ReadError> {
        self.materials += 1;
        if self.materials > MAX_MATERIALS {
            return Err(ReadError::TooMany { limit: MAX_MATERIALS as u64, what: "materials" });
        }
        Ok(self.builder.material(material))
    }

    /// Gives a material the image of its base colour.
    ///
    /// # Panics
    /// If `material` isn't an index that [`material`](Self::material) returned.
    pub(super) fn texture(&mut self, material: usize, texture: &Arc<Texture>) {
        self.builder.material_mut(material).texture = Some(texture.clone());
    }

    /// Returns how much more memory the mesh takes until it has its edges, in bytes, if no more faces are added.
    pub(super) fn bytes_to_finish(&self) -> u64 {
        let [corners, triangles] = [self.builder.distinct_corners(), self.triangles].map(|count| count as u64);
        edge_bytes(corners, triangles).saturating_sub(32 * corners + 12 * triangles)
    }

    /// Announces that about `triangles` more triangles, and about `corners` more distinct corners, will be added.
    pub(super) fn expect(&mut self, triangles: usize, corners: usize) {
        self.builder.expect(triangles.saturating_mul(3), corners);
    }

    /// Adds a face with any number of corners. Corners that can be repaired are repaired, in `corners` too. `place` is
    /// the face's position in the file.
    ///
    /// # Errors
    /// [`ReadError::Broken`] for a position that isn't finite or too far away, and [`ReadError::TooMany`].
    pub(super) fn add(
        &mut self,
        material: usize,
        corners: &mut Vec<InputCorner>,
        place: FilePosition,
    ) -> Result<(), ReadError> {
        for corner in corners.iter_mut() {
            check(corner.position).map_err(|reason| place.error(reason))?;
            if !corner.uv.is_finite() {
                corner.uv = Vec2::ZERO;
                self.bad_uvs += 1;
            }
        }
        if corners.len() > 3 {
            let given = corners.len();
            corners.dedup_by_key(|corner| corner.position);
            if corners.len() > 1 && corners.first().map(|c| c.position) == corners.last().map(|c| c.position) {
                corners.pop();
            }
            self.repeated += given - corners.len();
        }
        if corners.len() < 3 {
            self.too_small += 1;
            return Ok(());
        }
        self.triangles += corners.len() - 2;
        if self.triangles as u64 > MAX_TRIANGLES {
            return Err(ReadError::TooMany { limit: MAX_TRIANGLES, what: "triangles" });
        }
        let memory = self.memory;
        let room = self.builder.make_room_for_triangles(material, corners.len() - 2, memory);
        room.and_then(|()| self.builder.make_room(corners.len(), memory))
            .map_err(|refused| ReadError::TooLarge { reason: refused.into() })?;
        self.cut(material, corners);
        Ok(())
    }

    fn cut(&mut self, material: usize, corners: &[InputCorner]) {
        if let Ok(triangle) = corners.try_into() {
            self.builder.triangle(material, triangle);
            return;
        }
        let outline: Vec<Vec3> = corners.iter().map(|corner| corner.position).collect();
        self.cut.clear();
        let cut = triangulate(&outline, &mut self.work, &mut self.cut);
        self.somehow += usize::from(cut == CutQuality::MayOverlap);
        for triangle in &self.cut {
            self.builder.triangle(material, triangle.map(|i| corners[i]));
        }
    }

    /// Builds the mesh. `holds` says what the file has instead if it has no triangles; `warnings` are the reader's own.
    ///
    /// # Errors
    /// [`ReadError::Empty`] and [`ReadError::Cancelled`].
    pub(super) fn finish(
        self,
        name: &str,
        holds: String,
        mut warnings: Vec<String>,
        progress: &Progress,
    ) -> Result<LoadedMesh, ReadError> {
        if self.builder.is_empty() {
            let small = match self.too_small {
                0 => String::new(),
                count => format!(", and {count} faces of fewer than 3 corners"),
            };
            return Err(ReadError::Empty { holds: holds + &small });
        }
        warnings.extend(counted([
            (self.bad_uvs, "uvs that aren't finite, replaced by (0, 0)"),
            (self.too_small, "faces of fewer than 3 corners, left out"),
            (self.repeated, "corners of polygons at the position of the corner before, left out"),
            (
                self.somehow,
                "polygons that have no area, cross themselves or are too large, cut into triangles that may overlap",
            ),
        ]));
        let (mesh, _) = self.builder.finish_bound(name.to_owned(), self.memory, progress)?;
        warnings.extend(repair_warnings(&mesh.repairs));
        Ok(LoadedMesh { mesh, warnings, file_bytes: self.memory.files(), ..LoadedMesh::default() })
    }
}

/// Returns a sentence for each count that isn't 0.
pub(super) fn counted(sentences: impl IntoIterator<Item = (usize, &'static str)>) -> impl Iterator<Item = String> {
    let found = sentences.into_iter().filter(|(count, _)| *count > 0);
    found.map(|(count, sentence)| format!("{sentence}: {count}."))
}

fn check(position: Vec3) -> Result<(), String> {
    if !position.is_finite() {
        return Err("the face has a position that isn't finite".to_owned());
    }
    if position.abs().max_element() > LARGEST_COORDINATE {
        return Err(format!("the face has a coordinate beyond {LARGEST_COORDINATE:e}"));
    }
    Ok(())
}

#[cfg(test)]
pub(super) mod tests;

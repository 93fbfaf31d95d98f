//! Builds a mesh from the faces of FBX, OBJ, STL and PLY files: checks them, cuts polygons into triangles, and counts
//! repairs.

use glam::{Vec2, Vec3};

use super::loaded_mesh::LoadedMesh;
use super::memory_budget::Budget;
use super::read_error::{FilePosition, ReadError};
use super::warnings::repair_warnings;
use crate::mesh::build_limits::MAX_TRIANGLES;
use crate::mesh::mesh_builder::{InputCorner, MeshBuilder};
use crate::mesh::polygon::{self, CutQuality, triangulate};
use crate::mesh::rig::LARGEST_COORDINATE;
use crate::mesh::{Material, Mesh};
use crate::progress::Progress;

/// The greatest number of materials. A file with more is refused, since each takes memory and a draw call.
const MAX_MATERIALS: usize = 1 << 16;

/// The greatest number of corners of a face. A file with a larger face is refused.
pub(super) const MAX_CORNERS: usize = 1 << 19;

/// A corner of a face.
pub(super) trait FaceCorner: Copy {
    fn corner(&mut self) -> &mut InputCorner;

    /// A number of the reader's. Corners with different ones aren't merged.
    fn number(&self) -> u32 {
        0
    }
}

impl FaceCorner for InputCorner {
    fn corner(&mut self) -> &mut InputCorner {
        self
    }
}

/// A corner with its number.
#[derive(Clone, Copy)]
pub(super) struct NumberedCorner {
    pub corner: InputCorner,
    pub number: u32,
}

impl FaceCorner for NumberedCorner {
    fn corner(&mut self) -> &mut InputCorner {
        &mut self.corner
    }

    fn number(&self) -> u32 {
        self.number
    }
}

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
        corners: &mut Vec<impl FaceCorner>,
        place: FilePosition,
    ) -> Result<(), ReadError> {
        for corner in corners.iter_mut().map(FaceCorner::corner) {
            check(corner.position).map_err(|reason| place.error(reason))?;
            if !corner.uv.is_finite() {
                corner.uv = Vec2::ZERO;
                self.bad_uvs += 1;
            }
        }
        if corners.len() > 3 {
            let given = corners.len();
            corners.dedup_by_key(|corner| corner.corner().position);
            let first = corners.first_mut().map(|corner| corner.corner().position);
            if corners.len() > 1 && first == corners.last_mut().map(|corner| corner.corner().position) {
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

    fn cut<C: FaceCorner>(&mut self, material: usize, corners: &mut [C]) {
        let builder = &mut self.builder;
        let mut add = |triangle: [C; 3]| {
            let stored = triangle.map(|mut corner| builder.corner(*corner.corner(), corner.number()));
            builder.stored_triangle(material, stored);
        };
        if let Ok(triangle) = (&*corners).try_into() {
            add(triangle);
            return;
        }
        let outline: Vec<Vec3> = corners.iter_mut().map(|corner| corner.corner().position).collect();
        self.cut.clear();
        let cut = triangulate(&outline, &mut self.work, &mut self.cut);
        self.somehow += usize::from(cut == CutQuality::MayOverlap);
        for triangle in &self.cut {
            add(triangle.map(|i| corners[i]));
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
        warnings: Vec<String>,
        progress: &Progress,
    ) -> Result<LoadedMesh, ReadError> {
        let file_bytes = self.memory.files();
        let (mesh, _, warnings) = self.finish_numbered(name, holds, warnings, progress)?;
        Ok(LoadedMesh { mesh, warnings, file_bytes, ..LoadedMesh::default() })
    }

    /// Builds the mesh as [`finish`](Self::finish) does, and returns each corner's number and the warnings too.
    ///
    /// # Errors
    /// As [`finish`](Self::finish).
    pub(super) fn finish_numbered(
        self,
        name: &str,
        holds: String,
        mut warnings: Vec<String>,
        progress: &Progress,
    ) -> Result<(Mesh, Vec<u32>, Vec<String>), ReadError> {
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
        let (mesh, numbers) = self.builder.finish_bound(name.to_owned(), self.memory, progress)?;
        warnings.extend(repair_warnings(&mesh.repairs));
        Ok((mesh, numbers, warnings))
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

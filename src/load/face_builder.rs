//! Builds a mesh from the faces of OBJ, STL and PLY files: checks them, cuts polygons into triangles, and counts
//! repairs.

use std::sync::Arc;

use glam::{Vec2, Vec3, Vec4};

use super::loaded_mesh::LoadedMesh;
use super::memory_budget::Budget;
use super::read_error::{FilePosition, ReadError};
use super::warnings::repair_warnings;
use crate::mesh::build_limits::{MAX_TRIANGLES, MemoryRefused};
use crate::mesh::detail_table::DetailTable;
use crate::mesh::mesh_builder::{InputCorner, MeshBuilder};
use crate::mesh::polygon::{self, CutQuality, triangulate};
use crate::mesh::rig::LARGEST_COORDINATE;
use crate::mesh::{CornerDetail, Material};
use crate::numbers::linear;
use crate::progress::Progress;

/// The greatest number of materials. A file with more is refused, since each takes memory and a draw call.
const MAX_MATERIALS: usize = 1 << 16;

/// The greatest number of corners of a face. A file with a larger face is refused.
pub(super) const MAX_CORNERS: usize = 1 << 19;

/// A corner of a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FaceCorner {
    pub corner: InputCorner,
    /// Linear RGBA that multiplies the material's colour. It counts only in a file that [has colours](FaceBuilder::color).
    pub color: Vec4,
}

impl From<InputCorner> for FaceCorner {
    fn from(corner: InputCorner) -> Self {
        Self { corner, color: Vec4::ONE }
    }
}

/// The mesh that is being built, and counts of what was repaired or left out.
pub(super) struct FaceBuilder<'a> {
    memory: &'a Budget,
    builder: MeshBuilder,
    /// The colours of corners, if the file has any.
    colors: Option<DetailTable>,
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
    /// Faces with a position that isn't finite or is too far away, and the place of the first one.
    unplaced: (usize, Option<FilePosition>),
    /// The triangles of the polygon that is being cut.
    cut: Vec<[usize; 3]>,
}

impl<'a> FaceBuilder<'a> {
    /// Starts a mesh from a file of `bytes` bytes.
    pub(super) fn new(bytes: usize, memory: &'a Budget) -> Self {
        Self {
            memory,
            builder: MeshBuilder::new(),
            colors: None,
            materials: 0,
            triangles: 0,
            work: polygon::WorkBudget::new(bytes),
            too_small: 0,
            repeated: 0,
            somehow: 0,
            bad_uvs: 0,
            unplaced: (0, None),
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

    /// Keeps the colours of corners. Faces that were added before are white.
    pub(super) fn color(&mut self) {
        self.colors.get_or_insert_default();
    }

    /// Announces that about `triangles` more triangles, and about `corners` more distinct corners, will be added.
    pub(super) fn expect(&mut self, triangles: usize, corners: usize) {
        self.builder.expect(triangles.saturating_mul(3), corners);
    }

    /// Adds a face with any number of corners. Corners that can be repaired are repaired, in `corners` too. A face with a
    /// position that isn't finite or is too far away is left out. `place` is the face's position in the file.
    ///
    /// # Errors
    /// [`ReadError::TooMany`] and [`ReadError::TooLarge`].
    pub(super) fn add(
        &mut self,
        material: usize,
        corners: &mut Vec<FaceCorner>,
        place: FilePosition,
    ) -> Result<(), ReadError> {
        // A comparison with NaN is false.
        if !corners.iter().all(|at| at.corner.position.abs().cmple(Vec3::splat(LARGEST_COORDINATE)).all()) {
            self.unplaced.0 += 1;
            self.unplaced.1.get_or_insert(place);
            return Ok(());
        }
        for FaceCorner { corner, .. } in corners.iter_mut() {
            if !corner.uv.is_finite() {
                corner.uv = Vec2::ZERO;
                self.bad_uvs += 1;
            }
        }
        if corners.len() > 3 {
            let given = corners.len();
            corners.dedup_by_key(|at| at.corner.position);
            let ends = [corners.first(), corners.last()].map(|end| end.map(|at| at.corner.position));
            if corners.len() > 1 && ends[0] == ends[1] {
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
            .and_then(|()| self.cut(material, corners))
            .map_err(|refused| ReadError::TooLarge { reason: refused.into() })
    }

    fn cut(&mut self, material: usize, corners: &[FaceCorner]) -> Result<(), MemoryRefused> {
        if let &[a, b, c] = corners {
            return self.triangle(material, [a, b, c]);
        }
        let outline: Vec<Vec3> = corners.iter().map(|at| at.corner.position).collect();
        let mut cut = std::mem::take(&mut self.cut);
        cut.clear();
        let quality = triangulate(&outline, &mut self.work, &mut cut);
        self.somehow += usize::from(quality == CutQuality::MayOverlap);
        let added = cut.iter().try_for_each(|triangle| self.triangle(material, triangle.map(|i| corners[i])));
        self.cut = cut;
        added
    }

    fn triangle(&mut self, material: usize, corners: [FaceCorner; 3]) -> Result<(), MemoryRefused> {
        let Some(colors) = &mut self.colors else {
            self.builder.triangle(material, corners.map(|at| at.corner));
            return Ok(());
        };
        let mut numbers = [0; 3];
        for (number, FaceCorner { color, .. }) in numbers.iter_mut().zip(corners) {
            *number = colors.number(CornerDetail { color, ..CornerDetail::default() }, 0, self.memory)?;
        }
        let stored = [0, 1, 2].map(|i| self.builder.corner(corners[i].corner, numbers[i]));
        self.builder.stored_triangle(material, stored);
        Ok(())
    }

    /// Says how many faces have impossible positions, if any.
    fn unplaced(&self) -> Option<String> {
        let (count, Some(first)) = self.unplaced else { return None };
        let first = first.to_string();
        let first = first.trim_end_matches(": ");
        Some(format!(
            "{count} faces with a position that isn't a number or lies beyond {LARGEST_COORDINATE:e}, the first at {first}"
        ))
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
            let unplaced = self.unplaced().map(|unplaced| format!(", and {unplaced}")).unwrap_or_default();
            return Err(ReadError::Empty { holds: holds + &small + &unplaced });
        }
        warnings.extend(self.unplaced().map(|unplaced| format!("{unplaced}; they are left out.")));
        warnings.extend(counted([
            (self.bad_uvs, "uvs that aren't finite, replaced by (0, 0)"),
            (self.too_small, "faces of fewer than 3 corners, left out"),
            (self.repeated, "corners of polygons at the position of the corner before, left out"),
            (
                self.somehow,
                "polygons that have no area, cross themselves or are too large, cut into triangles that may overlap",
            ),
        ]));
        let (mut mesh, numbers) = self.builder.finish_bound(name.to_owned(), self.memory, progress)?;
        if let Some(colors) = self.colors {
            let too_large = |refused: MemoryRefused| ReadError::TooLarge { reason: refused.into() };
            let (details, _) = colors.into_lists(&numbers, self.memory).map_err(too_large)?;
            mesh.details = Some(Arc::new(details));
        }
        warnings.extend(repair_warnings(&mesh.repairs));
        Ok(LoadedMesh { mesh, warnings, file_bytes: self.memory.files(), ..LoadedMesh::default() })
    }
}

/// Decodes a vertex's colour: red, green and blue are encoded as sRGB, as scanners and painting programs write them.
pub(super) fn linear_color([r, g, b, a]: [u8; 4]) -> Vec4 {
    let [r, g, b] = [r, g, b].map(|byte| linear(f32::from(byte) / 255.0));
    Vec4::new(r, g, b, f32::from(a) / 255.0)
}

/// Returns a sentence for each count that isn't 0.
pub(super) fn counted(sentences: impl IntoIterator<Item = (usize, &'static str)>) -> impl Iterator<Item = String> {
    let found = sentences.into_iter().filter(|(count, _)| *count > 0);
    found.map(|(count, sentence)| format!("{sentence}: {count}."))
}

#[cfg(test)]
pub(super) mod tests;

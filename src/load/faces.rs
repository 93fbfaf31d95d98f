//! Faces of files that have no document, as triangles: checked, cut, counted.

use glam::{Vec2, Vec3};

use super::loaded_mesh::LoadedMesh;
use super::memory_budget::Budget;
use super::read_error::{Place, ReadError};
use super::warnings::repair_warnings;
use crate::mesh::Material;
use crate::mesh::build_limits::MAX_TRIANGLES;
use crate::mesh::mesh_builder::{LooseCorner, MeshBuilder};
use crate::mesh::polygon::{self, Cut, triangulate};
use crate::mesh::rig::LARGEST_COORDINATE;
use crate::progress::Progress;

/// A file of more materials than this is refused: each takes memory, and a draw.
const MAX_MATERIALS: usize = 1 << 16;

/// A face of more corners than this is refused.
pub const MAX_CORNERS: usize = 1 << 19;

/// What a mesh is made of meanwhile.
pub struct Faces<'a> {
    memory: &'a Budget,
    builder: MeshBuilder,
    materials: usize,
    triangles: usize,
    work: polygon::WorkBudget,
    /// Faces of fewer than 3 corners, corners on the place of the one before, faces cut somehow.
    too_small: usize,
    repeated: usize,
    somehow: usize,
    bad_uvs: usize,
    cut: Vec<[usize; 3]>,
}

impl<'a> Faces<'a> {
    /// For a file of so many bytes.
    pub fn new(bytes: usize, memory: &'a Budget) -> Self {
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

    /// Adds a material, for [`add`](Self::add).
    ///
    /// # Errors
    /// [`ReadError::TooMany`].
    pub fn material(&mut self, material: Material) -> Result<usize, ReadError> {
        self.materials += 1;
        if self.materials > MAX_MATERIALS {
            return Err(ReadError::TooMany { limit: MAX_MATERIALS as u64, what: "materials" });
        }
        Ok(self.builder.material(material))
    }

    /// There will be about so many triangles more, and distinct corners.
    pub fn expect(&mut self, triangles: usize, corners: usize) {
        self.builder.expect(triangles.saturating_mul(3), corners);
    }

    /// Adds a face of any number of corners; what can be mended is, in `corners` too. `place` is where the file has it.
    ///
    /// # Errors
    /// [`ReadError::Broken`] for positions that no mesh can have, [`ReadError::TooMany`].
    pub fn add(&mut self, material: usize, corners: &mut Vec<LooseCorner>, place: Place) -> Result<(), ReadError> {
        for corner in corners.iter_mut() {
            check(corner.position).map_err(|reason| place.fault(reason))?;
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

    fn cut(&mut self, material: usize, corners: &[LooseCorner]) {
        if let Ok(triangle) = corners.try_into() {
            self.builder.triangle(material, triangle);
            return;
        }
        let outline: Vec<Vec3> = corners.iter().map(|corner| corner.position).collect();
        self.cut.clear();
        let cut = triangulate(&outline, &mut self.work, &mut self.cut);
        self.somehow += usize::from(cut == Cut::Somehow);
        for triangle in &self.cut {
            self.builder.triangle(material, triangle.map(|i| corners[i]));
        }
    }

    /// The mesh. `holds` is what the file has in place of triangles, `warnings` what else is to be known.
    ///
    /// # Errors
    /// [`ReadError::Empty`] and [`ReadError::Cancelled`].
    pub fn finish(
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
            (self.repeated, "corners of polygons where the one before is, left out"),
            (
                self.somehow,
                "polygons without area, or whose sides cross, or too large, cut into triangles that may overlap",
            ),
        ]));
        let (mesh, _) = self.builder.finish_bound(name.to_owned(), self.memory, progress)?;
        warnings.extend(repair_warnings(&mesh.repairs));
        Ok(LoadedMesh { mesh, warnings, files: Vec::new(), file_bytes: self.memory.files() })
    }
}

/// A sentence for each of what there is some of.
pub fn counted(sentences: impl IntoIterator<Item = (usize, &'static str)>) -> impl Iterator<Item = String> {
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

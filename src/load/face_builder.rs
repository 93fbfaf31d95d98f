//! Builds a mesh from the faces of FBX, OBJ, STL, PLY, OFF and 3MF files: checks them, cuts polygons into triangles, and
//! counts repairs.

use glam::{Vec2, Vec3, Vec4};

use super::cage_faces::{CageFaces, OfFace};
use super::import::Import;
use super::loaded_mesh::{Contents, LoadedMesh};
use super::memory_budget::{Budget, edge_bytes};
use super::model_file::ModelFile;
use super::notes::{Notes, counted, counts};
use super::parts::Parts;
use super::read_error::{FilePosition, ReadError};
pub(super) use super::recent_corners::NumberedCorner;
use super::recent_corners::RecentCorners;
use super::rig_builder::RigBuilder;
use super::tangents;
use super::uri::Files;
use super::warnings::repair_warnings;
use geometry::mesh::build_limits::MAX_TRIANGLES;
use geometry::mesh::detail_table::DetailTable;
use geometry::mesh::mesh_builder::{InputCorner, MeshBuilder};
use geometry::mesh::mipmap::SRGB_TABLE;
use geometry::mesh::polygon::{self, CutQuality, triangulate};
use geometry::mesh::rig::LARGEST_COORDINATE;
use geometry::mesh::{CornerDetail, Material, PartStyle, Slot};
use geometry::progress::Progress;

/// The greatest number of materials. A file with more is refused, since each takes memory and a draw call.
const MAX_MATERIALS: usize = 1 << 16;

/// The greatest number of corners of a face. A file with a larger face is refused.
pub(super) const MAX_CORNERS: usize = 1 << 19;

/// The faces of a file, and what it holds in words.
pub(super) type Gathered<'a> = Result<(FaceBuilder<'a>, String), ReadError>;

/// Builds a mesh from a file's bytes, whose faces `gather` reads. It also says what the file holds in case it has no triangles.
///
/// # Errors
/// Those of `gather`, [`ReadError::Empty`] and [`ReadError::Cancelled`].
pub(super) fn read_faces(
    bytes: Vec<u8>,
    file: &ModelFile,
    gather: impl for<'a> FnOnce(&[u8], &'a Files<'a>, FaceBuilder<'a>) -> Gathered<'a>,
) -> Result<LoadedMesh, ReadError> {
    let budget = Budget::new(bytes.len(), file.limits.memory);
    let files = Files::new(file.folder, &file.limits, &budget, file.progress);
    let (faces, holds) = gather(&bytes, &files, FaceBuilder::new(file, &budget))?;
    budget.release(bytes.len() as u64);
    drop(bytes);
    let loaded = faces.finish(file.name, holds, &file.progress.part(0.5, 1.0))?;
    Ok(LoadedMesh { files: files.named(), ..loaded })
}

/// The mesh that is being built, and counts of what was repaired or left out.
pub(super) struct FaceBuilder<'a> {
    memory: &'a Budget,
    pub import: Import,
    /// What was repaired or left out.
    pub notes: Notes,
    pub parts: Parts,
    pub builder: MeshBuilder,
    recent: RecentCorners,
    /// The colours of corners, if the file has any, or if corners may need tangents.
    colors: Option<DetailTable>,
    are_colored: bool,
    materials: usize,
    /// How many triangles are stored so far.
    pub triangles: usize,
    work: polygon::WorkBudget,
    found: Counts,
    /// Faces with a position that isn't finite or is too far away, and the place of the first one.
    unplaced: (usize, Option<FilePosition>),
    /// Faces with the number of a position that the file doesn't have, and the place of the first one.
    misnumbered: (usize, Option<FilePosition>),
    /// The triangles of the polygon that is being cut.
    cut: Vec<[usize; 3]>,
    /// The faces that are to be refined, if any are.
    pub cage: Option<CageFaces>,
    /// Whether all cages could be refined; none if there wasn't any.
    pub is_refined: Option<bool>,
    /// Whether the next face of a cage is a hole.
    pub is_hole: bool,
}

counts! {
    struct Counts {
        bad_uvs => "uvs that aren't finite, replaced by (0, 0)";
        too_small => "faces of fewer than 3 corners, left out";
        degenerate => "faces of a subdivision surface's cage that have a point twice, left out";
        repeated => "corners of polygons at the position of the corner before, left out";
        maybe_overlapping =>
            "polygons that have no area, cross themselves or are too large, cut into triangles that may overlap";
    }
}

impl<'a> FaceBuilder<'a> {
    /// Starts a mesh, whose normals are made, and whose parts are left out, as was selected.
    pub(super) fn new(file: &ModelFile, memory: &'a Budget) -> Self {
        let import = file.selected.import;
        Self {
            memory,
            import,
            notes: Notes::default(),
            parts: Parts::new(&file.selected),
            builder: MeshBuilder::with_crease_angle(import.crease_angle),
            recent: RecentCorners::default(),
            colors: None,
            are_colored: false,
            materials: 0,
            triangles: 0,
            work: polygon::WorkBudget::new(usize::try_from(memory.files()).unwrap_or(usize::MAX)),
            found: Counts::default(),
            unplaced: (0, None),
            misnumbered: (0, None),
            cut: Vec::new(),
            cage: import.subdivision().map(CageFaces::new),
            is_refined: None,
            is_hole: false,
        }
    }

    /// Adds the refined faces of the cage that was collected. `details` are those of corners, if the reader has them, and `rig` what
    /// clips move.
    ///
    /// # Errors
    /// [`ReadError::TooMany`], [`ReadError::TooLarge`] and [`ReadError::Cancelled`].
    pub(super) fn end_cage(
        &mut self,
        details: Option<&mut DetailTable>,
        rig: Option<&mut RigBuilder>,
        progress: &Progress,
    ) -> Result<(), ReadError> {
        let Some(cage) = self.cage.take() else { return Ok(()) };
        let mut own = self.colors.take();
        let refined = cage.refine(
            (self.memory, progress),
            details.or(own.as_mut()),
            rig,
            |corners, OfFace { material, part, .. }| {
                progress.check()?;
                self.builder.enter_part(part);
                if self.import.makes_normals_of(self.parts.style(part, self.builder.material_mut(material).style)) {
                    corners.iter_mut().for_each(|at| at.corner.normal = None);
                }
                self.store(material, corners, false)
            },
        )?;
        self.colors = own;
        self.is_refined = Some(self.is_refined.unwrap_or(true) && refined.is_ok());
        let lone_creases = *refined.as_ref().unwrap_or(&0);
        self.notes.extend(counted([(lone_creases, "creases and sharp points that no face has, left out")]));
        let why_not = refined.err();
        self.notes.extend(why_not.map(|why| format!("A subdivision surface is shown as its control cage: {why}.")));
        Ok(())
    }

    /// The warning about faces that lack normals, as [`Import::lacking_normals`] has it. A refined surface has its own.
    pub(super) fn lacking_normals(&self, count: usize, what: &str) -> (usize, String) {
        self.import.lacking_normals(if self.cage.is_some() { 0 } else { count }, what)
    }

    /// Says which part the next faces belong to, as [`Parts::enter`] does.
    ///
    /// # Errors
    /// [`ReadError::TooLarge`].
    pub(super) fn enter_part(&mut self, path: &[u8], level: usize) -> Result<(), ReadError> {
        self.parts.enter(path, level, self.memory)?;
        self.builder.enter_part(self.parts.current());
        Ok(())
    }

    /// Adds a material and returns its index for [`add`](Self::add).
    ///
    /// # Errors
    /// [`ReadError::TooMany`].
    pub(super) fn material(&mut self, mut material: Material) -> Result<usize, ReadError> {
        self.materials += 1;
        if self.materials > MAX_MATERIALS {
            return Err(ReadError::TooMany { limit: MAX_MATERIALS as u64, what: "materials" });
        }
        self.parts.give_style(&mut material);
        Ok(self.builder.material(material))
    }

    /// What the next faces of a material have in place of what is said for all.
    pub(super) fn style(&mut self, material: usize) -> PartStyle {
        self.parts.style(self.parts.current(), self.builder.material_mut(material).style)
    }

    /// Returns how much more memory the mesh takes until it has its edges, in bytes, if no more faces are added.
    pub(super) fn bytes_to_finish(&self) -> u64 {
        let [corners, triangles] = [self.builder.distinct_corners(), self.triangles].map(|count| count as u64);
        edge_bytes(corners, triangles).saturating_sub(32 * corners + 12 * triangles)
    }

    /// Keeps the colours of corners from now on, and gives them tangents where a normal map needs them.
    ///
    /// # Errors
    /// [`ReadError::TooLarge`].
    pub(super) fn color(&mut self) -> Result<(), ReadError> {
        self.are_colored = true;
        self.colors.get_or_insert_default();
        // Corners that were added before have the number 0.
        self.number(Vec4::ONE).map(|_| ())
    }

    /// Gives corners tangents if a normal map needs them.
    pub(super) fn expect_normal_maps(&mut self) {
        self.colors.get_or_insert_default();
    }

    /// Returns the number of a corner of this colour, which multiplies the material's: linear RGBA. It is 0 in a file without
    /// [colours](Self::color).
    ///
    /// # Errors
    /// [`ReadError::TooLarge`].
    pub(super) fn number(&mut self, color: Vec4) -> Result<u32, ReadError> {
        let Some(colors) = &mut self.colors else { return Ok(0) };
        Ok(colors.number(CornerDetail { color, ..CornerDetail::default() }, 0, self.memory)?)
    }

    /// Announces that about `triangles` more triangles, and about `corners` more distinct corners, will be added.
    pub(super) fn expect(&mut self, triangles: usize, corners: usize) {
        self.builder.expect(triangles.saturating_mul(3), corners);
    }

    /// Leaves out a face with the number of a position that the file doesn't have.
    pub(super) fn leave_out(&mut self, place: FilePosition) {
        self.misnumbered.0 += 1;
        self.misnumbered.1.get_or_insert(place);
    }

    /// Adds a face with any number of corners. Corners that can be repaired are repaired, in `corners` too. A face with a
    /// position that isn't finite or is too far away is left out. `place` is the face's position in the file.
    ///
    /// # Errors
    /// [`ReadError::TooMany`] and [`ReadError::TooLarge`].
    pub(super) fn add(
        &mut self,
        material: usize,
        corners: &mut Vec<NumberedCorner>,
        place: FilePosition,
    ) -> Result<(), ReadError> {
        if !corners.iter().all(|at| is_near(&at.corner)) {
            self.unplaced.0 += 1;
            self.unplaced.1.get_or_insert(place);
            return Ok(());
        }
        let (bad_uvs, own) = (self.found.bad_uvs, self.style(material));
        for NumberedCorner { corner, .. } in corners.iter_mut() {
            if self.import.makes_normals_of(own) {
                corner.normal = None;
            }
            if !corner.uv.is_finite() {
                corner.uv = Vec2::ZERO;
                self.found.bad_uvs += 1;
            }
        }
        if corners.len() > 3 {
            let given = corners.len();
            // Vertices at one place may be points of their own.
            let by_vertex = self.cage.as_ref().is_some_and(|cage| cage.by_vertex);
            let point = |at: &NumberedCorner| (at.corner.position, at.vertex.filter(|_| by_vertex));
            corners.dedup_by_key(|at| point(at));
            if corners.len() > 1 && corners.first().map(point) == corners.last().map(point) {
                corners.pop();
            }
            self.found.repeated += given - corners.len();
        }
        if corners.len() < 3 {
            self.found.too_small += 1;
            return Ok(());
        }
        let is_left_out = self.parts.leave_out(corners.len() - 2);
        if let Some(cage) = &mut self.cage {
            self.cut.clear();
            let outline: Vec<Vec3> = corners.iter().map(|at| at.corner.position).collect();
            let cut = triangulate(&outline, &mut self.work, &mut self.cut);
            self.found.maybe_overlapping += usize::from(cut == CutQuality::MayOverlap);
            let face = OfFace { material, part: self.parts.current(), is_hole: is_left_out || self.is_hole };
            self.found.degenerate += cage.add(corners, face, &self.cut, self.memory)?;
            return Ok(());
        }
        if is_left_out {
            return Ok(());
        }
        // Repairs are counted again wherever their vertices are used, and other faces may have their vertices' own normals.
        self.store(material, corners, bad_uvs == self.found.bad_uvs && own.normals.is_none())
    }

    /// Stores a face as triangles, if there is room for them.
    fn store(&mut self, material: usize, corners: &[NumberedCorner], is_remembered: bool) -> Result<(), ReadError> {
        let triangles = corners.len() - 2;
        self.triangles += triangles;
        if self.triangles as u64 > MAX_TRIANGLES {
            return Err(ReadError::TooMany { limit: MAX_TRIANGLES, what: "triangles" });
        }
        self.builder.make_room_for_triangles(material, triangles, self.memory)?;
        self.builder.make_room(corners.len(), self.memory)?;
        self.cut(material, corners, is_remembered);
        Ok(())
    }

    /// Cuts a face into triangles. Corners are remembered for faces with the same vertices, unless they were repaired.
    fn cut(&mut self, material: usize, corners: &[NumberedCorner], is_remembered: bool) {
        let (builder, recent) = (&mut self.builder, &mut self.recent);
        let mut add = |triangle: [NumberedCorner; 3]| {
            let stored = triangle.map(|NumberedCorner { corner, number, vertex }| {
                let mut store = || builder.corner(corner, number);
                match vertex.filter(|_| is_remembered) {
                    Some(vertex) => recent.get(vertex, store),
                    None => store(),
                }
            });
            builder.stored_triangle(material, stored);
        };
        if let &[a, b, c] = corners {
            add([a, b, c]);
            return;
        }
        let outline: Vec<Vec3> = corners.iter().map(|at| at.corner.position).collect();
        self.cut.clear();
        let cut = triangulate(&outline, &mut self.work, &mut self.cut);
        self.found.maybe_overlapping += usize::from(cut == CutQuality::MayOverlap);
        for triangle in &self.cut {
            add(triangle.map(|i| corners[i]));
        }
    }

    /// Builds the mesh. `holds` says what the file has instead if it has no triangles.
    ///
    /// # Errors
    /// [`ReadError::Empty`] and [`ReadError::Cancelled`].
    pub(super) fn finish(mut self, name: &str, holds: String, progress: &Progress) -> Result<LoadedMesh, ReadError> {
        self.end_cage(None, None, progress)?;
        let (file_bytes, memory, colors) = (self.memory.files(), self.memory, self.colors.take());
        let are_colored = self.are_colored;
        let (mut loaded, numbers, mut notes) = self.finish_numbered(name, holds, progress)?;
        let has_normals = |material: &Material| material.look.maps[Slot::Normal as usize].is_some();
        if let Some(colors) = colors.filter(|_| are_colored || loaded.mesh.materials.iter().any(has_normals)) {
            tangents::with_details(&mut loaded.mesh, colors, &numbers, &mut notes, memory, progress)?;
        }
        Ok(LoadedMesh { warnings: notes.into_warnings(), file_bytes, ..loaded })
    }

    /// Builds the mesh as [`finish`](Self::finish) does; returns each corner's number too, and the notes, for what the reader adds.
    ///
    /// # Errors
    /// As [`finish`](Self::finish).
    pub(super) fn finish_numbered(
        mut self,
        name: &str,
        holds: String,
        progress: &Progress,
    ) -> Result<(LoadedMesh, Vec<u32>, Notes), ReadError> {
        self.end_cage(None, None, progress)?;
        self.parts.enter_materials(&mut self.builder, self.memory)?;
        let hides_all = self.builder.is_empty() && self.parts.are_hidden();
        let named = hides_all.then(|| format!("{holds}, and its parts are hidden; {}", self.parts.names()));
        let holds = named.unwrap_or(holds);
        // No more corners are stored.
        self.recent = RecentCorners::default();
        if self.builder.is_empty() {
            let small = match self.found.too_small {
                0 => String::new(),
                count => format!(", and {count} faces of fewer than 3 corners"),
            };
            let flawed: String = self.flawed().map(|flawed| format!(", and {flawed}")).collect();
            return Err(ReadError::Empty { holds: holds + &small + &flawed });
        }
        let flawed = self.flawed().map(|flawed| format!("{flawed}; they are left out."));
        self.notes.extend(flawed);
        self.notes.extend(self.found.sentences());
        let (mut mesh, numbers) = self.builder.finish_bound(name.to_owned(), self.memory, progress)?;
        let parts = self.parts.finish(&mut mesh, &mut self.notes);
        self.notes.extend(repair_warnings(&mesh.repairs, &self.import));
        let (contents, is_refined) = (Contents { parts, ..Contents::default() }, self.is_refined == Some(true));
        Ok((LoadedMesh { mesh, contents, is_refined, ..LoadedMesh::default() }, numbers, self.notes))
    }

    /// Says how many faces have impossible positions, and how many have numbers of positions that aren't there, if any.
    fn flawed(&self) -> impl Iterator<Item = String> + use<> {
        let place = |place: FilePosition| place.to_string().trim_end_matches(": ").to_owned();
        let unplaced = self.unplaced.1.map(|first| unplaced(self.unplaced.0, &place(first)));
        let misnumbered = self.misnumbered.1.map(|first| {
            faces_with(self.misnumbered.0, "the number of a position that isn't in the file", &place(first))
        });
        unplaced.into_iter().chain(misnumbered)
    }
}

/// Says how many faces have a position that can't be drawn; `first` is the place of the first one, if it is known.
pub(super) fn unplaced(count: usize, first: &str) -> String {
    faces_with(count, &format!("a position that isn't a number or lies beyond {LARGEST_COORDINATE:e}"), first)
}

fn faces_with(count: usize, what: &str, first: &str) -> String {
    let first = if first.is_empty() { String::new() } else { format!(", the first at {first}") };
    format!("{count} faces with {what}{first}")
}

/// Whether a position can be drawn. A comparison with NaN is false.
pub(super) fn is_near(corner: &InputCorner) -> bool {
    corner.position.abs().cmple(Vec3::splat(LARGEST_COORDINATE)).all()
}

/// Decodes a vertex's colour: red, green and blue are encoded as sRGB, as scanners and painting programs write them.
pub(super) fn linear_color([r, g, b, a]: [u8; 4]) -> Vec4 {
    let [r, g, b] = [r, g, b].map(|byte| SRGB_TABLE[usize::from(byte)]);
    Vec4::new(r, g, b, f32::from(a) / 255.0)
}

#[cfg(test)]
pub(super) mod tests;

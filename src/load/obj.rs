//! Reads Wavefront OBJ: polygons with texture coordinates and normals, and the colours of their materials.
//!
//! All groups and objects become one mesh, of which some may be left out. Weights are ignored. The file is read twice, on all
//! cores: first vertices and materials, then faces, so that faces may come before their vertices. If smoothing groups make
//! normals, faces are read twice.
//!
//! The crate `tobj` isn't used. It panics on an index near 2^63, gives a corner without a normal the normal of another
//! corner, doesn't know continued lines, and names no line in its errors.
//!
//! Source: Wavefront Technologies 1992, "Advanced Visualizer Manual", appendix B1.

mod faces;
mod materials;
mod mtl;
mod pieces;
mod smoothing;
mod tags;
mod textures;
mod vertices;

use glam::Vec4;

use super::face_builder::{FaceBuilder, Gathered, NumberedCorner, linear_color, read_faces};
use super::loaded_mesh::LoadedMesh;
use super::model_file::ModelFile;
use super::notes::counted;
use super::read_error::{FilePosition, ReadError};
use super::recent_corners::VertexNumbers;
use super::text_lines::{Line, Lines, first_word, in_utf8};
use super::uri::Files;
use geometry::casts::to_u32;
use geometry::mesh::mesh_builder::InputCorner;

use faces::{FacePiece, Found, StatementCounts};
use materials::Materials;
use pieces::{Piece, in_pieces};
use smoothing::Smoothing;
use tags::Tags;
use vertices::{VertexPiece, Vertices};

/// Builds a mesh from a file's bytes.
///
/// # Errors
/// [`ReadError`]. A missing material or texture isn't an error but a warning.
pub(super) fn read(bytes: Vec<u8>, file: &ModelFile) -> Result<LoadedMesh, ReadError> {
    let smooths = !file.selected.makes_all_normals();
    read_faces(in_utf8(bytes), file, |bytes, files, faces| gather(bytes, files, faces, smooths))
}

/// Reads all faces; with the normals of smoothing groups, if it `smooths`.
fn gather<'a>(bytes: &[u8], files: &'a Files<'a>, faces: FaceBuilder<'a>, smooths: bool) -> Gathered<'a> {
    let (budget, progress) = (files.budget, files.progress);
    let pieces = Piece::all(bytes);
    let (mut vertices, mut above) = (Vertices::default(), Vec::with_capacity(pieces.len()));
    let mut tags = Tags::default();
    let mut materials = Materials::default();
    let take = |more: VertexPiece| {
        above.push(vertices.counts());
        vertices.add(&more, budget)?;
        more.libraries.iter().for_each(|names| materials.add_library(names, files));
        Ok(more.tags.iter().filter(|_| faces.cage.is_some()).try_for_each(|tag| tags.take(tag, budget))?)
    };
    in_pieces(&pieces, |_, piece| VertexPiece::parse(piece), take, budget, &progress.part(0.0, 0.25))?;
    tags.holes.sort_unstable();
    let counts = vertices.counts();
    let parse = |i: usize, piece: &Piece| FacePiece::parse(piece, above[i], counts);
    let held = budget.held();
    let mut smoothing = Smoothing::new(&vertices, budget);
    let is_smoothed = vertices.is_smoothed && smooths;
    if is_smoothed {
        in_pieces(&pieces, parse, |made| smoothing.take(&made), budget, &progress.part(0.25, 0.3))?;
    }
    let of_smoothing = budget.held() - held;
    let mut reader = Reader {
        vertices: &vertices,
        holes: &tags.holes,
        faces,
        materials,
        part: Default::default(),
        smoothing: is_smoothed.then_some(smoothing),
        corners: Vec::new(),
        found: Counts::default(),
    };
    if !vertices.colors.is_empty() {
        reader.faces.color()?;
    }
    if reader.materials.may_have_normal_maps() {
        reader.faces.expect_normal_maps();
    }
    in_pieces(&pieces, parse, |made| reader.take_piece(made), budget, &progress.part(0.3, 0.5))?;
    reader.smoothing = None;
    budget.release(of_smoothing);
    let Reader { mut faces, mut materials, found, .. } = reader;
    tags.apply(&mut faces, &vertices.positions, found.faces);
    materials.read_images(&mut faces, files, bytes.len() as u64 + vertices.bytes())?;
    faces.notes.extend(materials.warnings());
    let lacking = faces.lacking_normals(found.without_normals, "faces without normals, or with some missing");
    faces.notes.extend(counted([lacking]));
    let smoothed = "faces without normals, or with some missing, which got those of their smoothing groups";
    faces.notes.extend(counted([(found.smoothed, smoothed)]));
    faces.notes.extend(vertices.flaws.sentences().chain(found.statements.sentences()));
    let holds = found.holds(&vertices);
    budget.release(vertices.bytes());
    Ok((faces, holds))
}

/// A statement: a line, joined with the lines that continue it.
struct Statement<'a> {
    /// The number of its first line, from 1.
    number: usize,
    /// Its first word; empty if it has none.
    word: &'a [u8],
    /// What follows, with a comment if there is one.
    rest: &'a [u8],
}

impl<'a> Statement<'a> {
    fn new(number: usize, text: &'a [u8]) -> Self {
        let (word, rest) = first_word(text);
        let is_comment = word.first() == Some(&b'#');
        let (word, rest) = if is_comment { (&b""[..], &b""[..]) } else { (word, rest) };
        Self { number, word, rest }
    }

    /// Returns what follows the first word, without a comment. A comment starts with a `#` at the start of a word, since names
    /// may contain one.
    fn rest(&self) -> &'a [u8] {
        let begins = |i: &usize| *i == 0 || self.rest[i - 1].is_ascii_whitespace();
        let comment = memchr::memchr_iter(b'#', self.rest).find(begins);
        &self.rest[..comment.unwrap_or(self.rest.len())]
    }

    fn place(&self) -> FilePosition {
        FilePosition::Line(self.number)
    }
}

/// Calls `take` with each statement.
///
/// # Errors
/// [`ReadError::Broken`] for a line that is too long, and those of `take`.
fn each_statement(
    mut lines: Lines,
    mut take: impl FnMut(&Statement) -> Result<(), ReadError>,
) -> Result<(), ReadError> {
    while let Some(Line { text, number }) = lines.next()? {
        // A comment may end with a backslash, as in the path of a Windows folder.
        match text.strip_suffix(b"\\").filter(|_| !text.trim_ascii_start().starts_with(b"#")) {
            None => take(&Statement::new(number, text))?,
            Some(start) => take(&Statement::new(number, &continued(start, &mut lines)?))?,
        }
    }
    Ok(())
}

/// Returns the start of a line joined with the lines that continue it. A line that ends with `\` is continued.
fn continued(start: &[u8], lines: &mut Lines) -> Result<Vec<u8>, ReadError> {
    let mut all = start.to_vec();
    while let Some(line) = lines.next()? {
        let part = line.text.strip_suffix(b"\\");
        all.push(b' ');
        all.extend(part.unwrap_or(line.text));
        lines.check(all.len())?;
        if part.is_none() {
            break;
        }
    }
    Ok(all)
}

/// What was found among the faces.
#[derive(Default)]
struct Counts {
    statements: StatementCounts,
    faces: usize,
    /// Faces with a corner that has no normal.
    without_normals: usize,
    /// Faces whose missing normals came from their smoothing groups.
    smoothed: usize,
}

impl Counts {
    fn holds(&self, vertices: &Vertices) -> String {
        let StatementCounts { points, lines, surfaces, unknown, .. } = self.statements;
        if vertices.positions.is_empty() && self.faces + points + lines + surfaces == 0 {
            let unknown = match unknown {
                0 => String::new(),
                1 => ", and a statement that OBJ doesn't have".to_owned(),
                _ => format!(", and {unknown} statements that OBJ doesn't have"),
            };
            return format!("it has no vertices{unknown}");
        }
        let surfaces = (surfaces, "free-form curves and surfaces (export them as polygons)");
        let others = [(points, "points (p)"), (lines, "lines (l)"), surfaces];
        let others = others.into_iter().filter(|(count, _)| *count > 0);
        let others: String = others.map(|(count, what)| format!(", {count} {what}")).collect();
        format!("it holds {} positions{others}", vertices.positions.len())
    }
}

/// Reads the faces of a file.
struct Reader<'v, 'a> {
    vertices: &'v Vertices,
    /// The faces that are holes of a subdivision surface.
    holes: &'v [u32],
    faces: FaceBuilder<'a>,
    materials: Materials,
    /// The names of the object and of the group that the next faces belong to.
    part: [Vec<u8>; 2],
    /// The normals that smoothing groups make, if there are groups.
    smoothing: Option<Smoothing<'v>>,
    /// The corners of the face that is being read.
    corners: Vec<NumberedCorner>,
    found: Counts,
}

impl Reader<'_, '_> {
    /// Takes what was found in the next piece of the file.
    fn take_piece(&mut self, made: FacePiece) -> Result<(), ReadError> {
        let FacePiece { found, corners, counts } = made;
        self.found.statements += counts;
        let mut start = 0;
        for found in found {
            match found {
                Found::Face { line, end } => {
                    self.faces.is_hole = self.holes.binary_search(&to_u32(self.found.faces)).is_ok();
                    self.found.faces += 1;
                    self.add_face(&corners[start..end as usize], FilePosition::Line(line))?;
                    start = end as usize;
                }
                Found::Absent { line } => {
                    self.found.faces += 1;
                    self.begin_parts()?;
                    self.faces.leave_out(FilePosition::Line(line));
                }
                Found::Smoothing(group) => self.smoothing.iter_mut().for_each(|smoothing| smoothing.group = group),
                Found::Object(name) => self.enter_part(0, &name)?,
                Found::Group(name) => self.enter_part(1, &name)?,
                Found::Material(name) => self.materials.enter(&name),
            }
        }
        Ok(())
    }

    /// Begins an object (0) or a group (1). A part is a group of an object.
    fn enter_part(&mut self, kind: usize, name: &[u8]) -> Result<(), ReadError> {
        self.part[kind] = name.to_vec();
        let [object, group] = &self.part;
        let path = if object == group { object.clone() } else { [object, &b"/"[..], group].concat() };
        self.faces.enter_part(&path, 0)
    }

    /// Enters the part of faces that belong to none, if there was none before.
    fn begin_parts(&mut self) -> Result<(), ReadError> {
        if self.faces.parts.have_begun() { Ok(()) } else { self.faces.enter_part(b"", 0) }
    }

    /// Adds a face with these corners.
    fn add_face(&mut self, numbers: &[VertexNumbers], place: FilePosition) -> Result<(), ReadError> {
        self.begin_parts()?;
        let mut corners = std::mem::take(&mut self.corners);
        corners.clear();
        for &vertex in numbers {
            let (corner, color) = corner_of(self.vertices, vertex);
            corners.push(NumberedCorner { corner, number: self.faces.number(color)?, vertex: Some(vertex) });
        }
        let material = self.materials.current(&mut self.faces)?;
        let own = self.faces.style(material);
        if !self.faces.import.makes_normals_of(own) && corners.iter().any(|at| at.corner.normal.is_none()) {
            let smoothed = self.smoothing.as_ref().is_some_and(|smoothing| smoothing.complete(numbers, &mut corners));
            // Where a crease angle was chosen, none is missed.
            let counts = usize::from(smoothed || own.crease_angle.is_none());
            *if smoothed { &mut self.found.smoothed } else { &mut self.found.without_normals } += counts;
        }
        for at in &mut corners {
            let placed = self.materials.placed(material, at.corner.uv);
            // Another material may place them elsewhere.
            at.vertex = at.vertex.filter(|_| placed == at.corner.uv);
            at.corner.uv = placed;
        }
        self.faces.add(material, &mut corners, place)?;
        self.corners = corners;
        Ok(())
    }
}

/// Returns the corner with these numbers of its position, texture coordinates and normal, and its colour.
fn corner_of(vertices: &Vertices, [position, uv, normal]: VertexNumbers) -> (InputCorner, Vec4) {
    let color = vertices.colors.get(position as usize).map_or(Vec4::ONE, |&color| linear_color(color));
    let corner = InputCorner {
        position: vertices.positions.get(position as usize).copied().unwrap_or_default(),
        normal: vertices.normals.get(normal as usize).copied(),
        uv: vertices.uvs.get(uv as usize).copied().unwrap_or_default(),
    };
    (corner, color)
}

#[cfg(test)]
pub(super) mod tests;

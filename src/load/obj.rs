//! Reads Wavefront OBJ: polygons with texture coordinates and normals, and the colours of their materials.
//!
//! All groups and objects become one mesh, of which some may be left out. Weights are ignored. The file is read twice, on all
//! cores: first vertices and materials, then faces, so that faces may come before their vertices. If smoothing groups make
//! normals, it is read a third time in between.
//!
//! The crate `tobj` isn't used. It panics on an index near 2^63, gives a corner without a normal the normal of another
//! corner, doesn't know continued lines, and names no line in its errors.
//!
//! Source: Wavefront Technologies 1992, "Advanced Visualizer Manual", appendix B1.

mod bump_maps;
mod faces;
mod materials;
mod mtl;
mod pieces;
mod smoothing;
mod textures;
mod vertices;

use std::borrow::Cow;
use std::path::Path;

use glam::Vec4;

use super::face_builder::{FaceBuilder, MAX_CORNERS, NumberedCorner, counted, linear_color};
use super::import::Import;
use super::loaded_mesh::LoadedMesh;
use super::memory_budget::Budget;
use super::read_error::{FilePosition, ReadError};
use super::recent_corners::VertexNumbers;
use super::selection::Selection;
use super::text_lines::{Line, Lines, first_word, of_utf16, shown, words};
use super::triangle_block::BLOCK;
use super::uri::Files;
use crate::files::Limits;
use geometry::mesh::build_limits::MemoryRefused;
use geometry::mesh::mesh_builder::InputCorner;
use geometry::progress::Progress;

use faces::{FacePiece, Found, NONE, StatementCounts, fitting, index};
use materials::Materials;
use pieces::{Piece, in_pieces};
use smoothing::Smoothing;
use vertices::{VertexPiece, Vertices};

/// The part of faces that belong to no object and no group; the specification calls it so.
const DEFAULT_PART: &[u8] = b"default";

/// Builds a mesh from a file's bytes.
///
/// `folder` is the file's folder; `name` becomes the mesh's name.
///
/// # Errors
/// [`ReadError`]. A missing material or texture isn't an error but a warning.
pub(super) fn read(
    bytes: Vec<u8>,
    folder: &Path,
    name: &str,
    selected: Selection,
    limits: &Limits,
    progress: &Progress,
) -> Result<LoadedMesh, ReadError> {
    let Selection { import, hidden, .. } = selected;
    let budget = Budget::new(bytes.len(), limits.memory);
    let bytes = of_utf16(&bytes, |bytes| budget.hold(bytes)).map_err(too_large)?.unwrap_or(bytes);
    let files = Files::new(folder, limits, &budget, progress);
    let pieces = Piece::all(&bytes);
    let (mut vertices, mut above) = (Vertices::default(), Vec::with_capacity(pieces.len()));
    let mut materials = Materials::new(&files, &budget);
    let take = |_: &Piece, more: VertexPiece| {
        above.push(vertices.counts());
        vertices.add(&more, &budget)?;
        more.libraries.iter().for_each(|names| materials.add_library(names));
        more.error.map_or(Ok(()), Err)
    };
    in_pieces(&pieces, |_, piece| VertexPiece::parse(piece), take, (&budget, &progress.part(0.0, 0.2)))?;
    bump_maps::find_normal_maps(&mut materials, &pieces, (&budget, &progress.part(0.2, 0.25)))?;
    let counts = vertices.counts();
    let mut smoothing = Smoothing::new(&vertices, &budget);
    let is_smoothed = vertices.is_smoothed && !import.makes_normals();
    if is_smoothed {
        each(&bytes, &progress.part(0.25, 0.3), |line| smoothing.take(line))?;
    }
    let mut reader = Reader {
        vertices: &vertices,
        above: [0; 3],
        faces: FaceBuilder::new(bytes.len(), &budget).importing(import).hiding(hidden),
        materials,
        part: Default::default(),
        smoothing: is_smoothed.then_some(smoothing),
        corners: Vec::new(),
        numbers: Vec::new(),
        found: Counts::default(),
    };
    if !vertices.colors.is_empty() || reader.materials.have_normal_maps() {
        reader.faces.color();
    }
    let parse = |i: usize, piece: &Piece| FacePiece::parse(piece, above[i], counts);
    let take = |piece: &Piece, made| reader.take_piece(piece, made);
    in_pieces(&pieces, parse, take, (&budget, &progress.part(0.3, 0.5)))?;
    reader.smoothing.take().into_iter().for_each(Smoothing::release);
    let freed = bytes.len() as u64 + vertices.bytes();
    reader.materials.read_textures(&mut reader.faces, freed, progress)?;
    let mut warnings = reader.materials.warnings();
    warnings.extend(reader.found.warnings(&import, &vertices));
    let holds = reader.found.holds(&vertices);
    let faces = reader.faces;
    budget.release(freed);
    drop(pieces);
    drop((bytes, vertices));
    let loaded = faces.finish(name, holds, warnings, &progress.part(0.5, 1.0))?;
    Ok(LoadedMesh { files: files.named(), ..loaded })
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
    fn of(line: &Line<'a>) -> Self {
        let (word, rest) = first_word(line.text);
        let is_comment = word.first() == Some(&b'#');
        let (word, rest) = if is_comment { (&b""[..], &b""[..]) } else { (word, rest) };
        Self { number: line.number, word, rest }
    }

    /// Returns what follows the first word, without a comment.
    fn rest(&self) -> &'a [u8] {
        without_comment(self.rest)
    }

    fn place(&self) -> FilePosition {
        FilePosition::Line(self.number)
    }
}

/// Calls `take` with each statement.
fn each(
    bytes: &[u8],
    progress: &Progress,
    mut take: impl FnMut(&Statement) -> Result<(), ReadError>,
) -> Result<(), ReadError> {
    let (mut lines, mut next) = (Lines::new(bytes), 0);
    let mut taken = Ok(());
    while next_statement(&mut lines, |statement| taken = take(statement))? {
        std::mem::replace(&mut taken, Ok(()))?;
        if lines.count() >= next {
            next = lines.count() + 4096;
            progress.set(1.0 - lines.rest().len() as f32 / bytes.len() as f32);
            progress.check()?;
        }
    }
    Ok(())
}

/// Passes the next statement to `take`. Returns false at the end of the text.
///
/// # Errors
/// [`ReadError::Broken`] for a line that is too long.
fn next_statement(lines: &mut Lines, take: impl FnOnce(&Statement)) -> Result<bool, ReadError> {
    let Some(line) = lines.next()? else { return Ok(false) };
    // A comment may end with a backslash, as in the path of a Windows folder.
    let is_whole = line.text.last() != Some(&b'\\') || line.text.trim_ascii_start().starts_with(b"#");
    if is_whole {
        take(&Statement::of(&line));
    } else {
        let text = continued(line.text, lines)?;
        take(&Statement::of(&Line { text: &text, number: line.number }));
    }
    Ok(true)
}

/// Returns a line joined with the lines that continue it. A line that ends with `\` is continued.
fn continued<'a>(text: &'a [u8], lines: &mut Lines<'a>) -> Result<Cow<'a, [u8]>, ReadError> {
    let Some(start) = text.strip_suffix(b"\\") else { return Ok(text.into()) };
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
    Ok(all.into())
}

/// Returns the text before a comment. A comment starts with a `#` at the start of a word, since names may contain one.
fn without_comment(text: &[u8]) -> &[u8] {
    let begins = |i: &usize| *i == 0 || text[i - 1].is_ascii_whitespace();
    let comment = memchr::memchr_iter(b'#', text).find(begins);
    &text[..comment.unwrap_or(text.len())]
}

fn too_large(refused: MemoryRefused) -> ReadError {
    ReadError::TooLarge { reason: refused.into() }
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
    /// Corners with more than three numbers.
    long_corners: usize,
    /// Corners whose normal, or whose texture coordinates, aren't in the file.
    absent_normals: usize,
    absent_uvs: usize,
}

impl Counts {
    fn warnings(&self, import: &Import, vertices: &Vertices) -> impl Iterator<Item = String> {
        let lacking = import.lacking_normals(self.without_normals, "faces without normals, or with some missing");
        let StatementCounts { points, lines, surfaces, calls, unknown } = self.statements;
        let others = counted([
            (self.smoothed, "faces without normals, or with some missing, which got those of their smoothing groups"),
            (vertices.with_commas, "statements with a comma in a number, which was taken for its point"),
            (vertices.flat, "positions of two numbers, which are placed at z = 0"),
            (self.long_corners, "corners with more than three numbers, of which the first three are read"),
            (self.absent_normals, "corners with the number of a normal that isn't in the file, left out"),
            (
                self.absent_uvs,
                "corners with the number of texture coordinates that aren't in the file, replaced by (0, 0)",
            ),
            (points, "points (p), left out"),
            (lines, "lines (l), left out"),
            (surfaces, "free-form curves and surfaces (curv, curv2, surf), which aren't read"),
            (calls, "calls of other files and of programs (call, csh), left out"),
            (unknown, "statements that OBJ doesn't have, left out"),
        ]);
        counted([lacking]).chain(others)
    }

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

/// Returns how many of the first faces are triangles, if the corners of the first begin with this one.
fn triangles(faces: &[Found], start: usize) -> usize {
    let ends = (1..).map(|triangles| start + 3 * triangles);
    let is_triangle = |(face, own): &(&Found, usize)| matches!(face, Found::Face { end, .. } if *end as usize == *own);
    faces.iter().zip(ends).take_while(is_triangle).count()
}

/// Reads the faces of a file.
struct Reader<'v, 'a> {
    vertices: &'v Vertices,
    /// The numbers of positions, texture coordinates and normals above the current statement.
    above: [usize; 3],
    faces: FaceBuilder<'a>,
    materials: Materials<'a>,
    /// The names of the object and of the group that the next faces belong to.
    part: [Vec<u8>; 2],
    /// The normals that smoothing groups make, if there are groups.
    smoothing: Option<Smoothing<'v>>,
    /// The corners of the face that is being read, and their numbers.
    corners: Vec<NumberedCorner>,
    numbers: Vec<VertexNumbers>,
    found: Counts,
}

impl Reader<'_, '_> {
    /// Takes the faces of the next piece of the file, and what else it has.
    fn take_piece(&mut self, piece: &Piece, made: FacePiece) -> Result<(), ReadError> {
        self.found.statements.add(made.counts);
        let (mut start, mut found) = (0, made.found.as_slice());
        while let [first, others @ ..] = found {
            let run = triangles(found, start);
            if run > 0 {
                let (faces, others) = found.split_at(run);
                let end = start + 3 * run;
                self.take_triangles(faces, made.corners[start..end].as_chunks().0)?;
                (start, found) = (end, others);
                continue;
            }
            match *first {
                Found::Face { line, end } => {
                    self.found.faces += 1;
                    self.add_face(&made.corners[start..end as usize], FilePosition::Line(line))?;
                    start = end as usize;
                }
                Found::Other { at, lines, above } => {
                    self.above = above.map(|count| count as usize);
                    let mut taken = Ok(());
                    let mut lines = piece.lines_from(at as usize, lines);
                    next_statement(&mut lines, |statement| taken = self.take(statement))?;
                    taken?;
                }
            }
            found = others;
        }
        made.error.map_or(Ok(()), Err)
    }

    /// Takes faces that are triangles, and their corners.
    fn take_triangles(&mut self, faces: &[Found], triangles: &[[VertexNumbers; 3]]) -> Result<(), ReadError> {
        self.found.faces += faces.len();
        self.begin_parts()?;
        let mut next = 0;
        while next < faces.len() {
            next += self.add_triangles(&triangles[next..])?;
            if let (Some(Found::Face { line, .. }), Some(triangle)) = (faces.get(next), triangles.get(next)) {
                self.add_face(triangle, FilePosition::Line(*line))?;
                next += 1;
            }
        }
        Ok(())
    }

    /// Takes a statement that isn't a plain face.
    fn take(&mut self, statement: &Statement) -> Result<(), ReadError> {
        match statement.word {
            b"f" | b"fo" => self.face(statement)?,
            b"s" => self.smoothing.iter_mut().for_each(|smoothing| smoothing.enter(statement.rest())),
            word @ (b"o" | b"g") => self.enter_part(word, statement.rest())?,
            b"usemtl" => self.materials.enter(statement.rest()),
            _ => {}
        }
        Ok(())
    }

    /// Begins an object (`o`) or a group (`g`). A part is a group of an object.
    fn enter_part(&mut self, word: &[u8], name: &[u8]) -> Result<(), ReadError> {
        self.part[usize::from(word == b"g")] = name.to_vec();
        let [object, group] = &self.part;
        match (object.is_empty(), group.is_empty()) {
            (true, true) => self.faces.enter_part(DEFAULT_PART),
            (true, false) => self.faces.enter_part(group),
            (false, _) if group.is_empty() || group == object => self.faces.enter_part(object),
            (false, _) => self.faces.enter_part(&[object, &b"/"[..], group].concat()),
        }
    }

    fn face(&mut self, statement: &Statement) -> Result<(), ReadError> {
        self.found.faces += 1;
        let mut numbers = std::mem::take(&mut self.numbers);
        numbers.clear();
        for word in words(statement.rest()) {
            if numbers.len() == MAX_CORNERS {
                return Err(statement.place().error(format!("the face has more than {MAX_CORNERS} corners")));
            }
            match self.corner(word).map_err(|reason| statement.place().error(reason))? {
                Some(corner) => numbers.push(corner),
                None => {
                    self.begin_parts()?;
                    self.faces.leave_out(statement.place());
                    self.numbers = numbers;
                    return Ok(());
                }
            }
        }
        self.add_face(&numbers, statement.place())?;
        self.numbers = numbers;
        Ok(())
    }

    /// Enters the part of faces that belong to none, if there was none before.
    fn begin_parts(&mut self) -> Result<(), ReadError> {
        if self.faces.has_parts() { Ok(()) } else { self.faces.enter_part(DEFAULT_PART) }
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
        if corners.iter().any(|at| at.corner.normal.is_none()) {
            let smoothed = self.smoothing.as_ref().is_some_and(|smoothing| smoothing.complete(numbers, &mut corners));
            *if smoothed { &mut self.found.smoothed } else { &mut self.found.without_normals } += 1;
        }
        let material = self.materials.current(&mut self.faces)?;
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

    /// Adds triangles whose corners are as the file has them. Returns how many were added; the general way must add the next one,
    /// unless there are [`BLOCK`].
    fn add_triangles(&mut self, triangles: &[[VertexNumbers; 3]]) -> Result<usize, ReadError> {
        let lacks_normals = |triangle: &[VertexNumbers; 3]| triangle.iter().any(|[.., normal]| *normal == NONE);
        let material = self.materials.current(&mut self.faces)?;
        if self.materials.moves(material) {
            return Ok(0);
        }
        let mut plain = &triangles[..triangles.len().min(BLOCK)];
        if self.smoothing.is_some() {
            plain = &plain[..plain.iter().position(lacks_normals).unwrap_or(plain.len())];
        }
        let vertices = self.vertices;
        let added = self.faces.add_triangles(material, plain, |vertex| Some(corner_of(vertices, vertex)))?;
        self.found.without_normals += plain[..added].iter().filter(|triangle| lacks_normals(triangle)).count();
        Ok(added)
    }

    /// Parses a corner: `v`, `v/vt`, `v//vn` or `v/vt/vn`. Returns its numbers; none if the position isn't in the file.
    ///
    /// # Errors
    /// A clause that says what isn't a number.
    fn corner(&mut self, word: &[u8]) -> Result<Option<VertexNumbers>, String> {
        let mut parts = word.split(|&byte| byte == b'/');
        let [position, uv, normal] = [0, 1, 2].map(|_| parts.next().filter(|part| !part.is_empty()));
        self.found.long_corners += usize::from(parts.next().is_some());
        let Some(position) = position else {
            return Err(format!("{} isn't a corner, such as 1, 1/2, 1//3 or 1/2/3", shown(word)));
        };
        let counts = self.vertices.counts();
        let Some(position) = index(position, self.above[0], counts[0])?.and_then(fitting) else { return Ok(None) };
        // A corner needs its position alone.
        let optional = |word: Option<&[u8]>, kind: usize, absent: &mut usize| {
            let found = word.and_then(|word| index(word, self.above[kind], counts[kind]).ok().flatten());
            let number = found.and_then(fitting);
            *absent += usize::from(word.is_some() && number.is_none());
            number.unwrap_or(NONE)
        };
        let uv = optional(uv, 1, &mut self.found.absent_uvs);
        let normal = optional(normal, 2, &mut self.found.absent_normals);
        Ok(Some([position, uv, normal]))
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

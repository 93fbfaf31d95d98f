//! Reads Wavefront OBJ: polygons with texture coordinates and normals, and the colours of their materials.
//!
//! All groups and objects become one mesh, of which some may be left out. Weights are ignored. The file is read twice, first vertices and materials and then faces, so
//! that faces may come before their vertices; and a third time in between if smoothing groups make normals.
//!
//! The crate `tobj` isn't used. It panics on an index near 2^63, gives a corner without a normal the normal of another
//! corner, doesn't know continued lines, and names no line in its errors.
//!
//! Source: Wavefront Technologies 1992, "Advanced Visualizer Manual", appendix B1.

mod materials;
mod mtl;
mod smoothing;
mod textures;

use std::borrow::Cow;
use std::path::Path;

use glam::{Vec2, Vec3, Vec4};

use super::face_builder::{FaceBuilder, MAX_CORNERS, NumberedCorner, counted, linear_color};
use super::import::Import;
use super::loaded_mesh::LoadedMesh;
use super::memory_budget::Budget;
use super::read_error::{FilePosition, ReadError};
use super::recent_corners::VertexNumbers;
use super::selection::Selection;
use super::text_lines::{Line, Lines, first_word, has_comma, numbers_or_nan, of_utf16, shown, words};
use super::uri::Files;
use crate::files::Limits;
use crate::mesh::MemoryAccount;
use crate::mesh::build_limits::MemoryRefused;
use crate::mesh::chunked_vec::ChunkedVec;
use crate::mesh::mesh_builder::InputCorner;
use crate::progress::Progress;

use materials::Materials;
use smoothing::Smoothing;

/// Statements that are ignored without a warning, since they change neither shape nor colour here.
const SILENT: [&[u8]; 21] = [
    b"vp",
    b"mg",
    b"lod",
    b"bevel",
    b"c_interp",
    b"d_interp",
    b"cstype",
    b"deg",
    b"bmat",
    b"step",
    b"parm",
    b"trim",
    b"hole",
    b"scrv",
    b"sp",
    b"end",
    b"con",
    b"usemap",
    b"maplib",
    b"shadow_obj",
    b"trace_obj",
];

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
    let budget = Budget::new(bytes.len(), limits);
    let bytes = of_utf16(&bytes, |bytes| budget.hold(bytes)).map_err(too_large)?.unwrap_or(bytes);
    let files = Files::new(folder, limits, &budget, progress);
    let mut vertices = Vertices::default();
    let mut materials = Materials::new(&files, &budget);
    each(&bytes, &progress.part(0.0, 0.2), |statement| {
        if statement.word == b"mtllib" {
            materials.add_library(statement.rest());
        }
        vertices.take(statement, &budget)
    })?;
    let mut smoothing = Smoothing::new(&vertices, &budget);
    let is_smoothed = vertices.is_smoothed && !import.makes_normals();
    if is_smoothed {
        each(&bytes, &progress.part(0.2, 0.3), |line| smoothing.take(line))?;
    }
    let mut reader = Reader {
        vertices: &vertices,
        above: [0; 3],
        faces: FaceBuilder::new(bytes.len(), &budget).importing(import).hiding(hidden),
        materials,
        part: Default::default(),
        smoothing: is_smoothed.then_some(smoothing),
        corners: Vec::new(),
        indices: Vec::new(),
        found: StatementCounts::default(),
    };
    if !vertices.colors.is_empty() || reader.materials.have_normal_maps() {
        reader.faces.color();
    }
    each(&bytes, &progress.part(0.3, 0.5), |line| reader.take(line))?;
    reader.smoothing.take().into_iter().for_each(Smoothing::release);
    let freed = bytes.len() as u64 + vertices.bytes();
    reader.materials.read_textures(&mut reader.faces, freed, progress)?;
    let mut warnings = reader.materials.warnings();
    warnings.extend(reader.found.warnings(&import));
    let holds = reader.found.holds(&vertices);
    let faces = reader.faces;
    budget.release(freed);
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
    let mut lines = Lines::new(bytes);
    let mut next = 0;
    while let Some(line) = lines.next()? {
        if line.number >= next {
            next = line.number + 4096;
            progress.set(1.0 - lines.rest().len() as f32 / bytes.len() as f32);
            progress.check()?;
        }
        // A comment may end with a backslash, as in the path of a Windows folder.
        let is_whole = line.text.last() != Some(&b'\\') || line.text.trim_ascii_start().starts_with(b"#");
        if is_whole {
            take(&Statement::of(&line))?;
            continue;
        }
        let text = continued(line.text, &mut lines)?;
        take(&Statement::of(&Line { text: &text, number: line.number }))?;
    }
    Ok(())
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

/// The positions, texture coordinates and normals that corners refer to.
#[derive(Default)]
struct Vertices {
    positions: ChunkedVec<Vec3>,
    uvs: ChunkedVec<Vec2>,
    normals: ChunkedVec<Vec3>,
    /// Colours of positions, encoded as sRGB. Positions that have none are white; those after the last coloured one are missing.
    colors: ChunkedVec<[u8; 4]>,
    /// Whether any faces are in a smoothing group.
    is_smoothed: bool,
}

impl Vertices {
    /// Stores the vertex data of a statement.
    fn take(&mut self, statement: &Statement, budget: &Budget) -> Result<(), ReadError> {
        let hold = |bytes| budget.hold(bytes).map_err(too_large);
        match statement.word {
            b"v" => {
                hold(self.positions.next_bytes())?;
                let rest = statement.rest();
                let [x, y, z] = numbers_or_nan(rest);
                self.positions.push(Vec3::new(x, y, if is_flat(rest) { 0.0 } else { z }));
                // With four numbers the last one is a weight, and with seven the first three are followed by one.
                let count = words(rest).take(8).count();
                if matches!(count, 6 | 7) {
                    let numbers: [f32; 7] = numbers_or_nan(rest);
                    let color = stored_color([0, 1, 2].map(|i| numbers[count - 3 + i]));
                    while self.colors.len() < self.positions.len() {
                        hold(self.colors.next_bytes())?;
                        let is_own = self.colors.len() + 1 == self.positions.len();
                        self.colors.push(if is_own { color } else { [255; 4] });
                    }
                }
            }
            b"vn" => {
                hold(self.normals.next_bytes())?;
                self.normals.push(numbers_or_nan(statement.rest()).into());
            }
            b"vt" => {
                hold(self.uvs.next_bytes())?;
                let rest = statement.rest();
                let [u, v] = numbers_or_nan(rest);
                let v = if words(rest).nth(1).is_some() { v } else { 0.0 };
                // The file's v points upwards, the mesh's downwards.
                self.uvs.push(Vec2::new(u, 1.0 - v));
            }
            b"s" => self.is_smoothed |= smoothing::group(statement.rest()) != 0,
            _ => {}
        }
        Ok(())
    }

    /// Returns the size in memory, in bytes.
    fn bytes(&self) -> u64 {
        self.positions.bytes() + self.uvs.bytes() + self.normals.bytes() + self.colors.bytes()
    }
}

/// Whether a position has x and y alone, as drawings in a plane have it.
fn is_flat(numbers: &[u8]) -> bool {
    words(numbers).take(3).count() == 2
}

/// Returns a colour as bytes. Scanning programs write 0 to 1, and some 0 to 255.
fn stored_color(color: [f32; 3]) -> [u8; 4] {
    let scale = if color.iter().any(|channel| *channel > 1.0) { 1.0 } else { 255.0 };
    // The conversion takes NaN for 0.
    let [r, g, b] = color.map(|channel| (channel * scale).round() as u8);
    [r, g, b, 255]
}

fn too_large(refused: MemoryRefused) -> ReadError {
    ReadError::TooLarge { reason: refused.into() }
}

/// Numbers of statements that don't make triangles; for points, the number of points.
#[derive(Default)]
struct StatementCounts {
    faces: usize,
    points: usize,
    lines: usize,
    surfaces: usize,
    unknown: usize,
    /// Faces with a corner that has no normal.
    without_normals: usize,
    /// Faces whose missing normals came from their smoothing groups.
    smoothed: usize,
    /// Statements whose numbers have a comma instead of a point.
    with_commas: usize,
    /// Positions of two numbers.
    flat: usize,
    /// Corners with more than three numbers.
    long_corners: usize,
    /// Corners whose normal, or whose texture coordinates, aren't in the file.
    absent_normals: usize,
    absent_uvs: usize,
}

impl StatementCounts {
    fn warnings(&self, import: &Import) -> impl Iterator<Item = String> {
        let made =
            format!("faces without normals, or with some missing, which got ones that are {}", import.smoothness());
        let others = counted([
            (self.smoothed, "faces without normals, or with some missing, which got those of their smoothing groups"),
            (self.with_commas, "statements with a comma in a number, which was taken for its point"),
            (self.flat, "positions of two numbers, which are placed at z = 0"),
            (self.long_corners, "corners with more than three numbers, of which the first three are read"),
            (self.absent_normals, "corners with the number of a normal that isn't in the file, left out"),
            (
                self.absent_uvs,
                "corners with the number of texture coordinates that aren't in the file, replaced by (0, 0)",
            ),
            (self.points, "points (p), left out"),
            (self.lines, "lines (l), left out"),
            (self.surfaces, "free-form curves and surfaces (curv, curv2, surf), which aren't read"),
            (self.unknown, "statements that OBJ doesn't have, left out"),
        ]);
        counted([(self.without_normals, made)]).chain(others)
    }

    fn holds(&self, vertices: &Vertices) -> String {
        let Self { faces, points, lines, surfaces, unknown, .. } = self;
        if vertices.positions.is_empty() && faces + points + lines + surfaces == 0 {
            let unknown =
                if *unknown > 0 { format!(", and {unknown} statements that OBJ doesn't have") } else { String::new() };
            return format!("it has no vertices{unknown}");
        }
        let others = [(points, "points (p)"), (lines, "lines (l)"), (surfaces, "free-form curves and surfaces")];
        let others = others.into_iter().filter(|(count, _)| **count > 0);
        let others: String = others.map(|(count, what)| format!(", {count} {what}")).collect();
        format!("it holds {} positions{others}", vertices.positions.len())
    }
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
    /// The corners of the face that is being read, and the numbers of their positions.
    corners: Vec<NumberedCorner>,
    indices: Vec<usize>,
    found: StatementCounts,
}

impl Reader<'_, '_> {
    fn take(&mut self, statement: &Statement) -> Result<(), ReadError> {
        match statement.word {
            b"" => {}
            word @ (b"v" | b"vt" | b"vn") => {
                self.above[match word {
                    b"v" => 0,
                    b"vt" => 1,
                    _ => 2,
                }] += 1;
                let rest = statement.rest();
                self.found.with_commas += usize::from(has_comma(rest));
                self.found.flat += usize::from(word == b"v" && is_flat(rest));
            }
            b"f" | b"fo" => self.face(statement)?,
            b"s" => self.smoothing.iter_mut().for_each(|smoothing| smoothing.enter(statement.rest())),
            word @ (b"o" | b"g") => self.enter_part(word, statement.rest())?,
            b"usemtl" => self.materials.enter(statement.rest()),
            // Material files were read with the vertices.
            b"mtllib" => {}
            b"p" => self.found.points += words(statement.rest()).count(),
            b"l" => self.found.lines += 1,
            b"curv" | b"curv2" | b"surf" => self.found.surfaces += 1,
            word => self.found.unknown += usize::from(!SILENT.contains(&word)),
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
        if !self.faces.has_parts() {
            self.faces.enter_part(DEFAULT_PART)?;
        }
        let mut corners = std::mem::take(&mut self.corners);
        corners.clear();
        self.indices.clear();
        for word in words(statement.rest()) {
            if corners.len() == MAX_CORNERS {
                return Err(statement.place().error(format!("the face has more than {MAX_CORNERS} corners")));
            }
            let found = self.corner(word).map_err(|reason| statement.place().error(reason))?;
            let Some((index, corner, vertex)) = found else {
                self.faces.leave_out(statement.place());
                self.corners = corners;
                return Ok(());
            };
            let color = self.vertices.colors.get(index).map_or(Vec4::ONE, |&color| linear_color(color));
            corners.push(NumberedCorner { corner, number: self.faces.number(color)?, vertex });
            self.indices.push(index);
        }
        if corners.iter().any(|at| at.corner.normal.is_none()) {
            let smoothed =
                self.smoothing.as_ref().is_some_and(|smoothing| smoothing.complete(&self.indices, &mut corners));
            *if smoothed { &mut self.found.smoothed } else { &mut self.found.without_normals } += 1;
        }
        let material = self.materials.current(&mut self.faces)?;
        for at in &mut corners {
            let placed = self.materials.placed(material, at.corner.uv);
            // Another material may place them elsewhere.
            at.vertex = at.vertex.filter(|_| placed == at.corner.uv);
            at.corner.uv = placed;
        }
        self.faces.add(material, &mut corners, statement.place())?;
        self.corners = corners;
        Ok(())
    }

    /// Parses a corner: `v`, `v/vt`, `v//vn` or `v/vt/vn`. Returns the number of its position too, and what determines it; none if the
    /// position isn't in the file.
    ///
    /// # Errors
    /// A clause that says what isn't a number.
    fn corner(&mut self, word: &[u8]) -> Result<Option<(usize, InputCorner, Option<VertexNumbers>)>, String> {
        let mut parts = word.split(|&byte| byte == b'/');
        let [position, uv, normal] = [0, 1, 2].map(|_| parts.next().filter(|part| !part.is_empty()));
        self.found.long_corners += usize::from(parts.next().is_some());
        let Some(position) = position else {
            return Err(format!("{} isn't a corner, such as 1, 1/2, 1//3 or 1/2/3", shown(word)));
        };
        let Vertices { positions, uvs, normals, .. } = self.vertices;
        let Some(number) = index(position, self.above[0], positions.len())? else { return Ok(None) };
        // A corner needs its position alone.
        let optional = |word: Option<&[u8]>, above, count, absent: &mut usize| {
            let found = word.and_then(|word| index(word, above, count).ok().flatten());
            *absent += usize::from(word.is_some() && found.is_none());
            found
        };
        let uv = optional(uv, self.above[1], uvs.len(), &mut self.found.absent_uvs);
        let normal = optional(normal, self.above[2], normals.len(), &mut self.found.absent_normals);
        let vertex = vertex_numbers([Some(number), uv, normal]);
        let uv = uv.and_then(|uv| uvs.get(uv)).copied().unwrap_or_default();
        let normal = normal.and_then(|normal| normals.get(normal)).copied();
        let position = positions.get(number).copied().unwrap_or_default();
        Ok(Some((number, InputCorner { position, normal, uv }, vertex)))
    }
}

/// Returns what determines a corner: the numbers of its position, texture coordinates and normal. None if one of them is too
/// large.
fn vertex_numbers(numbers: [Option<usize>; 3]) -> Option<VertexNumbers> {
    // The greatest number stands for none.
    let fitting = |number| u32::try_from(number).ok().filter(|number| *number != u32::MAX);
    let numbers = numbers.map(|number| number.map_or(Some(u32::MAX), fitting));
    let [Some(position), Some(uv), Some(normal)] = numbers else { return None };
    Some([position, uv, normal])
}

/// Parses an index into a list of `count` items, and returns it counted from 0; none if the list has no such item. The file counts
/// from 1, or backwards from the last of the `above` items before the statement, which is -1. Some programs write 1.0 for 1.
///
/// # Errors
/// A clause that says what isn't a number.
fn index(word: &[u8], above: usize, count: usize) -> Result<Option<usize>, String> {
    let whole = |number: f64| (number.fract() == 0.0).then_some(number as i128);
    let float = || whole(std::str::from_utf8(word).ok()?.parse().ok()?);
    let number = whole_number(word).map(i128::from).or_else(float);
    let number = number.ok_or_else(|| format!("{} isn't the index of a position", shown(word)))?;
    let distance = usize::try_from(number.unsigned_abs()).unwrap_or(usize::MAX);
    Ok(match number {
        0 => None,
        1.. => (distance <= count).then(|| distance - 1),
        _ => above.checked_sub(distance),
    })
}

/// Parses a whole number.
fn whole_number(word: &[u8]) -> Option<i64> {
    // Nearly all are a few digits, for which the general parser takes several times as long.
    let is_short = (1..10).contains(&word.len()) && word.iter().all(u8::is_ascii_digit);
    if is_short {
        return Some(word.iter().fold(0, |number, digit| 10 * number + i64::from(digit - b'0')));
    }
    std::str::from_utf8(word).ok().and_then(|word| word.parse().ok())
}

#[cfg(test)]
pub(super) mod tests;

//! Reads Wavefront OBJ: polygons with texture coordinates and normals, and the colours of their materials.
//!
//! All groups and objects become one mesh. Smoothing groups, vertex colours and weights are ignored. The file is read
//! twice, first vertices and then faces, so that faces may come before their vertices.
//!
//! The crate `tobj` isn't used. It panics on an index near 2^63, gives a corner without a normal the normal of another
//! corner, doesn't know continued lines, and names no line in its errors.
//!
//! Source: Wavefront Technologies 1992, "Advanced Visualizer Manual", appendix B1.

mod materials;
mod mtl;

use std::borrow::Cow;
use std::path::Path;

use glam::{Vec2, Vec3};

use super::face_builder::{FaceBuilder, MAX_CORNERS, counted};
use super::loaded_mesh::LoadedMesh;
use super::memory_budget::Budget;
use super::read_error::ReadError;
use super::text_lines::{Line, Lines, first_word, numbers, shown, words};
use super::uri::Files;
use crate::files::Limits;
use crate::mesh::MemoryAccount;
use crate::mesh::chunked_vec::ChunkedVec;
use crate::mesh::mesh_builder::InputCorner;
use crate::progress::Progress;

use materials::Materials;

/// Statements that are ignored without a warning, since they change neither shape nor colour here.
const SILENT: [&[u8]; 24] = [
    b"g",
    b"o",
    b"s",
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
    limits: &Limits,
    progress: &Progress,
) -> Result<LoadedMesh, ReadError> {
    let budget = Budget::new(bytes.len(), limits);
    let files = Files::new(folder, limits, &budget, progress);
    let mut vertices = Vertices::default();
    each(&bytes, &progress.part(0.0, 0.2), |line| vertices.take(line, &budget))?;
    let mut reader = Reader {
        vertices: &vertices,
        above: [0; 3],
        faces: FaceBuilder::new(bytes.len(), &budget),
        materials: Materials::new(&files, &budget),
        corners: Vec::new(),
        found: StatementCounts::default(),
    };
    each(&bytes, &progress.part(0.2, 0.5), |line| reader.take(line))?;
    let freed = bytes.len() as u64 + vertices.bytes();
    reader.materials.read_textures(&mut reader.faces, freed, progress)?;
    let mut warnings = reader.materials.warnings();
    warnings.extend(reader.found.warnings());
    let holds = reader.found.holds(&vertices);
    let faces = reader.faces;
    budget.release(freed);
    drop((bytes, vertices));
    let loaded = faces.finish(name, holds, warnings, &progress.part(0.5, 1.0))?;
    Ok(LoadedMesh { files: files.named(), ..loaded })
}

/// Calls `take` with each statement: a line without its comment, joined with the lines that continue it.
fn each(
    bytes: &[u8],
    progress: &Progress,
    mut take: impl FnMut(&Line) -> Result<(), ReadError>,
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
        if line.text.trim_ascii_start().starts_with(b"#") {
            continue;
        }
        let text = continued(line.text, &mut lines)?;
        take(&Line { text: without_comment(&text), number: line.number })?;
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
}

impl Vertices {
    /// Stores the vertex data of a statement.
    fn take(&mut self, line: &Line, budget: &Budget) -> Result<(), ReadError> {
        let (word, rest) = first_word(line.text);
        let wrong = |reason| line.place().error(reason);
        let hold = |bytes| budget.hold(bytes).map_err(|refused| ReadError::TooLarge { reason: refused.into() });
        match word {
            b"v" => {
                hold(self.positions.next_bytes())?;
                self.positions.push(numbers::<3>("v", rest).map_err(wrong)?.into());
            }
            b"vn" => {
                hold(self.normals.next_bytes())?;
                self.normals.push(numbers::<3>("vn", rest).map_err(wrong)?.into());
            }
            b"vt" => {
                hold(self.uvs.next_bytes())?;
                let [u] = numbers("vt", rest).map_err(wrong)?;
                let has_v = words(rest).nth(1).is_some();
                let v = if has_v { numbers::<2>("vt", rest).map_err(wrong)?[1] } else { 0.0 };
                // The file's v points upwards, the mesh's downwards.
                self.uvs.push(Vec2::new(u, 1.0 - v));
            }
            _ => {}
        }
        Ok(())
    }

    /// Returns the size in memory, in bytes.
    fn bytes(&self) -> u64 {
        self.positions.bytes() + self.uvs.bytes() + self.normals.bytes()
    }
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
}

impl StatementCounts {
    fn warnings(&self) -> impl Iterator<Item = String> {
        counted([
            (
                self.without_normals,
                "faces without normals, or with some missing, which got ones that are smooth within 60 degrees",
            ),
            (self.points, "points (p), left out"),
            (self.lines, "lines (l), left out"),
            (self.surfaces, "free-form curves and surfaces (curv, curv2, surf), which aren't read"),
            (self.unknown, "statements that OBJ doesn't have, left out"),
        ])
    }

    fn holds(&self, vertices: &Vertices) -> String {
        let Self { faces, points, lines, surfaces, unknown, .. } = self;
        if vertices.positions.is_empty() && faces + points + lines + surfaces == 0 {
            let unknown =
                if *unknown > 0 { format!(", and {unknown} statements that OBJ doesn't have") } else { String::new() };
            return format!("it has no vertices{unknown}");
        }
        format!(
            "it holds {} positions, {points} points (p), {lines} lines (l), and {surfaces} free-form curves and surfaces",
            vertices.positions.len()
        )
    }
}

/// Reads the faces of a file.
struct Reader<'v, 'a> {
    vertices: &'v Vertices,
    /// The numbers of positions, texture coordinates and normals above the current statement.
    above: [usize; 3],
    faces: FaceBuilder<'a>,
    materials: Materials<'a>,
    /// The corners of the face that is being read.
    corners: Vec<InputCorner>,
    found: StatementCounts,
}

impl Reader<'_, '_> {
    fn take(&mut self, line: &Line) -> Result<(), ReadError> {
        let (word, rest) = first_word(line.text);
        match word {
            b"" => {}
            b"v" => self.above[0] += 1,
            b"vt" => self.above[1] += 1,
            b"vn" => self.above[2] += 1,
            b"f" | b"fo" => self.face(line, rest)?,
            b"usemtl" => self.materials.enter(rest),
            b"mtllib" => self.materials.add_library(rest),
            b"p" => self.found.points += words(rest).count(),
            b"l" => self.found.lines += 1,
            b"curv" | b"curv2" | b"surf" => self.found.surfaces += 1,
            word => self.found.unknown += usize::from(!SILENT.contains(&word)),
        }
        Ok(())
    }

    fn face(&mut self, line: &Line, rest: &[u8]) -> Result<(), ReadError> {
        self.found.faces += 1;
        let mut corners = std::mem::take(&mut self.corners);
        corners.clear();
        for word in words(rest) {
            if corners.len() == MAX_CORNERS {
                return Err(line.place().error(format!("the face has more than {MAX_CORNERS} corners")));
            }
            corners.push(self.corner(word).map_err(|reason| line.place().error(reason))?);
        }
        self.found.without_normals += usize::from(corners.iter().any(|corner| corner.normal.is_none()));
        let material = self.materials.current(&mut self.faces)?;
        self.faces.add(material, &mut corners, line.place())?;
        self.corners = corners;
        Ok(())
    }

    /// Parses a corner: `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    fn corner(&self, word: &[u8]) -> Result<InputCorner, String> {
        let mut parts = word.split(|&byte| byte == b'/');
        let [position, uv, normal] = [0, 1, 2].map(|_| parts.next().filter(|part| !part.is_empty()));
        let (None, Some(position)) = (parts.next(), position) else {
            return Err(format!("{} isn't a corner, such as 1, 1/2, 1//3 or 1/2/3", shown(word)));
        };
        let Vertices { positions, uvs, normals } = self.vertices;
        let position = index(position, "position", self.above[0], positions.len())?;
        let uv = uv.map(|uv| index(uv, "texture coordinate", self.above[1], uvs.len())).transpose()?;
        let normal = normal.map(|normal| index(normal, "normal", self.above[2], normals.len())).transpose()?;
        let uv = uv.and_then(|uv| uvs.get(uv)).copied().unwrap_or_default();
        let position = positions.get(position).copied().unwrap_or_default();
        Ok(InputCorner { position, normal: normal.and_then(|normal| normals.get(normal)).copied(), uv })
    }
}

/// Parses an index into a list of `count` items, and returns it counted from 0. The file counts from 1, or backwards
/// from the last of the `above` items before the statement, which is -1.
fn index(word: &[u8], what: &str, above: usize, count: usize) -> Result<usize, String> {
    let number: i64 = std::str::from_utf8(word)
        .ok()
        .and_then(|word| word.parse().ok())
        .ok_or_else(|| format!("{} isn't the index of a {what}", shown(word)))?;
    let distance = usize::try_from(number.unsigned_abs()).unwrap_or(usize::MAX);
    match number {
        0 => Err(format!("the face uses {what} 0, but indices start at 1")),
        1.. if distance <= count => Ok(distance - 1),
        1.. => Err(format!("the face uses {what} {number}, but the file has {count}")),
        _ if distance <= above => Ok(above - distance),
        _ => Err(format!("the face uses {what} {number}, but {above} are above the face")),
    }
}

#[cfg(test)]
pub(super) mod tests;

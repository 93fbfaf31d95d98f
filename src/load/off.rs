//! Reads OFF, Geomview's Object File Format, in text: vertices with normals, colours and texture coordinates, and polygons with
//! colours.
//!
//! Source: Geomview manual 1.9, section 4.2.5, "OFF Files". A vertex, and a face, is one line here: numbers that stand behind them are
//! colours in some files, and the next vertex in others.

use glam::{Vec2, Vec3, Vec4};

use super::face_builder::{FaceBuilder, Gathered, MAX_CORNERS, NumberedCorner, linear_color, read_faces};
use super::loaded_mesh::LoadedMesh;
use super::memory_budget::Budget;
use super::model_file::ModelFile;
use super::notes::{counted, counts};
use super::read_error::{FilePosition, ReadError};
use super::text_lines::{Line, Lines, first_word, numbers, parsed, shown, words};
use super::uri::Files;
use geometry::casts::to_byte;
use geometry::mesh::Material;
use geometry::mesh::build_limits::MemoryRefused;
use geometry::mesh::chunked_vec::ChunkedVec;
use geometry::mesh::mesh_builder::InputCorner;
use geometry::progress::Progress;

/// The most numbers of a vertex that are read: a homogeneous position, a normal, a colour and texture coordinates.
const MAX_NUMBERS: usize = 4 + 3 + 4 + 2;

/// The fewest bytes of a face: `1 0` and the end of its line.
const LEAST_FACE: usize = 4;

/// Builds a mesh from a file's bytes.
pub(super) fn read(bytes: Vec<u8>, file: &ModelFile) -> Result<LoadedMesh, ReadError> {
    read_faces(bytes, file, gather)
}

/// Returns whether a text begins with the keyword of OFF, with the numbers of vertices and faces behind it, or with that of binary
/// OFF.
pub(super) fn begins(text: &[u8]) -> bool {
    let mut rows = Rows::new(text, None);
    let mut next = || rows.next().ok().flatten().map_or(&b""[..], |row| row.text);
    let (word, mut rest) = keyword(next());
    if VertexKind::new(word).is_none() {
        return false;
    }
    if rest.is_empty() {
        rest = next();
    }
    rest == b"BINARY" || counts(rest).is_some()
}

/// Reads all faces.
fn gather<'a>(bytes: &[u8], files: &'a Files<'a>, mut faces: FaceBuilder<'a>) -> Gathered<'a> {
    let mut rows = Rows::new(bytes, Some(files.progress));
    let header = Header::read(&mut rows)?;
    let vertices = Vertices::read(&header, &mut rows, files.budget)?;
    let material = faces.material(Material::plain("default", [1.0; 4]))?;
    let most = header.faces.min(bytes.len() / LEAST_FACE);
    faces.expect(most, vertices.positions.len().min(most.saturating_mul(4)));
    let (corners, found) = (Vec::new(), Counts::default());
    let mut reader = Reader { faces, material, vertices: &vertices, corners, found };
    reader.read(&header, &mut rows)?;
    let Reader { mut faces, found, .. } = reader;
    let without_normals = if vertices.normals.is_empty() { vertices.positions.len() } else { 0 };
    faces.notes.extend(counted([faces.lacking_normals(without_normals, "vertices without normals")]));
    faces.notes.extend(found.sentences());
    files.budget.release(vertices.bytes());
    Ok((faces, format!("it holds {} vertices and {} faces", header.vertices, header.faces)))
}

/// The lines of a file without comments and empty lines.
struct Rows<'a> {
    lines: Lines<'a>,
    bytes: usize,
    progress: Option<&'a Progress>,
}

impl<'a> Rows<'a> {
    fn new(bytes: &'a [u8], progress: Option<&'a Progress>) -> Self {
        Self { lines: Lines::new(bytes), bytes: bytes.len(), progress }
    }

    /// Returns the next line without white space around it, if there is one.
    fn next(&mut self) -> Result<Option<Line<'a>>, ReadError> {
        while let Some(line) = self.lines.next()? {
            if let Some(progress) = self.progress {
                let left = || self.lines.rest.len() as f32 / self.bytes as f32;
                progress.step(line.number as u64, || 0.5 * (1.0 - left()))?;
            }
            let comment = memchr::memchr(b'#', line.text).unwrap_or(line.text.len());
            let text = line.text[..comment].trim_ascii();
            if !text.is_empty() {
                return Ok(Some(Line { text, ..line }));
            }
        }
        Ok(None)
    }
}

/// What stands in the line of a vertex, besides x, y and z.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct VertexKind {
    /// A fourth number that divides the others.
    is_homogeneous: bool,
    has_normal: bool,
    has_color: bool,
    has_uv: bool,
    /// Any number of coordinates in place of three.
    has_any_dimension: bool,
}

impl VertexKind {
    /// Parses the keyword: `OFF` behind any of `ST`, `C`, `N`, `4` and `n`, in this order or in another.
    fn new(keyword: &[u8]) -> Option<Self> {
        let mut rest = keyword.strip_suffix(b"OFF")?;
        let mut kind = Self::default();
        while let Some((first, tail)) = rest.split_first() {
            let (part, tail) = match first {
                b'S' => (&mut kind.has_uv, tail.strip_prefix(b"T")?),
                b'C' => (&mut kind.has_color, tail),
                b'N' => (&mut kind.has_normal, tail),
                b'4' => (&mut kind.is_homogeneous, tail),
                b'n' => (&mut kind.has_any_dimension, tail),
                _ => return None,
            };
            if std::mem::replace(part, true) {
                return None;
            }
            rest = tail;
        }
        Some(kind)
    }
}

struct Header {
    kind: VertexKind,
    vertices: usize,
    faces: usize,
}

impl Header {
    fn read(rows: &mut Rows) -> Result<Self, ReadError> {
        let empty = || FilePosition::Everywhere.error("it isn't an OFF file: it has no line besides comments");
        let mut row = rows.next()?.ok_or_else(empty)?;
        let (word, mut rest) = keyword(row.text);
        // The keyword may be missing.
        let kind = match VertexKind::new(word).or(VertexKind::new(&word.to_ascii_uppercase())) {
            Some(kind) => kind,
            None if counts(row.text).is_some() => {
                rest = row.text;
                VertexKind::default()
            }
            None => {
                let reason = format!("it isn't an OFF file: it begins with {} instead of OFF", shown(word));
                return Err(row.place().error(reason));
            }
        };
        if first_word(rest).0 == b"BINARY" {
            return Err(FilePosition::Everywhere.error("it is binary OFF, of which only the text form is read"));
        }
        if kind.has_any_dimension {
            let reason =
                format!("its vertices may have any number of coordinates ({}), but only 3 are read", shown(word));
            return Err(row.place().error(reason));
        }
        if rest.is_empty() {
            row = rows.next()?.ok_or_else(|| row.place().error("the file ends after its first line"))?;
            rest = row.text;
        }
        let (vertices, faces) = counts(rest).ok_or_else(|| {
            row.place().error(format!("{} isn't the numbers of vertices, faces and edges", shown(rest)))
        })?;
        Ok(Self { kind, vertices, faces })
    }
}

/// Splits a line after its keyword. Some programs write the number of vertices behind it without a space: `OFF8 6 12`.
fn keyword(text: &[u8]) -> (&[u8], &[u8]) {
    let (word, rest) = first_word(text);
    let digits = word.iter().rev().take_while(|byte| byte.is_ascii_digit()).count();
    match word.split_at(word.len() - digits) {
        (keyword, number) if !number.is_empty() && VertexKind::new(keyword).is_some() => {
            (keyword, &text[keyword.len()..])
        }
        _ => (word, rest),
    }
}

/// Parses the numbers of vertices and faces. That of edges, which may be wrong, is left aside.
fn counts(text: &[u8]) -> Option<(usize, usize)> {
    let mut counts = words(text).map(parsed);
    Some((counts.next()??, counts.next()??))
}

/// The attributes of the vertices. Lists of what the file doesn't have are empty.
#[derive(Default)]
struct Vertices {
    positions: ChunkedVec<Vec3>,
    normals: ChunkedVec<Vec3>,
    uvs: ChunkedVec<Vec2>,
    /// Red, green, blue and alpha as the file has them. Alpha is NaN where there is none.
    colors: ChunkedVec<[f32; 4]>,
    /// What colours are multiplied by to lie from 0 to 1.
    color_scale: f32,
}

impl Vertices {
    fn read(header: &Header, rows: &mut Rows, budget: &Budget) -> Result<Self, ReadError> {
        let mut vertices = Self { color_scale: 1.0, ..Self::default() };
        for i in 0..header.vertices {
            let row = rows.next()?.ok_or_else(|| {
                let reason = format!("the file ends after {i} of its {} vertices", header.vertices);
                FilePosition::Everywhere.error(reason)
            })?;
            vertices.add(header.kind, row.text, budget)?;
        }
        Ok(vertices)
    }

    fn add(&mut self, kind: VertexKind, row: &[u8], budget: &Budget) -> Result<(), MemoryRefused> {
        let (numbers, count) = numbers::<_, MAX_NUMBERS>(row, |word| parsed(word).unwrap_or(f32::NAN));
        let [x, y, z, w, ..] = numbers;
        let w = if kind.is_homogeneous { w } else { 1.0 };
        let mut at = 3 + usize::from(kind.is_homogeneous);
        budget.hold(self.positions.next_bytes())?;
        self.positions.push(Vec3::new(x, y, z) / w);
        if kind.has_normal {
            budget.hold(self.normals.next_bytes())?;
            self.normals.push(Vec3::new(numbers[at], numbers[at + 1], numbers[at + 2]));
            at += 3;
        }
        let colors = count.saturating_sub(at + if kind.has_uv { 2 } else { 0 }).min(4);
        // Some programs write colours without the letter for them.
        if kind.has_color || (self.colors.len() + 1 == self.positions.len() && colors >= 3) {
            let mut color = [1.0, 1.0, 1.0, f32::NAN];
            let own = &numbers[at..at + if colors >= 3 { colors } else { 0 }];
            color[..own.len()].copy_from_slice(own);
            if own.iter().any(|channel| *channel > 1.0) {
                self.color_scale = 1.0 / 255.0;
            }
            budget.hold(self.colors.next_bytes())?;
            self.colors.push(color);
            at += own.len();
        }
        if kind.has_uv {
            // The file's v points upwards, the mesh's downwards.
            let [u, v] = [0, 1].map(|i| numbers.get(at + i).copied().unwrap_or(f32::NAN));
            budget.hold(self.uvs.next_bytes())?;
            self.uvs.push(Vec2::new(u, 1.0 - v));
        }
        Ok(())
    }

    /// Returns a vertex, with its colour if it has one: linear RGBA.
    fn corner(&self, index: usize) -> Option<(InputCorner, Option<Vec4>)> {
        let position = *self.positions.get(index)?;
        let uv = self.uvs.get(index).copied().unwrap_or_default();
        let corner = InputCorner { position, normal: self.normals.get(index).copied(), uv };
        Some((corner, self.colors.get(index).map(|color| encoded(*color, self.color_scale))))
    }

    /// Returns the size in memory, in bytes.
    fn bytes(&self) -> u64 {
        self.positions.bytes() + self.normals.bytes() + self.uvs.bytes() + self.colors.bytes()
    }
}

/// Decodes a colour whose channels lie from 0 to 1 once they are multiplied by `scale`. Alpha is 1 if it is NaN.
fn encoded(color: [f32; 4], scale: f32) -> Vec4 {
    // The conversion takes NaN for 0.
    let [r, g, b, a] = color.map(|channel| to_byte(channel * scale * 255.0));
    linear_color([r, g, b, if color[3].is_nan() { 255 } else { a }])
}

counts! {
    struct Counts {
        mapped => "faces with a number of a colour map, which isn't read";
        bad_colors => "faces with a colour that isn't 3 or 4 numbers, left out";
        after_faces => "lines after the last face, left out";
    }
}

/// Reads the faces.
struct Reader<'v, 'a> {
    faces: FaceBuilder<'a>,
    material: usize,
    vertices: &'v Vertices,
    /// The corners of the face that is being read.
    corners: Vec<NumberedCorner>,
    found: Counts,
}

impl Reader<'_, '_> {
    /// Reads the faces, as far as the file goes.
    fn read(&mut self, header: &Header, rows: &mut Rows) -> Result<(), ReadError> {
        if !self.vertices.colors.is_empty() {
            self.faces.color()?;
        }
        for i in 0..header.faces {
            let row = rows.next()?;
            let read = row.as_ref().map_or(Ok(()), |row| self.face(row));
            let is_cut = rows.lines.is_open && matches!(read, Err(ReadError::Broken { .. }));
            if row.is_none() || is_cut {
                let count = header.faces;
                self.faces.notes.push(format!(
                    "The file was cut short: it says that it has {count} faces, but it ends after {i}. Only those are shown."
                ));
                return Ok(());
            }
            read?;
        }
        while rows.next()?.is_some() {
            self.found.after_faces += 1;
        }
        Ok(())
    }

    fn face(&mut self, row: &Line) -> Result<(), ReadError> {
        let mut words = words(row.text);
        let first = words.next().unwrap_or_default();
        let count: usize = parsed(first)
            .ok_or_else(|| row.place().error(format!("{} isn't the number of a face's corners", shown(first))))?;
        if count > MAX_CORNERS {
            return Err(row.place().error(format!("the face has more than {MAX_CORNERS} corners")));
        }
        self.corners.clear();
        for i in 0..count {
            let word = words.next().ok_or_else(|| {
                row.place().error(format!("the face has {i} corners, but it says that it has {count}"))
            })?;
            if let Some((corner, color)) = parsed(word).and_then(|index| self.vertices.corner(index)) {
                let number = self.faces.number(color.unwrap_or(Vec4::ONE))?;
                self.corners.push(NumberedCorner { corner, number, vertex: None });
            }
        }
        if self.corners.len() < count {
            self.faces.leave_out(row.place());
            return Ok(());
        }
        let face_color = if self.vertices.colors.is_empty() { self.face_color(words) } else { None };
        if let Some(color) = face_color {
            self.faces.color()?;
            let number = self.faces.number(color)?;
            self.corners.iter_mut().for_each(|at| at.number = number);
        }
        self.faces.add(self.material, &mut self.corners, row.place())
    }

    /// Parses what stands behind a face: its colour, linear RGBA. Whole numbers go up to 255, others up to 1.
    fn face_color<'w>(&mut self, words: impl Iterator<Item = &'w [u8]>) -> Option<Vec4> {
        let words: Vec<_> = words.take(5).collect();
        match words.len() {
            0 => return None,
            1 => {
                self.found.mapped += 1;
                return None;
            }
            _ => {}
        }
        let is_whole = words.iter().all(|word| word.iter().all(u8::is_ascii_digit));
        let mut color = [f32::NAN; 4];
        for (slot, word) in color.iter_mut().zip(&words) {
            *slot = parsed(word).unwrap_or(f32::NAN);
        }
        if !matches!(words.len(), 3 | 4) || color[..words.len()].iter().any(|channel| channel.is_nan()) {
            self.found.bad_colors += 1;
            return None;
        }
        Some(encoded(color, if is_whole { 1.0 / 255.0 } else { 1.0 }))
    }
}

#[cfg(test)]
pub(super) mod tests;

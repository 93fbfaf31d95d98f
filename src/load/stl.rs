//! Reads STL, in text and in binary.
//!
//! The normals in the file are ignored: they belong to facets, and are often zero or wrong. All corners get computed
//! normals, smooth where facets meet at up to 60 degrees.
//!
//! The crate `stl_io` isn't used. It takes a binary file that begins with "solid" for text, silently drops all solids
//! but the first, refuses normals of NaN, and takes 30 bytes of memory for each byte of a long line.
//!
//! Source: 3D Systems 1989, "StereoLithography Interface Specification".

use glam::{Vec2, Vec3};

use super::face_builder::{FaceBuilder, counted};
use super::loaded_mesh::LoadedMesh;
use super::memory_budget::Budget;
use super::read_error::{FilePosition, ReadError};
use super::text_lines::{Line, Lines, first_word, number, shown, words};
use crate::files::Limits;
use crate::mesh::mesh_builder::InputCorner;
use crate::mesh::{Material, MemoryAccount};
use crate::progress::Progress;

/// The size of a binary file's header with its number of triangles, in bytes.
const HEADER: usize = 84;

/// The size of a binary triangle in bytes: a normal, three positions, and 16 bits without a fixed meaning.
const TRIANGLE: usize = 50;

/// Builds a mesh called `name` from a file's bytes.
///
/// # Errors
/// [`ReadError`].
pub(super) fn read(bytes: Vec<u8>, name: &str, limits: &Limits, progress: &Progress) -> Result<LoadedMesh, ReadError> {
    let budget = Budget::new(bytes.len(), limits);
    let mut faces = FaceBuilder::new(bytes.len(), &budget);
    let material = faces.material(Material::plain("default", [1.0; 4]))?;
    let mut reader = Reader { faces, material, corners: Vec::new(), progress, bytes: bytes.len() };
    let (holds, warnings) = if is_text(&bytes) { reader.text(&bytes)? } else { reader.binary(&bytes)? };
    budget.release(bytes.len() as u64);
    drop(bytes);
    reader.faces.finish(name, holds, warnings, &progress.part(0.5, 1.0))
}

/// Returns whether the file is text. Many binary files begin with "solid" too, but their size fits, or control
/// characters follow.
fn is_text(bytes: &[u8]) -> bool {
    let exact = triangles_said(bytes).is_some_and(|count| bytes.len() as u64 == size(count));
    let start = &bytes[..bytes.len().min(1024)];
    let start = start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start);
    let is_solid = first_word(start).0.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    is_solid && !exact && !start.iter().any(|byte| byte.is_ascii_control() && !byte.is_ascii_whitespace())
}

/// Returns the number of triangles in a binary file's header.
fn triangles_said(bytes: &[u8]) -> Option<u32> {
    bytes.get(HEADER - 4..HEADER).and_then(|count| count.try_into().ok()).map(u32::from_le_bytes)
}

/// Returns the size of a binary file of so many triangles, in bytes.
fn size(triangles: u32) -> u64 {
    HEADER as u64 + TRIANGLE as u64 * u64::from(triangles)
}

struct Reader<'a> {
    faces: FaceBuilder<'a>,
    material: usize,
    /// The corners of the triangle that is being added.
    corners: Vec<InputCorner>,
    progress: &'a Progress,
    /// The file's size, in bytes.
    bytes: usize,
}

impl Reader<'_> {
    /// Reads a binary file. Returns what it holds in case it has no triangles, and warnings.
    fn binary(&mut self, bytes: &[u8]) -> Result<(String, Vec<String>), ReadError> {
        let Some(count) = triangles_said(bytes) else {
            let length = bytes.len();
            let reason = format!(
                "it isn't an STL file: it doesn't begin with \"solid\", and its {length} bytes are fewer than the {HEADER} of a binary header"
            );
            return Err(FilePosition::Everywhere.error(reason));
        };
        let said = size(count);
        let Some(surplus) = (bytes.len() as u64).checked_sub(said) else {
            let length = bytes.len();
            let reason = format!(
                "its header says that it has {count} triangles, which take {said} bytes, but the file has {length}"
            );
            return Err(FilePosition::Byte(HEADER - 4).error(reason));
        };
        let triangles = bytes[HEADER..].as_chunks::<TRIANGLE>().0;
        // A closed surface has half as many points as triangles.
        self.faces.expect(count as usize, count as usize / 2);
        for (i, triangle) in triangles.iter().take(count as usize).enumerate() {
            if i % 4096 == 0 {
                self.at(HEADER + i * TRIANGLE)?;
            }
            // The first vector is the normal.
            let [_, a, b, c, ..] = triangle.as_chunks::<12>().0 else { continue };
            self.add([a, b, c].map(position_of), FilePosition::Byte(HEADER + i * TRIANGLE))?;
        }
        let warnings = counted([(surplus as usize, "bytes after the last triangle, left out")]);
        Ok(("its header says that it has 0 triangles".to_owned(), warnings.collect()))
    }

    /// Reads a text file; returns the same as [`binary`](Self::binary).
    fn text(&mut self, bytes: &[u8]) -> Result<(String, Vec<String>), ReadError> {
        let mut lines = Lines::new(bytes);
        let (mut solids, mut open) = (0, false);
        while let Some(line) = lines.next()? {
            if line.number % 4096 == 0 {
                self.at(bytes.len() - lines.rest().len())?;
            }
            let (word, _) = first_word(line.text);
            match word.to_ascii_lowercase().as_slice() {
                b"" => {}
                b"solid" => (solids, open) = (solids + 1, true),
                b"endsolid" => open = false,
                b"facet" => self.facet(&line, &mut lines)?,
                _ => return Err(unexpected(&line, "facet, endsolid or solid")),
            }
        }
        let warnings = counted([(usize::from(open), "solids without an end: the file may have been cut short")]);
        Ok((format!("it holds {solids} solids without facets"), warnings.collect()))
    }

    /// Reads the lines after a facet's first line.
    fn facet(&mut self, first: &Line, lines: &mut Lines) -> Result<(), ReadError> {
        let (mut positions, mut count) = ([Vec3::ZERO; 3], 0);
        while let Some(line) = lines.next()? {
            let (word, rest) = first_word(line.text);
            match word.to_ascii_lowercase().as_slice() {
                b"" | b"outer" | b"endloop" => {}
                b"vertex" => {
                    let position = position(rest).map_err(|reason| line.place().error(reason))?;
                    if let Some(slot) = positions.get_mut(count) {
                        *slot = position;
                    }
                    count += 1;
                }
                b"endfacet" if count == 3 => return self.add(positions, line.place()),
                b"endfacet" => return Err(line.place().error(format!("the facet has {count} vertices instead of 3"))),
                _ => return Err(unexpected(&line, "vertex, endloop or endfacet")),
            }
        }
        let reason = format!("the file ends within the facet that begins in line {}", first.number);
        Err(FilePosition::Line(lines.count()).error(reason))
    }

    fn add(&mut self, positions: [Vec3; 3], place: FilePosition) -> Result<(), ReadError> {
        let corner = |position| InputCorner { position, normal: None, uv: Vec2::ZERO };
        self.corners.clear();
        self.corners.extend(positions.map(corner));
        self.faces.add(self.material, &mut self.corners, place)
    }

    /// Sets the progress.
    fn at(&self, byte: usize) -> Result<(), ReadError> {
        self.progress.set(0.5 * byte as f32 / self.bytes as f32);
        Ok(self.progress.check()?)
    }
}

fn position_of(&[a, b, c, d, e, f, g, h, i, j, k, l]: &[u8; 12]) -> Vec3 {
    Vec3::new(f32::from_le_bytes([a, b, c, d]), f32::from_le_bytes([e, f, g, h]), f32::from_le_bytes([i, j, k, l]))
}

fn position(text: &[u8]) -> Result<Vec3, String> {
    let count = words(text).count();
    if count != 3 {
        return Err(format!("vertex needs 3 numbers, but has {count}"));
    }
    let mut position = [0.0; 3];
    for (slot, word) in position.iter_mut().zip(words(text)) {
        *slot = number(word)?;
    }
    Ok(position.into())
}

fn unexpected(line: &Line, expected: &str) -> ReadError {
    let word = shown(first_word(line.text).0);
    line.place().error(format!("the line begins with {word} instead of {expected}"))
}

#[cfg(test)]
pub(super) mod tests;

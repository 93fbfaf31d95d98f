//! Reads STL, in text and in binary.
//!
//! The normals in the file are ignored: they belong to facets, and are often zero or wrong. All corners get computed
//! normals, smooth where facets meet at up to the crease angle.
//!
//! The crate `stl_io` isn't used. It takes a binary file that begins with "solid" for text, silently drops all solids
//! but the first, refuses normals of NaN, and takes 30 bytes of memory for each byte of a long line.
//!
//! Source: 3D Systems 1989, "StereoLithography Interface Specification".

mod colors;

use glam::{Vec2, Vec3, Vec4};

use super::face_builder::{FaceBuilder, NumberedCorner, read_faces};
use super::loaded_mesh::LoadedMesh;
use super::model_file::ModelFile;
use super::notes::{counted, counts};
use super::read_error::{FilePosition, ReadError};
use super::text_lines::{Line, Lines, first_word, numbers_or_nan, shown};
use geometry::casts::to_usize;
use geometry::mesh::Material;
use geometry::mesh::mesh_builder::InputCorner;
use geometry::progress::Progress;

use colors::Colors;

/// The size of a binary file's header with its number of triangles, in bytes.
const HEADER: usize = 84;

/// The size of a binary triangle in bytes: a normal, three positions, and 16 bits, in which some programs put a [colour](colors).
const TRIANGLE: usize = 50;

/// Builds a mesh from a file's bytes.
pub(super) fn read(bytes: Vec<u8>, file: &ModelFile) -> Result<LoadedMesh, ReadError> {
    read_faces(bytes, file, |bytes, files, mut faces| {
        let material = faces.material(Material::plain("default", [1.0; 4]))?;
        let mut reader =
            Reader { faces, material, corners: Vec::new(), progress: files.progress, found: Counts::default() };
        let holds = if is_text(bytes) { reader.text(bytes)? } else { reader.binary(bytes)? };
        Ok((reader.faces, holds))
    })
}

/// Returns whether the file is text. Many binary files begin with "solid" too, but their size fits.
fn is_text(bytes: &[u8]) -> bool {
    let exact = triangles_said(bytes).is_some_and(|count| bytes.len() as u64 == size(count));
    begins_as_text(bytes) && !exact
}

/// Returns whether a file begins as text does. Some have no line with "solid" before their first facet, and some have notes before it. In
/// binary files control characters follow.
pub(super) fn begins_as_text(bytes: &[u8]) -> bool {
    let start = &bytes[..bytes.len().min(1024)];
    let start = start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start);
    let begins = |line: &[u8], with: &[u8]| {
        first_word(line).0.get(..with.len()).is_some_and(|word| word.eq_ignore_ascii_case(with))
    };
    let mut lines = start.split(|byte| matches!(byte, b'\n' | b'\r'));
    lines.any(|line| begins(line, b"solid") || begins(line, b"facet"))
        && !start.iter().any(|byte| byte.is_ascii_control() && !byte.is_ascii_whitespace())
}

/// Returns whether a file of `length` bytes that begins so is binary and has as many triangles as it says, at least one.
pub(super) fn has_exact_size(start: &[u8], length: u64) -> bool {
    triangles_said(start).is_some_and(|count| count > 0 && length == size(count))
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
    corners: Vec<NumberedCorner>,
    progress: &'a Progress,
    found: Counts,
}

counts! {
    /// What was found in a text file.
    struct Counts {
        open_facets => "facets without an end";
        with_commas => "lines with a comma in a number, which was taken for its point";
        open_solids => "solids without an end: the file may have been cut short";
        other_lines => "lines that aren't part of the format, left out";
    }
}

impl Reader<'_> {
    /// Reads a binary file. Returns what it holds in case it has no triangles.
    fn binary(&mut self, bytes: &[u8]) -> Result<String, ReadError> {
        let Some(count) = triangles_said(bytes) else {
            let length = bytes.len();
            let reason = format!(
                "it isn't an STL file: it doesn't begin with \"solid\", and its {length} bytes are fewer than the {HEADER} of a binary header"
            );
            return Err(FilePosition::Everywhere.error(reason));
        };
        let triangles = bytes[HEADER..].as_chunks::<TRIANGLE>().0;
        // Programs that write while they compute leave the count at 0.
        let is_uncounted = count == 0 && !triangles.is_empty();
        let said = if is_uncounted { triangles.len() } else { count as usize };
        let there = triangles.len().min(said);
        // A closed surface has half as many points as triangles.
        self.faces.expect(there, there / 2);
        let attributes = triangles.iter().take(there).map(|&[.., low, high]| u16::from_le_bytes([low, high]));
        let colors = Colors::new(&bytes[..HEADER - 4], attributes.clone());
        if let Some(colors) = &colors {
            self.faces.builder.material_mut(self.material).base_color = colors.of_all();
        }
        let of_triangles = colors.filter(|colors| colors.are_many);
        if of_triangles.is_some() {
            self.faces.color()?;
        }
        let position = |bytes: &[u8; 12]| Vec3::from(bytemuck::cast::<_, [[u8; 4]; 3]>(*bytes).map(f32::from_le_bytes));
        for (i, (triangle, bits)) in triangles.iter().zip(attributes).enumerate() {
            self.progress.step(i as u64, || 0.5 * (HEADER + i * TRIANGLE) as f32 / bytes.len() as f32)?;
            // The first vector is the normal.
            let [_, a, b, c, ..] = triangle.as_chunks::<12>().0 else { continue };
            let color = of_triangles.map_or(Vec4::ONE, |colors| colors.of_triangle(bits));
            self.add([a, b, c].map(position), color, FilePosition::Byte(HEADER + i * TRIANGLE))?;
        }
        if is_uncounted {
            let shown = format!("The header says that the file has 0 triangles. The {said} that follow it are shown.");
            self.faces.notes.push(shown);
            return Ok(String::new());
        }
        if there < said {
            self.faces.notes.push(format!(
                "The file was cut short: its header says that it has {count} triangles, but it ends after {there}. Only \
                 those are shown."
            ));
            return Ok(format!("its header says that it has {count} triangles, but none is whole"));
        }
        let surplus = bytes.len() - to_usize(size(count));
        self.faces.notes.extend(counted([(surplus, "bytes after the last triangle, left out")]));
        Ok("its header says that it has 0 triangles".to_owned())
    }

    /// Reads a text file; returns the same as [`binary`](Self::binary).
    fn text(&mut self, bytes: &[u8]) -> Result<String, ReadError> {
        let mut lines = Lines::new(bytes);
        let (mut solids, mut open) = (0, false);
        let mut next = lines.next()?;
        while let Some(line) = next {
            self.progress.step(line.number as u64, || 0.5 * (1.0 - lines.rest.len() as f32 / bytes.len() as f32))?;
            next = None;
            let rest = first_word(line.text).1;
            match keyword(&line).as_slice() {
                b"" => {}
                b"solid" => {
                    (solids, open) = (solids + 1, true);
                    match rest {
                        b"" => self.faces.enter_part(format!("solid {solids}").as_bytes(), 0)?,
                        name => self.faces.enter_part(name, 0)?,
                    }
                }
                b"endsolid" => open = false,
                b"facet" => next = self.facet(&line, &mut lines)?,
                b"outer" | b"vertex" => return Err(unexpected(&line, "facet, endsolid or solid")),
                _ => self.found.other_lines += 1,
            }
            if next.is_none() {
                next = lines.next()?;
            }
        }
        self.found.open_solids = usize::from(open);
        self.faces.notes.extend(self.found.sentences());
        Ok(format!("it holds {solids} solids without facets"))
    }

    /// Reads the lines after a facet's first line. Returns the line after it, if it was read to find that the facet has no end.
    fn facet<'l>(&mut self, first: &Line, lines: &mut Lines<'l>) -> Result<Option<Line<'l>>, ReadError> {
        let (mut positions, mut count) = ([Vec3::ZERO; 3], 0);
        while let Some(line) = lines.next()? {
            match keyword(&line).as_slice() {
                b"" | b"outer" | b"endloop" => {}
                b"vertex" => {
                    let rest = first_word(line.text).1;
                    self.found.with_commas += usize::from(rest.contains(&b','));
                    if let Some(slot) = positions.get_mut(count) {
                        *slot = numbers_or_nan(rest).into();
                    }
                    count += 1;
                }
                b"endfacet" if count == 3 => return self.add(positions, Vec4::ONE, line.place()).map(|()| None),
                b"endfacet" => return Err(line.place().error(format!("the facet has {count} vertices instead of 3"))),
                b"facet" | b"solid" | b"endsolid" if count == 3 => {
                    self.found.open_facets += 1;
                    return self.add(positions, Vec4::ONE, line.place()).map(|()| Some(line));
                }
                b"facet" | b"solid" | b"endsolid" => return Err(unexpected(&line, "vertex, endloop or endfacet")),
                // Some programs write colours and notes in lines of their own.
                _ => self.found.other_lines += 1,
            }
        }
        let number = first.number;
        let said = format!("The file ends within the facet that begins in line {number}. That facet is left out.");
        self.faces.notes.push(said);
        Ok(None)
    }

    fn add(&mut self, positions: [Vec3; 3], color: Vec4, place: FilePosition) -> Result<(), ReadError> {
        let number = self.faces.number(color)?;
        let corner = |position| {
            let corner = InputCorner { position, normal: None, uv: Vec2::ZERO };
            NumberedCorner { corner, number, vertex: None }
        };
        self.corners.clear();
        self.corners.extend(positions.map(corner));
        self.faces.add(self.material, &mut self.corners, place)
    }
}

/// Returns a line's first word in small letters. Some programs write the words that begin with `end` as two.
fn keyword(line: &Line) -> Vec<u8> {
    let (word, rest) = first_word(line.text);
    let mut word = word.to_ascii_lowercase();
    if word == b"end" {
        let second = first_word(rest).0.to_ascii_lowercase();
        if matches!(second.as_slice(), b"loop" | b"facet" | b"solid") {
            word.extend(second);
        }
    }
    word
}

fn unexpected(line: &Line, expected: &str) -> ReadError {
    let word = shown(first_word(line.text).0);
    line.place().error(format!("the line begins with {word} instead of {expected}"))
}

#[cfg(test)]
pub(super) mod tests;

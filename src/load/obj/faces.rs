//! The faces of an OBJ file, as numbers of positions, texture coordinates and normals.

use super::pieces::Piece;
use super::{Statement, next_statement};
use crate::face_builder::MAX_CORNERS;
use crate::read_error::ReadError;
use crate::recent_corners::VertexNumbers;
use crate::text_lines::{shown, words};

/// The number of what a corner doesn't have.
pub(super) const NONE: u32 = u32::MAX;

/// The faces of a piece of the file, and its other statements that change what follows.
#[derive(Default)]
pub(super) struct FacePiece {
    pub found: Vec<Found>,
    /// The corners of all its faces.
    pub corners: Vec<VertexNumbers>,
    pub counts: StatementCounts,
    /// Why the piece couldn't be read to its end.
    pub error: Option<ReadError>,
}

/// A statement that was found.
pub(super) enum Found {
    /// A face without a fault, its line, and where its corners end among those of the piece. They begin where those of the face
    /// before end.
    Face { line: usize, end: u32 },
    /// Another statement, or a face that needs a closer look: where it begins in the piece, how many lines come before it, and
    /// how many positions, texture coordinates and normals.
    Other { at: u32, lines: usize, above: [u32; 3] },
}

/// Numbers of statements that don't make triangles; for points, the number of points.
#[derive(Clone, Copy, Default)]
pub(super) struct StatementCounts {
    pub points: usize,
    pub lines: usize,
    pub surfaces: usize,
    /// Of other files and of programs.
    pub calls: usize,
    pub unknown: usize,
}

impl StatementCounts {
    pub(super) fn add(&mut self, other: Self) {
        self.points += other.points;
        self.lines += other.lines;
        self.surfaces += other.surfaces;
        self.calls += other.calls;
        self.unknown += other.unknown;
    }
}

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

impl FacePiece {
    /// Parses a piece of a file that has `counts` positions, texture coordinates and normals, `above` of them before the piece.
    pub(super) fn parse(piece: &Piece, mut above: [usize; 3], counts: [usize; 3]) -> Self {
        let (mut found, mut lines) = (Self::default(), piece.lines());
        loop {
            let (at, before) = (piece.bytes.len() - lines.rest().len(), lines.count());
            let other =
                |above: [usize; 3]| Found::Other { at: at as u32, lines: before, above: above.map(|n| n as u32) };
            let next = next_statement(&mut lines, |statement| match statement.word {
                b"v" => above[0] += 1,
                b"vt" => above[1] += 1,
                b"vn" => above[2] += 1,
                b"f" | b"fo" => {
                    let face = found.face(statement, above, counts);
                    found.found.push(face.unwrap_or_else(|| other(above)));
                }
                b"s" | b"o" | b"g" | b"usemtl" => found.found.push(other(above)),
                // Material files were read with the vertices.
                b"" | b"mtllib" => {}
                word => found.count(word, statement),
            });
            match next {
                Ok(true) => {}
                Ok(false) => return found,
                Err(error) => {
                    found.error = Some(error);
                    return found;
                }
            }
        }
    }

    fn count(&mut self, word: &[u8], statement: &Statement) {
        match word {
            b"p" => self.counts.points += words(statement.rest()).count(),
            b"l" => self.counts.lines += 1,
            b"curv" | b"curv2" | b"surf" => self.counts.surfaces += 1,
            b"call" | b"csh" => self.counts.calls += 1,
            word => self.counts.unknown += usize::from(!SILENT.contains(&word)),
        }
    }

    /// Parses a face; none if it isn't plain, of which nothing is kept then.
    fn face(&mut self, statement: &Statement, above: [usize; 3], counts: [usize; 3]) -> Option<Found> {
        let start = self.corners.len();
        for word in words(statement.rest()) {
            let corner = plain_corner(word, above, counts).filter(|_| self.corners.len() - start < MAX_CORNERS);
            let Some(corner) = corner else {
                self.corners.truncate(start);
                return None;
            };
            self.corners.push(corner);
        }
        Some(Found::Face { line: statement.number, end: u32::try_from(self.corners.len()).ok()? })
    }
}

/// Parses a corner of numbers that are all in the file. None if it needs a closer look.
fn plain_corner(word: &[u8], above: [usize; 3], counts: [usize; 3]) -> Option<VertexNumbers> {
    let mut numbers = [NONE; 3];
    let mut parts = word.split(|&byte| byte == b'/');
    for (i, number) in numbers.iter_mut().enumerate() {
        let Some(part) = parts.next() else { break };
        if i == 0 || !part.is_empty() {
            *number = fitting(index(part, above[i], counts[i]).ok()??)?;
        }
    }
    parts.next().is_none().then_some(numbers)
}

/// Returns a number as one of 32 bits, none of which is [`NONE`]. Larger ones don't occur: the file would be larger than any that is
/// read.
pub(super) fn fitting(number: usize) -> Option<u32> {
    u32::try_from(number).ok().filter(|number| *number != NONE)
}

/// Parses an index into a list of `count` items, and returns it counted from 0; none if the list has no such item. The file counts
/// from 1, or backwards from the last of the `above` items before the statement, which is -1. Some programs write 1.0 for 1.
///
/// # Errors
/// A clause that says what isn't a number.
pub(super) fn index(word: &[u8], above: usize, count: usize) -> Result<Option<usize>, String> {
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

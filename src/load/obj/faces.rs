//! The faces of an OBJ file, as numbers of positions, texture coordinates and normals.

use super::pieces::Piece;
use super::vertices::group;
use super::{Statement, each_statement};
use crate::face_builder::MAX_CORNERS;
use crate::notes::counts;
use crate::read_error::ReadError;
use crate::recent_corners::VertexNumbers;
use crate::text_lines::{parsed, shown, words};

/// The number of what a corner doesn't have.
const NONE: u32 = u32::MAX;

/// The faces of a piece of the file, and its other statements that change what follows.
#[derive(Default)]
pub(super) struct FacePiece {
    pub found: Vec<Found>,
    /// The corners of all its faces.
    pub corners: Vec<VertexNumbers>,
    pub counts: StatementCounts,
}

/// A statement that was found.
pub(super) enum Found {
    /// A face, its line, and where its corners end among those of the piece. They begin where those of the face before end.
    Face {
        line: usize,
        end: u32,
    },
    /// A face with the number of a position that isn't in the file, and its line.
    Absent {
        line: usize,
    },
    /// The smoothing group of the next faces.
    Smoothing(u32),
    /// The names of what the next faces belong to.
    Object(Box<[u8]>),
    Group(Box<[u8]>),
    Material(Box<[u8]>),
}

counts! {
    /// Numbers of statements that don't make triangles, and of flaws; for points, the number of points.
    pub(super) struct StatementCounts {
        long_corners => "corners with more than three numbers, of which the first three are read";
        absent_normals => "corners with the number of a normal that isn't in the file, left out";
        absent_uvs => "corners with the number of texture coordinates that aren't in the file, replaced by (0, 0)";
        points => "points (p), left out";
        lines => "lines (l), left out";
        surfaces => "free-form curves and surfaces (curv, curv2, surf), which aren't read";
        calls => "calls of other files and of programs (call, csh), left out";
        unknown => "statements that OBJ doesn't have, left out";
    }
}

/// Statements that are ignored without a warning, since they change neither shape nor colour here.
const SILENT: &str = "vp mg lod bevel c_interp d_interp cstype deg bmat step parm trim hole scrv sp end con usemap maplib shadow_obj \
                      trace_obj";

impl FacePiece {
    /// Parses a piece of a file that has `counts` positions, texture coordinates and normals, `above` of them before the piece, as
    /// far as it can be read.
    pub(super) fn parse(piece: &Piece, mut above: [usize; 3], counts: [usize; 3]) -> (Self, Result<(), ReadError>) {
        let mut found = Self::default();
        let ended = each_statement(piece.lines(), |statement| {
            let name = || statement.rest().into();
            match statement.word {
                b"v" => above[0] += 1,
                b"vt" => above[1] += 1,
                b"vn" => above[2] += 1,
                b"f" | b"fo" => found.face(statement, above, counts)?,
                b"s" => found.found.push(Found::Smoothing(group(statement.rest()))),
                b"o" => found.found.push(Found::Object(name())),
                b"g" => found.found.push(Found::Group(name())),
                b"usemtl" => found.found.push(Found::Material(name())),
                // Material files and tags were read with the vertices.
                b"" | b"mtllib" | b"t" => {}
                word => found.count(word, statement),
            }
            Ok(())
        });
        (found, ended)
    }

    fn count(&mut self, word: &[u8], statement: &Statement) {
        match word {
            b"p" => self.counts.points += words(statement.rest()).count(),
            b"l" => self.counts.lines += 1,
            b"curv" | b"curv2" | b"surf" => self.counts.surfaces += 1,
            b"call" | b"csh" => self.counts.calls += 1,
            word => {
                let is_silent = SILENT.split(' ').any(|known| known.as_bytes() == word);
                self.counts.unknown += usize::from(!is_silent);
            }
        }
    }

    /// Parses a face. Nothing is kept of one with the number of a position that isn't in the file.
    fn face(&mut self, statement: &Statement, above: [usize; 3], counts: [usize; 3]) -> Result<(), ReadError> {
        let (line, start) = (statement.number, self.corners.len());
        for word in words(statement.rest()) {
            if self.corners.len() - start == MAX_CORNERS {
                return Err(statement.place().error(format!("the face has more than {MAX_CORNERS} corners")));
            }
            match self.corner(word, above, counts).map_err(|reason| statement.place().error(reason))? {
                Some(corner) => self.corners.push(corner),
                None => {
                    self.corners.truncate(start);
                    self.found.push(Found::Absent { line });
                    return Ok(());
                }
            }
        }
        // Pieces are far smaller.
        let end = u32::try_from(self.corners.len()).unwrap_or(u32::MAX);
        self.found.push(Found::Face { line, end });
        Ok(())
    }

    /// Parses a corner: `v`, `v/vt`, `v//vn` or `v/vt/vn`. Returns its numbers; none if the position isn't in the file.
    ///
    /// # Errors
    /// A clause that says what isn't a number.
    fn corner(&mut self, word: &[u8], above: [usize; 3], counts: [usize; 3]) -> Result<Option<VertexNumbers>, String> {
        let mut parts = word.split(|&byte| byte == b'/');
        let [position, uv, normal] = [0, 1, 2].map(|_| parts.next().filter(|part| !part.is_empty()));
        self.counts.long_corners += usize::from(parts.next().is_some());
        let Some(position) = position else {
            return Err(format!("{} isn't a corner, such as 1, 1/2, 1//3 or 1/2/3", shown(word)));
        };
        let Some(position) = index(position, above[0], counts[0])? else { return Ok(None) };
        // A corner needs its position alone.
        let optional = |word: Option<&[u8]>, kind: usize, absent: &mut usize| {
            let number = word.and_then(|word| index(word, above[kind], counts[kind]).ok().flatten());
            *absent += usize::from(word.is_some() && number.is_none());
            number.unwrap_or(NONE)
        };
        let uv = optional(uv, 1, &mut self.counts.absent_uvs);
        let normal = optional(normal, 2, &mut self.counts.absent_normals);
        Ok(Some([position, uv, normal]))
    }
}

/// Parses an index into a list of `count` items, and returns it counted from 0; none if the list has no such item. The file counts
/// from 1, or backwards from the last of the `above` items before the statement, which is -1. Some programs write 1.0 for 1.
///
/// # Errors
/// A clause that says what isn't a number.
#[expect(clippy::cast_possible_truncation, reason = "a whole number; one too large becomes the end, which no list has")]
fn index(word: &[u8], above: usize, count: usize) -> Result<Option<u32>, String> {
    let whole = |number: f64| (number.fract() == 0.0).then_some(number as i128);
    let float = || whole(parsed(word)?);
    let number = whole_number(word).map(i128::from).or_else(float);
    let number = number.ok_or_else(|| format!("{} isn't the index of a position", shown(word)))?;
    let distance = usize::try_from(number.unsigned_abs()).unwrap_or(usize::MAX);
    let found = match number {
        0 => None,
        1.. => (distance <= count).then(|| distance - 1),
        _ => above.checked_sub(distance),
    };
    // Larger ones don't occur: the file would be larger than any that is read.
    Ok(found.and_then(|found| u32::try_from(found).ok()).filter(|found| *found != NONE))
}

/// Parses a whole number.
fn whole_number(word: &[u8]) -> Option<i64> {
    // Nearly all are a few digits, for which the general parser takes several times as long.
    let is_short = (1..10).contains(&word.len()) && word.iter().all(u8::is_ascii_digit);
    if is_short {
        return Some(word.iter().fold(0, |number, digit| 10 * number + i64::from(digit - b'0')));
    }
    parsed(word)
}

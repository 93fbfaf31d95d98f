//! The positions, texture coordinates and normals of an OBJ file, and what else is read before its faces.

use glam::{Vec2, Vec3};

use super::pieces::Piece;
use super::{Statement, each_statement};
use crate::memory_budget::Budget;
use crate::notes::counts;
use crate::read_error::ReadError;
use crate::text_lines::{first_word, number_or_nan, numbers, numbers_or_nan, parsed};
use geometry::casts::to_byte;
use geometry::mesh::chunked_vec::ChunkedVec;

/// The most numbers that a position has, with a weight and a colour.
const NUMBERS: usize = 7;

/// The positions, texture coordinates and normals that corners refer to.
#[derive(Default)]
pub(super) struct Vertices {
    pub positions: ChunkedVec<Vec3>,
    pub uvs: ChunkedVec<Vec2>,
    pub normals: ChunkedVec<Vec3>,
    /// Colours of positions, encoded as sRGB. Positions that have none are white; those after the last coloured one are missing.
    pub colors: ChunkedVec<[u8; 4]>,
    /// Whether any faces are in a smoothing group.
    pub is_smoothed: bool,
    pub flaws: VertexFlaws,
}

counts! {
    pub(super) struct VertexFlaws {
        with_commas => "statements with a comma in a number, which was taken for its point";
        flat => "positions of two numbers, which are placed at z = 0";
    }
}

impl Vertices {
    /// Returns how many positions, texture coordinates and normals there are.
    pub(super) fn counts(&self) -> [usize; 3] {
        [self.positions.len(), self.uvs.len(), self.normals.len()]
    }

    /// Stores what was read from the next piece of the file.
    ///
    /// # Errors
    /// [`ReadError::TooLarge`].
    pub(super) fn add(&mut self, more: &VertexPiece, budget: &Budget) -> Result<(), ReadError> {
        let before = self.positions.len();
        extend(&mut self.positions, &more.positions, budget)?;
        extend(&mut self.uvs, &more.uvs, budget)?;
        extend(&mut self.normals, &more.normals, budget)?;
        if !more.colors.is_empty() {
            let missing = before - self.colors.len();
            for color in std::iter::repeat_n(&[255; 4], missing).chain(&more.colors) {
                extend(&mut self.colors, std::slice::from_ref(color), budget)?;
            }
        }
        self.is_smoothed |= more.is_smoothed;
        self.flaws += more.flaws;
        Ok(())
    }

    /// Returns the size in memory, in bytes.
    pub(super) fn bytes(&self) -> u64 {
        self.positions.bytes() + self.uvs.bytes() + self.normals.bytes() + self.colors.bytes()
    }
}

fn extend<T: Copy>(list: &mut ChunkedVec<T>, items: &[T], budget: &Budget) -> Result<(), ReadError> {
    items.iter().try_for_each(|item| {
        budget.hold(list.next_bytes())?;
        list.push(*item);
        Ok(())
    })
}

/// What a piece of the file has, as [`Vertices`] has it for the whole file.
#[derive(Default)]
pub(super) struct VertexPiece {
    positions: Vec<Vec3>,
    uvs: Vec<Vec2>,
    normals: Vec<Vec3>,
    colors: Vec<[u8; 4]>,
    is_smoothed: bool,
    flaws: VertexFlaws,
    /// The names of material files that it asks for, one statement each.
    pub libraries: Vec<Vec<u8>>,
    /// What its subdivision tags say.
    pub tags: Vec<Vec<u8>>,
}

impl VertexPiece {
    /// Parses a piece, as far as it can be read.
    pub(super) fn parse(piece: &Piece) -> (Self, Result<(), ReadError>) {
        let mut found = Self::default();
        let ended = each_statement(piece.lines(), |statement| {
            found.take(statement);
            Ok(())
        });
        (found, ended)
    }

    fn take(&mut self, statement: &Statement) {
        match statement.word {
            b"v" => {
                let rest = self.numbers_of(statement);
                let (numbers, count) = numbers::<_, NUMBERS>(rest, number_or_nan);
                let [x, y, z, ..] = numbers;
                self.flaws.flat += usize::from(count == 2);
                self.positions.push(Vec3::new(x, y, if count == 2 { 0.0 } else { z }));
                // With four numbers the last one is a weight, and with seven the first three are followed by one.
                if matches!(count, 6 | 7) {
                    let color = stored_color([0, 1, 2].map(|i| numbers[count - 3 + i]));
                    self.colors.resize(self.positions.len() - 1, [255; 4]);
                    self.colors.push(color);
                }
            }
            b"vn" => {
                let rest = self.numbers_of(statement);
                self.normals.push(numbers_or_nan(rest).into());
            }
            b"vt" => {
                let rest = self.numbers_of(statement);
                let ([u, v], count) = numbers(rest, number_or_nan);
                // The file's v points upwards, the mesh's downwards.
                self.uvs.push(Vec2::new(u, 1.0 - if count > 1 { v } else { 0.0 }));
            }
            b"s" => self.is_smoothed |= group(statement.rest()) != 0,
            b"t" => self.tags.push(statement.rest().to_vec()),
            b"mtllib" => self.libraries.push(statement.rest().to_vec()),
            _ => {}
        }
    }

    /// Returns what follows the first word of a statement of numbers, and counts commas.
    fn numbers_of<'a>(&mut self, statement: &Statement<'a>) -> &'a [u8] {
        let rest = statement.rest();
        self.flaws.with_commas += usize::from(rest.contains(&b','));
        rest
    }
}

/// Parses the number of a smoothing group: 0 for `off`, and for what isn't a number.
pub(super) fn group(text: &[u8]) -> u32 {
    parsed(first_word(text).0).unwrap_or(0)
}

/// Returns a colour as bytes. Scanning programs write 0 to 1, and some 0 to 255.
fn stored_color(color: [f32; 3]) -> [u8; 4] {
    let scale = if color.iter().any(|channel| *channel > 1.0) { 1.0 } else { 255.0 };
    // The conversion takes NaN for 0.
    let [r, g, b] = color.map(|channel| to_byte(channel * scale));
    [r, g, b, 255]
}

//! Divides a text into pieces that are parsed on all cores. What is made of the pieces is taken in their order, so the result is
//! that of a reader which goes from line to line.

use crate::memory_budget::Budget;
use crate::read_error::ReadError;
use crate::text_lines::Lines;
use geometry::cores::in_ranges;
use geometry::mesh::Borrowed;
use geometry::progress::Progress;

/// The least size of a piece but the last, in bytes. One ends at the next line end that ends a statement.
const LEAST: usize = 1 << 15;

/// How much text is parsed at a time, in bytes, unless a single piece has more. It limits the memory, on however many cores.
const AT_A_TIME: usize = 1 << 20;

/// The greatest part of a piece of which anything is made, in bytes: a longer one has a line that is too long to be read.
const LONGEST: usize = 5 << 20;

/// The greatest memory for what is made of a byte of text, in bytes. A list doubles when it grows, with the old and the new one in
/// memory: three times its items. A corner of a face takes two bytes of text at least and 12 of memory, a colour with its position
/// 12 and 28, and a line that isn't a face 2 and 32.
const PER_BYTE: u64 = 48;

/// Some whole lines of a text.
#[derive(Clone, Copy)]
pub(super) struct Piece<'a> {
    pub bytes: &'a [u8],
    /// The byte that ends a line.
    end: u8,
    /// How many lines come before it.
    above: usize,
}

impl<'a> Piece<'a> {
    /// Divides a text. No statement begins in one piece and is continued in the next.
    pub(super) fn all(text: &'a [u8]) -> Vec<Self> {
        let Lines { mut rest, end, .. } = Lines::new(text);
        let mut pieces = Vec::new();
        while !rest.is_empty() {
            let (bytes, others) = rest.split_at(length(rest, end));
            pieces.push(Self { bytes, end, above: 0 });
            rest = others;
        }
        let lines = |piece: &Self| memchr::memchr_iter(end, piece.bytes).count();
        let counts = in_ranges(pieces.len(), 16, |range| pieces[range].iter().map(lines).collect::<Vec<_>>()).concat();
        let mut above = 0;
        for (piece, lines) in pieces.iter_mut().zip(counts) {
            piece.above = above;
            above += lines;
        }
        pieces
    }

    /// Returns its lines.
    pub(super) fn lines(&self) -> Lines<'a> {
        Lines { rest: self.bytes, end: self.end, count: self.above, is_open: false }
    }
}

/// Returns the length of the first piece of a text.
fn length(text: &[u8], end: u8) -> usize {
    let Some(far) = text.get(LEAST..) else { return text.len() };
    let is_last = |at: &usize| {
        let line = &text[..LEAST + at];
        !line.strip_suffix(b"\r").unwrap_or(line).ends_with(b"\\")
    };
    memchr::memchr_iter(end, far).find(is_last).map_or(text.len(), |at| LEAST + at + 1)
}

/// Parses pieces on all cores, and passes what is made of each to `take`, in their order. `parse` also returns whether it came to the end.
///
/// # Errors
/// Those of `parse` and `take`, [`ReadError::TooLarge`] and [`ReadError::Cancelled`].
pub(super) fn in_pieces<'a, T: Send>(
    pieces: &[Piece<'a>],
    parse: impl Fn(usize, &Piece<'a>) -> (T, Result<(), ReadError>) + Sync,
    mut take: impl FnMut(T) -> Result<(), ReadError>,
    budget: &Budget,
    progress: &Progress,
) -> Result<(), ReadError> {
    let mut first = 0;
    while first < pieces.len() {
        progress.set(first as f32 / pieces.len() as f32);
        progress.check()?;
        let some = &pieces[first..first + group(&pieces[first..], budget.left())];
        let _scope = Borrowed::from(budget);
        let bytes: usize = some.iter().map(|piece| piece.bytes.len().min(LONGEST)).sum();
        budget.borrow(bytes as u64 * PER_BYTE)?;
        let own = |i: usize| parse(first + i, &some[i]);
        let made = in_ranges(some.len(), 1, |range| range.map(own).collect::<Vec<_>>());
        made.into_iter().flatten().try_for_each(|(made, ended)| take(made).and(ended))?;
        first += some.len();
    }
    Ok(())
}

/// Returns how many pieces are parsed at a time, from the first one on, if so many bytes of memory are left: at least one, and no more
/// than leave three quarters of the memory to the mesh.
fn group(pieces: &[Piece], left: u64) -> usize {
    let most = (AT_A_TIME as u64).min(left / (4 * PER_BYTE));
    let mut bytes = 0;
    let fits = |piece: &&Piece| {
        bytes += piece.bytes.len() as u64;
        bytes <= most
    };
    pieces.iter().take_while(fits).count().max(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The numbers and texts of the lines, piece by piece.
    fn lines(pieces: &[Piece]) -> Vec<Vec<(usize, Vec<u8>)>> {
        let of = |piece: &Piece| {
            let (mut lines, mut all) = (piece.lines(), Vec::new());
            while let Some(line) = lines.next().expect("short lines") {
                all.push((line.number, line.text.to_vec()));
            }
            all
        };
        pieces.iter().map(of).collect()
    }

    #[test]
    fn pieces_are_the_lines_of_the_text() {
        for end in ["\n", "\r\n", "\r"] {
            let text: String = (0..20_000).map(|i| format!("v {i} {}{end}", "7".repeat(i % 9))).collect();
            let pieces = Piece::all(text.as_bytes());
            assert!(pieces.len() > 5);
            assert!(pieces[..pieces.len() - 1].iter().all(|piece| (LEAST..LEAST + 20).contains(&piece.bytes.len())));
            let mut whole = Vec::new();
            let mut all = Lines::new(text.as_bytes());
            while let Some(line) = all.next().expect("short lines") {
                whole.push((line.number, line.text.to_vec()));
            }
            assert!(lines(&pieces).concat() == whole, "{end:?}");
        }
    }

    #[test]
    fn a_continued_line_stays_in_its_piece() {
        for end in ["\n", "\r\n", "\r"] {
            let text = format!("{}f 1 \\{end}2 \\{end}3{end}v 0 0 0", "#".repeat(LEAST - 2) + end);
            let found = lines(&Piece::all(text.as_bytes()));
            assert_eq!(found.len(), 2, "{end:?}");
            assert_eq!((found[0].len(), found[1].clone()), (4, vec![(5, b"v 0 0 0".to_vec())]));
        }
        assert!(Piece::all(b"").is_empty());
        assert_eq!(
            lines(&Piece::all(b"\xef\xbb\xbfv\n")),
            [vec![(1, b"v".to_vec())]],
            "a byte order mark isn't of a line"
        );
    }
}

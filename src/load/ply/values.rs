//! Reads the values after the header of a PLY file, in text and in binary.

use super::header::{Element, Encoding, Header, PropertyKind, Scalar};
use crate::read_error::{FilePosition, ReadError};
use crate::text_lines::{Line, Lines, first_word, parsed, shown, words};
use geometry::casts::to_usize;
use geometry::progress::Progress;

/// The position of the next value.
#[derive(Clone)]
pub(super) struct Values<'a> {
    encoding: Encoding,
    /// The lines that haven't been read; of a text file, those after the current element's line.
    lines: Lines<'a>,
    /// In a text file, the current element's line.
    line: Line<'a>,
    /// In a text file, the rest of the current line.
    left: &'a [u8],
    /// In a binary file, the bytes that haven't been read.
    bytes: &'a [u8],
    /// The file's size, in bytes.
    size: usize,
    /// Whether the last error is that the file ends too early.
    pub ends: bool,
    /// Lines of a text file with more numbers than their element has.
    pub long_lines: usize,
}

impl<'a> Values<'a> {
    pub(super) fn new(header: &Header<'a>, size: usize) -> Self {
        let lines = header.lines.clone();
        let line = Line { text: &[], number: lines.count };
        Self { encoding: header.encoding, bytes: lines.rest, lines, line, left: &[], size, ends: false, long_lines: 0 }
    }

    /// Returns the position of the next value, for messages.
    pub(super) fn place(&self) -> FilePosition {
        match self.encoding {
            Encoding::Text => FilePosition::Line(self.line.number),
            _ => FilePosition::Byte(self.size - self.bytes.len()),
        }
    }

    /// Returns how much of the file has been read, 0 to 1.
    pub(super) fn fraction(&self) -> f32 {
        let left = if self.encoding == Encoding::Text { self.lines.rest } else { self.bytes };
        1.0 - left.len() as f32 / self.size as f32
    }

    /// Checks that the rest of the file is large enough for the number of elements, before memory is taken for them.
    ///
    /// # Errors
    /// [`ReadError::Broken`].
    pub(super) fn check(&mut self, element: &Element) -> Result<(), ReadError> {
        let (left, least) = self.room(element);
        let needed = element.count.checked_mul(least);
        if needed.is_some_and(|needed| needed <= left as u64) {
            return Ok(());
        }
        self.ends = true;
        let Element { name, count, .. } = element;
        let needed =
            needed.map_or("more bytes than any file has".to_owned(), |needed| format!("at least {needed} bytes"));
        let reason = format!(
            "the header says that there are {count} elements {}, which take {needed}, but {left} bytes are left",
            shown(name)
        );
        Err(self.place().error(reason))
    }

    /// Returns how many bytes are left, and how many an element takes at least.
    fn room(&self, element: &Element) -> (usize, u64) {
        match self.encoding {
            // A digit and a separator, which the last value may lack.
            Encoding::Text => (self.lines.rest.len() + 1, 2 * element.properties.len() as u64),
            _ => (self.bytes.len(), element.least().0),
        }
    }

    /// Returns how many of the elements that the header announces can be there at most.
    pub(super) fn most(&self, element: &Element) -> u64 {
        let (left, least) = self.room(element);
        (left as u64).checked_div(least).map_or(element.count, |most| element.count.min(most))
    }

    /// Skips an element, for which [`check`](Self::check) has succeeded.
    ///
    /// # Errors
    /// [`ReadError::Broken`].
    pub(super) fn skip(&mut self, element: &Element, progress: &Progress) -> Result<(), ReadError> {
        let (size, fixed) = element.least();
        if size == 0 {
            return Ok(());
        }
        if fixed && self.encoding != Encoding::Text {
            self.bytes = self.bytes.get(to_usize(size * element.count)..).unwrap_or_default();
            return Ok(());
        }
        for i in 0..element.count {
            progress.step(i, || 0.5 * self.fraction())?;
            self.begin(element, i)?;
            if self.encoding == Encoding::Text {
                continue;
            }
            for property in &element.properties {
                self.skip_one(property.kind)?;
            }
        }
        Ok(())
    }

    /// Skips one value or list.
    ///
    /// # Errors
    /// [`ReadError::Broken`].
    pub(super) fn skip_one(&mut self, kind: PropertyKind) -> Result<(), ReadError> {
        match kind {
            PropertyKind::One(scalar) => self.next(scalar).map(drop),
            PropertyKind::List { count, item } if self.encoding == Encoding::Text => {
                let count = self.count(count, item)?;
                (0..count).try_for_each(|_| self.next(item).map(drop))
            }
            PropertyKind::List { count, item } => {
                let count = self.count(count, item)?;
                self.bytes = self.bytes.get(count * item.size()..).unwrap_or_default();
                Ok(())
            }
        }
    }

    /// Goes to element number `i`: in a text file, to its line.
    ///
    /// # Errors
    /// [`ReadError::Broken`] at the end of the file.
    pub(super) fn begin(&mut self, element: &Element, i: u64) -> Result<(), ReadError> {
        if self.encoding != Encoding::Text {
            return Ok(());
        }
        while let Some(line) = self.lines.next()? {
            (self.line, self.left) = (line, line.text.trim_ascii());
            // If more should follow, the file may have been cut within this line's last number.
            let is_cut = self.lines.is_open && i + 1 < element.count;
            if !self.left.is_empty() && !is_cut {
                return Ok(());
            }
        }
        let Element { name, count, .. } = element;
        self.ends = true;
        Err(self.place().error(format!("the file ends after {i} of {count} elements {}", shown(name))))
    }

    /// Leaves out what follows the values of an element in its line.
    pub(super) fn end(&mut self) {
        self.long_lines += usize::from(!self.left.is_empty());
    }

    /// Returns the next value.
    ///
    /// # Errors
    /// [`ReadError::Broken`].
    pub(super) fn next(&mut self, scalar: Scalar) -> Result<f64, ReadError> {
        match self.encoding {
            Encoding::Text => self.word(),
            encoding => match scalar.decoded(self.bytes, encoding == Encoding::BigEndian) {
                Some(value) => {
                    self.bytes = &self.bytes[scalar.size()..];
                    Ok(value)
                }
                None => {
                    let (size, left) = (scalar.size(), self.bytes.len());
                    self.ends = true;
                    Err(self.place().error(format!("a value takes {size} bytes, but {left} are left")))
                }
            },
        }
    }

    /// Reads the number of values of a list, and checks that the rest of the file or line has as many.
    ///
    /// # Errors
    /// [`ReadError::Broken`].
    #[expect(clippy::cast_possible_truncation, reason = "a whole number that fits in what is left of the file")]
    pub(super) fn count(&mut self, count: Scalar, item: Scalar) -> Result<usize, ReadError> {
        let place = self.place();
        let said = self.next(count)?;
        if said < 0.0 || said.fract() != 0.0 || !said.is_finite() {
            return Err(place.error(format!("a list says that it has {} values", plain(said))));
        }
        let (left, needed) = match self.encoding {
            Encoding::Text => (words(self.left).count(), said),
            _ => (self.bytes.len(), said * item.size() as f64),
        };
        if needed > left as f64 {
            self.ends = self.is_last();
            let unit = if self.encoding == Encoding::Text { "are in its line" } else { "bytes are left" };
            return Err(place.error(format!("a list says that it has {} values, but {left} {unit}", plain(said))));
        }
        Ok(said as usize)
    }

    /// Whether nothing follows the present line of a text file. In a binary file whatever is missing would follow.
    fn is_last(&self) -> bool {
        self.encoding != Encoding::Text || self.lines.rest.trim_ascii().is_empty()
    }

    fn word(&mut self) -> Result<f64, ReadError> {
        let (word, rest) = first_word(self.left);
        if word.is_empty() {
            self.ends = self.is_last();
            let count = words(self.line.text).count();
            return Err(self.place().error(format!("the line has {count} numbers, but the element has more")));
        }
        self.left = rest;
        // Parsed as f64, so that indices are exact.
        parsed(word).ok_or_else(|| self.place().error(format!("{} isn't a number", shown(word))))
    }

    /// Returns how many bytes follow the last element.
    pub(super) fn left_over(&self) -> usize {
        match self.encoding {
            Encoding::Text => self.lines.rest.trim_ascii().len(),
            _ => self.bytes.len(),
        }
    }
}

/// Formats a number for a message.
fn plain(x: f64) -> String {
    if x == 0.0 || (1e-3..1e15).contains(&x.abs()) { x.to_string() } else { format!("{x:e}") }
}

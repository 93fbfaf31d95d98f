//! The values behind the header of a PLY file, in text and in binary: one element after another.

use super::header::{Element, Encoding, Header, Kind, Scalar};
use crate::load::read_error::{Place, ReadError};
use crate::load::text_lines::{Line, Lines, number, shown, words};

/// Where the next value is.
#[derive(Clone)]
pub struct Values<'a> {
    encoding: Encoding,
    /// What isn't read yet; of text, after the line of the element.
    lines: Lines<'a>,
    /// The element's line and what is left of it, in text.
    line: Line<'a>,
    left: &'a [u8],
    /// Of binary, the same.
    bytes: &'a [u8],
    /// The file's size.
    size: usize,
}

impl<'a> Values<'a> {
    pub fn new(header: &Header<'a>, size: usize) -> Self {
        let lines = header.lines.clone();
        let line = Line { text: &[], number: lines.count() };
        Self { encoding: header.encoding, bytes: lines.rest(), lines, line, left: &[], size }
    }

    /// Where it is.
    pub fn place(&self) -> Place {
        match self.encoding {
            Encoding::Text => Place::Line(self.line.number),
            _ => Place::Byte(self.size - self.bytes.len()),
        }
    }

    /// How much of the file has been read, 0 to 1.
    pub fn fraction(&self) -> f32 {
        let left = if self.encoding == Encoding::Text { self.lines.rest() } else { self.bytes };
        1.0 - left.len() as f32 / self.size as f32
    }

    /// Whether so many elements can follow at all: before memory is taken for them.
    ///
    /// # Errors
    /// [`ReadError::Broken`].
    pub fn check(&self, element: &Element) -> Result<(), ReadError> {
        let (left, least) = match self.encoding {
            // A digit and what ends it; the last may have no end.
            Encoding::Text => (self.lines.rest().len() + 1, 2 * element.properties.len() as u64),
            _ => (self.bytes.len(), element.least().0),
        };
        let needed = element.count.checked_mul(least);
        if needed.is_some_and(|needed| needed <= left as u64) {
            return Ok(());
        }
        let Element { name, count, .. } = element;
        let needed = needed.map_or("more than any file has".to_owned(), |needed| format!("at least {needed}"));
        let reason = format!(
            "the header says {count} of element {}, which take {needed} bytes, and {left} are left",
            shown(name)
        );
        Err(self.place().fault(reason))
    }

    /// Leaves out all of an element, checked before.
    ///
    /// # Errors
    /// [`ReadError::Broken`].
    pub fn skip(
        &mut self,
        element: &Element,
        mut each: impl FnMut(&Self, u64) -> Result<(), ReadError>,
    ) -> Result<(), ReadError> {
        let (size, fixed) = element.least();
        if size == 0 {
            return Ok(());
        }
        if fixed && self.encoding != Encoding::Text {
            self.bytes = self.bytes.get((size * element.count) as usize..).unwrap_or_default();
            return Ok(());
        }
        for i in 0..element.count {
            each(self, i)?;
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

    /// Leaves out one value or list.
    ///
    /// # Errors
    /// [`ReadError::Broken`].
    pub fn skip_one(&mut self, kind: Kind) -> Result<(), ReadError> {
        match kind {
            Kind::One(scalar) => self.next(scalar).map(drop),
            Kind::List { count, item } if self.encoding == Encoding::Text => {
                let count = self.count(count, item)?;
                (0..count).try_for_each(|_| self.next(item).map(drop))
            }
            Kind::List { count, item } => {
                let count = self.count(count, item)?;
                self.bytes = self.bytes.get(count * item.size()..).unwrap_or_default();
                Ok(())
            }
        }
    }

    /// Goes to the next element, which is number `i`: in text, to its line.
    ///
    /// # Errors
    /// [`ReadError::Broken`] at the end of the file.
    pub fn begin(&mut self, element: &Element, i: u64) -> Result<(), ReadError> {
        if self.encoding != Encoding::Text {
            return Ok(());
        }
        while let Some(line) = self.lines.next()? {
            (self.line, self.left) = (line, line.text.trim_ascii());
            if !self.left.is_empty() {
                return Ok(());
            }
        }
        let Element { name, count, .. } = element;
        Err(self.place().fault(format!("the file ends after {i} of {count} of element {}", shown(name))))
    }

    /// Says so if there is more in the line of an element than it consists of.
    ///
    /// # Errors
    /// [`ReadError::Broken`].
    pub fn end(&self, element: &Element) -> Result<(), ReadError> {
        if self.left.is_empty() {
            return Ok(());
        }
        let (all, more) = (words(self.line.text).count(), words(self.left).count());
        let reason = format!("the line has {all} numbers, and the element {} has {}", shown(element.name), all - more);
        Err(self.place().fault(reason))
    }

    /// The next value.
    ///
    /// # Errors
    /// [`ReadError::Broken`].
    pub fn next(&mut self, scalar: Scalar) -> Result<f64, ReadError> {
        match self.encoding {
            Encoding::Text => self.word(),
            Encoding::LittleEndian => Ok(match scalar {
                Scalar::I8 => i8::from_le_bytes(self.take()?).into(),
                Scalar::U8 => u8::from_le_bytes(self.take()?).into(),
                Scalar::I16 => i16::from_le_bytes(self.take()?).into(),
                Scalar::U16 => u16::from_le_bytes(self.take()?).into(),
                Scalar::I32 => i32::from_le_bytes(self.take()?).into(),
                Scalar::U32 => u32::from_le_bytes(self.take()?).into(),
                Scalar::F32 => f32::from_le_bytes(self.take()?).into(),
                Scalar::F64 => f64::from_le_bytes(self.take()?),
            }),
            Encoding::BigEndian => Ok(match scalar {
                Scalar::I8 => i8::from_be_bytes(self.take()?).into(),
                Scalar::U8 => u8::from_be_bytes(self.take()?).into(),
                Scalar::I16 => i16::from_be_bytes(self.take()?).into(),
                Scalar::U16 => u16::from_be_bytes(self.take()?).into(),
                Scalar::I32 => i32::from_be_bytes(self.take()?).into(),
                Scalar::U32 => u32::from_be_bytes(self.take()?).into(),
                Scalar::F32 => f32::from_be_bytes(self.take()?).into(),
                Scalar::F64 => f64::from_be_bytes(self.take()?),
            }),
        }
    }

    /// How many values a list has, which are all there.
    ///
    /// # Errors
    /// [`ReadError::Broken`].
    pub fn count(&mut self, count: Scalar, item: Scalar) -> Result<usize, ReadError> {
        let place = self.place();
        let said = self.next(count)?;
        if said < 0.0 || said.fract() != 0.0 || !said.is_finite() {
            return Err(place.fault(format!("a list has {} values", plain(said))));
        }
        let (left, needed) = match self.encoding {
            Encoding::Text => (words(self.left).count(), said),
            _ => (self.bytes.len(), said * item.size() as f64),
        };
        if needed > left as f64 {
            let unit = if self.encoding == Encoding::Text { "are in its line" } else { "bytes are left" };
            return Err(place.fault(format!("a list has {} values, and {left} {unit}", plain(said))));
        }
        Ok(said as usize)
    }

    fn word(&mut self) -> Result<f64, ReadError> {
        let (word, rest) = crate::load::text_lines::first_word(self.left);
        if word.is_empty() {
            let count = words(self.line.text).count();
            return Err(self.place().fault(format!("the line has {count} numbers, and the element has more")));
        }
        self.left = rest;
        // Twice as many digits as a position has: indices are exact.
        let wide = std::str::from_utf8(word).ok().and_then(|word| word.parse().ok());
        wide.ok_or_else(|| self.place().fault(number(word).err().unwrap_or_default()))
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N], ReadError> {
        let Some((value, rest)) = self.bytes.split_first_chunk() else {
            let left = self.bytes.len();
            return Err(self.place().fault(format!("a value takes {N} bytes, and {left} are left")));
        };
        self.bytes = rest;
        Ok(*value)
    }

    /// How many bytes there are after the last element.
    pub fn left_over(&self) -> usize {
        match self.encoding {
            Encoding::Text => self.lines.rest().trim_ascii().len(),
            _ => self.bytes.len(),
        }
    }
}

/// A number fit for a message, whatever it is.
pub fn plain(x: f64) -> String {
    if x == 0.0 || (1e-3..1e15).contains(&x.abs()) { x.to_string() } else { format!("{x:e}") }
}

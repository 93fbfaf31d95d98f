//! A document's JSON as a tree, after a look at how deep and how large it would be.

use serde_json::Value;
use serde_json::error::Category;

use super::Problem;
use crate::load::memory_budget::Budget;
use crate::mesh::{MemoryAccount, MemoryRefused};
use crate::progress::{Cancelled, Progress};

/// How deep lists and objects may lie in one another. The specification's own need 8; `extras` may have more.
const MAX_DEPTH: usize = 100;

/// Bytes that are looked at without asking whether anybody still waits.
const PIECE: usize = 1 << 24;

/// What a text becomes, at most, in bytes of memory: a member or an element, an object's first node of members, and that
/// object once more as what is read of it.
const PER_VALUE: u64 = 72;
pub const PER_OBJECT: u64 = 640;
const PER_READ: u64 = 400;

/// Parses a text.
///
/// # Errors
/// [`Problem::NotGltf`] for what is no JSON or nested too deep, [`Problem::Document`] for what is too large, and
/// [`Problem::Cancelled`].
pub fn parse(text: &[u8], budget: &Budget, progress: &Progress) -> Result<Value, Problem> {
    // A byte order mark is not JSON, but some editors write it.
    let text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text);
    let shape = Shape::of(text, progress)?;
    if shape.depth > MAX_DEPTH {
        let reason = format!("its JSON is nested {} deep, and {MAX_DEPTH} are read", shape.depth);
        return Err(Problem::NotGltf { reason });
    }
    let too_large =
        |refused: MemoryRefused| Problem::Document { pointer: "its JSON".to_owned(), reason: refused.into() };
    budget.borrow(shape.values * PER_VALUE + shape.objects * PER_OBJECT).map_err(too_large)?;
    budget.hold(shape.objects * PER_READ).map_err(too_large)?;
    serde_json::from_slice(text).map_err(|error| Problem::NotGltf { reason: reason(&error) })
}

/// What a text's brackets and commas say.
#[derive(Debug, Default, PartialEq, Eq)]
struct Shape {
    depth: usize,
    /// Not fewer than there are members and elements.
    values: u64,
    objects: u64,
}

impl Shape {
    fn of(text: &[u8], progress: &Progress) -> Result<Self, Cancelled> {
        let mut scan = Scan::default();
        for piece in text.chunks(PIECE) {
            progress.check()?;
            piece.iter().for_each(|&byte| scan.take(byte));
        }
        Ok(scan.shape)
    }
}

/// A text as far as it was looked at.
#[derive(Default)]
struct Scan {
    shape: Shape,
    depth: usize,
    in_string: bool,
    escaped: bool,
}

impl Scan {
    fn take(&mut self, byte: u8) {
        if self.in_string {
            self.in_string = self.escaped || byte != b'"';
            self.escaped = !self.escaped && byte == b'\\';
            return;
        }
        match byte {
            b'"' => self.in_string = true,
            b'{' | b'[' => {
                self.depth += 1;
                self.shape.depth = self.shape.depth.max(self.depth);
                self.shape.values += 1;
                self.shape.objects += u64::from(byte == b'{');
            }
            b'}' | b']' => self.depth = self.depth.saturating_sub(1),
            b',' => self.shape.values += 1,
            _ => {}
        }
    }
}

/// Why a text is no JSON: a file cut short is the most common, and the least plainly said.
fn reason(error: &serde_json::Error) -> String {
    match error.classify() {
        Category::Eof => format!("its JSON ends too early, at line {}, column {}", error.line(), error.column()),
        _ => format!("its JSON is broken: {error}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn brackets_in_strings_are_none() {
        let of = |text: &[u8]| Shape::of(text, &Progress::new()).expect("nobody cancels");
        let shape = of(br#"{"a[\"{[":[[1,2],{}],"b\\":"]"}"#);
        assert_eq!(shape, Shape { depth: 3, values: 7, objects: 2 });
        assert_eq!(of(b"]]]["), Shape { depth: 1, values: 1, objects: 0 });
    }

    #[test]
    fn depth_is_refused_with_both_numbers() {
        let deep = "[".repeat(MAX_DEPTH + 1);
        let said = parse(deep.as_bytes(), &Budget::unlimited(), &Progress::new()).unwrap_err().to_string();
        assert!(said.contains("nested 101 deep, and 100 are read"), "{said}");
        let allowed = format!("{}{}", "[".repeat(MAX_DEPTH), "]".repeat(MAX_DEPTH));
        assert!(parse(allowed.as_bytes(), &Budget::unlimited(), &Progress::new()).is_ok());
    }
}

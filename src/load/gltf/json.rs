//! Parses a document's JSON, after a check of how deep it is nested and how much memory it takes.

use serde_json::error::Category;
use serde_json::{Map, Value};

use super::GltfError;
use crate::memory_budget::Budget;
use geometry::progress::Progress;

/// How deep lists and objects may be nested. The specification itself needs 8 levels; `extras` may need more.
const MAX_DEPTH: usize = 100;

/// How many bytes are scanned between two checks for cancellation.
const PIECE: usize = 1 << 24;

/// Memory for a member or an element, in bytes.
const PER_VALUE: u64 = 72;
/// Memory for an object's first node of members, in bytes.
pub(super) const PER_OBJECT: u64 = 640;
/// Memory for what is read from an object, in bytes.
pub(super) const PER_READ: u64 = 400;

/// Parses a text.
///
/// # Errors
/// [`GltfError::NotGltf`] for text that isn't JSON or is nested too deep, [`GltfError::Document`] for text that is too
/// large, and [`GltfError::Cancelled`].
pub(super) fn parse(text: &[u8], budget: &Budget, progress: &Progress) -> Result<Value, GltfError> {
    // JSON has no byte order mark, but some editors write one.
    let text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text);
    let mut size = JsonSize::default();
    for piece in text.chunks(PIECE) {
        progress.check()?;
        piece.iter().for_each(|&byte| size.take(byte));
    }
    let JsonSize { depth, values, objects, .. } = size;
    if depth > MAX_DEPTH {
        let reason = format!("its JSON is nested {depth} levels deep, but at most {MAX_DEPTH} levels are read");
        return Err(GltfError::NotGltf { reason });
    }
    budget.borrow(values * PER_VALUE + objects * PER_OBJECT).map_err(GltfError::large_json)?;
    budget.hold(objects * PER_READ).map_err(GltfError::large_json)?;
    let mut value = serde_json::from_slice(text).map_err(|error| GltfError::NotGltf { reason: reason(&error) })?;
    make_whole(&mut value);
    Ok(value)
}

/// Replaces floating-point numbers that are whole by integers, so that an index may be written as 4.0 or 4e0: JSON doesn't tell
/// them apart (RFC 8259, section 6). Numbers from 2^53 on stay, since not every integer there is an f64.
#[expect(clippy::cast_possible_truncation, reason = "a whole number that both types have")]
fn make_whole(value: &mut Value) {
    const EXACT: f64 = (1_u64 << 53) as f64;
    match value {
        Value::Array(values) => values.iter_mut().for_each(make_whole),
        Value::Object(object) => object.values_mut().for_each(make_whole),
        Value::Number(number) if number.is_f64() => {
            let float = number.as_f64().filter(|float| float.fract() == 0.0 && float.abs() < EXACT);
            // -0.0 has no integer.
            if let Some(float) = float.filter(|float| *float != 0.0 || float.is_sign_positive()) {
                *number = (float as i64).into();
            }
        }
        _ => {}
    }
}

/// Returns one of the document's lists; an empty one if it is missing or no list.
pub(super) fn list<'a>(root: &'a Map<String, Value>, name: &str) -> &'a [Value] {
    root.get(name).and_then(Value::as_array).map_or(&[], Vec::as_slice)
}

/// Returns the objects in one of an object's lists, with their indices.
pub(super) fn objects<'a>(
    object: &'a mut Map<String, Value>,
    list: &str,
) -> impl Iterator<Item = (usize, &'a mut Map<String, Value>)> {
    let values = object.get_mut(list).and_then(Value::as_array_mut).into_iter().flatten().enumerate();
    values.filter_map(|(i, value)| Some((i, value.as_object_mut()?)))
}

/// Returns the memory of a value that has been parsed, in bytes, by the same estimate.
pub(super) fn bytes(value: &Value) -> u64 {
    let inside = match value {
        Value::Object(object) if object.is_empty() => 0,
        Value::Object(object) => {
            let members = object.iter().map(|(name, value)| name.len() as u64 + bytes(value));
            PER_OBJECT + members.sum::<u64>()
        }
        Value::Array(values) => values.iter().map(bytes).sum(),
        Value::String(text) => text.len() as u64,
        Value::Null | Value::Bool(_) | Value::Number(_) => 0,
    };
    PER_VALUE + inside
}

/// The size of a document, counted from brackets and commas.
#[derive(Debug, Default, PartialEq, Eq)]
struct JsonSize {
    /// The greatest depth, and that of the next byte.
    depth: usize,
    open: usize,
    /// At least as many as there are members and elements.
    values: u64,
    objects: u64,
    in_string: bool,
    escaped: bool,
}

impl JsonSize {
    fn take(&mut self, byte: u8) {
        if self.in_string {
            self.in_string = self.escaped || byte != b'"';
            self.escaped = !self.escaped && byte == b'\\';
            return;
        }
        match byte {
            b'"' => self.in_string = true,
            b'{' | b'[' => {
                self.open += 1;
                self.depth = self.depth.max(self.open);
                self.values += 1;
                self.objects += u64::from(byte == b'{');
            }
            b'}' | b']' => self.open = self.open.saturating_sub(1),
            b',' => self.values += 1,
            _ => {}
        }
    }
}

/// Returns why a text isn't JSON. A file that was cut short is the most common case, and serde_json's message for it
/// isn't clear.
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
    fn brackets_in_strings_do_not_count() {
        let of = |text: &[u8]| {
            let mut size = JsonSize::default();
            text.iter().for_each(|&byte| size.take(byte));
            [size.depth as u64, size.values, size.objects]
        };
        assert_eq!(of(br#"{"a[\"{[":[[1,2],{}],"b\\":"]"}"#), [3, 7, 2]);
        assert_eq!(of(b"]]]["), [1, 1, 0]);
    }

    #[test]
    fn whole_numbers_may_be_written_as_floats() {
        let text = br#"[4.0, {"a": 4e0}, -2.0, 0.5, -0.0, 1e300, 0.0]"#;
        let value = parse(text, &Budget::unlimited(), &Progress::new()).expect("JSON");
        let expected = serde_json::json!([4, { "a": 4 }, -2, 0.5, -0.0, 1e300, 0]);
        assert_eq!(value, expected);
    }

    #[test]
    fn depth_is_refused_with_both_numbers() {
        let deep = "[".repeat(MAX_DEPTH + 1);
        let said = parse(deep.as_bytes(), &Budget::unlimited(), &Progress::new()).unwrap_err().to_string();
        assert!(said.contains("nested 101 levels deep, but at most 100 levels are read"), "{said}");
        let allowed = format!("{}{}", "[".repeat(MAX_DEPTH), "]".repeat(MAX_DEPTH));
        assert!(parse(allowed.as_bytes(), &Budget::unlimited(), &Progress::new()).is_ok());
    }
}

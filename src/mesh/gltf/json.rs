//! A document's JSON as a tree, after a look at how deep and how large it would be.

use serde_json::Value;

use super::Problem;
use super::budget::Budget;

/// How deep lists and objects may lie in one another. The specification's own need 8; `extras` may have more.
const MAX_DEPTH: usize = 100;

/// What a text becomes, at most, in bytes of memory: a member or an element, an object's first node of members, and that
/// object once more as what is read of it.
const PER_VALUE: u64 = 72;
const PER_OBJECT: u64 = 640;
const PER_READ: u64 = 400;

/// Parses a text.
///
/// # Errors
/// [`Problem::NotGltf`] for what is no JSON or nested too deep, [`Problem::Document`] for what is too large.
pub fn parse(text: &[u8], budget: &Budget) -> Result<Value, Problem> {
    // A byte order mark is not JSON, but some editors write it.
    let text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text);
    let shape = Shape::of(text);
    if shape.depth > MAX_DEPTH {
        let reason = format!("its JSON is nested {} deep, and {MAX_DEPTH} are read", shape.depth);
        return Err(Problem::NotGltf { reason });
    }
    let too_large = |reason| Problem::Document { pointer: "its JSON".to_owned(), reason };
    budget.borrow(shape.values * PER_VALUE + shape.objects * PER_OBJECT).map_err(too_large)?;
    budget.hold(shape.objects * PER_READ).map_err(too_large)?;
    serde_json::from_slice(text).map_err(|error| Problem::NotGltf { reason: error.to_string() })
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
    fn of(text: &[u8]) -> Self {
        let mut shape = Self::default();
        let (mut depth, mut in_string, mut escaped) = (0_usize, false, false);
        for &byte in text {
            if in_string {
                in_string = escaped || byte != b'"';
                escaped = !escaped && byte == b'\\';
                continue;
            }
            match byte {
                b'"' => in_string = true,
                b'{' | b'[' => {
                    depth += 1;
                    shape.depth = shape.depth.max(depth);
                    shape.values += 1;
                    shape.objects += u64::from(byte == b'{');
                }
                b'}' | b']' => depth = depth.saturating_sub(1),
                b',' => shape.values += 1,
                _ => {}
            }
        }
        shape
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn brackets_in_strings_are_none() {
        let shape = Shape::of(br#"{"a[\"{[":[[1,2],{}],"b\\":"]"}"#);
        assert_eq!(shape, Shape { depth: 3, values: 7, objects: 2 });
        assert_eq!(Shape::of(b"]]]["), Shape { depth: 1, values: 1, objects: 0 });
    }

    #[test]
    fn depth_is_refused_with_both_numbers() {
        let deep = "[".repeat(MAX_DEPTH + 1);
        let said = parse(deep.as_bytes(), &Budget::new(0)).unwrap_err().to_string();
        assert!(said.contains("nested 101 deep, and 100 are read"), "{said}");
        let allowed = format!("{}{}", "[".repeat(MAX_DEPTH), "]".repeat(MAX_DEPTH));
        assert!(parse(allowed.as_bytes(), &Budget::new(0)).is_ok());
    }
}

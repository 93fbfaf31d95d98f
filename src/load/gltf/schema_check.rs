//! Compares a document with a [schema](super::schema) before anything else reads it, and removes what isn't in the
//! schema.

use std::collections::HashMap;
use std::fmt;

use serde_json::{Map, Value};

use super::GltfError;
use super::schema::{Field, MemberKind};

/// Checks a document, member by member, and removes all members that the schema doesn't name.
///
/// # Errors
/// [`GltfError::Document`] for the first member that is wrong.
pub(super) fn check(
    document: &mut Map<String, Value>,
    schema: &'static [Field],
    replaced_views: &[bool],
) -> Result<(), GltfError> {
    Checker::new(document, schema, replaced_views).object(document, schema, &JsonPointer(None, Part::Root))
}

/// A place in the document.
struct JsonPointer<'a>(Option<&'a JsonPointer<'a>>, Part<'a>);

enum Part<'a> {
    Root,
    Name(&'a str),
    Place(usize),
}

impl fmt::Display for JsonPointer<'_> {
    /// Writes the place as a JSON pointer (RFC 6901).
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        if let Some(above) = self.0 {
            above.fmt(f)?;
        }
        match self.1 {
            Part::Root => Ok(()),
            Part::Name(name) => write!(f, "/{}", name.replace('~', "~0").replace('/', "~1")),
            Part::Place(place) => write!(f, "/{place}"),
        }
    }
}

impl JsonPointer<'_> {
    fn fail<T>(&self, reason: String) -> Result<T, GltfError> {
        Err(GltfError::Document { pointer: self.to_string(), reason })
    }

    fn should_be<T>(&self, what: &str, value: &Value) -> Result<T, GltfError> {
        self.fail(format!("should be {what} but is {}", shown(value)))
    }
}

/// Checks objects of one document.
pub(super) struct Checker<'a> {
    /// The number of elements of each of the document's lists.
    counts: HashMap<&'static str, u64>,
    /// Which buffer views were replaced by empty ones, and aren't checked.
    replaced_views: &'a [bool],
}

impl<'a> Checker<'a> {
    pub(super) fn new(document: &Map<String, Value>, schema: &'static [Field], replaced_views: &'a [bool]) -> Self {
        let count = |field: &Field| Some((field.name, document.get(field.name)?.as_array()?.len() as u64));
        Self { counts: schema.iter().filter_map(count).collect(), replaced_views }
    }

    /// Checks one element of one of the document's lists.
    ///
    /// # Errors
    /// [`GltfError::Document`] for the first member that is wrong.
    pub(super) fn element(
        &self,
        list: &str,
        place: usize,
        value: &mut Value,
        fields: &'static [Field],
    ) -> Result<(), GltfError> {
        let path = JsonPointer(None, Part::Root);
        let path = JsonPointer(Some(&path), Part::Name(list));
        self.value(value, &MemberKind::Object(fields), &JsonPointer(Some(&path), Part::Place(place)))
    }

    fn object(
        &self,
        object: &mut Map<String, Value>,
        fields: &'static [Field],
        path: &JsonPointer,
    ) -> Result<(), GltfError> {
        // Null stands for a missing member.
        object.retain(|name, value| !value.is_null() && fields.iter().any(|field| field.name == name));
        for field in fields {
            let path = JsonPointer(Some(path), Part::Name(field.name));
            match object.get_mut(field.name) {
                None if field.required => return path.fail("is missing".to_owned()),
                None => {}
                Some(Value::String(_)) if matches!(field.kind, MemberKind::Name) => {}
                Some(_) if matches!(field.kind, MemberKind::Name) => {
                    object.remove(field.name);
                }
                Some(value) => self.value(value, &field.kind, &path)?,
            }
        }
        Ok(())
    }

    fn value(&self, value: &mut Value, kind: &MemberKind, path: &JsonPointer) -> Result<(), GltfError> {
        match kind {
            MemberKind::Index(list) => self.index(value, list, path),
            MemberKind::Indices(list) => each(value, path, |value, path| self.index(value, list, path)),
            MemberKind::Whole { least, most } => whole(value, *least, *most, path),
            MemberKind::Numbers(count) => numbers(value, *count, NUMBER, path),
            MemberKind::Within { count, least, most } => numbers(value, Some(*count), [*least, *most], path),
            MemberKind::Text | MemberKind::Name => {
                if value.is_string() {
                    Ok(())
                } else {
                    path.should_be("text", value)
                }
            }
            MemberKind::Flag => {
                if value.is_boolean() {
                    Ok(())
                } else {
                    path.should_be("true or false", value)
                }
            }
            MemberKind::Code(codes) => match value.as_u64() {
                Some(code) if codes.contains(&code) => Ok(()),
                _ => path.should_be(&one_of(codes), value),
            },
            MemberKind::Word(words) => match value.as_str() {
                Some(word) if words.contains(&word) => Ok(()),
                _ => path.should_be(&one_of(words), value),
            },
            MemberKind::Object(fields) => match value {
                Value::Object(object) => self.object(object, fields, path),
                other => path.should_be("an object", other),
            },
            MemberKind::Objects(fields) => each(value, path, |value, path| match path {
                JsonPointer(Some(JsonPointer(_, Part::Name("bufferViews"))), Part::Place(place))
                    if self.replaced_views.get(*place) == Some(&true) =>
                {
                    Ok(())
                }
                _ => self.value(value, &MemberKind::Object(fields), path),
            }),
            MemberKind::Attributes(is_read) => self.attributes(value, *is_read, path),
            MemberKind::Targets(is_read) => each(value, path, |value, path| self.attributes(value, *is_read, path)),
            MemberKind::Ids(is_read) => ids(value, *is_read, path),
        }
    }

    fn index(&self, value: &Value, list: &str, path: &JsonPointer) -> Result<(), GltfError> {
        let count = self.counts.get(list).copied().unwrap_or(0);
        match value.as_u64() {
            Some(index) if index < count => Ok(()),
            Some(index) => path.fail(format!("is {index}, but /{list} has {count}")),
            None => path.should_be("a whole number", value),
        }
    }

    /// Checks an object whose members are indices of accessors, and removes those that aren't read.
    fn attributes(&self, value: &mut Value, is_read: fn(&str) -> bool, path: &JsonPointer) -> Result<(), GltfError> {
        let Value::Object(attributes) = value else { return path.should_be("an object", value) };
        attributes.retain(|name, _| is_read(name));
        for (name, value) in attributes {
            self.index(value, "accessors", &JsonPointer(Some(path), Part::Name(name)))?;
        }
        Ok(())
    }
}

/// Checks an object whose members are ids of attributes. Those of attributes that aren't read may be anything.
fn ids(value: &Value, is_read: fn(&str) -> bool, path: &JsonPointer) -> Result<(), GltfError> {
    let Value::Object(ids) = value else { return path.should_be("an object", value) };
    let mut read = ids.iter().filter(|(name, _)| is_read(name));
    read.try_for_each(|(name, id)| whole(id, 0, u64::from(u32::MAX), &JsonPointer(Some(path), Part::Name(name))))
}

fn each(
    value: &mut Value,
    path: &JsonPointer,
    mut check: impl FnMut(&mut Value, &JsonPointer) -> Result<(), GltfError>,
) -> Result<(), GltfError> {
    let Value::Array(values) = value else { return path.should_be("a list", value) };
    for (place, value) in values.iter_mut().enumerate() {
        check(value, &JsonPointer(Some(path), Part::Place(place)))?;
    }
    Ok(())
}

fn whole(value: &Value, least: u64, most: u64, path: &JsonPointer) -> Result<(), GltfError> {
    match value.as_u64() {
        Some(number) if (least..=most).contains(&number) => Ok(()),
        Some(number) if number < least => path.fail(format!("is {number}, but must be at least {least}")),
        Some(number) => path.fail(format!("is {number}, but must be at most {most}")),
        None => path.should_be("a whole number", value),
    }
}

/// The least and the greatest f32.
const NUMBER: [f64; 2] = [f32::MIN as f64, f32::MAX as f64];

fn numbers(value: &mut Value, count: Option<usize>, range: [f64; 2], path: &JsonPointer) -> Result<(), GltfError> {
    if let (Some(values), Some(count)) = (value.as_array(), count)
        && values.len() != count
    {
        return path.fail(format!("should have {count} numbers but has {}", values.len()));
    }
    each(value, path, |value, path| number(value, range, path))
}

fn number(value: &Value, [least, most]: [f64; 2], path: &JsonPointer) -> Result<(), GltfError> {
    match value.as_f64() {
        Some(number) if number < least => path.fail(format!("is {value}, but must be at least {:?}", least as f32)),
        Some(number) if number > most => path.fail(format!("is {value}, but must be at most {:?}", most as f32)),
        Some(_) => Ok(()),
        None => path.should_be("a number", value),
    }
}

fn one_of<T: ToString>(choices: &[T]) -> String {
    let choices: Vec<String> = choices.iter().map(T::to_string).collect();
    match choices.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
        _ => choices.concat(),
    }
}

/// Formats a value for a message, short and on one line.
pub(super) fn shown(value: &Value) -> String {
    match value {
        Value::Array(values) => format!("a list of {}", values.len()),
        Value::Object(_) => "an object".to_owned(),
        Value::String(text) => format!("{:?}", crate::uri::shown(text)),
        other => other.to_string(),
    }
}

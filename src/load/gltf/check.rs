//! Holds a document against a [schema](super::schema) before anything else reads it, and drops what isn't in that.

use std::collections::HashMap;
use std::fmt;

use serde_json::{Map, Value};

use super::Problem;
use super::schema::{Field, Kind};

/// Checks a document, member by member, and leaves nothing in it that the schema doesn't name.
///
/// # Errors
/// [`Problem::Document`] for the first member that isn't what it should be.
pub fn check(document: &mut Map<String, Value>, schema: &'static [Field]) -> Result<(), Problem> {
    let count = |field: &Field| Some((field.name, document.get(field.name)?.as_array()?.len() as u64));
    let checker = Checker { counts: schema.iter().filter_map(count).collect() };
    checker.object(document, schema, &Path(None, Part::Root))
}

/// A place in the document.
struct Path<'a>(Option<&'a Path<'a>>, Part<'a>);

enum Part<'a> {
    Root,
    Name(&'a str),
    Place(usize),
}

impl fmt::Display for Path<'_> {
    /// As a JSON pointer (RFC 6901).
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

impl Path<'_> {
    fn fail<T>(&self, reason: String) -> Result<T, Problem> {
        Err(Problem::Document { pointer: self.to_string(), reason })
    }

    fn should_be<T>(&self, what: &str, value: &Value) -> Result<T, Problem> {
        self.fail(format!("should be {what} and is {}", shown(value)))
    }
}

struct Checker {
    /// How many elements each of the document's lists has.
    counts: HashMap<&'static str, u64>,
}

impl Checker {
    fn object(&self, object: &mut Map<String, Value>, fields: &'static [Field], path: &Path) -> Result<(), Problem> {
        // Null stands for nothing.
        object.retain(|name, value| !value.is_null() && fields.iter().any(|field| field.name == name));
        for field in fields {
            let path = Path(Some(path), Part::Name(field.name));
            match object.get_mut(field.name) {
                None if field.required => return path.fail("is missing".to_owned()),
                None => {}
                Some(Value::String(_)) if matches!(field.kind, Kind::Name) => {}
                Some(_) if matches!(field.kind, Kind::Name) => {
                    object.remove(field.name);
                }
                Some(value) => self.value(value, &field.kind, &path)?,
            }
        }
        Ok(())
    }

    fn value(&self, value: &mut Value, kind: &Kind, path: &Path) -> Result<(), Problem> {
        match kind {
            Kind::Index(list) => self.index(value, list, path),
            Kind::Indices(list) => each(value, path, |value, path| self.index(value, list, path)),
            Kind::Whole { least, most } => whole(value, *least, *most, path),
            Kind::Numbers(count) => numbers(value, *count, NUMBER, path),
            Kind::Within { count, least, most } => numbers(value, Some(*count), [*least, *most], path),
            Kind::Number => number(value, NUMBER, path),
            Kind::Text | Kind::Name => {
                if value.is_string() {
                    Ok(())
                } else {
                    path.should_be("text", value)
                }
            }
            Kind::Flag => {
                if value.is_boolean() {
                    Ok(())
                } else {
                    path.should_be("true or false", value)
                }
            }
            Kind::Code(codes) => match value.as_u64() {
                Some(code) if codes.contains(&code) => Ok(()),
                _ => path.should_be(&one_of(codes), value),
            },
            Kind::Word(words) => match value.as_str() {
                Some(word) if words.contains(&word) => Ok(()),
                _ => path.should_be(&one_of(words), value),
            },
            Kind::Object(fields) => match value {
                Value::Object(object) => self.object(object, fields, path),
                other => path.should_be("an object", other),
            },
            Kind::Objects(fields) => each(value, path, |value, path| self.value(value, &Kind::Object(fields), path)),
            Kind::Attributes(is_read) => self.attributes(value, *is_read, path),
            Kind::Targets(is_read) => each(value, path, |value, path| self.attributes(value, *is_read, path)),
            Kind::Interner => ids(value, path),
        }
    }

    fn index(&self, value: &Value, list: &str, path: &Path) -> Result<(), Problem> {
        let count = self.counts.get(list).copied().unwrap_or(0);
        match value.as_u64() {
            Some(index) if index < count => Ok(()),
            Some(index) => path.fail(format!("is {index}, and /{list} has {count}")),
            None => path.should_be("a whole number", value),
        }
    }

    /// An object whose members are accessors; keeps those that are read.
    fn attributes(&self, value: &mut Value, is_read: fn(&str) -> bool, path: &Path) -> Result<(), Problem> {
        let Value::Object(attributes) = value else { return path.should_be("an object", value) };
        attributes.retain(|name, _| is_read(name));
        for (name, value) in attributes {
            self.index(value, "accessors", &Path(Some(path), Part::Name(name)))?;
        }
        Ok(())
    }
}

fn ids(value: &Value, path: &Path) -> Result<(), Problem> {
    let Value::Object(ids) = value else { return path.should_be("an object", value) };
    ids.iter().try_for_each(|(name, id)| whole(id, 0, u64::from(u32::MAX), &Path(Some(path), Part::Name(name))))
}

fn each(
    value: &mut Value,
    path: &Path,
    mut check: impl FnMut(&mut Value, &Path) -> Result<(), Problem>,
) -> Result<(), Problem> {
    let Value::Array(values) = value else { return path.should_be("a list", value) };
    for (place, value) in values.iter_mut().enumerate() {
        check(value, &Path(Some(path), Part::Place(place)))?;
    }
    Ok(())
}

fn whole(value: &Value, least: u64, most: u64, path: &Path) -> Result<(), Problem> {
    match value.as_u64() {
        Some(number) if (least..=most).contains(&number) => Ok(()),
        Some(number) if number < least => path.fail(format!("is {number}, and {least} is the least")),
        Some(number) => path.fail(format!("is {number}, and {most} is the most")),
        None => path.should_be("a whole number", value),
    }
}

/// The least and the most that an f32 holds.
const NUMBER: [f64; 2] = [f32::MIN as f64, f32::MAX as f64];

fn numbers(value: &mut Value, count: Option<usize>, range: [f64; 2], path: &Path) -> Result<(), Problem> {
    if let (Some(values), Some(count)) = (value.as_array(), count)
        && values.len() != count
    {
        return path.fail(format!("should be {count} numbers and has {}", values.len()));
    }
    each(value, path, |value, path| number(value, range, path))
}

fn number(value: &Value, [least, most]: [f64; 2], path: &Path) -> Result<(), Problem> {
    match value.as_f64() {
        Some(number) if number < least => path.fail(format!("is {value}, and {:?} is the least", least as f32)),
        Some(number) if number > most => path.fail(format!("is {value}, and {:?} is the most", most as f32)),
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

/// A value, short and on one line.
fn shown(value: &Value) -> String {
    match value {
        Value::Array(values) => format!("a list of {}", values.len()),
        Value::Object(_) => "an object".to_owned(),
        Value::String(text) => format!("{:?}", crate::load::uri::shown(text)),
        other => other.to_string(),
    }
}

//! Compares a document with a [schema](super::schema) before anything else reads it, and removes what isn't in the
//! schema.

use std::cell::RefCell;
use std::collections::{BTreeMap, HashMap};
use std::fmt;
use std::ops::Bound;

use serde_json::{Map, Value};

use super::GltfError;
use super::schema::{Field, MemberKind};
use geometry::names::joined;

/// A member that has a value that it can't have.
#[derive(Clone, Debug)]
pub(crate) struct Fault {
    pub pointer: String,
    /// What is wrong, as a clause.
    pub reason: String,
}

impl From<Fault> for GltfError {
    fn from(Fault { pointer, reason }: Fault) -> Self {
        Self::Document { pointer, reason }
    }
}

/// What is wrong in a document, by place. What the schema doesn't require was removed there.
#[derive(Debug, Default)]
pub(crate) struct Faults(pub BTreeMap<String, String>);

impl Faults {
    /// Returns the first fault of a place, or of what is in it.
    pub(crate) fn at(&self, place: fmt::Arguments) -> Option<Fault> {
        if self.0.is_empty() {
            return None;
        }
        let place = &place.to_string()[..];
        // What is in a place comes before other places that begin alike.
        let (pointer, reason) = self.0.range::<str, _>((Bound::Included(place), Bound::Unbounded)).next()?;
        let rest = pointer.strip_prefix(place)?;
        let fault = || Fault { pointer: pointer.clone(), reason: reason.clone() };
        (rest.is_empty() || rest.starts_with('/')).then(fault)
    }

    /// # Errors
    /// The first fault of an element of one of the document's lists.
    pub(crate) fn check(&self, list: &str, i: usize) -> Result<(), Fault> {
        self.at(format_args!("/{list}/{i}")).map_or(Ok(()), Err)
    }
}

/// Checks a document, member by member, and removes all members that the schema doesn't name, and those that are wrong.
///
/// # Errors
/// A member that is wrong and that there is no document without.
pub(super) fn check(document: &mut Map<String, Value>, schema: &'static [Field]) -> Result<Faults, Fault> {
    let count = |field: &Field| Some((field.name, document.get(field.name)?.as_array()?.len() as u64));
    let checker = Checker { counts: schema.iter().filter_map(count).collect(), faults: RefCell::default() };
    checker.object(document, schema, &JsonPointer(None, Part::Root))?;
    Ok(checker.faults.into_inner())
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
    fn fail<T>(&self, reason: String) -> Result<T, Fault> {
        Err(Fault { pointer: self.to_string(), reason })
    }

    fn should_be<T>(&self, what: &str, value: &Value) -> Result<T, Fault> {
        self.fail(format!("should be {what} but is {}", shown(value)))
    }
}

/// Checks objects of one document.
struct Checker {
    /// The number of elements of each of the document's lists.
    counts: HashMap<&'static str, u64>,
    faults: RefCell<Faults>,
}

impl Checker {
    fn object(&self, object: &mut Map<String, Value>, fields: &[Field], path: &JsonPointer) -> Result<(), Fault> {
        // Null stands for a missing member.
        object.retain(|name, value| {
            let field = fields.iter().find(|field| field.name == name).filter(|_| !value.is_null());
            field.is_some_and(|field| !matches!(field.kind, MemberKind::Name) || value.is_string())
        });
        for field in fields {
            let path = JsonPointer(Some(path), Part::Name(field.name));
            let checked = match object.get_mut(field.name) {
                None if field.required => path.fail("is missing".to_owned()),
                None => Ok(()),
                Some(value) => self.value(value, &field.kind, &path),
            };
            if field.required {
                checked?;
            } else if let Err(fault) = checked {
                object.remove(field.name);
                self.keep(fault);
            }
        }
        Ok(())
    }

    fn keep(&self, fault: Fault) {
        self.faults.borrow_mut().0.insert(fault.pointer, fault.reason);
    }

    fn value(&self, value: &mut Value, kind: &MemberKind, path: &JsonPointer) -> Result<(), Fault> {
        let fits = |is: bool, what: &str| if is { Ok(()) } else { path.should_be(what, value) };
        match kind {
            MemberKind::Index(list) => self.index(value, list, path),
            MemberKind::Whole { least, most } => whole(value, *least, *most, path),
            MemberKind::Numbers(count) => numbers(value, *count, path),
            MemberKind::Text | MemberKind::Name => fits(value.is_string(), "text"),
            MemberKind::Flag => fits(value.is_boolean(), "true or false"),
            MemberKind::Code(codes) if value.as_u64().is_some_and(|own| codes.contains(&own)) => Ok(()),
            MemberKind::Code(codes) => path.should_be(&joined(codes, "or"), value),
            MemberKind::Word(words) if value.as_str().is_some_and(|own| words.contains(&own)) => Ok(()),
            MemberKind::Word(words) => path.should_be(&joined(words, "or"), value),
            MemberKind::Object(fields) => self.fields(value, fields, path),
            MemberKind::List(kind) => each(value, path, |value, path| self.value(value, kind, path)),
            MemberKind::Parts(fields, empty) => each(value, path, |value, path| {
                if let Err(fault) = self.fields(value, fields, path) {
                    self.keep(fault);
                    *value = serde_json::from_str(empty).unwrap_or_default();
                }
                Ok(())
            }),
            MemberKind::Attributes(is_read) => self.attributes(value, *is_read, path),
            MemberKind::Ids(is_read) => ids(value, *is_read, path),
        }
    }

    fn fields(&self, value: &mut Value, fields: &[Field], path: &JsonPointer) -> Result<(), Fault> {
        match value {
            Value::Object(object) => self.object(object, fields, path),
            other => path.should_be("an object", other),
        }
    }

    fn index(&self, value: &Value, list: &str, path: &JsonPointer) -> Result<(), Fault> {
        let count = self.counts.get(list).copied().unwrap_or(0);
        match value.as_u64() {
            Some(index) if index < count => Ok(()),
            Some(index) => path.fail(format!("is {index}, but /{list} has {count}")),
            None => path.should_be("a whole number", value),
        }
    }

    /// Checks an object whose members are indices of accessors, and removes those that aren't read or are wrong.
    fn attributes(&self, value: &mut Value, is_read: fn(&str) -> bool, path: &JsonPointer) -> Result<(), Fault> {
        let Value::Object(attributes) = value else { return path.should_be("an object", value) };
        attributes.retain(|name, value| {
            let is_here = is_read(name) && !value.is_null();
            let path = JsonPointer(Some(path), Part::Name(name));
            is_here && self.index(value, "accessors", &path).map_err(|fault| self.keep(fault)).is_ok()
        });
        Ok(())
    }
}

/// Checks an object whose members are ids of attributes. Those of attributes that aren't read may be anything.
fn ids(value: &Value, is_read: fn(&str) -> bool, path: &JsonPointer) -> Result<(), Fault> {
    let Value::Object(ids) = value else { return path.should_be("an object", value) };
    let mut read = ids.iter().filter(|(name, _)| is_read(name));
    read.try_for_each(|(name, id)| whole(id, 0, u64::from(u32::MAX), &JsonPointer(Some(path), Part::Name(name))))
}

fn each(
    value: &mut Value,
    path: &JsonPointer,
    mut check: impl FnMut(&mut Value, &JsonPointer) -> Result<(), Fault>,
) -> Result<(), Fault> {
    let Value::Array(values) = value else { return path.should_be("a list", value) };
    for (place, value) in values.iter_mut().enumerate() {
        check(value, &JsonPointer(Some(path), Part::Place(place)))?;
    }
    Ok(())
}

fn whole(value: &Value, least: u64, most: u64, path: &JsonPointer) -> Result<(), Fault> {
    let Some(number) = value.as_u64() else { return path.should_be("a whole number", value) };
    within(value, (least, number < least), (most, number > most), path)
}

fn numbers(value: &mut Value, count: Option<usize>, path: &JsonPointer) -> Result<(), Fault> {
    if let (Some(values), Some(count)) = (value.as_array(), count)
        && values.len() != count
    {
        return path.fail(format!("should have {count} numbers but has {}", values.len()));
    }
    each(value, path, |value, path| {
        let Some(number) = value.as_f64() else { return path.should_be("a number", value) };
        within(value, (f32::MIN, number < f32::MIN.into()), (f32::MAX, number > f32::MAX.into()), path)
    })
}

/// Checks a number; each limit comes with whether the number is beyond it.
fn within<T: fmt::Debug>(value: &Value, least: (T, bool), most: (T, bool), path: &JsonPointer) -> Result<(), Fault> {
    match (least, most) {
        ((least, true), _) => path.fail(format!("is {value}, but must be at least {least:?}")),
        (_, (most, true)) => path.fail(format!("is {value}, but must be at most {most:?}")),
        _ => Ok(()),
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

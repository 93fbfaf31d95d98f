//! Reads objects of a document whose faults don't keep the model from loading: materials, textures and samplers. What is wrong
//! with a member becomes a sentence, and the member's default is used.

use std::cell::RefCell;
use std::fmt::Display;

use serde_json::{Map, Value};

use super::notes::Notes;
use super::schema_check::shown;
use geometry::casts::to_f32;

/// An object, and where in the document it is.
pub(super) struct Members<'a> {
    object: &'a Map<String, Value>,
    pointer: String,
    notes: &'a RefCell<Notes>,
}

impl<'a> Members<'a> {
    /// Looks at a value, which should be an object; returns none if it is something else, which becomes a sentence.
    pub(super) fn new(value: &'a Value, pointer: String, notes: &'a RefCell<Notes>) -> Option<Self> {
        match value {
            Value::Object(object) => Some(Self { object, pointer, notes }),
            other => {
                notes.borrow_mut().push(format!("{pointer} is {}, not an object; it is left out.", shown(other)));
                None
            }
        }
    }

    /// Returns the names of all members.
    pub(super) fn names(&self) -> impl Iterator<Item = &'a str> {
        self.object.keys().map(String::as_str)
    }

    /// Returns a member that isn't null.
    fn get(&self, name: &str) -> Option<&'a Value> {
        self.object.get(name).filter(|value| !value.is_null())
    }

    pub(super) fn has(&self, name: &str) -> bool {
        self.get(name).is_some()
    }

    fn note(&self, name: &str, fault: impl Display, repair: impl Display) {
        self.notes.borrow_mut().push(format!("{}/{name} {fault}; {repair}.", self.pointer));
    }

    /// Returns the object in a member.
    pub(super) fn inside(&self, name: &str) -> Option<Self> {
        Self::new(self.get(name)?, format!("{}/{name}", self.pointer), self.notes)
    }

    /// Returns the text in a member; none if it is something else.
    pub(super) fn text(&self, name: &str) -> Option<&'a str> {
        self.get(name)?.as_str()
    }

    /// Returns whether a member is true.
    pub(super) fn flag(&self, name: &str) -> bool {
        let Some(value) = self.get(name) else { return false };
        value.as_bool().unwrap_or_else(|| {
            self.note(name, format_args!("is {}, not true or false", shown(value)), "false is used");
            false
        })
    }

    /// Returns a number from `least` to `most`; a number beyond is replaced by the nearest.
    pub(super) fn number(&self, name: &str, default: f32, range: [f32; 2]) -> f32 {
        self.get(name).map_or(default, |value| self.within(name, value, default, range))
    }

    /// Returns the numbers of a list of length N. Each may be from `least` to `most`.
    pub(super) fn numbers<const N: usize>(&self, name: &str, default: [f32; N], range: [f32; 2]) -> [f32; N] {
        let Some(value) = self.get(name) else { return default };
        let Some(values) = value.as_array().filter(|values| values.len() == N) else {
            self.note(name, format_args!("is {}, not {N} numbers", shown(value)), format_args!("{default:?} is used"));
            return default;
        };
        let mut numbers = default;
        for (i, (number, value)) in numbers.iter_mut().zip(values).enumerate() {
            *number = self.within(&format!("{name}/{i}"), value, default[i], range);
        }
        numbers
    }

    fn within(&self, name: &str, value: &Value, default: f32, [least, most]: [f32; 2]) -> f32 {
        let Some(number) = value.as_f64() else {
            self.note(name, format_args!("is {}, not a number", shown(value)), format_args!("{default} is used"));
            return default;
        };
        let (which, limit) = match number {
            _ if number < f64::from(least) => ("least", least),
            _ if number > f64::from(most) => ("most", most),
            _ => return to_f32(number),
        };
        let fault = format!("is {value}, but must be at {which} {limit:?}");
        self.note(name, fault, format_args!("{} is used", short(limit)));
        limit
    }

    /// Returns which of some words a member is.
    pub(super) fn word(&self, name: &str, words: &[&'static str]) -> &'static str {
        let Some(value) = self.get(name) else { return words[0] };
        let known = value.as_str().and_then(|word| words.iter().find(|known| **known == word));
        known.copied().unwrap_or_else(|| {
            let fault = format!("is {}, not {}", shown(value), words.join(" or "));
            self.note(name, fault, format_args!("{} is used", words[0]));
            words[0]
        })
    }

    /// Returns the value of a code.
    pub(super) fn code<T: Copy>(&self, name: &str, codes: &[(u64, T)], default: T) -> T {
        let Some(value) = self.get(name) else { return default };
        let known = value.as_u64().and_then(|code| codes.iter().find(|(known, _)| *known == code));
        if known.is_none() {
            let known: Vec<_> = codes.iter().map(|(code, _)| code.to_string()).collect();
            self.note(name, format_args!("is {}, not {}", shown(value), known.join(" or ")), "the default is used");
        }
        known.map_or(default, |(_, value)| *value)
    }

    /// Returns the n of a TEXCOORD_n; none if the member is missing or no such number.
    pub(super) fn uv_set(&self, name: &str) -> Option<usize> {
        let value = self.get(name)?;
        let set = value.as_u64().and_then(|set| u32::try_from(set).ok());
        if set.is_none() {
            self.note(name, format_args!("is {}, not a whole number up to {}", shown(value), u32::MAX), "0 is used");
        }
        Some(set.unwrap_or(0) as usize)
    }

    /// Returns an index into one of the document's lists; none without one, or if the list doesn't have it.
    pub(super) fn index(&self, name: &str, list: &str, count: usize) -> Option<usize> {
        let value = self.get(name)?;
        match value.as_u64().and_then(|index| usize::try_from(index).ok()) {
            Some(index) if index < count => return Some(index),
            Some(_) => self.note(name, format_args!("is {value}, but /{list} has {count}"), "it is left out"),
            None => self.note(name, format_args!("is {}, not a whole number", shown(value)), "it is left out"),
        }
        None
    }

    /// Adds a sentence about this object.
    pub(super) fn say(&self, clause: &str) {
        self.notes.borrow_mut().push(format!("{} {clause}.", self.pointer));
    }
}

/// Takes a list out of a document; what is something else becomes a sentence that ends like this.
pub(super) fn take_list(
    root: &mut Map<String, Value>,
    name: &str,
    otherwise: &str,
    notes: &RefCell<Notes>,
) -> Vec<Value> {
    match root.remove(name) {
        Some(Value::Array(values)) => values,
        None | Some(Value::Null) => Vec::new(),
        Some(other) => {
            notes.borrow_mut().push(format!("/{name} is {}, not a list; {otherwise}.", shown(&other)));
            Vec::new()
        }
    }
}

/// Formats a number without a long row of zeros.
fn short(number: f32) -> String {
    if number.abs() < 1e6 { number.to_string() } else { format!("{number:e}") }
}

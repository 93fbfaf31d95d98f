//! Chooses the scene of a document that is shown.

use serde_json::{Map, Value};

use super::json::list;
use super::notes::Notes;
use super::schema_check::shown;

/// Returns the names of a document's scenes, and which of them is shown: the one that is wanted, if the document has it;
/// otherwise its default scene, or its first one. The document names that scene afterwards. Without scenes all nodes are shown.
pub(super) fn choose(
    root: &mut Map<String, Value>,
    wanted: Option<&str>,
    notes: &mut Notes,
) -> (Vec<String>, Option<usize>) {
    let names = names(list(root, "scenes"), "scene");
    let own = root.remove("scene").filter(|own| !own.is_null());
    let default = own.as_ref().and_then(Value::as_u64).and_then(|own| usize::try_from(own).ok());
    let default = default.filter(|own| *own < names.len());
    if let (Some(own), None) = (own, default) {
        let what = if names.is_empty() { "all nodes are" } else { "the first scene is" };
        notes.push(format!("/scene is {}, but /scenes has {}; {what} shown.", shown(&own), names.len()));
    }
    let wanted = wanted.and_then(|wanted| number(&names, wanted));
    let shown = wanted.or(default).or((!names.is_empty()).then_some(0));
    if let Some(shown) = shown {
        root.insert("scene".to_owned(), shown.into());
    }
    (names, shown)
}

/// Returns the names of some objects, of which one that is missing is made of what they are and the number.
pub(super) fn names(list: &[Value], what: &str) -> Vec<String> {
    let name = |(i, own): (usize, &Value)| match own.get("name").and_then(Value::as_str) {
        Some(name) => name.to_owned(),
        None => format!("{what} {i}"),
    };
    list.iter().enumerate().map(name).collect()
}

/// Returns which of some scenes a text means: the first of that name, or else the one of that number, counted from 0.
pub(crate) fn number(names: &[String], text: &str) -> Option<usize> {
    let named = names.iter().position(|name| name == text);
    named.or_else(|| text.parse().ok().filter(|number| *number < names.len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_come_before_numbers() {
        let names = ["1", "hall", "hall"].map(str::to_owned);
        assert_eq!(
            ["1", "hall", "2", "3", "-1", "Hall"].map(|text| number(&names, text)),
            [Some(0), Some(1), Some(2), None, None, None]
        );
    }
}

//! The cases of the corpus: files, and changes of files.

use std::path::{Path, PathBuf};

use documents::package;
use load::environment_file::is_environment;
use load::format::Format;
use serde_json::{Map, Value};

/// A file to read, named by its path from the folder of the crate, such as `corpus/obj/odd/a-byte-order-mark.obj`.
pub(crate) struct Case {
    pub(crate) path: String,
    source: Source,
}

enum Source {
    File(PathBuf),
    /// The name of another file, as `of`, and what is changed in it (see [`change`]).
    Change(Map<String, Value>),
}

/// Returns the cases of a folder such as `corpus/obj/odd`, sorted by name: its files, without those that they name, and the
/// entries of its `changes.json`. None if there is no such folder.
pub(crate) fn cases(folder: &str) -> Vec<Case> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let is_case = |name: &str| Format::from_name(Path::new(name)).is_some() || is_environment(Path::new(name));
    let mut cases = Vec::new();
    for entry in std::fs::read_dir(&here).into_iter().flatten() {
        let file = entry.expect("a file of the corpus").path();
        let name = file.file_name().and_then(|name| name.to_str()).expect("a name in UTF-8");
        let name = name.strip_suffix(".zst").unwrap_or(name);
        if is_case(name) || folder.contains("factors") {
            cases.push(Case { path: format!("{folder}/{name}"), source: Source::File(file.clone()) });
        }
    }
    if let Ok(changes) = std::fs::read(here.join("changes.json")) {
        let changes: Map<String, Value> = serde_json::from_slice(&changes).expect("changes in JSON");
        let case = |(name, change): (String, Value)| {
            let Value::Object(change) = change else { panic!("{folder}: the change {name} is an object") };
            Case { path: format!("{folder}/{name}"), source: Source::Change(change) }
        };
        cases.extend(changes.into_iter().map(case));
    }
    cases.sort_by(|a, b| a.path.cmp(&b.path));
    cases
}

impl Case {
    /// Its bytes, which may be 100 MB.
    pub(crate) fn bytes(&self) -> Vec<u8> {
        match &self.source {
            Source::File(file) => {
                let bytes = std::fs::read(file).expect("a file of the corpus");
                let is_packed = file.extension().is_some_and(|ending| ending == "zst");
                if is_packed { zstd::decode_all(&bytes[..]).expect("Zstandard") } else { bytes }
            }
            Source::Change(changes) => self.changed(changes),
        }
    }

    fn changed(&self, changes: &Map<String, Value>) -> Vec<u8> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(&self.path).with_file_name("");
        let of = changes.get("of").and_then(Value::as_str);
        let mut text = of.map_or(String::new(), |of| std::fs::read_to_string(folder.join(of)).expect("a text"));
        for (place, new) in changes.iter().filter(|(place, _)| *place != "of") {
            text = change(&text, place, new).unwrap_or_else(|| panic!("{} has no {place}", self.path));
        }
        // The model within a package of 3MF.
        if self.path.ends_with(".3mf") { package::package(&text) } else { text.into_bytes() }
    }
}

/// Changes a text in one place. A place that begins with a slash is a JSON pointer, whose value becomes the new one; it may be
/// one behind the last of a list. Any other place is the first occurrence of this text, in whose place comes the text that
/// [`repeated`] gives. None if there is no such place.
fn change(text: &str, place: &str, new: &Value) -> Option<String> {
    let Some((parent, key)) = place.rsplit_once('/').filter(|_| place.starts_with('/')) else {
        return text.contains(place).then(|| text.replacen(place, &repeated(new), 1));
    };
    let mut root: Value = serde_json::from_str(text).ok()?;
    match root.pointer_mut(parent)? {
        Value::Array(values) => {
            let at: usize = key.parse().ok()?;
            values.resize(values.len().max(at + 1), Value::Null);
            values[at] = new.clone();
        }
        other => other.as_object_mut()?.insert(key.to_owned(), new.clone()).map_or((), drop),
    }
    Some(root.to_string())
}

/// A text is itself; `["x{i} ", 3, 5]` is "x3 x4 "; any other list is what its parts are, one after another.
fn repeated(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Array(parts) => match &parts[..] {
            [Value::String(text), Value::Number(first), Value::Number(end)] => {
                let numbers = first.as_u64().unwrap_or_default()..end.as_u64().unwrap_or_default();
                match text.contains("{i}") {
                    true => numbers.map(|i| text.replace("{i}", &i.to_string())).collect(),
                    false => text.repeat(numbers.count()),
                }
            }
            parts => parts.iter().map(repeated).collect(),
        },
        other => panic!("{other} is a text or a list"),
    }
}

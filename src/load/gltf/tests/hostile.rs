//! Tests with hostile documents: each is refused with an error, or read with a warning, and none takes longer than a second in any
//! build.

mod alone;
mod containers;
mod data;
mod graphs;
mod members;
mod much;
mod packed;
mod resources;
mod seen;
mod unused;

use std::panic::catch_unwind;
use std::path::PathBuf;

use super::packed as draco;
use super::*;
use crate::hostile_files::{is_expected, mentions, page, unhung};
use crate::markdown::plain;

/// The expected answer to a document.
enum Gets {
    /// An error (see [`is_expected`]).
    Refused(String),
    /// A mesh, and a warning with these parts (see [`mentions`]).
    Repaired(&'static str),
    /// A mesh without warnings.
    Read,
}

/// A hostile document.
struct Case {
    name: &'static str,
    bytes: Vec<u8>,
    gets: Gets,
    /// The document's folder, if it names files.
    folder: PathBuf,
}

impl Case {
    fn new(name: &'static str, bytes: impl Into<Vec<u8>>, gets: Gets) -> Self {
        Self { name, bytes: bytes.into(), gets, folder: "nowhere".into() }
    }

    fn refused(name: &'static str, bytes: impl Into<Vec<u8>>, expected: &str) -> Self {
        Self::new(name, bytes, Gets::Refused(expected.to_owned()))
    }

    /// The document of a triangle with another value in one place.
    fn with(name: &'static str, pointer: &str, value: Value, expected: &str) -> Self {
        let mut draft = triangle();
        set(&mut draft.root, pointer, value);
        Self::refused(name, draft.document().to_string(), expected)
    }

    fn draft(name: &'static str, draft: &Draft, gets: Gets) -> Self {
        Self::new(name, draft.document().to_string(), gets)
    }

    /// Reads the document. Returns the answer for the page, or what is wrong with it.
    fn answer(&self) -> Result<String, String> {
        let (bytes, folder) = (self.bytes.clone(), self.folder.clone());
        let read = move || read(bytes, &folder, "hostile", Selection::default(), &Limits::default(), &Progress::new());
        let result = catch_unwind(|| unhung(read)).map_err(|_| "panics, or takes for ever".to_owned())?;
        let answer = match (result, &self.gets) {
            (Err(error), Gets::Refused(expected)) if is_expected(&error, expected) => error.to_string(),
            (Ok(mesh), Gets::Read) if mesh.warnings.is_empty() => "is read".to_owned(),
            (Ok(mesh), Gets::Repaired(parts)) => match mesh.warnings.iter().find(|warning| mentions(warning, parts)) {
                Some(warning) => format!("is read, with a warning: {warning}"),
                None => return Err(format!("is read, with {:?}", mesh.warnings)),
            },
            (Err(error), _) => return Err(format!("is refused: {error:?} {error}")),
            (Ok(mesh), _) => return Err(format!("is read, with {:?}", mesh.warnings)),
        };
        Ok(answer.replace(&self.folder.display().to_string(), "its folder"))
    }
}

/// Sets the value at a place of a document, which may be missing before.
fn set(root: &mut Value, pointer: &str, value: Value) {
    let (parent, key) = pointer.rsplit_once('/').expect("a pointer has a slash");
    match root.pointer_mut(parent).expect("the place above is there") {
        Value::Array(values) => values[key.parse::<usize>().expect("a number")] = value,
        other => other[key] = value,
    }
}

#[test]
fn hostile_documents_get_the_answers_in_the_table() {
    let folder = resources::Folder::new();
    let mut cases = containers::cases();
    cases.extend(members::cases());
    cases.extend(data::cases());
    cases.extend(graphs::cases());
    cases.extend(much::cases());
    cases.extend(packed::cases());
    cases.extend(resources::cases(&folder));
    cases.extend(seen::cases());
    cases.extend(unused::cases());
    let names: std::collections::HashSet<_> = cases.iter().map(|case| case.name).collect();
    assert!(cases.len() >= 130 && names.len() == cases.len(), "{} of {}", names.len(), cases.len());
    for (i, case) in cases.iter().enumerate() {
        let kind = if case.bytes.starts_with(b"glTF") { "glb" } else { "gltf" };
        page::keep(&format!("gltf-{i:03}.{kind}"), &case.bytes);
    }
    let answers: Vec<_> = cases.iter().map(Case::answer).collect();
    let fault =
        |(case, answer): (&Case, &Result<String, String>)| Some(format!("{}: {}", case.name, answer.as_ref().err()?));
    let faults: Vec<_> = cases.iter().zip(&answers).filter_map(fault).collect();
    assert!(faults.is_empty(), "{} of {}:\n{}", faults.len(), cases.len(), faults.join("\n"));
    let is_refused = |name| cases.iter().any(|case| case.name == name && matches!(case.gets, Gets::Refused(_)));
    for name in alone::ALONE.iter().flat_map(|(_, names)| *names) {
        assert!(is_refused(*name), "{name} isn't refused");
    }
    // Some sentences contain the system's own messages.
    #[cfg(target_os = "linux")]
    {
        let row = |(case, answer): (&Case, Result<String, String>)| Some((plain(case.name), answer.ok()?));
        let rows: Vec<_> = cases.iter().zip(answers).filter_map(row).collect();
        let whys = alone::ALONE.iter().flat_map(|(why, names)| names.iter().map(move |name| (plain(name), *why)));
        page::hold_with("gltf.md", "Hostile glTF files", &rows, &whys.collect::<Vec<_>>());
    }
}

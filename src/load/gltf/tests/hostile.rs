//! Documents made to do harm, and what each gets: a refusal, word for word, or a repair that is told. None takes longer than
//! a second, in any build.

mod containers;
mod data;
mod graphs;
mod members;
mod much;
mod packed;
mod resources;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::time::Duration;

use super::packed as draco;
use super::*;
use crate::load::hostile_files::{page, time};
use crate::markdown::plain;

/// What a document gets.
enum Gets {
    /// This sentence, and no mesh.
    Refused(String),
    /// A mesh, and this sentence among its warnings.
    Repaired(&'static str),
    /// A mesh, and no word.
    Read,
}

/// A hostile document.
struct Case {
    name: &'static str,
    bytes: Vec<u8>,
    gets: Gets,
    /// Where it lies, if it names files.
    folder: PathBuf,
}

impl Case {
    fn new(name: &'static str, bytes: impl Into<Vec<u8>>, gets: Gets) -> Self {
        Self { name, bytes: bytes.into(), gets, folder: "nowhere".into() }
    }

    fn refused(name: &'static str, bytes: impl Into<Vec<u8>>, sentence: &str) -> Self {
        Self::new(name, bytes, Gets::Refused(sentence.to_owned()))
    }

    /// A triangle in which one place says something else.
    fn with(name: &'static str, pointer: &str, value: Value, sentence: &str) -> Self {
        let mut draft = triangle();
        set(&mut draft.root, pointer, value);
        Self::refused(name, draft.document().to_string(), sentence)
    }

    fn draft(name: &'static str, draft: &Draft, gets: Gets) -> Self {
        Self::new(name, draft.document().to_string(), gets)
    }

    /// Its name, and what it gets, on a page.
    fn row(&self) -> (String, String) {
        let gets = match &self.gets {
            Gets::Refused(sentence) => sentence.replace(&self.folder.display().to_string(), "its folder"),
            Gets::Repaired(sentence) => format!("is read, with a warning: {sentence}"),
            Gets::Read => "is read".to_owned(),
        };
        (plain(self.name), gets)
    }

    /// What is wrong with what it gets. A machine may be busy once; nothing takes too long three times by chance.
    fn fault(&self) -> Option<String> {
        let fault = self.attempt()?;
        if fault.starts_with(SLOW) { self.attempt().and_then(|_| self.attempt()) } else { Some(fault) }
    }

    fn attempt(&self) -> Option<String> {
        let start = time();
        let read = || read(self.bytes.clone(), &self.folder, "hostile", &Limits::default(), &Progress::new());
        let result = catch_unwind(AssertUnwindSafe(read));
        let took = time() - start;
        let fault = match (result, &self.gets) {
            (Err(_), _) => "panics".to_owned(),
            (Ok(Err(problem)), Gets::Refused(sentence)) if problem.to_string() == *sentence => return too_long(took),
            (Ok(Ok(mesh)), Gets::Repaired(sentence)) if mesh.warnings.iter().any(|said| said == sentence) => {
                return too_long(took);
            }
            (Ok(Ok(mesh)), Gets::Read) if mesh.warnings.is_empty() => return too_long(took),
            (Ok(Err(problem)), _) => format!("is refused: {problem}"),
            (Ok(Ok(mesh)), _) => format!("is read, with {:?}", mesh.warnings),
        };
        Some(fault)
    }
}

const SLOW: &str = "takes";

fn too_long(took: Duration) -> Option<String> {
    (took > Duration::from_secs(1)).then(|| format!("{SLOW} {took:?}"))
}

/// Sets a place of a document, also one that isn't there yet.
fn set(root: &mut Value, pointer: &str, value: Value) {
    let (parent, key) = pointer.rsplit_once('/').expect("a pointer has a slash");
    match root.pointer_mut(parent).expect("the place above is there") {
        Value::Array(values) => values[key.parse::<usize>().expect("a number")] = value,
        other => other[key] = value,
    }
}

#[test]
fn hostile_documents_get_what_the_table_says() {
    let folder = resources::Folder::new();
    let mut cases = containers::cases();
    cases.extend(members::cases());
    cases.extend(data::cases());
    cases.extend(graphs::cases());
    cases.extend(much::cases());
    cases.extend(packed::cases());
    cases.extend(resources::cases(&folder));
    let names: std::collections::HashSet<_> = cases.iter().map(|case| case.name).collect();
    assert!(cases.len() >= 130 && names.len() == cases.len(), "{} of {}", names.len(), cases.len());
    let faults: Vec<_> = cases.iter().filter_map(|case| Some(format!("{}: {}", case.name, case.fault()?))).collect();
    assert!(faults.is_empty(), "{} of {}:\n{}", faults.len(), cases.len(), faults.join("\n"));
    // The system's words are in it.
    #[cfg(target_os = "linux")]
    page::hold("gltf.md", "Hostile glTF files", &cases.iter().map(Case::row).collect::<Vec<_>>());
}

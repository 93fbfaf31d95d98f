//! A table of broken files, with the error or the warning that each gets.

mod fbx;
mod obj;
mod off;
mod ply;
mod stl;
mod threemf;

use std::borrow::Cow;

use super::{is_expected, mentions, page, read};
use crate::Format;

enum Gets {
    /// An error (see [`is_expected`]).
    Refused(&'static str),
    /// The same, and why, although two of three other programs show triangles of it.
    Alone(&'static str, &'static str),
    /// A mesh with so many triangles, and a warning with these parts (see [`mentions`]).
    Repaired(usize, &'static str),
}
use Gets::{Alone, Refused, Repaired};

/// Why a file whose only face has a vertex that doesn't exist has no triangle.
const ABSENT: &str =
    "the only face has a vertex that isn't in the file, and other programs draw another vertex in its place";

type Case = (Format, Cow<'static, [u8]>, Gets);

fn case(format: Format, text: impl Into<Cow<'static, str>>, gets: Gets) -> Case {
    let bytes = match text.into() {
        Cow::Borrowed(text) => Cow::Borrowed(text.as_bytes()),
        Cow::Owned(text) => Cow::Owned(text.into_bytes()),
    };
    (format, bytes, gets)
}

#[test]
fn every_hostile_file_gets_its_error_or_warning() {
    // Whole files of FBX and 3MF differ in few bytes, so words say in which.
    let named = |cases: Vec<(&'static str, Case)>| cases.into_iter().map(|(name, case)| (Some(name), case));
    let texts = obj::cases().into_iter().chain(stl::cases()).chain(ply::cases()).chain(off::cases());
    let all = named(fbx::cases()).chain(texts.map(|case| (None, case))).chain(named(threemf::cases()));
    let (names, cases): (Vec<Option<&str>>, Vec<Case>) = all.unzip();
    assert!(cases.len() >= 200, "{}", cases.len());
    for (i, (format, bytes, _)) in cases.iter().enumerate() {
        page::keep(&format!("others-{i:03}.{format:?}").to_lowercase(), bytes);
    }
    let answers: Vec<_> = cases.iter().map(answer).collect();
    let wrong: Vec<_> = answers.iter().filter_map(|answer| answer.as_ref().err()).map(String::as_str).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let name = |(own, (format, bytes, _)): (&Option<&str>, &Case)| match own {
        Some(name) => format!("{}: {name}", format.title()),
        None => format!("{} {}", format.title(), page::shown(bytes)),
    };
    let names: Vec<_> = names.iter().zip(&cases).map(name).collect();
    let alone = names.iter().zip(&cases).filter_map(|(name, case)| match case.2 {
        Alone(_, why) => Some((name.clone(), why)),
        _ => None,
    });
    let alone: Vec<_> = alone.collect();
    let rows: Vec<_> = names.into_iter().zip(answers).filter_map(|(name, answer)| Some((name, answer.ok()?))).collect();
    page::hold_with("others.md", "Hostile FBX, OBJ, STL, PLY, OFF and 3MF files", &rows, &alone);
}

/// Reads a file. Returns the answer for the page, or what is wrong with it.
fn answer((format, bytes, gets): &Case) -> Result<String, String> {
    let result = read(*format, bytes);
    match (&result, gets) {
        (Err(error), Refused(expected) | Alone(expected, _)) if is_expected(error, expected) => {
            return Ok(error.to_string());
        }
        (Ok(loaded), Repaired(triangles, parts)) if loaded.mesh.triangles.len() == *triangles => {
            if let Some(warning) = loaded.warnings.iter().find(|warning| mentions(warning, parts)) {
                return Ok(format!("is read, with a warning: {warning}"));
            }
        }
        _ => {}
    }
    let got = result.map(|loaded| (loaded.mesh.triangles.len(), loaded.warnings)).map_err(|error| format!("{error:?}"));
    let (Refused(expected) | Alone(expected, _) | Repaired(_, expected)) = gets;
    let start = String::from_utf8_lossy(&bytes[..bytes.len().min(60)]);
    Err(format!("{format:?} {start:?}\n  got {got:?}\n  instead of {expected:?}"))
}

//! One broken file after another, with the sentence that it gets.

mod obj;
mod ply;
mod stl;

use std::borrow::Cow;

use super::{Format, page, read};

enum Gets {
    /// The problem's message.
    Refused(&'static str),
    /// So many triangles, and a warning that contains this.
    Mended(usize, &'static str),
}
use Gets::{Mended, Refused};

type Case = (Format, Cow<'static, [u8]>, Gets);

fn case(format: Format, text: impl Into<Cow<'static, str>>, gets: Gets) -> Case {
    let bytes = match text.into() {
        Cow::Borrowed(text) => Cow::Borrowed(text.as_bytes()),
        Cow::Owned(text) => Cow::Owned(text.into_bytes()),
    };
    (format, bytes, gets)
}

#[test]
fn every_hostile_file_gets_its_sentence() {
    let cases: Vec<Case> = obj::cases().into_iter().chain(stl::cases()).chain(ply::cases()).collect();
    assert!(cases.len() >= 90, "{}", cases.len());
    let rows: Vec<_> = cases.iter().map(row).collect();
    let wrong: Vec<String> = cases.into_iter().filter_map(wrong).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    page::hold("others.md", "Hostile OBJ, STL and PLY files", &rows);
}

/// What it is, and what it gets, on a page.
fn row((format, bytes, gets): &Case) -> (String, String) {
    let gets = match gets {
        Refused(sentence) => (*sentence).to_owned(),
        Mended(_, warning) => format!("is read, with a warning: {warning}"),
    };
    (format!("{} {}", format!("{format:?}").to_uppercase(), page::shown(bytes)), gets)
}

/// What a file got in place of what it was to get.
fn wrong((format, bytes, gets): Case) -> Option<String> {
    let result = read(format, &bytes);
    let is_right = match (&result, &gets) {
        (Err(fault), Refused(expected)) => fault.to_string() == *expected,
        (Ok(loaded), Mended(triangles, warning)) => {
            loaded.mesh.triangles.len() == *triangles && loaded.warnings.iter().any(|said| said.contains(warning))
        }
        _ => false,
    };
    let got = result.map(|loaded| (loaded.mesh.triangles.len(), loaded.warnings)).map_err(|fault| fault.to_string());
    let (Refused(expected) | Mended(_, expected)) = gets;
    let start = String::from_utf8_lossy(&bytes[..bytes.len().min(60)]);
    (!is_right).then(|| format!("{format:?} {start:?}\n  got {got:?}\n  in place of {expected:?}"))
}

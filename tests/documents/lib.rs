//! Files that tests write and then read, and the repository's own pages.

pub mod cages;
pub mod lamp;
pub mod moving;
pub mod package;
pub mod panoramas;
pub mod scenes;
pub mod shot;
pub mod webp;

use std::path::{Path, PathBuf};

/// A file of the repository, such as a page of the manual that a test compares with what it says.
pub fn in_repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path)
}

/// Holds a part of a page of the repository, between two comments, to what it should be; `PNAEN_UPDATE_PAGES=1` writes it.
///
/// # Panics
/// If the page lacks the comments, or has something else between them.
pub fn assert_part_of_page(page: &str, name: &str, part: &str) {
    let path = in_repository(page);
    let text = std::fs::read_to_string(&path).expect("the page");
    let (begin, end) = (format!("<!-- {name} -->\n"), format!("<!-- end of {name} -->\n"));
    let (before, rest) = text.split_once(&begin).expect("where the part begins");
    let (there, after) = rest.split_once(&end).expect("where the part ends");
    if std::env::var_os("PNAEN_UPDATE_PAGES").is_some() {
        std::fs::write(&path, format!("{before}{begin}{part}{end}{after}")).expect("the page can be written");
        return;
    }
    assert_eq!(there, part, "{page} is out of date; PNAEN_UPDATE_PAGES=1 writes it");
}

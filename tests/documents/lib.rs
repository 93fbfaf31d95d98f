//! Files that tests write and then read, and the repository's own pages.

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

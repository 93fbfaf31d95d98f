//! What the readers of all formats are told of a file besides its bytes.

use std::path::Path;

use super::selection::Selection;
use crate::files::Limits;
use geometry::progress::Progress;

/// A model's file that is read.
#[derive(Clone, Copy)]
pub(super) struct ModelFile<'a> {
    /// Where the files are looked for that it names.
    pub folder: &'a Path,
    /// What the mesh is called.
    pub name: &'a str,
    /// What of it is read, and how. A variant or a scene that it doesn't have is left aside.
    pub selected: Selection<'a>,
    /// Those of the files that it names, and of the memory of the whole load.
    pub limits: Limits,
    pub progress: &'a Progress,
}

#[cfg(test)]
impl<'a> ModelFile<'a> {
    /// A file that is read whole, in a folder that isn't there.
    pub(super) fn from_test(name: &'a str, progress: &'a Progress) -> Self {
        Self { folder: Path::new("nowhere"), name, selected: Selection::default(), limits: Limits::default(), progress }
    }
}

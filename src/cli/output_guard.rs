//! What a command writes is apart from what it reads: no file that it was given is replaced, and none is written twice. Where
//! nothing could be written, that is said before there is anything to write.

use std::path::{Path, PathBuf};

use super::CliError;
use crate::load::{HeightSource, Source};
use crate::names::shown_path;

/// # Errors
/// A file to be written is read as well, or written already; or there is no folder for it.
pub(super) fn keep_apart<'a>(
    read: impl IntoIterator<Item = Option<&'a Path>>,
    written: impl IntoIterator<Item = Option<&'a Path>>,
) -> Result<(), CliError> {
    let mut taken: Vec<(PathBuf, &'static str)> =
        read.into_iter().flatten().filter_map(|path| Some((place(path)?, "read"))).collect();
    for path in written.into_iter().flatten() {
        if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty() && !folder.is_dir()) {
            return Err(CliError::NoFolder { path: shown_path(path), folder: shown_path(folder) });
        }
        let Some(place) = place(path) else { continue };
        if let Some((_, by)) = taken.iter().find(|(other, _)| *other == place) {
            return Err(CliError::Taken { path: shown_path(path), by });
        }
        taken.push((place, "written"));
    }
    Ok(())
}

/// The file of a mesh that has one.
pub(super) fn file_of(source: &Source) -> Option<&Path> {
    match source {
        Source::File(path) => Some(path),
        Source::Shape(..) | Source::FineShape(..) => None,
    }
}

/// The same of heights.
pub(super) fn file_of_heights(heights: Option<&HeightSource>) -> Option<&Path> {
    match heights? {
        HeightSource::File(path) => Some(path),
        HeightSource::Materials => None,
    }
}

/// Where a path leads, also if nothing is there yet; none for what isn't a file, as `-` and devices aren't.
fn place(path: &Path) -> Option<PathBuf> {
    if path.as_os_str() == "-" {
        return None;
    }
    match path.canonicalize() {
        Ok(real) => real.is_file().then_some(real),
        Err(_) => {
            let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
            Some(folder.canonicalize().ok()?.join(path.file_name()?))
        }
    }
}

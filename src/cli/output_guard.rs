//! Checks a command's paths before it works: it must not replace a file that it reads or write a file twice, and the folders
//! of its outputs must exist.

use std::path::{Path, PathBuf};

use super::{CliError, file_error, refuse};
use geometry::names::shown_path;
use load::{HeightSource, Source};

/// Checks that the files to be written are different from each other and from those to be read.
pub(super) fn keep_apart<'a>(
    read: impl IntoIterator<Item = Option<&'a Path>>,
    written: impl IntoIterator<Item = Option<&'a Path>>,
) -> Result<(), CliError> {
    let mut taken: Vec<(PathBuf, &'static str)> =
        read.into_iter().flatten().filter_map(|path| Some((place(path)?, "read"))).collect();
    for path in written.into_iter().flatten() {
        refuse(path.as_os_str().is_empty(), "an output has no name; name a file")?;
        if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty() && !folder.is_dir()) {
            return Err(CliError::NoFolder { path: shown_path(path), folder: shown_path(folder) });
        }
        if path.is_dir() {
            return Err(file_error(path, "written", &"it is a folder; name a file").into());
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
        Source::Shape(..) | Source::FineShape(..) | Source::Vase => None,
    }
}

/// The files of height maps.
pub(super) fn files_of_heights(heights: &[HeightSource]) -> impl Iterator<Item = Option<&Path>> {
    heights.iter().flat_map(HeightSource::files).map(Some)
}

/// Returns the canonical path of a file, even if it doesn't exist yet. Returns none for `-` and for devices.
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

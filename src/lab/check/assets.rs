//! Finds the assets to check: files, shapes, and all meshes in folders.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use inspect::shot::ShotError;
use inspect::shot::files::file_error;
use load::Source;
use load::files::file_reason;
use load::format::Format;
use walkdir::{DirEntry, WalkDir};

/// Returns the files and shapes as they are given, and in place of each folder the files in and below it whose names say that they
/// are meshes, in the order of their paths. Hidden files and folders are left out, and links to folders in folders, which could
/// lead in a circle. A file that is named several times comes once.
///
/// # Errors
/// A folder can't be looked through.
pub fn assets(given: &[Source]) -> Result<Vec<Source>, ShotError> {
    let (mut all, mut known) = (Vec::new(), HashSet::new());
    for source in given {
        let found = match source {
            Source::File(path) if path.is_dir() => meshes_in(path)?.into_iter().map(Source::File).collect(),
            other => vec![other.clone()],
        };
        let place = |source: &Source| match source {
            Source::File(path) => path.canonicalize().unwrap_or_else(|_| path.clone()),
            shape => PathBuf::from(shape.to_string()),
        };
        all.extend(found.into_iter().filter(|source| known.insert(place(source))));
    }
    Ok(all)
}

fn meshes_in(folder: &Path) -> Result<Vec<PathBuf>, ShotError> {
    let unreadable = |error: walkdir::Error| {
        let place = error.path().unwrap_or(folder).to_owned();
        file_error(&place, "read", &file_reason(&error.into()))
    };
    let is_shown = |entry: &DirEntry| entry.depth() == 0 || !entry.file_name().as_encoded_bytes().starts_with(b".");
    let mut files = Vec::new();
    for entry in WalkDir::new(folder).sort_by_file_name().into_iter().filter_entry(is_shown) {
        let entry = entry.map_err(unreadable)?;
        let path = entry.path();
        // A link to a file that is gone is an asset that can't be opened.
        let is_lost = entry.path_is_symlink() && !path.exists();
        if Format::from_name(path).is_some() && (path.is_file() || is_lost) {
            files.push(entry.into_path());
        }
    }
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_are_looked_through_and_files_come_once() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = |name: &str| folder.path().join(name);
        std::fs::create_dir_all(path("deep/er")).expect("a writable folder");
        std::fs::create_dir(path(".hidden")).expect("a writable folder");
        for name in ["b.obj", "a.GLB", "deep/er/c.stl", "notes.txt", ".d.obj", ".hidden/e.obj"] {
            std::fs::write(path(name), "").expect("a writable folder");
        }
        #[cfg(unix)]
        std::os::unix::fs::symlink(folder.path(), path("deep/circle")).expect("a link");
        #[cfg(unix)]
        std::os::unix::fs::symlink(path("gone.glb"), path("lost.glb")).expect("a link");
        let given =
            [Source::File(path("b.obj")), Source::File(folder.path().into()), Source::File(path("missing.obj"))];
        let found = assets(&given).expect("readable folders");
        let expected = ["b.obj", "a.GLB", "deep/er/c.stl", "lost.glb", "missing.obj"];
        let expected = expected.into_iter().filter(|name| cfg!(unix) || *name != "lost.glb");
        assert_eq!(found, expected.map(|name| Source::File(path(name))).collect::<Vec<_>>());
    }
}

//! The file of the saved state: where it is, and what happens if it can't be read.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use etcetera::BaseStrategy;

use super::Persistence;
use super::saved_state::SavedState;
use geometry::progress::Progress;
use load::files::{FileError, Limits, read_file, write_whole};

/// The environment variable that names another folder. If it is empty, nothing is saved.
const FOLDER: &str = "PNAEN_CONFIG";
const NAME: &str = "window.json";
/// The new name of a file that can't be parsed.
const SET_ASIDE: &str = "window.damaged.json";
/// The greatest number of bytes that are read, several times as many as are ever written.
const MAX_BYTES: u64 = 16 << 20;

/// The user's folder for the file; none if there is no such folder, or nothing is to be saved.
pub(crate) fn folder() -> Option<PathBuf> {
    match std::env::var_os(FOLDER) {
        Some(folder) => Some(PathBuf::from(folder)).filter(|folder| !folder.as_os_str().is_empty()),
        None => Some(etcetera::choose_base_strategy().ok()?.config_dir().join("pnaen")),
    }
}

/// Reads the saved state from a folder. A file that can't be parsed is renamed, and one that can't be read is never replaced.
pub(super) fn read(folder: &Path) -> Persistence {
    let place = folder.join(NAME);
    let shown = place.display();
    let alone = |said| Persistence { said: Some(said), ..Persistence::default() };
    let unread = |why: String| alone(format!("{shown} can't be read, so settings won't be saved this time ({why})"));
    match std::fs::metadata(&place) {
        Err(error) if error.kind() == ErrorKind::NotFound => {
            return Persistence { place: Some(place), ..Persistence::default() };
        }
        Err(error) => return unread(error.to_string()),
        // Reading a pipe might never end.
        Ok(file) if !file.is_file() => return unread("it is not a file".into()),
        Ok(_) => {}
    }
    let limits = Limits { file: MAX_BYTES, ..Limits::default() };
    let kept = match read_file(&place, &limits, |_| Ok::<(), FileError>(()), &Progress::new()) {
        Ok(bytes) => SavedState::read(&bytes),
        Err(FileError::Io { source, .. }) => return unread(source.to_string()),
        Err(_) => None,
    };
    if let Some(kept) = kept {
        return Persistence { kept, place: Some(place), ..Persistence::default() };
    }
    let aside = folder.join(SET_ASIDE);
    match std::fs::rename(&place, &aside) {
        Ok(()) => {
            let said =
                format!("{shown} is damaged. It was renamed to {SET_ASIDE}, and all settings have their defaults");
            Persistence { place: Some(place), said: Some(said), ..Persistence::default() }
        }
        Err(error) => {
            alone(format!("{shown} is damaged and can't be renamed, so settings won't be saved this time ({error})"))
        }
    }
}

/// Writes the state, and makes the folder if it doesn't exist.
///
/// # Errors
/// Why it can't be written, as a sentence.
pub(super) fn write(place: &Path, kept: &SavedState) -> Result<(), String> {
    let folder = place.parent().map_or(Ok(()), std::fs::create_dir_all);
    let written = folder.and_then(|()| write_whole(place, kept.written().as_bytes()));
    written.map_err(|error| format!("{}: settings could not be saved ({error})", place.display()))
}

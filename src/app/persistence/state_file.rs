//! Where the file is that the window's settings are kept in, and what is done if it can't be read.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use etcetera::BaseStrategy;

use super::saved_state::SavedState;
use crate::files::{FileError, Limits, read_file, write_whole};
use crate::progress::Progress;

/// Names another folder; empty, nothing is kept.
const FOLDER: &str = "PNAEN_CONFIG";
const NAME: &str = "window.json";
/// Where one goes that can't be understood.
const SET_ASIDE: &str = "window.damaged.json";
/// Bytes that are read at most: several times what is ever written.
const MAX_BYTES: u64 = 16 << 20;

/// The person's folder for it; none if there is none, or nothing is to be kept.
pub(crate) fn folder() -> Option<PathBuf> {
    match std::env::var_os(FOLDER) {
        Some(folder) => Some(PathBuf::from(folder)).filter(|folder| !folder.as_os_str().is_empty()),
        None => Some(etcetera::choose_base_strategy().ok()?.config_dir().join("pnaen")),
    }
}

/// What was found in a folder.
pub(super) struct Found {
    pub kept: SavedState,
    /// The file; none if it is better left alone.
    pub place: Option<PathBuf>,
    /// What went wrong, in a sentence.
    pub said: Option<String>,
}

/// Reads what is kept in a folder; a file that can't be understood is set aside there.
pub(super) fn read(folder: &Path) -> Found {
    let place = folder.join(NAME);
    let shown = place.display();
    let alone = |said| Found { kept: SavedState::default(), place: None, said: Some(said) };
    let unread = |why: String| alone(format!("{shown} can't be read, so that nothing is kept this time ({why})"));
    match std::fs::metadata(&place) {
        Err(error) if error.kind() == ErrorKind::NotFound => {
            return Found { kept: SavedState::default(), place: Some(place), said: None };
        }
        Err(error) => return unread(error.to_string()),
        // Reading a pipe might never end.
        Ok(file) if !file.is_file() => return unread("it is no file".into()),
        Ok(_) => {}
    }
    let kept = match read_file(
        &place,
        &Limits { file: MAX_BYTES, ..Limits::default() },
        |_| Ok::<(), FileError>(()),
        &Progress::new(),
    ) {
        Ok(bytes) => SavedState::read(&bytes),
        Err(FileError::Io { source, .. }) => return unread(source.to_string()),
        Err(_) => None,
    };
    if let Some(kept) = kept {
        return Found { kept, place: Some(place), said: None };
    }
    let aside = folder.join(SET_ASIDE);
    match std::fs::rename(&place, &aside) {
        Ok(()) => {
            let said = format!("{shown} is damaged: it is {SET_ASIDE} now, and settings are as they first were");
            Found { kept: SavedState::default(), place: Some(place), said: Some(said) }
        }
        Err(error) => alone(format!("{shown} is damaged and can't be set aside: nothing is kept this time ({error})")),
    }
}

/// Writes what is kept, and makes the folder for it.
///
/// # Errors
/// What and why, in a sentence.
pub(super) fn write(place: &Path, kept: &SavedState) -> Result<(), String> {
    let folder = place.parent().map_or(Ok(()), std::fs::create_dir_all);
    let written = folder.and_then(|()| write_whole(place, kept.written().as_bytes()));
    written.map_err(|error| format!("{}: settings could not be kept ({error})", place.display()))
}

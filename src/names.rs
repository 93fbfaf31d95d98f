//! Names that someone else gave, of files and in them, as they are shown: on one line, and no longer than anyone reads. And what
//! the system says of files, in words that tell what to do.

use std::io::{self, ErrorKind};
use std::path::Path;

/// Characters of a name that are shown, at most.
const MOST: usize = 200;

/// Without anything that a terminal would obey.
pub fn on_one_line(text: &str) -> String {
    text.replace(char::is_control, "\u{fffd}")
}

/// A text in so many characters at most.
pub fn shortened(name: &str, most: usize) -> String {
    if name.chars().count() <= most {
        return name.to_owned();
    }
    name.chars().take(most.saturating_sub(1)).chain(['…']).collect()
}

/// A name as it is shown.
pub fn shown(name: &str) -> String {
    shortened(&on_one_line(name), MOST)
}

/// A path as it is shown: of a long one the end, which names the file.
pub fn shown_path(path: &Path) -> String {
    let path = on_one_line(&path.display().to_string());
    let surplus = path.chars().count().saturating_sub(MOST);
    if surplus == 0 { path } else { ['…'].into_iter().chain(path.chars().skip(surplus + 1)).collect() }
}

/// Why a file couldn't be read or written.
pub fn file_reason(error: &io::Error) -> String {
    match error.kind() {
        // Somebody has said it already.
        _ if error.raw_os_error().is_none() => error.to_string(),
        ErrorKind::NotFound => "there is no such file or folder; check its path".to_owned(),
        ErrorKind::PermissionDenied => {
            "the system doesn't allow it; change its permissions or choose another".to_owned()
        }
        ErrorKind::ReadOnlyFilesystem => "nothing can be written there; choose another folder".to_owned(),
        ErrorKind::StorageFull => "there is no room left; delete something or choose another disk".to_owned(),
        ErrorKind::IsADirectory => "it is a folder; name a file".to_owned(),
        ErrorKind::NotADirectory => "a part of its path is no folder; check its path".to_owned(),
        _ => error.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_system_says_what_to_do() {
        let missing = std::fs::read("no/such/file").expect_err("it isn't there");
        assert_eq!(file_reason(&missing), "there is no such file or folder; check its path");
        assert_eq!(file_reason(&io::Error::other("it is a device")), "it is a device");
    }

    #[test]
    fn names_are_on_one_line_and_short() {
        assert_eq!(shown("\x1b[2Jred\nblue\u{9b}é"), "\u{fffd}[2Jred\u{fffd}blue\u{fffd}é");
        assert_eq!([shortened("Walk", 4), shortened("Walking", 4)], ["Walk", "Wal…"]);
        let long = shown(&"ä".repeat(1000));
        assert!(long.chars().count() == MOST && long.ends_with("ä…"));
        let path = shown_path(Path::new(&format!("{}/a\x07.glb", "b/".repeat(500))));
        assert!(path.chars().count() == MOST && path.starts_with("…") && path.ends_with("/a\u{fffd}.glb"), "{path}");
        assert_eq!(shown_path(Path::new("a b/c.glb")), "a b/c.glb");
    }
}

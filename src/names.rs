//! Names and paths that a file or a person gave, made fit to be shown: on one line, and no longer than anyone reads.

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

#[cfg(test)]
mod tests {
    use super::*;

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

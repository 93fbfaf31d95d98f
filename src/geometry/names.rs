//! Makes names and paths from files or users fit for display: one line each, and of limited length.

use std::path::Path;

/// Every variant of an enum, as an array in the given order. It doesn't compile if one is missing.
#[macro_export]
macro_rules! every {
    ($type:ident: $($variant:ident),+ $(,)?) => {{
        const _: fn($type) = |value| match value {
            $($type::$variant => {})+
        };
        [$($type::$variant),+]
    }};
}
pub use every;

/// The greatest length of a displayed name or path, in characters.
const MAX_LENGTH: usize = 200;

/// Replaces every control character by U+FFFD, so that a name can neither break a line nor command a terminal.
pub fn on_one_line(text: &str) -> String {
    let reorders = |c| matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    text.replace(|c: char| c.is_control() || reorders(c), "\u{fffd}")
}

/// Cuts a text to at most `most` characters; a text that was cut ends in an ellipsis.
pub fn shortened(name: &str, most: usize) -> String {
    if name.chars().count() <= most {
        return name.to_owned();
    }
    name.chars().take(most.saturating_sub(1)).chain(['…']).collect()
}

/// Returns a name for display: on one line, with at most 200 characters.
pub fn shown(name: &str) -> String {
    shortened(&on_one_line(name), MAX_LENGTH)
}

/// Joins words with commas, and with another word before the last.
pub fn joined<T: ToString>(words: &[T], before_last: &str) -> String {
    let words: Vec<String> = words.iter().map(T::to_string).collect();
    match &words[..] {
        [all @ .., last] if !all.is_empty() => format!("{} {before_last} {last}", all.join(", ")),
        _ => words.concat(),
    }
}

/// Breaks a text between words into lines of at most `most` characters.
pub fn wrapped(text: &str, most: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= most => *line += &format!(" {word}"),
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// Returns a path for display: on one line, with at most 200 characters. A longer path loses its start, since its end
/// names the file.
pub fn shown_path(path: &Path) -> String {
    let path = on_one_line(&path.display().to_string());
    let surplus = path.chars().count().saturating_sub(MAX_LENGTH);
    if surplus == 0 { path } else { ['…'].into_iter().chain(path.chars().skip(surplus + 1)).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_on_one_line_and_short() {
        assert_eq!(shown("\x1b[2Jred\nblue\u{9b}é"), "\u{fffd}[2Jred\u{fffd}blue\u{fffd}é");
        assert_eq!(shown("gpj.\u{202e}exe\u{2066}"), "gpj.\u{fffd}exe\u{fffd}", "nothing turns the order around");
        assert_eq!([shortened("Walk", 4), shortened("Walking", 4)], ["Walk", "Wal…"]);
        let long = shown(&"ä".repeat(1000));
        assert!(long.chars().count() == MAX_LENGTH && long.ends_with("ä…"));
        let path = shown_path(Path::new(&format!("{}/a\x07.glb", "b/".repeat(500))));
        assert!(
            path.chars().count() == MAX_LENGTH && path.starts_with("…") && path.ends_with("/a\u{fffd}.glb"),
            "{path}"
        );
        assert_eq!(shown_path(Path::new("a b/c.glb")), "a b/c.glb");
    }
}

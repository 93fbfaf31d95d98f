//! Patterns of paths, as `.gitignore` files have them.

/// A pattern of paths below the configuration's folder. `*` stands for any characters but `/`, `?` for one of them, and `**/` for any
/// folders, also none. A pattern with a `/` before its end begins at that folder; any other is one of names, wherever they are. The
/// pattern of a folder stands for all that is in it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Pattern {
    text: String,
    /// What stands between `/`. Those of folders, and of files that might be folders, end in what may be in these.
    parts: Vec<String>,
}

impl Pattern {
    pub(super) fn new(text: &str) -> Self {
        let rooted = text.strip_prefix("./").or_else(|| text.strip_prefix('/'));
        let own = rooted.unwrap_or(text).trim_end_matches('/');
        let begins_anywhere = rooted.is_none() && !own.contains('/');
        let below: &[&str] = if text.ends_with('/') { &["*", "**"] } else { &["**"] };
        let parts = begins_anywhere.then_some("**").into_iter().chain(own.split('/')).chain(below.iter().copied());
        Self { parts: parts.map(str::to_owned).collect(), text: text.to_owned() }
    }

    /// The pattern as the configuration has it.
    pub(super) fn text(&self) -> &str {
        &self.text
    }

    /// Whether it stands for a path below the configuration's folder, with `/` between its folders.
    pub(super) fn matches(&self, path: &str) -> bool {
        let pattern: Vec<&str> = self.parts.iter().map(String::as_str).collect();
        let path: Vec<&str> = path.split('/').collect();
        folders_match(&pattern, &path)
    }
}

/// Matches part by part. In a table of which ends match, so that patterns with many stars take no longer than their length times
/// the path's.
fn folders_match(pattern: &[&str], path: &[&str]) -> bool {
    ends_match(
        pattern,
        path,
        |part| *part == "**",
        |part, name| {
            let [part, name]: [Vec<char>; 2] = [part, name].map(|text| text.chars().collect());
            ends_match(&part, &name, |c| *c == '*', |c, own| *c == '?' || c == own)
        },
    )
}

/// Whether a pattern matches a whole row of items. `is_star` tells what stands for any number of items, also none.
fn ends_match<T>(pattern: &[T], items: &[T], is_star: impl Fn(&T) -> bool, is_one: impl Fn(&T, &T) -> bool) -> bool {
    // Whether the rest of the pattern matches the items from each place on; at first the empty rest.
    let mut rest: Vec<bool> = (0..=items.len()).map(|from| from == items.len()).collect();
    for part in pattern.iter().rev() {
        let mut now = vec![false; items.len() + 1];
        for from in (0..=items.len()).rev() {
            now[from] = match is_star(part) {
                true => rest[from] || now.get(from + 1).copied().unwrap_or(false),
                false => from < items.len() && rest[from + 1] && is_one(part, &items[from]),
            };
        }
        rest = now;
    }
    rest[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_match_names_folders_and_paths() {
        for (pattern, path, expected) in [
            ("*.glb", "a.glb", true),
            ("*.glb", "props/old/a.glb", true),
            ("*.glb", "a.gltf", false),
            ("./props/*.glb", "props/a.glb", true),
            ("/props/*.glb", "props/a.glb", true),
            ("props/*.glb", "props/old/a.glb", false),
            ("props/*.glb", "old/props/a.glb", false),
            ("/a.glb", "a.glb", true),
            ("/a.glb", "props/a.glb", false),
            ("props", "props/old/a.glb", true),
            ("props", "old/props/a.glb", true),
            ("props/", "old/props/a.glb", true),
            ("old/props", "old/props/a.glb", true),
            ("old/props/", "old/props/new/a.glb", true),
            ("props", "old/props.glb", false),
            ("a.glb/", "props/a.glb", false),
            ("props/**/*.glb", "props/a.glb", true),
            ("props/**/*.glb", "props/very/old/a.glb", true),
            ("props/**", "props/very/old/a.glb", true),
            ("props/**", "other/a.glb", false),
            ("**/old/*", "props/old/a.glb", true),
            ("a?.*", "ab.glb", true),
            ("a?.*", "a.glb", false),
            ("", "a", false),
        ] {
            assert_eq!(Pattern::new(pattern).matches(path), expected, "{pattern} {path}");
        }
    }

    #[test]
    fn many_stars_take_no_longer() {
        let pattern = Pattern::new(&"*a".repeat(500));
        assert!(!pattern.matches(&"a".repeat(400)));
        assert!(pattern.matches(&"a".repeat(900)));
    }
}

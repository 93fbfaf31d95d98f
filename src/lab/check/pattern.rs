//! Patterns of paths, as `.gitignore` files have them.

use std::path::Path;

use ignore::gitignore::{Gitignore, GitignoreBuilder};

/// A pattern of paths below the configuration's folder.
#[derive(Clone, Debug)]
pub(super) struct Pattern {
    text: String,
    matcher: Gitignore,
}

impl Pattern {
    pub(super) fn parse(text: &str) -> Result<Self, ignore::Error> {
        let mut builder = GitignoreBuilder::new("");
        // The folder of the configuration may be named.
        match text.strip_prefix("./") {
            Some(below) => builder.add_line(None, &format!("/{below}"))?,
            None => builder.add_line(None, text)?,
        };
        Ok(Self { text: text.to_owned(), matcher: builder.build()? })
    }

    /// The pattern as the configuration has it.
    pub(super) fn text(&self) -> &str {
        &self.text
    }

    /// Whether it stands for a path below the configuration's folder, or for a folder that the path is in.
    pub(super) fn matches(&self, path: &str) -> bool {
        let path = Path::new(path);
        path.ancestors().any(|place| self.matcher.matched(place, place != path).is_ignore())
    }
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
            ("a[bc].glb", "ab.glb", true),
            ("*.glb", "somewhere/else/a.glb", true),
            ("else/", "somewhere/else/a.glb", true),
        ] {
            let parsed = Pattern::parse(pattern).expect("a pattern");
            assert_eq!(parsed.matches(path), expected, "{pattern} {path}");
        }
    }

    #[test]
    fn many_stars_take_no_longer() {
        let pattern = Pattern::parse(&"*a".repeat(500)).expect("a pattern");
        assert!(!pattern.matches(&"a".repeat(400)));
        assert!(pattern.matches(&"a".repeat(900)));
    }

    #[test]
    fn what_is_no_pattern_is_refused() {
        assert!(Pattern::parse("a[z-a].glb").is_err());
    }
}

//! The declarations of WGSL files, each with its comment, and which of them others need.

use std::collections::BTreeSet;

use gpu::wgsl_tokens::{declared, tokens};

/// A declaration of a WGSL file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Declaration {
    pub name: String,
    pub is_function: bool,
    /// The lines of the comment above it, with their `//`.
    pub comment: Vec<String>,
    /// The lines of its text, with its attributes.
    pub lines: Vec<String>,
}

impl Declaration {
    /// The comment and the text, with a line end.
    pub(super) fn text(&self) -> String {
        self.comment.iter().chain(&self.lines).flat_map(|line| [line, "\n"]).collect()
    }

    /// The names that its text may refer to: any word, and in front of a parenthesis a function.
    fn words(&self) -> impl Iterator<Item = (&str, bool)> {
        self.lines.iter().flat_map(|line| {
            let code = line.split("//").next().unwrap_or_default();
            words(code)
        })
    }
}

/// Returns the words of a line of code, and whether each is followed by an opening parenthesis.
pub(super) fn words(code: &str) -> impl Iterator<Item = (&str, bool)> {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let mut rest = code;
    std::iter::from_fn(move || {
        rest = &rest[rest.find(is_word)?..];
        let end = rest.find(|c| !is_word(c)).unwrap_or(rest.len());
        let (word, after) = rest.split_at(end);
        rest = after;
        Some((word, after.starts_with('(')))
    })
}

/// Splits a WGSL text into its declarations. Each starts a line, and ends with a line `}` or with a semicolon; a comment belongs to
/// the declaration that follows it without a blank line.
pub(super) fn declarations(text: &str) -> Vec<Declaration> {
    let mut found = Vec::new();
    let (mut comment, mut lines) = (Vec::new(), Vec::<String>::new());
    for line in text.lines() {
        if lines.is_empty() && (line.is_empty() || line.starts_with("//")) {
            if line.is_empty() {
                comment.clear();
            } else {
                comment.push(line.to_owned());
            }
            continue;
        }
        lines.push(line.to_owned());
        let head = lines.iter().find(|line| !line.starts_with("@compute")).map_or("", String::as_str);
        let is_block = head.starts_with("fn ") || head.starts_with("struct ");
        let is_attribute = head.is_empty();
        let is_whole = if is_block { line == "}" } else { !is_attribute && line.ends_with(';') };
        if is_whole {
            let is_function = head.starts_with("fn ");
            let name = declared(&tokens(head)).first().map_or("", |(_, name)| name.text).to_owned();
            let (comment, lines) = (std::mem::take(&mut comment), std::mem::take(&mut lines));
            found.push(Declaration { name, is_function, comment, lines });
        }
    }
    found
}

/// Returns the declarations that `roots` need, directly or through others, with the roots, in their order.
pub(super) fn needed(all: &[Declaration], roots: &[&str]) -> Vec<Declaration> {
    let mut wanted: BTreeSet<&str> = BTreeSet::new();
    let mut open: Vec<&str> = roots.to_vec();
    while let Some(name) = open.pop() {
        if !wanted.insert(name) {
            continue;
        }
        let Some(own) = all.iter().find(|declaration| declaration.name == name) else { continue };
        for (word, is_called) in own.words() {
            let is_needed = |other: &&Declaration| other.name == word && (is_called || !other.is_function);
            open.extend(all.iter().find(is_needed).map(|other| other.name.as_str()));
        }
    }
    all.iter().filter(|declaration| wanted.contains(declaration.name.as_str())).cloned().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "// About the file.\n\n// One.\nconst ONE: u32 = 1u;\n\n@group(0) @binding(0) var<storage, read> data: \
                        array<f32>;\n\n// Two\n// lines.\nfn two(one: u32) -> u32 {\n    // ONE is named here only.\n    return \
                        one + three(one);\n}\n\nfn three(x: u32) -> u32 {\n    return x * ONE;\n}\n\n@compute \
                        @workgroup_size(1)\nfn main() {\n    data[0] = 1.0;\n}\n";

    #[test]
    fn a_text_is_split_into_declarations_with_their_comments() {
        let found = declarations(TEXT);
        let names: Vec<_> = found.iter().map(|declaration| declaration.name.as_str()).collect();
        assert_eq!(names, ["ONE", "data", "two", "three", "main"]);
        assert_eq!(found[0].comment, ["// One."]);
        assert_eq!(found[2].text(), "// Two\n// lines.\n".to_owned() + &found[2].lines.join("\n") + "\n");
        assert_eq!(found[4].lines.len(), 4, "with its attributes");
    }

    #[test]
    fn only_what_is_needed_stays() {
        let names = |roots: &[&str]| -> Vec<String> {
            needed(&declarations(TEXT), roots).into_iter().map(|declaration| declaration.name).collect()
        };
        assert_eq!(names(&["two"]), ["ONE", "two", "three"]);
        assert_eq!(names(&["main"]), ["data", "main"]);
    }
}

//! The tokens of a WGSL text, as far as they are needed to rename declarations and to find loops.

/// A word, a number, or one character of punctuation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Token<'a> {
    pub text: &'a str,
    /// Where it starts, in bytes.
    pub at: usize,
}

impl Token<'_> {
    /// Whether it is a keyword or a name.
    pub fn is_word(&self) -> bool {
        self.text.starts_with(|c: char| c.is_alphabetic() || c == '_')
    }
}

/// Returns the length of the comment at the start of a text, in bytes; block comments nest. None if there is no comment there.
fn comment(text: &str) -> Option<usize> {
    if text.starts_with("//") {
        // Line breaks are those of WGSL, section 3.2.
        let ends_line = |c| matches!(c, '\n'..='\r' | '\u{85}' | '\u{2028}' | '\u{2029}');
        return Some(text.find(ends_line).unwrap_or(text.len()));
    }
    if !text.starts_with("/*") {
        return None;
    }
    let (mut depth, mut at) = (0_usize, 0);
    while let Some(found) = text[at..].find(['/', '*']) {
        at += found;
        let step = match text.get(at..at + 2) {
            Some("/*") => {
                depth += 1;
                2
            }
            Some("*/") => {
                depth -= 1;
                2
            }
            _ => 1,
        };
        at += step;
        if depth == 0 {
            return Some(at);
        }
    }
    Some(text.len())
}

/// Returns the tokens of a text, without comments.
pub fn tokens(text: &str) -> Vec<Token<'_>> {
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(first) = text[at..].chars().next() {
        let rest = &text[at..];
        let is_of_word = |c: char| c.is_alphanumeric() || c == '_';
        let length = if first.is_whitespace() {
            first.len_utf8()
        } else if let Some(length) = comment(rest) {
            length
        } else {
            let is_of_own = |c: char| is_of_word(c) || (first.is_ascii_digit() && c == '.');
            let length = match is_of_word(first) {
                true => rest.find(|c| !is_of_own(c)).unwrap_or(rest.len()),
                false => first.len_utf8(),
            };
            tokens.push(Token { text: &rest[..length], at });
            length
        };
        at += length;
    }
    tokens
}

/// Returns the names that a text declares outside of functions, structs and templates, each after its keyword.
pub fn declared<'a>(tokens: &[Token<'a>]) -> Vec<(Token<'a>, Token<'a>)> {
    let (mut names, mut depth) = (Vec::new(), 0_usize);
    for (index, token) in tokens.iter().enumerate() {
        match token.text {
            "{" => depth += 1,
            "}" => depth = depth.saturating_sub(1),
            "fn" | "struct" | "const" | "override" | "alias" if depth == 0 => {
                names.extend(tokens.get(index + 1).map(|name| (*token, *name)));
            }
            "var" if depth == 0 => {
                // The template of an address space may stand before the name.
                let template = tokens.get(index + 1).filter(|next| next.text == "<");
                let end = template.and_then(|_| tokens[index..].iter().position(|token| token.text == ">"));
                names.extend(tokens.get(index + end.unwrap_or(0) + 1).map(|name| (*token, *name)));
            }
            _ => {}
        }
    }
    names.retain(|(_, name)| name.is_word());
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_are_no_tokens_and_numbers_are_one() {
        let text = "a // loop {\n/* for /* while */ if */b_1+1.5e3u;\u{e9}t\u{e9}";
        let words: Vec<_> = tokens(text).iter().map(|token| token.text).collect();
        assert_eq!(words, ["a", "b_1", "+", "1.5e3u", ";", "\u{e9}t\u{e9}"]);
        assert!(tokens(text).iter().all(|token| text[token.at..].starts_with(token.text)));
        assert_eq!(tokens("x /* never closed").len(), 1);
        assert_eq!(tokens("x /").len(), 2);
    }

    #[test]
    fn declarations_are_found_outside_of_braces_only() {
        let text = "const A = 1; struct B { c: f32 } fn d(e: B) { const f = 2; var g = 3; } var<private> h: u32; \
                    @group(0) @binding(1) var<storage, read_write> i: B; alias j = f32; override k = 1; var l: sampler;";
        let names: Vec<_> = declared(&tokens(text)).iter().map(|(_, name)| name.text).collect();
        assert_eq!(names, ["A", "B", "d", "h", "i", "j", "k", "l"]);
    }
}

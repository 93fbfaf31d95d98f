//! What differs in the stages of an export where the surface is displaced: lines of the templates, and how heights are fetched.

use super::declarations::Declaration;
use super::translation::StageLanguage;

/// The function that reads a px of the height image. Every language has its own.
const FETCH: &str = "fetch_height";

/// Returns a template with the lines that a displaced surface needs (`@D@`), or with those of one that isn't displaced (`@N@`).
pub(super) fn chosen_lines(template: &str, is_displaced: bool) -> String {
    let [own, other] = if is_displaced { ["@D@", "@N@"] } else { ["@N@", "@D@"] };
    let lines = template.lines().filter(|line| !line.starts_with(other));
    lines.flat_map(|line| [line.strip_prefix(own).unwrap_or(line), "\n"]).collect()
}

/// Takes the body out of the function that reads a px, and the texture that it reads: naga writes only what its entry point uses.
pub(super) fn without_fetch(mut all: Vec<Declaration>) -> Vec<Declaration> {
    all.retain(|own| own.name != "heights");
    for own in all.iter_mut().filter(|own| own.name == FETCH) {
        own.lines.splice(1..own.lines.len() - 1, ["    return 0.0;".to_owned()]);
        own.comment.clear();
    }
    all
}

/// Puts the language's own function in the place of the one without a body.
pub(super) fn with_fetch(language: StageLanguage, text: &str) -> String {
    let start = text.find(&format!("float {FETCH}("));
    let end = start.and_then(|start| Some(start + text[start..].find("\n}\n")? + 3));
    let Some((start, end)) = start.zip(end) else { return text.to_owned() };
    let own = match language {
        StageLanguage::Glsl => include_str!("templates/fetch_height.glsl"),
        StageLanguage::Hlsl => include_str!("templates/fetch_height.hlsl"),
    };
    format!("{}{own}{}", &text[..start], &text[end..])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_template_has_the_lines_of_its_choice() {
        let template = "a\n@D@b\n@N@c\n    d\n";
        assert_eq!(chosen_lines(template, true), "a\nb\n    d\n");
        assert_eq!(chosen_lines(template, false), "a\nc\n    d\n");
    }

    #[test]
    fn the_languages_own_function_takes_the_place_of_the_one_without_a_body() {
        let text = "int one() {\n}\n\nfloat fetch_height(uint level) {\n    return 0.0;\n}\n\nint two() {\n}\n";
        let made = with_fetch(StageLanguage::Glsl, text);
        assert!(made.starts_with("int one() {\n}\n\n// One number a texel"), "{made}");
        assert!(made.contains("texelFetch") && !made.contains("return 0.0") && made.ends_with("}\n\nint two() {\n}\n"));
        assert_eq!(with_fetch(StageLanguage::Hlsl, "int one() {\n}\n"), "int one() {\n}\n");
    }
}

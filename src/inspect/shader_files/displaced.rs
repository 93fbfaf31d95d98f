//! What differs in the stages of an export where the surface is displaced: lines of the templates, and how heights are fetched.

use super::declarations::Declaration;
use super::translation::StageLanguage;
use geometry::tessellate::Tessellation;

/// The function that reads a px of the height image. Every language has its own.
const FETCH: &str = "fetch_height";

/// How the surface of an export is displaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Relief {
    Off,
    /// All edges have one factor, so that the level at a point follows from its shortest edge.
    UniformLod,
    /// Factors depend on the view: a compute shader finds the level at each point.
    LodByView,
}

/// The marks at the start of a template's lines.
const MARKS: [&str; 4] = ["@N@", "@D@", "@U@", "@V@"];

impl Relief {
    pub(super) fn new(own: &Tessellation) -> Self {
        match (own.displacement.is_on(), own.used_lod().follows_view()) {
            (false, _) => Self::Off,
            (true, false) => Self::UniformLod,
            (true, true) => Self::LodByView,
        }
    }

    /// The marks of its lines: `@N@` without displacement, `@D@` with it, and then also `@U@` under uniform LOD or `@V@` under
    /// LOD by the view.
    fn marks(self) -> &'static [&'static str] {
        match self {
            Self::Off => &["@N@"],
            Self::UniformLod => &["@D@", "@U@"],
            Self::LodByView => &["@D@", "@V@"],
        }
    }

    /// Returns a template with the lines that have no mark, or one of its own.
    pub(super) fn chosen_lines(self, template: &str) -> String {
        template.lines().filter_map(|line| self.user_text(line)).flat_map(|line| [line, "\n"]).collect()
    }

    /// Returns a line without its mark; `None` if that is another's.
    fn user_text(self, line: &str) -> Option<&str> {
        let marked = MARKS.iter().find_map(|mark| Some((mark, line.strip_prefix(mark)?)));
        marked.map_or(Some(line), |(mark, text)| self.marks().contains(mark).then_some(text))
    }
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
        let template = "a\n@D@b\n@N@c\n@U@    d\n@V@e\n    @F@f\n";
        assert_eq!(Relief::Off.chosen_lines(template), "a\nc\n    @F@f\n");
        assert_eq!(Relief::UniformLod.chosen_lines(template), "a\nb\n    d\n    @F@f\n");
        assert_eq!(Relief::LodByView.chosen_lines(template), "a\nb\ne\n    @F@f\n");
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

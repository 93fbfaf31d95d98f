//! What of a file is read, and how.

use std::collections::{BTreeMap, HashSet};

use super::import::Import;
use geometry::mesh::PartStyle;
use geometry::names::shown;
use geometry::tessellate::Surface;

/// Weights of morph targets of glTF, and of blend shapes of FBX, by their names. Targets of one name have one weight.
pub type MorphWeights = BTreeMap<String, f32>;

/// Which of a file's alternatives is read, and how its geometry is taken.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Selection<'a> {
    /// The material variant, by name; none for each primitive's own material.
    pub variant: Option<&'a str>,
    /// The scene, by name or by number from 0; none for the file's default scene.
    pub scene: Option<&'a str>,
    /// The parts; none for all of them, as the file has them.
    pub parts: Option<&'a ShownParts>,
    /// How the geometry is taken.
    pub import: Import,
}

impl Selection<'_> {
    /// Whether normals are made of everything: no part and no material has those of the file.
    pub(super) fn makes_all_normals(&self) -> bool {
        let mut styles = self.parts.iter().flat_map(|parts| &parts.styles).map(|(_, style)| *style);
        self.import.makes_normals_of(PartStyle::default()) && styles.all(|style| self.import.makes_normals_of(style))
    }

    /// The weight that was chosen for the morph targets of a name.
    pub(super) fn morph(&self, name: &str) -> Option<f32> {
        self.parts?.morphs.get(name).copied()
    }
}

/// Which parts of a file are read, how they differ, and in which shape they are.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShownParts {
    /// The names of parts and groups that are left out (see [`is_part_of`]).
    pub hidden: Vec<String>,
    /// The names of parts and groups that alone are read; all parts if there are none.
    pub only: Vec<String>,
    /// What parts, groups and materials have in place of what is said for all, by their names.
    pub styles: Vec<(String, PartStyle)>,
    /// The weights of morph targets that take the place of the file's at rest, and in clips that don't move them.
    pub morphs: MorphWeights,
}

impl ShownParts {
    /// Shows the parts of these names alone, or all parts without any.
    pub fn show_only(&mut self, names: Vec<String>) {
        (self.hidden, self.only) = (Vec::new(), names);
    }

    /// What a part has in place of what is said for all.
    pub fn style(&self, name: &str) -> PartStyle {
        let own = self.styles.iter().filter(|(other, _)| other == name);
        own.fold(PartStyle::default(), |others, (_, style)| style.or(others))
    }

    /// What parts have in place of what is said for all, as the command line has it.
    pub fn style_texts(&self) -> impl Iterator<Item = String> {
        self.styles.iter().map(|(name, style)| format!("{name}:{style}"))
    }

    /// Whether a part has a surface of its own that is Phong's, which has a strength.
    pub fn has_phong(&self) -> bool {
        self.styles.iter().any(|(_, style)| style.surface.is_some_and(Surface::is_phong))
    }

    /// Gives a part a style of its own, in the place of the one that it had.
    pub fn set_style(&mut self, name: &str, style: PartStyle) {
        let place = self.styles.iter().position(|(other, _)| other == name).unwrap_or(self.styles.len());
        self.styles.retain(|(other, _)| other != name);
        if style != PartStyle::default() {
            self.styles.insert(place, (name.to_owned(), style));
        }
    }

    /// Forgets what is said of a part or morph target. Returns whether anything was.
    pub fn forget(&mut self, name: &str) -> bool {
        let count = |own: &Self| own.hidden.len() + own.only.len() + own.styles.len() + own.morphs.len();
        let before = count(self);
        self.hidden.retain(|own| own != name);
        self.only.retain(|own| own != name);
        self.styles.retain(|(own, _)| own != name);
        self.morphs.remove(name);
        count(self) < before
    }

    /// The names of parts and groups that are left out, and of those that alone are read, for [`hides`].
    pub(super) fn names(&self) -> [Names; 2] {
        [&self.hidden, &self.only].map(Names::new)
    }
}

/// Whether a part is left out, by its path. The start of the path that has this length, unless that is 0, is a further level of
/// detail: it is shown only if a name means it, and not all of what it lies in.
pub(super) fn hides([hidden, only]: &[Names; 2], path: &str, level: usize) -> bool {
    let above = path[..level].rsplit_once('/').map_or("", |(above, _)| above);
    let is_named = || only.meaning(path).iter().any(|name| level == 0 || !is_part_of(above, name));
    let is_limited = level > 0 || only.0.iter().any(|name| is_material(name) == is_material(path));
    !hidden.meaning(path).is_empty() || is_limited && !is_named()
}

/// Names that a user gave, of which those that mean a part are found quickly among many.
#[derive(Debug, Default)]
pub(super) struct Names(HashSet<String>);

impl Names {
    pub(super) fn new<'a>(names: impl IntoIterator<Item = &'a String>) -> Self {
        Self(names.into_iter().cloned().collect())
    }

    /// Returns those that mean a part, by its path.
    pub(super) fn meaning(&self, path: &str) -> Vec<&String> {
        let text = format!("/{path}/.");
        let slashes: Vec<usize> = text.match_indices('/').map(|(slash, _)| slash).collect();
        let is_meant = |name: &&String| is_part_of(path, name);
        // If they are few, or the path is long, all names are compared with it.
        if self.0.len() <= slashes.len() * slashes.len() {
            return self.0.iter().filter(is_meant).collect();
        }
        let ends = || slashes.iter().copied().chain([text.len()]);
        let starts = [0].into_iter().chain(slashes.iter().map(|slash| slash + 1));
        let runs = starts.flat_map(|start| ends().filter(move |end| *end > start).map(move |end| start..end));
        runs.filter_map(|run| self.0.get(&text[run])).filter(is_meant).collect()
    }
}

/// What the path of a material begins with.
pub const MATERIAL: &str = "material:";

/// Whether a part's path or name is that of a material.
pub fn is_material(name: &str) -> bool {
    name.starts_with(MATERIAL)
}

/// Whether a name that a user gave means a part, by its path: some names of the path that follow one another. A name that begins
/// with a slash begins with the first one, and one that ends in `/.` ends with the last one: it means a part without what lies in
/// it.
pub fn is_part_of(path: &str, name: &str) -> bool {
    let begins = |rest: &str, name: &str| {
        let after = rest.strip_prefix(name);
        after.is_some_and(|after| after.is_empty() || after.starts_with('/')) || name.strip_prefix(rest) == Some("/.")
    };
    let is_later = || path.match_indices('/').any(|(slash, _)| begins(&path[slash + 1..], name));
    is_material(path) == is_material(name)
        && name.strip_prefix('/').map_or_else(|| begins(path, name) || is_later(), |name| begins(path, name))
}

/// Returns which of something there are, as the end of a message; `none` says that there are none.
pub fn choice(known: &[String], none: &str) -> String {
    const NAMED: usize = 20;
    let names: Vec<_> = known.iter().take(NAMED).map(|name| shown(name)).collect();
    match known.len().checked_sub(NAMED) {
        _ if known.is_empty() => none.to_owned(),
        None | Some(0) => format!("choose one of {}", names.join(", ")),
        Some(more) => format!("choose one of {} and {more} more, which `pnaen info` lists", names.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_style_takes_the_place_of_the_one_before_it() {
        let style = |text: &str| text.parse::<PartStyle>().expect("a style");
        let mut parts = ShownParts::default();
        for (name, own) in [("a", "detail=2"), ("b", "surface=flat"), ("a", "detail=4")] {
            parts.set_style(name, style(own));
        }
        assert_eq!(parts.styles, [("a".to_owned(), style("detail=4")), ("b".to_owned(), style("surface=flat"))]);
        parts.set_style("a", PartStyle::default());
        assert_eq!(parts.styles.len(), 1);
        parts.styles.push(("b".to_owned(), style("detail=1")));
        assert_eq!(parts.style("b"), style("surface=flat,detail=1"));
    }

    #[test]
    fn names_among_many_are_those_that_are_found_one_by_one() {
        let paths = ["a", "a/b", "b/a/b", "material:a/b", "a/a/c", "material:b"];
        let names =
            ["a", "b", "/a", "a/b", "/a/b", "b/.", "/b/.", "material:a/b", "material:b", "/material:b", ".", "a/"];
        // As many more that mean nothing.
        let names: Vec<String> =
            names.iter().map(|name| (*name).to_owned()).chain((0..100).map(|i| format!("x{i}"))).collect();
        let all = Names::new(&names);
        for path in paths {
            let found: HashSet<&String> = all.meaning(path).into_iter().collect();
            let expected: HashSet<&String> = names.iter().filter(|name| is_part_of(path, name)).collect();
            assert_eq!(found, expected, "{path}");
            assert!(!expected.is_empty(), "{path}");
        }
    }
}

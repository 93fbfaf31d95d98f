//! What of a file is read, and how.

use std::collections::BTreeMap;

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
    /// What parts have in place of what the tessellation says for all, by their names.
    pub styles: Vec<(String, PartStyle)>,
    /// The weights of morph targets that take the place of the file's at rest, and in clips that don't move them.
    pub morphs: MorphWeights,
}

impl ShownParts {
    /// Shows the parts of these names alone, or all parts without any.
    pub fn show_only(&mut self, names: Vec<String>) {
        (self.hidden, self.only) = (Vec::new(), names);
    }

    /// What a part has in place of what the tessellation says for all.
    pub fn style(&self, name: &str) -> PartStyle {
        self.styles.iter().rev().find(|(other, _)| other == name).map(|(_, style)| *style).unwrap_or_default()
    }

    /// Whether a part has a surface of its own that is Phong's, which has a strength.
    pub fn has_phong(&self) -> bool {
        self.styles.iter().any(|(_, style)| style.surface.is_some_and(Surface::is_phong))
    }

    /// Gives a part a style of its own.
    pub fn set_style(&mut self, name: &str, style: PartStyle) {
        self.styles.retain(|(other, _)| other != name);
        if style != PartStyle::default() {
            self.styles.push((name.to_owned(), style));
        }
    }

    /// Whether a part is left out, by its path. The start of the path that has this length, unless that is 0, is a further level
    /// of detail: it is shown only if a name means it, and not all of what it lies in.
    pub(super) fn hide(&self, path: &str, level: usize) -> bool {
        let above = path[..level].rsplit_once('/').map_or("", |(above, _)| above);
        let is_named = |name: &String| is_part_of(path, name) && (level == 0 || !is_part_of(above, name));
        let is_limited = level > 0 || self.only.iter().any(|name| is_material(name) == is_material(path));
        self.hidden.iter().any(|name| is_part_of(path, name)) || is_limited && !self.only.iter().any(is_named)
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
    is_material(path) == is_material(name) && format!("//{path}/./").contains(&format!("/{name}/"))
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

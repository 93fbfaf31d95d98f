//! What of a file is read, and how.

use std::collections::BTreeMap;

use super::import::Import;
use geometry::names::shown;

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

/// Which parts of a file are read, and in which shape.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShownParts {
    /// The names of parts that are left out.
    pub hidden: Vec<String>,
    /// The names of parts that alone are read; all parts if there are none.
    pub only: Vec<String>,
    /// The weights of morph targets that take the place of the file's at rest, and in clips that don't move them.
    pub morphs: MorphWeights,
}

impl ShownParts {
    /// Shows the parts of these names alone, or all parts without any.
    pub fn show_only(&mut self, names: Vec<String>) {
        (self.hidden, self.only) = (Vec::new(), names);
    }

    /// Shows a part, or leaves it out.
    pub fn set(&mut self, name: &str, is_shown: bool) {
        self.hidden.retain(|other| other != name);
        let is_listed = self.only.iter().any(|other| other == name);
        match is_shown {
            true if !self.only.is_empty() && !is_listed => self.only.push(name.to_owned()),
            true => {}
            // Without the last name all parts would be shown.
            false if self.only.len() > 1 => self.only.retain(|other| other != name),
            false => self.hidden.push(name.to_owned()),
        }
    }
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

//! What of a file is read, and how.

use super::import::Import;
use geometry::mesh::PartStyle;
use geometry::names::shown;

/// Which of a file's alternatives is read, and how its geometry is taken.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Selection<'a> {
    /// The material variant, by name; none for each primitive's own material.
    pub variant: Option<&'a str>,
    /// The scene, by name or by number from 0; none for the file's default scene.
    pub scene: Option<&'a str>,
    /// The names of parts that are left out.
    pub hidden: &'a [String],
    /// The names of parts that alone are read; all parts if there are none.
    pub only: &'a [String],
    /// What parts have in place of what the tessellation says for all, by their names.
    pub styles: &'a [(String, PartStyle)],
    /// How the geometry is taken.
    pub import: Import,
}

/// Which parts of a file are read, and how they differ.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShownParts {
    /// The names of parts that are left out.
    pub hidden: Vec<String>,
    /// The names of parts that alone are read; all parts if there are none.
    pub only: Vec<String>,
    /// What parts have in place of what the tessellation says for all, by their names.
    pub styles: Vec<(String, PartStyle)>,
}

impl ShownParts {
    /// The part of this name alone.
    pub fn alone(name: &str) -> Self {
        Self { only: vec![name.to_owned()], ..Self::default() }
    }

    /// These parts, as they differ here.
    #[must_use]
    pub fn styled_as(self, other: &Self) -> Self {
        Self { styles: other.styles.clone(), ..self }
    }

    /// What a part has in place of what the tessellation says for all.
    pub fn style(&self, name: &str) -> PartStyle {
        self.styles.iter().rev().find(|(other, _)| other == name).map(|(_, style)| *style).unwrap_or_default()
    }

    /// Gives a part a style of its own.
    pub fn set_style(&mut self, name: &str, style: PartStyle) {
        self.styles.retain(|(other, _)| other != name);
        if style != PartStyle::default() {
            self.styles.push((name.to_owned(), style));
        }
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

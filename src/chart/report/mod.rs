//! A page about what charts found: which method to use when, and a section for each mesh. All it says is computed from rows.

mod advice;
mod answers;
mod fronts;
mod limits;
mod lods;
mod section;

use std::fmt::Write;

use super::{Race, Subject};
use crate::markdown::plain;
use answers::tables;
use section::section;

/// The page's file, and that of its table, in their folder.
pub(crate) const PAGE: &str = "results.md";
pub(crate) const TABLE: &str = "results.csv";

/// What it all ran on, and when.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Occasion {
    pub adapter: String,
    /// The driver and the interface that it was asked through.
    pub driver: String,
    /// Whether that runs on the CPU.
    pub is_software: bool,
    /// Day and minute, in UTC.
    pub date: String,
    /// The command line.
    pub command: String,
}

/// A mesh with what was measured of it, and what wasn't.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Part {
    pub subject: Subject,
    /// Patches that the mesh has, and edges whose sides have different normals.
    pub patches: u64,
    pub split_edges: u64,
    /// The picture's file, in the page's folder.
    pub picture: String,
    pub left_out: LeftOut,
}

/// How many settings are not in a part, by why.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct LeftOut {
    /// They had more triangles than were allowed, and how many those were.
    pub too_large: usize,
    pub most_triangles: u64,
    /// A coarser one of the method had come as close: see [`super::has_converged`].
    pub converged: usize,
    /// Somebody had seen enough.
    pub interrupted: usize,
}

impl LeftOut {
    /// Whatever is left out, in words; nothing if nothing is.
    pub(crate) fn words(&self) -> Vec<String> {
        let most = crate::numbers::grouped(self.most_triangles);
        let reasons = [
            (self.too_large, format!("of more than {most} triangles")),
            (self.converged, "finer than a method takes to come as close as it gets".to_owned()),
            (self.interrupted, "not tried, since it was interrupted".to_owned()),
        ];
        reasons.into_iter().filter(|(count, _)| *count > 0).map(|(count, why)| format!("{count} {why}")).collect()
    }
}

impl Part {
    /// Whether it was held against a truth, so that all its rows can be compared, also with those of others.
    fn has_truth(&self) -> bool {
        self.subject.truth.is_some()
    }

    /// Its rows, if they were held against one truth.
    fn race(&self) -> Option<Race<'_>> {
        self.subject.races().into_iter().next().filter(|_| self.has_truth())
    }

    /// Whether a row is the mesh as it is: its patches are triangles.
    fn is_plain(&self, row: &super::Row) -> bool {
        row.triangles == self.patches
    }
}

/// The page, in Markdown.
pub(crate) fn page(occasion: &Occasion, parts: &[Part]) -> String {
    let Occasion { adapter, driver, date, command, .. } = occasion;
    let mut text = String::from("# Speed against accuracy\n\n");
    let _ = writeln!(text, "Measured on {} ({}), {date}, by\n\n    {command}\n", plain(adapter), plain(driver));
    let _ = writeln!(text, "{}{ABOUT}\n", if occasion.is_software { SOFTWARE } else { "" });
    let _ = writeln!(text, "## Which method to use when\n");
    let advice = advice::sentences(parts);
    text.extend(advice.iter().map(|sentence| format!("- {sentence}\n")));
    text += &tables(parts);
    text += &limits::table_of(parts);
    text += &fronts::table_of(parts);
    text.extend(parts.iter().map(section));
    text
}

/// What numbers mean.
const ABOUT: &str = "A method is a surface and a level of detail (LOD): a uniform factor, px a segment on screen (the white paper's), \
     or the error on screen in px. Its settings go from coarse to fine. ms are those of tessellation and drawing, of all of a \
     mesh. The largest error is the largest distance between what is drawn and the truth, both ways; the RMS error is the root \
     of its mean square over the area; both in percent of the truth's bounding diagonal. Normals: the largest angle between a \
     shading normal and the truth's. All rows are in [results.csv](results.csv).";

/// Where ms say little.
const SOFTWARE: &str = "This adapter is software: triangles and errors are those of any other, but ms are a CPU's, and say nothing about GPUs. ";

#[cfg(test)]
mod tests;

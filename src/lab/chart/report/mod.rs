//! The report on charts: a page that says which method to use when, with a section for each mesh. All of its text is computed
//! from rows.

mod advice;
mod answers;
mod fronts;
mod limits;
mod lods;
mod section;

use std::fmt::Write;

use geometry::near::Interval;

use super::{Race, Subject};
use answers::tables;
use load::markdown::{plain, table};
use section::section;

/// The file names of the page and of its table.
pub const PAGE: &str = "results.md";
pub const TABLE: &str = "results.csv";

/// Where and when the measurements were made.
#[derive(Clone, Debug, PartialEq)]
pub struct Occasion {
    pub adapter: String,
    /// The driver, and the graphics API.
    pub driver: String,
    /// Whether the driver runs on the CPU.
    pub is_software: bool,
    /// Day and minute, in UTC.
    pub date: String,
    /// The command line.
    pub command: String,
}

/// A mesh with its measurements, and the number of settings that weren't measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    pub subject: Subject,
    /// The number of the mesh's patches, and of its edges whose sides have different normals.
    pub patches: u64,
    pub split_edges: u64,
    /// The picture's file, in the page's folder.
    pub picture: String,
    pub left_out: LeftOut,
}

/// The number of settings that were left out, for each reason.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LeftOut {
    /// They had more than `most_triangles` triangles.
    pub too_large: usize,
    /// The most triangles that were allowed.
    pub most_triangles: u64,
    /// A coarser setting of the method came as close: see [`super::has_converged`].
    pub converged: usize,
    /// The user interrupted the measurement.
    pub interrupted: usize,
}

impl LeftOut {
    /// The numbers with their reasons, in words; empty if nothing was left out.
    pub fn words(&self) -> Vec<String> {
        let most = geometry::numbers::grouped(self.most_triangles);
        let reasons = [
            (self.too_large, format!("with more than {most} triangles")),
            (self.converged, "whose method came as close as it gets with a coarser one".to_owned()),
            (self.interrupted, "not tried, since the measurement was interrupted".to_owned()),
        ];
        reasons.into_iter().filter(|(count, _)| *count > 0).map(|(count, why)| format!("{count} {why}")).collect()
    }
}

impl Part {
    /// Whether it was compared with a reference surface. Then all its rows can be compared, also with those of other meshes.
    fn has_reference_shape(&self) -> bool {
        self.subject.reference_shape.is_some()
    }

    /// Its rows, if they were compared with a reference surface.
    fn race(&self) -> Option<Race<'_>> {
        self.subject.races().into_iter().next().filter(|_| self.has_reference_shape())
    }

    /// Whether a row is the mesh without tessellation: one triangle for each patch.
    fn is_plain(&self, row: &super::Row) -> bool {
        row.probe.triangles == self.patches
    }
}

/// Returns the page in Markdown.
pub fn page(occasion: &Occasion, parts: &[Part]) -> String {
    let Occasion { adapter, driver, date, command, .. } = occasion;
    let mut text = String::from("# Speed against accuracy\n\n");
    let _ = writeln!(text, "Measured on {} ({}), {date}, by\n\n    {command}\n", plain(adapter), plain(driver));
    let _ = writeln!(text, "{}{ABOUT}{}\n", if occasion.is_software { SOFTWARE } else { "" }, certainty(parts));
    let _ = writeln!(text, "## Which method to use when\n");
    let advice = advice::sentences(parts);
    text.extend(advice.iter().map(|sentence| format!("- {sentence}\n")));
    text += &tables(parts);
    text += &limits::table_of(parts);
    text += &lods::table_of(parts);
    text += &fronts::table_of(parts);
    text.extend(parts.iter().map(section));
    text
}

/// How much larger the largest errors may be than what was found.
fn certainty(parts: &[Part]) -> String {
    let rows = parts.iter().flat_map(|part| &part.subject.rows);
    let found: Vec<Interval> = rows.filter_map(|row| row.probe.errors).map(|errors| errors.largest).collect();
    let close = found.iter().filter(|largest| largest.at_most <= 1.02 * largest.at_least).count();
    match found.len() {
        0 => String::new(),
        all => format!(
            " Largest errors are those that were found. In {close} of {all} rows it is proven that none is larger by more than 2 % \
             of itself; the column max_error_at_most has the proven limits of all."
        ),
    }
}

/// A table with its heading and a paragraph about it; empty without rows. Its first column has words.
fn titled(title: &str, about: &str, columns: &[&str], rows: &[Vec<String>]) -> String {
    match rows {
        [] => String::new(),
        rows => format!("\n### {title}\n\n{about}\n\n{}", table(columns, &[0], rows)),
    }
}

/// Explains the numbers.
const ABOUT: &str = "A method is a surface with a level of detail (LOD): a uniform factor, px per segment on screen (the white \
     paper's LOD), or the error on screen in px. Its settings go from coarse to fine. The ms are the time of tessellating and \
     drawing the whole mesh. The largest error is the largest distance between what is drawn and the reference surface, in both \
     directions. The RMS error is the root of the mean square of these distances over the area. Both are in percent of the \
     reference surface's bounding diagonal. Normals are compared by the largest angle between a shading normal and the \
     normal of the reference surface. All rows are in [results.csv](results.csv).";

/// Warns about times on software adapters.
const SOFTWARE: &str = "This adapter is software. Its triangles and errors are those of any other adapter, but its times \
     are those of a CPU, and say nothing about GPUs. ";

#[cfg(test)]
mod tests;

//! A report on a picture: one HTML file that needs no other, with the picture, or both halves of a split one, what was found, the
//! numbers, and the command that draws it again.

use std::fmt::Write;
use std::path::Path;

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use image::DynamicImage;
use serde_json::Value;

use super::files::write_text;
use super::picture_file::png_bytes;
use super::{Shot, ShotError, StatsWanted};
use crate::gates::{Gate, GateKind, Judgement, Limit};
use crate::html;
use crate::settings::{Settings, SplitSide, SplitView};
use geometry::numbers::{grouped, short};
use geometry::progress::Progress;

/// What this page has besides what all pages have.
const STYLE: &str = "
.pictures { display: flex; flex-wrap: wrap; gap: 1rem; } figure { flex: 1 1 20rem; } img { width: 100%; }
figcaption { white-space: pre-line; } pre { white-space: pre-wrap; overflow-wrap: anywhere; }
";

/// Longer lists have their length in the table.
const MOST_LISTED: usize = 4;

impl Shot {
    /// Draws the picture and writes a report on it. `command` draws it again.
    ///
    /// # Errors
    /// The device was lost, the file can't be written, or `progress` was cancelled.
    pub fn write_report(&mut self, path: &Path, command: &str, progress: &Progress) -> Result<(), ShotError> {
        let of_picture = |kind: &GateKind| kind.is_of_mesh() || kind.needs_survey();
        let gates = GateKind::ALL.into_iter().filter(of_picture).map(|kind| Gate { kind, limit: Limit::Count(0) });
        let gates: Vec<_> = gates.collect();
        let figures = self.figures(progress)?;
        let tolerance = self.subject.settings.tessellation.tolerance;
        let judged = self.judge(&gates, tolerance, progress)?;
        let stats = serde_json::to_value(self.stats()?).map_err(|error| ShotError::Output(error.into()))?;
        let title = self.subject.loaded.source.title();
        write_text(path, &page(&title, command, &figures, &judged, stats))
    }

    /// The picture, or each half of a split one alone, as a PNG file with its title.
    fn figures(&mut self, progress: &Progress) -> Result<Vec<(String, Vec<u8>)>, ShotError> {
        let Settings { split, split_view, .. } = self.subject.settings;
        self.subject.settings.split_view = SplitView::Divider;
        let halves: &[_] = if split.is_some() {
            &[(SplitSide::Left, 1.0), (SplitSide::Right, 0.0)]
        } else {
            &[(SplitSide::Right, 0.0)]
        };
        let mut figures = Vec::new();
        for &(half, at) in halves {
            self.subject.settings.split = split.map(|_| at);
            let picture = self.picture(Some(StatsWanted { error: true }), progress)?;
            let bytes = png_bytes(&DynamicImage::from(picture))
                .map_err(|error| ShotError::Output(std::io::Error::other(error)))?;
            figures.push((self.half_title(half), bytes));
        }
        (self.subject.settings.split, self.subject.settings.split_view) = (split, split_view);
        Ok(figures)
    }
}

fn page(title: &str, command: &str, figures: &[(String, Vec<u8>)], judged: &[Judgement], stats: Value) -> String {
    let title = escaped(title);
    let mut text = html::begin(&format!("{title} - pnaen"), STYLE);
    let _ = write!(text, "<h1>{title}</h1>\n<div class=\"pictures\">\n");
    for (caption, png) in figures {
        let (caption, data) = (escaped(caption), BASE64_STANDARD.encode(png));
        let picture = format!("<img src=\"data:image/png;base64,{data}\" alt=\"{caption}\">");
        let _ = writeln!(text, "<figure>{picture}<figcaption>{caption}</figcaption></figure>");
    }
    text += "</div>\n<h2>Findings</h2>\n<ul>\n";
    for Judgement { gate, kind, passed, text: words, .. } in judged {
        // Many sound meshes have borders and hard edges.
        let (class, how) = match *passed {
            true => ("passed", ""),
            false if kind.is_often_meant() => ("", ""),
            false => ("failed", " failed"),
        };
        let _ = writeln!(text, "<li><span class=\"{class}\">{gate}{how}</span>: {}</li>", escaped(words));
    }
    let _ = write!(text, "</ul>\n<h2>Command</h2>\n<pre>{}</pre>\n<h2>Numbers</h2>\n<table>\n", escaped(command));
    rows(&mut text, "", &stats);
    text + "</table>\n" + html::END
}

/// A row for each number and word in a value, by the names that lead to it. What isn't known has none.
fn rows(text: &mut String, name: &str, value: &Value) {
    let shown = match value {
        Value::Null => return,
        Value::Object(fields) => {
            for (key, value) in fields {
                let name = if name.is_empty() { key.clone() } else { format!("{name}, {key}") };
                rows(text, &name, value);
            }
            return;
        }
        Value::Array(all) if all.len() > MOST_LISTED || all.iter().any(Value::is_object) => {
            format!("{} entries", grouped(all.len() as u64))
        }
        Value::Array(all) => all.iter().map(plain).collect::<Vec<_>>().join(", "),
        value => plain(value),
    };
    let _ = writeln!(text, "<tr><th>{}</th><td>{}</td></tr>", escaped(&name.replace('_', " ")), escaped(&shown));
}

/// A value without fields, as people write it.
fn plain(value: &Value) -> String {
    match (value.as_u64(), value.as_f64(), value) {
        (Some(whole), ..) => grouped(whole),
        (None, Some(number), _) => short(number),
        (None, None, Value::String(words)) => words.clone(),
        (None, None, other) => other.to_string(),
    }
}

/// A text as HTML. Its lines stay.
fn escaped(text: &str) -> String {
    text.lines().map(html::escaped).collect::<Vec<_>>().join("\n")
}

//! The report's section on one mesh.

use std::fmt::Write;

use super::Part;
use super::answers::{PARTS, PX};
use super::fronts::brief;
use crate::chart::words::plain;
use crate::chart::{Cost, Race, Row};
use geometry::numbers::{grouped, short};
use inspect::settings::Choice;
use load::markdown;

/// Returns the section, with its picture and tables.
pub(super) fn section(part: &Part) -> String {
    let title = markdown::plain(&part.subject.title);
    let mut text = format!("\n## {title}\n\n{}\n\n", facts(part));
    let _ = writeln!(text, "![Largest error of {title} over ms and over triangles]({})", part.picture);
    for race in part.subject.races() {
        let of = race
            .surface
            .map_or_else(String::new, |surface| format!(" (`{}`, compared with its own limit)", surface.name()));
        let front = front(part, &race);
        let _ = write!(text, "\nSettings that no other setting beats, in triangles or in ms{of}:\n\n{front}");
        let (table, missing) = best(part, &race);
        if !table.is_empty() {
            let _ = write!(text, "\nThe fewest triangles with which each method reaches an error{of}:\n\n{table}");
        }
        text.extend(missing.iter().map(|said| format!("\n{said}\n")));
    }
    let left_out = part.left_out.words();
    if !left_out.is_empty() {
        let _ = writeln!(text, "\nLeft out are settings: {}.", markdown::listed(&left_out));
    }
    text
}

fn facts(part: &Part) -> String {
    let against = match &part.subject.reference_shape {
        Some(reference_shape) => format!("compared with {}", markdown::plain(reference_shape)),
        None => "each surface compared with its own limit, since no reference surface is known".to_owned(),
    };
    let [width, height] = part.subject.size;
    format!("{} triangles; {against}; seen at {width} x {height} px.", grouped(part.patches))
}

/// A column's name, whether it needs a reference surface, and its text of a row.
type Column = (&'static str, bool, fn(&Row) -> String);

/// The columns after a row's name: whether they need a reference surface, and their texts.
const COLUMNS: [Column; 6] = [
    ("triangles", false, |row| grouped(row.probe.triangles)),
    ("ms", false, |row| short(row.probe.time.total())),
    ("largest error, %", true, |row| known(row.probe.errors.map(|errors| 100.0 * errors.largest.at_least))),
    ("RMS error, %", true, |row| known(row.probe.errors.map(|errors| 100.0 * errors.rms))),
    ("largest error, px", false, |row| known(row.probe.max_error_px)),
    ("normals, degrees", true, |row| known(row.probe.errors.map(|errors| errors.normal_degrees))),
];

fn known(number: Option<f64>) -> String {
    number.map_or_else(|| "-".to_owned(), short)
}

/// A table of rows, each after three words about it, whose columns have these names; empty without rows.
fn table(part: &Part, names: [&str; 3], rows: &[([String; 3], &Row)]) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let known = |(_, needs_reference_shape, _): &&Column| part.has_reference_shape() || !needs_reference_shape;
    let own = || COLUMNS.iter().filter(known);
    let columns: Vec<&str> = names.into_iter().chain(own().map(|(name, ..)| *name)).collect();
    let line = |(words, row): &([String; 3], &Row)| {
        let cells = own().map(|(.., text)| text(row));
        words.iter().cloned().chain(cells).collect()
    };
    markdown::table(&columns, &[0, 1, 2], &rows.iter().map(line).collect::<Vec<_>>())
}

/// A table of the rows that no other row beats, in triangles or in ms.
fn front<'a>(part: &Part, race: &Race<'a>) -> String {
    let fronts = [Cost::Triangles, Cost::Ms].map(|cost| race.front(|row| cost.of(&row.probe)));
    let is_in = |row: &Row, front: &[(&Row, f64)]| front.iter().any(|(other, _)| std::ptr::eq(*other, row));
    let mut rows: Vec<(&'a Row, f64)> = fronts[0].clone();
    rows.extend(fronts[1].iter().filter(|(row, _)| !is_in(row, &fronts[0])));
    rows.sort_by(|a, b| b.1.total_cmp(&a.1));
    let line = |(row, _): (&'a Row, f64)| {
        let on = match [is_in(row, &fronts[0]), is_in(row, &fronts[1])] {
            [true, true] => "both",
            [true, false] => "triangles",
            _ => "ms",
        };
        ([part.subject.name(row.setting.method), row.setting.label(), on.to_owned()], row)
    };
    table(part, ["method", "setting", "unbeaten in"], &rows.into_iter().map(line).collect::<Vec<_>>())
}

/// A table of the cheapest row of each method for each error, and sentences about the methods that don't reach it.
fn best(part: &Part, race: &Race) -> (String, Vec<String>) {
    let (mut rows, mut said) = (Vec::new(), Vec::new());
    let (errors, unit) = if part.has_reference_shape() { (&PARTS[..], "%") } else { (&PX[..], "px") };
    let methods = || {
        let own = part.subject.methods().into_iter();
        own.filter(|method| race.surface.is_none_or(|surface| method.surface == surface))
    };
    for &error in errors {
        let level = format!("{} {unit}", plain(part.subject.unit() * error));
        if race.cheapest(error, Cost::Triangles, |row| part.is_plain(row)).is_some() {
            said.push(format!("{level}: the mesh reaches it without tessellation."));
            continue;
        }
        let cheapest = |method| race.cheapest(error, Cost::Triangles, |row| row.setting.method == method);
        let mut reached: Vec<&Row> = methods().filter_map(cheapest).collect();
        reached.sort_by_key(|row| row.probe.triangles);
        let words = |row: &Row| [level.clone(), part.subject.name(row.setting.method), row.setting.label()];
        rows.extend(reached.iter().map(|row| (words(row), *row)));
        let missing = methods().filter(|method| cheapest(*method).is_none());
        match brief(std::slice::from_ref(part), &missing.collect::<Vec<_>>()) {
            _ if reached.is_empty() => said.push(format!("{level}: no setting reaches it.")),
            names if names.is_empty() => {}
            names => said.push(format!("{level}: not reached by {}.", markdown::listed(&names))),
        }
    }
    (table(part, ["error of at most", "method", "setting"], &rows), said)
}

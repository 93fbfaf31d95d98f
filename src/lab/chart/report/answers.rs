//! The methods that reach an error at the least cost, for each mesh.

use std::fmt::Write;

use super::Part;
use crate::chart::words::plain;
use crate::chart::{Cost, Method, Race, Row};
use geometry::numbers::{grouped, short};
use load::markdown;

/// The errors that the report asks for: as parts of the diagonal, and in px for meshes without a reference surface.
pub(super) const PARTS: [f64; 4] = [0.01, 0.005, 0.001, 0.0001];
pub(super) const PX: [f64; 3] = [1.0, 0.5, 0.1];

/// Methods that take up to this many times as long as the fastest count as equally fast, since times differ that much between
/// runs.
const AS_FAST: f64 = 1.05;

/// The answer to which methods reach an error at the least cost.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Answer<'a> {
    /// The mesh without tessellation reaches it.
    AsItIs(&'a Row),
    /// The cheapest row of each method that has the least cost, or about the least; the cheapest of all is the first.
    By(Vec<&'a Row>),
    /// No row reaches it. Holds the row that comes closest, and its error.
    Nobody(&'a Row, f64),
}

/// Returns which methods reach an error at the least cost, or `None` if nothing was measured.
pub(super) fn answer<'a>(part: &Part, race: &Race<'a>, error: f64, cost: Cost) -> Option<Answer<'a>> {
    let Some(best) = race.cheapest(error, cost, |_| true) else {
        let closest = race.entries.iter().min_by(|a, b| a.1.total_cmp(&b.1));
        return closest.map(|(row, error)| Answer::Nobody(row, *error));
    };
    if let Some(row) = race.cheapest(error, cost, |row| part.is_plain(row)) {
        return Some(Answer::AsItIs(row));
    }
    let slack = if cost == Cost::Ms { AS_FAST } else { 1.0 };
    let mut rows = vec![best];
    for method in part.subject.methods().into_iter().filter(|method| *method != best.setting.method) {
        let own = race.cheapest(error, cost, |row| row.setting.method == method);
        rows.extend(own.filter(|row| cost.of(&row.probe) <= slack * cost.of(&best.probe)));
    }
    Some(Answer::By(rows))
}

/// The number of meshes on which each method is among the best, the largest number first.
pub(super) fn winners(answers: &[Answer]) -> Vec<(Method, usize)> {
    let mut all: Vec<(Method, usize)> = Vec::new();
    let rows = answers.iter().filter_map(|answer| if let Answer::By(rows) = answer { Some(rows) } else { None });
    for row in rows.flatten() {
        match all.iter_mut().find(|(method, _)| *method == row.setting.method) {
            Some((_, count)) => *count += 1,
            None => all.push((row.setting.method, 1)),
        }
    }
    all.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    all
}

/// A table for each error that any row reaches: the methods that reach it on each mesh.
pub(super) fn tables(parts: &[Part]) -> String {
    const COLUMNS: [&str; 5] = ["mesh", "fewest triangles by", "triangles", "fastest by", "ms"];
    let mut text = String::new();
    for error in PARTS {
        let row = |part: &Part| -> Option<Vec<String>> {
            let race = part.race()?;
            let [fewest, fastest] =
                [Cost::Triangles, Cost::Ms].map(|cost| answer(part, &race, error, cost).map(|a| (cost, a)));
            let [(by_triangles, triangles), (by_ms, ms)] = [cell(part, fewest?), cell(part, fastest?)];
            Some(vec![markdown::plain(&part.subject.title), by_triangles, triangles, by_ms, ms])
        };
        let rows: Vec<_> = parts.iter().filter_map(row).collect();
        let reached =
            |part: &Part| part.race().is_some_and(|race| race.cheapest(error, Cost::Triangles, |_| true).is_some());
        if parts.iter().any(reached) {
            let _ = write!(text, "\n### Error of at most {} %\n\n", plain(100.0 * error));
            text += &markdown::table(&COLUMNS, &[0, 1, 3], &rows);
        }
    }
    text
}

/// The text for an answer: the method, and its cost.
fn cell(part: &Part, (cost, answer): (Cost, Answer)) -> (String, String) {
    match answer {
        Answer::AsItIs(row) => ("the mesh as it is".to_owned(), amount(cost, cost.of(&row.probe))),
        Answer::By(rows) => {
            let more = match rows.len() {
                1 => String::new(),
                count => format!(", and {} more", count - 1),
            };
            let best = rows[0];
            (format!("{}{more}", part.subject.named(best)), amount(cost, cost.of(&best.probe)))
        }
        Answer::Nobody(row, error) => {
            let closest = format!("none; closest is {} with {} %", part.subject.named(row), short(100.0 * error));
            (if cost == Cost::Triangles { closest } else { "none".to_owned() }, "-".to_owned())
        }
    }
}

fn amount(cost: Cost, number: f64) -> String {
    match cost {
        Cost::Ms => short(number),
        Cost::Triangles => grouped(number as u64),
    }
}

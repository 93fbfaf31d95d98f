//! The report's advice: sentences that say which method to use when.

use super::answers::{Answer, PARTS, answer, winners};
use super::lods::{Range, Saving, saving};
use super::{Part, fronts, limits};
use crate::chart::words::plain;
use crate::chart::{Cost, LodKind};
use geometry::numbers::{counted, short};
use load::markdown;

/// The most methods that are named in a list. Others are counted.
const NAMED: usize = 3;

/// The least ratio of two costs that differ; those with a smaller one are about equal.
const DIFFERENT: f64 = 1.05;

/// The sentences about all meshes together.
pub(super) fn sentences(parts: &[Part]) -> Vec<String> {
    let mut all: Vec<String> = PARTS.iter().filter_map(|error| reaching(parts, *error)).collect();
    all.extend(fronts::sentences(parts));
    all.extend(
        [LodKind::Uniform, LodKind::Paper, LodKind::ErrorRows].into_iter().filter_map(|other| saved(parts, other)),
    );
    all.extend(limits::sentences(parts));
    let own = parts.iter().filter(|part| !part.has_reference_shape());
    let own: Vec<_> = own.map(|part| markdown::plain(&part.subject.title)).collect();
    if !own.is_empty() {
        let names = markdown::listed(&own);
        all.push(format!(
            "{names}: no reference surface is known. Each surface is compared with its own limit, in px, so surfaces can't be \
             compared with each other."
        ));
    }
    all
}

/// Names the methods that reach an error with the fewest triangles, and those that reach it fastest.
fn reaching(parts: &[Part], error: f64) -> Option<String> {
    let raced: Vec<_> = parts.iter().filter_map(|part| Some((part, part.race()?))).collect();
    if raced.is_empty() {
        return None;
    }
    // Every race has a row, so that each of these meshes has an answer.
    let asked = |cost: Cost| -> Vec<Answer> {
        raced.iter().filter_map(|(part, race)| answer(part, race, error, cost)).collect()
    };
    let [by_triangles, by_ms] = [Cost::Triangles, Cost::Ms].map(asked);
    let mut text = format!("**Error of at most {} % of the diagonal:**", plain(100.0 * error));
    let reached = by_triangles.iter().filter(|answer| matches!(answer, Answer::By(_))).count();
    if reached > 0 {
        let [fewest, fastest] = [&by_triangles, &by_ms].map(|answers| named(parts, answers, reached));
        text += &format!(" fewest triangles: {fewest}; fastest, or at most 5 % slower: {fastest}.");
    }
    let titles = |is_meant: fn(&Answer) -> bool| -> Vec<String> {
        let meant = raced.iter().zip(&by_triangles).filter(|(_, answer)| is_meant(answer));
        meant.map(|((part, _), _)| markdown::plain(&part.subject.title)).collect()
    };
    let as_they_are = titles(|answer| matches!(answer, Answer::AsItIs(_)));
    let nobody = titles(|answer| matches!(answer, Answer::Nobody(..)));
    if !as_they_are.is_empty() {
        text += &format!(" No tessellation is needed on {}.", markdown::listed(&as_they_are));
    }
    if !nobody.is_empty() {
        let on = if nobody.len() == raced.len() { "any mesh".to_owned() } else { markdown::listed(&nobody) };
        text += &format!(" No setting reaches it on {on}.");
    }
    Some(text)
}

/// The names of the best methods, with the number of meshes on which each is best.
fn named(parts: &[Part], answers: &[Answer], reached: usize) -> String {
    let winners = winners(answers);
    let mut words: Vec<String> = Vec::new();
    for (index, (method, count)) in winners.iter().take(NAMED).enumerate() {
        let of = if index == 0 { format!(" of {}", counted(reached as u64, "mesh")) } else { String::new() };
        words.push(format!("{} (on {count}{of})", fronts::name(parts, *method)));
    }
    if winners.len() > NAMED {
        let rest = winners.len() - NAMED;
        words.push(format!("{rest} {}", if rest == 1 { "other" } else { "others" }));
    }
    markdown::listed(&words)
}

/// Says what LOD by error saves compared with another LOD, at equal error.
fn saved(parts: &[Part], other: LodKind) -> Option<String> {
    let name = match other {
        LodKind::Uniform => "a uniform factor",
        LodKind::Paper => "the white paper's LOD",
        LodKind::ErrorRows => "the same LOD under rows",
        LodKind::Error => return None,
    };
    let Saving { times, count, alone } = saving(parts, other, Cost::Triangles)?;
    let against = match count {
        1 => format!("{name} (one comparison)"),
        _ => format!(
            "{name} (geometric mean of {count} comparisons over surfaces, meshes and errors; {})",
            ends(&times, ["fewer", "as many"])
        ),
    };
    let triangles = compared(times.mean, ["fewer triangles than", "as many triangles as"]);
    let mut text = format!("At equal error, LOD by error takes {triangles} {against}");
    if let Some(Saving { times, .. }) = saving(parts, other, Cost::Ms) {
        text += &format!(", and {}", compared(times.mean, ["less time", "as much time"]));
    }
    text.push('.');
    for (count, who) in [(alone[0], "LOD by error"), (alone[1], name)].into_iter().filter(|(count, _)| *count > 0) {
        let errors = if count == 1 { "error is reached" } else { "errors are reached" };
        text += &format!(" {count} {errors} only by {who}.");
    }
    Some(text)
}

/// The least and the greatest ratio, in the word that [`compared`] has for their mean.
fn ends(times: &Range, [less, as_much]: [&str; 2]) -> String {
    let Range { mean, least, most } = *times;
    let (from, to, word) = if mean >= DIFFERENT { (least, most, less) } else { (1.0 / most, 1.0 / least, as_much) };
    format!("{} to {} times {word}", short(from), short(to))
}

/// A ratio in words: above 1 as "times less", below 1 as "times as much".
fn compared(ratio: f64, [less, as_much]: [&str; 2]) -> String {
    match ratio {
        _ if ratio >= DIFFERENT => format!("{} times {less}", short(ratio)),
        _ if ratio <= 1.0 / DIFFERENT => format!("{} times {as_much}", short(1.0 / ratio)),
        _ => format!("about {as_much}"),
    }
}

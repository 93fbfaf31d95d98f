//! How often each method is on the front, that is, has settings that no other setting beats.

use super::{Part, titled};
use crate::chart::{Cost, Method, Row, distinct};
use geometry::numbers::{counted, grouped};
use inspect::settings::Choice;
use load::markdown;

/// How often a method is on the front.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Standing {
    pub method: Method,
    /// The number of meshes that it was tried on.
    pub tried: usize,
    /// The number of meshes on whose fronts it is, and of its settings on these fronts: by triangles, and by ms.
    pub meshes: [usize; 2],
    pub settings: [usize; 2],
}

/// The costs, in the order of a standing's numbers.
pub(super) const COSTS: [Cost; 2] = [Cost::Triangles, Cost::Ms];

/// The standing of every method on meshes with a reference surface, those on most fronts first. The mesh without tessellation
/// doesn't count, since all methods have it.
pub(super) fn standings(parts: &[Part]) -> Vec<Standing> {
    let mut all: Vec<Standing> = Vec::new();
    for (part, race) in parts.iter().filter_map(|part| Some((part, part.race()?))) {
        for method in part.subject.methods() {
            match all.iter_mut().find(|standing| standing.method == method) {
                Some(standing) => standing.tried += 1,
                None => all.push(Standing { method, tried: 1, meshes: [0; 2], settings: [0; 2] }),
            }
        }
        for (index, cost) in COSTS.into_iter().enumerate() {
            let front = race.front(|row| cost.of(&row.probe));
            let rows: Vec<&Row> = front.into_iter().map(|(row, _)| row).filter(|row| !part.is_plain(row)).collect();
            for standing in &mut all {
                let count = rows.iter().filter(|row| row.setting.method == standing.method).count();
                standing.settings[index] += count;
                standing.meshes[index] += usize::from(count > 0);
            }
        }
    }
    all.sort_by_key(|standing| std::cmp::Reverse((standing.meshes[0] + standing.meshes[1], standing.settings)));
    all
}

/// The table of standings.
pub(super) fn table_of(parts: &[Part]) -> String {
    const COLUMNS: [&str; 6] =
        ["method", "meshes", "on the front by triangles", "settings there", "on the front by ms", "settings there"];
    let rows: Vec<_> = standings(parts)
        .iter()
        .filter(|standing| standing.meshes != [0, 0])
        .map(|standing| {
            let Standing { method, tried, meshes, settings } = *standing;
            let counts = [tried, meshes[0], settings[0], meshes[1], settings[1]];
            let counts = counts.into_iter().map(|count| grouped(count as u64));
            [name(parts, method)].into_iter().chain(counts).collect()
        })
        .collect();
    let about = "The number of meshes on which a method has settings that no other setting beats, in triangles or in ms, \
                 and the number of these settings. The mesh without tessellation doesn't count.";
    titled("How often each method is on the front", about, &COLUMNS, &rows)
}

/// A method's name, as on the first mesh that it was tried on.
pub(super) fn name(parts: &[Part], method: Method) -> String {
    let part = parts.iter().find(|part| part.subject.methods().contains(&method));
    part.map_or_else(|| method.to_string(), |part| part.subject.name(method))
}

/// The names of methods. If all tried methods of a surface are among them, they get one name.
pub(super) fn brief(parts: &[Part], methods: &[Method]) -> Vec<String> {
    let tried: Vec<Method> = parts.iter().flat_map(|part| part.subject.methods()).collect();
    let name = |method: &Method| {
        let mut own = tried.iter().filter(|other| other.surface == method.surface);
        let are_all = own.all(|other| methods.contains(other));
        if are_all { format!("{} by any LOD", method.surface.name()) } else { name(parts, *method) }
    };
    distinct(methods.iter().map(name))
}

/// The sentences that name the methods on most fronts, and those on none.
pub(super) fn sentences(parts: &[Part]) -> Vec<String> {
    let standings = standings(parts);
    let mut all = Vec::new();
    for (index, cost) in COSTS.into_iter().enumerate() {
        let most = standings.iter().map(|standing| standing.meshes[index]).max().unwrap_or(0);
        let best = standings.iter().filter(|standing| most > 0 && standing.meshes[index] == most);
        let names: Vec<_> = best.map(|standing| name(parts, standing.method)).collect();
        let tried = parts.iter().filter(|part| part.race().is_some()).count();
        let by = if cost == Cost::Ms { "ms" } else { "triangles" };
        if !names.is_empty() {
            let names = markdown::listed(&names);
            all.push(format!(
                "Most often on the front by {by}: {names}, on {most} of {}.",
                counted(tried as u64, "mesh")
            ));
        }
    }
    let never = standings.iter().filter(|standing| standing.meshes == [0, 0]);
    let never = brief(parts, &never.map(|standing| standing.method).collect::<Vec<_>>());
    if !never.is_empty() {
        all.push(format!("On no front at all: {}.", markdown::listed(&never)));
    }
    all
}

//! How many times the triangles that LOD by error needs each method draws.

use super::lods::Range;
use super::{Part, fronts, titled};
use crate::chart::{Method, Row, distinct};
use geometry::numbers::short;

/// The triangles of a method's settings, divided by those with which LOD by error comes as close.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Waste {
    pub method: Method,
    /// The number of settings that were compared.
    pub count: usize,
    pub times: Range,
}

/// The waste of every method, the least first. The mesh without tessellation doesn't count, since nothing can be saved there.
pub(super) fn wastes(parts: &[Part]) -> Vec<Waste> {
    let methods = distinct(parts.iter().flat_map(|part| part.subject.methods()));
    let of = |method: Method| {
        let times = |part: &Part, row: &Row| -> Option<f64> {
            let is_meant = row.setting.method == method && !part.is_plain(row);
            let needed = row.probe.triangles_by_error.filter(|needed| is_meant && *needed > 0)?;
            Some(row.probe.triangles as f64 / needed as f64)
        };
        let rows = parts.iter().flat_map(|part| part.subject.rows.iter().filter_map(move |row| times(part, row)));
        let all: Vec<f64> = rows.collect();
        Some(Waste { method, count: all.len(), times: Range::from_ratios(&all)? })
    };
    let mut wastes: Vec<Waste> = methods.into_iter().filter_map(of).collect();
    wastes.sort_by(|a, b| a.times.mean.total_cmp(&b.times.mean));
    wastes
}

/// The table of wastes; empty if nothing could be compared.
pub(super) fn table_of(parts: &[Part]) -> String {
    const COLUMNS: [&str; 5] = ["method", "settings", "times, geometric mean", "least", "most"];
    let line = |waste: &Waste| {
        let Waste { method, count, times: Range { mean, least, most } } = *waste;
        vec![fronts::name(parts, method), count.to_string(), short(mean), short(least), short(most)]
    };
    let rows: Vec<_> = wastes(parts).iter().map(line).collect();
    titled("How far each method is from the fewest triangles", ABOUT, &COLUMNS, &rows)
}

/// Explains the table.
const ABOUT: &str = "Every setting is held against LOD by error on the same mesh, surface and partitioning: the table has the \
     setting's triangles, divided by those with which LOD by error comes as close to the limit of the surface, on screen. LOD \
     by error stands for the fewest triangles here, since it comes near the result of a search for them, which takes minutes a \
     mesh (`cargo bench --bench optimum`). A setting that is a little below 1 has fewer triangles than LOD by error for the same \
     error. Settings for which the tessellator hasn't enough segments are left out.";

//! What LOD by error saves: compared with another LOD at equal error, and how many times its triangles each method draws.

use super::{Part, fronts, titled};
use crate::chart::{Cost, LodKind, Method, Race, Row, distinct};
use geometry::numbers::short;
use geometry::tessellate::Surface;

/// How much less LOD by error costs than another LOD, over surfaces, meshes and errors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Saving {
    /// The cost of the other LOD divided by that of LOD by error.
    pub times: Range,
    /// The number of comparisons.
    pub count: usize,
    /// The number of errors that only LOD by error reached, and of those that only the other LOD reached.
    pub alone: [usize; 2],
}

/// What LOD by error saves in `cost` compared with `other`; `None` if they can't be compared on any mesh.
///
/// For each surface, the cheapest settings of both are compared at errors of 1, 2 and 5 times powers of ten. An error that the
/// mesh reaches without tessellation doesn't count, since nothing can be saved there; nor does one that the coarsest setting
/// reaches, since a setting that wasn't tried might have been cheaper.
pub(super) fn saving(parts: &[Part], other: LodKind, cost: Cost) -> Option<Saving> {
    let (mut ratios, mut alone) = (Vec::new(), [0, 0]);
    for part in parts {
        for race in part.subject.races() {
            for (surface, error) in cases(part, &race) {
                let cheapest = |lod: LodKind| {
                    let is_own = |row: &Row| (row.setting.method.surface, row.setting.method.lod) == (surface, lod);
                    race.cheapest(error, cost, is_own)
                };
                let is_coarsest =
                    |row: &Row| !part.subject.rows.iter().any(|other| row.setting.is_finer(&other.setting));
                let is_end = |row: &Row| part.is_plain(row) || is_coarsest(row);
                match (cheapest(LodKind::Error), cheapest(other)) {
                    (Some(own), Some(row)) if is_end(own) || is_end(row) => {}
                    (Some(own), Some(row)) if cost.of(&own.probe) > 0.0 => {
                        ratios.push(cost.of(&row.probe) / cost.of(&own.probe))
                    }
                    (Some(_), None) => alone[0] += 1,
                    (None, Some(_)) => alone[1] += 1,
                    _ => {}
                }
            }
        }
    }
    Some(Saving { times: Range::from_ratios(&ratios)?, count: ratios.len(), alone })
}

/// Each surface with each error at which it is compared.
fn cases(part: &Part, race: &Race) -> Vec<(Surface, f64)> {
    let surfaces = distinct(race.entries.iter().map(|(row, _)| row.setting.method.surface));
    let levels = race.levels(usize::MAX, part.subject.floor());
    surfaces.iter().flat_map(|surface| levels.iter().map(move |level| (*surface, *level))).collect()
}

/// The geometric mean, the least and the greatest of some ratios.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Range {
    pub mean: f64,
    pub least: f64,
    pub most: f64,
}

impl Range {
    /// Returns `None` if there are no ratios.
    pub(super) fn from_ratios(ratios: &[f64]) -> Option<Self> {
        let least = ratios.iter().copied().reduce(f64::min)?;
        let most = ratios.iter().copied().fold(least, f64::max);
        let mean = (ratios.iter().map(|ratio| ratio.ln()).sum::<f64>() / ratios.len() as f64).exp();
        Some(Self { mean, least, most })
    }
}

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

//! What LOD by error saves compared with another LOD, at equal error.

use super::Part;
use crate::chart::{Cost, LodKind, Race, Row, distinct};
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
                let is_end = |row: &Row| part.is_plain(row) || is_coarsest(part, row);
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

/// Whether a row is the coarsest of its method.
fn is_coarsest(part: &Part, row: &Row) -> bool {
    !part.subject.rows.iter().any(|other| row.setting.is_finer(&other.setting))
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

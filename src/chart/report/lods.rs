//! What one LOD saves against another, at equal error.

use super::Part;
use crate::chart::{Cost, LodKind, Race, Row};

/// What LOD by error costs less than another, over surfaces, meshes and errors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Saving {
    /// How many times less.
    pub times: Range,
    /// Pairs that were compared.
    pub count: usize,
    /// Errors that LOD by error reached and the other didn't, and the other way round.
    pub alone: [usize; 2],
}

/// What it saves in `cost` against `other`; none if nowhere both were needed.
///
/// They are compared at 1, 2 and 5 times powers of ten, for each surface, with the cheapest setting of each. Where a mesh needs
/// no tessellation nothing is to be saved; and where the coarsest setting does, one that wasn't tried might have been cheaper.
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
                    (Some(own), Some(row)) if cost.of(own) > 0.0 => ratios.push(cost.of(row) / cost.of(own)),
                    (Some(_), None) => alone[0] += 1,
                    (None, Some(_)) => alone[1] += 1,
                    _ => {}
                }
            }
        }
    }
    Some(Saving { times: Range::of(&ratios)?, count: ratios.len(), alone })
}

/// Whether nothing coarser of its method was tried.
fn is_coarsest(part: &Part, row: &Row) -> bool {
    !part.subject.rows.iter().any(|other| row.setting.is_finer(&other.setting))
}

/// Every surface with every error that is asked for.
fn cases(part: &Part, race: &Race) -> Vec<(crate::tessellate::Surface, f64)> {
    let mut surfaces = Vec::new();
    for (row, _) in &race.entries {
        if !surfaces.contains(&row.setting.method.surface) {
            surfaces.push(row.setting.method.surface);
        }
    }
    let levels = race.levels(usize::MAX, part.subject.floor());
    surfaces.iter().flat_map(|surface| levels.iter().map(move |level| (*surface, *level))).collect()
}

/// Ratios: their geometric mean, the least and the most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Range {
    pub mean: f64,
    pub least: f64,
    pub most: f64,
}

impl Range {
    /// None of none.
    pub(super) fn of(ratios: &[f64]) -> Option<Self> {
        let least = ratios.iter().copied().reduce(f64::min)?;
        let most = ratios.iter().copied().fold(least, f64::max);
        let mean = (ratios.iter().map(|ratio| ratio.ln()).sum::<f64>() / ratios.len() as f64).exp();
        Some(Self { mean, least, most })
    }
}

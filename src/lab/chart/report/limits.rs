//! How close each surface gets to the reference surface, at any cost.

use super::lods::Range;
use super::{Part, titled};
use crate::chart::{Race, distinct, has_converged};
use geometry::numbers::{counted, short};
use geometry::tessellate::{Surface, SurfaceFamily};
use inspect::settings::{Choice, Settings};
use load::markdown;

/// How close a surface gets on a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Limit {
    /// The least largest error, as a part of the diagonal.
    pub error: f64,
    /// Whether it is known that finer settings come no closer.
    pub is_reached: bool,
}

/// How close a surface gets; `None` if it wasn't tried.
pub(super) fn limit(part: &Part, race: &Race, surface: Surface) -> Option<Limit> {
    let own = race.entries.iter().filter(|(row, _)| row.setting.method.surface == surface);
    let error = own.map(|(_, error)| *error).reduce(f64::min)?;
    let mut methods = part.subject.methods().into_iter().filter(|method| method.surface == surface);
    let is_reached = methods.any(|method| has_converged(&part.subject.rows, method));
    Some(Limit { error, is_reached })
}

/// All surfaces that were tried, in the order of rows.
pub(super) fn surfaces(parts: &[Part]) -> Vec<Surface> {
    distinct(parts.iter().flat_map(|part| part.subject.methods()).map(|method| method.surface))
}

/// A table of how close every surface gets on every mesh with a reference surface.
pub(super) fn table_of(parts: &[Part]) -> String {
    let surfaces = surfaces(parts);
    let row = |part: &Part| -> Option<Vec<String>> {
        let race = part.race()?;
        let cell = |surface: &Surface| match limit(part, &race, *surface) {
            Some(Limit { error, is_reached: true }) => short(100.0 * error),
            Some(Limit { error, is_reached: false }) => format!("{} or less", short(100.0 * error)),
            None => "-".to_owned(),
        };
        let cells = surfaces.iter().map(cell);
        Some([markdown::plain(&part.subject.title)].into_iter().chain(cells).collect())
    };
    let rows: Vec<_> = parts.iter().filter_map(row).collect();
    let names = surfaces.iter().map(|surface| format!("{}, %", surface.name()));
    let columns: Vec<String> = ["mesh".to_owned()].into_iter().chain(names).collect();
    let columns: Vec<&str> = columns.iter().map(String::as_str).collect();
    let about = "The smallest value that the largest error has at any setting; \"or less\" where finer settings might come \
                 closer still.";
    titled("How close each surface gets", about, &columns, &rows)
}

/// The sentences about how close surfaces get.
pub(super) fn sentences(parts: &[Part]) -> Vec<String> {
    let all = surfaces(parts);
    all.iter()
        .filter_map(|surface| stops(parts, *surface))
        .chain(all.iter().filter_map(|s| rounds(parts, *s)))
        .collect()
}

/// Says how close a surface gets however fine it is, and why; `None` if that isn't known on any mesh.
fn stops(parts: &[Part], surface: Surface) -> Option<String> {
    let (mut reached, mut ratios, mut tried) = (Vec::new(), Vec::new(), 0_u64);
    for part in parts {
        let Some(race) = part.race() else { continue };
        let Some(limit) = limit(part, &race, surface) else { continue };
        tried += 1;
        if !limit.is_reached {
            continue;
        }
        reached.push((limit.error, part));
        let floor = part.subject.floor();
        let flat = self::limit(part, &race, Surface::Flat).filter(|_| !surface.is_flat());
        ratios.extend(flat.map(|flat| flat.error.max(floor) / limit.error.max(floor)));
    }
    reached.sort_by(|a, b| a.0.total_cmp(&b.0));
    let ((least, near), (most, far)) = (*reached.first()?, *reached.last()?);
    let at = |error: f64, part: &Part| format!("{} % ({})", short(100.0 * error), markdown::plain(&part.subject.title));
    let range = match reached.len() {
        1 => at(least, near),
        _ => format!("{} to {}", at(least, near), at(most, far)),
    };
    let name = surface.name();
    let against = Range::from_ratios(&ratios)
        .map_or_else(String::new, |range| format!(" It is {}.", closer(&range, ratios.len())));
    let (on, of, why) = (reached.len(), counted(tried, "mesh"), reason(surface));
    Some(format!("However fine, `{name}` comes no closer than {range}, on {on} of {of}: {why}.{against}"))
}

/// Compares a surface's error with that of flat triangles, in words.
fn closer(range: &Range, meshes: usize) -> String {
    let Range { mean, least, most } = *range;
    let [times, from, to] = if mean >= 1.0 { [mean, least, most] } else { [mean, most, least].map(f64::recip) };
    let word = if mean >= 1.0 { "closer" } else { "farther away" };
    match meshes {
        1 => format!("{} times {word} than `flat`", short(times)),
        _ => format!("{} times {word} than `flat` (geometric mean; {} to {})", short(times), short(from), short(to)),
    }
}

/// The reason why a surface comes no closer.
fn reason(surface: Surface) -> String {
    match surface.family() {
        SurfaceFamily::Flat => {
            "its points lie on the mesh's own triangles, so no factor moves a point or turns a normal".into()
        }
        SurfaceFamily::Pn => "a cubic patch follows the positions and normals of its corners, \
            which gives it the curvature of a smooth surface; only a finer mesh comes closer"
            .into(),
        SurfaceFamily::Phong => {
            let alpha = Settings::default().tessellation.alpha;
            let rises = 2.0 * alpha;
            format!(
                "to second order it rises 2 alpha times as high above its triangles as a smooth surface does, which is \
                 {rises} times for an alpha of {alpha}, so on a fine mesh its error is {} times that of `flat`",
                (rises - 1.0).abs()
            )
        }
        SurfaceFamily::Nagata => "a quadratic patch has the right slopes at the ends of its edges, which gives it \
            the curvature of a smooth surface; only a finer mesh comes closer"
            .into(),
    }
}

/// Names the meshes on which flat triangles come closer than a surface that averages over sides, if that is because of creases.
fn rounds(parts: &[Part], surface: Surface) -> Option<String> {
    if !surface.is_averaged() {
        return None;
    }
    let is_farther = |part: &&Part| {
        let both =
            part.race().and_then(|race| Some([limit(part, &race, surface)?, limit(part, &race, Surface::Flat)?]));
        part.split_edges > 0 && both.is_some_and(|[own, flat]| own.error > flat.error)
    };
    let meshes: Vec<_> = parts.iter().filter(is_farther).map(|part| markdown::plain(&part.subject.title)).collect();
    if meshes.is_empty() {
        return None;
    }
    Some(format!(
        "On {} `flat` comes closer than `{}`: there are creases (edges whose sides have different normals), which the mean of \
         both sides rounds.",
        markdown::listed(&meshes),
        surface.name()
    ))
}

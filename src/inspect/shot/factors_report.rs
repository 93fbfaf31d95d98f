//! Factors of a file: read, and where they disagree.

use std::path::Path;

use serde::Serialize;

use super::ShotError;
use super::files::read_text;
use crate::measure::{Agreement, Disagreement, Order};
use crate::settings::Choice;
use geometry::mesh::{Mesh, Topology};
use geometry::names::shown_path;
use geometry::tessellate::{Convention, HullFactors, Partitioning};
use load::factors_file::from_csv;

/// How many edges standard error lists.
const SAID: usize = 10;

/// How many edges the stats list.
pub(crate) const LISTED: usize = 10_000;

/// Reads the factors of each patch of a mesh from a file.
///
/// # Errors
/// The file can't be read, isn't for this mesh, or has factors that the partitioning doesn't take.
pub fn read_factors(
    path: &Path,
    mesh: &Mesh,
    topology: &Topology,
    partitioning: Partitioning,
) -> Result<Vec<HullFactors>, ShotError> {
    let text = read_text(path)?;
    let factors = from_csv(&text, topology, mesh.triangles.len(), partitioning).map_err(|error| ShotError::Line {
        path: shown_path(path),
        line: error.line,
        reason: error.fault.to_string(),
    })?;
    if partitioning.has_one_factor() {
        let uneven = topology.patches.iter().zip(&factors).find(|(_, factors)| !factors.is_uniform());
        if let Some((patch, _)) = uneven {
            return Err(ShotError::Uneven { path: shown_path(path), triangle: patch.triangle });
        }
    }
    Ok(factors)
}

/// Returns the report, as lines for standard error.
pub fn said(topology: &Topology, agreement: &Agreement, convention: Convention) -> Vec<String> {
    let mut lines = agreement_lines(topology, agreement);
    lines.extend(order_text(agreement, convention));
    lines
}

/// Returns which edges disagree, as lines for standard error.
pub fn agreement_lines(topology: &Topology, agreement: &Agreement) -> Vec<String> {
    let (culled, patches) = (agreement.patches_culled, topology.patches.len());
    let left_out =
        format!("{culled} of {patches} patches are left out, because one of their factors is not greater than 0");
    let counts = [agreement.edges.len() as u64, agreement.edges_compared];
    let texts = agreement.edges.iter().map(|edge| edge_text(topology, edge));
    different_lines("factors", counts, if culled > 0 { std::slice::from_ref(&left_out) } else { &[] }, texts)
}

/// Returns how many edges have different ones of what is named on their sides, of how many, then `more`, and which these are, the
/// ones that differ the most first; as lines for standard error.
pub(crate) fn different_lines(
    named: &str,
    [different, compared]: [u64; 2],
    more: &[String],
    edges: impl Iterator<Item = String>,
) -> Vec<String> {
    let mut lines = vec![format!("{different} of {compared} edges have different {named} on their sides")];
    lines.extend_from_slice(more);
    if different > SAID as u64 {
        lines.push(format!("the {SAID} edges that differ the most:"));
    }
    lines.extend(edges.take(SAID));
    lines
}

fn edge_text(topology: &Topology, edge: &Disagreement) -> String {
    let [a, b] = end_points(topology, edge.edge);
    let [(one, least), (other, greatest)] = edge.extremes();
    format!("{} to {}: {least} in triangle {one}, {greatest} in triangle {other}", point_text(a), point_text(b))
}

/// A point, as the lines of reports have it.
pub(crate) fn point_text([x, y, z]: [f32; 3]) -> String {
    format!("({x} {y} {z})")
}

/// The end points of an edge.
pub(crate) fn end_points(topology: &Topology, edge: u32) -> [[f32; 3]; 2] {
    topology.edge_points(&topology.edges[edge as usize]).map(|point| topology.points[point as usize].to_array())
}

/// Says which convention makes the file consistent, if one does.
fn order_text(agreement: &Agreement, convention: Convention) -> Option<String> {
    let named = |order: &Order| order.convention().filter(|found| found.is_consistent() && *found != convention);
    let names: Vec<_> = agreement.consistent().filter_map(named).map(Choice::name).collect();
    if agreement.edges.is_empty() {
        let others = names.join(" and ");
        return (!names.is_empty())
            .then(|| format!("the file is consistent as {others} too, so it doesn't tell which convention it has"));
    }
    if !names.is_empty() {
        let (all, any) = (names.join(" and as "), names.join(" or "));
        return Some(format!("the file is consistent as {all}: pass --convention {any}"));
    }
    if let Some(order) = agreement.consistent().next() {
        let edges = order.sides.map(|side| format!("({side}, {})", (side + 1) % 3)).join(", ");
        let like =
            order.convention().map_or(String::new(), |convention| format!(" as {} writes them", convention.name()));
        return Some(format!(
            "the file is consistent if e0, e1, e2 are for edges {edges}{like}; no valid convention has that order, so exchange \
             two factors where they are written"
        ));
    }
    let (nearest, different) = agreement.nearest()?;
    let differ = if different == 1 { "edge that differs" } else { "edges that differ" };
    let nearest = nearest.name();
    Some(format!("no convention makes the file consistent; {nearest} comes nearest, with {different} {differ}"))
}

/// The report as JSON.
#[derive(Clone, Debug, Serialize)]
pub struct FactorsFile {
    path: String,
    convention: &'static str,
    edges_compared: u64,
    edges_different: u64,
    patches_culled: u64,
    /// Conventions under which no edge differs.
    consistent_as: Vec<&'static str>,
    orders: Vec<OrderStats>,
    /// The largest differences first, at most [`LISTED`].
    edges: Vec<EdgeStats>,
}

/// How many edges differ if a patch's factors are in this order.
#[derive(Clone, Debug, Serialize)]
struct OrderStats {
    /// Side k runs from corner k to corner k + 1.
    sides: [u32; 3],
    /// The first convention, or known mistake, that writes factors in this order.
    written_by: Option<&'static str>,
    edges_different: u64,
}

#[derive(Clone, Debug, Serialize)]
pub(crate) struct EdgeStats {
    /// Object units.
    points: [[f32; 3]; 2],
    sides: Vec<SideStats>,
}

#[derive(Clone, Debug, Serialize)]
struct SideStats {
    triangle: u32,
    factor: Number,
}

/// JSON has no infinity.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
enum Number {
    Finite(f32),
    Infinite(&'static str),
}

impl EdgeStats {
    pub(crate) fn new(topology: &Topology, edge: &Disagreement) -> Self {
        let number = |factor: f32| if factor.is_finite() { Number::Finite(factor) } else { Number::Infinite("inf") };
        let side = |&(triangle, factor): &(u32, f32)| SideStats { triangle, factor: number(factor) };
        Self { points: end_points(topology, edge.edge), sides: edge.sides.iter().map(side).collect() }
    }
}

impl FactorsFile {
    pub fn new(path: &Path, topology: &Topology, agreement: &Agreement, convention: Convention) -> Self {
        let order = |order: &Order| OrderStats {
            sides: order.sides,
            written_by: order.convention().map(Choice::name),
            edges_different: order.different,
        };
        Self {
            path: shown_path(path),
            convention: convention.name(),
            edges_compared: agreement.edges_compared,
            edges_different: agreement.edges.len() as u64,
            patches_culled: agreement.patches_culled,
            consistent_as: agreement.consistent().filter_map(Order::valid_convention).map(Choice::name).collect(),
            orders: agreement.orders.iter().map(order).collect(),
            edges: agreement.edges.iter().take(LISTED).map(|edge| EdgeStats::new(topology, edge)).collect(),
        }
    }
}

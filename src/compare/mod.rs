//! Holds a tessellated mesh that another program emitted against ours: finds the patch and the domain place of everything in it,
//! and says what is different.
//!
//! Nothing but positions and triangles is looked at. Their order, and whether vertices are shared, don't matter.

mod alignment;
mod assignment;
mod corner_orders;
mod cuts;
mod domain_points;
mod explanations;
mod findings;
mod foreign;
mod locator;
mod matching;
mod outcomes;
mod own_mesh;
mod surfaces;
#[cfg(test)]
mod tests;

use glam::DVec3;

pub(crate) use findings::Finding;
pub(crate) use foreign::ForeignMesh;
pub(crate) use matching::Farthest;
pub(crate) use outcomes::{SideCut, SideDifference};

use crate::mesh::{Bounds, Mesh, Topology};
use crate::progress::{Cancelled, Progress};
use crate::tessellate::{Convention, Displacement, HullFactors, Inputs, Tessellated, Tessellation, tessellate};
use crate::view::ulp;

use alignment::Alignment;
use assignment::{Assignment, Overlaid};
use locator::{FINE, Locator};
use outcomes::Outcomes;
use own_mesh::OwnMesh;
use surfaces::Trial;

/// Our tessellation of a mesh, which has patches.
#[derive(Clone, Copy)]
pub(crate) struct Ours<'a> {
    pub mesh: &'a Mesh,
    pub topology: &'a Topology,
    pub inputs: &'a Inputs,
    /// Factors that were given in place of LOD's, one for each patch.
    pub given: Option<&'a [HullFactors]>,
    pub tessellated: &'a Tessellated,
}

/// How exact the other program's numbers are, in object units of our mesh.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Exactness {
    /// How far vertices may be from ours and be the same.
    pub within: f64,
    /// Half a unit of the last decimal that its file has; 0 if it has them all.
    pub resolution: f64,
}

/// What differs.
#[derive(Clone, Debug)]
pub(crate) struct Comparison {
    /// The most important first; empty if the two are the same.
    pub findings: Vec<Finding>,
    /// Numbers of what was compared.
    pub vertices: u64,
    pub triangles: u64,
    /// How many patches have triangles of theirs.
    pub patches: u64,
    /// The largest distance of their vertices from the surface that they lie on, in object units.
    pub from_surface: f64,
    /// The largest distance between vertices at the same domain points; `None` if no patch has the same points.
    pub farthest: Option<Farthest>,
    /// One unit in the last place of our mesh's largest coordinate, and the diagonal of its bounding box, in object units.
    pub ulp: f64,
    pub diagonal: f64,
    /// Sides of patches that are cut differently, those that differ the most first.
    pub sides: Vec<SideDifference>,
    /// Patches whose points or triangles differ, and patches that have none.
    pub different: Vec<u32>,
    pub missing: Vec<u32>,
    /// Vertices off the surface, in our coordinates; empty if all are.
    pub strays: Vec<DVec3>,
    /// Their vertices in our coordinates.
    pub positions: Vec<DVec3>,
}

/// A vertex lies on a surface if it is no farther away than this part of the diagonal.
const FIT: f64 = 1e-5;
/// If a larger share of the vertices is off a surface, it isn't theirs.
const STRAYS: f64 = 0.4;
/// A vertex is far from the surface beyond this part of the diagonal.
const FAR: f64 = 0.02;

/// Compares another program's tessellation with ours.
///
/// # Errors
/// [`Cancelled`].
pub(crate) fn compare(
    ours: &Ours,
    theirs: &ForeignMesh,
    exactness: Exactness,
    progress: &Progress,
) -> Result<Comparison, Cancelled> {
    let bounds = Bounds::of(ours.topology.points.iter().copied());
    let diagonal = f64::from(bounds.diagonal());
    let fit = (FIT * diagonal).max(exactness.within).max(2.0 * exactness.resolution);
    let empty = Comparison::new(ours, theirs, diagonal);
    let Some(own) = Locator::of_own(ours) else { return Ok(empty) };
    let emitted = Bounds::of(ours.tessellated.vertices.iter().map(|vertex| vertex.position.into()));
    let emitted = if ours.tessellated.vertices.is_empty() { bounds } else { emitted };
    let alignment = Alignment::find(theirs, &own, [emitted.min, emitted.max]);
    let positions: Vec<DVec3> = theirs.positions.iter().map(|position| position.as_dvec3()).collect();
    let positions = match &alignment {
        Some(alignment) => positions.into_iter().map(|position| alignment.ours(position)).collect(),
        None => positions,
    };
    let on_own = Overlaid::new(theirs, ours.topology, &own, &positions, fit, progress)?;
    let strays = on_own.strays();
    let other = match strays.is_empty() {
        true => None,
        false => Trial::new(ours.mesh, &on_own, ours.inputs, &strays).other_surface(progress)?,
    };
    let off_own = strays.len();
    let surface = |inputs: &Inputs| Locator::of_surface(ours.mesh, ours.topology, inputs, FINE);
    let other_locator = other.as_ref().and_then(surface);
    let overlaid = match &other_locator {
        Some(locator) => Overlaid::new(theirs, ours.topology, locator, &positions, fit, progress)?,
        None => on_own,
    };
    let strays = overlaid.strays();
    let is_fitted = strays.len() as f64 <= STRAYS * positions.len() as f64;
    // Vertices that are on none of our surfaces are displaced from our own, or belong to another mesh.
    let undisplaced = undisplaced(ours.inputs);
    let base = if is_fitted { None } else { surface(&undisplaced) };
    let overlaid = match &base {
        Some(base) => Overlaid::new(theirs, ours.topology, base, &positions, f64::INFINITY, progress)?,
        None => overlaid,
    };
    let strays = if is_fitted { strays } else { Vec::new() };
    let assignment = Assignment::new(&overlaid, progress)?;
    let own_mesh = OwnMesh::new(ours.tessellated);
    let outcomes = Outcomes::new(ours, &own_mesh, &assignment, exactness, progress)?;
    let mut found = Comparison {
        findings: Vec::new(),
        from_surface: overlaid.places.iter().map(|place| place.distance).fold(0.0, f64::max),
        farthest: outcomes.farthest(),
        patches: outcomes.patches(),
        missing: outcomes.missing.clone(),
        strays: strays.iter().map(|index| positions[*index as usize]).collect(),
        ..empty
    };
    let far = overlaid.places.iter().filter(|place| place.distance > FAR * diagonal).count();
    found.findings.extend(alignment.map(Finding::Aligned));
    if theirs.not_finite > 0 {
        found.findings.push(Finding::NotFinite { count: theirs.not_finite });
    }
    if !is_fitted && far as f64 > 0.2 * positions.len() as f64 && !outcomes.are_mostly_the_same() {
        let vertices = positions.len() as u64;
        found.findings.push(Finding::NotATessellation { far: far as u64, vertices, distance: FAR * diagonal });
        found.positions = positions;
        return Ok(found);
    }
    if let Some(theirs) = &other {
        let (ours, theirs) = (ours.inputs.tessellation, theirs.tessellation);
        let (vertices, of) = (off_own as u64, positions.len() as u64);
        found.findings.push(Finding::OtherSurface { ours, theirs, vertices, of });
    }
    if !is_fitted {
        found.findings.push(Finding::Displaced(outcomes.displaced(ours, fit)));
    } else {
        found.findings.extend(outcomes.moved(ours, &strays));
    }
    found.sides = outcomes.explain(ours, other.as_ref(), &mut found.findings, progress)?;
    outcomes.judge_triangles(ours, alignment.as_ref(), &mut found.findings);
    found.different = outcomes.different_at_all();
    let is_known = found.findings.iter().any(|finding| matches!(finding, Finding::Factors { .. }));
    if is_known && found.findings.iter().any(Finding::is_about_few_points) {
        let is_same = |turned: &Outcomes| turned.different_at_all().is_empty();
        if other_convention(ours, &assignment, exactness, progress, |_| true, is_same)?.is_some() {
            found.leave_to_factors();
        }
    }
    let largest = found.farthest.filter(|farthest| farthest.distance > exactness.within);
    if let Some(farthest) = largest.filter(|_| found.findings.iter().all(|finding| finding.is_about_coordinates())) {
        let triangle = ours.topology.patches[farthest.patch as usize].triangle;
        let rounding = Finding::Rounding { farthest, ulps: farthest.distance / found.ulp, triangle };
        // A valid convention gives the same points but for their last bits.
        let own = ours.inputs.tessellation.convention;
        let is_valid = |other: &Convention| own.is_consistent() && other.is_consistent();
        let is_near = |turned: &Outcomes| turned.farthest().is_some_and(|far| far.distance <= exactness.within);
        let theirs = other_convention(ours, &assignment, exactness, progress, is_valid, is_near)?;
        found.findings.push(theirs.map_or(rounding, |theirs| Finding::Convention { ours: own, theirs }));
    }
    found.positions = positions;
    Ok(found)
}

impl Comparison {
    /// Another order of factors gives all of their points. So it also explains a few that seem to be moved, and their triangles.
    fn leave_to_factors(&mut self) {
        self.findings.retain(|finding| !finding.is_about_few_points());
        for finding in &mut self.findings {
            if let Finding::Factors { patches, .. } = finding {
                *patches = self.different.len() as u64;
            }
        }
    }
}

/// Finds the convention among some of the others under which what we emit passes `suits`, which gets our outcomes under it.
///
/// # Errors
/// [`Cancelled`].
fn other_convention(
    ours: &Ours,
    assignment: &Assignment,
    exactness: Exactness,
    progress: &Progress,
    among: impl Fn(&Convention) -> bool,
    suits: impl Fn(&Outcomes) -> bool,
) -> Result<Option<Convention>, Cancelled> {
    let own = ours.inputs.tessellation.convention;
    // Given factors are in the order of our convention.
    let others = Convention::ALL.into_iter().filter(|other| ours.given.is_none() && *other != own);
    for theirs in others.filter(among) {
        let tessellation = Tessellation { convention: theirs, ..ours.inputs.tessellation };
        let inputs = Inputs { tessellation, ..*ours.inputs };
        let tessellated = tessellate(ours.mesh, ours.topology, &inputs, None);
        let turned = Ours { inputs: &inputs, tessellated: &tessellated, ..*ours };
        let own_mesh = OwnMesh::new(&tessellated);
        if suits(&Outcomes::new(&turned, &own_mesh, assignment, exactness, progress)?) {
            return Ok(Some(theirs));
        }
    }
    Ok(None)
}

/// The inputs without displacement.
fn undisplaced(inputs: &Inputs) -> Inputs {
    Inputs { tessellation: Tessellation { displacement: Displacement::Off, ..inputs.tessellation }, ..*inputs }
}

impl<'a> Locator<'a> {
    /// Our own surface. If it is displaced that is what was emitted, since heights are read from levels that depend on factors.
    fn of_own(ours: &Ours<'a>) -> Option<Self> {
        let exact = || Self::of_surface(ours.mesh, ours.topology, &undisplaced(ours.inputs), FINE);
        match ours.inputs.tessellation.displacement {
            Displacement::Off => exact(),
            _ => Self::of_emitted(ours.tessellated, ours.topology).or_else(exact),
        }
    }
}

impl Comparison {
    /// Without anything that was found.
    fn new(ours: &Ours, theirs: &ForeignMesh, diagonal: f64) -> Self {
        Self {
            findings: Vec::new(),
            vertices: theirs.positions.len() as u64,
            triangles: theirs.triangles.len() as u64,
            patches: 0,
            from_surface: 0.0,
            farthest: None,
            ulp: ulp(ours.topology),
            diagonal,
            sides: Vec::new(),
            different: Vec::new(),
            missing: Vec::new(),
            strays: Vec::new(),
            positions: Vec::new(),
        }
    }
}

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
mod net_mistakes;
mod our_mesh;
mod outcomes;
mod spaces;
mod surfaces;
#[cfg(test)]
mod tests;
mod twins;

use glam::{DMat4, DVec3, Vec3};

pub use findings::{Finding, point};
pub use foreign::ForeignMesh;
pub use matching::Farthest;
pub use outcomes::SideDifference;

use geometry::mesh::{Bounds, Mesh, Topology};
use geometry::numbers::ulp_at;
use geometry::tessellate::{Convention, HullFactors, Inputs, Tessellated, Tessellation, hull_factors, tessellate};
use geometry::view::ulp;

use assignment::{Assignment, Overlaid};
use locator::{FINE, Locator, OurSurface};
use our_mesh::OurMesh;
use outcomes::Outcomes;
use spaces::{Alignment, Space, SpaceKind};
use surfaces::Trial;
use twins::Twins;

/// Our tessellation of a mesh, which has patches.
#[derive(Clone, Copy)]
pub struct OurTessellation<'a> {
    pub mesh: &'a Mesh,
    pub topology: &'a Topology,
    pub inputs: &'a Inputs,
    /// Factors that were given in place of LOD's, one for each patch.
    pub given: Option<&'a [HullFactors]>,
    /// The other program's matrix from object units to clip space, if it was given.
    pub matrix: Option<DMat4>,
    pub tessellated: &'a Tessellated,
}

/// How exact the other program's numbers are, in object units of our mesh.
#[derive(Clone, Copy, Debug)]
pub struct Tolerances {
    /// Distance within which vertices count as equal.
    pub within: f64,
    /// Half a unit of the last decimal that its file has; 0 if it has them all.
    pub resolution: f64,
}

impl Tolerances {
    /// The same for numbers that are rounded by up to so many object units.
    fn rounded(self, resolution: Option<f64>) -> Self {
        let resolution = self.resolution.max(resolution.unwrap_or(0.0));
        Self { within: self.within.max(2.0 * resolution), resolution }
    }
}

/// What differs.
#[derive(Clone, Debug, Default)]
pub struct Comparison {
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
/// If a larger share of the vertices is far from the surface, they belong to another mesh.
const MANY_FAR: f64 = 0.2;

/// Compares another program's tessellation with ours.
pub fn compare(ours: &OurTessellation, theirs: &ForeignMesh, exactness: Tolerances) -> Comparison {
    let empty = Comparison::new(ours, theirs);
    if ours.topology.patches.is_empty() {
        return empty;
    }
    let asked = exactness.within;
    let halves = theirs.resolution_of_halves(ours);
    let mut exactness = exactness.rounded(halves);
    let fit = (FIT * empty.diagonal).max(exactness.within).max(2.0 * exactness.resolution);
    let apart = apart(asked, empty.ulp);
    let our_mesh = OurMesh::new(ours.tessellated, apart);
    let twins = |own: &[Vec3], positions: &[DVec3]| Twins::find(&our_mesh, own, theirs, positions, apart);
    let vertices = ours.vertices();
    let mut positions: Vec<_> = theirs.positions.iter().map(|position| position.as_dvec3()).collect();
    let mut our_twins = twins(&vertices, &positions);
    let own = if our_twins.are_all() { None } else { Locator::from_own(ours) };
    let frame = own.as_ref().and_then(|own| Alignment::find(theirs, own, ours, fit));
    if let Some(frame) = &frame {
        positions.iter_mut().for_each(|position| *position = frame.ours(*position));
        our_twins = twins(&vertices, &positions);
    }
    if let Some(space) = frame.as_ref().filter(|space| !matches!(space.kind, SpaceKind::Axes(_))) {
        exactness.within = exactness.within.max(rounding_in(space, theirs));
    }
    let twins = |own: &[Vec3]| twins(own, &positions);
    let on_own = Overlaid::new(theirs, ours.topology, own, our_twins, &positions, fit);
    let laid = Registered::new(ours, on_own, twins);
    let assignment = Assignment::new(&laid.overlaid);
    let outcomes = Outcomes::new(ours, &our_mesh, &assignment, exactness);
    let mut found = Comparison {
        from_surface: laid.overlaid.places.iter().map(|place| place.distance).fold(0.0, f64::max),
        farthest: outcomes.farthest(),
        patches: outcomes.patches(),
        missing: outcomes.missing.clone(),
        strays: laid.strays().iter().map(|index| positions[*index as usize]).collect(),
        ..empty
    };
    found.findings.extend(frame.map(Finding::Aligned));
    if theirs.not_finite > 0 {
        found.findings.push(Finding::NotFinite { count: theirs.not_finite });
    }
    match laid.other_mesh(found.diagonal).filter(|_| !outcomes.are_mostly_the_same()) {
        Some(other_mesh) => found.findings.push(other_mesh),
        None => {
            found.name_differences(&laid, &outcomes, frame.as_ref());
            found.findings.extend(halves.and_then(|_| found.rounded_to_halves(&laid, asked)));
        }
    }
    found.positions = positions;
    found
}

/// How far apart positions of ours are at most that can't be told apart, in object units: twice what theirs may be away from ours, if
/// that is no more than rounding.
fn apart(within: f64, ulp: f64) -> f64 {
    const ROUNDING: f64 = 16.0;
    2.0 * within.min(ROUNDING * ulp)
}

/// How far the rounding of coordinates in another space moves places in ours, in object units.
fn rounding_in(space: &Space, theirs: &ForeignMesh) -> f64 {
    const UNITS: f64 = 4.0;
    let moved = |position: &Vec3| ulp_at(position.abs().max_element()) * space.stretch(position.as_dvec3());
    UNITS * theirs.positions.iter().map(moved).fold(0.0, f64::max)
}

/// Their vertices over the surface that they lie on, and which one that is.
struct Registered<'a> {
    /// Over our own surface, over another one of ours, or over our own without displacement.
    overlaid: Overlaid<'a>,
    /// The surface that they lie on, if it isn't our own.
    other: Option<OurSurface>,
    /// How many of them are off our own surface.
    off_own: u64,
    /// Whether most of them lie on the surface. Otherwise they are displaced from it, or belong to another mesh.
    is_fitted: bool,
    /// How far from a surface a vertex lies on it, in object units.
    fit: f64,
}

impl<'a> Registered<'a> {
    /// Seeks their surface, from where they lie over ours.
    fn new(ours: &OurTessellation<'a>, on_own: Overlaid<'a>, twins: impl Fn(&[Vec3]) -> Twins<'a>) -> Self {
        let OurTessellation { mesh, topology, tessellated, .. } = *ours;
        let surface = |own: &OurSurface| Locator::from_surface(mesh, topology, own, FINE);
        let (fit, off_own) = (on_own.fit, on_own.strays().len() as u64);
        let trial = (off_own > 0).then(|| Trial::new(ours.mesh, &on_own, ours.inputs));
        let other = trial.and_then(|trial| trial.other_surface());
        let overlaid = match &other {
            Some(other) => {
                let own = other.positions(mesh, topology, &tessellated.vertices);
                on_own.over(surface(other), twins(&own))
            }
            None => on_own,
        };
        let is_fitted = overlaid.strays().len() as f64 <= STRAYS * overlaid.positions.len() as f64;
        let base = || surface(&undisplaced(ours.inputs).into());
        let overlaid = match is_fitted {
            true => overlaid,
            // Where they are displaced, every vertex counts as near its place.
            false => Overlaid { fit: f64::INFINITY, ..overlaid.over(base(), Twins::none(overlaid.theirs)) },
        };
        Self { overlaid, other, off_own, is_fitted, fit }
    }

    /// Vertices off the surface; none where most are, since none is expected on it then.
    fn strays(&self) -> Vec<u32> {
        if self.is_fitted { self.overlaid.strays() } else { Vec::new() }
    }

    /// Says that they belong to another mesh, if so many are far away that displacement is no explanation.
    fn other_mesh(&self, diagonal: f64) -> Option<Finding> {
        let distance = FAR * diagonal;
        let places = &self.overlaid.places;
        let far = places.iter().filter(|place| place.distance > distance).count();
        let is_other = !self.is_fitted && far as f64 > MANY_FAR * places.len() as f64;
        is_other.then_some(Finding::NotATessellation { far: far as u64, vertices: places.len() as u64, distance })
    }

    /// Names their surface, if it isn't ours.
    fn other_surface(&self, ours: &OurTessellation) -> Option<Finding> {
        let OurSurface { inputs: Inputs { tessellation: theirs, .. }, mistake } = self.other?;
        let (vertices, of) = (self.off_own, self.overlaid.positions.len() as u64);
        Some(match mistake {
            Some(mistake) => Finding::OtherNets { mistake, vertices, of },
            None => Finding::OtherSurface { ours: ours.inputs.tessellation, theirs, vertices, of },
        })
    }
}

impl OurTessellation<'_> {
    /// The positions that are emitted, or else those of the mesh.
    fn emitted_positions(&self) -> Vec<Vec3> {
        if self.tessellated.vertices.is_empty() { self.topology.points.clone() } else { self.vertices() }
    }

    /// The positions of the vertices that are emitted.
    fn vertices(&self) -> Vec<Vec3> {
        self.tessellated.vertices.iter().map(|vertex| vertex.position.into()).collect()
    }

    /// What a hull shader writes with these inputs, unless factors were given.
    fn written(&self, inputs: &Inputs) -> Vec<HullFactors> {
        self.given.map_or_else(|| hull_factors(self.mesh, self.topology, inputs), <[_]>::to_vec)
    }
}

impl Comparison {
    /// Without anything that was found.
    fn new(ours: &OurTessellation, theirs: &ForeignMesh) -> Self {
        Self {
            vertices: theirs.positions.len() as u64,
            triangles: theirs.triangles.len() as u64,
            ulp: ulp(ours.topology),
            diagonal: Bounds::new(ours.topology.points.iter().copied()).diagonal().into(),
            ..Self::default()
        }
    }

    /// Names what differs, where theirs is a tessellation of our mesh.
    fn name_differences(&mut self, laid: &Registered, outcomes: &Outcomes, frame: Option<&Space>) {
        self.findings.extend(laid.other_surface(outcomes.ours));
        if laid.is_fitted {
            self.findings.extend(outcomes.moved(&laid.strays()));
        } else {
            self.findings.push(Finding::Displaced(outcomes.displaced(laid.fit)));
        }
        let explained = outcomes.explain(laid.other.as_ref(), &mut self.findings);
        self.findings.extend(outcomes.judge_triangles(frame.is_some_and(Space::mirrors)));
        if let Some(sides) = explained {
            (self.sides, self.different) = (sides, outcomes.different_at_all());
        }
        self.leave_to_factors(outcomes);
        self.judge_distances(outcomes);
    }

    /// Says that their coordinates, which are numbers of 16 bits, are farther from ours than the distance that was asked for. Where
    /// they have other points than ours, their distance from the surface tells.
    fn rounded_to_halves(&self, laid: &Registered, asked: f64) -> Option<Finding> {
        let from_surface = if laid.is_fitted { self.from_surface } else { 0.0 };
        let distance = self.farthest.map_or(from_surface, |farthest| farthest.distance);
        let is_rounding = distance > asked && distance <= laid.fit;
        is_rounding.then(|| Finding::HalfFloats { distance, ulps: distance / self.ulp })
    }

    /// Where another convention gives all of their points, it also explains a few that seem to be moved, and their triangles.
    fn leave_to_factors(&mut self, outcomes: &Outcomes) {
        let is_known = self.findings.iter().any(|finding| matches!(finding, Finding::Factors { .. }));
        if !is_known || !self.findings.iter().any(Finding::is_about_few_points) {
            return;
        }
        let is_same = |turned: &Outcomes| turned.different_at_all().is_empty();
        if outcomes.other_convention(|_| true, is_same).is_none() {
            return;
        }
        self.findings.retain(|finding| !finding.is_about_few_points());
        for finding in &mut self.findings {
            if let Finding::Factors { patches, .. } = finding {
                *patches = self.different.len() as u64;
            }
        }
    }

    /// Says what distances between the same vertices mean, where nothing else was found but how coordinates are meant.
    fn judge_distances(&mut self, outcomes: &Outcomes) {
        let within = outcomes.exactness.within;
        let Some(farthest) = self.farthest.filter(|farthest| farthest.distance > within) else { return };
        if !self.findings.iter().all(|finding| matches!(finding, Finding::Aligned(_))) {
            return;
        }
        // A valid convention gives the same points but for their last bits.
        let own = outcomes.ours.inputs.tessellation.convention;
        let is_valid = |other: &Convention| own.is_consistent() && other.is_consistent();
        let is_near = |turned: &Outcomes| turned.farthest().is_some_and(|far| far.distance <= within);
        let triangle = outcomes.triangle(farthest.patch);
        self.findings.push(match outcomes.other_convention(is_valid, is_near) {
            Some(theirs) => Finding::Convention { ours: own, theirs },
            None if outcomes.are_within() => return,
            None => Finding::Rounding { farthest, ulps: farthest.distance / self.ulp, triangle },
        });
    }
}

impl Outcomes<'_> {
    /// Finds the convention among some of the others under which what we emit passes `suits`, which gets our outcomes under it.
    fn other_convention(
        &self,
        among: impl Fn(&Convention) -> bool,
        suits: impl Fn(&Outcomes) -> bool,
    ) -> Option<Convention> {
        let Self { ours, assignment, exactness, .. } = self;
        let own = ours.inputs.tessellation;
        let is_suited = |theirs: &Convention| {
            let inputs = Inputs { tessellation: Tessellation { convention: *theirs, ..own }, ..*ours.inputs };
            let tessellated = tessellate(ours.mesh, ours.topology, &inputs, None);
            let turned = OurTessellation { inputs: &inputs, tessellated: &tessellated, ..**ours };
            let our_mesh = OurMesh::new(&tessellated, apart(exactness.within, ulp(ours.topology)));
            suits(&Outcomes::new(&turned, &our_mesh, assignment, *exactness))
        };
        // Given factors are in the order of our convention.
        let others = Convention::ALL.into_iter().filter(|other| ours.given.is_none() && *other != own.convention);
        others.filter(among).find(is_suited)
    }
}

/// The inputs without displacement.
fn undisplaced(inputs: &Inputs) -> Inputs {
    Inputs { tessellation: inputs.tessellation.undisplaced(), ..*inputs }
}

impl<'a> Locator<'a> {
    /// Our own surface. If it is displaced that is what was emitted, since heights are read from levels that depend on factors.
    fn from_own(ours: &OurTessellation<'a>) -> Option<Self> {
        let exact = || Self::from_surface(ours.mesh, ours.topology, &undisplaced(ours.inputs).into(), FINE);
        let emitted = || Self::from_emitted(ours.tessellated, ours.topology);
        if ours.inputs.tessellation.displacement.is_on() { emitted().or_else(exact) } else { exact() }
    }
}

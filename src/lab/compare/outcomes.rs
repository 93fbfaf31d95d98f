//! What came out for every patch, and what follows from all of them together.

use glam::DVec3;
use serde::Serialize;

use super::assignment::{Assignment, made_of_all};
use super::corner_orders::CornerOrder;
use super::cuts::{Cut, cuts_of};
use super::explanations::{Explainer, Explanation, Rule};
use super::findings::{Displaced, Finding, UnknownFactors};
use super::locator::OurSurface;
use super::matching::{Farthest, LEAST_REACH, Match, Reach};
use super::our_mesh::{OurMesh, OurPatch};
use super::{OurTessellation, Tolerances};
use geometry::mesh::EdgeKind;
use geometry::tessellate::{FACTOR_VALUE, Partitioning, Tessellation, segments};
use geometry::view::ulp;

/// How every patch came out.
pub(super) struct Outcomes<'a> {
    pub ours: &'a OurTessellation<'a>,
    our_mesh: &'a OurMesh<'a>,
    pub assignment: &'a Assignment<'a>,
    pub exactness: Tolerances,
    reaches: Vec<Reach>,
    /// None for a patch for which only one of both emits triangles, or neither.
    all: Vec<Option<Outcome>>,
    /// Patches that we emit and they don't.
    pub missing: Vec<u32>,
    /// Patches that they emit and we don't.
    additional: Vec<u32>,
}

/// How one patch came out.
#[derive(Clone, Debug)]
struct Outcome {
    /// Without the list of vertices.
    found: Match,
    farthest: Option<Farthest>,
    /// How far the last bits of LOD's factors may move its points, in object units.
    slack: f64,
    offsets: Offsets,
}

/// How vertices lie beside ours at the same domain points.
#[derive(Clone, Copy, Debug, Default)]
struct Offsets {
    /// How many there are, and how many of them lie in the direction of our normals or against it.
    vertices: u64,
    along_normals: u64,
    /// The largest distances in both directions, in object units.
    outward: f64,
    inward: f64,
}

/// A side of a patch that is cut differently.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SideDifference {
    /// The patch's triangle of the mesh, and which of its sides it is (from corner k to corner k + 1).
    pub triangle: u32,
    pub side: u32,
    /// Both ends, in object units.
    #[serde(rename = "points")]
    pub ends: [[f32; 3]; 2],
    pub theirs: SideCut,
    pub ours: SideCut,
}

/// How a side is cut.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SideCut {
    pub segments: u64,
    /// The tessellation factor that gives it.
    pub factor: f64,
}

impl SideDifference {
    /// By how much the factors differ, as a ratio that is at least 1.
    fn ratio(&self) -> f64 {
        let ratio = self.theirs.factor / self.ours.factor;
        if ratio.is_finite() && ratio > 0.0 { ratio.max(ratio.recip()) } else { f64::INFINITY }
    }
}

/// A point is at most this part of a segment away from where it belongs, or points couldn't be told apart.
const LARGEST_REACH: f64 = 0.25;
/// The largest number of segments that a side has.
const MOST_SEGMENTS: f64 = 64.0;
/// Points of displaced patches are sought within this part of a segment.
const OF_SEGMENT: f64 = 0.35;
/// How far the last bits of LOD's factors, which devices compute differently, move points in the domain: by a few units of fixed point.
const LAST_BITS: f64 = 4.0 / 65536.0;
/// How many triangles a finding names.
const NAMED: usize = 10;
/// A partitioning suits if this share of the sides is cut as it cuts them.
const SUITS: f64 = 0.97;

impl<'a> Outcomes<'a> {
    /// Compares all patches.
    pub(super) fn new(
        ours: &'a OurTessellation,
        our_mesh: &'a OurMesh<'a>,
        assignment: &'a Assignment<'a>,
        exactness: Tolerances,
    ) -> Self {
        let patches = 0..ours.topology.patches.len() as u32;
        let fit = assignment.overlaid.fit;
        let exact = exactness.within.max(exactness.resolution).max(8.0 * ulp(ours.topology));
        let reach = |patch: u32| {
            let segments = segments_of(our_mesh, patch);
            if !fit.is_finite() {
                return Reach { domain: OF_SEGMENT / segments, fit };
            }
            // A patch that is cut into n segments has about n squared triangles.
            let most = segments.max(f64::from(assignment.count(patch)).sqrt().min(MOST_SEGMENTS));
            Reach { domain: exact_reach(ours, patch, exact).clamp(LEAST_REACH, LARGEST_REACH / most), fit }
        };
        let reaches: Vec<Reach> = patches.clone().map(reach).collect();
        // LOD by error has whole factors, like those of one number.
        let lod = ours.inputs.tessellation.used_lod();
        let has_last_bits = ours.given.is_none() && lod.follows_view() && !lod.is_by_error();
        let theirs = |patch: &u32| assignment.count(*patch) > 0;
        let emitted = |patch: &u32| our_mesh.emits(*patch);
        let all = made_of_all(patches.len(), |patch| {
            let patch = patch as u32;
            let own = (theirs(&patch) && emitted(&patch)).then(|| our_mesh.patch(patch))?;
            let slack = if has_last_bits { LAST_BITS * own.stretch() } else { 0.0 };
            Some(Outcome { slack, ..Outcome::new(assignment, &own, patch, reaches[patch as usize]) })
        });
        let missing = patches.clone().filter(|patch| emitted(patch) && !theirs(patch)).collect();
        let additional = patches.filter(|patch| theirs(patch) && !emitted(patch)).collect();
        Self { ours, our_mesh, assignment, exactness, reaches, all, missing, additional }
    }

    /// The number of patches that have triangles of theirs.
    pub(super) fn patches(&self) -> u64 {
        self.compared().count() as u64 + self.additional.len() as u64
    }

    fn compared(&self) -> impl Iterator<Item = (u32, &Outcome)> {
        (0..).zip(&self.all).filter_map(|(patch, outcome)| Some((patch, outcome.as_ref()?)))
    }

    /// Patches whose points differ.
    fn different(&self) -> Vec<u32> {
        self.compared().filter(|(_, outcome)| !outcome.found.has_same_points).map(|(patch, _)| patch).collect()
    }

    /// Patches of which anything differs but distances. Places of displaced vertices are too rough to tell one triangle from the next.
    pub(super) fn different_at_all(&self) -> Vec<u32> {
        let is_exact = self.assignment.overlaid.fit.is_finite();
        let differs = |found: &Match| {
            let counts = found.missing + found.doubled + found.other + found.slid;
            !found.has_same_points || found.flipped > 0 || is_exact && counts > 0
        };
        let different = self.compared().filter(|(_, outcome)| differs(&outcome.found)).map(|(patch, _)| patch);
        different.chain(self.additional.iter().copied()).collect()
    }

    /// Whether most patches have the same points.
    pub(super) fn are_mostly_the_same(&self) -> bool {
        2 * self.different().len() < self.compared().count()
    }

    pub(super) fn farthest(&self) -> Option<Farthest> {
        self.compared().filter_map(|(_, outcome)| outcome.farthest).reduce(Farthest::farther)
    }

    /// Whether vertices are no farther from ours than is allowed, and than the last bits of LOD's factors move points.
    pub(super) fn are_within(&self) -> bool {
        let within = self.exactness.within;
        let is_within = |own: &Outcome| own.farthest.is_none_or(|far| far.distance <= within + own.slack);
        self.compared().all(|(_, outcome)| is_within(outcome))
    }

    /// Says how vertices are displaced, of which none is expected on the surface. What is nearer than `fit` isn't displaced.
    pub(super) fn displaced(&self, fit: f64) -> Displaced {
        let overlaid = self.assignment.overlaid;
        let distances = || overlaid.places.iter().map(|place| place.distance);
        let sum = self.compared().fold(Offsets::default(), |sum, (_, outcome)| sum.with(outcome.offsets));
        Displaced {
            vertices: distances().filter(|distance| *distance > fit).count() as u64,
            of: overlaid.places.len() as u64,
            largest: distances().fold(0.0, f64::max),
            outward: sum.outward,
            inward: sum.inward,
            is_along_normals: sum.vertices > 0 && sum.along_normals as f64 >= 0.9 * sum.vertices as f64,
            ours: self.ours.inputs.tessellation.displacement,
        }
    }

    /// Says which vertices were moved: those off the surface, and those that were moved along it.
    pub(super) fn moved(&self, strays: &[u32]) -> Option<Finding> {
        let overlaid = self.assignment.overlaid;
        let slid: u64 = self.compared().map(|(_, outcome)| outcome.found.slid).sum();
        let distance = |index: &u32| overlaid.places[*index as usize].distance;
        let vertices = strays.len() as u64 + slid;
        let worst = strays.iter().max_by(|a, b| distance(a).total_cmp(&distance(b)));
        let least = worst.map_or(0.0, distance);
        // A vertex is no nearer to where it belongs than to the surface, unless it isn't known where it belongs.
        let known = self.farthest().filter(|farthest| vertices > 0 && farthest.distance >= least);
        let of_place = |worst: usize| (overlaid.positions[worst], least, overlaid.places[worst].patch);
        let of_vertex = known.map(|Farthest { distance, patch, theirs, .. }| (theirs, distance, patch));
        let (farthest, distance, patch) = of_vertex.or(worst.map(|worst| of_place(*worst as usize)))?;
        Some(Finding::Moved { vertices, farthest, distance, triangle: self.triangle(patch) })
    }

    /// The mesh's triangle of a patch.
    pub(super) fn triangle(&self, patch: u32) -> u32 {
        self.ours.topology.patches[patch as usize].triangle
    }

    /// Explains where points differ, and returns the sides that are cut differently. `other` is the surface that their vertices lie on, if
    /// it isn't ours. `None` if no point differs but for that surface or for displacement.
    pub(super) fn explain(&self, other: Option<&OurSurface>, found: &mut Vec<Finding>) -> Option<Vec<SideDifference>> {
        let different = self.different();
        if different.is_empty() {
            return Some(Vec::new());
        }
        let Self { ours, assignment, reaches, .. } = self;
        let OurTessellation { inputs, given, .. } = **ours;
        let explainer = Explainer { ours, assignment, other: other.map(|other| &other.inputs), reaches };
        let explanations = explainer.explain(&different);
        let own = Explanation { partitioning: inputs.tessellation.partitioning, rule: Rule::Same };
        if explanations.first() == Some(&own) || explainer.are_last_bits(&different) {
            return None;
        }
        // LOD measures control points, so that others have other factors, which are no mistake beside that.
        let measures = given.is_none() && inputs.tessellation.used_lod().reads().control_points;
        if measures && explanations.is_empty() && other.is_some_and(|other| other.mistake.is_some()) {
            return None;
        }
        let (sides, inside, suits) = self.other_cuts(&different);
        let (patches, of) = (different.len() as u64, self.compared().count() as u64);
        let Tessellation { partitioning, convention, .. } = inputs.tessellation;
        found.push(match explanations.is_empty() {
            false => Finding::Factors { ours: partitioning, convention, explanations, patches, of },
            true => {
                let is_of_view = given.is_none() && inputs.tessellation.used_lod().follows_view();
                let sides = sides.len() as u64;
                let ours = partitioning;
                Finding::UnknownFactors(UnknownFactors { patches, of, sides, inside, suits, ours, is_of_view })
            }
        });
        found.extend(self.cracks());
        Some(sides)
    }

    /// Which sides of these patches, whose points differ, are cut differently, those first that differ the most; how many patches
    /// have no such side, and so differ inside alone; and the partitionings that cut sides as theirs are cut.
    fn other_cuts(&self, different: &[u32]) -> (Vec<SideDifference>, u64, Vec<Partitioning>) {
        let (mut sides, mut inside): (Vec<SideDifference>, _) = (Vec::new(), 0);
        let mut suited = [0_usize; Partitioning::DIRECT3D.len()];
        for &patch in different {
            let (theirs, reach) = (self.cuts(patch), self.reaches[patch as usize].domain);
            let before = sides.len();
            sides.extend(self.side_differences(patch, &theirs));
            inside += u64::from(sides.len() == before);
            for (count, partitioning) in suited.iter_mut().zip(Partitioning::DIRECT3D) {
                *count += theirs.iter().filter(|cut| cut.suits(partitioning, reach)).count();
            }
        }
        sides.sort_by(|a, b| b.ratio().total_cmp(&a.ratio()));
        let suits = suited.into_iter().zip(Partitioning::DIRECT3D);
        let suits = suits.filter(|(count, _)| *count as f64 >= SUITS * 3.0 * different.len() as f64);
        (sides, inside, suits.map(|(_, partitioning)| partitioning).collect())
    }

    /// How their triangles cut the sides of a patch.
    fn cuts(&self, patch: u32) -> [Cut; 3] {
        cuts_of(&self.assignment.part(patch), self.reaches[patch as usize])
    }

    /// The sides of a patch that are cut differently.
    fn side_differences(&self, patch: u32, theirs: &[Cut; 3]) -> Vec<SideDifference> {
        let (own, reach) = (self.our_mesh.patch(patch), self.reaches[patch as usize].domain);
        let positions = self.ours.topology.patch_positions(patch);
        let shown = |cut: &Cut| SideCut { segments: cut.segments() as u64, factor: cut.factor() };
        let difference = |side: usize| {
            let own = Cut::new(side, own.weights.iter().copied(), reach);
            (!theirs[side].is_like(&own, reach)).then(|| SideDifference {
                triangle: self.triangle(patch),
                side: side as u32,
                ends: [positions[side], positions[(side + 1) % 3]].map(|end| end.to_array()),
                theirs: shown(&theirs[side]),
                ours: shown(&own),
            })
        };
        (0..3).filter_map(difference).collect()
    }

    /// Counts the edges between two patches that their sides cut differently, if there are any.
    fn cracks(&self) -> Option<Finding> {
        let topology = self.ours.topology;
        let cuts = made_of_all(self.all.len(), |patch| {
            (self.assignment.count(patch as u32) > 0).then(|| self.cuts(patch as u32).map(|cut| cut.factor() as f32))
        });
        let (mut edges, mut of) = (0, 0);
        for edge in topology.edges.iter().filter(|edge| !matches!(edge.kind, EdgeKind::Boundary)) {
            let cut = |side: &geometry::mesh::Side| cuts[side.patch() as usize].map(|cuts| cuts[side.index()]);
            let own: Vec<_> = topology.edge_sides(edge).iter().filter_map(cut).collect();
            if own.len() > 1 {
                of += 1;
                let differs = own.iter().any(|factor| (factor / own[0] - 1.0).abs() > 0.01);
                edges += u64::from(differs);
            }
        }
        (edges > 0).then_some(Finding::Cracked { edges, of })
    }

    /// What is wrong with triangles: those that are missing, doubled, wound the other way, or join other points. `is_mirrored` says that
    /// their coordinates are.
    pub(super) fn judge_triangles(&self, is_mirrored: bool) -> impl Iterator<Item = Finding> {
        let emitted = (0..self.all.len() as u32).filter(|patch| self.our_mesh.emits(*patch)).count() as u64;
        let named = |all: &[u32]| {
            let triangles: Vec<u32> = all.iter().take(NAMED).map(|patch| self.triangle(*patch)).collect();
            (!all.is_empty()).then_some((all.len() as u64, triangles))
        };
        let lost = named(&self.missing);
        let lost = lost.map(|(patches, triangles)| Finding::MissingPatches { patches, of: emitted, triangles });
        let additional = named(&self.additional);
        let additional = additional.map(|(patches, triangles)| Finding::AdditionalPatches { patches, triangles });
        let count = |of: fn(&Match) -> u64| {
            let counts = || self.compared().map(|(_, outcome)| of(&outcome.found)).filter(|count| *count > 0);
            (counts().sum::<u64>(), counts().count() as u64)
        };
        // Places of displaced vertices are too rough to tell one triangle from the next.
        let is_exact = self.assignment.overlaid.fit.is_finite();
        let exact = |of: fn(&Match) -> u64| Some(count(of)).filter(|(count, _)| is_exact && *count > 0);
        let missing = exact(|found| found.missing).map(|(count, patches)| Finding::MissingTriangles { count, patches });
        let doubled = exact(|found| found.doubled).map(|(count, patches)| Finding::Doubled { count, patches });
        let other = exact(|found| found.other);
        let other =
            other.map(|(count, patches)| Finding::OtherTriangles { count, patches, order: self.corner_order() });
        let [flipped, thin] = [count(|found| found.flipped).0, count(|found| found.thin).0];
        let of = self.compared().map(|(patch, _)| u64::from(self.assignment.count(patch))).sum();
        let flipped = if flipped > 0 && flipped + thin == of { of } else { flipped };
        // What is mirrored shows its other side, unless its winding was turned as well.
        let is_turned = flipped > 0 && !(is_mirrored && flipped == of);
        let flipped = is_turned.then_some(Finding::Flipped { count: flipped, of });
        [lost, additional, missing, doubled, flipped, other].into_iter().flatten()
    }

    /// The order of corners that explains all triangles that join other points.
    fn corner_order(&self) -> Option<CornerOrder> {
        let tessellation = self.ours.inputs.tessellation;
        if tessellation.partitioning.has_rows() {
            return None;
        }
        let written = self.ours.written(self.ours.inputs);
        let turned: Vec<u32> =
            self.compared().filter(|(_, outcome)| outcome.found.other > 0).map(|(patch, _)| patch).collect();
        let explains = |order: &CornerOrder| {
            turned.iter().all(|&patch| {
                let (part, own) = (self.assignment.part(patch), self.our_mesh.patch(patch));
                let found = Match::new(&part, &own, self.reaches[patch as usize]);
                let cut = (tessellation.convention, written[patch as usize], tessellation.partitioning);
                order.explains(&part, &own, &found, cut)
            })
        };
        CornerOrder::ALL.into_iter().find(explains)
    }
}

impl Outcome {
    fn new(assignment: &Assignment, own: &OurPatch, patch: u32, reach: Reach) -> Self {
        let part = assignment.part(patch);
        let found = Match::new(&part, own, reach);
        let (mut farthest, mut offsets): (Option<Farthest>, _) = (None, Offsets::default());
        for (&vertex, our_vertex) in part.vertices.iter().zip(&found.our_vertices) {
            let Some(our_vertex) = *our_vertex else { continue };
            let theirs = assignment.overlaid.positions[vertex as usize];
            let ours = own.positions[our_vertex as usize];
            let apart = Farthest { distance: theirs.distance(ours), patch, theirs, ours };
            farthest = Some(farthest.map_or(apart, |farthest| farthest.farther(apart)));
            offsets.add(theirs - ours, own.normals[our_vertex as usize]);
        }
        Self { found: Match { our_vertices: Vec::new(), ..found }, farthest, slack: 0.0, offsets }
    }
}

impl Offsets {
    fn add(&mut self, offset: DVec3, normal: DVec3) {
        /// The largest sine of the angle between an offset along a normal and that normal. Where a surface bends, the nearest
        /// place isn't the one that was displaced.
        const ASIDE: f64 = 0.3;
        let along = offset.dot(normal);
        self.vertices += 1;
        self.along_normals += u64::from((offset - normal * along).length() <= ASIDE * offset.length());
        self.outward = self.outward.max(along);
        self.inward = self.inward.max(-along);
    }

    fn with(self, other: Self) -> Self {
        Self {
            vertices: self.vertices + other.vertices,
            along_normals: self.along_normals + other.along_normals,
            outward: self.outward.max(other.outward),
            inward: self.inward.max(other.inward),
        }
    }
}

/// How far apart points of a patch may be in the domain if they are the same to within `exact` object units.
fn exact_reach(ours: &OurTessellation, patch: u32, exact: f64) -> f64 {
    let [a, b, c] = ours.topology.patch_positions(patch).map(|corner| corner.as_dvec3());
    let (sides, area) = ([a.distance(b), b.distance(c), c.distance(a)], (b - a).cross(c - a).length());
    // The least height of the triangle: along it, weights change the fastest.
    let height = area / sides.into_iter().fold(0.0, f64::max);
    let reach = 4.0 * exact / height;
    if reach.is_finite() { reach } else { f64::MAX }
}

/// The largest number of segments into which we cut a side, or the inside, of a patch.
fn segments_of(our_mesh: &OurMesh, patch: u32) -> f64 {
    let factors = our_mesh.tessellated.patch_factors[patch as usize];
    let outside = factors.outside.into_iter().map(segments).max().unwrap_or(1);
    f64::from(outside.max((factors.inside & FACTOR_VALUE).div_ceil(1 << 16)).max(1))
}

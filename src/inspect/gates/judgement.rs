//! Compares what was measured with the limits of gates, and finds the worst place of each that fails.

use glam::Vec3;
use serde::Serialize;

use super::mesh_defects::Defects;
use super::place::{EdgeSpot, PatchSpot, Place, Spot};
use super::{Gate, GateKind, Limit};
use crate::measure::{CrackedEdge, CrossedPatches, EdgeSide, Measured, PatchesAbove, Pop, WorstPoint};
use crate::render::{Leak, Leaks};
use geometry::choice::Choice;
use geometry::mesh::{EdgeKind, Mesh, TJunction, Topology};
use geometry::names::shown;
use geometry::near::Interval;
use geometry::numbers::{exact, grouped, hundredths, numbered, short};
use geometry::tessellate::Vertex;
use geometry::view::ScreenView;

/// What gates are judged by. What no gate asked for may be none; a gate without what it needs fails.
#[derive(Clone, Copy)]
pub struct Facts<'a> {
    /// The mesh in the pose that was tessellated.
    pub topology: &'a Topology,
    pub warnings: Option<&'a [String]>,
    /// The numbers of emitted vertices and triangles.
    pub emitted: Option<(u64, u64)>,
    pub measured: Option<&'a Measured>,
    /// The mesh as it was loaded, and its topology.
    pub mesh: Option<(&'a Mesh, &'a Topology)>,
    pub junctions: Option<&'a [TJunction]>,
    pub leaks: Option<&'a Leaks>,
    /// The view that leaks were counted in.
    pub view: Option<ScreenView>,
    pub above: Option<&'a PatchesAbove>,
    /// The patches that cross; none within if there were too many triangles to find them.
    pub crossed: Option<Option<&'a [CrossedPatches]>>,
    /// The distance from the reference surface, or why there is none.
    pub deviation: Option<Result<Deviation, &'static str>>,
    /// The farthest jump of a flight, none within if nothing in view moved; or why there is none.
    pub pop: Option<Result<Option<Pop>, &'static str>>,
}

/// The largest distance between what was emitted and a reference surface, both ways.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deviation {
    /// In object units.
    pub distance: Interval,
    /// Of the reference surface's bounding box.
    pub diagonal: f64,
    /// Where the lower end was found.
    pub worst: WorstPoint,
}

impl<'a> Facts<'a> {
    /// Facts of a mesh that nothing was measured of.
    pub fn from_mesh(topology: &'a Topology) -> Self {
        let (warnings, emitted, measured, junctions, leaks) = (None, None, None, None, None);
        let (mesh, view, above, crossed, deviation, pop) = (None, None, None, None, None, None);
        Self { topology, warnings, emitted, measured, mesh, junctions, leaks, view, above, crossed, deviation, pop }
    }
}

/// How a gate judged.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Judgement {
    #[serde(rename = "name")]
    pub gate: &'static str,
    #[serde(skip)]
    pub kind: GateKind,
    /// The largest number that passes.
    pub limit: Limit,
    /// What was counted or measured; none if nothing could be, and then the gate failed.
    pub found: Option<Found>,
    pub passed: bool,
    /// What was found, or why nothing could be counted, in a sentence without its end.
    pub text: String,
    /// The worst place of a gate that failed, if it is about a place.
    #[serde(rename = "where")]
    pub place: Option<Place>,
}

/// What a gate found: a number, a length in object units, or a distance on screen.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Found {
    Count(u64),
    Length(Interval),
    Px(f64),
}

impl Judgement {
    /// The sentence of a gate that failed, about the mesh with this name, without its end.
    pub fn sentence_of(&self, mesh: &str) -> String {
        format!("{mesh} fails the gate {}: {}", self.gate, self.sentence())
    }

    /// What failed, how much of it there is, and where, in one sentence without its end. Meant for gates that failed.
    pub fn sentence(&self) -> String {
        let place = self.place.as_ref().map(|place| format!("; {}", place.text)).unwrap_or_default();
        match self.found {
            Some(_) => format!("{}, {}{place}", self.text, self.limit.allowed()),
            None => self.text.clone(),
        }
    }
}

/// What was counted for a gate; or why nothing could be, and what to do.
type Count<'a> = Result<Counted<'a>, &'static str>;

struct Counted<'a> {
    found: Found,
    /// What was found, in a sentence without its end.
    text: String,
    /// Finds the worst place.
    worst: Box<dyn FnOnce() -> Option<Place> + 'a>,
}

/// What a gate says whose limit lies between the ends of what was measured. Such a gate fails.
const UNDECIDED: &str = ", so that it isn't decided whether that is more than the limit, which a limit above the second number \
                         would pass for certain";

/// Judges by each gate.
pub fn judge(gates: &[Gate], facts: &Facts) -> Vec<Judgement> {
    gates.iter().map(|gate| judged(*gate, facts)).collect()
}

/// What the gates of the mesh find in it, each with its worst place. Those that find nothing or need other facts are left out.
pub fn found_in_mesh(mesh: &Mesh, topology: &Topology) -> Vec<Judgement> {
    let of_mesh = GateKind::ALL.into_iter().filter(|kind| kind.is_of_mesh());
    let gates: Vec<Gate> = of_mesh.map(|kind| Gate { kind, limit: Limit::Count(0) }).collect();
    let judged = judge(&gates, &Facts { mesh: Some((mesh, topology)), ..Facts::from_mesh(topology) });
    judged.into_iter().filter(|judgement| judgement.found.is_some() && !judgement.passed).collect()
}

fn judged(Gate { kind, limit }: Gate, facts: &Facts) -> Judgement {
    let (found, mut text, worst) = match count(kind, facts) {
        Ok(Counted { found, text, worst }) => (Some(found), text, Some(worst)),
        Err(why) => (None, why.to_owned(), None),
    };
    let passed = match (found, limit) {
        (Some(Found::Count(count)), Limit::Count(limit)) => count <= limit,
        (Some(Found::Length(length)), Limit::Length(limit)) => {
            let diagonal = facts.deviation.and_then(Result::ok).map_or(0.0, |deviation| deviation.diagonal);
            let limit = limit.in_units(diagonal);
            if (length.at_least..length.at_most).contains(&limit) {
                text += UNDECIDED;
            }
            length.at_most <= limit
        }
        (Some(Found::Px(px)), Limit::Px(limit)) => px <= limit,
        _ => false,
    };
    let place = worst.filter(|_| !passed).and_then(|worst| worst());
    Judgement { gate: kind.name(), kind, limit, found, passed, text, place }
}

fn count<'a>(kind: GateKind, facts: &'a Facts) -> Count<'a> {
    let some = |number: u64, text: &str, worst: fn(&Facts) -> Option<Place>| {
        Ok(Counted::new(number, text, move || worst(facts)))
    };
    let measured = || known(facts.measured);
    let defects = |find: fn(&Mesh, &Topology) -> Defects, text| defects(facts, find, text);
    let edges =
        |kind, text| self::defects(facts, |_, topology| Defects::edges(topology, |edge| edge.kind == kind), text);
    match kind {
        GateKind::Cracks => some(measured()?.cracks.cracked().len() as u64, "# edge[ is|s are] cracked", worst_crack),
        GateKind::Factors => {
            let different = measured()?.cracks.different_factors;
            some(different, "# edge[ has|s have] sides with different factors", worst_factors)
        }
        GateKind::Leaks => some(leaking(facts)?, "# px show[s|] the inside of the mesh", worst_leak),
        GateKind::Folds => some(measured()?.folds, "# triangle[ is|s are] folded", worst_fold),
        GateKind::TJunctions => {
            some(known(facts.junctions)?.len() as u64, "the mesh has # T-junction[|s]", worst_junction)
        }
        GateKind::Warnings => {
            let (count, text) = warnings(known(facts.warnings)?);
            Ok(Counted { text, ..Counted::new(count, "", || None) })
        }
        GateKind::NonManifold => edges(EdgeKind::NonManifold, "# edge[ has|s have] three triangles or more"),
        GateKind::Boundary => edges(EdgeKind::Boundary, "# edge[ is|s are] open"),
        GateKind::Winding => defects(Defects::winding, "# edge[ has|s have] triangles wound opposite ways"),
        GateKind::NormalsAgainstFaces => {
            defects(Defects::against_faces, "# triangle[ has|s have] a normal that points behind [it|them]")
        }
        GateKind::Degenerate => defects(Defects::without_area, "# triangle[ has|s have] no area"),
        GateKind::Duplicates => defects(Defects::repeated, "# triangle[ repeats|s repeat] another one"),
        GateKind::NearSeam => defects(Defects::near_seam, "# open edge[ nearly meets|s nearly meet] another one"),
        GateKind::HardEdges => edges(EdgeKind::Split, "# edge[ has|s have] two normals at an end"),
        GateKind::Inflated => defects(Defects::inflated, "# triangle[ is|s are] blown up at [a hard edge|hard edges]"),
        GateKind::SelfIntersections => {
            let crossed = known(facts.crossed)?.ok_or("too many triangles were emitted to find those that cross")?;
            some(crossed.len() as u64, "# pair[|s] of patches cross[es|] each other", worst_crossing)
        }
        GateKind::Deviation => {
            let distance @ Interval { at_least, at_most } = known(facts.deviation)??.distance;
            let text = format!("the largest distance is {} to {} object units", short(at_least), short(at_most));
            Ok(Counted { found: Found::Length(distance), text, worst: Box::new(|| worst_deviation(facts)) })
        }
        GateKind::Pops => {
            let px = known(facts.pop)??.map_or(0.0, |pop| pop.px);
            let text = format!("the surface jumps by up to {} px from one frame of the flight to the next", short(px));
            Ok(Counted { found: Found::Px(px), text, worst: Box::new(|| worst_pop(facts)) })
        }
        GateKind::AboveTolerance => {
            let PatchesAbove { patches, tolerance_px, .. } = *known(facts.above)?;
            let px = exact(tolerance_px);
            let text = format!("# patch[ is|es are] farther than {px} px from [its|their] surface");
            some(patches, &text, worst_error)
        }
        GateKind::Triangles => some(known(facts.emitted)?.1, "# triangle[ is|s are] emitted", |_| None),
        GateKind::Bytes => {
            let (vertices, triangles) = known(facts.emitted)?;
            let bytes = vertices * size_of::<Vertex>() as u64 + triangles * size_of::<[u32; 3]>() as u64;
            some(bytes, "vertices and indices take # byte[|s]", |_| None)
        }
    }
}

impl<'a> Counted<'a> {
    /// A number with a text about it, as [`numbered`] takes it, and what finds the worst place.
    fn new(number: u64, text: &str, worst: impl FnOnce() -> Option<Place> + 'a) -> Self {
        Self { found: Found::Count(number), text: numbered(number, text), worst: Box::new(worst) }
    }
}

/// Counts the mesh's defects that `find` finds.
fn defects<'a>(facts: &Facts<'a>, find: impl Fn(&Mesh, &Topology) -> Defects, text: &str) -> Count<'a> {
    let (mesh, topology) = known(facts.mesh)?;
    let found = find(mesh, topology);
    Ok(Counted::new(found.count() as u64, text, move || worst_defect(found, mesh, topology)))
}

/// The px that leak.
fn leaking(facts: &Facts) -> Result<u64, &'static str> {
    match known(facts.leaks)? {
        Leaks::Counted(leaks) => Ok(leaks.iter().map(|leak| u64::from(leak.pixels)).sum()),
        Leaks::Open => {
            Err("leaks can be counted only in a closed mesh, and this one is open: leave this gate out for it")
        }
        Leaks::BothWays => {
            Err("leaks can be counted only where triangles that meet are wound the same way, and some of \
                                this mesh aren't: mend it, or leave this gate out for it")
        }
        Leaks::NearPlane => Err("leaks can't be counted where the near plane cuts the mesh: move the camera away"),
        Leaks::InNoView => {
            Err("leaks could be counted in none of the views: the near plane cuts the mesh in each, or \
                                positions aren't finite")
        }
    }
}

/// A fact that a gate needs.
fn known<T>(fact: Option<T>) -> Result<T, &'static str> {
    fact.ok_or("what it counts was not measured, which is an error of pnaen")
}

/// How many warnings loading gave, and the first of them.
fn warnings(all: &[String]) -> (u64, String) {
    let said = match all {
        [] => "loading gave no warning".to_owned(),
        [only] => format!("loading gave a warning ({})", clause(only)),
        [first, ..] => {
            format!("loading gave {} warnings (the first: {})", grouped(all.len() as u64), clause(first))
        }
    };
    (all.len() as u64, said)
}

/// A warning within a sentence.
fn clause(warning: &str) -> String {
    shown(warning).trim_end_matches('.').to_owned()
}

/// A place on an edge of the mesh.
struct EdgePlace {
    /// The mesh's triangles that meet there.
    triangles: Vec<u32>,
    spot: EdgeSpot,
}

impl EdgePlace {
    /// A place on the edge with this index. Without a position, it is the middle.
    fn new(topology: &Topology, index: u32, at: Option<Vec3>) -> Self {
        let edge = &topology.edges[index as usize];
        let sides = topology.edge_sides(edge).iter();
        let triangles = sides.map(|side| topology.patches[side.patch() as usize].triangle).collect();
        Self { triangles, spot: EdgeSpot::new(topology, index, at) }
    }

    /// Between which triangles it is, and where.
    fn words(&self) -> String {
        let between = match self.triangles[..] {
            [only] => format!("of triangle {only}"),
            [a, b] => format!("between triangles {a} and {b}"),
            _ => format!("between {} triangles", self.triangles.len()),
        };
        format!("{between} at {}", position(self.spot.at))
    }

    /// The place, said after these words.
    fn after(self, words: &str) -> Place {
        Place { text: format!("{words} {}", self.words()), triangles: self.triangles, spot: Spot::Edge(self.spot) }
    }
}

/// A position in object units, in words.
fn position(place: Vec3) -> String {
    let [x, y, z] = place.to_array().map(|coordinate| short(f64::from(coordinate)));
    format!("({x}, {y}, {z})")
}

fn worst_crack(facts: &Facts) -> Option<Place> {
    // The widest gap is the first.
    let crack = facts.measured?.cracks.cracked().first()?;
    let gap = short(crack.gap);
    let [a, b] = crack.widest;
    let place = EdgePlace::new(facts.topology, crack.edge, Some(a * 0.5 + b * 0.5));
    let mut place = place.after(&format!("the widest gap, {gap} object units, is"));
    let left_out = |patch: u32| {
        let triangle = facts.topology.patches[patch as usize].triangle;
        format!(", where the factors of triangle {triangle} leave it out")
    };
    place.text.extend(crack.discarded.map(left_out));
    Some(place)
}

fn worst_factors(facts: &Facts) -> Option<Place> {
    let measured = facts.measured?;
    let outlines = &measured.outlines;
    let range = |crack: &CrackedEdge| {
        let sides =
            [outlines.edge(facts.topology, crack.edge), outlines.discarded(facts.topology, crack.edge)].concat();
        // A factor that is not a number differs the most.
        let by_size = |a: &f32, b: &f32| a.is_nan().cmp(&b.is_nan()).then(a.total_cmp(b));
        let factors = sides.iter().map(|side| side.factor);
        Some((crack.edge, factors.clone().min_by(by_size)?, factors.max_by(by_size)?))
    };
    let different = measured.cracks.edges.iter().filter(|crack| crack.different_factors).filter_map(range);
    let apart = |least: f32, most: f32| if most.is_nan() { f32::INFINITY } else { most - least };
    let (edge, least, most) = different.reduce(|a, b| if apart(b.1, b.2) > apart(a.1, a.2) { b } else { a })?;
    let factors = format!("{} and {}", exact(least), exact(most));
    // In the middle of what was emitted, since the middle of a straight line may lie below the surface.
    let emitted = outlines.edge(facts.topology, edge).into_iter().next();
    let emitted: Vec<Vec3> = emitted.iter().flat_map(EdgeSide::positions).collect();
    let at = emitted.get(emitted.len() / 2).copied();
    Some(EdgePlace::new(facts.topology, edge, at).after(&format!("the factors differ most, {factors},")))
}

fn worst_leak(facts: &Facts) -> Option<Place> {
    let Some(Leaks::Counted(leaks)) = facts.leaks else { return None };
    // The largest is the first.
    let leak = leaks.first()?;
    let Leak { px, pixels } = *leak;
    let torn = torn_at(facts, leak);
    let there = torn.as_ref().map(|torn| format!(", {}", torn.words())).unwrap_or_default();
    let [x, y] = px.floor().to_array();
    let text = format!("the largest leak, {} px, is at x {x}, y {y} px of the picture{there}", grouped(pixels.into()));
    let (triangles, torn) = torn.map(|torn| (torn.triangles, torn.spot)).unzip();
    Some(Place { text, triangles: triangles.unwrap_or_default(), spot: Spot::Leak { px, pixels, torn } })
}

/// The edge that is torn where a leak is seen.
fn torn_at(facts: &Facts, leak: &Leak) -> Option<EdgePlace> {
    let crack = facts.measured?.crack_seen_at(facts.topology, &facts.view?, leak.px)?;
    // A px of a leak lies within its crack, or within a hole, of which no px is farther from its border than its area allows; the
    // rasteriser rounds to px.
    let most = 2.0 + crack.gap_px + (leak.pixels as f32).sqrt();
    (crack.px <= most).then(|| EdgePlace::new(facts.topology, crack.edge, Some(crack.at)))
}

/// A place on a patch: its triangle and the position, after these words.
fn on_patch(facts: &Facts, words: &str, patch: u32, at: Vec3) -> Place {
    let triangle = facts.topology.patches[patch as usize].triangle;
    on_triangle(words, triangle, facts.topology.patch_positions(patch), at)
}

/// The same for a triangle of the mesh, which has these corners.
fn on_triangle(words: &str, triangle: u32, corners: [Vec3; 3], at: Vec3) -> Place {
    let text = format!("{words} triangle {triangle} at {}", position(at));
    Place { text, triangles: vec![triangle], spot: Spot::Patch(PatchSpot::new(corners, at)) }
}

fn worst_fold(facts: &Facts) -> Option<Place> {
    // The largest area is the first.
    let fold = facts.measured?.folded.first()?;
    let words = format!("the largest are {} of", grouped(fold.folds.into()));
    Some(Place { spot: Spot::fold(fold), ..on_patch(facts, &words, fold.patch, fold.place()) })
}

fn worst_junction(facts: &Facts) -> Option<Place> {
    let worst = facts.junctions?.iter().reduce(|a, b| if b.distance > a.distance { b } else { a })?;
    let at = facts.topology.points[worst.point as usize];
    let distance = short(f64::from(worst.distance));
    let place = EdgePlace::new(facts.topology, worst.edge, Some(at));
    Some(place.after(&format!("the farthest point lies {distance} object units beside the edge")))
}

/// The longest edge or the largest triangle that has a defect, or the one that rises most.
fn worst_defect(defects: Defects, mesh: &Mesh, topology: &Topology) -> Option<Place> {
    let corners =
        |triangle: u32| mesh.triangles[triangle as usize].map(|corner| mesh.corners[corner as usize].position);
    let in_middle = |words: &str, triangle: u32| {
        let corners = corners(triangle);
        on_triangle(words, triangle, corners, corners.iter().sum::<Vec3>() / 3.0)
    };
    Some(match defects {
        Defects::Edges(edges) => {
            let length = |edge: &u32| {
                let [a, b] = topology.edge_points(&topology.edges[*edge as usize]);
                topology.points[a as usize].distance_squared(topology.points[b as usize])
            };
            let longest = edges.into_iter().max_by(|a, b| length(a).total_cmp(&length(b)))?;
            EdgePlace::new(topology, longest, None).after("the longest is")
        }
        Defects::Triangles(triangles) => {
            let longest = |triangle: &u32| {
                let [a, b, c] = corners(*triangle);
                a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a))
            };
            in_middle("the longest is", triangles.into_iter().max_by(|a, b| longest(a).total_cmp(&longest(b)))?)
        }
        Defects::Inflated(triangles) => {
            let (triangle, rise) = triangles.into_iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
            in_middle(&format!("most, by {} object units, rises", short(rise)), triangle)
        }
    })
}

fn worst_crossing(facts: &Facts) -> Option<Place> {
    // The pair with the most crossing triangles is the first.
    let CrossedPatches { patches, at, .. } = *facts.crossed??.first()?;
    let triangles = patches.map(|patch| facts.topology.patches[patch as usize].triangle);
    let corners = facts.topology.patch_positions(patches[0]);
    let [a, b] = triangles;
    let text = format!("most triangles cross between those of triangles {a} and {b} at {}", position(at));
    Some(Place { text, triangles: triangles.to_vec(), spot: Spot::Patch(PatchSpot::new(corners, at)) })
}

fn worst_pop(facts: &Facts) -> Option<Place> {
    let Pop { patch, at, .. } = facts.pop?.ok()??;
    Some(on_patch(facts, "the farthest jump is of", patch, at))
}

fn worst_deviation(facts: &Facts) -> Option<Place> {
    let Deviation { worst, .. } = facts.deviation?.ok()?;
    let mut place = on_patch(facts, "the farthest is of", worst.patch, worst.emitted.as_vec3());
    place.text += &format!(", and on the reference surface at {}", position(worst.reference_shape.as_vec3()));
    Some(place)
}

fn worst_error(facts: &Facts) -> Option<Place> {
    let worst = facts.above?.worst?;
    let words = format!("the farthest, {} px, is of", hundredths(worst.value));
    Some(on_patch(facts, &words, worst.patch, worst.emitted.as_vec3()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gate_without_the_fact_that_it_needs_fails() {
        let topology = Topology::default();
        let gates = GateKind::ALL.map(|kind| Gate { kind, limit: Limit::Count(u64::MAX) });
        for judgement in judge(&gates, &Facts::from_mesh(&topology)) {
            assert_eq!((judgement.found, judgement.passed), (None, false), "{judgement:?}");
            let sentence = judgement.sentence_of("a.glb");
            let expected = format!("a.glb fails the gate {}: what it counts was not measured", judgement.gate);
            assert!(sentence.starts_with(&expected), "{sentence}");
        }
    }
}

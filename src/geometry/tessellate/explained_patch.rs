//! Explains what LOD by error makes of one patch: what was asked of its edges and by whom, and how far its triangles are
//! from the surface. It uses the functions with which factors are searched for.

use super::control_nets::ControlNets;
use super::factors::{
    ROW_BASE_STEP, inside_segments, patch_has_rows, patch_is_culled, patch_is_minimal, patch_is_subtriangulated,
    row_width, segments,
};
use super::least_factors::{BEYOND_LAST, ChosenFactors, SearchGoal};
use super::lod::point_distance_factor;
use super::mesh_displacement::displacing_heights;
use super::mesh_factors::MeshLod;
use super::mesh_tessellation::seen_with_reach;
use super::piece_error::{SeenPatch, may_slide, piece_error};
use super::relief::SeenRelief;
use super::{
    Clip, Convention, FIXED_ONE, Inputs, Lod, LodView, Normals, Partitioning, PatchFactors, Tessellation,
    corner_weights, domain_plan, domain_point, domain_side, domain_triangle, edge_length_factor, paper_edge_factor,
    process, triangle_count,
};
use crate::mesh::{Mesh, Topology};
use glam::{Vec2, Vec3};

/// What LOD by error makes of a patch, and why.
#[derive(Clone, Debug, PartialEq)]
pub struct ExplainedPatch {
    /// How far the triangles may be from the surface, in px: LOD's tolerance, of a part with a detail so many times less.
    pub tolerance: f32,
    /// What was asked of the edges of sides 0, 1 and 2; `None` under other LODs.
    pub edges: Option<[ExplainedEdge; 3]>,
    /// What the factors of sides 0, 1 and 2 are computed from, and the detail of these sides; `None` under LOD by error.
    pub formulas: Option<[(EdgeFormula, f32); 3]>,
    /// Whether LOD by error allows points to slide along the surface: see `flat_patch.rs`. The errors then are distances to
    /// the nearest point of the surface.
    pub is_flat: bool,
    /// How far the triangles are from the surface at the factors that are used; `None` if nothing is emitted.
    pub errors: Option<PatternErrors>,
    /// The fewest triangles that are known to keep the tolerance, if nothing is asked of the patch by others.
    pub minimum: Minimum,
}

/// What was asked of an edge.
#[derive(Clone, Debug, PartialEq)]
pub struct ExplainedEdge {
    /// The least factor that the edge may get: its curves need it.
    pub least: f32,
    /// The factor that the patch requests.
    pub own: f32,
    /// The other patches on the edge, and the factors that they request.
    pub others: Vec<(u32, f32)>,
    /// The factor that it gets: the largest of these; a larger one if patches asked again; or what all edges get.
    pub got: f32,
}

/// What an LOD with a formula computes the factor of an edge from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EdgeFormula {
    /// All edges have the factor that is set, times their detail.
    Uniform { factor: f32 },
    /// The length on screen, in px, of the control polygon of the edge's longest curve, and of a segment. Their quotient times the
    /// edge's detail is the factor, if it isn't below 1.
    Length { px: f32, segment: f32 },
    /// How far the edge's ends are from the eye, in bounding radii, and their factors, whose mean the edge gets.
    Distance { radii: [f32; 2], factors: [f32; 2] },
}

/// Whose request an edge got.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DecidedBy {
    /// Nobody requested more than the edge's curve needs by itself.
    Curve,
    /// The patch that is explained.
    Own,
    /// A patch beside it.
    Other,
    /// Both requested the same.
    Both,
    /// One of them asked again, since no inside factor, or only a much larger one, sufficed beside what the edges got first.
    /// Or all edges got one factor that is larger than what these requested.
    Again,
    /// Nobody: all edges got one factor, which takes fewer triangles.
    All,
}

impl ExplainedEdge {
    /// Returns the largest factor that other patches request, if there are any.
    pub fn other(&self) -> Option<f32> {
        self.others.iter().map(|&(_, factor)| factor).reduce(f32::max)
    }

    /// Returns whose request the edge got.
    pub fn decided_by(&self) -> DecidedBy {
        let most = self.own.max(self.other().unwrap_or(0.0));
        match (self.own == self.got, self.other() == Some(self.got)) {
            _ if self.got < most => DecidedBy::All,
            _ if self.got == self.least => DecidedBy::Curve,
            _ if self.got > most => DecidedBy::Again,
            (true, true) => DecidedBy::Both,
            (true, false) => DecidedBy::Own,
            _ => DecidedBy::Other,
        }
    }
}

/// Upper bounds of how far the triangles of a pattern are from the surface on screen, in px. They are at most a
/// hundredth above what the finest bound says, and infinite where no bound holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatternErrors {
    /// Of the rows along sides 0, 1 and 2; `None` if the pattern has no rows.
    pub rows: Option<[f32; 3]>,
    /// Of the triangles along no edge; of all triangles if the pattern has no rows.
    pub inside: f32,
}

impl PatternErrors {
    /// Returns the largest of them.
    pub fn largest(&self) -> f32 {
        self.rows.into_iter().flatten().fold(self.inside, f32::max)
    }
}

/// The factors with which a patch alone would keep the tolerance with the fewest triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Minimum {
    /// The factors of sides 0, 1 and 2.
    pub sides: [f32; 3],
    /// Of rows their width.
    pub inside: f32,
    pub triangles: u32,
}

/// Returns the inputs under which a patch's minimum triangle count is searched for: LOD by error with the settings' tolerance. All else
/// that it doesn't depend on has its default, so that it isn't searched for again when that changes. Subtriangulation has
/// one number of segments everywhere, so that whole numbers stand in for it.
pub fn minimum_inputs(inputs: &Inputs) -> Inputs {
    let own = inputs.tessellation;
    let tessellation = Tessellation {
        normals: Normals::Linear,
        clip: Clip::Off,
        cull_back_faces: false,
        convention: Convention::default(),
        ..own.by_error(own.tolerance)
    };
    Inputs { tessellation, ..*inputs }
}

/// Returns a minimum with its number of triangles.
fn minimum(partitioning: Partitioning, ChosenFactors { edges: [u, v, w], inside, .. }: ChosenFactors) -> Minimum {
    let triangles = triangle_count(process(partitioning, [u, v, w], inside));
    Minimum { sides: [w, u, v], inside: inside % ROW_BASE_STEP as f32, triangles }
}

/// Explains a patch (an index into [`Topology::patches`]) that is emitted with these factors. Without displacement it looks
/// at the patch and its neighbours alone; with displacement, at the whole mesh.
pub fn explain_patch(
    mesh: &Mesh,
    topology: &Topology,
    inputs: &Inputs,
    patch: u32,
    used: PatchFactors,
) -> ExplainedPatch {
    let inputs = &seen_with_reach(mesh, inputs);
    let searched = &minimum_inputs(inputs);
    let is_displaced = displacing_heights(mesh, inputs).is_some();
    let nets = if is_displaced {
        ControlNets::new(mesh, topology, searched)
    } else {
        ControlNets::from_edges(mesh, topology, searched, edges_around(topology, patch).into_iter())
    };
    let lod = MeshLod::from_nets(nets, searched);
    let seen = lod.seen_patch(patch);
    let own = lod.minimum_factors(patch, &seen);
    let by_error = inputs.tessellation.lod.is_by_error();
    let is_flat = by_error && may_slide(&seen, searched.tessellation.tolerance);
    let mut measured = seen;
    if !is_flat {
        (measured.off_plane, measured.off_line) = (3.4e38, 3.4e38);
    }
    if !by_error {
        // Other LODs don't read heights where their bounds hold.
        measured.relief = SeenRelief::NONE;
    }
    let tolerance = searched.tessellation.tolerance;
    let detail = topology.detail_of(mesh, patch);
    // What is seen of a part with a detail is magnified.
    let errors = pattern_errors(&measured, inputs.tessellation.convention, used).map(|own| PatternErrors {
        rows: own.rows.map(|rows| rows.map(|px| px / detail)),
        inside: own.inside / detail,
    });
    let tolerance = tolerance / detail;
    let mut minimum = minimum(searched.tessellation.partitioning, own);
    // The search doesn't try all factors. What is drawn may have fewer triangles than it found, because neighbours requested more
    // along the edges.
    let drawn = triangle_count(used);
    let is_within = errors.is_some_and(|errors| errors.largest() <= tolerance) && (by_error || !is_displaced);
    if is_within && drawn < minimum.triangles {
        let sides = [0, 1, 2].map(|k| used_factor(inputs.tessellation.convention, used, k));
        minimum = Minimum { sides, inside: inside_cut(used) as f32, triangles: drawn };
    }
    ExplainedPatch {
        tolerance,
        edges: by_error.then(|| {
            [0, 1, 2].map(|k| lod.explain_edge(patch, k, used_factor(inputs.tessellation.convention, used, k)))
        }),
        formulas: (!by_error).then(|| [0, 1, 2].map(|side| edge_formula(&lod.nets, inputs, patch, side))),
        is_flat,
        errors,
        minimum,
    }
}

/// The length of a segment, in px, in which lengths are measured: those below it count as that.
const FINE: f32 = 1.0 / 1024.0;

/// Returns what the factor of a patch's side is computed from.
fn edge_formula(nets: &ControlNets, inputs: &Inputs, patch: u32, side: usize) -> (EdgeFormula, f32) {
    let Inputs { tessellation: Tessellation { lod, factor, pixels, near, far, .. }, ref view } = *inputs;
    let at = nets.patch_factor(patch, side) as usize;
    let curves = nets.curves.factor_curves[at]..nets.curves.factor_curves[at + 1];
    // All curves of an edge have its detail.
    let detail = nets.detail_of_curve(curves.start);
    let nets = curves.map(|curve| nets.curve_points(curve));
    let longest = |px: fn(&LodView, f32, [Vec3; 4]) -> f32| EdgeFormula::Length {
        px: nets.clone().map(|net| px(view, FINE, net) * FINE).fold(0.0, f32::max),
        segment: pixels,
    };
    let formula = match lod {
        Lod::Uniform | Lod::Error => EdgeFormula::Uniform { factor },
        Lod::Paper => longest(paper_edge_factor),
        Lod::EdgeLength => longest(edge_length_factor),
        Lod::Distance => {
            let [a, _, _, b] = nets.clone().next().unwrap_or_default();
            EdgeFormula::Distance {
                radii: [a, b].map(|end| end.distance(view.eye) / view.radius),
                factors: [a, b].map(|end| point_distance_factor(view, factor * detail, near, far, end)),
            }
        }
    };
    (formula, detail)
}

/// Returns the minimum triangle count of every patch.
pub fn minimum_triangles(mesh: &Mesh, topology: &Topology, inputs: &Inputs) -> Vec<u32> {
    let lod = MeshLod::new(mesh, topology, &minimum_inputs(&seen_with_reach(mesh, inputs)));
    let own = |patch| lod.minimum_factors(patch, &lod.seen_patch(patch));
    let patches = 0..topology.patches.len() as u32;
    patches.map(|patch| minimum(lod.inputs.tessellation.partitioning, own(patch)).triangles).collect()
}

/// Returns the edges of a patch and of all patches that share an edge with it, in ascending order.
fn edges_around(topology: &Topology, patch: u32) -> Vec<u32> {
    let edges = |patch: u32| topology.patches[patch as usize].sides.map(|side| topology.sides[side as usize].edge);
    let sides = |edge: u32| topology.edge_sides(&topology.edges[edge as usize]).iter();
    let patches = edges(patch).into_iter().flat_map(|edge| sides(edge).map(|side| side.patch()));
    let mut all: Vec<u32> = patches.flat_map(edges).collect();
    all.sort_unstable();
    all.dedup();
    all
}

impl MeshLod<'_> {
    /// Returns what was asked of the edge of a patch's side. A factor that no other patch shares, as published, is asked
    /// for by this one alone.
    fn explain_edge(&self, patch: u32, side: usize, used: f32) -> ExplainedEdge {
        let (nets, topology) = (&self.nets, self.nets.topology);
        let factor = nets.patch_factor(patch, side);
        let requested = |patch: u32, side: usize| {
            let seen = self.seen_patch(patch);
            let least = self.first_least(patch, &seen, |factor| self.least_edge_factor(factor));
            let own = self.fewest(&seen, least, 0.0, SearchGoal::Requests);
            own.requests(self.inputs.tessellation.partitioning)[(side + 2) % 3]
        };
        let own_side = topology.sides[topology.patches[patch as usize].sides[side] as usize];
        let sides = topology.edge_sides(&topology.edges[own_side.edge as usize]).iter();
        let others = sides.filter(|other| (other.patch(), other.index()) != (patch, side));
        let others = others.filter(|other| nets.patch_factor(other.patch(), other.index()) == factor);
        let others: Vec<_> = others.map(|other| (other.patch(), requested(other.patch(), other.index()))).collect();
        let own = requested(patch, side);
        let most = others.iter().map(|&(_, factor)| factor).fold(own, f32::max);
        let got = if used > 0.0 && is_enough(most) { used } else { most.max(used) };
        ExplainedEdge { least: self.least_edge_factor(factor), own, others, got }
    }
}

/// Returns the number of segments that the edge of a patch's side has; 0 if nothing is emitted.
fn used_factor(convention: Convention, used: PatchFactors, side: usize) -> f32 {
    let index = (0..3).find(|&i| domain_side(convention, i) as usize == side).unwrap_or(0);
    if patch_is_culled(used) { 0.0 } else { segments(used.outside[index as usize]) as f32 }
}

/// Returns into how many segments a patch is cut inside; of rows to how many they widen.
pub fn inside_cut(factors: PatchFactors) -> u32 {
    if patch_has_rows(factors) {
        return row_width(factors);
    }
    if patch_is_minimal(factors) { 1 } else { inside_segments(factors.inside) }
}

/// Returns how far the triangles of a pattern are from the surface; `None` if it has none.
fn pattern_errors(seen: &SeenPatch, convention: Convention, factors: PatchFactors) -> Option<PatternErrors> {
    let all = triangle_count(factors);
    if all == 0 {
        return None;
    }
    if patch_is_minimal(factors) || patch_is_subtriangulated(factors) || patch_has_rows(factors) {
        return Some(PatternErrors { rows: None, inside: largest_error(seen, convention, factors, 0, all) });
    }
    // The rows of the three edges come first, one after another.
    let inner = inside_segments(factors.inside) - 2;
    let mut rows = [0.0; 3];
    let mut first = 0;
    for i in 0..3 {
        let end = first + segments(factors.outside[i as usize]) + inner;
        rows[domain_side(convention, i) as usize] = largest_error(seen, convention, factors, first, end);
        first = end;
    }
    Some(PatternErrors { rows: Some(rows), inside: largest_error(seen, convention, factors, first, all) })
}

/// Returns a bound on the error of the triangles `first` to `end` of a pattern, in px.
fn largest_error(seen: &SeenPatch, convention: Convention, factors: PatchFactors, first: u32, end: u32) -> f32 {
    let plan = domain_plan(factors);
    let place = |i| {
        let [x, y] = corner_weights(convention, domain_point(&plan, i));
        Vec2::new(x as f32, y as f32) / FIXED_ONE as f32
    };
    let mut largest = 0.0;
    for t in first..end {
        let at = domain_triangle(&plan, t).map(place);
        // Most triangles are within the largest error so far, which takes the least time to tell.
        let error = piece_error(seen, largest, at);
        if error > largest || error.is_nan() {
            largest = finest_bound(seen, at).max(largest);
        }
    }
    largest
}

/// A larger error is no error: where there is no bound, it is the number that stands for infinity.
const LARGEST: f32 = 3.3e38;

/// Returns the least bound that [`piece_error`] gives for a triangle, to a hundredth of the bound without a grid; infinity
/// if there is none.
fn finest_bound(seen: &SeenPatch, at: [Vec2; 3]) -> f32 {
    let bound = piece_error(seen, LARGEST, at);
    if bound > LARGEST || bound.is_nan() {
        return f32::INFINITY;
    }
    let (mut beyond, mut within) = (0.0, bound);
    for _ in 0..7 {
        let tried = 0.5 * (beyond + within);
        let error = piece_error(seen, tried, at);
        if error <= tried {
            within = error;
        } else {
            beyond = tried;
        }
    }
    within
}

/// Returns whether a factor, or an inside factor of any partitioning, is one that there is, and not [`BEYOND_LAST`].
pub fn is_enough(factor: f32) -> bool {
    factor % (ROW_BASE_STEP as f32) < BEYOND_LAST
}

#[cfg(test)]
mod tests;

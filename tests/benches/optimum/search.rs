//! The fewest triangles with which the tessellator's pattern keeps a tolerance: what LOD by error is compared with.
//!
//! The least factors are searched for, with the error sampled in f64: a local search over the factors of all edges,
//! where every patch takes the least inside factor that suffices. Sampling may miss the largest error, so that the
//! result may be slightly too small. If every patch could choose the factors of its edges for itself, there would be
//! fewer triangles yet: that is the lower bound.

use std::collections::HashMap;

use geometry::mesh::{Mesh, Topology};
use geometry::tessellate::{
    ControlNet, FIXED_ONE, HullFactors, Inputs, LimitSurface, NOT_CULLED, Partitioning, SeenPatch, cull_reason,
    domain_plan, domain_point, domain_triangle, hull_factors, piece_error, process, tessellate,
};
use glam::{DMat4, DVec2, DVec4, Vec2};
use inspect::measure::{EmittedChunk, ScreenErrorMeasurement, Visitor};

/// The number of steps of the grid that each triangle is sampled on.
const STEPS: u32 = 8;

/// The fewest triangles that were found.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Optimum {
    pub(crate) triangles: u64,
    /// No factors need fewer triangles than this, as far as sampling tells.
    pub(crate) lower_bound: u64,
    /// The least factor that, used everywhere, keeps the tolerance, and its number of triangles; `None` if none does.
    pub(crate) uniform: Option<(u32, u64)>,
}

/// A patch whose factors are searched.
struct Patch {
    clip: [DVec4; 10],
    seen: SeenPatch,
    half: DVec2,
    tolerance: f64,
    partitioning: Partitioning,
    edges: [usize; 3],
    /// Whether rows are within the tolerance: by edge of the pattern, edge factor and inside factor.
    rows: HashMap<(u8, u8, u8), bool>,
    insides: HashMap<u8, bool>,
    single: Option<bool>,
    /// The inside factors that were found for three edge factors, and their numbers of triangles.
    known: HashMap<[u32; 3], Option<(u32, u64)>>,
}

/// The factors of a partitioning.
fn levels(partitioning: Partitioning) -> Vec<u32> {
    (1..=64).filter(|segments| partitioning.has_segments(*segments)).collect()
}

impl Patch {
    fn new(inputs: &Inputs, seen: SeenPatch, net: &ControlNet, edges: [usize; 3]) -> Self {
        let matrix: DMat4 = inputs.view.clip_from_object.as_dmat4();
        let [ab, ba, bc, cb, ca, ac] = net.edges;
        let [a, b, c] = net.corners;
        let points = [a, b, c, ab, ba, bc, cb, ca, ac, net.center];
        Self {
            seen,
            clip: points.map(|p| matrix * p.as_dvec3().extend(1.0)),
            half: inputs.view.half_viewport.as_dvec2(),
            tolerance: f64::from(inputs.tessellation.tolerance),
            partitioning: inputs.tessellation.partitioning,
            edges,
            rows: HashMap::new(),
            insides: HashMap::new(),
            single: None,
            known: HashMap::new(),
        }
    }

    fn surface(&self, [x, y, z]: [f64; 3]) -> DVec4 {
        let p = &self.clip;
        p[0] * (x * x * x)
            + p[1] * (y * y * y)
            + p[2] * (z * z * z)
            + (p[3] * x + p[4] * y) * (3.0 * x * y)
            + (p[5] * y + p[6] * z) * (3.0 * y * z)
            + (p[7] * z + p[8] * x) * (3.0 * z * x)
            + p[9] * (6.0 * x * y * z)
    }

    /// Whether a flat triangle is within the tolerance wherever it is seen.
    fn suffices(&self, corners: [[f64; 3]; 3]) -> bool {
        // What the bound decides needs no samples.
        let at = corners.map(|corner| Vec2::new(corner[0] as f32, corner[1] as f32));
        let tolerance = 0.99 * self.tolerance as f32;
        if piece_error(&self.seen, tolerance, at) <= tolerance {
            return true;
        }
        let flat = corners.map(|corner| self.surface(corner));
        let seen = |clip: DVec4| clip.x.abs() <= clip.w && clip.y.abs() <= clip.w && clip.z <= clip.w;
        let sample = |weights: [f64; 3]| {
            let mix = |k: usize| (0..3).map(|c| weights[c] * corners[c][k]).sum::<f64>();
            let surface = self.surface([mix(0), mix(1), mix(2)]);
            let emitted: DVec4 = (0..3).map(|c| flat[c] * weights[c]).sum();
            let (a, b) = (surface, emitted);
            if !(seen(a) || seen(b)) || a.w <= 0.0 || b.w <= 0.0 || a.z > a.w || b.z > b.w {
                return true;
            }
            let place = |clip: DVec4| DVec2::new(clip.x, clip.y) / clip.w * self.half;
            place(a).distance(place(b)) <= self.tolerance
        };
        // The middles of the edges first, which are the worst places of most triangles.
        let middles = [[0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5]];
        middles.into_iter().all(sample)
            && (0..=STEPS).all(|i| {
                (0..=STEPS - i).all(|j| sample([i, j, STEPS - i - j].map(|x| f64::from(x) / f64::from(STEPS))))
            })
    }

    /// Whether some triangles of a pattern are within the tolerance.
    fn all_suffice(&self, edges: [u32; 3], inside: u32, which: impl Fn(u32, u32) -> std::ops::Range<u32>) -> bool {
        let factors = process(self.partitioning, edges.map(|factor| factor as f32), inside as f32);
        let plan = domain_plan(factors);
        let outer: u32 = edges.iter().sum();
        which(outer, geometry::tessellate::triangle_count(factors)).all(|t| {
            let at = |i| {
                let [u, v] = domain_point(&plan, i).map(|x| f64::from(x) / f64::from(FIXED_ONE));
                [u, v, 1.0 - u - v]
            };
            self.suffices(domain_triangle(&plan, t).map(at))
        })
    }

    fn row(&mut self, k: usize, edge: u32, inside: u32) -> bool {
        let key = (k as u8, edge as u8, inside as u8);
        if let Some(&known) = self.rows.get(&key) {
            return known;
        }
        let first = self.levels_first();
        let mut edges = [first; 3];
        edges[k] = edge;
        let start = k as u32 * (first + inside - 2);
        let own = self.all_suffice(edges, inside, |_, _| start..start + edge + inside - 2);
        self.rows.insert(key, own);
        own
    }

    /// A factor for edges that don't matter, with which the pattern has rings.
    fn levels_first(&self) -> u32 {
        if self.partitioning == Partitioning::FractionalOdd { 3 } else { 2 }
    }

    fn inside(&mut self, inside: u32) -> bool {
        if let Some(&known) = self.insides.get(&(inside as u8)) {
            return known;
        }
        let first = self.levels_first();
        let own = self.all_suffice([first; 3], inside, |outer, all| outer + 3 * (inside - 2)..all);
        self.insides.insert(inside as u8, own);
        own
    }

    fn single(&mut self) -> bool {
        if let Some(known) = self.single {
            return known;
        }
        let own = self.partitioning != Partitioning::FractionalEven && self.all_suffice([1; 3], 1, |_, _| 0..1);
        self.single = Some(own);
        own
    }

    /// The least inside factor with these factors of the edges opposite corners 0, 1 and 2, and the number of triangles.
    fn least(&mut self, edges: [u32; 3], levels: &[u32]) -> Option<(u32, u64)> {
        if let Some(&known) = self.known.get(&edges) {
            return known;
        }
        let least = self.find_least(edges, levels);
        self.known.insert(edges, least);
        least
    }

    fn find_least(&mut self, edges: [u32; 3], levels: &[u32]) -> Option<(u32, u64)> {
        if edges == [1; 3] && self.single() {
            return Some((1, 1));
        }
        let first = self.levels_first();
        let sum: u32 = edges.iter().sum();
        for &inside in levels.iter().filter(|&&level| level >= first) {
            if self.inside(inside) && (0..3).all(|k| self.row(k, edges[k], inside)) {
                return Some((inside, u64::from(sum) + ring_triangles(inside)));
            }
        }
        None
    }

    /// The fewest triangles with any factors of its edges, and those factors.
    fn alone(&mut self, levels: &[u32]) -> Option<([u32; 3], u64)> {
        if levels[0] == 1 && self.single() {
            return Some(([1; 3], 1));
        }
        let first = self.levels_first();
        let mut best: Option<([u32; 3], u64)> = None;
        for &inside in levels.iter().filter(|&&level| level >= first) {
            let own = ring_triangles(inside);
            if best.is_some_and(|(_, fewest)| own + 3 >= fewest) {
                break;
            }
            if !self.inside(inside) {
                continue;
            }
            let least = [0, 1, 2].map(|k| {
                let most = best.map_or(64, |(_, fewest)| (fewest - own) as u32).min(inside + 16);
                levels.iter().copied().take_while(|&edge| edge <= most).find(|&edge| self.row(k, edge, inside))
            });
            if let [Some(a), Some(b), Some(c)] = least {
                let cost = own + u64::from(a + b + c);
                if best.is_none_or(|(_, fewest)| cost < fewest) {
                    best = Some(([a, b, c], cost));
                }
            }
        }
        best
    }
}

/// The triangles of a pattern that lie along no edge of the patch.
fn ring_triangles(inside: u32) -> u64 {
    let rings = u64::from(inside.saturating_sub(2));
    3 * rings + 3 * rings * rings / 2
}

/// Searches the fewest triangles for these inputs. `starts` are factors of all edges to start from; the search always
/// starts from what the patches would choose by themselves, too.
pub(crate) fn optimum(mesh: &Mesh, topology: &Topology, inputs: &Inputs, starts: &[Vec<u32>]) -> Optimum {
    let levels = levels(inputs.tessellation.partitioning);
    let limit = LimitSurface::new(mesh, topology, inputs);
    let mut patches = Vec::new();
    for index in 0..topology.patches.len() as u32 {
        let net = limit.net(index);
        if cull_reason(inputs.tessellation.clip, false, &inputs.view, &net) != NOT_CULLED {
            continue;
        }
        let sides = topology.patches[index as usize].sides.map(|side| topology.sides[side as usize].edge as usize);
        patches.push(Patch::new(inputs, limit.seen_patch(index), &net, [sides[1], sides[2], sides[0]]));
    }
    let alone: Vec<_> = patches.iter_mut().map(|patch| patch.alone(&levels)).collect();
    let lower_bound = alone.iter().map(|own| own.map_or(1, |(_, triangles)| triangles)).sum();
    let mut separate_start = vec![levels[0]; topology.edges.len()];
    for (patch, own) in patches.iter().zip(&alone) {
        for (k, &edge) in patch.edges.iter().enumerate() {
            separate_start[edge] = separate_start[edge].max(own.map_or(levels[0], |(edges, _)| edges[k]));
        }
    }
    let mut search = Search { around: vec![Vec::new(); topology.edges.len()], patches, levels };
    for (index, patch) in search.patches.iter().enumerate() {
        patch.edges.iter().for_each(|&edge| search.around[edge].push(index));
    }
    let uniform = search.uniform();
    let uniform_start = uniform.map(|(factor, _)| vec![factor; topology.edges.len()]);
    let starts = starts.iter().cloned().chain([separate_start]).chain(uniform_start);
    let triangles = starts.map(|start| search.improve(start)).min().unwrap_or_default();
    Optimum { triangles, lower_bound, uniform }
}

/// LOD by error beside the optimum.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Compared {
    /// The triangles of LOD by error.
    pub(crate) triangles: u64,
    /// None if it wasn't searched for.
    pub(crate) best: Option<Optimum>,
    /// The largest error in px; `None` where a factor is capped.
    pub(crate) error_px: Option<f64>,
}

/// Tessellates a mesh under these inputs, whose LOD is by error, measures the error, and searches the optimum if asked to.
pub(crate) fn compare_with_optimum(mesh: &Mesh, topology: &Topology, inputs: &Inputs, searches: bool) -> Compared {
    let own = tessellate(mesh, topology, inputs, None);
    let triangles = own.triangles.len() as u64;
    let capped = |factors: &HullFactors| factors.is_capped(inputs.tessellation.partitioning);
    let error_px = (!hull_factors(mesh, topology, inputs).iter().any(capped)).then(|| {
        let mut measurement = ScreenErrorMeasurement::new(mesh, topology, inputs, triangles);
        measurement.take(&EmittedChunk::whole(&own.vertices, &own.triangles));
        measurement.worst().map_or(0.0, |worst| worst.value)
    });
    let last = levels(inputs.tessellation.partitioning).pop().unwrap_or(64) as f32;
    let start: Vec<u32> = own.edge_factors.iter().map(|factor| factor.min(last) as u32).collect();
    let best = searches.then(|| optimum(mesh, topology, inputs, &[start]));
    Compared { triangles, best, error_px }
}

/// What a patch counts that has no factors within the tolerance.
const NONE: u64 = 1 << 32;

struct Search {
    patches: Vec<Patch>,
    /// The patches around each edge.
    around: Vec<Vec<usize>>,
    levels: Vec<u32>,
}

impl Search {
    fn cost(&mut self, patch: usize, edges: &[u32]) -> u64 {
        let own = self.patches[patch].edges.map(|edge| edges[edge]);
        self.patches[patch].least(own, &self.levels).map_or(NONE, |(_, triangles)| triangles)
    }

    /// The least factor that suffices everywhere.
    fn uniform(&mut self) -> Option<(u32, u64)> {
        let levels = self.levels.clone();
        for factor in levels {
            let first = self.patches.first().map_or(1, Patch::levels_first);
            let suffices = |patch: &mut Patch| match factor {
                1 => patch.single(),
                _ => {
                    let inside = factor.max(first);
                    patch.inside(inside) && (0..3).all(|k| patch.row(k, factor, inside))
                }
            };
            if self.patches.iter_mut().all(suffices) {
                let each = if factor == 1 { 1 } else { 3 * u64::from(factor) + ring_triangles(factor.max(first)) };
                return Some((factor, each * self.patches.len() as u64));
            }
        }
        None
    }

    /// Changes the factors of single edges, and of all edges of single patches, as long as that saves triangles, and
    /// returns how many are left.
    fn improve(&mut self, mut edges: Vec<u32>) -> u64 {
        for _ in 0..40 {
            let mut saved = self.change_edges(&mut edges);
            saved += self.change_patches(&mut edges);
            if saved == 0 {
                break;
            }
        }
        (0..self.patches.len()).map(|patch| self.cost(patch, &edges)).sum()
    }

    fn change_edges(&mut self, edges: &mut [u32]) -> u64 {
        let mut saved = 0;
        for edge in 0..edges.len() {
            let around = self.around[edge].clone();
            let before: u64 = around.iter().map(|&patch| self.cost(patch, edges)).sum();
            let now = edges[edge];
            let at = self.levels.iter().position(|&level| level == now).unwrap_or(0);
            let (mut best, mut fewest) = (now, before);
            for index in at.saturating_sub(6)..(at + 7).min(self.levels.len()) {
                let level = self.levels[index];
                edges[edge] = level;
                let mut after = 0;
                for &patch in &around {
                    after += self.cost(patch, edges);
                    if after >= fewest {
                        break;
                    }
                }
                if after < fewest {
                    (best, fewest) = (level, after);
                }
            }
            edges[edge] = best;
            saved += before - fewest;
        }
        saved
    }

    fn change_patches(&mut self, edges: &mut [u32]) -> u64 {
        let mut saved = 0;
        for patch in 0..self.patches.len() {
            let own = self.patches[patch].edges;
            let mut around: Vec<usize> = own.iter().flat_map(|&edge| self.around[edge].clone()).collect();
            around.sort_unstable();
            around.dedup();
            let before: u64 = around.iter().map(|&patch| self.cost(patch, edges)).sum();
            let now = own.map(|edge| edges[edge]);
            let Some((inside, _)) = self.patches[patch].least(now, &self.levels) else { continue };
            let at = self.levels.iter().position(|&level| level == inside).unwrap_or(0);
            let (mut best, mut fewest) = (now, before);
            for index in at.saturating_sub(4)..(at + 3).min(self.levels.len()) {
                let inside = self.levels[index];
                if inside < self.patches[patch].levels_first() || !self.patches[patch].inside(inside) {
                    continue;
                }
                for floor in [self.levels[0], 0] {
                    let found = [0, 1, 2].map(|k| {
                        let least = if floor == 0 { now[k] } else { floor };
                        let levels = self.levels.clone();
                        let near = levels.into_iter().filter(|&level| level >= least && level <= inside + 6);
                        near.into_iter().find(|&level| self.patches[patch].row(k, level, inside))
                    });
                    let [Some(a), Some(b), Some(c)] = found else { continue };
                    for (k, factor) in [a, b, c].into_iter().enumerate() {
                        edges[own[k]] = factor;
                    }
                    let after: u64 = around.iter().map(|&patch| self.cost(patch, edges)).sum();
                    if after < fewest {
                        (best, fewest) = ([a, b, c], after);
                    }
                }
            }
            for k in 0..3 {
                edges[own[k]] = best[k];
            }
            saved += before - fewest;
        }
        saved
    }
}

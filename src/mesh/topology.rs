//! From triangles to patches, points, edges and sides: who meets whom, and how.

use std::ops::Range;
use std::sync::Arc;

use glam::Vec3;
use serde::Serialize;

use super::build_limits::{BuildError, Unlimited};
use super::interner::Interner;
use super::union_find::UnionFind;
use super::weld::weld_alike;
use super::{Corner, Mesh};
use crate::mesh::build_limits::MemoryAccount;
use crate::progress::{Cancelled, Progress};

/// A mesh's patches and the edges between them.
///
/// Order: points by first appearance among the corners, patches as their triangles, edges by their two points, an
/// edge's sides by patch. So the same mesh always gives the same topology.
///
/// Of a mesh whose edges mostly have two sides it takes about 62 bytes a triangle, so what follows from something else is not
/// kept: where a patch's corners are (in the mesh's triangles), where an edge ends, and how many sides it has.
#[derive(Clone, Debug, Default)]
pub struct Topology {
    /// Welded positions (see [`weld_alike`]), in object units.
    pub points: Vec<Vec3>,
    /// The point of each of the mesh's corners.
    pub corner_points: Vec<u32>,
    /// The lowest corner on each point: the dominant one, which speaks for all of them.
    pub point_corners: Vec<u32>,
    /// The mesh's.
    triangles: Arc<Vec<[u32; 3]>>,
    pub patches: Vec<Patch>,
    pub edges: Vec<Edge>,
    /// Grouped by edge.
    pub sides: Vec<Side>,
    /// Triangles left out because two of their corners lie on one point.
    pub degenerate: u32,
    /// For each of the mesh's materials, the patches that wear it.
    pub material_patches: Vec<Range<u32>>,
}

/// An input triangle with three distinct points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Patch {
    /// Indices into [`Topology::sides`]; side k runs from corner k to corner (k + 1) % 3.
    pub sides: [u32; 3],
    /// Index into the mesh's triangles.
    pub triangle: u32,
}

/// An unordered pair of points that at least one patch connects.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edge {
    /// Index into [`Topology::sides`], of the first of its sides.
    pub first_side: u32,
    pub kind: EdgeKind,
    /// Whether it has two sides, with the same two corners of the mesh.
    pub shares_corners: bool,
}

/// One patch's use of an edge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Side {
    /// Six times the patch, plus twice which of its sides, plus 1 if it runs against the edge's own direction: a mesh has more
    /// sides than anything else.
    code: u32,
    pub edge: u32,
}

impl Side {
    fn new(patch: u32, index: u8, reversed: bool, edge: u32) -> Self {
        Self { code: 6 * patch + 2 * u32::from(index) + u32::from(reversed), edge }
    }

    pub fn patch(&self) -> u32 {
        self.code / 6
    }

    /// Which of the patch's sides, 0 to 2.
    pub fn index(&self) -> usize {
        (self.code % 6 / 2) as usize
    }

    /// Whether the patch runs it against the edge's own direction.
    pub fn reversed(&self) -> bool {
        self.code % 2 == 1
    }
}

/// What an edge's sides have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[repr(u8)]
#[serde(rename_all = "snake_case")]
pub enum EdgeKind {
    /// Two sides with the same normals and uvs.
    Smooth = 0,
    /// Two sides whose normals differ at one end at least.
    Split = 1,
    /// Two sides with the same normals whose uvs differ at one end at least.
    Seam = 2,
    /// One side.
    Boundary = 3,
    /// Three sides or more.
    NonManifold = 4,
}

/// How many edges there are of each kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct EdgeCounts {
    pub smooth: u32,
    pub split: u32,
    pub seam: u32,
    pub boundary: u32,
    pub non_manifold: u32,
}

impl EdgeCounts {
    /// The edges of all kinds.
    pub fn total(&self) -> u32 {
        self.smooth + self.split + self.seam + self.boundary + self.non_manifold
    }
}

impl Topology {
    /// [`build_within`](Self::build_within) without a tolerance: corners at exactly equal positions share a point.
    ///
    /// # Errors
    /// [`Cancelled`] when `progress` says so.
    pub fn build(mesh: &Mesh, progress: &Progress) -> Result<Self, Cancelled> {
        Self::build_within(mesh, 0.0, progress)
    }

    /// Welds the corners within a tolerance (see [`super::weld::weld_within`]) and finds the edges. The tolerance is relative to the
    /// mesh's bounding diagonal; 0 joins only exactly equal positions. Triangles whose corners it brings together are
    /// degenerate. Corners that a clip moves apart stay apart. Linear in triangles, but for a logarithm of the most patches
    /// around a point.
    ///
    /// # Errors
    /// [`Cancelled`] when `progress` says so.
    pub fn build_within(mesh: &Mesh, tolerance: f32, progress: &Progress) -> Result<Self, Cancelled> {
        match Self::build_afforded(mesh, tolerance, &Unlimited, progress) {
            Ok(topology) => Ok(topology),
            // Memory is unlimited, so that nothing but a cancellation ends it.
            Err(_) => Err(Cancelled),
        }
    }

    /// The same within a budget, which holds what the topology takes.
    ///
    /// # Errors
    /// [`BuildError`].
    pub fn build_afforded(
        mesh: &Mesh,
        tolerance: f32,
        budget: &dyn MemoryAccount,
        progress: &Progress,
    ) -> Result<Self, BuildError> {
        let borrowed = budget.borrowed();
        let take = |bytes: usize| budget.hold(bytes as u64);
        budget.borrow(weld_bytes(mesh.corners.len(), tolerance))?;
        let (mut points, corner_points) = weld_corners(mesh, tolerance);
        points.shrink_to_fit();
        budget.give_back_to(borrowed);
        take(16 * points.len() + 4 * corner_points.len())?;
        progress.check()?;
        take(mesh.triangles.len() * size_of::<Patch>())?;
        let patches = patches(mesh, &corner_points);
        progress.check()?;
        take(3 * patches.len() * size_of::<Side>())?;
        budget.borrow(8 * points.len() as u64)?;
        let (sides, starts) = sides(&patches, &mesh.triangles, &corner_points, points.len());
        progress.check()?;
        let mut topology = Self {
            point_corners: first_corners(&corner_points, points.len()),
            degenerate: (mesh.triangles.len() - patches.len()) as u32,
            material_patches: material_patches(mesh, &patches),
            triangles: mesh.triangles.clone(),
            points,
            corner_points,
            patches,
            sides,
            edges: Vec::new(),
        };
        let count = topology.count_edges(&starts);
        take(count * size_of::<Edge>())?;
        // Exactly: one more than there is room for would double what edges take.
        topology.edges.reserve_exact(count);
        topology.connect(&starts, &mesh.corners);
        budget.give_back_to(borrowed);
        progress.check()?;
        Ok(topology)
    }

    /// How many edges there are of each kind.
    pub fn edge_counts(&self) -> EdgeCounts {
        let mut counts = EdgeCounts::default();
        for edge in &self.edges {
            *match edge.kind {
                EdgeKind::Smooth => &mut counts.smooth,
                EdgeKind::Split => &mut counts.split,
                EdgeKind::Seam => &mut counts.seam,
                EdgeKind::Boundary => &mut counts.boundary,
                EdgeKind::NonManifold => &mut counts.non_manifold,
            } += 1;
        }
        counts
    }

    /// Whether every edge has exactly two sides, which run it in opposite directions: what has an inside.
    pub fn is_closed_and_oriented(&self) -> bool {
        let opposed = |edge: &Edge| match self.edge_sides(edge) {
            [a, b] => a.reversed() != b.reversed(),
            _ => false,
        };
        !self.edges.is_empty() && self.edges.iter().all(opposed)
    }

    /// The volumes of the parts that hang together by edges, in cubic object units: less than 0 where a part is wound
    /// inward. Only of a closed mesh do they mean anything.
    pub fn part_volumes(&self) -> impl Iterator<Item = f64> {
        let mut parts = UnionFind::new(self.patches.len());
        for edge in &self.edges {
            for pair in self.edge_sides(edge).windows(2) {
                parts.join(pair[0].patch(), pair[1].patch());
            }
        }
        let mut volumes = vec![None; self.patches.len()];
        for i in 0..self.patches.len() {
            let [a, b, c] = self.patch_positions(i as u32).map(Vec3::as_dvec3);
            // From a place of the part's own, so that what is far away is no less exact.
            let (at, volume) = volumes[parts.of(i as u32) as usize].get_or_insert((a, 0.0));
            *volume += (a - *at).dot((b - *at).cross(c - *at)) / 6.0;
        }
        volumes.into_iter().flatten().map(|(_, volume)| volume)
    }

    /// Where the sides of an edge are among all of them.
    pub fn side_range(&self, edge: &Edge) -> Range<u32> {
        let first = edge.first_side;
        let count = match edge.kind {
            EdgeKind::Boundary => 1,
            EdgeKind::Smooth | EdgeKind::Split | EdgeKind::Seam => 2,
            EdgeKind::NonManifold => {
                let (own, rest) = (self.sides[first as usize].edge, &self.sides[first as usize..]);
                rest.iter().take_while(|side| side.edge == own).count() as u32
            }
        };
        first..first + count
    }

    /// The sides of an edge.
    pub fn edge_sides(&self, edge: &Edge) -> &[Side] {
        let range = self.side_range(edge);
        &self.sides[range.start as usize..range.end as usize]
    }

    /// The points of an edge, the lower first: its own direction runs from there to the other.
    pub fn edge_points(&self, edge: &Edge) -> [u32; 2] {
        self.side_corners(&self.sides[edge.first_side as usize]).map(|corner| self.corner_points[corner as usize])
    }

    /// The corners of a patch: indices into the mesh's, in its triangle's own order.
    pub fn patch_corners(&self, patch: u32) -> [u32; 3] {
        // Where nothing is degenerate, patches are numbered as triangles are: one look into memory fewer.
        let triangle = if self.degenerate == 0 { patch } else { self.patches[patch as usize].triangle };
        self.triangles[triangle as usize]
    }

    /// The same of a patch at hand.
    pub fn corners(&self, patch: &Patch) -> [u32; 3] {
        self.triangles[patch.triangle as usize]
    }

    /// The points of a patch's corners.
    pub fn patch_points(&self, patch: u32) -> [u32; 3] {
        self.patch_corners(patch).map(|corner| self.corner_points[corner as usize])
    }

    /// The patch that a triangle of the mesh has become; none if it is degenerate.
    pub fn patch_of(&self, triangle: u32) -> Option<u32> {
        // Patches are in the order of their triangles.
        self.patches.binary_search_by_key(&triangle, |patch| patch.triangle).ok().map(|patch| patch as u32)
    }

    /// Where a patch's corners lie, in object units.
    pub fn patch_positions(&self, patch: u32) -> [Vec3; 3] {
        self.patch_points(patch).map(|point| self.points[point as usize])
    }

    /// The material (an index into [`Mesh::materials`]) of a patch.
    pub fn material_of(&self, patch: u32) -> usize {
        self.material_patches.partition_point(|patches| patches.end <= patch)
    }

    /// The direction that an edge's patches face together: the sum of their facings, by area; zero where they cancel.
    pub fn edge_facing(&self, edge: &Edge) -> Vec3 {
        let facing = |side: &Side| {
            let [a, b, c] = self.patch_positions(side.patch()).map(Vec3::as_dvec3);
            (b - a).cross(c - a)
        };
        let sum: glam::DVec3 = self.edge_sides(edge).iter().map(facing).sum();
        sum.normalize_or_zero().as_vec3()
    }

    /// The corners that a side's patch has there, in the edge's own direction.
    pub fn side_corners(&self, side: &Side) -> [u32; 2] {
        let own = self.patch_corners(side.patch());
        let [a, b] = [own[side.index()], own[(side.index() + 1) % 3]];
        if side.reversed() { [b, a] } else { [a, b] }
    }

    /// How many edges sorted sides have, which know the edge's higher point in its place.
    fn count_edges(&self, starts: &[u32]) -> usize {
        let is_last = |i: usize, end: usize| i + 1 == end || self.sides[i].edge != self.sides[i + 1].edge;
        let of = |around: Range<usize>| around.clone().filter(|&i| is_last(i, around.end)).count();
        runs(starts).map(of).sum()
    }

    /// Makes edges of such sides, and tells patches and sides of each other.
    fn connect(&mut self, starts: &[u32], corners: &[Corner]) {
        for around in runs(starts) {
            let mut start = around.start;
            while start < around.end {
                let high = self.sides[start].edge;
                let run = self.sides[start..around.end].iter().take_while(|side| side.edge == high).count();
                for (index, side) in (start as u32..).zip(&mut self.sides[start..start + run]) {
                    side.edge = self.edges.len() as u32;
                    self.patches[side.patch() as usize].sides[side.index()] = index;
                }
                let (kind, shares_corners) = self.kind(&self.sides[start..start + run], corners);
                self.edges.push(Edge { first_side: start as u32, kind, shares_corners });
                start += run;
            }
        }
    }

    /// What an edge with these sides is, and whether two of them have the same corners.
    fn kind(&self, sides: &[Side], corners: &[Corner]) -> (EdgeKind, bool) {
        let [a, b] = match sides {
            [_] => return (EdgeKind::Boundary, false),
            [a, b] => [a, b].map(|side| self.side_corners(side)),
            _ => return (EdgeKind::NonManifold, false),
        };
        if a == b {
            return (EdgeKind::Smooth, true);
        }
        let [a, b] = [a, b].map(|own| own.map(|corner| corners[corner as usize]));
        let kind = if a[0].normal != b[0].normal || a[1].normal != b[1].normal {
            EdgeKind::Split
        } else if a[0].uv != b[0].uv || a[1].uv != b[1].uv {
            EdgeKind::Seam
        } else {
            EdgeKind::Smooth
        };
        (kind, false)
    }
}

/// The points of a mesh within a tolerance, as [`Topology::build_within`] has them, and the point of each corner.
pub(super) fn weld_corners(mesh: &Mesh, tolerance: f32) -> (Vec<Vec3>, Vec<u32>) {
    let distance = mesh.bounds().part(tolerance.into());
    let alike = mesh.rig.as_ref().map_or(&[][..], |rig| &rig.alike);
    let numbers = alike.iter().copied().chain(std::iter::repeat(0));
    weld_alike(mesh.corners.iter().map(|corner| corner.position).zip(numbers), distance)
}

/// Whether a triangle with corners on these points is none.
pub(super) fn is_degenerate([a, b, c]: [u32; 3]) -> bool {
    a == b || b == c || c == a
}

/// What [`weld_corners`] takes at most meanwhile, in bytes.
fn weld_bytes(corners: usize, tolerance: f32) -> u64 {
    // Every corner's point, and points as lists of them are copied when those shrink.
    let exactly = 36;
    // Points twice over with their cells, in lists and a table that double as they grow.
    let within = if tolerance > 0.0 { 64 } else { 0 };
    Interner::bytes_for(corners) + (exactly + within) * corners as u64
}

/// Where the sides of each point are.
fn runs(starts: &[u32]) -> impl Iterator<Item = Range<usize>> {
    starts.windows(2).map(|ends| ends[0] as usize..ends[1] as usize)
}

/// The triangles with three distinct points; their sides are not known yet.
fn patches(mesh: &Mesh, corner_points: &[u32]) -> Vec<Patch> {
    let whole = |corners: &[u32; 3]| !is_degenerate(corners.map(|corner| corner_points[corner as usize]));
    let triangles = (0..).zip(mesh.triangles.iter()).filter(|(_, corners)| whole(corners));
    let mut patches = Vec::with_capacity(mesh.triangles.len());
    patches.extend(triangles.map(|(triangle, _)| Patch { sides: [0; 3], triangle }));
    patches
}

/// The sides of all patches by their lower points, then by their higher ones, which stand where their edges will, then by patch.
/// Those of point p are `starts[p]..starts[p + 1]`.
fn sides(patches: &[Patch], triangles: &[[u32; 3]], corner_points: &[u32], points: usize) -> (Vec<Side>, Vec<u32>) {
    let ends = |patch: &Patch, k: usize| {
        let corners = triangles[patch.triangle as usize];
        [corners[k], corners[(k + 1) % 3]].map(|corner| corner_points[corner as usize])
    };
    let mut starts = vec![0_u32; points + 1];
    for patch in patches {
        for k in 0..3 {
            let [a, b] = ends(patch, k);
            starts[a.min(b) as usize + 1] += 1;
        }
    }
    for point in 0..points {
        starts[point + 1] += starts[point];
    }
    let mut next = starts.clone();
    let mut sides = vec![Side::default(); 3 * patches.len()];
    for (index, patch) in (0..).zip(patches) {
        for k in 0..3 {
            let [a, b] = ends(patch, k);
            let place = &mut next[a.min(b) as usize];
            sides[*place as usize] = Side::new(index, k as u8, b < a, a.max(b));
            *place += 1;
        }
    }
    drop(next);
    for around in runs(&starts) {
        sides[around].sort_unstable_by_key(|side| (side.edge, side.code));
    }
    (sides, starts)
}

/// The lowest corner on each point.
fn first_corners(corner_points: &[u32], points: usize) -> Vec<u32> {
    let mut first = vec![0; points];
    for (corner, &point) in corner_points.iter().enumerate().rev() {
        first[point as usize] = corner as u32;
    }
    first
}

/// Each material's triangles as patches. Patches are in the order of their triangles, so ranges stay ranges.
fn material_patches(mesh: &Mesh, patches: &[Patch]) -> Vec<Range<u32>> {
    let before = |triangle: u32| patches.partition_point(|patch| patch.triangle < triangle) as u32;
    mesh.materials.iter().map(|m| before(m.triangles.start)..before(m.triangles.end)).collect()
}

#[cfg(test)]
mod tests;

//! Builds patches, points, edges and sides from a mesh's triangles: which patches meet, and how.

mod connecting;

use crate::choice::choices;
use std::ops::Range;
use std::sync::Arc;

use bytemuck::Zeroable;
use glam::Vec3;
use rayon::prelude::*;
use serde::Serialize;

use super::build_limits::{Borrowed, Budget, BuildError};
use super::union_find::UnionFind;
use super::weld::{WELD_BYTES, weld_alike};
use super::{Corner, Mesh};
use crate::casts::to_u32;
use crate::numbers::ulp_at;
use crate::progress::{Cancelled, Progress};

/// How many patches have their volumes computed on all cores before these are added up.
const BLOCK: usize = 1 << 16;

/// A mesh's patches and the edges between them.
///
/// Points are in the order of their first appearance among the corners, patches in the order of their triangles, edges
/// in the order of their two points, and an edge's sides in the order of their patches. So the same mesh always gives
/// the same topology.
///
/// If most edges have two sides, a topology takes about 62 bytes a triangle. To save memory, what follows from other
/// data isn't stored: a patch's corners (they are in the mesh's triangles), an edge's points, and the number of its
/// sides.
#[derive(Clone, Debug, Default)]
pub struct Topology {
    /// Welded positions, in object units.
    pub points: Vec<Vec3>,
    /// The point of each of the mesh's corners.
    pub corner_points: Vec<u32>,
    /// The lowest corner on each point: its dominant corner.
    pub point_corners: Vec<u32>,
    /// The triangles of the mesh.
    triangles: Arc<Vec<[u32; 3]>>,
    /// The triangles with three distinct points.
    pub patches: Vec<Patch>,
    /// The lines where sides meet.
    pub edges: Vec<Edge>,
    /// The sides of all patches, grouped by edge.
    pub sides: Vec<Side>,
    /// Triangles left out because two of their corners lie on one point.
    pub degenerate: u32,
    /// For each of the mesh's materials, its patches.
    pub material_patches: Vec<Range<u32>>,
}

/// A triangle of the mesh with three distinct points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Zeroable)]
pub struct Patch {
    /// Indices into [`Topology::sides`]; side k runs from corner k to corner (k + 1) % 3.
    pub sides: [u32; 3],
    /// Index into the mesh's triangles.
    pub triangle: u32,
}

/// Two points that at least one patch connects.
#[derive(Clone, Debug, PartialEq, Eq, Zeroable)]
pub struct Edge {
    /// The first of its sides, an index into [`Topology::sides`].
    pub first_side: u32,
    /// How its sides meet.
    pub kind: EdgeKind,
    /// Whether it has exactly two sides, which have the same two corners of the mesh.
    pub shares_corners: bool,
}

/// The use of an edge by one patch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Zeroable)]
pub struct Side {
    /// Six times the patch, plus twice which of its sides this is, plus 1 if it has the opposite direction to the edge.
    /// Packed, since a mesh has more sides than anything else.
    code: u32,
    /// The edge that it lies on.
    pub edge: u32,
}

impl Side {
    fn new(patch: u32, index: u8, reversed: bool, edge: u32) -> Self {
        Self { code: 6 * patch + 2 * u32::from(index) + u32::from(reversed), edge }
    }

    /// Returns the patch that it belongs to.
    pub fn patch(&self) -> u32 {
        self.code / 6
    }

    /// Returns which of the patch's sides this is, 0 to 2.
    pub fn index(&self) -> usize {
        (self.code % 6 / 2) as usize
    }

    /// Returns whether the side's direction in its patch is opposite to the edge's own direction.
    pub fn reversed(&self) -> bool {
        self.code % 2 == 1
    }
}

choices! {
    /// What meets at an edge.
    #[derive(Hash, Serialize, Zeroable)]
    #[repr(u8)]
    #[serde(rename_all = "snake_case")]
    pub enum EdgeKind {
        Smooth => "smooth", "smooth", "Edges of two triangles that share normals and uvs.";
        Split => "split", "split normal", "Edges of two triangles whose normals differ at an end. PN triangles crack here.";
        Seam => "seam", "uv seam", "Edges of two triangles that share normals but not uvs.";
        Boundary => "boundary", "boundary", "Edges of only one triangle: a hole or a border.";
        NonManifold => "non-manifold", "non-manifold", "Edges of three or more triangles.";
    }
}

/// The number of edges of each kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct EdgeCounts {
    /// See [`EdgeKind::Smooth`].
    pub smooth: u32,
    /// See [`EdgeKind::Split`].
    pub split: u32,
    /// See [`EdgeKind::Seam`].
    pub seam: u32,
    /// See [`EdgeKind::Boundary`].
    pub boundary: u32,
    /// See [`EdgeKind::NonManifold`].
    pub non_manifold: u32,
}

impl EdgeCounts {
    /// Returns the number of all edges.
    pub fn total(&self) -> u32 {
        self.smooth + self.split + self.seam + self.boundary + self.non_manifold
    }
}

impl Topology {
    /// Builds a topology in which only corners at exactly equal positions share a point:
    /// [`build_within`](Self::build_within) without a tolerance.
    ///
    /// # Errors
    /// [`Cancelled`] when `progress` says so.
    pub fn build(mesh: &Mesh, progress: &Progress) -> Result<Self, Cancelled> {
        Self::build_within(mesh, 0.0, progress)
    }

    /// Builds a topology in which only corners at exactly equal positions share a point.
    pub fn new(mesh: &Mesh) -> Self {
        // Nothing else holds this progress, so nothing cancels it.
        Self::build(mesh, &Progress::new()).unwrap_or_default()
    }

    /// Welds corners within a tolerance and finds the edges. The tolerance is relative to the mesh's bounding diagonal;
    /// 0 joins only exactly equal positions. A triangle with two corners on one point is degenerate. Corners that a
    /// clip moves apart aren't joined. Takes time linear in the number of triangles, times the logarithm of the
    /// greatest number of patches around a point.
    ///
    /// # Errors
    /// [`Cancelled`] when `progress` says so.
    pub fn build_within(mesh: &Mesh, tolerance: f32, progress: &Progress) -> Result<Self, Cancelled> {
        match Self::build_afforded(mesh, tolerance, &Budget::unlimited(), progress) {
            Ok(topology) => Ok(topology),
            // Memory is unlimited, so cancellation is the only possible error.
            Err(_) => Err(Cancelled),
        }
    }

    /// Builds a topology as [`build_within`](Self::build_within) does, within a budget, which holds its memory.
    ///
    /// # Errors
    /// [`BuildError`].
    pub fn build_afforded(
        mesh: &Mesh,
        tolerance: f32,
        budget: &Budget,
        progress: &Progress,
    ) -> Result<Self, BuildError> {
        let take = |bytes: usize| budget.hold(bytes as u64);
        let welding = Borrowed::from(budget);
        // Further lists of the points, and a table of cells; lists and table double as they grow.
        let within = if tolerance > 0.0 { 80 } else { 0 };
        budget.borrow((WELD_BYTES + within) * mesh.corners.len() as u64)?;
        let (mut points, corner_points) = weld_corners(mesh, tolerance);
        points.shrink_to_fit();
        drop(welding);
        take(16 * points.len() + 4 * corner_points.len())?;
        progress.check()?;
        take(mesh.triangles.len() * size_of::<Patch>())?;
        let _connecting = Borrowed::from(budget);
        budget.borrow(8 * points.len() as u64)?;
        let (patches, starts) = connecting::patches(&mesh.triangles, &corner_points, points.len());
        progress.check()?;
        take(3 * patches.len() * size_of::<Side>())?;
        let (mut sides, ranges) = connecting::sides(&mesh.triangles, &corner_points, &starts);
        progress.check()?;
        let (point_corners, has_many) = first_corners(&corner_points, points.len());
        let mut topology = Self {
            point_corners,
            degenerate: to_u32(mesh.triangles.len() - patches.len()),
            material_patches: material_patches(mesh, &patches),
            triangles: mesh.triangles.clone(),
            points,
            corner_points,
            patches,
            sides: Vec::new(),
            edges: Vec::new(),
        };
        take(ranges.iter().map(|range| range.edges.len()).sum::<usize>() * size_of::<Edge>())?;
        topology.edges = connecting::edges(&topology, &mut sides, &ranges, &starts, &has_many, &mesh.corners);
        connecting::connect(&mut topology.patches, &sides);
        topology.sides = sides;
        progress.check()?;
        Ok(topology)
    }

    /// Counts the edges of each kind.
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

    /// Returns whether every edge has exactly two sides.
    pub fn is_closed(&self) -> bool {
        !self.edges.is_empty() && self.edges.par_iter().all(|edge| self.edge_sides(edge).len() == 2)
    }

    /// Returns whether the triangles at every edge of two sides are wound the same way.
    pub fn is_oriented(&self) -> bool {
        self.edges.par_iter().all(|edge| match self.edge_sides(edge) {
            [a, b] => a.reversed() != b.reversed(),
            _ => true,
        })
    }

    /// Returns whether the three corners of a patch lie in line, to within a unit in the last place of their largest
    /// coordinate.
    pub fn is_in_line(&self, patch: u32) -> bool {
        let corners = self.patch_positions(patch);
        let unit = ulp_at(corners.iter().map(|corner| corner.abs().max_element()).fold(0.0, f32::max));
        let [a, b, c] = corners.map(|corner| corner.as_dvec3());
        let longest = [a.distance(b), b.distance(c), c.distance(a)].into_iter().fold(0.0, f64::max);
        (b - a).cross(c - a).length() <= unit * longest
    }

    /// Returns whether the mesh has an inside.
    pub fn is_closed_and_oriented(&self) -> bool {
        self.is_closed() && self.is_oriented()
    }

    /// Returns the volume of each part of the mesh that is connected by edges, in cubic object units. It is negative
    /// for a part that is wound inward, and means something only for a closed mesh.
    pub fn part_volumes(&self) -> impl Iterator<Item = f64> {
        let parts = UnionFind::new(self.patches.len());
        self.edges.par_iter().for_each(|edge| {
            self.edge_sides(edge).windows(2).for_each(|pair| parts.join(pair[0].patch(), pair[1].patch()));
        });
        let volume = |patch: u32| {
            let part = parts.of(patch);
            // Measured from a corner of the part, so that a part far from the origin loses no precision.
            let at = self.patch_positions(part)[0].as_dvec3();
            let [a, b, c] = self.patch_positions(patch).map(|point| point.as_dvec3() - at);
            (part, a.dot(b.cross(c)) / 6.0)
        };
        let mut volumes = vec![0.0; self.patches.len()];
        for first in (0..self.patches.len()).step_by(BLOCK) {
            let block = to_u32(first)..to_u32((first + BLOCK).min(self.patches.len()));
            // Rounding depends on the order, so that one core adds up.
            let own: Vec<(u32, f64)> = block.into_par_iter().map(volume).collect();
            own.into_iter().for_each(|(part, volume)| volumes[part as usize] += volume);
        }
        (0..).zip(volumes).filter(move |&(patch, _)| parts.of(patch) == patch).map(|(_, volume)| volume)
    }

    /// Returns the range of an edge's sides in [`Topology::sides`].
    pub fn side_range(&self, edge: &Edge) -> Range<u32> {
        let first = edge.first_side;
        let count = match edge.kind {
            EdgeKind::Boundary => 1,
            EdgeKind::Smooth | EdgeKind::Split | EdgeKind::Seam => 2,
            EdgeKind::NonManifold => {
                let (own, rest) = (self.sides[first as usize].edge, &self.sides[first as usize..]);
                to_u32(rest.iter().take_while(|side| side.edge == own).count())
            }
        };
        first..first + count
    }

    /// Returns the sides of an edge.
    pub fn edge_sides(&self, edge: &Edge) -> &[Side] {
        let range = self.side_range(edge);
        &self.sides[range.start as usize..range.end as usize]
    }

    /// Returns the points of an edge, the lower one first. The edge's own direction is from the first to the second.
    pub fn edge_points(&self, edge: &Edge) -> [u32; 2] {
        self.side_corners(&self.sides[edge.first_side as usize]).map(|corner| self.corner_points[corner as usize])
    }

    /// Returns the corners of a patch as indices into the mesh's corners, in the order of its triangle.
    pub fn patch_corners(&self, patch: u32) -> [u32; 3] {
        // Without degenerate triangles, patches and triangles have the same numbers, which saves reading the patch.
        let triangle = if self.degenerate == 0 { patch } else { self.patches[patch as usize].triangle };
        self.triangles[triangle as usize]
    }

    /// Returns the corners of a patch, as [`patch_corners`](Self::patch_corners) does.
    pub fn corners(&self, patch: &Patch) -> [u32; 3] {
        self.triangles[patch.triangle as usize]
    }

    /// Returns the points of a patch's corners.
    pub fn patch_points(&self, patch: u32) -> [u32; 3] {
        self.patch_corners(patch).map(|corner| self.corner_points[corner as usize])
    }

    /// Returns the patch of a triangle of the mesh; none if the triangle is degenerate.
    pub fn patch_of(&self, triangle: u32) -> Option<u32> {
        // Patches are in the order of their triangles.
        self.patches.binary_search_by_key(&triangle, |patch| patch.triangle).ok().map(to_u32)
    }

    /// Returns the positions of a patch's points, in object units.
    pub fn patch_positions(&self, patch: u32) -> [Vec3; 3] {
        self.patch_points(patch).map(|point| self.points[point as usize])
    }

    /// Returns the material of a patch, an index into [`Mesh::materials`].
    pub fn material_of(&self, patch: u32) -> usize {
        self.material_patches.partition_point(|patches| patches.end <= patch)
    }

    /// Returns the mean surface normal of an edge's patches, weighted by area, at unit length; zero where they cancel.
    pub fn edge_facing(&self, edge: &Edge) -> Vec3 {
        let facing = |side: &Side| {
            let [a, b, c] = self.patch_positions(side.patch()).map(Vec3::as_dvec3);
            (b - a).cross(c - a)
        };
        let sum: glam::DVec3 = self.edge_sides(edge).iter().map(facing).sum();
        sum.normalize_or_zero().as_vec3()
    }

    /// Returns the corners of a side's patch at the ends of its edge, in the edge's own direction.
    pub fn side_corners(&self, side: &Side) -> [u32; 2] {
        let own = self.patch_corners(side.patch());
        let [a, b] = [own[side.index()], own[(side.index() + 1) % 3]];
        if side.reversed() { [b, a] } else { [a, b] }
    }

    /// Returns the kind of an edge with these sides, and whether it has two sides with the same corners.
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

/// Welds a mesh's corners within a tolerance, as [`Topology::build_within`] does. Returns the points, and the point of
/// each corner.
pub(super) fn weld_corners(mesh: &Mesh, tolerance: f32) -> (Vec<Vec3>, Vec<u32>) {
    let distance = if tolerance > 0.0 { mesh.bounds().part(tolerance.into()) } else { 0.0 };
    let alike = mesh.rig.as_ref().map_or(&[][..], |rig| &rig.alike);
    let number = |corner: usize| alike.get(corner).copied().unwrap_or_default();
    weld_alike(mesh.corners.len(), |corner| (mesh.corners[corner].position, number(corner)), distance)
}

/// Returns whether a triangle with corners on these points is degenerate.
pub(super) fn is_degenerate([a, b, c]: [u32; 3]) -> bool {
    a == b || b == c || c == a
}

/// Returns the lowest corner on each point, and whether the point has more than one.
fn first_corners(corner_points: &[u32], points: usize) -> (Vec<u32>, Vec<bool>) {
    let (mut first, mut has_many) = (vec![u32::MAX; points], vec![false; points]);
    for (corner, &point) in (0..).zip(corner_points) {
        let first = &mut first[point as usize];
        if *first == u32::MAX {
            *first = corner;
        } else {
            has_many[point as usize] = true;
        }
    }
    (first, has_many)
}

/// Returns the range of each material's patches. Patches are in the order of their triangles, so a range of triangles
/// becomes a range of patches.
fn material_patches(mesh: &Mesh, patches: &[Patch]) -> Vec<Range<u32>> {
    let before = |triangle: u32| to_u32(patches.partition_point(|patch| patch.triangle < triangle));
    mesh.materials.iter().map(|m| before(m.triangles.start)..before(m.triangles.end)).collect()
}

#[cfg(test)]
mod tests;

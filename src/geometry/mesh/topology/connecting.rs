//! Makes patches, sides and edges of triangles, on several cores.

use std::iter::zip;
use std::ops::Range;

use bytemuck::zeroed_vec;
use rayon::prelude::*;

use super::{Edge, EdgeKind, Patch, Side, Topology, is_degenerate};
use crate::casts::to_u32;
use crate::cores::{ranges, split};
use crate::mesh::Corner;

/// The least number of triangles that are worth a thread.
const LEAST: usize = 1 << 14;

/// Points in a row, whose sides are one core's work.
pub(super) struct PointRange {
    points: Range<usize>,
    /// The sides whose lower point is one of them.
    sides: Range<usize>,
    /// The edges of these sides.
    pub(super) edges: Range<usize>,
}

/// Returns the triangles with three distinct points as patches, whose sides are set later; and for each point p the number
/// `starts[p]` of their sides whose lower point is before it. The last number is that of all sides.
pub(super) fn patches(triangles: &[[u32; 3]], corner_points: &[u32], points: usize) -> (Vec<Patch>, Vec<u32>) {
    let mut patches: Vec<Patch> = zeroed_vec(triangles.len());
    // On two cores at most, since each counts the sides of all points.
    let ranges: Vec<_> = ranges(triangles.len(), (triangles.len() / 2).max(LEAST)).collect();
    let parts = split(&mut patches, ranges.iter().map(Range::len)).into_par_iter().zip(&ranges);
    let counts = parts.map(|(patches, range)| {
        let (mut kept, mut starts) = (0, vec![0_u32; points + 1]);
        for triangle in range.clone() {
            let [a, b, c] = triangles[triangle].map(|corner| corner_points[corner as usize]);
            if !is_degenerate([a, b, c]) {
                patches[kept].triangle = to_u32(triangle);
                kept += 1;
                [(a, b), (b, c), (c, a)].into_iter().for_each(|(a, b)| starts[a.min(b) as usize + 1] += 1);
            }
        }
        (kept, starts)
    });
    let counts: Vec<(usize, Vec<u32>)> = counts.collect();
    let (mut count, mut starts) = (0, Vec::new());
    for (range, (kept, own)) in zip(ranges, counts) {
        patches.copy_within(range.start..range.start + kept, count);
        count += kept;
        if starts.is_empty() {
            starts = own;
        } else {
            zip(&mut starts, own).for_each(|(sum, own)| *sum += own);
        }
    }
    patches.truncate(count);
    for point in 0..points {
        starts[point + 1] += starts[point];
    }
    (patches, starts)
}

/// Returns the sides of all patches, sorted by the lower point of their edge, then by its higher point, which `edge`
/// holds for now, then by patch; and the ranges of points, each for one core. The sides whose lower point is p are
/// `starts[p]..starts[p + 1]`.
pub(super) fn sides(triangles: &[[u32; 3]], corner_points: &[u32], starts: &[u32]) -> (Vec<Side>, Vec<PointRange>) {
    let mut sides: Vec<Side> = zeroed_vec(starts.last().map_or(0, |count| *count as usize));
    let mut ranges = point_ranges(starts);
    let parts = split(&mut sides, ranges.iter().map(|range| range.sides.len())).into_par_iter().zip(&ranges);
    let edges = parts.map(|(sides, PointRange { points, sides: range, .. })| {
        let runs =
            points.clone().map(|point| starts[point] as usize - range.start..starts[point + 1] as usize - range.start);
        let mut next: Vec<u32> = runs.clone().map(|run| to_u32(run.start)).collect();
        // Each core looks at all triangles.
        let points_of = triangles.iter().map(|corners| corners.map(|corner| corner_points[corner as usize]));
        for (index, [a, b, c]) in (0..).zip(points_of.filter(|points| !is_degenerate(*points))) {
            for (k, a, b) in [(0, a, b), (1, b, c), (2, c, a)] {
                if let Some(place) = next.get_mut((a.min(b) as usize).wrapping_sub(points.start)) {
                    sides[*place as usize] = Side::new(index, k, b < a, a.max(b));
                    *place += 1;
                }
            }
        }
        let mut edges = 0;
        for run in runs {
            // Sides of one edge stay in the order of their patches.
            sides[run.clone()].sort_by_key(|side| side.edge);
            edges += sides[run].chunk_by(|a, b| a.edge == b.edge).count();
        }
        edges
    });
    let edges: Vec<usize> = edges.collect();
    let mut first = 0;
    for (range, edges) in zip(&mut ranges, edges) {
        range.edges = first..first + edges;
        first += edges;
    }
    (sides, ranges)
}

/// Divides points into a range for each core, with about as many sides each. Their edges are counted later. Points after the last side
/// are left out.
fn point_ranges(starts: &[u32]) -> Vec<PointRange> {
    let count = starts.last().map_or(0, |last| *last as usize);
    let (mut point, mut side) = (0, 0);
    let range = |some: Range<usize>| {
        let points = point..starts.partition_point(|start| (*start as usize) < some.end);
        let sides = side..starts.get(points.end).map_or(0, |start| *start as usize);
        (point, side) = (points.end, sides.end);
        PointRange { points, sides, edges: 0..0 }
    };
    ranges(count, 3 * LEAST).map(range).collect()
}

/// Makes an edge of each group of sorted sides with the same points, and connects sides with edges. The `edge` of these sides still
/// holds the higher point. `has_many` says of each point whether it has more than one corner.
pub(super) fn edges(
    topology: &Topology,
    sides: &mut [Side],
    ranges: &[PointRange],
    starts: &[u32],
    has_many: &[bool],
    corners: &[Corner],
) -> Vec<Edge> {
    let mut edges: Vec<Edge> = zeroed_vec(ranges.last().map_or(0, |range| range.edges.end));
    let of_sides = split(sides, ranges.iter().map(|range| range.sides.len()));
    let of_edges = split(&mut edges, ranges.iter().map(|range| range.edges.len()));
    ranges.par_iter().zip(of_sides).zip(of_edges).for_each(|((range, sides), edges)| {
        let mut numbered = zip(to_u32(range.edges.start).., edges.iter_mut());
        for point in range.points.clone() {
            let (start, end) = (starts[point] as usize, starts[point + 1] as usize);
            let mut first_side = to_u32(start);
            let around = &mut sides[start - range.sides.start..end - range.sides.start];
            for run in around.chunk_by_mut(|a, b| a.edge == b.edge) {
                let high = run[0].edge as usize;
                let (kind, shares_corners) = match run {
                    // Most edges need no look at their corners.
                    [_, _] if !has_many[point] && !has_many[high] => (EdgeKind::Smooth, true),
                    _ => topology.kind(run, corners),
                };
                let Some((number, edge)) = numbered.next() else { return };
                *edge = Edge { first_side, kind, shares_corners };
                run.iter_mut().for_each(|side| side.edge = number);
                first_side += to_u32(run.len());
            }
        }
    });
    edges
}

/// Connects patches with their sides.
pub(super) fn connect(patches: &mut [Patch], sides: &[Side]) {
    let ranges: Vec<_> = ranges(patches.len(), LEAST).collect();
    // Each core looks at all sides.
    split(patches, ranges.iter().map(Range::len)).into_par_iter().zip(ranges).for_each(|(patches, range)| {
        for (index, side) in (0..).zip(sides) {
            if let Some(patch) = patches.get_mut((side.patch() as usize).wrapping_sub(range.start)) {
                patch.sides[side.index()] = index;
            }
        }
    });
}

//! Cuts one triangle into pieces.

use std::collections::HashMap;

use glam::{DVec3, Vec2, Vec3};

use super::cuts::{Cuts, EdgeCuts};
use super::fans::blend;
use crate::casts::{to_f32, to_u32};
use crate::mesh::{Corner, Topology};

/// The greatest part of the way from a corner to the centre of the incircle.
const LARGEST_PART: f64 = 0.5;

/// By how much the band inside each further triangle on the same three points is narrower, as a part of the width. So
/// the two sides of a thin sheet keep edges and normals of their own.
const TWIN_STEP: f64 = 0.125;

/// Cuts patches into pieces.
pub(super) struct Cutter<'a> {
    cuts: &'a Cuts<'a>,
    /// See [`twins`].
    twins: HashMap<u32, u32>,
    /// The number of triangles that are too small for the width.
    pub narrowed: u32,
}

/// How a triangle is cut back at a corner.
#[derive(Clone, Copy)]
enum Inset {
    /// It isn't cut there.
    None,
    /// To a point inside, away from two creased sides.
    Inside(Corner),
    /// To a point on the one of its sides that isn't creased.
    On(Corner),
    /// The corner is cut off between two points: one on the side that ends there, one on the side that starts there.
    Off([Corner; 2]),
}

/// A patch with everything that its pieces are computed from.
struct CutPatch {
    /// Its corners, on the topology's points, with their own normals.
    own: [Corner; 3],
    /// The same corners with the normals that their fans share.
    shared: [Corner; 3],
    /// Whether the normals of the corner's fan differ.
    is_split: [bool; 3],
    /// Whether side k is creased.
    is_creased: [bool; 3],
    /// The cuts on side k, near its start and near its end.
    cuts: [[Option<Corner>; 2]; 3],
}

impl<'a> Cutter<'a> {
    /// Prepares to cut patches.
    pub(super) fn new(cuts: &'a Cuts) -> Self {
        Self { cuts, twins: twins(cuts.fans.topology), narrowed: 0 }
    }

    /// Calls `add` with each piece of a patch: first what the cuts leave of it, then the strips along creased sides.
    pub(super) fn pieces(&mut self, patch: u32, add: &mut dyn FnMut([Corner; 3])) {
        let whole = self.whole(patch);
        let part = self.inside_part(patch, &whole);
        let insets = [0, 1, 2].map(|k| whole.inset(k, part));
        let mut rest = Vec::with_capacity(6);
        for (k, inset) in insets.iter().enumerate() {
            match *inset {
                Inset::None => rest.push(whole.shared[k]),
                Inset::Inside(corner) | Inset::On(corner) => rest.push(corner),
                Inset::Off(both) => rest.extend(both),
            }
        }
        // The outline is convex, and no three corners lie on a line, since at most two lie on any side.
        for pair in rest[1..].windows(2) {
            add([rest[0], pair[0], pair[1]]);
        }
        for (k, inset) in insets.iter().enumerate() {
            if let Inset::Off([before, after]) = *inset {
                add([whole.shared[k], after, before]);
            }
            if whole.is_creased[k] {
                whole.strip(k, &insets, add);
            }
        }
    }

    fn whole(&self, patch: u32) -> CutPatch {
        let Cuts { fans, edges: cuts, .. } = self.cuts;
        let topology = fans.topology;
        let own = topology.patch_corners(patch).map(|corner| fans.on_point(corner));
        let sides = topology.patches[patch as usize].sides.map(|side| topology.sides[side as usize]);
        let edges: [&EdgeCuts; 3] = sides.map(|side| &cuts[side.edge as usize]);
        let cut = |k: usize, end: usize| {
            let cut = edges[k].ends[if sides[k].reversed() { 1 - end } else { end }]?;
            let (from, to) = (own[(k + end) % 3], own[(k + 1 - end) % 3]);
            Some(Corner { position: cut.position, normal: cut.normal, uv: from.uv.lerp(to.uv, cut.part) })
        };
        let normals = [0, 1, 2].map(|k| fans.normal(patch, k));
        CutPatch {
            own,
            shared: [0, 1, 2].map(|k| Corner { normal: normals[k].unwrap_or(own[k].normal), ..own[k] }),
            is_split: normals.map(|normal| normal.is_some()),
            is_creased: edges.map(|edge| edge.is_creased),
            cuts: [0, 1, 2].map(|k| [cut(k, 0), cut(k, 1)]),
        }
    }

    /// Returns which part of the way from a corner to the incircle's centre moves a point by the width from both sides.
    fn inside_part(&mut self, patch: u32, whole: &CutPatch) -> f64 {
        if (0..3).all(|k| !whole.has_inside(k)) {
            return 0.0;
        }
        let [a, b, c] = whole.own.map(|corner| corner.position.as_dvec3());
        let perimeter = a.distance(b) + b.distance(c) + c.distance(a);
        let radius = (b - a).cross(c - a).length() / perimeter;
        let width = self.cuts.width;
        self.narrowed += u32::from(width > LARGEST_PART * radius);
        let part = if width < LARGEST_PART * radius { width / radius } else { LARGEST_PART };
        part / (1.0 + TWIN_STEP * f64::from(self.twins.get(&patch).copied().unwrap_or(0)))
    }
}

/// Numbers the patches that have the same three points: 1 for the second, 2 for the third. The first isn't listed.
fn twins(topology: &Topology) -> HashMap<u32, u32> {
    let points = |index: u32| {
        let mut points = topology.patch_points(index);
        points.sort_unstable();
        (points, index)
    };
    let mut patches: Vec<_> = (0..to_u32(topology.patches.len())).map(points).collect();
    patches.sort_unstable();
    let groups = patches.chunk_by(|a, b| a.0 == b.0);
    groups.flat_map(|group| group.iter().zip(0..).skip(1)).map(|(&(_, patch), rank)| (patch, rank)).collect()
}

impl CutPatch {
    /// Returns whether corner `k` is cut back from two creased sides.
    fn has_inside(&self, k: usize) -> bool {
        self.is_split[k] && self.is_creased[k] && self.is_creased[(k + 2) % 3]
    }

    fn inset(&self, k: usize, part: f64) -> Inset {
        let before = (k + 2) % 3;
        let (cut_before, cut_after) = (self.cuts[before][1], self.cuts[k][0]);
        if self.has_inside(k) {
            return Inset::Inside(self.inside(k, part));
        }
        // An edge without a crease is cut, for all its sides, at an end with split normals.
        match (self.is_creased[before], self.is_creased[k], cut_before, cut_after) {
            (false, true, Some(cut), _) | (true, false, _, Some(cut)) => Inset::On(cut),
            (false, false, Some(before), Some(after)) => Inset::Off([before, after]),
            _ => Inset::None,
        }
    }

    /// Returns the point at a part of the way from corner `k` to the incircle's centre. Each corner's weight in that
    /// centre is the length of the opposite side.
    fn inside(&self, k: usize, part: f64) -> Corner {
        let p = self.own.map(|corner| corner.position.as_dvec3());
        let opposite = [0, 1, 2].map(|i| p[(i + 1) % 3].distance(p[(i + 2) % 3]));
        let perimeter: f64 = opposite.iter().sum();
        let weight = |i: usize| part * opposite[i] / perimeter;
        let offset = |i: usize| weight(i) * (p[i] - p[k]);
        let uv_offset = |i: usize| to_f32(weight(i)) * (self.own[i].uv - self.own[k].uv);
        let (next, last) = ((k + 1) % 3, (k + 2) % 3);
        let position: DVec3 = p[k] + offset(next) + offset(last);
        let position: Vec3 = position.as_vec3();
        if position == self.own[k].position {
            // In f32, the point would be the corner itself.
            return self.shared[k];
        }
        let weights = [(k, 1.0 - weight(next) - weight(last)), (next, weight(next)), (last, weight(last))];
        let normal = blend(weights.map(|(i, weight)| (weight, self.own[i].normal)));
        let uv: Vec2 = self.own[k].uv + uv_offset(next) + uv_offset(last);
        Corner { position, normal, uv }
    }

    /// Adds the triangles between the creased side `k` and the cut along it.
    fn strip(&self, k: usize, insets: &[Inset; 3], add: &mut dyn FnMut([Corner; 3])) {
        let next = (k + 1) % 3;
        let inner = |k: usize| match insets[k] {
            Inset::Inside(corner) | Inset::On(corner) => Some(corner),
            Inset::None | Inset::Off(_) => None,
        };
        let (mut from, mut to) = (self.shared[k], self.shared[next]);
        let (inner_from, inner_to) = (inner(k), inner(next));
        if let (Some(cut), Some(inner)) = (self.cuts[k][0], inner_from) {
            add([from, cut, inner]);
            from = cut;
        }
        if let (Some(cut), Some(inner)) = (self.cuts[k][1], inner_to) {
            add([cut, to, inner]);
            to = cut;
        }
        match (inner_from, inner_to) {
            (Some(inner_from), Some(inner_to)) => {
                // This diagonal can't leave the strip, however wide it is at either end.
                if matches!((insets[k], insets[next]), (Inset::Inside(_), Inset::On(_))) {
                    add([from, to, inner_from]);
                    add([to, inner_to, inner_from]);
                } else {
                    add([from, to, inner_to]);
                    add([from, inner_to, inner_from]);
                }
            }
            (Some(inner), None) | (None, Some(inner)) => add([from, to, inner]),
            (None, None) => {}
        }
    }
}

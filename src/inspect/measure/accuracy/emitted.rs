//! What was emitted, as far as it is kept: its triangles, and the patch of each.

use glam::{DVec3, Vec3};

use super::WorstPoint;
use crate::reference_shape::{Closest, Triangles};
use geometry::tessellate::Vertex;

/// The triangles of some chunks.
#[derive(Default)]
pub(super) struct Emitted {
    chunks: Vec<Chunk>,
}

struct Chunk {
    tree: Triangles,
    /// The patch of each triangle.
    patches: Vec<u32>,
}

/// The emitted point that is nearest to some place.
#[derive(Clone, Copy, Debug)]
pub(super) struct NearestEmitted {
    pub point: DVec3,
    pub distance: f64,
    pub patch: u32,
}

impl NearestEmitted {
    /// The place with the distance from a point of the reference surface to this one.
    pub(super) fn from(self, reference_shape: DVec3) -> WorstPoint {
        WorstPoint { value: self.distance, patch: self.patch, emitted: self.point, reference_shape }
    }
}

impl Emitted {
    /// Adds the triangles of a chunk, whose positions must be finite.
    pub(super) fn add(&mut self, vertices: &[Vertex], triangles: &[[u32; 3]]) {
        let corners = |triangle: &[u32; 3]| triangle.map(|index| Vec3::from(vertices[index as usize].position));
        let patch = |triangle: &[u32; 3]| vertices[triangle[0] as usize].patch();
        if let Some(tree) = Triangles::new(triangles.iter().map(corners)) {
            self.chunks.push(Chunk { tree, patches: triangles.iter().map(patch).collect() });
        }
    }

    /// The number of triangles.
    pub(super) fn triangles(&self) -> usize {
        self.chunks.iter().map(|chunk| chunk.patches.len()).sum()
    }

    /// Returns the nearest point, if one is nearer than `within`.
    pub(super) fn closest(&self, p: DVec3, within: f64) -> Option<NearestEmitted> {
        self.chunks.iter().fold(None, |best: Option<NearestEmitted>, chunk| {
            let within = best.map_or(within, |best| best.distance);
            chunk.tree.closest(p, within).map(|closest| chunk.place(&closest)).or(best)
        })
    }

    /// Returns the nearest point; or if points are at most `enough` away, any of those, which is found faster. `hints` belong
    /// to a run of places that are near each other, and are empty at first.
    pub(super) fn closest_or_within(&self, p: DVec3, enough: f64, hints: &mut Vec<u32>) -> Option<NearestEmitted> {
        hints.resize(self.chunks.len(), 0);
        let mut best: Option<NearestEmitted> = None;
        for (chunk, hint) in self.chunks.iter().zip(hints) {
            let closest = chunk.tree.closest_or_within(p, enough, hint)?;
            if best.is_none_or(|best| closest.distance < best.distance) {
                best = Some(chunk.place(&closest));
            }
            if closest.distance <= enough {
                break;
            }
        }
        best
    }
}

impl Chunk {
    fn place(&self, closest: &Closest) -> NearestEmitted {
        let patch = self.patches[closest.triangle as usize];
        NearestEmitted { point: closest.point, distance: closest.distance, patch }
    }
}

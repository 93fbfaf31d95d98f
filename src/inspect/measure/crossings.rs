//! Patches that a curved surface makes cross each other: in a hollow, PN triangles may bulge through those beside them.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use glam::Vec3;

use super::accuracy::{Emitted, MOST_KEPT};
use super::visitor::{EmittedChunk, Visitor};
use geometry::mesh::Topology;
use geometry::near::{Crossing, cross, crossings};
use geometry::progress::{Cancelled, Progress};

/// Two patches whose triangles cross, though the mesh's own triangles don't. They may be the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrossedPatches {
    pub patches: [u32; 2],
    /// How many pairs of their triangles cross.
    pub pairs: u32,
    /// A place where two of them cross, in object units.
    pub at: Vec3,
}

/// Keeps what is emitted until all of it is.
#[derive(Default)]
pub struct CrossingMeasurement {
    emitted: Emitted,
}

impl CrossingMeasurement {
    /// The patches that cross, those with the most pairs of triangles first. `None` if more than [`MOST_KEPT`] triangles were
    /// emitted.
    ///
    /// # Errors
    /// `progress` was cancelled.
    pub fn finish(self, topology: &Topology, progress: &Progress) -> Result<Option<Vec<CrossedPatches>>, Cancelled> {
        let soup = self.emitted.soup();
        if soup.triangles.len() > MOST_KEPT {
            return Ok(None);
        }
        let mut all: HashMap<[u32; 2], CrossedPatches> = HashMap::new();
        for Crossing { triangles, at } in crossings(soup, progress)? {
            let patches @ [a, b] = triangles.map(|triangle| self.emitted.patch(triangle));
            match all.entry(patches) {
                Entry::Occupied(mut known) => known.get_mut().pairs += 1,
                Entry::Vacant(new) => {
                    let cross_flat =
                        a != b && cross(topology.patch_positions(a), topology.patch_positions(b)).is_some();
                    if !cross_flat {
                        new.insert(CrossedPatches { patches, pairs: 1, at: at.as_vec3() });
                    }
                }
            }
        }
        let mut all: Vec<_> = all.into_values().collect();
        all.sort_unstable_by_key(|crossed| (std::cmp::Reverse(crossed.pairs), crossed.patches));
        Ok(Some(all))
    }
}

impl Visitor for CrossingMeasurement {
    fn take(&mut self, chunk: &EmittedChunk) {
        let is_finite = |index: &u32| chunk.vertices[*index as usize].position.iter().all(|x| x.is_finite());
        let finite = chunk.triangles.iter().filter(|triangle| triangle.iter().all(is_finite));
        // One triangle more than are kept says that there were too many.
        let more = (MOST_KEPT + 1).saturating_sub(self.emitted.soup().triangles.len());
        self.emitted.add(chunk.vertices, &finite.take(more).copied().collect::<Vec<_>>());
    }
}

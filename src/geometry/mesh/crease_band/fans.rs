//! Fans: the corners around a point that are connected by edges, and the one normal that each fan gets.

use glam::{DVec3, Vec3};

use crate::casts::to_u32;
use crate::mesh::union_find::UnionFind;
use crate::mesh::weld::plus_zero3;
use crate::mesh::{Corner, Mesh, Side, Topology};

/// A sum of unit normals that is shorter than this is what rounding leaves of normals that cancel.
const CANCELLED: f64 = 1e-6;

/// All fans of a mesh. Parts of a mesh that meet in a point without a common edge have a fan each, since nothing can
/// tear between them.
pub(super) struct Fans<'a> {
    pub mesh: &'a Mesh,
    pub topology: &'a Topology,
    /// The fan of each corner k of each patch, at 3 * patch + k.
    fan_of: Vec<u32>,
    /// For each fan, the normal that its corners will share; none if they have the same normal already.
    pub normals: Vec<Option<Vec3>>,
}

impl<'a> Fans<'a> {
    pub(super) fn new(mesh: &'a Mesh, topology: &'a Topology) -> Self {
        let count = 3 * topology.patches.len();
        let parts = UnionFind::new(count);
        for edge in &topology.edges {
            for pair in topology.edge_sides(edge).windows(2) {
                for end in 0..2 {
                    let [a, b] = [&pair[0], &pair[1]].map(|side| slot(side.patch(), corner_at(side, end)));
                    parts.join(a, b);
                }
            }
        }
        let fan_of: Vec<u32> = (0..to_u32(count)).map(|slot| parts.of(slot)).collect();
        let corners = topology.patches.iter().flat_map(|patch| topology.corners(patch));
        let mut keys: Vec<_> =
            fan_of.iter().zip(corners).map(|(&fan, c)| (fan, key(mesh.corners[c as usize].normal))).collect();
        keys.sort_unstable();
        keys.dedup();
        let mut normals = vec![None; count];
        for fan in keys.chunk_by(|a, b| a.0 == b.0).filter(|fan| fan.len() > 1) {
            normals[fan[0].0 as usize] = Some(mean(fan.iter().map(|(_, key)| *key)));
        }
        Self { mesh, topology, fan_of, normals }
    }

    /// Returns the normal that corner `k` of a patch shares with its fan; none if the fan's normals don't differ.
    pub(super) fn normal(&self, patch: u32, k: usize) -> Option<Vec3> {
        self.normals[self.fan_of[slot(patch, k) as usize] as usize]
    }

    /// Returns the same as [`normal`](Self::normal) for an end of a side: 0 or 1, in its edge's own direction.
    pub(super) fn normal_at(&self, side: &Side, end: usize) -> Option<Vec3> {
        self.normal(side.patch(), corner_at(side, end))
    }

    /// Returns a side's own normal at an end of its edge.
    pub(super) fn own_normal(&self, side: &Side, end: usize) -> Vec3 {
        self.mesh.corners[self.topology.side_corners(side)[end] as usize].normal
    }

    /// Returns a corner of the mesh, moved to its point.
    pub(super) fn on_point(&self, corner: u32) -> Corner {
        let point = self.topology.corner_points[corner as usize];
        Corner { position: self.topology.points[point as usize], ..self.mesh.corners[corner as usize] }
    }
}

fn slot(patch: u32, k: usize) -> u32 {
    3 * patch + to_u32(k)
}

/// Returns which of its patch's corners a side has at an end of its edge, 0 to 2.
pub(super) fn corner_at(side: &Side, end: usize) -> usize {
    let k = side.index();
    if (end == 0) != side.reversed() { k } else { (k + 1) % 3 }
}

/// Returns the normalised mean of the distinct normals, or one of them where they cancel. How many corners have the
/// same normal doesn't matter, so the result doesn't depend on how faces are triangulated.
pub(super) fn shared(normals: impl Iterator<Item = Vec3>) -> Vec3 {
    let mut keys: Vec<_> = normals.map(key).collect();
    keys.sort_unstable();
    keys.dedup();
    mean(keys.into_iter())
}

/// Returns the bits of a normal, which are the same for equal normals (-0 equals 0).
fn key(normal: Vec3) -> [u32; 3] {
    plus_zero3(normal).to_array().map(f32::to_bits)
}

fn mean(keys: impl Iterator<Item = [u32; 3]> + Clone) -> Vec3 {
    let normal = |key: [u32; 3]| Vec3::from(key.map(f32::from_bits));
    let sum: DVec3 = keys.clone().map(|key| normal(key).as_dvec3()).sum();
    let whole = || sum.length() > CANCELLED;
    let first = keys.clone().next().map_or(Vec3::Z, normal);
    if keys.count() > 1 && whole() { sum.normalize().as_vec3() } else { first }
}

/// Returns a weighted sum of unit normals, normalised; or the first normal where they cancel.
pub(super) fn blend(normals: impl IntoIterator<Item = (f64, Vec3)>) -> Vec3 {
    let mut first = None;
    let mut sum = DVec3::ZERO;
    for (weight, normal) in normals {
        first.get_or_insert(normal);
        sum += weight * normal.as_dvec3();
    }
    if sum.length() > CANCELLED { sum.normalize().as_vec3() } else { first.unwrap_or(Vec3::Z) }
}

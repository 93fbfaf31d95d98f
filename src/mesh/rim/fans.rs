//! Fans: the corners around a point that hang together by edges, and the one normal that each gets.

use glam::{DVec3, Vec3};

use crate::mesh::union_find::UnionFind;
use crate::mesh::weld::plus_zero3;
use crate::mesh::{Mesh, Side, Topology};

/// Shorter sums of unit normals than this are what rounding leaves of normals that cancel.
const CANCELLED: f64 = 1e-6;

/// All fans of a mesh. UnionFind of a mesh that meet in a point without an edge have a fan each: there is nothing to tear.
pub struct Fans {
    /// The fan of every patch's every corner, at 3 * patch + k.
    fan_of: Vec<u32>,
    /// The normal that a fan's corners share from now on; none if they have but one.
    normals: Vec<Option<Vec3>>,
}

impl Fans {
    pub fn of(mesh: &Mesh, topology: &Topology) -> Self {
        let count = 3 * topology.patches.len();
        let mut parts = UnionFind::new(count);
        for edge in &topology.edges {
            for pair in topology.edge_sides(edge).windows(2) {
                for end in 0..2 {
                    let [a, b] = [&pair[0], &pair[1]].map(|side| slot(side.patch(), corner_at(side, end)));
                    parts.join(a, b);
                }
            }
        }
        let fan_of: Vec<u32> = (0..count as u32).map(|slot| parts.of(slot)).collect();
        let corners = topology.patches.iter().flat_map(|patch| topology.corners(patch));
        let mut keys: Vec<_> =
            fan_of.iter().zip(corners).map(|(&fan, c)| (fan, key(mesh.corners[c as usize].normal))).collect();
        keys.sort_unstable();
        keys.dedup();
        let mut normals = vec![None; count];
        for fan in keys.chunk_by(|a, b| a.0 == b.0).filter(|fan| fan.len() > 1) {
            normals[fan[0].0 as usize] = Some(mean(fan.iter().map(|(_, key)| *key)));
        }
        Self { fan_of, normals }
    }

    /// Whether there is a fan whose normals differ.
    pub fn any_split(&self) -> bool {
        self.normals.iter().any(Option::is_some)
    }

    /// What corner `k` of a patch shares with its fan; none if nothing is split there.
    pub fn normal(&self, patch: u32, k: usize) -> Option<Vec3> {
        self.normals[self.fan_of[slot(patch, k) as usize] as usize]
    }

    /// The same at an end of a side, 0 or 1 in its edge's own direction.
    pub fn normal_at(&self, side: &Side, end: usize) -> Option<Vec3> {
        self.normal(side.patch(), corner_at(side, end))
    }
}

fn slot(patch: u32, k: usize) -> u32 {
    3 * patch + k as u32
}

/// Which of its patch's corners a side has at an end of its edge, 0 to 2.
pub fn corner_at(side: &Side, end: usize) -> usize {
    let k = side.index();
    if (end == 0) != side.reversed() { k } else { (k + 1) % 3 }
}

/// The mean of distinct normals at unit length: how many corners have each doesn't matter, so neither does how faces are
/// triangulated. One of them where they cancel.
pub fn shared(normals: impl Iterator<Item = Vec3>) -> Vec3 {
    let mut keys: Vec<_> = normals.map(key).collect();
    keys.sort_unstable();
    keys.dedup();
    mean(keys.into_iter())
}

/// Equal normals as equal keys.
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

/// A weighted sum of unit normals at unit length; the first where they cancel.
pub fn blend(normals: impl IntoIterator<Item = (f64, Vec3)>) -> Vec3 {
    let mut first = None;
    let mut sum = DVec3::ZERO;
    for (weight, normal) in normals {
        first.get_or_insert(normal);
        sum += weight * normal.as_dvec3();
    }
    if sum.length() > CANCELLED { sum.normalize().as_vec3() } else { first.unwrap_or(Vec3::Z) }
}

//! Corners that differ in nothing but their details.

use std::hash::BuildHasher;

use foldhash::fast::RandomState;
use rayon::prelude::*;

use super::rig::Binding;
use super::{Corner, Mesh};
use crate::casts::to_u32;

/// The most corners that are found to be alike, so that work for each of them with all triangles of all of them is limited.
const MOST: usize = 64;

impl Mesh {
    /// Returns for each corner the first one that differs from it in its [`details`](Self::details) alone, or the corner itself.
    /// Where very many corners are alike, each is returned itself.
    pub fn alike_corners(&self) -> Vec<u32> {
        let mut firsts: Vec<u32> = (0..to_u32(self.corners.len())).collect();
        if self.details.is_none() {
            return firsts;
        }
        // Equal keys have equal hashes, which are sorted several times faster than the keys.
        let hasher = RandomState::default();
        let mut sorted: Vec<(u64, u32)> =
            firsts.par_iter().map(|corner| (hasher.hash_one(self.key(*corner)), *corner)).collect();
        sorted.par_sort_unstable();
        let groups = sorted.chunk_by(|(hash, a), (other, b)| hash == other && self.key(*a) == self.key(*b));
        for alike in groups.filter(|alike| alike.len() <= MOST) {
            alike.iter().for_each(|(_, corner)| firsts[*corner as usize] = alike[0].1);
        }
        firsts
    }

    fn key(&self, corner: u32) -> ([u32; 8], Option<[u32; 16]>) {
        let Corner { position, normal, uv } = self.corners[corner as usize];
        let ([x, y, z], [a, b, c], [u, v]) = (position.to_array(), normal.to_array(), uv.to_array());
        let binding = self.rig.as_ref().map(|rig| bytemuck::cast::<Binding, [u32; 16]>(rig.bindings[corner as usize]));
        ([x, y, z, a, b, c, u, v].map(f32::to_bits), binding)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use crate::mesh::{CornerDetail, Shape};

    #[test]
    fn only_details_may_differ() {
        let mut mesh = Shape::Torus.build();
        let count = mesh.corners.len() as u32;
        mesh.corners.extend(mesh.corners.clone());
        assert_eq!(mesh.alike_corners(), (0..2 * count).collect::<Vec<_>>());
        mesh.details = Some(Arc::new(vec![CornerDetail::default(); mesh.corners.len()]));
        assert_eq!(mesh.alike_corners(), (0..count).chain(0..count).collect::<Vec<_>>());
        let last = mesh.corners.len() - 1;
        mesh.corners[last].uv.x += 1.0;
        assert_eq!(mesh.alike_corners()[last], last as u32);
        mesh.corners = vec![mesh.corners[0]; 65];
        mesh.details = Some(Arc::new(vec![CornerDetail::default(); 65]));
        assert_eq!(mesh.alike_corners(), (0..65).collect::<Vec<_>>());
    }
}

//! Height images, for displacement: each a pyramid of ever smaller ones, so that what is sampled fits what is drawn.

mod pyramid;

use glam::Vec2;

use super::Mesh;
use crate::progress::{Cancelled, Progress};

/// The largest width and height that is kept, in px: larger images are made smaller first.
pub const MAX_KEPT: u32 = 4096;

/// Levels that a map has at most: 4096 px halved down to 1.
pub const MAX_LEVELS: usize = 13;

/// Maps that a mesh has at most: as many as the shaders have room for.
pub const MAX_MAPS: usize = 256;

/// One image's heights, 0 (black) to 1 (white), level after level; each level half as wide and high as the one before, down
/// to a single px.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightMap {
    /// Width and height of level 0, in px.
    pub size: [u32; 2],
    pub levels: u32,
    /// Whether it starts again where it ends: some texture coordinate goes beyond 0 to 1. Else its border goes on.
    pub repeats: bool,
    /// Rows from the top, level after level.
    pub heights: Vec<f32>,
}

/// What a mesh is displaced by.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Heights {
    pub maps: Vec<HeightMap>,
    /// The map of each of the mesh's materials; none for what stays where it is.
    pub of_material: Vec<Option<u32>>,
    /// The least and the greatest height in any map.
    pub range: [f32; 2],
    /// The mesh's bounding radius before anything moves it, in object units: heights are measured in it.
    pub radius: f32,
    /// The sum of the angles, in radians, that triangles have at each of the mesh's corners, before anything moves them.
    pub angles: Vec<f32>,
    /// How far level l of each map, linearly interpolated, is from its level 0 at most; no less for a coarser level.
    pub detail: Vec<[f32; MAX_LEVELS]>,
}

impl HeightMap {
    /// Width and height of a level, in px.
    pub fn level_size(&self, level: u32) -> [u32; 2] {
        self.size.map(|side| (side >> level).max(1))
    }
}

impl Heights {
    /// One map for all of a mesh's materials.
    pub fn everywhere(mesh: &Mesh, map: HeightMap) -> Self {
        // It fails only when it is cancelled, and this progress is nobody else's.
        Self::all_over(mesh, map, &Progress::new()).expect("nobody cancels")
    }

    /// The same; stops when `progress` says so.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub(crate) fn all_over(mesh: &Mesh, map: HeightMap, progress: &Progress) -> Result<Self, Cancelled> {
        Self::new(mesh, vec![map], vec![Some(0); mesh.materials.len()], progress)
    }

    /// Maps and the map of each material.
    ///
    /// # Errors
    /// [`Cancelled`] when `progress` says so.
    pub(crate) fn new(
        mesh: &Mesh,
        mut maps: Vec<HeightMap>,
        of_material: Vec<Option<u32>>,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        for (material, map) in mesh.materials.iter().zip(&of_material) {
            let triangles = &mesh.triangles[material.triangles.start as usize..material.triangles.end as usize];
            let uvs = triangles.iter().flatten().map(|&corner| mesh.corners[corner as usize].uv);
            let beyond = |uv: Vec2| uv.cmplt(Vec2::ZERO).any() || uv.cmpgt(Vec2::ONE).any();
            if let Some(map) = map.and_then(|map| maps.get_mut(map as usize)) {
                map.repeats |= uvs.clone().any(beyond);
            }
        }
        let mut range = [f32::INFINITY, f32::NEG_INFINITY];
        for map in &maps {
            let [width, height] = map.size;
            for &own in &map.heights[..(width * height) as usize] {
                range = [range[0].min(own), range[1].max(own)];
            }
        }
        let part = |index: usize| index as f32 / maps.len() as f32;
        let lost = |(index, map): (usize, &HeightMap)| map.detail(&progress.part(part(index), part(index + 1)));
        let detail = maps.iter().enumerate().map(lost).collect::<Result<_, _>>()?;
        Ok(Self { maps, of_material, range, radius: mesh.bounds().radius(), angles: angles(mesh), detail })
    }

    /// How far anything is moved at most, in units of the scale.
    pub fn reach(&self, midlevel: f32) -> f32 {
        (self.range[0] - midlevel).abs().max((self.range[1] - midlevel).abs())
    }

    /// Bytes of all maps.
    pub fn bytes(&self) -> u64 {
        self.maps.iter().map(|map| size_of_val(&map.heights[..]) as u64).sum()
    }
}

/// What [`Heights::angles`] takes, in bytes.
pub(crate) fn angle_bytes(corners: usize) -> u64 {
    4 * corners as u64
}

fn angles(mesh: &Mesh) -> Vec<f32> {
    let mut angles = vec![0.0; mesh.corners.len()];
    for triangle in mesh.triangles.iter() {
        let at = triangle.map(|corner| mesh.corners[corner as usize].position.as_dvec3());
        for k in 0..3 {
            let [a, b] = [1, 2].map(|step| (at[(k + step) % 3] - at[k]).normalize_or_zero());
            angles[triangle[k] as usize] += a.cross(b).length().atan2(a.dot(b)) as f32;
        }
    }
    angles
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Shape;

    #[test]
    fn detail_is_lost_level_by_level() {
        // A checkerboard is gone at once, a slope not at all inside.
        let board = HeightMap::new([8, 8], (0..64).map(|i| ((i + i / 8) % 2) as f32).collect());
        let heights = Heights::everywhere(&Shape::Torus.build(), board);
        let detail = heights.detail[0];
        assert_eq!((detail[0], heights.range), (0.0, [0.0, 1.0]));
        assert!(detail[1] > 0.4 && detail[12] >= detail[3]);
        assert_eq!(heights.reach(0.25), 0.75);
        let flat = Heights::everywhere(&Shape::Torus.build(), HeightMap::new([8, 8], vec![0.5; 64]));
        assert!(flat.detail[0].iter().all(|&lost| lost < 1e-6), "{:?}", flat.detail);
    }
}

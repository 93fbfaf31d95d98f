//! Height images for displacement. Each is a pyramid of levels, so that a sample can cover an area that suits the
//! triangles.

mod pyramid;
mod relief;

pub use relief::{PatchRelief, RELIEF_STEPS, Relief, patch_reliefs};

use glam::Vec2;

use super::Mesh;
use crate::casts::to_f32;
use crate::progress::{Cancelled, Progress};

/// The greatest width and height of a height map, in px. Larger images are scaled down.
pub const MAX_KEPT: u32 = 4096;

/// The greatest number of maps of a mesh, for which the shaders have room.
pub const MAX_MAPS: usize = 256;

/// The heights of one image, from 0 (black) to 1 (white), in levels. Each level is half as wide and high as the one
/// before, down to a single pixel.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct HeightMap {
    /// The width and height of level 0, in px.
    pub size: [u32; 2],
    /// The number of levels.
    pub levels: u32,
    /// Whether the image repeats, since some texture coordinate lies outside 0 to 1. Otherwise the pixels at its border
    /// continue.
    pub repeats: bool,
    /// The pixels of all levels, one level after another, each row by row from the top.
    pub heights: Vec<f32>,
}

/// The height maps that displace a mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Heights {
    /// The images.
    pub maps: Vec<HeightMap>,
    /// For each of the mesh's materials, its map; none if the material isn't displaced.
    pub of_material: Vec<Option<u32>>,
    /// Whether each map is the brightness of its material's base colour.
    pub are_of_colors: bool,
    /// The least and the greatest height in all maps.
    pub range: [f32; 2],
    /// The mesh's bounding radius at rest, in object units. The scale of displacement is a multiple of it.
    pub radius: f32,
    /// For each of the mesh's corners, the sum of the angles, in radians, of the triangles there, in the mesh at rest.
    pub angles: Vec<f32>,
    /// For each of the mesh's triangles, bounds on the heights over it.
    pub reliefs: Vec<Relief>,
}

impl HeightMap {
    /// Returns the width and height of a level, in px.
    pub fn level_size(&self, level: u32) -> [u32; 2] {
        self.size.map(|side| (side >> level).max(1))
    }
}

impl Heights {
    /// Uses one map for all materials of a mesh.
    pub fn everywhere(mesh: &Mesh, map: HeightMap) -> Self {
        // The only possible error is cancellation, and no other code has this handle.
        Self::all_over(mesh, map, &Progress::new()).expect("not cancelled")
    }

    /// Uses a map made in code, of `side` px a side, with so many waves across and down. It can be repeated without a seam.
    pub fn waves(mesh: &Mesh, side: u32, [across, down]: [f32; 2]) -> Self {
        let height = |i: u32| {
            let [x, y] = [i % side, i / side].map(|x| std::f32::consts::TAU * (x as f32 + 0.5) / side as f32);
            0.5 + 0.25 * (across * x).sin() * (down * y).cos() + 0.2 * (x + 2.0 * y).cos()
        };
        Self::everywhere(mesh, HeightMap::new([side; 2], (0..side * side).map(height).collect()))
    }

    /// Uses one map for all materials of a mesh, and can be cancelled.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn all_over(mesh: &Mesh, map: HeightMap, progress: &Progress) -> Result<Self, Cancelled> {
        Self::new(mesh, vec![map], vec![Some(0); mesh.materials.len()], progress)
    }

    /// Uses several maps; `of_material` holds the map of each material.
    ///
    /// # Errors
    /// [`Cancelled`] when `progress` says so.
    pub fn new(
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
        let reliefs = relief::reliefs(mesh, &maps, &of_material, progress)?;
        Ok(Self {
            maps,
            of_material,
            are_of_colors: false,
            range,
            radius: mesh.bounds().radius(),
            angles: angles(mesh),
            reliefs,
        })
    }

    /// Returns the number of a material's image, if it has one.
    pub fn map_of(&self, material: usize) -> Option<u32> {
        self.of_material.get(material).copied().flatten()
    }

    /// Returns the images.
    pub fn maps(&self) -> &[HeightMap] {
        &self.maps
    }

    /// Returns the greatest distance that a point can be moved by, as a multiple of the scale.
    pub fn reach(&self, midlevel: f32) -> f32 {
        (self.range[0] - midlevel).abs().max((self.range[1] - midlevel).abs())
    }

    /// Returns the size of all maps, in bytes.
    pub fn bytes(&self) -> u64 {
        self.maps.iter().map(|map| size_of_val(&map.heights[..]) as u64).sum()
    }
}

/// Returns how many bytes [`Heights`] take for a mesh beside their maps: for angles, and for bounds over triangles while they are made.
pub fn bytes_beside_maps(mesh: &Mesh) -> u64 {
    4 * mesh.corners.len() as u64 + 132 * mesh.triangles.len() as u64
}

fn angles(mesh: &Mesh) -> Vec<f32> {
    let mut angles = vec![0.0; mesh.corners.len()];
    for triangle in mesh.triangles.iter() {
        let at = triangle.map(|corner| mesh.corners[corner as usize].position.as_dvec3());
        for k in 0..3 {
            let [a, b] = [1, 2].map(|step| (at[(k + step) % 3] - at[k]).normalize_or_zero());
            angles[triangle[k] as usize] += to_f32(a.cross(b).length().atan2(a.dot(b)));
        }
    }
    angles
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Shape;

    #[test]
    fn a_point_moves_by_the_height_that_differs_most_from_the_middle() {
        let map = HeightMap::new([4, 4], (0..16).map(|i| if i < 8 { 0.25 } else { 1.0 }).collect());
        let heights = Heights::everywhere(&Shape::Torus.build(), map);
        assert_eq!([0.0, 0.5, 0.75, 1.0].map(|midlevel| heights.reach(midlevel)), [1.0, 0.5, 0.5, 0.75]);
    }

    #[test]
    fn angles_and_bounds_take_as_many_bytes_as_is_said() {
        let mesh = Shape::Torus.build();
        let reliefs = mesh.triangles.len() * size_of::<Relief>();
        assert!(bytes_beside_maps(&mesh) > (size_of_val(&angles(&mesh)[..]) + reliefs) as u64);
    }
}

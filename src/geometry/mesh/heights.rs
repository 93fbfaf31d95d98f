//! Height images for displacement, one for each material or one for all. Each is a pyramid of levels, so that a sample can cover an
//! area that suits the triangles.

mod pyramid;
mod relief;

pub use relief::{PatchRelief, RELIEF_STEPS, Relief, patch_reliefs};

use std::collections::HashMap;
use std::sync::Arc;

use glam::Vec2;

use super::Mesh;
use crate::casts::{to_f32, to_u32};
use crate::progress::{Cancelled, Progress};

/// The greatest width and height of a height map, in px. Larger images are scaled down.
pub const MAX_KEPT: u32 = 4096;

/// The greatest number of maps of a mesh, for which the shaders have room.
pub const MAX_MAPS: usize = 256;

/// How far heights move the surface: by `scale` * (height - `midlevel`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeightAmount {
    /// How far white is above black, in object units.
    pub scale: f32,
    /// The height that stays where it is.
    pub midlevel: f32,
}

impl HeightAmount {
    /// The amount by which a height that is multiplied by `factor` and then has `offset` added moves the surface, both in object
    /// units; none if that isn't finite, or doesn't depend on the height.
    pub fn from_factor(factor: f32, offset: f32) -> Option<Self> {
        let amount = Self { scale: factor, midlevel: -offset / factor };
        (factor != 0.0 && factor.is_finite() && amount.midlevel.is_finite()).then_some(amount)
    }
}

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
    /// How far it moves the surface; none if the settings say so.
    pub amount: Option<HeightAmount>,
    /// The least and the greatest height.
    pub range: [f32; 2],
    /// The pixels of all levels, one level after another, each row by row from the top. Maps that differ in the rest share them.
    pub heights: Arc<Vec<f32>>,
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

    /// Returns the same image with an amount of its own.
    pub fn with_amount(&self, amount: Option<HeightAmount>) -> Self {
        Self { amount, ..self.clone() }
    }

    /// Whether both have the same pixels, without comparing them.
    pub fn shares_pixels(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.heights, &other.heights)
    }

    /// Returns the greatest distance that it moves a point by, in object units, where the settings say `usual`.
    pub fn reach(&self, usual: HeightAmount) -> f32 {
        let HeightAmount { scale, midlevel } = self.amount.unwrap_or(usual);
        scale.abs() * self.range.map(|height| (height - midlevel).abs()).into_iter().fold(0.0, f32::max)
    }
}

impl Heights {
    /// Uses one map for all materials of a mesh.
    pub fn everywhere(mesh: &Mesh, map: HeightMap) -> Self {
        // The only possible error is cancellation, and no other code has this handle.
        Self::all_over(mesh, map, &Progress::new()).expect("not cancelled")
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
        let reliefs = relief::reliefs(mesh, &maps, &of_material, progress)?;
        Ok(Self {
            maps,
            of_material,
            are_of_colors: false,
            radius: mesh.bounds().radius(),
            angles: angles(mesh),
            reliefs,
        })
    }

    /// Uses the maps that materials have; none without any. Materials whose maps are equal share one.
    ///
    /// # Errors
    /// [`Cancelled`] when `progress` says so.
    pub fn of_materials(
        mesh: &Mesh,
        own: &[Option<HeightMap>],
        progress: &Progress,
    ) -> Result<Option<Self>, Cancelled> {
        let mut maps: Vec<HeightMap> = Vec::new();
        let mut number = |own: &HeightMap| {
            let is_same = |map: &HeightMap| map.shares_pixels(own) && map.amount == own.amount;
            let known = maps.iter().position(is_same);
            to_u32(known.unwrap_or_else(|| {
                maps.push(own.clone());
                maps.len() - 1
            }))
        };
        let of_material: Vec<_> = own.iter().map(|own| own.as_ref().map(&mut number)).collect();
        if maps.is_empty() {
            return Ok(None);
        }
        Self::new(mesh, maps, of_material, progress).map(Some)
    }

    /// Returns the number of a material's image, if it has one.
    pub fn map_of(&self, material: usize) -> Option<u32> {
        self.of_material.get(material).copied().flatten()
    }

    /// Returns the images.
    pub fn maps(&self) -> &[HeightMap] {
        &self.maps
    }

    /// Returns the greatest distance that a point can be moved by, in object units, where the settings say `usual`.
    pub fn reach(&self, usual: HeightAmount) -> f32 {
        self.maps.iter().map(|map| map.reach(usual)).fold(0.0, f32::max)
    }

    /// Whether the settings say how far some image moves the surface.
    pub fn follow_settings(&self) -> bool {
        self.maps.iter().any(|map| map.amount.is_none())
    }

    /// Returns the size of all maps, in bytes.
    pub fn bytes(&self) -> u64 {
        bytes_of_maps(self.maps.iter())
    }
}

/// Returns the size of maps in bytes. Pixels that several share count once.
pub fn bytes_of_maps<'a>(maps: impl Iterator<Item = &'a HeightMap>) -> u64 {
    let known: HashMap<*const Vec<f32>, u64> =
        maps.map(|map| (Arc::as_ptr(&map.heights), size_of_val(&map.heights[..]) as u64)).collect();
    known.values().sum()
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
        let reach = |midlevel| heights.reach(HeightAmount { scale: -2.0, midlevel });
        assert_eq!([0.0, 0.5, 0.75, 1.0].map(reach), [2.0, 1.0, 1.0, 1.5]);
        let own = heights.maps[0].with_amount(HeightAmount::from_factor(4.0, -1.0));
        assert_eq!(own.amount, Some(HeightAmount { scale: 4.0, midlevel: 0.25 }));
        assert_eq!(own.reach(HeightAmount { scale: 100.0, midlevel: 0.0 }), 3.0, "the settings don't count");
    }

    #[test]
    fn amounts_that_depend_on_no_height_are_none() {
        let bad = [(0.0, 1.0), (f32::NAN, 0.0), (f32::INFINITY, 0.0), (1.0, f32::NAN), (1e-30, 1e30)];
        assert!(bad.into_iter().all(|(factor, offset)| HeightAmount::from_factor(factor, offset).is_none()));
    }

    #[test]
    fn materials_with_equal_maps_share_one_and_pixels_count_once() {
        let mut mesh = Shape::Torus.build();
        mesh.materials = vec![mesh.materials[0].clone(); 4];
        let map = HeightMap::new([2, 2], vec![0.5; 4]);
        let deep = map.with_amount(HeightAmount::from_factor(3.0, 0.0));
        let own = [Some(map.clone()), None, Some(deep.clone()), Some(map.clone())];
        let heights = Heights::of_materials(&mesh, &own, &Progress::new()).expect("not cancelled").expect("maps");
        assert_eq!(heights.of_material, [Some(0), None, Some(1), Some(0)]);
        assert_eq!((heights.maps.len(), heights.bytes(), heights.follow_settings()), (2, 4 * 5, true));
        let none = Heights::of_materials(&mesh, &[None, None, None, None], &Progress::new());
        assert_eq!(none, Ok(None));
        let deep = Heights::of_materials(&mesh, &[None, None, Some(deep)], &Progress::new());
        assert!(deep.is_ok_and(|deep| deep.is_some_and(|deep| !deep.follow_settings())));
    }

    #[test]
    fn angles_and_bounds_take_as_many_bytes_as_is_said() {
        let mesh = Shape::Torus.build();
        let reliefs = mesh.triangles.len() * size_of::<Relief>();
        assert!(bytes_beside_maps(&mesh) > (size_of_val(&angles(&mesh)[..]) + reliefs) as u64);
    }
}

//! Height images for displacement, one for each material or one for all. Each is a pyramid of levels, so that a sample can cover an
//! area that suits the triangles.

mod pyramid;
mod relief;

pub use relief::{PatchRelief, RELIEF_STEPS, Relief, patch_reliefs};

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use glam::Vec2;

use super::{Mesh, PartRange, Wrap};
use crate::casts::{to_f32, to_u32};
use crate::progress::{Cancelled, Progress};

/// The greatest width and height of a height map, in px. Larger images are scaled down.
pub const MAX_KEPT: u32 = 4096;

/// The greatest width and height in texels of the texture that holds all maps of a mesh. Every adapter has textures of that size
/// (WebGPU, default limits).
pub const HEIGHTS_ACROSS: u32 = 8192;

/// The greatest size of a mesh's maps together, in bytes: that of this texture.
pub const MOST_BYTES: u64 = 4 * (HEIGHTS_ACROSS as u64).pow(2);

/// The greatest number of maps of a mesh, for which the shaders have room.
pub const MAX_MAPS: usize = 256;

/// The largest scale and midlevel of an image, so that no coordinate leaves f32.
const MOST_AMOUNT: f32 = 1e9;

/// How far heights move the surface: by `scale` * (height - `midlevel`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeightAmount {
    /// How far white is above black, in object units.
    pub scale: f32,
    /// The height that stays where it is.
    pub midlevel: f32,
}

impl HeightAmount {
    /// None if a number is no number, or above 1e9.
    pub fn new(scale: f32, midlevel: f32) -> Option<Self> {
        [scale, midlevel].iter().all(|number| number.abs() <= MOST_AMOUNT).then_some(Self { scale, midlevel })
    }

    /// The amount by which a height that is multiplied by `factor` and then has `offset` added moves the surface, both in object
    /// units; none as for [`Self::new`].
    pub fn from_factor(factor: f32, offset: f32) -> Option<Self> {
        // So far below the midlevel all heights of an image are the same number in f32, and an offset alone stays what it is.
        let least = 2.0 * offset.abs() / MOST_AMOUNT;
        let scale = if factor.abs() < least { least } else { factor };
        Self::new(scale, if scale == 0.0 { 0.0 } else { -offset / scale })
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
    /// What is beyond the image along u and v. In [`Heights`] the pixels at the border continue if no texture coordinate lies
    /// outside 0 to 1.
    pub wrap: [Wrap; 2],
    /// How far it moves the surface; none if the settings say so.
    pub amount: Option<HeightAmount>,
    /// The least and the greatest height, or beyond them.
    pub range: [f32; 2],
    /// The pixels of all levels, one level after another, each row by row from the top. Maps that differ in the rest share them.
    pub heights: Arc<Vec<f32>>,
}

/// The height maps that displace a mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Heights {
    /// The images.
    pub maps: Vec<HeightMap>,
    /// Triangles that follow one another, and the number of the map that displaces them, in their order. Others aren't displaced.
    pub ranges: Vec<(Range<u32>, u32)>,
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

    /// Returns the same image that goes on so beyond its border.
    pub fn with_wrap(&self, wrap: [Wrap; 2]) -> Self {
        Self { wrap, ..self.clone() }
    }
}

impl Heights {
    /// Uses one map for all materials of a mesh.
    pub fn everywhere(mesh: &Mesh, map: HeightMap) -> Self {
        // The only possible error is cancellation, and no other code has this handle.
        let made = Self::of_materials(mesh, &vec![Some(map); mesh.materials.len()], &Progress::new());
        made.expect("not cancelled").expect("one map")
    }

    /// Uses a map made in code, of `side` px a side, with so many waves across and down. It can be repeated without a seam.
    pub fn waves(mesh: &Mesh, side: u32, [across, down]: [f32; 2]) -> Self {
        let height = |i: u32| {
            let [x, y] = [i % side, i / side].map(|x| std::f32::consts::TAU * (x as f32 + 0.5) / side as f32);
            0.5 + 0.25 * (across * x).sin() * (down * y).cos() + 0.2 * (x + 2.0 * y).cos()
        };
        Self::everywhere(mesh, HeightMap::new([side; 2], (0..side * side).map(height).collect()))
    }

    /// Uses a map for each material that has one, and for each of the file's parts, where it wins over that of a material: `own` has
    /// those of the materials, then those of the parts, if any have one. Equal maps are one. None if these are more than
    /// [`MAX_MAPS`].
    ///
    /// # Errors
    /// [`Cancelled`] when `progress` says so.
    pub fn of_materials(
        mesh: &Mesh,
        own: &[Option<HeightMap>],
        progress: &Progress,
    ) -> Result<Option<Self>, Cancelled> {
        let (mut maps, mut known) = (Vec::new(), HashMap::new());
        let (of_materials, of_parts) = own.split_at_checked(mesh.materials.len()).unwrap_or((own, &[]));
        let has_own = |range: &&PartRange| matches!(of_parts.get(range.part as usize), Some(Some(_)));
        let parts = mesh.part_ranges.iter().filter(has_own).map(|range| &range.triangles);
        let all = mesh.materials.iter().map(|material| &material.triangles).chain(parts);
        let mut ends: Vec<u32> = all.flat_map(|range| [range.start, range.end]).collect();
        ends.sort_unstable();
        ends.dedup();
        let mut ranges = Vec::with_capacity(ends.len());
        for ends in ends.windows(2) {
            progress.check()?;
            let [start, end] = [ends[0], ends[1]];
            let of_part = mesh.part_of(start).and_then(|part| of_parts.get(part as usize)?.as_ref());
            let material = mesh.materials.partition_point(|material| material.triangles.end <= start);
            let Some(own) = of_part.or_else(|| of_materials.get(material)?.as_ref()) else { continue };
            let amount = own.amount.map(|own| [own.scale, own.midlevel].map(f32::to_bits));
            let index = *known.entry((Arc::as_ptr(&own.heights), amount, own.wrap)).or_insert(maps.len());
            if index == MAX_MAPS {
                return Ok(None);
            }
            if index == maps.len() {
                maps.push(HeightMap { wrap: [Wrap::Clamp; 2], ..own.clone() });
            }
            ranges.push((start..end, to_u32(index)));
            let triangles = &mesh.triangles[start as usize..end as usize];
            let mut uvs = triangles.iter().flatten().map(|&corner| mesh.corners[corner as usize].uv);
            if uvs.any(|uv| uv.cmplt(Vec2::ZERO).any() || uv.cmpgt(Vec2::ONE).any()) {
                maps[index].wrap = own.wrap;
            }
        }
        let reliefs = relief::reliefs(mesh, &maps, &ranges, progress)?;
        let (radius, angles) = (mesh.bounds().radius(), angles(mesh));
        Ok(Some(Self { maps, ranges, are_of_colors: false, radius, angles, reliefs }))
    }

    /// Returns the number of the image that displaces a triangle, if one does.
    pub fn map_of(&self, triangle: u32) -> Option<u32> {
        let place = self.ranges.partition_point(|(range, _)| range.end <= triangle);
        self.ranges.get(place).filter(|(range, _)| range.contains(&triangle)).map(|(_, map)| *map)
    }

    /// Returns the image that displaces a triangle, if one does.
    pub fn map(&self, triangle: u32) -> Option<&HeightMap> {
        self.maps.get(self.map_of(triangle)? as usize)
    }

    /// Returns the greatest distance that a point can be moved by, in object units, where the settings say `usual`.
    pub fn reach(&self, usual: HeightAmount) -> f32 {
        let of_map = |map: &HeightMap| {
            let HeightAmount { scale, midlevel } = map.amount.unwrap_or(usual);
            map.range.map(|height| (scale * (height - midlevel)).abs())
        };
        self.maps.iter().flat_map(of_map).fold(0.0, f32::max)
    }

    /// Whether the settings say how far some image moves the surface.
    pub fn follow_settings(&self) -> bool {
        self.maps.iter().any(|map| map.amount.is_none())
    }
}

/// Returns the size of maps in bytes. Pixels that several share count once.
pub fn bytes_of_maps<'a>(maps: impl Iterator<Item = &'a HeightMap>) -> u64 {
    let known: HashMap<_, _> = maps.map(|map| (Arc::as_ptr(&map.heights), map.heights.len())).collect();
    4 * known.into_values().sum::<usize>() as u64
}

/// Returns how many bytes [`Heights`] take for a mesh beside their maps: for angles, ranges, and bounds over triangles while they are
/// made.
pub fn bytes_beside_maps(mesh: &Mesh) -> u64 {
    let ranges = 64 * (mesh.materials.len() + mesh.part_ranges.len());
    4 * mesh.corners.len() as u64 + 132 * mesh.triangles.len() as u64 + ranges as u64
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
    use crate::mesh::{Material, Shape};

    /// Gives each of the first triangles a material of its own.
    fn one_triangle_each(mesh: &mut Mesh, count: usize) {
        let of = |first| Material { triangles: first..first + 1, ..mesh.materials[0].clone() };
        mesh.materials = (0..to_u32(count)).map(of).collect();
    }

    #[test]
    fn a_point_moves_by_the_height_that_differs_most_from_the_middle() {
        let map = HeightMap::new([4, 4], (0..16).map(|i| if i < 8 { 0.25 } else { 1.0 }).collect());
        let heights = Heights::everywhere(&Shape::Torus.build(), map);
        let reach = |midlevel| heights.reach(HeightAmount { scale: -2.0, midlevel });
        assert_eq!([0.0, 0.5, 0.75, 1.0].map(reach), [2.0, 1.0, 1.0, 1.5]);
        let own = heights.maps[0].with_amount(HeightAmount::from_factor(4.0, -1.0));
        assert_eq!(own.amount, Some(HeightAmount { scale: 4.0, midlevel: 0.25 }));
        let own = Heights { maps: vec![own], ..heights };
        assert_eq!(own.reach(HeightAmount { scale: 100.0, midlevel: 0.0 }), 3.0, "the settings don't count");
    }

    #[test]
    fn more_maps_than_shaders_have_room_for_are_refused() {
        let mut mesh = Shape::Torus.build_at(1);
        let map = HeightMap::new([1, 1], vec![0.5]);
        let numbered = |i: usize| Some(map.with_amount(HeightAmount::from_factor(i as f32, 0.0)));
        let own: Vec<_> = (0..=MAX_MAPS).map(numbered).collect();
        one_triangle_each(&mut mesh, own.len());
        let count = |own: &[Option<HeightMap>], progress: &Progress| {
            Heights::of_materials(&mesh, own, progress).map(|made| made.map(|heights| heights.maps.len()))
        };
        assert_eq!(count(&own[1..], &Progress::new()), Ok(Some(MAX_MAPS)));
        assert_eq!(count(&own, &Progress::new()), Ok(None));
        let cancelled = Progress::new();
        cancelled.cancel();
        assert_eq!(count(&own, &cancelled), Err(Cancelled));
    }

    #[test]
    fn images_go_on_as_they_are_said_to_only_where_coordinates_leave_them() {
        let mut mesh = Shape::Saddle.build();
        let wrap = [Wrap::Mirror, Wrap::Clamp];
        let map = HeightMap::new([2, 2], vec![0.5; 4]).with_wrap(wrap);
        assert_eq!(Heights::everywhere(&mesh, map.clone()).maps[0].wrap, [Wrap::Clamp; 2]);
        mesh.corners.iter_mut().for_each(|corner| corner.uv *= 2.0);
        assert_eq!(Heights::everywhere(&mesh, map.clone()).maps[0].wrap, wrap);
        // One image that goes on in two ways is two maps of the same pixels.
        one_triangle_each(&mut mesh, 2);
        let own = [Some(map.clone()), Some(map.with_wrap([Wrap::Repeat; 2]))];
        let heights = Heights::of_materials(&mesh, &own, &Progress::new()).expect("not cancelled").expect("few maps");
        assert_eq!((heights.maps.len(), bytes_of_maps(heights.maps.iter())), (2, 4 * 5));
    }

    #[test]
    fn a_height_without_a_factor_leaves_the_offset() {
        for (factor, offset) in [(0.0, 0.0), (0.0, 1.0), (0.0, -0.7), (0.0, 3e5), (1e-12, 0.3), (0.0, 1e-40)] {
            let HeightAmount { scale, midlevel } = HeightAmount::from_factor(factor, offset).expect("an amount");
            for height in [0.0, 0.25, 1.0] {
                let moved = scale * (height - midlevel);
                assert!((moved - offset).abs() <= 1e-6 * offset.abs() + 1e-30, "{factor} {offset}: {moved}");
            }
        }
        assert_eq!(HeightAmount::from_factor(0.0, 0.0), Some(HeightAmount { scale: 0.0, midlevel: 0.0 }));
    }

    #[test]
    fn amounts_that_are_no_numbers_or_too_large_are_none() {
        let bad = [(f32::NAN, 0.0), (f32::INFINITY, 0.0), (1.0, f32::NAN), (0.0, f32::INFINITY), (1e-30, 1e30)];
        assert!(bad.into_iter().all(|(factor, offset)| HeightAmount::from_factor(factor, offset).is_none()));
        assert_eq!(HeightAmount::from_factor(1e9, 0.0).map(|amount| amount.scale), Some(1e9));
        assert_eq!(HeightAmount::from_factor(1.1e9, 0.0), None);
    }

    #[test]
    fn materials_with_equal_maps_share_one_and_pixels_count_once() {
        let mut mesh = Shape::Torus.build();
        one_triangle_each(&mut mesh, 4);
        let map = HeightMap::new([2, 2], vec![0.5; 4]);
        let deep = map.with_amount(HeightAmount::from_factor(3.0, 0.0));
        let own = [Some(map.clone()), None, Some(deep.clone()), Some(map.clone())];
        let heights = Heights::of_materials(&mesh, &own, &Progress::new()).expect("not cancelled").expect("few maps");
        assert_eq!(heights.ranges, [(0..1, 0), (2..3, 1), (3..4, 0)]);
        assert_eq!([0, 1, 2, 3, 4].map(|triangle| heights.map_of(triangle)), [Some(0), None, Some(1), Some(0), None]);
        assert_eq!((heights.maps.len(), bytes_of_maps(heights.maps.iter())), (2, 4 * 5));
        assert!(heights.follow_settings() && !Heights::everywhere(&mesh, deep).follow_settings());
    }

    #[test]
    fn an_image_of_a_part_wins_over_those_of_its_materials() {
        let mut mesh = Shape::Torus.build();
        let count = to_u32(mesh.triangles.len());
        let of = |triangles| Material { triangles, ..mesh.materials[0].clone() };
        mesh.materials = vec![of(0..10), of(10..count)];
        let range = |triangles, part| PartRange { triangles, part };
        mesh.part_ranges = vec![range(2..5, 1), range(5..10, 0), range(10..12, 1), range(20..count, 0)];
        let [a, b] = [0.25, 0.75].map(|height| Some(HeightMap::new([1, 1], vec![height])));
        let of = |own: &[Option<HeightMap>]| {
            let heights =
                Heights::of_materials(&mesh, own, &Progress::new()).expect("not cancelled").expect("few maps");
            [0, 1, 2, 4, 5, 9, 10, 11, 12, 19, 20, count - 1]
                .map(|triangle| heights.map(triangle).map_or(0.0, |map| map.heights[0]))
        };
        let all = [a.clone(), None, None, b.clone()];
        assert_eq!(of(&all), [0.25, 0.25, 0.75, 0.75, 0.25, 0.25, 0.75, 0.75, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(of(&all[..2]), [0.25, 0.25, 0.25, 0.25, 0.25, 0.25, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(of(&[None, None, b]), [0.0, 0.0, 0.0, 0.0, 0.75, 0.75, 0.0, 0.0, 0.0, 0.0, 0.75, 0.75]);
        // A part that no range has, as a hidden one, changes nothing.
        assert_eq!(
            of(&[None, a.clone(), None, None, a]),
            [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.25, 0.25, 0.25, 0.25, 0.25, 0.25]
        );
    }

    #[test]
    fn angles_and_bounds_take_as_many_bytes_as_is_said() {
        let mut mesh = Shape::Torus.build();
        let reliefs = mesh.triangles.len() * size_of::<Relief>();
        assert!(bytes_beside_maps(&mesh) > (size_of_val(&angles(&mesh)[..]) + reliefs) as u64);
        // Parts between whose triangles are those of a material: twice as many ranges, in a list that doesn't grow.
        mesh.part_ranges = (0..65).map(|i| PartRange { triangles: 2 * i..2 * i + 1, part: 0 }).collect();
        let own = [0.0, 1.0].map(|height| Some(HeightMap::new([1, 1], vec![height])));
        let heights = Heights::of_materials(&mesh, &own, &Progress::new()).expect("not cancelled").expect("few maps");
        assert_eq!(heights.ranges.len(), 2 * 65);
        assert!(heights.ranges.capacity() * size_of_val(&heights.ranges[0]) < 30 * 65);
    }
}

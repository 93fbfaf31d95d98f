//! What displacement needs in device memory: height images, and what patches share where they meet.

use std::collections::HashMap;
use std::sync::Arc;

use super::buffer::{filled, filled_texture, uniform_buffer};
use super::layout::{HeightMap, Share};
use super::{Gpu, GpuError};
use geometry::groups::in_groups;
use geometry::mesh::heights::{MOST_BYTES, bytes_of_maps};
use geometry::mesh::{Dominance, HEIGHTS_ACROSS, Heights, MAX_MAPS, Mesh, Topology, patch_reliefs};

/// A mesh's height images, all mip levels of all of them one after another in the rows of one texture.
pub(crate) struct HeightImages {
    pub view: wgpu::TextureView,
    /// Bytes that this value uploaded; 0 if it shares another's.
    pub bytes: u64,
}

impl HeightImages {
    /// The same images for another tessellator; nothing is uploaded again.
    pub(crate) fn shared(&self) -> Self {
        Self { view: self.view.clone(), bytes: 0 }
    }

    /// # Errors
    /// They are larger than one texture.
    pub(crate) fn new(gpu: &Gpu, heights: &Heights) -> Result<Self, GpuError> {
        let bytes = bytes_of_maps(heights.maps.iter());
        if bytes > MOST_BYTES {
            return Err(GpuError::TooLarge { what: "height images", bytes, limit: MOST_BYTES });
        }
        let rows = bytes.div_ceil(4 * u64::from(HEIGHTS_ACROSS)).max(1) as u32;
        let mut all: Vec<f32> = Vec::with_capacity((rows * HEIGHTS_ACROSS) as usize);
        for (map, start) in heights.maps.iter().zip(starts(&heights.maps)) {
            // Others are there already.
            if start as usize == all.len() {
                all.extend_from_slice(&map.heights);
            }
        }
        all.resize((rows * HEIGHTS_ACROSS) as usize, 0.0);
        let (size, texels) = ([HEIGHTS_ACROSS, rows], bytemuck::cast_slice(&all));
        let view = filled_texture(gpu, "heights", size, wgpu::TextureFormat::R32Float, texels);
        Ok(Self { view, bytes: 4 * all.len() as u64 })
    }
}

/// Where the heights of each map begin in the texture. Maps that share heights begin at the same place.
fn starts(maps: &[geometry::mesh::HeightMap]) -> impl Iterator<Item = u32> {
    let (mut known, mut end) = (HashMap::new(), 0);
    maps.iter().map(move |map| {
        let start = *known.entry(Arc::as_ptr(&map.heights)).or_insert(end);
        end = end.max(start + map.heights.len() as u32);
        start
    })
}

/// A [`HeightMap`] for each image.
pub(crate) fn height_maps(gpu: &Gpu, heights: Option<&Heights>) -> wgpu::Buffer {
    let mut table = [HeightMap { size: [1, 1], levels: 1, ..bytemuck::Zeroable::zeroed() }; MAX_MAPS];
    let maps = heights.map(|heights| &heights.maps[..]).unwrap_or_default();
    for ((entry, map), start) in table.iter_mut().zip(maps).zip(starts(maps)) {
        let (scale, midlevel) = map.amount.map_or((0.0, 0.0), |amount| (amount.scale, amount.midlevel));
        let (wrap, has_amount) = (map.wrap[0] as u32 | (map.wrap[1] as u32) << 2, u32::from(map.amount.is_some()));
        *entry = HeightMap { size: map.size, levels: map.levels, start, wrap, has_amount, scale, midlevel };
    }
    uniform_buffer(gpu, "height maps", bytemuck::cast_slice(&table))
}

/// What passes know of a mesh that heights displace, by the names in WGSL. Without heights there are only the lists that passes
/// are bound to in any case, and they are empty. Lists of varying length lie one after another in one buffer; `starts` holds where
/// each begins, and then where the last ends.
///
/// # Errors
/// A buffer would be larger than the adapter binds.
pub(crate) fn relief_buffers(
    gpu: &Gpu,
    mesh: &Mesh,
    topology: &Topology,
    dominance: Option<&Dominance>,
) -> Result<Vec<(&'static str, wgpu::Buffer)>, GpuError> {
    let shares = dominance.map(|dominance| shares(mesh, dominance)).unwrap_or_default();
    let reliefs = patch_reliefs(mesh.heights.as_deref(), mesh, topology);
    let mut buffers = vec![
        // What patches share where displacement must not tear them apart.
        ("shares", filled(gpu, "shares", &shares)?),
        // What LOD by error knows of the heights over each patch.
        ("reliefs", filled(gpu, "reliefs", &reliefs)?),
    ];
    let Some(dominance) = dominance else { return Ok(buffers) };
    let (corner_ranges, corner_patches) = patches_of_corners(mesh, topology);
    let parts: Vec<[u32; 2]> = dominance.parts.iter().map(|&(corner, part)| [corner, part.to_bits()]).collect();
    buffers.extend([
        // The corners of each point, each with the bits of its weight in the point's direction.
        ("part_starts", filled(gpu, "part starts", &dominance.part_starts)?),
        ("parts", filled(gpu, "parts", &parts)?),
        // The factors of its edges.
        ("factor_starts", filled(gpu, "factor starts", &dominance.factor_starts)?),
        ("point_factors", filled(gpu, "point factors", &dominance.factors)?),
        // The patches of each corner.
        ("corner_ranges", filled(gpu, "corner ranges", &corner_ranges)?),
        ("corner_patches", filled(gpu, "corner patches", &corner_patches)?),
    ]);
    Ok(buffers)
}

/// The [`Share`]s of a mesh, filled in as far as they depend on the mesh alone. In this order:
///
/// - one for each point,
/// - one for each factor,
/// - two for each corner.
fn shares(mesh: &Mesh, dominance: &Dominance) -> Vec<Share> {
    let share = |&dominant: &u32| Share { dominant, ..bytemuck::Zeroable::zeroed() };
    let shared = dominance.corners.iter().chain(&dominance.sides).map(share);
    shared.chain(std::iter::repeat_n(share(&0), 2 * mesh.corners.len())).collect()
}

/// Where each corner's list of patches starts in the second vector, and where it ends. Corners that differ in their details alone
/// have one list, so that displaced normals are as smooth there as if they were one corner.
fn patches_of_corners(mesh: &Mesh, topology: &Topology) -> (Vec<[u32; 2]>, Vec<u32>) {
    let alike = mesh.alike_corners();
    let corners = (0..)
        .zip(&topology.patches)
        .flat_map(|(patch, own)| topology.corners(own).map(|corner| (alike[corner as usize], patch)));
    let (starts, patches) = in_groups(mesh.corners.len(), corners);
    let range = |&corner: &u32| [starts[corner as usize], starts[corner as usize + 1]];
    (alike.iter().map(range).collect(), patches)
}

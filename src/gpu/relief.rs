//! Displacement on the device: height images, what patches share where they meet, and the passes that use them.

use super::buffers::filled;
use super::layout::{HeightMap, Share};
use super::pipelines::bind_group;
use super::pipelines::{dispatch, grid};
use super::recorder::Recorder;
use super::slab::{SlabPasses, uniform_buffer};
use super::{ComputePipelines, Gpu, GpuError, MeshBuffers};
use crate::mesh::{Dominance, Heights, MAX_LEVELS, MAX_MAPS, Mesh, Topology};
use crate::tessellate::{Span, map_number};

/// Twin of `HEIGHTS_ACROSS` in `shaders/displace.wgsl`.
const HEIGHTS_ACROSS: u32 = 4096;

/// A mesh's height images: uploaded once.
pub struct HeightImages {
    view: wgpu::TextureView,
    maps: wgpu::Buffer,
    /// That were uploaded for it.
    bytes: u64,
}

impl HeightImages {
    /// The same for another tessellation: nothing more is uploaded.
    pub fn shared(&self) -> Self {
        Self { view: self.view.clone(), maps: self.maps.clone(), bytes: 0 }
    }

    /// # Errors
    /// They are larger than the adapter's textures.
    pub fn new(gpu: &Gpu, heights: &Heights) -> Result<Self, GpuError> {
        let texels: u64 = heights.maps.iter().map(|map| map.heights.len() as u64).sum();
        let rows = texels.div_ceil(u64::from(HEIGHTS_ACROSS)).max(1);
        let limit = u64::from(gpu.device.limits().max_texture_dimension_2d);
        if rows > limit {
            let limit = 4 * limit * u64::from(HEIGHTS_ACROSS);
            return Err(GpuError::TooLarge { what: "height images", bytes: 4 * texels, limit });
        }
        let rows = rows as u32;
        let mut table = [HeightMap { size: [1, 1], levels: 1, ..bytemuck::Zeroable::zeroed() }; MAX_MAPS];
        let mut all: Vec<f32> = Vec::with_capacity((rows * HEIGHTS_ACROSS) as usize);
        for (entry, map) in table.iter_mut().zip(&heights.maps) {
            let (start, repeats) = (all.len() as u32, u32::from(map.repeats));
            *entry = HeightMap { size: map.size, levels: map.levels, start, repeats, ..*entry };
            all.extend_from_slice(&map.heights);
        }
        all.resize((rows * HEIGHTS_ACROSS) as usize, 0.0);
        Ok(Self {
            view: upload(gpu, &all, rows),
            maps: uniform_buffer(gpu, "height maps", bytemuck::cast_slice(&table)),
            bytes: 4 * all.len() as u64,
        })
    }

    pub fn bytes(&self) -> u64 {
        self.bytes
    }
}

fn upload(gpu: &Gpu, heights: &[f32], rows: u32) -> wgpu::TextureView {
    use wgpu::util::DeviceExt;
    let descriptor = wgpu::TextureDescriptor {
        label: Some("heights"),
        size: wgpu::Extent3d { width: HEIGHTS_ACROSS, height: rows, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::R32Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    };
    let (order, bytes) = (wgpu::util::TextureDataOrder::LayerMajor, bytemuck::cast_slice(heights));
    let texture = gpu.device.create_texture_with_data(&gpu.queue, &descriptor, order, bytes);
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

/// What patches share where they meet, of a mesh whose sides are grouped into curves in some way.
pub struct ReliefBuffers {
    part_starts: wgpu::Buffer,
    parts: wgpu::Buffer,
    factor_starts: wgpu::Buffer,
    factors: wgpu::Buffer,
    corner_starts: wgpu::Buffer,
    corner_patches: wgpu::Buffer,
    corner_count: u32,
}

impl ReliefBuffers {
    /// # Errors
    /// A buffer would be larger than the adapter binds.
    pub fn new(gpu: &Gpu, mesh: &Mesh, topology: &Topology, dominance: &Dominance) -> Result<Self, GpuError> {
        let (corner_starts, corner_patches) = patches_of_corners(mesh, topology);
        let parts: Vec<[u32; 2]> = dominance.parts.iter().map(|&(corner, part)| [corner, part.to_bits()]).collect();
        Ok(Self {
            part_starts: filled(gpu, "part starts", &dominance.part_starts)?,
            parts: filled(gpu, "parts", &parts)?,
            factor_starts: filled(gpu, "factor starts", &dominance.factor_starts)?,
            factors: filled(gpu, "point factors", &dominance.factors)?,
            corner_starts: filled(gpu, "corner starts", &corner_starts)?,
            corner_patches: filled(gpu, "corner patches", &corner_patches)?,
            corner_count: mesh.corners.len() as u32,
        })
    }

    pub fn bytes(&self) -> u64 {
        let corners = [&self.corner_starts, &self.corner_patches];
        let points = [&self.part_starts, &self.parts, &self.factor_starts, &self.factors];
        corners.iter().chain(&points).map(|buffer| buffer.size()).sum()
    }
}

/// What points, then factors, then corners share, as far as it never changes; then the further spans of factors.
pub fn shares(mesh: &Mesh, dominance: &Dominance, spans: &[Span]) -> Vec<Share> {
    let (point_count, factor_count) = (dominance.corners.len(), dominance.sides.len());
    let behind = (point_count + 2 * mesh.corners.len()) as u32;
    let share = |dominant, span: Span| {
        let next = if span.next > 0 { behind + span.next } else { 0 };
        Share { dominant, texels: span.texels, map: span.map, next, ..bytemuck::Zeroable::zeroed() }
    };
    let (own, further) = spans.split_at(factor_count);
    let points = dominance.corners.iter().map(|&dominant| share(dominant, Span::default()));
    let factors = dominance.sides.iter().zip(own).map(|(&dominant, &span)| share(dominant, span));
    let corners = std::iter::repeat_n(share(0, Span::default()), 2 * mesh.corners.len());
    let further = further.iter().map(|&span| share(0, span));
    points.chain(factors).chain(corners).chain(further).collect()
}

/// What each level of each height image loses, four levels an element; zeros without heights.
pub fn details(gpu: &Gpu, heights: Option<&Heights>) -> wgpu::Buffer {
    let mut table = [[0.0_f32; 16]; MAX_MAPS];
    for (entry, detail) in table.iter_mut().zip(heights.iter().flat_map(|heights| &heights.detail)) {
        entry[..MAX_LEVELS].copy_from_slice(detail);
    }
    uniform_buffer(gpu, "height details", bytemuck::cast_slice(&table))
}

/// Where each corner's run of patches starts, and where the last ends; and the patches.
fn patches_of_corners(mesh: &Mesh, topology: &Topology) -> (Vec<u32>, Vec<u32>) {
    let mut starts = vec![0; mesh.corners.len() + 1];
    let corners =
        || (0..).zip(&topology.patches).flat_map(|(patch, own)| topology.corners(own).map(|corner| (corner, patch)));
    corners().for_each(|(corner, _)| starts[corner as usize + 1] += 1);
    for corner in 0..mesh.corners.len() {
        starts[corner + 1] += starts[corner];
    }
    let (mut next, mut patches) = (starts.clone(), vec![0; 3 * topology.patches.len()]);
    for (corner, patch) in corners() {
        patches[next[corner as usize] as usize] = patch;
        next[corner as usize] += 1;
    }
    (starts, patches)
}

/// A patch's height map, as it stands behind its centre among the points: 1 for the first, 0 for none.
pub fn patch_maps(heights: Option<&Heights>, topology: &Topology) -> Vec<f32> {
    let mut maps = vec![0.0; topology.patches.len()];
    for patches in topology.material_patches.iter().filter(|patches| !patches.is_empty()) {
        let map = heights.map_or(0, |heights| map_number(heights, topology, patches.start));
        maps[patches.start as usize..patches.end as usize].fill(map as f32);
    }
    maps
}

/// The passes that displace a mesh, bound to its buffers.
pub struct ReliefPasses {
    directions: wgpu::BindGroup,
    frames: wgpu::BindGroup,
    corner_count: u32,
    factor_levels: wgpu::BindGroup,
    point_levels: wgpu::BindGroup,
    displace: Vec<wgpu::BindGroup>,
}

impl ReliefPasses {
    /// Of a mesh with heights; one bind group for every slab, in their order.
    pub fn new(
        gpu: &Gpu,
        pipelines: &ComputePipelines,
        b: &MeshBuffers,
        images: &HeightImages,
        [params, given, vertices]: [&wgpu::Buffer; 3],
        slabs: &[SlabPasses],
    ) -> Option<Self> {
        let relief = b.relief.as_ref()?;
        let own = [(0, params), (6, &b.shares)];
        let directions = [&own[..], &[(2, &b.corners), (7, &relief.part_starts), (8, &relief.parts)]].concat();
        let around = [(1, &b.points), (2, &b.corners), (3, &b.patches)];
        let frames = [&own[..], &around, &[(7, &relief.corner_starts), (9, &relief.corner_patches)]].concat();
        let mesh = [(1, &b.points), (2, &b.corners), (3, &b.patches), (4, &b.edge_factors), (5, given)];
        let factor_levels = [&own[..], &mesh[..], &[(21, &images.maps)]].concat();
        let point_levels = [&own[..], &[(7, &relief.factor_starts), (9, &relief.factors)]].concat();
        let group = |label: &str, pipeline: &wgpu::ComputePipeline, buffers: &[(u32, &wgpu::Buffer)]| {
            bind_group(gpu, label, &pipeline.get_bind_group_layout(0), buffers)
        };
        let displace = slabs.iter().map(|slab| {
            let buffers = [
                (0, params),
                (1, &slab.slab_buffer),
                (2, &slab.chunks),
                (4, &slab.patch_factors),
                (5, &b.points),
                (6, &b.patches),
                (7, &b.curve_nets),
                (8, &b.corners),
                (9, vertices),
                (11, &b.shares),
                (21, &images.maps),
            ];
            let mut entries: Vec<_> = buffers
                .iter()
                .map(|&(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
                .collect();
            let view = wgpu::BindingResource::TextureView(&images.view);
            entries.push(wgpu::BindGroupEntry { binding: 20, resource: view });
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("displace"),
                layout: &pipelines.displace.get_bind_group_layout(0),
                entries: &entries,
            })
        });
        Some(Self {
            directions: group("directions", &pipelines.directions, &directions),
            frames: group("frames", &pipelines.frames, &frames),
            corner_count: relief.corner_count,
            factor_levels: group("levels.factors", &pipelines.factor_levels, &factor_levels),
            point_levels: group("levels.points", &pipelines.point_levels, &point_levels),
            displace: displace.collect(),
        })
    }

    /// Once a mesh, as its nets are: the direction of every point, and the frame of every corner.
    pub fn record_directions(&self, recorder: &mut Recorder, pipelines: &ComputePipelines, b: &MeshBuffers) {
        recorder.compute("directions", |pass| {
            dispatch(pass, &pipelines.directions, &self.directions, grid(b.point_count));
            dispatch(pass, &pipelines.frames, &self.frames, grid(self.corner_count));
        });
    }

    /// After the factors: the levels of edges and points.
    pub fn record_levels(&self, recorder: &mut Recorder, pipelines: &ComputePipelines, b: &MeshBuffers) {
        recorder.compute("levels", |pass| {
            dispatch(pass, &pipelines.factor_levels, &self.factor_levels, grid(b.factor_count));
            dispatch(pass, &pipelines.point_levels, &self.point_levels, grid(b.point_count));
        });
    }

    /// What [`ComputePipelines::displace`] is bound to for a slab.
    pub fn displace(&self, slab: usize) -> &wgpu::BindGroup {
        &self.displace[slab]
    }
}

//! The compute passes and their pipelines, and what binds buffers to them.

use std::collections::HashMap;
use std::sync::{Arc, Mutex};

use super::buffer::uniform_buffer;
use super::compute_pipeline::{ComputePipeline, Pass, ShaderModules};
use super::lazy::{Lazy, made_once};
use super::user_functions::{RecentPipelines, UserPipelines};
use super::user_lod::LodShader;
use super::user_surface::SurfaceShader;
use super::{Gpu, GpuError};
use geometry::tessellate::connectivity_table;

pub(super) const DEFORM_CORNERS: Pass = Pass::new("pass_deform", "deform_corners_main");
pub(super) const DEFORM_POINTS: Pass = Pass::new("pass_deform", "deform_points_main");
/// The control points of every curve.
pub(super) const CURVE_NETS: Pass = Pass::new("pass_nets", "curve_nets_main");
/// The control point at the centre of every patch.
pub(super) const CENTERS: Pass = Pass::new("pass_nets", "centers_main");
/// The direction in which displacement moves every point.
pub(super) const DIRECTIONS: Pass = Pass::new("pass_levels", "directions_main");
/// How texture coordinates change at every corner.
pub(super) const FRAMES: Pass = Pass::new("pass_levels", "frames_main");
/// LOD's factor of every edge.
pub(super) const EDGE_FACTORS: Pass = Pass::new("pass_factors", "edge_factors_main");
/// The directions in which the corners of every patch move, for LOD by error.
pub(super) const PATCH_DIRECTIONS: Pass = Pass::new("pass_levels", "patch_directions_main");
/// The patches whose minimum needs no search.
pub(super) const LEAST_TRIANGLES: Pass = Pass::new("pass_least", "least_triangles_main");
/// The others. Like all searches it has a size of its workgroups and a kind of pattern: see [`ComputePipelines::search`].
pub(super) const SEARCH_LEAST_TRIANGLES: Pass = Pass::new("pass_least", "search_least_triangles_main");
/// The level at which heights are looked up on every edge.
pub(super) const FACTOR_LEVELS: Pass = Pass::new("pass_levels", "factor_levels_main");
/// The level at which heights are looked up at every point.
pub(super) const POINT_LEVELS: Pass = Pass::new("pass_levels", "point_levels_main");
/// Factors and counts of every patch, added up within blocks.
pub(super) const COUNTS: Pass = Pass::new("pass_counts", "counts_main");
/// For reading hull factors back: no other pass needs them all.
pub(super) const HULL_FACTORS: Pass = Pass::new("pass_counts", "hull_factors_main");
/// Sums within blocks to offsets within the slab.
pub(super) const SCAN: Pass = Pass::new("pass_scan", "scan_main");
/// Chunks that fit the arena, and the indirect arguments that emit them.
pub(super) const CHUNKS: Pass = Pass::new("pass_chunks", "chunks_main");
/// The indirect arguments that draw each material of each chunk.
pub(super) const DRAWS: Pass = Pass::new("pass_chunks", "draws_main");
/// The vertices of a chunk.
pub(super) const EMIT_VERTICES: Pass = Pass::new("pass_emit", "emit_vertices_main");
/// The triangles of a chunk.
pub(super) const EMIT_TRIANGLES: Pass = Pass::new("pass_emit", "emit_triangles_main");
/// The displacement of a chunk's vertices.
pub(super) const DISPLACE: Pass = Pass::new("pass_displace", "displace_main");

/// The pipelines of the passes, each made when it is first needed, and what they share. They belong to the device on which they
/// are first requested.
pub struct ComputePipelines {
    /// The sizes of workgroups that search: see [`Self::search`].
    groups: [u32; 3],
    modules: ShaderModules,
    pipelines: Mutex<HashMap<Pass, Arc<ComputePipeline>>>,
    patterns: Lazy<wgpu::Buffer>,
    user_lods: RecentPipelines<LodShader>,
    user_surfaces: RecentPipelines<SurfaceShader>,
}

impl Default for ComputePipelines {
    /// Compiles nothing yet.
    fn default() -> Self {
        Self::in_groups([8, 32, 128])
    }
}

/// Fewer patches than this don't fill a GPU with 32 invocations each.
const FEW_PATCHES: u32 = 512;
/// `MANY_PATCHES` in `shaders/pass_requests.wgsl`: of fewer patches than this each may need thousands of triangles.
pub const MANY_PATCHES: u32 = 128;

impl ComputePipelines {
    /// Those with workgroups of these sizes for searches: for large meshes on a software driver, for most, and for small ones on
    /// a GPU.
    pub fn in_groups(groups: [u32; 3]) -> Self {
        Self {
            groups,
            modules: ShaderModules::default(),
            pipelines: Mutex::default(),
            patterns: Lazy::default(),
            user_lods: RecentPipelines::default(),
            user_surfaces: RecentPipelines::default(),
        }
    }

    /// The pipeline of a pass. Compiles nothing.
    pub(super) fn get(&self, pass: Pass) -> Arc<ComputePipeline> {
        let pipeline = || ComputePipeline::from_module(&self.modules.get(pass.module), pass);
        made_once(&self.pipelines, pass, || Arc::new(pipeline()))
    }

    /// A pass that searches factors of so many patches (see `shaders/search_group.wgsl`). Its workgroups may have any size. A
    /// software driver computes the invocations of a workgroup one after the other, and those that were in vain take time; but it ends
    /// the loops of an invocation after some time, which large patches need, so that those share it. On a GPU that patches alone don't
    /// fill, larger workgroups do.
    pub(super) fn search(&self, gpu: &Gpu, pass: Pass, patches: u32) -> Pass {
        let [small, medium, large] = self.groups;
        let size = match (gpu.is_software(), patches) {
            (true, MANY_PATCHES..) => small,
            (false, ..FEW_PATCHES) => large,
            _ => medium,
        };
        pass.with("GROUP", size)
    }

    /// The pipelines of functions of the user's own for factors.
    pub fn user_lod(&self, shader: &Arc<LodShader>) -> Arc<UserPipelines> {
        self.user_lods.of(shader)
    }

    /// The pipelines of a function of the user's own for control points.
    pub fn user_surface(&self, shader: &Arc<SurfaceShader>) -> Arc<UserPipelines> {
        self.user_surfaces.of(shader)
    }

    /// The table in which [`EMIT_TRIANGLES`] looks up which points triangles join: see `shaders/connectivity_table.wgsl`.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub(super) fn patterns(&self, gpu: &Gpu) -> Result<&wgpu::Buffer, GpuError> {
        let table = || uniform_buffer(gpu, "patterns", bytemuck::cast_slice(&connectivity_table::CONNECTIVITY_TABLE));
        self.patterns.get_or_make(gpu, table)
    }
}

/// A bind group of what is at each binding number.
pub fn bind_group<'a>(
    gpu: &Gpu,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    bound: impl IntoIterator<Item = (u32, wgpu::BindingResource<'a>)>,
) -> wgpu::BindGroup {
    let entry = |(binding, resource)| wgpu::BindGroupEntry { binding, resource };
    let entries: Vec<_> = bound.into_iter().map(entry).collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(label), layout, entries: &entries })
}

/// `WORKGROUP` in `shaders/types.wgsl`: invocations of a workgroup of most passes.
pub const WORKGROUP: u32 = 256;

/// `MOST_WORKGROUPS` in `shaders/types.wgsl`: the most workgroups along one dimension that WebGPU allows.
pub const MOST_WORKGROUPS: u32 = 65_535;

/// Twin of `grid` in `shaders/types.wgsl`: the workgroups in each dimension for so many invocations.
pub fn grid(items: u32) -> [u32; 3] {
    let workgroups = items.div_ceil(WORKGROUP);
    [workgroups.min(GRID_WIDTH), workgroups.div_ceil(GRID_WIDTH), 1]
}

/// `GRID_WIDTH` in `shaders/types.wgsl`: workgroups along a grid's first dimension. WebGPU allows 65,535.
pub const GRID_WIDTH: u32 = 32768;

//! The compute pipelines of all passes, and what binds buffers to them.

use std::sync::Arc;

use wgpu::util::DeviceExt;

use super::compute_pipeline::{ComputePipeline, ShaderModule};
use super::lazy::Lazy;
use super::own_functions::RecentPipelines;
use super::own_lod::{LodShader, OwnLodPipelines};
use super::own_surface::{OwnSurfacePipelines, SurfaceShader};
use super::wgsl::{
    CONNECTIVITY_TABLE, CONTROL_POINTS, CONVENTION, CULL, DISPLACE, DISPLACEMENT_FACTOR, DISPLACEMENT_SHARES, DOMAIN,
    FACTORS, HEIGHT_LIST, LEAST_FACTORS, LEAST_ROWS, LOAD_NET, LOADS, LOD, NORMAL, OCTAHEDRAL_NORMAL, SEARCH_GROUP,
    SEARCH_STATE, SLIDES, SURFACE, TYPES, WORKGROUP_SCAN, WgslFile,
};
use super::{Gpu, GpuError};
use geometry::tessellate::{Normals, connectivity_table};

static DEFORM: WgslFile = WgslFile::new("deform", &[&NORMAL]);

// A module for each of these, in the order in which the passes run.
pub(super) static PASS_DEFORM: WgslFile = WgslFile::new("pass_deform", &[&DEFORM, &NORMAL, &TYPES]);
pub(super) static PASS_NETS: WgslFile =
    WgslFile::new("pass_nets", &[&CONTROL_POINTS, &LOAD_NET, &LOADS, &SURFACE, &TYPES]);
pub(super) static PASS_FACTORS: WgslFile =
    WgslFile::new("pass_factors", &[&DISPLACEMENT_FACTOR, &FACTORS, &LEAST_FACTORS, &LOD, &SURFACE, &TYPES]);
pub(super) static PASS_ASKED: WgslFile =
    WgslFile::new("pass_asked", &[&LEAST_FACTORS, &LEAST_ROWS, &LOADS, &SEARCH_GROUP, &SEARCH_STATE, &SLIDES, &TYPES]);
pub(super) static PASS_UNIFORM: WgslFile = WgslFile::new(
    "pass_uniform",
    &[&FACTORS, &LEAST_FACTORS, &LOADS, &SEARCH_GROUP, &SEARCH_STATE, &SLIDES, &TYPES, &WORKGROUP_SCAN],
);
pub(super) static PASS_LEAST: WgslFile = WgslFile::new(
    "pass_least",
    &[&DISPLACEMENT_FACTOR, &FACTORS, &LEAST_FACTORS, &LEAST_ROWS, &LOADS, &SEARCH_GROUP, &SLIDES, &TYPES],
);
pub(super) static PASS_LEVELS: WgslFile =
    WgslFile::new("pass_levels", &[&CONVENTION, &DISPLACE, &HEIGHT_LIST, &NORMAL, &DISPLACEMENT_SHARES, &TYPES]);
pub(super) static PASS_COUNTS: WgslFile = WgslFile::new(
    "pass_counts",
    &[&CONVENTION, &CULL, &FACTORS, &LOAD_NET, &LOADS, &LOD, &SURFACE, &TYPES, &WORKGROUP_SCAN],
);
pub(super) static PASS_SCAN: WgslFile = WgslFile::new("pass_scan", &[&TYPES, &WORKGROUP_SCAN]);
pub(super) static PASS_CHUNKS: WgslFile = WgslFile::new("pass_chunks", &[&TYPES]);
pub(super) static PASS_EMIT: WgslFile = WgslFile::new(
    "pass_emit",
    &[&CONVENTION, &DOMAIN, &FACTORS, &LOAD_NET, &NORMAL, &OCTAHEDRAL_NORMAL, &CONNECTIVITY_TABLE, &SURFACE, &TYPES],
);
pub(super) static PASS_DISPLACE: WgslFile = WgslFile::new(
    "pass_displace",
    &[
        &DISPLACE,
        &FACTORS,
        &HEIGHT_LIST,
        &LOAD_NET,
        &LOADS,
        &NORMAL,
        &OCTAHEDRAL_NORMAL,
        &DISPLACEMENT_SHARES,
        &SURFACE,
        &TYPES,
    ],
);

/// The pipelines of an entry point that searches factors (see `shaders/search_group.wgsl`), which have workgroups of different
/// sizes and the same results.
pub struct SearchPipelines {
    /// A software driver computes the invocations of a workgroup one after the other, and those that were in vain take time.
    on_software: ComputePipeline,
    many_patches: ComputePipeline,
    few_patches: ComputePipeline,
}

impl SearchPipelines {
    fn new(module: &Arc<ShaderModule>, entry_point: &'static str, groups: [u32; 3]) -> Self {
        let [on_software, many_patches, few_patches] =
            groups.map(|size| ComputePipeline::new(module, entry_point).with("GROUP", size));
        Self { on_software, many_patches, few_patches }
    }

    /// Those that search the patterns of Direct3D, then those that search rows.
    fn pair(module: &Arc<ShaderModule>, entry_point: &'static str, groups: [u32; 3]) -> [Self; 2] {
        [0, 1].map(|rows| {
            let own = Self::new(module, entry_point, groups);
            Self {
                on_software: own.on_software.with("SEARCHES_ROWS", rows),
                many_patches: own.many_patches.with("SEARCHES_ROWS", rows),
                few_patches: own.few_patches.with("SEARCHES_ROWS", rows),
            }
        })
    }

    /// The pipeline for a number of patches: if these alone don't fill a GPU, larger workgroups do.
    pub fn of(&self, gpu: &Gpu, patches: u32) -> &ComputePipeline {
        match patches {
            _ if gpu.is_software() => &self.on_software,
            ..FEW_PATCHES => &self.few_patches,
            _ => &self.many_patches,
        }
    }
}

/// `ALONE` in `shaders/pass_asked.wgsl` for a software driver, which computes few invocations of a workgroup side by side.
const ALONE: u32 = 32;

/// Fewer patches than this don't fill a GPU with 32 invocations each.
const FEW_PATCHES: u32 = 512;

/// The pipelines of the passes, one an entry point, and what they share. They belong to the device on which they are first
/// asked for.
pub struct ComputePipelines {
    pub deform_corners: ComputePipeline,
    pub deform_points: ComputePipeline,
    pub curve_nets: ComputePipeline,
    pub centers: ComputePipeline,
    pub directions: ComputePipeline,
    pub frames: ComputePipeline,
    pub edge_factors: ComputePipeline,
    pub heights_inside: ComputePipeline,
    pub asked_factors: ComputePipeline,
    /// The same where `first_patterns` follows.
    pub asked_before_first_patterns: ComputePipeline,
    pub first_patterns: ComputePipeline,
    pub search_workgroups: ComputePipeline,
    pub round_workgroups: ComputePipeline,
    /// For the patterns of Direct3D, then for rows, like all searches that are pairs.
    pub search_asked_factors: [SearchPipelines; 2],
    pub inside_factors: ComputePipeline,
    pub search_inside_factors: [SearchPipelines; 2],
    pub keep_factors: ComputePipeline,
    pub sum_triangles: ComputePipeline,
    pub candidates: ComputePipeline,
    pub search_uniform_factor: SearchPipelines,
    pub take_uniform_factor: ComputePipeline,
    /// Whose results no other pass needs, like those of the next.
    pub least_triangles: ComputePipeline,
    pub search_least_triangles: [SearchPipelines; 2],
    pub factor_levels: ComputePipeline,
    pub point_levels: ComputePipeline,
    pub counts: ComputePipeline,
    /// For reading hull factors back: no other pass needs them all.
    pub hull_factors: ComputePipeline,
    pub scan: ComputePipeline,
    pub chunks: ComputePipeline,
    /// For the patterns of Direct3D, then for rows; of each, one for each of [`Normals`].
    pub emit_vertices: [[ComputePipeline; 3]; 2],
    pub emit_triangles: [ComputePipeline; 2],
    pub displace: ComputePipeline,
    patterns: Lazy<wgpu::Buffer>,
    own_lods: RecentPipelines<LodShader, OwnLodPipelines>,
    own_surfaces: RecentPipelines<SurfaceShader, OwnSurfacePipelines>,
}

impl Default for ComputePipelines {
    fn default() -> Self {
        Self::new()
    }
}

impl ComputePipelines {
    /// Compiles nothing yet.
    pub fn new() -> Self {
        Self::in_groups([8, 32, 128])
    }

    /// The same with workgroups of these sizes for searches: see `SearchPipelines`.
    pub fn in_groups(groups: [u32; 3]) -> Self {
        let module = |file| Arc::new(ShaderModule::new(file));
        let (deform, nets, levels) = (module(&PASS_DEFORM), module(&PASS_NETS), module(&PASS_LEVELS));
        let (asked, uniform, least) = (module(&PASS_ASKED), module(&PASS_UNIFORM), module(&PASS_LEAST));
        let (factors, counts, emit) = (module(&PASS_FACTORS), module(&PASS_COUNTS), module(&PASS_EMIT));
        let vertices = |rows| ComputePipeline::new(&emit, "emit_vertices_main").with("EMIT_ROWS", rows);
        Self {
            deform_corners: ComputePipeline::new(&deform, "deform_corners_main"),
            deform_points: ComputePipeline::new(&deform, "deform_points_main"),
            curve_nets: ComputePipeline::new(&nets, "curve_nets_main"),
            centers: ComputePipeline::new(&nets, "centers_main"),
            directions: ComputePipeline::new(&levels, "directions_main"),
            frames: ComputePipeline::new(&levels, "frames_main"),
            edge_factors: ComputePipeline::new(&factors, "edge_factors_main"),
            heights_inside: ComputePipeline::new(&factors, "heights_inside_main"),
            asked_factors: ComputePipeline::new(&asked, "asked_factors_main"),
            asked_before_first_patterns: ComputePipeline::new(&asked, "asked_factors_main").with("ALONE", ALONE),
            first_patterns: ComputePipeline::new(&asked, "first_patterns_main"),
            search_workgroups: ComputePipeline::new(&asked, "search_workgroups_main"),
            round_workgroups: ComputePipeline::new(&asked, "round_workgroups_main"),
            search_asked_factors: SearchPipelines::pair(&asked, "search_asked_factors_main", groups),
            inside_factors: ComputePipeline::new(&asked, "inside_factors_main"),
            search_inside_factors: SearchPipelines::pair(&asked, "search_inside_factors_main", groups),
            keep_factors: ComputePipeline::new(&asked, "keep_factors_main"),
            sum_triangles: ComputePipeline::new(&uniform, "sum_triangles_main"),
            candidates: ComputePipeline::new(&uniform, "candidates_main"),
            search_uniform_factor: SearchPipelines::new(&uniform, "search_uniform_factor_main", groups),
            take_uniform_factor: ComputePipeline::new(&uniform, "take_uniform_factor_main"),
            least_triangles: ComputePipeline::new(&least, "least_triangles_main"),
            search_least_triangles: SearchPipelines::pair(&least, "search_least_triangles_main", groups),
            factor_levels: ComputePipeline::new(&levels, "factor_levels_main"),
            point_levels: ComputePipeline::new(&levels, "point_levels_main"),
            counts: ComputePipeline::new(&counts, "counts_main"),
            hull_factors: ComputePipeline::new(&counts, "hull_factors_main"),
            scan: ComputePipeline::new(&module(&PASS_SCAN), "scan_main"),
            chunks: ComputePipeline::new(&module(&PASS_CHUNKS), "chunks_main"),
            emit_vertices: [0, 1].map(|rows| {
                let of_normals = |normals| vertices(rows).with("EMIT_NORMALS", normals as u32);
                [Normals::Linear, Normals::Quadratic, Normals::Surface].map(of_normals)
            }),
            emit_triangles: [0, 1]
                .map(|rows| ComputePipeline::new(&emit, "emit_triangles_main").with("EMIT_ROWS", rows)),
            displace: ComputePipeline::new(&module(&PASS_DISPLACE), "displace_main"),
            patterns: Lazy::default(),
            own_lods: RecentPipelines::default(),
            own_surfaces: RecentPipelines::default(),
        }
    }

    /// The pipelines of functions of the user's own for factors.
    pub fn own_lod(&self, shader: &Arc<LodShader>) -> Arc<OwnLodPipelines> {
        self.own_lods.of(shader, OwnLodPipelines::new)
    }

    /// The pipelines of a function of the user's own for control points.
    pub fn own_surface(&self, shader: &Arc<SurfaceShader>) -> Arc<OwnSurfacePipelines> {
        self.own_surfaces.of(shader, OwnSurfacePipelines::new)
    }

    /// The table in which `emit_triangles` looks up which points triangles join: see `shaders/connectivity_table.wgsl`.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub fn patterns(&self, gpu: &Gpu) -> Result<&wgpu::Buffer, GpuError> {
        self.patterns.get_or_make(gpu, || {
            gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("patterns"),
                contents: bytemuck::cast_slice(&connectivity_table::CONNECTIVITY_TABLE),
                usage: wgpu::BufferUsages::STORAGE,
            })
        })
    }
}

/// A bind group of whole buffers, each at its binding number.
pub fn bind_group(
    gpu: &Gpu,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    buffers: &[(u32, &wgpu::Buffer)],
) -> wgpu::BindGroup {
    let entries: Vec<_> = buffers
        .iter()
        .map(|&(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
        .collect();
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

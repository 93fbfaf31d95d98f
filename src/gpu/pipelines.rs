//! Shader modules put together from their rooms, and the compute pipelines made of them.

use wgpu::util::DeviceExt;

use super::Gpu;
use crate::tessellate::{Normals, patterns};

/// Rooms of the tessellator itself, part of every module that tessellates.
const DOMAIN: [&str; 4] = [
    include_str!("../../shaders/factors.wgsl"),
    include_str!("../../shaders/rings.wgsl"),
    include_str!("../../shaders/domain.wgsl"),
    include_str!("../../shaders/subtriangulation.wgsl"),
];
const SURFACE: &str = include_str!("../../shaders/surface.wgsl");
const CONTROL_POINTS: &str = include_str!("../../shaders/control_points.wgsl");
const NORMAL: &str = include_str!("../../shaders/normal.wgsl");
const LOD: &str = include_str!("../../shaders/lod.wgsl");
const ERROR: &str = include_str!("../../shaders/error.wgsl");
const CULL: &str = include_str!("../../shaders/cull.wgsl");
const CONVENTION: &str = include_str!("../../shaders/convention.wgsl");
const TYPES: &str = include_str!("../../shaders/types.wgsl");
const CONNECTIVITY: &str = include_str!("../../shaders/connectivity.wgsl");
const PATTERNS: &str = include_str!("../../shaders/patterns.wgsl");
const LOADS: &str = include_str!("../../shaders/loads.wgsl");
const LOAD_NET: &str = include_str!("../../shaders/load_net.wgsl");
const DISPLACE: &str = include_str!("../../shaders/displace.wgsl");
const RELIEF: &str = include_str!("../../shaders/relief.wgsl");
const WORKGROUP_SCAN: &str = include_str!("../../shaders/workgroup_scan.wgsl");

/// What every module starts with. Declarations in WGSL may stand in any order, so a module is its rooms, one after
/// another; names are unique across rooms.
const ROOMS: [&str; 12] =
    [DOMAIN[0], DOMAIN[1], DOMAIN[2], DOMAIN[3], CONTROL_POINTS, SURFACE, NORMAL, LOD, ERROR, CULL, CONVENTION, TYPES];

/// Every shader module by name, with the rooms that only it has. A test validates each.
pub const SHADERS: [(&str, &[&str]); 15] = [
    ("deform", &[include_str!("../../shaders/deform.wgsl"), include_str!("../../shaders/pass_deform.wgsl")]),
    ("nets", &[LOADS, LOAD_NET, include_str!("../../shaders/pass_nets.wgsl")]),
    ("factors", &[include_str!("../../shaders/pass_factors.wgsl")]),
    ("counts", &[LOADS, LOAD_NET, WORKGROUP_SCAN, include_str!("../../shaders/pass_counts.wgsl")]),
    ("scan", &[WORKGROUP_SCAN, include_str!("../../shaders/pass_scan.wgsl")]),
    ("chunks", &[include_str!("../../shaders/pass_chunks.wgsl")]),
    ("emit", &[LOAD_NET, include_str!("../../shaders/pass_emit.wgsl")]),
    ("levels", &[DISPLACE, RELIEF, include_str!("../../shaders/pass_levels.wgsl")]),
    ("displace", &[LOADS, LOAD_NET, DISPLACE, RELIEF, include_str!("../../shaders/pass_displace.wgsl")]),
    ("domain", &[include_str!("../../shaders/pass_domain.wgsl")]),
    (
        "coverage",
        &[
            WORKGROUP_SCAN,
            include_str!("../../shaders/coverage.wgsl"),
            include_str!("../../shaders/pass_coverage.wgsl"),
        ],
    ),
    ("draw", &[include_str!("../../shaders/draw_types.wgsl"), include_str!("../../shaders/draw_surface.wgsl")]),
    ("leaks", &[include_str!("../../shaders/draw_leaks.wgsl")]),
    ("pick", &[include_str!("../../shaders/draw_types.wgsl"), include_str!("../../shaders/draw_pick.wgsl")]),
    ("lines", &[include_str!("../../shaders/draw_types.wgsl"), include_str!("../../shaders/draw_lines.wgsl")]),
];

/// The whole text of the module `name`, which is one of [`SHADERS`]; any other name gives the shared rooms alone.
pub fn shader_source(name: &str) -> String {
    let own = SHADERS.iter().find(|(shader, _)| *shader == name).map_or(&[][..], |(_, rooms)| rooms);
    let connectivity = if name == "emit" { PATTERNS } else { CONNECTIVITY };
    ROOMS.iter().chain([&connectivity]).chain(own).copied().collect::<Vec<_>>().join("\n")
}

/// Compiles the module `name`.
pub fn shader_module(gpu: &Gpu, name: &str) -> wgpu::ShaderModule {
    gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(name),
        source: wgpu::ShaderSource::Wgsl(shader_source(name).into()),
    })
}

/// One pipeline an entry point of the passes.
pub struct ComputePipelines {
    pub deform_corners: wgpu::ComputePipeline,
    pub deform_points: wgpu::ComputePipeline,
    pub curve_nets: wgpu::ComputePipeline,
    pub centers: wgpu::ComputePipeline,
    pub edge_factors: wgpu::ComputePipeline,
    pub heights_inside: wgpu::ComputePipeline,
    pub counts: wgpu::ComputePipeline,
    pub scan: wgpu::ComputePipeline,
    pub chunks: wgpu::ComputePipeline,
    /// One for each of [`Normals`].
    pub emit_vertices: [wgpu::ComputePipeline; 3],
    pub emit_triangles: wgpu::ComputePipeline,
    /// Which points triangles join, looked up by `emit_triangles`: see `shaders/patterns.wgsl`.
    pub patterns: wgpu::Buffer,
    pub directions: wgpu::ComputePipeline,
    pub frames: wgpu::ComputePipeline,
    pub factor_levels: wgpu::ComputePipeline,
    pub point_levels: wgpu::ComputePipeline,
    pub displace: wgpu::ComputePipeline,
}

impl ComputePipelines {
    pub fn new(gpu: &Gpu) -> Self {
        let (nets, emit) = (shader_module(gpu, "nets"), shader_module(gpu, "emit"));
        let (factors, levels) = (shader_module(gpu, "factors"), shader_module(gpu, "levels"));
        let deform = shader_module(gpu, "deform");
        Self {
            deform_corners: compute_pipeline(gpu, &deform, "deform_corners_main"),
            deform_points: compute_pipeline(gpu, &deform, "deform_points_main"),
            curve_nets: compute_pipeline(gpu, &nets, "curve_nets_main"),
            centers: compute_pipeline(gpu, &nets, "centers_main"),
            edge_factors: compute_pipeline(gpu, &factors, "edge_factors_main"),
            heights_inside: compute_pipeline(gpu, &factors, "heights_inside_main"),
            counts: compute_pipeline(gpu, &shader_module(gpu, "counts"), "counts_main"),
            scan: compute_pipeline(gpu, &shader_module(gpu, "scan"), "scan_main"),
            chunks: compute_pipeline(gpu, &shader_module(gpu, "chunks"), "chunks_main"),
            emit_vertices: [Normals::Linear, Normals::Quadratic, Normals::Surface].map(|normals| {
                let constants = [("EMIT_NORMALS", f64::from(normals as u32))];
                specialised_pipeline(gpu, &emit, "emit_vertices_main", &constants)
            }),
            emit_triangles: compute_pipeline(gpu, &emit, "emit_triangles_main"),
            patterns: gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("patterns"),
                contents: bytemuck::cast_slice(&patterns::PATTERNS),
                usage: wgpu::BufferUsages::STORAGE,
            }),
            directions: compute_pipeline(gpu, &levels, "directions_main"),
            frames: compute_pipeline(gpu, &levels, "frames_main"),
            factor_levels: compute_pipeline(gpu, &levels, "factor_levels_main"),
            point_levels: compute_pipeline(gpu, &levels, "point_levels_main"),
            displace: compute_pipeline(gpu, &shader_module(gpu, "displace"), "displace_main"),
        }
    }
}

/// A pipeline whose layout is what the entry point uses.
pub fn compute_pipeline(gpu: &Gpu, module: &wgpu::ShaderModule, entry_point: &str) -> wgpu::ComputePipeline {
    specialised_pipeline(gpu, module, entry_point, &[])
}

/// The same with values for what the module lets a pipeline override.
fn specialised_pipeline(
    gpu: &Gpu,
    module: &wgpu::ShaderModule,
    entry_point: &str,
    constants: &[(&str, f64)],
) -> wgpu::ComputePipeline {
    gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(entry_point),
        layout: None,
        module,
        entry_point: Some(entry_point),
        compilation_options: wgpu::PipelineCompilationOptions { constants, ..Default::default() },
        cache: None,
    })
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

/// Twin of `grid` in `shaders/types.wgsl`.
pub fn grid(items: u32) -> [u32; 3] {
    let workgroups = items.div_ceil(256);
    [workgroups.min(32768), workgroups.div_ceil(32768), 1]
}

/// Runs one entry point over a grid.
pub fn dispatch(
    pass: &mut wgpu::ComputePass,
    pipeline: &wgpu::ComputePipeline,
    group: &wgpu::BindGroup,
    [x, y, z]: [u32; 3],
) {
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, group, &[]);
    pass.dispatch_workgroups(x, y, z);
}

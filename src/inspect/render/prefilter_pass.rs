//! The pass that blurs an environment from level to level.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

use super::blur_levels::{ENVIRONMENT_LEVELS, SAMPLE_COUNT, roughness_of_level};
use gpu::wgsl::WgslFile;
use gpu::{ComputePipeline, Gpu, GpuError, ShaderModule, uniform_buffer};

static SHEEN: WgslFile = WgslFile::new("sheen", &[]);
pub(crate) static REFLECTANCE: WgslFile = WgslFile::new("reflectance", &[&SHEEN]);
static PREFILTER: WgslFile = WgslFile::new("prefilter", &[&REFLECTANCE]);
pub(crate) static PASS_PREFILTER: WgslFile = WgslFile::new("pass_prefilter", &[&PREFILTER]);

/// Twin of `PrefilterParams` in `shaders/pass_prefilter.wgsl`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct PrefilterParams {
    pub roughness: f32,
    pub sample_count: u32,
    pub size: u32,
    pub source_size: u32,
}

/// Fills all levels of a cube map of [`ENVIRONMENT_LEVELS`] levels from one of the same size with all mip levels. The result is
/// the same every time.
///
/// # Errors
/// The pipeline can't be made: out of memory, or a lost device.
pub(crate) fn prefilter(
    gpu: &Gpu,
    source: &wgpu::Texture,
    filtered: &wgpu::Texture,
    sampler: &wgpu::Sampler,
) -> Result<(), GpuError> {
    let pipeline = ComputePipeline::new(&Arc::new(ShaderModule::new(&PASS_PREFILTER)), "prefilter_main");
    let pipeline = pipeline.get(gpu)?;
    gpu.attempt(|| {
        let mut encoder =
            gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("prefilter") });
        for level in 0..ENVIRONMENT_LEVELS {
            let group = level_group(gpu, pipeline, source, filtered, sampler, level);
            let workgroups = (filtered.width() >> level).div_ceil(8);
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.dispatch_workgroups(workgroups, workgroups, 6);
        }
        gpu.queue.submit([encoder.finish()]);
    })
}

/// What the pass over one level is bound to.
fn level_group(
    gpu: &Gpu,
    pipeline: &wgpu::ComputePipeline,
    source: &wgpu::Texture,
    filtered: &wgpu::Texture,
    sampler: &wgpu::Sampler,
    level: u32,
) -> wgpu::BindGroup {
    let params = PrefilterParams {
        roughness: roughness_of_level(level),
        sample_count: SAMPLE_COUNT,
        size: filtered.width() >> level,
        source_size: source.width(),
    };
    let params = uniform_buffer(gpu, "prefilter", bytemuck::bytes_of(&params));
    let target = filtered.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        base_mip_level: level,
        mip_level_count: Some(1),
        ..Default::default()
    });
    let source = cube_view(source);
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("prefilter"),
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&source) },
            wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(sampler) },
            wgpu::BindGroupEntry { binding: 2, resource: params.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 3, resource: wgpu::BindingResource::TextureView(&target) },
        ],
    })
}

/// All faces and levels of a texture of six layers.
pub(crate) fn cube_view(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::Cube),
        ..Default::default()
    })
}

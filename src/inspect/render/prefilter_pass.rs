//! The pass that blurs an environment from level to level.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

use super::blur_levels::{ENVIRONMENT_LEVELS, SAMPLE_COUNT, roughness_of_level};
use gpu::{ComputePipeline, Gpu, GpuError, ShaderModule, uniform_buffer};

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
    let pipeline = ComputePipeline::new(&Arc::new(ShaderModule::new("pass_prefilter")), "prefilter_main");
    pipeline.get(gpu)?;
    gpu.attempt(|| {
        let mut encoder =
            gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("prefilter") });
        for level in 0..ENVIRONMENT_LEVELS {
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
            let bound = pipeline.bind(gpu, |name| {
                Some(match name {
                    "source" => wgpu::BindingResource::TextureView(&source),
                    "source_sampler" => wgpu::BindingResource::Sampler(sampler),
                    "params" => params.as_entire_binding(),
                    _ => wgpu::BindingResource::TextureView(&target),
                })
            })?;
            let workgroups = (filtered.width() >> level).div_ceil(8);
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            bound.dispatch(&mut pass, [workgroups, workgroups, 6]);
        }
        gpu.queue.submit([encoder.finish()]);
        Ok(())
    })?
}

/// All faces and levels of a texture of six layers.
pub(crate) fn cube_view(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::Cube),
        ..Default::default()
    })
}

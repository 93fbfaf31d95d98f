//! The pass that blurs an environment from level to level, and adds up irradiance.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

use super::blur_levels::{ENVIRONMENT_LEVELS, IRRADIANCE_LEVEL, SAMPLE_COUNT, roughness_of_level};
use super::irradiance::LightPart;
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

/// Fills all [`ENVIRONMENT_LEVELS`] levels of the first of two cubes from one of the same size with all mip levels, and a level of
/// the second with the irradiance of light that is divided into these parts. The result is the same every time.
///
/// # Errors
/// The pipeline can't be made: out of memory, or a lost device.
pub(crate) fn prefilter(
    gpu: &Gpu,
    source: &wgpu::Texture,
    parts: &[LightPart],
    filtered: &wgpu::Texture,
    sampler: &wgpu::Sampler,
) -> Result<(), GpuError> {
    let pipeline = ComputePipeline::new(&Arc::new(ShaderModule::new("pass_prefilter")), "prefilter_main");
    pipeline.get(gpu)?;
    gpu.attempt(|| {
        let parts = uniform_buffer(gpu, "irradiance", bytemuck::cast_slice(parts));
        let mut encoder =
            gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("prefilter") });
        let levels = (0..ENVIRONMENT_LEVELS).map(|level| (0, level, SAMPLE_COUNT));
        for (cube, level, sample_count) in levels.chain([(1, IRRADIANCE_LEVEL, 0)]) {
            let params = PrefilterParams {
                roughness: roughness_of_level(level),
                sample_count,
                size: filtered.width() >> level,
                source_size: source.width(),
            };
            let params = uniform_buffer(gpu, "prefilter", bytemuck::bytes_of(&params));
            let target = filtered.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2Array),
                base_mip_level: level,
                mip_level_count: Some(1),
                base_array_layer: 6 * cube,
                array_layer_count: Some(6),
                ..Default::default()
            });
            let source = cube_view(source);
            let bound = pipeline.bind(gpu, |name| {
                Some(match name {
                    "source" => wgpu::BindingResource::TextureView(&source),
                    "source_sampler" => wgpu::BindingResource::Sampler(sampler),
                    "parts" => parts.as_entire_binding(),
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

/// All cubes and levels of a texture of six layers a cube.
pub(crate) fn cube_view(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::CubeArray),
        ..Default::default()
    })
}

//! Layouts of bind groups that several pipelines share.

use super::target::samples;
use gpu::Gpu;

/// A binding, the stages that see it, and what it is.
pub(super) type Binding = (u32, wgpu::ShaderStages, wgpu::BindingType);

pub(super) const VERTEX: wgpu::ShaderStages = wgpu::ShaderStages::VERTEX;
pub(super) const FRAGMENT: wgpu::ShaderStages = wgpu::ShaderStages::FRAGMENT;
pub(super) const UNIFORM: wgpu::BindingType = buffer(wgpu::BufferBindingType::Uniform);
/// A storage buffer that is only read.
pub(super) const READ: wgpu::BindingType = buffer(wgpu::BufferBindingType::Storage { read_only: true });
/// An image whose texels are blended.
pub(super) const IMAGE: wgpu::BindingType = image(wgpu::TextureViewDimension::D2);
pub(super) const SAMPLER: wgpu::BindingType = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);

const fn buffer(ty: wgpu::BufferBindingType) -> wgpu::BindingType {
    wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None }
}

pub(super) const fn image(view_dimension: wgpu::TextureViewDimension) -> wgpu::BindingType {
    let sample_type = wgpu::TextureSampleType::Float { filterable: true };
    wgpu::BindingType::Texture { sample_type, view_dimension, multisampled: false }
}

/// Depths of layers.
pub(super) fn depths(gpu: &Gpu) -> wgpu::BindingType {
    wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Depth,
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: samples(gpu) > 1,
    }
}

pub(super) fn group_layout(gpu: &Gpu, label: &str, bindings: &[Binding]) -> wgpu::BindGroupLayout {
    let entry =
        |&(binding, visibility, ty): &Binding| wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None };
    let entries: Vec<_> = bindings.iter().map(entry).collect();
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries: &entries })
}

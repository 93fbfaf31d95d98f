//! Buffers and textures in device memory.

use bytemuck::Pod;
use wgpu::util::DeviceExt;

use super::{Gpu, GpuError};

/// A storage buffer that holds `items`, which passes may write over. Without items it still holds one zeroed element, since
/// an empty buffer can't be bound.
///
/// # Errors
/// It would be larger than the adapter binds.
pub(super) fn filled<T: Pod>(gpu: &Gpu, what: &'static str, items: &[T]) -> Result<wgpu::Buffer, GpuError> {
    check_size::<T>(gpu, what, items.len())?;
    let zero = [T::zeroed()];
    Ok(gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: Some(what),
        contents: bytemuck::cast_slice(if items.is_empty() { &zero } else { items }),
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
    }))
}

/// A storage buffer with room for `count` elements (at least one) that passes write, and that draws may then read as vertices,
/// indices or indirect arguments.
///
/// # Errors
/// It would be larger than the adapter binds.
pub fn empty<T>(gpu: &Gpu, what: &'static str, count: usize) -> Result<wgpu::Buffer, GpuError> {
    check_size::<T>(gpu, what, count)?;
    Ok(gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(what),
        size: (count.max(1) * size_of::<T>()) as u64,
        usage: wgpu::BufferUsages::STORAGE
            | wgpu::BufferUsages::COPY_SRC
            | wgpu::BufferUsages::INDIRECT
            | wgpu::BufferUsages::VERTEX
            | wgpu::BufferUsages::INDEX,
        mapped_at_creation: false,
    }))
}

/// A buffer that shaders bind as a uniform or as storage, and that the host may write again.
pub fn uniform_buffer(gpu: &Gpu, label: &str, contents: &[u8]) -> wgpu::Buffer {
    gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: Some(label),
        contents,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
    })
}

/// The size of buffers together.
pub fn bytes_of<'a>(buffers: impl IntoIterator<Item = &'a wgpu::Buffer>) -> u64 {
    buffers.into_iter().map(wgpu::Buffer::size).sum()
}

/// What to say of a texture with one layer, one level and one sample a texel.
pub fn flat_texture(
    label: &str,
    [width, height]: [u32; 2],
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::TextureDescriptor<'_> {
    wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    }
}

/// A view of all of a texture.
pub fn whole(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

/// A view of a texture like that with these texels, which shaders sample.
pub fn filled_texture(
    gpu: &Gpu,
    label: &str,
    size: [u32; 2],
    format: wgpu::TextureFormat,
    bytes: &[u8],
) -> wgpu::TextureView {
    let descriptor = flat_texture(label, size, format, wgpu::TextureUsages::TEXTURE_BINDING);
    whole(&gpu.device.create_texture_with_data(
        &gpu.queue,
        &descriptor,
        wgpu::util::TextureDataOrder::LayerMajor,
        bytes,
    ))
}

fn check_size<T>(gpu: &Gpu, what: &'static str, count: usize) -> Result<(), GpuError> {
    let bytes = (count * size_of::<T>()) as u64;
    let limits = gpu.device.limits();
    let limit = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
    if bytes > limit { Err(GpuError::TooLarge { what, bytes, limit }) } else { Ok(()) }
}

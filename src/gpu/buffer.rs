//! Buffers in device memory.

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

fn check_size<T>(gpu: &Gpu, what: &'static str, count: usize) -> Result<(), GpuError> {
    let bytes = (count * size_of::<T>()) as u64;
    let limits = gpu.device.limits();
    let limit = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
    if bytes > limit { Err(GpuError::TooLarge { what, bytes, limit }) } else { Ok(()) }
}

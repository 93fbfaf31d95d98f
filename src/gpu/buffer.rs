//! Buffers and textures in device memory.

use bytemuck::Pod;
use wgpu::util::DeviceExt;

use super::{Gpu, GpuError};
use geometry::cores::in_ranges;

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

/// The most bytes of a buffer that are made before the device takes them.
const BLOCK: usize = 16 << 20;

/// The least number of items that are worth a thread.
const LEAST: usize = 1 << 12;

/// A storage buffer as [`filled`] makes it, of `count` items. They are made on all cores, and block by block: a list of all of them
/// may take more memory than what it is made from.
///
/// # Errors
/// It would be larger than the adapter binds.
pub(super) fn filled_by<T: Pod>(
    gpu: &Gpu,
    what: &'static str,
    count: usize,
    item: impl Fn(usize) -> T + Sync,
) -> Result<wgpu::Buffer, GpuError> {
    check_size::<T>(gpu, what, count)?;
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(what),
        size: (count.max(1) * size_of::<T>()) as u64,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let at_once = BLOCK / size_of::<T>();
    for first in (0..count).step_by(at_once) {
        let items = at_once.min(count - first);
        in_ranges(items, LEAST, |range| {
            let start = ((first + range.start) * size_of::<T>()) as u64;
            let made: Vec<T> = range.map(|i| item(first + i)).collect();
            gpu.queue.write_buffer(&buffer, start, bytemuck::cast_slice(&made));
        });
        if items == at_once {
            // So that the device frees the memory that this block waits in.
            gpu.queue.submit([]);
        }
    }
    Ok(buffer)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::readback::read_buffer;

    #[test]
    fn items_that_are_made_in_blocks_all_arrive() {
        let gpu = Gpu::headless().expect("these tests need a graphics adapter: run ./setup.sh");
        let in_block = BLOCK / size_of::<[u32; 3]>();
        for count in [0, 1, LEAST + 1, in_block, 2 * in_block + 5] {
            let item = |i: usize| [i as u32, !(i as u32), 7];
            let buffer = filled_by(&gpu, "items", count, item).expect("it isn't too large");
            let bytes = read_buffer(&gpu, &buffer, 0, buffer.size()).expect("the device isn't lost");
            let expected: Vec<[u32; 3]> = if count == 0 { vec![[0; 3]] } else { (0..count).map(item).collect() };
            assert!(bytes == bytemuck::cast_slice::<_, u8>(&expected), "{count}");
        }
    }
}

//! The passes that make the smaller levels of an image.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

use geometry::mesh::mipmap::{MipFilter, SRGB_TABLE, level_count, level_size, wanted_texels};
use gpu::{ComputePipeline, Gpu, GpuError, ShaderModule, uniform_buffer};

/// Numbers that are kept of each level for the test of a mask.
pub(crate) const ALPHAS: u32 = 257;

/// Twin of `MipParams` in `shaders/pass_mipmap.wgsl`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct MipParams {
    pub source_size: [u32; 2],
    pub target_size: [u32; 2],
    pub source_start: u32,
    pub source_stride: u32,
    pub target_start: u32,
    pub target_stride: u32,
    pub level: u32,
    pub mip_filter: u32,
    pub least_alpha: u32,
    pub wanted: u32,
}

/// The test of a mask that an image's alpha must pass.
#[derive(Clone, Copy, Debug)]
pub(super) struct AlphaTest {
    /// The least alpha that passes, 1 to 255.
    pub least: u32,
    /// How many of the image's texels do.
    pub covered: u64,
}

/// The passes. Their pipelines are made when an image first has several levels.
pub(super) struct Mipmaps {
    average: ComputePipeline,
    /// For the test of a mask, in this order.
    tested: [ComputePipeline; 3],
}

impl Mipmaps {
    pub(super) fn new() -> Self {
        let module = Arc::new(ShaderModule::new("pass_mipmap"));
        let pass = |name| ComputePipeline::new(&module, name);
        Self { average: pass("mip_main"), tested: ["mip_count", "mip_choose", "mip_cover"].map(pass) }
    }

    /// Records passes that fill all levels of an image of 8-bit RGBA but the first, which must be there before. `first` is a
    /// view of that, without a transfer function. The result is the same every time.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub(super) fn fill(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        image: &wgpu::Texture,
        first: &wgpu::TextureView,
        filter: MipFilter,
        test: Option<AlphaTest>,
    ) -> Result<(), GpuError> {
        let size = [image.width(), image.height()];
        if image.mip_level_count() == 1 {
            return Ok(());
        }
        let tested = if test.is_some() { &self.tested[..] } else { &[] };
        std::iter::once(&self.average).chain(tested).try_for_each(|pass| pass.get(gpu).map(|_| ()))?;
        let levels: Vec<_> = level_params(size, filter, test).collect();
        let buffers = gpu.attempt(|| Buffers::new(gpu, size))?;
        // Each level is averaged from the one before before any alpha is scaled.
        for params in &levels {
            record(&self.average, gpu, encoder, &buffers, first, params)?;
        }
        for (params, pass) in levels.iter().flat_map(|params| tested.iter().map(move |pass| (params, pass))) {
            record(pass, gpu, encoder, &buffers, first, params)?;
        }
        levels.iter().for_each(|params| copy(params, encoder, &buffers.texels, image));
        Ok(())
    }
}

/// Records a pass over a level.
///
/// # Errors
/// The pipeline can't be made: out of memory, or a lost device.
fn record(
    pipeline: &ComputePipeline,
    gpu: &Gpu,
    encoder: &mut wgpu::CommandEncoder,
    buffers: &Buffers,
    first: &wgpu::TextureView,
    params: &MipParams,
) -> Result<(), GpuError> {
    let uniform = uniform_buffer(gpu, "mipmap", bytemuck::bytes_of(params));
    let bound = pipeline.bind(gpu, |name| {
        Some(match name {
            "params" => uniform.as_entire_binding(),
            "image" => wgpu::BindingResource::TextureView(first),
            "levels" => buffers.texels.as_entire_binding(),
            "alphas" => buffers.alphas.as_entire_binding(),
            _ => buffers.table.as_entire_binding(),
        })
    })?;
    let [across, down] = match pipeline.entry_point() {
        "mip_choose" => [1, 1],
        _ => params.target_size.map(|side| side.div_ceil(8)),
    };
    bound.dispatch(&mut encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default()), [across, down, 1]);
    Ok(())
}

/// What the passes over an image work in.
struct Buffers {
    /// All levels but the first.
    texels: wgpu::Buffer,
    table: wgpu::Buffer,
    alphas: wgpu::Buffer,
}

impl Buffers {
    fn new(gpu: &Gpu, size: [u32; 2]) -> Self {
        // New buffers are filled with 0.
        let storage = |label, size| {
            let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
            let descriptor = wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false };
            gpu.device.create_buffer(&descriptor)
        };
        Self {
            texels: storage("levels", level_bytes(size)),
            table: uniform_buffer(gpu, "sRGB", bytemuck::cast_slice(&*SRGB_TABLE)),
            alphas: storage("alphas", u64::from(level_count(size) * ALPHAS * 4)),
        }
    }
}

/// Texels from the start of a row of a level to that of the next one in the buffer of levels: copies to images need multiples of
/// 256 bytes.
fn stride(width: u32) -> u32 {
    width.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT / 4)
}

/// The size of the buffer of all levels but the first of an image of `size` px, in bytes.
pub(super) fn level_bytes(size: [u32; 2]) -> u64 {
    let texels = |[width, height]: [u32; 2]| u64::from(stride(width)) * u64::from(height);
    (1..level_count(size)).map(|level| 4 * texels(level_size(size, level))).sum()
}

/// What the passes over each level but the first are told.
fn level_params(size: [u32; 2], filter: MipFilter, test: Option<AlphaTest>) -> impl Iterator<Item = MipParams> {
    let (mut source_start, mut target_start) = (0, 0);
    (1..level_count(size)).map(move |level| {
        let [source_size, target_size] = [level - 1, level].map(|level| level_size(size, level));
        let params = MipParams {
            source_size,
            target_size,
            source_start,
            source_stride: stride(source_size[0]),
            target_start,
            target_stride: stride(target_size[0]),
            level,
            mip_filter: filter as u32,
            least_alpha: test.map_or(1, |test| test.least),
            wanted: test.map_or(0, |test| wanted_texels(test.covered, size, level)),
        };
        (source_start, target_start) = (target_start, target_start + params.target_stride * target_size[1]);
        params
    })
}

/// Records the copy of a level to the image.
fn copy(params: &MipParams, encoder: &mut wgpu::CommandEncoder, texels: &wgpu::Buffer, image: &wgpu::Texture) {
    let [width, height] = params.target_size;
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 4 * u64::from(params.target_start),
        bytes_per_row: Some(4 * params.target_stride),
        rows_per_image: None,
    };
    let to = wgpu::TexelCopyTextureInfo { mip_level: params.level, ..image.as_image_copy() };
    let extent = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
    encoder.copy_buffer_to_texture(wgpu::TexelCopyBufferInfo { buffer: texels, layout }, to, extent);
}

#[cfg(test)]
mod tests;

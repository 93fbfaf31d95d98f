//! The texture that a picture is drawn into.

use crate::gpu::{Gpu, GpuError, read_texture};

/// How a picture's texture is drawn into and resolved: sRGB-encoded 8-bit RGBA.
pub(super) const COLOR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
pub(super) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Samples a pixel that pictures are drawn with: 4 where the adapter has them, else 1.
pub fn samples(gpu: &Gpu) -> u32 {
    gpu.samples(&[COLOR_FORMAT, DEPTH_FORMAT])
}

/// Colour and depth of one size. Drawn through an sRGB view, shown and read back through a plain one, so that the bytes
/// are those of a PNG.
pub struct Target {
    pub size: [u32; 2],
    resolved: wgpu::Texture,
    resolved_srgb: wgpu::TextureView,
    multisampled: Option<wgpu::TextureView>,
    depth: wgpu::TextureView,
}

/// What egui shows and a PNG holds: sRGB-encoded bytes, not decoded when sampled.
const SHOWN_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

impl Target {
    /// # Errors
    /// The adapter has no textures of that size.
    pub fn new(gpu: &Gpu, size: [u32; 2]) -> Result<Self, GpuError> {
        let limit = gpu.device.limits().max_texture_dimension_2d;
        let [width, height] = size.map(|side| side.max(1));
        if width > limit || height > limit {
            return Err(GpuError::PictureTooLarge { width, height, limit });
        }
        let texture = |label, format, samples, usage, view_formats: &[wgpu::TextureFormat]| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: samples,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage,
                view_formats,
            })
        };
        let drawn = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let shown = drawn | wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_SRC;
        let resolved = texture("target", SHOWN_FORMAT, 1, shown, &[COLOR_FORMAT]);
        let resolved_srgb =
            resolved.create_view(&wgpu::TextureViewDescriptor { format: Some(COLOR_FORMAT), ..Default::default() });
        let view = |texture: wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let samples = samples(gpu);
        let multisampled =
            (samples > 1).then(|| view(texture("target.multisampled", COLOR_FORMAT, samples, drawn, &[])));
        let depth = view(texture("target.depth", DEPTH_FORMAT, samples, drawn, &[]));
        Ok(Self { size: [width, height], resolved, resolved_srgb, multisampled, depth })
    }

    /// The view to show: sRGB-encoded values.
    pub fn shown_view(&self) -> wgpu::TextureView {
        self.resolved.create_view(&wgpu::TextureViewDescriptor::default())
    }

    /// Width and height in px.
    pub fn viewport(&self) -> glam::Vec2 {
        glam::vec2(self.size[0] as f32, self.size[1] as f32)
    }

    /// The colour attachment of one pass of several: the first clears to `background` (linear), the last resolves.
    pub fn color(&self, background: wgpu::Color, first: bool, last: bool) -> wgpu::RenderPassColorAttachment<'_> {
        let (view, resolve_target) = match &self.multisampled {
            Some(view) => (view, last.then_some(&self.resolved_srgb)),
            None => (&self.resolved_srgb, None),
        };
        let load = if first { wgpu::LoadOp::Clear(background) } else { wgpu::LoadOp::Load };
        wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target,
            ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
        }
    }

    /// The depth attachment of one pass of several. Depth is reversed: the far end is 0.
    pub fn depth(&self, first: bool) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        let load = if first { wgpu::LoadOp::Clear(0.0) } else { wgpu::LoadOp::Load };
        wgpu::RenderPassDepthStencilAttachment {
            view: &self.depth,
            depth_ops: Some(wgpu::Operations { load, store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }
    }

    /// Bytes of all its textures.
    pub fn bytes(&self) -> u64 {
        let pixels = u64::from(self.size[0]) * u64::from(self.size[1]);
        let samples = if self.multisampled.is_some() { 4 } else { 1 };
        pixels * 4 * (1 + samples + if samples > 1 { samples } else { 0 })
    }

    /// The picture, waiting for it.
    ///
    /// # Errors
    /// The device was lost.
    pub fn read(&self, gpu: &Gpu) -> Result<image::RgbaImage, GpuError> {
        let [width, height] = self.size;
        let pixels = read_texture(gpu, &self.resolved)?;
        image::RgbaImage::from_raw(width, height, pixels)
            .ok_or_else(|| GpuError::Readback("the picture came back short".into()))
    }
}

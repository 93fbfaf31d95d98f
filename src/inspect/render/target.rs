//! The texture that a picture is drawn into.

use super::layout::{linear, srgb};
use super::mipmap_pass::Mipmaps;
use super::textures::fits;
use crate::settings::Settings;
use geometry::mesh::mipmap::{MipFilter, level_count};
use gpu::{Gpu, GpuError, Lazy, Recorder, flat_texture, read_texture, whole};

/// The format in which pictures are drawn and resolved: 8-bit RGBA, encoded as sRGB.
pub(crate) const COLOR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
pub(crate) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// The number of samples per pixel in pictures: 4 if the adapter supports them, else 1.
pub fn samples(gpu: &Gpu) -> u32 {
    gpu.samples(&[COLOR_FORMAT, DEPTH_FORMAT])
}

/// Colour and depth textures of one size. They are drawn through an sRGB view, and shown and read back through a plain one, so
/// that the bytes are those of a PNG.
pub struct Target {
    pub size: [u32; 2],
    resolved: wgpu::Texture,
    resolved_srgb: wgpu::TextureView,
    multisampled: Option<wgpu::TextureView>,
    /// What passes attach, for shaders that read it.
    pub(super) depth: wgpu::TextureView,
    /// Made when a picture first has layers: see [`super::layers`].
    layer_depths: Lazy<[wgpu::TextureView; 2]>,
    /// Pictures of both halves, made when a difference is first drawn: see [`super::difference`].
    kept: Lazy<[wgpu::Texture; 2]>,
    /// A picture of what is behind layers that distort it, with mip levels. Made when such a layer is first drawn.
    behind: Lazy<wgpu::Texture>,
    /// Whether pictures have no background: where nothing is drawn they are transparent.
    pub(super) is_transparent: bool,
    /// Whether pictures leave out what takes a software driver longest: see [`Self::draft`].
    pub(super) is_draft: bool,
    /// Px of the full picture that one px stands for, along each axis: see [`Self::coarse`].
    pub(super) coarseness: u32,
}

/// The format that egui shows and a PNG holds: bytes encoded as sRGB, which sampling doesn't decode.
pub(super) const SHOWN_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

impl Target {
    /// Makes the textures, with this width and height in px.
    ///
    /// # Errors
    /// The adapter has no textures of that size.
    pub fn new(gpu: &Gpu, size: [u32; 2]) -> Result<Self, GpuError> {
        let limit = gpu.device.limits().max_texture_dimension_2d;
        let [width, height] = size.map(|side| side.max(1));
        if width > limit || height > limit {
            return Err(GpuError::PictureTooLarge { width, height, limit });
        }
        let drawn = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let shown = drawn | wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_SRC;
        let flat = |label, format, usage| flat_texture(label, [width, height], format, usage);
        let resolved = gpu.device.create_texture(&wgpu::TextureDescriptor {
            view_formats: &[COLOR_FORMAT],
            ..flat("target", SHOWN_FORMAT, shown)
        });
        let resolved_srgb =
            resolved.create_view(&wgpu::TextureViewDescriptor { format: Some(COLOR_FORMAT), ..Default::default() });
        let sample_count = samples(gpu);
        let multisampled = (sample_count > 1).then(|| {
            let own = flat("target.multisampled", COLOR_FORMAT, drawn);
            whole(&gpu.device.create_texture(&wgpu::TextureDescriptor { sample_count, ..own }))
        });
        let depth = depth_view(gpu, "target.depth", [width, height]);
        Ok(Self {
            size: [width, height],
            resolved,
            resolved_srgb,
            multisampled,
            depth,
            layer_depths: Lazy::default(),
            kept: Lazy::default(),
            behind: Lazy::default(),
            is_transparent: false,
            is_draft: false,
            coarseness: 1,
        })
    }

    /// The same, for pictures that are transparent where nothing is drawn.
    ///
    /// # Errors
    /// The same.
    pub fn transparent(gpu: &Gpu, size: [u32; 2]) -> Result<Self, GpuError> {
        Ok(Self { is_transparent: true, ..Self::new(gpu, size)? })
    }

    /// The same, for drafts of pictures. The images of a material count by their mean, but for that of the base colour, and its
    /// normals are those of the surface. A place that shows more than half of what is behind it isn't drawn, and any other hides
    /// what is behind.
    ///
    /// # Errors
    /// The same.
    pub fn draft(gpu: &Gpu, size: [u32; 2]) -> Result<Self, GpuError> {
        Ok(Self { is_draft: true, ..Self::new(gpu, size)? })
    }

    /// The same, for pictures that are shown so many times as large along each axis. Their lines are as many times thinner.
    pub fn coarse(self, coarseness: u32) -> Self {
        Self { coarseness, ..self }
    }

    /// The view for showing the picture. Its values are encoded as sRGB, or are linear light for a texture that encodes them.
    pub(super) fn shown_view(&self, is_linear: bool) -> wgpu::TextureView {
        if is_linear { self.resolved_srgb.clone() } else { whole(&self.resolved) }
    }

    /// Width and height in px.
    pub fn viewport(&self) -> glam::Vec2 {
        glam::vec2(self.size[0] as f32, self.size[1] as f32)
    }

    /// The colour attachment for one of several passes. The first clears to `background` (linear light), and the last resolves.
    pub fn color(&self, background: wgpu::Color, first: bool, last: bool) -> wgpu::RenderPassColorAttachment<'_> {
        let (view, resolve_target) = match &self.multisampled {
            Some(view) => (view, last.then_some(&self.resolved_srgb)),
            None => (&self.resolved_srgb, None),
        };
        wgpu::RenderPassColorAttachment { resolve_target, ..color_attachment(view, first.then_some(background)) }
    }

    /// The depth attachment for one of several passes. Depth is reversed, so the first clears it to 0, the far end.
    pub fn depth(&self, first: bool) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        depth_attachment(&self.depth, first.then_some(0.0))
    }

    /// Two more textures of depths, for layers. They are made at the first call.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub(super) fn layer_depths(&self, gpu: &Gpu) -> Result<&[wgpu::TextureView; 2], GpuError> {
        self.layer_depths.get_or_make(gpu, || [0, 1].map(|_| depth_view(gpu, "target.layer depth", self.size)))
    }

    /// The pictures that were kept. Their textures are made at the first call.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub(super) fn kept(&self, gpu: &Gpu) -> Result<&[wgpu::Texture; 2], GpuError> {
        let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
        let texture = |_| gpu.device.create_texture(&flat_texture("target.kept", self.size, SHOWN_FORMAT, usage));
        self.kept.get_or_make(gpu, || [0, 1].map(texture))
    }

    /// Frees the pictures that were kept, unless pictures with these settings are differences.
    pub fn keep_only_for(&mut self, settings: &Settings) {
        if !settings.shows_difference() {
            self.kept = Lazy::default();
        }
    }

    /// Keeps the picture that was drawn as the one with this index.
    ///
    /// # Errors
    /// The same.
    pub(super) fn keep(&self, recorder: &mut Recorder, gpu: &Gpu, index: usize) -> Result<(), GpuError> {
        let (from, to) = (self.resolved.as_image_copy(), self.kept(gpu)?[index].as_image_copy());
        recorder.encoder().copy_texture_to_texture(from, to, self.resolved.size());
        Ok(())
    }

    /// The picture of what is behind layers that distort it. Its texture is made at the first call.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub(super) fn behind(&self, gpu: &Gpu) -> Result<&wgpu::Texture, GpuError> {
        let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
        // Where there is no room for levels, nothing is blurred.
        let mip_level_count = if fits(gpu, self.size) { level_count(self.size) } else { 1 };
        let flat = flat_texture("target.behind", self.size, COLOR_FORMAT, usage);
        let descriptor = wgpu::TextureDescriptor { mip_level_count, view_formats: &[SHOWN_FORMAT], ..flat };
        self.behind.get_or_make(gpu, || gpu.device.create_texture(&descriptor))
    }

    /// Makes the picture that was drawn so far, and resolved, that of what is behind layers.
    ///
    /// # Errors
    /// The same.
    pub(super) fn keep_behind(&self, recorder: &mut Recorder, gpu: &Gpu, mipmaps: &Mipmaps) -> Result<(), GpuError> {
        let behind = self.behind(gpu)?;
        let (from, to) = (self.resolved.as_image_copy(), behind.as_image_copy());
        recorder.encoder().copy_texture_to_texture(from, to, self.resolved.size());
        let first =
            wgpu::TextureViewDescriptor { format: Some(SHOWN_FORMAT), mip_level_count: Some(1), ..Default::default() };
        mipmaps.fill(gpu, recorder.encoder(), behind, &behind.create_view(&first), MipFilter::Colors, None)
    }

    /// The size of all its textures in bytes.
    pub fn bytes(&self) -> u64 {
        let pixels = u64::from(self.size[0]) * u64::from(self.size[1]);
        let samples = if self.multisampled.is_some() { 4 } else { 1 };
        let layers = if self.layer_depths.is_made() { 2 * samples } else { 0 };
        let kept = if self.kept.is_made() { 2 } else { 0 };
        // Levels are a third of the first.
        let behind = if self.behind.is_made() { pixels * 16 / 3 } else { 0 };
        pixels * 4 * (1 + samples + if samples > 1 { samples } else { 0 } + layers + kept) + behind
    }

    /// Reads the picture back, with straight alpha as PNG files have it. Waits for the device.
    ///
    /// # Errors
    /// The device was lost.
    pub fn read(&self, gpu: &Gpu) -> Result<image::RgbaImage, GpuError> {
        let [width, height] = self.size;
        let pixels = read_texture(gpu, &self.resolved)?;
        let mut picture = image::RgbaImage::from_raw(width, height, pixels)
            .ok_or_else(|| GpuError::Readback("the picture came back short".into()))?;
        if self.is_transparent {
            picture.pixels_mut().for_each(|pixel| pixel.0 = straight(pixel.0));
        }
        Ok(picture)
    }
}

/// A texture of depths that can be attached, and read by shaders.
fn depth_view(gpu: &Gpu, label: &str, size: [u32; 2]) -> wgpu::TextureView {
    let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
    let descriptor = flat_texture(label, size, DEPTH_FORMAT, usage);
    whole(&gpu.device.create_texture(&wgpu::TextureDescriptor { sample_count: samples(gpu), ..descriptor }))
}

/// A colour attachment that is first cleared to a colour, or keeps what it has.
pub(super) fn color_attachment(
    view: &wgpu::TextureView,
    clear: Option<wgpu::Color>,
) -> wgpu::RenderPassColorAttachment<'_> {
    let load = clear.map_or(wgpu::LoadOp::Load, wgpu::LoadOp::Clear);
    let ops = wgpu::Operations { load, store: wgpu::StoreOp::Store };
    wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops }
}

/// A depth attachment that is first cleared to a depth, or keeps what it has.
pub(super) fn depth_attachment(
    view: &wgpu::TextureView,
    clear: Option<f32>,
) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    let load = clear.map_or(wgpu::LoadOp::Load, wgpu::LoadOp::Clear);
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations { load, store: wgpu::StoreOp::Store }),
        stencil_ops: None,
    }
}

/// A pixel with straight alpha, from one whose linear colour is multiplied by alpha, which is what blending over nothing makes.
fn straight([r, g, b, alpha]: [u8; 4]) -> [u8; 4] {
    if [0, 255].contains(&alpha) {
        return [r, g, b, alpha];
    }
    let [r, g, b] = linear([r, g, b]).map(|channel| srgb(channel * 255.0 / f32::from(alpha)));
    [r, g, b, alpha]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_half_covered_pixel_gets_the_colour_that_covers_it() {
        let own = [200, 90, 20];
        let [r, g, b] = linear(own).map(|channel| srgb(channel * 128.0 / 255.0));
        let [red, green, blue, alpha] = straight([r, g, b, 128]);
        let largest = [red, green, blue].iter().zip(own).map(|(a, b)| a.abs_diff(b)).max();
        assert!(largest <= Some(1) && alpha == 128, "{red} {green} {blue}");
        assert_eq!([straight([0; 4]), straight([1, 2, 3, 255])], [[0; 4], [1, 2, 3, 255]]);
    }
}

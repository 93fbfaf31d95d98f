//! Images and samplers on the device.

use std::sync::Arc;

use super::mipmap_pass::{AlphaTest, Mipmaps, level_bytes};
use geometry::mesh::mipmap::{MipFilter, covered, halved, level_count};
use geometry::mesh::{Alpha, Material, Sampling, Texture, Wrap};
use gpu::{Gpu, GpuError, flat_texture};

/// What an image is to a material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ImageUse {
    pub filter: MipFilter,
    /// The least alpha, 1 to 255, that passes the test of a mask; none if there is no such test.
    pub least_alpha: Option<u32>,
}

impl ImageUse {
    /// Without a test of alpha.
    pub(super) fn new(filter: MipFilter) -> Self {
        Self { filter, least_alpha: None }
    }

    /// As the image of a material's base colour.
    pub(super) fn base_color(material: &Material) -> Self {
        let filter = MipFilter::from_base_color(material.look.alpha);
        let least_alpha = match material.look.alpha {
            Alpha::Mask(cutoff) => Some((255.0 * cutoff / material.base_color[3] - ROUNDING).ceil()),
            Alpha::Opaque | Alpha::Blend => None,
        };
        // Where everything passes, or nothing, no scale changes that.
        let least_alpha = least_alpha.filter(|least| (1.0..=255.0).contains(least)).map(|least| least as u32);
        Self { filter, least_alpha }
    }

    fn format(self) -> wgpu::TextureFormat {
        match self.filter {
            MipFilter::Colors | MipFilter::AlphaWeighted => COLORS,
            MipFilter::Numbers | MipFilter::Normals => NUMBERS,
        }
    }
}

/// A cutoff that is meant to be a byte's alpha may be a little more.
const ROUNDING: f32 = 1e-3;

/// The formats of views of images: with sRGB's transfer function, and without.
const COLORS: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
const NUMBERS: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// The images of a mesh's materials. One that several materials use in the same way is uploaded once.
#[derive(Default)]
pub(super) struct Textures {
    uploaded: Vec<(*const Texture, ImageUse, wgpu::TextureView)>,
}

impl Textures {
    /// A view of an image, which is uploaded if it isn't there yet.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub(super) fn view(
        &mut self,
        gpu: &Gpu,
        mipmaps: &Mipmaps,
        texture: &Arc<Texture>,
        image_use: ImageUse,
    ) -> Result<wgpu::TextureView, GpuError> {
        let key = Arc::as_ptr(texture);
        if let Some((.., view)) = self.uploaded.iter().find(|(known, of, _)| (*known, *of) == (key, image_use)) {
            return Ok(view.clone());
        }
        let view = upload(gpu, mipmaps, texture, image_use)?;
        self.uploaded.push((key, image_use, view.clone()));
        Ok(view)
    }
}

/// The greatest level of a sampler without mip levels. Half a level more would be level 1; with 0, no image would ever count as
/// smaller than its pixels, and the filter for that wouldn't be used (Vulkan specification, VkSamplerCreateInfo).
const LEVEL_0_ALONE: f32 = 0.25;

/// How many times as long as wide the area of an image may be that a pixel shows without being blurred: floors seen from the side need it.
const ANISOTROPY: u16 = 16;

/// The anisotropy of a sampler. WebGPU has it only where all texels are blended. Mesa's software driver blurs images that are seen from the
/// front, too, and shows wrong texels along the sides of triangles.
fn anisotropy(sampling: Sampling, is_software: bool) -> u16 {
    let is_linear = sampling.magnify_linear && sampling.minify_linear && sampling.mip_linear == Some(true);
    if is_linear && !is_software { ANISOTROPY } else { 1 }
}

pub(super) fn sampler(gpu: &Gpu, sampling: Sampling) -> wgpu::Sampler {
    let wrap = sampling.wrap.map(|wrap| match wrap {
        Wrap::Repeat => wgpu::AddressMode::Repeat,
        Wrap::Mirror => wgpu::AddressMode::MirrorRepeat,
        Wrap::Clamp => wgpu::AddressMode::ClampToEdge,
    });
    let filter = |is_linear| if is_linear { wgpu::FilterMode::Linear } else { wgpu::FilterMode::Nearest };
    let blends_levels = sampling.mip_linear == Some(true);
    gpu.device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("material"),
        address_mode_u: wrap[0],
        address_mode_v: wrap[1],
        mag_filter: filter(sampling.magnify_linear),
        min_filter: filter(sampling.minify_linear),
        mipmap_filter: if blends_levels { wgpu::MipmapFilterMode::Linear } else { wgpu::MipmapFilterMode::Nearest },
        lod_max_clamp: if sampling.mip_linear.is_some() { 32.0 } else { LEVEL_0_ALONE },
        anisotropy_clamp: anisotropy(sampling, gpu.is_software()),
        ..Default::default()
    })
}

/// A sampler that blends texels and levels.
pub(super) fn linear_sampler(gpu: &Gpu, label: &str) -> wgpu::Sampler {
    gpu.device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some(label),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        mipmap_filter: wgpu::MipmapFilterMode::Linear,
        ..Default::default()
    })
}

/// A white pixel, for what has no image.
pub(super) fn white(gpu: &Gpu) -> wgpu::TextureView {
    let pixel = Texture { size: [1, 1], rgba: vec![255; 4] };
    view(&first_level(gpu, &pixel, wgpu::TextureUsages::empty()), COLORS)
}

fn view(texture: &wgpu::Texture, format: wgpu::TextureFormat) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor { format: Some(format), ..Default::default() })
}

/// A view of an image that is uploaded, with all its mip levels. An image that is larger than the adapter's textures can be is halved
/// until it isn't.
///
/// # Errors
/// Out of memory, or a lost device.
pub(super) fn upload(
    gpu: &Gpu,
    mipmaps: &Mipmaps,
    texture: &Texture,
    image_use: ImageUse,
) -> Result<wgpu::TextureView, GpuError> {
    let next = |larger: &Texture| (!fits(gpu, larger.size)).then(|| halved(larger, image_use.filter));
    let smaller = std::iter::successors(next(texture), next).last();
    let texture = smaller.as_ref().unwrap_or(texture);
    let on_device = gpu.attempt(|| first_level(gpu, texture, wgpu::TextureUsages::empty()))?;
    let first = on_device.create_view(&wgpu::TextureViewDescriptor {
        format: Some(NUMBERS),
        mip_level_count: Some(1),
        ..Default::default()
    });
    let test = image_use.least_alpha.map(|least| AlphaTest { least, covered: covered(texture, least) });
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("mipmap") });
    mipmaps.fill(gpu, &mut encoder, &on_device, &first, image_use.filter, test)?;
    gpu.attempt(|| gpu.queue.submit([encoder.finish()]))?;
    Ok(view(&on_device, image_use.format()))
}

/// Whether the adapter's textures can be so large, in px, and its buffers hold their levels.
pub(super) fn fits(gpu: &Gpu, size: [u32; 2]) -> bool {
    let limits = gpu.device.limits();
    let most = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
    size.iter().all(|side| *side <= limits.max_texture_dimension_2d) && level_bytes(size) <= most
}

/// An image on the device, with room for all its mip levels, of which the first is there. It can be sampled and copied to, and used
/// as `usage` says.
pub(super) fn first_level(gpu: &Gpu, texture: &Texture, usage: wgpu::TextureUsages) -> wgpu::Texture {
    let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST | usage;
    let on_device = gpu.device.create_texture(&wgpu::TextureDescriptor {
        mip_level_count: level_count(texture.size),
        view_formats: &[NUMBERS],
        ..flat_texture("material", texture.size, COLORS, usage)
    });
    let layout =
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * texture.size[0]), rows_per_image: None };
    gpu.queue.write_texture(on_device.as_image_copy(), &texture.rgba, layout, on_device.size());
    on_device
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_that_are_blended_in_all_ways_are_filtered_anisotropically() {
        let linear = Sampling::default();
        assert_eq!((anisotropy(linear, false), anisotropy(linear, true)), (ANISOTROPY, 1));
        let others = [
            Sampling { magnify_linear: false, ..linear },
            Sampling { minify_linear: false, ..linear },
            Sampling { mip_linear: Some(false), ..linear },
            Sampling { mip_linear: None, ..linear },
        ];
        assert!(others.into_iter().all(|sampling| anisotropy(sampling, false) == 1));
    }
}

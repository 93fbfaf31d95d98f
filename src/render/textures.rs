//! Images and samplers on the device.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use image::imageops::FilterType;
use wgpu::util::DeviceExt;

use crate::gpu::Gpu;
use crate::mesh::{Sampling, Texture, Wrap};

/// What the bytes of an image are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Meaning {
    /// Colours, encoded as sRGB.
    Colors,
    /// Numbers.
    Numbers,
}

impl Meaning {
    fn format(self) -> wgpu::TextureFormat {
        match self {
            Self::Colors => wgpu::TextureFormat::Rgba8UnormSrgb,
            Self::Numbers => wgpu::TextureFormat::Rgba8Unorm,
        }
    }
}

/// The images of a mesh's materials. One that several materials use, or one material for several things, is uploaded once.
#[derive(Default)]
pub(super) struct Textures {
    uploaded: Vec<(*const Texture, wgpu::Texture)>,
}

impl Textures {
    /// A view of an image, which is uploaded if it isn't there yet.
    pub(super) fn view(&mut self, gpu: &Gpu, texture: &Arc<Texture>, meaning: Meaning) -> wgpu::TextureView {
        let key = Arc::as_ptr(texture);
        let known = self.uploaded.iter().find(|(known, _)| *known == key);
        let on_device = known.map_or_else(|| upload(gpu, texture), |(_, on_device)| on_device.clone());
        if self.uploaded.iter().all(|(known, _)| *known != key) {
            self.uploaded.push((key, on_device.clone()));
        }
        view(&on_device, meaning)
    }
}

/// Samplers, one for each way in which images are sampled.
#[derive(Default)]
pub(super) struct Samplers {
    made: Mutex<HashMap<Sampling, wgpu::Sampler>>,
}

impl Samplers {
    /// The sampler for a way of sampling.
    pub(super) fn get(&self, gpu: &Gpu, sampling: Sampling) -> wgpu::Sampler {
        // What is behind the lock is whole even if a thread panicked while it held it.
        let mut made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        made.entry(sampling).or_insert_with(|| sampler(gpu, sampling)).clone()
    }
}

/// The greatest level of a sampler without mip levels. Half a level more would be level 1; with 0, no image would ever count as
/// smaller than its pixels, and the filter for that wouldn't be used (Vulkan specification, VkSamplerCreateInfo).
const LEVEL_0_ALONE: f32 = 0.25;

fn sampler(gpu: &Gpu, sampling: Sampling) -> wgpu::Sampler {
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
        ..Default::default()
    })
}

/// A white pixel, for what has no image.
pub(super) fn white(gpu: &Gpu) -> wgpu::TextureView {
    color_image(gpu, &white_pixel())
}

/// A view of an image of colours, which is uploaded.
pub(super) fn color_image(gpu: &Gpu, texture: &Texture) -> wgpu::TextureView {
    view(&upload(gpu, texture), Meaning::Colors)
}

fn white_pixel() -> Texture {
    Texture { size: [1, 1], rgba: vec![255; 4] }
}

fn view(texture: &wgpu::Texture, meaning: Meaning) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor { format: Some(meaning.format()), ..Default::default() })
}

/// Uploads an image with all its mip levels. If it is larger than the adapter's textures can be, it is made smaller first.
fn upload(gpu: &Gpu, texture: &Texture) -> wgpu::Texture {
    let limit = gpu.device.limits().max_texture_dimension_2d;
    let [width, height] = texture.size;
    let Some(mut level) = image::RgbaImage::from_raw(width, height, texture.rgba.clone()) else {
        return upload(gpu, &white_pixel());
    };
    if width > limit || height > limit {
        let fitted = image::DynamicImage::ImageRgba8(level).resize(limit, limit, FilterType::Triangle);
        level = fitted.to_rgba8();
    }
    let (mut bytes, size) = (level.as_raw().clone(), level.dimensions());
    let mip_level_count = size.0.max(size.1).ilog2() + 1;
    for _ in 1..mip_level_count {
        let (width, height) = ((level.width() / 2).max(1), (level.height() / 2).max(1));
        level = image::imageops::resize(&level, width, height, FilterType::Triangle);
        bytes.extend_from_slice(level.as_raw());
    }
    let descriptor = wgpu::TextureDescriptor {
        label: Some("material"),
        size: wgpu::Extent3d { width: size.0, height: size.1, depth_or_array_layers: 1 },
        mip_level_count,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: Meaning::Colors.format(),
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[Meaning::Numbers.format()],
    };
    gpu.device.create_texture_with_data(&gpu.queue, &descriptor, wgpu::util::TextureDataOrder::LayerMajor, &bytes)
}

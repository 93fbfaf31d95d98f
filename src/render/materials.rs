//! Materials on the device: their colours and textures.

use std::sync::Arc;

use image::imageops::FilterType;
use wgpu::util::DeviceExt;

use super::layout;
use crate::gpu::Gpu;
use crate::mesh::{Material, Texture};

/// What the materials of all scenes share: the layout, a sampler and a white texture.
pub struct Materials {
    pub layout: wgpu::BindGroupLayout,
    /// For materials without a texture.
    white: wgpu::TextureView,
    sampler: wgpu::Sampler,
}

impl Materials {
    pub fn new(gpu: &Gpu) -> Self {
        Self {
            layout: material_layout(gpu),
            white: upload(gpu, &Texture { size: [1, 1], rgba: vec![255; 4] }),
            sampler: gpu.device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("base color"),
                address_mode_u: wgpu::AddressMode::Repeat,
                address_mode_v: wgpu::AddressMode::Repeat,
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                mipmap_filter: wgpu::MipmapFilterMode::Linear,
                ..Default::default()
            }),
        }
    }

    /// Makes a bind group for each material. A texture that several materials use is uploaded once.
    pub fn groups(&self, gpu: &Gpu, materials: &[Material]) -> Vec<wgpu::BindGroup> {
        let mut uploaded: Vec<(*const Texture, wgpu::TextureView)> = Vec::new();
        let mut view = |texture: &Arc<Texture>| {
            let key = Arc::as_ptr(texture);
            if let Some((_, view)) = uploaded.iter().find(|(known, _)| *known == key) {
                return view.clone();
            }
            let view = upload(gpu, texture);
            uploaded.push((key, view.clone()));
            view
        };
        let group = |material: &Material| {
            let view = material.texture.as_ref().map_or_else(|| self.white.clone(), &mut view);
            self.group(gpu, material.base_color, &view)
        };
        materials.iter().map(group).collect()
    }

    fn group(&self, gpu: &Gpu, base_color: [f32; 4], view: &wgpu::TextureView) -> wgpu::BindGroup {
        let constants = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("material"),
            contents: bytemuck::bytes_of(&layout::Material { base_color }),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("material"),
            layout: &self.layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: constants.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(view) },
                wgpu::BindGroupEntry { binding: 2, resource: wgpu::BindingResource::Sampler(&self.sampler) },
            ],
        })
    }
}

fn material_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let entry =
        |binding, ty| wgpu::BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::FRAGMENT, ty, count: None };
    let uniform = wgpu::BufferBindingType::Uniform;
    let texture = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: true },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("material"),
        entries: &[
            entry(0, wgpu::BindingType::Buffer { ty: uniform, has_dynamic_offset: false, min_binding_size: None }),
            entry(1, texture),
            entry(2, wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering)),
        ],
    })
}

/// Uploads an image with all its mip levels. If it is larger than the adapter's textures can be, it is made smaller first.
fn upload(gpu: &Gpu, texture: &Texture) -> wgpu::TextureView {
    let limit = gpu.device.limits().max_texture_dimension_2d;
    let [width, height] = texture.size;
    let Some(mut level) = image::RgbaImage::from_raw(width, height, texture.rgba.clone()) else {
        return upload(gpu, &Texture { size: [1, 1], rgba: vec![255; 4] });
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
        label: Some("base color"),
        size: wgpu::Extent3d { width: size.0, height: size.1, depth_or_array_layers: 1 },
        mip_level_count,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8UnormSrgb,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    };
    let order = wgpu::util::TextureDataOrder::LayerMajor;
    let texture = gpu.device.create_texture_with_data(&gpu.queue, &descriptor, order, &bytes);
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

//! Materials on the device: their constants, images and samplers.

use wgpu::util::DeviceExt;

use super::environment::Environment;
use super::layout::{self, LEAST_SEEN, MapPlace};
use super::mipmap_pass::Mipmaps;
use super::punctual::upload_lights;
use super::textures::{ImageUse, Samplers, Textures, white};
use crate::gpu::{Gpu, GpuError};
use crate::mesh::mipmap::MipFilter;
use crate::mesh::{Alpha, Map, MapUv, Material, Sampling, Slot};

/// Where the bindings of the light from all around begin in the group of a lit material; the same in `shaders/environment.wgsl`.
const LIGHT_BINDING: u32 = 16;
/// The binding of the lights of the file; the same in `shaders/draw_material.wgsl`.
const FILE_LIGHTS_BINDING: u32 = 20;

/// Where the bindings of the images go on that have no room below the light's; the same in `shaders/draw_material.wgsl`.
const LATER_IMAGES_BINDING: u32 = 21;

/// Images of a material: that of the base colour, and the maps.
const IMAGES: usize = 1 + Slot::COUNT;
/// How many of them have their bindings below the light's.
const EARLY_IMAGES: usize = 6;

/// What the materials of all scenes share: layouts, samplers and a white texture.
pub struct Materials {
    /// Of the base colour's constants, texture and sampler.
    pub layout: wgpu::BindGroupLayout,
    /// Of everything, and the light.
    pub lit_layout: wgpu::BindGroupLayout,
    /// For what has no image.
    white: wgpu::TextureView,
    /// For a mesh without lights.
    no_lights: wgpu::Buffer,
    samplers: Samplers,
    pub(super) mipmaps: Mipmaps,
}

/// A material on the device.
#[derive(Clone)]
pub struct UploadedMaterial {
    /// Its base colour.
    pub group: wgpu::BindGroup,
    constants: wgpu::Buffer,
    images: [(wgpu::TextureView, wgpu::Sampler); IMAGES],
}

impl Materials {
    pub fn new(gpu: &Gpu) -> Self {
        let own = |images| [vec![uniform_entry(0)], image_entries(images)].concat();
        let lights = [Environment::layout_entries(LIGHT_BINDING).to_vec(), vec![uniform_entry(FILE_LIGHTS_BINDING)]];
        Self {
            layout: bind_group_layout(gpu, "material", &own(1)),
            lit_layout: bind_group_layout(gpu, "lit material", &[own(IMAGES), lights.concat()].concat()),
            white: white(gpu),
            no_lights: upload_lights(gpu, &[]),
            samplers: Samplers::default(),
            mipmaps: Mipmaps::new(),
        }
    }

    /// Uploads materials. An image that several of them use in the same way is uploaded once.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub fn upload(&self, gpu: &Gpu, materials: &[Material]) -> Result<Vec<UploadedMaterial>, GpuError> {
        let mut textures = Textures::default();
        materials.iter().map(|material| self.upload_one(gpu, material, &mut textures)).collect()
    }

    fn upload_one(
        &self,
        gpu: &Gpu,
        material: &Material,
        textures: &mut Textures,
    ) -> Result<UploadedMaterial, GpuError> {
        let constants = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("material"),
            contents: bytemuck::bytes_of(&constants(material)),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let sampler = |sampling| self.samplers.get(gpu, sampling);
        let mut images = std::array::from_fn(|_| (self.white.clone(), sampler(Sampling::default())));
        if let Some(texture) = &material.texture {
            let view = textures.view(gpu, &self.mipmaps, texture, ImageUse::base_color(material))?;
            images[0] = (view, sampler(material.sampling));
        }
        for slot in Slot::ALL {
            if let Some(map) = &material.look.maps[slot as usize] {
                let view = textures.view(gpu, &self.mipmaps, &map.texture, ImageUse::of(MipFilter::of_map(slot)))?;
                images[1 + slot as usize] = (view, sampler(map.sampling));
            }
        }
        let entries = [vec![entry(0, constants.as_entire_binding())], entries_of(&images[..1])].concat();
        let group = bind_group(gpu, "material", &self.layout, &entries);
        Ok(UploadedMaterial { group, constants, images })
    }

    /// The bind groups of materials that a light shines on, and the lights of a file, if there are any.
    pub(super) fn lit_groups(
        &self,
        gpu: &Gpu,
        materials: &[UploadedMaterial],
        (environment, surroundings): (&Environment, &wgpu::Buffer),
        lights: Option<&wgpu::Buffer>,
    ) -> Vec<wgpu::BindGroup> {
        let lights = entry(FILE_LIGHTS_BINDING, lights.unwrap_or(&self.no_lights).as_entire_binding());
        let light = [&environment.entries(LIGHT_BINDING, surroundings)[..], &[lights]].concat();
        let group = |own: &UploadedMaterial| {
            let constants = vec![entry(0, own.constants.as_entire_binding())];
            let entries = [constants, entries_of(&own.images), light.clone()].concat();
            bind_group(gpu, "lit material", &self.lit_layout, &entries)
        };
        materials.iter().map(group).collect()
    }
}

/// The constants that shaders read of a material.
fn constants(material: &Material) -> layout::Material {
    let look = &material.look;
    let has_normals = look.maps[Slot::Normal as usize].is_some();
    layout::Material {
        base_color: material.base_color,
        emissive: look.emissive,
        metallic: look.metallic,
        specular_color: look.specular_color,
        roughness: look.roughness,
        ior: look.ior,
        specular: look.specular,
        coat: look.clearcoat,
        coat_roughness: look.clearcoat_roughness,
        normal_scale: if has_normals { look.normal_scale } else { 0.0 },
        occlusion_strength: look.occlusion_strength,
        cutoff: match look.alpha {
            Alpha::Opaque => f32::NEG_INFINITY,
            Alpha::Mask(cutoff) => cutoff,
            Alpha::Blend => 1.0 - LEAST_SEEN,
        },
        unlit: f32::from(u8::from(look.unlit)),
        blends: f32::from(u8::from(look.alpha == Alpha::Blend)),
        transmission: if look.transmits() { look.transmission } else { 0.0 },
        _pad: [0.0; 2],
        sheen_color: if look.has_sheen() { look.sheen_color } else { [0.0; 3] },
        sheen_roughness: look.sheen_roughness,
        maps: look.maps.each_ref().map(|map| map_place(map.as_ref())),
    }
}

fn map_place(map: Option<&Map>) -> MapPlace {
    match map.map(|map| map.uv) {
        None | Some(MapUv::Own) => MapPlace { u: [1.0, 0.0, 0.0, 0.0], v: [0.0, 1.0, 0.0, 0.0] },
        Some(MapUv::Set(set, [a, b, c, d, e, f])) => {
            MapPlace { u: [a, b, c, if set == 0 { 1.0 } else { 2.0 }], v: [d, e, f, 0.0] }
        }
    }
}

fn uniform_entry(binding: u32) -> wgpu::BindGroupLayoutEntry {
    let ty = wgpu::BufferBindingType::Uniform;
    layout_entry(binding, wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None })
}

/// A texture and a sampler for each of so many images.
fn image_entries(images: usize) -> Vec<wgpu::BindGroupLayoutEntry> {
    let texture = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: true },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
    let both = std::iter::repeat_n([texture, sampler], images).flatten();
    image_bindings().zip(both).map(|(binding, ty)| layout_entry(binding, ty)).collect()
}

/// The bindings of textures and samplers.
fn image_bindings() -> impl Iterator<Item = u32> {
    (1..=2 * EARLY_IMAGES as u32).chain(LATER_IMAGES_BINDING..)
}

fn layout_entry(binding: u32, ty: wgpu::BindingType) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::FRAGMENT, ty, count: None }
}

fn bind_group_layout(gpu: &Gpu, label: &str, entries: &[wgpu::BindGroupLayoutEntry]) -> wgpu::BindGroupLayout {
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries })
}

fn entry(binding: u32, resource: wgpu::BindingResource<'_>) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry { binding, resource }
}

/// The entries of [`image_entries`].
fn entries_of(images: &[(wgpu::TextureView, wgpu::Sampler)]) -> Vec<wgpu::BindGroupEntry<'_>> {
    let both = images.iter().flat_map(|(view, sampler)| {
        [wgpu::BindingResource::TextureView(view), wgpu::BindingResource::Sampler(sampler)]
    });
    image_bindings().zip(both).map(|(binding, resource)| entry(binding, resource)).collect()
}

fn bind_group(
    gpu: &Gpu,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    entries: &[wgpu::BindGroupEntry],
) -> wgpu::BindGroup {
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(label), layout, entries })
}

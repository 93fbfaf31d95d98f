//! Materials on the device: their constants, images and samplers.

use std::collections::HashMap;
use std::sync::Mutex;

use super::environment::Environment;
use super::group_layouts::{Binding, FRAGMENT, IMAGE, SAMPLER, UNIFORM, depths, group_layout};
use super::layout::{self, LEAST_SEEN, MapPlace};
use super::mipmap_pass::Mipmaps;
use super::needs::BEHIND;
use super::punctual::upload_lights;
use super::textures::{ImageUse, Textures, sampler, white};
use geometry::mesh::mipmap::MipFilter;
use geometry::mesh::{Alpha, Look, Map, MapUv, Material, Sampling, Slot, Wrap};
use gpu::shader_constants::image_binding;
use gpu::{Gpu, GpuError, bind_group, made_once, uniform_buffer};

/// Where the bindings of the light from all around begin in the group of a lit material; the same in `shaders/environment.wgsl`.
const LIGHT_BINDING: u32 = 16;
/// The binding of the lights of the file; the same in `shaders/draw_material.wgsl`.
const FILE_LIGHTS_BINDING: u32 = 20;

/// The binding of the depths of what hides everything behind it, where layers are found; the same in `shaders/layers_single.wgsl` and
/// `shaders/layers_multisampled.wgsl`.
const HIDING_DEPTHS_BINDING: u32 = 35;

/// Images of a shader: that of the base colour, and the places for others.
const IMAGES: usize = 1 + Look::MOST_IMAGES;

/// What the materials of all scenes share: layouts, samplers and a white texture.
pub struct Materials {
    /// Of the base colour's constants, texture and sampler.
    pub layout: wgpu::BindGroupLayout,
    /// Of everything, and the light. With the depths of the layer that was found last, shaders then have as many images as WebGPU
    /// allows.
    pub lit_layout: wgpu::BindGroupLayout,
    /// Of what finds layers, without light.
    pub found_layout: wgpu::BindGroupLayout,
    /// For what has no image.
    white: wgpu::TextureView,
    /// For a mesh without lights.
    no_lights: wgpu::Buffer,
    /// One for each way in which images are sampled.
    samplers: Mutex<HashMap<Sampling, wgpu::Sampler>>,
    pub(super) mipmaps: Mipmaps,
}

/// A material on the device.
#[derive(Clone)]
pub struct UploadedMaterial {
    /// Its base colour.
    pub group: wgpu::BindGroup,
    constants: wgpu::Buffer,
    /// That of the base colour, those of all slots, and one in place of what is [`BEHIND`].
    images: [Image; 2 + Slot::COUNT],
}

/// An image, and how it is sampled.
type Image = (wgpu::TextureView, wgpu::Sampler);

/// A material, and the images that its shader has places for: see [`Needs::maps`](super::needs::Needs::maps).
pub(super) type PlacedMaterial<'a> = (&'a UploadedMaterial, u32);

impl Materials {
    pub fn new(gpu: &Gpu) -> Self {
        let depths = [(HIDING_DEPTHS_BINDING, FRAGMENT, depths(gpu))];
        let lights = [&Environment::bindings(LIGHT_BINDING)[..], &[(FILE_LIGHTS_BINDING, FRAGMENT, UNIFORM)]].concat();
        let lit = [user_bindings(IMAGES), lights].concat();
        let found = [&user_bindings(IMAGES)[..], &depths].concat();
        Self {
            layout: group_layout(gpu, "material", &user_bindings(1)),
            lit_layout: group_layout(gpu, "lit material", &lit),
            found_layout: group_layout(gpu, "found material", &found),
            white: white(gpu),
            no_lights: upload_lights(gpu, &[]),
            samplers: Mutex::default(),
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
        let constants = uniform_buffer(gpu, "material", bytemuck::bytes_of(&constants(material)));
        let sampler = |sampling| made_once(&self.samplers, sampling, || sampler(gpu, sampling));
        let mut images = std::array::from_fn(|_| (self.white.clone(), sampler(Sampling::default())));
        images[1 + BEHIND].1 = sampler(Sampling { wrap: [Wrap::Clamp; 2], ..Sampling::default() });
        if let Some(texture) = &material.texture {
            let view = textures.view(gpu, &self.mipmaps, texture, ImageUse::base_color(material))?;
            images[0] = (view, sampler(material.sampling));
        }
        for slot in Slot::ALL {
            if let Some(map) = &material.look.maps[slot as usize] {
                let view = textures.view(gpu, &self.mipmaps, &map.texture, ImageUse::new(MipFilter::from_map(slot)))?;
                images[1 + slot as usize] = (view, sampler(map.sampling));
            }
        }
        let group = bind_group(gpu, "material", &self.layout, own_bound(&constants, &images[..1]));
        Ok(UploadedMaterial { group, constants, images })
    }

    /// The bind groups of materials that a light shines on, and the lights of a file, if there are any; and a picture of what is
    /// behind layers that distort it.
    pub(super) fn lit_groups(
        &self,
        gpu: &Gpu,
        materials: &[PlacedMaterial],
        environment: &Environment,
        surroundings: &wgpu::Buffer,
        lights: Option<&wgpu::Buffer>,
        behind: Option<&wgpu::TextureView>,
    ) -> Vec<wgpu::BindGroup> {
        let lights = (FILE_LIGHTS_BINDING, lights.unwrap_or(&self.no_lights).as_entire_binding());
        let light = [&environment.bound(LIGHT_BINDING, surroundings)[..], &[lights]].concat();
        let group = |&(own, maps): &PlacedMaterial| {
            let images = own.placed(maps, behind);
            let bound = [own_bound(&own.constants, &images), light.clone()].concat();
            bind_group(gpu, "lit material", &self.lit_layout, bound)
        };
        materials.iter().map(group).collect()
    }

    /// The bind groups of materials for passes that find layers before what hides everything behind it, which has these depths.
    pub(super) fn found_groups(
        &self,
        gpu: &Gpu,
        materials: &[PlacedMaterial],
        hiding: &wgpu::TextureView,
    ) -> Vec<wgpu::BindGroup> {
        let depths = [(HIDING_DEPTHS_BINDING, wgpu::BindingResource::TextureView(hiding))];
        let group = |&(own, maps): &PlacedMaterial| {
            let images = own.placed(maps, None);
            let bound = [&own_bound(&own.constants, &images)[..], &depths].concat();
            bind_group(gpu, "found material", &self.found_layout, bound)
        };
        materials.iter().map(group).collect()
    }
}

impl UploadedMaterial {
    /// The images in the places of a shader that has these maps.
    fn placed(&self, maps: u32, behind: Option<&wgpu::TextureView>) -> Vec<Image> {
        let mut images = self.images.clone();
        images[1 + BEHIND].0 = behind.unwrap_or(&images[1 + BEHIND].0).clone();
        let base = images[0].clone();
        let own = images.into_iter().enumerate().filter(|(image, _)| *image == 0 || maps >> (image - 1) & 1 == 1);
        // Places without an image aren't read.
        own.map(|(_, image)| image).chain(std::iter::repeat(base)).take(IMAGES).collect()
    }
}

/// The constants that shaders read of a material.
fn constants(material: &Material) -> layout::Material {
    let look = &material.look;
    let scale_of = |slot: Slot, scale: f32| if look.maps[slot as usize].is_some() { scale } else { 0.0 };
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
        normal_scale: scale_of(Slot::Normal, look.normal_scale),
        occlusion_strength: look.occlusion_strength,
        cutoff: match look.alpha {
            Alpha::Opaque => f32::NEG_INFINITY,
            Alpha::Mask(cutoff) => cutoff,
            Alpha::Blend => 1.0 - LEAST_SEEN,
        },
        unlit: f32::from(u8::from(look.unlit)),
        blends: f32::from(u8::from(look.alpha == Alpha::Blend)),
        transmission: if look.transmits() { look.transmission } else { 0.0 },
        coat_normal_scale: scale_of(Slot::ClearcoatNormal, look.clearcoat_normal_scale),
        anisotropy: if look.has_anisotropy() { look.anisotropy } else { 0.0 },
        sheen_color: if look.has_sheen() { look.sheen_color } else { [0.0; 3] },
        sheen_roughness: look.sheen_roughness,
        absorption: look.absorption(),
        thickness: look.thickness,
        anisotropy_direction: glam::Vec2::from_angle(look.anisotropy_rotation).to_array(),
        _pad: [0.0; 2],
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

/// The constants, and a texture and a sampler for each of so many images.
fn user_bindings(images: usize) -> Vec<Binding> {
    let both = (0..images).map(binding_of);
    let both = both.flat_map(|binding| [(binding, FRAGMENT, IMAGE), (binding + 1, FRAGMENT, SAMPLER)]);
    std::iter::once((0, FRAGMENT, UNIFORM)).chain(both).collect()
}

/// The binding of an image: the first is that of the base colour. That of its sampler comes next.
fn binding_of(image: usize) -> u32 {
    image.checked_sub(1).map_or(1, image_binding)
}

/// What is bound at [`user_bindings`].
fn own_bound<'a>(constants: &'a wgpu::Buffer, images: &'a [Image]) -> Vec<(u32, wgpu::BindingResource<'a>)> {
    let both = images.iter().enumerate().flat_map(|(image, (view, sampler))| {
        let binding = binding_of(image);
        let view = wgpu::BindingResource::TextureView(view);
        [(binding, view), (binding + 1, wgpu::BindingResource::Sampler(sampler))]
    });
    std::iter::once((0, constants.as_entire_binding())).chain(both).collect()
}

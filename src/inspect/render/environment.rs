//! Light from all around: what `shaders/environment.wgsl` reads.

use bytemuck::{Pod, Zeroable};
use glam::{Mat3, Vec3};
use half::f16;
use wgpu::util::DeviceExt;

use super::blur_levels::ENVIRONMENT_LEVELS;
use super::cube_map::CubeMap;
use super::dfg::{DFG_SIZE, dfg_table};
use super::group_layouts::{Binding, FRAGMENT, IMAGE, SAMPLER, UNIFORM, image};
use super::irradiance::{Irradiance, irradiance};
use super::prefilter_pass::{cube_view, prefilter};
use super::studio::studio_light;
use super::textures::linear_sampler;
use crate::settings::ToneCurve;
use gpu::{Gpu, GpuError, Lazy, WgslModule, filled_texture, flat_texture, uniform_buffer};
use load::panorama::Panorama;

/// A shader module that has it binds [`Environment::bound`] in group 1 from binding 16 on.
pub const ENVIRONMENT: WgslModule = WgslModule("environment");

/// The binding of the `Surroundings` in `shaders/environment.wgsl`.
const SURROUNDINGS_BINDING: u32 = 19;

/// Width of a face of the cube map's first level, in texels.
pub(crate) const ENVIRONMENT_SIZE: u32 = 128;

/// Width and height of the studio's panorama, in px. Its soft boxes have edges that are five px wide.
const STUDIO_SIZE: [u32; 2] = [512, 256];

/// Four half floats a texel.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// Twin of `Surroundings` in `shaders/environment.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Surroundings {
    /// The coefficients that `irradiance` makes; the fourth component is unused.
    pub irradiance: [[f32; 4]; 9],
    /// Turns a direction in object space into the light's own. The fourth component is unused.
    pub light_from_object: [[f32; 4]; 3],
    /// Factor of all light.
    pub brightness: f32,
    /// Factor of what the camera sees.
    pub exposure: f32,
    /// `TONE_CURVE_*` in `shaders/tone.wgsl`.
    pub tone_curve: u32,
    pub _pad: u32,
}

/// How an environment is turned and shown.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LightView {
    /// In EV: each doubles the light from all around.
    pub brightness: f32,
    /// By how many degrees the light is turned about +Y, from +Z towards +X.
    pub rotation: f32,
    /// In EV: each doubles what is seen.
    pub exposure: f32,
    pub tone_curve: ToneCurve,
}

/// Light from all around on the device: a cube map, blurred by GGX from level to level; irradiance as spherical harmonics; and
/// the table of directional albedos.
pub struct Environment {
    /// [`ENVIRONMENT_LEVELS`] levels in half floats; the first is a mirror's.
    cube: wgpu::TextureView,
    sampler: wgpu::Sampler,
    dfg: wgpu::TextureView,
    irradiance: Irradiance,
    /// That of a file comes with it; the studio's is made when it is first seen.
    backdrop: Lazy<Backdrop>,
}

/// A panorama on the device, which is seen behind the mesh.
#[derive(Debug)]
pub(crate) struct Backdrop {
    panorama: wgpu::TextureView,
    sampler: wgpu::Sampler,
}

impl Environment {
    /// A photographer's studio, made in code.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub fn studio(gpu: &Gpu) -> Result<Self, GpuError> {
        Self::new(gpu, &CubeMap::new(ENVIRONMENT_SIZE, studio_light))
    }

    /// The light of a panorama.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub fn from_panorama(gpu: &Gpu, panorama: Panorama) -> Result<Self, GpuError> {
        let backdrop = Lazy::default();
        backdrop.get_or_make(gpu, || Backdrop::new(gpu, &panorama))?;
        // A quarter of a turn has at least as many pixels as a face has texels, and at most twice as many.
        let panorama = panorama.reduced(4 * ENVIRONMENT_SIZE as usize);
        let own = Self::new(gpu, &CubeMap::new(ENVIRONMENT_SIZE, |direction| panorama.light_from(direction)))?;
        Ok(Self { backdrop, ..own })
    }

    pub(crate) fn new(gpu: &Gpu, light: &CubeMap) -> Result<Self, GpuError> {
        let irradiance = irradiance(light);
        // The prefilter fills its levels.
        let cube = cube_descriptor(light.size, ENVIRONMENT_LEVELS, wgpu::TextureUsages::STORAGE_BINDING);
        let table: Vec<u8> = dfg_table().iter().flatten().flat_map(|&part| f16::from_f32(part).to_ne_bytes()).collect();
        let (source, cube, dfg, sampler) = gpu.attempt(|| {
            let dfg = filled_texture(gpu, "directional albedo", [DFG_SIZE; 2], FORMAT, &table);
            (upload(gpu, light), gpu.device.create_texture(&cube), dfg, linear_sampler(gpu, "environment"))
        })?;
        prefilter(gpu, &source, &cube, &sampler)?;
        Ok(Self { cube: cube_view(&cube), sampler, dfg, irradiance, backdrop: Lazy::default() })
    }

    /// What is seen behind the mesh.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub(crate) fn backdrop(&self, gpu: &Gpu) -> Result<&Backdrop, GpuError> {
        self.backdrop.get_or_make(gpu, || Backdrop::new(gpu, &Panorama::from_radiance(STUDIO_SIZE, studio_light)))
    }

    /// The `Surroundings` of a picture for which the light is turned and shown like this. Each picture has its own, so that one
    /// that is recorded on another thread doesn't change them.
    pub fn surroundings(&self, gpu: &Gpu, view: &LightView) -> wgpu::Buffer {
        uniform_buffer(gpu, "surroundings", bytemuck::bytes_of(&surroundings(&self.irradiance, view)))
    }

    /// The cube map, its sampler, the table and the `Surroundings`, which fragment shaders read, from this binding on.
    pub(super) fn bindings(first: u32) -> [Binding; 4] {
        let types = [image(wgpu::TextureViewDimension::Cube), SAMPLER, IMAGE, UNIFORM];
        [0, 1, 2, 3].map(|k| (first + k as u32, FRAGMENT, types[k]))
    }

    /// What is bound there, with what [`Self::surroundings`] returns.
    pub fn bound<'a>(&'a self, first: u32, surroundings: &'a wgpu::Buffer) -> [(u32, wgpu::BindingResource<'a>); 4] {
        [
            (first, wgpu::BindingResource::TextureView(&self.cube)),
            (first + 1, wgpu::BindingResource::Sampler(&self.sampler)),
            (first + 2, wgpu::BindingResource::TextureView(&self.dfg)),
            (first + 3, surroundings.as_entire_binding()),
        ]
    }
}

impl Backdrop {
    fn new(gpu: &Gpu, panorama: &Panorama) -> Self {
        let sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("panorama"),
            address_mode_u: wgpu::AddressMode::Repeat,
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        let bytes: Vec<u8> = panorama.pixels().iter().flat_map(|&light| half_floats(light)).collect();
        Self { panorama: filled_texture(gpu, "panorama", panorama.size(), FORMAT, &bytes), sampler }
    }

    /// The panorama, its sampler and the `Surroundings`.
    pub(super) const BINDINGS: [Binding; 3] =
        [(0, FRAGMENT, IMAGE), (1, FRAGMENT, SAMPLER), (SURROUNDINGS_BINDING, FRAGMENT, UNIFORM)];

    /// What is bound there, with what [`Environment::surroundings`] returns.
    pub(super) fn bound<'a>(&'a self, surroundings: &'a wgpu::Buffer) -> [(u32, wgpu::BindingResource<'a>); 3] {
        [
            (0, wgpu::BindingResource::TextureView(&self.panorama)),
            (1, wgpu::BindingResource::Sampler(&self.sampler)),
            (SURROUNDINGS_BINDING, surroundings.as_entire_binding()),
        ]
    }
}

fn surroundings(irradiance: &Irradiance, view: &LightView) -> Surroundings {
    let light_from_object = Mat3::from_rotation_y(-view.rotation.to_radians());
    let padded = |vector: Vec3| vector.extend(0.0).to_array();
    Surroundings {
        irradiance: irradiance.map(padded),
        light_from_object: [light_from_object.x_axis, light_from_object.y_axis, light_from_object.z_axis].map(padded),
        brightness: view.brightness.exp2(),
        exposure: view.exposure.exp2(),
        tone_curve: view.tone_curve as u32,
        _pad: 0,
    }
}

fn cube_descriptor(size: u32, levels: u32, usage: wgpu::TextureUsages) -> wgpu::TextureDescriptor<'static> {
    let face = flat_texture("environment", [size; 2], FORMAT, usage | wgpu::TextureUsages::TEXTURE_BINDING);
    let size = wgpu::Extent3d { depth_or_array_layers: 6, ..face.size };
    wgpu::TextureDescriptor { size, mip_level_count: levels, ..face }
}

/// The bytes of a pixel in half floats, whose largest number is 65,504.
fn half_floats(light: Vec3) -> [u8; 8] {
    bytemuck::cast(light.min(Vec3::splat(65504.0)).extend(1.0).to_array().map(|value| f16::from_f32(value).to_bits()))
}

/// Uploads all levels.
fn upload(gpu: &Gpu, light: &CubeMap) -> wgpu::Texture {
    let mut bytes: Vec<u8> = Vec::new();
    for face in 0..6 {
        for level in &light.levels {
            let of_face = level.len() / 6;
            let pixels = level[face * of_face..(face + 1) * of_face].iter();
            bytes.extend(pixels.flat_map(|&light| half_floats(light)));
        }
    }
    let descriptor = cube_descriptor(light.size, light.levels.len() as u32, wgpu::TextureUsages::empty());
    gpu.device.create_texture_with_data(&gpu.queue, &descriptor, wgpu::util::TextureDataOrder::LayerMajor, &bytes)
}

//! Light from all around: what `shaders/environment.wgsl` reads.

use bytemuck::{Pod, Zeroable};
use glam::{Mat3, Vec3};
use half::f16;
use wgpu::util::DeviceExt;

use super::blur_levels::ENVIRONMENT_LEVELS;
use super::cube_map::CubeMap;
use super::dfg::{DFG_SIZE, dfg_table};
use super::group_layouts::{Binding, FRAGMENT, IMAGE, SAMPLER, UNIFORM, image};
use super::irradiance::{LightPart, light_parts};
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

impl LightView {
    /// The `Surroundings` of a picture. Each has its own, so that one that is recorded on another thread doesn't change them.
    pub fn surroundings(&self, gpu: &Gpu) -> wgpu::Buffer {
        let turn = Mat3::from_rotation_y(-self.rotation.to_radians());
        let surroundings = Surroundings {
            light_from_object: [turn.x_axis, turn.y_axis, turn.z_axis].map(|axis| axis.extend(0.0).to_array()),
            brightness: self.brightness.exp2(),
            exposure: self.exposure.exp2(),
            tone_curve: self.tone_curve as u32,
            _pad: 0,
        };
        uniform_buffer(gpu, "surroundings", bytemuck::bytes_of(&surroundings))
    }
}

/// Light from all around on the device: a cube map, blurred by GGX from level to level; one of irradiance; and the table of
/// directional albedos.
pub struct Environment {
    /// [`ENVIRONMENT_LEVELS`] levels in half floats, the first of which is a mirror's; and a second cube, which has irradiance.
    cubes: wgpu::TextureView,
    sampler: wgpu::Sampler,
    dfg: wgpu::TextureView,
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
        let light = CubeMap::new(ENVIRONMENT_SIZE, studio_light);
        Self::new(gpu, &light, &light_parts(light.lights()))
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
        let light = CubeMap::new(ENVIRONMENT_SIZE, |direction| panorama.light_from(direction));
        // The map may miss some of a sun that is as small as a pixel. Large pixels aren't lights, but are blended.
        let is_fine = panorama.size()[1] >= ENVIRONMENT_SIZE;
        let parts = if is_fine { light_parts(panorama.lights()) } else { light_parts(light.lights()) };
        let own = Self::new(gpu, &light, &parts)?;
        Ok(Self { backdrop, ..own })
    }

    pub(crate) fn new(gpu: &Gpu, light: &CubeMap, parts: &[LightPart]) -> Result<Self, GpuError> {
        let blurred = cube_texture(light.size, 2, ENVIRONMENT_LEVELS, wgpu::TextureUsages::STORAGE_BINDING);
        let (cubes, sampler) = (|| gpu.device.create_texture(&blurred), || linear_sampler(gpu, "environment"));
        let (source, cubes, dfg, sampler) =
            gpu.attempt(|| (upload(gpu, light), cubes(), upload_dfg(gpu), sampler()))?;
        prefilter(gpu, &source, parts, &cubes, &sampler)?;
        Ok(Self { cubes: cube_view(&cubes), sampler, dfg, backdrop: Lazy::default() })
    }

    /// What is seen behind the mesh.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub(crate) fn backdrop(&self, gpu: &Gpu) -> Result<&Backdrop, GpuError> {
        self.backdrop.get_or_make(gpu, || Backdrop::new(gpu, &Panorama::from_radiance(STUDIO_SIZE, studio_light)))
    }

    /// The cubes, their sampler, the table and the `Surroundings`, which fragment shaders read, from this binding on.
    pub(super) fn bindings(first: u32) -> [Binding; 4] {
        let types = [image(wgpu::TextureViewDimension::CubeArray), SAMPLER, IMAGE, UNIFORM];
        [0, 1, 2, 3].map(|k| (first + k as u32, FRAGMENT, types[k]))
    }

    /// What is bound there, with what [`LightView::surroundings`] returns.
    pub fn bound<'a>(&'a self, first: u32, surroundings: &'a wgpu::Buffer) -> [(u32, wgpu::BindingResource<'a>); 4] {
        [
            (first, wgpu::BindingResource::TextureView(&self.cubes)),
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

    /// What is bound there, with what [`LightView::surroundings`] returns.
    pub(super) fn bound<'a>(&'a self, surroundings: &'a wgpu::Buffer) -> [(u32, wgpu::BindingResource<'a>); 3] {
        [
            (0, wgpu::BindingResource::TextureView(&self.panorama)),
            (1, wgpu::BindingResource::Sampler(&self.sampler)),
            (SURROUNDINGS_BINDING, surroundings.as_entire_binding()),
        ]
    }
}

/// What to say of a texture of so many cubes.
fn cube_texture(size: u32, count: u32, levels: u32, usage: wgpu::TextureUsages) -> wgpu::TextureDescriptor<'static> {
    let face = flat_texture("environment", [size; 2], FORMAT, usage | wgpu::TextureUsages::TEXTURE_BINDING);
    let size = wgpu::Extent3d { depth_or_array_layers: 6 * count, ..face.size };
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
    let descriptor = cube_texture(light.size, 1, light.levels.len() as u32, wgpu::TextureUsages::empty());
    gpu.device.create_texture_with_data(&gpu.queue, &descriptor, wgpu::util::TextureDataOrder::LayerMajor, &bytes)
}

fn upload_dfg(gpu: &Gpu) -> wgpu::TextureView {
    let bytes: Vec<u8> = dfg_table().iter().flatten().flat_map(|&part| f16::from_f32(part).to_ne_bytes()).collect();
    filled_texture(gpu, "directional albedo", [DFG_SIZE; 2], FORMAT, &bytes)
}

//! The pipelines that paint the largest areas of a window: its background, and the picture that a target holds. The window's
//! library could paint both, but its shader has a branch for each filter and each way to wrap, and a software driver computes
//! all of them for every pixel. That takes longer than most pictures.

use super::Target;
use super::group_layouts::{FRAGMENT, IMAGE, SAMPLER, group_layout};
use super::render_pipeline::PipelineParts;
use gpu::{Gpu, GpuError, ShaderModule, bind_group};

/// The pipelines for windows whose textures have one format. Each draws 3 vertices, without blending.
pub struct WindowPipelines {
    format: wgpu::TextureFormat,
    /// The number of the instance is the colour: 8 bits each for red, green and blue, red the lowest.
    pub fill: wgpu::RenderPipeline,
    /// Group 0 is from [`Self::shown`].
    pub picture: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
}

impl WindowPipelines {
    /// # Errors
    /// Out of memory, or a lost device.
    pub fn new(gpu: &Gpu, format: wgpu::TextureFormat) -> Result<Self, GpuError> {
        let module = ShaderModule::new("draw_window");
        let module = module.get(gpu)?;
        gpu.attempt(|| {
            let layout = group_layout(gpu, "window", &[(0, FRAGMENT, IMAGE), (1, FRAGMENT, SAMPLER)]);
            let fill = pipeline(gpu, module, format, ["fill_vertex", "fill_fragment"], &[]);
            let entry_points = ["picture_vertex", "picture_fragment"];
            let picture = pipeline(gpu, module, format, entry_points, &[Some(&layout)]);
            Self { format, fill, picture, layout }
        })
    }

    /// Binds the picture of a target.
    pub fn shown(&self, gpu: &Gpu, target: &Target, filter: wgpu::FilterMode) -> wgpu::BindGroup {
        let sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("window"),
            mag_filter: filter,
            min_filter: filter,
            ..Default::default()
        });
        let view = target.shown_view(self.format.is_srgb());
        let picture = wgpu::BindingResource::TextureView(&view);
        let bound = [(0, picture), (1, wgpu::BindingResource::Sampler(&sampler))];
        bind_group(gpu, "window", &self.layout, bound)
    }
}

fn pipeline(
    gpu: &Gpu,
    module: &wgpu::ShaderModule,
    format: wgpu::TextureFormat,
    entry_points: [&str; 2],
    layouts: &[Option<&wgpu::BindGroupLayout>],
) -> wgpu::RenderPipeline {
    let constants = vec![("window_encodes", f64::from(u8::from(format.is_srgb())))];
    let parts = PipelineParts::new(module, entry_points, Some(format.into()));
    PipelineParts { constants, layouts: Some(layouts.to_vec()), ..parts }.pipeline(gpu)
}

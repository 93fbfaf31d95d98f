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
            let pipeline = |entry_points, layouts| {
                let constants = vec![("window_encodes", f64::from(u8::from(format.is_srgb())))];
                let parts = PipelineParts::new(module, entry_points, Some(format.into()));
                PipelineParts { constants, layouts: Some(layouts), ..parts }.pipeline(gpu)
            };
            let fill = pipeline(["fill_vertex", "fill_fragment"], vec![]);
            let picture = pipeline(["picture_vertex", "picture_fragment"], vec![Some(&layout)]);
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

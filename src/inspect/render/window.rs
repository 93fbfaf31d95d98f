//! The pipelines that paint the largest areas of a window: its background, and the picture that a target holds. The window's
//! library could paint both, but its shader has a branch for each filter and each way to wrap, and a software driver computes
//! all of them for every pixel. That takes longer than most pictures.

use super::Target;
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
            let layout = picture_layout(gpu);
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

fn picture_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let entry =
        |binding, ty| wgpu::BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::FRAGMENT, ty, count: None };
    let texture = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: true },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("window"),
        entries: &[entry(0, texture), entry(1, sampler)],
    })
}

fn pipeline(
    gpu: &Gpu,
    module: &wgpu::ShaderModule,
    format: wgpu::TextureFormat,
    [vertex, fragment]: [&str; 2],
    layouts: &[Option<&wgpu::BindGroupLayout>],
) -> wgpu::RenderPipeline {
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(vertex),
        bind_group_layouts: layouts,
        ..Default::default()
    });
    let constants = [("window_encodes", f64::from(u8::from(format.is_srgb())))];
    let compilation_options = wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() };
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(vertex),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(vertex),
            compilation_options: compilation_options.clone(),
            buffers: &[],
        },
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(fragment),
            compilation_options,
            targets: &[Some(format.into())],
        }),
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        multiview_mask: None,
        cache: None,
    })
}

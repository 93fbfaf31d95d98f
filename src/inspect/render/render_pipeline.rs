//! How pipelines that draw triangles are made.

use super::target::DEPTH_FORMAT;
use gpu::Gpu;

/// What a pipeline is made of. What isn't set is as in [`Self::new`].
pub(super) struct PipelineParts<'a> {
    pub module: &'a wgpu::ShaderModule,
    /// The vertex and the fragment shader.
    pub entry_points: [&'a str; 2],
    pub target: Option<wgpu::ColorTargetState>,
    /// Values of the module's constants.
    pub constants: Vec<(&'a str, f64)>,
    /// None for those that the shaders ask for.
    pub layouts: Option<Vec<Option<&'a wgpu::BindGroupLayout>>>,
    pub vertex_buffers: Vec<Option<wgpu::VertexBufferLayout<'a>>>,
    pub cull_mode: Option<wgpu::Face>,
    pub depth: Option<wgpu::DepthStencilState>,
    pub samples: u32,
}

impl<'a> PipelineParts<'a> {
    /// Without constants, vertex buffers, culling and depth, and with one sample a pixel.
    pub(super) fn new(
        module: &'a wgpu::ShaderModule,
        entry_points: [&'a str; 2],
        target: Option<wgpu::ColorTargetState>,
    ) -> Self {
        Self {
            module,
            entry_points,
            target,
            constants: Vec::new(),
            layouts: None,
            vertex_buffers: Vec::new(),
            cull_mode: None,
            depth: None,
            samples: 1,
        }
    }

    pub(super) fn pipeline(self, gpu: &Gpu) -> wgpu::RenderPipeline {
        let (module, [vertex, fragment], target) = (self.module, self.entry_points, [self.target]);
        let compilation_options = wgpu::PipelineCompilationOptions { constants: &self.constants, ..Default::default() };
        let layout = self.layouts.map(|layouts| {
            gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(vertex),
                bind_group_layouts: &layouts,
                ..Default::default()
            })
        });
        gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(vertex),
            layout: layout.as_ref(),
            vertex: wgpu::VertexState {
                module,
                entry_point: Some(vertex),
                compilation_options: compilation_options.clone(),
                buffers: &self.vertex_buffers,
            },
            primitive: wgpu::PrimitiveState { cull_mode: self.cull_mode, ..Default::default() },
            depth_stencil: self.depth,
            multisample: wgpu::MultisampleState { count: self.samples, ..Default::default() },
            fragment: Some(wgpu::FragmentState {
                module,
                entry_point: Some(fragment),
                compilation_options,
                targets: if target[0].is_some() { &target } else { &[] },
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// Depths that are tested, and written or not.
pub(super) fn depth_state(is_written: bool, compare: wgpu::CompareFunction) -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format: DEPTH_FORMAT,
        depth_write_enabled: Some(is_written),
        depth_compare: Some(compare),
        stencil: wgpu::StencilState::default(),
        bias: wgpu::DepthBiasState::default(),
    }
}

/// A sum of what is drawn and what is there, with these factors: of what is drawn, and of the colour and the alpha there.
pub(super) fn blended(
    drawn: wgpu::BlendFactor,
    color: wgpu::BlendFactor,
    alpha: wgpu::BlendFactor,
) -> wgpu::BlendState {
    let component =
        |there| wgpu::BlendComponent { src_factor: drawn, dst_factor: there, operation: wgpu::BlendOperation::Add };
    wgpu::BlendState { color: component(color), alpha: component(alpha) }
}

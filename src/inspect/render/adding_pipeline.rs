//! The pipeline of draws that add something at every sample that an emitted triangle covers, without depth.

use gpu::{Gpu, VERTEX_HALF};

/// What such a draw adds, and to which texture.
pub(super) struct Adding {
    pub(super) label: &'static str,
    /// Entry points of the vertex and the fragment shader.
    pub(super) entry_points: [&'static str; 2],
    pub(super) format: wgpu::TextureFormat,
    /// What the fragment shader's value is multiplied by.
    pub(super) factor: wgpu::BlendFactor,
    pub(super) channels: wgpu::ColorWrites,
}

impl Adding {
    /// The vertex shader gets positions in object units at location 0.
    pub(super) fn pipeline(self, gpu: &Gpu, module: &wgpu::ShaderModule) -> wgpu::RenderPipeline {
        let add = wgpu::BlendComponent {
            src_factor: self.factor,
            dst_factor: wgpu::BlendFactor::One,
            operation: wgpu::BlendOperation::Add,
        };
        let vertex = wgpu::VertexBufferLayout {
            array_stride: VERTEX_HALF,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &wgpu::vertex_attr_array![0 => Float32x3],
        };
        gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(self.label),
            layout: None,
            vertex: wgpu::VertexState {
                module,
                entry_point: Some(self.entry_points[0]),
                compilation_options: Default::default(),
                buffers: &[Some(vertex)],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: None,
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module,
                entry_point: Some(self.entry_points[1]),
                compilation_options: Default::default(),
                targets: &[Some(wgpu::ColorTargetState {
                    format: self.format,
                    blend: Some(wgpu::BlendState { color: add, alpha: add }),
                    write_mask: self.channels,
                })],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

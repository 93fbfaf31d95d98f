//! What draws are made of: bind group layouts, and pipelines by what they draw and what hides it.

use crate::gpu::{COLOR_FORMAT, DEPTH_FORMAT, Gpu};

/// The frame, points, corners, patches, the arena's vertices and indices, and the frame again as a uniform.
pub fn scene_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let both = wgpu::ShaderStages::VERTEX_FRAGMENT;
    let mut entries = vec![buffer_entry(0, READ, both)];
    entries.extend((1..6).map(|binding| buffer_entry(binding, READ, wgpu::ShaderStages::VERTEX)));
    entries.push(buffer_entry(6, wgpu::BufferBindingType::Uniform, both));
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("scene"), entries: &entries })
}

/// The slab that a chunk is of, and its patches' factors.
pub fn chunk_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let entries = [(0, wgpu::BufferBindingType::Uniform), (1, READ)]
        .map(|(binding, ty)| buffer_entry(binding, ty, wgpu::ShaderStages::VERTEX));
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("chunk"), entries: &entries })
}

/// How far a chunk's triangles are from the truth.
pub fn deviation_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let entries = [buffer_entry(0, READ, wgpu::ShaderStages::FRAGMENT)];
    gpu.device
        .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("deviation"), entries: &entries })
}

const READ: wgpu::BufferBindingType = wgpu::BufferBindingType::Storage { read_only: true };

fn buffer_entry(
    binding: u32,
    ty: wgpu::BufferBindingType,
    visibility: wgpu::ShaderStages,
) -> wgpu::BindGroupLayoutEntry {
    let ty = wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None }
}

pub fn material_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
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

/// What a pipeline draws, and what hides it.
#[derive(Clone, Copy, PartialEq)]
pub enum Layer {
    /// Opaque, in depth.
    Surface,
    /// The same without what faces away.
    Fronts,
    /// Blended, whatever is in front.
    Everywhere,
    /// Blended, where nothing is in front.
    InSight,
}

pub fn pipeline(
    gpu: &Gpu,
    layouts: &[Option<&wgpu::BindGroupLayout>],
    module: &wgpu::ShaderModule,
    (vertex, fragment): (&str, &str),
    buffers: &[Option<wgpu::VertexBufferLayout>],
    layer: Layer,
) -> wgpu::RenderPipeline {
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(vertex),
        bind_group_layouts: layouts,
        ..Default::default()
    });
    let compare = match layer {
        Layer::Surface | Layer::Fronts | Layer::InSight => wgpu::CompareFunction::Greater,
        Layer::Everywhere => wgpu::CompareFunction::Always,
    };
    let opaque = matches!(layer, Layer::Surface | Layer::Fronts);
    let cull_mode = (layer == Layer::Fronts).then_some(wgpu::Face::Back);
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(vertex),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(vertex),
            compilation_options: Default::default(),
            buffers,
        },
        primitive: wgpu::PrimitiveState { cull_mode, ..Default::default() },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH_FORMAT,
            depth_write_enabled: Some(opaque),
            depth_compare: Some(compare),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState { count: gpu.samples, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(fragment),
            compilation_options: Default::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format: COLOR_FORMAT,
                blend: (!opaque).then_some(wgpu::BlendState::ALPHA_BLENDING),
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}

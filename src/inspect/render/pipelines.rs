//! The pipelines that draw a scene, each made when it is first needed, and their bind group layouts.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use super::draws::{Draw, Shading, SurfaceDraw, Triangles};
use super::environment::Backdrop;
use super::materials::{Materials, depths_entry};
use super::target::samples;
use gpu::{Gpu, GpuError, Lazy, ShaderModule};

/// The pipeline of each [`Draw`], and the layouts of their bind groups.
pub(super) struct DrawPipelines {
    /// Group 0: the frame, points, corners, patches, the arena's vertices and indices, the frame once more as a uniform, curve
    /// nets, the parameters of the passes, and details of corners.
    pub scene_layout: wgpu::BindGroupLayout,
    /// Group 1: a material's constants, texture and sampler.
    material_layout: wgpu::BindGroupLayout,
    /// Group 1 where materials are lit: all of a material, and the light.
    lit_layout: wgpu::BindGroupLayout,
    /// Group 1 of the background: a panorama, its sampler, and how the light is shown.
    pub background_layout: wgpu::BindGroupLayout,
    /// Group 2: the slab of the chunk that is drawn, and the factors of the slab's patches.
    pub chunk_layout: wgpu::BindGroupLayout,
    /// Group 3: what was measured of a chunk's triangles, their distances to the reference surface, and of patches, their own
    /// least.
    pub measured_layout: wgpu::BindGroupLayout,
    /// Group 1 where layers are found: what says where a material shows what is behind it, and the depths of what hides everything
    /// behind it.
    found_layout: wgpu::BindGroupLayout,
    /// Group 3 where layers are drawn: the same, and the depths of the layer that was found last.
    pub layer_layout: wgpu::BindGroupLayout,
    plain: ShaderModule,
    lit: ShaderModule,
    surface: ShaderModule,
    layers: ShaderModule,
    clear: ShaderModule,
    background: ShaderModule,
    ground: ShaderModule,
    lines: ShaderModule,
    pipelines: Mutex<HashMap<Draw, Arc<Lazy<wgpu::RenderPipeline>>>>,
}

impl DrawPipelines {
    /// Makes the layouts. Compiles nothing yet.
    pub(super) fn new(gpu: &Gpu, materials: &Materials) -> Self {
        let is_multisampled = samples(gpu) > 1;
        Self {
            scene_layout: scene_layout(gpu),
            material_layout: materials.layout.clone(),
            lit_layout: materials.lit_layout.clone(),
            found_layout: materials.found_layout.clone(),
            background_layout: background_layout(gpu),
            chunk_layout: chunk_layout(gpu),
            measured_layout: measured_layout(gpu),
            layer_layout: layer_layout(gpu),
            plain: ShaderModule::new("draw_plain"),
            lit: ShaderModule::new("draw_lit"),
            surface: ShaderModule::new("draw_surface"),
            layers: ShaderModule::new(if is_multisampled { "layers_multisampled" } else { "layers_single" }),
            clear: ShaderModule::new("draw_clear"),
            background: ShaderModule::new("draw_background"),
            ground: ShaderModule::new("draw_ground"),
            lines: ShaderModule::new("draw_lines"),
            pipelines: Default::default(),
        }
    }

    /// The pipeline of a draw. It is made at the first call.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub(super) fn get(&self, gpu: &Gpu, draw: Draw) -> Result<wgpu::RenderPipeline, GpuError> {
        let module = match draw {
            Draw::Surface(SurfaceDraw { layer: Some(_), .. }) => &self.layers,
            Draw::Surface(SurfaceDraw { triangles: Triangles::Bare, shading: Shading::Lit(_), .. }) => &self.lit,
            Draw::Surface(SurfaceDraw { triangles: Triangles::Bare, .. }) => &self.plain,
            Draw::Surface(_) => &self.surface,
            Draw::LayerClear { .. } => &self.clear,
            Draw::Background => &self.background,
            Draw::Ground => &self.ground,
            Draw::Lines(_) | Draw::Normals(_) => &self.lines,
        };
        let module = module.get(gpu)?;
        // Nothing is made while the lock is held, so that a picture doesn't wait for pipelines of another.
        let own = self.pipelines.lock().unwrap_or_else(PoisonError::into_inner).entry(draw).or_default().clone();
        own.get_or_make(gpu, || pipeline(gpu, &self.layouts(draw), module, draw)).cloned()
    }

    /// The layouts of the groups that a pipeline binds.
    fn layouts(&self, draw: Draw) -> Vec<Option<&wgpu::BindGroupLayout>> {
        let (scene, chunk) = (Some(&self.scene_layout), Some(&self.chunk_layout));
        match draw {
            Draw::Surface(SurfaceDraw { triangles, shading, layer, .. }) => {
                let material = match (layer, shading) {
                    (Some(layer), _) if layer.finds() => &self.found_layout,
                    (_, Shading::Lit(_)) => &self.lit_layout,
                    _ => &self.material_layout,
                };
                let last = if layer.is_some() { &self.layer_layout } else { &self.measured_layout };
                let has_overlays = layer.is_some() || triangles != Triangles::Bare;
                let chunk = chunk.filter(|_| triangles.have_factors());
                let mut layouts = vec![scene, Some(material)];
                if has_overlays {
                    layouts.extend([chunk, Some(last)]);
                }
                layouts
            }
            Draw::LayerClear { .. } => Vec::new(),
            Draw::Background => vec![scene, Some(&self.background_layout)],
            Draw::Ground | Draw::Lines(_) => vec![scene],
            Draw::Normals(_) => vec![scene, None, chunk],
        }
    }
}

fn scene_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let (vertex, fragment) = (wgpu::ShaderStages::VERTEX, wgpu::ShaderStages::FRAGMENT);
    let mut entries: Vec<_> = (0..4).map(|binding| buffer_entry(binding, READ, vertex | fragment)).collect();
    entries.extend((4..6).map(|binding| buffer_entry(binding, READ, vertex)));
    entries.push(buffer_entry(6, wgpu::BufferBindingType::Uniform, vertex | fragment));
    // Vertex shaders have as many storage buffers as WebGPU allows.
    entries.push(buffer_entry(7, READ, fragment));
    entries.push(buffer_entry(8, wgpu::BufferBindingType::Uniform, fragment));
    entries.push(buffer_entry(9, READ, fragment));
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("scene"), entries: &entries })
}

fn chunk_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let entries = [(0, wgpu::BufferBindingType::Uniform), (1, READ)]
        .map(|(binding, ty)| buffer_entry(binding, ty, wgpu::ShaderStages::VERTEX));
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("chunk"), entries: &entries })
}

fn measured_entries() -> [wgpu::BindGroupLayoutEntry; 2] {
    [buffer_entry(0, READ, wgpu::ShaderStages::FRAGMENT), buffer_entry(1, READ, wgpu::ShaderStages::VERTEX)]
}

fn background_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let entries = Backdrop::layout_entries();
    gpu.device
        .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("background"), entries: &entries })
}

fn measured_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let entries = measured_entries();
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("measured"), entries: &entries })
}

fn layer_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let entries = [&measured_entries()[..], &[depths_entry(gpu, 2)]].concat();
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("layer"), entries: &entries })
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

fn pipeline(
    gpu: &Gpu,
    layouts: &[Option<&wgpu::BindGroupLayout>],
    module: &wgpu::ShaderModule,
    draw: Draw,
) -> wgpu::RenderPipeline {
    let (vertex, fragment) = (draw.vertex_entry(), draw.fragment_entry());
    let constants = draw.constants();
    let color = draw.color_target().map(Some);
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(vertex),
        bind_group_layouts: layouts,
        ..Default::default()
    });
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(vertex),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(vertex),
            compilation_options: wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() },
            buffers: &draw.vertex_buffers(),
        },
        primitive: wgpu::PrimitiveState { cull_mode: draw.cull_mode(), ..Default::default() },
        depth_stencil: Some(draw.depth_stencil()),
        multisample: wgpu::MultisampleState { count: samples(gpu), ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(fragment),
            compilation_options: wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() },
            targets: color.as_slice(),
        }),
        multiview_mask: None,
        cache: None,
    })
}

//! Pipelines that draw a scene, and the one way a picture is drawn.

use wgpu::util::DeviceExt;

use super::layout::{Frame, linear, overlay_bits};
use super::scene::{LineSegment, upload};
use super::{Camera, Scene, Target};
use crate::gpu::layout::Vertex;
use crate::gpu::{COLOR_FORMAT, ChunkBuffers, DEPTH_FORMAT, Gpu, Recorder};
use crate::mesh::Texture;
use crate::settings::Settings;

/// Long-lived: one for a device, whatever is loaded.
pub struct Renderer {
    gpu: Gpu,
    scene_layout: wgpu::BindGroupLayout,
    pub(super) material_layout: wgpu::BindGroupLayout,
    pub(super) white: wgpu::TextureView,
    pub(super) sampler: wgpu::Sampler,
    indexed: wgpu::RenderPipeline,
    pulled: wgpu::RenderPipeline,
    source: wgpu::RenderPipeline,
    /// Through everything and faint, then what is in sight.
    lines: [wgpu::RenderPipeline; 2],
}

/// Bytes from a [`crate::gpu::layout::DrawArgs`]'s start to its arguments for pulled drawing.
const PULL_ARGS: u64 = std::mem::offset_of!(crate::gpu::layout::DrawArgs, pull_vertex_count) as u64;

impl Renderer {
    pub fn new(gpu: &Gpu) -> Self {
        let scene_layout = scene_layout(gpu);
        let material_layout = material_layout(gpu);
        let surface = crate::gpu::shader_module(gpu, "draw");
        let vertex = [wgpu::VertexBufferLayout {
            array_stride: size_of::<Vertex>() as u64,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Uint32x2, 2 => Uint32, 3 => Float32x2],
        }];
        let layouts = [Some(&scene_layout), Some(&material_layout)];
        let surface =
            |entry, buffers| pipeline(gpu, &layouts, &surface, (entry, "surface_fragment"), buffers, Layer::Surface);
        let segment = wgpu::VertexBufferLayout {
            array_stride: size_of::<LineSegment>() as u64,
            step_mode: wgpu::VertexStepMode::Instance,
            attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x3, 3 => Float32],
        };
        let lines = crate::gpu::shader_module(gpu, "lines");
        let lines = |entry, layer| {
            pipeline(gpu, &layouts[..1], &lines, ("line_vertex", entry), &[Some(segment.clone())], layer)
        };
        let [vertex] = vertex;
        Self {
            gpu: gpu.clone(),
            indexed: surface("indexed_vertex", &[Some(vertex)]),
            pulled: surface("pulled_vertex", &[]),
            source: surface("source_vertex", &[]),
            lines: [lines("hidden_line_fragment", Layer::Everywhere), lines("line_fragment", Layer::InSight)],
            white: upload(gpu, &Texture { size: [1, 1], rgba: vec![255; 4] }),
            sampler: gpu.device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("base color"),
                address_mode_u: wgpu::AddressMode::Repeat,
                address_mode_v: wgpu::AddressMode::Repeat,
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                mipmap_filter: wgpu::MipmapFilterMode::Linear,
                ..Default::default()
            }),
            scene_layout,
            material_layout,
        }
    }

    /// Draws the scene, whose counts must be known, into the target: chunk after chunk, each emitted unless the arena
    /// still holds it.
    pub fn draw(
        &self,
        recorder: &mut Recorder,
        scene: &mut Scene,
        target: &Target,
        camera: &Camera,
        settings: &Settings,
    ) {
        let frame = self.frame(scene, target, camera, settings);
        let frame = self.gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("frame"),
            contents: bytemuck::bytes_of(&frame),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let passes = scene.tessellator.chunk_count().max(1);
        for index in 0..passes {
            let emitted = index < scene.tessellator.chunk_count();
            if emitted {
                scene.tessellator.emit(recorder, index);
            }
            let (first, last) = (index == 0, index + 1 == passes);
            let color = target.color(linear_color(settings.background), first, last);
            let group = self.scene_group(scene, &frame);
            recorder.render("draw", color, target.depth(first), |pass| {
                pass.set_bind_group(0, &group, &[]);
                let [left, right] = halves(target.size, settings.split);
                if first {
                    self.draw_source(pass, scene, left);
                }
                if emitted {
                    // These look at whole triangles.
                    let pulled = settings.overlays.wireframe || settings.overlays.folds;
                    self.draw_chunk(pass, scene, right, pulled, &scene.tessellator.chunk(index));
                }
                if last {
                    self.draw_lines(pass, scene, right);
                }
            });
        }
    }

    fn frame(&self, scene: &Scene, target: &Target, camera: &Camera, settings: &Settings) -> Frame {
        let viewport = target.viewport();
        let [right, up, back] = camera.axes();
        let eye = if camera.orthographic { back.extend(0.0) } else { camera.eye().extend(1.0) };
        Frame {
            clip_from_object: camera.clip_from_object(viewport, &scene.bounds).to_cols_array_2d(),
            key_light: (up * 0.7 + back - right * 0.5).normalize().extend(0.0).to_array(),
            fill_light: (up * 0.8 + back * 0.4 + right * 0.5).normalize().extend(0.0).to_array(),
            eye: eye.to_array(),
            viewport: viewport.to_array(),
            overlays: overlay_bits(&settings.overlays),
            ulp: scene.ulp,
        }
    }

    fn draw_source(&self, pass: &mut wgpu::RenderPass, scene: &Scene, [x, y, width, height]: [u32; 4]) {
        if width == 0 || height == 0 {
            return;
        }
        pass.set_scissor_rect(x, y, width, height);
        pass.set_pipeline(&self.source);
        for (material, patches) in scene.materials.iter().zip(&scene.tessellator.topology().material_patches) {
            pass.set_bind_group(1, material, &[]);
            pass.draw(3 * patches.start..3 * patches.end, 0..1);
        }
    }

    fn draw_chunk(
        &self,
        pass: &mut wgpu::RenderPass,
        scene: &Scene,
        [x, y, width, height]: [u32; 4],
        pulled: bool,
        chunk: &ChunkBuffers,
    ) {
        if width == 0 || height == 0 {
            return;
        }
        pass.set_scissor_rect(x, y, width, height);
        if pulled {
            pass.set_pipeline(&self.pulled);
        } else {
            pass.set_pipeline(&self.indexed);
            pass.set_vertex_buffer(0, chunk.vertices.slice(..));
            pass.set_index_buffer(chunk.indices.slice(..), wgpu::IndexFormat::Uint32);
        }
        let mut args = chunk.draw_args_offset;
        for material in &scene.materials {
            pass.set_bind_group(1, material, &[]);
            if pulled {
                pass.draw_indirect(chunk.draw_args, args + PULL_ARGS);
            } else {
                pass.draw_indexed_indirect(chunk.draw_args, args);
            }
            args += size_of::<crate::gpu::layout::DrawArgs>() as u64;
        }
    }

    fn draw_lines(&self, pass: &mut wgpu::RenderPass, scene: &Scene, [x, y, width, height]: [u32; 4]) {
        if let Some((buffer, count)) = &scene.lines
            && width > 0
            && height > 0
        {
            pass.set_scissor_rect(x, y, width, height);
            pass.set_vertex_buffer(0, buffer.slice(..));
            for pipeline in &self.lines {
                pass.set_pipeline(pipeline);
                pass.draw(0..6, 0..*count);
            }
        }
    }

    fn scene_group(&self, scene: &Scene, frame: &wgpu::Buffer) -> wgpu::BindGroup {
        let buffers = scene.tessellator.buffers();
        let (vertices, indices) = scene.tessellator.arena();
        let bound = [frame, &buffers.points, &buffers.corners, &buffers.patches, vertices, indices];
        let bound: Vec<_> = (0..).zip(bound).collect();
        crate::gpu::bind_group(&self.gpu, "scene", &self.scene_layout, &bound)
    }
}

/// The picture left and right of the split: x, y, width, height in px.
pub(super) fn halves([width, height]: [u32; 2], split: Option<f32>) -> [[u32; 4]; 2] {
    let at = split.map_or(0, |split| (split.clamp(0.0, 1.0) * width as f32).round() as u32);
    [[0, 0, at, height], [at, 0, width - at, height]]
}

/// sRGB bytes as the linear colour that a clear takes.
fn linear_color(srgb: [u8; 3]) -> wgpu::Color {
    let [r, g, b] = linear(srgb).map(f64::from);
    wgpu::Color { r, g, b, a: 1.0 }
}

fn scene_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let entry = |binding, ty, visibility| wgpu::BindGroupLayoutEntry {
        binding,
        visibility,
        ty: wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None },
        count: None,
    };
    let both = wgpu::ShaderStages::VERTEX_FRAGMENT;
    let storage = wgpu::BufferBindingType::Storage { read_only: true };
    let mut entries = vec![entry(0, wgpu::BufferBindingType::Uniform, both)];
    entries.extend((1..6).map(|binding| entry(binding, storage, wgpu::ShaderStages::VERTEX)));
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("scene"), entries: &entries })
}

fn material_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
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
enum Layer {
    /// Opaque, in depth.
    Surface,
    /// Blended, whatever is in front.
    Everywhere,
    /// Blended, where nothing is in front.
    InSight,
}

fn pipeline(
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
        Layer::Surface | Layer::InSight => wgpu::CompareFunction::Greater,
        Layer::Everywhere => wgpu::CompareFunction::Always,
    };
    let opaque = layer == Layer::Surface;
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(vertex),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(vertex),
            compilation_options: Default::default(),
            buffers,
        },
        primitive: wgpu::PrimitiveState::default(),
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

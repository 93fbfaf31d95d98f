//! Leaks: pixels at which a crack shows the inside of a closed mesh.

use glam::Mat4;
use wgpu::util::DeviceExt;

use super::Scene;
use crate::gpu::wgsl::wgsl;
use crate::gpu::{
    Gpu, GpuError, Lazy, Recorder, ShaderModule, Timing, VERTEX_HALF, WgslFile, bind_group, read_texture,
};

pub(super) static DRAW_LEAKS: WgslFile = wgsl!("draw_leaks");

/// The count of each pixel, which may be negative. This format holds every whole number up to 2048, and every adapter can blend
/// it.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R16Float;

/// Counts leaks.
///
/// A closed surface covers every pixel with as many front faces as back faces, since a line of sight that enters it also leaves
/// it. Where a front and a back face meet at a silhouette, the rasteriser gives each pixel to both or to neither, by the same
/// rule. So all triangles are drawn without a depth test; front faces add 1 and back faces subtract 1. A pixel that isn't 0 at
/// the end sees the inside through a crack, or the outside from within. (If a line of sight passes through one crack in front
/// and another behind, the two cancel; the pixels around it still count.)
pub(crate) struct LeakCounter {
    module: ShaderModule,
    pipeline: Lazy<wgpu::RenderPipeline>,
}

impl Default for LeakCounter {
    fn default() -> Self {
        Self::new()
    }
}

impl LeakCounter {
    /// Compiles nothing yet.
    pub(crate) fn new() -> Self {
        Self { module: ShaderModule::new(&DRAW_LEAKS), pipeline: Lazy::default() }
    }

    fn pipeline(&self, gpu: &Gpu) -> Result<&wgpu::RenderPipeline, GpuError> {
        let module = self.module.get(gpu)?;
        self.pipeline.get_or_make(gpu, || pipeline(gpu, module))
    }

    /// How many pixels of a picture of `size` (width and height in px) are leaks. The scene's counts must be known, its mesh must
    /// be closed, and all of it must lie beyond the near plane.
    ///
    /// # Errors
    /// The picture is larger than the adapter draws, or the device was lost.
    pub(crate) fn count(&self, gpu: &Gpu, scene: &mut Scene, size: [u32; 2], clip: Mat4) -> Result<u64, GpuError> {
        let limit = gpu.device.limits().max_texture_dimension_2d;
        let [width, height] = size.map(|side| side.max(1));
        if width > limit || height > limit {
            return Err(GpuError::PictureTooLarge { width, height, limit });
        }
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("leaks"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        self.draw(gpu, scene, &texture, clip)?;
        // Two bytes a texel. Both zeros, +0 and -0, are 0.
        let bytes = read_texture(gpu, &texture)?;
        Ok(bytes.chunks_exact(2).filter(|half| half[0] != 0 || half[1] & 0x7f != 0).count() as u64)
    }

    fn draw(&self, gpu: &Gpu, scene: &mut Scene, texture: &wgpu::Texture, clip: Mat4) -> Result<(), GpuError> {
        let pipeline = self.pipeline(gpu)?;
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let uniform = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("leaks"),
            contents: bytemuck::bytes_of(&clip.to_cols_array_2d()),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let group = bind_group(gpu, "leaks", &pipeline.get_bind_group_layout(0), &[(0, &uniform)]);
        let mut timing = Timing::Off;
        let mut recorder = Recorder::new(gpu, &mut timing);
        let chunks = scene.tessellator.chunk_count();
        for index in 0..chunks.max(1) {
            if index < chunks {
                scene.tessellator.emit(&mut recorder, index)?;
            }
            let load = if index == 0 { wgpu::LoadOp::Clear(wgpu::Color::BLACK) } else { wgpu::LoadOp::Load };
            let mut pass = recorder.encoder().begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("leaks"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
                })],
                ..Default::default()
            });
            if index < chunks {
                let chunk = scene.tessellator.chunk(index);
                pass.set_pipeline(pipeline);
                pass.set_bind_group(0, &group, &[]);
                let [(places, bytes), _] = chunk.vertices();
                pass.set_vertex_buffer(0, places.slice(bytes));
                pass.set_index_buffer(chunk.indices.slice(..), wgpu::IndexFormat::Uint32);
                pass.draw_indexed(0..3 * chunk.chunk.triangle_count, 0, 0..1);
            }
        }
        recorder.submit();
        Ok(())
    }
}

fn pipeline(gpu: &Gpu, module: &wgpu::ShaderModule) -> wgpu::RenderPipeline {
    let add = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Add,
    };
    let vertex = wgpu::VertexBufferLayout {
        array_stride: VERTEX_HALF,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &wgpu::vertex_attr_array![0 => Float32x3],
    };
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("leaks"),
        layout: None,
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("leak_vertex"),
            compilation_options: Default::default(),
            buffers: &[Some(vertex)],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("leak_fragment"),
            compilation_options: Default::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format: FORMAT,
                blend: Some(wgpu::BlendState { color: add, alpha: add }),
                write_mask: wgpu::ColorWrites::RED,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}

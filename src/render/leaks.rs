//! Leaks: pixels through which one looks into a closed mesh.

use glam::Mat4;
use wgpu::util::DeviceExt;

use super::Scene;
use crate::gpu::{Gpu, GpuError, Recorder, Timing, VERTEX_HALF, read_staging, shader_module, staging_buffer};

/// Counts of either sign, exact far beyond what any pixel sees, and blendable on every adapter.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R16Float;
const TEXEL_BYTES: u32 = 2;

/// Counts leaks. Long-lived: the pipeline that adds and takes away.
///
/// What is closed covers every pixel with as many front faces as back faces: whatever enters it leaves it. Where a
/// front and a back face meet at a silhouette, the rasteriser gives each pixel to both or to neither, by the same rule.
/// So all triangles are drawn without a depth test, front faces adding 1 and back faces taking 1 away, and a pixel
/// that is not 0 at the end looks in through a crack, or out through one. (Where a line of sight passes through one
/// crack in front and another behind, the two cancel; the pixels around it still count.)
pub struct LeakCounter {
    pipeline: wgpu::RenderPipeline,
}

impl LeakCounter {
    pub fn new(gpu: &Gpu) -> Self {
        let module = shader_module(gpu, "leaks");
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
        let pipeline = gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("leaks"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("leak_vertex"),
                compilation_options: Default::default(),
                buffers: &[Some(vertex)],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: None,
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
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
        });
        Self { pipeline }
    }

    /// How many of `size` px are leaks. The scene's counts must be known, its mesh closed and beyond the near plane.
    ///
    /// # Errors
    /// The picture is larger than the adapter draws, or the device was lost.
    pub fn count(&self, gpu: &Gpu, scene: &mut Scene, size: [u32; 2], clip: Mat4) -> Result<u64, GpuError> {
        let limit = gpu.device.limits().max_texture_dimension_2d;
        let [width, height] = size.map(|side| side.max(1));
        if width > limit || height > limit {
            return Err(GpuError::PictureTooLarge { width, height, limit });
        }
        let extent = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("leaks"),
            size: extent,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        self.draw(gpu, scene, &texture, clip);
        let row = (width * TEXEL_BYTES).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let staging = staging_buffer(gpu, u64::from(row) * u64::from(height));
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
        let to = wgpu::TexelCopyBufferInfo { buffer: &staging, layout };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), to, extent);
        gpu.queue.submit([encoder.finish()]);
        let bytes = read_staging(gpu, &staging)?;
        let pixels = bytes.chunks_exact(row as usize).flat_map(|line| line[..(width * TEXEL_BYTES) as usize].chunks(2));
        // Either zero is a zero.
        Ok(pixels.filter(|half| half[0] != 0 || half[1] & 0x7f != 0).count() as u64)
    }

    fn draw(&self, gpu: &Gpu, scene: &mut Scene, texture: &wgpu::Texture, clip: Mat4) {
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let uniform = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("leaks"),
            contents: bytemuck::bytes_of(&clip.to_cols_array_2d()),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let group = crate::gpu::bind_group(gpu, "leaks", &self.pipeline.get_bind_group_layout(0), &[(0, &uniform)]);
        let mut timing = Timing::Off;
        let mut recorder = Recorder::new(gpu, &mut timing);
        let chunks = scene.tessellator.chunk_count();
        for index in 0..chunks.max(1) {
            if index < chunks {
                scene.tessellator.emit(&mut recorder, index);
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
                pass.set_pipeline(&self.pipeline);
                pass.set_bind_group(0, &group, &[]);
                let [(places, bytes), _] = chunk.vertices();
                pass.set_vertex_buffer(0, places.slice(bytes));
                pass.set_index_buffer(chunk.indices.slice(..), wgpu::IndexFormat::Uint32);
                pass.draw_indexed(0..3 * chunk.chunk.triangle_count, 0, 0..1);
            }
        }
        recorder.submit();
    }
}

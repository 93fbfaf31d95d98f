//! Draws that add something at every sample that an emitted triangle covers, without depth.

use glam::Mat4;

use super::render_pipeline::{PipelineParts, blended};
use super::target::color_attachment;
use gpu::embed::VERTEX_LAYOUTS;
use gpu::{ChunkBuffers, Gpu, GpuError, Lazy, Readback, Recorder, ShaderModule, flat_texture, uniform_buffer, whole};

/// What such draws add, and to what textures.
pub(super) struct Adding {
    module: ShaderModule,
    pipeline: Lazy<wgpu::RenderPipeline>,
    fragment: &'static str,
    format: wgpu::TextureFormat,
    factor: wgpu::BlendFactor,
    channels: wgpu::ColorWrites,
}

impl Adding {
    /// What a fragment shader of `shaders/draw_adding.wgsl` gives, times a factor, in some channels. Compiles nothing yet.
    pub(super) fn new(
        fragment: &'static str,
        format: wgpu::TextureFormat,
        factor: wgpu::BlendFactor,
        channels: wgpu::ColorWrites,
    ) -> Self {
        let (module, pipeline) = (ShaderModule::new("draw_adding"), Lazy::default());
        Self { module, pipeline, fragment, format, factor, channels }
    }

    /// Starts with nothing, in a texture of this width and height, which the adapter must have.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub(super) fn start(&self, gpu: &Gpu, size: [u32; 2], clip_from_object: Mat4) -> Result<Added, GpuError> {
        let module = self.module.get(gpu)?;
        let pipeline = self.pipeline.get_or_make(gpu, || {
            let blend = Some(blended(self.factor, wgpu::BlendFactor::One, wgpu::BlendFactor::One));
            let target = wgpu::ColorTargetState { format: self.format, blend, write_mask: self.channels };
            let parts = PipelineParts::new(module, ["adding_vertex", self.fragment], Some(target));
            PipelineParts { vertex_buffers: VERTEX_LAYOUTS[..1].to_vec(), ..parts }.pipeline(gpu)
        })?;
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        let texture = gpu.device.create_texture(&flat_texture(self.fragment, size, self.format, usage));
        let matrix = clip_from_object.to_cols_array_2d();
        let uniform = uniform_buffer(gpu, self.fragment, bytemuck::bytes_of(&matrix));
        let layout = pipeline.get_bind_group_layout(0);
        let group = self.module.bind(gpu, "adding_vertex", &layout, |_| Some(uniform.as_entire_binding()));
        Ok(Added { texture, pipeline: pipeline.clone(), group, is_cleared: false })
    }
}

/// What was added so far.
pub(crate) struct Added {
    texture: wgpu::Texture,
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
    is_cleared: bool,
}

impl Added {
    /// Records drawing a chunk that was emitted; without one nothing is added. `constant` is that of the blend factor.
    pub(crate) fn draw(&mut self, recorder: &mut Recorder, constant: wgpu::Color, chunk: Option<&ChunkBuffers>) {
        let view = whole(&self.texture);
        let color = color_attachment(&view, (!self.is_cleared).then_some(wgpu::Color::TRANSPARENT));
        self.is_cleared = true;
        recorder.render("adding", Some(color), None, |pass| {
            let Some(chunk) = chunk else { return };
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &self.group, &[]);
            pass.set_blend_constant(constant);
            let [(places, bytes), _] = chunk.vertices();
            pass.set_vertex_buffer(0, places.slice(bytes));
            pass.set_index_buffer(chunk.indices.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(0..3 * chunk.chunk.triangle_count, 0, 0..1);
        });
    }

    /// Records a copy of all samples, row by row.
    pub(crate) fn read(&self, gpu: &Gpu, recorder: &mut Recorder) -> Readback {
        Readback::from_texture(gpu, recorder.encoder(), &self.texture)
    }
}

//! What triangles cover on screen, for their outline.

use glam::{Mat4, Vec3};
use wgpu::util::DeviceExt;

use super::adding_pipeline::Adding;
use crate::measure::{OutlineOf, SampleGrid};
use gpu::{ChunkBuffers, Gpu, GpuError, Lazy, Readback, Recorder, ShaderModule, bind_group};

/// A channel for each of [`OutlineOf::ALL`].
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Draws what triangles cover.
pub(crate) struct SilhouetteDrawer {
    module: ShaderModule,
    pipeline: Lazy<wgpu::RenderPipeline>,
}

impl SilhouetteDrawer {
    /// Compiles nothing yet.
    pub(crate) fn new() -> Self {
        Self { module: ShaderModule::new("draw_silhouette"), pipeline: Lazy::default() }
    }

    /// Starts with nothing covered. `clip_from_object` is that of the picture without its margin.
    ///
    /// # Errors
    /// The picture is larger than the adapter draws, or the device was lost.
    pub(crate) fn start(
        &self,
        gpu: &Gpu,
        grid: SampleGrid,
        clip_from_object: Mat4,
    ) -> Result<SilhouetteCoverage, GpuError> {
        let limit = gpu.device.limits().max_texture_dimension_2d;
        let [width, height] = grid.size();
        if width > limit || height > limit {
            let [width, height] = grid.picture;
            return Err(GpuError::PictureTooLarge {
                width,
                height,
                limit: limit.saturating_sub(grid.padded()[0] - width),
            });
        }
        let module = self.module.get(gpu)?;
        let pipeline = self.pipeline.get_or_make(gpu, || pipeline(gpu, module))?;
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("silhouette"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let uniform = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("silhouette"),
            contents: bytemuck::bytes_of(&padded_clip(grid, clip_from_object).to_cols_array_2d()),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let group = bind_group(gpu, "silhouette", &pipeline.get_bind_group_layout(0), &[(0, &uniform)]);
        Ok(SilhouetteCoverage { texture, pipeline: pipeline.clone(), group, is_cleared: false })
    }
}

/// The matrix of a picture with its margin, in which a px is as large as without.
pub(crate) fn padded_clip(grid: SampleGrid, clip_from_object: Mat4) -> Mat4 {
    let [x, y] = [0, 1].map(|axis| grid.picture[axis] as f32 / grid.padded()[axis] as f32);
    Mat4::from_scale(Vec3::new(x, y, 1.0)) * clip_from_object
}

/// What is covered so far.
pub(crate) struct SilhouetteCoverage {
    texture: wgpu::Texture,
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
    is_cleared: bool,
}

impl SilhouetteCoverage {
    /// Records drawing a chunk that was emitted; without one nothing is added.
    pub(crate) fn draw(&mut self, recorder: &mut Recorder, of: OutlineOf, chunk: Option<&ChunkBuffers>) {
        let view = self.texture.create_view(&wgpu::TextureViewDescriptor::default());
        let load = if self.is_cleared { wgpu::LoadOp::Load } else { wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT) };
        self.is_cleared = true;
        let mut pass = recorder.encoder().begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("silhouette"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
            })],
            ..Default::default()
        });
        let Some(chunk) = chunk else { return };
        let [r, g, b] = OutlineOf::ALL.map(|other| f64::from(u8::from(other == of)));
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.set_blend_constant(wgpu::Color { r, g, b, a: 0.0 });
        let [(places, bytes), _] = chunk.vertices();
        pass.set_vertex_buffer(0, places.slice(bytes));
        pass.set_index_buffer(chunk.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..3 * chunk.chunk.triangle_count, 0, 0..1);
    }

    /// Records a copy of all samples, as [`crate::measure::Silhouette::find`] takes them.
    pub(crate) fn read(&self, gpu: &Gpu, recorder: &mut Recorder) -> Readback {
        Readback::of_texture(gpu, recorder.encoder(), &self.texture)
    }
}

fn pipeline(gpu: &Gpu, module: &wgpu::ShaderModule) -> wgpu::RenderPipeline {
    // A channel stays at 1 however many triangles cover a sample.
    let adding = Adding {
        label: "silhouette",
        entry_points: ["silhouette_vertex", "silhouette_fragment"],
        format: FORMAT,
        factor: wgpu::BlendFactor::Constant,
        channels: wgpu::ColorWrites::ALL,
    };
    adding.pipeline(gpu, module)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{vec2, vec3};

    #[test]
    fn a_px_of_the_padded_picture_is_one_of_the_picture() {
        let grid = SampleGrid { picture: [200, 100], per_px: 1 };
        let [width, height] = grid.padded().map(|side| side as f32);
        let corner = padded_clip(grid, Mat4::IDENTITY).transform_point3(vec3(1.0, 1.0, 0.5));
        let from_middle = 0.5 * vec2(corner.x * width, corner.y * height);
        assert!(from_middle.abs_diff_eq(vec2(100.0, 50.0), 1e-4), "{from_middle}");
    }
}

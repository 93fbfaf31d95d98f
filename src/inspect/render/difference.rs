//! The picture of the difference between both halves of a split view.

use super::render_pipeline::{PipelineParts, blended};
use super::target::{SHOWN_FORMAT, Target, color_attachment};
use gpu::{Gpu, GpuError, Lazy, Recorder, ShaderModule, whole};

/// Draws how much two pictures differ, pixel by pixel: see `shaders/draw_difference.wgsl`.
pub(super) struct DifferenceDrawer {
    module: ShaderModule,
    pipeline: Lazy<wgpu::RenderPipeline>,
}

impl DifferenceDrawer {
    /// Compiles nothing yet.
    pub(super) fn new() -> Self {
        Self { module: ShaderModule::new("draw_difference"), pipeline: Lazy::default() }
    }

    /// Draws the difference between the pictures that were kept under what the target shows.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub(super) fn draw(&self, recorder: &mut Recorder, gpu: &Gpu, target: &Target) -> Result<(), GpuError> {
        let module = self.module.get(gpu)?;
        let pipeline = self.pipeline.get_or_make(gpu, || {
            let (under, over) = (wgpu::BlendFactor::OneMinusDstAlpha, wgpu::BlendFactor::One);
            let blend = Some(blended(under, over, over));
            let shown = wgpu::ColorTargetState { blend, ..SHOWN_FORMAT.into() };
            PipelineParts::new(module, ["whole_vertex", "difference_fragment"], Some(shown)).pipeline(gpu)
        })?;
        let [left, right] = target.kept(gpu)?.each_ref().map(whole);
        let group = self.module.bind(gpu, "difference_fragment", &pipeline.get_bind_group_layout(0), |name| {
            Some(wgpu::BindingResource::TextureView(if name == "left_picture" { &left } else { &right }))
        });
        let view = target.shown_view(false);
        recorder.render("difference", Some(color_attachment(&view, None)), None, |pass| {
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.draw(0..3, 0..1);
        });
        Ok(())
    }
}

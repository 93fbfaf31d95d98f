//! The picture of the difference between both halves of a split view.

use super::group_layouts::{FRAGMENT, IMAGE, group_layout};
use super::render_pipeline::{PipelineParts, blended};
use super::target::{SHOWN_FORMAT, Target, color_attachment};
use gpu::{Gpu, GpuError, Lazy, Recorder, ShaderModule, bind_group, whole};

/// Draws how much two pictures differ, pixel by pixel: see `shaders/draw_difference.wgsl`.
pub(super) struct DifferenceDrawer {
    module: ShaderModule,
    layout: wgpu::BindGroupLayout,
    pipeline: Lazy<wgpu::RenderPipeline>,
}

impl DifferenceDrawer {
    pub(super) fn new(gpu: &Gpu) -> Self {
        let layout = group_layout(gpu, "difference", &[0, 1].map(|binding| (binding, FRAGMENT, IMAGE)));
        Self { module: ShaderModule::new("draw_difference"), layout, pipeline: Lazy::default() }
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
            let parts = PipelineParts::new(module, ["whole_vertex", "difference_fragment"], Some(shown));
            PipelineParts { layouts: Some(vec![Some(&self.layout)]), ..parts }.pipeline(gpu)
        })?;
        let views = target.kept(gpu)?.each_ref().map(whole);
        let bound = (0..).zip(views.each_ref().map(wgpu::BindingResource::TextureView));
        let group = bind_group(gpu, "difference", &self.layout, bound);
        let view = target.shown_view(false);
        recorder.render("difference", Some(color_attachment(&view, None)), None, |pass| {
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.draw(0..3, 0..1);
        });
        Ok(())
    }
}

//! Paints the largest areas of the window on its device: see [`WindowPipelines`].

use egui::{Color32, PaintCallbackInfo, Rect, Shape};
use egui_wgpu::{Callback, CallbackResources, CallbackTrait};

use gpu::Gpu;
use inspect::render::{Target, WindowPipelines};

/// An area of one opaque colour.
pub(super) fn filled(pipelines: &WindowPipelines, area: Rect, color: Color32) -> Shape {
    Callback::new_paint_callback(area, FilledArea { pipeline: pipelines.fill.clone(), color }).into()
}

/// The frame of a panel that shows the window's background.
pub(super) fn panel_frame(ui: &egui::Ui) -> egui::Frame {
    egui::Frame::side_top_panel(ui.style()).fill(Color32::TRANSPARENT)
}

#[derive(Clone)]
pub(super) struct ShownPicture {
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
}

impl ShownPicture {
    pub(super) fn new(pipelines: &WindowPipelines, gpu: &Gpu, target: &Target, filter: wgpu::FilterMode) -> Self {
        Self { pipeline: pipelines.picture.clone(), group: pipelines.shown(gpu, target, filter) }
    }

    /// The picture, stretched over this area.
    pub(super) fn over(&self, area: Rect) -> Shape {
        Callback::new_paint_callback(area, self.clone()).into()
    }
}

impl CallbackTrait for ShownPicture {
    fn paint(&self, _: PaintCallbackInfo, pass: &mut wgpu::RenderPass<'static>, _: &CallbackResources) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.draw(0..3, 0..1);
    }
}

struct FilledArea {
    pipeline: wgpu::RenderPipeline,
    color: Color32,
}

impl CallbackTrait for FilledArea {
    fn paint(&self, _: PaintCallbackInfo, pass: &mut wgpu::RenderPass<'static>, _: &CallbackResources) {
        let color = u32::from_le_bytes([self.color.r(), self.color.g(), self.color.b(), 0]);
        pass.set_pipeline(&self.pipeline);
        pass.draw(0..3, color..color + 1);
    }
}

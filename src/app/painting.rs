//! Paints the largest areas of the window on its device: see [`WindowPipelines`].

use egui::{Color32, PaintCallbackInfo, Rect, Shape};
use egui_wgpu::{Callback, CallbackResources, CallbackTrait};

use gpu::{Gpu, GpuError};
use inspect::render::{Target, WindowPipelines};

/// What paints into the textures of one window.
pub(super) struct Painting(WindowPipelines);

impl Painting {
    /// `format` is that of the window's textures.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub(super) fn new(gpu: &Gpu, format: wgpu::TextureFormat) -> Result<Self, GpuError> {
        WindowPipelines::new(gpu, format).map(Self)
    }

    pub(super) fn shown(&self, gpu: &Gpu, target: &Target, filter: wgpu::FilterMode) -> ShownPicture {
        ShownPicture { pipeline: self.0.picture.clone(), group: self.0.shown(gpu, target, filter) }
    }

    /// An area of one opaque colour.
    pub(super) fn fill(&self, area: Rect, color: Color32) -> Shape {
        Callback::new_paint_callback(area, FilledArea { pipeline: self.0.fill.clone(), color }).into()
    }
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

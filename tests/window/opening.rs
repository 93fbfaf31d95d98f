//! Windows, with a device that all share or with one of their own.

use std::sync::LazyLock;

use egui_kittest::wgpu::{create_render_state, default_wgpu_setup};
use egui_kittest::{Harness, HarnessBuilder};
use egui_wgpu::{RendererOptions, WgpuSetup, WgpuSetupExisting};
use gpu::Gpu;
use inspect::engine::Engine;
use load::Source;
use load::files::Limits;
use pnaen::app::App;

/// A device of the usual adapter, but not through OpenGL: EGL fails at times when several threads look for adapters.
pub(super) fn setup() -> WgpuSetup {
    let mut setup = default_wgpu_setup();
    if let WgpuSetup::CreateNew(new) = &mut setup {
        new.instance_descriptor.backends = gpu::BACKENDS;
    }
    setup
}

/// One device for all windows, and the pipelines on it: compiling them is what takes long.
static DEVICE: LazyLock<(WgpuSetupExisting, Engine)> = LazyLock::new(|| {
    let state = create_render_state(setup(), RendererOptions::PREDICTABLE);
    let engine = Engine::new(Gpu::new(&state.adapter, state.device.clone(), state.queue.clone()));
    let (instance, adapter, device, queue) = (state.instance, state.adapter, state.device, state.queue);
    (WgpuSetupExisting { instance, adapter, device, queue }, engine)
});

/// Opens a window, and changes it with `then` before its first frame.
pub(super) fn open(
    builder: HarnessBuilder<App>,
    source: Option<Source>,
    then: impl FnOnce(&mut App, &egui::Context),
) -> Harness<'static, App> {
    let (setup, engine) = &*DEVICE;
    builder.wgpu_setup(setup.clone().into()).build_eframe(move |context| {
        let app = App::with_engine(context, engine.clone(), source, Limits::default());
        let mut app = app.expect("these tests need a graphics adapter");
        then(&mut app, &context.egui_ctx);
        app
    })
}

/// Opens a window with a device of its own, which may be lost, and whose pipelines may be counted.
pub(super) fn open_alone(builder: HarnessBuilder<App>, source: Option<Source>) -> Harness<'static, App> {
    builder.wgpu_setup(setup()).build_eframe(move |context| {
        App::new(context, source, Limits::default()).expect("these tests need a graphics adapter")
    })
}

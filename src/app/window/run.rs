//! Opening the window; and another in its place, where the device that draws it was lost.

use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::rc::Rc;
use std::sync::Arc;

use thiserror::Error;

use super::device_lost::Next;
use crate::app::persistence::{LEAST_SIZE, WindowGeometry, folder};
use crate::app::{App, Persistence};
use crate::files::Limits;
use crate::gpu::{AdapterChoice, BACKENDS, GpuError, device_descriptor};
use crate::load::Source;

#[derive(Debug, Error)]
pub enum WindowError {
    /// Why, in a few words.
    #[error("no window could be opened ({0})")]
    NoDisplay(String),
    /// In a sentence.
    #[error("{0}")]
    NoAdapter(String),
    #[error("the window can't be drawn ({0}): check the graphics driver, or use the commands (pnaen --help)")]
    Failed(String),
    /// Why there is none, in a sentence or a few words.
    #[error(
        "the graphics device was lost, and there is no other ({0}); settings and camera are kept for the next window"
    )]
    Gone(String),
}

/// Opens the window on `source`, or on a cube made in code, and returns when it is closed; on the adapter that was asked
/// for. Files larger than `limits` says aren't opened.
///
/// # Errors
/// There is no display, or none that a window can be drawn on.
pub(crate) fn run(source: Option<Source>, limits: Limits, adapter: AdapterChoice) -> Result<(), WindowError> {
    run_watched(source, limits, adapter, |_, _| {})
}

/// The same; `watch` is told of every frame before it is made, of all windows that follow each other.
///
/// # Errors
/// There is no display, or none that a window can be drawn on.
pub fn run_watched(
    source: Option<Source>,
    limits: Limits,
    adapter: AdapterChoice,
    watch: impl FnMut(&mut App, &egui::Context) + 'static,
) -> Result<(), WindowError> {
    if cfg!(target_os = "linux") && !["DISPLAY", "WAYLAND_DISPLAY"].iter().any(|name| std::env::var_os(name).is_some())
    {
        return Err(WindowError::NoDisplay("neither DISPLAY nor WAYLAND_DISPLAY is set".into()));
    }
    let lasting = Persistence::read(folder().as_deref());
    let watch: Watch = Rc::new(RefCell::new(watch));
    let place = sized(lasting.frame());
    let first = |context: &eframe::CreationContext| {
        let mut app = App::new(context, source, limits)?;
        app.resume(&context.egui_ctx, lasting);
        Ok(app)
    };
    let mut closed = show(place, &adapter, &watch, first)?;
    loop {
        let Closed { app, context } = closed;
        match app.next() {
            Next::Quit => return Ok(()),
            Next::GiveUp(why) => return Err(WindowError::Gone(why)),
            Next::Anew => {}
        }
        let place = context.input(|input| input.viewport().outer_rect);
        let sized = sized(app.frame_kept());
        let place = match place {
            Some(place) => sized.with_position(place.min),
            None => sized,
        };
        let anew = |creation: &eframe::CreationContext| app.anew(creation, &context);
        closed = show(place, &adapter, &watch, anew).map_err(|error| WindowError::Gone(error.to_string()))?;
    }
}

/// Called before every frame.
type Watch = Rc<RefCell<dyn FnMut(&mut App, &egui::Context)>>;

fn sized(frame: &WindowGeometry) -> egui::ViewportBuilder {
    egui::ViewportBuilder::default()
        .with_title("pnaen")
        .with_app_id("pnaen")
        .with_inner_size(frame.size)
        .with_maximized(frame.is_maximized)
        .with_min_inner_size(LEAST_SIZE)
}

/// What is left of a window.
struct Closed {
    app: App,
    context: egui::Context,
}

/// Shows a window until it is closed. Its state outlives it, whatever the window library does.
fn show(
    viewport: egui::ViewportBuilder,
    adapter: &AdapterChoice,
    watch: &Watch,
    create: impl FnOnce(&eframe::CreationContext) -> Result<App, GpuError>,
) -> Result<Closed, WindowError> {
    let state: Rc<RefCell<Option<Closed>>> = Rc::default();
    let mut create = Some(create);
    let mut run = || {
        let creator: eframe::AppCreator = Box::new(|context| {
            let app = create.take().ok_or("it was opened twice")?(context)?;
            *state.borrow_mut() = Some(Closed { app, context: context.egui_ctx.clone() });
            Ok(Box::new(Shown { state: state.clone(), watch: watch.clone() }))
        });
        let options = eframe::NativeOptions {
            viewport: viewport.clone(),
            renderer: eframe::Renderer::Wgpu,
            wgpu_options: wgpu_configuration(adapter.clone()),
            ..Default::default()
        };
        catch_unwind(AssertUnwindSafe(|| eframe::run_native("pnaen", options, creator)))
    };
    let mut ended = run();
    if matches!(ended, Ok(Ok(()))) && state.borrow().is_none() {
        // The event loop has only now ended what a panic in the window before left half done.
        ended = run();
    }
    let closed = state.take();
    let is_lost = closed.as_ref().is_some_and(|closed| closed.app.is_lost());
    match (ended, closed) {
        (Ok(Ok(())), Some(closed)) => Ok(closed),
        (Ok(Ok(())), None) => Err(WindowError::Failed("it was closed before it was there".into())),
        // A device that is lost in the midst of painting makes egui panic: it has no other way to say so.
        (_, Some(mut closed)) if is_lost => {
            eframe::App::on_exit(&mut closed.app);
            Ok(closed)
        }
        (Ok(Err(error)), _) => Err(in_words(error)),
        (Err(panic), _) => resume_unwind(panic),
    }
}

/// What the window library shows: the state that outlives it.
struct Shown {
    state: Rc<RefCell<Option<Closed>>>,
    watch: Watch,
}

impl Shown {
    fn with(&self, what: impl FnOnce(&mut App)) {
        if let Some(closed) = self.state.borrow_mut().as_mut() {
            what(&mut closed.app);
        }
    }
}

impl eframe::App for Shown {
    fn logic(&mut self, context: &egui::Context, frame: &mut eframe::Frame) {
        self.with(|app| {
            self.watch.borrow_mut()(app, context);
            app.logic(context, frame);
        });
    }

    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        self.with(|app| app.ui(ui, frame));
    }

    fn on_exit(&mut self) {
        self.with(eframe::App::on_exit);
    }
}

/// The window library's errors are about its own files, or have its words around ours.
fn in_words(error: eframe::Error) -> WindowError {
    match error {
        eframe::Error::Winit(_) | eframe::Error::WinitEventLoop(_) => {
            WindowError::NoDisplay("the display that DISPLAY or WAYLAND_DISPLAY names can't be opened".into())
        }
        eframe::Error::Wgpu(egui_wgpu::WgpuError::CustomNativeAdapterSelectionError(why)) => {
            WindowError::NoAdapter(why)
        }
        eframe::Error::Wgpu(egui_wgpu::WgpuError::RequestAdapterError(_)) => {
            WindowError::NoAdapter(GpuError::NoAdapter.to_string())
        }
        eframe::Error::AppCreation(error) => WindowError::Failed(error.to_string()),
        error => WindowError::Failed(error.to_string()),
    }
}

/// The device that egui draws with is the engine's own.
fn wgpu_configuration(choice: AdapterChoice) -> egui_wgpu::WgpuConfiguration {
    let mut configuration = egui_wgpu::WgpuConfiguration::default();
    if let egui_wgpu::WgpuSetup::CreateNew(new) = &mut configuration.wgpu_setup {
        new.instance_descriptor.backends = BACKENDS;
        new.power_preference = wgpu::PowerPreference::HighPerformance;
        new.device_descriptor = Arc::new(device_descriptor);
        if choice != AdapterChoice::Best {
            new.native_adapter_selector = Some(Arc::new(move |adapters, surface| {
                let shows =
                    |adapter: &wgpu::Adapter| surface.is_none_or(|surface| adapter.is_surface_supported(surface));
                choice.among_able(adapters, shows).cloned().map_err(|error| error.to_string())
            }));
        }
    }
    configuration
}

//! Opens the window, and another in its place if its device was lost.

use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::rc::Rc;
use std::sync::Arc;

use thiserror::Error;

use super::device_lost::Next;
use crate::app::persistence::{LEAST_SIZE, WindowGeometry, folder};
use crate::app::{App, Persistence};
use gpu::{AdapterChoice, BACKENDS, GpuError, device_descriptor};
use inspect::engine::Preparation;
use load::Source;
use load::files::Limits;

#[derive(Debug, Error)]
pub enum WindowError {
    /// The reason, in a few words.
    #[error("no window could be opened ({0})")]
    NoDisplay(String),
    /// The reason, as a sentence.
    #[error("{0}")]
    NoAdapter(String),
    #[error("the window can't be drawn ({0}): check the graphics driver, or use the commands (pnaen --help)")]
    Failed(String),
    /// Why there is no other device, in a sentence or a few words.
    #[error(
        "the graphics device was lost, and there is no other ({0}); settings and camera are kept for the next window"
    )]
    Gone(String),
}

/// What the command line changes in how the mesh is taken.
pub type Opening<'a> = Option<&'a dyn Fn(&mut Preparation)>;

/// Opens the window with `source`, or with a cube made in code, on the chosen adapter; `opening` says how the mesh is taken.
/// Files beyond `limits` aren't opened. `watch` is called before every frame, in all windows that follow each other. Returns
/// when the last one is closed.
///
/// # Errors
/// There is no display, no adapter, or the window can't be drawn.
pub fn run(
    source: Option<Source>,
    opening: Opening,
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
        if let Some(change) = opening {
            app.open_as(&context.egui_ctx, change);
        }
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
        let sized = sized(app.persistence.frame());
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

struct Closed {
    app: App,
    context: egui::Context,
}

/// Shows a window until it is closed. Its state outlives it, even if the window library panics.
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
            Ok(Box::new(WatchedApp { state: state.clone(), watch: watch.clone() }))
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
        // After a panic in the window before, the event loop's first run only cleans up. The second one shows the window.
        ended = run();
    }
    let closed = state.take();
    let is_lost = closed.as_ref().is_some_and(|closed| closed.app.is_lost());
    match (ended, closed) {
        (Ok(Ok(())), Some(closed)) => Ok(closed),
        (Ok(Ok(())), None) => Err(WindowError::Failed("it was closed before it was shown".into())),
        // egui panics if the device is lost while it paints.
        (_, Some(mut closed)) if is_lost => {
            eframe::App::on_exit(&mut closed.app);
            Ok(closed)
        }
        (Ok(Err(error)), _) => Err(in_words(error)),
        (Err(panic), _) => resume_unwind(panic),
    }
}

/// The app that the window library runs. It forwards to the state that outlives it.
struct WatchedApp {
    state: Rc<RefCell<Option<Closed>>>,
    watch: Watch,
}

impl WatchedApp {
    fn with(&self, what: impl FnOnce(&mut App)) {
        if let Some(closed) = self.state.borrow_mut().as_mut() {
            what(&mut closed.app);
        }
    }
}

impl eframe::App for WatchedApp {
    fn raw_input_hook(&mut self, context: &egui::Context, input: &mut egui::RawInput) {
        self.with(|app| app.raw_input_hook(context, input));
    }

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

/// Converts the window library's errors, which name its own files or wrap this program's errors.
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

/// Makes egui create the device that the engine needs, since both share it.
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

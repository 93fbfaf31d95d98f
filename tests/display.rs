//! Tests the real window on a virtual display (Xvfb, on Linux only), for example how it goes on after its device is lost. It is a
//! program of its own, since windows need the main thread.
#![allow(unsafe_code, reason = "windows read the environment, which only this process has before its first thread")]

use std::cell::{Cell, RefCell};
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::rc::Rc;
use std::sync::Arc;
use std::time::{Duration, Instant};

use geometry::mesh::shapes::Shape;
use gpu::adapters::AdapterChoice;
use gpu::device::Gpu;
use inspect::render::camera::Camera;
use inspect::settings::Settings;
use load::Limits;
use load::source::Source;
use pnaen::app::{App, run};

/// More time than each test needs on two slow cores.
const PATIENCE: Duration = Duration::from_secs(180);

fn main() {
    let arguments: Vec<_> = std::env::args().skip(1).collect();
    if arguments.iter().any(|argument| argument == NO_DIALOG) {
        return without_a_dialog();
    }
    let filter = arguments.iter().find(|argument| !argument.starts_with('-'));
    if arguments.iter().any(|argument| argument == "--list") || filter.is_some_and(|filter| !"display".contains(filter))
    {
        return;
    }
    if !cfg!(target_os = "linux") {
        println!("display: the real window is tested where there is Xvfb");
        return;
    }
    let _display = Display::open().expect("these tests need Xvfb: run ./setup.sh");
    // SAFETY: nothing else runs yet that could read the environment at the same time.
    unsafe { std::env::set_var("PNAEN_CONFIG", "") };
    a_missing_adapter_is_reported_in_one_line();
    closing_while_a_mesh_loads_ends_at_once();
    without_a_file_dialog_a_path_is_typed();
    a_window_replaces_a_lost_device_once_and_then_reports_the_loss();
    println!("display: ok");
}

/// The argument with which this program starts itself as another process, which finds no file dialog.
const NO_DIALOG: &str = "--no-dialog";

/// An X server, which ends with the test.
struct Display(Child);

impl Display {
    fn open() -> Option<Self> {
        let mut command = Command::new("Xvfb");
        // Without -noreset, the server starts anew when its last client goes, and then cuts off a client that came
        // at the same moment.
        command.args(["-displayfd", "1", "-screen", "0", "1500x920x24", "-nolisten", "tcp", "-noreset"]);
        let mut server = command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().ok()?;
        let mut number = String::new();
        BufReader::new(server.stdout.take()?).read_line(&mut number).ok()?;
        // SAFETY: nothing else runs yet that could read the environment at the same time.
        unsafe { std::env::set_var("DISPLAY", format!(":{}", number.trim())) };
        Some(Self(server))
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// The state of a window that must survive the loss of its device.
#[derive(Clone, Debug, PartialEq)]
struct WindowState {
    source: Option<Source>,
    settings: Settings,
    camera: Camera,
    triangle: Option<u32>,
    totals: Option<(u64, u64)>,
}

impl WindowState {
    fn new(app: &App) -> Self {
        Self {
            source: app.source().cloned(),
            settings: *app.settings(),
            camera: *app.camera(),
            triangle: app.selected_triangle(),
            totals: app.totals(),
        }
    }
}

/// Loses the device, as a reset driver does.
fn lose(gpu: &Gpu) {
    gpu.device.destroy();
    let _ = gpu.device.poll(wgpu::PollType::wait_indefinitely());
    assert!(gpu.lost().is_some());
}

/// Saves a picture of the display if `PNAEN_TEST_PICTURES` names a folder, for people who run this by hand.
fn picture(name: &str) {
    if let Some(folder) = std::env::var_os("PNAEN_TEST_PICTURES") {
        let path = std::path::Path::new(&folder).join(name);
        let _ = Command::new("import").args(["-window", "root"]).arg(path).status();
    }
}

fn a_missing_adapter_is_reported_in_one_line() {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pnaen"));
    let output = command.args(["--adapter", "no such thing"]).output().expect("the program starts");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.starts_with("pnaen: no graphics adapter has \"no such thing\" in its name: there are "), "{said}");
    assert_eq!(said.lines().count(), 1, "{said}");
}

fn closing_while_a_mesh_loads_ends_at_once() {
    let slow = "shape:icosphere@6".parse().expect("a shape");
    let closed: Rc<Cell<Option<Instant>>> = Rc::default();
    let (told, mut frames) = (closed.clone(), 0);
    let watch = move |app: &mut App, context: &egui::Context| {
        context.request_repaint();
        frames += 1;
        if frames == 3 {
            assert!(app.source().is_none() && app.is_busy(), "it is still loading");
            told.set(Some(Instant::now()));
            context.send_viewport_cmd(egui::ViewportCommand::Close);
        }
    };
    let ended = run(Some(slow), None, Limits::default(), AdapterChoice::Best, watch);
    let took = closed.get().map(|closed| closed.elapsed());
    assert!(ended.is_ok() && took.is_some_and(|took| took < Duration::from_secs(2)), "{ended:?} {took:?}");
}

fn without_a_file_dialog_a_path_is_typed() {
    let mut command = Command::new(std::env::current_exe().expect("this program"));
    // There is no portal, and no program that could show a dialog.
    command.arg(NO_DIALOG).env("DBUS_SESSION_BUS_ADDRESS", "unix:path=/nowhere").env("PATH", "/nowhere");
    assert!(command.status().expect("this program starts").success());
}

/// The window that asks for a path: its title, and the reason.
type Asked = (&'static str, Option<&'static str>);

fn without_a_dialog() {
    let (start, mut is_requested) = (Instant::now(), false);
    let said: Rc<RefCell<Vec<Asked>>> = Rc::default();
    let seen = said.clone();
    let watch = move |app: &mut App, context: &egui::Context| {
        assert!(start.elapsed() < PATIENCE, "no window asks for a path");
        context.request_repaint();
        if let Some(asked) = app.path_asked_for() {
            assert!(!app.settings().overlays.wireframe, "a key typed meanwhile is no shortcut");
            seen.borrow_mut().push(asked);
            // The window is visible some frames later.
            if seen.borrow().len() == 5 {
                picture("0-no-dialog.png");
                context.send_viewport_cmd(egui::ViewportCommand::Close);
            }
        } else if app.pictures() > 0 && !std::mem::replace(&mut is_requested, true) {
            let press =
                |key, modifiers| egui::Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers };
            let keys = [press(egui::Key::O, egui::Modifiers::COMMAND), press(egui::Key::W, egui::Modifiers::NONE)];
            context.input_mut(|input| input.events.extend(keys));
        }
    };
    let ended = run(None, None, Limits::default(), AdapterChoice::Best, watch);
    assert!(ended.is_ok(), "{ended:?}");
    let said = said.borrow();
    assert!(matches!(said.first(), Some(("Open path", Some(why))) if why.contains("no file dialog")), "{said:?}");
}

fn a_window_replaces_a_lost_device_once_and_then_reports_the_loss() {
    let (start, torus) = (Instant::now(), Source::Shape(Shape::Torus));
    let had: Rc<RefCell<Vec<WindowState>>> = Rc::default();
    let (seen, mut still) = (had.clone(), 0);
    let watch = move |app: &mut App, context: &egui::Context| {
        assert!(start.elapsed() < PATIENCE, "the window got no further than step {}", seen.borrow().len());
        context.request_repaint();
        if app.fatal_message().is_some() {
            still += 1;
            if still == 10 {
                picture("3-farewell.png");
                context.send_viewport_cmd(egui::ViewportCommand::Close);
            }
            return;
        }
        let is_done = app.pictures() > 0 && !app.is_busy() && !app.is_lost();
        still = if is_done { still + 1 } else { 0 };
        if still == 5 {
            app.select_triangle(Some(7));
        } else if still == 10 {
            still = 0;
            let number = seen.borrow().len() + 1;
            picture(&format!("{number}-window.png"));
            seen.borrow_mut().push(WindowState::new(app));
            let gpu = app.gpu().clone();
            match number {
                1 => lose(&gpu),
                // The device is lost after the window's contents are made and before egui paints them.
                _ => context.on_end_pass("lose", Arc::new(move |_| lose(&gpu))),
            }
        }
    };
    let ended = run(Some(torus.clone()), None, Limits::default(), AdapterChoice::Best, watch);
    assert!(ended.is_ok(), "{ended:?}");
    let had = had.borrow();
    assert_eq!(had.len(), 2, "the device was lost twice");
    assert_eq!((had[0].source.as_ref(), had[0].triangle), (Some(&torus), Some(7)));
    assert_eq!(had[0], had[1], "the state is kept");
}

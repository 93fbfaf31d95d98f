//! Settings tried beside the window for its chart: on a thread of its own, and on a device of its own, so that neither
//! waits for the other.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::thread::JoinHandle;
use std::time::Duration;

use super::background_job::{caught, spawn};
use crate::chart::{Bench, Effort, Probe, Row, Setting, Subject};
use crate::engine::{Engine, Loaded};
use crate::gpu::{Gpu, GpuError};
use crate::mesh::Moment;
use crate::progress::Progress;
use crate::render::{Camera, Target};
use crate::settings::{ARENA_BYTES, Settings};
use crate::truth::Truth;

/// What points of a chart are about, besides the settings that they are of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Of {
    pub document: u64,
    pub moment: Option<Moment>,
    /// Tells one truth from the next.
    pub truth: u64,
    pub camera: Camera,
    /// Of the view, in px.
    pub size: [u32; 2],
    /// What all settings that are tried have in common.
    pub base: Settings,
}

/// What a run needs.
pub(crate) struct Job {
    pub adapter: wgpu::Adapter,
    pub loaded: Loaded,
    pub of: Of,
    pub truth: Option<Arc<Truth>>,
    /// What the window has, if the list doesn't.
    pub current: Option<Settings>,
    pub settings: Vec<Setting>,
    pub effort: Effort,
}

/// What is known.
pub(crate) struct Charted {
    pub of: Of,
    pub subject: Subject,
    /// Settings of more triangles than are measured.
    pub left_out: Vec<Setting>,
    /// The truth's bounding diagonal, in object units, of which errors are parts.
    pub diagonal: Option<f64>,
    /// What the window had when it was last measured beside the list; nothing if those were too many triangles.
    pub current: Option<(Settings, Option<Probe>)>,
}

impl Charted {
    pub(crate) fn new(of: Of, title: String, truth: Option<(&Truth, String)>, adapter: String) -> Self {
        let (diagonal, truth) = truth.map(|(truth, words)| (truth.diagonal(), words)).unzip();
        let subject = Subject { title, truth, adapter, size: of.size, rows: Vec::new() };
        Self { of, subject, left_out: Vec::new(), diagonal, current: None }
    }

    /// Takes a row to its place among those of its method, from coarse to fine.
    fn add(&mut self, row: Row) {
        let rows = &mut self.subject.rows;
        let finer = rows.iter().position(|other| other.setting.is_finer(&row.setting));
        rows.insert(finer.unwrap_or(rows.len()), row);
    }

    /// Whether this setting was tried.
    pub(crate) fn has(&self, setting: &Setting) -> bool {
        self.left_out.contains(setting) || self.row(setting).is_some()
    }

    pub(crate) fn row(&self, setting: &Setting) -> Option<&Row> {
        self.subject.rows.iter().find(|row| row.setting == *setting)
    }
}

/// Runs, one at a time.
#[derive(Default)]
pub(crate) struct ChartJob {
    /// Kept while the chart is open, because making its pipelines takes longer than measuring a setting.
    engine: Option<Engine>,
    running: Option<Running>,
    /// A run that was cancelled may not have ended yet; the next one waits for it.
    last: Option<JoinHandle<()>>,
    pub charted: Option<Charted>,
}

/// A run under way; dropping it cancels it.
struct Running {
    found: Receiver<Found>,
    wanted: Progress,
    /// While this is set nothing new is tried.
    held: Arc<AtomicBool>,
    done: usize,
    all: usize,
}

impl Drop for Running {
    fn drop(&mut self) {
        self.wanted.cancel();
    }
}

enum Found {
    Engine(Box<Engine>),
    Row(Box<Row>),
    LeftOut(Setting),
    Current(Box<Settings>, Option<Probe>),
    /// Why, in a sentence.
    Failed(String),
}

impl ChartJob {
    /// How many settings were tried, and how many there are, while they are.
    pub(crate) fn progress(&self) -> Option<(usize, usize)> {
        self.running.as_ref().map(|running| (running.done, running.all))
    }

    /// Starts a run, whose results go into what is known.
    pub(crate) fn start(&mut self, context: &egui::Context, job: Job) {
        self.stop();
        let (sender, found) = channel();
        let (wanted, held) = (Progress::new(), Arc::new(AtomicBool::new(false)));
        let all = job.settings.len() + usize::from(job.current.is_some());
        let (engine, last, context) = (self.engine.clone(), self.last.take(), context.clone());
        let worker = Worker { sender, wanted: wanted.clone(), held: held.clone(), context };
        self.running = Some(Running { found, wanted, held, done: 0, all });
        self.last = spawn(move || {
            // One that failed has said so.
            let _ = last.map(JoinHandle::join);
            let failed = match caught(|| worker.run(job, engine)) {
                Ok(run) => run.err().map(|error| format!("The chart could not be measured: {error}")),
                Err(stopped) => Some(format!("Measuring the chart {stopped}")),
            };
            if let Some(why) = failed {
                worker.say(Found::Failed(why));
            }
            worker.context.request_repaint();
        });
    }

    /// Stops what is under way; what is known stays known.
    pub(crate) fn stop(&mut self) {
        self.running = None;
    }

    /// Frees the device.
    pub(crate) fn close(&mut self) {
        self.stop();
        self.engine = None;
    }

    /// Lets what is under way wait before it tries anything new, or go on.
    pub(crate) fn hold(&self, hold: bool) {
        if let Some(running) = &self.running {
            running.held.store(hold, Ordering::Relaxed);
        }
    }

    /// Takes what has come in.
    ///
    /// # Errors
    /// The run has failed: why.
    pub(crate) fn take(&mut self) -> Result<(), String> {
        let Some(running) = &mut self.running else { return Ok(()) };
        let Some(charted) = &mut self.charted else { return Ok(()) };
        loop {
            match running.found.try_recv() {
                Ok(Found::Engine(engine)) => {
                    self.engine = Some(*engine);
                    continue;
                }
                Ok(Found::Row(row)) => charted.add(*row),
                Ok(Found::LeftOut(setting)) => charted.left_out.push(setting),
                Ok(Found::Current(settings, probe)) => charted.current = Some((*settings, probe)),
                Ok(Found::Failed(why)) => {
                    self.close();
                    return Err(why);
                }
                Err(TryRecvError::Empty) => return Ok(()),
                Err(TryRecvError::Disconnected) => {
                    let is_whole = running.done == running.all;
                    self.stop();
                    return if is_whole { Ok(()) } else { Err("Measuring the chart stopped unexpectedly".into()) };
                }
            }
            running.done += 1;
        }
    }
}

/// The thread's side.
struct Worker {
    sender: Sender<Found>,
    wanted: Progress,
    held: Arc<AtomicBool>,
    context: egui::Context,
}

impl Worker {
    fn say(&self, found: Found) {
        // Nobody listens any more if the run was cancelled.
        let _ = self.sender.send(found);
        self.context.request_repaint();
    }

    /// Waits while it is held; whether to go on then.
    fn goes_on(&self) -> bool {
        while self.held.load(Ordering::Relaxed) && self.wanted.check().is_ok() {
            std::thread::sleep(Duration::from_millis(10));
        }
        self.wanted.check().is_ok()
    }

    fn run(&self, job: Job, engine: Option<Engine>) -> Result<(), GpuError> {
        let engine = match engine {
            Some(engine) => engine,
            None => Engine::new(Gpu::on(&job.adapter)?),
        };
        self.say(Found::Engine(Box::new(engine.clone())));
        let Of { moment, camera, size, base, .. } = job.of;
        // As much as what is measured takes at most, in one piece.
        let mut scene = engine.scene(&job.loaded, ARENA_BYTES / 4)?;
        scene.frame_clip(moment.map(|moment| moment.clip));
        scene.set_moment(moment)?;
        let target = Target::new(&engine.gpu, size)?;
        let (mesh, truth) = (job.loaded.source.to_string(), job.truth.as_deref());
        let mut bench =
            Bench { engine: &engine, mesh, scene, target: &target, camera, truth, base, effort: job.effort };
        if let Some(settings) = job.current.filter(|_| self.goes_on()) {
            let probe = bench.probe(&settings)?;
            engine.gpu.check()?;
            self.say(Found::Current(Box::new(settings), probe));
        }
        for setting in job.settings {
            if !self.goes_on() {
                break;
            }
            let row = bench.measure(&setting)?;
            engine.gpu.check()?;
            self.say(row.map_or(Found::LeftOut(setting), |row| Found::Row(Box::new(row))));
        }
        Ok(())
    }
}

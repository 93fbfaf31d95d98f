//! Measures settings for the window's chart, on a thread and a device of its own, so that neither the window nor the
//! measurement waits for the other.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::Duration;

use super::background_job::caught;
use super::job_list::Work;
use crate::app::App;
use geometry::mesh::Moment;
use geometry::progress::Progress;
use gpu::{Gpu, GpuError};
use inspect::engine::{Engine, Loaded};
use inspect::reference_shape::ReferenceShape;
use inspect::render::{Camera, Target};
use inspect::settings::{ARENA_BYTES, Settings};
use lab::chart::{Bench, Cost, Effort, Plan, Probe, Row, Setting, Subject};

/// What all points of a chart have in common: mesh, pose, reference surface, view and settings that aren't tried.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ChartBasis {
    pub document: u64,
    pub moment: Option<Moment>,
    /// Counts reference surfaces; see [`App::yardstick`](crate::app::App).
    pub reference_shape: u64,
    pub camera: Camera,
    /// Width and height of the view, in px.
    pub size: [u32; 2],
    /// The settings that aren't varied.
    pub base: Settings,
}

/// What a run needs.
struct Job {
    adapter: wgpu::Adapter,
    loaded: Loaded,
    of: ChartBasis,
    reference_shape: Option<Arc<ReferenceShape>>,
    /// The window's settings, if the list doesn't have them.
    current: Option<Settings>,
    settings: Vec<Setting>,
    effort: Effort,
}

pub(crate) struct Charted {
    pub of: ChartBasis,
    pub subject: Subject,
    /// Settings that have too many triangles to be measured.
    pub left_out: Vec<Setting>,
    /// The diagonal of the reference surface's bounding box, in object units. Errors are given as fractions of it.
    pub diagonal: Option<f64>,
    /// The window's settings that were last measured beside the list; without a result if they have too many triangles.
    pub current: Option<(Settings, Option<Probe>)>,
}

impl Charted {
    /// Inserts a row among those of its method, which go from coarse to fine.
    fn add(&mut self, row: Row) {
        let rows = &mut self.subject.rows;
        let finer = rows.iter().position(|other| other.setting.is_finer(&row.setting));
        rows.insert(finer.unwrap_or(rows.len()), row);
    }

    /// Whether this setting was measured or left out.
    pub(crate) fn has(&self, setting: &Setting) -> bool {
        self.left_out.contains(setting) || self.row(setting).is_some()
    }

    pub(crate) fn row(&self, setting: &Setting) -> Option<&Row> {
        self.subject.rows.iter().find(|row| row.setting == *setting)
    }
}

/// The chart, which measures one list of settings at a time.
#[derive(Default)]
pub(crate) struct Chart {
    pub is_open: bool,
    pub cost: Cost,
    /// The surfaces and LODs that are tried. Normals are those of the window.
    pub plan: Plan,
    pub effort: Effort,
    /// The window's settings, if they aren't in the chart, and since when they are unchanged, on the window's clock in s.
    pub still: Option<(Settings, f64)>,
    /// Kept while the chart is open, because making its pipelines takes longer than measuring a setting.
    engine: Option<Engine>,
    /// How many settings of the last run are done, and how many there are.
    progress: (usize, usize),
    /// While this is set, no new setting is measured.
    pub held: Arc<AtomicBool>,
    /// A run that was cancelled may not have ended yet; the next one waits for it.
    last: Option<JoinHandle<()>>,
    pub charted: Option<Charted>,
}

enum ChartMessage {
    Engine(Box<Engine>),
    Row(Box<Row>),
    LeftOut(Setting),
    Current(Box<Settings>, Option<Probe>),
    /// Why, in a sentence.
    Failed(String),
}

impl App {
    /// Starts to measure settings and the window's own, with the effort of the command's chart, but with one core left for the window. The
    /// results are added to those so far.
    pub(in crate::app) fn start_charting(
        &mut self,
        context: &egui::Context,
        of: ChartBasis,
        current: Option<Settings>,
        settings: Vec<Setting>,
    ) {
        let Some(loaded) = self.document.as_ref().map(|document| document.loaded.clone()) else { return };
        let (adapter, reference_shape) = (self.render_state.adapter.clone(), self.yardstick().1);
        let chart = &mut self.panels.chart;
        let mut effort = chart.effort;
        effort.accuracy.threads = effort.accuracy.threads.saturating_sub(1).max(1);
        chart.progress = (0, settings.len() + usize::from(current.is_some()));
        chart.held = Arc::default();
        let (engine, last, held) = (chart.engine.clone(), chart.last.take(), chart.held.clone());
        let job = Job { adapter, loaded, of, reference_shape, current, settings, effort };
        let run = move |wanted: &Progress, say: &dyn Fn(ChartMessage) -> bool| {
            // If the last run failed, it has reported that itself.
            let _ = last.map(JoinHandle::join);
            let failed = match caught(|| measure(job, engine, wanted, &held, say)) {
                Ok(run) => run.err().map(|error| format!("The chart could not be measured: {error}")),
                Err(stopped) => Some(format!("Measuring the chart {stopped}")),
            };
            failed.into_iter().for_each(|why| _ = say(ChartMessage::Failed(why)));
        };
        chart.last = self.jobs.follow(context, Work::Chart, run, |app, _, message| app.take_charted(message));
    }

    /// How many of the chart's settings are done, and how many there are; none if it isn't measuring.
    pub fn charting(&self) -> Option<(usize, usize)> {
        self.jobs.has(Work::Chart).then_some(self.panels.chart.progress)
    }

    /// Stops measuring and frees the chart's device. The results so far stay.
    pub(in crate::app) fn close_chart(&mut self) {
        self.jobs.stop(Work::Chart);
        self.panels.chart.still = None;
        self.panels.chart.engine = None;
    }

    /// Takes what a run has found; none if it has ended.
    fn take_charted(&mut self, message: Option<ChartMessage>) {
        let Chart { engine, progress, charted, .. } = &mut self.panels.chart;
        match (message, charted) {
            (Some(ChartMessage::Engine(made)), _) => return *engine = Some(*made),
            (Some(ChartMessage::Row(row)), Some(charted)) => charted.add(*row),
            (Some(ChartMessage::LeftOut(setting)), Some(charted)) => charted.left_out.push(setting),
            (Some(ChartMessage::Current(settings, probe)), Some(charted)) => charted.current = Some((*settings, probe)),
            (Some(ChartMessage::Failed(why)), _) => {
                self.close_chart();
                return self.dialogs.error = Some(why);
            }
            (None, _) => {
                if progress.0 < progress.1 {
                    self.dialogs.error = Some("Measuring the chart stopped unexpectedly".into());
                }
                return;
            }
            (_, None) => {}
        }
        progress.0 += 1;
    }
}

/// Measures all settings of a run, and says what it finds, which nobody wants if the run was cancelled.
fn measure(
    job: Job,
    engine: Option<Engine>,
    wanted: &Progress,
    held: &AtomicBool,
    say: &dyn Fn(ChartMessage) -> bool,
) -> Result<(), GpuError> {
    // Waits while the run is held, and returns whether to go on.
    let goes_on = || {
        while held.load(Ordering::Relaxed) && wanted.check().is_ok() {
            std::thread::sleep(Duration::from_millis(10));
        }
        wanted.check().is_ok()
    };
    let engine = match engine {
        Some(engine) => engine,
        None => Engine::new(Gpu::on(&job.adapter)?),
    };
    say(ChartMessage::Engine(Box::new(engine.clone())));
    let ChartBasis { moment, camera, size, base, .. } = job.of;
    // Enough for the largest number of triangles that is measured, in one chunk.
    let mut scene = engine.scene(&job.loaded, ARENA_BYTES / 4)?;
    scene.frame_clip(moment.map(|moment| moment.clip));
    scene.set_moment(moment)?;
    let target = Target::new(&engine.gpu, size)?;
    let (mesh, reference_shape) = (job.loaded.source.to_string(), job.reference_shape.as_deref());
    let mut bench =
        Bench { engine: &engine, mesh, scene, target: &target, camera, reference_shape, base, effort: job.effort };
    if let Some(settings) = job.current.filter(|_| goes_on()) {
        let probe = bench.probe(&settings)?;
        engine.gpu.check()?;
        say(ChartMessage::Current(Box::new(settings), probe));
    }
    for setting in job.settings {
        if !goes_on() {
            break;
        }
        let row = bench.measure(&setting)?;
        engine.gpu.check()?;
        say(row.map_or(ChartMessage::LeftOut(setting), |row| ChartMessage::Row(Box::new(row))));
    }
    Ok(())
}

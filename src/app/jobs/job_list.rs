//! The jobs that are under way: one list, which is polled, waited for and stopped in one place.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{TryRecvError, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use super::background_job::{BackgroundJob, Stopped, spawn};
use super::patience::Patience;
use crate::app::App;
use crate::commands::CompanionFile;
use geometry::progress::Progress;
use inspect::engine::{Loaded, Preparation};
use inspect::settings::Settings;
use load::files::Limits;
use load::{MorphWeights, Source};

/// What a job is for. There is one job for each at most: a new one takes the place of the one before it, which is stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Work {
    Mesh,
    /// Reading what is open beside the mesh. Factors are compared, too, under another convention, and the files of shaders watched, which
    /// goes on after the first version.
    Companion(CompanionFile),
    /// Watching the mesh's files.
    MeshFiles,
    /// Finding the meshes beside the one that is open.
    Folder,
    /// A file that is being written.
    File,
    Dialog,
    /// The window's state, which is being saved.
    State,
    Checks,
    Explanation,
    /// Measuring settings for the chart.
    Chart,
    /// Measuring moments of a clip.
    Clip,
    /// The scene of the left half.
    LeftHalf,
    /// The mesh that previews draw in place of a large one.
    StandIn,
}

/// What is done in the window with what a job found.
type Landing = Box<dyn FnOnce(&mut App, &egui::Context)>;

/// A job under way. Dropping it cancels it, and nothing is done with what it finds.
pub(crate) struct Job {
    work: Work,
    /// What is under way, such as "Saving torus.png", if it is shown.
    pub title: String,
    pub progress: Progress,
    pub since: Instant,
    /// Returns what the job has found since the last call.
    poll: Box<dyn FnMut() -> Option<Landing>>,
    has_landed: bool,
}

impl Drop for Job {
    fn drop(&mut self) {
        self.progress.cancel();
    }
}

/// How often jobs are polled that would wake a window that is closed.
const EVERY: Duration = Duration::from_millis(50);

/// The load of a mesh, and what it is to become.
pub(crate) struct Load {
    pub source: Source,
    /// How the mesh is being prepared.
    pub preparation: Preparation,
    /// Whether the camera stays where it is, because the same mesh is loaded again.
    pub keep_view: bool,
    /// Whether it is loaded because it has changed on disk.
    pub has_changed: bool,
    /// Whether it is the mesh of the left half, which gets the one that is open.
    pub exchanges: bool,
}

/// What is left of the split in place of the mesh that is open.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum LeftChoice {
    /// The mesh as it was before its file changed on disk, or when it was kept.
    Kept(Arc<Kept>),
    /// The mesh of a source, or without one the same mesh, with these weights of morph targets.
    Read(Option<Source>, MorphWeights),
}

/// A mesh as it was.
#[derive(Clone, Debug)]
pub(crate) struct Kept {
    pub loaded: Loaded,
    /// How often its file had changed.
    pub version: u64,
}

impl PartialEq for Kept {
    fn eq(&self, other: &Self) -> bool {
        self.version == other.version && self.loaded.is_prepared_as(&other.loaded)
    }
}

#[derive(Default)]
pub(crate) struct Jobs {
    jobs: Vec<Job>,
    /// Whether some were started by a window that is closed.
    pub of_another_window: bool,
    pub limits: Limits,
    /// What is being loaded, or was loaded last.
    pub last_load: Option<Load>,
    /// The file of light that is being read, or was read last.
    pub light: Option<PathBuf>,
    /// The source of the reference surface that is being read, or was read last; none for the limit of the mesh's own cage. Then
    /// whether deviation is shown once it is read.
    pub reference: (Option<Source>, bool),
    /// What is being read for the left half, or was read last.
    pub left: Option<LeftChoice>,
    /// Of the mesh's files, which are watched.
    pub patience: Arc<Patience>,
}

impl Jobs {
    pub(crate) fn new(limits: Limits) -> Self {
        Self { limits, ..Self::default() }
    }

    /// The load of a mesh that is under way.
    pub(crate) fn load(&self) -> Option<&Load> {
        self.last_load.as_ref().filter(|_| self.has(Work::Mesh))
    }

    /// Starts a job on a thread of its own. `land` gets its result, or why there is none, in the window.
    pub(crate) fn start<T: Send + 'static>(
        &mut self,
        context: &egui::Context,
        work: Work,
        title: String,
        job: impl FnOnce(&Progress) -> T + Send + 'static,
        land: impl FnOnce(&mut App, &egui::Context, Result<T, Stopped>) + 'static,
    ) {
        let progress = Progress::new();
        let own = progress.clone();
        let running = BackgroundJob::start(context, move || job(&own));
        let mut land = Some(land);
        let poll = move || {
            let (ended, land) = (running.take()?, land.take()?);
            let landing: Landing = Box::new(move |app, context| {
                app.jobs.stop(work);
                land(app, context, ended);
            });
            Some(landing)
        };
        let (since, poll) = (Instant::now(), Box::new(poll));
        self.add(Job { work, title, progress, since, poll, has_landed: false });
    }

    /// Starts a job that goes on after it has found something, on a thread of its own. It says each thing that it finds, which returns
    /// false once nobody wants it any more. `land` gets it in the window; none if the job has ended, which is then over.
    pub(crate) fn follow<T: Send + 'static>(
        &mut self,
        context: &egui::Context,
        work: Work,
        job: impl FnOnce(&Progress, &dyn Fn(T) -> bool) + Send + 'static,
        land: impl Fn(&mut App, &egui::Context, Option<T>) + Copy + 'static,
    ) -> Option<JoinHandle<()>> {
        let (sender, found) = channel();
        let (progress, context) = (Progress::new(), context.clone());
        let wanted = progress.clone();
        let poll = move || {
            let found = found.try_recv();
            let is_there = !matches!(found, Err(TryRecvError::Empty));
            let landing = move |app: &mut App, context: &egui::Context| {
                if found.is_err() {
                    app.jobs.stop(work);
                }
                land(app, context, found.ok());
            };
            is_there.then(|| Box::new(landing) as Landing)
        };
        let (title, since, poll) = (String::new(), Instant::now(), Box::new(poll));
        self.add(Job { work, title, progress, since, poll, has_landed: false });
        spawn(move || {
            job(&wanted, &|found| {
                let is_wanted = sender.send(found).is_ok();
                context.request_repaint();
                is_wanted
            });
            drop(sender);
            context.request_repaint();
        })
    }

    fn add(&mut self, job: Job) {
        self.stop(job.work);
        self.jobs.push(job);
    }

    pub(crate) fn get(&self, work: Work) -> Option<&Job> {
        self.jobs.iter().find(|job| job.work == work)
    }

    pub(crate) fn has(&self, work: Work) -> bool {
        self.get(work).is_some()
    }

    /// Stops a job, if there is one. Nothing is done with what it finds.
    pub(crate) fn stop(&mut self, work: Work) {
        self.jobs.retain(|job| job.work != work);
    }

    /// Stops the jobs about a document that is open no more.
    pub(crate) fn stop_of_document(&mut self) {
        use Work::{Chart, Checks, Clip, Explanation, Folder, LeftHalf, MeshFiles, StandIn};
        let is_of_document =
            |work| matches!(work, Checks | Clip | Explanation | Chart | LeftHalf | StandIn | MeshFiles | Folder);
        self.jobs.retain(|job| !is_of_document(job.work));
    }

    /// Whether something is under way that the picture, or what is said about it, waits for.
    pub(crate) fn is_busy(&self) -> bool {
        use Work::{Chart, Checks, Clip, Dialog, File, Folder, MeshFiles, StandIn, State};
        let goes_on_beside =
            |work| matches!(work, Clip | File | Dialog | State | Checks | Chart | StandIn | MeshFiles | Folder);
        self.jobs.iter().any(|job| !goes_on_beside(job.work) && !job.has_landed)
    }

    /// Whether a file beside the mesh is being read.
    pub(crate) fn opens_companions(&self) -> bool {
        self.jobs.iter().any(|job| matches!(job.work, Work::Companion(_)) && !job.has_landed)
    }

    /// Waits for a job, whose result isn't wanted.
    pub(crate) fn wait_for(&mut self, work: Work) {
        for job in self.jobs.iter_mut().filter(|job| job.work == work) {
            while (job.poll)().is_none() {
                std::thread::sleep(Duration::from_millis(1));
            }
        }
        self.stop(work);
    }

    /// Takes what a job has found. The scene of the left half waits until no picture is under way.
    fn take(&mut self, is_free: bool) -> Option<(Work, Landing)> {
        let is_ready = |job: &Job| is_free || job.work != Work::LeftHalf;
        self.jobs.iter_mut().filter(|job| is_ready(job)).find_map(|job| {
            let landing = (job.poll)()?;
            job.has_landed = true;
            Some((job.work, landing))
        })
    }
}

impl App {
    /// Takes what jobs have found. Files of a step of undo change no settings: these are as in that step, but for what the user has set
    /// since.
    pub(in crate::app) fn take_found(&mut self, context: &egui::Context) {
        // Framing a mesh needs the viewport's size, which is known after the first frame.
        if self.viewport.picture.target.is_none() {
            return;
        }
        while let Some((work, land)) = self.jobs.take(self.viewport.picture.is_free()) {
            let settings = self.settings_without_files();
            land(self, context);
            if self.takes_back && matches!(work, Work::Mesh | Work::Companion(_)) {
                // If the mesh wasn't read anew, its import is the one that is there.
                self.put_settings(Settings { import: self.settings.import, ..settings });
            }
        }
        self.jobs.of_another_window &= !self.jobs.jobs.is_empty();
        if self.jobs.of_another_window {
            context.request_repaint_after(EVERY);
        }
    }
}

//! A file that is being written on a thread of its own.

use std::path::{Path, PathBuf};

use super::background_job::{BackgroundJob, Stopped};
use geometry::names::shown_path;
use geometry::progress::Progress;

/// A file under way; dropping this cancels it, and then nothing is written.
pub(crate) struct WritingJob {
    pub progress: Progress,
    /// What is done with the file, such as "Saving".
    doing: &'static str,
    path: PathBuf,
    /// None only for a moment, inside [`Self::wake`].
    job: Option<BackgroundJob<Result<Vec<String>, String>>>,
}

impl WritingJob {
    /// Starts to write a file. `write` returns sentences about what couldn't be written, or fails with one, and ends early if it is
    /// cancelled.
    pub(crate) fn start(
        context: &egui::Context,
        doing: &'static str,
        path: PathBuf,
        write: impl FnOnce(&Path, &Progress) -> Result<Vec<String>, String> + Send + 'static,
    ) -> Self {
        let progress = Progress::new();
        let (own_path, own_progress) = (path.clone(), progress.clone());
        let job = BackgroundJob::start(context, move || write(&own_path, &own_progress));
        Self { progress, doing, path, job: Some(job) }
    }

    /// What is under way, such as "Saving torus.png".
    pub(crate) fn title(&self) -> String {
        format!("{} {}", self.doing, shown_path(Path::new(self.path.file_name().unwrap_or_default())))
    }

    /// Returns sentences once the file is written, or as an error why nothing was.
    pub(crate) fn take(&self) -> Option<Result<String, String>> {
        let stopped = |stopped: Stopped| Err(format!("{}: writing it {stopped}", shown_path(&self.path)));
        let ended = self.job.as_ref()?.take()?.unwrap_or_else(stopped);
        let said = |warnings| [vec![format!("{} is written.", shown_path(&self.path))], warnings].concat().join("\n");
        Some(ended.map(said))
    }

    /// Lets the job repaint another window when it ends.
    pub(crate) fn wake(&mut self, context: &egui::Context) {
        self.job = self.job.take().map(|job| job.waking(context));
    }
}

impl Drop for WritingJob {
    fn drop(&mut self) {
        self.progress.cancel();
    }
}

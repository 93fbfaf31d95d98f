//! What takes long and can be stopped. One at a time is shown over the picture, and stopped there or by its key.

use super::windows::Notice;
use crate::app::App;
use crate::app::jobs::job_list::{Job, Work};
use crate::commands::CompanionFile;
use geometry::progress::Stage;

/// The jobs that are shown, and what stopping them does, in sentences.
const SHOWN: [(Work, &str); 6] = [
    (Work::Mesh, "Stops loading. The mesh that is open stays."),
    (Work::Companion(CompanionFile::ReferenceShape), "Stops loading. The reference surface before it stays."),
    (Work::Companion(CompanionFile::LeftMesh), "Stops loading. The left half stays as it is."),
    (Work::Clip, "Stops measuring. The clip stays."),
    (Work::Companion(CompanionFile::Environment), "Stops reading. The light before it stays."),
    (Work::File, "Stops it. Nothing is written."),
];

pub(crate) struct UnderWay {
    /// None is a long drawing.
    work: Option<Work>,
    /// A clause such as "Saving torus.png".
    pub title: String,
    /// From 0 to 1.
    pub done: f32,
    /// About how many, if that is known.
    pub seconds_left: Option<f64>,
    /// Sentences about what stopping it does.
    pub stopping: &'static str,
}

impl App {
    /// What is under way; of several, the first in the order of [`SHOWN`], and at last a long drawing.
    pub(in crate::app) fn under_way(&self) -> Option<UnderWay> {
        let mut jobs = SHOWN.iter().filter_map(|(work, stopping)| Some((*work, self.jobs.get(*work)?, *stopping)));
        if let Some((work, job, stopping)) = jobs.next() {
            let title = if work == Work::Mesh { self.load_title(job) } else { job.title.clone() };
            let done = job.progress.fraction();
            return Some(UnderWay { work: Some(work), title, done, seconds_left: None, stopping });
        }
        let drawing = self.viewport.picture.drawing.as_ref().filter(|_| self.viewport.picture.is_long())?;
        Some(UnderWay {
            work: None,
            title: format!("Drawing {}", self.triangles()),
            done: drawing.done(),
            seconds_left: drawing.seconds_left(),
            stopping: "Stops drawing. The last picture and all settings stay.",
        })
    }

    fn load_title(&self, job: &Job) -> String {
        let load = self.jobs.load();
        let heights = load.and_then(|load| load.preparation.heights.as_ref());
        match (job.progress.stage(), heights, load) {
            (Stage::Heights, Some(heights), _) => format!("Reading heights: {}", heights.title()),
            (Stage::Device, _, Some(load)) => format!("Preparing to draw {}", load.source.title()),
            _ => job.title.clone(),
        }
    }

    /// Stops it, and says so. Over a drawing that was stopped the picture itself says it.
    pub(in crate::app) fn stop(&mut self, under_way: &UnderWay) {
        let Some(work) = under_way.work else { return self.viewport.picture.cancel() };
        self.jobs.stop(work);
        match work {
            Work::Mesh => self.keep_file_choices(),
            Work::Companion(CompanionFile::Environment) => self.cancel_environment(),
            _ => {}
        }
        self.dialogs.notice = Some(Notice::new(format!("Stopped: {}.", under_way.title)));
    }
}

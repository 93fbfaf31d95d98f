//! What takes long and can be stopped. One at a time is shown over the picture, and stopped there or by its key.

use super::notice::Notice;
use crate::app::App;
use crate::app::jobs::environment_job::file_name;
use geometry::progress::Stage;

/// Something that can be stopped.
#[derive(Clone, Copy, PartialEq)]
enum Work {
    Mesh,
    Truth,
    Light,
    File,
    Drawing,
}

/// What is under way, as it is shown.
pub(crate) struct UnderWay {
    work: Work,
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
    /// What is under way; of several, the first in this order.
    pub(in crate::app) fn under_way(&self) -> Option<UnderWay> {
        let (jobs, picture) = (&self.jobs, &self.viewport.picture);
        let (work, title, done, stopping) = if let Some(load) = &jobs.load {
            let title = match (load.progress.stage(), &load.preparation.heights) {
                (Stage::Heights, Some(heights)) => format!("Reading heights: {}", heights.title()),
                (Stage::Device, _) => format!("Preparing to draw {}", load.source.title()),
                _ => format!("Loading {}", load.source.title()),
            };
            (Work::Mesh, title, load.progress.fraction(), "Stops loading. The mesh that is open stays.")
        } else if let Some(load) = &jobs.truth_load {
            let title = format!("Loading the reference surface {}", load.source.title());
            (Work::Truth, title, load.progress.fraction(), "Stops loading. The reference surface before it stays.")
        } else if let Some(load) = &jobs.environment {
            let title = format!("Reading the light of {}", file_name(&load.path));
            (Work::Light, title, load.progress.fraction(), "Stops reading. The light before it stays.")
        } else if let Some(writing) = &jobs.writing {
            (Work::File, writing.title(), writing.progress.fraction(), "Stops it. Nothing is written.")
        } else {
            let drawing = picture.drawing.as_ref().filter(|_| picture.is_long())?;
            let title = format!("Drawing {}", self.triangles());
            (Work::Drawing, title, drawing.done(), "Stops drawing. The last picture and all settings stay.")
        };
        let drawing = picture.drawing.as_ref().filter(|_| work == Work::Drawing);
        Some(UnderWay { work, title, done, seconds_left: drawing.and_then(|drawing| drawing.seconds_left()), stopping })
    }

    /// Stops it, and says so. Over a drawing that was stopped the picture itself says it.
    pub(in crate::app) fn stop(&mut self, under_way: &UnderWay) {
        match under_way.work {
            Work::Mesh => {
                self.jobs.load = None;
                self.keep_file_choices();
            }
            Work::Truth => self.jobs.truth_load = None,
            Work::Light => self.cancel_environment(),
            Work::File => self.jobs.writing = None,
            Work::Drawing => return self.viewport.picture.cancel(),
        }
        self.dialogs.notice = Some(Notice::new(format!("Stopped: {}.", under_way.title)));
    }
}

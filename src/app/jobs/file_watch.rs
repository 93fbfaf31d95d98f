//! Watches files for changes on disk.

use std::path::PathBuf;
use std::time::Duration;

use super::job_list::Work;
use super::patience::Patience;
use crate::app::App;
use geometry::progress::Progress;
use load::files::Stamp;
use load::{HeightSource, Source};

/// How often files are looked at.
const EVERY: Duration = Duration::from_millis(200);

/// Files with the stamps that they had when they were read; none for a file that wasn't there.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Stamped(Vec<(PathBuf, Option<Stamp>)>);

impl Stamped {
    pub(crate) fn now(paths: impl IntoIterator<Item = PathBuf>) -> Self {
        let stamped = |path: PathBuf| {
            let stamp = Stamp::of(&path);
            (path, stamp)
        };
        Self(paths.into_iter().map(stamped).collect())
    }

    /// Adds files after these.
    pub(crate) fn and(mut self, others: Self) -> Self {
        self.0.extend(others.0);
        self
    }

    /// Whether the first file is there. A program may replace a file by another, so that it is missing for a moment.
    fn is_there(&self) -> bool {
        self.0.first().is_some_and(|(_, stamp)| stamp.is_some())
    }
}

/// Calls `changed` after every change of the files, once enough looks find them the same: what is still being written is waited for.
/// Ends when nobody wants it any more, or when `changed` returns false.
pub(super) fn watch(mut known: Stamped, patience: &Patience, wanted: &Progress, mut changed: impl FnMut() -> bool) {
    let (mut last, mut needed, mut alike) = (known.clone(), 0, 0);
    while wanted.check().is_ok() {
        std::thread::sleep(EVERY);
        let now = Stamped::now(known.0.iter().map(|(path, _)| path.clone()));
        if now == last {
            alike += 1;
        } else {
            needed = if last == known { patience.begin() } else { needed };
            (last, alike) = (now, 0);
        }
        if last != known && alike >= needed && last.is_there() {
            known = last.clone();
            patience.end();
            if !changed() {
                return;
            }
        }
    }
}

/// The files that a mesh is read from, besides those that it names.
pub(crate) fn sources(source: &Source, heights: Option<&HeightSource>) -> Vec<PathBuf> {
    let mesh = if let Source::File(path) = source { Some(path) } else { None };
    let heights = heights.map(HeightSource::files).unwrap_or_default();
    mesh.into_iter().cloned().chain(heights.into_iter().map(Into::into)).collect()
}

impl App {
    /// Loads the mesh again whenever it, or a file that it names, has changed on disk. A version that can't be read leaves the one that
    /// is shown.
    pub(in crate::app) fn watch_mesh(&mut self, context: &egui::Context) {
        let Some(files) = self.document.as_ref().map(|document| document.files.clone()) else { return };
        if !matches!(self.source(), Some(Source::File(_))) {
            return;
        }
        let patience = self.jobs.patience.clone();
        let watch =
            move |wanted: &Progress, changed: &dyn Fn(()) -> bool| watch(files, &patience, wanted, || changed(()));
        self.jobs.follow(context, Work::MeshFiles, watch, |app, context, change| {
            if change.is_some() && app.jobs.load().is_none_or(|load| load.keep_view) {
                app.reload(context);
                app.jobs.last_load.iter_mut().for_each(|load| load.has_changed = true);
            }
        });
    }
}

//! A mesh left of the split in place of the one that is open: that of another file, or the one before its file changed on disk.

use super::companion_files::new_generation;
use super::job_list::Work;
use crate::app::App;
use geometry::progress::Progress;
use inspect::engine::{self, Loaded, Preparation};
use load::Source;

pub(crate) struct LeftMesh {
    /// What it was read from; none for the mesh before its file changed.
    pub source: Option<Source>,
    pub loaded: Loaded,
    /// A number of its own for each mesh, from 2 on.
    pub generation: u64,
}

impl LeftMesh {
    pub(crate) fn title(&self) -> String {
        self.source.as_ref().map_or_else(|| "before the change".to_owned(), Source::title)
    }
}

impl App {
    /// Starts to load the mesh of another file for the left half. Until it is loaded, what is there stays.
    pub(in crate::app) fn open_left_mesh(&mut self, context: &egui::Context, source: Source) {
        let import = self.preparation().import;
        let preparation = Preparation { import, limits: self.jobs.limits, ..Preparation::default() };
        let wanted = source.clone();
        let load =
            move |progress: &Progress| engine::load(&wanted, &preparation, progress).map_err(|error| error.to_string());
        let title = format!("Loading {} for the left half", source.title());
        self.read_companion(context, Work::LeftMesh, title, source.title(), load, |app, loaded| {
            app.show_left_mesh(Some(source), loaded);
        });
    }

    /// Loads the mesh of another file again, which is turned and scaled as the mesh is.
    pub(in crate::app) fn follow_left_mesh(&mut self, context: &egui::Context) {
        let source = self.left_mesh.as_ref().and_then(|left| left.source.clone());
        source.into_iter().for_each(|source| self.open_left_mesh(context, source));
    }

    /// Forgets the mesh before its file changed, which is turned and scaled otherwise than the new one.
    pub(in crate::app) fn forget_before(&mut self) {
        self.document.iter_mut().for_each(|document| document.before = None);
        if self.left_mesh.as_ref().is_some_and(|left| left.source.is_none()) {
            self.forget_left_mesh();
        }
    }

    /// Shows the mesh as it was before its file changed, tessellated as the new one is.
    pub(in crate::app) fn compare_with_before(&mut self) {
        let Some(before) = self.document.as_ref().and_then(|document| document.before.clone()) else { return };
        self.settings.left = self.settings.tessellation;
        self.show_left_mesh(None, before);
        self.settings.split.get_or_insert(self.viewport.last_split);
    }

    fn show_left_mesh(&mut self, source: Option<Source>, loaded: Loaded) {
        self.left_mesh = Some(LeftMesh { source, loaded, generation: new_generation() });
    }

    /// Shows the mesh that is open in both halves.
    pub(in crate::app) fn forget_left_mesh(&mut self) {
        self.left_mesh = None;
        self.jobs.stop(Work::LeftMesh);
    }
}

//! What the halves of a split picture show: the mesh that the left one has in place of the one that is open, and how they are exchanged.

use std::sync::Arc;

use super::Document;
use crate::app::App;
use crate::app::jobs::companion_files::{LeftMesh, Opened};
use crate::app::jobs::job_list::{Kept, LeftChoice, Work};
use crate::commands::CompanionFile;
use geometry::progress::Progress;
use inspect::engine::{self, Loaded};
use inspect::render::LeftPose;
use inspect::settings::Settings;
use load::{MorphWeights, Source};

impl LeftMesh {
    /// What it is called beside the mesh that is open.
    pub(in crate::app) fn title(&self, open: &Document) -> String {
        match &self.from {
            LeftChoice::Kept(kept) if kept.loaded.source != open.loaded.source => self.content.source.title(),
            LeftChoice::Kept(kept) if kept.version < open.version => "before the change".to_owned(),
            LeftChoice::Kept(_) => "as kept".to_owned(),
            LeftChoice::Read(..) => self.content.source.title(),
        }
    }
}

/// What both halves show is exchanged.
impl App {
    /// Exchanges what both halves show: settings, poses, weights of morph targets, and meshes of two files. A mesh as it was before a
    /// change stays on the left.
    pub(in crate::app) fn swap_halves(&mut self, context: &egui::Context) {
        let left = self.other_left().map(|left| left.content.clone());
        if let Some(left) = left.filter(|left| Some(&left.source) != self.source()) {
            return self.exchange_meshes(context, left);
        }
        if let Some(LeftChoice::Read(None, morphs)) = self.left_choice() {
            let (contents, right) = (self.contents(), self.preparation().parts.morphs);
            let before = |name: &String| right.get(name).or(contents.morph_targets.get(name)).copied();
            let of_right = morphs.keys().filter_map(|name| Some((name.clone(), before(name)?))).collect();
            self.read_left(context, None, of_right);
            self.prepare(context, |own| own.parts.morphs.extend(morphs));
        }
        self.change_halves(Settings::swap_halves);
        self.swap_poses();
    }

    /// Takes the mesh of the left half, and shows the one before on the left as it is. No step of undo goes back from there.
    pub(super) fn take_exchanged(&mut self, context: &egui::Context, document: Document) {
        let Some(before) = self.document.as_ref().map(Document::kept) else { return };
        let (moment, left_pose) = (self.moment(), self.viewport.playback.left);
        let (camera, frozen, reference) = (self.viewport.camera, self.viewport.frozen, self.reference_shape.take());
        self.change_halves(Settings::swap_halves);
        self.take_document(context, document, false);
        if let LeftPose::Own(Some(own)) = left_pose {
            self.choose_clip(Some(own.clip));
            self.viewport.playback.time = own.time;
        }
        self.viewport.playback.left = moment.map_or(LeftPose::Same, |moment| LeftPose::Own(Some(moment)));
        (self.viewport.camera, self.viewport.frozen, self.reference_shape) = (camera, frozen, reference);
        let Loaded { source, preparation, .. } = before.loaded.clone();
        let morphs = preparation.parts.morphs.clone();
        // What a command can name can be read again.
        let is_plain = preparation == self.preparation().of_left(true, &morphs);
        let kept = LeftChoice::Kept(before.clone());
        let from = if is_plain { LeftChoice::Read(Some(source), morphs) } else { kept };
        self.left_mesh = Some(Opened::new(from, before.loaded.clone()));
        self.history = Default::default();
    }

    /// Changes the settings of both halves. Those that files take the place of are as they are again when these are closed.
    pub(in crate::app) fn change_halves(&mut self, change: impl FnOnce(&mut Settings)) {
        let mut own = self.settings_without_files();
        change(&mut own);
        self.put_settings(own);
    }

    /// Makes the left half a copy of the right one, and opens the split. The mesh and a moment of a clip stay there as they are; a pose
    /// at rest goes on being shared.
    pub(in crate::app) fn keep_on_left(&mut self) {
        let Some(kept) = self.document.as_ref().map(|open| open.kept()) else { return };
        self.put_left(kept);
        self.viewport.playback.left = self.moment().map_or(LeftPose::Same, |moment| LeftPose::Own(Some(moment)));
    }
}

/// The mesh left of the split.
impl App {
    /// The mesh left of the split, unless it is the one that is open as it is prepared now.
    pub(in crate::app) fn other_left(&self) -> Option<&LeftMesh> {
        let open = self.document.as_ref()?;
        let is_same = |kept: &Kept| kept.version == open.version && kept.loaded.is_prepared_as(&open.loaded);
        self.left_mesh.as_ref().filter(|left| !matches!(&left.from, LeftChoice::Kept(kept) if is_same(kept)))
    }

    /// What is left of the split in place of the mesh, or is being read for it.
    pub(in crate::app) fn left_choice(&self) -> Option<LeftChoice> {
        let is_read = self.jobs.has(Work::Companion(CompanionFile::LeftMesh));
        let read = self.jobs.left.as_ref().filter(|_| is_read);
        read.or(self.other_left().map(|left| &left.from)).cloned()
    }

    /// Starts to load the mesh of a source for the left half, or without one the same mesh, with these weights of morph targets in place
    /// of its own. Until it is loaded, what is there stays.
    pub(in crate::app) fn read_left(&mut self, context: &egui::Context, from: Option<Source>, morphs: MorphWeights) {
        if from.is_none() && morphs.is_empty() {
            return self.close_companion(CompanionFile::LeftMesh);
        }
        let Some(source) = from.clone().or_else(|| self.source().cloned()) else { return };
        let preparation = self.preparation().of_left(from.is_some(), &morphs);
        let (choice, what) = (LeftChoice::Read(from, morphs), source.title());
        self.jobs.left = Some(choice.clone());
        let load =
            move |progress: &Progress| engine::load(&source, &preparation, progress).map_err(|error| error.to_string());
        let title = format!("Loading {what} for the left half");
        self.read_companion(context, CompanionFile::LeftMesh, title, what, load, |app, loaded| {
            app.left_mesh = Some(Opened::new(choice, loaded));
        });
    }

    /// Forgets the mesh as it was, which is turned and scaled otherwise than the new one.
    pub(in crate::app) fn forget_earlier(&mut self) {
        self.document.iter_mut().for_each(|document| document.before = None);
        if self.shows_earlier() {
            self.close_companion(CompanionFile::LeftMesh);
        }
        self.history.change_all(|step| _ = step.left.take_if(|left| matches!(left, LeftChoice::Kept(_))));
    }

    /// Shows the mesh as it was before its file changed, tessellated as the new one is.
    pub(in crate::app) fn compare_with_before(&mut self) {
        let before = self.document.as_ref().and_then(|document| document.before.clone());
        before.into_iter().for_each(|before| self.put_left(before));
    }

    /// Shows a mesh as it was left of the split, tessellated as the right half is.
    pub(in crate::app) fn put_left(&mut self, kept: Arc<Kept>) {
        self.close_companion(CompanionFile::LeftMesh);
        let at = self.viewport.last_split;
        self.change_halves(|own| own.keep_on_left(at));
        self.left_mesh = Some(Opened::new(LeftChoice::Kept(kept.clone()), kept.loaded.clone()));
    }

    /// Whether the left half shows the mesh as it was, which no command can name.
    pub(in crate::app) fn shows_earlier(&self) -> bool {
        self.other_left().is_some_and(|left| matches!(left.from, LeftChoice::Kept(_)))
    }
}

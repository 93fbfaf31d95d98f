//! Undo and redo: of settings, of how the mesh is prepared and of files that are open beside it, and separately of views, so that
//! neither is in the way of the other.

use std::collections::VecDeque;

use super::App;
use super::jobs::job_list::{LeftChoice, Work};
use crate::commands::CompanionFile;
use gpu::{LodShader, SurfaceShader};
use inspect::engine::Preparation;
use inspect::render::{Camera, LeftPose};
use inspect::settings::Settings;
use load::{Import, Source};

/// The greatest number of steps that can be undone.
const MOST: usize = 200;

/// Movements of the camera that follow each other within so many seconds are one step.
const ONE_MOVEMENT: f64 = 0.5;

#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Undoable {
    /// Those that files with factors or functions of the user's own take the place of are as before.
    pub settings: Settings,
    /// How the mesh is prepared, but for the import, which is in the settings.
    pub preparation: Preparation,
    pub companions: [Option<Source>; CompanionFile::BY_SOURCE.len()],
    /// Whether the mesh is compared with the limit of its own cage.
    pub own_limit: bool,
    /// What is left of the split in place of the mesh.
    pub left: Option<LeftChoice>,
    pub left_pose: LeftPose,
    /// Whether the poses of both halves were exchanged an odd number of times. The right one's is in no step.
    pub is_swapped: bool,
}

/// The states before and after the present one.
#[derive(Default)]
pub(super) struct History<T> {
    /// None before the first frame.
    now: Option<T>,
    pub past: VecDeque<T>,
    pub future: Vec<T>,
}

impl<T: Clone + PartialEq> History<T> {
    /// Records a state. It isn't called while the pointer drags, so that a drag is one step.
    fn note(&mut self, state: &T) {
        if self.now.as_ref() == Some(state) {
            return;
        }
        let Some(before) = self.now.replace(state.clone()) else { return };
        self.past.push_back(before);
        if self.past.len() > MOST {
            self.past.pop_front();
        }
        self.future.clear();
    }

    pub(super) fn undo(&mut self, state: &T) -> Option<T> {
        self.note(state);
        let before = self.past.pop_back()?;
        self.future.extend(self.now.replace(before.clone()));
        Some(before)
    }

    pub(super) fn redo(&mut self, state: &T) -> Option<T> {
        self.note(state);
        let after = self.future.pop()?;
        self.past.extend(self.now.replace(after.clone()));
        Some(after)
    }
}

impl History<Undoable> {
    /// Changes all steps by what no step can undo.
    pub(super) fn change_all(&mut self, change: impl Fn(&mut Undoable)) {
        self.now.iter_mut().chain(&mut self.past).chain(&mut self.future).for_each(change);
    }
}

/// The views before and after the present one.
#[derive(Default)]
pub(super) struct ViewHistory {
    pub views: History<Camera>,
    /// When the camera was last seen to have moved, in s.
    moved: Option<f64>,
}

impl ViewHistory {
    /// Records the view at a time in s. A movement that goes on is one step.
    fn note(&mut self, camera: &Camera, now: f64) {
        if self.views.now.is_none_or(|before| before == *camera) {
            return self.views.note(camera);
        }
        match self.moved.replace(now) {
            Some(before) if now - before < ONE_MOVEMENT => self.views.now = Some(*camera),
            _ => self.views.note(camera),
        }
    }
}

impl App {
    /// Records settings and view at the end of a frame. A file that is being read becomes a step with all that follows from it.
    pub(super) fn note_state(&mut self, context: &egui::Context) {
        if context.egui_is_using_pointer() {
            return;
        }
        if !self.is_opening() {
            self.takes_back = false;
            self.history.note(&self.undoable());
        }
        self.view_history.note(&self.viewport.camera, context.input(|input| input.time));
    }

    fn undoable(&self) -> Undoable {
        let prepared = self.document.as_ref().map(|document| document.loaded.preparation.clone());
        Undoable {
            settings: self.settings_without_files(),
            preparation: Preparation { import: Import::default(), ..prepared.unwrap_or_default() },
            companions: CompanionFile::BY_SOURCE.map(|companion| self.companion(companion)),
            own_limit: self.has_own_limit(),
            left: self.left_mesh.as_ref().map(|left| left.from.clone()),
            left_pose: self.viewport.playback.left,
            is_swapped: self.viewport.playback.is_swapped,
        }
    }

    /// Whether the mesh, or a file beside it, is being read anew, so that settings may follow from it.
    pub(super) fn is_opening(&self) -> bool {
        self.jobs.load().is_some_and(|load| load.keep_view) || self.jobs.opens_companions()
    }

    /// Takes over how a mesh that was opened is prepared. This isn't a step of undo: all steps have this mesh's preparation from
    /// now on, and no files that were about another one.
    pub(super) fn take_preparation(&mut self) {
        let Undoable { preparation, settings, .. } = self.undoable();
        self.takes_back = false;
        self.history.change_all(|step| {
            step.preparation = preparation.clone();
            step.settings.tessellation.displacement = settings.tessellation.displacement;
            step.own_limit = false;
            for (companion, source) in CompanionFile::BY_SOURCE.iter().zip(&mut step.companions) {
                source.take_if(|_| matches!(companion, CompanionFile::ReferenceShape | CompanionFile::Factors));
            }
            (step.left, step.left_pose, step.is_swapped) = (None, LeftPose::Same, false);
        });
    }

    /// Goes back to what there was before the last change.
    pub fn undo(&mut self, context: &egui::Context) {
        let state = self.state_to_leave();
        // A file that is still being read is no step yet: reading it is what is taken back.
        let only_opens = self.is_opening() && !self.takes_back && self.history.now.as_ref() == Some(&state);
        let before = if only_opens { Some(state) } else { self.history.undo(&state) };
        self.take_back(context, before);
    }

    /// Goes forward to what [`Self::undo`] left.
    pub fn redo(&mut self, context: &egui::Context) {
        let after = self.history.redo(&self.state_to_leave());
        self.take_back(context, after);
    }

    /// The present state; or while a step is still being taken back, that step with the present settings.
    fn state_to_leave(&self) -> Undoable {
        let step = self.history.now.clone().filter(|_| self.takes_back);
        step.map_or_else(|| self.undoable(), |step| Undoable { settings: self.settings_without_files(), ..step })
    }

    fn take_back(&mut self, context: &egui::Context, step: Option<Undoable>) {
        let Some(step) = step else { return };
        let Undoable { settings, preparation, companions, own_limit, left, left_pose, is_swapped } = step;
        if self.viewport.playback.is_swapped != is_swapped {
            self.swap_poses();
        }
        self.viewport.playback.left = left_pose;
        use CompanionFile::{Environment, Factors, LeftMesh, Matcap, ReferenceShape};
        // A limit that was being read anew is stale.
        let reads_limit = own_limit && (!self.has_own_limit() || self.jobs.has(Work::Companion(ReferenceShape)));
        [ReferenceShape, LeftMesh, Matcap, Environment]
            .into_iter()
            .for_each(|companion| self.jobs.stop(Work::Companion(companion)));
        if self.given.is_none() {
            self.jobs.stop(Work::Companion(Factors));
        }
        if self.jobs.load().is_some_and(|load| load.keep_view) {
            self.jobs.stop(Work::Mesh);
        }
        if self.has_own_limit() != own_limit {
            self.close_companion(ReferenceShape);
        }
        for (companion, source) in CompanionFile::BY_SOURCE.into_iter().zip(companions) {
            if self.companion(companion) != source {
                self.close_companion(companion);
                source.into_iter().for_each(|source| self.open_companion(context, companion, source));
            }
        }
        if self.left_mesh.as_ref().map(|own| &own.from) != left.as_ref() {
            match left {
                Some(LeftChoice::Kept(kept)) => self.put_left(kept),
                Some(LeftChoice::Read(from, morphs)) => self.read_left(context, from, morphs),
                None => self.close_companion(LeftMesh),
            }
        }
        self.put_settings(settings);
        let preparation = Preparation { import: settings.import, ..preparation };
        self.prepare(context, |own| *own = preparation);
        if reads_limit {
            // It is that of the mesh as it is prepared now.
            self.read_reference(context, None, false);
        }
        self.takes_back = true;
    }

    /// Sets all settings, and lets open files take the place of theirs again.
    pub(super) fn put_settings(&mut self, settings: Settings) {
        self.settings = settings;
        self.replace_again::<LodShader>();
        self.replace_again::<SurfaceShader>();
        self.replace_by_factors();
        if !self.jobs.has(Work::Companion(CompanionFile::Environment)) {
            // A file of light may be gone.
            self.cancel_environment();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::tessellate::Tessellation;

    fn of(factor: f32) -> Settings {
        Settings::from(Tessellation { factor, ..Tessellation::default() })
    }

    #[test]
    fn undo_and_redo_go_through_the_steps_and_a_change_clears_redo() {
        let mut history = History::default();
        [1.0, 2.0, 2.0, 3.0].map(of).iter().for_each(|settings| history.note(settings));
        assert_eq!(history.undo(&of(3.0)), Some(of(2.0)));
        assert_eq!(history.undo(&of(2.0)), Some(of(1.0)));
        assert_eq!(history.undo(&of(1.0)), None);
        assert_eq!(history.redo(&of(1.0)), Some(of(2.0)));
        // Settings that weren't recorded yet become a step.
        assert_eq!(history.undo(&of(7.0)), Some(of(2.0)));
        assert_eq!(history.redo(&of(2.0)), Some(of(7.0)));
        history.note(&of(8.0));
        assert_eq!(history.redo(&of(8.0)), None);
        assert_eq!(history.undo(&of(8.0)), Some(of(7.0)));
    }

    #[test]
    fn a_movement_that_goes_on_is_one_step_of_the_views() {
        let at = |azimuth: f32| Camera { azimuth, ..Camera::framing(&Default::default(), glam::Vec2::ONE) };
        let mut history = ViewHistory::default();
        for (azimuth, now) in [(0.0, 0.0), (1.0, 1.0), (2.0, 1.1), (3.0, 1.5), (9.0, 3.0)] {
            history.note(&at(azimuth), now);
        }
        assert_eq!(history.views.undo(&at(9.0)), Some(at(3.0)));
        assert_eq!(history.views.undo(&at(3.0)), Some(at(0.0)));
        assert_eq!(history.views.redo(&at(0.0)), Some(at(3.0)));
    }

    #[test]
    fn the_number_of_steps_is_limited() {
        let mut history = History::default();
        (0..2 * MOST).for_each(|i| history.note(&of(i as f32)));
        assert_eq!((history.past.len(), history.past[0]), (MOST, of((MOST - 1) as f32)));
    }
}

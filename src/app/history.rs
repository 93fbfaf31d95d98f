//! Undo and redo: of settings, hidden parts and the user's own shaders, and separately of views, so that neither is in the way of
//! the other.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::App;
use crate::gpu::{LodShader, SurfaceShader};
use crate::render::Camera;
use crate::settings::Settings;
use crate::tessellate::Displacement;

/// The greatest number of steps that can be undone.
const MOST: usize = 200;

/// Movements of the camera that follow each other within so many seconds are one step.
const ONE_MOVEMENT: f64 = 0.5;

/// What undo brings back.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Undoable {
    pub settings: Settings,
    /// The names of parts of the file that are left out.
    pub hidden: Arc<Vec<String>>,
    /// The files of functions of the user's own that are open. The settings are those that these take the place of.
    pub lod_shader: Option<PathBuf>,
    pub surface_shader: Option<PathBuf>,
}

/// The states before and after the present one.
pub(super) struct History<T> {
    /// None before the first frame.
    now: Option<T>,
    past: VecDeque<T>,
    future: Vec<T>,
}

impl<T> Default for History<T> {
    fn default() -> Self {
        Self { now: None, past: VecDeque::new(), future: Vec::new() }
    }
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

    fn undo(&mut self, state: &T) -> Option<T> {
        self.note(state);
        let before = self.past.pop_back()?;
        self.future.extend(self.now.replace(before.clone()));
        Some(before)
    }

    fn redo(&mut self, state: &T) -> Option<T> {
        self.note(state);
        let after = self.future.pop()?;
        self.past.extend(self.now.replace(after.clone()));
        Some(after)
    }
}

impl History<Undoable> {
    /// Sets displacement in all steps, because it follows from the mesh and can't be undone.
    pub(super) fn displace(&mut self, displacement: Displacement) {
        self.change_all(|settings| settings.tessellation.displacement = displacement);
    }

    /// Changes the settings of all steps, by what no step can undo.
    pub(super) fn change_all(&mut self, change: impl Fn(&mut Settings)) {
        self.steps().for_each(|step| change(&mut step.settings));
    }

    /// Hides the same parts in all steps, because another mesh has others.
    fn hide_in_all(&mut self, hidden: &Arc<Vec<String>>) {
        self.steps().for_each(|step| step.hidden = hidden.clone());
    }

    fn steps(&mut self) -> impl Iterator<Item = &mut Undoable> {
        self.now.iter_mut().chain(&mut self.past).chain(&mut self.future)
    }
}

/// The views before and after the present one.
#[derive(Default)]
pub(super) struct ViewHistory {
    views: History<Camera>,
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
    /// Records settings and view at the end of a frame.
    pub(super) fn note_state(&mut self, context: &egui::Context) {
        if !context.egui_is_using_pointer() {
            self.history.note(&self.undoable());
            self.view_history.note(&self.viewport.camera, context.input(|input| input.time));
        }
    }

    fn undoable(&self) -> Undoable {
        Undoable {
            settings: self.settings_without_shaders(),
            hidden: self.hidden.clone(),
            lod_shader: self.open_shader_file::<LodShader>().map(Path::to_owned),
            surface_shader: self.open_shader_file::<SurfaceShader>().map(Path::to_owned),
        }
    }

    /// Takes over the hidden parts of a mesh that was opened: those of the command line, or none. This isn't a step of undo.
    pub(super) fn take_hidden_parts(&mut self) {
        let opened = self.document.as_ref().map(|document| document.loaded.preparation.hidden.clone());
        self.hidden = Arc::new(opened.unwrap_or_default());
        self.history.hide_in_all(&self.hidden);
    }

    pub(super) fn can_undo(&self) -> bool {
        !self.history.past.is_empty()
    }

    pub(super) fn can_redo(&self) -> bool {
        !self.history.future.is_empty()
    }

    pub(super) fn has_view_before(&self) -> bool {
        !self.view_history.views.past.is_empty()
    }

    pub(super) fn has_view_after(&self) -> bool {
        !self.view_history.views.future.is_empty()
    }

    /// Goes back to the view before the last movement of the camera.
    pub(super) fn view_before(&mut self) {
        let before = self.view_history.views.undo(&self.viewport.camera);
        self.viewport.camera = before.unwrap_or(self.viewport.camera);
    }

    /// Goes forward to the view that [`Self::view_before`] left.
    pub(super) fn view_after(&mut self) {
        let after = self.view_history.views.redo(&self.viewport.camera);
        self.viewport.camera = after.unwrap_or(self.viewport.camera);
    }

    /// Goes back to the settings, hidden parts and shaders before the last change.
    pub fn undo(&mut self, context: &egui::Context) {
        let before = self.history.undo(&self.undoable());
        self.take_back(context, before);
    }

    /// Goes forward to those that [`Self::undo`] left.
    pub fn redo(&mut self, context: &egui::Context) {
        let after = self.history.redo(&self.undoable());
        self.take_back(context, after);
    }

    fn take_back(&mut self, context: &egui::Context, step: Option<Undoable>) {
        let Some(Undoable { settings, hidden, lod_shader, surface_shader }) = step else { return };
        if lod_shader.is_some() {
            // A file of factors that was opened since has its place.
            self.forget_factors();
        }
        (self.settings, self.hidden) = (settings, hidden);
        self.take_back_shader::<LodShader>(context, lod_shader);
        self.take_back_shader::<SurfaceShader>(context, surface_shader);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tessellate::Tessellation;

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

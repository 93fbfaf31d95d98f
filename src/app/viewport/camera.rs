//! The commands that move the camera.

use glam::vec2;

use crate::app::App;
use crate::commands::CameraAction;
use geometry::mesh::Moment;
use inspect::render::{Camera, framed_size};
use inspect::settings::SplitSide;

/// Degrees that the camera turns at a press of an arrow key.
const DEGREES_PER_KEY: f32 = 7.5;
/// Points that a press of an arrow key moves the target by.
const POINTS_PER_KEY: f32 = 40.0;
/// The factor by which a press of a key changes the distance to the mesh.
const CLOSER: f32 = 0.8;

/// A camera of the file that is looked through.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FollowedCamera {
    /// Its number in the file.
    index: usize,
    moment: Option<Moment>,
    /// The view at that moment.
    camera: Camera,
}

impl App {
    pub(in crate::app) fn move_camera_by(&mut self, context: &egui::Context, action: CameraAction) {
        let points = self.viewport.picture.size() / context.pixels_per_point();
        let camera = &mut self.viewport.camera;
        match action {
            CameraAction::Frame => self.frame(),
            CameraAction::FramePatch => self.frame_patch(),
            CameraAction::LookFrom(standpoint) => camera.look_from(standpoint),
            CameraAction::Before => *camera = self.view_history.views.undo(camera).unwrap_or(*camera),
            CameraAction::After => *camera = self.view_history.views.redo(camera).unwrap_or(*camera),
            CameraAction::Bookmark(index) => *camera = self.viewport.bookmarks.get(index).copied().unwrap_or(*camera),
            CameraAction::OfFile(index) => self.look_through_file_camera(index),
            CameraAction::ThroughFrozen => *camera = self.viewport.frozen.map_or(*camera, |frozen| frozen.camera),
            CameraAction::Orthographic => camera.orthographic = !camera.orthographic,
            CameraAction::Orbit(steps) => camera.orbit(steps.as_vec2() * DEGREES_PER_KEY),
            CameraAction::Pan(steps) => camera.pan(vec2(steps.x as f32, -steps.y as f32) * POINTS_PER_KEY, points),
            CameraAction::ZoomIn => camera.zoom(CLOSER, points * 0.5, points),
            CameraAction::ZoomOut => camera.zoom(CLOSER.recip(), points * 0.5, points),
        }
    }

    /// Moves the camera to where a camera of the file is at this moment, and gives it the same field of view, or height. It follows
    /// that camera while a clip plays.
    fn look_through_file_camera(&mut self, index: usize) {
        let Some(document) = &self.document else { return };
        let moment = document.moment;
        if let Some(camera) = document.loaded.mesh.cameras_at(moment).get(index) {
            let camera = Camera::from_file(camera, &document.scene.bounds);
            self.viewport.camera = camera;
            self.viewport.through = Some(FollowedCamera { index, moment, camera });
        }
    }

    /// Moves the camera along with that of the file which it looks through, if the moment is another one. A camera that was moved
    /// otherwise follows no more.
    pub(in crate::app) fn follow_file_camera(&mut self) {
        let Some(FollowedCamera { index, moment, camera }) = self.viewport.through else { return };
        if camera != self.viewport.camera {
            self.viewport.through = None;
        } else if self.document.as_ref().is_some_and(|document| document.moment != moment) {
            self.viewport.through = None;
            self.look_through_file_camera(index);
        }
    }

    /// Moves the camera so that all of the mesh is in view, upright and with the usual field of view, over its whole clip and with its
    /// displacement.
    pub(in crate::app) fn frame(&mut self) {
        if let Some(document) = &self.document {
            let camera = &mut self.viewport.camera;
            (camera.field_of_view, camera.roll) = (Camera::default().field_of_view, 0.0);
            let size = framed_size(self.viewport.picture.size(), &self.settings);
            let reach = self.settings.reach(document.scene.tessellator.mesh());
            self.viewport.camera.frame(&document.scene.bounds.grown(reach), size);
            self.viewport.framed = Some(self.viewport.camera);
        }
    }

    /// Whether nothing of the mesh is to be seen in the picture, as far as that is measured.
    pub(in crate::app) fn shows_nothing(&self) -> bool {
        let sizes = self.results().filter(|_| self.found(SplitSide::Right).is_some()).map(|results| &results.sizes);
        sizes.is_some_and(|sizes| Some(sizes.view) == self.viewport.picture.seen_from() && sizes.show_nothing())
    }

    /// Frames the mesh for a view of its own, also if LOD was frozen where it emits nothing.
    pub(in crate::app) fn frame_anew(&mut self) {
        self.viewport.frozen = None;
        self.frame();
    }

    /// Frames a mesh that was opened, or loaded again, with a camera that sees nothing of it.
    pub(in crate::app) fn frame_unseen(&mut self) {
        if self.viewport.opened == Some(self.viewport.camera) && self.shows_nothing() {
            self.frame_anew();
        }
        if self.found(SplitSide::Right).is_some() {
            self.viewport.opened = None;
        }
    }

    /// Whether the camera has its target and distance of the last [`Self::frame`]. It may have turned.
    pub fn is_framed(&self) -> bool {
        let place = |camera: &Camera| (camera.target, camera.distance);
        self.viewport.framed.as_ref().map(place) == Some(place(&self.viewport.camera))
    }
}

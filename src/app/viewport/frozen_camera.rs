//! The frozen LOD camera: LOD and clipping stay computed for it while the picture shows the mesh from elsewhere.

use glam::Vec2;

use crate::app::App;
use crate::app::jobs::measure_job::Seen;
use crate::app::text::counted;
use crate::commands::{Action, key_name};
use geometry::mesh::Bounds;
use geometry::tessellate::LodView;
use geometry::view::ScreenView;
use inspect::render::Camera;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FrozenCamera {
    pub camera: Camera,
    /// Width and height of its view, in px.
    pub viewport: Vec2,
    /// What LOD and clipping are computed for.
    pub view: LodView,
}

impl FrozenCamera {
    /// The view through it of a mesh with these bounds.
    pub(in crate::app) fn screen_view(&self, bounds: &Bounds) -> ScreenView {
        ScreenView { clip_from_object: self.camera.clip_from_object(self.viewport, bounds), viewport: self.viewport }
    }
}

impl App {
    /// Freezes LOD and clipping as they are for the camera of the picture that is shown, or lets them follow the camera again.
    pub(in crate::app) fn toggle_frozen(&mut self) {
        if self.viewport.frozen.take().is_none() {
            self.freeze();
        }
    }

    /// Freezes LOD and clipping as they are for the camera of the picture that is shown.
    fn freeze(&mut self) {
        let Some((document, drawn)) = self.document.as_ref().zip(self.viewport.picture.drawn) else { return };
        let (camera, viewport) = (drawn.camera, drawn.view.viewport);
        let view = camera.lod_view(viewport, &document.scene.bounds);
        self.viewport.frozen = Some(FrozenCamera { camera, viewport, view });
    }

    /// Freezes LOD and clipping, if they follow the camera, as they were where what the panels show was measured: the numbers stay
    /// true wherever the camera goes.
    pub(in crate::app) fn keep_measured(&mut self) {
        if self.uses_lod_shader() || self.settings.tessellation.follows_view() {
            self.keep_view();
        }
    }

    /// Freezes the view in which what the panels show was measured, also if only what is counted in a view depends on it.
    pub(in crate::app) fn keep_view(&mut self) {
        if self.viewport.frozen.is_some() {
            return;
        }
        match self.results().map(|results| results.seen) {
            Some(Seen { camera, view, inputs }) => {
                self.viewport.frozen = Some(FrozenCamera { camera, viewport: view.viewport, view: inputs.view });
            }
            None => self.freeze(),
        }
    }

    /// Says why the mesh has holes where the frozen camera doesn't see it; none if it has no such hole.
    pub(super) fn left_out_note(&self) -> Option<String> {
        let culled = self.viewport.frozen.and_then(|_| self.results()).map(|results| results.found.culled)?;
        let left_out = counted((culled.out_of_view + culled.facing_away).into(), "patch");
        let key = key_name(&Action::FreezeLodCamera);
        (culled.out_of_view + culled.facing_away > 0)
            .then(|| format!("Left out, since the frozen camera doesn't see them: {left_out} ({key} thaws LOD)"))
    }

    /// What the lines of the frozen camera depend on; none if there is no such camera, or the picture is seen through it.
    pub(in crate::app) fn frozen_shown(&self) -> Option<(FrozenCamera, Bounds)> {
        let bounds = self.document.as_ref()?.scene.bounds;
        self.viewport.frozen.filter(|frozen| frozen.camera != self.viewport.camera).map(|frozen| (frozen, bounds))
    }
}

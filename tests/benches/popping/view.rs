//! Where a camera sees places, and from which side.

use geometry::mesh::Mesh;
use glam::{DMat4, DVec2, DVec3, DVec4};
use inspect::render::camera::Camera;

use crate::VIEWPORT;
use crate::places::Place;

/// What a camera sees.
pub(crate) struct View {
    clip_from_object: DMat4,
    half_viewport: DVec2,
    eye: DVec3,
}

impl View {
    /// A camera's view of a mesh.
    pub(crate) fn new(camera: &Camera, mesh: &Mesh) -> Self {
        Self {
            clip_from_object: camera.clip_from_object(VIEWPORT, &mesh.bounds()).as_dmat4(),
            half_viewport: VIEWPORT.as_dvec2() * 0.5,
            eye: camera.eye().as_dvec3(),
        }
    }

    fn clip(&self, p: DVec3) -> DVec4 {
        self.clip_from_object * p.extend(1.0)
    }

    /// Whether the limit surface at a place is in view.
    pub(crate) fn shows(&self, place: &Place) -> bool {
        let clip = self.clip(place.position);
        clip.w > 0.0 && clip.x.abs() <= clip.w && clip.y.abs() <= clip.w && clip.z <= clip.w
    }

    /// The cosine of the angle at which the limit surface faces the eye at a place: from 1 through 0 (edge-on) to -1 (away).
    pub(crate) fn facing(&self, place: &Place) -> f64 {
        place.normal.dot((self.eye - place.position).normalize_or_zero())
    }

    /// The place on screen of a point in object units, in px from the middle; `None` if it is nearer than the near plane.
    pub(crate) fn on_screen(&self, p: DVec3) -> Option<DVec2> {
        let clip = self.clip(p);
        let is_beyond_near = clip.w > 0.0 && clip.z <= clip.w;
        is_beyond_near.then(|| clip.truncate().truncate() / clip.w * self.half_viewport)
    }

    /// The direction on screen across the silhouette at a place that is seen edge-on.
    pub(crate) fn across_silhouette(&self, place: &Place) -> DVec2 {
        // The silhouette's direction is that of the tangent at right angles to the line of sight.
        let tangent = place.normal.cross(self.eye - place.position);
        let (clip, along) = (self.clip(place.position), self.clip_from_object * tangent.extend(0.0));
        let slope = (along.truncate().truncate() * clip.w - clip.truncate().truncate() * along.w) * self.half_viewport;
        slope.perp().normalize_or_zero()
    }
}

//! An orbiting camera. Angles in degrees, lengths in object units; +Y is up and azimuth 0 looks along -Z (from the
//! front, as glTF has it). Clip space is WebGPU's, with depth reversed: 1 at the near plane, 0 at infinity.

use glam::camera::rh::proj::directx as proj;
use glam::{Mat4, Vec2, Vec3, vec3};

use super::view_projection::ClipRows;
use geometry::choice::choices;
use geometry::defaults::with_defaults;
use geometry::mesh::Bounds;
use geometry::tessellate::LodView;

/// The usual vertical field of view, in degrees.
pub const FIELD_OF_VIEW: f32 = 40.0;
/// The allowed vertical fields of view, in degrees.
pub const FIELDS_OF_VIEW: std::ops::RangeInclusive<f32> = 0.1..=170.0;
/// The allowed distances between the target and the eye, in object units.
const DISTANCES: std::ops::RangeInclusive<f32> = 1e-30..=1e30;
/// The distance of the near plane from the eye of a perspective view, in distances between eye and target.
const NEAR: f32 = 1e-3;
/// The steepest elevation that the camera can be turned to, in degrees. At 90 turning about the vertical axis would only roll it.
pub(crate) const MAX_ELEVATION: f32 = 89.9;

/// How far a frustum that is drawn reaches beyond the middle of the mesh, in bounding radii: a little more than the mesh.
const FRUSTUM_REACH: f32 = 1.2;

/// How far a mesh reaches from its middle at most, in bounding radii: surfaces bulge beyond the corners, and heights lift them by
/// at most a bounding radius.
const BULGE: f32 = 2.0;

with_defaults! {
    /// A camera that looks at `target` from `distance` away: by default in front of the origin.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Camera {
        pub target: Vec3 = Vec3::ZERO,
        /// Degrees about +Y, from +Z towards +X.
        pub azimuth: f32 = 0.0,
        /// Degrees above the horizon.
        pub elevation: f32 = 0.0,
        /// The distance from the target to the eye, in object units.
        pub distance: f32 = 1.0,
        pub orthographic: bool = false,
        /// Vertical, in degrees. An orthographic view is as high as a perspective view is at the target.
        pub field_of_view: f32 = FIELD_OF_VIEW,
        /// Degrees that the camera is turned about its direction of view, counterclockwise as it sees that.
        pub roll: f32 = 0.0,
        /// What an engine's matrix says about where points land, in place of what the rest says. The window has no such cameras,
        /// and moving one has no effect.
        pub rows: Option<ClipRows> = None,
    }
}

choices! {
    /// Directions of view along an axis.
    pub enum Standpoint {
        Front => "front", "Front", "Looks from the front.";
        Back => "back", "Back", "Looks from the back.";
        Left => "left", "Left", "Looks from the left.";
        Right => "right", "Right", "Looks from the right.";
        Top => "top", "Top", "Looks from the top.";
        Bottom => "bottom", "Bottom", "Looks from the bottom.";
    }
}

impl Standpoint {
    /// The unit vector from the target to the eye.
    pub fn direction(self) -> Vec3 {
        match self {
            Self::Front => Vec3::Z,
            Self::Back => Vec3::NEG_Z,
            Self::Left => Vec3::NEG_X,
            Self::Right => Vec3::X,
            Self::Top => Vec3::Y,
            Self::Bottom => Vec3::NEG_Y,
        }
    }
}

impl Camera {
    /// A camera that sees all of `bounds` in a viewport of this size (px), from the front, the right and a little above.
    pub fn framing(bounds: &Bounds, viewport: Vec2) -> Self {
        let mut camera = Self { azimuth: 30.0, elevation: 20.0, ..Self::default() };
        camera.frame(bounds, viewport);
        camera
    }

    /// Whether all values are finite and in their ranges, as they are after any movement. A saved camera may be damaged.
    pub fn is_sound(&self) -> bool {
        let turned = self.azimuth.is_finite() && (-90.0..=90.0).contains(&self.elevation) && self.roll.is_finite();
        turned
            && FIELDS_OF_VIEW.contains(&self.field_of_view)
            && self.target.is_finite()
            && DISTANCES.contains(&self.distance)
    }

    /// Turns the camera so that it looks along an axis, upright.
    pub fn look_from(&mut self, standpoint: Standpoint) {
        self.roll = 0.0;
        self.turn_to(standpoint.direction());
    }

    /// Turns the camera so that a unit vector points from the target to the eye, as steeply as it can be turned.
    pub(super) fn turn_to(&mut self, back: Vec3) {
        self.azimuth = back.x.atan2(back.z).to_degrees().rem_euclid(360.0);
        self.elevation = back.y.clamp(-1.0, 1.0).asin().to_degrees().clamp(-MAX_ELEVATION, MAX_ELEVATION);
    }

    /// Unit vectors that point right, up, and back towards the eye.
    pub fn axes(&self) -> [Vec3; 3] {
        let (azimuth, elevation) = (self.azimuth.to_radians(), self.elevation.to_radians());
        let back = vec3(azimuth.sin() * elevation.cos(), elevation.sin(), azimuth.cos() * elevation.cos());
        let level = vec3(azimuth.cos(), 0.0, -azimuth.sin());
        let upright = back.cross(level);
        if self.roll == 0.0 {
            return [level, upright, back];
        }
        let (sine, cosine) = self.roll.to_radians().sin_cos();
        [level * cosine + upright * sine, upright * cosine - level * sine, back]
    }

    pub fn eye(&self) -> Vec3 {
        let of_rows = self.rows.and_then(|rows| rows.eye);
        of_rows.unwrap_or_else(|| self.target + self.axes()[2] * self.distance)
    }

    /// Turns around the target by `degrees`, to the right and upwards.
    pub fn orbit(&mut self, degrees: Vec2) {
        self.azimuth = (self.azimuth + degrees.x).rem_euclid(360.0);
        self.elevation = (self.elevation + degrees.y).clamp(-MAX_ELEVATION, MAX_ELEVATION);
    }

    /// Moves the target so that the point under the pointer moves by `pixels` (x right, y down).
    pub fn pan(&mut self, pixels: Vec2, viewport: Vec2) {
        let [right, up, _] = self.axes();
        let unit = self.units_per_pixel(viewport.y);
        self.target += (up * pixels.y - right * pixels.x) * unit;
    }

    /// Multiplies the distance by `ratio`. The point under `pointer` (px from the top left) at the target's depth stays there.
    pub fn zoom(&mut self, ratio: f32, pointer: Vec2, viewport: Vec2) {
        let [right, up, _] = self.axes();
        let from_center = pointer - viewport * 0.5;
        let before = self.units_per_pixel(viewport.y);
        self.distance = (self.distance * ratio).clamp(1e-30, 1e30);
        let moved = before - self.units_per_pixel(viewport.y);
        self.target += (right * from_center.x - up * from_center.y) * moved;
    }

    /// Whether an engine's matrix shows the mesh as in a mirror. What is drawn for it isn't: the whole picture is mirrored afterwards,
    /// so that which way triangles are wound stays the same.
    pub fn is_mirrored(&self) -> bool {
        self.rows.is_some_and(|rows| rows.is_mirrored)
    }

    /// Object units per px at the target's depth, in a viewport that is `height` px high.
    pub fn units_per_pixel(&self, height: f32) -> f32 {
        if let Some(rows) = self.rows {
            return if self.orthographic { 1.0 } else { self.distance } / rows.px_where_w_is_1(height.max(1.0));
        }
        2.0 * self.distance * (0.5 * self.field_of_view).to_radians().tan() / height.max(1.0)
    }

    /// How many px an object unit across the view is where w is 1 in clip space, in a viewport that is `height` px high. In an
    /// orthographic view w is 1 everywhere; in a perspective view it is the distance from the eye.
    pub fn px_where_w_is_1(&self, height: f32) -> f32 {
        (if self.orthographic { 1.0 } else { self.distance }) / self.units_per_pixel(height)
    }

    /// The matrix from object units to clip space, for a viewport of `viewport` px. In an orthographic view, the depth range
    /// holds `bounds`.
    pub fn clip_from_object(&self, viewport: Vec2, bounds: &Bounds) -> Mat4 {
        if let Some(rows) = self.rows {
            return rows.clip_from_object(bounds.center(), BULGE * bounds.radius());
        }
        let [right, up, back] = self.axes();
        let eye = self.eye();
        let view = Mat4::from_cols(right.extend(0.0), up.extend(0.0), back.extend(0.0), glam::Vec4::W).transpose()
            * Mat4::from_translation(-eye);
        let aspect = viewport.x.max(1.0) / viewport.y.max(1.0);
        let projection = if self.orthographic {
            let half = 0.5 * self.units_per_pixel(viewport.y) * viewport.max(Vec2::ONE);
            let radius = BULGE * bounds.radius();
            let depth = radius + (bounds.center() - self.target).length() + self.distance;
            proj::orthographic(-half.x, half.x, -half.y, half.y, self.distance + depth, self.distance - depth)
        } else {
            proj::perspective_infinite_reverse(self.field_of_view.to_radians(), aspect, self.distance * NEAR)
        };
        projection * view
    }

    /// The corners of the view's near plane, and of the plane that ends it behind everything in `bounds`, in object units: the
    /// view itself has no end. Each goes around from the lower left. An orthographic view also begins before everything.
    pub fn frustum(&self, viewport: Vec2, bounds: &Bounds) -> [[Vec3; 4]; 2] {
        let [right, up, back] = self.axes();
        let (eye, middle) = (self.eye(), (self.eye() - bounds.center()).dot(back));
        let (near, far) = if self.orthographic {
            (middle - FRUSTUM_REACH * bounds.radius(), middle + FRUSTUM_REACH * bounds.radius())
        } else {
            let near = self.rows.map_or(self.distance * NEAR, |rows| rows.near);
            (near, (middle + FRUSTUM_REACH * bounds.radius()).max(2.0 * near))
        };
        if let Some(rows) = self.rows {
            return [near, far].map(|depth| rows.corners(depth, eye - back * depth));
        }
        let at_target = 0.5 * self.units_per_pixel(viewport.y) * viewport.max(Vec2::ONE);
        [near, far].map(|depth| {
            let half = if self.orthographic { at_target } else { at_target * (depth / self.distance) };
            [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
                .map(|(x, y)| eye - back * depth + right * (x * half.x) + up * (y * half.y))
        })
    }

    /// The view for LOD and clipping.
    pub fn lod_view(&self, viewport: Vec2, bounds: &Bounds) -> LodView {
        let radius = bounds.radius().max(f32::MIN_POSITIVE);
        LodView::new(self.clip_from_object(viewport, bounds), viewport * 0.5).seen_from(self.eye(), radius)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::view::project;
    use glam::vec2;

    fn unit_bounds() -> Bounds {
        Bounds::new([Vec3::NEG_ONE, Vec3::ONE].into_iter())
    }

    #[test]
    fn the_target_is_in_the_middle_and_up_is_up() {
        let viewport = vec2(800.0, 600.0);
        for orthographic in [false, true] {
            let camera = Camera { orthographic, ..Camera::framing(&unit_bounds(), viewport) };
            let clip = camera.clip_from_object(viewport, &unit_bounds());
            let at = |p| project(clip, viewport, p).expect("in front of the eye");
            assert!(at(Vec3::ZERO).distance(vec2(400.0, 300.0)) < 1e-2);
            assert!(at(Vec3::Y * 0.5).y < 290.0);
        }
    }

    #[test]
    fn a_standpoint_looks_along_its_axis() {
        let mut camera = Camera::framing(&unit_bounds(), vec2(800.0, 600.0));
        for standpoint in Standpoint::ALL {
            camera.look_from(standpoint);
            assert!(camera.is_sound() && camera.axes()[2].distance(standpoint.direction()) < 0.002, "{standpoint:?}");
        }
    }

    #[test]
    fn zooming_keeps_the_point_under_the_pointer() {
        let viewport = vec2(800.0, 600.0);
        let mut camera = Camera::framing(&unit_bounds(), viewport);
        let [right, up, _] = camera.axes();
        let pointer = vec2(650.0, 120.0);
        let unit = camera.units_per_pixel(viewport.y);
        let under = camera.target + right * (250.0 * unit) + up * (180.0 * unit);
        camera.zoom(0.5, pointer, viewport);
        let now = project(camera.clip_from_object(viewport, &unit_bounds()), viewport, under);
        assert!(now.expect("in front of the eye").distance(pointer) < 0.1);
    }

    #[test]
    fn a_frustum_holds_the_mesh_and_lies_on_the_views_borders() {
        let viewport = vec2(400.0, 300.0);
        for orthographic in [false, true] {
            let bounds = unit_bounds();
            let camera = Camera { orthographic, ..Camera::framing(&bounds, viewport) };
            let clip = camera.clip_from_object(viewport, &bounds);
            let [near, far] = camera.frustum(viewport, &bounds);
            for (corner, expected) in
                [(0, vec2(0.0, 300.0)), (1, vec2(400.0, 300.0)), (2, vec2(400.0, 0.0)), (3, vec2(0.0, 0.0))]
            {
                for place in [near[corner], far[corner]] {
                    let at = project(clip, viewport, place).expect("in front of the eye");
                    assert!(at.distance(expected) < 0.1, "{at} {expected}");
                }
            }
            let back = camera.axes()[2];
            let depth = |place: Vec3| (camera.eye() - place).dot(back);
            let middle = depth(bounds.center());
            assert!(depth(near[0]) < middle - bounds.radius() && depth(far[0]) > middle + bounds.radius());
            let near_clip = clip * near[0].extend(1.0);
            assert!(orthographic || (near_clip.z / near_clip.w - 1.0).abs() < 1e-4, "on the near plane");
        }
        // A camera that looks away from the mesh has a frustum too.
        let away = Camera {
            target: vec3(0.0, 0.0, 50.0),
            azimuth: 180.0,
            elevation: 0.0,
            ..Camera::framing(&unit_bounds(), viewport)
        };
        let [near, far] = away.frustum(viewport, &unit_bounds());
        assert!(near.iter().chain(&far).all(|corner| corner.is_finite()) && near[0] != far[0]);
    }

    #[test]
    fn depth_is_reversed_and_holds_the_whole_mesh() {
        let viewport = vec2(400.0, 400.0);
        for orthographic in [false, true] {
            let camera = Camera { orthographic, ..Camera::framing(&unit_bounds(), viewport) };
            let clip = camera.clip_from_object(viewport, &unit_bounds());
            let depth = |p: Vec3| {
                let c = clip * p.extend(1.0);
                c.z / c.w
            };
            let back = camera.axes()[2];
            let (near, far) = (depth(back), depth(-back));
            assert!((0.0..=1.0).contains(&far) && far < near && near <= 1.0, "{near} {far}");
            // So are points that heights lift by a bounding radius.
            let lifted = 2.0 * unit_bounds().radius() * back;
            assert!((0.0..=1.0).contains(&depth(lifted)) && (0.0..=1.0).contains(&depth(-lifted)));
        }
    }
}

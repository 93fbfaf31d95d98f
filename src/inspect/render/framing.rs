//! Moves a camera so that it shows a whole mesh, or one edge or triangle of it.

use glam::{DVec2, DVec3, Vec2, Vec3, dvec3, vec2};

use super::Camera;
use super::camera::FIELD_OF_VIEW;
use geometry::mesh::Bounds;

/// The distance from which a framed edge is seen with the usual field of view, in lengths of the edge. It then is two thirds of the
/// view's height long.
const FRAMED_EDGE: f32 = 2.06;
/// The part of the viewport that fitted positions fill. The rest is margin.
const FITTED: f64 = 0.93;
/// The least distance between the eye and fitted positions, as a part of their largest extent. Without it, a line that is seen
/// end on would reach the eye.
const LEAST_CLEARANCE: f64 = 0.1;
/// The number of steps in which the slopes of planes that touch the fitted positions converge.
const FIT_STEPS: usize = 16;

impl Camera {
    /// Moves the target and the distance so that the bounding sphere just fills the viewport's shorter side. The angles stay.
    pub fn frame(&mut self, bounds: &Bounds, viewport: Vec2) {
        let radius = bounds.radius();
        let radius = if radius > 0.0 && radius.is_finite() { radius } else { 1.0 };
        let aspect = viewport.x.max(1.0) / viewport.y.max(1.0);
        let half_angle = ((0.5 * self.field_of_view).to_radians().tan() * aspect.min(1.0)).atan();
        self.target = bounds.center();
        self.distance = radius / half_angle.sin();
    }

    /// Moves the target and the distance so that these positions, with `reach` (object units) around each, fill the viewport
    /// except for a small margin. The angles stay. Positions that aren't finite are ignored. If the positions have no extent, it
    /// does what [`Self::frame`] does.
    pub fn fit(&mut self, positions: impl Iterator<Item = Vec3>, reach: f32, viewport: Vec2) {
        let [right, up, back] = self.axes().map(Vec3::as_dvec3);
        let finite = positions.filter(|p| p.is_finite()).map(Vec3::as_dvec3);
        let mut places: Vec<DVec3> = finite.map(|p| dvec3(right.dot(p), up.dot(p), back.dot(p))).collect();
        let least = places.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let most = places.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        let reach = f64::from(reach).max(0.0);
        let extent = (most - least).max_element() + 2.0 * reach;
        if !(extent > 0.0 && extent.is_finite()) {
            let bounds = if extent == 0.0 { Bounds::new(std::iter::once(self.at(least))) } else { Bounds::default() };
            return self.frame(&bounds, viewport);
        }
        let middle = 0.5 * (least.z + most.z);
        places.iter_mut().for_each(|place| place.z -= middle);
        let aspect = viewport.x.max(1.0) / viewport.y.max(1.0);
        let slopes = ((0.5 * self.field_of_view).to_radians().tan() * vec2(aspect, 1.0)).as_dvec2() * FITTED;
        let (_, half) = self.between(&places, reach, slopes);
        let clearance = 0.5 * (most.z - least.z) + reach + LEAST_CLEARANCE * extent;
        let distance = (half / slopes).max_element().max(clearance);
        // Along the axis that isn't filled, planes that are less steep touch on both sides. No place is farther from the middle
        // than the eye, so this converges.
        let touching = (0..FIT_STEPS).fold(slopes, |slopes, _| self.between(&places, reach, slopes).1 / distance);
        let (center, _) = self.between(&places, reach, touching);
        self.target = self.at(center.extend(middle));
        self.distance = distance.clamp(1e-30, 1e30) as f32;
    }

    /// The planes with these slopes that touch spheres of radius `reach` at `places` (right, up, back): left and right, and
    /// below and above. Returns the middle between them at depth 0, and half of their distance there. They meet in the eye that
    /// just sees all. In an orthographic view they are parallel.
    fn between(&self, places: &[DVec3], reach: f64, slopes: DVec2) -> (DVec2, DVec2) {
        let slopes = if self.orthographic { DVec2::ZERO } else { slopes };
        let farthest = |sign: f64| {
            let beside = places.iter().map(|place| place.truncate() * sign + slopes * place.z);
            beside.fold(DVec2::NEG_INFINITY, DVec2::max)
        };
        let [above, below] = [1.0, -1.0].map(farthest);
        // From the eye, a sphere reaches farther out than its radius at the depth of its centre.
        let beside = (DVec2::ONE + slopes * slopes).map(f64::sqrt) * reach;
        ((above - below) * 0.5, (above + below) * 0.5 + beside)
    }

    /// The position at these distances to the right, up and back.
    fn at(&self, place: DVec3) -> Vec3 {
        let [right, up, back] = self.axes().map(Vec3::as_dvec3);
        (right * place.x + up * place.y + back * place.z).as_vec3()
    }

    /// Puts a place in the middle, with what is `length` long there two thirds of the view's height long, seen from the direction
    /// `facing`. If that is zero, the direction stays. `bounds` are the mesh's.
    pub fn frame_at(&mut self, target: Vec3, length: f32, facing: Vec3, bounds: &Bounds) {
        self.target = target;
        let half = |angle: f32| (0.5 * angle).to_radians().tan();
        let nearer = half(FIELD_OF_VIEW) / half(self.field_of_view);
        self.distance = (FRAMED_EDGE * length * nearer).max(1e-4 * bounds.radius());
        if facing != Vec3::ZERO {
            self.turn_to(facing);
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::vec3;

    use super::*;
    use geometry::view::project;

    fn unit_bounds() -> Bounds {
        Bounds::new([Vec3::NEG_ONE, Vec3::ONE].into_iter())
    }

    #[test]
    fn a_framed_sphere_touches_the_shorter_side() {
        for viewport in [vec2(800.0, 600.0), vec2(200.0, 700.0)] {
            let bounds = unit_bounds();
            let camera = Camera { azimuth: 0.0, elevation: 0.0, ..Camera::framing(&bounds, viewport) };
            let half_angle = (bounds.radius() / camera.distance).asin();
            let reach = half_angle.tan() * camera.distance / camera.units_per_pixel(viewport.y);
            assert!((reach - 0.5 * viewport.min_element()).abs() < 0.5, "{reach} px of {viewport}");
        }
    }

    /// The least and greatest x and y of fitted positions on screen, from -1 to 1 in the viewport.
    fn filled(camera: &Camera, positions: &[Vec3], reach: f32, viewport: Vec2) -> [Vec2; 2] {
        let bounds = Bounds::new(positions.iter().copied());
        let clip = camera.clip_from_object(viewport, &bounds);
        let axes = camera.axes();
        let (mut least, mut most) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
        for &position in positions {
            for turn in 0..if reach > 0.0 { 400 } else { 1 } {
                let (around, up) = ((turn % 20) as f32 * 0.314_159, (turn / 20) as f32 * 0.165 - 1.57);
                let sphere = axes[0] * around.cos() * up.cos() + axes[1] * around.sin() * up.cos() + axes[2] * up.sin();
                let place = project(clip, viewport, position + sphere * reach).expect("in front of the eye");
                let place = place / viewport * 2.0 - 1.0;
                (least, most) = (least.min(place), most.max(place));
            }
        }
        [least, most]
    }

    #[test]
    fn fitted_positions_fill_one_axis_and_are_in_the_middle() {
        let cloud: Vec<Vec3> = (0..40)
            .map(|i| vec3((i as f32 * 1.7).sin(), (i as f32 * 2.3).cos() * 0.4, (i as f32 * 0.9).sin() * 1.6))
            .collect();
        let flat: Vec<Vec3> = cloud.iter().map(|p| vec3(p.x, 0.0, p.z)).collect();
        for (size, at) in [(1.0, Vec3::ZERO), (1e-20, Vec3::ZERO), (1e18, Vec3::ZERO), (1.0, vec3(800.0, -3.0, 50.0))] {
            for (positions, viewport) in
                [(&cloud, vec2(300.0, 240.0)), (&flat, vec2(200.0, 700.0)), (&flat, vec2(400.0, 150.0))]
            {
                let placed: Vec<Vec3> = positions.iter().map(|p| (*p + at) * size).collect();
                for (azimuth, elevation, orthographic, reach) in [
                    (30.0, 20.0, false, 0.0),
                    (250.0, 0.0, true, 0.0),
                    (0.0, -89.9, false, 0.3),
                    (123.0, 45.0, true, 0.2),
                ] {
                    let bounds = Bounds::new(placed.iter().copied());
                    let mut camera = Camera { azimuth, elevation, orthographic, ..Camera::framing(&bounds, viewport) };
                    camera.fit(placed.iter().copied(), reach * size, viewport);
                    let [least, most] = filled(&camera, &placed, reach * size, viewport);
                    let widest = most.max(-least).max_element();
                    let known = format!("{size:e} {at} {viewport} {azimuth} {orthographic}: {least} {most}");
                    assert!((0.91..0.94).contains(&widest), "{known}");
                    assert!((least + most).abs().max_element() < 0.03, "{known}");
                }
            }
        }
    }

    #[test]
    fn fitting_comes_nearer_than_framing() {
        let viewport = vec2(300.0, 240.0);
        let tall = [vec3(0.0, -1.0, 0.0), vec3(0.1, 1.0, 0.0), vec3(0.0, 0.0, 0.1)];
        let framed = Camera::framing(&Bounds::new(tall.into_iter()), viewport);
        let mut fitted = framed;
        fitted.fit(tall.into_iter(), 0.0, viewport);
        assert!(fitted.distance < 0.99 * framed.distance, "{fitted:?}");
        assert_eq!((fitted.azimuth, fitted.elevation), (framed.azimuth, framed.elevation));
    }

    #[test]
    fn positions_without_extent_give_a_valid_camera() {
        let viewport = vec2(300.0, 240.0);
        let end_on = [Vec3::Z, Vec3::NEG_Z, Vec3::ZERO];
        let bad = [Vec3::NAN, Vec3::INFINITY];
        let one = [vec3(3.0, 4.0, 5.0); 2];
        let far = [Vec3::MAX, Vec3::MIN];
        for (positions, seen) in [(&end_on[..], true), (&bad, false), (&one, true), (&[], false), (&far, false)] {
            for orthographic in [false, true] {
                let mut camera =
                    Camera { azimuth: 0.0, elevation: 0.0, orthographic, ..Camera::framing(&unit_bounds(), viewport) };
                camera.fit(positions.iter().copied(), 0.0, viewport);
                assert!(
                    camera.target.is_finite() && camera.distance.is_finite() && camera.distance > 0.0,
                    "{camera:?}"
                );
                let bounds = Bounds::new(positions.iter().copied());
                let clip = camera.clip_from_object(viewport, &bounds);
                let within = |p: Vec3| project(clip, viewport, p).is_some_and(|at| at.distance(viewport * 0.5) < 1.0);
                assert!(!seen || positions.iter().all(|&p| within(p)), "{camera:?}");
            }
        }
    }

    #[test]
    fn a_framed_edge_is_in_the_middle_and_faces_the_eye() {
        let viewport = vec2(800.0, 600.0);
        let mut camera = Camera::framing(&unit_bounds(), viewport);
        let (ends, facing) = ([vec3(0.5, 1.0, 0.0), vec3(0.7, 1.0, 0.1)], vec3(0.3, 0.8, -0.6).normalize());
        camera.frame_at(0.5 * (ends[0] + ends[1]), ends[0].distance(ends[1]), facing, &unit_bounds());
        assert!(camera.axes()[2].distance(facing) < 1e-5);
        let clip = camera.clip_from_object(viewport, &unit_bounds());
        let [a, b] = ends.map(|p| project(clip, viewport, p).expect("in front of the eye"));
        assert!((a + b).distance(viewport) < 2.0);
        let length = a.distance(b);
        assert!((350.0..450.0).contains(&length), "{length} px");
    }

    #[test]
    fn a_framed_place_is_in_the_middle_and_faces_the_eye() {
        let viewport = vec2(800.0, 600.0);
        let mut camera = Camera::framing(&unit_bounds(), viewport);
        let corners = [vec3(0.5, 0.1, 0.2), vec3(0.9, 0.1, 0.3), vec3(0.6, 0.4, 0.5)];
        let [a, b, c] = corners;
        let (facing, length) = ((b - a).cross(c - a).normalize(), a.distance(b).max(b.distance(c)).max(c.distance(a)));
        camera.frame_at((a + b + c) / 3.0, length, facing, &unit_bounds());
        assert!(camera.axes()[2].distance(facing) < 1e-5);
        let clip = camera.clip_from_object(viewport, &unit_bounds());
        let [a, b, c] = corners.map(|p| project(clip, viewport, p).expect("in front of the eye"));
        assert!((a + b + c).distance(viewport * 1.5) < 3.0);
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        assert!((350.0..450.0).contains(&longest), "{longest} px");
        let before = camera;
        camera.frame_at(Vec3::ONE, 0.0, Vec3::ZERO, &unit_bounds());
        assert_eq!((camera.azimuth, camera.elevation), (before.azimuth, before.elevation), "a point faces nowhere");
        assert!(camera.distance > 0.0);
    }
}

//! From where the worst place of a gate is shown: where nothing hides it.

use glam::{Vec2, Vec3, vec3};

use super::place::{EdgeSpot, PatchSpot, Spot, towards};
use crate::render::Camera;
use crate::render::camera::{FIELD_OF_VIEW, MAX_ELEVATION};
use geometry::mesh::Bounds;

/// How many directions around a hidden place are tried.
const DIRECTIONS: u32 = 64;
/// What is nearer to the place than this part of its edge or patch is at the place, and hides nothing.
const NEAR: f32 = 0.005;
/// How well the back of a place shows it, where its front does so by 1.
const OF_BACK: f32 = 0.25;
/// How well a place that has no front is seen from within the mesh, where it is seen from outside by 1.
const FROM_WITHIN: f64 = 0.5;
/// How far the eye goes towards what hides the place, when it is seen from between the two.
const BETWEEN: f32 = 0.9;

/// Cameras from which a place may be seen.
pub struct Standpoints {
    /// The place, in object units; none if it isn't known, and then there is one camera alone.
    at: Option<Vec3>,
    /// Whether both sides show it as well.
    both_sides: bool,
    /// The size of its edge or patch, and a distance at which one is outside of the mesh, in object units.
    size: f32,
    beyond: f32,
    /// The camera that shows it best if nothing hides it from there.
    first: Camera,
    /// Cameras around it, and for each how well it shows the place, 0 to 1.
    around: Vec<(Camera, f32)>,
}

impl Standpoints {
    /// Those of a spot. `judged` is the camera of the judged picture, `viewport` that picture's size in px, and `bounds` are the
    /// mesh's.
    pub fn new(spot: &Spot, judged: &Camera, viewport: Vec2, bounds: &Bounds) -> Self {
        let first = spot.camera(judged, viewport, bounds);
        let (size, facing, both_sides) = match *spot {
            Spot::Edge(EdgeSpot { ends: [a, b], .. }) => (a.distance(b), first, false),
            Spot::Patch(PatchSpot { size, both_sides, .. }) => (size, first, both_sides),
            Spot::Leak { torn: Some(torn @ EdgeSpot { ends: [a, b], .. }), .. } => {
                (a.distance(b), torn.camera(judged, bounds), false)
            }
            Spot::Leak { torn: None, .. } => (0.0, first, false),
        };
        let at = spot.at();
        let of_back = if both_sides { 1.0 } else { OF_BACK };
        let around = if at.is_some() { around(&facing, of_back) } else { Vec::new() };
        let beyond = (4.0 * bounds.radius() + first.target.distance(bounds.center())).max(first.distance);
        Self { at, both_sides, size, beyond, first, around }
    }

    /// Where lines of sight begin, all eyes, and how near to the place nothing hides it, in object units. None if the place isn't
    /// known. `beside` moves a camera so that the place is elsewhere in its picture.
    pub fn lines(&self, beside: impl Fn(Camera) -> Camera) -> Option<(Vec3, Vec<Vec3>, f32)> {
        let at = self.at?;
        let eye = |camera: &Camera| match camera.orthographic {
            // An orthographic view has no eye: what is farther away hides the place too.
            true => at + camera.axes()[2] * self.beyond,
            // What is beyond the eye tells outside from within.
            false if self.both_sides => at + (beside(*camera).eye() - at).normalize_or_zero() * self.beyond,
            false => beside(*camera).eye(),
        };
        let others = self.around.iter().map(|(camera, _)| camera);
        Some((at, std::iter::once(&self.first).chain(others).map(eye).collect(), NEAR * self.size))
    }

    /// The camera that shows the place. `clear` has the part of each line that is clear, from the place on.
    pub fn clearest(&self, clear: &[f64]) -> Camera {
        let (Some(at), Some((first, others))) = (self.at, clear.split_first()) else { return self.first };
        if *first >= 1.0 {
            return self.first;
        }
        let rated = self.around.iter().zip(others).map(|((camera, fitness), clear)| {
            let (up_to_eye, there) = match self.both_sides {
                true if *clear < 1.0 => ((clear * f64::from(self.beyond / camera.distance)).min(1.0), FROM_WITHIN),
                _ => (*clear, 1.0),
            };
            (camera, up_to_eye, f64::from(*fitness) * up_to_eye * there)
        });
        // The first of those that are as good.
        let best = rated.reduce(|a, b| if b.2 > a.2 { b } else { a });
        match best {
            Some((camera, clear, _)) if clear < 1.0 => {
                let eye = camera.eye() - at;
                towards(&Camera { target: at, ..*camera }, eye * (BETWEEN * clear as f32))
            }
            Some((camera, ..)) => *camera,
            None => self.first,
        }
    }
}

/// Perspective cameras around what `facing` shows, that one first, each with how well it shows it: the more a camera faces it the
/// better, its back shows it by `of_back` of that, and from the very side it isn't seen at all. The directions are those of the spherical
/// Fibonacci point set (Keinert et al. 2015, "Spherical Fibonacci Mapping").
fn around(facing: &Camera, of_back: f32) -> Vec<(Camera, f32)> {
    const GOLDEN_ANGLE: f32 = 2.399_963_2;
    let field_of_view = if facing.orthographic { FIELD_OF_VIEW } else { facing.field_of_view };
    let narrower = |angle: f32| (0.5 * angle).to_radians().tan();
    let distance = facing.distance * narrower(facing.field_of_view) / narrower(field_of_view);
    let facing = Camera { orthographic: false, field_of_view, distance, ..*facing };
    let front = facing.axes()[2];
    let direction = |index: u32| {
        let height = 1.0 - (2.0 * index as f32 + 1.0) / DIRECTIONS as f32;
        let (sine, cosine) = (index as f32 * GOLDEN_ANGLE).sin_cos();
        let level = (1.0 - height * height).sqrt();
        vec3(sine * level, height, cosine * level)
    };
    let from = |back: Vec3| {
        let mut camera = towards(&facing, back * distance);
        camera.elevation = camera.elevation.clamp(-MAX_ELEVATION, MAX_ELEVATION);
        let faces = back.dot(front);
        (camera, faces.max(-of_back * faces))
    };
    std::iter::once((facing, 1.0)).chain((0..DIRECTIONS).map(direction).map(from)).collect()
}

#[cfg(test)]
mod tests {
    use glam::vec2;

    use super::*;

    fn judged(orthographic: bool) -> (Camera, Vec2, Bounds) {
        let (viewport, bounds) = (vec2(640.0, 480.0), Bounds::new([Vec3::NEG_ONE, Vec3::ONE].into_iter()));
        (Camera { orthographic, ..Camera::framing(&bounds, viewport) }, viewport, bounds)
    }

    /// An edge in the middle, which faces the front.
    const EDGE: EdgeSpot = EdgeSpot { ends: [Vec3::NEG_X, Vec3::X], facing: Vec3::Z, at: Vec3::ZERO };

    #[test]
    fn a_place_is_seen_from_the_side_that_faces_it_most_and_is_clear() {
        for orthographic in [false, true] {
            let (camera, viewport, bounds) = judged(orthographic);
            let standpoints = Standpoints::new(&Spot::Edge(EDGE), &camera, viewport, &bounds);
            let (at, eyes, near) = standpoints.lines(|camera| camera).expect("a known place");
            assert!(at == EDGE.at && near < 0.05);
            let direction = |camera: &Camera| (camera.eye() - at).normalize();
            let front = standpoints.clearest(&vec![1.0; eyes.len()]);
            assert!(front.orthographic == orthographic && direction(&front).distance(Vec3::Z) < 1e-3, "{front:?}");
            // A wall right before it hides it from all directions within 60 degrees of its front.
            let wall = |eye: &Vec3| if eye.normalize().z > 0.5 { 0.05 } else { 1.0 };
            let beside = standpoints.clearest(&eyes.iter().map(wall).collect::<Vec<_>>());
            assert!((0.3..=0.5).contains(&direction(&beside).z), "{beside:?}");
            // Hidden from everywhere: from before what hides it.
            let between = standpoints.clearest(&vec![0.5; eyes.len()]);
            assert!(direction(&between).distance(Vec3::Z) < 1e-3 && between.target == at, "{between:?}");
            assert!(!between.orthographic);
            assert!((between.distance / eyes[1].length() - 0.45).abs() < 1e-3, "{between:?}");
        }
    }

    #[test]
    fn a_fold_is_seen_from_the_side_that_is_outside_of_the_mesh() {
        let (camera, viewport, bounds) = judged(false);
        let spot = PatchSpot { at: Vec3::ZERO, facing: Vec3::Z, size: 0.1, both_sides: true };
        let standpoints = Standpoints::new(&Spot::Patch(spot), &camera, viewport, &bounds);
        let (at, eyes, _) = standpoints.lines(|camera| camera).expect("a known place");
        let beyond = eyes[0].distance(at);
        assert!(beyond > 2.0 * bounds.radius(), "the lines go on to where the mesh ends: {beyond}");
        // In front of it is the inside of the mesh, up to a wall behind the eye.
        let clear: Vec<f64> = eyes.iter().map(|eye| if eye.z > 0.0 { 0.4 } else { 1.0 }).collect();
        let camera = standpoints.clearest(&clear);
        assert!((camera.eye() - at).normalize().z < -0.9 && camera.distance < 0.5, "{camera:?}");
        // Hidden from outside everywhere: from where its front is seen, within the mesh.
        let camera = standpoints.clearest(&vec![0.4; eyes.len()]);
        assert!((camera.eye() - at).normalize().distance(Vec3::Z) < 1e-3 && camera.distance < 0.5, "{camera:?}");
    }

    #[test]
    fn a_leak_is_seen_from_the_judged_eye_unless_it_is_hidden_there() {
        let (camera, viewport, bounds) = judged(false);
        let leak = |torn| Spot::Leak { px: 0.5 * viewport, pixels: 9, torn };
        let known = Standpoints::new(&leak(Some(EDGE)), &camera, viewport, &bounds);
        let (_, eyes, _) = known.lines(|camera| camera).expect("a known place");
        assert!(eyes[0].distance(camera.eye()) < 1e-3);
        let clear = |first: f64| [vec![first], vec![1.0; eyes.len() - 1]].concat();
        assert!(known.clearest(&clear(1.0)).eye().distance(camera.eye()) < 1e-3);
        assert!(known.clearest(&clear(0.9)).eye().normalize().distance(Vec3::Z) < 1e-3, "from where the edge faces");
        let unknown = Standpoints::new(&leak(None), &camera, viewport, &bounds);
        assert!(unknown.lines(|camera| camera).is_none() && unknown.clearest(&[]).eye().distance(camera.eye()) < 1e-3);
    }
}

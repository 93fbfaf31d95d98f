//! From where the worst place of a gate is shown: where nothing hides it.

use glam::{Vec2, Vec3, vec3};

use super::place::{EdgeSpot, Spot, towards};
use crate::measure::SightLine;
use crate::mesh::Bounds;
use crate::render::Camera;
use crate::render::camera::{FIELD_OF_VIEW, MAX_ELEVATION};

/// How many directions around a hidden place are tried.
const DIRECTIONS: u32 = 48;
/// What is nearer to the place than this part of its edge or patch is at the place, and hides nothing.
const NEAR: f32 = 0.005;
/// How far beside the place other lines of sight run, in px: a place that shows through a slit alone is hidden.
const BESIDE: f32 = 4.0;
/// How many lines of sight a camera has: through the place, and beside it on four sides.
const LINES: usize = 5;
/// How far the eye goes towards what hides the place, when it is seen from between the two.
const BETWEEN: f32 = 0.9;

/// Cameras from which a place may be seen.
pub(crate) struct Standpoints {
    /// The place, in object units; none if it isn't known, and then there is one camera alone.
    at: Option<Vec3>,
    /// What is nearer to the place hides nothing, in object units.
    near: f64,
    /// Lines of sight are so far from each other, and an orthographic camera's so long, in object units.
    beside: f32,
    beyond: f32,
    /// The camera that shows it best if nothing hides it from there.
    first: Camera,
    /// Cameras around it, and for each how well it shows the place, 0 to 1.
    around: Vec<(Camera, f32)>,
}

impl Standpoints {
    /// Those of a spot. `judged` is the camera of the judged picture, `viewport` that picture's size in px, and `bounds` are the
    /// mesh's.
    pub(crate) fn of(spot: &Spot, judged: &Camera, viewport: Vec2, bounds: &Bounds) -> Self {
        let first = spot.camera(judged, viewport, bounds);
        let (size, facing) = match *spot {
            Spot::Edge(EdgeSpot { ends: [a, b], .. }) => (a.distance(b), first),
            Spot::Patch { corners: [a, b, c], .. } => (a.distance(b).max(b.distance(c)).max(c.distance(a)), first),
            Spot::Leak { torn: Some(torn), .. } => (torn.ends[0].distance(torn.ends[1]), torn.camera(judged, bounds)),
            Spot::Leak { torn: None, .. } => (0.0, first),
        };
        let at = spot.at();
        let around = if at.is_some() { around(&facing) } else { Vec::new() };
        let beside = BESIDE * first.units_per_pixel(viewport.y);
        let near = f64::from((NEAR * size).max(2.0 * beside));
        let beyond = 4.0 * bounds.radius() + first.target.distance(bounds.center());
        Self { at, near, beside, beyond, first, around }
    }

    /// The camera that shows the place best if nothing hides it from there.
    pub(crate) fn first(&self) -> &Camera {
        &self.first
    }

    /// What is nearer to the place than this hides nothing, in object units.
    pub(crate) fn near(&self) -> f64 {
        self.near
    }

    /// The lines of sight of the first camera; none if the place isn't known.
    pub(crate) fn first_lines(&self) -> Vec<SightLine> {
        self.at.map_or(Vec::new(), |at| self.lines(at, &self.first).to_vec())
    }

    /// Those of the cameras around the place.
    pub(crate) fn lines_around(&self) -> Vec<SightLine> {
        let Some(at) = self.at else { return Vec::new() };
        self.around.iter().flat_map(|(camera, _)| self.lines(at, camera)).collect()
    }

    fn lines(&self, at: Vec3, camera: &Camera) -> [SightLine; LINES] {
        let [right, up, back] = camera.axes();
        // An orthographic view has no eye: what is farther away hides the place too.
        let to_eye = if camera.orthographic { back * self.beyond } else { camera.eye() - at };
        [Vec3::ZERO, right, -right, up, -up]
            .map(|aside| SightLine { from: (at + aside * self.beside).as_dvec3(), to_eye: to_eye.as_dvec3() })
    }

    /// Whether the first camera shows the place. `clear` has the part of each of its lines that is clear.
    pub(crate) fn is_seen_first(&self, clear: &[f64]) -> bool {
        clear_part(clear) >= 1.0
    }

    /// The camera around the place that shows it best. `clear` has the part of each of their lines that is clear.
    pub(crate) fn clearest(&self, clear: &[f64]) -> Camera {
        let parts = clear.chunks_exact(LINES).map(clear_part);
        let rated =
            self.around.iter().zip(parts).map(|((camera, fitness), part)| (camera, part, f64::from(*fitness) * part));
        // The first of those that are as good.
        let best = rated.reduce(|a, b| if b.2 > a.2 { b } else { a });
        match (best, self.at) {
            (Some((camera, part, _)), Some(at)) if part < 1.0 => {
                let to_eye = camera.eye() - at;
                towards(&Camera { target: at, ..*camera }, to_eye * (BETWEEN * part as f32))
            }
            (Some((camera, ..)), _) => *camera,
            (None, _) => self.first,
        }
    }
}

/// The part that is clear of most lines of a camera: a few of them may graze the surface that the place is on.
fn clear_part(clear: &[f64]) -> f64 {
    let mut sorted = clear.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(clear.len() / 2).copied().unwrap_or(1.0)
}

/// Perspective cameras around what `facing` shows, that one first, each with how well it shows it: those that face it more are
/// better. The directions are those of the spherical Fibonacci point set (Keinert et al. 2015, "Spherical Fibonacci Mapping").
fn around(facing: &Camera) -> Vec<(Camera, f32)> {
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
        (camera, 0.5 + 0.5 * back.dot(front))
    };
    std::iter::once((facing, 1.0)).chain((0..DIRECTIONS).map(direction).map(from)).collect()
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, vec2};

    use super::*;

    fn judged(orthographic: bool) -> (Camera, Vec2, Bounds) {
        let (viewport, bounds) = (vec2(640.0, 480.0), Bounds::of([Vec3::NEG_ONE, Vec3::ONE].into_iter()));
        (Camera { orthographic, ..Camera::framing(&bounds, viewport) }, viewport, bounds)
    }

    /// An edge in the middle, which faces the front.
    const EDGE: EdgeSpot = EdgeSpot { ends: [Vec3::NEG_X, Vec3::X], facing: Vec3::Z, at: Vec3::ZERO };

    /// What is clear of lines, where `hidden` has that for lines in each unit direction.
    fn clear(lines: &[SightLine], hidden: impl Fn(DVec3) -> f64) -> Vec<f64> {
        lines.iter().map(|line| hidden(line.to_eye.normalize())).collect()
    }

    #[test]
    fn a_place_is_seen_from_the_side_that_faces_it_most_and_is_clear() {
        for orthographic in [false, true] {
            let (camera, viewport, bounds) = judged(orthographic);
            let standpoints = Standpoints::of(&Spot::Edge(EDGE), &camera, viewport, &bounds);
            let direction = |camera: &Camera| camera.eye().normalize();
            let front = standpoints.first();
            assert!(front.orthographic == orthographic && direction(front).distance(Vec3::Z) < 1e-3, "{front:?}");
            assert_eq!((standpoints.first_lines().len(), standpoints.near() < 0.1), (LINES, true));
            let around = standpoints.lines_around();
            // A wall right before it hides it from all directions within 60 degrees of its front.
            let beside = standpoints.clearest(&clear(&around, |to_eye| if to_eye.z > 0.5 { 0.05 } else { 1.0 }));
            assert!((0.25..=0.5).contains(&direction(&beside).z), "{beside:?}");
            // Hidden from everywhere: from before what hides it.
            let between = standpoints.clearest(&clear(&around, |_| 0.5));
            assert!(direction(&between).distance(Vec3::Z) < 1e-3 && between.target == EDGE.at, "{between:?}");
            assert!(!between.orthographic);
            assert!((f64::from(between.distance) / around[0].to_eye.length() - 0.45).abs() < 1e-3, "{between:?}");
        }
    }

    #[test]
    fn a_leak_is_seen_from_the_judged_eye_unless_it_is_hidden_there() {
        let (camera, viewport, bounds) = judged(false);
        let leak = |torn| Spot::Leak { px: 0.5 * viewport, pixels: 9, torn };
        let known = Standpoints::of(&leak(Some(EDGE)), &camera, viewport, &bounds);
        assert!(known.first().eye().distance(camera.eye()) < 1e-3);
        assert!(known.is_seen_first(&[1.0, 0.2, 1.0, 0.2, 1.0]), "two lines graze something");
        assert!(!known.is_seen_first(&[1.0, 0.2, 0.2, 0.2, 1.0]), "it shows through a slit");
        let other = known.clearest(&clear(&known.lines_around(), |_| 1.0));
        assert!(other.eye().normalize().distance(Vec3::Z) < 1e-3, "from where the edge faces");
        let unknown = Standpoints::of(&leak(None), &camera, viewport, &bounds);
        assert!(unknown.first_lines().is_empty() && unknown.is_seen_first(&[]));
    }
}

//! Paths along which cameras move.

use geometry::mesh::Bounds;
use glam::Vec2;
use inspect::render::camera::Camera;

use crate::VIEWPORT;

#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Motion {
    Orbit,
    Dolly,
    Pan,
}

impl Motion {
    pub(crate) const ALL: [Self; 3] = [Self::Orbit, Self::Dolly, Self::Pan];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Orbit => "orbits",
            Self::Dolly => "dollies",
            Self::Pan => "pans",
        }
    }

    /// Moves a camera as from one frame to the next. `direction` is a unit vector.
    fn step(self, camera: &mut Camera, direction: Vec2) {
        match self {
            // By 1 degree.
            Self::Orbit => camera.orbit(direction),
            Self::Dolly => camera.zoom(0.99, VIEWPORT * 0.5, VIEWPORT),
            // By 10 px.
            Self::Pan => camera.pan(10.0 * direction, VIEWPORT),
        }
    }
}

/// One camera for each frame.
pub(crate) struct Path {
    /// Which mesh it shows.
    pub mesh: usize,
    pub motion: Motion,
    pub cameras: Vec<Camera>,
}

/// Makes `count` paths of `frames` frames, shared out evenly among meshes with these bounds.
pub(crate) fn random(bounds: &[Bounds], count: usize, frames: usize) -> Vec<Path> {
    let mut random = fastrand::Rng::with_seed(1);
    let path = |number: usize| {
        let mesh = number % bounds.len();
        let motion = Motion::ALL[number / bounds.len() % 3];
        let angle = std::f32::consts::TAU * random.f32();
        let mut camera = start(&bounds[mesh], &mut random);
        let moved = |_| {
            let now = camera;
            motion.step(&mut camera, Vec2::from_angle(angle));
            now
        };
        Path { mesh, motion, cameras: (0..frames).map(moved).collect() }
    };
    (0..count).map(path).collect()
}

/// A camera that looks at the middle of a mesh from any side. Its distance is 0.4 to 1.6 times that which shows the whole mesh.
fn start(bounds: &Bounds, random: &mut fastrand::Rng) -> Camera {
    let framing = Camera::framing(bounds, VIEWPORT);
    Camera {
        azimuth: 360.0 * random.f32(),
        elevation: 60.0 * (2.0 * random.f32() - 1.0),
        distance: framing.distance * 0.4 * 4f32.powf(random.f32()),
        ..framing
    }
}

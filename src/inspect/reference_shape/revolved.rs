//! Surfaces of revolution around the Y axis: the torus, and those that a profile of line segments sweeps.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::{Nearest, ON_CREASE, Sample, Surface};

/// Returns the distance of p from the axis, and the unit direction away from the axis. Within `on_axis` of the axis the
/// direction is that of `facing`, if it has one.
fn around(p: DVec3, facing: DVec3, on_axis: f64) -> (f64, DVec3) {
    let flat = |v: DVec3| DVec3::new(v.x, 0.0, v.z);
    let radius = p.x.hypot(p.z);
    let own = if radius > 0.0 { flat(p) / radius } else { DVec3::Z };
    let out = if radius <= on_axis { flat(facing).try_normalize().unwrap_or(own) } else { own };
    (radius, out)
}

/// Returns the point at distance `out` from the axis and height `y` after `turn` turns (0 to 1).
fn turned(out: f64, y: f64, turn: f64) -> DVec3 {
    let (sin, cos) = (TAU * turn).sin_cos();
    DVec3::new(out * sin, y, out * cos)
}

/// A torus around the Y axis.
pub(super) struct Torus {
    /// The radius of the circle in the middle of the tube.
    pub major: f64,
    /// The radius of the tube.
    pub minor: f64,
}

impl Surface for Torus {
    fn closest(&self, p: DVec3, facing: DVec3) -> Nearest {
        let (radius, out) = around(p, facing, 0.0);
        let across = DVec2::new(radius - self.major, p.y).try_normalize().unwrap_or(DVec2::X);
        let normal = out * across.x + DVec3::Y * across.y;
        let point = out * self.major + normal * self.minor;
        Nearest { point, normal, distance: (DVec2::new(radius - self.major, p.y).length() - self.minor).abs() }
    }

    fn extent(&self) -> [DVec3; 2] {
        let out = self.major + self.minor;
        let corner = DVec3::new(out, self.minor, out);
        [-corner, corner]
    }

    fn at(&self, _: usize, s: f64, t: f64) -> (Sample, f64) {
        let (sin, cos) = (TAU * s).sin_cos();
        let out = self.major + self.minor * cos;
        let sample = Sample { point: turned(out, self.minor * sin, t), normal: turned(cos, sin, t) };
        (sample, TAU * out * TAU * self.minor)
    }

    fn bends(&self, _: usize) -> [f64; 3] {
        [self.minor, self.minor, self.major + self.minor].map(|radius| TAU * TAU * radius)
    }
}

/// Line segments in the half-plane of distance from the axis and height. The outside is on their right.
pub(super) struct Profile {
    segments: Vec<[DVec2; 2]>,
}

impl Profile {
    pub(super) fn new(corners: &[DVec2]) -> Self {
        Self { segments: corners.windows(2).map(|ends| [ends[0], ends[1]]).collect() }
    }

    fn size(&self) -> f64 {
        self.segments.iter().flatten().map(|corner| corner.length()).fold(0.0, f64::max)
    }
}

/// Returns the unit normal of a segment, to its right.
fn outward([a, b]: [DVec2; 2]) -> DVec2 {
    -(b - a).perp().normalize()
}

impl Surface for Profile {
    fn closest(&self, p: DVec3, facing: DVec3) -> Nearest {
        let near = ON_CREASE * self.size();
        let (radius, out) = around(p, DVec3::ZERO, 0.0);
        let (_, out_facing) = around(p, facing, near);
        let flat = DVec2::new(radius, p.y);
        let foot = |[a, b]: [DVec2; 2]| {
            let t = (flat - a).dot(b - a) / (b - a).length_squared();
            a.lerp(b, t.clamp(0.0, 1.0))
        };
        let feet = self.segments.iter().map(|segment| {
            let at = foot(*segment);
            (at, flat.distance(at), outward(*segment))
        });
        let first = (DVec2::ZERO, f64::INFINITY, DVec2::Y);
        let (at, distance, mut normal) =
            feet.clone().fold(first, |best, foot| if foot.1 < best.1 { foot } else { best });
        let facing_flat = DVec2::new(facing.dot(out_facing), facing.y);
        for (_, _, other) in feet.filter(|foot| foot.1 <= distance + near) {
            if other.dot(facing_flat) > normal.dot(facing_flat) {
                normal = other;
            }
        }
        let on_slope = if at.x <= near { out_facing } else { out };
        Nearest { point: out * at.x + DVec3::Y * at.y, normal: on_slope * normal.x + DVec3::Y * normal.y, distance }
    }

    fn extent(&self) -> [DVec3; 2] {
        let corners = || self.segments.iter().flatten();
        let out = corners().map(|corner| corner.x).fold(0.0, f64::max);
        let low = corners().map(|corner| corner.y).fold(f64::INFINITY, f64::min);
        let high = corners().map(|corner| corner.y).fold(f64::NEG_INFINITY, f64::max);
        [DVec3::new(-out, low, -out), DVec3::new(out, high, out)]
    }

    fn charts(&self) -> usize {
        self.segments.len()
    }

    fn at(&self, chart: usize, s: f64, t: f64) -> (Sample, f64) {
        let [a, b] = self.segments[chart];
        let (at, normal) = (a.lerp(b, s), outward([a, b]));
        let sample = Sample { point: turned(at.x, at.y, t), normal: turned(normal.x, normal.y, t) };
        (sample, TAU * at.x * a.distance(b))
    }

    fn bends(&self, chart: usize) -> [f64; 3] {
        let [a, b] = self.segments[chart];
        [0.0, TAU * (b.x - a.x).abs(), TAU * TAU * a.x.max(b.x)]
    }
}

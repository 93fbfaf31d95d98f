//! The saddle y = (x^2 - z^2) / 2 over a square around the origin.

use glam::DVec3;

use super::root::root;
use super::{Nearest, Sample, Surface};

/// The saddle y = (x^2 - z^2) / 2 over a square around the origin.
pub(super) struct Saddle {
    /// Half the square's side.
    pub half: f64,
}

/// Returns the saddle's point above (x, z).
fn point(x: f64, z: f64) -> DVec3 {
    DVec3::new(x, (x * x - z * z) / 2.0, z)
}

/// Returns the unit normal above (x, z).
fn normal(x: f64, z: f64) -> DVec3 {
    DVec3::new(-x, 1.0, z).normalize()
}

impl Surface for Saddle {
    fn closest(&self, p: DVec3, _: DVec3) -> Nearest {
        // The nearest point's x and z have the signs of p's, since the square and the saddle are symmetric.
        let q = DVec3::new(p.x.abs(), p.y, p.z.abs());
        let free = foot(q);
        let at = if free.x <= self.half && free.z <= self.half {
            free
        } else {
            let slope = 1.0 - self.half * self.half / 2.0;
            let along_z = point(self.half, cubic_root(slope + q.y, q.z).min(self.half));
            let along_x = point(cubic_root(slope - q.y, q.x).min(self.half), self.half);
            if q.distance_squared(along_z) <= q.distance_squared(along_x) { along_z } else { along_x }
        };
        let (x, z) = (at.x.copysign(p.x), at.z.copysign(p.z));
        let nearest = point(x, z);
        Nearest { point: nearest, normal: normal(x, z), distance: p.distance(nearest) }
    }

    fn extent(&self) -> [DVec3; 2] {
        let corner = DVec3::new(self.half, self.half * self.half / 2.0, self.half);
        [-corner, corner]
    }

    fn at(&self, _: usize, s: f64, t: f64) -> (Sample, f64) {
        let [x, z] = [s, t].map(|part| self.half * (2.0 * part - 1.0));
        let area = 4.0 * self.half * self.half * (1.0 + x * x + z * z).sqrt();
        (Sample { point: point(x, z), normal: normal(x, z) }, area)
    }

    fn bends(&self, _: usize) -> [f64; 3] {
        let along = 4.0 * self.half * self.half;
        [along, 0.0, along]
    }
}

/// Returns the nearest point of the unbounded saddle to a p with x and z of 0 or more.
///
/// If w is the height of that point above p, then x (1 + w) = p.x and z (1 - w) = p.z. What remains is one decreasing
/// function of w, whose root lies between -1 and 1.
fn foot(p: DVec3) -> DVec3 {
    if (p.x * p.x - p.z * p.z) / 2.0 - p.y > 0.0 {
        // The root is positive. Exchanging x and z and negating y makes it negative.
        let DVec3 { x, y, z } = foot_below(DVec3::new(p.z, -p.y, p.x));
        return DVec3::new(z, -y, x);
    }
    foot_below(p)
}

/// Returns the nearest point if w is 0 or negative. It solves for a = 1 + w, which keeps more digits.
fn foot_below(p: DVec3) -> DVec3 {
    let (xx, zz) = (p.x * p.x, p.z * p.z);
    let at = |a: f64| {
        let b = 2.0 - a;
        let value = (xx / (a * a) - zz / (b * b)) / 2.0 - p.y - a + 1.0;
        (value, -xx / (a * a * a) - zz / (b * b * b) - 1.0)
    };
    let above_ridge = 1.0 - p.y - zz / 8.0;
    if xx < 1e-200 && above_ridge <= 0.0 {
        // The point lies above the valley's centre of curvature, so both sides of the valley are equally near.
        return point((-2.0 * above_ridge).sqrt(), p.z / 2.0);
    }
    let a = root(0.0, 1.0, at);
    point(if xx == 0.0 { 0.0 } else { p.x / a }, p.z / (2.0 - a))
}

/// Returns the positive root of t^3 / 2 + a t = b for b of 0 or more, or 0 if there is none. Newton's method starts
/// above the root, where the function is convex.
fn cubic_root(a: f64, b: f64) -> f64 {
    let mut t = (2.0 * b).cbrt() + (-2.0 * a).max(0.0).sqrt();
    for _ in 0..100 {
        let slope = 1.5 * t * t + a;
        let step = if slope > 0.0 { (t * t * t / 2.0 + a * t - b) / slope } else { 0.0 };
        t -= step;
        if step.abs() <= 1e-16 * t {
            break;
        }
    }
    t.max(0.0)
}

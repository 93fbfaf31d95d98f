//! The saddle y = (x^2 - z^2) / 2 over a square around the origin.

use glam::DVec3;

use super::root::root;
use super::surface::Surface;
use super::{Nearest, Sample};

pub(super) struct Saddle {
    /// Half the square's side.
    pub half: f64,
}

fn point(x: f64, z: f64) -> DVec3 {
    DVec3::new(x, (x * x - z * z) / 2.0, z)
}

fn normal(x: f64, z: f64) -> DVec3 {
    DVec3::new(-x, 1.0, z).normalize()
}

impl Surface for Saddle {
    fn closest(&self, p: DVec3, _: DVec3) -> Nearest {
        // What is nearest has the signs of p's x and z, since square and saddle are symmetric.
        let q = DVec3::new(p.x.abs(), p.y, p.z.abs());
        let free = foot(q);
        let at = if free.x <= self.half && free.z <= self.half {
            free
        } else {
            let rim = 1.0 - self.half * self.half / 2.0;
            let along_z = point(self.half, cubic_root(rim + q.y, q.z).min(self.half));
            let along_x = point(cubic_root(rim - q.y, q.x).min(self.half), self.half);
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

    fn charts(&self) -> usize {
        1
    }

    fn at(&self, _: usize, s: f64, t: f64) -> (Sample, f64) {
        let [x, z] = [s, t].map(|part| self.half * (2.0 * part - 1.0));
        let area = 4.0 * self.half * self.half * (1.0 + x * x + z * z).sqrt();
        (Sample { point: point(x, z), normal: normal(x, z) }, area)
    }
}

/// The nearest point of the whole saddle, for x and z 0 or above. With w its height above p, x (1 + w) = p.x and
/// z (1 - w) = p.z; that leaves one falling function of w, whose root lies between -1 and 1.
fn foot(p: DVec3) -> DVec3 {
    if (p.x * p.x - p.z * p.z) / 2.0 - p.y > 0.0 {
        // The root is above 0. The saddle turned over has it below.
        let DVec3 { x, y, z } = foot_below(DVec3::new(p.z, -p.y, p.x));
        return DVec3::new(z, -y, x);
    }
    foot_below(p)
}

/// The same for a w of 0 or below, by a = 1 + w, which keeps its digits.
fn foot_below(p: DVec3) -> DVec3 {
    let (xx, zz) = (p.x * p.x, p.z * p.z);
    let at = |a: f64| {
        let b = 2.0 - a;
        let value = (xx / (a * a) - zz / (b * b)) / 2.0 - p.y - a + 1.0;
        (value, -xx / (a * a * a) - zz / (b * b * b) - 1.0)
    };
    let above_ridge = 1.0 - p.y - zz / 8.0;
    if xx < 1e-200 && above_ridge <= 0.0 {
        // Above the middle of the valley's curvature both of its sides are as near.
        return point((-2.0 * above_ridge).sqrt(), p.z / 2.0);
    }
    let a = root(0.0, 1.0, at);
    point(if xx == 0.0 { 0.0 } else { p.x / a }, p.z / (2.0 - a))
}

/// The positive root of t^3 / 2 + a t = b, for a b of 0 or above; 0 if there is none. From above, where it is convex.
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

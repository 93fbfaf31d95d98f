//! Ellipsoids around the origin, with the sphere as a special case.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::root::root;
use super::{Nearest, Sample, Surface};

pub(super) struct Ellipsoid {
    /// The radii along x, y and z.
    pub radii: DVec3,
}

impl Surface for Ellipsoid {
    fn closest(&self, p: DVec3, _: DVec3) -> Nearest {
        let radii = self.radii;
        let point = if radii == DVec3::splat(radii.x) {
            p.try_normalize().unwrap_or(DVec3::Y) * radii.x
        } else {
            let mut axes = [0, 1, 2];
            axes.sort_by(|a, b| radii[*b].total_cmp(&radii[*a]));
            let foot = foot(axes.map(|axis| radii[axis]), axes.map(|axis| p[axis].abs()));
            let mut point = DVec3::ZERO;
            for (axis, x) in axes.into_iter().zip(foot) {
                point[axis] = x.copysign(p[axis]);
            }
            point
        };
        let normal = (point / (radii * radii)).normalize();
        Nearest { point, normal, distance: p.distance(point) }
    }

    fn extent(&self) -> [DVec3; 2] {
        [-self.radii, self.radii]
    }

    /// Stretches the sphere with its latitude and longitude.
    fn at(&self, _: usize, s: f64, t: f64) -> (Sample, f64) {
        let (across, y) = (PI * s).sin_cos();
        let (sin, cos) = (TAU * t).sin_cos();
        let unit = DVec3::new(across * sin, y, across * cos);
        let steep = unit / self.radii;
        let sample = Sample { point: unit * self.radii, normal: steep.normalize() };
        (sample, PI * TAU * across.abs() * self.radii.element_product() * steep.length())
    }

    fn bends(&self, _: usize) -> [f64; 3] {
        [PI * PI, PI * TAU, TAU * TAU].map(|bend| bend * self.radii.max_element())
    }
}

/// Returns the nearest point to a place whose coordinates are 0 or positive. The radii are in descending order. Source:
/// Eberly, "Distance from a Point to an Ellipse, an Ellipsoid, or a Hyperellipsoid" (2013). His parameter is counted
/// from the pole here, since it would lose digits otherwise.
fn foot(radii: [f64; 3], p: [f64; 3]) -> [f64; 3] {
    let [_, _, least] = radii;
    let squares = radii.map(|radius| (radius / least) * (radius / least));
    let reach: [f64; 3] = std::array::from_fn(|i| squares[i] * (p[i] / radii[i]));
    // A coordinate of 0 stays 0, even if the divisor is 0.
    let part = |i: usize, w: f64| if reach[i] == 0.0 { 0.0 } else { reach[i] / (w + (squares[i] - 1.0)) };
    let sum = |w: f64| (0..3).map(|i| part(i, w) * part(i, w)).sum::<f64>();
    if reach[2] == 0.0 && sum(0.0) <= 1.0 {
        // The place is so near to the middle of the plane of the two larger radii that the shortest way leaves that plane.
        let x = [0, 1].map(|i| part(i, 0.0) * radii[i]);
        return [x[0], x[1], least * (1.0 - sum(0.0)).max(0.0).sqrt()];
    }
    let low = (0..3).map(|i| reach[i] - (squares[i] - 1.0)).fold(0.0, f64::max);
    let high = reach.iter().map(|x| x * x).sum::<f64>().sqrt();
    let slope = |w: f64| -2.0 * (0..3).map(|i| part(i, w) * part(i, w) / (w + (squares[i] - 1.0))).sum::<f64>();
    let w = root(low, high.max(low), |w| (sum(w) - 1.0, slope(w)));
    std::array::from_fn(|i| part(i, w) * radii[i])
}

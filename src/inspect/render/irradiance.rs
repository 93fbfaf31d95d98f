//! Irradiance as spherical harmonics, of which nine say all but a percent (Ramamoorthi and Hanrahan 2001).

use std::f32::consts::PI;

use glam::Vec3;

use super::cube_map::CubeMap;

/// Coefficients of 1, y, z, x, xy, yz, 3zz - 1, xz and xx - yy of a normal, in linear RGB. Their sum is the irradiance of a
/// surface with that normal, divided by pi.
pub(crate) type Irradiance = [Vec3; 9];

/// The squares of the constants of the harmonics (equation 3), times what a cosine leaves of each degree, divided by pi
/// (equation 8).
const WEIGHTS: [f32; 9] = {
    let (first, second) = (3.0 / (4.0 * PI) * (2.0 / 3.0), 15.0 / (4.0 * PI) * 0.25);
    [1.0 / (4.0 * PI), first, first, first, second, second, second / 12.0, second, second / 4.0]
};

/// The irradiance of an environment.
pub fn irradiance(map: &CubeMap) -> Irradiance {
    let mut sums = Irradiance::default();
    for (direction, solid_angle, light) in map.lights() {
        for (sum, term) in sums.iter_mut().zip(terms(direction)) {
            *sum += light * (term * solid_angle);
        }
    }
    std::array::from_fn(|index| sums[index] * WEIGHTS[index])
}

/// The polynomials that coefficients are for.
pub(crate) fn terms(Vec3 { x, y, z }: Vec3) -> [f32; 9] {
    [1.0, y, z, x, x * y, y * z, 3.0 * z * z - 1.0, x * z, x * x - y * y]
}

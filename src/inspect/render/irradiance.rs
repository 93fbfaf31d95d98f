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
fn terms(Vec3 { x, y, z }: Vec3) -> [f32; 9] {
    [1.0, y, z, x, x * y, y * z, 3.0 * z * z - 1.0, x * z, x * x - y * y]
}

/// Twin of `environment_irradiance` in `shaders/environment.wgsl`, of a light that isn't turned.
pub fn irradiance_of(coefficients: &Irradiance, normal: Vec3) -> Vec3 {
    let sum: Vec3 = coefficients.iter().zip(terms(normal)).map(|(&color, term)| color * term).sum();
    sum.max(Vec3::ZERO)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The integral over all texels.
    fn integrated(map: &CubeMap, normal: Vec3) -> Vec3 {
        map.lights().map(|(direction, angle, light)| light * (direction.dot(normal).max(0.0) * angle / PI)).sum()
    }

    #[test]
    fn an_even_light_gives_itself() {
        let map = CubeMap::new(32, |_| Vec3::new(1.0, 0.5, 0.25));
        let coefficients = irradiance(&map);
        for (normal, ..) in CubeMap::new(2, |_| Vec3::ZERO).lights() {
            assert!(irradiance_of(&coefficients, normal).distance(Vec3::new(1.0, 0.5, 0.25)) < 1e-3);
        }
    }

    /// Harmonics of degree 2 and less are exact, but for the texels.
    #[test]
    fn smooth_lights_give_their_integral() {
        let map =
            CubeMap::new(32, |d| Vec3::new(1.0 + 0.5 * d.y, 1.0 + d.x * d.z, 1.0 + 0.4 * d.x * d.x - 0.3 * d.z * d.y));
        let coefficients = irradiance(&map);
        for (normal, ..) in CubeMap::new(4, |_| Vec3::ZERO).lights() {
            let (found, exact) = (irradiance_of(&coefficients, normal), integrated(&map, normal));
            assert!(found.distance(exact) < 3e-3, "{normal}: {found} {exact}");
        }
    }
}

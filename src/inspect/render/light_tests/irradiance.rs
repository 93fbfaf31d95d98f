//! What matte surfaces get, held against sums over all of the light.

use glam::Vec3;

use crate::for_tests::prefiltered::{gathered, irradiance_map};
use crate::for_tests::sunlit::{SunCase, sun_cases};
use crate::render::cube_map::CubeMap;
use crate::render::environment::ENVIRONMENT_SIZE;
use crate::render::irradiance::light_parts;
use crate::render::layout::srgb;
use crate::render::studio::studio_light;
use load::panorama::Panorama;

/// Directions that are spread over the sphere.
fn normals() -> Vec<Vec3> {
    CubeMap::new(4, |_| Vec3::ZERO).lights().map(|(normal, ..)| normal).collect()
}

/// The sum over all texels.
fn integrated(map: &CubeMap, normal: Vec3) -> Vec3 {
    map.lights()
        .map(|(direction, angle, light)| light * (direction.dot(normal).max(0.0) * angle / std::f32::consts::PI))
        .sum()
}

#[test]
fn an_even_light_gives_itself() {
    let light = Vec3::new(1.0, 0.5, 0.25);
    let map = CubeMap::new(ENVIRONMENT_SIZE, |_| light);
    let panorama = Panorama::from_radiance([256, 128], |_| light);
    for parts in [light_parts(map.lights()), light_parts(panorama.lights())] {
        for normal in normals() {
            let found = gathered(&parts, normal);
            assert!((found / light - 1.0).abs().max_element() < 4e-3, "{normal}: {found}");
        }
    }
}

#[test]
fn smooth_lights_and_the_studio_give_their_integral() {
    let smooth = |d: Vec3| Vec3::new(1.0 + 0.5 * d.y, 1.0 + d.x * d.z, 1.0 + 0.4 * d.x * d.x - 0.3 * d.z * d.y);
    for map in [CubeMap::new(64, smooth), CubeMap::new(ENVIRONMENT_SIZE, studio_light)] {
        let read = irradiance_map(&light_parts(map.lights()), ENVIRONMENT_SIZE);
        for normal in normals() {
            let (found, exact) = (read.sample(normal, 0.0), integrated(&map, normal));
            assert!((found / exact - 1.0).abs().max_element() < 5e-3, "{normal}: {found} {exact}");
        }
    }
}

/// A small sun that gives half of all light, high, low and at the zenith, in a panorama that is halved first: within 2 of 255 steps
/// of the sum over all of its pixels.
#[test]
fn a_sun_lights_a_matte_surface_as_the_sum_over_all_pixels_says() {
    for SunCase { toward, panorama, normals, exact, exposure } in sun_cases() {
        let read = irradiance_map(&light_parts(panorama.reduced(512).lights()), ENVIRONMENT_SIZE);
        for (&normal, exact) in normals.iter().zip(&exact) {
            let shown = |light: Vec3| light.to_array().map(|channel| srgb(channel * exposure));
            let (found, exact) = (shown(read.sample(normal, 0.0)), shown(exact.as_vec3()));
            let most = found.iter().zip(exact).map(|(found, exact)| found.abs_diff(exact)).max();
            assert!(most <= Some(2), "{toward} {normal}: {found:?}, not {exact:?}");
        }
    }
}

/// More than a half float holds, or even a float: nothing is infinite or no number.
#[test]
fn the_brightest_suns_are_finite() {
    for brightest in [1e6, f32::MAX, f32::INFINITY] {
        let map =
            CubeMap::new(ENVIRONMENT_SIZE, |direction| Vec3::splat(if direction.y > 0.9 { brightest } else { 0.5 }));
        let parts = light_parts(map.lights());
        let [up, down] = [Vec3::Y, Vec3::NEG_Y].map(|normal| gathered(&parts, normal));
        assert!(up == Vec3::splat(65504.0) && down.distance(Vec3::splat(0.5)) < 0.01, "{brightest}: {up} {down}");
    }
    assert_eq!(gathered(&light_parts(CubeMap::new(8, |_| Vec3::ZERO).lights()), Vec3::X), Vec3::ZERO);
}

//! A sky with a small sun, and what matte surfaces get of it.

use std::f64::consts::{PI, TAU};

use glam::{DVec3, Vec3, dvec3, vec3};
use load::panorama::Panorama;

use crate::render::layout::linear;

/// The radius of the sun as it is seen from the Earth, in degrees.
const SUN_RADIUS: f32 = 0.27;

/// A panorama with a small sun, and what matte surfaces get of it.
pub struct SunCase {
    pub toward: Vec3,
    pub panorama: Panorama,
    pub normals: Vec<Vec3>,
    /// Irradiance at each normal, divided by pi.
    pub exact: Vec<DVec3>,
    /// With this factor, the side that faces the sun has the byte 200.
    pub exposure: f32,
}

/// Suns that are low, high and at the zenith.
pub fn sun_cases() -> impl Iterator<Item = SunCase> {
    [vec3(0.6, 0.1, -0.8), vec3(-0.3, 0.9, 0.4), vec3(0.05, 1.0, 0.02)].into_iter().map(|toward| {
        let (panorama, normals) = (sunlit([1100, 550], toward), normals_about(toward));
        let exact = irradiances(&panorama, &normals);
        let exposure = linear([200; 3])[1] / exact[0].y as f32;
        SunCase { toward, panorama, normals, exact, exposure }
    })
}

/// A panorama in which a sun in that direction gives half of all light. A pixel must not be larger than the sun.
fn sunlit(size: [u32; 2], toward: Vec3) -> Panorama {
    let is_sun = |direction: Vec3| direction.dot(toward.normalize()) > SUN_RADIUS.to_radians().cos();
    let sky = |direction: Vec3| {
        let ground = vec3(0.3, 0.27, 0.25);
        if direction.y < 0.0 { ground } else { vec3(0.6, 0.8, 1.0) * (1.0 + 0.5 * direction.y) }
    };
    let all = |light: &dyn Fn(Vec3) -> Vec3| {
        let lights = pixels(&Panorama::from_radiance(size, light));
        lights.iter().map(|(_, light)| light.element_sum()).sum::<f64>()
    };
    let sun = all(&sky) / all(&|direction| if is_sun(direction) { Vec3::ONE } else { Vec3::ZERO });
    Panorama::from_radiance(size, |direction| if is_sun(direction) { Vec3::splat(sun as f32) } else { sky(direction) })
}

/// Irradiance of surfaces with these normals, divided by pi: the sum over all pixels of a panorama.
fn irradiances(panorama: &Panorama, normals: &[Vec3]) -> Vec<DVec3> {
    let pixels = pixels(panorama);
    let irradiance = |normal: DVec3| pixels.iter().map(|&(toward, light)| toward.dot(normal).max(0.0) * light).sum();
    normals.iter().map(|normal| irradiance(normal.as_dvec3())).collect()
}

/// The direction of each pixel, and its light times its solid angle divided by pi.
fn pixels(panorama: &Panorama) -> Vec<(DVec3, DVec3)> {
    let [width, height] = panorama.size().map(f64::from);
    let pixel = |(index, light): (usize, &Vec3)| {
        let (column, row) = (index % panorama.size()[0] as usize, index / panorama.size()[0] as usize);
        let longitude = ((column as f64 + 0.5) / width - 0.5) * TAU;
        let [north, south] = [row, row + 1].map(|border| (0.5 - border as f64 / height) * PI);
        let latitude = 0.5 * (north + south);
        let toward = dvec3(longitude.sin() * latitude.cos(), latitude.sin(), -longitude.cos() * latitude.cos());
        (toward, light.as_dvec3() * (TAU / width * (north.sin() - south.sin()) / PI))
    };
    panorama.pixels().iter().enumerate().map(pixel).collect()
}

/// Normals at all angles from a direction, and many that are nearly across it.
fn normals_about(toward: Vec3) -> Vec<Vec3> {
    let toward = toward.normalize();
    let (right, up) = toward.any_orthonormal_pair();
    let all = (0..=16).map(|step| 180.0 * step as f32 / 16.0);
    let turned = |(index, angle): (usize, f32)| {
        let (along, (sine, cosine)) = (2.4 * index as f32, angle.to_radians().sin_cos());
        toward * cosine + (right * along.cos() + up * along.sin()) * sine
    };
    all.chain((86..=94).map(|angle| angle as f32)).enumerate().map(turned).collect()
}

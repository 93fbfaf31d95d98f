//! The sheen of cloth, held against integrals.

use std::f32::consts::PI;

use glam::{Vec3, vec3};

use super::lobes::hemisphere;
use super::split_sum::{Studio, normals};
use super::{cosines, eye_at, roughnesses, white_light};
use crate::for_tests::environment::environment_sheen;
use crate::for_tests::prefiltered::gathered;
use crate::for_tests::reflectance::{LookAt, direct_reflection, direct_sheen, reflect_ambient, sheen_direction};
use crate::render::cube_map::CubeMap;
use crate::render::studio::studio_light;

/// A material with that sheen, seen by an eye at that cosine from the normal.
fn sheen(base_color: Vec3, sheen_color: Vec3, sheen_roughness: f32, cosine: f32) -> LookAt {
    let sheen_albedo = environment_sheen(cosine, sheen_roughness);
    LookAt { base_color, sheen_color, sheen_roughness, sheen_albedo, specular: 0.0, ..LookAt::default() }
}

/// Light from all directions at once, one by one.
fn reflected_of_all(look: &LookAt, cosine: f32) -> Vec3 {
    const COUNT: u32 = 16_384;
    let to_eye = eye_at(cosine);
    let sum: Vec3 = hemisphere(COUNT).map(|to_light| direct_reflection(look, Vec3::Z, to_eye, to_light)).sum();
    sum * (2.0 * PI / COUNT as f32)
}

/// Both are integrals of one lobe, from directions of their own. The table's directions leave 0.002 open, and so do 16,384 of
/// Hammersley's; the rest is what is linear between entries.
#[test]
fn the_table_holds_the_integral_of_the_sheen() {
    let mut most = 0.0_f32;
    for cosine in cosines() {
        for roughness in roughnesses().filter(|&roughness| roughness > 0.15) {
            // Without a known albedo, nothing is scaled down.
            let look = LookAt { sheen_albedo: 0.0, ..sheen(Vec3::ZERO, Vec3::ONE, roughness, cosine) };
            let integral = reflected_of_all(&look, cosine).x;
            let off = (integral - environment_sheen(cosine, roughness)).abs();
            assert!(off < 0.012, "{cosine} {roughness}: {integral} {}", environment_sheen(cosine, roughness));
            most = most.max(off);
        }
    }
    println!("{most}");
}

#[test]
fn light_from_all_directions_one_by_one_is_what_the_sheen_reflects_of_an_even_light() {
    for cosine in [0.1, 0.3, 0.6, 0.9] {
        for roughness in [0.2, 0.4, 0.7, 1.0] {
            let look = sheen(vec3(0.3, 0.2, 0.1), vec3(0.9, 0.5, 0.7), roughness, cosine);
            let ambient = reflect_ambient(&look, &white_light(cosine, look.roughness, 0.0));
            let summed = reflected_of_all(&look, cosine);
            assert!(ambient.distance(summed) < 0.02, "{cosine} {roughness}: {ambient} {summed}");
        }
    }
}

#[test]
fn white_sheen_over_white_cannot_be_seen_in_a_white_room() {
    for facing in cosines().chain([0.0, 0.01]) {
        for roughness in roughnesses() {
            for strength in [0.0, 0.3, 1.0] {
                for (coat, metallic) in [(0.0, 0.0), (1.0, 0.0), (0.5, 1.0)] {
                    let own = sheen(Vec3::ONE, Vec3::splat(strength), roughness, facing);
                    let look = LookAt { coat, metallic, specular: 1.0, ..own };
                    let seen = reflect_ambient(&look, &white_light(facing, look.roughness, look.coat_roughness));
                    assert!(seen.distance(Vec3::ONE) < 0.01, "{facing} {look:?}: {seen}");
                }
            }
        }
    }
}

/// The fitted lobe of smooth fibres that are seen from the side would reflect several times the light that there is.
#[test]
fn no_sheen_reflects_more_than_it_gets() {
    for cosine in [0.02, 0.05, 0.1, 0.5, 1.0] {
        for roughness in [0.1, 0.15, 0.2, 0.5, 1.0] {
            let look = sheen(Vec3::ONE, Vec3::ONE, roughness, cosine);
            let [lobe, all] =
                [sheen(Vec3::ZERO, Vec3::ONE, roughness, cosine), look].map(|look| reflected_of_all(&look, cosine));
            assert!(lobe.max_element() < 1.03 && all.max_element() < 1.03, "{cosine} {roughness}: {lobe} {all}");
        }
    }
}

#[test]
fn a_sheen_shows_along_outlines_and_backwards_in_both_directions() {
    let look = sheen(Vec3::ZERO, Vec3::ONE, 0.4, 0.3);
    let head_on = sheen(Vec3::ZERO, Vec3::ONE, 0.4, 1.0);
    assert!(look.sheen_albedo > 20.0 * head_on.sheen_albedo, "{} {}", look.sheen_albedo, head_on.sheen_albedo);
    let (eye, light) = (eye_at(0.3), vec3(0.5, -0.4, 0.6).normalize());
    let half_way = (eye + light).normalize();
    let [there, back] = [
        direct_sheen(&look, Vec3::Z, eye, light, half_way) / light.z,
        direct_sheen(&look, Vec3::Z, light, eye, half_way) / eye.z,
    ];
    assert!((there - back).abs() < 1e-5 * there, "{there} {back}");
}

/// White sheen on a black sphere in the studio, from the irradiance about the direction half way to the eye, against the sum over
/// all of the light: the mean difference, relative to the mean brightness. The page about materials states these bounds.
#[test]
fn a_sphere_with_sheen_is_near_its_integral() {
    let (studio, coarse, to_eye) = (Studio::new(), CubeMap::new(32, studio_light), Vec3::Z);
    let lights: Vec<_> = coarse.lights().collect();
    for (roughness, most) in [(0.3, 0.27), (0.5, 0.16), (0.7, 0.1), (1.0, 0.08)] {
        let (mut off, mut sum) = (0.0, 0.0);
        for normal in normals() {
            let look = sheen(Vec3::ZERO, Vec3::ONE, roughness, normal.dot(to_eye));
            let lobe = |to_light: Vec3| direct_sheen(&look, normal, to_eye, to_light, (to_eye + to_light).normalize());
            let exact: Vec3 = lights.iter().map(|&(to_light, angle, light)| light * (angle * lobe(to_light))).sum();
            let gathered = gathered(&studio.parts, sheen_direction(normal, to_eye));
            off += (gathered * look.sheen_albedo.min(1.0) - exact).abs().element_sum();
            sum += exact.element_sum();
        }
        println!("{roughness}: {}", off / sum);
        assert!(off / sum < most, "{roughness}: {}", off / sum);
    }
}

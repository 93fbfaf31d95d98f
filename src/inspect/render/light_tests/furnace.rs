//! What absorbs nothing can't be seen in a room that is equally bright on all sides.

use glam::Vec3;

use super::{cosines, roughnesses, white_light};
use crate::for_tests::reflectance::{LookAt, reflect_ambient};

/// What a material shows in a room that is 1 on all sides.
fn seen(look: &LookAt, facing: f32) -> Vec3 {
    reflect_ambient(look, &white_light(facing, look.roughness, look.coat_roughness))
}

#[test]
fn white_surfaces_cannot_be_seen_in_a_white_room() {
    for facing in cosines().chain([0.0]) {
        for roughness in roughnesses() {
            for metallic in [0.0, 0.3, 1.0] {
                for (coat, ior) in [(0.0, 1.5), (0.6, 1.5), (1.0, 2.4), (0.0, 1.0), (0.0, 0.0)] {
                    let look =
                        LookAt { roughness, metallic, coat, ior, coat_roughness: 1.0 - roughness, ..LookAt::default() };
                    let seen = seen(&look, facing);
                    assert!(seen.distance(Vec3::ONE) < 0.01, "{facing} {look:?}: {seen}");
                }
            }
        }
    }
}

#[test]
fn no_surface_reflects_more_than_it_gets_or_less_than_nothing() {
    for facing in cosines().chain([0.0]) {
        for roughness in roughnesses() {
            for color in [Vec3::ZERO, Vec3::new(1.0, 0.5, 0.0), Vec3::ONE] {
                for (metallic, specular, coat) in [(0.0, 0.0, 0.0), (0.0, 1.0, 1.0), (0.5, 0.5, 0.5), (1.0, 1.0, 0.0)] {
                    let look = LookAt {
                        base_color: color,
                        specular_color: color,
                        roughness,
                        metallic,
                        specular,
                        coat,
                        ..LookAt::default()
                    };
                    let seen = seen(&look, facing);
                    assert!(seen.min_element() >= 0.0 && seen.max_element() < 1.001, "{facing} {look:?}: {seen}");
                }
            }
        }
    }
}

/// The colour of a rough metal gets deeper as light meets several microfacets (Fdez-Aguera 2019, figure 1).
#[test]
fn rough_metal_is_more_saturated_than_polished_metal() {
    let gold = |roughness| {
        let look = LookAt { base_color: Vec3::new(1.0, 0.77, 0.34), metallic: 1.0, roughness, ..LookAt::default() };
        seen(&look, 0.9)
    };
    let [polished, rough] = [gold(0.0), gold(1.0)];
    assert!(polished.distance(Vec3::new(1.0, 0.77, 0.34)) < 0.01, "{polished}");
    assert!((rough.x - 1.0).abs() < 0.01 && rough.z < polished.z - 0.02, "{rough}");
}

#[test]
fn occlusion_takes_all_light_or_none() {
    for facing in cosines() {
        for roughness in roughnesses() {
            let look = LookAt { roughness, coat: 1.0, coat_roughness: 0.2, ..LookAt::default() };
            let [dark, half, light] = [0.0, 0.5, 1.0].map(|occlusion| seen(&LookAt { occlusion, ..look }, facing).x);
            assert!(dark < 0.01 && dark <= half && half <= light && light > 0.99, "{dark} {half} {light}");
        }
    }
}

//! What lies over or along a surface: a sheen, a coat, and long highlights.

use geometry::mesh::{CornerDetail, Look, MapUv, Material, Mesh, Slot};
use glam::{Vec3, vec3};
use inspect::render::layout::srgb;

use super::{
    PLACES, assert_near, assert_same, assert_unseen, at, balls, every_way, glossy, image, look_with, map, material,
    picture, square, studio, with_details, with_tangents,
};

/// The picture of a sheen whose maps say what its numbers say.
#[test]
fn maps_of_a_sheen_multiply_its_numbers() {
    let numbers = Look { sheen_color: [0.5, 0.25, 1.0], sheen_roughness: 0.5, roughness: 1.0, ..Look::default() };
    let texel = |color: [f32; 3], alpha: u8| {
        let [r, g, b] = color.map(srgb);
        image([1, 1], &[[r, g, b, alpha]])
    };
    let color = texel([1.0, 0.5, 0.2], 7);
    let base = Look { sheen_color: [0.5, 0.5, 1.0], sheen_roughness: 1.0, ..numbers.clone() };
    let mapped = look_with(Slot::SheenColor, map(color, MapUv::Own), base.clone());
    let of_color = material([0.1; 3], Look { sheen_roughness: 0.5, ..mapped });
    let expected = Look { sheen_color: [0.5, 0.25, 0.2], ..numbers.clone() };
    let of_roughness = look_with(Slot::SheenRoughness, map(texel([0.0; 3], 128), MapUv::Own), base);
    let tilted = vec3(0.8, 0.0, 0.6);
    for settings in every_way(studio()) {
        let seen = |own: Material| at(&picture(&square(tilted, own), &settings, 0.0), PLACES[0]);
        assert_near(seen(of_color.clone()), seen(material([0.1; 3], expected.clone())), 1, "colour");
        let plain = Look { sheen_color: [0.5, 0.5, 1.0], ..numbers.clone() };
        assert_near(seen(material([0.1; 3], of_roughness.clone())), seen(material([0.1; 3], plain)), 1, "roughness");
        assert!(seen(of_color.clone()) != seen(material([0.1; 3], Look { sheen_color: [0.0; 3], ..numbers.clone() })));
    }
}

/// The pictures of a coat and of a reflection whose maps say what their numbers say.
#[test]
fn maps_of_a_coat_and_of_a_reflection_multiply_their_numbers() {
    let base = Look { roughness: 0.9, clearcoat: 1.0, clearcoat_roughness: 1.0, ior: 2.0, ..Look::default() };
    let texel =
        |slot, texel: [u8; 4], look: &Look| look_with(slot, map(image([1, 1], &[texel]), MapUv::Own), look.clone());
    let half = 128.0 / 255.0;
    let of_coat = texel(Slot::Clearcoat, [128, 9, 9, 9], &Look { clearcoat_roughness: 0.1, ..base.clone() });
    let of_roughness = texel(Slot::ClearcoatRoughness, [9, 51, 9, 9], &base);
    let [red, green, blue] = [1.0, 0.5, 0.2].map(srgb);
    let uncoated = Look { clearcoat: 0.0, roughness: 0.2, ..base.clone() };
    let of_color = texel(Slot::SpecularColor, [red, green, blue, 7], &uncoated);
    let of_strength = texel(Slot::Specular, [9, 9, 9, 128], &uncoated);
    for (mapped, numbers) in [
        (of_coat, Look { clearcoat: half, clearcoat_roughness: 0.1, ..base.clone() }),
        (of_roughness, Look { clearcoat_roughness: 0.2, ..base.clone() }),
        (of_color, Look { specular_color: [1.0, 0.5, 0.2], ..uncoated.clone() }),
        (of_strength, Look { specular: half, ..uncoated.clone() }),
    ] {
        let tilted = vec3(0.6, 0.3, 0.7).normalize();
        let [mapped, numbers] = [mapped, numbers].map(|look| square(tilted, material([0.1, 0.2, 0.3], look)));
        assert_same(&mapped, &numbers, &format!("{:?}", mapped.materials[0].look));
    }
}

/// Only the coat reflects light here.
#[test]
fn the_normals_of_a_coat_are_its_own() {
    let texel = [190, 70, 225];
    let own = texel.map(|byte| 2.0 * f32::from(byte) / 255.0 - 1.0);
    let normals = map(image([1, 1], &[[texel[0], texel[1], texel[2], 255]]), MapUv::Own);
    for scale in [1.0, 0.5] {
        let coat = Look {
            specular: 0.0,
            clearcoat: 1.0,
            clearcoat_roughness: 0.2,
            clearcoat_normal_scale: scale,
            ..Look::default()
        };
        let detail = CornerDetail { tangent: Vec3::Y, ..CornerDetail::default() };
        let mapped = look_with(Slot::ClearcoatNormal, normals.clone(), coat.clone());
        let mapped = with_details(square(Vec3::Z, material([0.0; 3], mapped)), |_| detail);
        let normal = (scale * own[0] * Vec3::Y - scale * own[1] * Vec3::X + own[2] * Vec3::Z).normalize();
        assert_same(&mapped, &square(normal, material([0.0; 3], coat)), &format!("scale {scale}"));
    }
}

/// A square with highlights that are longer along a direction of these tangents.
fn brushed(look: Look, tangent: Vec3, bitangent_sign: f32) -> Mesh {
    let detail = CornerDetail { tangent, bitangent_sign, ..CornerDetail::default() };
    with_details(square(vec3(0.4, 0.0, 0.9).normalize(), material([0.9, 0.7, 0.4], look)), |_| detail)
}

#[test]
fn long_highlights_go_along_the_tangent_that_is_turned() {
    let long = |angle: f32, anisotropy| Look {
        metallic: 1.0,
        anisotropy,
        anisotropy_rotation: angle.to_radians(),
        ..glossy()
    };
    let along_x = brushed(long(0.0, 0.8), Vec3::X, 1.0);
    assert_same(&brushed(long(90.0, 0.8), Vec3::NEG_Y, 1.0), &along_x, "a quarter of a turn from below");
    assert_same(&brushed(long(180.0, 0.8), Vec3::X, 1.0), &along_x, "back");
    let turned = brushed(long(35.0, 0.8), Vec3::X, 1.0);
    assert_same(&brushed(long(-35.0, 0.8), Vec3::X, -1.0), &turned, "mirrored");
    // Red and green are the cosine and the sine of 35 degrees, and blue is 0.8.
    let texel = [35.0_f32.to_radians().cos(), 35.0_f32.to_radians().sin()].map(|part| (127.5 + 127.5 * part) as u8);
    let texel = map(image([1, 1], &[[texel[0], texel[1], 204, 255]]), MapUv::Own);
    assert_same(&brushed(look_with(Slot::Anisotropy, texel.clone(), long(0.0, 1.0)), Vec3::X, 1.0), &turned, "a map");
    let both = look_with(Slot::Anisotropy, texel, long(-35.0, 1.0));
    assert_same(&brushed(both, Vec3::X, 1.0), &along_x, "a map that is turned");
    let round = brushed(long(0.0, 0.0), Vec3::X, 1.0);
    assert_same(&brushed(long(20.0, 0.8), Vec3::ZERO, 1.0), &round, "no tangent");
    assert_same(&square(vec3(0.4, 0.0, 0.9).normalize(), along_x.materials[0].clone()), &round, "no details");
    let color = |mesh: &Mesh| at(&picture(mesh, &studio(), 0.0), PLACES[0]);
    let colors = [&round, &along_x, &brushed(long(90.0, 0.8), Vec3::X, 1.0)].map(color);
    assert!(colors[0] != colors[1] && colors[1] != colors[2], "{colors:?}");
}

#[test]
fn white_metal_with_long_highlights_cannot_be_told_from_an_even_light() {
    let long = |roughness| {
        let look = Look { metallic: 1.0, roughness, anisotropy: 0.8, ..Look::default() };
        material([1.0; 3], look)
    };
    assert_unseen(with_tangents(balls([0.0, 0.25, 0.5, 1.0].map(long).into(), 4)), [320, 100]);
}

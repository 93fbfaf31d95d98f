//! Maps of a material, and the colours of corners.

use std::sync::Arc;

use geometry::mesh::{Alpha, CornerDetail, HeightMap, Heights, Look, MapUv, Material, Mesh, Slot, Texture};
use geometry::progress::Progress;
use geometry::tessellate::{Displacement, Tessellation};
use glam::{Vec2, Vec3, Vec4, vec2, vec3};
use inspect::render::layout::srgb;
use inspect::settings::{NormalMaps, Settings};
use load::{Budget, HeightSource};

use super::{
    PLACES, SIDE, assert_near, assert_same, at, every_way, glossy, image, look_with, map, material, picture, square,
    studio, with_details,
};

#[test]
fn a_normal_map_tilts_normals_as_a_tilted_normal_does_and_mirrored_tangents_mirror_it() {
    let texel = [180, 90, 230];
    let own = texel.map(|byte| 2.0 * f32::from(byte) / 255.0 - 1.0);
    let normals = image([1, 1], &[[texel[0], texel[1], texel[2], 255]]);
    for (scale, tangent, sign) in
        [(1.0, Vec3::X, 1.0), (1.0, Vec3::X, -1.0), (0.5, Vec3::Y, 1.0), (1.5, Vec3::NEG_X, -1.0)]
    {
        let look = look_with(Slot::Normal, map(normals.clone(), MapUv::Own), Look { normal_scale: scale, ..glossy() });
        let detail = CornerDetail { tangent, bitangent_sign: sign, ..CornerDetail::default() };
        let mapped = with_details(square(Vec3::Z, material([0.8, 0.5, 0.2], look)), |_| detail);
        let bitangent = sign * Vec3::Z.cross(tangent);
        let normal = (scale * own[0] * tangent + scale * own[1] * bitangent + own[2] * Vec3::Z).normalize();
        let tilted = square(normal, material([0.8, 0.5, 0.2], glossy()));
        assert_same(&mapped, &tilted, &format!("scale {scale}, tangent {tangent}, sign {sign}"));
    }
}

#[test]
fn a_tangent_is_made_perpendicular_to_the_shading_normal_and_none_leaves_it() {
    let normals = image([1, 1], &[[200, 128, 220, 255]]);
    let look = look_with(Slot::Normal, map(normals, MapUv::Own), glossy());
    let own = |tangent: Vec3| {
        let detail = CornerDetail { tangent, ..CornerDetail::default() };
        with_details(square(Vec3::Z, material([0.8; 3], look.clone())), |_| detail)
    };
    assert_same(&own(vec3(0.6, 0.0, 0.8)), &own(Vec3::X), "a tangent that isn't perpendicular");
    assert_same(&own(Vec3::ZERO), &square(Vec3::Z, material([0.8; 3], glossy())), "no tangent");
}

/// Four colours.
fn quarters() -> Arc<Texture> {
    image([2, 2], &[[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255], [255, 255, 255, 255]])
}

#[test]
fn maps_are_read_at_their_own_texture_coordinates() {
    // Nothing but what it emits.
    let dark = Look { emissive: [0.5; 3], specular: 0.0, ..Look::default() };
    let of = |uv| square(Vec3::Z, material([0.0; 3], look_with(Slot::Emissive, map(quarters(), uv), dark.clone())));
    let expected = of(MapUv::Own);
    for (place, color) in [([0.2, 0.2], [188, 0, 0]), ([0.7, 0.2], [0, 188, 0]), ([0.7, 0.7], [188; 3])] {
        assert_near(at(&picture(&expected, &studio(), 0.0), place), color, 1, "half of the image's colour");
    }
    let second = with_details(of(MapUv::Set(1, [1.0, 0.0, 0.0, 0.0, 1.0, 0.0])), |uv| CornerDetail {
        uvs: [Vec2::ZERO, uv],
        ..CornerDetail::default()
    });
    assert_same(&second, &expected, "the second set");
    // The transform takes back what the file's coordinates have too much: a quarter of a turn, a scale and an offset.
    let turned = with_details(of(MapUv::Set(0, [0.0, 0.5, 0.25, -0.25, 0.0, 1.0])), |uv| CornerDetail {
        uvs: [vec2(4.0 * (1.0 - uv.y), 2.0 * (uv.x - 0.25)), Vec2::ZERO],
        ..CornerDetail::default()
    });
    assert_same(&turned, &expected, "a transform");
}

#[test]
fn metalness_roughness_and_occlusion_are_read_from_their_channels() {
    let texel = |texel: [u8; 4], slot, look| look_with(slot, map(image([1, 1], &[texel]), MapUv::Own), look);
    let full = Look { metallic: 1.0, roughness: 1.0, ..Look::default() };
    let mapped = square(Vec3::Z, material([0.7, 0.4, 0.2], texel([255, 51, 204, 255], Slot::MetallicRoughness, full)));
    let numbers = Look { metallic: 0.8, roughness: 0.2, ..Look::default() };
    assert_same(&mapped, &square(Vec3::Z, material([0.7, 0.4, 0.2], numbers)), "metalness and roughness");
    // Without reflection, occlusion only darkens: half of it, of a strength of a half.
    let matte = Look { specular: 0.0, occlusion_strength: 0.5, ..Look::default() };
    let occluded = square(Vec3::Z, material([0.8; 3], texel([51, 255, 255, 255], Slot::Occlusion, matte.clone())));
    assert_same(&occluded, &square(Vec3::Z, material([0.8 * 0.6; 3], matte)), "occlusion");
}

#[test]
fn colours_of_corners_multiply_the_base_colour() {
    let color = [0.5, 0.25, 1.0];
    let detail = CornerDetail { color: Vec4::new(color[0], color[1], color[2], 1.0), ..CornerDetail::default() };
    let colored = with_details(square(Vec3::Z, material([0.6, 0.8, 0.4], Look::default())), |_| detail);
    assert_same(&colored, &square(Vec3::Z, material([0.3, 0.2, 0.4], Look::default())), "one colour");
    let unlit = Look { unlit: true, ..Look::default() };
    let gradient = with_details(square(Vec3::Z, material([1.0; 3], unlit)), |uv| CornerDetail {
        color: Vec4::new(uv.x, uv.y, 0.0, 1.0),
        ..CornerDetail::default()
    });
    for settings in every_way(studio()) {
        let picture = picture(&gradient, &settings, 0.0);
        for place in PLACES {
            let middle = place.map(|part| ((part * SIDE as f32).floor() + 0.5) / SIDE as f32);
            let expected = [srgb(middle[0]), srgb(middle[1]), 0];
            assert_near(at(&picture, place), expected, 1, "linear between corners");
        }
    }
}

#[test]
fn a_mask_leaves_out_where_alpha_is_below_the_cutoff() {
    let alphas = image([2, 1], &[[255, 255, 255, 100], [255, 255, 255, 180]]);
    let background = [10, 20, 30];
    for (cutoff, alpha, seen) in [(0.5, 1.0, [false, true]), (0.3, 1.0, [true; 2]), (0.5, 0.6, [false; 2])] {
        let mut leaf = material([0.0, 0.5, 0.0], Look { alpha: Alpha::Mask(cutoff), unlit: true, ..Look::default() });
        leaf.base_color[3] = alpha;
        leaf.texture = Some(alphas.clone());
        leaf.sampling = map(alphas.clone(), MapUv::Own).sampling;
        let mesh = square(Vec3::Z, leaf);
        for settings in every_way(studio()) {
            let picture = picture(&mesh, &Settings { background: Some(background), ..settings }, 0.0);
            for (place, is_seen) in [[0.2, 0.45], [0.9, 0.6]].into_iter().zip(seen) {
                let expected = if is_seen { [0, 188, 0] } else { background };
                assert_near(at(&picture, place), expected, 1, &format!("cutoff {cutoff} with {settings:?}"));
            }
        }
    }
}

/// The relief of a normal map is that of the heights, if these come from the base colour's image: here a plain.
#[test]
fn a_normal_map_is_left_out_where_its_own_image_displaces_the_surface() {
    let leaning = map(image([1, 1], &[[200, 90, 220, 255]]), MapUv::Own);
    let gray = image([2, 2], &[[128, 128, 128, 255]; 4]);
    type Made<'a> = &'a dyn Fn(&Mesh) -> Heights;
    let of_colors: Made = &|mesh| {
        HeightSource::Materials
            .load(mesh, &[], &mut Vec::new(), &Budget::unlimited(), &Progress::default())
            .expect("an image")
    };
    let of_file: Made = &|mesh| Heights::everywhere(mesh, HeightMap::new([2, 2], vec![0.5; 4]));
    let square_with = |look: Look, heights: Made| {
        let own = Material { texture: Some(gray.clone()), ..material([0.8; 3], look) };
        let detail = CornerDetail { tangent: Vec3::X, ..CornerDetail::default() };
        let mut mesh = with_details(square(Vec3::Z, own), |_| detail);
        mesh.heights = Some(Arc::new(heights(&mesh)));
        mesh
    };
    let mapped = look_with(Slot::Normal, leaning, glossy());
    let tessellation = Tessellation { displacement: Displacement::On, ..studio().tessellation };
    for settings in every_way(studio().with(tessellation)) {
        let seen = |look: &Look, heights: Made, normal_maps| {
            let settings = Settings { normal_maps, ..settings };
            at(&picture(&square_with(look.clone(), heights), &settings, 0.0), PLACES[0])
        };
        let plain = seen(&glossy(), of_file, NormalMaps::On);
        for (heights, normal_maps, is_drawn) in [
            (of_colors, NormalMaps::Auto, false),
            (of_colors, NormalMaps::On, true),
            (of_file, NormalMaps::Auto, true),
            (of_file, NormalMaps::Off, false),
        ] {
            let found = seen(&mapped, heights, normal_maps);
            // The mesh without tessellation isn't displaced.
            let is_drawn = is_drawn || settings.split.is_some();
            let differs = found.iter().zip(plain).any(|(a, b)| a.abs_diff(b) > 2);
            assert_eq!(differs, is_drawn, "{found:?} and {plain:?}: {normal_maps:?} {settings:?}");
        }
    }
}

//! Materials in light from all around: each part of a material against a picture that must be the same, and pictures of all of them.

use std::sync::Arc;

use geometry::mesh::mesh_builder::{InputCorner, MeshBuilder};
use geometry::mesh::{
    Alpha, CornerDetail, HeightMap, Heights, Look, Map, MapUv, Material, Mesh, Sampling, Shape, Slot, Texture,
};
use geometry::progress::Progress;
use geometry::tessellate::{Displacement, Surface, Tessellation};
use glam::{Vec2, Vec3, Vec4, vec2, vec3};
use gpu::Timing;
use image::RgbaImage;
use inspect::engine::Engine;
use inspect::render::environment::Environment;
use inspect::render::layout::{linear, srgb};
use inspect::render::{Camera, Renderer, Target};
use inspect::settings::{Lighting, NormalMaps, NormalsAt, Overlays, Settings, ToneCurve};
use load::Budget;
use load::HeightSource;

use crate::engine;
use crate::looks::{square_of, square_picture};
use crate::pictures::differing;
use crate::stability::{scene_of, seen};

/// The sides of pictures of a square in px.
pub(super) const SIDE: u32 = 64;

/// Flat patches in studio light, whose colours aren't changed by a tone curve.
pub(super) fn studio() -> Settings {
    let tessellation = Tessellation { surface: Surface::Flat, factor: 3.0, ..Tessellation::default() };
    Settings { lighting: Lighting::Studio, tone_curve: ToneCurve::None, ..Settings::from(tessellation) }
}

/// Every way in which the surface is drawn, each with a shader of its own.
pub(super) fn every_way(settings: Settings) -> [Settings; 5] {
    let with = |overlays| Settings { overlays, ..settings };
    [
        settings,
        Settings { normals_at: NormalsAt::Pixels, ..settings },
        with(Overlays { adjacency: true, ..Overlays::default() }),
        with(Overlays { folds: true, ..Overlays::default() }),
        Settings { split: Some(1.0), ..settings },
    ]
}

/// A square from -1 to 1 in the plane z = 0, which faces +z. All its corners have one normal, and u and v run from 0 to 1, v
/// downwards.
fn square(normal: Vec3, material: Material) -> Mesh {
    square_of(material, normal, Vec2::ONE)
}

/// The mesh with details of every corner, made of its texture coordinates.
pub(super) fn with_details(mut mesh: Mesh, detail: impl Fn(Vec2) -> CornerDetail) -> Mesh {
    mesh.details = Some(Arc::new(mesh.corners.iter().map(|corner| detail(corner.uv)).collect()));
    mesh
}

/// A picture of a square from the front, or from behind: it fills the view.
fn picture(mesh: &Mesh, settings: &Settings, azimuth: f32) -> RgbaImage {
    square_picture(mesh, settings, azimuth, SIDE)
}

/// The colour at a place of a square's texture coordinates.
pub(super) fn at(picture: &RgbaImage, uv: [f32; 2]) -> [u8; 3] {
    let [x, y] = uv.map(|part| (part * SIDE as f32) as u32);
    let [r, g, b, _] = picture.get_pixel(x, y).0;
    [r, g, b]
}

/// Places that no line of an overlay comes near.
pub(super) const PLACES: [[f32; 2]; 4] = [[0.2, 0.45], [0.4, 0.12], [0.62, 0.87], [0.9, 0.6]];

pub(super) fn assert_near(found: [u8; 3], expected: [u8; 3], most: u8, what: &str) {
    let is_near = found.iter().zip(expected).all(|(a, b)| a.abs_diff(b) <= most);
    assert!(is_near, "{what}: {found:?}, not {expected:?}");
}

/// Checks that two meshes look the same from the front and from behind, however they are drawn.
fn assert_same(found: &Mesh, expected: &Mesh, what: &str) {
    for azimuth in [0.0, 180.0] {
        let expected = picture(expected, &studio(), azimuth);
        for settings in every_way(studio()) {
            let found = picture(found, &settings, azimuth);
            for place in PLACES {
                let name = format!("{what} at {place:?} from {azimuth} with {settings:?}");
                assert_near(at(&found, place), at(&expected, place), 2, &name);
            }
        }
    }
}

/// A material with this look.
pub(super) fn material(base_color: [f32; 3], look: Look) -> Material {
    let [r, g, b] = base_color;
    Material { look, double_sided: true, ..Material::plain("material", [r, g, b, 1.0]) }
}

/// An image of a few pixels.
pub(super) fn image(size: [u32; 2], pixels: &[[u8; 4]]) -> Arc<Texture> {
    Arc::new(Texture { size, rgba: pixels.concat() })
}

/// A map whose texels aren't blended.
pub(super) fn map(texture: Arc<Texture>, uv: MapUv) -> Map {
    let sampling = Sampling { magnify_linear: false, minify_linear: false, mip_linear: None, ..Sampling::default() };
    Map { texture, uv, sampling }
}

pub(super) fn look_with(slot: Slot, map: Map, look: Look) -> Look {
    let mut look = look;
    look.maps[slot as usize] = Some(map);
    look
}

const GLOSSY: f32 = 0.3;

/// Something that shows from where light comes.
fn glossy() -> Look {
    Look { roughness: GLOSSY, metallic: 0.5, ..Look::default() }
}

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

#[test]
fn what_is_emitted_is_exposed_and_what_is_unlit_is_shown_as_it_is() {
    let glowing =
        square(Vec3::Z, material([0.0; 3], Look { emissive: [0.1, 0.2, 0.05], specular: 0.0, ..Look::default() }));
    let unlit = square(Vec3::Z, material([0.1, 0.2, 0.05], Look { unlit: true, ..Look::default() }));
    for exposure in [0.0, 1.0, -2.0] {
        let settings = Settings { exposure, ..studio() };
        let expected = [0.1, 0.2, 0.05].map(|light: f32| srgb(light * exposure.exp2()));
        assert_near(at(&picture(&glowing, &settings, 0.0), PLACES[0]), expected, 1, "emitted");
        let neutral = Settings { tone_curve: ToneCurve::Neutral, ..settings };
        for settings in [settings, neutral] {
            let expected = [0.1, 0.2, 0.05].map(srgb);
            assert_near(at(&picture(&unlit, &settings, 0.0), PLACES[0]), expected, 1, "unlit");
        }
    }
}

#[test]
fn the_light_turns_with_its_rotation_alone() {
    let tilted = |turn: f32| {
        let normal = glam::Quat::from_rotation_y(turn.to_radians()) * vec3(0.3, 0.5, 0.8).normalize();
        square(normal, material([0.8; 3], Look { specular: 0.0, ..Look::default() }))
    };
    let turned = picture(&tilted(40.0), &Settings { light_rotation: 40.0, ..studio() }, 0.0);
    assert_near(at(&turned, PLACES[0]), at(&picture(&tilted(0.0), &studio(), 0.0), PLACES[0]), 1, "both are turned");
    let all_round = picture(&tilted(0.0), &Settings { light_rotation: 360.0, ..studio() }, 0.0);
    assert_near(at(&all_round, PLACES[0]), at(&picture(&tilted(0.0), &studio(), 0.0), PLACES[0]), 1, "once around");
}

/// Balls side by side, one for each of these materials, in rows of `across`. Texture coordinates are those of the shape.
pub(super) fn balls(materials: Vec<Material>, across: usize) -> Mesh {
    let ball = Shape::Icosphere.build();
    let mut builder = MeshBuilder::new();
    for (index, material) in materials.into_iter().enumerate() {
        let material = builder.material(material);
        let offset = vec3((index % across) as f32, -((index / across) as f32), 0.0) * 2.2;
        for triangle in ball.triangles.iter() {
            let corner = |corner: u32| {
                let own = &ball.corners[corner as usize];
                InputCorner { position: own.position + offset, normal: Some(own.normal), uv: own.uv }
            };
            builder.triangle(material, triangle.map(corner));
        }
    }
    builder.finish("balls".to_owned(), &Progress::default()).expect("nobody cancels")
}

pub(super) fn of_picture(tone_curve: ToneCurve) -> Settings {
    let tessellation = Tessellation { surface: Surface::PnAen, factor: 6.0, ..Tessellation::default() };
    Settings { lighting: Lighting::Studio, tone_curve, ..Settings::from(tessellation) }
}

/// White metal and white plastic, polished to rough.
pub(super) fn white_balls() -> Mesh {
    let metal = |roughness| material([1.0; 3], Look { metallic: 1.0, roughness, ..Look::default() });
    let matte = |roughness| material([1.0; 3], Look { roughness, ..Look::default() });
    let materials = [0.0, 0.25, 0.5, 0.75, 1.0].into_iter().flat_map(|roughness| [metal(roughness), matte(roughness)]);
    balls(materials.collect(), 5)
}

/// Gold and red plastic, polished to rough.
pub(super) fn metal_and_matte_balls() -> Mesh {
    let row = |metallic, color| {
        let look = move |roughness| Look { metallic, roughness, ..Look::default() };
        [0.0, 0.25, 0.5, 1.0].map(|roughness| material(color, look(roughness)))
    };
    balls([row(1.0, [1.0, 0.77, 0.34]), row(0.0, [0.8, 0.1, 0.1])].concat(), 4)
}

/// Checks that a mesh which absorbs nothing can't be told from an even light all around, in a picture of this size.
fn assert_unseen(mesh: Mesh, size: [u32; 2]) {
    let gpu = &engine().gpu;
    // Here a step of a picture's bytes is 0.9 %.
    let [light, ..] = linear([250; 3]);
    let mut engine: Engine = engine().clone();
    let environment = Environment::uniform(gpu, [light; 3]).expect("a device");
    engine.renderer = Arc::new(Renderer::lit_by(gpu, environment));
    let mut scene = scene_of(mesh, 0.0);
    let target = Target::new(gpu, size).expect("a small picture");
    let camera = Camera::framing(&scene.bounds, target.viewport());
    let settings = Settings { background: Some([srgb(light); 3]), ..of_picture(ToneCurve::None) };
    engine.draw(&mut scene, &target, &camera, &settings, &mut Timing::Off).expect("a draw");
    let picture = target.read(gpu).expect("a readback");
    let farthest = picture.pixels().flat_map(|pixel| linear([pixel.0[0], pixel.0[1], pixel.0[2]]));
    let farthest = farthest.map(|value| (value / light - 1.0).abs()).fold(0.0, f32::max);
    assert!(farthest < 0.01, "{farthest}");
}

#[test]
fn white_balls_cannot_be_told_from_an_even_light() {
    assert_unseen(white_balls(), [320, 160]);
}

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

/// In a normal map, directions may point below the surface. Their mirror images above it are seen, not what would be reflected where
/// the surface is seen from the very side, which is all of the light.
#[test]
fn a_normal_that_faces_away_is_seen_as_its_mirror_image() {
    let leaning = |blue| {
        let normals = map(image([1, 1], &[[235, 128, blue, 255]]), MapUv::Own);
        let look = Look { roughness: 0.2, ..Look::default() };
        let detail = CornerDetail { tangent: Vec3::X, ..CornerDetail::default() };
        with_details(square(Vec3::Z, material([0.2; 3], look_with(Slot::Normal, normals, look))), |_| detail)
    };
    assert_same(&leaning(75), &leaning(180), "a normal below the surface");
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

/// Bumps, as a normal map.
fn bumps() -> Arc<Texture> {
    const SIZE: u32 = 256;
    let texel = |index: u32| {
        let turns = |at: u32, bumps: f32| std::f32::consts::TAU * bumps * (at as f32 + 0.5) / SIZE as f32;
        let (x, y) = (turns(index % SIZE, 16.0), turns(index / SIZE, 8.0));
        let normal = vec3(-0.8 * x.cos() * y.sin(), 0.8 * x.sin() * y.cos(), 1.0).normalize();
        let [r, g, b] = normal.to_array().map(|part| (127.5 + 127.5 * part).round() as u8);
        [r, g, b, 255]
    };
    image([SIZE; 2], &(0..SIZE * SIZE).map(texel).collect::<Vec<_>>())
}

/// The mesh with the tangents that its texture coordinates have.
fn with_tangents(mut mesh: Mesh) -> Mesh {
    let mut details = vec![CornerDetail::default(); mesh.corners.len()];
    for triangle in mesh.triangles.iter() {
        let [a, b, c] = triangle.map(|corner| mesh.corners[corner as usize]);
        let [ab, ac] = [b.uv - a.uv, c.uv - a.uv];
        let tangent = ((b.position - a.position) * ac.y - (c.position - a.position) * ab.y) * ab.perp_dot(ac).signum();
        triangle.iter().for_each(|&corner| details[corner as usize].tangent += tangent.normalize_or_zero());
        triangle.iter().for_each(|&corner| details[corner as usize].bitangent_sign = -ab.perp_dot(ac).signum());
    }
    mesh.details = Some(Arc::new(details));
    mesh
}

#[test]
fn materials_look_as_they_did() {
    let row = |metallic, color| {
        let look = move |roughness| Look { metallic, roughness, ..Look::default() };
        [0.0, 0.25, 0.5, 0.75, 1.0].map(|roughness| material(color, look(roughness)))
    };
    let spheres =
        balls([row(1.0, [0.95, 0.93, 0.88]), row(1.0, [1.0, 0.77, 0.34]), row(0.0, [0.8, 0.1, 0.1])].concat(), 5);
    let coat = |clearcoat, clearcoat_roughness| {
        let look = Look { metallic: 0.6, roughness: 0.6, clearcoat, clearcoat_roughness, ..Look::default() };
        material([0.1, 0.2, 0.7], look)
    };
    let coats = balls(vec![coat(0.0, 0.0), coat(1.0, 0.0), coat(1.0, 0.4)], 3);
    let mut torus = Shape::Torus.build();
    for own in &mut torus.materials {
        own.base_color = [0.4, 0.4, 0.45, 1.0];
        let lamps = image([2, 2], &[[255, 120, 0, 255], [0, 0, 0, 255], [0, 0, 0, 255], [0, 0, 0, 255]]);
        let look = look_with(Slot::Emissive, map(lamps, MapUv::Own), Look { emissive: [2.0; 3], ..glossy() });
        own.look = look_with(Slot::Normal, Map { sampling: Sampling::default(), ..map(bumps(), MapUv::Own) }, look);
    }
    let velvet = |sheen_roughness| {
        let look = Look { roughness: 0.8, sheen_color: [1.0, 0.6, 0.5], sheen_roughness, ..Look::default() };
        material([0.15, 0.01, 0.02], look)
    };
    let sheens = balls([0.1, 0.3, 0.5, 1.0].map(velvet).into(), 4);
    let brushed = |anisotropy| {
        let look = Look { metallic: 1.0, roughness: 0.3, anisotropy, ..Look::default() };
        material([0.9, 0.75, 0.5], look)
    };
    let brushed = with_tangents(balls([0.0, 0.4, 0.7, 1.0].map(brushed).into(), 4));
    let maps = with_tangents(torus);
    let pictures = [("spheres", spheres), ("coats", coats), ("sheen", sheens), ("maps", maps), ("anisotropy", brushed)];
    let pictures = pictures.into_iter().map(|(name, mesh)| {
        let mut scene = scene_of(mesh, 0.0);
        let target = Target::new(&engine().gpu, [320, 200]).expect("a small picture");
        let camera = Camera { azimuth: 10.0, elevation: 15.0, ..Camera::framing(&scene.bounds, target.viewport()) };
        (format!("material-{name}"), seen(&mut scene, &target, &of_picture(ToneCurve::Neutral), &camera))
    });
    assert_eq!(differing(pictures.collect()), Vec::<String>::new());
}

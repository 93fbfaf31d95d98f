//! Materials in light from all around: each part of a material against a picture that must be the same, and pictures of all of them.

mod coats;
mod maps;

use std::sync::Arc;

use geometry::mesh::mesh_builder::{InputCorner, MeshBuilder};
use geometry::mesh::{CornerDetail, Look, Map, MapUv, Material, Mesh, Sampling, Shape, Slot, Texture};
use geometry::progress::Progress;
use geometry::tessellate::{Surface, Tessellation};
use glam::{Vec2, Vec3, vec3};
use gpu::Timing;
use image::RgbaImage;
use inspect::engine::Engine;
use inspect::render::environment::Environment;
use inspect::render::layout::{linear, srgb};
use inspect::render::{Camera, Renderer, Target};
use inspect::settings::{Lighting, NormalsAt, Overlays, Settings, ToneCurve};

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

/// An engine on the same device whose studio is an even light all around, so bright in linear numbers.
pub(super) fn evenly_lit(light: f32) -> Engine {
    let mut engine = engine().clone();
    let environment = Environment::uniform(&engine.gpu, [light; 3]).expect("a small environment");
    engine.renderer = Arc::new(Renderer::lit_by(&engine.gpu, environment));
    engine
}

/// The bytes of an even light, of which a step is 0.9 %.
pub(super) const EVEN_LIGHT: u8 = 250;

/// A picture of a mesh in an even light all around, before as much light.
pub(super) fn in_even_light(mesh: Mesh, size: [u32; 2]) -> RgbaImage {
    let [light, ..] = linear([EVEN_LIGHT; 3]);
    let engine = evenly_lit(light);
    let mut scene = scene_of(mesh, 0.0);
    let target = Target::new(&engine.gpu, size).expect("a small picture");
    let camera = Camera::framing(&scene.bounds, target.viewport());
    let settings = Settings { background: Some([srgb(light); 3]), ..of_picture(ToneCurve::None) };
    engine.draw(&mut scene, &target, &camera, &settings, &mut Timing::Off).expect("a draw");
    target.read(&engine.gpu).expect("a readback")
}

/// Checks that a mesh which absorbs nothing can't be told from an even light all around, in a picture of this size.
fn assert_unseen(mesh: Mesh, size: [u32; 2]) {
    let [light, ..] = linear([EVEN_LIGHT; 3]);
    let picture = in_even_light(mesh, size);
    let farthest = picture.pixels().flat_map(|pixel| linear([pixel.0[0], pixel.0[1], pixel.0[2]]));
    let farthest = farthest.map(|value| (value / light - 1.0).abs()).fold(0.0, f32::max);
    assert!(farthest < 0.01, "{farthest}");
}

#[test]
fn white_balls_cannot_be_told_from_an_even_light() {
    assert_unseen(white_balls(), [320, 160]);
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

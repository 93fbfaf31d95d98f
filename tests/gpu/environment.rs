//! Light from files: panoramas, also behind the mesh, and the lights of glTF files.

use std::f32::consts::PI;
use std::sync::Arc;

use documents::panoramas::{open_exr_file, radiance_file};
use geometry::mesh::{Light, LightKind, Look, Material, Mesh, Shape};
use geometry::progress::Progress;
use geometry::tessellate::{Surface, Tessellation};
use glam::{Vec2, Vec3, vec3};
use gpu::Timing;
use image::RgbaImage;
use inspect::engine::Engine;
use inspect::for_tests::punctual::direct_light;
use inspect::for_tests::tone::tone_mapped;
use inspect::render::environment::Environment;
use inspect::render::layout::{linear, srgb};
use inspect::render::punctual::PunctualLight;
use inspect::render::studio::studio_light;
use inspect::render::{Camera, Scene, Target};
use inspect::settings::{Colors, FileLights, Lighting, NormalsAt, Overlays, Settings, ToneCurve};
use load::environment_file::EnvironmentFile;
use load::files::Limits;
use load::panorama::Panorama;

use crate::engine;
use crate::looks::square_of;
use crate::materials::{evenly_lit, every_way, white_balls};
use crate::pictures::differing;
use crate::stability::{scene_of, seen};

fn lit_by_file() -> Settings {
    let tessellation = Tessellation { surface: Surface::PnAen, factor: 6.0, ..Tessellation::default() };
    let lighting = Lighting::Environment;
    Settings { lighting, tone_curve: ToneCurve::None, ..Settings::from(tessellation) }
}

/// A scene in the light of a panorama.
fn scene_in(mesh: Mesh, panorama: Panorama) -> Scene {
    let mut scene = scene_of(mesh, 0.0);
    let environment = Environment::from_panorama(&engine().gpu, panorama).expect("a small environment");
    scene.environment = Some(Arc::new(environment));
    scene
}

fn linear_of(picture: &RgbaImage, [x, y]: [u32; 2]) -> Vec3 {
    let [r, g, b, _] = picture.get_pixel(x, y).0;
    linear([r, g, b]).into()
}

/// White balls in front of the white light of a file can't be seen. Here a step of a picture's bytes is 0.9 %, and the light is
/// a number that Radiance files hold exactly.
#[test]
fn white_balls_cannot_be_seen_before_the_even_light_of_a_file() {
    let (size, light) = ([64, 32], 0.9375);
    let pixels = vec![[light; 3]; 64 * 32];
    for (name, bytes) in [("hdr", radiance_file(size, &pixels)), ("exr", open_exr_file(size, &pixels))] {
        let file = EnvironmentFile::read(&bytes, &Limits::default(), &Progress::new()).expect("a panorama");
        let mut scene = scene_in(white_balls(), file.panorama);
        let target = Target::new(&engine().gpu, [320, 160]).expect("a small picture");
        let camera = Camera::framing(&scene.bounds, target.viewport());
        let settings = Settings { environment_background: true, ..lit_by_file() };
        let picture = seen(&mut scene, &target, &settings, &camera);
        let farthest = picture.pixels().flat_map(|pixel| linear([pixel.0[0], pixel.0[1], pixel.0[2]]));
        let farthest = farthest.map(|value| (value / light - 1.0).abs()).fold(0.0, f32::max);
        assert!(farthest < 0.01, "{name}: {farthest}");
    }
}

/// A matte ball, seen from the front.
fn ball_under(panorama: Panorama, settings: &Settings) -> RgbaImage {
    let mut ball = Shape::Icosphere.build();
    for material in &mut ball.materials {
        (material.base_color, material.look) = ([1.0; 4], Look { roughness: 1.0, ..Look::default() });
    }
    let mut scene = scene_in(ball, panorama);
    let target = Target::new(&engine().gpu, [96; 2]).expect("a small picture");
    let camera = Camera { azimuth: 0.0, elevation: 0.0, ..Camera::framing(&scene.bounds, target.viewport()) };
    seen(&mut scene, &target, settings, &camera)
}

/// The middle of a panorama is at -Z, behind the ball; its right quarter at +X, and its borders at +Z, where the eye is.
#[test]
fn one_bright_pixel_lights_the_side_that_it_is_on() {
    const BESIDE: [[u32; 2]; 4] = [[66, 48], [30, 48], [48, 30], [48, 66]];
    let size = [64_u32, 32];
    for (pixel, brightest, rotation) in [
        ([48, 15], 0, 0.0),
        ([16, 15], 1, 0.0),
        ([40, 1], 2, 0.0),
        ([40, 30], 3, 0.0),
        // What was at the front comes to the right, and what was at the right to the back, whence it lights neither side more.
        ([0, 15], 0, 90.0),
    ] {
        let mut pixels = vec![[0.01; 3]; 64 * 32];
        // As much light from a pixel near a pole, which is small.
        let latitude = (0.5 - (pixel[1] as f32 + 0.5) / size[1] as f32) * PI;
        pixels[(pixel[1] * size[0] + pixel[0]) as usize] = [300.0 / latitude.cos(); 3];
        let panorama = Panorama::new(size, pixels).0;
        let picture = ball_under(panorama, &Settings { light_rotation: rotation, ..lit_by_file() });
        let lights = BESIDE.map(|place| linear_of(&picture, place).x);
        for (k, light) in lights.into_iter().enumerate().filter(|(k, _)| *k != brightest) {
            assert!(lights[brightest] > 1.3 * light + 0.02, "{pixel:?}: {lights:?}, where {k} should be darker");
        }
    }
}

/// Each EV doubles the environment, and nothing else.
#[test]
fn the_brightness_is_that_of_the_light_from_all_around_alone() {
    let seen = |environment_brightness: f32, emissive: f32| {
        let look = Look { roughness: 1.0, emissive: [emissive; 3], ..Look::default() };
        let mesh = square_of(Material { look, ..Material::plain("square", [0.5, 0.5, 0.5, 1.0]) }, Vec3::Z, Vec2::ONE);
        let mut scene = scene_in(mesh, Panorama::from_radiance([64, 32], |_| Vec3::splat(0.3)));
        let target = Target::new(&engine().gpu, [64; 2]).expect("a small picture");
        let camera = Camera { azimuth: 0.0, elevation: 0.0, ..Camera::framing(&scene.bounds, target.viewport()) };
        let picture = self::seen(&mut scene, &target, &Settings { environment_brightness, ..lit_by_file() }, &camera);
        linear_of(&picture, [32, 32]).x
    };
    let [usual, double, glowing, glowing_double] =
        [(0.0, 0.0), (1.0, 0.0), (0.0, 0.2), (1.0, 0.2)].map(|(ev, own)| seen(ev, own));
    assert!((double / usual - 2.0).abs() < 0.03, "{usual} {double}");
    assert!(
        (glowing - usual - 0.2).abs() < 0.01 && (glowing_double - double - 0.2).abs() < 0.01,
        "{glowing} {glowing_double}"
    );
}

/// The direction that a perspective view has at a place of the picture.
fn direction(camera: &Camera, viewport: Vec2, px: Vec2) -> Vec3 {
    let [right, up, back] = camera.axes();
    let at = (px - 0.5 * viewport) * camera.units_per_pixel(viewport.y);
    (right * at.x - up * at.y - back * camera.distance).normalize()
}

/// Behind the mesh is what the light is made of: in perspective and orthographic views, turned, exposed, through the tone curve,
/// under lines too; but not in transparent pictures, nor where an overlay has a light of its own.
#[test]
fn the_light_is_seen_behind_the_mesh() {
    let colors = |direction: Vec3| 0.4 + 0.3 * direction;
    let size = [160, 90];
    let viewport = Vec2::new(160.0, 90.0);
    let mut scene = scene_in(Shape::Icosphere.build(), Panorama::from_radiance([512, 256], colors));
    let base = Camera::framing(&scene.bounds, viewport);
    let usual = Settings { environment_background: true, tone_curve: ToneCurve::Neutral, ..lit_by_file() };
    for (azimuth, elevation, orthographic, settings) in [
        (30.0, 20.0, false, usual),
        (200.0, -40.0, false, Settings { light_rotation: 70.0, exposure: -1.0, ..usual }),
        (30.0, 20.0, true, usual),
        (0.0, 0.0, false, Settings { lighting: Lighting::Studio, environment_brightness: -0.5, ..usual }),
    ] {
        let camera = Camera { azimuth, elevation, orthographic, ..base };
        let target = Target::new(&engine().gpu, size).expect("a small picture");
        let picture = seen(&mut scene, &target, &settings, &camera);
        let radiance = if settings.lighting == Lighting::Studio { studio_light } else { colors };
        for px in [[2, 2], [157, 3], [24, 2], [4, 86], [150, 80]] {
            let at = Vec2::from(px.map(|side| side as f32 + 0.5));
            let turn = glam::Mat3::from_rotation_y(-settings.light_rotation.to_radians());
            let light = radiance(turn * direction(&camera, viewport, at));
            let shown =
                tone_mapped(light * (settings.exposure + settings.environment_brightness).exp2(), ToneCurve::Neutral);
            let found = linear_of(&picture, px);
            assert!(found.distance(shown) < 0.015, "{px:?} {camera:?}: {found}, not {shown}");
        }
    }
    let transparent = Target::transparent(&engine().gpu, size).expect("a small picture");
    let picture = seen(&mut scene, &transparent, &usual, &base);
    assert_eq!(picture.get_pixel(2, 2).0, [0; 4]);
    assert_eq!(picture.get_pixel(80, 45).0[3], 255);
    let clay = Settings { overlays: Overlays { colors: Colors::Clay, ..Overlays::default() }, ..usual };
    let opaque = Target::new(&engine().gpu, size).expect("a small picture");
    let [r, g, b] = clay.background_color();
    assert_eq!(seen(&mut scene, &opaque, &clay, &base).get_pixel(2, 2).0, [r, g, b, 255]);
}

/// Without a file, its light is the studio's.
#[test]
fn without_a_file_the_studio_shines() {
    let mut scene = scene_of(white_balls(), 0.0);
    let target = Target::new(&engine().gpu, [160, 80]).expect("a small picture");
    let camera = Camera::framing(&scene.bounds, target.viewport());
    let [file, studio] = [Lighting::Environment, Lighting::Studio]
        .map(|lighting| seen(&mut scene, &target, &Settings { lighting, ..lit_by_file() }, &camera));
    assert_eq!(file, studio);
}

/// A square that reflects half of the light evenly, in nothing but the light of these.
fn square_under(lights: Vec<Light>) -> Mesh {
    let look = Look { roughness: 1.0, specular: 0.0, ..Look::default() };
    let material = Material { look, ..Material::plain("matte", [0.5, 0.5, 0.5, 1.0]) };
    Mesh { lights, ..square_of(material, Vec3::Z, Vec2::ONE) }
}

/// Three lights before a square from -1 to 1 in the plane z = 0.
fn three_lights() -> Vec<Light> {
    let light =
        |kind, intensity, place: Vec3, toward: Vec3| Light { kind, intensity, place, direction: toward.normalize() };
    vec![
        light(LightKind::Directional, vec3(0.0, 0.8, 0.0), Vec3::ZERO, vec3(1.0, 0.0, -1.0)),
        light(LightKind::Point { range: Some(1.5) }, vec3(1.0, 0.2, 0.2), vec3(-0.5, 0.25, 0.5), Vec3::NEG_Z),
        light(
            LightKind::Spot { range: None, inner: 0.2, outer: 0.5 },
            vec3(0.0, 0.5, 4.0),
            vec3(0.5, -0.5, 1.0),
            vec3(0.1, 0.0, -1.0),
        ),
    ]
}

/// The engine with a studio that is dark, so that nothing but the lights of a file shines.
pub(super) fn unlit_engine() -> Engine {
    evenly_lit(0.0)
}

/// The width and height of pictures of a square, in px.
pub(super) const SIDE: u32 = 64;

/// The camera before a square from -1 to 1 that fills a picture of [`SIDE`] px.
pub(super) fn before_a_square(scene: &Scene, target: &Target, orthographic: bool) -> Camera {
    let framed = Camera::framing(&scene.bounds, target.viewport());
    let distance = framed.distance * 2.0 / (SIDE as f32 * framed.units_per_pixel(SIDE as f32));
    Camera { azimuth: 0.0, elevation: 0.0, orthographic, distance, ..framed }
}

/// Holds a picture of such a square, which reflects half of the light evenly, against the formula, to two steps of its bytes. Pixels
/// that lines cover aren't looked at.
pub(super) fn assert_lit_by(
    picture: &RgbaImage,
    lights: &[PunctualLight],
    is_under_lines: impl Fn([u32; 2]) -> bool,
    said: &str,
) {
    let mut brightest = 0;
    for [x, y] in (0..SIDE * SIDE).step_by(7).map(|index| [index % SIDE, index / SIDE]) {
        let at = |pixel: u32| (pixel as f32 + 0.5) * 2.0 / SIDE as f32 - 1.0;
        let place = vec3(at(x), -at(y), 0.0);
        let reached = lights.iter().map(|light| direct_light(light, place));
        let light: Vec3 = reached.map(|light| light.illuminance * light.to_light.z.max(0.0)).sum();
        let expected = (0.5 / PI * light).to_array().map(srgb);
        brightest = brightest.max(expected[0].max(expected[2]));
        let found = picture.get_pixel(x, y).0;
        let is_near = (0..3).all(|k| found[k].abs_diff(expected[k]) <= 2);
        assert!(is_near || is_under_lines([x, y]), "[{x}, {y}]: {found:?}, not {expected:?}, with {said}");
    }
    assert!(brightest > 100, "{brightest} with {said}");
}

/// On a matte surface, radiance is base colour / pi times illuminance times the cosine, at every pixel: in both projections, and
/// with every shader.
#[test]
fn lights_of_the_file_shine_on_a_matte_square_as_the_formula_says() {
    let engine = unlit_engine();
    let lights = three_lights();
    let packed: Vec<PunctualLight> = lights.iter().map(PunctualLight::from).collect();
    let mut scene = scene_of(square_under(lights), 0.0);
    let target = Target::new(&engine.gpu, [SIDE; 2]).expect("a small picture");
    let tessellation = Tessellation { surface: Surface::Flat, factor: 3.0, ..Tessellation::default() };
    let base = Settings { lighting: Lighting::Studio, tone_curve: ToneCurve::None, ..Settings::from(tessellation) };
    for orthographic in [false, true] {
        let camera = before_a_square(&scene, &target, orthographic);
        for settings in every_way(base) {
            engine.draw(&mut scene, &target, &camera, &settings, &mut Timing::Off).expect("a draw");
            let picture = target.read(&engine.gpu).expect("a readback");
            // Lines of the adjacency lie over the borders of the two patches.
            let is_under_lines = |[x, y]: [u32; 2]| {
                settings.overlays.adjacency && (x.abs_diff(SIDE - 1 - y) < 4 || x.min(y) < 3 || x.max(y) > 60)
            };
            assert_lit_by(&picture, &packed, is_under_lines, &format!("{settings:?}"));
        }
    }
    let off = Settings { lights: FileLights::Off, ..base };
    let camera = before_a_square(&scene, &target, false);
    engine.draw(&mut scene, &target, &camera, &off, &mut Timing::Off).expect("a draw");
    assert_eq!(target.read(&engine.gpu).expect("a readback").get_pixel(32, 32).0, [0, 0, 0, 255]);
}

/// Lights add to the light from all around, and pixels see the same as vertices on a flat square.
#[test]
fn lights_add_to_the_environment() {
    let settings = Settings { lights: FileLights::Off, ..lit_by_file() };
    let seen = |settings: Settings| {
        let mut scene = scene_in(square_under(three_lights()), Panorama::from_radiance([64, 32], |_| Vec3::splat(0.1)));
        let target = Target::new(&engine().gpu, [64; 2]).expect("a small picture");
        let camera = Camera { azimuth: 0.0, elevation: 0.0, ..Camera::framing(&scene.bounds, target.viewport()) };
        linear_of(&self::seen(&mut scene, &target, &settings, &camera), [32, 32])
    };
    let dark = Settings { environment_brightness: -10.0, lights: FileLights::On, ..settings };
    let [around, both, alone] =
        [settings, Settings { lights: FileLights::On, ..settings }, Settings { normals_at: NormalsAt::Pixels, ..dark }]
            .map(seen);
    assert!((around + alone).distance(both) < 0.01, "{around} {alone} {both}");
    assert!(alone.min_element() > 0.01, "{alone}");
}

/// A place with a sky, a sun, and a ground that is lit by it.
fn outdoors(direction: Vec3) -> Vec3 {
    let sun = direction.dot(vec3(0.6, 0.5, 0.62).normalize()).max(0.0);
    let sky = vec3(0.25, 0.45, 0.9).lerp(vec3(0.8, 0.85, 0.9), 1.0 - direction.y.max(0.0).sqrt());
    let ground = vec3(0.22, 0.17, 0.1);
    let base = ground.lerp(sky, (20.0 * direction.y + 0.5).clamp(0.0, 1.0));
    base + vec3(1.0, 0.9, 0.7) * (60.0 * sun.powf(800.0) + 0.5 * sun.powf(20.0))
}

#[test]
fn environments_look_as_they_did() {
    let target = Target::new(&engine().gpu, [320, 160]).expect("a small picture");
    let neutral = Settings { tone_curve: ToneCurve::Neutral, ..lit_by_file() };
    let mut balls = scene_in(crate::materials::metal_and_matte_balls(), Panorama::from_radiance([1024, 512], outdoors));
    let camera = Camera { azimuth: 10.0, elevation: 10.0, ..Camera::framing(&balls.bounds, target.viewport()) };
    let file = seen(&mut balls, &target, &Settings { environment_background: true, ..neutral }, &camera);
    let studio = Settings { lighting: Lighting::Studio, environment_background: true, ..neutral };
    let studio = seen(&mut balls, &target, &studio, &camera);
    let mut lit = crate::materials::metal_and_matte_balls();
    let place = |kind, intensity, x: f32| {
        let place = vec3(x, 1.5, 2.5);
        Light { kind, intensity, place, direction: (vec3(x, -1.0, 0.0) - place).normalize() }
    };
    lit.lights = vec![
        place(LightKind::Point { range: None }, vec3(8.0, 5.0, 2.0), 0.0),
        place(LightKind::Spot { range: None, inner: 0.1, outer: 0.35 }, vec3(20.0, 20.0, 60.0), 6.0),
    ];
    let mut lit = scene_of(lit, 0.0);
    let lights = Settings { lighting: Lighting::Studio, environment_brightness: -3.0, ..neutral };
    let lights = seen(&mut lit, &target, &lights, &camera);
    let pictures = [("file", file), ("studio", studio), ("lights", lights)];
    let pictures = pictures.into_iter().map(|(name, picture)| (format!("environment-{name}"), picture));
    assert_eq!(differing(pictures.collect()), Vec::<String>::new());
}

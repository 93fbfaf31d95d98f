//! Surfaces that show what is behind them: pictures against what compositing on the CPU makes of the same surfaces, and against
//! pictures that must be the same.

use std::sync::Arc;

use geometry::mesh::mesh_builder::{InputCorner, MeshBuilder};
use geometry::mesh::{Alpha, CornerDetail, Heights, Look, MapUv, Material, Mesh, Moment, Slot, Topology};
use geometry::progress::Progress;
use geometry::tessellate::{Displacement, Surface, Tessellation};
use glam::{Vec2, Vec3, Vec4, vec2, vec3};
use gpu::Timing;
use image::RgbaImage;
use inspect::engine::Engine;
use inspect::render::environment::Environment;
use inspect::render::layout::{linear, srgb};
use inspect::render::{Camera, Pixel, Renderer, Target};
use inspect::settings::{Overlays, Settings, ToneCurve};

use crate::displacement::waves;
use crate::materials::{
    PLACES, SIDE, assert_near, at, balls, every_way, image, look_with, map, material, of_picture, studio,
};
use crate::pictures::differing;
use crate::stability::{scene_of, seen};
use crate::{deforming, engine};

/// Layers are rounded to bytes one after another.
const ROUNDING: u8 = 2;

/// An unlit sheet across the whole view, at the height `z` + `slope` x.
#[derive(Clone, Copy)]
struct Sheet {
    z: f32,
    slope: f32,
    /// Linear RGB, and alpha.
    color: [f32; 4],
    alpha: Alpha,
}

fn blended(z: f32, slope: f32, color: [f32; 4]) -> Sheet {
    Sheet { z, slope, color, alpha: Alpha::Blend }
}

/// Sheets that overlap and intersect: opaque, cut out, blended, and blended without a share.
fn overlapping() -> Vec<Sheet> {
    vec![
        blended(0.2, 0.5, [0.8, 0.1, 0.1, 0.5]),
        Sheet { z: -0.8, slope: 0.0, color: [0.2, 0.5, 0.9, 1.0], alpha: Alpha::Opaque },
        blended(0.2, -0.5, [0.1, 0.7, 0.2, 0.25]),
        // Cut away wholly, in front of everything.
        Sheet { z: 0.9, slope: 0.0, color: [1.0, 1.0, 1.0, 0.4], alpha: Alpha::Mask(0.5) },
        blended(0.8, 0.0, [1.0, 0.0, 1.0, 0.0]),
        blended(0.0, 0.1, [0.9, 0.9, 0.3, 0.7]),
        // Behind the opaque sheet on the right, and in front of it on the left.
        blended(-0.8, -0.4, [0.0, 0.0, 0.0, 0.9]),
    ]
}

/// The two triangles of a sheet. The whole part of u says which sheet it is.
fn corners(index: usize, sheet: &Sheet) -> [[InputCorner; 3]; 2] {
    let normal = vec3(-sheet.slope, 0.0, 1.0).normalize();
    let corner = |x: f32, y: f32| InputCorner {
        position: vec3(x, y, sheet.z + sheet.slope * x),
        normal: Some(normal),
        uv: vec2(index as f32 + 0.25 + 0.125 * x, 0.5 - 0.5 * y),
    };
    let [a, b, c, d] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    [[a, b, c], [a, c, d]]
}

/// A mesh with a material for each sheet, whose triangles are in this order or in reverse.
fn sheets_mesh(sheets: &[Sheet], is_reversed: bool) -> Mesh {
    let mut builder = MeshBuilder::new();
    let mut triangles = Vec::new();
    let mut order: Vec<_> = sheets.iter().enumerate().collect();
    if is_reversed {
        order.reverse();
    }
    for (index, sheet) in order {
        let look = Look { alpha: sheet.alpha, unlit: true, ..Look::default() };
        let own = Material { look, ..Material::plain("sheet", sheet.color) };
        let own = builder.material(own);
        let mut both = corners(index, sheet);
        if is_reversed {
            both.reverse();
        }
        triangles.extend(both.map(|triangle| (own, triangle)));
    }
    triangles.into_iter().for_each(|(own, triangle)| builder.triangle(own, triangle));
    builder.finish("sheets".to_owned(), &Progress::default()).expect("nobody cancels")
}

/// The sheets in one material, whose corners have their colours.
fn sheets_in_one_material(sheets: &[Sheet], is_reversed: bool) -> Mesh {
    let mut builder = MeshBuilder::new();
    let look = Look { alpha: Alpha::Blend, unlit: true, ..Look::default() };
    let own = builder.material(Material { look, ..Material::plain("sheets", [1.0; 4]) });
    let mut triangles: Vec<_> = sheets.iter().enumerate().flat_map(|(index, sheet)| corners(index, sheet)).collect();
    if is_reversed {
        triangles.reverse();
    }
    triangles.into_iter().for_each(|triangle| builder.triangle(own, triangle));
    let mut mesh = builder.finish("sheets".to_owned(), &Progress::default()).expect("nobody cancels");
    let detail = |uv: Vec2| CornerDetail { color: sheets[uv.x as usize].color.into(), ..CornerDetail::default() };
    mesh.details = Some(Arc::new(mesh.corners.iter().map(|corner| detail(corner.uv)).collect()));
    mesh
}

const BACKGROUND: [u8; 3] = [40, 60, 30];

/// What is seen of sheets in the middle of a pixel (linear RGB, and how much is covered): the painter's algorithm. The last
/// `layers` blended sheets count.
fn composited(sheets: &[Sheet], x: f32, under: Vec4, layers: usize) -> Vec4 {
    let height = |sheet: &&Sheet| sheet.z + sheet.slope * x;
    let mut order: Vec<_> = sheets
        .iter()
        .filter(|sheet| !matches!(sheet.alpha, Alpha::Mask(cutoff) if sheet.color[3] < cutoff) && sheet.color[3] > 0.0)
        .collect();
    order.sort_by(|a, b| height(a).total_cmp(&height(b)));
    let last_hiding = order.iter().rposition(|sheet| sheet.alpha != Alpha::Blend);
    let mut seen = under;
    if let Some(hiding) = last_hiding {
        let [r, g, b, _] = order[hiding].color;
        seen = Vec4::new(r, g, b, 1.0);
    }
    let in_front = &order[last_hiding.map_or(0, |hiding| hiding + 1)..];
    for sheet in &in_front[in_front.len().saturating_sub(layers)..] {
        let [r, g, b, alpha] = sheet.color;
        seen = Vec4::new(r, g, b, 1.0) * alpha + seen * (1.0 - alpha);
    }
    seen
}

pub(super) fn camera_of(engine: &Engine, mesh: &Mesh, target: &Target) -> (inspect::render::Scene, Camera) {
    let topology = Topology::build_within(mesh, 0.0, &Progress::default()).expect("nobody cancels");
    let scene = engine.scene_of(Arc::new(mesh.clone()), Arc::new(topology), 8 << 20).expect("a small mesh");
    let framed = Camera::framing(&scene.bounds, target.viewport());
    let distance = framed.distance * 2.0 / (SIDE as f32 * framed.units_per_pixel(SIDE as f32));
    (scene, Camera { azimuth: 0.0, elevation: 0.0, orthographic: true, distance, ..framed })
}

pub(super) fn drawn_by(engine: &Engine, mesh: &Mesh, settings: &Settings, is_transparent: bool) -> RgbaImage {
    let make = if is_transparent { Target::transparent } else { Target::new };
    let target = make(&engine.gpu, [SIDE; 2]).expect("a small picture");
    let (mut scene, camera) = camera_of(engine, mesh, &target);
    engine.draw(&mut scene, &target, &camera, settings, &mut Timing::Off).expect("a draw");
    target.read(&engine.gpu).expect("a readback")
}

fn drawn(mesh: &Mesh, settings: &Settings) -> RgbaImage {
    drawn_by(engine(), mesh, settings, false)
}

/// An engine on the same device that draws one sample a pixel.
pub(super) fn single_sampled() -> Engine {
    let mut gpu = engine().gpu.clone();
    gpu.most_samples = 1;
    Engine::new(gpu)
}

/// The middle of a place's pixel, from -1 to 1 along x.
fn middle(place: [f32; 2]) -> f32 {
    2.0 * ((place[0] * SIDE as f32).floor() + 0.5) / SIDE as f32 - 1.0
}

fn background() -> Vec4 {
    Vec3::from(linear(BACKGROUND)).extend(1.0)
}

fn bytes_of(color: Vec4) -> [u8; 3] {
    [srgb(color.x), srgb(color.y), srgb(color.z)]
}

/// Checks a picture of sheets at all places.
fn assert_composited(picture: &RgbaImage, sheets: &[Sheet], what: &str) {
    for place in PLACES {
        let expected = composited(sheets, middle(place), background(), 8);
        assert_near(at(picture, place), bytes_of(expected), ROUNDING, &format!("{what} at {place:?}"));
    }
}

#[test]
fn sheets_are_composited_by_depth_whatever_their_order_is() {
    let (sheets, single) = (overlapping(), single_sampled());
    for settings in every_way(studio()).map(|settings| Settings { background: Some(BACKGROUND), ..settings }) {
        for engine in [engine(), &single] {
            let samples = inspect::render::samples(&engine.gpu);
            let draw = |mesh: &Mesh| drawn_by(engine, mesh, &settings, false);
            let picture = draw(&sheets_mesh(&sheets, false));
            let what = format!("{samples} samples, {settings:?}");
            assert_composited(&picture, &sheets, &what);
            assert!(draw(&sheets_mesh(&sheets, true)) == picture, "in reverse, {what}");
            assert!(draw(&sheets_mesh(&sheets, false)) == picture, "once more, {what}");
        }
    }
}

#[test]
fn sheets_of_one_material_are_composited_by_depth_too() {
    let sheets: Vec<_> = overlapping().into_iter().map(|sheet| Sheet { alpha: Alpha::Blend, ..sheet }).collect();
    let [forward, reversed] = [false, true].map(|is_reversed| sheets_in_one_material(&sheets, is_reversed));
    for settings in every_way(studio()).map(|settings| Settings { background: Some(BACKGROUND), ..settings }) {
        let picture = drawn(&forward, &settings);
        // The sheet whose alpha is 1 hides what is behind it.
        let hiding =
            |sheet: &Sheet| Sheet { alpha: if sheet.color[3] == 1.0 { Alpha::Opaque } else { Alpha::Blend }, ..*sheet };
        assert_composited(&picture, &sheets.iter().map(hiding).collect::<Vec<_>>(), &format!("{settings:?}"));
        assert!(drawn(&reversed, &settings) == picture, "in reverse, {settings:?}");
    }
}

#[test]
fn blended_places_whose_alpha_is_1_look_the_same_as_opaque_ones() {
    let opaque = sheets_mesh(&[Sheet { alpha: Alpha::Opaque, ..blended(0.0, 0.3, [0.3, 0.6, 0.2, 1.0]) }], false);
    let blended = sheets_mesh(&[blended(0.0, 0.3, [0.3, 0.6, 0.2, 1.0])], false);
    for settings in every_way(studio()) {
        assert!(drawn(&opaque, &settings) == drawn(&blended, &settings), "{settings:?}");
    }
}

#[test]
fn a_lens_shows_the_face_behind_it() {
    let face = Sheet { z: -0.5, slope: 0.0, color: [0.9, 0.6, 0.3, 1.0], alpha: Alpha::Opaque };
    let lens = blended(0.5, 0.0, [0.0, 0.0, 0.0, 0.2]);
    let picture = drawn(&sheets_mesh(&[face, lens], false), &studio());
    let expected = [0.9, 0.6, 0.3].map(|channel: f32| srgb(0.8 * channel));
    assert_near(at(&picture, PLACES[0]), expected, 1, "four fifths of the face");
}

#[test]
fn eight_layers_are_composited_and_those_behind_them_are_left_out() {
    let color = |index: usize| [index as f32 / 12.0, 1.0 - index as f32 / 12.0, 0.5, 0.3];
    let mut sheets: Vec<_> = (0..12).map(|index| blended(-0.6 + 0.1 * index as f32, 0.0, color(index))).collect();
    sheets.push(Sheet { z: -0.9, slope: 0.0, color: [1.0; 4], alpha: Alpha::Opaque });
    let settings = Settings { background: Some(BACKGROUND), ..studio() };
    let picture = drawn(&sheets_mesh(&sheets, false), &settings);
    assert_composited(&picture, &sheets, "the nearest of twelve layers");
    let all = composited(&sheets, 0.0, background(), 12);
    assert!(at(&picture, PLACES[0]).iter().zip(bytes_of(all)).any(|(a, b)| a.abs_diff(b) > ROUNDING));
}

#[test]
fn a_transparent_picture_is_covered_by_as_much_as_its_layers_cover() {
    let sheets = [blended(0.4, 0.0, [0.8, 0.2, 0.1, 0.5]), blended(-0.4, 0.0, [0.1, 0.3, 0.9, 0.25])];
    let picture = drawn_by(engine(), &sheets_mesh(&sheets, false), &studio(), true);
    let expected = composited(&sheets, 0.0, Vec4::ZERO, 8);
    let straight = (expected.truncate() / expected.w).extend(expected.w);
    assert_near(at(&picture, PLACES[0]), bytes_of(straight), ROUNDING, "straight colour");
    let alpha = picture.get_pixel(SIDE / 3, SIDE / 2).0[3];
    assert!(alpha.abs_diff((255.0 * 0.625_f32).round() as u8) <= 1, "{alpha}");
    // Half of the light goes through, on average of three channels, and nothing else is seen.
    let filter = glass([1.0, 0.5, 0.0], 1.0);
    let filtered = drawn_by(engine(), &sheets_of([(0.0, filter)]), &studio(), true);
    assert!(filtered.get_pixel(SIDE / 3, SIDE / 2).0[3].abs_diff(128) <= 1, "{:?}", filtered.get_pixel(20, 30));
}

/// A smooth material that lets a part of the light through and mirrors none.
fn glass([r, g, b]: [f32; 3], transmission: f32) -> Material {
    let look = Look { transmission, specular: 0.0, roughness: 0.0, ..Look::default() };
    Material { look, double_sided: true, ..Material::plain("glass", [r, g, b, 1.0]) }
}

fn painted(color: [f32; 3]) -> Material {
    material(color, Look { unlit: true, ..Look::default() })
}

/// Level sheets at these heights.
fn sheets_of<const N: usize>(sheets: [(f32, Material); N]) -> Mesh {
    let mut builder = MeshBuilder::new();
    for (index, (z, own)) in sheets.into_iter().enumerate() {
        let own = builder.material(own);
        let sheet = Sheet { z, slope: 0.0, color: [0.0; 4], alpha: Alpha::Opaque };
        corners(index, &sheet).into_iter().for_each(|triangle| builder.triangle(own, triangle));
    }
    builder.finish("sheets".to_owned(), &Progress::default()).expect("nobody cancels")
}

#[test]
fn light_goes_through_a_thin_surface_in_its_base_colour() {
    let (wall, tint) = ([0.9, 0.5, 0.7], [0.8, 0.4, 0.1]);
    for settings in every_way(studio()) {
        let color = |mesh: &Mesh| at(&drawn(mesh, &settings), PLACES[0]);
        let matte = color(&sheets_of([(0.0, glass(tint, 0.0))]));
        for transmission in [0.25, 0.6, 1.0] {
            let found = color(&sheets_of([(0.4, glass(tint, transmission)), (-0.4, painted(wall))]));
            let expected: [u8; 3] = std::array::from_fn(|k| {
                srgb((1.0 - transmission) * linear(matte)[k] + transmission * tint[k] * wall[k])
            });
            assert_near(found, expected, ROUNDING, &format!("{transmission} with {settings:?}"));
        }
        // Two panes tint twice.
        let panes = color(&sheets_of([(0.4, glass(tint, 1.0)), (0.0, glass(tint, 1.0)), (-0.4, painted(wall))]));
        let expected: [u8; 3] = std::array::from_fn(|k| srgb(tint[k] * tint[k] * wall[k]));
        assert_near(panes, expected, ROUNDING, "two panes");
    }
}

/// The nearer wall of a ball, and the farther one, which is seen from behind.
#[test]
fn a_single_sided_ball_has_one_wall_and_a_double_sided_one_has_two() {
    let sheer = Look { alpha: Alpha::Blend, unlit: true, ..Look::default() };
    for settings in every_way(studio()) {
        for double_sided in [false, true] {
            // Each wall lets half of the light through.
            let walls = [
                Material { look: sheer.clone(), ..Material::plain("sheer", [1.0, 1.0, 1.0, 0.5]) },
                glass([0.5; 3], 1.0),
            ];
            for own in walls {
                let mesh = balls(vec![Material { double_sided, ..own }], 1);
                let picture = drawn_by(engine(), &mesh, &settings, true);
                let middle = SIDE / 2 - 4..SIDE / 2 + 4;
                // Lines cover more.
                let alpha = middle.clone().flat_map(|y| middle.clone().map(move |x| (x, y)));
                let alpha = alpha.map(|(x, y)| picture.get_pixel(x, y).0[3]).min().expect("64 pixels");
                // The overlay of folds shows faces from behind.
                let expected = if double_sided || settings.overlays.folds { 191 } else { 128 };
                assert!(alpha.abs_diff(expected) <= ROUNDING, "{alpha}, not {expected}: {double_sided} {settings:?}");
            }
        }
    }
}

/// A body of this thickness and smoothness, which leaves a half, a quarter and all of light after half a unit.
fn body(thickness: f32, roughness: f32) -> Material {
    let mut own = glass([0.9, 0.8, 1.0], 1.0);
    (own.look.thickness, own.look.roughness) = (thickness, roughness);
    (own.look.attenuation_distance, own.look.attenuation_color) = (0.5, [0.5, 0.25, 1.0]);
    own
}

#[test]
fn a_body_absorbs_as_much_as_its_thickness_says() {
    let wall = [0.9, 0.8, 0.7];
    let color = |own: &Material, settings: &Settings| {
        at(&drawn(&sheets_of([(0.4, own.clone()), (-0.4, painted(wall))]), settings), PLACES[0])
    };
    let mapped = |green| {
        let texel = map(image([1, 1], &[[0, green, 0, 255]]), MapUv::Own);
        let own = body(1.0, 0.0);
        Material { look: look_with(Slot::Thickness, texel, own.look), ..own }
    };
    for settings in every_way(studio()) {
        let cases = [(body(0.25, 0.0), 0.25), (body(1.0, 0.0), 1.0), (mapped(51), 0.2), (mapped(0), 0.0)];
        for (own, thickness) in cases {
            let left = [0.5_f32, 0.25, 1.0].map(|left| left.powf(thickness / 0.5));
            let tint = [0.9, 0.8, 1.0];
            let expected = std::array::from_fn(|k| srgb(left[k] * tint[k] * wall[k]));
            assert_near(color(&own, &settings), expected, ROUNDING, &format!("{thickness} with {settings:?}"));
        }
        // Without thickness it is a thin pane, whatever its inside is.
        let panes =
            [body(0.0, 0.0), Material { look: Look { roughness: 0.0, ..glass([1.0; 3], 1.0).look }, ..body(0.0, 0.0) }];
        assert_eq!(color(&panes[0], &settings), color(&panes[1], &settings), "{settings:?}");
    }
}

/// What is seen at these places of two walls, red on the left and green on the right, through a sheet before them with this
/// slope.
fn before_two_walls(own: Material, slope: f32, places: &[[f32; 2]]) -> Vec<[u8; 3]> {
    let mut builder = MeshBuilder::new();
    let walls = [(-0.2, painted([1.0, 0.0, 0.0])), (0.2, painted([0.0, 1.0, 0.0]))];
    for (index, (slope, own)) in [(slope, own)].into_iter().chain(walls).enumerate() {
        let own = builder.material(own);
        let z = if index == 0 { 0.4 } else { -0.8 };
        let sheet = Sheet { z, slope, color: [0.0; 4], alpha: Alpha::Opaque };
        corners(index, &sheet).into_iter().for_each(|triangle| builder.triangle(own, triangle));
    }
    let mesh = builder.finish("walls".to_owned(), &Progress::default()).expect("nobody cancels");
    let picture = drawn(&mesh, &studio());
    places.iter().map(|place| at(&picture, *place)).collect()
}

/// Snell's law: through a surface that leans by half, light along -z goes on along (-0.160, 0, -0.987) where the index is 1.5.
#[test]
fn a_body_bends_light_to_where_it_leaves_it() {
    let clear = |thickness, ior| {
        let mut own = body(thickness, 0.0);
        own.base_color = [1.0; 4];
        (own.look.ior, own.look.attenuation_distance) = (ior, f32::INFINITY);
        own
    };
    let (red, green) = ([255, 0, 0], [0, 255, 0]);
    // In the middle of the picture is x = 0, and at its right border 1: 0.32 to the left lies what is seen.
    let places = [[0.4, 0.45], [0.58, 0.45], [0.64, 0.45], [0.7, 0.45]];
    assert_eq!(before_two_walls(clear(2.0, 1.5), -0.5, &places), [red, red, red, green]);
    assert_eq!(before_two_walls(clear(2.0, 1.5), 0.0, &places), [red, green, green, green], "along the normal");
    assert_eq!(before_two_walls(clear(2.0, 1.0), -0.5, &places), [red, green, green, green], "an index of 1");
    assert_eq!(before_two_walls(clear(0.0, 1.5), -0.5, &places), [red, green, green, green], "no thickness");
    // Roughness blurs the border between the walls, unless nothing is refracted.
    let rough = |ior| Material { look: Look { roughness: 0.7, ..clear(2.0, ior).look }, ..clear(2.0, ior) };
    let [r, g, _] = linear(before_two_walls(rough(1.5), 0.0, &[[0.46, 0.45]])[0]);
    assert!(r > 0.2 && g > 0.2, "{r} {g}");
    assert_eq!(before_two_walls(rough(1.0), 0.0, &[[0.46, 0.45]]), [red]);
}

/// A thin surface blurs as a body does, of any thickness along the normal. What is opaque is seen through it, and no layers.
#[test]
fn a_rough_thin_surface_blurs_what_is_behind_it() {
    let pane = |thickness, roughness, ior| {
        let own = glass([1.0; 3], 1.0);
        Material { look: Look { thickness, roughness, ior, ..own.look }, ..own }
    };
    let places = [[0.46, 0.45], [0.3, 0.45], [0.7, 0.45]];
    let [thin, body] = [0.0, 1e-4].map(|thickness| before_two_walls(pane(thickness, 0.7, 1.5), 0.0, &places));
    (0..places.len()).for_each(|place| assert_near(thin[place], body[place], 1, "a body without a way through it"));
    let [r, g, _] = linear(thin[0]);
    assert!(r > 0.2 && g > 0.2, "{r} {g}");
    for sharp in [pane(0.0, 0.0, 1.5), pane(0.0, 0.7, 1.0)] {
        assert_eq!(before_two_walls(sharp, 0.0, &places), [[255, 0, 0], [255, 0, 0], [0, 255, 0]]);
    }
    let wall = [0.9, 0.5, 0.7];
    // Lines on the wall would be blurred, too.
    for settings in every_way(studio()).into_iter().filter(|settings| !settings.overlays.adjacency) {
        for roughness in [0.05, 0.5, 1.0] {
            let color = |mesh: &Mesh| at(&drawn(mesh, &settings), PLACES[0]);
            let tinted = Material { base_color: [0.8, 0.4, 0.1, 1.0], ..pane(0.0, roughness, 1.5) };
            let both = [(0.4, tinted.clone()), (0.0, tinted), (-0.4, painted(wall))];
            let expected = std::array::from_fn(|k| srgb([0.8, 0.4, 0.1][k] * wall[k]));
            assert_near(color(&sheets_of(both)), expected, ROUNDING, &format!("{roughness} with {settings:?}"));
        }
    }
}

/// Its thickness stands for the wall behind: only the nearer one is drawn, and nothing is behind it in a transparent picture.
#[test]
fn a_body_has_one_wall() {
    let mut own = body(0.1, 0.0);
    own.base_color = [0.5, 0.5, 0.5, 1.0];
    own.look.attenuation_color = [1.0; 3];
    let picture = drawn_by(engine(), &balls(vec![own], 1), &studio(), true);
    let alpha = picture.get_pixel(SIDE / 2, SIDE / 2).0[3];
    assert!(alpha.abs_diff(128) <= ROUNDING, "{alpha}");
}

#[test]
fn a_map_says_where_light_goes_through_and_metal_lets_none_through() {
    let halves = map(image([2, 1], &[[255, 0, 0, 255], [0, 255, 255, 255]]), MapUv::Own);
    let mut half = glass([1.0; 3], 1.0);
    half.look = look_with(Slot::Transmission, halves, half.look);
    let wall = [0.9, 0.2, 0.1];
    // Texture coordinates of a sheet run over an eighth on both sides of a quarter: the map's left half is seen.
    let behind = drawn(&sheets_of([(0.4, half), (-0.4, painted(wall))]), &studio());
    assert_near(at(&behind, PLACES[0]), wall.map(srgb), ROUNDING, "the map lets all light through");
    let mut metal = glass([0.6, 0.5, 0.4], 1.0);
    metal.look.metallic = 1.0;
    let alone = drawn(&sheets_of([(0.0, metal.clone())]), &studio());
    let before_wall = drawn(&sheets_of([(0.0, metal), (-0.4, painted(wall))]), &studio());
    assert_near(at(&before_wall, PLACES[0]), at(&alone, PLACES[0]), 1, "metal hides the wall");
}

#[test]
fn white_glass_cannot_be_told_from_an_even_light() {
    let gpu = &engine().gpu;
    let [light, ..] = linear([250; 3]);
    let mut engine: Engine = engine().clone();
    let environment = Environment::uniform(gpu, [light; 3]).expect("a device");
    engine.renderer = Arc::new(Renderer::lit_by(gpu, environment));
    let pane = |roughness, transmission, clearcoat| {
        let look = Look { roughness, transmission, clearcoat, ..Look::default() };
        material([1.0; 3], look)
    };
    let panes = [pane(0.0, 1.0, 0.0), pane(0.5, 1.0, 0.0), pane(0.0, 0.5, 0.0), pane(0.2, 1.0, 1.0)];
    let mut scene = scene_of(balls(panes.into(), 2), 0.0);
    let target = Target::new(gpu, [160, 160]).expect("a small picture");
    let camera = Camera::framing(&scene.bounds, target.viewport());
    let settings = Settings { background: Some([srgb(light); 3]), ..of_picture(ToneCurve::None) };
    engine.draw(&mut scene, &target, &camera, &settings, &mut Timing::Off).expect("a draw");
    let picture = target.read(gpu).expect("a readback");
    let farthest = picture.pixels().flat_map(|pixel| [pixel.0[0], pixel.0[1], pixel.0[2]]);
    let farthest = farthest.map(|byte| byte.abs_diff(250)).max();
    assert!(farthest <= Some(3), "{farthest:?} steps");
}

/// A ball of glass, or of what blends, around a smaller opaque one.
fn ball_in_ball(outer: Material) -> Mesh {
    let inner = Material { double_sided: false, ..painted([0.9, 0.1, 0.1]) };
    let mut mesh = balls(vec![inner, outer], 1);
    // `balls` puts the second below the first.
    let first = mesh.corners.len() / 2;
    for (index, corner) in mesh.corners.iter_mut().enumerate() {
        let offset = if index < first { Vec3::ZERO } else { vec3(0.0, -2.2, 0.0) };
        corner.position = (corner.position - offset) * if index < first { 0.5 } else { 1.0 };
    }
    mesh
}

fn blended_ball() -> Material {
    let look = Look { alpha: Alpha::Blend, roughness: 0.2, ..Look::default() };
    Material { look, ..Material::plain("ball", [0.2, 0.4, 0.9, 0.3]) }
}

fn ball_picture(scene: &mut inspect::render::Scene, settings: &Settings) -> RgbaImage {
    let target = Target::new(&engine().gpu, [160, 120]).expect("a small picture");
    let camera = Camera { azimuth: 20.0, elevation: 15.0, ..Camera::framing(&scene.bounds, target.viewport()) };
    seen(scene, &target, settings, &camera)
}

#[test]
fn backs_are_seen_through_fronts() {
    for outer in [blended_ball(), Material { double_sided: false, ..glass([0.7, 0.8, 0.9], 1.0) }] {
        let mut scene = scene_of(ball_in_ball(outer), 0.0);
        let settings = of_picture(ToneCurve::Neutral);
        let culled = settings.with(Tessellation { cull_back_faces: true, ..settings.tessellation });
        assert!(ball_picture(&mut scene, &culled) == ball_picture(&mut scene, &settings));
    }
}

#[test]
fn layers_of_many_chunks_and_of_both_halves_give_the_same_picture() {
    let mesh = ball_in_ball(blended_ball());
    let settings = of_picture(ToneCurve::Neutral);
    let settings = settings.with(Tessellation { factor: 40.0, ..settings.tessellation });
    let topology = Arc::new(Topology::new(&mesh));
    let mesh = Arc::new(mesh);
    let [whole, pieces] = [256 << 20, 1 << 20].map(|arena| {
        let mut scene = engine().scene_of(mesh.clone(), topology.clone(), arena).expect("a small mesh");
        let drawn = ball_picture(&mut scene, &settings);
        (scene.tessellator.chunk_count(), drawn)
    });
    assert!(whole.0 == 1 && pieces.0 > 2, "{} chunks and {}", whole.0, pieces.0);
    assert!(whole.1 == pieces.1);
    // The same surface in both halves.
    let mut scene = engine().scene_of(mesh, topology, 256 << 20).expect("a small mesh");
    let split = Settings { split: Some(0.5), left: settings.tessellation, ..settings };
    let left = scene.sibling(1 << 20)().expect("a small mesh");
    scene.set_left(Some(left)).expect("no rig");
    assert!(ball_picture(&mut scene, &split) == whole.1);
}

/// An engine on the same device whose passes over layers go over whole pictures.
fn peeling_everywhere() -> Engine {
    let mut renderer = Renderer::new(&engine().gpu);
    renderer.peels_everywhere = true;
    let mut engine = engine().clone();
    engine.renderer = Arc::new(renderer);
    engine
}

/// Cameras that see all of a scene, a part of it, nothing, and its middle from within.
fn cameras(scene: &inspect::render::Scene, target: &Target) -> [Camera; 6] {
    let framed = Camera { azimuth: 20.0, elevation: 15.0, ..Camera::framing(&scene.bounds, target.viewport()) };
    let beside = |by: f32| framed.target + framed.axes()[0] * (by * scene.bounds.radius());
    [
        framed,
        Camera { distance: 0.4 * framed.distance, target: beside(1.2), ..framed },
        Camera { target: beside(9.0), ..framed },
        Camera { target: framed.target + framed.axes()[2] * (9.0 * scene.bounds.radius()), ..framed },
        Camera { distance: 0.05 * framed.distance, ..framed },
        Camera { orthographic: true, target: beside(-1.0), ..framed },
    ]
}

/// Checks that pictures are the same whether or not passes go over all of them.
fn assert_same_everywhere(scene: &mut inspect::render::Scene, everywhere: &Engine, settings: &Settings, what: &str) {
    let target = Target::new(&engine().gpu, [120, 90]).expect("a small picture");
    for camera in cameras(scene, &target) {
        let [part, whole] = [engine(), everywhere].map(|engine| {
            engine.draw(scene, &target, &camera, settings, &mut Timing::Off).expect("a draw");
            target.read(&engine.gpu).expect("a readback")
        });
        assert!(part == whole, "{what}, {settings:?}, {camera:?}");
    }
}

#[test]
fn passes_over_a_part_of_a_picture_find_all_layers() {
    let everywhere = peeling_everywhere();
    let settings = of_picture(ToneCurve::Neutral);
    let mut mesh = ball_in_ball(blended_ball());
    mesh.heights = Some(Arc::new(Heights::everywhere(&mesh, waves(16))));
    let mut scene = scene_of(mesh, 0.0);
    for surface in Surface::ALL {
        for displacement in [Displacement::Off, Displacement::On] {
            let own = Tessellation { surface, displacement, factor: 3.0, height_scale: 0.4, ..settings.tessellation };
            assert_same_everywhere(&mut scene, &everywhere, &settings.with(own), "ball");
        }
    }
    let flat = Settings { split: Some(0.4), ..settings };
    let wires = Overlays { wireframe: true, ..Overlays::default() };
    for split in [flat, Settings { overlays: wires, ..flat }] {
        assert_same_everywhere(&mut scene, &everywhere, &split, "beside the mesh without tessellation");
    }
}

#[test]
fn passes_over_a_part_of_a_picture_find_the_layers_of_every_pose() {
    let everywhere = peeling_everywhere();
    let (loaded, _) = deforming::scene();
    let mut mesh = Mesh::clone(&loaded.mesh);
    mesh.materials.iter_mut().for_each(|own| own.look.alpha = Alpha::Blend);
    mesh.materials.iter_mut().for_each(|own| own.base_color[3] = 0.5);
    let clips: Vec<_> = mesh.rig.as_ref().expect("a rig").clips.iter().map(|clip| clip.duration).collect();
    let mut scene = engine().scene_of(Arc::new(mesh), loaded.topology.clone(), 8 << 20).expect("a small mesh");
    for (clip, duration) in clips.into_iter().enumerate() {
        for part in [0.0, 0.3, 0.9] {
            let moment = Moment { clip, time: duration * part };
            scene.set_moment(Some(moment)).expect("a small rig");
            let settings = of_picture(ToneCurve::Neutral);
            let settings = settings.with(Tessellation { factor: 3.0, ..settings.tessellation });
            assert_same_everywhere(&mut scene, &everywhere, &settings, &format!("{moment:?}"));
        }
    }
}

/// By how much the ground changes the green light of each pixel in the middle of a picture of a blended ball with this alpha.
fn ground_in_front_of_ball(alpha: f32, elevation: f32) -> Vec<f32> {
    let mut ball = blended_ball();
    ball.base_color[3] = alpha;
    let mut scene = scene_of(balls(vec![ball], 1), 0.0);
    let target = Target::new(&engine().gpu, [160, 120]).expect("a small picture");
    let camera = Camera { azimuth: 20.0, elevation, ..Camera::framing(&scene.bounds, target.viewport()) };
    let settings = Settings { background: Some(BACKGROUND), ..of_picture(ToneCurve::Neutral) };
    let overlays = Overlays { grid: true, ..Overlays::default() };
    let [without, with] =
        [settings, Settings { overlays, ..settings }].map(|settings| seen(&mut scene, &target, &settings, &camera));
    let green = |picture: &RgbaImage, index: u32| {
        let [r, g, b, _] = picture.get_pixel(60 + index % 40, 40 + index / 40).0;
        linear([r, g, b])[1]
    };
    (0..40 * 40).map(|index| green(&with, index) - green(&without, index)).collect()
}

#[test]
fn the_ground_is_seen_through_what_is_in_front_of_it() {
    // Where alpha is 0 there is no ball.
    let [alone, through] = [0.0, 0.5].map(|alpha| ground_in_front_of_ball(alpha, 40.0));
    let most = alone.iter().copied().fold(0.0, f32::max);
    assert!(most > 0.12, "the ground has lines here: {most}");
    // A half of it comes through the wall that faces the eye.
    for (alone, through) in alone.iter().zip(&through) {
        assert!((through - 0.5 * alone).abs() < 0.015, "{through}, not a half of {alone}");
    }
    // From below, nothing is in front of it.
    let below = ground_in_front_of_ball(0.9, -40.0).into_iter().map(f32::abs).fold(0.0, f32::max);
    assert!(below > 0.1, "{below}");
}

#[test]
fn wires_on_a_layer_are_opaque() {
    let mesh = sheets_of([(0.4, glass([1.0; 3], 1.0)), (-0.4, painted([0.9; 3]))]);
    let borders = Settings { overlays: Overlays { adjacency: true, ..Overlays::default() }, ..studio() };
    let picture = drawn(&mesh, &borders);
    // The boundary of the sheets, in the middle of the left border of the picture.
    let [r, g, b, _] = picture.get_pixel(0, SIDE / 2).0;
    assert_near([r, g, b], [86, 180, 233], 3, "a boundary edge");
}

#[test]
fn a_blended_surface_is_picked_in_front() {
    let sheets =
        [Sheet { z: -0.5, slope: 0.0, color: [1.0; 4], alpha: Alpha::Opaque }, blended(0.5, 0.0, [1.0, 1.0, 1.0, 0.1])];
    let mesh = sheets_mesh(&sheets, false);
    let target = Target::new(&engine().gpu, [SIDE; 2]).expect("a small picture");
    let (mut scene, camera) = camera_of(engine(), &mesh, &target);
    engine().draw(&mut scene, &target, &camera, &studio(), &mut Timing::Off).expect("a draw");
    let clip_from_object = camera.clip_from_object(target.viewport(), &scene.bounds);
    let pixel = Pixel { clip_from_object, size: [SIDE; 2], at: [SIDE / 3, SIDE / 2], has_input: false };
    let picking = engine().picker.start(&engine().gpu, &mut scene, &pixel);
    let picked = picking.and_then(|mut picking| picking.wait(&engine().gpu)).expect("a readback").expect("a surface");
    let [x, y, z] = picked.triangle.expect("an emitted triangle").vertices[0].position;
    assert_eq!(z, 0.5, "at {x} {y}");
}

#[test]
fn layers_look_as_they_did() {
    let gold = material([1.0, 0.77, 0.34], Look { metallic: 1.0, roughness: 0.3, ..Look::default() });
    let glass = |color, roughness| material(color, Look { transmission: 1.0, roughness, ..Look::default() });
    let mut faint = blended_ball();
    faint.base_color = [0.1, 0.6, 0.2, 0.35];
    let mut mesh =
        balls(vec![gold, glass([0.95, 0.98, 1.0], 0.0), glass([0.9, 0.25, 0.2], 0.1), faint, painted([0.2; 3])], 5);
    // Closer together, so that they intersect, and each a little farther away than the one before.
    mesh.corners.iter_mut().for_each(|corner| {
        let ball = (corner.position.x / 2.2).round();
        corner.position += vec3(-1.1 * ball, 0.0, -0.7 * ball);
    });
    let mut scene = scene_of(mesh, 0.0);
    let target = Target::new(&engine().gpu, [320, 200]).expect("a small picture");
    let camera = Camera { azimuth: 10.0, elevation: 15.0, ..Camera::framing(&scene.bounds, target.viewport()) };
    let plain = seen(&mut scene, &target, &of_picture(ToneCurve::Neutral), &camera);
    let overlays = Overlays { patches: true, grid: true, ..Overlays::default() };
    let lines = Settings { overlays, ..of_picture(ToneCurve::Neutral) };
    let lines = seen(&mut scene, &target, &lines, &camera);
    let pictures = vec![("material-layers".to_owned(), plain), ("material-layers-lines".to_owned(), lines)];
    assert_eq!(differing(pictures), Vec::<String>::new());
}

#[test]
fn bodies_look_as_they_did() {
    let ball = |thickness, roughness| {
        let mut own = body(thickness, roughness);
        (own.look.specular, own.look.attenuation_color) = (1.0, [0.3, 0.8, 0.5]);
        own
    };
    let wall = |color| material(color, Look::default());
    let bodies = vec![ball(0.0, 0.0), ball(0.5, 0.0), ball(1.5, 0.0), ball(1.5, 0.4)];
    let behind = [[0.8, 0.2, 0.1], [0.9; 3], [0.1, 0.2, 0.7], [0.9, 0.7, 0.1]].map(wall);
    let mut mesh = balls([bodies, behind.to_vec()].concat(), 4);
    // The second row lies behind the first, a little to the side.
    for corner in mesh.corners.iter_mut().filter(|corner| corner.position.y < -1.1) {
        corner.position += vec3(0.9, 2.2, -3.0);
    }
    let mut scene = scene_of(mesh, 0.0);
    let target = Target::new(&engine().gpu, [320, 140]).expect("a small picture");
    let camera = Camera { azimuth: 0.0, elevation: 5.0, ..Camera::framing(&scene.bounds, target.viewport()) };
    let picture = seen(&mut scene, &target, &of_picture(ToneCurve::Neutral), &camera);
    assert_eq!(differing(vec![("material-bodies".to_owned(), picture)]), Vec::<String>::new());
}

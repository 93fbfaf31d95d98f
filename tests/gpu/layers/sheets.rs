//! Level and inclined sheets, against what compositing on the CPU makes of them.

use std::sync::Arc;

use geometry::mesh::mesh_builder::MeshBuilder;
use geometry::mesh::{Alpha, CornerDetail, Look, Material, Mesh};
use geometry::progress::Progress;
use glam::{Vec2, Vec3, Vec4};
use gpu::Timing;
use image::RgbaImage;
use inspect::render::layout::{linear, srgb};
use inspect::render::{Pixel, Target};
use inspect::settings::Settings;

use super::{
    BACKGROUND, ROUNDING, Sheet, blended, camera_of, corners, drawn, drawn_by, glass, sheets_of, single_sampled,
};
use crate::engine;
use crate::materials::{PLACES, SIDE, assert_near, at, every_way, studio};

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

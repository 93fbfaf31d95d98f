//! Light that goes through: thin surfaces, and bodies, which absorb and bend it.

use geometry::mesh::mesh_builder::MeshBuilder;
use geometry::mesh::{Alpha, Look, MapUv, Material, Mesh, Slot};
use geometry::progress::Progress;
use glam::vec3;
use inspect::render::layout::{linear, srgb};
use inspect::render::{Camera, Target};
use inspect::settings::{Settings, ToneCurve};

use super::{ROUNDING, Sheet, corners, drawn, drawn_by, glass, painted, sheets_of};
use crate::engine;
use crate::materials::{
    EVEN_LIGHT, PLACES, SIDE, assert_near, at, balls, every_way, image, in_even_light, look_with, map, material,
    of_picture, studio,
};
use crate::pictures::differing;
use crate::stability::{scene_of, seen};

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
    let pane = |roughness, transmission, clearcoat| {
        let look = Look { roughness, transmission, clearcoat, ..Look::default() };
        material([1.0; 3], look)
    };
    let panes = [pane(0.0, 1.0, 0.0), pane(0.5, 1.0, 0.0), pane(0.0, 0.5, 0.0), pane(0.2, 1.0, 1.0)];
    let picture = in_even_light(balls(panes.into(), 2), [160, 160]);
    let farthest = picture.pixels().flat_map(|pixel| [pixel.0[0], pixel.0[1], pixel.0[2]]);
    let farthest = farthest.map(|byte| byte.abs_diff(EVEN_LIGHT)).max();
    assert!(farthest <= Some(3), "{farthest:?} steps");
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

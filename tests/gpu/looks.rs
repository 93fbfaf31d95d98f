//! The colours that show a surface by itself: clay, zebra, shading normals and the checker over texture coordinates.

use std::f32::consts::PI;
use std::sync::Arc;

use geometry::mesh::mesh_builder::{InputCorner, MeshBuilder};
use geometry::mesh::{Material, Mesh, Shape, Texture};
use geometry::progress::Progress;
use geometry::tessellate::{
    CurvatureKind, LimitSurface, Normals, Partitioning, Surface, Tessellation, linear_normal, patch_curvature,
    patch_position,
};
use geometry::view::project;
use glam::{Vec2, Vec3, vec2, vec3};
use image::RgbaImage;
use inspect::render::layout::{linear, srgb};
use inspect::render::matcap::{MATCAP_REACH, picture};
use inspect::render::{Camera, DENSITY_SCALE, Scene, Target, Usual};
use inspect::settings::{Colors, Matcap, NormalsAt, Overlays, Settings, SurfaceUnit};

use crate::stability::{scene_of, seen};
use crate::{engine, scene};

/// The sides of pictures in px.
const SIDE: u32 = 400;

/// A square from -1 to 1 in the plane z = 0, which faces +z. All its corners have one normal, and u and v run from 0 to `uv`, v
/// downwards.
pub(super) fn square_of(material: Material, normal: Vec3, uv: Vec2) -> Mesh {
    let mut builder = MeshBuilder::new();
    let material = builder.material(material);
    let corner = |x: f32, y: f32| InputCorner {
        position: vec3(x, y, 0.0),
        normal: Some(normal),
        uv: uv * vec2(0.5 + 0.5 * x, 0.5 - 0.5 * y),
    };
    let [a, b, c, d] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    builder.triangle(material, [a, b, c]);
    builder.triangle(material, [a, c, d]);
    builder.finish("square".to_owned(), &Progress::default()).expect("nobody cancels")
}

/// A grey square.
fn square(normal: Vec3, uv: Vec2) -> Mesh {
    square_of(Material::plain("square", [0.6, 0.6, 0.6, 1.0]), normal, uv)
}

/// Flat patches in these colours.
fn flat(colors: Colors) -> Settings {
    let tessellation = Tessellation {
        surface: Surface::Flat,
        partitioning: Partitioning::Integer,
        factor: 3.0,
        ..Tessellation::default()
    };
    Settings { overlays: Overlays { colors, ..Overlays::default() }, ..Settings::from(tessellation) }
}

/// A square's picture from the front, or from behind: it fills the view. A px has `2 / side` object units.
pub(super) fn square_picture(mesh: &Mesh, settings: &Settings, azimuth: f32, side: u32) -> RgbaImage {
    let mut scene = scene_of(mesh.clone(), 0.0);
    let target = Target::new(&engine().gpu, [side; 2]).expect("a small picture");
    let camera = Camera { azimuth, ..facing(&scene, &target) };
    seen(&mut scene, &target, settings, &camera)
}

/// The camera for which a square fills the view, seen from the front.
pub(super) fn facing(scene: &Scene, target: &Target) -> Camera {
    let side = target.viewport().y;
    let framed = Camera::framing(&scene.bounds, target.viewport());
    let distance = framed.distance * 2.0 / (side * framed.units_per_pixel(side));
    Camera { azimuth: 0.0, elevation: 0.0, orthographic: true, distance, ..framed }
}

fn drawn(mesh: &Mesh, settings: &Settings, azimuth: f32) -> RgbaImage {
    square_picture(mesh, settings, azimuth, SIDE)
}

fn middle(picture: &RgbaImage) -> [u8; 3] {
    let [r, g, b, _] = picture.get_pixel(SIDE / 2 + 7, SIDE / 2 + 3).0;
    [r, g, b]
}

/// The settings with normals at pixels, and with the mesh itself in all of the picture, drawn without tessellation.
fn also(settings: Settings) -> [Settings; 3] {
    let pixels = Settings { normals_at: NormalsAt::Pixels, ..settings };
    [settings, pixels, Settings { split: Some(1.0), ..settings }]
}

#[test]
fn shading_normals_have_the_colours_of_normal_maps() {
    for normal in [Vec3::Z, vec3(0.6, 0.0, 0.8), vec3(0.0, -0.6, 0.8), vec3(-0.48, 0.64, 0.6)] {
        let mesh = square(normal, Vec2::ONE);
        let expected = (255.0 * (0.5 + 0.5 * normal)).to_array();
        for settings in also(flat(Colors::ShadingNormals)) {
            for azimuth in [0.0, 180.0] {
                let found = middle(&drawn(&mesh, &settings, azimuth)).map(f32::from);
                // Vertices have their normals packed in 32 bits, and the picture rounds each channel.
                let is_near = (0..3).all(|k| (found[k] - expected[k]).abs() <= 1.0);
                assert!(is_near, "{normal}: {found:?}, not {expected:?}, from {azimuth} with {settings:?}");
            }
        }
    }
}

#[test]
fn a_matcap_shows_the_colour_that_its_sphere_has_at_the_same_normal() {
    for matcap in [Matcap::RedClay, Matcap::TwoTone] {
        let sphere = picture(matcap);
        for normal in [Vec3::Z, vec3(0.6, 0.0, 0.8), vec3(0.0, -0.6, 0.8), vec3(-0.48, 0.64, 0.6), vec3(-0.8, 0.0, 0.6)]
        {
            let mesh = painted(&square(normal, Vec2::ONE));
            // The square is seen along z: from behind its normal is turned over, and right is -x.
            for (azimuth, seen) in [(0.0, normal), (180.0, vec3(normal.x, -normal.y, normal.z))] {
                let side = sphere.size[0] as f32;
                let place = 0.5 * side * (1.0 + MATCAP_REACH * vec2(seen.x, -seen.y));
                let at = 4 * (place.y as usize * sphere.size[0] as usize + place.x as usize);
                let expected = &sphere.rgba[at..at + 3];
                for settings in also(Settings { matcap, ..flat(Colors::Matcap) }) {
                    let found = middle(&drawn(&mesh, &settings, azimuth));
                    let is_near = found.iter().zip(expected).all(|(found, expected)| found.abs_diff(*expected) <= 3);
                    assert!(
                        is_near,
                        "{matcap:?} {normal}: {found:?}, not {expected:?}, from {azimuth} with {settings:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn surface_normals_are_those_of_the_patch_whatever_it_is_shaded_with() {
    // Normals that lean bend no flat patch, and the mesh itself is flat.
    let leaning = square(vec3(0.6, 0.0, 0.8), Vec2::ONE);
    for settings in also(flat(Colors::SurfaceNormals)) {
        for azimuth in [0.0, 180.0] {
            let found = middle(&drawn(&leaning, &settings, azimuth));
            let is_near = found.iter().zip([128, 128, 255]).all(|(found, expected)| found.abs_diff(expected) <= 1);
            assert!(is_near, "{found:?} from {azimuth} with {settings:?}");
        }
    }
}

#[test]
fn surface_normals_of_curved_patches_are_those_of_the_mathematics() {
    for surface in [Surface::PnAen, Surface::PhongAen, Surface::NagataAen] {
        let settings = flat(Colors::SurfaceNormals);
        let settings = settings.with(Tessellation { surface, normals: Normals::Surface, ..settings.tessellation });
        let shading = Settings { normals_at: NormalsAt::Pixels, ..settings };
        let shading = Settings { overlays: Overlays { colors: Colors::ShadingNormals, ..shading.overlays }, ..shading };
        let (_, mut sphere) = scene(Shape::Icosphere);
        let target = Target::new(&engine().gpu, [SIDE; 2]).expect("a small picture");
        let camera = Camera::framing(&sphere.bounds, target.viewport());
        // Surface normals at pixels are tested against the CPU; these must be the same whatever shades the surface.
        let expected = seen(&mut sphere, &target, &shading, &camera);
        for normals in [Normals::Linear, Normals::Surface] {
            let own = settings.with(Tessellation { normals, ..settings.tessellation });
            for overlays in [own.overlays, Overlays { folds: true, ..own.overlays }] {
                let found = seen(&mut sphere, &target, &Settings { overlays, ..own }, &camera);
                // At borders of patches, pixels that triangles share may take either side's colour.
                let differs =
                    |(a, b): (&image::Rgba<u8>, &image::Rgba<u8>)| (0..3).any(|k| a.0[k].abs_diff(b.0[k]) > 2);
                let different = found.pixels().zip(expected.pixels()).filter(|&pair| differs(pair)).count();
                assert!(different < 160, "{different} px: {surface:?} {normals:?} {overlays:?}");
            }
        }
    }
}

#[test]
fn texel_density_is_that_of_the_base_colours_image() {
    let grey = linear([188; 3]);
    for (size, units, expected) in [
        (Some([SIDE, SIDE]), 1.0, Some(1.0)),
        // A px covers 2 by 1/2 texels, and then 4 by 1.
        (Some([2 * SIDE, SIDE / 2]), 1.0, Some(1.0)),
        (Some([2 * SIDE, SIDE / 2]), 2.0, Some(2.0)),
        (Some([SIDE / 4, SIDE / 4]), 1.0, Some(0.25)),
        (Some([4, 4]), 1.0, Some(0.01)),
        (None, 1.0, Some(1024.0 / SIDE as f32)),
        (None, 0.0, None),
    ] {
        let mut mesh = square(Vec3::Z, Vec2::splat(units));
        if let Some([width, height]) = size {
            let texture = Texture { size: [width, height], rgba: vec![90; 4 * (width * height) as usize] };
            mesh.materials[0].texture = Some(Arc::new(texture));
        }
        let expected = expected.map(|density| DENSITY_SCALE.color(DENSITY_SCALE.place(density)));
        for settings in also(flat(Colors::TexelDensity)) {
            let found = middle(&drawn(&mesh, &settings, 0.0));
            match expected {
                Some(color) => {
                    let is_near = found.iter().zip(color).all(|(found, expected)| found.abs_diff(expected) <= 2);
                    assert!(is_near, "{size:?} {units}: {found:?}, not {color:?}, with {settings:?}");
                }
                None => assert!(found[0] == found[1] && linear(found)[0] < grey[0] * 1.1, "grey: {found:?}"),
            }
        }
    }
}

#[test]
fn texel_density_is_counted_along_object_units_in_any_view() {
    for (size, units) in [([400, 400], 1.0), ([800, 200], 1.0), ([300, 300], 5.0), ([3000, 3000], 0.25)] {
        let mut mesh = square(Vec3::Z, Vec2::splat(units));
        let texture = Texture { size, rgba: vec![90; 4 * (size[0] * size[1]) as usize] };
        mesh.materials[0].texture = Some(Arc::new(texture));
        // A square has 2 object units.
        let expected = (size[0] as f32 * size[1] as f32).sqrt() * units / 2.0;
        let own = Settings { texel_density_per: SurfaceUnit::Units, ..flat(Colors::TexelDensity) };
        let scale = scene_of(mesh.clone(), 0.0).usual().scale(&own, None);
        assert!((scale.least..scale.most).contains(&expected), "{expected} in {scale:?}");
        let color = scale.color(scale.place(expected));
        for settings in also(own) {
            for side in [SIDE, 150] {
                let picture = square_picture(&mesh, &settings, 0.0, side);
                let [r, g, b, _] = picture.get_pixel(side / 2 + 7, side / 2 + 3).0;
                let is_near = [r, g, b].iter().zip(color).all(|(found, expected)| found.abs_diff(expected) <= 2);
                assert!(is_near, "{size:?} {units}: {:?}, not {color:?}, with {settings:?}", [r, g, b]);
            }
        }
    }
}

/// What curvature looks like in a picture: a colour of the scale, in very little light.
fn curvature_color(curvature: f32, settings: &Settings, usual: &Usual, facing: f32) -> [u8; 3] {
    let scale = usual.scale(settings, None);
    linear(scale.color(scale.place(curvature))).map(|channel| srgb(channel * (0.7 + 0.3 * facing)))
}

#[test]
fn curvature_at_pixels_is_that_of_the_mathematics() {
    const PLACES: [[u32; 2]; 4] = [[21845, 21845], [40000, 13000], [9000, 20000], [3000, 58000]];
    // Across borders of patches, where no place is near, the other kinds jump farther than the mean does.
    const INSIDE: [[u32; 2]; 4] = [[21845, 21845], [30000, 18000], [16000, 22000], [20000, 30000]];
    for (kind, shape, surface) in [
        (CurvatureKind::Mean, Shape::Icosahedron, Surface::PnAen),
        (CurvatureKind::Mean, Shape::Icosahedron, Surface::PhongAen),
        (CurvatureKind::Mean, Shape::Icosahedron, Surface::NagataAen),
        (CurvatureKind::Mean, Shape::Icosahedron, Surface::Flat),
        (CurvatureKind::Mean, Shape::Saddle, Surface::PnAen),
        (CurvatureKind::Gaussian, Shape::Icosahedron, Surface::PnAen),
        (CurvatureKind::Gaussian, Shape::Saddle, Surface::PnAen),
        (CurvatureKind::Largest, Shape::Icosahedron, Surface::PnAen),
        (CurvatureKind::Largest, Shape::Saddle, Surface::PnAen),
        (CurvatureKind::Least, Shape::Icosahedron, Surface::PnAen),
        (CurvatureKind::Least, Shape::Saddle, Surface::PnAen),
    ] {
        let (_, mut scene) = scene(shape);
        let places = if kind == CurvatureKind::Mean { PLACES } else { INSIDE };
        let settings = Settings { curvature_kind: kind, curvature_scale: Some(4.0), ..flat(Colors::Curvature) };
        let settings = settings.with(Tessellation { surface, factor: 32.0, ..settings.tessellation });
        let target = Target::new(&engine().gpu, [SIDE; 2]).expect("a small picture");
        let camera = Camera { orthographic: true, ..Camera::framing(&scene.bounds, target.viewport()) };
        let (clip, to_eye) = (camera.clip_from_object(target.viewport(), &scene.bounds), camera.axes()[2]);
        let (mesh, topology) = (scene.tessellator.mesh().clone(), scene.tessellator.topology().clone());
        let inputs = settings.inputs(camera.lod_view(target.viewport(), &scene.bounds));
        let limit = LimitSurface::new(&mesh, &topology, &inputs);
        for settings in [settings, Settings { overlays: Overlays { folds: true, ..settings.overlays }, ..settings }] {
            let picture = seen(&mut scene, &target, &settings, &camera);
            let (mut tried, mut range) = (0, [f32::INFINITY, f32::NEG_INFINITY]);
            for (patch, [u, v]) in (0..topology.patches.len() as u32).flat_map(|patch| places.map(|at| (patch, at))) {
                let net = limit.net(patch);
                let normals =
                    topology.corners(&topology.patches[patch as usize]).map(|c| mesh.corners[c as usize].normal);
                let facing = linear_normal(normals, u, v).dot(to_eye);
                if facing < 0.5 {
                    continue;
                }
                let curvature = patch_curvature(kind, surface, &net, u, v);
                let at = project(clip, target.viewport(), patch_position(surface, &net, u, v)).expect("in view");
                let found = picture.get_pixel(at.x as u32, at.y as u32).0;
                let expected = curvature_color(curvature, &settings, &scene.usual(), facing);
                let is_near = (0..3).all(|k| found[k].abs_diff(expected[k]) <= 5);
                assert!(is_near, "{kind:?} {shape:?} {surface:?} {patch} {u} {v}: {found:?}, not {expected:?}");
                range = [range[0].min(curvature), range[1].max(curvature)];
                tried += 1;
            }
            assert!(
                tried > 9 && (surface == Surface::Flat || range[1] - range[0] > 0.01),
                "{kind:?} {shape:?}: {tried} {range:?}"
            );
        }
    }
}

#[test]
fn the_mesh_itself_has_no_curvature() {
    let settings = Settings { split: Some(1.0), ..flat(Colors::Curvature) };
    let settings = settings.with(Tessellation { surface: Surface::PnAen, ..settings.tessellation });
    let (_, mut sphere) = scene(Shape::Icosphere);
    let target = Target::new(&engine().gpu, [SIDE; 2]).expect("a small picture");
    let camera = Camera::framing(&sphere.bounds, target.viewport());
    let [r, g, b] = middle(&seen(&mut sphere, &target, &settings, &camera));
    assert!(r == g && g == b && r > 200, "light grey: {:?}", [r, g, b]);
    let curved = Settings { split: None, ..settings };
    let [r, g, b] = middle(&seen(&mut sphere, &target, &curved, &camera));
    assert!(r > g + 10 && r > b + 10, "a sphere bulges: {:?}", [r, g, b]);
}

/// The square with another material: a red one with a texture of two colours.
fn painted(mesh: &Mesh) -> Mesh {
    let mut painted = mesh.clone();
    let texture = Texture { size: [2, 1], rgba: vec![255, 0, 255, 255, 0, 255, 0, 255] };
    for material in &mut painted.materials {
        material.base_color = [0.9, 0.2, 0.1, 1.0];
        material.texture = Some(Arc::new(texture.clone()));
    }
    painted
}

#[test]
fn clay_has_no_colours_textures_or_gloss() {
    // It mirrors the light into the eye, so that gloss is strongest.
    let normal = vec3(-0.5, 0.7, 2.0).normalize();
    let plain = square(normal, Vec2::ONE);
    let painted = painted(&plain);
    for settings in also(flat(Colors::Clay)) {
        let clay = drawn(&plain, &settings, 0.0);
        assert!(clay == drawn(&painted, &settings, 0.0), "{settings:?}");
        let [r, g, b] = middle(&clay);
        assert!(r > g && g > b && b > 120, "a light warm grey: {:?}", [r, g, b]);
        // Gloss is added to the colour and is grey, so that it changes the hue.
        let hue = |color: [u8; 3]| linear(color)[2] / linear(color)[0];
        let shaded = middle(&drawn(&square(vec3(0.9, -0.3, 0.3), Vec2::ONE), &settings, 0.0));
        assert!((hue([r, g, b]) - hue(shaded)).abs() < 0.02, "{:?} and {shaded:?}", [r, g, b]);
    }
    let own = flat(Colors::Material);
    assert!(drawn(&plain, &own, 0.0) != drawn(&painted, &own, 0.0), "their own colours differ");
}

#[test]
fn half_a_turn_of_the_normal_has_24_stripes() {
    // Across the stripes, in the view.
    let across = vec3(-0.6, 0.8, 0.0);
    for stripe in -11..11 {
        let angle = (stripe as f32 + 0.5) / 24.0 * PI;
        let mesh = square(angle.cos() * Vec3::Z + angle.sin() * across, Vec2::ONE);
        for settings in also(flat(Colors::Zebra)) {
            let color = middle(&drawn(&mesh, &settings, 0.0));
            let is_white = color.iter().all(|&channel| channel > 200);
            let is_black = color.iter().all(|&channel| channel < 50);
            assert_eq!([is_white, is_black], [stripe % 2 == 0, stripe % 2 != 0], "{stripe}: {color:?}, {settings:?}");
        }
    }
}

#[test]
fn zebra_has_as_many_stripes_as_are_asked_for_in_their_direction() {
    for (stripes, direction) in [(10_i16, 0.0_f32), (10, 90.0), (6, 120.0), (40, 36.87)] {
        let (sine, cosine) = direction.to_radians().sin_cos();
        for stripe in 1 - stripes / 2..stripes / 2 - 1 {
            let angle = (f32::from(stripe) + 0.5) / f32::from(stripes) * PI;
            // Across the stripes, in the view.
            let normal = angle.cos() * Vec3::Z + angle.sin() * vec3(-sine, cosine, 0.0);
            let of_zebra =
                Settings { zebra_stripes: f32::from(stripes), zebra_direction: direction, ..flat(Colors::Zebra) };
            let [color, _, _] = middle(&drawn(&square(normal, Vec2::ONE), &of_zebra, 0.0));
            let expected = if stripe % 2 == 0 { 200..=255 } else { 0..=50 };
            assert!(expected.contains(&color), "{stripe} of {stripes} at {direction}: {color}");
        }
    }
}

/// The mean difference of the stripes on both sides of the borders of patches that face the eye, as a part of that of black and
/// white.
fn jump(scene: &mut Scene, settings: &Settings) -> f64 {
    let target = Target::new(&engine().gpu, [1000; 2]).expect("a small picture");
    let camera = Camera { orthographic: true, ..Camera::framing(&scene.bounds, target.viewport()) };
    let picture = seen(scene, &target, settings, &camera);
    let clip = camera.clip_from_object(target.viewport(), &scene.bounds);
    let to_eye = camera.axes()[2];
    let mesh = scene.tessellator.mesh().clone();
    let brightness = |at: Vec2| f64::from(linear([picture.get_pixel(at.x as u32, at.y as u32).0[0]; 3])[0]);
    let (mut sum, mut count) = (0.0, 0);
    for triangle in mesh.triangles.iter() {
        let corners = triangle.map(|corner| mesh.corners[corner as usize].position);
        if corners.iter().any(|corner| corner.normalize().dot(to_eye) < 0.6) {
            continue;
        }
        let ends = corners.map(|corner| project(clip, target.viewport(), corner).expect("in view"));
        for (a, b) in [(ends[0], ends[1]), (ends[1], ends[2]), (ends[2], ends[0])] {
            let aside = (b - a).perp().normalize() * 2.0;
            for part in [0.2, 0.35, 0.5, 0.65, 0.8] {
                let at = a.lerp(b, part);
                sum += (brightness(at + aside) - brightness(at - aside)).abs();
                count += 1;
            }
        }
    }
    assert!(count > 50, "{count} places");
    sum / f64::from(count) / (0.85 - 0.012)
}

#[test]
fn stripes_go_on_across_borders_of_patches_with_the_same_normals_and_jump_at_others() {
    let (_, mut sphere) = scene(Shape::Icosphere);
    let of = |normals| {
        let settings = flat(Colors::Zebra);
        settings.with(Tessellation { normals, ..settings.tessellation })
    };
    let [together, apart] = [Normals::Linear, Normals::Surface].map(|normals| jump(&mut sphere, &of(normals)));
    // Where the sides of a border have nothing to do with each other, half of the places differ.
    assert!(together < 0.2 && apart > 0.35, "{together} {apart}");
    let pixels = Settings { normals_at: NormalsAt::Pixels, ..of(Normals::Linear) };
    assert!(jump(&mut sphere, &pixels) < 0.2);
}

/// How often squares of a checker change along a row or a column of a picture. Light squares are at least 0.3 in linear light, and
/// dark ones at most 0.25.
fn changes(pixels: impl Iterator<Item = [u8; 3]>) -> usize {
    let is_light: Vec<_> = pixels.map(|color| linear(color).iter().sum::<f32>() / 3.0 > 0.28).collect();
    is_light.windows(2).filter(|pair| pair[0] != pair[1]).count()
}

#[test]
fn a_unit_of_texture_coordinates_has_eight_squares_and_a_line_around_it() {
    let mesh = square(Vec3::Z, Vec2::ONE);
    for settings in also(flat(Colors::UvChecker)) {
        let picture = drawn(&mesh, &settings, 0.0);
        let color = |x: u32, y: u32| {
            let [r, g, b, _] = picture.get_pixel(x, y).0;
            [r, g, b]
        };
        // Beside what is written in squares, without the lines at both ends.
        let (inside, square) = (5..SIDE - 5, SIDE / 8);
        for place in [square - 2, 5 * square - 2] {
            assert_eq!(changes(inside.clone().map(|x| color(x, place))), 7, "{settings:?}");
            assert_eq!(changes(inside.clone().map(|y| color(place, y))), 7, "{settings:?}");
        }
        let is_line = |[r, g, b]: [u8; 3]| b > 120 && r < 60 && g < 90;
        for place in [0, SIDE - 1] {
            assert!(is_line(color(place, 120)) && is_line(color(120, place)), "{:?}", color(place, 120));
        }
        // The light squares in the first and the last row and column.
        let [first, u, v] = [(25, 25), (325, 25), (25, 325)].map(|(x, y)| color(x, y));
        assert!(
            u[0].abs_diff(first[0]) < 30 && u[1] + 30 < u[0] && u[2] + 30 < u[0],
            "red grows with u: {first:?} {u:?}"
        );
        assert!(v[0] + 30 < v[1] && v[2] + 30 < v[1], "green grows with v: {first:?} {v:?}");
    }
}

#[test]
fn a_unit_of_texture_coordinates_has_as_many_squares_as_are_asked_for() {
    for (count, width) in [(4.0, 100), (10.0, 40)] {
        let settings = Settings { checker_squares: count, ..flat(Colors::UvChecker) };
        let picture = drawn(&square(Vec3::Z, Vec2::ONE), &settings, 0.0);
        let color = |x: u32| {
            let [r, g, b, _] = picture.get_pixel(x, width - 2).0;
            [r, g, b]
        };
        assert_eq!(changes((5..SIDE - 5).map(color)), count as usize - 1, "{count}");
    }
}

#[test]
fn squares_have_an_f_that_shows_mirrored_coordinates_and_their_numbers() {
    // One light square, 22 cells wide, and the dark one beside it. The F has cells of twice the size; the last digits of column and
    // row are at the right.
    let settings = Settings { checker_squares: 1.0, ..flat(Colors::UvChecker) };
    let [own, mirrored] = [1.0, -1.0].map(|u| drawn(&square(Vec3::Z, vec2(u, 1.0)), &settings, 0.0));
    let f = ["###", "#..", "##.", "#..", "#.."];
    let one = [".#.", "##.", ".#.", ".#.", "###"];
    // What is written, where it begins, how large its cells are, and what is darker than this is ink: red and green grow across.
    for (glyph, [left, top], size, ink) in
        [(f, [1.0, 5.0], 2.0, 0.38), (one, [17.0, 5.0], 1.0, 0.33), (one, [17.0, 11.0], 1.0, 0.33)]
    {
        for (y, row) in (0_u8..).zip(glyph) {
            for (x, cell) in (0_u8..).zip(row.chars()) {
                let px = |from: f32, step: u8| ((from + size * (f32::from(step) + 0.5)) / 22.0 * SIDE as f32) as u32;
                let at = [px(left, x), px(top, y)];
                let brightness = |picture: &RgbaImage, across: u32| {
                    let [r, g, b, _] = picture.get_pixel(across, at[1]).0;
                    linear([r, g, b]).iter().sum::<f32>() / 3.0
                };
                let [light, dark] = [brightness(&own, at[0]), brightness(&mirrored, SIDE - 1 - at[0])];
                assert_eq!([light < ink, dark > 0.26], [cell == '#'; 2], "{glyph:?} {x} {y}: {light} {dark}");
            }
        }
    }
}

#[test]
fn squares_smaller_than_a_pixel_are_plain() {
    // Squares of 0.17 and of 0.8 px.
    for units in [300.0, 62.5] {
        let picture = drawn(&square(Vec3::Z, Vec2::splat(units)), &flat(Colors::UvChecker), 0.0);
        let [r, g, b] = middle(&picture);
        assert!(picture.pixels().all(|pixel| pixel.0 == [r, g, b, 255]), "{units} units have a pattern of pixels");
    }
}

#[test]
fn a_surface_without_texture_coordinates_has_no_checker() {
    for settings in also(flat(Colors::UvChecker)) {
        let picture = drawn(&square(Vec3::Z, Vec2::ZERO), &settings, 0.0);
        let [r, g, b] = middle(&picture);
        assert!(r == g && g == b && (140..200).contains(&r), "a grey: {:?}", [r, g, b]);
        assert!(picture.pixels().all(|pixel| pixel.0 == [r, r, r, 255]));
    }
}

#[test]
fn a_normal_across_the_view_reflects_the_place_where_all_stripes_meet() {
    let [r, g, b] = middle(&drawn(&square(Vec3::X, Vec2::ONE), &flat(Colors::Zebra), 0.0));
    assert!(r == g && g == b && (100..220).contains(&r), "a grey: {:?}", [r, g, b]);
}

use std::sync::Arc;

use glam::{Mat4, Vec4, vec2, vec3};
use proptest::prelude::*;

use super::*;
use crate::mesh::{Corner, HeightAmount, HeightMap, Heights, Material, Mesh, Topology, Wrap, patch_reliefs};
use crate::tessellate::displace::bilinear_height;
use crate::tessellate::lod::LodView;
use crate::tessellate::normal::unit_or;
use crate::tessellate::piece_error::{piece_error, seen_patch, seen_relief};
use crate::tessellate::{ControlNet, straight_control_point};

/// Images of every kind: smooth, smooth with steps of 8 bits, a cliff, noise, one white px, and flat.
fn image(kind: u32, size: [u32; 2], seed: u32) -> HeightMap {
    let height = |i: u32| {
        let (x, y) = (i % size[0], i / size[0]);
        let [across, down] = [x, y].map(|at| at as f32 / size[0] as f32);
        let smooth = 0.5 + 0.25 * (12.8 * across + seed as f32).sin() + 0.2 * (8.3 * down).cos();
        match kind {
            0 => smooth,
            1 => (255.0 * smooth).round() / 255.0,
            2 => f32::from(u8::from(x > y + seed % 5)),
            3 => (i.wrapping_mul(2_654_435_769).wrapping_add(seed).wrapping_mul(0x9e37_79b1) >> 24) as f32 / 255.0,
            4 => f32::from(u8::from(i == seed % (size[0] * size[1]))),
            _ => 0.75,
        }
    };
    HeightMap::new(size, (0..size[0] * size[1]).map(height).collect())
}

/// A mesh of one triangle with these texture coordinates.
fn triangle(uvs: [Vec2; 3], map: HeightMap) -> (Mesh, Topology) {
    let positions = [vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), Vec3::ZERO];
    let corner = |k: usize| Corner { position: positions[k], normal: Vec3::Z, uv: uvs[k] };
    let mut material = Material::plain("plain", [1.0; 4]);
    material.triangles = 0..1;
    let mut mesh = Mesh {
        corners: vec![corner(0), corner(1), corner(2)],
        triangles: vec![[0, 1, 2]].into(),
        materials: vec![material],
        ..Mesh::default()
    };
    mesh.heights = Some(Arc::new(Heights::everywhere(&mesh, map)));
    let topology = Topology::new(&mesh);
    (mesh, topology)
}

/// The net of a flat triangle.
fn flat_net([a, b, c]: [Vec3; 3]) -> ControlNet {
    let edges = [[a, b], [b, a], [b, c], [c, b], [c, a], [a, c]].map(|[near, far]| straight_control_point(near, far));
    ControlNet { corners: [a, b, c], edges, center: (a + b + c) / 3.0 }
}

/// A place of the domain, from two numbers between 0 and 1.
fn place([x, y]: [f32; 2]) -> Vec2 {
    if x + y > 1.0 { vec2(1.0 - x, 1.0 - y) } else { vec2(x, y) }
}

/// A triangle around a place of the domain, `size` of it wide.
fn piece(middle: Vec2, corners: [[f32; 2]; 3], size: f32) -> [Vec2; 3] {
    corners.map(|corner| middle + (place(corner) - middle) * size)
}

fn weighted<T: std::ops::Mul<f32, Output = T> + std::ops::Add<Output = T> + Copy>(of: [T; 3], at: Vec2) -> T {
    of[0] * at.x + of[1] * at.y + of[2] * (1.0 - at.x - at.y)
}

fn numbers<const N: usize>() -> impl Strategy<Value = [[f32; 2]; N]> {
    prop::array::uniform(prop::array::uniform2(0f32..1.0))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]
    #[test]
    fn no_height_is_farther_from_linear_ones_than_is_bounded(
        (kind, seed) in (0u32..6, 0u32..1000),
        size in prop::sample::select(&[[64u32, 64], [32, 8], [37, 23], [1, 16], [1, 1]][..]),
        uvs in numbers::<3>(),
        (tiles, shift) in (prop::sample::select(&[0.02f32, 0.2, 1.0, 3.0][..]), -1f32..1.0),
        (middle, corners, magnitude) in (numbers::<1>(), numbers::<3>(), -6f32..0.0),
        within in numbers::<4>(),
        wrap in prop::array::uniform2(prop::sample::select(&[Wrap::Clamp, Wrap::Repeat, Wrap::Mirror][..])),
    ) {
        let uvs = uvs.map(|uv| Vec2::from(uv) * tiles + if tiles < 1.0 { 0.3 } else { shift });
        let (mesh, topology) = triangle(uvs, image(kind, size, seed).with_wrap(wrap));
        prop_assume!(!topology.patches.is_empty());
        let heights = mesh.heights.as_deref().expect("heights");
        let relief = patch_reliefs(Some(heights), &mesh, &topology)[0];
        let at = piece(place(middle[0]), corners, magnitude.exp2());
        let seen = SeenRelief { relief, directions: [Vec3::X; 3], turning: 0.0, shortest: 1.0, part: 1.0 };
        let bound = heights_error(&seen, 0.0, at, Vec2::ZERO, 0.0, 1.0);
        // Patches have their corners in the mesh's order.
        let uvs = topology.corners(&topology.patches[0]).map(|corner| mesh.corners[corner as usize].uv);
        let height = |at: Vec2| bilinear_height(&heights.maps[0], 0, weighted(uvs, at));
        let ends = at.map(height);
        for inner in within {
            let inner = place(inner);
            let error = (height(weighted(at, inner)) - weighted(ends, inner)).abs();
            prop_assert!(error <= bound + 2e-5, "{error}, not {bound}, at {at:?} of {relief:?}");
        }
    }
}

#[test]
fn bounds_of_smooth_heights_fall_with_the_square_of_the_sides() {
    let (mesh, topology) = triangle([vec2(1.0, 0.0), vec2(0.0, 1.0), Vec2::ZERO], image(0, [64, 64], 0));
    let relief = patch_reliefs(mesh.heights.as_deref(), &mesh, &topology)[0];
    // The second derivative of the sine is a hundredth, and that of the cosine a third of it.
    // Half a px beyond the border is flat: that is a bend by the slope there.
    let [constant, square] = relief.losses[RELIEF_STEPS - 1];
    assert!(constant < 0.02 && (0.0015..0.01).contains(&square), "{relief:?}");
    // Noise is bounded by its range alone.
    let (mesh, topology) = triangle([vec2(1.0, 0.0), vec2(0.0, 1.0), Vec2::ZERO], image(3, [64, 64], 0));
    let relief = patch_reliefs(mesh.heights.as_deref(), &mesh, &topology)[0];
    assert!(relief.range > 0.95 && relief.losses[1] == [relief.range, 0.0], "{relief:?}");
}

#[test]
fn steps_of_8_bits_cost_about_as_much_as_they_are_high() {
    let over = |kind| {
        let (mesh, topology) = triangle([vec2(1.0, 0.0), vec2(0.0, 1.0), Vec2::ZERO], image(kind, [512, 512], 0));
        let [constant, square] = patch_reliefs(mesh.heights.as_deref(), &mesh, &topology)[0].losses[4];
        constant + square * 16.0 * 16.0
    };
    assert!(over(1) < over(0) + 8.0 / 255.0, "{} and {}", over(1), over(0));
}

#[test]
fn what_no_image_displaces_has_no_error() {
    let (mut mesh, topology) = triangle([Vec2::ZERO; 3], image(3, [8, 8], 0));
    let heights = Heights { ranges: Vec::new(), ..mesh.heights.as_deref().expect("heights").clone() };
    mesh.heights = Some(Arc::new(heights));
    assert_eq!(patch_reliefs(mesh.heights.as_deref(), &mesh, &topology), [PatchRelief::NONE]);
    assert_eq!(patch_reliefs(None, &mesh, &topology), []);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]
    #[test]
    fn no_point_is_farther_from_the_displaced_surface_than_is_bounded(
        (kind, seed) in (0u32..6, 0u32..1000),
        turned in numbers::<3>(),
        (amount, height_scale, orthographic) in (0f32..1.0, -0.2f32..0.2, any::<bool>()),
        (middle, corners, magnitude) in (numbers::<1>(), numbers::<3>(), -6f32..0.0),
        within in numbers::<4>(),
    ) {
        let (mesh, topology) = triangle([vec2(1.0, 0.0), vec2(0.0, 1.0), Vec2::ZERO], image(kind, [32, 32], seed));
        let heights = mesh.heights.as_deref().expect("heights");
        let relief = patch_reliefs(Some(heights), &mesh, &topology)[0];
        let corners_of = topology.corners(&topology.patches[0]).map(|corner| mesh.corners[corner as usize]);
        let directions = turned.map(|[x, y]| vec3(amount * (2.0 * x - 1.0), amount * (2.0 * y - 1.0), 1.0).normalize());
        let midlevel = 0.25;
        let mut clip_from_object = Mat4::from_rotation_x(0.7 * amount);
        if !orthographic {
            // A depth of 3 and more.
            let depth = clip_from_object.row(2) * 0.5 + Vec4::W * 3.0;
            (clip_from_object.x_axis.w, clip_from_object.y_axis.w) = (depth.x, depth.y);
            (clip_from_object.z_axis.w, clip_from_object.w_axis.w) = (depth.z, depth.w);
            (clip_from_object.x_axis.z, clip_from_object.y_axis.z) = (0.0, 0.0);
            (clip_from_object.z_axis.z, clip_from_object.w_axis.z) = (0.0, 0.01);
        }
        let reach = heights.reach(HeightAmount { scale: height_scale, midlevel });
        let view = LodView::new(clip_from_object, vec2(400.0, 300.0)).with_reach(reach);
        let net = flat_net(corners_of.map(|corner| corner.position));
        let mut patch = seen_patch(&view, &net);
        patch.relief = seen_relief(&view, patch.scale, directions, height_scale, relief);
        let at = piece(place(middle[0]), corners, magnitude.exp2());
        let displaced = |at: Vec2| {
            let position = weighted(corners_of.map(|corner| corner.position), at);
            let height = bilinear_height(&heights.maps[0], 0, weighted(corners_of.map(|corner| corner.uv), at));
            position + unit_or(weighted(directions, at), Vec3::Z) * (height_scale * (height - midlevel))
        };
        let px = |p: Vec3| {
            let clip = view.clip_from_object * p.extend(1.0);
            vec2(clip.x, clip.y) * view.half_viewport / clip.w
        };
        let ends = at.map(displaced);
        let bound = piece_error(&patch, 1e9, at);
        for inner in within {
            let inner = place(inner);
            let error = px(displaced(weighted(at, inner))).distance(px(weighted(ends, inner)));
            prop_assert!(error <= bound + 2e-3, "{error} px, not {bound}");
        }
    }
}

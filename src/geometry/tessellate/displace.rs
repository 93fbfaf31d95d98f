//! Displacement: heights that are read from an image at texture coordinates, and the normals of the displaced surface.
//! Twin: `shaders/displace.wgsl`.
//!
//! A point moves by scale * (height - midlevel) along a direction that all patches around it share. Heights are
//! filtered in f32, not by the device's texture units, whose filter weights have 8 bits: so every device computes the
//! same heights.
//!
//! A height map is a list of mip levels, level 0 first; a *px* is a pixel of one level. Texture coordinates run from 0
//! to 1 over the image.

use glam::{Vec2, Vec3, vec2};

use super::FIXED_ONE;
use super::height_list::{fetch_height, level_place};
use super::normal::unit_or;
use super::surface::outline_place;
use crate::choice::choices;
use crate::mesh::{HeightMap, Wrap};

choices! {
    /// Whether a surface is displaced by height images, and what its patches agree on where they meet.
    #[derive(Default, Hash)]
    #[repr(u32)]
    pub enum Displacement {
        #[default]
        Off => "off", "Off", "The surface isn't displaced.";
        On => "on", "On",
            "Displaces without cracks. Each edge and each point takes its texture coordinates from one triangle \
             (dominant edges and vertices, McDonald 2011), and moves along the mean of the normals that meet there.";
        AsPublished => "as-published", "Paper (seams closed)",
            "Uses dominant edges and vertices (McDonald 2011), but moves each patch along its own normals. Texture seams \
             stay closed, and edges with split normals crack open.";
        PerPatch => "per-patch", "Per patch (cracks)",
            "Each patch uses its own texture coordinates and normals. Texture seams and edges with split normals crack \
             open.";
    }
}

impl Displacement {
    /// Whether heights move the surface.
    pub fn is_on(self) -> bool {
        self != Self::Off
    }

    /// The one that is usual with heights, or without.
    pub fn usual(has_heights: bool) -> Self {
        if has_heights { Self::On } else { Self::Off }
    }

    /// Whether patches take heights from the same place where they meet.
    pub fn shares_heights(self) -> bool {
        matches!(self, Self::On | Self::AsPublished)
    }
}

/// Returns the fractional part of a texture coordinate, which repeats the image.
fn wrapped(x: f32) -> f32 {
    x - x.floor()
}

/// Returns where the texture coordinate `x` lies along a row or column of `size` px: in px from the centre of px 0. In
/// images that repeat, `size` is added, so that the result isn't negative.
fn pixel_coordinate(wrap: Wrap, x: f32, size: u32) -> f32 {
    if wrap == Wrap::Repeat {
        return wrapped(x) * size as f32 + size as f32 - 0.5;
    }
    // There and back again.
    let turned = 2.0 * wrapped(0.5 * x);
    let place = if wrap == Wrap::Mirror { turned.min(2.0 - turned) } else { x };
    (place * size as f32 - 0.5).clamp(0.0, (size - 1) as f32)
}

/// Returns the height of a mip level at a texture coordinate, bilinearly interpolated.
pub(crate) fn bilinear_height(map: &HeightMap, level: u32, uv: Vec2) -> f32 {
    let width = (map.size[0] >> level).max(1);
    let height = (map.size[1] >> level).max(1);
    let x = pixel_coordinate(map.wrap[0], uv.x, width);
    let y = pixel_coordinate(map.wrap[1], uv.y, height);
    let left = x as u32 % width;
    let upper = y as u32 % height;
    // Images that don't repeat give weight 0 to a px beyond the last one.
    let right = (left + 1) % width;
    let lower = (upper + 1) % height;
    let place = level_place(map, level);
    let a = fetch_height(map, place, [left, upper]);
    let b = fetch_height(map, place, [right, upper]);
    let c = fetch_height(map, place, [left, lower]);
    let d = fetch_height(map, place, [right, lower]);
    let across = x - x.floor();
    let down = y - y.floor();
    let above = a + (b - a) * across;
    let below = c + (d - c) * across;
    above + (below - above) * down
}

/// Returns the height at a texture coordinate, linearly interpolated between the two mip levels around `level`.
pub(crate) fn height_at(map: &HeightMap, level: f32, uv: Vec2) -> f32 {
    let least = level as u32;
    let part = level - least as f32;
    let fine = bilinear_height(map, least, uv);
    if part <= 0.0 {
        return fine;
    }
    fine + (bilinear_height(map, least + 1, uv) - fine) * part
}

/// Returns the derivatives of the height by both texture coordinates, as central differences over one px of the level.
pub(crate) fn height_slopes(map: &HeightMap, level: f32, uv: Vec2) -> Vec2 {
    let px = level.exp2() / vec2(map.size[0] as f32, map.size[1] as f32);
    let across = vec2(0.5 * px.x, 0.0);
    let down = vec2(0.0, 0.5 * px.y);
    let along_x = height_at(map, level, uv + across) - height_at(map, level, uv - across);
    let along_y = height_at(map, level, uv + down) - height_at(map, level, uv - down);
    vec2(along_x / px.x, along_y / px.y)
}

/// Returns the mip level at which one px is as long as a segment of an edge. The edge is `texels` px of level 0 long
/// and is cut into `segments`.
pub(crate) fn segment_level(map: &HeightMap, texels: f32, segments: f32) -> f32 {
    let level = (texels.max(1e-6) / segments).log2();
    level.clamp(0.0, (map.levels - 1) as f32)
}

/// Returns the distance between two texture coordinates in px of level 0.
pub(crate) fn texel_length(map: &HeightMap, a: Vec2, b: Vec2) -> f32 {
    ((b - a) * vec2(map.size[0] as f32, map.size[1] as f32)).length()
}

/// Where a point lies in its patch.
pub(super) enum Spot {
    Corner(usize),
    /// A side, and the weight of its end.
    Side(usize, u32),
    Inside,
}

/// Returns where the domain point (u, v) lies in its patch.
pub(super) fn spot(u: u32, v: u32) -> Spot {
    let corner = [u, v, FIXED_ONE - u - v].iter().position(|&weight| weight == FIXED_ONE);
    let on_outline = || outline_place(u, v).map_or(Spot::Inside, |(side, t)| Spot::Side(side, t));
    corner.map_or_else(on_outline, Spot::Corner)
}

/// Returns the derivatives by u and by v of the unit vector along a u + b v + c w, where a, b and c are `directions`
/// and w = 1 - u - v. `direction` is that unit vector, and `length` is the length of the sum. Zero if the sum is nearly
/// zero.
pub(crate) fn direction_slopes(directions: [Vec3; 3], direction: Vec3, length: f32) -> [Vec3; 2] {
    let along_u = directions[0] - directions[2];
    let along_v = directions[1] - directions[2];
    if length <= 1e-6 {
        return [Vec3::ZERO; 2];
    }
    let flat_u = along_u - direction * direction.dot(along_u);
    let flat_v = along_v - direction * direction.dot(along_v);
    [flat_u * (1.0 / length), flat_v * (1.0 / length)]
}

/// Returns the gradients of both texture coordinates over a flat triangle, each times twice the triangle's area, and
/// twice that area.
///
/// The gradients lie in the triangle's plane, in texture widths and heights for each object unit. Everything is zero if
/// the triangle is degenerate.
pub(crate) fn uv_gradients(corners: [Vec3; 3], uvs: [Vec2; 3]) -> ([Vec3; 2], f32) {
    let along = corners[1] - corners[0];
    let beside = corners[2] - corners[0];
    let size = along.abs().max(beside.abs()).max_element();
    if size == 0.0 {
        return ([Vec3::ZERO; 2], 0.0);
    }
    // Scale the sides, so that products of very short or very long ones neither underflow nor overflow.
    let a = along * (1.0 / size);
    let b = beside * (1.0 / size);
    let facing = a.cross(b);
    let area = facing.length();
    if area <= 1e-12 {
        return ([Vec3::ZERO; 2], 0.0);
    }
    let normal = facing * (1.0 / area);
    let first = uvs[1] - uvs[0];
    let second = uvs[2] - uvs[0];
    let across = b.cross(normal);
    let down = normal.cross(a);
    let gradients = [across * first.x + down * second.x, across * first.y + down * second.y];
    (gradients.map(|gradient| gradient * size), area * size * size)
}

/// Returns the unit normal of a surface that is shaded with `normal` and whose height has this gradient (Mikkelsen
/// 2008, the surface gradient). The gradient points uphill in object space; its length is the slope.
///
/// It is the exact normal if the surface is displaced along `normal`.
pub(crate) fn raised_normal(gradient: Vec3, normal: Vec3) -> Vec3 {
    unit_or(normal - (gradient - normal * gradient.dot(normal)), normal)
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3, vec3};
    use proptest::prelude::*;

    use super::*;

    /// Returns a map of 4 x 2 px that rises by 1/8 for each px to the right and by 1/4 for each px down.
    fn slope() -> HeightMap {
        let heights = (0..8).map(|i| (i % 4) as f32 / 8.0 + (i / 4) as f32 / 4.0).collect();
        HeightMap::new([4, 2], heights)
    }

    #[test]
    fn images_that_do_not_repeat_continue_with_their_border() {
        let map = slope().with_wrap([Wrap::Clamp; 2]);
        for (u, expected) in [(-1.0, 0.0), (0.0, 0.0), (0.125, 0.0), (0.875, 0.375), (1.0, 0.375), (7.0, 0.375)] {
            assert_eq!(bilinear_height(&map, 0, vec2(u, 0.25)), expected, "{u}");
        }
        let between = bilinear_height(&map, 0, vec2(0.5, 0.5));
        assert_eq!(
            between,
            slope().heights[..8].iter().sum::<f32>() / 8.0,
            "repeating makes no difference inside the image"
        );
    }

    #[test]
    fn mirrored_images_run_back_beyond_their_border() {
        let (map, within) = (slope().with_wrap([Wrap::Mirror, Wrap::Repeat]), slope().with_wrap([Wrap::Clamp; 2]));
        for u in [0.0, 0.1, 0.45, 0.875, 1.0] {
            let expected = bilinear_height(&within, 0, vec2(u, 0.25));
            for other in [u, -u, 2.0 - u, 2.0 + u, -2.0 - u] {
                // Rows repeat.
                let height = bilinear_height(&map, 0, vec2(other, -2.75));
                assert!((height - expected).abs() < 1e-5, "{other}: {height}, not {expected}");
            }
        }
    }

    #[test]
    fn heights_at_pixel_centres_are_the_pixels_and_images_repeat() {
        let map = slope();
        for i in 0..8 {
            let uv = vec2(((i % 4) as f32 + 0.5) / 4.0, ((i / 4) as f32 + 0.5) / 2.0);
            for turn in [vec2(0.0, 0.0), vec2(3.0, -2.0)] {
                assert_eq!(bilinear_height(&map, 0, uv + turn), map.heights[i as usize], "px {i}");
            }
        }
        // Halfway between the last column and the first.
        assert_eq!(bilinear_height(&map, 0, vec2(0.0, 0.25)), (0.0 + 3.0 / 8.0) / 2.0);
        assert_eq!(bilinear_height(&map, 0, vec2(1.0, 0.25)), bilinear_height(&map, 0, vec2(0.0, 0.25)));
        assert_eq!(map.levels, 3);
        let last = *map.heights.last().expect("a last level");
        assert_eq!(height_at(&map, 2.0, vec2(0.3, 0.9)), last);
        let between = height_at(&map, 1.5, vec2(0.3, 0.9));
        let mean = 0.5 * (last + bilinear_height(&map, 1, vec2(0.3, 0.9)));
        assert!((between - mean).abs() < 1e-6);
    }

    #[test]
    fn slopes_are_those_of_the_image() {
        // The height rises by 1/8 for each of the 4 px across and by 1/4 for each of the 2 px down.
        let slopes = height_slopes(&slope(), 0.0, vec2(0.5, 0.5));
        assert!(slopes.distance(vec2(0.5, 0.5)) < 1e-6, "{slopes}");
    }

    #[test]
    fn a_px_of_the_level_is_as_long_as_a_segment() {
        let map = HeightMap::new([256, 256], vec![0.0; 65536]);
        assert_eq!(segment_level(&map, 256.0, 16.0), 4.0);
        assert_eq!(segment_level(&map, 256.0, 256.0), 0.0);
        assert_eq!(segment_level(&map, 16.0, 64.0), 0.0, "no finer than the image");
        assert_eq!(segment_level(&map, 1e9, 1.0), 8.0, "no coarser than one px");
        assert_eq!(segment_level(&map, 0.0, 1.0), 0.0, "no texture coordinates");
        assert_eq!(texel_length(&map, Vec2::ZERO, vec2(0.5, 0.0)), 128.0);
    }

    #[test]
    fn degenerate_triangles_have_no_gradient() {
        let uvs = [Vec2::ZERO, Vec2::X, Vec2::Y];
        for corners in [[Vec3::ZERO; 3], [Vec3::ZERO, Vec3::X, Vec3::X * 2.0]] {
            assert_eq!(uv_gradients(corners, uvs), ([Vec3::ZERO; 2], 0.0));
        }
        assert_eq!(raised_normal(Vec3::ZERO, Vec3::Y), Vec3::Y);
    }

    #[test]
    fn texel_lengths_count_px_of_the_width_and_of_the_height() {
        let map = HeightMap::new([64, 32], vec![0.0; 2048]);
        assert_eq!(texel_length(&map, vec2(0.5, 0.25), vec2(0.5 + 3.0 / 64.0, 0.25 + 4.0 / 32.0)), 5.0);
    }

    proptest! {
        #[test]
        fn raised_normals_are_the_normals_of_displaced_triangles(
            (ux, uy, uz) in (0.3f64..2.0, -1f64..1.0, -1f64..1.0),
            (vx, vy, vz) in (-0.2f64..0.2, 0.3f64..2.0, -1f64..1.0),
            slopes in prop::array::uniform2(-2f64..2.0),
            size in prop::sample::select(vec![1e-15, 1.0, 1e12]),
        ) {
            // The height changes by `slopes` over the whole width and height of the texture.
            let corners = [DVec3::ZERO, DVec3::new(ux, uy, uz), DVec3::new(vx, vy, vz)].map(|corner| corner * size);
            let uvs = [DVec2::new(0.1, 0.2), DVec2::new(0.9, 0.3), DVec2::new(0.2, 0.7)];
            let normal = corners[1].cross(corners[2]).normalize();
            let height = |uv: DVec2| uv.dot(DVec2::from(slopes)) * size;
            let raised = [0, 1, 2].map(|k| corners[k] + normal * height(uvs[k]));
            let expected = (raised[1] - raised[0]).cross(raised[2] - raised[0]).normalize();
            let (gradients, area) = uv_gradients(corners.map(|corner| corner.as_vec3()), uvs.map(|uv| uv.as_vec2()));
            let uphill = (gradients[0] * slopes[0] as f32 + gradients[1] * slopes[1] as f32) * (size as f32 / area);
            let own = raised_normal(uphill, normal.as_vec3());
            prop_assert!(own.as_dvec3().distance(expected) < 1e-4, "{} {}", own, expected);
        }

        #[test]
        fn direction_slopes_are_the_derivatives_of_the_interpolated_direction(x in 0.1f32..0.8, share in 0.1f32..0.9) {
            let y = (1.0 - x) * share;
            let corners = [vec3(0.6, 0.0, 0.8), vec3(0.0, 0.6, 0.8), vec3(-0.48, -0.36, 0.8)];
            let sum = |x: f32, y: f32| corners[0] * x + corners[1] * y + corners[2] * (1.0 - x - y);
            let at = |x: f32, y: f32| sum(x, y).as_dvec3().normalize();
            let slopes = direction_slopes(corners, sum(x, y).normalize(), sum(x, y).length());
            let step = 1e-3;
            let along_u = (at(x + step, y) - at(x - step, y)) / f64::from(2.0 * step);
            let along_v = (at(x, y + step) - at(x, y - step)) / f64::from(2.0 * step);
            for (own, expected) in slopes.into_iter().zip([along_u, along_v]) {
                prop_assert!(own.as_dvec3().distance(expected) < 1e-3, "{} {}", own, expected);
            }
        }
    }
}

//! Displacement: how high a surface stands at a texture coordinate, and how it is shaded there. Twin:
//! `shaders/displace.wgsl`.
//!
//! A point moves by scale * (height - midlevel) along a direction that all its sides share. Heights are sampled without the
//! device's texture unit, whose filters weigh in 8 bits: so they are the same numbers everywhere.

use glam::{Vec2, Vec3, vec2};

use super::normal::unit_or;
use crate::mesh::HeightMap;

/// Whether a surface is displaced by height images, and what its patches agree on where they meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum Displacement {
    /// The surface as it is.
    Off = 0,
    /// Displaced without cracks: one side's texture coordinates for an edge and one corner's for a point (dominant edges and
    /// vertices, McDonald 2011), and along one direction, the mean of all normals that meet there.
    On = 1,
    /// Dominant edges and vertices alone (McDonald 2011), each patch along its own normals: texture seams hold, split normals
    /// tear.
    AsPublished = 2,
    /// Every patch by its own texture coordinates and normals: seams and split normals tear.
    PerPatch = 3,
}

/// A number's place in a repeating whole, 0 to 1.
fn wrapped(x: f32) -> f32 {
    x - x.floor()
}

/// Where a level starts in a map's list.
fn level_start(map: &HeightMap, level: u32) -> u32 {
    let mut start = 0;
    for l in 0..level {
        start += (map.size[0] >> l).max(1) * (map.size[1] >> l).max(1);
    }
    start
}

fn fetch_height(map: &HeightMap, index: u32) -> f32 {
    map.heights[index as usize]
}

/// Where a texture coordinate lies along one side of `size` px: after the middle of px 0, in px.
fn pixel_place(map: &HeightMap, x: f32, size: u32) -> f32 {
    if map.repeats {
        return wrapped(x) * size as f32 + size as f32 - 0.5;
    }
    (x * size as f32 - 0.5).clamp(0.0, (size - 1) as f32)
}

/// A level's height at a texture coordinate, between its four nearest px.
pub fn bilinear_height(map: &HeightMap, level: u32, uv: Vec2) -> f32 {
    let width = (map.size[0] >> level).max(1);
    let height = (map.size[1] >> level).max(1);
    let x = pixel_place(map, uv.x, width);
    let y = pixel_place(map, uv.y, height);
    let left = x as u32 % width;
    let upper = y as u32 % height;
    // Beyond the last px of an image that ends there nothing is asked for.
    let right = (left + 1) % width;
    let lower = (upper + 1) % height;
    let start = level_start(map, level);
    let a = fetch_height(map, start + upper * width + left);
    let b = fetch_height(map, start + upper * width + right);
    let c = fetch_height(map, start + lower * width + left);
    let d = fetch_height(map, start + lower * width + right);
    let across = x - x.floor();
    let down = y - y.floor();
    let above = a + (b - a) * across;
    let below = c + (d - c) * across;
    above + (below - above) * down
}

/// The height at a texture coordinate and a level that may lie between two.
pub fn height_at(map: &HeightMap, level: f32, uv: Vec2) -> f32 {
    let least = level as u32;
    let part = level - least as f32;
    let fine = bilinear_height(map, least, uv);
    if part <= 0.0 {
        return fine;
    }
    fine + (bilinear_height(map, least + 1, uv) - fine) * part
}

/// How the height changes with both texture coordinates, over one px of the level.
pub fn height_slopes(map: &HeightMap, level: f32, uv: Vec2) -> Vec2 {
    let px = level.exp2() / vec2(map.size[0] as f32, map.size[1] as f32);
    let across = vec2(0.5 * px.x, 0.0);
    let down = vec2(0.0, 0.5 * px.y);
    let along_x = height_at(map, level, uv + across) - height_at(map, level, uv - across);
    let along_y = height_at(map, level, uv + down) - height_at(map, level, uv - down);
    vec2(along_x / px.x, along_y / px.y)
}

/// The level whose px are as long as a segment, of something `texels` px of level 0 long that is cut into `segments`.
pub fn segment_level(map: &HeightMap, texels: f32, segments: f32) -> f32 {
    let level = (texels.max(1e-6) / segments).log2();
    level.clamp(0.0, (map.levels - 1) as f32)
}

/// How long a line between two texture coordinates is, in px of level 0.
pub fn texel_length(map: &HeightMap, a: Vec2, b: Vec2) -> f32 {
    ((b - a) * vec2(map.size[0] as f32, map.size[1] as f32)).length()
}

/// How a direction between three turns with u and with v: the change of (a u + b v + c w) at unit length. `direction` is
/// what it is here.
pub fn direction_slopes(directions: [Vec3; 3], direction: Vec3, length: f32) -> [Vec3; 2] {
    let along_u = directions[0] - directions[2];
    let along_v = directions[1] - directions[2];
    if length <= 1e-6 {
        return [Vec3::ZERO; 2];
    }
    let flat_u = along_u - direction * direction.dot(along_u);
    let flat_v = along_v - direction * direction.dot(along_v);
    [flat_u * (1.0 / length), flat_v * (1.0 / length)]
}

/// How both texture coordinates change over a flat triangle: two vectors in its plane, in texture widths and heights a unit,
/// each times twice the triangle's area; and that area. Zero where there is no triangle.
pub fn uv_gradients(corners: [Vec3; 3], uvs: [Vec2; 3]) -> ([Vec3; 2], f32) {
    let along = corners[1] - corners[0];
    let beside = corners[2] - corners[0];
    let size = along.abs().max(beside.abs()).max_element();
    if size == 0.0 {
        return ([Vec3::ZERO; 2], 0.0);
    }
    // Areas of very small or large lengths are none: only proportions matter.
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

/// The normal of what is shaded with `normal` and rises by `gradient`, a vector that points uphill and is as long as the
/// slope: exact if it rises along its normal (Mikkelsen 2008, the surface gradient).
pub fn raised_normal(gradient: Vec3, normal: Vec3) -> Vec3 {
    unit_or(normal - (gradient - normal * gradient.dot(normal)), normal)
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3, vec3};
    use proptest::prelude::*;

    use super::*;

    /// A slope across, times two down.
    fn slope() -> HeightMap {
        let heights = (0..8).map(|i| (i % 4) as f32 / 8.0 + (i / 4) as f32 / 4.0).collect();
        HeightMap { repeats: true, ..HeightMap::new([4, 2], heights) }
    }

    #[test]
    fn images_that_do_not_repeat_go_on_as_their_border_is() {
        let map = HeightMap { repeats: false, ..slope() };
        for (u, expected) in [(-1.0, 0.0), (0.0, 0.0), (0.125, 0.0), (0.875, 0.375), (1.0, 0.375), (7.0, 0.375)] {
            assert_eq!(bilinear_height(&map, 0, vec2(u, 0.25)), expected, "{u}");
        }
        let between = bilinear_height(&map, 0, vec2(0.5, 0.5));
        assert_eq!(between, slope().heights[..8].iter().sum::<f32>() / 8.0, "inside it makes no difference");
    }

    #[test]
    fn pixels_are_at_their_centres_and_images_repeat() {
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
        // Inside the image, 1/8 a px across, which is 4 to the whole width, and 1/4 a px down of 2.
        let slopes = height_slopes(&slope(), 0.0, vec2(0.5, 0.5));
        assert!(slopes.distance(vec2(0.5, 0.5)) < 1e-6, "{slopes}");
    }

    #[test]
    fn levels_follow_the_segments() {
        let map = HeightMap::new([256, 256], vec![0.0; 65536]);
        assert_eq!(segment_level(&map, 256.0, 16.0), 4.0);
        assert_eq!(segment_level(&map, 256.0, 256.0), 0.0);
        assert_eq!(segment_level(&map, 16.0, 64.0), 0.0, "no finer than the image");
        assert_eq!(segment_level(&map, 1e9, 1.0), 8.0, "no coarser than one px");
        assert_eq!(segment_level(&map, 0.0, 1.0), 0.0, "no texture coordinates");
        assert_eq!(texel_length(&map, Vec2::ZERO, vec2(0.5, 0.0)), 128.0);
    }

    #[test]
    fn a_line_has_no_gradient() {
        let uvs = [Vec2::ZERO, Vec2::X, Vec2::Y];
        for corners in [[Vec3::ZERO; 3], [Vec3::ZERO, Vec3::X, Vec3::X * 2.0]] {
            assert_eq!(uv_gradients(corners, uvs), ([Vec3::ZERO; 2], 0.0));
        }
        assert_eq!(raised_normal(Vec3::ZERO, Vec3::Y), Vec3::Y);
    }

    proptest! {
        #[test]
        fn raised_normals_are_those_of_the_raised_triangle(
            (ux, uy, uz) in (0.3f64..2.0, -1f64..1.0, -1f64..1.0),
            (vx, vy, vz) in (-0.2f64..0.2, 0.3f64..2.0, -1f64..1.0),
            slopes in prop::array::uniform2(-2f64..2.0),
            size in prop::sample::select(vec![1e-15, 1.0, 1e12]),
        ) {
            // A triangle with its own texture coordinates, over which a height changes by `slopes` a texture.
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
        fn directions_turn_as_their_interpolation_does(x in 0.1f32..0.8, share in 0.1f32..0.9) {
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

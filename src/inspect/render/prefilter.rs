//! Blurs an environment as rough surfaces do: twin of `shaders/prefilter.wgsl`.

use std::f32::consts::PI;

use glam::{Vec2, Vec3, Vec4, vec2, vec3, vec4};

/// A direction on a face of a cube map; `at` is -1 to 1 along the face's axes (WebGPU, section on cube maps).
pub(crate) fn cube_direction(face: u32, at: Vec2) -> Vec3 {
    match face {
        0 => vec3(1.0, -at.y, -at.x),
        1 => vec3(-1.0, -at.y, at.x),
        2 => vec3(at.x, 1.0, at.y),
        3 => vec3(at.x, -1.0, -at.y),
        4 => vec3(at.x, -at.y, 1.0),
        _ => vec3(-at.x, -at.y, -1.0),
    }
}

/// Point `index` of `count` of Hammersley's set in the unit square.
pub(crate) fn hammersley(index: u32, count: u32) -> Vec2 {
    vec2(index as f32 / count as f32, (index.reverse_bits() >> 8) as f32 / 16_777_216.0)
}

/// Two directions that are orthogonal to a unit vector and to each other (Duff et al. 2017, listing 3).
pub fn directions_across(normal: Vec3) -> [Vec3; 2] {
    let side = if normal.z >= 0.0 { 1.0 } else { -1.0 };
    let a = -1.0 / (side + normal.z);
    let b = normal.x * normal.y * a;
    [
        vec3(1.0 + side * normal.x * normal.x * a, side * b, -side * normal.x),
        vec3(b, side + normal.y * normal.y * a, -normal.y),
    ]
}

/// A light's direction seen along the normal (z) of a GGX surface, by way of its microfacets (Walter et al. 2007, equations 35
/// and 36), and the square root of its density times 4 (w).
pub fn light_and_density(point: Vec2, alpha: f32) -> Vec4 {
    let square = alpha * alpha;
    let cosine_squared = (1.0 - point.x) / (1.0 + (square - 1.0) * point.x);
    let sine_squared = square * point.x / (1.0 + (square - 1.0) * point.x);
    let angle = 2.0 * PI * point.y;
    let along = 2.0 * (cosine_squared * sine_squared).sqrt();
    let spread = cosine_squared * square + sine_squared;
    vec4(along * angle.cos(), along * angle.sin(), cosine_squared - sine_squared, alpha / (PI.sqrt() * spread))
}

/// The level of the source whose texels are as large as a sample of that density, times 2 (Krivanek and Colbert 2008, section
/// 3). `size` is the size of a face, in texels.
pub fn sample_level(root_density: f32, count: u32, size: f32) -> f32 {
    let texels = (24.0 / PI).sqrt() * size / (root_density * (count as f32).sqrt());
    texels.log2().max(0.0)
}

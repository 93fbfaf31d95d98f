//! Directions that an environment is blurred in: functions of `shaders/prefilter.wgsl`. Only tests need the others.

use glam::{Vec2, Vec3, vec2, vec3};

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

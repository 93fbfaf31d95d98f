//! Light from all around as matte surfaces gather it: `shaders/pass_prefilter.wgsl` adds up what it is divided into.

use std::f32::consts::PI;

use bytemuck::{Pod, Zeroable};
use glam::{Vec3, Vec4};

/// How many cells a cube around all directions has along each axis. Its sides meet 1,352 of them.
const CELLS: usize = 16;

/// Twin of `LightPart` in `shaders/pass_prefilter.wgsl`. The fourth components are unused.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub struct LightPart {
    pub direction: Vec4,
    pub light: Vec4,
}

/// Joins lights (unit direction, solid angle in sr, and linear RGB) whose directions lie in one cell. Of grey light, this changes
/// only what surfaces get whose horizon crosses the cell: even a bright sun stays where it is, as directions count by their light.
pub fn light_parts(lights: impl Iterator<Item = (Vec3, f32, Vec3)>) -> Vec<LightPart> {
    let mut cells = vec![LightPart::default(); CELLS * CELLS * CELLS];
    for (direction, solid_angle, light) in lights {
        let place = (direction / direction.abs().max_element() + 1.0) * (0.5 * CELLS as f32);
        let [x, y, z] = place.to_array().map(|along| (along as usize).min(CELLS - 1));
        let (part, light) = (&mut cells[(z * CELLS + y) * CELLS + x], light.min(Vec3::MAX) * (solid_angle / PI));
        part.light += light.extend(0.0);
        part.direction += direction.extend(0.0) * light.element_sum();
    }
    let mut parts: Vec<_> = cells.into_iter().filter(|part| part.light != Vec4::ZERO).collect();
    parts.iter_mut().for_each(|part| part.direction /= part.light.element_sum());
    // A buffer can't be empty.
    parts.push(LightPart::default());
    parts
}

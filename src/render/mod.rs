//! Draws pictures of a scene on the device, as a camera sees it, with one indirect draw per material into an offscreen texture.

pub(crate) mod camera;
mod coverage;
mod deviation;
mod frame;
mod framing;
pub(crate) mod layout;
mod leaks;
mod marks;
mod materials;
mod pick;
mod pipelines;
mod renderer;
mod scale;
pub(crate) mod scene;
#[cfg(test)]
mod shader_tests;
mod steps;
pub(crate) mod target;

pub(crate) use camera::{Camera, Standpoint};
pub(crate) use deviation::{DEVIATION_PX_SCALE, deviation_scale};
pub(crate) use leaks::LeakCounter;
pub(crate) use marks::{crack_lines, crack_lines_in, patch_lines, t_junction_lines, worst_lines};
pub(crate) use pick::{Picked, PickedTriangle, Picker, Picking, Pixel};
pub(crate) use renderer::Renderer;
pub(crate) use scale::{EXCESS_SCALE, FACTOR_SCALE, SIZE_SCALE, Scale};
pub(crate) use scene::{LineSegment, Scene};
pub(crate) use target::Target;
#[cfg(test)]
pub(crate) use target::samples;

/// The shader files with entry points for drawing and picking. Each makes one shader module.
#[cfg(test)]
static MODULES: [&crate::gpu::WgslFile; 6] = [
    &coverage::PASS_COVERAGE,
    &leaks::DRAW_LEAKS,
    &pick::DRAW_PICK,
    &pipelines::DRAW_LINES,
    &pipelines::DRAW_PLAIN,
    &pipelines::DRAW_SURFACE,
];

//! Draws pictures of a scene on the device, as a camera sees it, with one indirect draw per material into an offscreen texture.

mod camera;
mod coverage;
mod deviation;
mod frame;
mod framing;
pub mod layout;
mod leaks;
mod marks;
mod materials;
mod pick;
mod pipelines;
mod renderer;
mod scale;
mod scene;
#[cfg(test)]
mod shader_tests;
mod steps;
mod target;

pub use camera::{Camera, Standpoint};
pub use deviation::{DEVIATION_PX_SCALE, deviation_scale};
pub use leaks::LeakCounter;
pub use marks::{crack_lines, crack_lines_in, patch_lines, t_junction_lines, worst_lines};
pub use materials::Materials;
pub use pick::{Picked, PickedTriangle, Picker, Picking, Pixel};
pub use renderer::Renderer;
pub use scale::{FACTOR_SCALE, SIZE_SCALE, Scale};
pub use scene::{LineSegment, Scene};
pub use target::{Target, samples};

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

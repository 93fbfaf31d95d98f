//! Draws pictures of a scene on the device, as a camera sees it, with one indirect draw per material into an offscreen texture.

mod adding_pipeline;
pub mod blur_levels;
pub mod camera;
mod coverage;
mod covered_area;
pub mod cube_map;
mod deviation;
pub mod dfg;
mod draw_states;
mod draws;
mod engine_view;
pub mod environment;
mod file_view;
mod frame;
mod framing;
mod ground;
pub mod irradiance;
mod layers;
pub mod layout;
mod leaks;
mod legend;
#[cfg(test)]
mod light_tests;
mod look;
mod marks;
pub mod matcap;
mod materials;
pub(crate) mod mipmap_pass;
mod needs;
mod outlines_picture;
mod pick;
mod pipelines;
pub mod prefilter;
pub(crate) mod prefilter_pass;
pub mod punctual;
pub mod reflectance;
pub mod renderer;
mod scale;
pub mod scene;
#[cfg(test)]
mod shader_tests;
pub mod sheen;
mod silhouette;
mod steps;
pub mod studio;
mod surface_draws;
pub mod target;
mod textures;
pub mod tone;
pub mod view_projection;
mod window;

pub use camera::{Camera, Standpoint};
pub use deviation::{DEVIATION_PX_SCALE, deviation_scale};
pub use ground::{Ground, axis_lines};
pub(crate) use leaks::LeakCounter;
pub use leaks::{Leak, LeakCount, Leaks, leaks_in};
pub(crate) use legend::{COLUMNS, Shown, tick_text};
pub use legend::{Distances, Legend, has_legend, legend_of};
pub use marks::{crack_lines, crack_lines_in, lod_camera_lines, patch_lines, t_junction_lines, worst_lines};
pub use outlines_picture::{lay_over, outlines_picture};
pub use pick::{Picked, PickedTriangle, Picker, Picking, Pixel};
pub use renderer::{DraftPipelines, Renderer};
pub(crate) use scale::SIZE_SCALE;
pub use scale::{DENSITY_SCALE, EXCESS_SCALE, FACTOR_SCALE, Scale, curvature_scale};
pub use scene::{LineSegment, Scene};
pub(crate) use silhouette::{SilhouetteCoverage, SilhouetteDrawer, padded_clip};
pub use target::{Target, samples};
pub use window::WindowPipelines;

#[cfg(test)]
/// The shader files with entry points for drawing and picking, and the light that draws read. Each makes one shader module.
static MODULES: [&gpu::WgslFile; 17] = [
    &coverage::PASS_COVERAGE,
    &environment::ENVIRONMENT,
    &leaks::DRAW_LEAKS,
    &mipmap_pass::PASS_MIPMAP,
    &pick::DRAW_PICK,
    &pipelines::DRAW_BACKGROUND,
    &pipelines::DRAW_CLEAR,
    &pipelines::DRAW_GROUND,
    &pipelines::DRAW_LINES,
    &pipelines::DRAW_LIT,
    &pipelines::DRAW_PLAIN,
    &pipelines::DRAW_SURFACE,
    &pipelines::LAYERS_MULTISAMPLED,
    &pipelines::LAYERS_SINGLE,
    &prefilter_pass::PASS_PREFILTER,
    &silhouette::DRAW_SILHOUETTE,
    &window::DRAW_WINDOW,
];

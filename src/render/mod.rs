//! Draws pictures of a scene on the device, as a camera sees it, with one indirect draw per material into an offscreen texture.

mod adding_pipeline;
pub(crate) mod blur_levels;
pub(crate) mod camera;
mod coverage;
mod covered_area;
pub(crate) mod cube_map;
mod deviation;
pub(crate) mod dfg;
mod draw_states;
mod draws;
mod engine_view;
pub(crate) mod environment;
mod file_view;
mod frame;
mod framing;
mod ground;
pub(crate) mod irradiance;
mod layers;
pub(crate) mod layout;
mod leaks;
mod legend;
#[cfg(test)]
mod light_tests;
mod look;
mod marks;
pub(crate) mod matcap;
mod materials;
pub(crate) mod mipmap_pass;
mod needs;
mod outlines_picture;
mod pick;
mod pipelines;
pub(crate) mod prefilter;
pub(crate) mod prefilter_pass;
pub(crate) mod punctual;
#[cfg(test)]
pub(crate) mod reflectance;
pub(crate) mod renderer;
mod scale;
pub(crate) mod scene;
#[cfg(test)]
mod shader_tests;
pub(crate) mod sheen;
mod silhouette;
mod steps;
pub(crate) mod studio;
mod surface_draws;
pub(crate) mod target;
mod textures;
pub(crate) mod tone;
pub(crate) mod view_projection;
#[cfg(feature = "app")]
mod window;

pub(crate) use camera::{Camera, Standpoint};
pub(crate) use deviation::{DEVIATION_PX_SCALE, deviation_scale};
pub(crate) use ground::{Ground, axis_lines};
pub(crate) use leaks::{Leak, LeakCount, LeakCounter, Leaks, leaks_in};
pub(crate) use legend::{BARYCENTRIC_TITLE, COLUMNS, Distances, Shown, has_legend, legend_of, tick_text};
pub(crate) use marks::{crack_lines, crack_lines_in, lod_camera_lines, patch_lines, t_junction_lines, worst_lines};
pub(crate) use outlines_picture::{lay_over, outlines_picture};
pub(crate) use pick::{Picked, PickedTriangle, Picker, Picking, Pixel};
pub(crate) use renderer::{DraftPipelines, Renderer};
pub(crate) use scale::{DENSITY_SCALE, EXCESS_SCALE, FACTOR_SCALE, SIZE_SCALE, Scale, curvature_scale};
pub(crate) use scene::{LineSegment, Scene};
pub(crate) use silhouette::{SilhouetteCoverage, SilhouetteDrawer, padded_clip};
pub(crate) use target::Target;
#[cfg(test)]
pub(crate) use target::samples;
#[cfg(feature = "app")]
pub(crate) use window::WindowPipelines;

/// The shader files with entry points for drawing and picking, and the light that draws read. Each makes one shader module.
#[cfg(test)]
static MODULES: [&crate::gpu::WgslFile; 17] = [
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
    #[cfg(feature = "app")]
    &window::DRAW_WINDOW,
];

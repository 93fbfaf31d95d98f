//! Draws pictures of a scene on the device, as a camera sees it, with one indirect draw per material into an offscreen texture.

mod adding;
pub mod blur_levels;
pub mod camera;
mod coverage;
mod covered_area;
pub mod cube_map;
mod deviation;
pub mod dfg;
mod difference;
mod draws;
pub mod environment;
mod file_view;
mod frame;
mod framing;
mod ground;
mod group_layouts;
mod halves;
pub mod irradiance;
mod layers;
pub mod layout;
mod leaks;
mod legend;
#[cfg(test)]
mod light_tests;
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
mod render_pipeline;
pub mod renderer;
mod scale;
pub mod scene;
pub mod section;
#[cfg(test)]
mod shader_tests;
pub mod sheen;
mod silhouette;
mod steps;
pub mod studio;
mod surface_draws;
pub mod target;
mod textures;
mod usual;
pub mod view_projection;
mod window;

pub(crate) use adding::Added;
pub use camera::{Camera, Standpoint};
pub use deviation::{DEVIATION_PX_SCALE, deviation_scale};
pub use ground::{Ground, axis_lines};
pub use halves::{HalfPlace, framed_size, half_at, half_places};
pub use leaks::{Leak, LeakCount, LeakCounter, Leaks, leaks_in};
pub use legend::{Distances, Legend, legend_of, legend_side};
pub(crate) use legend::{Shown, tick_text};
pub use marks::{
    bone_lines, crack_lines, crack_lines_in, lod_camera_lines, outlined, patch_lines, t_junction_lines, worst_lines,
};
pub use outlines_picture::{lay_over, outlines_picture};
pub use pick::{Picked, PickedTriangle, Picker, Picking, Pixel};
pub use renderer::{DraftPipelines, Renderer};
pub use scale::{DENSITY_SCALE, EXCESS_SCALE, FACTOR_SCALE, Scale};
pub use scene::{LeftPose, LineSegment, Scene};
pub(crate) use silhouette::{SilhouetteDrawer, channel, padded_clip};
pub use target::{Target, samples};
pub use usual::{Usual, texel_density};
pub use window::WindowPipelines;

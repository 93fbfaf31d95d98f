//! Pictures: a camera, a scene on the device, and one indirect draw a material into an offscreen texture.

mod camera;
mod coverage;
mod deviation;
mod frame;
mod framing;
pub mod layout;
mod leaks;
mod marks;
mod pick;
mod pipelines;
mod renderer;
mod scale;
mod scene;
mod steps;
mod target;

pub use camera::{Camera, Standpoint};
pub use coverage::Sieve;
pub use deviation::{DEVIATION_PX_SCALE, deviation_scale};
pub use leaks::LeakCounter;
pub use marks::{crack_lines, crack_lines_in, patch_lines, t_junction_lines, worst_lines};
pub use pick::{Picked, PickedTriangle, Picker, Picking, Pixel};
pub use renderer::Renderer;
pub use scale::{FACTOR_SCALE, SIZE_SCALE, Scale};
pub use scene::{LineSegment, Scene};
pub use target::Target;

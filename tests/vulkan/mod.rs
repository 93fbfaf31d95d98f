//! Vulkan as it is, for what wgpu has none of: tessellation stages. The bench draws our patches with them, and tests run exported
//! shaders on them.

pub mod agreement;
pub mod bindings;
pub mod device;
pub mod exported;
pub mod height_image;
pub mod levels;
pub mod memory;
pub mod pass;
pub mod stages;

pub use device::{Counted, Took, Vulkan, VulkanError};

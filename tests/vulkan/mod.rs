//! Vulkan as it is, for what wgpu has none of: tessellation stages. The bench draws our patches with them, and tests run exported
//! shaders on them.
#![allow(
    unsafe_code,
    clippy::undocumented_unsafe_blocks,
    reason = "every call of Vulkan is; handles live as long as their owner"
)]

pub(crate) mod agreement;
pub(crate) mod bindings;
pub(crate) mod device;
pub(crate) mod exported;
pub(crate) mod height_image;
pub(crate) mod levels;
pub(crate) mod memory;
pub(crate) mod pass;
#[allow(dead_code, reason = "tests compare patterns, and benches don't")]
pub(crate) mod patterns;
pub(crate) mod stages;

pub(crate) use device::{Counted, Took, Vulkan, VulkanError};

//! Meshes, and their tessellation on the CPU: the reference that the passes of the GPU follow.

pub mod casts;
pub mod choice;
pub mod cores;
pub mod defaults;
pub mod groups;
pub mod mesh;
pub mod names;
pub mod near;
pub mod numbers;
pub mod progress;
mod surface_kind;
pub mod tessellate;
pub mod view;

//! The mathematics of [`crate::tessellate`] as compute passes.
//!
//! 1. When the pose changes: deform.
//! 2. When the mesh, its pose or the kind of surface changes: nets (and directions, if it has heights).
//! 3. When settings or the view change: factors (and levels, if displaced), counts, scan, chunks.
//! 4. For every chunk of patches that fits the arena: emit (and displace), and then whatever uses the chunk: a draw, a readback.
//!
//! Pipelines are made when they are first needed, so recording a pass may fail.

mod adapters;
mod arena;
mod bound_pass;
mod buffer;
mod device;
pub(crate) mod domain;
mod error;
mod hull;
pub mod layout;
mod lazy;
mod mesh_buffers;
mod mesh_passes;
mod params;
mod pipelines;
mod readback;
mod recorder;
pub(crate) mod relief_buffers;
mod rig;
mod slab;
mod tessellator;
pub(crate) mod wgsl;

pub use adapters::{AdapterChoice, BACKENDS, adapters, best_adapter, kind};
pub use arena::{VERTEX_HALF, vertices_of};
pub use bound_pass::BoundPass;
pub use buffer::{empty, uniform_buffer};
pub use device::{Gpu, device_descriptor};
pub use domain::{DomainParams, DomainPass, DomainPattern};
pub use error::GpuError;
pub use lazy::Lazy;
pub use mesh_buffers::MeshBuffers;
pub use pipelines::{ComputePipeline, ComputePipelines, GRID_WIDTH, ShaderModule, WORKGROUP, bind_group, grid};
pub use readback::{Readback, read_buffer, read_buffers, read_texture};
pub use recorder::{DRAWING, PASSES, PassTime, RecordPasses, Recorder, Timing, take_times};
pub use tessellator::{ChunkBuffers, Tessellator};
pub use wgsl::WgslFile;

/// The files with the entry points of the passes: one shader module each.
#[cfg(test)]
pub(crate) static MODULES: [&WgslFile; 10] = [
    &pipelines::PASS_DEFORM,
    &pipelines::PASS_NETS,
    &pipelines::PASS_FACTORS,
    &pipelines::PASS_LEVELS,
    &pipelines::PASS_COUNTS,
    &pipelines::PASS_SCAN,
    &pipelines::PASS_CHUNKS,
    &pipelines::PASS_EMIT,
    &pipelines::PASS_DISPLACE,
    &domain::PASS_DOMAIN,
];

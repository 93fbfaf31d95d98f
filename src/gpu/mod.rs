//! The mathematics of [`crate::tessellate`] as compute passes.
//!
//! Once a pose: deform. Once a mesh, pose and surface: nets. When settings or view change: factors, counts, scan, chunks. Then, for every chunk of
//! patches that fits the arena: emit, and whatever is done with it (a draw, a readback).

mod adapters;
mod arena;
mod buffers;
mod counts;
mod device;
mod domain;
mod error;
mod hull;
pub mod layout;
mod params;
mod pipelines;
mod recorder;
mod relief;
mod rig;
mod slab;
mod tessellator;

pub use adapters::{AdapterChoice, BACKENDS, adapters, best_adapter, kind};
pub use arena::{VERTEX_HALF, vertices_of};
pub use buffers::{MeshBuffers, empty};
pub use device::{COLOR_FORMAT, DEPTH_FORMAT, Gpu, device_descriptor};
pub use domain::{DomainParams, DomainPass, DomainPattern};
pub use error::GpuError;
pub use pipelines::{
    ComputePipelines, SHADERS, bind_group, compute_pipeline, dispatch, grid, shader_module, shader_source,
};
pub use recorder::{
    DRAWING, PASSES, PassTime, Recorder, Timing, mapped_bytes, read_buffer, read_staging, staging_buffer, take_times,
    wait,
};
pub use slab::uniform_buffer;
pub use tessellator::{ChunkBuffers, Tessellator};

//! The mathematics of [`geometry::tessellate`] as compute passes.
//!
//! 1. When the pose changes: deform.
//! 2. When the mesh, its pose or the kind of surface changes: nets (and directions, if it has heights).
//! 3. When settings or the view change: factors (and levels, if displaced), counts, scan, chunks.
//! 4. For every chunk of patches that fits the arena: emit (and displace), and then whatever uses the chunk: a draw, a readback.
//!
//! Pipelines are made when they are first needed, so recording a pass may fail.

pub mod adapters;
mod arena;
mod buffer;
mod compute_pipeline;
pub mod device;
pub mod domain;
pub mod embed;
mod error;
pub mod layout;
mod lazy;
mod mesh_buffers;
mod minimum;
mod params;
mod pass_inputs;
mod pipelines;
pub mod readback;
pub mod recorder;
mod relief_buffers;
mod rig;
mod search_passes;
pub mod shader_constants;
mod slab;
mod tessellator;
pub mod user_functions;
pub mod user_lod;
pub mod user_surface;
pub mod wgsl;
pub mod wgsl_tokens;

pub use adapters::{AdapterChoice, BACKENDS, adapters, best_adapter, driver, identity, kind};
pub use arena::{VERTEX_HALF, chunks_an_arena, put_together};
pub use buffer::{bytes_of, empty, filled_texture, flat_texture, uniform_buffer, whole};
pub use compute_pipeline::{BoundPass, ComputePipeline, ShaderModule, ShaderModules};
pub use device::{Gpu, device_descriptor};
pub use domain::{DomainParams, DomainPass, DomainPattern};
pub use error::GpuError;
pub use lazy::{Lazy, made_once};
pub(crate) use mesh_buffers::MeshBuffers;
pub use mesh_buffers::{CURVE_SURFACE_STEP, DETAIL_STEP, SEARCH_COUNTERS, TEXTURED};
pub use pipelines::{ComputePipelines, GRID_WIDTH, MANY_PATCHES, MOST_WORKGROUPS, WORKGROUP, bind_group, grid};
pub use readback::{Readback, read_buffer, read_buffers, read_texture};
pub use recorder::{DRAWING, PASSES, PassTime, RecordPasses, Recorder, Timing, ms_of, submit_untimed, take_times};
pub use tessellator::{ChunkBuffers, Tessellator};
pub use user_functions::{UserPipelines, UserReport, UserShader};
pub use user_lod::{Given, LodShader};
pub use user_surface::SurfaceShader;
pub use wgsl::WgslModule;

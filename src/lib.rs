//! pnaen tessellates meshes on the GPU, with PN-AEN triangles and their relatives, in compute passes that follow the
//! Direct3D 11 tessellator. The program of the same name shows what the tessellation did.
//!
//! As a library it serves programs that have a wgpu device of their own. [`embed`] tessellates a mesh into vertex and index
//! buffers that the host draws. [`mesh::Mesh::from_slices`] makes a mesh from arrays; with the feature `formats`,
//! `load::load` reads one from a file. [`tessellate::tessellate`] does the same as the passes on the CPU.
//!
//! ```
//! use pnaen::mesh::{Mesh, MeshSlices, Topology};
//! use pnaen::tessellate::{Inputs, LodView, Tessellation, tessellate};
//!
//! // A flat square of two triangles whose normals lean apart, so that the surface between them is curved.
//! let mesh = Mesh::from_slices(&MeshSlices {
//!     positions: &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
//!     normals: &[[-1.0, -1.0, 2.0], [1.0, -1.0, 2.0], [1.0, 1.0, 2.0], [-1.0, 1.0, 2.0]],
//!     indices: &[0, 1, 2, 0, 2, 3],
//!     ..Default::default()
//! })?;
//! let inputs = Inputs::new(&Tessellation { factor: 8.0, ..Default::default() }, LodView::default());
//! let made = tessellate(&mesh, &Topology::new(&mesh), &inputs, None);
//! let highest = made.vertices.iter().map(|vertex| vertex.position[2]).fold(0.0, f32::max);
//! assert!(highest > 0.1, "the surface rises above its corners");
//! # Ok::<(), pnaen::mesh::SliceError>(())
//! ```
//!
//! Those who read the crate's code can go through it in this order: [`mesh`] (triangles, and how they are connected),
//! [`tessellate`] (the mathematics on the CPU: the reference), `gpu` (the same mathematics as compute passes), then for
//! the program `render` (pictures), `measure` (what was emitted, in numbers), `engine` (these parts put together), and
//! above them `cli` (the commands) and `app` (the window).
pub use geometry::{mesh, progress, tessellate};
pub use gpu::embed;
#[cfg(feature = "formats")]
pub use load;

#[cfg(feature = "cli")]
pub mod cli;
#[cfg(feature = "cli")]
mod program;

#[cfg(feature = "app")]
pub mod app;
#[cfg(feature = "app")]
pub mod commands;

// Types of these crates are part of the interface.
pub use {glam, wgpu};

#[cfg(feature = "cli")]
pub use program::run;

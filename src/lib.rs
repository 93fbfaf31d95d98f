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
//! let made = tessellate(&mesh, &Topology::of(&mesh), &inputs, None);
//! let highest = made.vertices.iter().map(|vertex| vertex.position[2]).fold(0.0, f32::max);
//! assert!(highest > 0.1, "the surface rises above its corners");
//! # Ok::<(), pnaen::mesh::SliceError>(())
//! ```
//!
//! Those who read the crate's code can go through it in this order: [`mesh`] (triangles, and how they are connected),
//! [`tessellate`] (the mathematics on the CPU: the reference), `gpu` (the same mathematics as compute passes), then for
//! the program `render` (pictures), `measure` (what was emitted, in numbers), `engine` (these parts put together), and
//! above them `cli` (the commands) and `app` (the window).
// The items of `internals` aren't part of the documentation, so their links may lead to private items.
#![cfg_attr(feature = "app", allow(rustdoc::private_intra_doc_links))]
// Only the program uses the whole crate. In a library without it, parts of the rooms are unused.
#![cfg_attr(not(feature = "app"), allow(dead_code, unused_imports))]
#![cfg_attr(feature = "app", warn(unreachable_pub))]
#![cfg_attr(not(feature = "cli"), warn(missing_docs))]

pub mod embed;
#[cfg(feature = "formats")]
pub mod load;
pub mod mesh;
pub mod progress;
pub mod tessellate;

mod cores;
mod gpu;
mod names;

#[cfg(feature = "formats")]
mod files;
#[cfg(feature = "formats")]
mod markdown;

#[cfg(feature = "cli")]
mod adjacency_file;
#[cfg(feature = "cli")]
mod chart;
#[cfg(feature = "cli")]
mod check;
#[cfg(feature = "cli")]
mod cli;
#[cfg(feature = "cli")]
mod compare;
#[cfg(feature = "cli")]
mod engine;
#[cfg(feature = "cli")]
mod export;
#[cfg(feature = "cli")]
mod factors_file;
#[cfg(feature = "cli")]
mod gallery;
#[cfg(feature = "cli")]
mod gates;
#[cfg(feature = "cli")]
mod measure;
#[cfg(feature = "cli")]
mod numbers;
#[cfg(feature = "cli")]
mod own_shader;
#[cfg(feature = "cli")]
mod plot;
#[cfg(feature = "cli")]
mod program;
#[cfg(feature = "cli")]
mod render;
#[cfg(feature = "cli")]
mod settings;
#[cfg(feature = "cli")]
mod shader_files;
#[cfg(feature = "cli")]
mod stability;
#[cfg(feature = "cli")]
mod truth;
#[cfg(feature = "cli")]
mod view;

#[cfg(feature = "app")]
mod app;
#[cfg(feature = "app")]
mod commands;

#[cfg(feature = "app")]
#[doc(hidden)]
pub mod internals;

// Tests of the whole program, which name the crate as other crates do.
#[cfg(test)]
#[cfg(feature = "app")]
extern crate self as pnaen;
#[cfg(test)]
#[cfg(feature = "app")]
#[path = "../tests/gpu/mod.rs"]
mod gpu_tests;
#[cfg(test)]
mod rooms;
#[cfg(test)]
#[cfg(feature = "app")]
#[path = "../tests/window/mod.rs"]
mod window_tests;

// Types of these crates are part of the interface.
pub use {glam, wgpu};

#[cfg(feature = "cli")]
pub use program::run;

//! Loads meshes from glTF, OBJ, STL and PLY files, height images and textures, within limits of file size and memory.
//! Everything in a file is checked before it is used.

mod face_builder;
mod gltf;
mod heights;
#[cfg(test)]
mod hostile_files;
mod images;
mod jpeg_memory;
mod loaded_mesh;
mod memory_budget;
mod mesh_file;
mod obj;
mod ply;
mod read_error;
mod source;
mod stl;
mod text_lines;
mod uri;
mod warnings;

pub use crate::files::Limits;
pub use gltf::GltfError;
pub use heights::{HeightError, HeightSource};
pub use loaded_mesh::LoadedMesh;
pub use memory_budget::Budget;
pub use mesh_file::{Format, LoadError, load, read};
pub use read_error::ReadError;
pub use source::Source;
pub use warnings::{crease_band_warnings, untextured_warning};

//! Files become meshes: glTF, OBJ, STL and PLY, height images and textures, each within limits of size and memory. Nothing
//! that a file says is trusted.

mod faces;
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

pub use gltf::Problem as GltfProblem;
pub use heights::{HeightError, HeightSource};
pub use loaded_mesh::LoadedMesh;
pub use memory_budget::Budget;
pub use mesh_file::{Format, LoadError, load, read};
pub use read_error::ReadError;
pub use source::Source;
pub use warnings::{rim_warnings, untextured_warning};

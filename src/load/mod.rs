//! Loads meshes from glTF, FBX, OBJ, STL and PLY files, height images and textures, within limits of file size and memory.
//! Everything in a file is checked before it is used.

mod attachment;
mod binding_space;
mod bits;
#[cfg(feature = "cli")]
pub(crate) mod environment_file;
mod face_builder;
mod fbx;
mod gltf;
pub(crate) mod heights;
#[cfg(test)]
mod hostile_files;
mod images;
mod jpeg_memory;
mod ktx2;
mod loaded_mesh;
mod matcap_image;
pub(crate) mod memory_budget;
pub(crate) mod mesh_file;
mod notes;
mod obj;
#[cfg(feature = "cli")]
pub(crate) mod panorama;
mod ply;
mod read_error;
mod recent_corners;
mod rig_builder;
pub(crate) mod selection;
pub(crate) mod source;
mod stl;
mod tangents;
mod text_lines;
mod texture_room;
mod uri;
mod warnings;
mod webp_memory;
mod zstd;

pub use crate::files::{FileError, Limits};
pub use gltf::GltfError;
pub use heights::HeightError;
pub use loaded_mesh::LoadedMesh;
pub use matcap_image::{MatcapError, load_matcap};
pub use mesh_file::{LoadError, load};
pub use read_error::{FilePosition, ReadError};

pub(crate) use heights::HeightSource;
pub(crate) use memory_budget::Budget;
#[cfg(test)]
pub(crate) use mesh_file::Format;
pub(crate) use source::Source;
pub(crate) use warnings::{crease_band_warnings, untextured_warning};

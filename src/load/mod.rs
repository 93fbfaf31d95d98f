//! Loads meshes from glTF, FBX, OBJ, STL, PLY, OFF and 3MF files, height images and textures, within limits of file size and memory.
//! Everything in a file is checked before it is used.

mod attachment;
mod binding_space;
mod bits;
mod content;
#[cfg(feature = "cli")]
pub(crate) mod csv_vertices;
#[cfg(feature = "cli")]
pub(crate) mod environment_file;
mod face_builder;
mod fbx;
pub(crate) mod format;
mod gltf;
pub(crate) mod heights;
#[cfg(test)]
mod hostile_files;
mod images;
pub(crate) mod import;
mod jpeg_memory;
mod ktx2;
mod loaded_mesh;
mod matcap_image;
pub(crate) mod memory_budget;
pub(crate) mod mesh_file;
mod notes;
mod obj;
mod off;
mod packing;
#[cfg(feature = "cli")]
pub(crate) mod panorama;
pub(crate) mod parts;
mod ply;
mod prefix_code;
mod read_error;
mod recent_corners;
mod rig_builder;
pub(crate) mod selection;
pub(crate) mod source;
mod stl;
mod tangents;
mod text_lines;
mod texture_room;
mod threemf;
mod triangle_block;
mod unread_formats;
mod uri;
mod warnings;
mod webp_memory;
mod webp_tables;
mod zstd;

pub use crate::files::{FileError, Limits};
pub use gltf::GltfError;
pub use heights::HeightError;
pub use loaded_mesh::LoadedMesh;
pub use matcap_image::{MatcapError, load_matcap};
pub use mesh_file::{LoadError, load};
pub use read_error::{FilePosition, ReadError};
pub(crate) use uri::percent_decoded;

#[cfg(test)]
pub(crate) use format::Format;
pub(crate) use heights::HeightSource;
pub(crate) use import::{FileUnit, Import, LengthUnit, NormalSource, UNIT_METRES, is_of_lacking_normals};
pub(crate) use memory_budget::Budget;
pub(crate) use source::Source;
#[cfg(test)]
pub(crate) use threemf::tests::package;
pub(crate) use warnings::{crease_band_warnings, untextured_warning};

//! Loads meshes from glTF, FBX, OBJ, STL, PLY, OFF and 3MF files, height images and textures, within limits of file size and memory.
//! Everything in a file is checked before it is used.

#![cfg_attr(not(test), warn(clippy::cast_possible_truncation))]

mod attachment;
mod binding_space;
mod cage_faces;
mod content;
pub mod csv_vertices;
pub mod environment_file;
mod face_builder;
pub mod factors_file;
mod fbx;
pub mod files;
pub mod format;
mod gltf;
pub mod heights;
mod images;
pub mod import;
mod ktx2;
mod loaded_mesh;
mod map_uvs;
pub mod markdown;
mod matcap_image;
mod memory_budget;
pub mod mesh_file;
mod model_file;
mod notes;
mod obj;
mod off;
mod packing;
pub mod panorama;
pub mod part_tree;
pub mod parts;
mod ply;
mod read_error;
mod recent_corners;
mod rig_builder;
pub mod selection;
pub mod source;
mod stl;
mod tangents;
mod text_lines;
mod texture_room;
mod threemf;
mod unread_formats;
mod uri;
mod warnings;
mod watched_bytes;
mod webp;

pub use crate::files::{FileError, Limits};
pub use geometry::mesh::normals::NormalSource;
pub use gltf::{GltfError, material_members};
pub use heights::HeightError;
pub use loaded_mesh::{Contents, LoadedMesh};
pub use matcap_image::{MatcapError, load_matcap};
pub use mesh_file::{LoadError, load};
pub use read_error::{FilePosition, ReadError};
pub use uri::percent_decoded;

pub use format::Format;
pub use heights::{HeightSource, NamedImage};
pub use import::{FileUnit, Import, LengthUnit, UNIT_METRES, is_of_lacking_normals};
pub use memory_budget::Budget;
pub use selection::{MorphWeights, ShownParts};
pub use source::Source;
pub use warnings::crease_band_warnings;

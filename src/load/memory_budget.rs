//! Limits the memory that a load takes by the size of its files.
//!
//! A load may take four times the size of its files, plus [`Limits::memory`](crate::Limits::memory). What counts is the memory in use
//! at one time. A file of `F` bytes that becomes `T` triangles with `V` distinct corners and `P` points takes, in
//! bytes, besides textures and animation data:
//!
//! - while it is read, `F + 44 V + 12 T`: the file's bytes, corners with the tables that find equal ones, and triangles. Each vertex of
//!   the glTF primitive that is being read takes 5 more, and each vertex of an OBJ, PLY, OFF or 3MF file takes its attributes. If the
//!   number of corners isn't known beforehand, their list grows by half, and the old and the new list exist at the same time: `98 V`.
//! - while normals are computed, after the file's bytes have been freed: `32 V + 12 T + 57 P`; then, for points at creases,
//!   `32 V + 24 T + 5 P`, and 16 for each corner that a crease adds.
//! - at the end `36 V + 12 T`, or `24 T` if triangles were collected in several lists.
//! - more if materials need details of corners ([`CornerDetail`](geometry::mesh::CornerDetail)), of which `D` are distinct: up to
//!   `130 D` and a table's `8 S` while they are read (`S` is the first power of two from `8 D / 7` on), then `52 D + 52 V`, at the end
//!   `48 V`; and 1000 for each of about 65,536 triangles at a time whose tangents are computed.
//! - with its topology `32 V + 12 T`; in addition first `32 V` for points, then `16 P + 4 V + 40 T` for patches and
//!   sides, and 8 for each edge. For a closed mesh this is 92 for each triangle in all.

pub use geometry::mesh::Budget;

/// Returns how much memory a mesh of so many corners and triangles takes until its topology is built, in bytes: see above. There are at
/// most as many points as corners, and an ordinary mesh has three edges for two triangles.
pub(super) fn edge_bytes(corners: u64, triangles: u64) -> u64 {
    corners.saturating_mul(32 + 32 + 16 + 4).saturating_add(triangles.saturating_mul(12 + 40 + 12))
}

//! The mesh that the window opens first, and files to try the program with.

use std::path::PathBuf;

/// A painted vase of few triangles, as a .glb file.
pub const VASE: &[u8] = include_bytes!("vase.glb");

/// Where a file of this folder is, for tests.
pub fn path(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(name)
}

//! What of a file is read, and how.

use super::import::Import;

/// Which of a file's alternatives is read, and how its geometry is taken.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Selection<'a> {
    /// The material variant, by name; none for each primitive's own material.
    pub variant: Option<&'a str>,
    /// The scene, by name or by number from 0; none for the file's default scene.
    pub scene: Option<&'a str>,
    /// The names of parts that are left out.
    pub hidden: &'a [String],
    /// How the geometry is taken.
    pub import: Import,
}

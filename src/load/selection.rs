//! What of a file is shown, if it holds several things.

/// Which of a file's alternatives is read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Selection<'a> {
    /// The material variant, by name; none for each primitive's own material.
    pub variant: Option<&'a str>,
    /// The scene, by name or by number from 0; none for the file's default scene.
    pub scene: Option<&'a str>,
}

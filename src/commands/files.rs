//! What the window asks a file for.

use geometry::names::every;

/// What can be open beside the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CompanionFile {
    /// The reference surface.
    ReferenceShape,
    Factors,
    LodShader,
    SurfaceShader,
    /// A picture of a lit sphere.
    Matcap,
    Environment,
}

impl CompanionFile {
    pub const ALL: [Self; 6] =
        every![CompanionFile: ReferenceShape, Factors, LodShader, SurfaceShader, Matcap, Environment];
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Written {
    Chart,
    Picture,
    /// A turntable as PNG files.
    Folder,
    Gif,
    Factors,
    Adjacency,
    Stats,
    /// The tessellated mesh.
    Mesh,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    Open,
    Heights,
    CompanionFile(CompanionFile),
    Write(Written),
}

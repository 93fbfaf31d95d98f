//! What the window asks a file for.

use geometry::names::every;

/// What can be open beside the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CompanionFile {
    /// The reference surface.
    ReferenceShape,
    /// The mesh left of the split.
    LeftMesh,
    Factors,
    LodShader,
    SurfaceShader,
    /// A picture of a lit sphere.
    Matcap,
    Environment,
}

impl CompanionFile {
    pub const ALL: [Self; 7] =
        every![CompanionFile: ReferenceShape, LeftMesh, Factors, LodShader, SurfaceShader, Matcap, Environment];
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

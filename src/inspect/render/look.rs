//! Colours of the surface that have variants of its shader of their own, so that no other picture pays for them.

use crate::settings::Colors;
use geometry::names::every;

/// Such colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub(crate) enum Look {
    SurfaceNormals = 1,
    Curvature = 2,
    Matcap = 3,
    TexelDensity = 4,
}

impl Look {
    pub(super) const ALL: [Self; 4] = every![Look: SurfaceNormals, Curvature, Matcap, TexelDensity];

    /// The variant that shows these colours, if they have one.
    pub(super) fn of(colors: Colors) -> Option<Self> {
        match colors {
            Colors::SurfaceNormals => Some(Self::SurfaceNormals),
            Colors::Curvature => Some(Self::Curvature),
            Colors::Matcap => Some(Self::Matcap),
            Colors::TexelDensity => Some(Self::TexelDensity),
            Colors::Material
            | Colors::Clay
            | Colors::Zebra
            | Colors::ShadingNormals
            | Colors::UvChecker
            | Colors::Barycentric
            | Colors::Factors
            | Colors::TriangleSize
            | Colors::LowFactors
            | Colors::Excess
            | Colors::Deviation
            | Colors::Silhouette => None,
        }
    }
}

//! How the surface's shader shows the colours that the settings choose.

use super::scale::{DENSITY_SCALE, EXCESS_SCALE, FACTOR_SCALE, SIZE_SCALE, Scale};
use crate::settings::Colors;

/// A variant of the surface's shader that only some colours need, so that no other picture pays for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub(crate) enum Look {
    SurfaceNormals = 1,
    Curvature = 2,
    Matcap = 3,
    TexelDensity = 4,
}

/// What the shader looks at to show colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Branch {
    /// What it shows without being told to.
    Usual,
    /// A bit of the overlays: `OVERLAY_*` in `shaders/draw_types.wgsl`.
    Bit(u32),
    Variant(Look),
}

/// How colours are drawn: the shader's branch, and the scale of their numbers if that is always the same one.
pub(crate) struct DrawnColors {
    pub branch: Branch,
    pub scale: Option<&'static Scale>,
}

impl DrawnColors {
    pub(crate) fn new(colors: Colors) -> Self {
        let bit = |bit: u32| Self { branch: Branch::Bit(1 << bit), scale: None };
        let variant = |look| Self { branch: Branch::Variant(look), scale: None };
        match colors {
            Colors::Material => Self { branch: Branch::Usual, scale: None },
            Colors::Barycentric => bit(2),
            Colors::Factors => Self { scale: Some(&FACTOR_SCALE), ..bit(6) },
            Colors::TriangleSize => Self { scale: Some(&SIZE_SCALE), ..bit(7) },
            Colors::LowFactors => bit(8),
            Colors::Deviation => bit(9),
            Colors::Excess => Self { scale: Some(&EXCESS_SCALE), ..bit(10) },
            Colors::Clay => bit(11),
            Colors::Zebra => bit(12),
            Colors::ShadingNormals => bit(13),
            Colors::UvChecker => bit(14),
            Colors::Silhouette => bit(15),
            Colors::SurfaceNormals => variant(Look::SurfaceNormals),
            Colors::Curvature => variant(Look::Curvature),
            Colors::Matcap => variant(Look::Matcap),
            Colors::TexelDensity => Self { scale: Some(&DENSITY_SCALE), ..variant(Look::TexelDensity) },
        }
    }

    /// The bit of the overlays; 0 if there is none.
    pub(crate) fn bit(&self) -> u32 {
        if let Branch::Bit(bit) = self.branch { bit } else { 0 }
    }

    pub(crate) fn look(&self) -> Option<Look> {
        if let Branch::Variant(look) = self.branch { Some(look) } else { None }
    }
}

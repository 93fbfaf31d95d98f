//! The surfaces that a patch may become. How they are computed is in `tessellate/`.

use crate::choice::choices;

choices! {
    /// Which surface a patch becomes. Those that end on AEN are the same with adjacent edge normals, as in PN-AEN: an edge's
    /// control points are the mean of what its sides propose.
    #[derive(Hash, PartialOrd, Ord)]
    #[repr(u32)]
    pub enum Surface {
        Flat => "flat", "Flat", "Triangles stay flat: more triangles, the same shape.";
        Pn => "pn", "PN",
            "PN triangles (Vlachos et al. 2001): cubic patches from the corners' positions and normals. Edges with split \
             normals crack open.";
        PnAen => "pn-aen", "PN-AEN",
            "PN triangles with adjacent edge normals (McDonald and Kilgard 2010): the triangles that meet at an edge \
             share the mean of their control points, so that nothing cracks.";
        PnCrease => "pn-crease", "PN crease",
            "PN triangles with sharp creases (Vlachos et al. 2001, section 3.4): where normals are split, an edge starts \
             along the line in which both tangent planes meet. Nothing cracks.";
        Phong => "phong", "Phong",
            "Phong tessellation (Boubekeur and Alexa 2008): quadratic patches from projections onto the corners' tangent \
             planes. Edges with split normals crack open.";
        PhongAen => "phong-aen", "Phong AEN",
            "Phong tessellation whose edges are averaged over the triangles that meet there. Nothing cracks.";
        Nagata => "nagata", "Nagata",
            "Nagata patches (Nagata 2005): the flattest quadratic edges that are perpendicular to the normals at their \
             ends. Edges with split normals crack open.";
        NagataAen => "nagata-aen", "Nagata AEN",
            "Nagata patches whose edges are averaged over the triangles that meet there. Nothing cracks.";
    }
}

/// How the control points of an edge follow from the normals at its ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SurfaceFamily {
    Flat,
    Pn,
    Phong,
    Nagata,
}

impl Surface {
    /// What patches are drawn as while a function of the user's own gives the control points of their edges: cubic, and each side of
    /// an edge by itself.
    pub const OF_USER_SHADER: Self = Self::Pn;

    pub fn family(self) -> SurfaceFamily {
        match self {
            Self::Flat => SurfaceFamily::Flat,
            Self::Pn | Self::PnAen | Self::PnCrease => SurfaceFamily::Pn,
            Self::Phong | Self::PhongAen => SurfaceFamily::Phong,
            Self::Nagata | Self::NagataAen => SurfaceFamily::Nagata,
        }
    }

    /// Whether patches stay the triangles that they are.
    pub fn is_flat(self) -> bool {
        self.family() == SurfaceFamily::Flat
    }

    /// Whether edges are sharp where their sides' normals differ.
    pub fn has_creases(self) -> bool {
        self == Self::PnCrease
    }

    /// Returns whether all sides of an edge share the mean of their control points.
    pub fn is_averaged(self) -> bool {
        !self.tears() && !self.is_flat() && !self.has_creases()
    }

    /// Returns whether edges crack where their sides' normals differ, because each side uses only its own normals.
    pub fn tears(self) -> bool {
        matches!(self, Self::Pn | Self::Phong | Self::Nagata)
    }

    /// Returns whether this is Phong tessellation, which has a strength.
    pub fn is_phong(self) -> bool {
        self.family() == SurfaceFamily::Phong
    }
}

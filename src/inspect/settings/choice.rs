//! Values with names: how the command line, saved settings and the window call the values of an option.

use geometry::tessellate::{Clip, Convention, Displacement, Edges, Lod, Normals, Partitioning, Surface};

/// What a value is called, and what it does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Description {
    /// On the command line and in files: lower case, words joined by hyphens.
    pub name: &'static str,
    /// In the window.
    pub label: &'static str,
    /// Whole sentences for help and hover texts.
    pub text: &'static str,
}

impl Description {
    pub const fn new(name: &'static str, label: &'static str, text: &'static str) -> Self {
        Self { name, label, text }
    }

    /// Returns how HLSL spells the name of a partitioning, where that differs: `fractional_odd`, `fractional_even`.
    pub fn hlsl_name(&self) -> Option<String> {
        self.name.starts_with("fractional-").then(|| self.name.replace('-', "_"))
    }

    /// Whether a text is this name, or HLSL's spelling of it.
    pub fn is_named(&self, text: &str) -> bool {
        text == self.name || self.hlsl_name().is_some_and(|name| name == text)
    }
}

/// A value that is one of several, each with a name.
pub trait Choice: Copy + PartialEq + 'static {
    /// All values, in the order in which lists show them.
    const ALL: &'static [Self];

    fn description(self) -> Description;

    fn name(self) -> &'static str {
        self.description().name
    }

    fn label(self) -> &'static str {
        self.description().label
    }

    fn text(self) -> &'static str {
        self.description().text
    }

    /// The value of that name.
    fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|value| value.description().is_named(name))
    }
}

/// Says what the values of an enum are called and what they do, in the order in which lists show them. It doesn't compile if one is
/// missing. The enum may be declared along with them; the texts are then its variants' documentation.
macro_rules! choices {
    ($type:ident: $($variant:ident => $name:literal, $label:literal, $text:literal;)+) => {
        impl $crate::settings::Choice for $type {
            const ALL: &'static [Self] = &[$(Self::$variant),+];

            fn description(self) -> $crate::settings::Description {
                match self {
                    $(Self::$variant => $crate::settings::Description::new($name, $label, $text),)+
                }
            }
        }
    };
    ($(#[$of_type:meta])* pub enum $type:ident {
        $($(#[$of_variant:meta])* $variant:ident => $name:literal, $label:literal, $text:literal;)+
    }) => {
        $(#[$of_type])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $type {
            $(#[doc = $text] $(#[$of_variant])* $variant),+
        }

        $crate::settings::choices! { $type: $($variant => $name, $label, $text;)+ }
    };
}
pub(crate) use choices;

/// The descriptions of all values, in the order in which lists show them.
pub fn descriptions<T: Choice>() -> Vec<Description> {
    T::ALL.iter().map(|value| value.description()).collect()
}

choices! { Surface:
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

choices! { Normals:
    Linear => "linear", "Linear normals", "The corners' normals, linearly interpolated, as in Phong shading.";
    Quadratic => "quadratic", "Quadratic normals",
        "The corners' normals, quadratically interpolated (Vlachos et al. 2001, section 3.3): they follow edges that \
         bend one way and back.";
    Surface => "surface", "Surface normals",
        "The exact normals of the curved surface. They change abruptly where the surface has a crease, which is \
         along most edges between patches.";
}

choices! { Edges:
    PerEdge => "per-edge", "Computed once",
        "Every shared edge is computed once. The triangles on both sides get identical bits, so that nothing cracks.";
    AsPublished => "as-published", "By each patch",
        "Every patch computes its edges for itself, as the white paper's shaders do (McDonald and Kilgard 2010). \
         Rounding differs, so that edges crack in their last bits. In the window, LOD by edge length and clipping \
         switch to the white paper's form too.";
}

choices! { Partitioning:
    Integer => "integer", "Integer",
        "Rounds factors up to whole numbers. All segments of an edge have the same length, and the pattern changes \
         in steps (Direct3D 11.3, section 11.7).";
    Pow2 => "pow2", "Power of two",
        "Rounds factors up to 1, 2, 4, 8, 16, 32 or 64, so that segments are only ever halved (Direct3D 11.3, \
         section 11.7).";
    FractionalOdd => "fractional-odd", "Fractional odd",
        "An odd number of segments, two of which grow from nothing, so that the pattern never jumps (Direct3D 11.3, \
         section 11.7).";
    FractionalEven => "fractional-even", "Fractional even",
        "An even number of segments, at least 2, two of which grow from nothing, so that the pattern never jumps \
         (Direct3D 11.3, section 11.7).";
    Subtriangulation => "subtriangulation", "Subtriangulation",
        "Rounds the factor up to n and cuts every patch into n x n equal triangles (Vlachos et al. 2001, figure 4, \
         where this is level of detail n - 1). Direct3D doesn't have it. All edges have the same factor, so that LOD \
         is uniform.";
    Rows => "rows", "Rows",
        "Rounds factors up to whole numbers and cuts every patch into strips beside one of its edges. LOD by error \
         takes about 0.6 times the triangles that Direct3D's patterns need. Hardware tessellators can't make it; \
         compute and mesh shaders can.";
}

choices! { Lod:
    Uniform => "uniform", "Uniform", "All edges have the same factor.";
    Error => "error", "Error",
        "About the fewest triangles that stay within a tolerance, in px, of the surface (bounds on second \
         derivatives: Filip et al. 1986). Flat places stay untessellated.";
    EdgeLength => "edge-length", "Edge length",
        "The edge's length on screen, divided by the length of a segment. Edges that reach near or behind the eye \
         are measured where they come nearest to it.";
    Distance => "distance", "Distance",
        "The full factor up to a near distance from the eye, 1 beyond a far distance, linear in between. An edge \
         gets the mean of its two ends, as engines commonly do (Unity's `UnityDistanceBasedTess`, for example).";
    Paper => "paper", "White paper",
        "The length of the edge's control polygon on screen, divided by the length of a segment (McDonald and \
         Kilgard 2010). Edges that reach near or behind the eye get wrong factors.";
}

choices! { Clip:
    Off => "off", "Off", "Every patch is drawn.";
    Frustum => "frustum", "Frustum",
        "Leaves out a patch if all its ten control points lie outside the same side of the view. No visible patch is \
         lost.";
    Paper => "paper", "White paper",
        "Leaves out a patch if each of its ten control points lies outside the view, on whichever side (McDonald and \
         Kilgard 2010). Patches that cross the view can be lost.";
}

choices! { Convention:
    D3d11 => "d3d11", "Direct3D 11",
        "As in Direct3D 11, Vulkan and the white paper: weights u, v, w belong to corners 0, 1, 2, and \
         TessFactor[0..2] to the edges opposite them.";
    AmdPn => "amd-pn", "AMD PN sample",
        "As in AMD's PN triangles sample for Direct3D 11: weights w, u, v belong to corners 0, 1, 2, and \
         TessFactor[0..2] to the edges opposite u, v and w.";
    EdgeOrder => "edge-order", "Edge order",
        "TessFactor[0..2] belong to the edges (0, 1), (1, 2), (2, 0), and weights v, w, u to corners 0, 1, 2.";
    Rotated => "rotated", "Rotated (mistake)",
        "Factors in edge order, but weights as in Direct3D 11. Every edge gets the factor of another edge, and \
         adaptive LOD cracks.";
    Mirrored => "mirrored", "Mirrored (mistake)",
        "As in Direct3D 11, but with the first two factors exchanged, as if triangles were wound the other way. \
         Adaptive LOD cracks.";
}

choices! { Displacement:
    Off => "off", "Off", "The surface isn't displaced.";
    On => "on", "On",
        "Displaces without cracks. Each edge and each point takes its texture coordinates from one triangle \
         (dominant edges and vertices, McDonald 2011), and moves along the mean of the normals that meet there.";
    AsPublished => "as-published", "As published",
        "Uses dominant edges and vertices (McDonald 2011), but moves each patch along its own normals. Texture seams \
         stay closed, and edges with split normals crack open.";
    PerPatch => "per-patch", "Per patch",
        "Each patch uses its own texture coordinates and normals. Texture seams and edges with split normals crack \
         open.";
}

#[cfg(test)]
mod tests {
    use geometry::mesh::UpAxis;
    use load::{LengthUnit, NormalSource};

    use super::super::{Colors, DeviationUnit, Lighting, NormalsAt, Overlay, ToneCurve};
    use super::*;

    fn check<T: Choice + std::fmt::Debug>() {
        for (index, value) in T::ALL.iter().copied().enumerate() {
            let Description { name, label, text } = value.description();
            assert!(!T::ALL[..index].contains(&value), "{value:?} is listed twice");
            assert_eq!(T::named(name), Some(value), "{value:?}");
            let hlsl = value.description().hlsl_name();
            assert!(hlsl.is_none_or(|hlsl| T::named(&hlsl) == Some(value)), "{value:?}");
            assert!(T::ALL[..index].iter().all(|other| other.label() != label), "{label} is there twice");
            assert!(text.ends_with('.') && text.len() > 10, "{value:?}: {text}");
            assert_eq!(label.trim(), label);
        }
        assert_eq!(T::named("odd"), None);
        assert_eq!(T::named(""), None);
    }

    #[test]
    fn every_value_is_found_by_its_name_and_has_a_text() {
        check::<Surface>();
        check::<Normals>();
        check::<Edges>();
        check::<Partitioning>();
        check::<Lod>();
        check::<Clip>();
        check::<Convention>();
        check::<Displacement>();
        check::<DeviationUnit>();
        check::<NormalsAt>();
        check::<Lighting>();
        check::<ToneCurve>();
        check::<Overlay>();
        check::<Colors>();
        check::<NormalSource>();
        check::<UpAxis>();
        check::<LengthUnit>();
    }
}

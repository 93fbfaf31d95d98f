//! What is drawn over the shaded surface, or in place of its colours.

use super::{Choice, Description, choices};

choices! {
    /// One of [`Overlays`], by name.
    pub enum Overlay {
        Wireframe => "wireframe", "Wireframe", "Edges of the tessellated triangles.";
        Patches => "patches", "Patch borders", "Edges of the mesh's own triangles.";
        Clay => "clay", "Clay",
            "Shows the mesh in one matte warm grey, without its own colours, textures and gloss, so that only its \
             shape is seen.";
        Matcap => "matcap", "Matcap",
            "Gives each place of the surface the colour that a lit sphere has at the same shading normal, as \
             sculpting programs do. The light stays with the view.";
        Zebra => "zebra", "Zebra",
            "Black and white stripes around the mesh, as the shading normals reflect them. Stripes jump where the \
             tangent breaks, and have a kink where the curvature does. With surface normals they show the patches, otherwise the \
             normals that are shaded.";
        ShadingNormals => "shading-normals", "Shading normals",
            "Colours the surface by its unit shading normal in object space, as normal maps do: x red, y green, z \
             blue, each from -1 (0) to 1 (255). Seen from behind, it has the same colours.";
        SurfaceNormals => "surface-normals", "Surface normals",
            "Colours the surface by the unit normal of each curved patch itself, in the colours of the shading \
             normals. They differ from the shading normals where shading pretends, and jump where patches meet at an \
             angle. Displacement isn't in them.";
        Curvature => "curvature", "Curvature",
            "Colours the surface by a curvature of each curved patch itself, the mean one unless another is chosen, in 1 / object \
             unit: red above 0, where it bulges, blue below 0, where it is hollow, and light grey at 0. A sphere of radius r \
             has 1 / r. Displacement isn't in it.";
        UvChecker => "uv-checker", "UV checker",
            "A checker over texture coordinates, with 8 by 8 squares in one unit of u and v unless another number is chosen, and \
             blue lines around each unit. Red grows with u and green with v. In each square are an F, which shows mirrored and \
             turned charts, and the numbers of its column, from the left, and of its row, from the top. Triangles without texture \
             coordinates are plain grey, and so are squares smaller than a px.";
        TexelDensity => "texel-density", "Texel density",
            "Colours the surface by how many texels of the base colour's image lie side by side in a px of the \
             picture: orange where the image is magnified and looks blurred, purple where it has more detail than is seen. Or \
             along an object unit: orange where the mesh has fewer than the power of two that is nearest to what half of its \
             triangles have at most, purple where it has more. A material without an image counts as if it had one of \
             1024 x 1024 px. Triangles without texture coordinates are plain grey.";
        Barycentric => "barycentric", "Barycentric",
            "Colours the surface by domain coordinates: u red on corner 0, v green on corner 1, w blue on corner 2. A corner, \
             where its weight is 1 and the others are 0, has one pure colour; along an edge the colour of the opposite corner is \
             missing; in the middle all are equal.";
        Adjacency => "adjacency", "Adjacency edges", "Edges of the mesh's own triangles, coloured by the kind of edge.";
        Cracks => "cracks", "Cracks",
            "Edges along which neighbouring triangles put a point at different positions; faint behind the surface.";
        Folds => "folds", "Folds", "Triangles that face away from the side that their patch faces.";
        TJunctions => "t-junctions", "T-junctions",
            "Open edges that a point of another triangle lies on; faint behind the surface.";
        Bones => "bones", "Bones",
            "The joints of the mesh's skins in the pose that is shown, each with a line to the nearest joint above it; seen \
             through the surface.";
        BackFaces => "back-faces", "Back faces", "Triangles seen from behind: of open meshes, or wound the other way.";
        Factors => "factors", "Factors",
            "Colours the surface by tessellation factors after clamping and rounding: the inside factor inside each \
             patch, and along each edge the factor of that edge.";
        TriangleSize => "triangle-size", "Triangle size",
            "Colours triangles by their size on screen: the side, in px, of the square that has twice the triangle's \
             area. Those below 3 px stand out: a GPU shades up to four times as many px for them as they cover.";
        LowFactors => "low-factors", "Factors below 2",
            "Colours patches whose edge and inside factors are all below 2: without tessellation they would look \
             almost the same and cost less.";
        Excess => "excess", "Excess triangles",
            "Colours patches by how many times as many triangles they have as the minimum that they need: the fewest with which \
             a patch alone would keep the tolerance of LOD by error.";
        Normals => "normals", "Normals",
            "Normals of the tessellated vertices, 18 px long across the view; faint behind the surface. Where there \
             are many, about one every 24 px is drawn.";
        Grid => "grid", "Ground grid",
            "The ground under the mesh, with lines at multiples of a round number of object units, and the axes x \
             (red), y (green) and z (blue) from the origin.";
        Deviation => "deviation", "Deviation",
            "Colours the surface by its distance to the reference surface: the exact surface of a shape made in \
             code, a mesh that was chosen, or else the surface that the tessellation converges to. The scale ends at the largest \
             distance, rounded up, and begins at a hundredth of that; smaller distances have the first colour. What isn't \
             measured is grey.";
        Silhouette => "silhouette", "Silhouette",
            "Shows the outline of the tessellated triangles over those of the source mesh and of the curved surface, \
             and how many px it is from them at most. Where only one line is seen, the outlines agree. A ring is \
             around the place where two are farthest apart. Lines are drawn to within 0.1 px, and distances are right to about \
             half a px. How far the triangles' outline is from the source's is what tessellation has gained.";
    }
}

/// Sorts overlays into those that colour the surface, one at a time, and those that are switched on by themselves.
macro_rules! overlays {
    (colors: $($color:ident of $source:ident)+; switches: $($switch:ident as $field:ident)+) => {
        /// What the surface's colours mean: one thing at a time. But for the first, see [`Overlay`].
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
        pub enum Colors {
            /// The mesh's own.
            #[default]
            Material,
            $($color),+
        }

        impl Choice for Colors {
            const ALL: &'static [Self] = &[Self::Material, $(Self::$color),+];

            fn description(self) -> Description {
                match self {
                    Self::Material => Description::new("material", "Material", "The mesh's own colours."),
                    $(Self::$color => Overlay::$color.description(),)+
                }
            }
        }

        impl Colors {
            pub fn source(self) -> ColorSource {
                match self {
                    Self::Material => ColorSource::Materials,
                    $(Self::$color => ColorSource::$source,)+
                }
            }
        }

        /// What is drawn over the shaded surface; any of them together. Switches are called as their [`Overlay`].
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        pub struct Overlays {
            pub colors: Colors,
            $(pub $field: bool),+
        }

        impl Overlays {
            /// The control that turns `overlay` on.
            pub fn control(&mut self, overlay: Overlay) -> Control<'_> {
                match overlay {
                    $(Overlay::$color => Control::Colors(&mut self.colors, Colors::$color),)+
                    $(Overlay::$switch => Control::Switch(&mut self.$field),)+
                }
            }
        }
    };
}

overlays! {
    colors: Clay of Nothing Matcap of LitSphere Zebra of Nothing ShadingNormals of Nothing SurfaceNormals of Nothing
        Curvature of Nothing UvChecker of TextureCoordinates TexelDensity of TextureCoordinates Barycentric of Nothing
        Factors of Nothing TriangleSize of Nothing LowFactors of Nothing Excess of MinimumTriangles
        Deviation of ReferenceSurface Silhouette of Outlines;
    switches: Wireframe as wireframe Patches as patches Adjacency as adjacency Cracks as cracks Folds as folds
        BackFaces as back_faces TJunctions as t_junctions Bones as bones Normals as normals Grid as grid
}

/// What colours are made of, besides the triangles that are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColorSource {
    Nothing,
    Materials,
    TextureCoordinates,
    /// A picture of a lit sphere.
    LitSphere,
    /// The fewest triangles that each patch needs.
    MinimumTriangles,
    /// Distances to the reference surface.
    ReferenceSurface,
    /// The outlines of the source mesh and of the curved surface.
    Outlines,
}

/// The control of an overlay: a switch, or the surface's colours and the value that the overlay gives them.
pub enum Control<'a> {
    Switch(&'a mut bool),
    Colors(&'a mut Colors, Colors),
}

impl Overlays {
    /// Turns an overlay on if it is off, and off if it is on. One that colours the surface takes the place of another.
    pub fn toggle(&mut self, overlay: Overlay) {
        match self.control(overlay) {
            Control::Switch(switch) => *switch = !*switch,
            Control::Colors(colors, own) => *colors = if *colors == own { Colors::Material } else { own },
        }
    }

    /// Turns an overlay on, if it isn't.
    pub fn turn_on(&mut self, overlay: Overlay) {
        if !self.on().any(|on| on == overlay) {
            self.toggle(overlay);
        }
    }

    /// Those that are on.
    pub fn on(mut self) -> impl Iterator<Item = Overlay> {
        Overlay::ALL.iter().copied().filter(move |overlay| match self.control(*overlay) {
            Control::Switch(switch) => *switch,
            Control::Colors(colors, own) => *colors == own,
        })
    }

    /// These overlays on, all others off; none if two of them colour the surface.
    pub fn new(overlays: &[Overlay]) -> Option<Self> {
        let mut all = Self::default();
        for &overlay in overlays {
            match all.control(overlay) {
                Control::Switch(switch) => *switch = true,
                Control::Colors(colors, own) if [Colors::Material, own].contains(colors) => *colors = own,
                Control::Colors(..) => return None,
            }
        }
        Some(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_overlay_at_a_time_colours_the_surface() {
        let mut overlays = Overlays::default();
        for overlay in Overlay::ALL {
            overlays.toggle(overlay);
            assert_ne!(overlays, Overlays::default(), "{overlay:?}");
        }
        assert_eq!(overlays.colors, Colors::Silhouette, "the last one");
        overlays.toggle(Overlay::Factors);
        assert_eq!(overlays.colors, Colors::Factors);
        overlays.toggle(Overlay::Factors);
        assert_eq!(overlays.colors, Colors::Material);
        let factors = Overlays { colors: Colors::Factors, wireframe: true, ..Overlays::default() };
        assert_eq!(Overlays::new(&[Overlay::Factors, Overlay::Wireframe, Overlay::Factors]), Some(factors));
        assert_eq!(Overlays::new(&[Overlay::Factors, Overlay::Barycentric]), None);
    }
}

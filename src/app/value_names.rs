//! What there is to choose from on the left, and what it is called.

use crate::settings::{Colors, DeviationUnit, Overlay};
use crate::tessellate::{Clip, Convention, Edges, Lod, Normals, Partitioning, Surface};

/// What values are called here; what they are is said where they are defined, for the commands too.
pub const SURFACES: [(Surface, &str); 8] = [
    (Surface::Flat, "Flat"),
    (Surface::Pn, "PN"),
    (Surface::PnAen, "PN-AEN"),
    (Surface::PnCrease, "PN crease"),
    (Surface::Phong, "Phong"),
    (Surface::PhongAen, "Phong AEN"),
    (Surface::Nagata, "Nagata"),
    (Surface::NagataAen, "Nagata AEN"),
];
pub const NORMALS: [(Normals, &str); 3] = [
    (Normals::Linear, "Linear normals"),
    (Normals::Quadratic, "Quadratic normals"),
    (Normals::Surface, "Surface normals"),
];
pub const EDGES: [(Edges, &str); 2] = [(Edges::PerEdge, "Once an edge"), (Edges::AsPublished, "As published")];
pub const LODS: [(Lod, &str); 5] = [
    (Lod::Uniform, "Uniform"),
    (Lod::Error, "Error"),
    (Lod::EdgeLength, "Edge length"),
    (Lod::Distance, "Distance"),
    (Lod::Paper, "White paper"),
];
pub const CLIPS: [(Clip, &str); 3] = [(Clip::Off, "Off"), (Clip::Frustum, "Frustum"), (Clip::Paper, "White paper")];
pub const CONVENTIONS: [(Convention, &str); 5] = [
    (Convention::D3d11, "Direct3D 11"),
    (Convention::AmdPn, "AMD PN sample"),
    (Convention::EdgeOrder, "Edge order"),
    (Convention::Rotated, "Rotated, a mistake"),
    (Convention::Mirrored, "Mirrored, a mistake"),
];
pub const PARTITIONINGS: [(Partitioning, &str, &str); 5] = [
    (Partitioning::Integer, "Integer", Partitioning::Integer.about()),
    (Partitioning::Pow2, "Power of two", Partitioning::Pow2.about()),
    (Partitioning::FractionalOdd, "Fractional odd", Partitioning::FractionalOdd.about()),
    (Partitioning::FractionalEven, "Fractional even", Partitioning::FractionalEven.about()),
    (Partitioning::Subtriangulation, "Subtriangulation", Partitioning::Subtriangulation.about()),
];
pub const LOD_FIXED: &str = "Subtriangulation has one number of segments everywhere. Another partitioning brings back the LOD \
                         that was chosen.";
/// Name and explanation of each meaning of colours, and overlay.
pub const COLORS: [(Colors, &str, &str); 6] = [
    (Colors::Material, "Material", "The mesh's own."),
    (
        Colors::Barycentric,
        "Barycentric",
        "Domain coordinates: u red on corner 0, v green on corner 1, w blue on corner 2 (B).",
    ),
    (
        Colors::Factors,
        "Factors",
        "Tessellation factors after clamping and rounding: inside each patch its inside factor, and along each edge that \
         edge's (H).",
    ),
    (
        Colors::TriangleSize,
        "Triangle size",
        "How large triangles are on screen: the side, in px, of the square that has twice the triangle's area. Those below \
         3 px, of which a GPU shades up to four times as many px as it shows, stand out (X).",
    ),
    (
        Colors::LowFactors,
        "Factors below 2",
        "Patches whose factors are all below 2, edges and inside: drawing them untessellated would hardly show, and cost \
         less (U).",
    ),
    (
        Colors::Deviation,
        "Deviation",
        "How far every place of what is emitted is from what it should have been: the surface that a shape is sampled from, a \
         truth chosen under File, or else the surface that the tessellation converges to (V).",
    ),
];
pub const DEVIATION_UNITS: [(DeviationUnit, &str); 2] =
    [(DeviationUnit::Units, "Object units"), (DeviationUnit::Px, "Px")];
pub const OVERLAYS: [(Overlay, &str, &str); 8] = [
    (Overlay::Wireframe, "Wireframe", "Edges of the tessellated triangles (W)."),
    (Overlay::Patches, "Patch borders", "Borders of the input triangles (P)."),
    (Overlay::Adjacency, "Adjacency edges", "Borders of the input triangles, coloured by the kind of edge (A)."),
    (Overlay::Cracks, "Cracks", "Edges whose sides put a point at different positions, faint behind the surface (C)."),
    (Overlay::Folds, "Folds", "Triangles that face away from the side that their patch faces (O)."),
    (
        Overlay::TJunctions,
        "T-junctions",
        "Open edges that another triangle's point lies on, faint behind the surface (T).",
    ),
    (Overlay::BackFaces, "Back faces", "Faces seen from behind: open meshes, and triangles wound the other way (K)."),
    (
        Overlay::Normals,
        "Normals",
        "Normals of emitted vertices, 18 px long across the view, faint behind the surface. Where vertices are many, only as \
         many as leave about 24 px between them (N).",
    ),
];

/// What a surface is called here.
pub fn surface_name(surface: Surface) -> &'static str {
    SURFACES.iter().find(|(choice, _)| *choice == surface).map_or("", |(_, name)| name)
}

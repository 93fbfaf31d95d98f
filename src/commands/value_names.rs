//! What the window calls the values of settings.

use std::borrow::Cow;

use clap::ValueEnum;

use crate::settings::{Colors, Control, DeviationUnit, Overlay, Overlays};
use crate::tessellate::{Clip, Convention, Displacement, Edges, Lod, Normals, Partitioning, Surface};

/// Names of values; their explanations are those of the command line, which stand where the values are defined.
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
/// Why patches that show their backs can't be left out.
pub const BACKS_ARE_SEEN: &str = "Backs of this mesh can be seen: it is open, a part of it is wound inward, a material is \
                                  double-sided, it is displaced, or it moves.";
/// What a height image does.
pub const HEIGHT_IMAGE: &str =
    "Displaces the mesh by a PNG or JPEG image over all materials, its brightness as stored.";
pub const DISPLACEMENTS: [(Displacement, &str); 4] = [
    (Displacement::Off, "Off"),
    (Displacement::On, "On"),
    (Displacement::AsPublished, "As published"),
    (Displacement::PerPatch, "Per patch"),
];
/// Name and explanation of each meaning of colours, and of each overlay.
pub const COLORS: [(Colors, &str, &str); 6] = [
    (Colors::Material, "Material", "The mesh's own."),
    (
        Colors::Barycentric,
        "Barycentric",
        "Domain coordinates: u red on corner 0, v green on corner 1, w blue on corner 2.",
    ),
    (
        Colors::Factors,
        "Factors",
        "Tessellation factors after clamping and rounding: inside each patch its inside factor, and along each edge that \
         edge's.",
    ),
    (
        Colors::TriangleSize,
        "Triangle size",
        "How large triangles are on screen: the side, in px, of the square that has twice the triangle's area. Those below \
         3 px, of which a GPU shades up to four times as many px as it shows, stand out.",
    ),
    (
        Colors::LowFactors,
        "Factors below 2",
        "Patches whose factors are all below 2, edges and inside: drawing them untessellated would hardly show, and cost \
         less.",
    ),
    (
        Colors::Deviation,
        "Deviation",
        "How far every place of what is emitted is from what it should have been: the surface that a shape is sampled from, a \
         truth chosen under File, or else the surface that the tessellation converges to.",
    ),
];
pub const DEVIATION_UNITS: [(DeviationUnit, &str); 2] =
    [(DeviationUnit::Units, "Object units"), (DeviationUnit::Px, "Px")];
pub const OVERLAYS: [(Overlay, &str, &str); 8] = [
    (Overlay::Wireframe, "Wireframe", "Edges of the tessellated triangles."),
    (Overlay::Patches, "Patch borders", "Borders of the input triangles."),
    (Overlay::Adjacency, "Adjacency edges", "Borders of the input triangles, coloured by the kind of edge."),
    (Overlay::Cracks, "Cracks", "Edges whose sides put a point at different positions, faint behind the surface."),
    (Overlay::Folds, "Folds", "Triangles that face away from the side that their patch faces."),
    (Overlay::TJunctions, "T-junctions", "Open edges that another triangle's point lies on, faint behind the surface."),
    (Overlay::BackFaces, "Back faces", "Faces seen from behind: open meshes, and triangles wound the other way."),
    (
        Overlay::Normals,
        "Normals",
        "Normals of emitted vertices, 18 px long across the view, faint behind the surface. Where vertices are many, only as \
         many as leave about 24 px between them.",
    ),
];

/// What a surface is called here.
pub fn surface_name(surface: Surface) -> &'static str {
    SURFACES.iter().find(|(choice, _)| *choice == surface).map_or("", |(_, name)| name)
}

/// What the command line says of a value, as a sentence.
pub fn explanation(value: impl ValueEnum) -> String {
    let help = value.to_possible_value().and_then(|value| value.get_help().map(ToString::to_string));
    format!("{}.", help.unwrap_or_default())
}

/// A value of a setting, its name and its explanation in a sentence.
pub struct Named<T> {
    pub value: T,
    pub name: &'static str,
    pub text: Cow<'static, str>,
}

/// Values that the command line explains.
fn explained<T: ValueEnum + Copy>(values: &[(T, &'static str)]) -> Vec<Named<T>> {
    values.iter().map(|&(value, name)| Named { value, name, text: explanation(value).into() }).collect()
}

pub fn surfaces() -> Vec<Named<Surface>> {
    explained(&SURFACES)
}

pub fn normals() -> Vec<Named<Normals>> {
    explained(&NORMALS)
}

pub fn edges() -> Vec<Named<Edges>> {
    explained(&EDGES)
}

pub fn lods() -> Vec<Named<Lod>> {
    explained(&LODS)
}

pub fn clips() -> Vec<Named<Clip>> {
    explained(&CLIPS)
}

pub fn conventions() -> Vec<Named<Convention>> {
    explained(&CONVENTIONS)
}

pub fn displacements() -> Vec<Named<Displacement>> {
    explained(&DISPLACEMENTS)
}

pub fn deviation_units() -> Vec<Named<DeviationUnit>> {
    explained(&DEVIATION_UNITS)
}

pub fn partitionings() -> Vec<Named<Partitioning>> {
    PARTITIONINGS.map(|(value, name, text)| Named { value, name, text: text.into() }).into()
}

/// The colours that the surface has when no overlay gives it others.
pub fn material_colors() -> Named<Colors> {
    let [(value, name, text), ..] = COLORS;
    Named { value, name, text: text.into() }
}

/// An overlay with a switch of its own; none for one that is a meaning of the surface's colours.
pub fn overlay(overlay: Overlay) -> Option<Named<Overlay>> {
    let (value, name, text) = OVERLAYS.into_iter().find(|(known, ..)| *known == overlay)?;
    Some(Named { value, name, text: text.into() })
}

/// What the surface's colours mean while this overlay gives them; none for an overlay with a switch of its own.
pub fn overlay_colors(overlay: Overlay) -> Option<Named<Overlay>> {
    let mut overlays = Overlays::default();
    let Control::Colors(_, colors) = overlays.control(overlay) else { return None };
    let (_, name, text) = COLORS.into_iter().find(|(known, ..)| *known == colors)?;
    Some(Named { value: overlay, name, text: text.into() })
}

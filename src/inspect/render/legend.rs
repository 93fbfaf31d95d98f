//! What a legend says about the surface's colours.

use super::deviation::scale_of;
use super::layout::{CHECKER_LIGHT, CHECKER_LINE, CHECKER_U, CHECKER_V, TEXELS_WITHOUT_IMAGE, srgb};
use super::outlines_picture::SILHOUETTE_COLORS;
use super::{DEVIATION_PX_SCALE, EXCESS_SCALE, FACTOR_SCALE, SIZE_SCALE, Scale, Usual};
use crate::measure::{OutlineDistance, OutlineDistances, OutlineOf};
use crate::settings::{Choice, Colors, DensityPer, DeviationUnit, Settings};
use geometry::tessellate::CurvatureKind;

/// The contents of a legend.
#[derive(Clone, Debug, PartialEq)]
pub struct Legend {
    pub title: String,
    /// The hover text.
    pub meaning: String,
    pub shown: Shown,
}

impl Legend {
    /// What a screen reader says of it: the title, and what is said of colours in rows.
    pub fn spoken(&self) -> String {
        let Shown::Rows(rows) = &self.shown else { return self.title.clone() };
        let rows: Vec<_> = rows.iter().map(|(_, text)| text.as_str()).collect();
        format!("{}: {}", self.title, rows.join(", "))
    }
}

/// What a legend shows.
#[derive(Clone, Debug, PartialEq)]
pub enum Shown {
    /// The title alone.
    Title,
    /// [`WASTE_COLOR`](super::layout::WASTE_COLOR), before the title.
    Waste,
    /// A scale under the title.
    Scale {
        scale: Scale,
        /// The numbers under it.
        ticks: Vec<f32>,
        /// Whether [`WASTE_COLOR`](super::layout::WASTE_COLOR) stands before it.
        waste: bool,
    },
    /// sRGB colours under the title, in rows of [`COLUMNS`], with their names.
    Colors(Vec<([u8; 3], &'static str)>),
    /// sRGB colours under the title, each in a row with what is said of it.
    Rows(Vec<([u8; 3], String)>),
    /// A patch in its barycentric colours.
    Barycentric,
}

/// How many colours stand in a row.
pub(crate) const COLUMNS: usize = 3;

/// What is known of the distances to the reference surface, and between outlines.
pub struct Distances {
    pub unit: DeviationUnit,
    /// None until something is measured.
    pub scale: Option<Scale>,
    /// Whether some of the surface has no colour.
    pub is_partial: bool,
    /// The progress of the measurement, 0 to 1; none if none is under way.
    pub measured: Option<f32>,
    /// How far the triangles' outline is from the others; none until that is known.
    pub outlines: Option<OutlineDistances>,
}

/// The legend of a picture's colours, if they have one, of a mesh on which these numbers are `usual`.
pub fn legend_of(settings: &Settings, usual: &Usual, distances: &Distances) -> Option<Legend> {
    let legend = |title: &str, meaning: &str, shown: Shown| {
        Some(Legend { title: title.to_owned(), meaning: meaning.to_owned(), shown })
    };
    let scale = |scale: Scale, ticks: &[f32], waste: bool| Shown::Scale { scale, ticks: ticks.to_vec(), waste };
    match settings.overlays.colors {
        Colors::Material | Colors::Clay | Colors::Matcap => None,
        Colors::Barycentric => legend(
            "Barycentric, weights in the patch",
            "Each place has the weights u, v and w of its patch's corners as red, green and blue. A corner, where its weight is 1 and the \
             others are 0, has one pure colour; along an edge the colour of the opposite corner is missing; in the middle all are equal.",
            Shown::Barycentric,
        ),
        Colors::Zebra => legend(
            "Stripes break at creases",
            "Stripes that the surface reflects. A stripe breaks off where the surface has a crease, and has a corner where only \
             its curvature changes. With surface normals they show the patches, otherwise the normals that are shaded.",
            Shown::Title,
        ),
        Colors::ShadingNormals => legend(
            "Normal: x red, y green, z blue",
            "Colours of shading normals in object space, as normal maps have them: a coordinate of -1 is 0 in its channel, \
             and 1 is 255. Seen from behind, the surface has the same colours.",
            Shown::Colors(normal_colors()),
        ),
        Colors::SurfaceNormals => legend(
            "Surface normal: x red, y green, z blue",
            "Colours of the normals of the curved patches themselves, without displacement, in object space, as normal maps have \
             them: a coordinate of -1 is 0 in its channel, and 1 is 255. Seen from behind, the surface has the same colours.",
            Shown::Colors(normal_colors()),
        ),
        Colors::Curvature => {
            let (kind, own) = (settings.curvature_kind, scale_of(settings, None, usual));
            let unit = if kind == CurvatureKind::Gaussian { "1/unit²" } else { "1/unit" };
            legend(
                &format!("{} curvature, {unit}", kind.label()),
                &format!(
                    "Colours of a curvature of the curved patches themselves, without displacement, in {unit} for object units: a \
                     sphere of radius r has 1 / r, and the Gaussian curvature 1 / r². {} Curvature up to, in the section Look, sets \
                     the scale's ends.",
                    kind.text()
                ),
                scale(own, &[own.least, 0.0, own.most], false),
            )
        }
        Colors::UvChecker => legend(
            &format!("UV: a square is 1/{} of a unit", tick_text(settings.checker_squares.round())),
            "A checker over texture coordinates. Red grows with u and green with v up to the next whole number, where there \
             is a line. Each square has an F, which is mirrored where the image would be, and the numbers of its column, from the \
             left, and of its row, from the top. Triangles without texture coordinates are plain grey, and so are squares smaller \
             than a px.",
            Shown::Colors(checker_colors()),
        ),
        Colors::TexelDensity => {
            let own = scale_of(settings, None, usual);
            let (unit, meaning) = match settings.texel_density_per {
                DensityPer::Px => (
                    "px",
                    "in a px of the picture. Below 1 the image is magnified and looks blurred; above 1 it has more detail than the \
                     picture shows.",
                ),
                DensityPer::Unit => (
                    "unit",
                    "along an object unit. In the middle of the scale is the power of two that is nearest to what half of the \
                     mesh's triangles have at most.",
                ),
            };
            legend(
                &format!("Texels per {unit}"),
                &format!(
                    "Colours of how many texels of the base colour's image lie side by side {meaning} A material without an image \
                     counts as if it had one of {TEXELS_WITHOUT_IMAGE} x {TEXELS_WITHOUT_IMAGE} px. Triangles without texture \
                     coordinates are plain grey."
                ),
                scale(own, &[1.0, 4.0, 8.0, 16.0, 64.0].map(|times| times * own.least), false),
            )
        }
        Colors::Factors => legend(
            "Factor",
            "Colours of tessellation factors, 1 to 64. Each patch shows its inside factor, and along an edge the edge's factor.",
            scale(FACTOR_SCALE, &[1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0], false),
        ),
        Colors::TriangleSize => legend(
            "Triangle size, px",
            "Colours of triangles by their size on screen, 3 to 64 px. The size is the side of a square with twice the \
             triangle's area. All triangles below 3 px have one colour.",
            scale(SIZE_SCALE, &[3.0, 4.0, 8.0, 16.0, 32.0, 64.0], true),
        ),
        Colors::LowFactors => legend(
            "Factors below 2",
            "One colour for patches whose factors are all below 2, edges and inside.",
            Shown::Waste,
        ),
        Colors::Excess => legend(
            "Triangles / fewest needed",
            "Colours of patches by how many times as many triangles they have as their own least, 1 to 16: the fewest with \
             which a patch alone would keep the tolerance of LOD by error.",
            scale(EXCESS_SCALE, &[1.0, 2.0, 4.0, 8.0, 16.0], false),
        ),
        Colors::Deviation => Some(deviation_legend(distances)),
        Colors::Silhouette => Some(silhouette_legend(distances.outlines)),
    }
}

/// The colours of normals along the axes.
fn normal_colors() -> Vec<([u8; 3], &'static str)> {
    let all = [("+x", 0, 255), ("+y", 1, 255), ("+z", 2, 255), ("-x", 0, 0), ("-y", 1, 0), ("-z", 2, 0)];
    let color = |(name, axis, byte)| {
        let mut color = [128; 3];
        color[axis] = byte;
        (color, name)
    };
    all.map(color).to_vec()
}

/// The colours of the checker's light squares just before whole numbers of u and of v, and of its lines.
fn checker_colors() -> Vec<([u8; 3], &'static str)> {
    let tinted = |tint: [f32; 3]| tint.map(|channel| srgb(CHECKER_LIGHT * channel));
    vec![(tinted(CHECKER_U), "u grows"), (tinted(CHECKER_V), "v grows"), (CHECKER_LINE, "unit")]
}

fn deviation_legend(distances: &Distances) -> Legend {
    let unit = match distances.unit {
        DeviationUnit::Units => "units",
        DeviationUnit::Px => "px",
    };
    let state = match distances.measured {
        Some(part) => format!(" (measuring, {:.0} %)", 100.0 * part),
        None if distances.is_partial => " (not of all triangles)".to_owned(),
        None => String::new(),
    };
    let scale = distances.scale.unwrap_or(DEVIATION_PX_SCALE);
    // The scale has two decades: a tick at each end and one between them.
    let ticks = [scale.least, (scale.least * scale.most).sqrt(), scale.most];
    Legend {
        title: format!("Deviation, {unit}{state}"),
        meaning:
            "Colours of the distance to the reference surface. The scale ends at the largest distance, rounded up, and \
                  begins at a hundredth of that; smaller distances have the first colour. What isn't measured is grey."
                .to_owned(),
        shown: Shown::Scale {
            scale,
            ticks: if distances.scale.is_some() { ticks.to_vec() } else { Vec::new() },
            waste: false,
        },
    }
}

fn silhouette_legend(distances: Option<OutlineDistances>) -> Legend {
    let away = |distance: fn(&OutlineDistances) -> Option<OutlineDistance>| match &distances {
        None => "comparing\u{2026}".to_owned(),
        Some(known) => distance(known)
            .map_or_else(|| "not both in view".to_owned(), |found| format!("up to {:.1} px away", found.px)),
    };
    let row = |of: OutlineOf, text: String| (SILHOUETTE_COLORS[of as usize], text);
    Legend {
        title: "Outlines".to_owned(),
        meaning: "The outline of the tessellated triangles, that of the source mesh, which are the mesh's own triangles, and that of \
                  the curved surface, drawn to within 0.1 px. The numbers are the largest distances of the triangles' outline from \
                  each of the others, in px, right to about half a px: a ring in the other's colour is around the place. A round \
                  outline is near the surface's; how far it is from the source's is what tessellation has gained."
            .to_owned(),
        shown: Shown::Rows(vec![
            row(OutlineOf::Triangles, "triangles".to_owned()),
            row(OutlineOf::Source, format!("source: {}", away(|known| known.from_source))),
            row(OutlineOf::Surface, format!("surface: {}", away(|known| known.from_surface))),
        ]),
    }
}

/// Formats a tick as shortly as possible. The ends of scales are round numbers.
pub(crate) fn tick_text(tick: f32) -> String {
    if tick < 0.0 {
        return format!("-{}", tick_text(-tick));
    }
    if tick == 0.0 || (1e-3..1e5).contains(&tick) {
        let rounded = format!("{tick:.5}");
        rounded.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        let rounded = format!("{tick:.1e}");
        rounded.replace(".0e", "e")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_short() {
        let texts = [64.0, 3.0, 0.1, 0.0025, 0.25, 1.5e-4, 2e-7, 150.0].map(tick_text);
        assert_eq!(texts, ["64", "3", "0.1", "0.0025", "0.25", "1.5e-4", "2e-7", "150"]);
        assert_eq!([0.0, -2.4, -3e-7].map(tick_text), ["0", "-2.4", "-3e-7"]);
    }
}

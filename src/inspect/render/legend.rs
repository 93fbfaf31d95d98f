//! What a legend says about the surface's colours.

use super::covered_area::{covered_area, intersection};
use super::layout::{CHECKER_LIGHT, CHECKER_LINE, CHECKER_U, CHECKER_V, srgb};
use super::outlines_picture::SILHOUETTE_COLORS;
use super::section::clip_from_object;
use super::{Camera, Scale, Scene, Usual, half_places};
use crate::measure::{OutlineDistance, OutlineDistances, OutlineOf};
use crate::settings::{Choice, Colors, Settings, SplitSide, SurfaceUnit};
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
        let Shown::Colors { colors, columns: 1 } = &self.shown else { return self.title.clone() };
        let rows: Vec<_> = colors.iter().map(|(_, text)| text.as_str()).collect();
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
    /// sRGB colours under the title, so many in a row, each with its name or what is said of it.
    Colors { colors: Vec<([u8; 3], String)>, columns: usize },
    /// A patch in its barycentric colours.
    Barycentric,
}

/// What is known of the distances to the reference surface, and between outlines.
pub struct Distances {
    /// That of distances in object units; none until something is measured.
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
    let (colors, kind) = (settings.overlays.colors, settings.curvature_kind);
    let own = usual.scale(settings, distances.scale);
    let scale = |ticks: &[f32], waste: bool| Shown::Scale { scale: own, ticks: ticks.to_vec(), waste };
    let mut meaning = colors.text().to_owned();
    let title = |title: &str| title.to_owned();
    let (title, shown) = match colors {
        Colors::Material | Colors::Clay | Colors::Matcap => return None,
        Colors::Barycentric => (title("Barycentric, weights in the patch"), Shown::Barycentric),
        Colors::Zebra => (title("Stripes break at creases"), Shown::Title),
        Colors::ShadingNormals => (title("Normal: x red, y green, z blue"), normal_colors()),
        Colors::SurfaceNormals => (title("Surface normal: x red, y green, z blue"), normal_colors()),
        Colors::Curvature => {
            let unit = if kind == CurvatureKind::Gaussian { "1/unit²" } else { "1/unit" };
            meaning = format!("{meaning} {}", kind.text());
            (format!("{} curvature, {unit}", kind.label()), scale(&[own.least, 0.0, own.most], false))
        }
        Colors::UvChecker => {
            let count = tick_text(settings.checker_squares.round());
            (format!("UV: a square is 1/{count} of a unit"), checker_colors())
        }
        Colors::TexelDensity => {
            let ticks = [1.0, 4.0, 8.0, 16.0, 64.0].map(|times| times * own.least);
            let unit = if settings.texel_density_per == SurfaceUnit::Px { "px" } else { "unit" };
            (format!("Texels per {unit}"), scale(&ticks, false))
        }
        Colors::Factors => (title("Factor"), scale(&[1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0], false)),
        Colors::TriangleSize => (title("Triangle size, px"), scale(&[3.0, 4.0, 8.0, 16.0, 32.0, 64.0], true)),
        Colors::LowFactors => (title("Factors below 2"), Shown::Waste),
        Colors::Excess => (title("Triangles / fewest needed"), scale(&[1.0, 2.0, 4.0, 8.0, 16.0], false)),
        Colors::Deviation => {
            let is_known = distances.scale.is_some() || settings.deviation_in == SurfaceUnit::Px;
            // The scale has two decades: a tick at each end and one between them.
            let ticks = [own.least, (own.least * own.most).sqrt(), own.most];
            (deviation_title(settings.deviation_in, distances), scale(if is_known { &ticks } else { &[] }, false))
        }
        Colors::Silhouette => (title("Outlines"), silhouette_rows(distances.outlines)),
    };
    Some(Legend { title, meaning, shown })
}

/// The half of a picture whose lower corner has the legend: the right one, unless there it would cover more than twice as much of
/// where the mesh can be. `size` is the picture's width and height in px, and `room` what the legend takes.
pub fn legend_side(scene: &Scene, camera: &Camera, settings: &Settings, [size, room]: [[u32; 2]; 2]) -> SplitSide {
    let viewport = size.map(|side| side as f32).into();
    let covered = |from_left: u32| -> u32 {
        let legend = [from_left, size[1].saturating_sub(room[1]), room[0], room[1]];
        let halves = SplitSide::BOTH.into_iter().zip(half_places(size, settings));
        let of_half = halves.filter_map(|(half, place)| {
            let (own, settings) = scene.half(half).zip(settings.half(half))?;
            let clip = clip_from_object(camera, viewport, &own.bounds, &settings);
            let bounds = own.bounds.grown(settings.reach(own.tessellator.mesh()));
            let [_, _, width, height] = intersection(legend, place.part(covered_area(&bounds, clip, size)).area);
            Some(width * height)
        });
        of_half.sum()
    };
    let ends = [covered(0), covered(size[0].saturating_sub(room[0]))];
    let [left, right] = if camera.is_mirrored() { [ends[1], ends[0]] } else { ends };
    if 2 * left < right { SplitSide::Left } else { SplitSide::Right }
}

/// The colours of normals along the axes.
fn normal_colors() -> Shown {
    let all = [("+x", 0, 255), ("+y", 1, 255), ("+z", 2, 255), ("-x", 0, 0), ("-y", 1, 0), ("-z", 2, 0)];
    let color = |(name, axis, byte): (&str, usize, u8)| {
        let mut color = [128; 3];
        color[axis] = byte;
        (color, name.to_owned())
    };
    Shown::Colors { colors: all.map(color).to_vec(), columns: 3 }
}

/// The colours of the checker's light squares just before whole numbers of u and of v, and of its lines.
fn checker_colors() -> Shown {
    let tinted = |tint: [f32; 3]| tint.map(|channel| srgb(CHECKER_LIGHT * channel));
    let all = [(tinted(CHECKER_U), "u grows"), (tinted(CHECKER_V), "v grows"), (CHECKER_LINE, "unit")];
    Shown::Colors { colors: all.map(|(color, name)| (color, name.to_owned())).to_vec(), columns: 3 }
}

fn deviation_title(unit: SurfaceUnit, distances: &Distances) -> String {
    let state = match distances.measured {
        Some(part) => format!(" (measuring, {:.0} %)", 100.0 * part),
        None if distances.is_partial => " (not of all triangles)".to_owned(),
        None => String::new(),
    };
    format!("Deviation, {}{state}", unit.name())
}

fn silhouette_rows(distances: Option<OutlineDistances>) -> Shown {
    let away = |distance: fn(&OutlineDistances) -> Option<OutlineDistance>| match &distances {
        None => "comparing\u{2026}".to_owned(),
        Some(known) => distance(known)
            .map_or_else(|| "not both in view".to_owned(), |found| format!("up to {:.1} px away", found.px)),
    };
    let row = |of: OutlineOf, text: String| (SILHOUETTE_COLORS[of as usize], text);
    let colors = vec![
        row(OutlineOf::Triangles, "triangles".to_owned()),
        row(OutlineOf::Source, format!("source: {}", away(|known| known.from_source))),
        row(OutlineOf::Surface, format!("surface: {}", away(|known| known.from_surface))),
    ];
    Shown::Colors { colors, columns: 1 }
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

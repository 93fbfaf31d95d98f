//! Draws the legend of the surface's colours: into a picture, or for the window to show.

use image::{RgbaImage, imageops};
use plotters::backend::BitMapBackend;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::plot::{self, ChartError, DENSITY};
use crate::render::layout::{WASTE_COLOR, srgb};
use crate::render::{Camera, Distances, Legend, Scale, Scene, Shown, legend_of, legend_side, tick_text};
use crate::settings::{Settings, SplitSide};

/// Sizes in points: the bar of the scale, the block of one colour before it, the margin, and the text.
const BAR: [f64; 2] = [196.0, 12.0];
const BLOCK_WIDTH: f64 = 42.0;
const MARGIN: f64 = 10.0;
const TEXT: f64 = 12.5;
/// Of a row of named colours.
const ROW: f64 = 17.0;
/// The width of a letter, about.
const LETTER: f64 = 6.6;
/// A point is this part of a picture's shorter side, so that legends are as legible in large pictures as in small ones.
const POINTS_A_SIDE: f64 = 600.0;
/// The sRGB colours of a plate and of what is written on it.
pub type Inks = [[u8; 3]; 2];
const ON_PICTURES: Inks = [[24; 3], [235; 3]];

const LEFT_TOP: Pos = Pos { h_pos: HPos::Left, v_pos: VPos::Top };
const MIDDLE_TOP: Pos = Pos { h_pos: HPos::Center, v_pos: VPos::Top };
const LEFT: Pos = Pos { h_pos: HPos::Left, v_pos: VPos::Center };

/// Draws the legend into a lower corner, if the picture's colours have one, where it covers less of the scene. In a split picture it is
/// the right half's, or if that has none the left one's.
///
/// # Errors
/// The font can't be used.
pub(crate) fn draw_legend(
    picture: &mut RgbaImage,
    scene: &Scene,
    camera: &Camera,
    settings: &Settings,
    distances: &Distances,
) -> Result<(), ChartError> {
    let legend = settings.halves().rev().find_map(|own| legend_of(&own, &scene.usual(), distances));
    let Some(legend) = legend else { return Ok(()) };
    let size = picture.dimensions().into();
    lay(picture, &legend, |taken| legend_side(scene, camera, settings, [size, taken]))
}

/// The legend as a picture in these colours, with so many px a point.
///
/// # Errors
/// The font can't be used.
pub fn legend_picture(legend: &Legend, point: f64, colors: Inks) -> Result<RgbaImage, ChartError> {
    plate(inner_size(legend), point, colors, |pen| paint(pen, legend))
}

/// Width and height inside the plate's margins, in points.
fn inner_size(legend: &Legend) -> [f64; 2] {
    match &legend.shown {
        Shown::Title => [214.0, 14.0],
        Shown::Waste => [112.0, 14.0],
        Shown::Scale { waste, .. } => [before_scale(*waste) + BAR[0], 52.0],
        Shown::Colors { colors, columns } => [BAR[0], 18.0 + ROW * colors.len().div_ceil(*columns) as f64],
        Shown::Barycentric => BARYCENTRIC,
    }
}

/// The width of what stands before a scale, in points.
fn before_scale(has_waste: bool) -> f64 {
    if has_waste { BLOCK_WIDTH + 10.0 } else { 0.0 }
}

fn paint(pen: &Pen, legend: &Legend) -> Drawn {
    let title = &legend.title;
    match &legend.shown {
        Shown::Title => pen.text(title, [0.0, 7.0], LEFT),
        Shown::Waste => named(pen, [0.0, 7.0], WASTE_COLOR, title),
        Shown::Scale { scale: shown, ticks, waste } => scale(pen, title, shown, ticks, before_scale(*waste)),
        Shown::Colors { colors, columns } => named_colors(pen, title, colors, *columns),
        Shown::Barycentric => barycentric(pen, title),
    }
}

/// A colour and what it stands for.
pub type Named = ([u8; 3], &'static str);

/// Draws colours with their names into the lower left corner, unless there are none.
///
/// # Errors
/// The font can't be used.
pub fn draw_key(picture: &mut RgbaImage, title: &str, rows: &[Named]) -> Result<(), ChartError> {
    if rows.is_empty() {
        return Ok(());
    }
    let colors = rows.iter().map(|(color, name)| (*color, (*name).to_owned())).collect();
    let shown = Shown::Colors { colors, columns: 1 };
    let key = Legend { title: title.to_owned(), meaning: String::new(), shown };
    lay(picture, &key, |_| SplitSide::Left)
}

/// A plate with lines of text for half of a picture of this size in px, and the margin around it in px.
///
/// # Errors
/// The font can't be used.
pub(super) fn plate_of_lines((width, height): (u32, u32), lines: &[&str]) -> Result<(RgbaImage, u32), ChartError> {
    let longest = lines.iter().map(|line| line.chars().count()).max().unwrap_or(0);
    let inner = [LETTER * longest as f64, ROW * lines.len() as f64];
    let point = point_in((width / 2, height), inner);
    let plate = plate(inner, point, ON_PICTURES, |pen| {
        let middles = (0..).map(|row| ROW * (f64::from(row) + 0.5));
        lines.iter().zip(middles).try_for_each(|(line, middle)| pen.text(line, [0.0, middle], LEFT))
    })?;
    Ok((plate, (MARGIN * point).round() as u32))
}

/// The size of a plate with this much room inside, in points.
fn plate_size(inner: [f64; 2]) -> [f64; 2] {
    [inner[0] + 2.0 * MARGIN, inner[1] + 12.0]
}

/// How many px a point has in a picture. In a small one all of a plate with this much room inside becomes smaller.
fn point_in((width, height): (u32, u32), inner: [f64; 2]) -> f64 {
    let (room, size) = ([width, height].map(f64::from), plate_size(inner));
    let usual = (room[0].min(room[1]) / POINTS_A_SIDE).max(1.0);
    usual.min(room[0] / (size[0] + 2.0 * MARGIN)).min(room[1] / (size[1] + 2.0 * MARGIN))
}

/// A plate with this much room inside, in points, and what `paint` puts there.
fn plate(inner: [f64; 2], point: f64, inks: Inks, paint: impl FnOnce(&Pen) -> Drawn) -> Result<RgbaImage, ChartError> {
    let [back, ink] = inks.map(|[r, g, b]| RGBColor(r, g, b));
    let px = plate_size(inner).map(|side| ((side * point).round() as u32).max(1));
    let plate = plot::bitmap(px, |area| {
        area.fill(&back)?;
        paint(&Pen { area, ink, point: point * f64::from(DENSITY), origin: [MARGIN, 6.0] })
    })?;
    Ok(image::DynamicImage::from(plate).to_rgba8())
}

/// Lays a legend into a lower corner: that of the half which `side` returns for the width and height in px that it takes.
fn lay(picture: &mut RgbaImage, legend: &Legend, side: impl FnOnce([u32; 2]) -> SplitSide) -> Result<(), ChartError> {
    let point = point_in(picture.dimensions(), inner_size(legend));
    let (plate, margin) = (legend_picture(legend, point, ON_PICTURES)?, (MARGIN * point).round() as u32);
    let side = side([plate.width(), plate.height()].map(|side| side + (2.0 * MARGIN * point) as u32));
    let right = picture.width().saturating_sub(plate.width() + margin);
    let top = picture.height().saturating_sub(plate.height() + margin);
    let left = if side == SplitSide::Left { margin } else { right };
    imageops::replace(picture, &plate, left.into(), top.into());
    Ok(())
}

type Drawn = Result<(), DrawingAreaErrorKind<<BitMapBackend<'static> as DrawingBackend>::ErrorType>>;

/// Draws on a plate, in points from the corner of the room inside it.
struct Pen<'a, 'b> {
    area: &'a DrawingArea<BitMapBackend<'b>, Shift>,
    ink: RGBColor,
    /// Drawn px.
    point: f64,
    origin: [f64; 2],
}

impl Pen<'_, '_> {
    fn px(&self, at: [f64; 2]) -> (i32, i32) {
        let [x, y] = [0, 1].map(|k| ((at[k] + self.origin[k]) * self.point).round() as i32);
        (x, y)
    }

    fn rect(&self, min: [f64; 2], max: [f64; 2], [r, g, b]: [u8; 3]) -> Drawn {
        self.area.draw(&Rectangle::new([self.px(min), self.px(max)], RGBColor(r, g, b).filled()))
    }

    fn text(&self, text: &str, at: [f64; 2], pos: Pos) -> Drawn {
        self.area.draw_text(text, &self.font().pos(pos), self.px(at))
    }

    /// The width of a text in points.
    fn width(&self, text: &str) -> f64 {
        self.area.estimate_text_size(text, &self.font()).map_or(0.0, |(px, _)| f64::from(px) / self.point)
    }

    fn font(&self) -> TextStyle<'_> {
        plot::font((TEXT * self.point).round() as i32).color(&self.ink)
    }
}

/// A block of one colour, its left side in the middle at a place, and the colour's name.
fn named(pen: &Pen, [left, middle]: [f64; 2], color: [u8; 3], name: &str) -> Drawn {
    let half = 0.5 * BAR[1];
    pen.rect([left, middle - half], [left + BAR[1], middle + half], color)?;
    pen.text(name, [left + BAR[1] + 8.0, middle], LEFT)
}

/// Colours with their names or what they stand for, under a title, so many in a row.
fn named_colors(pen: &Pen, title: &str, colors: &[([u8; 3], String)], columns: usize) -> Drawn {
    pen.text(title, [0.0, 0.0], LEFT_TOP)?;
    for (index, (color, name)) in colors.iter().enumerate() {
        let [column, row] = [index % columns, index / columns].map(|place| place as f64);
        named(pen, [column * BAR[0] / columns as f64, 18.0 + ROW * (row + 0.5)], *color, name)?;
    }
    Ok(())
}

/// A scale with its title and numbers, from `left` on. Before it is the block of what is below it, if there is room.
fn scale(pen: &Pen, title: &str, scale: &Scale, ticks: &[f32], left: f64) -> Drawn {
    pen.text(title, [0.0, 0.0], LEFT_TOP)?;
    let (top, bottom) = (20.0, 20.0 + BAR[1]);
    if left > 0.0 {
        pen.rect([0.0, top], [BLOCK_WIDTH, bottom], WASTE_COLOR)?;
        pen.text(&format!("below {}", scale.least), [BLOCK_WIDTH / 2.0, bottom + 4.0], MIDDLE_TOP)?;
    }
    let pieces = (BAR[0] * pen.point).ceil().max(1.0) as u32;
    for piece in 0..pieces {
        let [from, to] = [piece, piece + 1].map(|end| f64::from(end) / f64::from(pieces));
        let color = scale.color((0.5 * (from + to)) as f32);
        pen.rect([left + from * BAR[0], top], [left + to * BAR[0], bottom], color)?;
    }
    let RGBColor(r, g, b) = pen.ink;
    for &tick in ticks {
        let x = left + f64::from(scale.place(tick)) * BAR[0];
        pen.rect([x - 0.5, bottom], [x + 0.5, bottom + 3.0], [r, g, b])?;
        // Long numbers at the ends are moved inwards, so that they stay on the plate.
        let (text, half) = (tick_text(tick), 0.5 * pen.width(&tick_text(tick)));
        let (first, last) = (left - 6.0 + half, left + BAR[0] + 6.0 - half);
        let middle = if first < last { x.clamp(first, last) } else { x };
        pen.text(&text, [middle, bottom + 4.0], MIDDLE_TOP)?;
    }
    Ok(())
}

/// Sizes of the legend of barycentric colours in points: all of it, and the patch.
const BARYCENTRIC: [f64; 2] = [180.0, 78.0];
const PATCH: [f64; 2] = [66.0, 56.0];

/// A patch in its barycentric colours, and which corner each colour belongs to.
fn barycentric(pen: &Pen, title: &str) -> Drawn {
    pen.text(title, [0.0, 0.0], LEFT_TOP)?;
    let top = BARYCENTRIC[1] - PATCH[1];
    let ((left, above), (right, below)) = (pen.px([0.0, top]), pen.px([PATCH[0], BARYCENTRIC[1]]));
    for (y, x) in (above..below).flat_map(|y| (left..right).map(move |x| (y, x))) {
        // Weights of the lower left, the lower right and the upper corner.
        let w = f64::from(below - y) / f64::from((below - above).max(1));
        let v = f64::from(x - left) / f64::from((right - left).max(1)) - 0.5 * w;
        let weights = [1.0 - v - w, v, w];
        if weights.iter().all(|weight| *weight >= 0.0) {
            let [r, g, b] = weights.map(|weight| srgb(weight as f32));
            pen.area.draw_pixel((x, y), &RGBColor(r, g, b))?;
        }
    }
    for (corner, weight) in ["u", "v", "w"].into_iter().enumerate() {
        let (left, middle) = (PATCH[0] + 14.0, top + 17.0 * (corner as f64 + 0.5) + 2.5);
        let mut color = [0; 3];
        color[corner] = 255;
        pen.rect([left, middle - 5.0], [left + 10.0, middle + 5.0], color)?;
        pen.text(&format!("{weight}: corner {corner}"), [left + 17.0, middle], LEFT)?;
    }
    Ok(())
}

//! Draws the parts of a chart into a bitmap or an SVG file. All coordinates and sizes are in px of the chart.

use plotters::coord::Shift;
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::method_style::{Fill, MethodStyle, Shape};
use inspect::plot::{self, DENSITY, INK};

/// Draws into an area, in px of the chart.
pub(super) struct Pen<'a, DB: DrawingBackend>(pub &'a DrawingArea<DB, Shift>);

pub(super) type Drawn<DB> = Result<(), DrawingAreaErrorKind<<DB as DrawingBackend>::ErrorType>>;

/// Text starts at its place, or is centred on it.
pub(super) const LEFT: Pos = Pos { h_pos: HPos::Left, v_pos: VPos::Center };
pub(super) const MIDDLE: Pos = Pos { h_pos: HPos::Center, v_pos: VPos::Center };

/// The colour under the front: the points that no other point beats.
pub(super) const FRONT: RGBColor = RGBColor(214, 214, 214);

/// The radius of a marker in px.
pub const RADIUS: f64 = 3.6;

/// The px that are drawn for a place.
pub(super) fn px([x, y]: [f64; 2]) -> (i32, i32) {
    let density = f64::from(DENSITY);
    ((x * density).round() as i32, (y * density).round() as i32)
}

/// The place of px that are drawn.
pub(super) fn place_of((x, y): (i32, i32)) -> [f64; 2] {
    [x, y].map(|px| f64::from(px) / f64::from(DENSITY))
}

pub(super) fn width(px: f64) -> u32 {
    (px * f64::from(DENSITY)).round() as u32
}

impl<DB: DrawingBackend> Pen<'_, DB> {
    pub(super) fn line(&self, points: &[[f64; 2]], color: impl Color, thick: f64, dash: Option<[f64; 2]>) -> Drawn<DB> {
        let points: Vec<_> = points.iter().copied().map(px).collect();
        let style = color.stroke_width(width(thick));
        match dash {
            None => self.0.draw(&PathElement::new(points, style)),
            Some([drawn, left_out]) => {
                self.0.draw(&DashedPathElement::new(points, width(drawn), width(left_out), style))
            }
        }
    }

    /// Draws text at a place. `size` is its height in px.
    pub(super) fn text(&self, text: &str, at: [f64; 2], size: i32, pos: Pos) -> Drawn<DB> {
        self.0.draw_text(text, &font(size).pos(pos), px(at))
    }

    /// The width of text in px. In an SVG file it is an estimate, since the viewer's font may be wider.
    pub(super) fn text_width(&self, text: &str, size: i32) -> f64 {
        let letters = 0.55 * f64::from(size) * text.chars().count() as f64;
        self.0.estimate_text_size(text, &font(size)).map_or(letters, |(px, _)| f64::from(px) / f64::from(DENSITY))
    }

    /// Draws a method's marker, with a white outline that sets it off from others.
    pub(super) fn marker(&self, at: [f64; 2], style: &MethodStyle) -> Drawn<DB> {
        self.shape(at, style.shape, RADIUS + 1.2, WHITE.filled())?;
        self.shape(at, style.shape, RADIUS, style.color.filled())?;
        match style.fill {
            Fill::Full => Ok(()),
            Fill::Hollow => self.shape(at, style.shape, RADIUS - 1.6, WHITE.filled()),
            Fill::Pale => {
                self.shape(at, style.shape, RADIUS - 1.2, WHITE.filled())?;
                self.shape(at, style.shape, RADIUS - 1.2, style.color.mix(0.4).filled())
            }
        }
    }

    pub(super) fn shape(&self, at: [f64; 2], shape: Shape, radius: f64, style: ShapeStyle) -> Drawn<DB> {
        if shape == Shape::Disc {
            return self.0.draw(&Circle::new(px(at), width(radius) as i32, style));
        }
        shape.pieces(radius).into_iter().try_for_each(|piece| {
            let corners: Vec<_> = piece.into_iter().map(|[x, y]| px([at[0] + x, at[1] + y])).collect();
            self.0.draw(&Polygon::new(corners, style))
        })
    }
}

pub(super) fn font(size: i32) -> TextStyle<'static> {
    plot::font(size * DENSITY as i32).color(&INK)
}

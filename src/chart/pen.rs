//! What a chart is drawn with, into a bitmap or an SVG file alike. All is in px of the chart.

use plotters::coord::Shift;
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::look::{Fill, Look, Shape};
use crate::plot::{self, DENSITY, INK};

/// An area, and how one draws in px of the chart.
pub(super) struct Pen<'a, DB: DrawingBackend>(pub &'a DrawingArea<DB, Shift>);

pub(super) type Drawn<DB> = Result<(), DrawingAreaErrorKind<<DB as DrawingBackend>::ErrorType>>;

/// Where text is beside its place.
pub(super) const LEFT: Pos = Pos { h_pos: HPos::Left, v_pos: VPos::Center };
pub(super) const MIDDLE: Pos = Pos { h_pos: HPos::Center, v_pos: VPos::Center };
pub(super) const RIGHT: Pos = Pos { h_pos: HPos::Right, v_pos: VPos::Center };

/// Under the points that nothing beats.
pub(super) const FRONT: RGBColor = RGBColor(214, 214, 214);

/// From the middle of a point to its rim.
pub(crate) const RADIUS: f64 = 3.6;

fn px([x, y]: [f64; 2]) -> (i32, i32) {
    let density = f64::from(DENSITY);
    ((x * density).round() as i32, (y * density).round() as i32)
}

fn width(px: f64) -> u32 {
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

    pub(super) fn rect(&self, min: [f64; 2], max: [f64; 2], style: impl Into<ShapeStyle>) -> Drawn<DB> {
        self.0.draw(&Rectangle::new([px(min), px(max)], style))
    }

    /// Text of a size in px, beside a place.
    pub(super) fn text(&self, text: &str, at: [f64; 2], size: i32, pos: Pos) -> Drawn<DB> {
        self.0.draw_text(text, &font(size).pos(pos), px(at))
    }

    /// The same, read from below.
    pub(super) fn text_upwards(&self, text: &str, at: [f64; 2], size: i32) -> Drawn<DB> {
        self.0.draw_text(text, &font(size).pos(MIDDLE).transform(FontTransform::Rotate270), px(at))
    }

    /// How wide text will be; letters of another font may be wider.
    pub(super) fn text_width(&self, text: &str, size: i32) -> f64 {
        let letters = 0.55 * f64::from(size) * text.chars().count() as f64;
        self.0.estimate_text_size(text, &font(size)).map_or(letters, |(px, _)| f64::from(px) / f64::from(DENSITY))
    }

    /// A point of a method, with a rim of white, so that it is seen before others.
    pub(super) fn marker(&self, at: [f64; 2], look: &Look) -> Drawn<DB> {
        self.shape(at, look.shape, RADIUS + 1.2, WHITE.filled())?;
        self.shape(at, look.shape, RADIUS, look.color.filled())?;
        match look.fill {
            Fill::Full => Ok(()),
            Fill::Hollow => self.shape(at, look.shape, RADIUS - 1.6, WHITE.filled()),
            Fill::Pale => {
                self.shape(at, look.shape, RADIUS - 1.2, WHITE.filled())?;
                self.shape(at, look.shape, RADIUS - 1.2, look.color.mix(0.4).filled())
            }
        }
    }

    fn shape(&self, at: [f64; 2], shape: Shape, radius: f64, style: ShapeStyle) -> Drawn<DB> {
        if shape == Shape::Disc {
            return self.0.draw(&Circle::new(px(at), width(radius) as i32, style));
        }
        shape.pieces(radius).into_iter().try_for_each(|piece| {
            let corners: Vec<_> = piece.into_iter().map(|[x, y]| px([at[0] + x, at[1] + y])).collect();
            self.0.draw(&Polygon::new(corners, style))
        })
    }
}

fn font(size: i32) -> TextStyle<'static> {
    plot::font(size * DENSITY as i32).color(&INK)
}

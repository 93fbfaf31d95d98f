//! The picture of a chart: for each mesh, the error over time and over triangles, side by side.

use image::RgbImage;
use plotters::coord::Shift;
use plotters::coord::cartesian::Cartesian2d;
use plotters::prelude::*;

use super::axis::Axis;
use super::labels::{LabelRequest, Rect, place};
use super::legend::{Entry, draw_legend, legend, method_styles};
use super::method_style::Shape;
use super::pen::{Drawn, FRONT, LEFT, MIDDLE, Pen, font, place_of, px, width};
use super::{Cost, Method, Row, Subject};
use geometry::names::wrapped;
use inspect::plot::{self, ChartError, DENSITY, INK};
use inspect::shot::ShotError;

/// The picture's width in px: that of pictures in a README.
const WIDTH: u32 = 960;
/// The space to the left and right of the panels and between them, and the height of panels, in px.
const LEFT_MARGIN: f64 = 70.0;
const RIGHT_MARGIN: f64 = 16.0;
const BETWEEN: f64 = 34.0;
const PANEL_HEIGHT: f64 = 380.0;
/// The heights of what is above and below the panels of a mesh, and of a line of text, in px.
const HEAD: f64 = 48.0;
const FOOT: f64 = 50.0;
const LINE: f64 = 19.0;
/// The space beyond the names of axes, in px.
const DESCRIBED: f64 = 10.0;
/// Sizes of text, in px.
const TITLE: i32 = 18;
const TEXT: i32 = 14;
const SMALL: i32 = 12;

const GRID: RGBColor = RGBColor(236, 236, 236);
const FINE_GRID: RGBColor = RGBColor(246, 246, 246);

/// Draws charts as a bitmap.
pub fn bitmap(subjects: &[Subject]) -> Result<RgbImage, ShotError> {
    let layout = Layout::from_subjects(subjects);
    Ok(plot::bitmap([WIDTH, layout.height()], |area| layout.draw(area))?)
}

/// Draws charts as an SVG file. Its labels are text.
pub fn svg(subjects: &[Subject]) -> Result<String, ShotError> {
    plot::use_font()?;
    let layout = Layout::from_subjects(subjects);
    let (size, drawn) = ([WIDTH, layout.height()], [WIDTH, layout.height()].map(|side| side * DENSITY));
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, drawn.into()).into_drawing_area();
        layout.draw(&area).map_err(|error| ChartError::failed(&error))?;
        area.present().map_err(|error| ChartError::failed(&error))?;
    }
    // The library draws in whole px, so the file is drawn larger than it is shown.
    let sides = |[width, height]: [u32; 2]| format!("width=\"{width}\" height=\"{height}\"");
    Ok(text.replacen(&sides(drawn), &sides(size), 1))
}

/// The layout of all charts: their subjects with the lines of text below them, and the legend.
struct Layout<'a> {
    subjects: Vec<(&'a Subject, Vec<String>)>,
    legend: Vec<Vec<Entry>>,
}

/// The most letters in a line of text. Longer sentences are broken.
const LETTERS: usize = 145;

impl<'a> Layout<'a> {
    fn from_subjects(subjects: &'a [Subject]) -> Self {
        let lines = |subject: &Subject| subject.sentences().iter().flat_map(|text| wrapped(text, LETTERS)).collect();
        Self { subjects: subjects.iter().map(|subject| (subject, lines(subject))).collect(), legend: legend(subjects) }
    }

    fn height(&self) -> u32 {
        let parts = self.subjects.iter().map(|(_, lines)| part_height(lines));
        (parts.sum::<f64>() + LINE * self.legend.len() as f64 + 22.0) as u32
    }

    fn draw<DB: DrawingBackend>(&self, area: &DrawingArea<DB, Shift>) -> Drawn<DB> {
        area.fill(&WHITE)?;
        let pen = Pen(area);
        let mut top = 0.0;
        for (subject, lines) in &self.subjects {
            draw_subject(&pen, subject, lines, top)?;
            top += part_height(lines);
        }
        for (entries, line) in self.legend.iter().zip(0..) {
            draw_legend(&pen, entries, [LEFT_MARGIN, top + 10.0 + LINE * f64::from(line)], TEXT)?;
        }
        Ok(())
    }
}

fn part_height(lines: &[String]) -> f64 {
    HEAD + PANEL_HEIGHT + FOOT + LINE * lines.len() as f64 + 14.0
}

fn draw_subject<DB: DrawingBackend>(pen: &Pen<DB>, subject: &Subject, lines: &[String], top: f64) -> Drawn<DB> {
    let facts = subject.facts();
    pen.text(&subject.title, [LEFT_MARGIN, top + 20.0], TITLE, LEFT)?;
    let after = LEFT_MARGIN + pen.text_width(&subject.title, TITLE) * 1.08 + 12.0;
    pen.text(&facts, [after, top + 21.0], TEXT, LEFT)?;
    let across = (f64::from(WIDTH) - LEFT_MARGIN - RIGHT_MARGIN - BETWEEN) / 2.0;
    for (cost, left, margin) in [(Cost::Ms, 0.0, LEFT_MARGIN), (Cost::Triangles, LEFT_MARGIN + across, BETWEEN)] {
        draw_diagram((subject, cost), pen, [left, top + HEAD], [margin, across])?;
    }
    let mut y = top + HEAD + PANEL_HEIGHT + FOOT + LINE / 2.0;
    for line in lines {
        pen.text(line, [LEFT_MARGIN, y], TEXT, LEFT)?;
        y += LINE;
    }
    Ok(())
}

/// The error over one cost.
type Diagram<'a, DB> = ChartContext<'a, DB, Cartesian2d<Axis, Axis>>;

/// Draws the axes, from a corner on. `margin` is the space to the left of the diagram, and `across` its width, in px; the first one
/// has the names of errors there.
fn axes<'d, DB: DrawingBackend>(
    (subject, cost): (&Subject, Cost),
    pen: &Pen<'d, DB>,
    [left, top]: [f64; 2],
    [margin, across]: [f64; 2],
) -> Result<Diagram<'d, DB>, DrawingAreaErrorKind<DB::ErrorType>> {
    let known = || subject.rows.iter().filter_map(|row| Some((row, subject.error(&row.probe)?)));
    let unit = subject.unit();
    let x = Axis::around(known().map(|(row, _)| cost.of(&row.probe)), 0.0);
    let y = Axis::around(known().map(|(_, error)| error * unit), subject.floor() * unit);
    let area = pen.0.clone().shrink(px([left, top]), px([margin + across, PANEL_HEIGHT + FOOT]));
    let mut chart = ChartBuilder::on(&area)
        .margin_left(width(DESCRIBED))
        .margin_bottom(width(DESCRIBED))
        .x_label_area_size(width(FOOT - DESCRIBED))
        .y_label_area_size(width(margin - DESCRIBED))
        .build_cartesian_2d(x, y)?;
    let is_first = left == 0.0;
    chart
        .configure_mesh()
        .x_desc(cost.name())
        .y_desc(if is_first { subject.error_name() } else { "" })
        .axis_desc_style(font(TEXT))
        .label_style(font(TEXT))
        .x_label_formatter(&|value| x.text(x.place(*value)))
        .y_label_formatter(&|value| if is_first { y.text(y.place(*value)) } else { String::new() })
        .set_all_tick_mark_size(width(5.0))
        .bold_line_style(GRID.stroke_width(DENSITY))
        .light_line_style(FINE_GRID.stroke_width(DENSITY))
        .axis_style(INK.stroke_width(DENSITY))
        .draw()?;
    Ok(chart)
}

/// Draws a diagram, as [`axes`] draws its axes.
fn draw_diagram<DB: DrawingBackend>(
    shown: (&Subject, Cost),
    pen: &Pen<DB>,
    corner: [f64; 2],
    across: [f64; 2],
) -> Drawn<DB> {
    let (subject, cost) = shown;
    let chart = axes(shown, pen, corner, across)?;
    let point = |row: &Row, error: f64| place_of(chart.backend_coord(&(cost.of(&row.probe), error * subject.unit())));
    let races = subject.races();
    let fronts: Vec<_> = races.iter().map(|race| race.front(|row| cost.of(&row.probe))).collect();
    for front in &fronts {
        let points: Vec<_> = front.iter().map(|(row, error)| point(row, *error)).collect();
        pen.line(&points, FRONT, 9.0, None)?;
        // Discs, because a front of one point has no line.
        points.iter().try_for_each(|at| pen.shape(*at, Shape::Disc, 4.5, FRONT.filled()))?;
    }
    let methods = method_styles(subject);
    let rows = |method: Method| {
        let own = subject.rows.iter().filter(move |row| row.setting.method == method);
        own.filter_map(|row| Some((row, subject.error(&row.probe)?)))
    };
    let mut all: Vec<(&Row, [f64; 2])> = Vec::new();
    let mut lines = Vec::new();
    for (method, style) in &methods {
        let points: Vec<_> = rows(*method).map(|(row, error)| (row, point(row, error))).collect();
        let path: Vec<_> = points.iter().map(|(_, point)| *point).collect();
        pen.line(&path, style.color, 1.4, style.dash)?;
        lines.extend(path.windows(2).map(|ends| [ends[0], ends[1]]));
        all.extend(points);
    }
    for (method, style) in &methods {
        rows(*method).try_for_each(|(row, error)| pen.marker(point(row, error), style))?;
    }
    // Points on the front get their labels first.
    let is_front = |row: &Row| fronts.iter().flatten().any(|(other, _)| std::ptr::eq(*other, row));
    all.sort_by_key(|(row, _)| !is_front(row));
    let (across, down) = chart.plotting_area().get_pixel_range();
    let frame = Rect { min: place_of((across.start, down.start)), max: place_of((across.end, down.end)) };
    draw_labels(pen, &all, &lines, frame)
}

fn draw_labels<DB: DrawingBackend>(
    pen: &Pen<DB>,
    all: &[(&Row, [f64; 2])],
    lines: &[[[f64; 2]; 2]],
    frame: Rect,
) -> Drawn<DB> {
    let texts: Vec<String> = all.iter().map(|(row, _)| row.setting.label()).collect();
    let points: Vec<_> = all.iter().map(|(_, point)| *point).collect();
    let size = |text: &str| [pen.text_width(text, SMALL) * 1.08, f64::from(SMALL)];
    let wanted: Vec<_> = points.iter().zip(&texts).map(|(&at, text)| LabelRequest { at, size: size(text) }).collect();
    for (text, rect) in texts.iter().zip(place(&wanted, &points, lines, frame)) {
        if let Some(Rect { min, max }) = rect {
            pen.text(text, [(min[0] + max[0]) / 2.0, (min[1] + max[1]) / 2.0], SMALL, MIDDLE)?;
        }
    }
    Ok(())
}

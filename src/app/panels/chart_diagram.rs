//! The chart's picture: error against time or triangles, both logarithmic, and what lies under the pointer.

use egui::{Color32, Pos2, Stroke, vec2};
use egui_plot::{GridInput, GridMark, Plot, PlotPoint, PlotTransform};

use crate::app::jobs::chart_job::Charted;
use crate::chart::{
    Axis, Cost, Fill, Method, MethodStyle, RADIUS, Row, Setting, Shape, Tick, method_styles, tick_text,
};
use crate::plot::INK;

/// What is drawn.
pub struct Diagram<'a> {
    pub charted: &'a Charted,
    pub cost: Cost,
    /// Whether it is of something else than what is shown.
    pub is_stale: bool,
    /// The window's own setting.
    pub own: Option<Setting>,
}

/// A point of it.
#[derive(Clone, Copy)]
pub enum Spot<'a> {
    Row(&'a Row),
    /// What the window has, measured beside the list.
    Current,
}

/// How far around a point the pointer finds it, in points.
const REACH: f32 = 9.0;
/// The rings around the window's own setting, and around what a click applies, in points.
const RING: f32 = 8.5;
/// How far beyond the outermost values the axes go, and how far below them what is as good as 0 lies, in decades.
const SLACK: f64 = 0.1;
const ZERO: f64 = 0.35;

/// Logarithms of values along an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Logs {
    low: f64,
    high: f64,
    /// Where what is as good as 0 lies, if something is.
    zero: Option<f64>,
}

impl Logs {
    /// Around these values, all that are above `floor`.
    fn around(values: impl Iterator<Item = f64>, floor: f64) -> Self {
        let (mut low, mut high, mut has_zero) = (f64::INFINITY, f64::NEG_INFINITY, false);
        for value in values {
            if value > floor {
                (low, high) = (low.min(value.log10()), high.max(value.log10()));
            } else {
                has_zero = true;
            }
        }
        // Nothing to show is a chart too.
        if low > high {
            (low, high) = (-1.0, 1.0);
        }
        let low = low - SLACK;
        Self { low, high: high + SLACK, zero: has_zero.then_some(low - ZERO) }
    }

    fn place(&self, value: f64) -> f64 {
        let log = value.log10();
        self.zero.filter(|_| log < self.low).unwrap_or(log)
    }

    fn start(&self) -> f64 {
        self.zero.map_or(self.low, |zero| zero - SLACK)
    }

    /// Ticks as the chart's files have them.
    fn marks(&self, (from, to): (f64, f64)) -> Vec<GridMark> {
        let values = [from.max(self.low), to].map(|log| 10f64.powf(log));
        let ticks = Axis { values, px: [0.0, 1.0], zero_px: 0.0 }.ticks();
        // What is written, the plot takes for a step of a decade, and the rest for fine lines.
        let mark = |Tick { value, named }| GridMark { value: value.log10(), step_size: if named { 1.0 } else { 0.03 } };
        let zero = self.zero.map(|value| GridMark { value, step_size: 1.0 });
        ticks.into_iter().map(mark).chain(zero).collect()
    }

    fn text(&self, mark: GridMark) -> String {
        if self.zero.is_some_and(|zero| mark.value < zero + 1e-9) {
            "0".into()
        } else {
            tick_text(10f64.powf(mark.value))
        }
    }
}

impl<'a> Diagram<'a> {
    /// Draws it as large as there is room; what the pointer is on, and whether that was clicked.
    pub fn show(&self, ui: &mut egui::Ui) -> Option<(Spot<'a>, bool)> {
        let subject = &self.charted.subject;
        let spots = self.spots();
        let x = Logs::around(spots.iter().map(|(_, [cost, _])| *cost), 0.0);
        let y = Logs::around(spots.iter().map(|(_, [_, error])| *error), subject.floor() * subject.unit());
        // A plot keeps its view until it is reset: another cost is another plot.
        let plot = Plot::new(("chart", self.cost == Cost::Ms))
            .x_axis_label(self.cost.name())
            .y_axis_label(if subject.truth.is_some() { "Error, % of diagonal" } else { "Error, px" })
            .grid_color(ui.visuals().weak_text_color().gamma_multiply(0.5))
            .x_grid_spacer(move |input: GridInput| x.marks(input.bounds))
            .y_grid_spacer(move |input: GridInput| y.marks(input.bounds))
            .x_axis_formatter(move |mark, _| x.text(mark))
            .y_axis_formatter(move |mark, _| y.text(mark))
            .include_x(x.start())
            .include_x(x.high)
            .include_y(y.start())
            .include_y(y.high)
            .set_margin_fraction(egui::Vec2::ZERO)
            .label_formatter(|_| None)
            .show_crosshair(false)
            .allow_scroll(false)
            .allow_axis_zoom_drag(false);
        let shown = plot.show(ui, |_| ());
        let response = shown.response;
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "Chart"));
        let canvas = Canvas { painter: ui.painter_at(*shown.transform.frame()), transform: shown.transform, x, y };
        self.paint(ui, &canvas, &spots);
        let pointer = response.hover_pos()?;
        let distance = |at: &[f64; 2]| canvas.place(*at).distance(pointer);
        let (spot, at) = spots.iter().min_by(|a, b| distance(&a.1).total_cmp(&distance(&b.1)))?;
        if distance(at) > REACH {
            return None;
        }
        canvas.painter.circle_stroke(canvas.place(*at), RING, Stroke::new(1.0, ui.visuals().text_color()));
        ui.ctx().set_cursor_icon(egui::CursorIcon::PointingHand);
        Some((*spot, response.clicked()))
    }

    /// Points whose error is known, with their cost and their error as it is shown.
    fn spots(&self) -> Vec<(Spot<'a>, [f64; 2])> {
        let subject = &self.charted.subject;
        let of_row = |row: &'a Row| Some((Spot::Row(row), [self.cost.of(row), subject.error(row)? * subject.unit()]));
        let current = self.charted.current.and_then(|(_, probe)| {
            let probe = probe?;
            let error = subject.error_of(probe.errors, probe.max_error_px)? * subject.unit();
            Some((Spot::Current, [self.cost.either(probe.time.total(), probe.triangles), error]))
        });
        subject.rows.iter().filter_map(of_row).chain(current).collect()
    }

    fn paint(&self, ui: &egui::Ui, canvas: &Canvas, spots: &[(Spot, [f64; 2])]) {
        let subject = &self.charted.subject;
        let inks = Inks::new(ui, self.is_stale);
        for race in subject.races() {
            let front = race.front(|row| self.cost.of(row)).into_iter();
            let places: Vec<_> =
                front.map(|(row, error)| canvas.place([self.cost.of(row), error * subject.unit()])).collect();
            // A front of one point is no line.
            for place in &places {
                canvas.painter.circle_filled(*place, 4.5, inks.front);
            }
            canvas.painter.line(places, Stroke::new(9.0, inks.front));
        }
        let styles = method_styles(subject);
        let of = |method: Method| {
            let own = move |spot: &Spot| matches!(spot, Spot::Row(row) if row.setting.method == method);
            spots.iter().filter(move |(spot, _)| own(spot)).map(|(_, at)| canvas.place(*at))
        };
        for (method, style) in &styles {
            line(&canvas.painter, &of(*method).collect::<Vec<_>>(), Stroke::new(1.4, inks.of(style)), style.dash);
        }
        for (method, style) in &styles {
            of(*method).for_each(|place| marker(&canvas.painter, place, style, &inks));
        }
        for (spot, at) in spots {
            let place = canvas.place(*at);
            match spot {
                Spot::Row(row) if Some(row.setting) == self.own => self.ring(ui, canvas, place),
                Spot::Row(_) => {}
                Spot::Current => {
                    let Some((settings, _)) = &self.charted.current else { continue };
                    marker(&canvas.painter, place, &MethodStyle::of_surface(settings.tessellation.surface), &inks);
                    self.ring(ui, canvas, place);
                }
            }
        }
    }

    /// Says that this is what the window shows.
    fn ring(&self, ui: &egui::Ui, canvas: &Canvas, place: Pos2) {
        let color = ui.visuals().strong_text_color();
        canvas.painter.circle_stroke(place, RING, Stroke::new(2.0, color));
        let font = egui::TextStyle::Small.resolve(ui.style());
        let is_right = place.x < canvas.transform.frame().center().x;
        let (align, aside) =
            if is_right { (egui::Align2::LEFT_CENTER, RING) } else { (egui::Align2::RIGHT_CENTER, -RING) };
        let galley = canvas.painter.layout_no_wrap("current".into(), font, color);
        let rect = align.anchor_size(place + vec2(1.4 * aside, 0.0), galley.size());
        canvas.painter.rect_filled(rect.expand(1.0), 2.0, ui.visuals().extreme_bg_color.gamma_multiply(0.8));
        canvas.painter.galley(rect.min, galley, color);
    }
}

/// Where one paints.
struct Canvas {
    painter: egui::Painter,
    transform: PlotTransform,
    x: Logs,
    y: Logs,
}

impl Canvas {
    fn place(&self, [cost, error]: [f64; 2]) -> Pos2 {
        self.transform.position_from_point(&PlotPoint::new(self.x.place(cost), self.y.place(error)))
    }
}

/// Colours of this theme.
pub struct Inks {
    /// Between points and whatever is under them.
    rim: Color32,
    front: Color32,
    text: Color32,
    /// For all methods alike.
    stale: Option<Color32>,
}

impl Inks {
    pub fn new(ui: &egui::Ui, is_stale: bool) -> Self {
        let visuals = ui.visuals();
        let front = Color32::from_gray(if visuals.dark_mode { 62 } else { 222 });
        let stale = is_stale.then(|| Color32::from_gray(if visuals.dark_mode { 112 } else { 165 }));
        Self { rim: visuals.extreme_bg_color, front, text: visuals.strong_text_color(), stale }
    }

    pub fn front(&self) -> Color32 {
        self.front
    }

    pub fn text(&self) -> Color32 {
        self.text
    }

    /// The chart's ink is the theme's.
    fn of(&self, style: &MethodStyle) -> Color32 {
        let color = style.color;
        let own = if color == INK { self.text } else { Color32::from_rgb(color.0, color.1, color.2) };
        self.stale.unwrap_or(own)
    }
}

/// A line as methods have them.
pub fn line(painter: &egui::Painter, points: &[Pos2], stroke: Stroke, dash: Option<[f64; 2]>) {
    match dash {
        None => {
            painter.line(points.to_vec(), stroke);
        }
        Some([drawn, left_out]) => {
            painter.extend(egui::Shape::dashed_line(points, stroke, drawn as f32, left_out as f32));
        }
    }
}

/// A method's point.
pub fn marker(painter: &egui::Painter, at: Pos2, style: &MethodStyle, inks: &Inks) {
    let color = inks.of(style);
    let shape = |radius: f64, color: Color32| {
        if style.shape == Shape::Disc {
            painter.circle_filled(at, radius as f32, color);
        }
        for piece in style.shape.pieces(radius) {
            let corners = piece.into_iter().map(|[x, y]| at + vec2(x as f32, y as f32)).collect();
            painter.add(egui::Shape::convex_polygon(corners, color, Stroke::NONE));
        }
    };
    shape(RADIUS + 1.2, inks.rim);
    shape(RADIUS, color);
    match style.fill {
        Fill::Full => {}
        Fill::Hollow => shape(RADIUS - 1.6, inks.rim),
        Fill::Pale => shape(RADIUS - 1.2, inks.rim.lerp_to_gamma(color, 0.4)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_exact_lies_below_all_else_and_is_called_0() {
        let logs = Logs::around([0.0, 0.01, 10.0].into_iter(), 1e-7);
        let places = [0.0, 0.01, 10.0].map(|value| logs.place(value));
        assert!(logs.start() < places[0] && places[0] < places[1] && places[2] < logs.high, "{places:?}");
        assert_eq!((places[1], places[2]), (-2.0, 1.0));
        let marks = logs.marks((logs.start(), logs.high));
        let named: Vec<_> = marks.iter().filter(|mark| mark.step_size == 1.0).map(|mark| logs.text(*mark)).collect();
        assert_eq!(named, ["0.01", "0.1", "1", "10", "0"]);
        let positive = Logs::around([0.01, 10.0].into_iter(), 1e-7);
        assert_eq!((positive.zero, positive.start()), (None, positive.low), "no room for none where there is none");
    }

    #[test]
    fn a_short_axis_has_ticks_too() {
        for (least, most) in [(25.0, 38.0), (0.2, 0.21), (3.0, 3.0)] {
            let logs = Logs::around([least, most].into_iter(), 0.0);
            let marks = logs.marks((logs.start(), logs.high));
            assert!(marks.iter().any(|mark| mark.step_size == 1.0), "{least} to {most}");
            assert!(marks.iter().all(|mark| mark.value.is_finite()));
        }
        let none = Logs::around(std::iter::empty(), 0.0);
        assert!(none.start() < none.high);
    }
}

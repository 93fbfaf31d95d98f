//! Draws the chart: error against time or triangles, both logarithmic, and finds the point under the pointer.

use egui::{Color32, Pos2, Stroke, vec2};
use egui_plot::{GridInput, GridMark, Plot, PlotPoint, PlotTransform};

use crate::app::jobs::chart_job::Charted;
use inspect::plot::INK;
use inspect::settings::Settings;
use lab::chart::{Axis, Cost, Fill, Method, MethodStyle, Probe, RADIUS, Row, Setting, Shape, Tick, method_styles};

pub(super) struct Diagram<'a> {
    pub charted: &'a Charted,
    pub cost: Cost,
    /// Whether the chart is out of date.
    pub is_stale: bool,
    pub own: Option<Setting>,
}

#[derive(Clone, Copy)]
pub(super) enum Spot<'a> {
    Row(&'a Row),
    /// The window's settings, measured beside the list.
    Current(&'a Settings, &'a Probe),
}

/// How far around a point the pointer finds it, in points.
const REACH: f32 = 9.0;
/// The radius of the rings around the window's own setting and around the point under the pointer, in points.
const RING: f32 = 8.5;
/// The ticks between two places: the same as in the chart's files.
fn marks(axis: &Axis, (from, to): (f64, f64)) -> Vec<GridMark> {
    // The plot draws steps of 1 with a number and small steps as fine lines.
    let mark = |Tick { place, named }| GridMark { value: place, step_size: if named { 1.0 } else { 0.03 } };
    axis.ticks([from, to]).into_iter().map(mark).collect()
}

impl<'a> Diagram<'a> {
    /// Draws the diagram as large as there is room. Returns the point under the pointer and whether it was clicked.
    pub(super) fn show(&self, ui: &mut egui::Ui) -> Option<(Spot<'a>, bool)> {
        let subject = &self.charted.subject;
        let spots = self.spots();
        let x = Axis::around(spots.iter().map(|(_, [cost, _])| *cost), 0.0);
        let y = Axis::around(spots.iter().map(|(_, [_, error])| *error), subject.floor() * subject.unit());
        // A plot keeps its view until it is reset, so each cost has a plot of its own.
        let plot = Plot::new(("chart", self.cost == Cost::Ms))
            .x_axis_label(self.cost.name())
            .y_axis_label(if subject.reference_shape.is_some() { "Error, % of diagonal" } else { "Error, px" })
            .grid_color(ui.visuals().weak_text_color().gamma_multiply(0.5))
            .x_grid_spacer(move |input: GridInput| marks(&x, input.bounds))
            .y_grid_spacer(move |input: GridInput| marks(&y, input.bounds))
            .x_axis_formatter(move |mark, _| x.text(mark.value))
            .y_axis_formatter(move |mark, _| y.text(mark.value))
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

    /// The points whose error is known, with their cost and error in the units of the axes.
    fn spots(&self) -> Vec<(Spot<'a>, [f64; 2])> {
        let subject = &self.charted.subject;
        let at = |probe: &Probe| Some([self.cost.of(probe), subject.error(probe)? * subject.unit()]);
        let current = self.charted.current.as_ref().and_then(|(settings, probe)| Some((settings, probe.as_ref()?)));
        let current = current.and_then(|(settings, probe)| Some((Spot::Current(settings, probe), at(probe)?)));
        let of_rows = subject.rows.iter().filter_map(|row| Some((Spot::Row(row), at(&row.probe)?)));
        of_rows.chain(current).collect()
    }

    fn paint(&self, ui: &egui::Ui, canvas: &Canvas, spots: &[(Spot, [f64; 2])]) {
        let subject = &self.charted.subject;
        let inks = Inks::new(ui, self.is_stale);
        for race in subject.races() {
            let front = race.front(|row| self.cost.of(&row.probe)).into_iter();
            let places: Vec<_> =
                front.map(|(row, error)| canvas.place([self.cost.of(&row.probe), error * subject.unit()])).collect();
            // Circles, because a front of one point has no line.
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
                Spot::Current(settings, _) => {
                    marker(&canvas.painter, place, &MethodStyle::from_surface(settings.tessellation.surface), &inks);
                    self.ring(ui, canvas, place);
                }
            }
        }
    }

    /// Marks the window's own setting with a ring and a label.
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

/// The painter, and the transform from values to the screen.
struct Canvas {
    painter: egui::Painter,
    transform: PlotTransform,
    x: Axis,
    y: Axis,
}

impl Canvas {
    fn place(&self, [cost, error]: [f64; 2]) -> Pos2 {
        self.transform.position_from_point(&PlotPoint::new(self.x.place(cost), self.y.place(error)))
    }
}

pub(super) struct Inks {
    /// Drawn around points, to set them off from what is under them.
    halo: Color32,
    pub front: Color32,
    pub text: Color32,
    /// The colour of all methods if the chart is out of date.
    stale: Option<Color32>,
}

impl Inks {
    pub(super) fn new(ui: &egui::Ui, is_stale: bool) -> Self {
        let visuals = ui.visuals();
        let front = Color32::from_gray(if visuals.dark_mode { 62 } else { 222 });
        let stale = is_stale.then(|| Color32::from_gray(if visuals.dark_mode { 112 } else { 165 }));
        Self { halo: visuals.extreme_bg_color, front, text: visuals.strong_text_color(), stale }
    }

    /// The chart's ink is the theme's.
    fn of(&self, style: &MethodStyle) -> Color32 {
        let color = style.color;
        let own = if color == INK { self.text } else { Color32::from_rgb(color.0, color.1, color.2) };
        self.stale.unwrap_or(own)
    }
}

pub(super) fn line(painter: &egui::Painter, points: &[Pos2], stroke: Stroke, dash: Option<[f64; 2]>) {
    match dash {
        None => {
            painter.line(points.to_vec(), stroke);
        }
        // A dash that is no longer than the line is wide would hardly be seen.
        Some([drawn, left_out]) if drawn <= f64::from(stroke.width) => {
            let (spacing, radius) = ((drawn + left_out) as f32, 0.75 * stroke.width);
            painter.extend(egui::Shape::dotted_line(points, stroke.color, spacing, radius));
        }
        Some([drawn, left_out]) => {
            painter.extend(egui::Shape::dashed_line(points, stroke, drawn as f32, left_out as f32));
        }
    }
}

pub(super) fn marker(painter: &egui::Painter, at: Pos2, style: &MethodStyle, inks: &Inks) {
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
    shape(RADIUS + 1.2, inks.halo);
    shape(RADIUS, color);
    match style.fill {
        Fill::Full => {}
        Fill::Hollow => shape(RADIUS - 1.6, inks.halo),
        Fill::Pale => shape(RADIUS - 1.2, inks.halo.lerp_to_gamma(color, 0.4)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn named_ticks_are_those_of_the_chart_s_files() {
        let axis = Axis::around([0.0, 0.01, 10.0].into_iter(), 1e-7);
        let marks = marks(&axis, (axis.start(), axis.high));
        let named = marks.iter().filter(|mark| mark.step_size == 1.0);
        assert_eq!(named.map(|mark| axis.text(mark.value)).collect::<Vec<_>>(), ["0", "0.01", "0.1", "1", "10"]);
    }
}

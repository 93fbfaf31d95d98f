//! The viewport's panel: moving the camera with the pointer, and the divider, notes and progress over the picture.

use std::sync::Arc;
use std::time::Duration;

use egui::{PointerButton, Sense};
use glam::vec2;

use super::axis_gizmo::axes_place;
use super::picture::PictureRequest;
use crate::app::jobs::job_list::Work;
use crate::app::jobs::measure_job::{MeasureError, Seen};
use crate::app::painting::filled;
use crate::app::text::counted;
use crate::app::widgets::rgb;
use crate::app::{App, Document};
use crate::commands::{Action, CameraAction, key_name, with_key};
use geometry::view::ScreenView;
use gpu::GpuError;
use inspect::engine::SilhouetteView;
use inspect::render::{Ground, framed_size, half_at};
use inspect::settings::{Settings, SplitSide};
use load::Source;

/// Degrees that the camera turns for a point of dragging.
const DEGREES_PER_POINT: f32 = 0.4;
/// How much nearer the camera comes for a point of scrolling, as a part of its distance. Dragging takes half as far.
const RATIO_PER_POINT: f32 = 0.0025;
/// How far beside the divider it can be grabbed, in points.
const DIVIDER_REACH: f32 = 5.0;

/// The opacity, of 255, of the background's colour over the picture of a mesh that is open no more.
const VEIL: u8 = 190;

/// The alignment of the halves' titles, which are at the top beside the divider.
const ALIGN: [egui::Align2; 2] = [egui::Align2::RIGHT_TOP, egui::Align2::LEFT_TOP];

/// From this width on, in points, a half has room for more than the first line of its title.
const WIDE_HALF: f32 = 180.0;

/// Making the left half's scene for longer than this is shown.
const NOTICED: Duration = Duration::from_millis(300);

/// The line of help at a first start.
const GREETING: &str =
    "Drag to turn, scroll to zoom, click a triangle to read its factors. Drop a mesh here to open it.";

impl App {
    /// Shows the picture with what lies over it; the legend only if it isn't beside it.
    pub(in crate::app) fn viewport_panel(&mut self, ui: &mut egui::Ui, legend_is_beside: bool) {
        let rect = ui.available_rect_before_wrap();
        self.viewport.rect = Some(rect);
        let response = ui.allocate_rect(rect, Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "Viewport"));
        self.move_camera(ui, &response, rect);
        let scale = ui.ctx().pixels_per_point();
        self.click(&response, scale);
        response.context_menu(|ui| self.part_menu(ui));
        let size = [rect.width(), rect.height()].map(|side| (side * scale).round().max(1.0) as u32);
        // A camera that frames the whole mesh goes on doing so in a window of another size, and side by side.
        let framed_size = framed_size(size.map(|side| side as f32).into(), &self.settings);
        let resized = std::mem::replace(&mut self.viewport.framed_size, framed_size) != framed_size;
        let framed = resized && self.is_framed();
        let shown = self.advance(ui.ctx(), size).and_then(|()| Ok(self.show_pointer_value(&response)?));
        if let Err(error) = shown {
            self.dialogs.error = Some(error.to_string());
        }
        if framed {
            self.frame();
        }
        let generation = self.document.as_ref().map(|document| document.generation);
        let is_another = self.viewport.picture.shows.zip(generation).is_some_and(|(shown, own)| shown != own);
        // A picture that the device refused may be half drawn.
        let is_whole =
            self.viewport.picture.cancelled.is_none() || (self.viewport.picture.drawn.is_some() && !is_another);
        let is_preview = self.shows_preview();
        let whole = self.viewport.picture.shown().filter(|_| is_whole);
        let picture = if is_preview { self.viewport.preview.picture() } else { whole };
        match picture {
            Some(picture) => {
                ui.painter().add(picture.over(rect));
                if is_another && !is_preview {
                    // The mesh before stays as a shade until the first picture of this one.
                    let [r, g, b] = self.settings_in(ui.ctx().theme()).background_color();
                    let veil = egui::Color32::from_rgba_unmultiplied(r, g, b, VEIL);
                    ui.painter().rect_filled(rect, 0.0, veil);
                }
                let has_outlines = !is_preview && !self.settings.moves_halves();
                if let Some(outlines) = self.found_outlines().filter(|_| has_outlines) {
                    egui::Image::new(&outlines.texture).paint_at(ui, rect);
                }
                self.over_picture(ui, rect, legend_is_beside);
            }
            None => {
                let background = self.settings_in(ui.ctx().theme()).background_color();
                ui.painter().add(filled(&self.painting, rect, rgb(background)));
            }
        }
        self.viewport_notes(ui, rect);
    }

    /// What lies over a picture, and explains it.
    fn over_picture(&mut self, ui: &mut egui::Ui, rect: egui::Rect, legend_is_beside: bool) {
        self.divider(ui, rect);
        self.section_arrow(ui, rect);
        self.patch_labels(ui, rect);
        self.greeting(ui, rect);
        let legend = if legend_is_beside { None } else { self.legend_in_corner(ui, rect) };
        self.corner_notes(ui, rect, legend);
        self.axis_gizmo(ui, rect);
    }

    /// Goes on with drawing and all measurements.
    fn advance(&mut self, context: &egui::Context, size: [u32; 2]) -> Result<(), MeasureError> {
        // Callbacks of readbacks run here; a lost device reports through its own callback.
        self.engine.gpu.poll(wgpu::PollType::Poll);
        self.viewport.picture.fit(&self.painting, &self.engine, size)?;
        self.viewport.picture.land(&self.engine);
        self.keep_left(context)?;
        // A picture that is under way is finished first, so that playing shows pictures even if each takes long.
        if self.viewport.picture.is_free() {
            self.pose_now()?;
        }
        self.follow_file_camera();
        self.mark();
        let Some((wanted, is_whole)) = self.wanted(context, size)? else { return Ok(()) };
        if self.preview(context, &wanted)? {
            return Ok(());
        }
        let Some(document) = &mut self.document else { return Ok(()) };
        let drawn = self.viewport.picture.draw(&self.engine, document, &wanted, self.viewport.pace.ms());
        // The device's own error explains more than the errors that follow from it.
        if let Err(problem) = self.engine.gpu.check().and(drawn) {
            self.viewport.picture.refuse(&mut document.scene, &wanted);
            return Err(problem.into());
        }
        for half in SplitSide::BOTH {
            if let Some(scene) = document.scene.half(half) {
                document.halves[half as usize].measure.keep_only(scene.tessellator.generation());
            }
        }
        let shown = is_whole && self.viewport.picture.drawn.as_ref() == Some(&wanted);
        self.viewport.picture.outdated = !shown && self.viewport.picture.cancelled.is_none();
        if shown {
            self.measure_shown(context, &wanted, size)?;
            self.frame_unseen();
        }
        self.go_on_showing(shown)?;
        self.deviate(&wanted.inputs)?;
        if let Err(problem) = self.engine.gpu.check() {
            self.document.iter_mut().for_each(Document::give_up_measuring);
            return Err(problem.into());
        }
        self.ask_for_next_frame(context)?;
        self.warm_up(context, &wanted);
        Ok(())
    }

    /// Returns what the picture is to show, and whether all that it needs is there; none without a mesh.
    fn wanted(
        &mut self,
        context: &egui::Context,
        size: [u32; 2],
    ) -> Result<Option<(PictureRequest, bool)>, MeasureError> {
        let (deviation, moment) = (self.deviation_shown(), self.moment());
        self.give_from_files()?;
        let from_files = self.wanted_from_files();
        let settings = self.settings_in(context.theme());
        let Some(document) = &self.document else { return Ok(None) };
        let viewport = vec2(size[0] as f32, size[1] as f32);
        let camera = self.viewport.camera;
        let seen = camera.lod_view(viewport, &document.scene.bounds);
        let view = self.viewport.frozen.map_or(seen, |frozen| frozen.view);
        let wanted = PictureRequest {
            document: document.generation,
            moment: document.moment,
            left_pose: document.scene.left_pose(),
            lines: document.highlight.map_or(0, |marked| marked.generation),
            deviation,
            from_files: document.from_files,
            camera,
            settings,
            inputs: settings.inputs(view),
            view: ScreenView { clip_from_object: camera.clip_from_object(viewport, &document.scene.bounds), viewport },
        };
        let is_posed = (wanted.moment, wanted.left_pose) == (moment, self.viewport.playback.left);
        Ok(Some((wanted, document.from_files == from_files && is_posed)))
    }

    /// Measures what is shown, if it is at rest.
    fn measure_shown(
        &mut self,
        context: &egui::Context,
        wanted: &PictureRequest,
        size: [u32; 2],
    ) -> Result<(), MeasureError> {
        let Some(document) = &mut self.document else { return Ok(()) };
        let is_busy = self.viewport.playback.is_playing() || self.viewport.picture.in_flight.is_some();
        if is_busy || !document.scene.tessellator.is_counted() {
            return Ok(());
        }
        let bounds = document.scene.bounds;
        let view = wanted.view;
        let seen = wanted.camera.lod_view(view.viewport, &bounds);
        let silhouette = SilhouetteView { size, seen, lod: wanted.inputs.view };
        // What is counted in a view stays that of the frozen one, with all other numbers.
        let (camera, counted_in) = match self.viewport.frozen {
            Some(frozen) => (frozen.camera, frozen.screen_view(&bounds)),
            None => (wanted.camera, view),
        };
        for half in SplitSide::BOTH.into_iter().rev() {
            let measure = &mut document.halves[half as usize].measure;
            let scene = document.scene.half_mut(half).filter(|scene| scene.tessellator.is_counted());
            if let Some((scene, inputs)) = scene.zip(wanted.inputs_of(half)) {
                measure.go_on(&self.engine.gpu, scene, &Seen { camera, view: counted_in, inputs })?;
            } else if measure.is_busy() {
                measure.forget();
            }
        }
        self.count_leaks(context, counted_in)?;
        self.compare_outlines(context, &wanted.settings.tessellation, &silhouette, view)?;
        Ok(())
    }

    /// Asks for the next frame, if anything is under way.
    fn ask_for_next_frame(&mut self, context: &egui::Context) -> Result<(), MeasureError> {
        let mut halves = self.document.iter().flat_map(|document| &document.halves);
        let measures = halves.clone().any(|half| half.deviation.is_busy()) || self.jobs.has(Work::LeftHalf);
        let copies = halves.any(|half| half.measure.is_busy());
        let measures_only = measures && self.viewport.picture.is_free() && !copies;
        if self.pick()? || (self.is_busy() && !measures_only) {
            context.request_repaint();
        } else if measures_only {
            // Drawing the window more often would only slow the measurement down.
            context.request_repaint_after(Duration::from_millis(30));
        }
        Ok(())
    }

    /// Poses the scene for the wanted moment.
    ///
    /// # Errors
    /// The mesh's rig needs a larger buffer than the adapter can bind.
    pub(in crate::app) fn pose_now(&mut self) -> Result<(), GpuError> {
        let (wanted, left) = (self.moment(), self.viewport.playback.left);
        let Some(document) = &mut self.document else { return Ok(()) };
        document.scene.set_left_pose(left)?;
        if document.moment != wanted {
            document.moment = wanted;
            document.scene.set_moment(wanted)?;
        }
        Ok(())
    }

    /// Moves the camera as the pointer does that drags, or scrolls over, the picture or what lies over it.
    pub(super) fn move_camera(&mut self, ui: &egui::Ui, response: &egui::Response, picture: egui::Rect) {
        let points = vec2(picture.width(), picture.height());
        let drag = vec2(response.drag_delta().x, response.drag_delta().y);
        let (shift, command) = ui.input(|input| (input.modifiers.shift, input.modifiers.command));
        let pans = response.dragged_by(PointerButton::Middle) || (response.dragged_by(PointerButton::Primary) && shift);
        let zooms =
            response.dragged_by(PointerButton::Secondary) || (response.dragged_by(PointerButton::Middle) && command);
        if zooms {
            // Upwards comes nearer.
            self.viewport.camera.zoom((2.0 * drag.y * RATIO_PER_POINT).exp(), 0.5 * points, points);
        } else if pans {
            self.viewport.camera.pan(drag, points);
        } else if response.dragged_by(PointerButton::Primary) {
            self.viewport.camera.orbit(vec2(-drag.x, drag.y) * DEGREES_PER_POINT);
        }
        if let Some(pointer) = response.hover_pos() {
            let (scroll, pinch) = ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
            let ratio = (-scroll * RATIO_PER_POINT).exp() / pinch;
            if ratio != 1.0 {
                let (pointer, scale) = (pointer - picture.min, ui.ctx().pixels_per_point());
                let size = (points * scale).to_array().map(|side| side.round() as u32);
                let (_, [x, _]) = half_at([(pointer.x * scale) as u32, 0], size, &self.settings);
                self.viewport.camera.zoom(ratio, vec2(x as f32 / scale, pointer.y), points);
            }
        }
    }

    /// The split's divider, and the titles of its halves.
    fn divider(&mut self, ui: &mut egui::Ui, rect: egui::Rect) {
        let titles = SplitSide::BOTH.map(|half| self.half_title(half));
        let Some(split) = self.settings.split else { return };
        let is_whole = self.settings.shows_difference();
        let at = rect.left() + rect.width() * if is_whole { 0.5 } else { split };
        if !is_whole {
            self.divider_handle(ui, rect, split);
        }
        // The axes are in the right half's corner, or under the titles.
        let beside = axes_place(rect, Some(split)).filter(|axes| Some(*axes) == axes_place(rect, None));
        let end = beside.map_or(rect.right(), |axes| axes.left());
        let halves = [rect.with_max_x(at.min(end)), rect.with_min_x(at).with_max_x(end.max(at))];
        for ((half, place), (title, align)) in halves.into_iter().zip(["Left", "Right"]).zip(titles.iter().zip(ALIGN)) {
            half_note(ui, half, align, title, &format!("{place}: {title}"));
        }
    }

    /// The line of the divider, and what drags it.
    fn divider_handle(&mut self, ui: &mut egui::Ui, rect: egui::Rect, split: f32) {
        let at = rect.left() + rect.width() * split;
        let reach = egui::Rect::from_x_y_ranges(at - DIVIDER_REACH..=at + DIVIDER_REACH, rect.y_range());
        let (response, asked) = handle(ui, reach, "Split divider", split);
        let pointer = response.interact_pointer_pos().filter(|_| response.dragged_by(PointerButton::Primary));
        let dragged = pointer.map(|pointer| ((pointer.x - rect.left()) / rect.width()).clamp(0.0, 1.0));
        match dragged.or(asked) {
            Some(to) => (self.settings.split, self.viewport.last_split) = (Some(to), to),
            None => self.move_camera(ui, &response, rect),
        }
        let response = response.on_hover_cursor(egui::CursorIcon::ResizeHorizontal);
        for stroke in handle_strokes(&response) {
            ui.painter().vline(at, rect.y_range(), stroke);
        }
    }

    /// The number of triangles of the wanted picture, as text.
    pub(in crate::app) fn triangles(&self) -> String {
        let scene = |half| self.settings.half(half).and(self.document.as_ref()?.scene.half(half));
        let scenes = SplitSide::BOTH.into_iter().filter_map(scene);
        counted(scenes.map(|own| own.tessellator.totals().1).sum(), "triangle")
    }

    /// Whether nothing was done yet: no camera moved, no setting changed, nothing selected and no other mesh opened.
    fn is_untouched(&self) -> bool {
        let is_vase = self.source().is_none_or(|source| *source == Source::Vase);
        let is_framed = self.viewport.framed.is_none_or(|framed| framed == self.viewport.camera);
        let is_selected = self.selected_edge().is_some() || self.selected_triangle().is_some();
        is_vase && is_framed && !is_selected && self.settings == Settings::greeting()
    }

    /// What is on in the picture, in its lower left corner, above a legend there.
    fn corner_notes(&self, ui: &egui::Ui, rect: egui::Rect, legend: Option<egui::Rect>) {
        let preview = &self.viewport.preview;
        let previewed = preview.shown(&self.viewport.picture).map(|(_, shape)| preview.mark(shape));
        let frozen = self.viewport.frozen.map(|_| "LOD camera frozen".to_owned());
        let grid =
            self.document.as_ref().filter(|_| self.settings.halves().any(|own| own.overlays.grid)).map(|document| {
                let spacing = Ground::under(&document.scene.bounds).spacing;
                let unit = if spacing == 1.0 { "unit" } else { "units" };
                format!("Grid: {spacing} {unit}")
            });
        let left = self.document.as_ref().and_then(|document| document.scene.half(SplitSide::Left));
        let difference = left.filter(|_| self.settings.shows_difference());
        let difference = difference.map(|_| "Difference: black where both halves are equal".to_owned());
        let distance = self.viewport.ruler.map(|ruler| ruler.text());
        let bookmarked = self.viewport.bookmarks.iter().position(|bookmark| *bookmark == self.viewport.camera);
        let bookmark = bookmarked.map(|index| format!("Bookmark {}", index + 1));
        let texts =
            [previewed, frozen, self.left_out_note(), difference, grid, distance, bookmark].into_iter().flatten();
        let notes: Vec<_> = texts.map(|text| (note_text(ui, &text, egui::Color32::from_gray(235)), text)).collect();
        let widest = notes.iter().map(|(galley, _)| galley.size().x).fold(0.0, f32::max);
        let shows_progress =
            self.under_way().is_some() || self.viewport.picture.cancelled.is_some() || self.shows_nothing();
        let progress = shows_progress.then(|| progress_place(rect));
        // In a narrow picture they are above the progress, and above a legend on the right.
        let is_below = |place: &egui::Rect| place.left() <= rect.left() + 10.0 + widest + 12.0;
        let below = [progress, legend].into_iter().flatten().filter(is_below);
        let bottom = below.map(|place| place.top()).fold(rect.bottom(), f32::min);
        let mut position = egui::pos2(rect.left() + 10.0, bottom - 10.0);
        for (galley, text) in notes {
            let place = egui::Align2::LEFT_BOTTOM.anchor_size(position, galley.size());
            let response = ui.interact(place, ui.scope_id().with(("note", &text)), Sense::empty());
            response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, &text));
            position.y = place.top() - 10.0;
            paint_note(ui, place, galley);
        }
    }

    /// The line of help at a first start, at the lower border of the picture. It leaves that place to the progress of a load.
    fn greeting(&mut self, ui: &egui::Ui, rect: egui::Rect) {
        self.viewport.greets &= self.is_untouched();
        if !self.viewport.greets || self.jobs.load().is_some() {
            return;
        }
        let (font, gray) = (egui::TextStyle::Body.resolve(ui.style()), egui::Color32::from_gray(235));
        let text = ui.painter().layout(GREETING.to_owned(), font, gray, rect.width() - 28.0);
        let place = egui::Align2::CENTER_BOTTOM.align_size_within_rect(text.size(), rect.shrink(14.0));
        let response = ui.interact(place, ui.scope_id().with("greeting"), Sense::empty());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, GREETING));
        paint_note(ui, place, text);
    }

    /// Notes about what is under way: the progress of loading, writing and drawing.
    fn viewport_notes(&mut self, ui: &mut egui::Ui, rect: egui::Rect) {
        let is_old = self.document.as_ref().map(|document| document.generation)
            != self.viewport.picture.drawn.as_ref().map(|drawn| drawn.document);
        let is_cancelled = self.viewport.picture.cancelled.is_some();
        let left_takes_long = self.jobs.get(Work::LeftHalf).is_some_and(|job| job.since.elapsed() > NOTICED);
        if self.document.is_some() && !is_cancelled && (is_old || left_takes_long) {
            let text = note_text(ui, "Tessellating…", egui::Color32::from_gray(235));
            // Below the titles of both halves.
            let from_top = if self.settings.split.is_some() { 112.0 } else { 40.0 };
            let place =
                egui::Align2::CENTER_TOP.align_size_within_rect(text.size(), rect.shrink2(egui::vec2(40.0, from_top)));
            paint_note(ui, place, text);
        }
        if let Some(under_way) = self.under_way() {
            let stop = format!("Stop ({})", key_name(&Action::Cancel));
            let done = Some((under_way.done, under_way.seconds_left));
            if progress(ui, rect, &under_way.title, done, &stop, under_way.stopping) {
                self.stop(&under_way);
            }
            ui.ctx().request_repaint_after(Duration::from_millis(50));
        } else if self.viewport.picture.cancelled.is_some() {
            let hover = "Draw anyway. Changing any setting also redraws.";
            if progress(ui, rect, &format!("Not drawn: {}", self.triangles()), None, "Draw", hover) {
                self.viewport.picture.cancelled = None;
                ui.ctx().request_repaint();
            }
        } else if self.shows_nothing() {
            let hover =
                with_key("Moves the camera so that it sees all of the mesh.", &Action::Camera(CameraAction::Frame));
            if progress(ui, rect, "Nothing of the mesh is in view.", None, "Frame the mesh", &hover) {
                self.frame_anew();
            }
        }
    }
}

/// What can be dragged in the picture, which `at`, from 0 to 1, follows. Screen readers say it in percent, and may ask for another
/// one, which is returned.
pub(super) fn handle(ui: &egui::Ui, reach: egui::Rect, name: &str, at: f32) -> (egui::Response, Option<f32>) {
    use egui::accesskit::{Action, ActionData};
    let response = ui.interact(reach, ui.scope_id().with(name), Sense::drag());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Slider, true, name));
    ui.ctx().accesskit_node_builder(response.id, |node| {
        node.set_min_numeric_value(0.0);
        node.set_max_numeric_value(100.0);
        node.set_numeric_value(f64::from(100.0 * at));
        node.add_action(Action::SetValue);
    });
    let asked = ui.input(|input| {
        let requests = input.accesskit_action_requests(response.id, Action::SetValue);
        let values = requests.filter_map(|request| match request.data {
            Some(ActionData::NumericValue(percent)) => Some((percent / 100.0).clamp(0.0, 1.0) as f32),
            _ => None,
        });
        values.last()
    });
    (response, asked)
}

/// The lines of what can be dragged: a light one in a dark one is seen on any background.
pub(super) fn handle_strokes(response: &egui::Response) -> [egui::Stroke; 2] {
    let (width, gray) = if response.hovered() || response.dragged() { (2.5, 255) } else { (1.5, 190) };
    let dark = egui::Stroke::new(width + 2.0, egui::Color32::from_black_alpha(130));
    [dark, egui::Stroke::new(width, egui::Color32::from_gray(gray))]
}

/// The place of the progress in a picture: below its middle, so that the picture can be seen.
fn progress_place(rect: egui::Rect) -> egui::Rect {
    egui::Align2::CENTER_BOTTOM.align_size_within_rect(egui::vec2(280.0, 84.0), rect.shrink(14.0))
}

/// Shows the title of something that takes long at the lower border of the picture, the part of it that is done, about how many
/// seconds are left if that is known, and a button with a hover text. Returns true if the button is pressed.
fn progress(
    ui: &mut egui::Ui,
    rect: egui::Rect,
    title: &str,
    done: Option<(f32, Option<f64>)>,
    button: &str,
    hover: &str,
) -> bool {
    let area = progress_place(rect);
    let show = |ui: &mut egui::Ui| {
        ui.set_min_width(260.0);
        ui.label(title);
        if let Some((done, left)) = done {
            let left = left.map_or_else(String::new, |left| format!(", about {left:.0} s left"));
            let text = format!("{:.0} %{left}", 100.0 * done);
            ui.add(egui::ProgressBar::new(done).desired_width(260.0).text(text));
        }
        ui.button(button).on_hover_text(hover).clicked()
    };
    let popup = |ui: &mut egui::Ui| egui::Frame::popup(ui.style()).show(ui, show).inner;
    ui.scope_builder(egui::UiBuilder::new().max_rect(area), popup).inner
}

/// Shows the title of a half at its top beside the divider, if there is enough room for its first line. In a narrow half it has no
/// other lines, since the axes are below it.
fn half_note(ui: &egui::Ui, half: egui::Rect, align: egui::Align2, text: &str, name: &str) {
    let room = half.shrink(8.0);
    let first = text.lines().next().unwrap_or_default();
    if note_text(ui, first, egui::Color32::WHITE).size().x > room.width() {
        return;
    }
    let shown = if room.width() < WIDE_HALF { first } else { text };
    let font = egui::TextStyle::Body.resolve(ui.style());
    let galley = ui.painter().layout(shown.to_owned(), font, egui::Color32::from_gray(235), room.width());
    let place = align.align_size_within_rect(galley.size(), room);
    let response = ui.interact(place, ui.scope_id().with(("half", align.x() as u8)), Sense::empty());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, name));
    paint_note(ui, place, galley);
}

pub(in crate::app) fn note_text(ui: &egui::Ui, text: &str, color: egui::Color32) -> Arc<egui::Galley> {
    ui.painter().layout_no_wrap(text.to_owned(), egui::TextStyle::Body.resolve(ui.style()), color)
}

/// Shows a short text over the picture, on a dark background.
pub(in crate::app) fn paint_note(ui: &egui::Ui, rect: egui::Rect, galley: Arc<egui::Galley>) {
    ui.painter().rect_filled(rect.expand2(egui::vec2(6.0, 3.0)), 4.0, egui::Color32::from_black_alpha(215));
    ui.painter().galley(rect.min, galley, egui::Color32::WHITE);
}

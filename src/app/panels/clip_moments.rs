//! What is found all through the clip: a strip of moments, and buttons that show the worst ones.

use egui::{Rect, Sense, pos2, vec2};

use crate::app::App;
use crate::app::jobs::given::FromFiles;
use crate::app::jobs::job_list::Work;
use crate::app::jobs::scenes::arena_bytes;
use crate::app::text::grouped;
use crate::app::widgets::rgb;
use geometry::progress::Progress;
use geometry::tessellate::{Inputs, LodView, Tessellation};
use inspect::engine::{ClipFinding, MomentFound, worst_moment};
use inspect::render::layout::{CRACK_COLOR, FOLD_COLOR};
use inspect::settings::Choice;

/// The height of the strip, in points: that of the button that was there before.
const HEIGHT: f32 = 18.0;

/// What was found in a clip.
pub(crate) struct ClipMoments {
    of: Measured,
    found: Vec<MomentFound>,
}

/// What moments depend on: the clip, how it is tessellated, from where it is seen if that matters, and what files give.
type Measured = (usize, Tessellation, Option<LodView>, FromFiles);

impl App {
    /// The strip of moments and the worst of them; before they are measured, the button that starts it.
    pub(in crate::app) fn clip_moments(&mut self, ui: &mut egui::Ui) {
        let clip = self.moment().map(|moment| moment.clip);
        let drawn = self.viewport.picture.drawn.as_ref().map(|drawn| (drawn.inputs, drawn.from_files));
        let of = drawn.zip(clip).map(|((Inputs { tessellation, view, .. }, from_files), clip)| {
            (clip, tessellation, tessellation.follows_view().then_some(view), from_files)
        });
        let known = self.document.as_ref().and_then(|document| document.clip_moments.as_ref());
        let Some(found) = known.filter(|known| Some(known.of) == of).map(|known| known.found.clone()) else {
            let hover = "Measures moments all through the clip, as it is seen and tessellated now, and then shows those with the most folds, \
                         cracked edges and triangles.";
            let button =
                ui.add_enabled(of.is_some() && !self.jobs.has(Work::Clip), egui::Button::new("Find the worst moments"));
            let is_clicked = button.on_hover_text(hover).on_disabled_hover_text("Choose a clip.").clicked();
            if let Some((of, (inputs, _))) = of.zip(drawn).filter(|_| is_clicked) {
                self.survey_clip(ui.ctx(), of, inputs);
            }
            return;
        };
        let worst = |finding| worst_moment(&found, finding).map(|worst| (finding, worst));
        ui.horizontal(|ui| {
            let widest = ui.available_width() / 4.0;
            let mut time = None;
            for (finding, MomentFound { time: at, counts }) in ClipFinding::ALL.into_iter().filter_map(worst) {
                let count = counts[finding as usize];
                let shown = match count {
                    0 => format!("No {}", finding.label()),
                    count => format!("Most {}: {}", finding.label(), grouped(count)),
                };
                let name = if count == 0 { shown.clone() } else { format!("{shown} at {at:.3} s") };
                let button = egui::Button::new(shown).truncate();
                let own = |ui: &mut egui::Ui| {
                    ui.set_max_width(widest);
                    ui.add_enabled(count > 0, button)
                };
                let button = ui.scope(own).inner;
                button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, count > 0, &name));
                let button = button.on_hover_text(format!("{name}. {}", finding.text()));
                if button.on_disabled_hover_text("There are none in this clip.").clicked() {
                    time = Some(at);
                }
            }
            if let Some(time) = self.strip(ui, &found).or(time) {
                self.viewport.playback.show(time);
            }
        });
    }

    /// Folds and cracked edges over time, each against the most of them. Returns the time of the moment that is clicked on.
    fn strip(&self, ui: &mut egui::Ui, found: &[MomentFound]) -> Option<f64> {
        let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width().max(HEIGHT), HEIGHT), Sense::click());
        let painter = ui.painter_at(rect);
        painter.rect_filled(rect, 2.0, ui.visuals().extreme_bg_color);
        let width = rect.width() / found.len().max(1) as f32;
        for (finding, color) in [(ClipFinding::Cracks, CRACK_COLOR), (ClipFinding::Folds, FOLD_COLOR)] {
            let most = worst_moment(found, finding).map_or(0, |worst| worst.counts[finding as usize]).max(1);
            for (index, moment) in found.iter().enumerate() {
                let height = HEIGHT * (moment.counts[finding as usize] as f32 / most as f32);
                let left = rect.left() + width * index as f32;
                let bar = Rect::from_min_max(pos2(left, rect.bottom() - height), pos2(left + width, rect.bottom()));
                painter.rect_filled(bar, 0.0, rgb(color).gamma_multiply(0.8));
            }
        }
        if let Some(now) = self.moment() {
            let before = found.partition_point(|moment| moment.time <= now.time).saturating_sub(1);
            let middle = rect.left() + width * (before as f32 + 0.5);
            painter.vline(middle, rect.y_range(), ui.visuals().widgets.active.fg_stroke);
        }
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, "Moments of the clip"));
        let hover = "Folds and cracked edges over the clip, each against the most of them. A click shows that moment.";
        let pointer = response.interact_pointer_pos().filter(|_| response.clicked());
        response.on_hover_text(hover);
        let index = pointer.map(|pointer| ((pointer.x - rect.left()) / width).max(0.0) as usize);
        index.and_then(|index| found.get(index)).map(|moment| moment.time)
    }

    /// Starts to measure a clip on a thread of its own.
    fn survey_clip(&mut self, context: &egui::Context, of: Measured, inputs: Inputs) {
        let clip = of.0;
        let Some(document) = &self.document else { return };
        let (engine, sibling) = (self.engine.clone(), document.scene.sibling(arena_bytes(&self.engine)));
        let settings = self.settings.with(inputs.tessellation);
        let survey = move |progress: &Progress| {
            let made = engine.gpu.attempt(|| {
                let mut scene = sibling()?;
                scene.frame_clip(Some(clip));
                engine.survey_clip(&mut scene, &settings, inputs.view, clip, progress)
            });
            made.and_then(|made| made)
        };
        self.jobs.start(context, Work::Clip, "Measuring the clip".to_owned(), survey, move |app, _, ended| {
            match (ended, &mut app.document) {
                (Ok(Ok(Ok(found))), Some(document)) => document.clip_moments = Some(ClipMoments { of, found }),
                (Ok(Err(error)), _) => app.dialogs.error = Some(error.to_string()),
                (Err(stopped), _) => app.dialogs.error = Some(format!("measuring the clip {stopped}")),
                _ => {}
            }
        });
    }
}

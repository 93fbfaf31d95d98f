//! The timeline under the picture: which clip is shown, its time, playing, and what was found all through it.

use std::ops::RangeInclusive;

use egui::Ui;

use crate::app::App;
use crate::app::painting::panel_frame;
use crate::app::text::shortened;
use crate::app::viewport::playback::LISTED;
use crate::app::widgets::chooser;
use crate::commands::{Action, with_key};
use geometry::mesh::rig::Clip;
use inspect::render::LeftPose;

/// The range of speeds at which a clip plays; 1 is its own speed.
const SPEED_RANGE: RangeInclusive<f64> = 0.1..=4.0;
/// How far the buttons beside the time go, in s.
const FRAME: f64 = 1.0 / 30.0;
/// The widths of the lists of clips and poses, of the slider of speeds, and of the numbers beside sliders, in points.
const CLIPS_WIDTH: f32 = 110.0;
const SPEED_WIDTH: f32 = 60.0;
const NUMBER_WIDTH: f32 = 72.0;

impl App {
    /// The timeline, which only a mesh with clips has.
    pub(in crate::app) fn timeline(&mut self, ui: &mut Ui) {
        let read = self.document.as_ref().map(|document| &document.loaded.read);
        let is_fixed = self.clips().is_empty();
        if is_fixed && read.is_none_or(|read| read.rig.is_none()) {
            return;
        }
        egui::Panel::bottom("timeline").frame(panel_frame(ui)).show(ui, |ui| {
            if is_fixed {
                ui.weak("A mesh with a crease band can't be animated.");
                return;
            }
            ui.horizontal(|ui| {
                self.clip_list(ui);
                self.play_button(ui);
                self.speed_slider(ui);
            });
            ui.horizontal(|ui| self.time_slider(ui));
            self.clip_moments(ui);
        });
    }

    fn clip_list(&mut self, ui: &mut Ui) {
        // A name short enough for the list, and a hover text.
        let texts = |clip: &Clip| {
            (shortened(&clip.name, 18), format!("{}: {:.3} s.", shortened(&clip.name, 200), clip.duration))
        };
        let texts: Vec<_> = self.clips().iter().take(LISTED).map(texts).collect();
        let clips = texts.iter().enumerate().map(|(i, (name, hover))| (Some(i), name.as_str(), hover.as_str()));
        let rest = (None, "Rest pose", "The mesh as it is without any clip.");
        let choices: Vec<_> = std::iter::once(rest).chain(clips).collect();
        ui.spacing_mut().combo_width = CLIPS_WIDTH;
        let hover = "The animation clip. A clip that is chosen is shown from its start.";
        if let Some(clip) = chooser(ui, "Clip", hover, self.viewport.playback.clip, &choices) {
            self.choose_clip(clip);
        }
    }

    fn play_button(&mut self, ui: &mut Ui) {
        let is_playing = self.is_playing();
        let button = egui::Button::new(if is_playing { "Pause" } else { "Play" }).min_size(egui::vec2(48.0, 0.0));
        let hover = "Plays the clip in a loop, or the first clip if none is chosen. Cracks and other statistics are measured \
                     only while it is paused.";
        if ui.add(button).on_hover_text(with_key(hover, &Action::PlayOrPause)).clicked() {
            self.toggle_playing(ui.ctx());
        }
    }

    fn speed_slider(&mut self, ui: &mut Ui) {
        let hover = "How fast the clip plays. 1 is its own speed.";
        let label = ui.label("Speed").on_hover_text(hover);
        let slider = egui::Slider::new(&mut self.viewport.playback.speed, SPEED_RANGE);
        ui.spacing_mut().slider_width = SPEED_WIDTH;
        let slider = slider.max_decimals(2).logarithmic(true).suffix(" \u{d7}");
        ui.add(slider).labelled_by(label.id).on_hover_text(hover);
    }

    /// The pose of a split view's left half: that of the right one, or one that stays.
    fn left_pose_list(&mut self, ui: &mut Ui) {
        let Some(_) = self.settings.split else { return };
        let own = self.viewport.playback.left;
        let (clips, moment) = (self.clip_names(), if let LeftPose::Own(moment) = own { moment } else { None });
        let posed = moment.and_then(|own| Some(format!("{} at {} s", clips.get(own.clip)?, own.time as f32)));
        let title = posed.unwrap_or_else(|| "at rest".to_owned());
        let same = (LeftPose::Same, "The same", "The left half has the pose of the right one.");
        let now = (LeftPose::Own(self.moment()), "This moment", "The left half stays in the pose that is shown now.");
        let mut choices = vec![same, now];
        if !choices.iter().any(|(pose, ..)| *pose == own) {
            choices.push((own, &title, "The left half stays in this pose."));
        }
        ui.spacing_mut().combo_width = CLIPS_WIDTH;
        let hover = "The pose left of the split (--split-animation, --split-time).";
        self.viewport.playback.left = chooser(ui, "Left pose", hover, own, &choices).unwrap_or(own);
    }

    fn time_slider(&mut self, ui: &mut Ui) {
        self.left_pose_list(ui);
        let clip = self.viewport.playback.clip.and_then(|clip| self.clips().get(clip));
        let duration = clip.map_or(0.0, |clip| clip.duration);
        let hover = if clip.is_some() { format!("Time in the clip, 0 to {duration:.3} s.") } else { String::new() };
        let why_not = "Choose a clip that is longer than 0 s.";
        let label = ui.label("Time").on_hover_text(&hover);
        let time = self.viewport.playback.time;
        for (text, name, to) in [("<", "Previous frame", time - FRAME), (">", "Next frame", time + FRAME)] {
            let button = ui.add_enabled(duration > 0.0, egui::Button::new(text));
            button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, duration > 0.0, name));
            let button = button.on_hover_text(format!("{name}: 1/30 s from here.")).on_disabled_hover_text(why_not);
            if button.clicked() {
                self.viewport.playback.show(to.clamp(0.0, duration));
            }
        }
        // With an empty range the handle would be in the middle.
        let end = if duration > 0.0 { duration } else { 1.0 };
        ui.spacing_mut().slider_width = (ui.available_width() - NUMBER_WIDTH).max(SPEED_WIDTH);
        let slider = egui::Slider::new(&mut self.viewport.playback.time, 0.0..=end).fixed_decimals(3).suffix(" s");
        let response = ui.add_enabled(duration > 0.0, slider).labelled_by(label.id);
        response.on_hover_text(hover).on_disabled_hover_text(why_not);
    }
}

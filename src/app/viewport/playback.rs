//! What moves: clip, time and speed, and playing.

use crate::app::App;
use crate::app::text::shortened;
use crate::app::widgets::{chooser, heading};
use crate::commands::{Action, with_key};
use crate::mesh::Moment;
use crate::mesh::rig::Clip;

/// How much faster than it was made a clip plays.
const SPEED_RANGE: std::ops::RangeInclusive<f64> = 0.1..=4.0;
/// Clips that the list offers.
const LISTED: usize = 1000;

/// Where the mesh is in its clips.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Playback {
    /// None at rest.
    clip: Option<usize>,
    /// s.
    time: f64,
    speed: f64,
    /// While playing: when, on the window's clock in s, the time was last moved on.
    playing: Option<f64>,
}

impl Default for Playback {
    fn default() -> Self {
        Self { clip: None, time: 0.0, speed: 1.0, playing: None }
    }
}

impl Playback {
    pub(crate) fn moment(&self) -> Option<Moment> {
        self.clip.map(|clip| Moment { clip, time: self.time })
    }

    pub(crate) fn is_playing(&self) -> bool {
        self.playing.is_some()
    }

    /// Goes on by the clock of another window.
    pub(crate) fn go_on_in(&mut self, context: &egui::Context) {
        let now = context.input(|input| input.time);
        self.playing = self.playing.map(|_| now);
    }
}

impl App {
    /// Clip and time that are wanted; none at rest, and while a crease band keeps the mesh from moving.
    pub fn moment(&self) -> Option<Moment> {
        self.viewport.playback.moment().filter(|moment| moment.clip < self.clips().len())
    }

    /// Whether a clip is playing.
    pub fn is_playing(&self) -> bool {
        self.viewport.playback.is_playing()
    }

    /// What the mesh that is open can do.
    fn clips(&self) -> &[Clip] {
        let rig = self.document.as_ref().and_then(|document| document.loaded.mesh.rig.as_deref());
        rig.map_or(&[], |rig| &rig.clips)
    }

    /// Names of the clips, as the command line tells those of one name apart.
    pub(in crate::app) fn clip_names(&self) -> Vec<String> {
        let rig = self.document.as_ref().and_then(|document| document.loaded.mesh.rig.as_deref());
        rig.map_or_else(Vec::new, |rig| (0..rig.clips.len().min(LISTED)).map(|clip| rig.clip_name(clip)).collect())
    }

    /// Shows a clip from its start on, not playing; or the mesh at rest.
    pub fn choose_clip(&mut self, clip: Option<usize>) {
        let clip = clip.filter(|&clip| clip < self.clips().len());
        let was_framed = self.is_framed();
        self.viewport.playback = Playback { clip, speed: self.viewport.playback.speed, ..Playback::default() };
        self.frame_clip();
        // Who looks at all of it goes on to, also where the clip goes far; who looks at a detail stays there.
        if was_framed {
            self.frame();
        }
    }

    /// Takes what depends on the extent of what is shown from all of the clip.
    pub(in crate::app) fn frame_clip(&mut self) {
        let clip = self.moment().map(|moment| moment.clip);
        if let Some(document) = &mut self.document {
            document.scene.frame_clip(clip);
        }
    }

    /// Keeps clip and time for a document that is the same mesh loaded again, also with a crease band, with which it doesn't move;
    /// forgets them for another.
    pub(in crate::app) fn keep_playback(&mut self, is_same: bool) {
        let count = self.clips().len();
        if !is_same {
            self.viewport.playback = Playback::default();
        } else if count == 0 {
            self.viewport.playback.playing = None;
        } else if self.viewport.playback.clip.is_some_and(|clip| clip >= count) {
            self.viewport.playback = Playback { speed: self.viewport.playback.speed, ..Playback::default() };
        }
        if self.viewport.playback.clip.is_some() {
            self.frame_clip();
        }
        // Before anything is drawn of it.
        if let Err(error) = self.pose_now() {
            self.dialogs.error = Some(error.to_string());
        }
    }

    /// Plays, the first clip if none is chosen; or pauses.
    pub(in crate::app) fn toggle_playing(&mut self, context: &egui::Context) {
        if self.clips().is_empty() {
            return;
        }
        if self.viewport.playback.clip.is_none() {
            self.choose_clip(Some(0));
        }
        let now = context.input(|input| input.time);
        self.viewport.playback.playing = if self.viewport.playback.playing.is_some() { None } else { Some(now) };
    }

    /// Moves the time on while a clip plays, round and round.
    pub(in crate::app) fn play_on(&mut self, context: &egui::Context) {
        let Some((last, clip)) = self.viewport.playback.playing.zip(self.viewport.playback.clip) else { return };
        let now = context.input(|input| input.time);
        let time = self.viewport.playback.time + (now - last) * self.viewport.playback.speed;
        self.viewport.playback.time = self.clips().get(clip).map_or(0.0, |clip| clip.looped(time));
        self.viewport.playback.playing = Some(now);
        context.request_repaint();
    }

    /// Only for a mesh that can move.
    pub(in crate::app) fn animation_section(&mut self, ui: &mut egui::Ui) {
        if self.clips().is_empty() {
            let read = self.document.as_ref().map(|document| &document.loaded.read);
            if read.is_some_and(|read| read.rig.is_some()) {
                heading(ui, "Animation");
                ui.weak("A mesh with a crease band can't be animated.");
            }
            return;
        }
        heading(ui, "Animation");
        let mut chosen = self.viewport.playback.clip;
        let texts: Vec<_> = self.clips().iter().take(LISTED).map(clip_texts).collect();
        egui::Grid::new("animation").num_columns(2).min_col_width(92.0).show(ui, |ui| {
            let mut choices = vec![(None, "Rest pose", "The mesh as it is without any clip.")];
            let clips = texts.iter().enumerate();
            choices.extend(clips.map(|(i, (name, hover))| (Some(i), name.as_str(), hover.as_str())));
            chooser(ui, "Clip", "What moves the mesh; shown from its start on.", &mut chosen, &choices);
            self.time_row(ui);
            self.speed_row(ui);
            ui.label("");
            self.play_button(ui);
            ui.end_row();
        });
        if chosen != self.viewport.playback.clip {
            self.choose_clip(chosen);
        }
    }

    fn time_row(&mut self, ui: &mut egui::Ui) {
        let clip = self.viewport.playback.clip.and_then(|clip| self.clips().get(clip));
        let duration = clip.map_or(0.0, |clip| clip.duration);
        let hover = if clip.is_some() { format!("Time in the clip, 0 to {duration:.3} s.") } else { String::new() };
        let label = ui.label("Time").on_hover_text(&hover);
        // Without any length the handle would be in the middle.
        let end = if duration > 0.0 { duration } else { 1.0 };
        let slider = egui::Slider::new(&mut self.viewport.playback.time, 0.0..=end).fixed_decimals(3).suffix(" s");
        ui.add_enabled(duration > 0.0, slider)
            .labelled_by(label.id)
            .on_hover_text(hover)
            .on_disabled_hover_text("Choose a clip that takes time.");
        ui.end_row();
    }

    fn speed_row(&mut self, ui: &mut egui::Ui) {
        let hover = "How fast the clip plays: 1 is as it was made.";
        let label = ui.label("Speed").on_hover_text(hover);
        let slider = egui::Slider::new(&mut self.viewport.playback.speed, SPEED_RANGE)
            .max_decimals(2)
            .logarithmic(true)
            .suffix(" \u{d7}");
        ui.add(slider).labelled_by(label.id).on_hover_text(hover);
        ui.end_row();
    }

    fn play_button(&mut self, ui: &mut egui::Ui) {
        let is_playing = self.is_playing();
        let button = egui::Button::new(if is_playing { "Pause" } else { "Play" }).min_size(egui::vec2(72.0, 0.0));
        let hover = "Plays the clip round and round, the first one if none is chosen. What is shown is measured while it is \
                     paused.";
        if ui.add(button).on_hover_text(with_key(hover, &Action::PlayOrPause)).clicked() {
            self.toggle_playing(ui.ctx());
        }
    }
}

/// A clip's name in the room that a list has, and all that is known about it.
fn clip_texts(clip: &Clip) -> (String, String) {
    (shortened(&clip.name, 18), format!("{}: {:.3} s.", shortened(&clip.name, 200), clip.duration))
}

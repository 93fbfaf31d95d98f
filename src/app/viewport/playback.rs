//! The animation: clip, time and speed, and playing.

use crate::app::App;
use geometry::defaults::with_defaults;
use geometry::mesh::Moment;
use geometry::mesh::rig::Clip;
use inspect::render::LeftPose;

/// How many clips the list shows.
pub(in crate::app) const LISTED: usize = 1000;

with_defaults! {
    /// The clip and the time that the mesh is shown at.
    #[derive(Clone, Copy, Debug)]
    pub(crate) struct Playback {
        /// None at rest.
        pub clip: Option<usize> = None,
        /// Time in the clip, in s.
        pub time: f64 = 0.0,
        /// 1 is the clip's own speed.
        pub speed: f64 = 1.0,
        /// The pose left of a split.
        pub left: LeftPose = LeftPose::Same,
        /// Whether the poses were exchanged an odd number of times.
        pub is_swapped: bool = false,
        /// While playing: when `time` was last advanced, on the window's clock in s.
        playing: Option<f64> = None,
    }
}

impl Playback {
    pub(crate) fn moment(&self) -> Option<Moment> {
        self.clip.map(|clip| Moment { clip, time: self.time })
    }

    /// Shows another time of the clip, and pauses.
    pub(crate) fn show(&mut self, time: f64) {
        (self.time, self.playing) = (time, None);
    }

    pub(crate) fn is_playing(&self) -> bool {
        self.playing.is_some()
    }

    /// Goes on in another window, which has another clock.
    pub(crate) fn go_on_in(&mut self, context: &egui::Context) {
        let now = context.input(|input| input.time);
        self.playing = self.playing.map(|_| now);
    }
}

impl App {
    /// The wanted clip and time; none at rest, and for a mesh with a crease band, which can't be animated.
    pub fn moment(&self) -> Option<Moment> {
        self.viewport.playback.moment().filter(|moment| moment.clip < self.clips().len())
    }

    /// Whether a clip is playing.
    pub fn is_playing(&self) -> bool {
        self.viewport.playback.is_playing()
    }

    pub(in crate::app) fn clips(&self) -> &[Clip] {
        let rig = self.document.as_ref().and_then(|document| document.loaded.mesh.rig.as_deref());
        rig.map_or(&[], |rig| &rig.clips)
    }

    /// The names of the clips, made distinct as on the command line.
    pub(in crate::app) fn clip_names(&self) -> Vec<String> {
        let rig = self.document.as_ref().and_then(|document| document.loaded.mesh.rig.as_deref());
        rig.map_or_else(Vec::new, |rig| (0..rig.clips.len().min(LISTED)).map(|clip| rig.clip_name(clip)).collect())
    }

    /// Shows the start of a clip, or the mesh at rest. If a clip is playing, the next one plays too.
    pub fn choose_clip(&mut self, clip: Option<usize>) {
        let clip = clip.filter(|&clip| clip < self.clips().len());
        let was_framed = self.is_framed();
        let playing = self.viewport.playback.playing.filter(|_| clip.is_some());
        self.viewport.playback = Playback { clip, time: 0.0, playing, ..self.viewport.playback };
        self.frame_clip();
        // A camera that frames the whole mesh frames the whole clip now; one that shows a detail stays.
        if was_framed {
            self.frame();
        }
    }

    /// Exchanges the poses of both halves, if the left one has its own.
    pub(in crate::app) fn swap_poses(&mut self) {
        if let LeftPose::Own(own) = self.viewport.playback.left {
            let left = LeftPose::Own(self.moment());
            self.choose_clip(own.map(|moment| moment.clip));
            let playback = &mut self.viewport.playback;
            (playback.time, playback.left) = (own.map_or(0.0, |moment| moment.time), left);
            playback.is_swapped = !playback.is_swapped;
        }
    }

    /// Sets the scene's bounds to those of the whole clip.
    pub(in crate::app) fn frame_clip(&mut self) {
        let clip = self.moment().map(|moment| moment.clip);
        if let Some(document) = &mut self.document {
            document.scene.frame_clip(clip);
        }
    }

    /// Keeps clip and time if the same mesh was loaded again, even with a crease band, with which it can't be animated.
    /// Resets them for another mesh.
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
        // The scene must have its pose before it is drawn.
        if let Err(error) = self.pose_now() {
            self.dialogs.error = Some(error.to_string());
        }
    }

    /// Plays the clip, or the first one if none is chosen; or pauses.
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

    /// Advances the time while a clip plays in a loop.
    pub(in crate::app) fn play_on(&mut self, context: &egui::Context) {
        let Some((last, clip)) = self.viewport.playback.playing.zip(self.viewport.playback.clip) else { return };
        let now = context.input(|input| input.time);
        let time = self.viewport.playback.time + (now - last) * self.viewport.playback.speed;
        self.viewport.playback.time = self.clips().get(clip).map_or(0.0, |clip| clip.looped(time));
        self.viewport.playback.playing = Some(now);
        context.request_repaint();
    }
}

//! Failures of the graphics device. If it refuses a command, the picture isn't drawn. If it is lost, the window goes on with
//! another device and keeps its mesh, settings, camera, animation, reference surface, chart and selection.

use std::path::Path;
use std::time::{Duration, Instant};

use super::fatal_screen::FatalScreen;
use crate::app::App;
use crate::app::jobs::job_list::Work;
use crate::app::jobs::scenes::scene_of;
use crate::app::style::style;
use crate::app::viewport::picture::Picture;
use crate::app::viewport::preview::Preview;
use crate::app::viewport::warm_up::WarmUp;
use gpu::{Gpu, GpuError, LodShader, SurfaceShader};
use inspect::engine::Engine;
use inspect::render::WindowPipelines;

/// A device that is lost sooner than this after the last one isn't replaced automatically.
const LASTS: Duration = Duration::from_secs(60);

/// When the last device was lost.
#[derive(Default)]
pub(crate) struct DeviceLosses(Option<Instant>);

impl DeviceLosses {
    /// Whether a device that is lost now is replaced automatically. The first one is, and so is one that has drawn a picture
    /// and is lost a minute or more after the last. Others would probably be lost again.
    fn replaces(&mut self, now: Instant, has_drawn: bool) -> bool {
        let last = self.0.replace(now);
        last.is_none_or(|last| has_drawn && now.duration_since(last) >= LASTS)
    }
}

/// What happens after a window was closed.
pub(crate) enum Next {
    Quit,
    /// Another window opens with the same state.
    Anew,
    /// The program ends with this error.
    GiveUp(String),
}

impl App {
    /// The device that the window is drawn with.
    pub fn gpu(&self) -> &Gpu {
        self.window.fatal_screen.as_ref().map_or(&self.engine.gpu, |screen| &screen.gpu)
    }

    /// Whether that device was lost, so that nothing can be shown in this window any more.
    pub fn is_lost(&self) -> bool {
        self.gpu().lost().is_some()
    }

    pub(in crate::app) fn next(&self) -> Next {
        match (&self.window.fatal_screen, self.gpu().lost()) {
            (None, None) => Next::Quit,
            (None, Some(_)) => Next::Anew,
            (Some(screen), None) if screen.tries_again => Next::Anew,
            (Some(_), None) => Next::Quit,
            (Some(_), Some(why)) => Next::GiveUp(why.to_owned()),
        }
    }

    /// Moves the state to another window with a new device; `before` is the context of the window before. If the new device
    /// isn't to be used, or fails, the window only says so and offers to save the mesh.
    ///
    /// # Errors
    /// The window isn't drawn through wgpu.
    pub fn anew(mut self, creation: &eframe::CreationContext, before: &egui::Context) -> Result<Self, GpuError> {
        let state = creation.wgpu_render_state.clone().ok_or(GpuError::NoAdapter)?;
        // egui's memory has theme, zoom, scroll positions and folded sections.
        let memory = before.memory(Clone::clone);
        creation.egui_ctx.memory_mut(|own| *own = memory);
        style(&creation.egui_ctx);
        let why = self.engine.gpu.lost().unwrap_or_default().to_owned();
        let gpu = Gpu::new(&state.adapter, state.device.clone(), state.queue.clone());
        let (was_fatal, has_drawn) = (self.window.fatal_screen.take().is_some(), self.viewport.picture.pictures > 0);
        if !self.window.losses.replaces(Instant::now(), has_drawn) && !was_fatal {
            self.window.fatal_screen =
                Some(FatalScreen::new(gpu, format!("The graphics device was lost again ({why}).")));
        } else if let Err(error) = self.move_to(&creation.egui_ctx, gpu.clone(), state) {
            self.window.fatal_screen =
                Some(FatalScreen::new(gpu, format!("The graphics device was lost ({why}); then {error}.")));
        } else {
            self.dialogs.error = Some(format!(
                "The graphics device was lost ({why}). The window goes on with a new one: mesh, settings and camera are as \
                 they were."
            ));
        }
        Ok(self)
    }

    /// Makes on another device everything that was on the last one. If that fails, nothing is changed.
    fn move_to(
        &mut self,
        context: &egui::Context,
        gpu: Gpu,
        render_state: egui_wgpu::RenderState,
    ) -> Result<(), GpuError> {
        let engine = gpu.attempt(|| Engine::new(gpu.clone()))?;
        let painting = WindowPipelines::new(&gpu, render_state.target_format)?;
        let scene = self.document.as_ref().map(|document| scene_of(&engine, &document.loaded)).transpose()?;
        let mut viewport = Picture::new(&engine);
        viewport.cancelled = self.viewport.picture.cancelled;
        let mut preview = Preview::new(&engine);
        preview.is_on = self.viewport.preview.is_on;
        (self.engine, self.render_state, self.painting) = (engine, render_state, painting);
        (self.viewport.picture, self.viewport.preview) = (viewport, preview);
        (self.viewport.warm_up, self.viewport.legend) = (WarmUp::default(), None);
        if let Some((document, scene)) = self.document.as_mut().zip(scene) {
            document.move_to(scene);
        }
        self.say_title(context);
        self.go_on_in(context);
        self.keep_playback(true);
        Ok(())
    }

    /// Lets jobs go on in this window. Those that need the lost device start over.
    fn go_on_in(&mut self, context: &egui::Context) {
        self.jobs.of_another_window = true;
        [Work::Clip, Work::LeftHalf, Work::StandIn].into_iter().for_each(|work| self.jobs.stop(work));
        self.load_anew(context);
        // What the lost device had of it is gone too.
        if let Some(path) = self.environment_file().map(Path::to_owned) {
            self.environment = None;
            self.read_environment(context, path, false);
        }
        self.watch_shader::<LodShader>(context);
        self.watch_shader::<SurfaceShader>(context);
        self.watch_mesh(context);
        self.dialogs.pending.iter_mut().for_each(|dialog| dialog.since = f64::NEG_INFINITY);
        self.close_chart();
        // The new window has another clock.
        self.persistence.changed = None;
        self.viewport.playback.go_on_in(context);
    }

    pub(in crate::app) fn take_device_problem(&mut self) {
        if let Err(problem) = self.engine.gpu.check() {
            self.dialogs.error = Some(problem.to_string());
        }
    }
}

#[cfg(test)]
mod tests {
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    use super::*;
    use geometry::mesh::Shape;
    use load::Source;
    use load::files::Limits;

    /// Runs frames until nothing is under way.
    fn settle(harness: &mut Harness<App>) {
        let start = Instant::now();
        harness.run_steps(3);
        while harness.state().is_busy() {
            assert!(start.elapsed() < Duration::from_secs(60), "it is still busy");
            std::thread::sleep(Duration::from_millis(2));
            harness.step();
        }
        harness.run_steps(2);
    }

    #[test]
    fn a_refused_picture_is_not_shown_and_not_drawn_again_automatically() {
        let torus = Some(Source::Shape(Shape::Torus));
        let mut harness = Harness::builder().with_size([1200.0, 960.0]).wgpu().build_eframe(|context| {
            App::new(context, torus, Limits::default()).expect("these tests need a graphics adapter")
        });
        settle(&mut harness);
        let loaded = harness.state().loaded().cloned().expect("a torus");
        let pictures = harness.state().pictures();
        let document = harness.state().document.as_ref().expect("a torus");
        document.scene.tessellator.edge_factors().0.destroy();
        harness.state_mut().settings.tessellation.tolerance = 3.0;
        let refused = |harness: &mut Harness<App>| {
            settle(harness);
            harness.get_by_label_contains("the graphics device refused a command");
            harness.get_by_label("Draw");
            assert_eq!(harness.state().pictures(), pictures, "nothing was drawn");
            assert!(harness.state().viewport.picture.drawn.is_none(), "no picture is shown as if it were drawn");
            harness.get_by_label("Close").click();
            harness.run_steps(20);
            assert!(harness.query_by_label("Close").is_none(), "no second message: it isn't drawn again");
        };
        refused(&mut harness);
        harness.get_by_label("Draw").click();
        refused(&mut harness);
        let (context, settings) = (harness.ctx.clone(), *harness.state().settings());
        harness.state_mut().reload(&context);
        settle(&mut harness);
        assert!(harness.state().pictures() > pictures && harness.query_by_label("Draw").is_none());
        assert_eq!(
            (harness.state().settings(), &harness.state().loaded().expect("a torus").source),
            (&settings, &loaded.source)
        );
    }

    #[test]
    fn a_device_is_replaced_once_a_minute_and_only_after_a_picture() {
        let start = Instant::now();
        let lost = |times: &[(u64, bool)]| {
            let mut losses = DeviceLosses::default();
            let replaces = |&(s, has_drawn): &(u64, bool)| losses.replaces(start + Duration::from_secs(s), has_drawn);
            times.iter().map(replaces).collect::<Vec<_>>()
        };
        assert_eq!(lost(&[(0, false)]), [true], "the first loss, even before a picture");
        assert_eq!(lost(&[(5, true), (64, true)]), [true, false], "59 s later");
        assert_eq!(lost(&[(5, true), (65, true)]), [true, true]);
        assert_eq!(lost(&[(5, true), (600, false)]), [true, false], "it has drawn nothing");
        assert_eq!(lost(&[(0, true), (59, true), (118, true)]), [true, false, false], "counted from the last one");
    }
}

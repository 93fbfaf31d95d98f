//! The left half of a split view with another tessellation. Its scene is made on a thread of its own, and only while it is shown.

use std::time::Duration;

use crate::app::App;
use crate::app::jobs::background_job::Stopped;
use crate::app::jobs::job_list::Work;
use crate::app::jobs::measure_job::{MeasureError, Results, Seen};
use crate::app::jobs::scenes::arena_bytes;
use crate::app::jobs::user_shader_job::OpenShader;
use crate::app::text::counted;
use gpu::GpuError;
use inspect::measure::Measured;
use inspect::render::Scene;
use inspect::settings::{Choice, Declaration, SplitSide, options};

/// Making a scene for longer than this is shown in the window.
const NOTICED: Duration = Duration::from_millis(300);

impl App {
    /// Whether making the left half's scene takes so long that the window should say so.
    pub(super) fn left_takes_long(&self) -> bool {
        self.jobs.get(Work::LeftHalf).is_some_and(|job| job.since.elapsed() > NOTICED)
    }

    /// Makes the left half's scene or drops it, as the settings want it. Waits until no picture is under way.
    pub(in crate::app) fn keep_left(&mut self, context: &egui::Context) -> Result<(), GpuError> {
        let Some(document) = self.document.as_mut().filter(|_| self.viewport.picture.is_free()) else { return Ok(()) };
        let is_wanted = self.settings.half(SplitSide::Left).is_some();
        if !is_wanted {
            self.jobs.stop(Work::LeftHalf);
        }
        if is_wanted == document.scene.half(SplitSide::Left).is_some() || self.jobs.has(Work::LeftHalf) {
            return Ok(());
        }
        document.halves[SplitSide::Left as usize].forget();
        if !is_wanted {
            return document.scene.set_left(None);
        }
        let (gpu, make) = (self.engine.gpu.clone(), document.scene.sibling(arena_bytes(&self.engine)));
        let make = move |_: &_| gpu.attempt(make)?;
        self.jobs.start(context, Work::LeftHalf, String::new(), make, |app, _, made| app.take_left(made));
        Ok(())
    }

    fn take_left(&mut self, made: Result<Result<Scene, GpuError>, Stopped>) {
        let Some(document) = &mut self.document else { return };
        let taken = match made {
            Ok(made) => made.and_then(|mut left| {
                // It shows a surface of ours.
                left.tessellator.set_surface_shader(None)?;
                document.left_made += 1;
                document.scene.set_left(Some(left))
            }),
            Err(stopped) => return self.leave_as_it_came(&format!("tessellating it {stopped}")),
        };
        taken.unwrap_or_else(|error| self.leave_as_it_came(&error.to_string()));
    }

    fn leave_as_it_came(&mut self, why: &str) {
        self.settings.left = None;
        self.dialogs.error = Some(format!("the left half can't show another tessellation: {why}"));
    }

    /// Measures the left half while it is shown.
    pub(in crate::app) fn measure_left(&mut self, seen: &Seen) -> Result<(), MeasureError> {
        let is_wanted = self.settings.half(SplitSide::Left).is_some();
        let Some(document) = self.document.as_mut() else { return Ok(()) };
        let left = document.scene.half_mut(SplitSide::Left).filter(|left| is_wanted && left.tessellator.is_counted());
        let measure = &mut document.halves[SplitSide::Left as usize].measure;
        match left.zip(self.settings.half(SplitSide::Left)) {
            Some((scene, settings)) => {
                let seen = Seen { inputs: settings.inputs(seen.inputs.view), ..*seen };
                measure.go_on(&self.engine.gpu, scene, &seen)
            }
            None => {
                if measure.is_busy() {
                    measure.forget();
                }
                Ok(())
            }
        }
    }

    /// What was measured last. The panels show all of it together: while another picture is measured, that of the picture before. None
    /// while a clip plays, and if the picture isn't drawn: these aren't measured.
    pub(in crate::app) fn results(&self) -> Option<&Results> {
        let is_measured = !self.is_playing() && self.viewport.picture.cancelled.is_none();
        self.last_results().filter(|_| is_measured)
    }

    /// What was measured last of the document.
    pub(in crate::app) fn last_results(&self) -> Option<&Results> {
        self.document.as_ref()?.right().measure.last()
    }

    pub(in crate::app) fn found(&self, half: SplitSide) -> Option<&Measured> {
        self.document.as_ref()?.halves[half as usize].measure.found()
    }

    /// The title of a half if the split has two tessellations: the surface, with the deviation overlay its largest deviation, what else
    /// differs between the halves, and what was counted.
    pub(in crate::app) fn half_title(&self, half: SplitSide) -> Option<String> {
        let name = self.surface_title(half)?;
        let own = self.settings.half(half)?;
        let other = self.settings.half(if half == SplitSide::Left { SplitSide::Right } else { SplitSide::Left })?;
        let first = self.largest_text(half).map_or_else(|| name.clone(), |largest| format!("{name}: {largest}"));
        let differs = |option: &&Declaration| {
            option.name != options::SURFACE.name
                && option.get(&own) != option.get(&other)
                && (option.no_effect)(&own).is_none()
        };
        let differing = options::TESSELLATION.into_iter().filter(differs).map(|option| option.shown(&own));
        let scene = self.document.as_ref().and_then(|document| document.scene.half(half));
        let triangles = scene.map(|scene| counted(scene.tessellator.totals().1, "triangle"));
        let cracks = self.found(half).map(|found| counted(found.cracks.cracked().len() as u64, "cracked edge"));
        let lines = [Some(first), joined(differing), joined(triangles.into_iter().chain(cracks))];
        Some(lines.into_iter().flatten().collect::<Vec<_>>().join("\n"))
    }

    /// What the surface of a half is called: as the list of surfaces has it, or a shader's file.
    pub(in crate::app) fn surface_title(&self, half: SplitSide) -> Option<String> {
        let chosen = self.settings.half(half)?.tessellation.surface.label().to_owned();
        let own = self.surface_shader.as_ref().filter(|open| open.is_used() && half == SplitSide::Right);
        Some(own.map_or(chosen, OpenShader::name))
    }
}

/// Joins texts by commas; none if there are none.
fn joined(texts: impl Iterator<Item = String>) -> Option<String> {
    let texts: Vec<_> = texts.collect();
    (!texts.is_empty()).then(|| texts.join(", "))
}

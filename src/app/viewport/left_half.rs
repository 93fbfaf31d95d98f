//! The left half of a split view. Its scene is made on a thread of its own, and only while it is shown.

use crate::app::App;
use crate::app::jobs::background_job::Stopped;
use crate::app::jobs::job_list::Work;
use crate::app::jobs::measure_job::Results;
use crate::app::jobs::scenes::{arena_bytes, scene_of};
use crate::app::jobs::user_shader_job::OpenShader;
use gpu::GpuError;
use inspect::measure::Measured;
use inspect::render::Scene;
use inspect::settings::SplitSide;
use inspect::shot::{HalfFacts, half_title, mesh_title, surface_title};

impl App {
    /// Makes the left half's scene or drops it, as the settings want it. Waits until no picture is under way.
    pub(in crate::app) fn keep_left(&mut self, context: &egui::Context) -> Result<(), GpuError> {
        let wanted = self.settings.split.map(|_| self.other_left().map_or(0, |left| left.generation));
        let Some(document) = self.document.as_mut().filter(|_| self.viewport.picture.is_free()) else { return Ok(()) };
        if wanted.is_none() {
            self.jobs.stop(Work::LeftHalf);
        }
        let shown = document.scene.half(SplitSide::Left).map(|_| document.left_of);
        if wanted == shown || self.jobs.has(Work::LeftHalf) {
            return Ok(());
        }
        // What measures the scene before must not go on with another one.
        document.halves[SplitSide::Left as usize].forget();
        document.scene.set_left(None)?;
        let Some(wanted) = wanted else { return Ok(()) };
        let (engine, sibling) = (self.engine.clone(), document.scene.sibling(arena_bytes(&self.engine)));
        let other = self.left_mesh.as_ref().filter(|left| left.generation == wanted).map(|left| left.content.clone());
        let make = move |_: &_| match other {
            Some(other) => scene_of(&engine, &other),
            None => engine.gpu.attempt(sibling)?,
        };
        self.jobs.start(context, Work::LeftHalf, String::new(), make, move |app, _, made| app.take_left(made, wanted));
        Ok(())
    }

    fn take_left(&mut self, made: Result<Result<Scene, GpuError>, Stopped>, of: u64) {
        let Some(document) = &mut self.document else { return };
        let taken = match made {
            Ok(made) => made.and_then(|mut left| {
                // It shows a surface of ours.
                left.tessellator.set_surface_shader(None)?;
                document.left_made += 1;
                document.left_of = of;
                document.from_files.left_factors = if of == 0 { document.from_files.factors } else { 0 };
                document.scene.set_left(Some(left))
            }),
            Err(stopped) => return self.leave_as_it_came(&format!("tessellating it {stopped}")),
        };
        taken.unwrap_or_else(|error| self.leave_as_it_came(&error.to_string()));
    }

    fn leave_as_it_came(&mut self, why: &str) {
        self.settings.split = None;
        self.dialogs.error = Some(format!("the left half can't be shown: {why}"));
    }

    /// What was measured last. The panels show all of it together: while another picture is measured, that of the picture before. None
    /// while a clip plays, and if the picture isn't drawn: these aren't measured.
    pub(in crate::app) fn results(&self) -> Option<&Results> {
        self.results_of(SplitSide::Right)
    }

    /// The same of a half.
    pub(in crate::app) fn results_of(&self, half: SplitSide) -> Option<&Results> {
        let is_measured = !self.is_playing() && self.viewport.picture.cancelled.is_none();
        self.document.as_ref()?.halves[half as usize].measure.last().filter(|_| is_measured)
    }

    pub(in crate::app) fn found(&self, half: SplitSide) -> Option<&Measured> {
        self.document.as_ref()?.halves[half as usize].measure.found()
    }

    /// The title of a half of a split view: its surface, with the deviation overlay its largest deviation, what else differs between
    /// the halves, and what was counted.
    pub(in crate::app) fn half_title(&self, half: SplitSide) -> String {
        let open = self.document.as_ref();
        let meshes = self.other_left().zip(open).map(|(left, open)| {
            let names = [left.title(open), open.loaded.source.title()];
            mesh_title(half, [&left.content, &open.loaded], names)
        });
        let scene = open.and_then(|document| document.scene.half(half));
        let facts = HalfFacts {
            mesh: meshes.unwrap_or_default(),
            pose: open.and_then(|document| document.scene.pose_title(half)),
            shader: self.shader_title(half),
            largest: self.largest_text(half),
            triangles: scene.map(|scene| scene.tessellator.totals().1),
            cracked_edges: self.found(half).map(|found| found.cracks.cracked().len() as u64),
        };
        half_title(&self.settings, half, facts)
    }

    /// What the surface of a half is called: as the list of surfaces has it, or a shader's file.
    pub(in crate::app) fn surface_title(&self, half: SplitSide) -> String {
        self.shader_title(half).unwrap_or_else(|| surface_title(&self.settings, half).to_owned())
    }

    /// The file of the shader in place of a half's surface.
    fn shader_title(&self, half: SplitSide) -> Option<String> {
        let own = self.surface_shader.as_ref().filter(|open| open.is_used() && half == SplitSide::Right);
        own.map(OpenShader::name)
    }
}

//! Copies the command line that draws what the window shows.

use std::path::Path;

use crate::app::App;
use crate::app::jobs::companion_files::absolute_path;
use crate::app::jobs::job_list::LeftChoice;
use crate::app::jobs::picture_job::PictureChoices;
use inspect::render::{Camera, LeftPose};
use inspect::settings::{Settings, SplitSide};
use inspect::shot::{AT_REST, CopiedCommand, ShotView, Turn};
use load::{HeightSource, Source};

const DRAWS_IT: &str = "This command draws it without a window:";
const DRAWS_RIGHT: &str = "This command draws the right half without a window. The left half is left out, because no command can \
                           name the earlier version of a mesh:";

impl App {
    /// Copies the command that draws what is shown with these choices, and shows that command in a window. A turn makes it a turntable,
    /// as a GIF or not.
    pub(in crate::app) fn copy_command(
        &mut self,
        context: &egui::Context,
        choices: &PictureChoices,
        turn: Option<(Turn, bool)>,
    ) {
        let command = self.command_of(context.theme(), choices, &self.viewport.camera, None, turn);
        let Some(command) = command else { return };
        context.copy_text(command.clone());
        let lacks_left = self.settings.split.is_some() && self.shows_earlier();
        self.commands.copied = Some((command, if lacks_left { DRAWS_RIGHT } else { DRAWS_IT }));
    }

    /// Copies the picture that is shown.
    pub(in crate::app) fn copy_picture(&mut self, context: &egui::Context) {
        match self.read_picture() {
            Ok(Some(picture)) => {
                let size = [picture.width() as usize, picture.height() as usize];
                context.copy_image(egui::ColorImage::from_rgba_unmultiplied(size, &picture));
            }
            Ok(None) => {}
            Err(error) => self.dialogs.error = Some(error.to_string()),
        }
    }

    /// The command that draws what is shown, with these choices, as this camera sees it; none without a mesh. Without an
    /// output, the file is named after the mesh. A left half that shows the earlier version of a mesh is left out.
    pub(in crate::app) fn command_of(
        &self,
        theme: egui::Theme,
        choices: &PictureChoices,
        camera: &Camera,
        output: Option<&Path>,
        turn: Option<(Turn, bool)>,
    ) -> Option<String> {
        let document = self.document.as_ref()?;
        let animation = document.scene.clip_and_time();
        let source = absolute_source(&document.loaded.source);
        let reference_shape = self.reference_shape().map(absolute_source);
        let (left_mesh, left_morphs) = match self.left_mesh.as_ref().map(|left| &left.from) {
            Some(LeftChoice::Read(from, morphs)) => (from.as_ref().map(absolute_source), Some(morphs)),
            Some(LeftChoice::Kept(_)) | None => (None, None),
        };
        let mut preparation = document.loaded.preparation.clone();
        if preparation.heights.is_none() && self.has_heights() {
            preparation.heights = Some(HeightSource::Model);
        }
        preparation.heights.iter_mut().for_each(HeightSource::make_absolute);
        let settings = self.saved_settings_of(theme, choices);
        let settings = Settings { split: settings.split.filter(|_| !self.shows_earlier()), ..settings };
        let left = document.scene.half(SplitSide::Left).filter(|_| settings.split.is_some());
        let left = left.filter(|_| document.scene.left_pose() != LeftPose::Same);
        let left_animation = left.map(|left| left.clip_and_time().unwrap_or((AT_REST.to_owned(), 0.0)));
        let shown = CopiedCommand {
            source: &source,
            preparation: &preparation,
            settings: &settings,
            view: ShotView { camera: *camera, ..self.shot_view(choices) },
            radius: document.scene.bounds.radius(),
            animation: animation.as_ref().map(|(name, time)| (&**name, *time)),
            left_animation: left_animation.as_ref().map(|(name, time)| (&**name, *time)),
            reference_shape: reference_shape.as_ref(),
            reference_subdivide: self.has_own_limit().then(|| self.own_scheme()),
            left_mesh: left_mesh.as_ref(),
            left_morphs,
            factors: self.factors_file(),
            lod_shader: self.lod_shader_file().filter(|_| self.uses_lod_shader()),
            surface_shader: self.surface_shader_file(),
            matcap_image: self.matcap_image(),
            environment: self.environment_file(),
            triangle: self.selected_triangle().filter(|_| choices.overlays),
            output,
            turn,
        };
        Some(shown.line())
    }

    pub(in crate::app) fn command_window(&mut self, context: &egui::Context) {
        let Some((command, said)) = &self.commands.copied else { return };
        let mut is_open = true;
        let window = egui::Window::new("Copied").open(&mut is_open).resizable(false).collapsible(false);
        let window = window.pivot(egui::Align2::CENTER_TOP).fixed_pos(self.message_place());
        window.default_width(520.0).show(context, |ui| {
            ui.label(*said);
            ui.add(egui::Label::new(egui::RichText::new(command).monospace()).wrap().selectable(true));
        });
        if !is_open {
            self.commands.copied = None;
        }
    }
}

/// A source with an absolute path, which is valid in every folder.
fn absolute_source(source: &Source) -> Source {
    match source {
        Source::File(path) => Source::File(absolute_path(path.clone())),
        shape => shape.clone(),
    }
}

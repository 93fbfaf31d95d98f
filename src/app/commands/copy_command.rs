//! Copies the command line that draws what the window shows.

use crate::app::App;
use crate::cli::CopiedCommand;
use crate::load::{HeightSource, Source};

impl App {
    /// Copies the command that draws what is shown, and shows that command in a window.
    pub(in crate::app) fn copy_command(&mut self, context: &egui::Context) {
        let Some(document) = &self.document else { return };
        let moment = self.moment().zip(document.loaded.mesh.rig.as_deref());
        let animation = moment.map(|(moment, rig)| (rig.clip_name(moment.clip), moment.time));
        let source = absolute_source(&document.loaded.source);
        let truth = self.truth.as_ref().map(|truth| absolute_source(&truth.source));
        let mut preparation = document.loaded.preparation.clone();
        if let Some(HeightSource::File(path)) = &mut preparation.heights {
            *path = std::path::absolute(&*path).unwrap_or_else(|_| path.clone());
        }
        let shown = CopiedCommand {
            source: &source,
            preparation: &preparation,
            settings: &self.settings,
            camera: &self.viewport.camera,
            radius: document.scene.bounds.radius(),
            size: self.viewport.picture.size().to_array().map(|side| side as u32),
            animation: animation.as_ref().map(|(name, time)| (&**name, *time)),
            truth: truth.as_ref(),
            triangle: self.selected_triangle(),
        };
        let command = shown.line();
        context.copy_text(command.clone());
        self.commands.copied = Some(command);
    }

    pub(in crate::app) fn command_window(&mut self, context: &egui::Context) {
        let Some(command) = &self.commands.copied else { return };
        let mut is_open = true;
        let window = egui::Window::new("Copied").open(&mut is_open).resizable(false).collapsible(false);
        window.anchor(egui::Align2::CENTER_TOP, egui::vec2(0.0, 40.0)).default_width(520.0).show(context, |ui| {
            ui.label("This command draws the picture without a window:");
            ui.add(egui::Label::new(egui::RichText::new(command).monospace()).wrap().selectable(true));
            if self.viewport.frozen.is_some() {
                ui.weak("The command computes LOD for this camera, not for the frozen one.");
            }
        });
        if !is_open {
            self.commands.copied = None;
        }
    }
}

/// A source with an absolute path, which is valid in every folder.
fn absolute_source(source: &Source) -> Source {
    match source {
        Source::File(path) => Source::File(std::path::absolute(path).unwrap_or_else(|_| path.clone())),
        shape => shape.clone(),
    }
}

//! Files that the window writes: the picture and the tessellated mesh.

use std::path::PathBuf;

use crate::app::App;
use crate::app::jobs::background_job::BackgroundJob;
use crate::app::jobs::export_job::ExportJob;
use crate::cli::write_picture;
use crate::export::{Exported, ending};
use crate::names::shown_path;

impl App {
    /// Whether a picture or a mesh is being written.
    pub fn is_writing(&self) -> bool {
        self.jobs.export.is_some() || self.jobs.picture_file.is_some()
    }

    /// Writes the viewport's picture, without the texts over it, as a PNG file.
    ///
    /// # Errors
    /// The path doesn't end in .png, nothing is drawn yet, or the device was lost; as a sentence.
    pub fn save_picture(&mut self, context: &egui::Context, path: PathBuf) -> Result<(), String> {
        if ending(&path) != "png" {
            return Err(format!("{}: the name must end in .png", shown_path(&path)));
        }
        let picture = self.read_picture().map_err(|error| error.to_string())?;
        let picture = image::DynamicImage::from(picture.ok_or("nothing is drawn yet")?);
        let write = move || {
            write_picture(&path, &picture).map_err(|error| error.to_string())?;
            Ok(format!("{} is written.", shown_path(&path)))
        };
        self.jobs.picture_file = Some(BackgroundJob::start(context, write));
        Ok(())
    }

    /// Starts to write the mesh that is emitted for this view, or for the frozen one, as a .glb or .obj file.
    ///
    /// # Errors
    /// The path has another ending; as a sentence.
    pub fn export_mesh(&mut self, context: &egui::Context, path: PathBuf) -> Result<(), String> {
        Exported::check(&path, 0, 0).map_err(|error| error.to_string())?;
        let Some(document) = &self.document else { return Ok(()) };
        let view = self.viewport.camera.lod_view(self.viewport.picture.size(), &document.scene.bounds);
        let inputs = self.settings.inputs(self.viewport.frozen.unwrap_or(view));
        self.jobs.export = Some(ExportJob::start(context, &self.engine, document, inputs, path));
        Ok(())
    }

    /// Shows what was written, or why it couldn't be.
    pub(in crate::app) fn take_written(&mut self) {
        let exported = self.jobs.export.as_ref().and_then(ExportJob::take);
        if let Some(ended) = exported {
            self.jobs.export = None;
            self.say_written(ended);
        }
        let picture = self.jobs.picture_file.as_ref().and_then(BackgroundJob::take);
        if let Some(ended) = picture {
            self.jobs.picture_file = None;
            self.say_written(ended.unwrap_or_else(|stopped| Err(format!("saving the picture {stopped}"))));
        }
    }

    fn say_written(&mut self, ended: Result<String, String>) {
        match ended {
            Ok(written) => self.dialogs.notice = Some(written),
            Err(why) => self.dialogs.error = Some(why),
        }
    }
}

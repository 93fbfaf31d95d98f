//! Files that the window writes: pictures, the tessellated mesh, and numbers.

use std::path::{Path, PathBuf};

use super::notice::Notice;
use super::turntable_window::TurntableWindow;
use crate::app::App;
use crate::app::jobs::document::arena_bytes;
use crate::app::jobs::export_job::Export;
use crate::app::jobs::picture_job::PictureChoices;
use crate::app::jobs::writing_job::WritingJob;
use geometry::mesh::adjacency::Layout;
use geometry::names::shown_path;
use geometry::progress::Progress;
use inspect::adjacency_file::Format;
use inspect::export::{Exported, ending};
use inspect::shot::files::write_adjacency;
use inspect::shot::{ShotError, frame_name};

impl App {
    /// Whether a file is being written, other than the chart's.
    pub fn is_writing(&self) -> bool {
        self.jobs.writing.is_some()
    }

    /// Starts to draw the picture as was last chosen, and to write it as a PNG file.
    ///
    /// # Errors
    /// The path doesn't end in .png; as a sentence.
    pub fn save_picture(&mut self, context: &egui::Context, path: PathBuf) -> Result<(), String> {
        check_ending(&path, &["png"])?;
        let (theme, choices) = (context.theme(), self.dialogs.picture.choices);
        let name = path.file_name().map(Path::new);
        let command = self.command_of(theme, &choices, &self.viewport.camera, name, None);
        let Some((parts, command)) = self.shot_parts(theme, &choices).zip(command) else { return Ok(()) };
        self.write(context, path, move |path, progress| parts.save(&command, path, progress));
        Ok(())
    }

    /// Starts to draw a turntable as was last chosen, and to write its folder or GIF file.
    ///
    /// # Errors
    /// The path ends as a file of another kind; as a sentence.
    pub fn save_turntable(&mut self, context: &egui::Context, path: PathBuf) -> Result<(), String> {
        let TurntableWindow { choices, turn, is_gif, .. } = self.dialogs.turntable;
        if is_gif {
            check_ending(&path, &["gif"])?;
        } else if !ending(&path).is_empty() {
            return Err(format!("{}: the name of a folder must have no ending", shown_path(&path)));
        }
        let theme = context.theme();
        let command = |frame| {
            let (camera, name) = (turn.camera(&self.viewport.camera, frame), frame_name(frame));
            self.command_of(theme, &choices, &camera, Some(Path::new(&name)), None)
        };
        let commands: Option<Vec<String>> = (0..if is_gif { 0 } else { turn.frames }).map(command).collect();
        let Some((parts, commands)) = self.shot_parts(theme, &choices).zip(commands) else { return Ok(()) };
        self.write(context, path, move |path, progress| parts.save_turn(turn, &commands, path, progress));
        Ok(())
    }

    /// Starts to write the factors of this view, or of the frozen one, as a .csv file.
    ///
    /// # Errors
    /// The path has another ending; as a sentence.
    pub fn save_factors(&mut self, context: &egui::Context, path: PathBuf) -> Result<(), String> {
        check_ending(&path, &["csv"])?;
        let Some(parts) = self.shot_parts(context.theme(), &PictureChoices::default()) else { return Ok(()) };
        self.write(context, path, move |path, progress| parts.save_factors(path, progress));
        Ok(())
    }

    /// Starts to write the index buffer of 9 indices a patch as a .json or .bin file.
    ///
    /// # Errors
    /// The path has another ending; as a sentence.
    pub fn save_adjacency(&mut self, context: &egui::Context, path: PathBuf) -> Result<(), String> {
        check_ending(&path, &["json", "bin"])?;
        let Some(loaded) = self.document.as_ref().map(|document| document.loaded.clone()) else { return Ok(()) };
        self.write(context, path, move |path, progress| {
            let indices = Layout::Nine.indices(&loaded.topology);
            let written = progress
                .check()
                .map_err(ShotError::from)
                .and_then(|()| write_adjacency(&loaded, Layout::Nine, &indices, Format::of_name(path), path));
            written.map_err(|error| error.to_string())
        });
        Ok(())
    }

    /// Starts to measure what is shown, and to write the numbers as a .json file.
    ///
    /// # Errors
    /// The path has another ending; as a sentence.
    pub fn save_stats(&mut self, context: &egui::Context, path: PathBuf) -> Result<(), String> {
        check_ending(&path, &["json"])?;
        let Some(parts) = self.shot_parts(context.theme(), &PictureChoices::default()) else { return Ok(()) };
        let adapter = self.render_state.adapter.clone();
        self.write(context, path, move |path, progress| parts.save_stats(&adapter, path, progress));
        Ok(())
    }

    fn write(
        &mut self,
        context: &egui::Context,
        path: PathBuf,
        write: impl FnOnce(&Path, &Progress) -> Result<(), String> + Send + 'static,
    ) {
        let write = |path: &Path, progress: &Progress| write(path, progress).map(|()| Vec::new());
        self.jobs.writing = Some(WritingJob::start(context, "Saving", path, write));
    }

    /// Starts to write the mesh that is emitted for this view, or for the frozen one, as a .glb or .obj file.
    ///
    /// # Errors
    /// The path has another ending; as a sentence.
    pub fn export_mesh(&mut self, context: &egui::Context, path: PathBuf) -> Result<(), String> {
        Exported::check_ending(&path).map_err(|error| error.to_string())?;
        let Some(document) = &self.document else { return Ok(()) };
        let view = self.viewport.camera.lod_view(self.viewport.picture.size(), &document.scene.bounds);
        let inputs = self.settings.inputs(self.viewport.frozen.map_or(view, |frozen| frozen.view));
        let (engine, loaded, moment) = (self.engine.clone(), document.loaded.clone(), document.moment);
        let make = document.scene.beside(arena_bytes(&engine));
        let export = Export { engine, loaded, moment, inputs };
        let write = move |path: &Path, progress: &_| export.run(make, path, progress);
        self.jobs.writing = Some(WritingJob::start(context, "Exporting", path, write));
        Ok(())
    }

    /// Shows what was written, or why it couldn't be.
    pub(in crate::app) fn take_written(&mut self) {
        let Some(ended) = self.jobs.writing.as_ref().and_then(WritingJob::take) else { return };
        self.jobs.writing = None;
        match ended {
            Ok(written) => self.dialogs.notice = Some(Notice::new(written)),
            Err(why) => self.dialogs.error = Some(why),
        }
    }
}

/// Checks how a path ends.
///
/// # Errors
/// It ends otherwise; as a sentence.
fn check_ending(path: &Path, endings: &[&str]) -> Result<(), String> {
    match endings.contains(&&*ending(path)) {
        true => Ok(()),
        false => Err(format!("{}: the name must end in .{}", shown_path(path), endings.join(" or ."))),
    }
}

//! Files that the window writes: pictures, the tessellated mesh, and numbers.

use std::path::{Path, PathBuf};

use super::notice::Notice;
use super::turntable_window::TurntableWindow;
use crate::app::App;
use crate::app::jobs::companion_files::file_name;
use crate::app::jobs::job_list::Work;
use crate::app::jobs::picture_job::{PictureChoices, ShotParts};
use crate::commands::Written;
use geometry::mesh::adjacency::Layout;
use geometry::names::shown_path;
use geometry::progress::Progress;
use inspect::adjacency_file::Format;
use inspect::export::{Exported, ending};
use inspect::shot::files::write_adjacency;
use inspect::shot::{ShotError, frame_name};
use lab::chart::save;

impl App {
    pub fn is_writing(&self) -> bool {
        self.jobs.has(Work::File)
    }

    /// Starts to draw the picture as was last chosen, and to write it as a PNG file, or a report on it as a page.
    ///
    /// # Errors
    /// The path doesn't end in .png or .html; as a sentence.
    pub fn save_picture(&mut self, context: &egui::Context, path: PathBuf) -> Result<(), String> {
        check_ending(&path, &["png", "html"])?;
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

    /// Starts to write numbers of this view, or of the frozen one, as a file with this ending.
    ///
    /// # Errors
    /// The path has another ending; as a sentence.
    fn save_numbers(
        &mut self,
        context: &egui::Context,
        path: PathBuf,
        ending: &str,
        save: impl FnOnce(ShotParts, &Path, &Progress) -> Result<(), String> + Send + 'static,
    ) -> Result<(), String> {
        check_ending(&path, &[ending])?;
        let Some(parts) = self.shot_parts(context.theme(), &PictureChoices::default()) else { return Ok(()) };
        self.write(context, path, move |path, progress| save(parts, path, progress));
        Ok(())
    }

    /// Starts to write the index buffer of 9 indices a patch as a .json or .bin file.
    ///
    /// # Errors
    /// The path has another ending; as a sentence.
    fn save_adjacency(&mut self, context: &egui::Context, path: PathBuf) -> Result<(), String> {
        check_ending(&path, &["json", "bin"])?;
        let Some(loaded) = self.document.as_ref().map(|document| document.loaded.clone()) else { return Ok(()) };
        self.write(context, path, move |path, progress| {
            let indices = Layout::Nine.indices(&loaded.topology);
            let written = progress
                .check()
                .map_err(ShotError::from)
                .and_then(|()| write_adjacency(&loaded, Layout::Nine, &indices, Format::from_name(path), path));
            written.map_err(|error| error.to_string())
        });
        Ok(())
    }

    fn write_chart(&mut self, context: &egui::Context, path: PathBuf) {
        let Some(charted) = self.panels.chart.charted() else { return };
        let subject = charted.subject.clone();
        self.write(context, path, move |path, _| save(path, &subject).map_err(|error| error.to_string()));
    }

    /// Starts to write a file.
    ///
    /// # Errors
    /// The path has the ending of another kind of file; as a sentence.
    pub(super) fn write_as(&mut self, context: &egui::Context, what: Written, path: PathBuf) -> Result<(), String> {
        match what {
            Written::Chart => self.write_chart(context, path),
            Written::Picture => self.save_picture(context, path)?,
            Written::Folder | Written::Gif => self.save_turntable(context, path)?,
            Written::Factors => self.save_numbers(context, path, "csv", ShotParts::save_factors)?,
            Written::Adjacency => self.save_adjacency(context, path)?,
            Written::Stats => {
                let adapter = self.render_state.adapter.clone();
                let save = move |parts: ShotParts, path: &Path, progress: &Progress| {
                    parts.save_stats(&adapter, path, progress)
                };
                self.save_numbers(context, path, "json", save)?;
            }
            Written::Mesh => self.export_mesh(context, path)?,
        }
        Ok(())
    }

    fn write(
        &mut self,
        context: &egui::Context,
        path: PathBuf,
        write: impl FnOnce(&Path, &Progress) -> Result<(), String> + Send + 'static,
    ) {
        let write = |path: &Path, progress: &Progress| write(path, progress).map(|()| Vec::new());
        self.write_with_warnings(context, "Saving", path, write);
    }

    /// Starts to write a file, and then shows what was written, or why it couldn't be. `write` returns sentences about what couldn't be
    /// written, or fails with one, and ends early if it is cancelled.
    fn write_with_warnings(
        &mut self,
        context: &egui::Context,
        doing: &str,
        path: PathBuf,
        write: impl FnOnce(&Path, &Progress) -> Result<Vec<String>, String> + Send + 'static,
    ) {
        let (title, shown) = (format!("{doing} {}", file_name(&path)), shown_path(&path));
        let write = move |progress: &Progress| write(&path, progress);
        self.jobs.start(context, Work::File, title, write, move |app, _, ended| {
            match ended.unwrap_or_else(|stopped| Err(format!("{shown}: writing it {stopped}"))) {
                Ok(warnings) => {
                    let said = [vec![format!("{shown} is written.")], warnings].concat().join("\n");
                    app.dialogs.notice = Some(Notice::new(said));
                }
                Err(why) => app.dialogs.error = Some(why),
            }
        });
    }

    /// Starts to write the mesh that is emitted for this view, or for the frozen one, as a .glb or .obj file.
    ///
    /// # Errors
    /// The path has another ending; as a sentence.
    pub fn export_mesh(&mut self, context: &egui::Context, path: PathBuf) -> Result<(), String> {
        Exported::check_ending(&path).map_err(|error| error.to_string())?;
        let Some(parts) = self.shot_parts(context.theme(), &PictureChoices::default()) else { return Ok(()) };
        self.write_with_warnings(context, "Exporting", path, move |path, progress| parts.export(path, progress));
        Ok(())
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

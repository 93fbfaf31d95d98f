//! Files that the window writes: pictures, the tessellated mesh, and numbers.

use std::path::{Path, PathBuf};

use egui::Theme;

use super::purpose::AskedFile;
use super::save_window::SaveWindow;
use super::windows::Notice;
use crate::app::App;
use crate::app::jobs::job_list::Work;
use crate::app::jobs::picture_job::PictureChoices;
use crate::app::text::file_name;
use crate::commands::{Purpose, Written};
use geometry::mesh::adjacency::Layout;
use geometry::names::shown_path;
use geometry::progress::Progress;
use inspect::adjacency_file::Format;
use inspect::export::ending;
use inspect::shot::files::write_adjacency;
use inspect::shot::frame_name;
use lab::chart::save;

/// Writes a file. Returns sentences about what couldn't be written, or fails with one, and ends early if it is cancelled.
type Writer = Box<dyn FnOnce(&Path, &Progress) -> Result<Vec<String>, String> + Send>;

impl App {
    pub fn is_writing(&self) -> bool {
        self.jobs.has(Work::File)
    }

    /// Starts to write a file, and then shows what was written, or why it couldn't be.
    ///
    /// # Errors
    /// The path has the ending of another kind of file; as a sentence.
    pub(in crate::app) fn write_as(
        &mut self,
        context: &egui::Context,
        what: Written,
        path: PathBuf,
    ) -> Result<(), String> {
        check_ending(what, &path)?;
        let Some(write) = self.writer(context.theme(), what, &path) else { return Ok(()) };
        let doing = if what == Written::Mesh { "Exporting" } else { "Saving" };
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
        Ok(())
    }

    /// What writes such a file, with all that it is made from as it is now; none without a mesh, or without a chart. Numbers and the mesh are
    /// those of this view, or of the frozen one.
    fn writer(&self, theme: Theme, what: Written, path: &Path) -> Option<Writer> {
        let plain = || self.shot_parts(theme, &PictureChoices::default());
        Some(match what {
            Written::Chart => {
                let subject = self.panels.chart.charted.as_ref()?.subject.clone();
                without_warnings(move |path, _| {
                    save(path, std::slice::from_ref(&subject)).map_err(|error| error.to_string())
                })
            }
            Written::Picture => {
                let (choices, name) = (self.dialogs.picture.choices, path.file_name().map(Path::new));
                let command = self.command_of(theme, &choices, &self.viewport.camera, name, None)?;
                let parts = self.shot_parts(theme, &choices)?;
                without_warnings(move |path, progress| parts.save(&command, path, progress))
            }
            Written::Folder | Written::Gif => {
                let SaveWindow { choices, turn, .. } = self.dialogs.turntable;
                let command = |frame| {
                    let (camera, name) = (turn.camera(&self.viewport.camera, frame), frame_name(frame));
                    self.command_of(theme, &choices, &camera, Some(Path::new(&name)), None)
                };
                let named = if what == Written::Gif { 0 } else { turn.frames };
                let commands: Vec<String> = (0..named).map(command).collect::<Option<_>>()?;
                let parts = self.shot_parts(theme, &choices)?;
                without_warnings(move |path, progress| {
                    let command = |frame: u32| commands.get(frame as usize).cloned().unwrap_or_default();
                    parts.with_shot(|shot| turn.write(shot, command, path, progress, &mut |_| ()))
                })
            }
            Written::Factors => {
                let parts = plain()?;
                without_warnings(move |path, progress| parts.save_factors(path, progress))
            }
            Written::Adjacency => {
                let loaded = self.document.as_ref()?.loaded.clone();
                without_warnings(move |path, progress| {
                    let indices = Layout::Nine.indices(&loaded.topology);
                    progress.check().map_err(|error| error.to_string())?;
                    let written = write_adjacency(&loaded, Layout::Nine, &indices, Format::from_name(path), path);
                    written.map_err(|error| error.to_string())
                })
            }
            Written::Stats => {
                let (parts, adapter) = (plain()?, self.render_state.adapter.clone());
                without_warnings(move |path, progress| parts.save_stats(&adapter, path, progress))
            }
            Written::Mesh => {
                let parts = plain()?;
                Box::new(move |path, progress| parts.export(path, progress))
            }
        })
    }
}

fn without_warnings(write: impl FnOnce(&Path, &Progress) -> Result<(), String> + Send + 'static) -> Writer {
    Box::new(|path, progress| write(path, progress).map(|()| Vec::new()))
}

/// Checks how a path ends. That of a chart is checked when it is written.
///
/// # Errors
/// It ends otherwise; as a sentence.
fn check_ending(what: Written, path: &Path) -> Result<(), String> {
    let kinds = AskedFile::new(Purpose::Write(what)).kinds;
    let endings: Vec<_> = kinds.into_iter().flat_map(|(_, endings)| endings).collect();
    match (what, &*ending(path)) {
        (Written::Chart, _) | (Written::Folder, "") => Ok(()),
        (Written::Folder, _) => Err(format!("{}: the name of a folder must have no ending", shown_path(path))),
        (_, own) if endings.contains(&own) => Ok(()),
        _ => Err(format!("{}: the name must end in .{}", shown_path(path), endings.join(" or ."))),
    }
}

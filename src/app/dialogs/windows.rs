//! The small windows over the main window, and the desktop's file dialog.

use std::path::PathBuf;

use super::desktop_dialog;
use super::notice::Notice;
use super::typed_path::{PendingDialog, Purpose, name_beside};
use crate::app::App;
use crate::app::jobs::background_job::BackgroundJob;
use load::environment_file::ENVIRONMENT_EXTENSIONS;
use load::format::EXTENSIONS;

impl App {
    pub(in crate::app) fn open_dialog(&mut self, context: &egui::Context) {
        self.dialog(Purpose::Open, context, || meshes("Open a mesh").pick_file());
    }

    pub(in crate::app) fn truth_dialog(&mut self, context: &egui::Context) {
        self.dialog(Purpose::Truth, context, || meshes("Choose a reference surface").pick_file());
    }

    pub(in crate::app) fn factors_dialog(&mut self, context: &egui::Context) {
        self.dialog(Purpose::Factors, context, || {
            rfd::FileDialog::new().set_title("Choose a file of factors").add_filter("CSV", &["csv"]).pick_file()
        });
    }

    pub(in crate::app) fn environment_dialog(&mut self, context: &egui::Context) {
        self.dialog(Purpose::Environment, context, || {
            let dialog = rfd::FileDialog::new().set_title("Open an environment");
            dialog.add_filter("Panoramas of light", &ENVIRONMENT_EXTENSIONS).pick_file()
        });
    }

    /// Asks where the picture is to be saved.
    pub(in crate::app) fn picture_dialog(&mut self, context: &egui::Context) {
        let name = self.proposed_name("-view.png");
        self.dialog(Purpose::SavePicture, context, move || {
            let dialog = rfd::FileDialog::new().set_title("Save the picture").set_file_name(name);
            dialog.add_filter("PNG picture", &["png"]).save_file()
        });
    }

    /// Asks where the tessellated mesh is to be exported.
    pub(in crate::app) fn export_dialog(&mut self, context: &egui::Context) {
        let name = self.proposed_name("-tessellated.glb");
        self.dialog(Purpose::ExportMesh, context, move || {
            let dialog = rfd::FileDialog::new().set_title("Export the tessellated mesh").set_file_name(name);
            dialog.add_filter("glTF binary", &["glb"]).add_filter("Wavefront OBJ", &["obj"]).save_file()
        });
    }

    /// Asks where a turntable is to be saved.
    pub(in crate::app) fn turntable_dialog(&mut self, context: &egui::Context, is_gif: bool) {
        let purpose = if is_gif { Purpose::SaveGif } else { Purpose::SaveFolder };
        let name = self.proposed_name(if is_gif { "-turntable.gif" } else { "-turntable" });
        self.dialog(purpose, context, move || {
            let dialog = rfd::FileDialog::new().set_title("Save the turntable").set_file_name(name);
            if is_gif { dialog.add_filter("Animated GIF", &["gif"]) } else { dialog }.save_file()
        });
    }

    /// Asks where numbers are to be saved: factors, the index buffer or stats.
    pub(in crate::app) fn numbers_dialog(&mut self, context: &egui::Context, purpose: Purpose) {
        let (title, name, filters): (_, _, &[_]) = match purpose {
            Purpose::SaveFactors => ("Save the factors", "-factors.csv", &[("CSV table", "csv")]),
            Purpose::SaveAdjacency => {
                ("Save the adjacency", "-adjacency.json", &[("JSON", "json"), ("Bare indices", "bin")])
            }
            _ => ("Save the stats", "-stats.json", &[("JSON", "json")]),
        };
        let name = self.proposed_name(name);
        self.dialog(purpose, context, move || {
            let dialog = rfd::FileDialog::new().set_title(title).set_file_name(name);
            filters.iter().fold(dialog, |dialog, (kind, ending)| dialog.add_filter(*kind, &[*ending])).save_file()
        });
    }

    /// The proposed name of a file that is made from the mesh.
    fn proposed_name(&self, ending: &str) -> String {
        self.source().map_or_else(|| format!("mesh{ending}"), |source| name_beside(&source.title(), ending))
    }

    /// Opens the desktop's file dialog on a thread of its own.
    pub(in crate::app) fn dialog(
        &mut self,
        purpose: Purpose,
        context: &egui::Context,
        choose: impl FnOnce() -> Option<PathBuf> + Send + 'static,
    ) {
        if self.dialogs.pending.is_none() {
            let job = BackgroundJob::start(context, move || desktop_dialog::ask(choose));
            let since = context.input(|input| input.time);
            self.dialogs.pending = Some(PendingDialog { purpose, job, since, early: Vec::new() });
        }
    }

    /// Shows the small windows that are open.
    pub(in crate::app) fn windows(&mut self, context: &egui::Context) {
        self.path_window(context);
        self.keys_window(context);
        self.command_window(context);
        self.palette_window(context);
        self.forget_window(context);
        self.background_window(context);
        self.picture_window(context);
        self.turntable_window(context);
        self.warnings_window(context);
        self.message_window(context);
    }

    /// The upper end of a message: below the toolbar, so that this stays in reach.
    pub(in crate::app) fn message_place(&self) -> egui::Pos2 {
        self.viewport.rect.center_top() + egui::vec2(0.0, 8.0)
    }

    /// Shows the last error, or what is to be read about the last file that was written, until it is closed.
    fn message_window(&mut self, context: &egui::Context) {
        let notice = self.dialogs.notice.as_ref().and_then(Notice::for_window);
        let (title, text) = match (&self.dialogs.error, notice) {
            (Some(error), _) => ("Problem", &**error),
            (None, Some(notice)) => ("Written", notice),
            (None, None) => return,
        };
        let mut closed = false;
        let window = egui::Window::new(title).resizable(false).collapsible(false);
        let window = window.pivot(egui::Align2::CENTER_TOP).fixed_pos(self.message_place());
        window.default_width(420.0).show(context, |ui| {
            ui.label(text);
            closed = ui.button("Close").clicked() || ui.input(|input| input.key_pressed(egui::Key::Enter));
        });
        if closed && self.dialogs.error.take().is_none() {
            self.dialogs.notice = None;
        }
    }
}

fn meshes(title: &str) -> rfd::FileDialog {
    // A mesh is told by its content, so it may have any name.
    let dialog = rfd::FileDialog::new().set_title(title);
    dialog.add_filter("Meshes", &EXTENSIONS.map(|(extension, _)| extension)).add_filter("All files", &["*"])
}

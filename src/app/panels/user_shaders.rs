//! The rows for functions of the user's own in place of LOD, and in place of the surface.

use crate::app::App;
use crate::app::jobs::user_shader_job::UserShaderSlot;
use crate::app::widgets::{button_row, file_row, text_row};
use crate::commands::{CLOSE_LOD_SHADER, CLOSE_SURFACE_SHADER};
use gpu::{LodShader, SurfaceShader};

impl App {
    /// The rows of the LOD shader, if it is open. Returns whether it takes the place of LOD, so that nothing of that can be set.
    pub(super) fn lod_shader_rows(&mut self, ui: &mut egui::Ui) -> bool {
        let hover = "Functions of this file compute factors in place of LOD.";
        let close = ["Close the shader", CLOSE_LOD_SHADER];
        self.shader_rows::<LodShader>(ui, ["LOD shader", hover], close, "The LOD is still used.");
        self.uses_lod_shader()
    }

    /// The rows of the surface shader, if it is open. Returns whether it takes the place of the surface.
    pub(super) fn surface_shader_rows(&mut self, ui: &mut egui::Ui) -> bool {
        let hover = "A function of this file computes the control points of edges in place of a surface. Left of a split, \
                     it doesn't.";
        let close = ["Close the surface", CLOSE_SURFACE_SHADER];
        self.shader_rows::<SurfaceShader>(ui, ["Shader", hover], close, "The surface stays.");
        if let Some(said) = self.straight_sides_said() {
            text_row(ui, said, ui.visuals().warn_fg_color);
        }
        self.uses_surface_shader()
    }

    /// The file and the button that closes it, each with its hover text. `stays` is said while no version of it can be used.
    fn shader_rows<S: UserShaderSlot>(&mut self, ui: &mut egui::Ui, file: [&str; 2], close: [&str; 2], stays: &str) {
        let Some(open) = S::open_in(self) else { return };
        file_row(ui, file[0], file[1], &open.path);
        if let Some(error) = &open.error {
            let stays = if open.is_used() { "The version before it stays." } else { stays };
            text_row(ui, format!("{error}\n{stays}"), ui.visuals().error_fg_color);
        }
        if button_row(ui, close[0], close[1]) {
            self.forget_shader::<S>();
        }
    }
}

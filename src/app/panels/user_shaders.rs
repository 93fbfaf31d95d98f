//! The rows for functions of the user's own in place of LOD, and in place of the surface.

use crate::app::App;
use crate::app::jobs::user_shader_job::UserShaderSlot;
use crate::app::widgets::{button_row, file_row, text_row};
use crate::commands::{CLOSE_LOD_SHADER, CLOSE_SURFACE_SHADER};
use gpu::{LodShader, SurfaceShader};

/// What the rows of a file say.
struct Texts {
    label: &'static str,
    hover: &'static str,
    /// What is shown while no version of the file can be used.
    stays: &'static str,
    close: &'static str,
    close_hover: &'static str,
}

const OF_LOD: Texts = Texts {
    label: "LOD shader",
    hover: "Functions of this file compute factors in place of LOD.",
    stays: "The LOD is still used.",
    close: "Close the shader",
    close_hover: CLOSE_LOD_SHADER,
};

const OF_SURFACE: Texts = Texts {
    label: "Shader",
    hover: "A function of this file computes the control points of edges in place of a surface. Left of a split, it doesn't.",
    stays: "The surface stays.",
    close: "Close the surface",
    close_hover: CLOSE_SURFACE_SHADER,
};

impl App {
    /// The rows of the LOD shader, if it is open. Returns whether it takes the place of LOD, so that nothing of that can be set.
    pub(super) fn lod_shader_rows(&mut self, ui: &mut egui::Ui) -> bool {
        self.shader_rows::<LodShader>(ui, &OF_LOD);
        self.uses_lod_shader()
    }

    /// The rows of the surface shader, if it is open. Returns whether it takes the place of the surface.
    pub(super) fn surface_shader_rows(&mut self, ui: &mut egui::Ui) -> bool {
        self.shader_rows::<SurfaceShader>(ui, &OF_SURFACE);
        if let Some(said) = self.straight_sides_said() {
            text_row(ui, said, ui.visuals().warn_fg_color);
        }
        self.uses_surface_shader()
    }

    fn shader_rows<S: UserShaderSlot>(&mut self, ui: &mut egui::Ui, texts: &Texts) {
        let Some(open) = S::open_in(self) else { return };
        file_row(ui, texts.label, texts.hover, &open.path);
        if let Some(error) = &open.error {
            let stays = if open.is_used() { "The version before it stays." } else { texts.stays };
            text_row(ui, format!("{error}\n{stays}"), ui.visuals().error_fg_color);
        }
        if button_row(ui, texts.close, texts.close_hover) {
            self.forget_shader::<S>();
        }
    }
}

//! The panels beside the picture, which keeps at least half of the window's width. A wide window has the settings on the left and the
//! measurements on the right. In a narrower one they share the left side, and tabs say which of them is shown.

use egui::RichText;

use crate::app::App;
use crate::app::painting::panel_frame;
use crate::app::widgets::legible;

/// The widths of the panel of settings and of that of measurements, and the least that both can share, in points.
const SETTINGS_WIDTH: f32 = 280.0;
const FACTS_WIDTH: f32 = 304.0;
const LEAST_SHARED: f32 = 240.0;

/// Which panel is shown where both share a side.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::app) enum Side {
    #[default]
    Settings,
    Measurements,
}

impl Side {
    /// Both with their names and hover texts.
    const ALL: [(Self, &str, &str); 2] = [
        (Self::Settings, "Settings", "Shows the settings of this picture."),
        (Self::Measurements, "Measurements", "Shows what was measured, and what is known of the selected patch."),
    ];
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Arrangement {
    Hidden,
    /// Both share the left side, which is so wide, in points.
    Shared(f32),
    Beside,
}

/// Where the panels are in a window of this width, in points.
fn arrangement(width: f32) -> Arrangement {
    let half = 0.5 * width;
    match half {
        _ if half >= SETTINGS_WIDTH + FACTS_WIDTH => Arrangement::Beside,
        _ if half >= LEAST_SHARED => Arrangement::Shared(half.min(FACTS_WIDTH)),
        _ => Arrangement::Hidden,
    }
}

impl App {
    /// Shows the panels that there is room for. Returns whether measurements are among them, and with these the legend.
    pub(in crate::app) fn side_panels(&mut self, ui: &mut egui::Ui) -> bool {
        let frame = panel_frame(ui);
        let panel = |panel: egui::Panel, width| panel.resizable(false).exact_size(width).frame(frame);
        match arrangement(ui.available_width()) {
            _ if self.panels.are_hidden => false,
            Arrangement::Hidden => false,
            Arrangement::Shared(width) => {
                panel(egui::Panel::left("shared"), width).show(ui, |ui| self.shared_panel(ui));
                self.panels.side == Side::Measurements
            }
            Arrangement::Beside => {
                panel(egui::Panel::left("settings"), SETTINGS_WIDTH).show(ui, |ui| self.settings_panel(ui));
                panel(egui::Panel::right("facts"), FACTS_WIDTH).show(ui, |ui| self.facts_panel(ui));
                true
            }
        }
    }

    /// The tabs, and the panel that is chosen.
    fn shared_panel(&mut self, ui: &mut egui::Ui) {
        let worst = self.worst(ui);
        ui.horizontal(|ui| {
            let gap = ui.spacing().item_spacing.x;
            let size = egui::vec2(0.5 * (ui.available_width() - gap), ui.spacing().interact_size.y + 4.0);
            for (side, name, hover) in Side::ALL {
                let is_shown = self.panels.side == side;
                // The tab of measurements has the colour of the worst that is wrong.
                let color = worst.filter(|_| side == Side::Measurements && !is_shown).map(|color| legible(ui, color));
                let text = color.map_or_else(|| RichText::new(name), |color| RichText::new(name).color(color));
                let response = ui.add_sized(size, egui::Button::selectable(is_shown, text).frame_when_inactive(true));
                response.widget_info(|| egui::WidgetInfo::selected(egui::Role::Tab, true, is_shown, name));
                if response.on_hover_text(hover).clicked() {
                    self.panels.side = side;
                }
            }
        });
        match self.panels.side {
            Side::Settings => drop(ui.push_id("settings", |ui| self.settings_panel(ui))),
            Side::Measurements => self.facts_panel(ui),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_picture_keeps_half_of_any_window() {
        for width in (100..3000).map(|width| width as f32) {
            let taken = match arrangement(width) {
                Arrangement::Hidden => 0.0,
                Arrangement::Shared(width) => width,
                Arrangement::Beside => SETTINGS_WIDTH + FACTS_WIDTH,
            };
            assert!(taken <= 0.5 * width, "{width}: {taken}");
        }
        assert_eq!(
            [1280.0, 853.0, 512.0, 400.0].map(arrangement),
            [Arrangement::Beside, Arrangement::Shared(FACTS_WIDTH), Arrangement::Shared(256.0), Arrangement::Hidden]
        );
    }
}

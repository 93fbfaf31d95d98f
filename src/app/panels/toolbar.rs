//! The toolbar over the picture: what people use every day, one click away.

use egui::containers::menu::{MenuButton, MenuConfig};

use super::settings_panel::{colors_hover, overlay_hover, overlay_of};
use crate::app::App;
use crate::app::widgets::{switch_button, text_width};
use crate::commands::{Action, Availability, CameraAction, Change, Command, FileAction, all, with_key};
use inspect::settings::{Choice, Colors, Control, Overlay};

/// The width of the list of colours, in points: that of its longest entry.
const COLORS_WIDTH: f32 = 124.0;

/// The overlays that have a button of their own; the list has the others.
const ON_TOOLBAR: [Overlay; 2] = [Overlay::Wireframe, Overlay::Cracks];

/// How much room a line between buttons takes, in points.
const DIVIDER_WIDTH: f32 = 6.0;

/// The button that writes the picture into a file.
const SAVE: &str = "Save picture";

impl App {
    pub(in crate::app) fn toolbar(&mut self, ui: &mut egui::Ui) {
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            let now = self.availability();
            let commands = all(&now);
            self.command_button(ui, &commands, &now, &Action::SplitView, ["Split", "Split view"]);
            let why_not = |overlay| {
                let action = Action::Setting(Change::Overlay(overlay));
                commands.iter().find(|command| command.action == action)?.why_not(&now)
            };
            for overlay in ON_TOOLBAR {
                let action = Action::Setting(Change::Overlay(overlay));
                self.command_button(ui, &commands, &now, &action, [overlay.label(); 2]);
            }
            self.of_half(|app, _| {
                app.overlays_list(ui, why_not);
                app.colors_list(ui, why_not);
            });
            divider(ui, "Frame");
            self.command_button(ui, &commands, &now, &Action::Camera(CameraAction::Frame), ["Frame", "Frame all"]);
            let names = ["Freeze LOD", "Freeze LOD camera"];
            self.command_button(ui, &commands, &now, &Action::FreezeLodCamera, names);
            if !now.clips.is_empty() {
                let label = if self.is_playing() { "Pause" } else { "Play" };
                self.command_button(ui, &commands, &now, &Action::PlayOrPause, [label, "Play or pause"]);
            }
            divider(ui, SAVE);
            self.command_button(ui, &commands, &now, &Action::File(FileAction::SavePicture), [SAVE; 2]);
        });
    }

    /// The overlays that have no button of their own. The list stays open while they are switched. `why_not` says in a sentence
    /// why one can't be shown.
    fn overlays_list(&mut self, ui: &mut egui::Ui, why_not: impl Fn(Overlay) -> Option<&'static str>) {
        let others = || Overlay::ALL.into_iter().filter(|overlay| !ON_TOOLBAR.contains(overlay));
        let overlays = &mut self.settings.overlays;
        let is_any_on = others().any(|overlay| matches!(overlays.control(overlay), Control::Switch(true)));
        let button = MenuButton::from_button(switch_button(is_any_on, "Overlays"));
        let config = MenuConfig::new().close_behavior(egui::PopupCloseBehavior::CloseOnClickOutside);
        let (response, _) = button.config(config).ui(ui, |ui| {
            for overlay in others() {
                if let Control::Switch(switch) = overlays.control(overlay) {
                    let why_not = why_not(overlay);
                    let check = egui::Checkbox::new(switch, overlay.label());
                    let check = ui.add_enabled(why_not.is_none(), check).on_hover_text(overlay_hover(overlay));
                    check.on_disabled_hover_text(why_not.unwrap_or_default());
                }
            }
        });
        response.on_hover_text("What else is drawn over the surface (--overlay).");
    }

    fn colors_list(&mut self, ui: &mut egui::Ui, why_not: impl Fn(Overlay) -> Option<&'static str>) {
        let colors = &mut self.settings.overlays.colors;
        let combo = egui::ComboBox::from_id_salt("Colours").selected_text(colors.label()).width(COLORS_WIDTH);
        // High enough for all entries.
        let combo = combo.height(420.0).show_ui(ui, |ui| {
            for &choice in Colors::ALL {
                let why_not = overlay_of(choice).and_then(&why_not);
                let entry = egui::Button::selectable(*colors == choice, choice.label());
                let entry = ui.add_enabled(why_not.is_none(), entry).on_hover_text(colors_hover(choice));
                if entry.on_disabled_hover_text(why_not.unwrap_or_default()).clicked() {
                    *colors = choice;
                }
            }
        });
        let response = combo.response.on_hover_text("What the surface's colours mean (--overlay).");
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Colours"));
    }

    /// A button that gives a command, with its text and key as hover text, and with a name for screen readers that may say more than its
    /// label. It stays pressed while what it switches is on, and is greyed out where the command isn't possible.
    pub(in crate::app) fn command_button(
        &mut self,
        ui: &mut egui::Ui,
        commands: &[Command],
        now: &Availability,
        action: &Action,
        [label, name]: [&str; 2],
    ) {
        let Some(command) = commands.iter().find(|command| command.action == *action) else { return };
        let (why_not, is_on) = (command.why_not(now), self.is_on(ui.ctx(), action));
        let is_possible = why_not.is_none();
        let button = is_on.map_or_else(|| egui::Button::new(label), |is_on| switch_button(is_on, label));
        let button = ui.add_enabled(is_possible, button);
        button.widget_info(|| match is_on {
            Some(is_on) => egui::WidgetInfo::selected(egui::Role::CheckBox, is_possible, is_on, name),
            None => egui::WidgetInfo::labeled(egui::Role::Button, is_possible, name),
        });
        let button = button.on_hover_text(with_key(&command.text, action));
        if button.on_disabled_hover_text(why_not.unwrap_or_default()).clicked() {
            self.give(ui.ctx(), command);
        }
    }
}

/// A line before a button, unless the button begins the next row.
fn divider(ui: &mut egui::Ui, button: &str) {
    let spacing = ui.spacing();
    let beside = 2.0 * spacing.button_padding.x + 2.0 * spacing.item_spacing.x + DIVIDER_WIDTH;
    if text_width(ui, button) + beside <= ui.available_size_before_wrap().x {
        ui.add(egui::Separator::default().spacing(DIVIDER_WIDTH));
    }
}

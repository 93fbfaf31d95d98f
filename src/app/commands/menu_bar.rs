//! The menu bar, made from the table of commands.

use std::ffi::OsStr;
use std::path::Path;

use crate::app::App;
use crate::app::jobs::folder_job::Neighbours;
use crate::app::text::shortened;
use crate::commands::{
    Action, Availability, CameraAction, Change, Command, FileAction, Menu, Place, Submenu, all, shown_key,
};
use load::Source;

impl App {
    pub(in crate::app) fn menu_bar(&mut self, ui: &mut egui::Ui) {
        egui::MenuBar::new().ui(ui, |ui| {
            for menu in Menu::ALL {
                let shown = ui.menu_button(menu.name(), |ui| scrolled(ui, |ui| self.menu(ui, menu)));
                self.keep_open(menu, &shown);
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| self.title(ui));
        });
    }

    /// The mesh's name, where it is among its neighbours, and buttons that open these.
    fn title(&mut self, ui: &mut egui::Ui) {
        ui.weak(concat!("pnaen ", env!("CARGO_PKG_VERSION")));
        ui.separator();
        let Some(document) = &self.document else { return };
        let (title, whole) = (document.loaded.source.title(), document.loaded.source.to_string());
        let has_changed = document.has_changed;
        if let Some([number, count]) = document.neighbours.as_ref().map(Neighbours::numbers) {
            let now = self.availability();
            let commands = all(&now);
            for (action, label, name) in
                [(FileAction::NextMesh, ">", "Next mesh"), (FileAction::PreviousMesh, "<", "Previous mesh")]
            {
                self.command_button(ui, &commands, &now, &action.into(), [label, name]);
            }
            ui.label(format!("{number}/{count}"));
        }
        ui.add(egui::Label::new(egui::RichText::new(title).strong()).truncate()).on_hover_text(whole);
        if has_changed {
            let hover =
                "The file has changed on disk, and was loaded again. Click to compare it with what it was before.";
            if ui.link("changed on disk, loaded anew").on_hover_text(hover).clicked() {
                self.compare_with_before();
            }
        }
    }

    /// Keeps a menu open that is clicked after it opened because the pointer came over its name from another open menu. egui closes
    /// it again. The second click on a name closes its menu.
    fn keep_open(&mut self, menu: Menu, shown: &egui::InnerResponse<Option<()>>) {
        if !shown.response.clicked() {
            return;
        }
        let is_second = self.commands.clicked_menu == Some(menu);
        if shown.inner.is_none() && !is_second && self.commands.clicked_menu.is_some() {
            egui::Popup::open_id(&shown.response.ctx, egui::Popup::default_response_id(&shown.response));
            shown.response.ctx.request_repaint();
        }
        self.commands.clicked_menu = (!(is_second && shown.inner.is_none())).then_some(menu);
    }

    /// The commands of a menu, with a line between groups. Submenus come at the ends of their groups.
    fn menu(&mut self, ui: &mut egui::Ui, menu: Menu) {
        let now = self.availability();
        let commands = all(&now);
        let group_of = |command: &Command| match command.place {
            Some(Place::Menu(of, group)) if of == menu => Some(group),
            _ => None,
        };
        let last = commands.iter().filter_map(group_of).chain(menu.submenus().iter().map(|(group, _)| *group)).max();
        let mut chosen = None;
        for group in 0..=last.unwrap_or(0) {
            if group > 0 {
                ui.separator();
            }
            for command in commands.iter().filter(|command| group_of(command) == Some(group)) {
                if self.entry(ui, command, &now) {
                    chosen = Some(command);
                }
            }
            for (_, submenu) in menu.submenus().iter().filter(|(of, _)| *of == group) {
                chosen = self.submenu_entries(ui, *submenu, &commands, &now).or(chosen);
            }
        }
        if let Some(command) = chosen {
            ui.close();
            self.give(ui.ctx(), command);
        }
    }

    /// Shows a command in a menu. Returns true if it is chosen.
    fn entry(&self, ui: &mut egui::Ui, command: &Command, now: &Availability) -> bool {
        let (why_not, name) = (command.why_not(now), command.value_name());
        let key = command.keys.first().map(|key| shown_key(ui.ctx(), key)).unwrap_or_default();
        let show = |ui: &mut egui::Ui| match (&command.action, self.is_on(ui.ctx(), &command.action)) {
            (Action::File(FileAction::OpenSource(Source::File(path))), _) => ui.add(recent_button(path)),
            (Action::Theme(_), Some(is_on)) => ui.radio(is_on, name),
            (_, Some(mut is_on)) => with_key_beside(ui, &key, |ui| ui.checkbox(&mut is_on, name)),
            (_, None) if key.is_empty() => ui.button(name),
            (_, None) => ui.add(egui::Button::new(name).shortcut_text(&key)),
        };
        let response = ui.add_enabled_ui(why_not.is_none(), show).inner.on_hover_text(&*command.text);
        response.on_disabled_hover_text(why_not.unwrap_or_default()).clicked()
    }

    fn submenu_entries<'a>(
        &self,
        ui: &mut egui::Ui,
        submenu: Submenu,
        commands: &'a [Command],
        now: &Availability,
    ) -> Option<&'a Command> {
        let of_submenu = |command: &&Command| command.place == Some(Place::Submenu(submenu));
        let entries: Vec<_> = commands.iter().filter(of_submenu).collect();
        let list = |ui: &mut egui::Ui| entries.iter().copied().filter(|command| self.entry(ui, command, now)).last();
        let show = |ui: &mut egui::Ui| ui.menu_button(submenu.name(), list).inner;
        ui.add_enabled_ui(!entries.is_empty(), show).inner.flatten()
    }

    /// Whether a command that switches something is on; none for commands that no menu and no toolbar shows as a switch.
    pub(in crate::app) fn is_on(&self, context: &egui::Context, action: &Action) -> Option<bool> {
        match action {
            Action::Camera(CameraAction::Orthographic) => Some(self.viewport.camera.orthographic),
            Action::Chart => Some(self.panels.chart.is_open),
            Action::HidePanels => Some(self.panels.are_hidden),
            Action::SplitView => Some(self.settings.split.is_some()),
            Action::FreezeLodCamera => Some(self.viewport.frozen.is_some()),
            Action::Setting(Change::Overlay(overlay)) => {
                let edited = self.settings.half(self.panels.edited).unwrap_or(self.settings);
                Some(edited.overlays.on().any(|on| on == *overlay))
            }
            Action::Ruler => Some(self.viewport.ruler.is_some()),
            Action::Previews => Some(self.viewport.preview.is_on),
            Action::Theme(theme) => Some(context.options(|options| options.theme_preference) == *theme),
            _ => None,
        }
    }
}

/// Shows a control of a menu, and its key at the menu's right border, where buttons have theirs.
fn with_key_beside(ui: &mut egui::Ui, key: &str, show: impl FnOnce(&mut egui::Ui) -> egui::Response) -> egui::Response {
    let is_sizing = ui.is_sizing_pass();
    ui.horizontal(|ui| {
        let response = show(ui);
        if is_sizing {
            // The menu gets as wide as its entries ask for.
            ui.add_space(2.0 * ui.spacing().item_spacing.x);
            ui.weak(key);
        } else {
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| ui.weak(key));
        }
        response
    })
    .inner
}

/// Points that a menu leaves free above and below it.
const MARGIN: f32 = 60.0;

/// Shows a menu's entries, in a list that scrolls where the window is too low for all of them.
fn scrolled(ui: &mut egui::Ui, entries: impl FnOnce(&mut egui::Ui)) {
    let most = (ui.ctx().content_rect().height() - MARGIN).max(100.0);
    egui::ScrollArea::vertical().min_scrolled_height(most).max_height(most).show(ui, entries);
}

/// A button with a file's name and its folder.
fn recent_button(path: &Path) -> egui::Button<'static> {
    const NAME: usize = 48;
    const FOLDER: usize = 32;
    let text = |name: Option<&OsStr>, most| shortened(&name.unwrap_or_default().to_string_lossy(), most);
    egui::Button::new(text(path.file_name(), NAME)).shortcut_text(text(path.parent().and_then(Path::file_name), FOLDER))
}

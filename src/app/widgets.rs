//! Widgets that the panels share.

use std::path::Path;

use egui::RichText;
use egui::scroll_area::ScrollSource;

use super::text::file_name;
use super::wheel;

/// The width of the settings' labels in points: as much as the longest, "Segment length", takes.
pub(super) const LABEL_WIDTH: f32 = 94.0;

/// Small monospaced text, so that a position's three coordinates fit on one line.
pub(super) fn dense(text: impl Into<String>) -> RichText {
    RichText::new(text).monospace().size(12.0)
}

/// The name of a small table.
pub(super) fn title(ui: &mut egui::Ui, text: &str, hover: &str) {
    ui.add_space(6.0);
    ui.label(text).on_hover_text(hover);
}

/// A row with a name and a list to choose from. Returns what is chosen in place of a value.
pub(super) fn chooser<T: Copy + PartialEq>(
    ui: &mut egui::Ui,
    name: &str,
    hover: &str,
    value: T,
    choices: &[(T, &str, &str)],
) -> Option<T> {
    let shown = choices.iter().find(|(choice, ..)| *choice == value).map_or("", |(_, text, _)| text);
    let mut chosen = value;
    list_row(ui, name, hover, shown, |ui| {
        for (choice, text, hover) in choices {
            ui.selectable_value(&mut chosen, *choice, *text).on_hover_text(*hover);
        }
    });
    (chosen != value).then_some(chosen)
}

/// A row with a name and a list, of which `shown` is chosen.
pub(super) fn list_row(ui: &mut egui::Ui, name: &str, hover: &str, shown: &str, entries: impl FnOnce(&mut egui::Ui)) {
    let label = ui.label(name).on_hover_text(hover);
    // High enough for the longest list, where the window is.
    let height = (0.6 * ui.ctx().content_rect().height()).clamp(260.0, 480.0);
    let combo = egui::ComboBox::from_id_salt(name).selected_text(shown).truncate().height(height);
    combo.show_ui(ui, entries).response.labelled_by(label.id).on_hover_text(hover);
    ui.end_row();
}

/// A row that names a file which is open.
pub(super) fn file_row(ui: &mut egui::Ui, name: &str, hover: &str, path: &Path) {
    ui.label(name).on_hover_text(hover);
    ui.add(egui::Label::new(file_name(path)).truncate()).on_hover_text(path.display().to_string());
    ui.end_row();
}

/// A row with a name and a control.
pub(super) fn control_row(ui: &mut egui::Ui, name: &str, hover: &str, control: impl egui::Widget) -> egui::Response {
    let label = ui.label(name).on_hover_text(hover);
    let response = ui.add(control).labelled_by(label.id).on_hover_text(hover);
    ui.end_row();
    response
}

/// A row with a button. Returns whether it was clicked.
pub(super) fn button_row(ui: &mut egui::Ui, name: &str, hover: &str) -> bool {
    ui.label("");
    let is_clicked = ui.button(name).on_hover_text(hover).clicked();
    ui.end_row();
    is_clicked
}

/// A row with a text that may take several lines.
pub(super) fn text_row(ui: &mut egui::Ui, text: String, color: egui::Color32) {
    ui.label("");
    ui.add(egui::Label::new(RichText::new(text).color(color)).wrap());
    ui.end_row();
}

/// The same row, disabled; `why` is its hover text.
pub(super) fn fixed(ui: &mut egui::Ui, name: &str, shown: &str, why: &str) {
    let label = ui.label(name).on_hover_text(why);
    let combo = egui::ComboBox::from_id_salt(name).selected_text(shown);
    let response = ui.add_enabled_ui(false, |ui| combo.show_ui(ui, |_| {}).response).inner;
    response.labelled_by(label.id).on_disabled_hover_text(why);
    ui.end_row();
}

/// A row with a name and a right-aligned number.
pub(super) fn fact(ui: &mut egui::Ui, name: &str, value: &str, hover: &str) {
    ui.label(name).on_hover_text(hover);
    number(ui, value);
    ui.end_row();
}

/// A right-aligned number, monospaced.
pub(super) fn number(ui: &mut egui::Ui, text: &str) {
    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| ui.label(RichText::new(text).monospace()));
}

/// A row of text in columns that can't be clicked, aligned with rows that can. Headers are weak.
pub(super) fn columns(ui: &mut egui::Ui, text: &str, is_weak: bool) -> egui::Response {
    let text = RichText::new(text).monospace();
    unclicked(ui, if is_weak { text.weak() } else { text })
}

/// A row of text that can't be clicked, aligned with rows that can.
pub(super) fn unclicked(ui: &mut egui::Ui, text: RichText) -> egui::Response {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 0.0;
        ui.add_space(ui.spacing().button_padding.x);
        ui.label(text)
    })
    .inner
}

/// How many rows a list shows at once.
const LIST_ROWS: f32 = 6.0;

/// A list of many rows. Only the visible ones are made. The keys Up, Down, Home and End go from row to row. If there are other rows
/// than in the last frame, which two numbers of `rows` tell, the list shows the first of them again.
pub(super) fn list(
    ui: &mut egui::Ui,
    name: &str,
    count: usize,
    rows: (usize, u32),
    mut row: impl FnMut(&mut egui::Ui, usize) -> egui::Response,
) {
    let height = ui.text_style_height(&egui::TextStyle::Monospace).max(ui.spacing().interact_size.y);
    let pitch = height + ui.spacing().item_spacing.y;
    let shown = LIST_ROWS.min(count as f32) * pitch;
    let id = ui.scope_id().with(name);
    let mouse_wheel = wheel::scrolls(ui, id, ui.data(|data| data.get_temp(id.with("place"))));
    let source = ScrollSource { mouse_wheel, ..ScrollSource::default() };
    let area = egui::ScrollArea::vertical().id_salt(name).max_height(shown).auto_shrink([false, true]);
    let area = area.scroll_source(source);
    // The row that the last frame's key asked for, and how far the list was scrolled then.
    let asked: Option<(usize, f32)> = ui.data_mut(|data| data.remove_temp(id));
    let before: Option<(usize, u32)> = ui.data(|data| data.get_temp(id.with("rows")));
    ui.data_mut(|data| data.insert_temp(id.with("rows"), rows));
    let area = match asked {
        _ if before.is_some_and(|before| before != rows) => area.vertical_scroll_offset(0.0),
        Some((index, offset)) => {
            let top = index as f32 * pitch;
            area.vertical_scroll_offset(offset.clamp((top + pitch - shown).max(0.0), top))
        }
        None => area,
    };
    let (mut focused, mut reached) = (None, None);
    let output = area.show_rows(ui, height, count, |ui, range| {
        ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Truncate);
        for index in range {
            let response = row(ui, index);
            if asked.is_some_and(|(asked, _)| asked == index) {
                response.request_focus();
            }
            if response.gained_focus() {
                reached = Some(response.rect);
            }
            if response.has_focus() {
                focused = Some(index);
                let filter = egui::EventFilter { vertical_arrows: true, ..Default::default() };
                ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
            }
        }
    });
    ui.data_mut(|data| data.insert_temp(id.with("place"), output.inner_rect));
    if let Some(row) = reached {
        // The list scrolls to a row by itself, but the panel around it doesn't.
        ui.scroll_to_rect(row, None);
    }
    if let Some(next) = focused.and_then(|index| next_row(ui, index, count)) {
        ui.data_mut(|data| data.insert_temp(id, (next, output.state.clamped_offset().y)));
        ui.ctx().request_repaint();
    }
}

/// A row of what was found: its columns, whether it is selected, and its hover text.
pub(super) struct FoundRow {
    pub columns: String,
    pub is_selected: bool,
    pub hover: String,
}

/// A [`list`] of what was found. Returns what was clicked.
pub(super) fn found_list<'a, T>(
    ui: &mut egui::Ui,
    name: &str,
    found: &'a [T],
    first: u32,
    row: impl Fn(&T) -> FoundRow,
) -> Option<&'a T> {
    let mut clicked = None;
    list(ui, name, found.len(), (found.len(), first), |ui, index| {
        let FoundRow { columns, is_selected, hover } = row(&found[index]);
        let response = ui.selectable_label(is_selected, RichText::new(columns).monospace()).on_hover_text(hover);
        if response.clicked() {
            clicked = found.get(index);
        }
        response
    });
    clicked
}

/// The title of a list, after a swatch of its colour if it has one.
pub(super) fn list_title(ui: &mut egui::Ui, color: Option<[u8; 3]>, text: &str, hover: &str) {
    ui.add_space(4.0);
    marked(ui, color, text, hover);
}

/// A text after a swatch of its colour, if it has one.
pub(super) fn marked(ui: &mut egui::Ui, color: Option<[u8; 3]>, text: &str, hover: &str) {
    ui.horizontal(|ui| {
        color.into_iter().for_each(|color| swatch(ui, color));
        ui.label(text).on_hover_text(hover);
    });
}

/// The row that a pressed key goes to from row `index` of `count`.
fn next_row(ui: &egui::Ui, index: usize, count: usize) -> Option<usize> {
    let pressed = |key| ui.input(|input| input.key_pressed(key));
    let last = count.checked_sub(1)?;
    let next = [
        (egui::Key::ArrowDown, (index + 1).min(last)),
        (egui::Key::ArrowUp, index.saturating_sub(1)),
        (egui::Key::Home, 0),
        (egui::Key::End, last),
    ];
    next.into_iter().find(|(key, _)| pressed(*key)).map(|(_, next)| next)
}

/// Width and height of a swatch, in points.
pub(super) const SWATCH: egui::Vec2 = egui::vec2(14.0, 10.0);

/// A button that stays pressed while something is on. It has a frame also while that is off: without one it would look like a
/// mere word beside other buttons.
pub(super) fn switch_button(is_on: bool, label: &str) -> egui::Button<'_> {
    egui::Button::selectable(is_on, label).frame_when_inactive(true)
}

/// The width of a text in the usual font, in points.
pub(super) fn text_width(ui: &egui::Ui, text: &str) -> f32 {
    let font = egui::TextStyle::Body.resolve(ui.style());
    ui.painter().layout_no_wrap(text.to_owned(), font, egui::Color32::PLACEHOLDER).size().x
}

pub(super) fn rgb([r, g, b]: [u8; 3]) -> egui::Color32 {
    egui::Color32::from_rgb(r, g, b)
}

/// A colour of the picture as that of a text: darker in a light theme, on whose panels it would be too pale.
pub(super) fn legible(ui: &egui::Ui, color: egui::Color32) -> egui::Color32 {
    if ui.visuals().dark_mode { color } else { color.lerp_to_gamma(egui::Color32::BLACK, 0.3) }
}

pub(super) fn swatch(ui: &mut egui::Ui, color: [u8; 3]) {
    let (rect, _) = ui.allocate_exact_size(SWATCH, egui::Sense::hover());
    // Its outline shows where its colour is that of the background.
    let outline = ui.visuals().widgets.noninteractive.bg_stroke;
    ui.painter().rect(rect, 2.0, rgb(color), outline, egui::StrokeKind::Inside);
}

/// A field of the status line. Its width doesn't depend on its text: what is longer is cut off, and its hover text has all of it.
/// Where there is no room for the field, it is left out.
pub(super) fn status(ui: &mut egui::Ui, width: f32, text: impl Into<egui::WidgetText>, hover: &str) {
    if ui.available_width() < width {
        return;
    }
    let height = ui.spacing().interact_size.y;
    ui.allocate_ui_with_layout(egui::vec2(width, height), egui::Layout::left_to_right(egui::Align::Center), |ui| {
        ui.set_min_width(width);
        ui.add(egui::Label::new(text).truncate()).on_hover_text(hover);
    });
    ui.separator();
}

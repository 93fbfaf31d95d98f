//! Rows of the settings panel, made from the declarations of options.

use crate::app::text::typed_number;
use crate::app::widgets::{chooser, fixed, text_width};
use crate::commands::with_note;
use inspect::settings::{Declaration, Description, Kind, Range, Settings, Value};

/// What sliders of light reach, in EV. More can be typed, up to the option's own range, but over all of that a step of the slider
/// would be too coarse.
const SLID_EV: std::ops::RangeInclusive<f32> = -5.0..=5.0;

/// The entry for a number in the list of an option that need not have one.
const A_NUMBER: Description = Description::new("number", "A number", "The row below has it.");

/// The least width of a slider's track, in points.
const LEAST_TRACK: f32 = 20.0;

/// A row that changes an option, greyed out where the option has no effect. `key` names the key that changes it too.
pub(super) fn option_row(ui: &mut egui::Ui, option: &Declaration, settings: &mut Settings, key: &str) {
    option_row_with(ui, option, settings, &option_hover(option, key));
}

/// The same with another hover text.
pub(super) fn option_row_with(ui: &mut egui::Ui, option: &Declaration, settings: &mut Settings, hover: &str) {
    let value = option.get(settings);
    match (&option.kind, value) {
        (Kind::Number(range) | Kind::NameOrNumber { range, .. }, Value::Number(number)) => {
            if let Some(entry) = number_entry(option) {
                choice_row(ui, option, Some(entry.name), settings, hover);
            }
            let name = if let Kind::NameOrNumber { row, .. } = option.kind { row } else { option.label };
            // The list may have changed it.
            if option.get(settings) == Value::Number(number) {
                number_row(ui, option, name, range, number, settings, hover);
            }
        }
        (_, Value::Name(name)) => choice_row(ui, option, Some(name), settings, hover),
        (Kind::Choice(_) | Kind::Number(_) | Kind::NameOrNumber { .. }, Value::Unset) => {
            choice_row(ui, option, None, settings, hover);
        }
        // Options of other kinds are shown by code of their own.
        _ => {}
    }
}

/// A row that is there only where the option has an effect.
pub(super) fn shown_option_row(ui: &mut egui::Ui, option: &Declaration, settings: &mut Settings) {
    if (option.no_effect)(settings).is_none() {
        option_row(ui, option, settings, "");
    }
}

/// The hover text of an option: its text, its key and its name on the command line.
pub(super) fn option_hover(option: &Declaration, key: &str) -> String {
    let name = format!("--{}", option.name);
    with_note(option.text, &if key.is_empty() { name } else { format!("{key}; {name}") })
}

/// A row with a slider for the number of an option. The row's name is given with the option.
fn number_row(
    ui: &mut egui::Ui,
    option: &Declaration,
    name: &str,
    range: &Range,
    mut number: f32,
    settings: &mut Settings,
    hover: &str,
) {
    let unit = if range.unit.is_empty() { String::new() } else { format!(" {}", range.unit) };
    // Numbers with decimals are shown with as many as there is room for.
    let shown = format!("{number:.0}{unit}");
    let label = ui.label(name).on_hover_text(hover);
    let slid = if range.unit == "EV" { SLID_EV } else { range.least..=range.most };
    let slider = egui::Slider::new(&mut number, slid)
        .clamping(egui::SliderClamping::Never)
        .max_decimals(range.decimals)
        .logarithmic(range.is_logarithmic)
        .suffix(&unit)
        .custom_parser(|text| typed_number(text, range.unit))
        .update_while_editing(false);
    let idle = (option.no_effect)(settings);
    // A long number takes its room from the track, so that the row stays as wide as the others.
    let (track, usual) = (ui.spacing().slider_width, ui.spacing().interact_size.x);
    let beyond = (text_width(ui, &shown) + 2.0 * ui.spacing().button_padding.x - usual).max(0.0);
    ui.spacing_mut().slider_width = (track - beyond).max(LEAST_TRACK);
    let response = ui.add_enabled(idle.is_none(), slider).labelled_by(label.id).on_hover_text(hover);
    ui.spacing_mut().slider_width = track;
    if response.on_disabled_hover_text(idle.unwrap_or_default()).changed() {
        option.set(settings, Value::Number(number.clamp(range.least, range.most)));
    }
    ui.end_row();
}

/// The entry of an option's list for a number, if there is a list.
fn number_entry(option: &Declaration) -> Option<Description> {
    match &option.kind {
        Kind::NameOrNumber { number, .. } => Some(*number),
        Kind::Number(_) if option.unset.is_some() => Some(A_NUMBER),
        _ => None,
    }
}

fn choice_row(
    ui: &mut egui::Ui,
    option: &Declaration,
    name: Option<&'static str>,
    settings: &mut Settings,
    hover: &str,
) {
    let unset = option.unset.iter().map(|value| (None, value.label, value.text));
    let mut values = option.kind.descriptions();
    let number = number_entry(option);
    values.extend(number);
    let all: Vec<_> = unset.chain(values.iter().map(|value| (Some(value.name), value.label, value.text))).collect();
    if let Some(why) = (option.no_effect)(settings) {
        let shown = all.iter().find(|(value, ..)| *value == name).map_or("", |(_, label, _)| label);
        return fixed(ui, option.label, shown, why);
    }
    if let Some(name) = chooser(ui, option.label, hover, name, &all) {
        let is_number = |name: &str| number.is_some_and(|number| number.name == name);
        let value = match name {
            Some(name) if is_number(name) => Value::Number(1.0),
            name => name.map_or(Value::Unset, Value::Name),
        };
        option.set(settings, value);
    }
}

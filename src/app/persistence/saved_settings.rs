//! Settings as JSON, whose members and values have the names that options declare.

use serde_json::{Value as Json, json};

use inspect::settings::{Declaration, Kind, Settings, Value, options};

/// Returns all settings as a JSON object.
pub(super) fn written_settings(settings: &Settings) -> Json {
    let members = options::all().flat_map(|option| option.written(settings));
    members.map(|(name, value)| (name, json!(value))).collect()
}

/// Reads settings. Members that are missing or invalid get the values of a first start.
pub(super) fn read_settings(value: &Json) -> Settings {
    let mut settings = Settings::opening();
    for option in options::all() {
        if let Some(value) = read(option, value) {
            // A value out of range leaves settings unchanged.
            option.set(&mut settings, value);
        }
    }
    settings
}

fn read(option: &Declaration, all: &Json) -> Option<Value> {
    let number = |value: &Json| value.as_f64().map(|number| number as f32);
    let members: Vec<&Json> = option.members().iter().map(|name| &all[name]).collect();
    match (&option.kind, &members[..]) {
        (Kind::Choice(_), [name]) => option.kind.named(name.as_str()?).map(Value::Name),
        (Kind::Several(_), [names]) => {
            // Unknown names are skipped: a newer version may have written them.
            let names = names.as_array()?.iter().filter_map(Json::as_str);
            Some(Value::Names(names.filter_map(|name| option.kind.named(name)).collect()))
        }
        (Kind::Number(_), [value]) => number(value).map(Value::Number),
        (Kind::Pair(_), [a, b]) => Some(Value::Pair([number(a)?, number(b)?])),
        (Kind::Switch, [value]) => value.as_bool().map(Value::Switch),
        (Kind::Options(_), [text]) => option.kind.parse(text.as_str()?).ok(),
        (Kind::Color, [value]) => serde_json::from_value((*value).clone()).ok().map(Value::Color),
        _ => None,
    }
}

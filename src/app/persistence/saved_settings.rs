//! Settings as they are written down: by the names that commands have for their values.

use serde_json::{Value, json};

use super::saved_state::Fields;
use crate::settings::{
    ALPHA_RANGE, DISTANCE_RANGE, FACTOR_RANGE, HEIGHT_RANGE, MIDLEVEL_RANGE, Overlay, Overlays, PIXELS_RANGE, Settings,
    TOLERANCE_RANGE, option_name,
};

/// Every field but what displaces a mesh, which is bound to it.
pub fn written_settings(settings: &Settings) -> Value {
    // Without `..`: what is new must be written too, or left out for a reason.
    let Settings {
        surface,
        alpha,
        normals,
        edges,
        factor,
        partitioning,
        lod,
        pixels,
        tolerance,
        near,
        far,
        clip,
        cull_back_faces,
        convention,
        displacement: _,
        height_scale,
        midlevel,
        overlays,
        deviation_in,
        split,
        split_surface,
        background,
    } = settings;
    json!({
        "surface": option_name(*surface),
        "alpha": alpha,
        "normals": option_name(*normals),
        "edges": option_name(*edges),
        "factor": factor,
        "partitioning": partitioning.name(),
        "lod": option_name(*lod),
        "pixels": pixels,
        "tolerance": tolerance,
        "near": near,
        "far": far,
        "clip": option_name(*clip),
        "cull_back_faces": cull_back_faces,
        "convention": option_name(*convention),
        "height_scale": height_scale,
        "midlevel": midlevel,
        "overlays": overlays.on().map(option_name).collect::<Vec<_>>(),
        "deviation_in": option_name(*deviation_in),
        "split": split,
        "split_surface": split_surface.map(option_name),
        "background": background,
    })
}

/// What isn't there, or isn't in its range, is as the window opens with it.
pub fn read_settings(value: &Value) -> Settings {
    let opening = Settings::opening();
    let fields = Fields(value);
    let partitioning = value["partitioning"].as_str().and_then(|name| name.parse().ok());
    let distances = ["near", "far"].map(|name| fields.number_in(name, DISTANCE_RANGE));
    let (near, far) = match distances {
        [Some(near), Some(far)] if near < far => (near, far),
        _ => (opening.near, opening.far),
    };
    Settings {
        surface: fields.choice("surface", opening.surface),
        alpha: fields.number("alpha", ALPHA_RANGE, opening.alpha),
        normals: fields.choice("normals", opening.normals),
        edges: fields.choice("edges", opening.edges),
        factor: fields.number("factor", FACTOR_RANGE, opening.factor),
        partitioning: partitioning.unwrap_or(opening.partitioning),
        lod: fields.choice("lod", opening.lod),
        pixels: fields.number("pixels", PIXELS_RANGE, opening.pixels),
        tolerance: fields.number("tolerance", TOLERANCE_RANGE, opening.tolerance),
        near,
        far,
        clip: fields.choice("clip", opening.clip),
        cull_back_faces: fields.switch("cull_back_faces", opening.cull_back_faces),
        convention: fields.choice("convention", opening.convention),
        displacement: opening.displacement,
        height_scale: fields.number("height_scale", HEIGHT_RANGE, opening.height_scale),
        midlevel: fields.number("midlevel", MIDLEVEL_RANGE, opening.midlevel),
        overlays: read_overlays(&value["overlays"]).unwrap_or(opening.overlays),
        deviation_in: fields.choice("deviation_in", opening.deviation_in),
        split: fields.number_in("split", 0.0..=1.0),
        split_surface: fields.choice_of("split_surface"),
        background: read_color(&value["background"]).unwrap_or(opening.background),
    }
}

/// Those that are known; none if two of them colour the surface.
fn read_overlays(value: &Value) -> Option<Overlays> {
    let names = value.as_array()?.iter().filter_map(Value::as_str);
    let known: Vec<Overlay> = names.filter_map(|name| clap::ValueEnum::from_str(name, false).ok()).collect();
    Overlays::of(&known)
}

fn read_color(value: &Value) -> Option<[u8; 3]> {
    serde_json::from_value(value.clone()).ok()
}

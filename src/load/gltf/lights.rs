//! The lights of a document: the extension KHR_lights_punctual. Their faults don't keep the model from loading.
//!
//! Source: Khronos, KHR_lights_punctual.

use std::cell::RefCell;
use std::f32::consts::{FRAC_PI_2, FRAC_PI_4};

use glam::Vec3;
use serde_json::{Map, Value};

use super::json::objects;
use super::lenient::Members;
use super::nodes::Placed;
use super::notes::Notes;
use geometry::mesh::{Light, LightKind, MOST_LIGHTS};

const EXTENSION: &str = "KHR_lights_punctual";

/// From 0 to the largest intensity that is read: it is finite, also times a colour.
const POSITIVE: [f32; 2] = [0.0, 1e18];
/// Ranges must be greater than 0.
const RANGE: [f32; 2] = [1e-18, 1e18];

/// The lights of a document, and the nodes that have one.
#[derive(Debug, Default)]
pub(super) struct LightSources {
    /// At the origin, shining along -Z; none for one that can't be read.
    lights: Vec<Option<Light>>,
    /// Nodes and the indices of their lights.
    of_nodes: Vec<[usize; 2]>,
}

impl LightSources {
    /// Takes the lights out of a document before it is checked.
    pub(super) fn take(root: &mut Map<String, Value>, notes: &mut Notes) -> Self {
        let pointer = format!("/extensions/{EXTENSION}");
        let Some(extension) = taken(root) else { return Self::default() };
        let collected = RefCell::new(std::mem::take(notes));
        let lights = match extension.get("lights") {
            Some(Value::Array(lights)) => {
                let light =
                    |(i, light)| light_source(&Members::of(light, format!("{pointer}/lights/{i}"), &collected)?);
                lights.iter().enumerate().map(light).collect()
            }
            _ => {
                collected.borrow_mut().push(format!("{pointer}/lights isn't a list; there are no lights."));
                Vec::new()
            }
        };
        let mut own = Self { lights, of_nodes: Vec::new() };
        for (node, object) in objects(root, "nodes").enumerate() {
            let Some(extension) = taken(object) else { continue };
            let pointer = format!("/nodes/{node}/extensions/{EXTENSION}");
            let Some(members) = Members::of(&extension, pointer, &collected) else { continue };
            let list = format!("extensions/{EXTENSION}/lights");
            own.of_nodes.extend(members.index("light", &list, own.lights.len()).map(|light| [node, light]));
        }
        *notes = collected.into_inner();
        own
    }

    /// The memory that they take, in bytes.
    pub(super) fn bytes(&self) -> u64 {
        (size_of_val(&self.lights[..]) + size_of_val(&self.of_nodes[..])) as u64
    }

    /// The nodes that have a light.
    pub(super) fn nodes(&self) -> impl Iterator<Item = usize> {
        self.of_nodes.iter().map(|[node, _]| *node)
    }

    /// The lights of the nodes that the scene shows, where they are at rest, each with its node: at most [`MOST_LIGHTS`].
    pub(super) fn shown(&self, placed: &Placed, notes: &mut Notes) -> Vec<(usize, Light)> {
        let is_shown = if self.of_nodes.is_empty() { Vec::new() } else { placed.is_shown() };
        let shown = self.of_nodes.iter().filter(|[node, _]| is_shown.get(*node) == Some(&true));
        let all: Vec<_> = shown.filter_map(|&[node, light]| Some((node, self.lights[light]?))).collect();
        if all.len() > MOST_LIGHTS {
            notes.push(format!("The scene has {} lights, of which only the first {MOST_LIGHTS} shine.", all.len()));
        }
        let mut lights = Vec::new();
        for (node, light) in all.into_iter().take(MOST_LIGHTS) {
            match placed.global.get(node).and_then(|global| light.at(global)) {
                Some(light) => lights.push((node, light)),
                None => notes.push(format!("/nodes/{node} has a light at no finite place; it is left out.")),
            }
        }
        lights
    }
}

/// Removes the extension from an object.
fn taken(object: &mut Map<String, Value>) -> Option<Value> {
    object.get_mut("extensions")?.as_object_mut()?.remove(EXTENSION)
}

/// Reads a light.
fn light_source(members: &Members) -> Option<Light> {
    let color = Vec3::from(members.numbers("color", [1.0; 3], [0.0, 1.0]));
    let intensity = color * members.number("intensity", 1.0, POSITIVE);
    let range = || members.has("range").then(|| members.number("range", 1.0, RANGE));
    let kind = match members.text("type") {
        Some("directional") => LightKind::Directional,
        Some("point") => LightKind::Point { range: range() },
        Some("spot") => spot(members, range()),
        _ => {
            members.say("isn't a directional, a point or a spot light; it is left out");
            return None;
        }
    };
    Some(Light { kind, intensity, place: Vec3::ZERO, direction: Vec3::NEG_Z })
}

fn spot(members: &Members, range: Option<f32>) -> LightKind {
    let cone = members.inside("spot");
    let angle = |name, default| cone.as_ref().map_or(default, |cone| cone.number(name, default, [0.0, FRAC_PI_2]));
    let (inner, outer) = (angle("innerConeAngle", 0.0), angle("outerConeAngle", FRAC_PI_4));
    if inner > outer {
        members.say("has an inner cone that is wider than the outer one; the outer one is used for both");
    }
    LightKind::Spot { range, inner: inner.min(outer), outer }
}

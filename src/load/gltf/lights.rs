//! The lights of a document: the extension KHR_lights_punctual.
//!
//! Source: Khronos, KHR_lights_punctual.

use std::cell::RefCell;
use std::f32::consts::{FRAC_PI_2, FRAC_PI_4};

use glam::{DMat4, Vec3};
use serde_json::{Map, Value};

use super::carried::{Carriable, Carried, Carrier, take_extension};
use super::lenient::Members;
use super::notes::Notes;
use geometry::mesh::{Light, LightKind, MOST_LIGHTS};

const EXTENSION: &str = "KHR_lights_punctual";

/// From 0 to the largest intensity that is read: it is finite, also times a colour.
const POSITIVE: [f32; 2] = [0.0, 1e18];
/// Ranges must be greater than 0.
const RANGE: [f32; 2] = [1e-18, 1e18];

/// Takes the lights out of a document before it is checked. Each is at the origin, shining along -Z.
pub(super) fn take(root: &mut Map<String, Value>, notes: &RefCell<Notes>) -> Carried<Light> {
    let own = take_extension(root, EXTENSION);
    let lights = own.as_ref().map_or(Some(&[][..]), |own| own.get("lights")?.as_array().map(Vec::as_slice));
    if lights.is_none() {
        notes.borrow_mut().push(format!("/{} isn't a list; there are no lights.", Light::LIST));
    }
    Carried::take(root, lights.unwrap_or_default(), notes)
}

impl Carriable for Light {
    type Placed = Self;
    const LIST: &'static str = "extensions/KHR_lights_punctual/lights";
    const EXTENSION: Option<&'static str> = Some(EXTENSION);
    const MEMBER: &'static str = "light";
    const MOST: usize = MOST_LIGHTS;
    const MORE: [&'static str; 2] = ["lights, of which only the first", "shine"];
    const UNPLACED: &'static str = "a light at no finite place";

    fn read(members: &Members) -> Option<Self> {
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
        Some(Self { kind, intensity, place: Vec3::ZERO, direction: Vec3::NEG_Z })
    }

    fn at(&self, _: &Carrier, global: &DMat4) -> Option<Self> {
        Self::at(*self, global)
    }
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

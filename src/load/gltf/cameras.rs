//! The cameras of a document.
//!
//! Source: glTF 2.0 specification, section 3.10.

use std::cell::RefCell;

use glam::DMat4;
use serde_json::{Map, Value};

use super::carried::{Carried, Carrier, Most, Place};
use super::lenient::{Members, take_list};
use super::nodes::Placed;
use super::notes::Notes;
use geometry::mesh::{FileCamera, Projection};

const PLACE: Place = Place { list: "cameras", extension: None, member: "camera" };

/// The greatest number of cameras that are listed.
const MOST_CAMERAS: usize = 256;
/// Vertical fields of view in degrees: those that pictures can have.
const FIELDS_OF_VIEW: [f32; 2] = [0.1, 170.0];
/// Heights that are read; finite, also when they are doubled.
const HEIGHTS: [f32; 2] = [-1e18, 1e18];

#[derive(Debug)]
pub(super) struct CameraSource {
    name: Option<String>,
    projection: Projection,
}

/// Takes the cameras out of a document before it is checked.
pub(super) fn take(root: &mut Map<String, Value>, notes: &RefCell<Notes>) -> Carried<CameraSource> {
    let cameras = take_list(root, "cameras", "there are no cameras", notes);
    Carried::take(root, &cameras, &PLACE, camera, notes)
}

/// The cameras of the nodes that the scene shows, where they are at rest, each with its node: at most [`MOST_CAMERAS`].
pub(super) fn shown(cameras: &Carried<CameraSource>, placed: &Placed, notes: &mut Notes) -> Vec<(usize, FileCamera)> {
    let more = format!("cameras, of which the first {MOST_CAMERAS} are listed.");
    let most = Most { count: MOST_CAMERAS, more, unplaced: "a camera without a finite place and direction" };
    let at = |source: &CameraSource, own: &Carrier, global: &DMat4| {
        let (eye, axes) = FileCamera::view_axes(global)?;
        let name = own.name.clone().or_else(|| source.name.clone());
        let name = name.unwrap_or_else(|| format!("camera {}", own.index));
        Some(FileCamera { name, eye, axes, projection: source.projection })
    };
    cameras.shown(placed, &most, at, notes)
}

/// Reads a camera.
fn camera(members: &Members) -> Option<CameraSource> {
    let name = members.text("name").map(str::to_owned);
    let projection = match members.text("type") {
        Some("perspective") => members
            .inside("perspective")
            .filter(|inside| inside.has("yfov"))
            .map(|inside| Projection::Perspective(inside.number("yfov", 0.7, FIELDS_OF_VIEW.map(f32::to_radians)))),
        Some("orthographic") => members.inside("orthographic").and_then(|inside| {
            let height = inside.number("ymag", 0.0, HEIGHTS).abs();
            (height > 1e-18).then_some(Projection::Orthographic(height))
        }),
        _ => {
            members.say("isn't a perspective or an orthographic camera; it is left out");
            return None;
        }
    };
    if projection.is_none() {
        members.say("has no field of view or height; it is left out");
    }
    Some(CameraSource { name, projection: projection? })
}

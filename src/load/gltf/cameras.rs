//! The cameras of a document.
//!
//! Source: glTF 2.0 specification, section 3.10.

use std::cell::RefCell;

use glam::DMat4;
use serde_json::{Map, Value};

use super::carried::{Carriable, Carried, Carrier};
use super::lenient::{Members, take_list};
use super::notes::Notes;
use geometry::mesh::{FileCamera, Projection};

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
    Carried::take(root, &cameras, notes)
}

impl Carriable for CameraSource {
    type Placed = FileCamera;
    const LIST: &'static str = "cameras";
    const EXTENSION: Option<&'static str> = None;
    const MEMBER: &'static str = "camera";
    const MOST: usize = MOST_CAMERAS;
    const MORE: [&'static str; 2] = ["cameras, of which the first", "are listed"];
    const UNPLACED: &'static str = "a camera without a finite place and direction";

    fn read(members: &Members) -> Option<Self> {
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
        Some(Self { name, projection: projection? })
    }

    fn at(&self, carrier: &Carrier, global: &DMat4) -> Option<FileCamera> {
        let (eye, axes) = FileCamera::view_axes(global)?;
        let name = carrier.name.as_ref().or(self.name.as_ref());
        let name = name.map_or_else(|| format!("camera {}", carrier.index), String::clone);
        Some(FileCamera { name, eye, axes, projection: self.projection })
    }
}

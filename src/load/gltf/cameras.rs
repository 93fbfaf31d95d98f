//! The cameras of a document. Their faults don't keep the model from loading.
//!
//! Source: glTF 2.0 specification, section 3.10.

use std::cell::RefCell;

use serde_json::{Map, Value, json};

use super::json::objects;
use super::lenient::Members;
use super::nodes::Placed;
use super::notes::Notes;
use super::schema_check::shown;
use geometry::mesh::{FileCamera, Projection};

/// The greatest number of cameras that are listed.
const MOST_CAMERAS: usize = 256;
/// Vertical fields of view in degrees: those that pictures can have.
const FIELDS_OF_VIEW: [f32; 2] = [0.1, 170.0];
/// Heights that are read; finite, also when they are doubled.
const HEIGHTS: [f32; 2] = [-1e18, 1e18];

/// The cameras of a document, and the nodes that have one.
#[derive(Debug, Default)]
pub(super) struct CameraSources {
    /// None for one that can't be read.
    cameras: Vec<Option<CameraSource>>,
    of_nodes: Vec<CameraNode>,
}

#[derive(Clone, Debug)]
struct CameraSource {
    name: Option<String>,
    projection: Projection,
}

/// A node that has a camera.
#[derive(Debug)]
struct CameraNode {
    node: usize,
    name: Option<String>,
    camera: usize,
}

impl CameraSources {
    /// Takes the cameras out of a document before it is checked.
    pub(super) fn take(root: &mut Map<String, Value>, notes: &mut Notes) -> Self {
        let collected = RefCell::new(std::mem::take(notes));
        let list = match root.remove("cameras") {
            Some(Value::Array(list)) => list,
            None | Some(Value::Null) => Vec::new(),
            Some(other) => {
                let said = format!("/cameras is {}, not a list; there are no cameras.", shown(&other));
                collected.borrow_mut().push(said);
                Vec::new()
            }
        };
        let source = |(i, camera)| camera_source(&Members::of(camera, format!("/cameras/{i}"), &collected)?);
        let cameras: Vec<_> = list.iter().enumerate().map(source).collect();
        let mut of_nodes = Vec::new();
        for (node, object) in objects(root, "nodes").enumerate() {
            let Some(camera) = object.remove("camera") else { continue };
            let name = object.get("name").and_then(Value::as_str).map(str::to_owned);
            let own = json!({ "camera": camera });
            let Some(members) = Members::of(&own, format!("/nodes/{node}"), &collected) else { continue };
            let camera = members.index("camera", "cameras", cameras.len());
            of_nodes.extend(camera.map(|camera| CameraNode { node, name, camera }));
        }
        *notes = collected.into_inner();
        Self { cameras, of_nodes }
    }

    /// The memory that they take, in bytes.
    pub(super) fn bytes(&self) -> u64 {
        let names = self.cameras.iter().flatten().map(|camera| &camera.name);
        let names = names.chain(self.of_nodes.iter().map(|node| &node.name)).flatten().map(String::capacity);
        (names.sum::<usize>() + size_of_val(&self.cameras[..]) + size_of_val(&self.of_nodes[..])) as u64
    }

    /// The nodes that have a camera.
    pub(super) fn nodes(&self) -> impl Iterator<Item = usize> {
        self.of_nodes.iter().map(|own| own.node)
    }

    /// The cameras of the nodes that the scene shows, where they are at rest, each with its node: at most [`MOST_CAMERAS`].
    pub(super) fn shown(&self, placed: &Placed, notes: &mut Notes) -> Vec<(usize, FileCamera)> {
        if self.of_nodes.is_empty() {
            return Vec::new();
        }
        let is_shown = placed.is_shown();
        let shown = self.of_nodes.iter().filter(|own| is_shown.get(own.node) == Some(&true));
        let all: Vec<_> = shown.filter_map(|own| Some((own, self.cameras[own.camera].as_ref()?))).collect();
        if all.len() > MOST_CAMERAS {
            notes.push(format!("The scene has {} cameras, of which the first {MOST_CAMERAS} are listed.", all.len()));
        }
        let mut cameras = Vec::new();
        for (own, source) in all.into_iter().take(MOST_CAMERAS) {
            let name = own.name.clone().or_else(|| source.name.clone());
            let name = name.unwrap_or_else(|| format!("camera {}", own.camera));
            match placed.global.get(own.node).and_then(FileCamera::view_axes) {
                Some((eye, axes)) => {
                    cameras.push((own.node, FileCamera { name, eye, axes, projection: source.projection }));
                }
                None => notes.push(format!(
                    "/nodes/{} has a camera without a finite place and direction; it is left out.",
                    own.node
                )),
            }
        }
        cameras
    }
}

/// Reads a camera.
fn camera_source(members: &Members) -> Option<CameraSource> {
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

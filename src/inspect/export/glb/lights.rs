//! Writes the lights of the file, each on a node of its own.
//!
//! Source: Khronos, KHR_lights_punctual.

use glam::{Quat, Vec3};
use serde_json::{Value, json};

use super::Writer;
use geometry::mesh::{Light, LightKind};

const EXTENSION: &str = "KHR_lights_punctual";

impl Writer {
    /// Adds lights to the document, and their nodes to the scene's.
    pub(super) fn lights(&mut self, lights: &[Light], root: &mut Value) {
        if lights.is_empty() {
            return;
        }
        let all: Vec<_> = lights.iter().map(light_source).collect();
        self.extend(root, EXTENSION, json!({ "lights": all }));
        for (index, light) in lights.iter().enumerate() {
            let turn = Quat::from_rotation_arc(Vec3::NEG_Z, light.direction.try_normalize().unwrap_or(Vec3::NEG_Z));
            let mut node = json!({ "translation": light.place.to_array(), "rotation": turn.normalize().to_array() });
            self.extend(&mut node, EXTENSION, json!({ "light": index }));
            self.push("nodes", node);
        }
    }
}

/// A light at the origin, which shines along -Z.
fn light_source(light: &Light) -> Value {
    let brightest = light.intensity.max_element();
    // A colour's channels are 1 at most.
    let color = if brightest > 0.0 { light.intensity / brightest } else { Vec3::ONE };
    let mut source = json!({ "color": color.to_array(), "intensity": brightest });
    let (kind, range) = match light.kind {
        LightKind::Directional => ("directional", None),
        LightKind::Point { range } => ("point", range),
        LightKind::Spot { range, inner, outer } => {
            source["spot"] = json!({ "innerConeAngle": inner, "outerConeAngle": outer });
            ("spot", range)
        }
    };
    source["type"] = json!(kind);
    if let Some(range) = range {
        source["range"] = json!(range);
    }
    source
}

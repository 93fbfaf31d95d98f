//! Materials: their numbers, maps and samplers, what corners get for them, and what is wrong with some.

mod broken;
mod coordinates;
mod numbers;
mod tangents;

use glam::Vec4;

use super::*;
use geometry::mesh::{CornerDetail, MapUv, Material, Slot, Wrap};

/// The square of 1 in the xy plane that faces +Z, of two triangles.
const SQUARE: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
const QUARTER: [f32; 2] = [0.25, 0.25];

/// A square with two sets of texture coordinates, and three textures of 2 x 1 px.
fn square(material: Value) -> Draft {
    let mut draft = Draft::new();
    let (at, normals) = (draft.vectors(&SQUARE), draft.vectors(&[[0.0, 0.0, 1.0]; 4]));
    let first = draft.floats("VEC2", &[0.0, 1.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0]);
    let second = draft.floats("VEC2", &[QUARTER; 4].concat());
    let indices = draft.indices(&[0, 1, 2, 2, 1, 3]);
    let attributes = json!({ "POSITION": at, "NORMAL": normals, "TEXCOORD_0": first, "TEXCOORD_1": second });
    draft.primitive(json!({ "attributes": attributes, "indices": indices, "material": 0 }));
    draft.root["materials"] = json!([material]);
    draft.root["images"] = json!([{ "uri": files::png_uri() }]);
    draft.root["textures"] = json!([{ "source": 0 }, { "source": 0, "sampler": 0 }, { "source": 0 }]);
    draft.root["samplers"] = json!([{ "wrapS": 33071, "wrapT": 33648, "magFilter": 9728, "minFilter": 9985 }]);
    draft
}

fn attribute(draft: &mut Draft, name: &str, accessor: usize) {
    draft.root["meshes"][0]["primitives"][0]["attributes"][name] = json!(accessor);
}

/// The material of a square, which must be read without warnings.
fn material(of: Value) -> Material {
    let loaded = square(of).read().unwrap();
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    loaded.mesh.materials[0].clone()
}

fn details(mesh: &Mesh) -> &[CornerDetail] {
    let details = mesh.details.as_ref().expect("details");
    assert_eq!(details.len(), mesh.corners.len());
    details
}

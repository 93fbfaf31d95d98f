//! Writes Wavefront OBJ: text, with enough digits that every number reads back exactly.

use glam::Vec4;

use super::Exported;
use geometry::mesh::{Material, Mesh};
use load::markdown::listed;

/// Returns the text of a file.
pub(super) fn encode(mesh: &Exported) -> Vec<u8> {
    let mut text = format!("# {} tessellated by pnaen\n", mesh.mesh.name.replace(char::is_control, " "));
    // Rust prints the shortest decimal that parses to the same f32.
    text.extend(mesh.positions.iter().map(|p| format!("v {} {} {}\n", p.x, p.y, p.z)));
    text.extend(mesh.uvs.iter().map(|uv| format!("vt {} {}\n", uv.x, 1.0 - uv.y)));
    text.extend(mesh.normals.iter().map(|n| format!("vn {} {} {}\n", n.x, n.y, n.z)));
    for (material, triangles) in mesh.mesh.materials.iter().zip(&mesh.triangles) {
        text += &format!("g {}\n", material.name.replace(char::is_whitespace, "_"));
        let numbered = triangles.iter().map(|triangle| triangle.map(|index| index + 1));
        text.extend(numbered.map(|[a, b, c]| format!("f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}\n")));
    }
    text.into_bytes()
}

/// Returns a sentence about what is drawn of a mesh but isn't written, if there is something.
pub(super) fn left_out(mesh: &Mesh, path: &str) -> Option<String> {
    let materials = &mesh.materials;
    let is_plain = |own: &Material| own.texture.is_none() && own.look.maps.iter().all(Option::is_none);
    let has_materials = materials.len() > 1 || !materials.iter().all(is_plain);
    let has_colors = mesh.details.iter().any(|details| details.iter().any(|detail| detail.color != Vec4::ONE));
    let parts = [
        (has_materials, "its materials"),
        (has_colors, "the colours of its vertices"),
        (!mesh.lights.is_empty(), "its lights"),
    ];
    let parts: Vec<String> = parts.into_iter().filter(|(has, _)| *has).map(|(_, part)| part.to_owned()).collect();
    let said = || format!("{path}: the mesh is written without {}; a .glb file holds them.", listed(&parts));
    (!parts.is_empty()).then(said)
}

//! Writes Wavefront OBJ: text, with enough digits that every number reads back exactly.

use std::fmt::Write;

use super::Exported;

/// Returns the text of a file.
pub(super) fn encode(mesh: &Exported) -> Vec<u8> {
    let mut text = format!("# {} tessellated by pnaen\n", mesh.mesh.name.replace(char::is_control, " "));
    // Writing into a String can't fail. Rust prints the shortest decimal that parses to the same f32.
    for p in &mesh.positions {
        let _ = writeln!(text, "v {} {} {}", p.x, p.y, p.z);
    }
    for uv in &mesh.uvs {
        let _ = writeln!(text, "vt {} {}", uv.x, 1.0 - uv.y);
    }
    for n in &mesh.normals {
        let _ = writeln!(text, "vn {} {} {}", n.x, n.y, n.z);
    }
    for (material, triangles) in mesh.mesh.materials.iter().zip(&mesh.triangles) {
        let _ = writeln!(text, "g {}", material.name.replace(char::is_whitespace, "_"));
        for [a, b, c] in triangles.iter().map(|t| t.map(|i| i + 1)) {
            let _ = writeln!(text, "f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}");
        }
    }
    text.into_bytes()
}

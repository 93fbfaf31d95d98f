//! A table of files that are odd but say what their mesh is, as exporters and people write them. Each opens, with all of its
//! triangles.

mod fbx;
mod obj;
mod ply;
mod stl;

use std::path::Path;

use super::{mentions, page, unhung};
use crate::fbx::tests::documents::image;
use crate::files::Limits;
use crate::mesh_file::read;
use crate::selection::Selection;
use crate::{Format, gltf};
use geometry::progress::Progress;

/// A file that opens.
pub(crate) struct Odd {
    pub name: &'static str,
    pub format: Format,
    pub bytes: Vec<u8>,
    pub triangles: usize,
    /// Parts of one of its warnings (see [`mentions`]); if empty, there is none but about normals that are missing.
    pub warning: &'static str,
}

/// The files beside each of them.
fn beside(folder: &Path) {
    let material = b"newmtl wood\nKd 0.5 0.25 0\nmap_Kd grain.png\n";
    std::fs::create_dir(folder.join("maps")).expect("a folder");
    for (name, bytes) in [
        ("wood.mtl", &material[..]),
        ("my wood.mtl", material),
        ("paint.mtl", b"newmtl paint\nKd 1 0 0\n"),
        ("wood grain.png", &image()),
        ("grain.png", &image()),
        ("maps/grain.png", &image()),
        ("three positions.bin", bytemuck::cast_slice(&[0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0])),
    ] {
        std::fs::write(folder.join(name), bytes).expect("a file");
    }
}

/// Reads a file. Returns the answer for the page, or what is wrong with it.
fn answer(odd: &Odd, folder: &Path) -> Result<String, String> {
    let (format, bytes, path) = (odd.format, odd.bytes.clone(), folder.join("odd"));
    let result = unhung(move || read(format, bytes, &path, Selection::default(), &Limits::default(), &Progress::new()));
    let loaded = result.map_err(|error| format!("{}: {error}", odd.name))?;
    let (found, warnings) = (loaded.mesh.triangles.len(), &loaded.warnings);
    let is_fit = match odd.warning {
        "" => warnings.iter().all(|warning| warning.contains("without normals")),
        parts => warnings.iter().any(|warning| mentions(warning, parts)),
    };
    if found != odd.triangles || !is_fit {
        return Err(format!("{}: {found} triangles and {warnings:?}", odd.name));
    }
    let told = warnings.iter().filter(|warning| !warning.contains("without normals"));
    let told: String = told.map(|warning| format!("; {warning}")).collect();
    let plural = if found == 1 { "" } else { "s" };
    Ok(format!("{found} triangle{plural}{told}").replace(&folder.display().to_string(), "its folder"))
}

#[test]
fn every_odd_file_opens() {
    let folder = tempfile::tempdir().expect("a folder");
    beside(folder.path());
    let mut odd = obj::files();
    odd.extend(stl::files().into_iter().chain(ply::files()).chain(gltf::tests::odd()).chain(fbx::files()));
    for (i, own) in odd.iter().enumerate() {
        let ending = if own.bytes.starts_with(b"glTF") { "Glb".to_owned() } else { format!("{:?}", own.format) };
        page::keep(&format!("odd-{i:03}.{ending}").to_lowercase(), &own.bytes);
    }
    let answers: Vec<_> = odd.iter().map(|own| answer(own, folder.path())).collect();
    let wrong: Vec<_> = answers.iter().filter_map(|answer| answer.as_ref().err()).map(String::as_str).collect();
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), odd.len(), wrong.join("\n"));
    let name = |own: &Odd| format!("{}: {}", format!("{:?}", own.format).replace("Gltf", "glTF"), own.name);
    let rows: Vec<_> = odd.iter().zip(answers).filter_map(|(own, answer)| Some((name(own), answer.ok()?))).collect();
    page::hold("odd.md", "Odd files that open", &rows);
}

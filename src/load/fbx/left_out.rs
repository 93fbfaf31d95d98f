//! Warnings about what a file has and isn't read, and about what the parser repaired.

use ufbx::{Mesh, Scene, SkinningMethod, WarningType};

use super::nodes::Placed;
use crate::notes::{Notes, counted};

/// Adds a warning for each kind of thing that is left out.
pub(super) fn warn(scene: &Scene, notes: &mut Notes) {
    let meshes = |has: fn(&Mesh) -> bool| scene.meshes.into_iter().filter(|mesh| has(mesh)).count();
    let dual = |method| matches!(method, SkinningMethod::DualQuaternion | SkinningMethod::BlendedDqLinear);
    let dual = scene.skin_deformers.into_iter().filter(|skin| dual(skin.skinning_method)).count();
    notes.extend(counted([
        (scene.cameras.len() + scene.stereo_cameras.len(), "cameras, which aren't read"),
        (scene.lights.len(), "lights, which aren't read"),
        (curves(scene), "lines and curves, left out"),
        (scene.procedural_geometries.len(), "procedural surfaces, which aren't read"),
        (scene.cache_deformers.len() + scene.cache_files.len(), "geometry caches, which aren't read"),
        (scene.constraints.len(), "constraints, left out; the animation shows what the exporter has baked"),
        (dual, "skins for dual quaternions, whose joints are blended linearly"),
        (meshes(|mesh| mesh.skin_deformers.len() > 1), "meshes with several skins, of which the first is used"),
    ]));
    let warnings = scene.metadata.warnings.iter();
    notes.extend(counted(warnings.filter_map(|own| Some((own.count.max(1), repaired(own.type_)?)))));
}

fn curves(scene: &Scene) -> usize {
    scene.nurbs_curves.len() + scene.line_curves.len()
}

/// Returns what the parser did; none if nobody needs to know.
fn repaired(warning: WarningType) -> Option<&'static str> {
    Some(match warning {
        WarningType::MissingExternalFile | WarningType::ImplicitMtl | WarningType::UnknownObjDirective => return None,
        WarningType::EmptyFaceRemoved => return None,
        WarningType::IndexClamped => "indices of something that doesn't exist, whose uses are left out",
        WarningType::TruncatedArray => "lists that are shorter than they should be, filled with what they end with",
        WarningType::MissingGeometryData => "meshes whose geometry is missing, left out",
        WarningType::DuplicateConnection => "connections that the file has twice",
        WarningType::BadVertexWAttribute => "fourth components of vertices that can't be read, left out",
        WarningType::MissingPolygonMapping => "lists whose mapping to polygons is missing, for which one was guessed",
        WarningType::UnsupportedVersion => "versions of FBX that may be read wrongly",
        WarningType::BadUnicode => "names that aren't UTF-8, with letters replaced",
        WarningType::BadBase64Content => "embedded files that aren't base64, left out",
        WarningType::BadElementConnectedToRoot => "things that hang at the root though they can't, left out",
        WarningType::DuplicateObjectId => "objects with the number of another one",
    })
}

/// Returns what the file holds, for the error that says that there are no triangles.
pub(super) fn holds(scene: &Scene, placed: &Placed) -> String {
    let surfaces = scene.nurbs_surfaces.len() + scene.procedural_geometries.len();
    let convert = "(export them as polygons)";
    let kinds = [
        (scene.nodes.len(), "nodes", ""),
        (scene.meshes.len(), "meshes", ""),
        (placed.hidden, "nodes with meshes that it hides", "(--show-hidden shows them)"),
        (surfaces, "NURBS and procedural surfaces", convert),
        (curves(scene), "lines and curves", convert),
    ];
    let held = kinds.into_iter().filter(|(count, what, _)| *count > 0 || *what == "meshes");
    let held: Vec<_> = held.map(|(count, what, help)| format!("{count} {what} {help}").trim_end().to_owned()).collect();
    format!("it holds {}", held.join(", "))
}

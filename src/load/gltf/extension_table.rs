//! Which extensions change the shape, and what is said of those that aren't read.
//!
//! Source: Khronos, glTF extension registry, <https://github.com/KhronosGroup/glTF/blob/main/extensions/README.md>, and the
//! registries of VRM and of the Open Metaverse Interoperability group.

use serde_json::{Map, Value};

use super::GltfError;
use super::notes::Notes;
use super::schema::{BASISU, DRACO, INSTANCING, KHR_MESHOPT, LOD, MESHOPT, TRANSFORM, VISIBILITY, WEBP};
use crate::uri::shown;

/// What an extension does to a model; and, if that changes the shape, what a user can do. Without that, it changes how the model looks.
type Effect = (&'static str, Option<&'static str>);

/// How many unknown extensions a sentence names.
const NAMED: usize = 5;

const EXPORT: &str = "export the model without it";
const SHADERS: &str = "draws with shaders of its own";

/// The extensions that have an effect and aren't read.
const KNOWN: [(&str, Effect); 9] = [
    ("AGI_articulations", ("places parts by articulations", Some(EXPORT))),
    ("EXT_primitive_voxels", ("makes voxels of its primitives", Some("export the voxels as triangles"))),
    ("KHR_gaussian_splatting", ("makes splats of points", Some("convert the splats to triangles"))),
    ("KHR_technique_webgl", (SHADERS, None)),
    ("KHR_techniques_webgl", (SHADERS, None)),
    ("MAXAR_mesh_variants", ("has several variants of its meshes, of which the first is shown", Some(EXPORT))),
    ("MPEG_accessor_timed", ("changes vertices over time", Some(EXPORT))),
    ("MPEG_mesh_linking", ("moves meshes with others", Some(EXPORT))),
    ("MPEG_scene_dynamic", ("changes the scene over time", Some(EXPORT))),
];

/// The extensions that are read, and those that have no effect, besides those whose [names](concerns_looks) tell it. FB_ngon_encoding
/// says which triangles are one polygon.
const READ: [&str; 6] = [INSTANCING, MESHOPT, DRACO, KHR_MESHOPT, LOD, VISIBILITY];
const WITHOUT_EFFECT: &str = "\
    AGI_stk_metadata CESIUM_primitive_outline EXT_instance_features EXT_mesh_features EXT_mesh_manifold \
    EXT_mesh_primitive_edge_visibility EXT_structural_metadata FB_geometry_metadata FB_ngon_encoding GODOT_single_root \
    GRIFFEL_bim_data KHR_animation_pointer KHR_audio_emitter KHR_collision_shapes KHR_implicit_shapes KHR_interactivity \
    KHR_mesh_quantization KHR_node_hoverability KHR_node_selectability KHR_physics_rigid_bodies KHR_xmp KHR_xmp_json_ld \
    MAXAR_image_ortho MOZ_hubs_components MPEG_audio_spatial MPEG_media MSFT_packing_normalRoughnessMetallic \
    MSFT_packing_occlusionRoughnessMetallic OMI_physics_body OMI_physics_shape VRM VRMC_node_constraint VRMC_springBone \
    VRMC_springBone_extended_collider VRMC_vrm VRMC_vrm_animation";

/// Returns whether an extension is one of materials, textures or lights, whose names say so behind the vendor's prefix.
fn concerns_looks(name: &str) -> bool {
    let subject = name.split_once('_').map_or("", |(_, subject)| subject);
    [BASISU, WEBP, TRANSFORM].contains(&name)
        || ["materials_", "texture_", "lights_"].iter().any(|prefix| subject.starts_with(prefix))
}

/// Returns whether an extension is read, or changes nothing of the shape at rest: looks, light, sound, behaviour, descriptions.
fn is_harmless(name: &str) -> bool {
    concerns_looks(name) || READ.contains(&name) || WITHOUT_EFFECT.split(' ').any(|known| known == name)
}

/// Returns the effect of an extension that isn't read, if it is known.
fn effect(name: &str) -> Option<Effect> {
    KNOWN.iter().find(|(known, _)| *known == name).map(|(_, effect)| *effect)
}

/// Checks that the shape can be known without the extensions that aren't read. Says which extensions that the document only uses
/// change the shape, or aren't known.
///
/// # Errors
/// [`GltfError::Extension`] for the first required extension that changes the shape or isn't known.
pub(super) fn check(root: &Map<String, Value>, notes: &mut Notes) -> Result<(), GltfError> {
    for (place, name) in names(root, "extensionsRequired") {
        let (reason, remedy) = match effect(name) {
            Some((does, Some(remedy))) => (format!("which {does} and isn't read"), remedy),
            None if !is_harmless(name) => ("which isn't known, and may change the shape".to_owned(), EXPORT),
            Some((_, None)) | None => continue,
        };
        return Err(GltfError::Extension { place, name: shown(name), reason, remedy });
    }
    let mut unknown = Vec::new();
    for (_, name) in names(root, "extensionsUsed") {
        match effect(name) {
            Some((does, remedy)) => {
                let what = if remedy.is_some() {
                    "What is shown may differ from what the file means"
                } else {
                    "Colours may differ"
                };
                notes.push(format!("{name} isn't read: it {does}. {what}."));
            }
            None if is_harmless(name) || unknown.contains(&name) => {}
            None => unknown.push(name),
        }
        if unknown.len() > NAMED {
            break;
        }
    }
    if let Some(sentence) = unknown_sentence(&unknown) {
        notes.push(sentence);
    }
    Ok(())
}

fn names<'a>(root: &'a Map<String, Value>, list: &str) -> impl Iterator<Item = (usize, &'a str)> {
    let names = root.get(list).and_then(Value::as_array).into_iter().flatten();
    names.enumerate().filter_map(|(i, name)| Some((i, name.as_str()?)))
}

fn unknown_sentence(unknown: &[&str]) -> Option<String> {
    let names: Vec<_> = unknown.iter().take(NAMED).map(|name| shown(name)).collect();
    let more = if unknown.len() > NAMED { " and more" } else { "" };
    match names.len() {
        0 => None,
        1 => Some(format!("the extension {} isn't known, and is left out.", names[0])),
        _ => Some(format!("the extensions {}{more} aren't known, and are left out.", names.join(", "))),
    }
}

/// Returns whether a document requires this extension.
pub(super) fn requires(root: &Map<String, Value>, extension: &str) -> bool {
    names(root, "extensionsRequired").any(|(_, name)| name == extension)
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn checked(root: &Value) -> Result<Vec<String>, String> {
        let mut notes = Notes::default();
        let root = root.as_object().expect("an object");
        check(root, &mut notes).map_err(|error| error.to_string()).map(|()| notes.into_warnings())
    }

    #[test]
    fn names_are_sorted_and_stand_once() {
        assert!(KNOWN.windows(2).all(|pair| pair[0].0 < pair[1].0));
        assert!(KNOWN.iter().all(|(name, _)| !concerns_looks(name)));
        let harmless: Vec<_> = WITHOUT_EFFECT.split(' ').collect();
        assert!(harmless.windows(2).all(|pair| pair[0] < pair[1]), "{harmless:?}");
        assert!(harmless.iter().all(|name| !concerns_looks(name) && !KNOWN.iter().any(|(known, _)| known == name)));
    }

    #[test]
    fn looks_may_be_required_and_shapes_may_not() {
        let fine = ["KHR_materials_fuzz", "EXT_texture_avif", "KHR_xmp_json_ld", "KHR_animation_pointer", DRACO];
        assert_eq!(checked(&json!({ "extensionsRequired": fine })), Ok(Vec::new()));
        let said = checked(&json!({ "extensionsRequired": ["VRM", "KHR_gaussian_splatting"] })).unwrap_err();
        assert!(
            said.contains("/extensionsRequired/1 is KHR_gaussian_splatting, which makes splats of points"),
            "{said}"
        );
        assert!(said.ends_with("convert the splats to triangles"), "{said}");
        let said = checked(&json!({ "extensionsRequired": ["A_b"] })).unwrap_err();
        assert!(
            said.contains("A_b, which isn't known, and may change the shape; export the model without it"),
            "{said}"
        );
    }

    #[test]
    fn shaders_and_polygons_may_be_required_and_the_former_are_said() {
        for name in ["KHR_technique_webgl", "KHR_techniques_webgl", "FB_ngon_encoding"] {
            let said = checked(&json!({ "extensionsUsed": [name], "extensionsRequired": [name] })).expect("no error");
            let expected = format!("{name} isn't read: it draws with shaders of its own. Colours may differ.");
            assert_eq!(said, if name.starts_with("KHR") { vec![expected] } else { Vec::new() });
        }
    }

    #[test]
    fn what_is_only_used_is_said() {
        let said = checked(&json!({ "extensionsUsed": ["A_b", "VRM", "A_b", "MPEG_mesh_linking"] })).expect("no error");
        assert_eq!(said.len(), 2, "{said:?}");
        assert!(said[0].starts_with("MPEG_mesh_linking isn't read: it moves meshes with others."), "{said:?}");
        assert_eq!(said[1], "the extension A_b isn't known, and is left out.");
        let many: Vec<_> = (0..9).map(|i| format!("A_{i}")).collect();
        let said = checked(&json!({ "extensionsUsed": many })).expect("no error");
        assert_eq!(said, ["the extensions A_0, A_1, A_2, A_3, A_4 and more aren't known, and are left out."]);
    }
}

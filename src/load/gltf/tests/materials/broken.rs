//! Materials with faults, which are repaired or left out and told.

use super::*;

#[test]
fn broken_materials_are_repaired_and_told() {
    let cases = [
        (json!(7), "/materials/0 is 7, not an object"),
        (
            json!({ "pbrMetallicRoughness": { "metallicFactor": 1.5 } }),
            "metallicFactor is 1.5, but must be at most 1.0; 1 is used",
        ),
        (
            json!({ "pbrMetallicRoughness": { "roughnessFactor": "no" } }),
            "roughnessFactor is \"no\", not a number; 1 is used",
        ),
        (json!({ "emissiveFactor": [1, 1] }), "emissiveFactor is a list of 2, not 3 numbers"),
        (json!({ "emissiveFactor": [1, -1, 0] }), "emissiveFactor/1 is -1, but must be at least 0.0; 0 is used"),
        (json!({ "alphaMode": "GLASS" }), "alphaMode is \"GLASS\", not OPAQUE or MASK or BLEND; OPAQUE is used"),
        (json!({ "normalTexture": { "index": 9 } }), "/materials/0/normalTexture/index is 9, but /textures has 3"),
        (json!({ "normalTexture": {} }), "/materials/0/normalTexture has no index"),
        (json!({ "normalTexture": { "index": 0, "scale": [] } }), "normalTexture/scale is a list of 0, not a number"),
        (json!({ "extensions": { "KHR_materials_ior": { "ior": 0.5 } } }), "index of refraction 0.5"),
        (
            json!({ "extensions": { "KHR_materials_transmission": { "transmissionFactor": 1.5 } },
                "pbrMetallicRoughness": { "roughnessFactor": 0 } }),
            "/materials/0/extensions/KHR_materials_transmission/transmissionFactor is 1.5, but must be at most 1.0; 1 is used",
        ),
        (
            json!({ "extensions": { "KHR_materials_transmission": { "transmissionFactor": "all" } } }),
            "transmissionFactor is \"all\", not a number; 0 is used",
        ),
        (
            json!({ "name": "soap", "extensions": { "KHR_materials_iridescence": { "iridescenceFactor": 0.5 } } }),
            "KHR_materials_iridescence isn't drawn; material \"soap\" has it.",
        ),
        (
            json!({ "extensions": { "KHR_materials_volume": { "thicknessFactor": -1 } } }),
            "KHR_materials_volume/thicknessFactor is -1, but must be at least 0.0; 0 is used",
        ),
        (
            json!({ "extensions": { "KHR_materials_volume": { "thicknessFactor": 1, "attenuationDistance": 0 } } }),
            "/materials/0/extensions/KHR_materials_volume has the attenuation distance 0",
        ),
        (
            json!({ "extensions": { "KHR_materials_anisotropy": { "anisotropyStrength": 2 } } }),
            "KHR_materials_anisotropy/anisotropyStrength is 2, but must be at most 1.0; 1 is used",
        ),
        (
            json!({ "extensions": { "KHR_materials_sheen": { "sheenColorFactor": [2, 0, 0] } } }),
            "/materials/0/extensions/KHR_materials_sheen/sheenColorFactor/0 is 2, but must be at most 1.0; 1 is used",
        ),
    ];
    for (of, expected) in cases {
        let mesh = square(of).read().unwrap();
        assert_eq!(mesh.warnings.len(), 1, "{expected}: {:?}", mesh.warnings);
        assert!(mesh.warnings[0].contains(expected), "{expected}: {:?}", mesh.warnings);
    }
}

#[test]
fn broken_textures_are_left_out_and_told() {
    let occlusion = json!({ "name": "m", "occlusionTexture": { "index": 0 } });
    let cases = [
        ("textures", json!([{ "source": 5 }]), "/textures/0/source is 5, but /images has 1"),
        ("textures", json!([[]]), "/textures/0 is a list of 0, not an object"),
        ("textures", json!([{ "source": 0, "sampler": 3 }]), "/textures/0/sampler is 3, but /samplers has 1"),
        ("textures", json!("none"), "/textures is \"none\", not a list"),
        ("images", json!([{ "uri": 5 }]), "the occlusion map of material \"m\" is left out: /images/0/uri isn't text"),
        ("images", json!([{ "bufferView": 99 }]), "/images/0/bufferView isn't one of the document's buffer views"),
    ];
    for (list, value, expected) in cases {
        let mut draft = square(occlusion.clone());
        draft.root[list] = value;
        let mesh = draft.read().unwrap();
        assert!(mesh.warnings[0].contains(expected), "{expected}: {:?}", mesh.warnings);
    }
    let mut draft = square(json!({ "occlusionTexture": { "index": 1 } }));
    draft.root["samplers"][0]["wrapS"] = json!(5);
    let said = draft.read().unwrap().warnings;
    assert!(said[0].contains("/samplers/0/wrapS is 5, not 10497 or 33071 or 33648"), "{said:?}");
}

#[test]
fn broken_colours_and_tangents_are_left_out_and_told() {
    let normal = || square(json!({ "normalTexture": { "index": 0 } }));
    let mut short = normal();
    let few = short.floats("VEC4", &[1.0; 4]);
    attribute(&mut short, "COLOR_0", few);
    let mut beyond = normal();
    attribute(&mut beyond, "TANGENT", 99);
    let mut flat = normal();
    let pairs = flat.floats("VEC2", &[1.0; 8]);
    attribute(&mut flat, "TANGENT", pairs);
    let mut odd = normal();
    let colors = odd.floats("VEC4", &[[f32::NAN; 4], [9.0; 4], [-1.0; 4], [0.5; 4]].concat());
    attribute(&mut odd, "COLOR_0", colors);
    let mut zero = normal();
    let tangents = zero.floats("VEC4", &[0.0; 16]);
    attribute(&mut zero, "TANGENT", tangents);
    let cases = [
        (short, "(COLOR_0 of /meshes/0/primitives/0 (\"thing\")) has 1 elements for 4 vertices; it is left out."),
        (beyond, "/attributes/TANGENT isn't one of the 5 accessors; it is left out."),
        (flat, "(TANGENT of /meshes/0/primitives/0 (\"thing\"))"),
        (odd, "colours of vertices that aren't finite, replaced by white: 1."),
        (zero, "tangents without a direction, replaced by ones that are computed: 4."),
    ];
    for (draft, expected) in cases {
        let mesh = draft.read().unwrap();
        assert_eq!(mesh.warnings.len(), 1, "{expected}: {:?}", mesh.warnings);
        assert!(mesh.warnings[0].contains(expected), "{expected}: {:?}", mesh.warnings);
        for detail in details(&mesh) {
            assert!(detail.tangent.distance(Vec3::X) < 1e-6, "{expected}: {detail:?}");
            assert!(detail.color.cmpge(Vec4::ZERO).all() && detail.color.cmple(Vec4::ONE).all(), "{detail:?}");
        }
    }
}

#[test]
fn a_material_that_is_not_there_is_the_default() {
    for index in [json!(4), json!(-1), json!("first")] {
        let mut draft = square(json!({ "name": "there" }));
        draft.root["meshes"][0]["primitives"][0]["material"] = index;
        let mesh = draft.read().unwrap();
        assert_eq!(mesh.materials[0].name, "default");
        assert!(
            mesh.warnings[0].contains("/meshes/0/primitives/0/material isn't one of the 1 materials"),
            "{:?}",
            mesh.warnings
        );
    }
}

#[test]
fn many_materials_with_the_same_extension_are_one_sentence() {
    let strong = json!({ "KHR_materials_iridescence": { "iridescenceFactor": 1 } });
    let mut draft = square(json!({ "name": "a", "extensions": strong }));
    let one = draft.root["meshes"][0]["primitives"][0].clone();
    for i in 1..5 {
        let mut next = one.clone();
        next["material"] = json!(i);
        draft.primitive(next);
        draft.push("materials", json!({ "name": format!("m{i}"), "extensions": strong }));
    }
    let warnings = draft.read().unwrap().warnings;
    let expected = "KHR_materials_iridescence isn't drawn; materials \"a\", \"m1\", \"m2\" and 2 more have it.";
    assert_eq!(warnings, [expected]);
}

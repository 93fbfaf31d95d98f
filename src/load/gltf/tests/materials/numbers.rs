//! Factors and the extensions that have them, with their maps.

use super::*;
use geometry::mesh::{Alpha, HeightAmount, Look};

#[test]
fn silent_materials_are_rough_metal() {
    for of in [json!({}), json!({ "pbrMetallicRoughness": {} })] {
        let Look { metallic, roughness, emissive, alpha, ior, .. } = material(of).look;
        assert_eq!((metallic, roughness, emissive, alpha, ior), (1.0, 1.0, [0.0; 3], Alpha::Opaque, 1.5));
    }
    let default = triangle().read().unwrap();
    assert_eq!((default.materials[0].look.metallic, default.details.is_none()), (1.0, true));
}

#[test]
fn all_numbers_are_read() {
    let read = material(json!({
        "name": "paint", "doubleSided": true, "alphaMode": "MASK", "alphaCutoff": 0.25, "emissiveFactor": [0.5, 0.25, 0],
        "pbrMetallicRoughness": { "baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0.5, "roughnessFactor": 0.75 },
        "normalTexture": { "index": 0, "scale": -2 }, "occlusionTexture": { "index": 0, "strength": 0.125 },
        "extensions": {
            "KHR_materials_emissive_strength": { "emissiveStrength": 8 }, "KHR_materials_ior": { "ior": 1.25 },
            "KHR_materials_specular": { "specularFactor": 0.5, "specularColorFactor": [1, 2, 3] },
            "KHR_materials_clearcoat": { "clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.25 },
            "KHR_materials_transmission": { "transmissionFactor": 0.375, "transmissionTexture": { "index": 0 } },
            "KHR_materials_unlit": {},
        },
    }));
    let look = &read.look;
    assert_eq!((read.name.as_str(), read.double_sided, read.base_color), ("paint", true, [0.1, 0.2, 0.3, 0.4]));
    assert_eq!((look.metallic, look.roughness, look.emissive), (0.5, 0.75, [4.0, 2.0, 0.0]));
    assert_eq!((look.normal_scale, look.occlusion_strength, look.alpha), (-2.0, 0.125, Alpha::Mask(0.25)));
    assert_eq!((look.ior, look.specular, look.specular_color, look.unlit), (1.25, 0.5, [1.0, 2.0, 3.0], true));
    assert_eq!((look.clearcoat, look.clearcoat_roughness), (0.5, 0.25));
    assert_eq!((look.transmission, look.maps[Slot::Transmission as usize].is_some()), (0.375, true));
    let cut = material(json!({ "alphaMode": "MASK" })).look.alpha;
    assert_eq!(cut, Alpha::Mask(0.5));
}

#[test]
fn a_sheen_has_a_colour_a_roughness_and_maps() {
    let sheen = json!({
        "sheenColorFactor": [0.5, 0.25, 1], "sheenRoughnessFactor": 0.75, "sheenColorTexture": { "index": 0 },
        "sheenRoughnessTexture": { "index": 1 },
    });
    let read = material(json!({ "extensions": { "KHR_materials_sheen": sheen } })).look;
    assert_eq!((read.sheen_color, read.sheen_roughness, read.has_sheen()), ([0.5, 0.25, 1.0], 0.75, true));
    let slots = [Slot::SheenColor, Slot::SheenRoughness];
    assert!(slots.iter().all(|&slot| read.maps[slot as usize].is_some()));
    // Without a colour there is no sheen, whatever its roughness is.
    let none = json!({ "sheenRoughnessFactor": 0.75, "sheenColorTexture": { "index": 0 } });
    let read = material(json!({ "extensions": { "KHR_materials_sheen": none } })).look;
    assert!(!read.has_sheen() && slots.iter().all(|&slot| read.maps[slot as usize].is_none()));
}

#[test]
fn height_images_displace_as_either_draft_says() {
    let displaced = |of: Value| json!({ "extensions": { "KHR_materials_displacement": of } });
    for name in ["displacement", "displacementGeometry"] {
        let [texture, factor, offset] = ["Texture", "Factor", "Offset"].map(|end| format!("{name}{end}"));
        let own = json!({ (&texture): { "index": 1 }, (factor): 0.5, (offset): -0.125 });
        let map = material(displaced(own)).height.expect("a height image");
        assert_eq!((map.size, map.amount), ([2, 1], Some(HeightAmount { scale: 0.5, midlevel: 0.25 })));
        assert_eq!(map.wrap, [Wrap::Clamp, Wrap::Mirror], "as the sampler says");
        let usual = material(displaced(json!({ (texture): { "index": 0 } }))).height.expect("a height image");
        assert_eq!((usual.amount, usual.wrap), (HeightAmount::from_factor(1.0, 0.0), [Wrap::Repeat; 2]));
    }
    let elsewhere = json!({ "displacementTexture": { "index": 0, "texCoord": 1 } });
    let alone = square(displaced(elsewhere.clone())).read().unwrap();
    assert!(alone.warnings.is_empty() && alone.corners.iter().all(|corner| corner.uv.to_array() == QUARTER));
    let mut both = displaced(elsewhere);
    both["pbrMetallicRoughness"] = json!({ "baseColorTexture": { "index": 0 } });
    let said = &square(both).read().unwrap().warnings[0];
    assert!(said.contains("height image of material \"material 0\" lies elsewhere than its base colour"), "{said}");
    let mut broken = square(displaced(json!({ "displacementTexture": { "index": 0 } })));
    broken.root["images"] = json!([{ "uri": "data:image/png;base64,AAAA" }]);
    let broken = broken.read().unwrap();
    let start = "the height image of material \"material 0\" is left out: /images/0 can't be read as a height image: ";
    assert!(broken.materials[0].height.is_none() && broken.warnings[0].starts_with(start), "{:?}", broken.warnings);
}

#[test]
fn a_coat_and_a_reflection_have_maps() {
    let coat = json!({
        "clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.25, "clearcoatTexture": { "index": 0 },
        "clearcoatRoughnessTexture": { "index": 1 }, "clearcoatNormalTexture": { "index": 2, "scale": 3, "texCoord": 1 },
    });
    let specular = json!({ "specularTexture": { "index": 0, "texCoord": 1 }, "specularColorTexture": { "index": 2 } });
    let both = json!({ "KHR_materials_clearcoat": coat, "KHR_materials_specular": specular });
    let loaded = square(json!({ "extensions": both })).read().unwrap();
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    let read = &loaded.materials[0].look;
    let uv = |slot: Slot| read.maps[slot as usize].as_ref().map(|map| map.uv);
    let second = Some(MapUv::Set(1, [1.0, 0.0, 0.0, 0.0, 1.0, 0.0]));
    assert_eq!([uv(Slot::Clearcoat), uv(Slot::ClearcoatRoughness), uv(Slot::SpecularColor)], [Some(MapUv::Own); 3]);
    assert_eq!([uv(Slot::ClearcoatNormal), uv(Slot::Specular)], [second; 2]);
    assert_eq!((read.clearcoat, read.clearcoat_roughness, read.clearcoat_normal_scale), (0.5, 0.25, 3.0));
    // A coat of no part of the surface needs no images. One alone needs no tangents that a map of normals would.
    let none = json!({ "clearcoatTexture": { "index": 0 }, "clearcoatNormalTexture": { "index": 2 } });
    let read = material(json!({ "extensions": { "KHR_materials_clearcoat": none } })).look;
    assert!(read.maps.iter().all(Option::is_none));
    // Normals of a coat need tangents as those of the surface do.
    let alone = json!({ "clearcoatFactor": 1, "clearcoatNormalTexture": { "index": 0 } });
    let mesh = square(json!({ "extensions": { "KHR_materials_clearcoat": alone } })).read().unwrap();
    assert!(details(&mesh).iter().all(|detail| detail.tangent.distance(Vec3::X) < 1e-6));
}

#[test]
fn long_highlights_have_a_strength_a_direction_and_a_map_and_need_tangents() {
    let rotation = std::f32::consts::FRAC_PI_2;
    let long = json!({ "anisotropyStrength": 0.5, "anisotropyRotation": rotation });
    let mesh = square(json!({ "extensions": { "KHR_materials_anisotropy": long } })).read().unwrap();
    let look = &mesh.materials[0].look;
    assert_eq!((look.anisotropy, look.anisotropy_rotation, look.has_anisotropy()), (0.5, rotation, true));
    assert_eq!(mesh.warnings, [""; 0]);
    // They go along the base colour's texture coordinates.
    assert!(details(&mesh).iter().all(|detail| detail.tangent.distance(Vec3::X) < 1e-6));
    // In the map's own texture coordinates, which are turned by a quarter, u grows along y.
    let quarter = json!({ "KHR_texture_transform": { "rotation": rotation } });
    let map = json!({ "anisotropyStrength": 1, "anisotropyTexture": { "index": 0, "extensions": quarter } });
    let mesh = square(json!({ "extensions": { "KHR_materials_anisotropy": map } })).read().unwrap();
    assert!(mesh.materials[0].look.maps[Slot::Anisotropy as usize].is_some());
    assert!(details(&mesh).iter().all(|detail| detail.tangent.distance(Vec3::NEG_Y) < 1e-6));
    let none = json!({ "anisotropyTexture": { "index": 0 } });
    let mesh = square(json!({ "extensions": { "KHR_materials_anisotropy": none } })).read().unwrap();
    assert!(mesh.details.is_none() && mesh.materials[0].look.maps.iter().all(Option::is_none));
}

/// A body of this thickness, which lets all light through.
fn body(thickness: f32) -> Value {
    let volume = json!({
        "thicknessFactor": thickness, "attenuationDistance": 0.5, "attenuationColor": [1, 0.5, 0.25],
        "thicknessTexture": { "index": 0 },
    });
    let extensions =
        json!({ "KHR_materials_transmission": { "transmissionFactor": 1 }, "KHR_materials_volume": volume });
    json!({ "name": "jar", "pbrMetallicRoughness": { "metallicFactor": 0 }, "extensions": extensions })
}

#[test]
fn a_body_has_a_thickness_in_its_mesh_and_absorbs_in_the_scene() {
    let look = material(body(2.0)).look;
    assert_eq!((look.thickness, look.attenuation_distance, look.attenuation_color), (2.0, 0.5, [1.0, 0.5, 0.25]));
    // A half is left after half a unit.
    let [red, green, blue] = look.absorption();
    assert!(red == 0.0 && (green - 2.0 * 2.0_f32.ln()).abs() < 1e-6 && (blue - 2.0 * green).abs() < 1e-6);
    assert!(look.refracts() && look.maps[Slot::Thickness as usize].is_some());
    let thin = material(json!({ "extensions": { "KHR_materials_volume": { "attenuationDistance": 2 } } })).look;
    assert_eq!((thin.refracts(), thin.absorption()), (false, [0.0; 3]));
    // What is behind a rough surface is blurred, also where it is thin.
    let pane = |metallic: f32, roughness: f32| {
        let extensions = json!({ "KHR_materials_transmission": { "transmissionFactor": 1 } });
        let rough = json!({ "metallicFactor": metallic, "roughnessFactor": roughness });
        material(json!({ "pbrMetallicRoughness": rough, "extensions": extensions })).look
    };
    assert!(look.distorts() && pane(0.0, 0.5).distorts() && !pane(0.0, 0.0).distorts() && !thin.distorts());
    // No light goes through metal, unless a map says where it is.
    let metal = pane(1.0, 0.5);
    assert!(pane(0.5, 0.5).distorts() && !metal.distorts() && metal.distorts_with(true));
    // Of a scale along one axis the mean counts, and that of the first node.
    let mut draft = square(body(2.0));
    draft.root["nodes"] = json!([{ "mesh": 0, "scale": [8, 1, 1] }, { "mesh": 0, "scale": [-2, 2, 2] }]);
    draft.root["scenes"][0]["nodes"] = json!([0, 1]);
    let mesh = draft.read().unwrap();
    assert!((mesh.materials[0].look.thickness - 4.0).abs() < 1e-5, "{}", mesh.materials[0].look.thickness);
    assert_eq!((mesh.materials[0].look.attenuation_distance, mesh.warnings), (0.5, Vec::<String>::new()));
    draft.root["nodes"][1]["scale"] = json!([3, 3, 3]);
    let warnings = draft.read().unwrap().warnings;
    assert!(matches!(&warnings[..], [said] if said.contains("thickness of material \"jar\"")), "{warnings:?}");
}

#[test]
fn a_map_beyond_those_that_are_drawn_is_told() {
    let info = json!({ "index": 0 });
    let all = json!({
        "name": "m", "normalTexture": info, "occlusionTexture": info, "emissiveTexture": info,
        "pbrMetallicRoughness": { "metallicRoughnessTexture": info, "metallicFactor": 0 },
        "extensions": {
            "KHR_materials_sheen": { "sheenColorFactor": [1, 1, 1], "sheenColorTexture": info, "sheenRoughnessTexture": info },
            "KHR_materials_clearcoat": {
                "clearcoatFactor": 1, "clearcoatTexture": info, "clearcoatRoughnessTexture": info,
                "clearcoatNormalTexture": info,
            },
            "KHR_materials_specular": { "specularTexture": info, "specularColorTexture": info },
            "KHR_materials_anisotropy": { "anisotropyStrength": 1, "anisotropyTexture": info },
        },
    });
    let loaded = square(all.clone()).read().unwrap();
    assert_eq!(loaded.warnings, [""; 0], "there are 12");
    let mut more = all;
    more["extensions"]["KHR_materials_transmission"] = json!({ "transmissionFactor": 1, "transmissionTexture": info });
    more["extensions"]["KHR_materials_volume"] = json!({ "thicknessFactor": 1 });
    let warnings = square(more).read().unwrap().warnings;
    let expected = "a map beyond the first 11 isn't drawn; material \"m\" has it.";
    assert_eq!(warnings, [expected]);
}

#[test]
fn extensions_without_an_effect_are_not_named() {
    let clear = json!({ "transmissionFactor": 1 });
    for extensions in [
        json!({ "KHR_materials_volume": { "attenuationDistance": 2 } }),
        json!({ "KHR_materials_volume": { "thicknessFactor": 0 }, "KHR_materials_ior": {} }),
        json!({ "KHR_materials_anisotropy": {}, "KHR_materials_iridescence": {}, "KHR_materials_dispersion": {} }),
        json!({ "KHR_materials_diffuse_transmission": { "diffuseTransmissionFactor": 0 } }),
        json!({ "KHR_materials_transmission": clear }),
    ] {
        material(json!({ "extensions": extensions }));
    }
}

#[test]
fn the_glossiness_of_an_image_becomes_a_roughness() {
    let glossy = |factor: f32| {
        let map = json!({ "specularGlossinessTexture": { "index": 1 }, "glossinessFactor": factor });
        material(json!({ "extensions": { "KHR_materials_pbrSpecularGlossiness": map } })).look
    };
    // Alpha of the image is 255 on the left and 128 on the right.
    for (factor, green) in [(1.0, [0, 127]), (0.5, [128, 191]), (0.0, [255, 255])] {
        let look = glossy(factor);
        let [specular, rough] =
            [Slot::SpecularColor, Slot::MetallicRoughness].map(|slot| look.maps[slot as usize].clone().expect("a map"));
        assert_eq!((specular.texture.rgba[..4].to_vec(), look.specular_color), (vec![255, 0, 0, 255], [1.0; 3]));
        let greens: Vec<u8> = rough.texture.rgba.iter().skip(1).step_by(4).copied().collect();
        assert_eq!((greens, look.roughness, look.metallic), (green.to_vec(), 1.0, 0.0), "{factor}");
        assert_eq!((rough.uv, rough.sampling), (specular.uv, specular.sampling));
    }
}

#[test]
fn specular_and_glossiness_are_converted() {
    let glossy =
        json!({ "diffuseFactor": [0.5, 0.5, 0.5, 1], "specularFactor": [0.25, 0.5, 1], "glossinessFactor": 0.75 });
    let both = json!({
        "pbrMetallicRoughness": { "baseColorFactor": [1, 0, 0, 1] },
        "extensions": { "KHR_materials_pbrSpecularGlossiness": glossy },
    });
    let Material { base_color, look, .. } = material(both);
    assert_eq!((base_color, look.metallic, look.roughness), ([0.5, 0.5, 0.5, 1.0], 0.0, 0.25));
    // With an infinite index the reflection seen head-on is the specular colour itself.
    assert_eq!((look.ior, look.specular, look.specular_color), (0.0, 1.0, [0.25, 0.5, 1.0]));
    let diffuse = json!({ "diffuseTexture": { "index": 0 } });
    assert!(material(json!({ "extensions": { "KHR_materials_pbrSpecularGlossiness": diffuse } })).texture.is_some());
}

//! Materials: their numbers, maps and samplers, what corners get for them, and what is wrong with some.

use glam::Vec4;

use super::*;
use geometry::mesh::{Alpha, CornerDetail, HeightAmount, Look, MapUv, Material, Sampling, Slot, Wrap};

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

#[test]
fn maps_know_their_coordinates_and_sampling() {
    let moved = json!({ "KHR_texture_transform": { "offset": [0.5, 0], "scale": [2, 3], "texCoord": 1 } });
    let read = material(json!({
        "pbrMetallicRoughness": {
            "baseColorTexture": { "index": 0 }, "metallicRoughnessTexture": { "index": 1 },
        },
        "occlusionTexture": { "index": 0, "texCoord": 1 },
        "emissiveTexture": { "index": 0, "extensions": moved },
        "emissiveFactor": [1, 1, 1],
    }));
    let map = |slot: Slot| read.look.maps[slot as usize].as_ref();
    let rough = map(Slot::MetallicRoughness).expect("a map");
    assert_eq!(rough.uv, MapUv::Own);
    let expected = Sampling {
        wrap: [Wrap::Clamp, Wrap::Mirror],
        magnify_linear: false,
        minify_linear: true,
        mip_linear: Some(false),
    };
    assert_eq!((rough.sampling, read.sampling), (expected, Sampling::default()));
    assert_eq!(map(Slot::Occlusion).expect("a map").uv, MapUv::Set(1, [1.0, 0.0, 0.0, 0.0, 1.0, 0.0]));
    assert_eq!(map(Slot::Emissive).expect("a map").uv, MapUv::Set(1, [2.0, 0.0, 0.5, 0.0, 3.0, 0.0]));
    assert!(map(Slot::Normal).is_none());
    let image = read.texture.as_ref().expect("a texture");
    assert!(std::sync::Arc::ptr_eq(image, &rough.texture), "one image is read once");
}

#[test]
fn corners_have_the_sets_that_maps_use() {
    let second = json!({ "emissiveFactor": [1, 1, 1], "emissiveTexture": { "index": 0, "texCoord": 1 } });
    let mesh = square(second).read().unwrap();
    for (corner, detail) in mesh.corners.iter().zip(details(&mesh)) {
        assert_eq!(detail.uvs, [Vec2::ZERO, QUARTER.into()], "only what is used");
        assert_eq!(corner.uv, Vec2::new(corner.position.x, 1.0 - corner.position.y));
        assert_eq!((detail.color, detail.tangent), (Vec4::ONE, Vec3::ZERO));
    }
    // A transform of the base colour alone: maps beside it have the coordinates of the file.
    let moved = json!({ "index": 0, "extensions": { "KHR_texture_transform": { "offset": [8, 8] } } });
    let apart = json!({ "pbrMetallicRoughness": { "baseColorTexture": moved }, "occlusionTexture": { "index": 0 } });
    let mesh = square(apart).read().unwrap();
    for (corner, detail) in mesh.corners.iter().zip(details(&mesh)) {
        assert_eq!(corner.uv, detail.uvs[0] + Vec2::splat(8.0));
    }
    let plain = json!({ "pbrMetallicRoughness": { "metallicRoughnessTexture": { "index": 0 } } });
    assert!(square(plain).read().unwrap().details.is_none());
}

#[test]
fn a_set_beyond_the_second_is_replaced_and_told() {
    let mut draft = square(json!({ "name": "m", "occlusionTexture": { "index": 0, "texCoord": 5 } }));
    let mesh = draft.read().unwrap();
    assert!(matches!(mesh.materials[0].look.maps[Slot::Occlusion as usize].as_ref().unwrap().uv, MapUv::Set(0, _)));
    assert!(mesh.warnings[0].contains("occlusion map of material \"m\" has TEXCOORD_5"), "{:?}", mesh.warnings);
    draft.root["materials"][0] = json!({ "occlusionTexture": { "index": 0, "texCoord": 1 } });
    draft.root["meshes"][0]["primitives"][0]["attributes"].as_object_mut().unwrap().remove("TEXCOORD_1");
    let mesh = draft.read().unwrap();
    assert!(mesh.warnings[0].contains("primitives without the texture coordinates of a map"), "{:?}", mesh.warnings);
}

#[test]
fn colours_of_all_types_multiply() {
    let expected = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 1.0]];
    for (component, width) in [(5121, 3), (5121, 4), (5123, 3), (5123, 4), (5126, 3), (5126, 4)] {
        let mut bytes = Vec::new();
        for [r, g, b] in expected {
            for value in &[r, g, b, 0.0][..width] {
                match component {
                    5121 => bytes.push((value * 255.0) as u8),
                    5123 => bytes.extend(((value * 65535.0) as u16).to_le_bytes()),
                    _ => bytes.extend(f32::to_le_bytes(*value)),
                }
            }
        }
        let mut draft = square(json!({}));
        let kind = if width == 3 { "VEC3" } else { "VEC4" };
        let colors = draft.accessor(&bytes, component, kind, 4);
        draft.root["accessors"][colors]["normalized"] = json!(component != 5126);
        attribute(&mut draft, "COLOR_0", colors);
        let mesh = draft.read().unwrap();
        assert!(mesh.warnings.is_empty(), "{component} {width} {:?}", mesh.warnings);
        for (corner, detail) in mesh.corners.iter().zip(details(&mesh)) {
            let place = SQUARE.iter().position(|at| Vec3::from(*at) == corner.position).unwrap();
            let alpha = if width == 3 { 1.0 } else { 0.0 };
            assert_eq!(detail.color, Vec3::from(expected[place]).extend(alpha), "{component} {width}");
        }
    }
}

#[test]
fn corners_that_differ_in_colour_alone_do_not_tear() {
    let mut draft = square(json!({}));
    let plain = draft.read().unwrap();
    // The second triangle once more as a primitive of its own, with colours: its corners lie on the first's.
    let at = draft.root["meshes"][0]["primitives"][0]["attributes"].clone();
    let (first, second) = (draft.indices(&[0, 1, 2]), draft.indices(&[2, 1, 3]));
    let colors = draft.floats("VEC4", &[[1.0, 0.0, 0.0, 1.0]; 4].concat());
    let mut colored = at.clone();
    colored["COLOR_0"] = json!(colors);
    draft.root["meshes"][0]["primitives"] = json!([
        { "attributes": at, "indices": first, "material": 0 }, { "attributes": colored, "indices": second, "material": 0 },
    ]);
    let split = draft.read().unwrap();
    assert_eq!((plain.corners.len(), split.corners.len(), split.triangles.len()), (4, 6, 2));
    let [a, b] = [&plain.mesh, &split.mesh].map(Topology::new);
    assert_eq!((a.points.clone(), a.edge_counts()), (b.points.clone(), b.edge_counts()));
    assert_eq!(b.edge_counts().smooth, 1);
}

#[test]
fn tangents_of_the_file_are_used() {
    let normal = json!({ "normalTexture": { "index": 0 } });
    let mut draft = square(normal.clone());
    let tangents = draft.floats("VEC4", &[[0.0, 2.0, 0.0, -1.0]; 4].concat());
    attribute(&mut draft, "TANGENT", tangents);
    let all = |draft: &Draft| {
        let mesh = draft.read().unwrap();
        assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
        details(&mesh).iter().map(|detail| (detail.tangent, detail.bitangent_sign)).collect::<Vec<_>>()
    };
    assert_eq!(all(&draft), [(Vec3::Y, -1.0); 4]);
    // A quarter turn about z, and a mirror: the bitangent is a cross product, which a mirror turns around.
    draft.root["nodes"][0]["rotation"] =
        json!([0.0, 0.0, std::f32::consts::FRAC_1_SQRT_2, std::f32::consts::FRAC_1_SQRT_2]);
    let turned = all(&draft);
    assert!(turned.iter().all(|(tangent, sign)| tangent.distance(Vec3::NEG_X) < 1e-6 && *sign == -1.0), "{turned:?}");
    draft.root["nodes"][0] = json!({ "mesh": 0, "scale": [1, -3, 1] });
    assert_eq!(all(&draft), [(Vec3::NEG_Y, 1.0); 4]);
    // Without normals in the file, its tangents don't fit the normals that are made.
    let mut without = square(normal);
    let tangents = without.floats("VEC4", &[[0.0, 2.0, 0.0, -1.0]; 4].concat());
    attribute(&mut without, "TANGENT", tangents);
    without.root["meshes"][0]["primitives"][0]["attributes"].as_object_mut().unwrap().remove("NORMAL");
    let mesh = without.read().unwrap();
    assert!(details(&mesh).iter().all(|detail| detail.tangent.distance(Vec3::X) < 1e-6));
}

/// In the square u grows along x, and v along -y: the image stands upright, and the bitangent points up.
#[test]
fn tangents_are_computed_as_files_have_them() {
    let normal = json!({ "normalTexture": { "index": 0 } });
    let mesh = square(normal.clone()).read().unwrap();
    assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
    for detail in details(&mesh) {
        assert!(detail.tangent.distance(Vec3::X) < 1e-6 && detail.bitangent_sign == 1.0, "{detail:?}");
    }
    // Mirrored: u grows along -x, and the image is seen from behind.
    let mut mirrored = square(normal.clone());
    mirrored.root["nodes"][0]["scale"] = json!([-1, 1, 1]);
    for detail in details(&mirrored.read().unwrap()) {
        assert!(detail.tangent.distance(Vec3::NEG_X) < 1e-6 && detail.bitangent_sign == -1.0, "{detail:?}");
    }
    // On the normal map's own coordinates: turned by a quarter in the image, u grows along y.
    let quarter = json!({ "KHR_texture_transform": { "rotation": std::f32::consts::FRAC_PI_2 } });
    let turned = json!({ "normalTexture": { "index": 0, "extensions": quarter } });
    for detail in details(&square(turned).read().unwrap()) {
        assert!(detail.tangent.distance(Vec3::NEG_Y) < 1e-6 && detail.bitangent_sign == 1.0, "{detail:?}");
    }
}

/// A roof whose image is mirrored at the ridge: the corners there have two tangents, and become two each.
#[test]
fn corners_with_two_tangents_are_split_but_do_not_tear() {
    let roof = [[-1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 1.0], [-1.0, 1.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]];
    let mut draft = square(json!({ "normalTexture": { "index": 0 } }));
    let (at, normals) = (draft.vectors(&roof), draft.vectors(&[[0.0, 0.0, 1.0]; 6]));
    let uvs = draft.floats("VEC2", &[0.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    let indices = draft.indices(&[0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2]);
    let attributes = json!({ "POSITION": at, "NORMAL": normals, "TEXCOORD_0": uvs });
    draft.root["meshes"][0]["primitives"] = json!([{ "attributes": attributes, "indices": indices, "material": 0 }]);
    let mesh = draft.read().unwrap();
    assert_eq!((mesh.corners.len(), details(&mesh).len()), (8, 8));
    for (triangle, left) in mesh.triangles.iter().zip([true, true, false, false]) {
        for detail in triangle.map(|corner| details(&mesh)[corner as usize]) {
            let (tangent, sign) = (detail.tangent, detail.bitangent_sign);
            assert_eq!((tangent.x > 0.0, sign), (left, if left { 1.0 } else { -1.0 }), "{detail:?}");
        }
    }
    let topology = Topology::new(&mesh);
    assert_eq!((topology.points.len(), topology.edge_counts().boundary), (6, 6));
    assert_eq!((topology.edge_counts().smooth, topology.edge_counts().split), (3, 0));
}

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

//! Members that are missing or have a wrong value.

use super::*;
use crate::gltf::tests::files::png_uri;

/// 2 to the power of 62.
const HUGE: u64 = 1 << 62;

fn without(name: &'static str, pointer: &str, expected: &str) -> Case {
    Case::with(name, pointer, Value::Null, expected)
}

/// A triangle with materials, textures and images.
fn dressed() -> Draft {
    let mut draft = triangle();
    draft.root["materials"] = json!([{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }]);
    draft.root["textures"] = json!([{ "source": 0 }]);
    draft.root["images"] = json!([{ "uri": "" }]);
    draft
}

/// The dressed triangle with another value in one place, and its material in use, with a normal map.
fn repaired(name: &'static str, pointer: &str, value: Value, parts: &'static str) -> Case {
    let mut draft = dressed();
    draft.root["images"] = json!([{ "uri": png_uri() }]);
    draft.root["meshes"][0]["primitives"][0]["material"] = json!(0);
    draft.root["materials"][0]["normalTexture"] = json!({ "index": 0 });
    set(&mut draft.root, pointer, value);
    Case::draft(name, &draft, Gets::Repaired(parts))
}

pub(super) fn cases() -> Vec<Case> {
    let sparse =
        json!({ "count": 1, "indices": { "bufferView": 0, "componentType": 5126 }, "values": { "bufferView": 1 } });
    vec![
        Case::with("nodes that are an object", "/nodes", json!({}), "Document | /nodes | list | object"),
        Case::with("a node that is text", "/nodes/0", json!("root"), "Document | /nodes/0 | \"root\" | object"),
        Case::with("a mesh that isn't there", "/nodes/0/mesh", json!(5), "Document | /nodes/0/mesh | 5 | /meshes | 1"),
        Case::with(
            "a mesh before the first",
            "/nodes/0/mesh",
            json!(-1),
            "Document | /nodes/0/mesh | -1 | whole number",
        ),
        Case::with("half a mesh", "/nodes/0/mesh", json!(0.5), "Document | /nodes/0/mesh | 0.5 | whole number"),
        Case::with(
            "a mesh beyond 32 bits",
            "/nodes/0/mesh",
            json!(1_u64 << 32),
            "Document | /nodes/0/mesh | 4294967296 | /meshes | 1",
        ),
        Case::with(
            "a child that isn't there",
            "/nodes/0/children",
            json!([HUGE]),
            "Document | /nodes/0/children/0 | 4611686018427387904 | /nodes | 1",
        ),
        Case::with(
            "a matrix of three numbers",
            "/nodes/0/matrix",
            json!([1, 0, 0]),
            "Document | /nodes/0/matrix | 16 | 3",
        ),
        Case::with(
            "a translation beyond f32",
            "/nodes/0/translation",
            json!([0, 1e308, 0]),
            "Document | /nodes/0/translation/1 | 1e+308 | 3.4028235e38",
        ),
        Case {
            gets: Gets::Repaired("/nodes/0/rotation | length 2"),
            ..Case::with("a rotation that is too long", "/nodes/0/rotation", json!([0, 0, 0, 2]), "")
        },
        Case::draft(
            "weights that are text",
            &{
                let mut draft = triangle();
                draft.root["nodes"][0]["weights"] = json!(["a\nb"]);
                draft.root["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": 0 }]);
                draft
            },
            Gets::Refused("Document | /nodes/0/weights/0 | number | \"a�b\"".to_owned()),
        ),
        Case::with(
            "a scene's node that isn't there",
            "/scenes/0/nodes",
            json!([0, 1]),
            "Document | /scenes/0/nodes/1 | 1 | /nodes",
        ),
        without("no primitives", "/meshes/0/primitives", "Document | /meshes/0/primitives | missing"),
        without("no attributes", "/meshes/0/primitives/0/attributes", "Empty | 1 primitives | empty"),
        Case::with(
            "a mode that there isn't",
            "/meshes/0/primitives/0/mode",
            json!(7),
            "Document | /meshes/0/primitives/0/mode | 0 | 1 | 2 | 3 | 4 | 5 | 6 | 7",
        ),
        Case::draft(
            "a material that isn't there",
            &{
                let mut draft = triangle();
                set(&mut draft.root, "/meshes/0/primitives/0/material", json!(0));
                draft
            },
            Gets::Repaired("/meshes/0/primitives/0/material | 0 materials | default material"),
        ),
        Case::with(
            "positions that aren't there",
            "/meshes/0/primitives/0/attributes/POSITION",
            json!(77),
            "Document | /meshes/0/primitives/0/attributes/POSITION | 77 | /accessors | 2",
        ),
        Case::with(
            "targets that are a number",
            "/meshes/0/primitives/0/targets",
            json!(3),
            "Document | /meshes/0/primitives/0/targets | 3 | list",
        ),
        without("no component type", "/accessors/0/componentType", "Document | /accessors/0/componentType | missing"),
        Case::with(
            "signed 32-bit integers",
            "/accessors/0/componentType",
            json!(5124),
            "Document | /accessors/0/componentType | 5120 | 5121 | 5122 | 5123 | 5125 | 5126 | 5124",
        ),
        Case::with(
            "five numbers an element",
            "/accessors/0/type",
            json!("VEC5"),
            "Document | /accessors/0/type | SCALAR | VEC2 | VEC3 | VEC4 | MAT2 | MAT3 | MAT4 | \"VEC5\"",
        ),
        without("no count", "/accessors/0/count", "Document | /accessors/0/count | missing"),
        Case::with(
            "a count below 0",
            "/accessors/0/count",
            json!(-1),
            "Document | /accessors/0/count | -1 | whole number",
        ),
        Case::with(
            "a count of 1e308",
            "/accessors/0/count",
            json!(1e308),
            "Document | /accessors/0/count | 1e+308 | whole number",
        ),
        Case { gets: Gets::Read, ..without("neither view nor sparse values: zeros", "/accessors/0/bufferView", "") },
        Case::with(
            "a view that isn't there",
            "/accessors/1/bufferView",
            json!(2_u64 << 30),
            "Document | /accessors/1/bufferView | 2147483648 | /bufferViews | 2",
        ),
        Case::with(
            "sparse places that are no integers",
            "/accessors/0/sparse",
            sparse,
            "Document | /accessors/0/sparse/indices/componentType | 5121 | 5123 | 5125 | 5126",
        ),
        Case::with(
            "a stride below 4",
            "/bufferViews/0/byteStride",
            json!(3),
            "Document | /bufferViews/0/byteStride | 3 | at least 4",
        ),
        Case::with(
            "a stride beyond 252",
            "/bufferViews/0/byteStride",
            json!(256),
            "Document | /bufferViews/0/byteStride | 256 | at most 252",
        ),
        without("a view of no buffer", "/bufferViews/0/buffer", "Document | /bufferViews/0/buffer | missing"),
        repaired(
            "texture coordinates beyond 32 bits",
            "/materials/0/pbrMetallicRoughness/baseColorTexture/texCoord",
            json!(HUGE),
            "/materials/0/pbrMetallicRoughness/baseColorTexture/texCoord | 4611686018427387904 | 4294967295 | 0 is used",
        ),
        repaired(
            "a colour beyond 1",
            "/materials/0/pbrMetallicRoughness/baseColorFactor",
            json!([1, 1, 1, 1.5]),
            "/materials/0/pbrMetallicRoughness/baseColorFactor/3 | 1.5 | at most | 1.0 | 1 is used",
        ),
        repaired(
            "sides that are text",
            "/materials/0/doubleSided",
            json!("yes"),
            "/materials/0/doubleSided | \"yes\" | true or false | false is used",
        ),
        repaired(
            "a texture that isn't there",
            "/materials/0/pbrMetallicRoughness/baseColorTexture/index",
            json!(1),
            "/materials/0/pbrMetallicRoughness/baseColorTexture/index | 1 | /textures",
        ),
        repaired("an image that isn't there", "/textures/0/source", json!(9), "/textures/0/source | 9 | /images | 1"),
        repaired("a path that is a number", "/images/0/uri", json!(5), "texture | /images/0/uri | text"),
        repaired("materials that are text", "/materials", json!("none"), "/materials | \"none\" | list"),
        repaired("a material that is a list", "/materials/0", json!([[]]), "/materials/0 | list of 1 | object"),
        repaired(
            "an emission beyond f32",
            "/materials/0/extensions",
            json!({ "KHR_materials_emissive_strength": { "emissiveStrength": 1e300 } }),
            "/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength | 1e+300 | at most",
        ),
        repaired(
            "a transform that is a number",
            "/materials/0/normalTexture",
            json!({ "index": 0, "extensions": { "KHR_texture_transform": 7 } }),
            "/materials/0/normalTexture/extensions/KHR_texture_transform | 7 | object",
        ),
        repaired(
            "a sampler that isn't there",
            "/textures/0/sampler",
            json!(HUGE),
            "/textures/0/sampler | /samplers | 0",
        ),
        repaired(
            "colours that aren't there",
            "/meshes/0/primitives/0/attributes/COLOR_0",
            json!(77),
            "/meshes/0/primitives/0/attributes/COLOR_0 | 2 accessors | left out",
        ),
        repaired(
            "tangents of three numbers",
            "/meshes/0/primitives/0/attributes/TANGENT",
            json!(1),
            "/accessors/1 | TANGENT of /meshes/0/primitives/0 | left out",
        ),
        Case::with(
            "a scale of nothing",
            "/nodes/0/scale",
            json!([null, 1, 1]),
            "Document | /nodes/0/scale/0 | number | null",
        ),
        Case::with(
            "an extension that nobody knows",
            "/extensionsRequired",
            json!(["EXT_unknown"]),
            "Extension | /extensionsRequired/0 | EXT_unknown",
        ),
        Case::draft(
            "Draco without anything that it compressed",
            &{
                let mut draft = triangle();
                draft.root["extensionsRequired"] = json!(["KHR_mesh_quantization", "KHR_draco_mesh_compression"]);
                draft
            },
            Gets::Read,
        ),
        Case::with("a node without a mesh", "/nodes/0", json!({}), "Empty | node | mesh"),
        Case::draft(
            "a name that is no text, and an unknown extension",
            &{
                let mut draft = triangle();
                draft.root["meshes"][0]["name"] = json!([1]);
                draft.root["extensionsUsed"] = json!(["EXT_unknown"]);
                draft.root["nodes"][0]["extensions"] = json!({ "EXT_unknown": [[[]]] });
                draft
            },
            Gets::Repaired("EXT_unknown | isn't known | left out"),
        ),
    ]
}
